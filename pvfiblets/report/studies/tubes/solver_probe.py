"""The solver alone, on rays and halves of the caller's: what tests and the report of error against run time ask.

>>> probe = SolverProbe(ctx, "illinois")                                                # doctest: +SKIP
>>> l, t, kind = probe.hits(controls, origins, directions)                              # doctest: +SKIP
"""

from __future__ import annotations

import time
from collections.abc import Callable

import moderngl
import numpy as np
import numpy.typing as npt

from pvfiblets.engine.gl.bindings import BLOCKS, TUBE_PROBE
from pvfiblets.engine.gl.moderngl_extras import GLExtras
from pvfiblets.engine.gl.shaders import Programs
from pvfiblets.engine.tubes.options import SOLVERS, check_choices
from pvfiblets.engine.tubes.uniform_blocks import SPLINES_BLOCK

Array = npt.NDArray[np.float64]

_ROW = 1024


class SolverProbe:
    """Meets rays with halves on the GPU, by the same code as the picture; `seconds` are of the last call's drawing."""

    def __init__(
        self,
        ctx: moderngl.Context,
        solver: str,
        iterations: int | None = None,
        *,
        chain: bool = False,
        hollow: bool = False,
        clock: Callable[[], float] = time.perf_counter,
    ) -> None:
        check_choices(solver=solver, iterations=iterations)
        self._ctx, self._gl = ctx, GLExtras(ctx)
        self._programs = Programs(ctx, {})
        feature = SOLVERS[solver].feature
        wanted = {"TUBE_CHAIN": chain or hollow or feature is None, "TUBE_HOLLOW": hollow}
        features = [name for name, on in wanted.items() if on] + ([feature] if feature else [])
        self._program, self._array = self._programs.screen("tubes/probe.frag", features)
        self._block = ctx.buffer(bytes(SPLINES_BLOCK.nbytes))
        self.limit(SOLVERS[solver].iterations if iterations is None else iterations)
        self._clock = clock
        self.seconds = 0.0

    def hits(
        self,
        controls: Array,
        origins: Array,
        directions: Array,
        *,
        start: npt.ArrayLike = -np.inf,
        capped: bool = False,
    ) -> tuple[Array, Array, npt.NDArray[np.int64]]:
        """Return where each ray meets its half."""
        count = len(controls)
        unit = directions / np.linalg.norm(directions, axis=1, keepdims=True)
        low, high = controls[..., :3].min(axis=1), controls[..., :3].max(axis=1)
        centre = (low + high) / 2.0
        size = np.maximum((high - low).max(axis=1) / 2.0 + controls[..., 3].max(axis=1), 1e-30)
        moved = controls.copy()
        moved[..., :3] -= centre[:, None]
        away = centre - origins
        along = np.einsum("ij,ij->i", away, unit)
        rows = np.zeros((count, 5, 4))
        rows[:, :3] = moved / size[:, None, None]
        rows[:, 3, :3] = (along[:, None] * unit - away) / size[:, None]
        rows[:, 3, 3] = np.clip((np.broadcast_to(np.asarray(start, np.float64), count) - along) / size, -1e38, 1e38)
        rows[:, 4, :3] = unit
        rows[:, 4, 3] = float(capped)
        found = self._run(rows)
        kind = found[:, 2].astype(np.int64)
        return np.where(kind > 0, found[:, 0] * size + along, np.nan), found[:, 1], kind

    def limit(self, iterations: int) -> None:
        """Search by so many iterations from now on; the program stays the same."""
        check_choices(iterations=iterations)
        SPLINES_BLOCK.write(self._block, tube_search_steps=iterations)

    def _run(self, rows: Array) -> Array:
        ctx, count = self._ctx, len(rows)
        height = max(1, -(-count // _ROW))
        data = ctx.buffer(np.ascontiguousarray(rows, "<f4").tobytes())
        cases = self._gl.texture_buffer(data, "rgba32f")
        target = ctx.texture((_ROW, height), 4, dtype="f4")
        framebuffer = ctx.framebuffer([target])
        try:
            self._block.bind_to_uniform_block(BLOCKS["Splines"])
            cases.bind(TUBE_PROBE["cases"])
            self._gl.set_sampler(self._program, "cases", TUBE_PROBE["cases"])
            self._program["row"], self._program["count"] = _ROW, count
            with self._gl.framebuffers_kept():
                framebuffer.use()
                ctx.scissor = None
                ctx.enable_only(moderngl.NOTHING)
                ctx.finish()
                begin = self._clock()
                self._array.render(moderngl.TRIANGLES, vertices=3)
                ctx.finish()
                self.seconds = self._clock() - begin
            found = np.frombuffer(target.read(), "<f4").reshape(-1, 4)[:count].astype(np.float64)
        finally:
            framebuffer.release()
            target.release()
            cases.release()
            data.release()
        return found

    def release(self) -> None:
        """Give everything back; twice is harmless."""
        self._block.release()
        self._programs.release()
