"""Two-phase culling of spline tubes: what others hide is not drawn, and no pixel changes.

The segments that own a pixel of the last picture are drawn first. A pyramid of that depth, which belongs to this very
camera, then tells of all others which cannot show; the rest is drawn after. Both lists are made on the GPU, and drawn
by calls whose numbers it writes itself: the CPU issues the same calls whatever shows, and nothing is read back. In what
order segments are listed is not determined, and so neither is which of two owns a pixel in which both are as deep.

It needs compute stages (OpenGL 4.3), and pays from some ten thousand segments on.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import moderngl

from ..culling.pyramid import DepthPyramid
from ..opengl import BufferTexture, OpenGL
from ..passes import dispatch
from ..shaders import Programs
from .silhouettes import BATCH

if TYPE_CHECKING:
    from collections.abc import Callable

    from ..passes import Passes
    from .target import SplineTarget

__all__ = ["LEAST_SEGMENTS", "TwoPhase"]

LEAST_SEGMENTS = 16000
"""With fewer, two rounds and a pyramid cost more than what they spare: for 3,500 segments as much again."""
LISTED_UNIT, OWNER_UNIT = 20, 12
_PER_CALL = BATCH // 4
_GROUP = 64


class TwoPhase:
    """Lists and draws the segments of one set that may show.

    Parameters
    ----------
    ctx : moderngl.Context
    gl : OpenGL
    programs : Programs
    n_segments : int
    """

    def __init__(self, ctx: moderngl.Context, gl: OpenGL, programs: Programs, n_segments: int) -> None:
        self._ctx, self._gl, self._programs, self._n = ctx, gl, programs, n_segments
        self._pyramid = DepthPyramid(ctx, gl, programs)
        self._calls = -(-n_segments // _PER_CALL)
        self._max_groups = int(ctx.info["GL_MAX_COMPUTE_WORK_GROUP_COUNT"][0])
        self.buffers: dict[str, moderngl.Buffer] = {}
        self._texture: BufferTexture | None = None
        try:
            for name, size in (
                ("seen", 4 * -(-n_segments // 32)),
                ("listed", 4 * n_segments),
                ("counts", 16),
                ("commands", 20 * self._calls),
            ):
                self.buffers[name] = ctx.buffer(reserve=size)
            self._texture = gl.texture_buffer(self.buffers["listed"], "r32ui")
        except BaseException:
            self.release()
            raise

    @property
    def nbytes(self) -> int:
        """Bytes of GPU memory that go with the segments."""
        return sum(buffer.size for buffer in self.buffers.values())

    @property
    def pyramid_nbytes(self) -> int:
        """Bytes of GPU memory that go with the picture."""
        return self._pyramid.nbytes

    def before(self, target: SplineTarget) -> None:
        """Note what the last picture shows; nothing, if there is none of this size. Call it before that is cleared."""
        seen = self.buffers["seen"]
        seen.clear()
        if not target.buffer.generation:
            return
        program = self._programs.compute("splines/seen.comp")
        seen.bind_to_storage_buffer(0)
        target.buffer.owner.use(OWNER_UNIT)
        program["owner"], program["count"] = OWNER_UNIT, self._n
        width, height = target.size
        program.run(-(-width // 8), -(-height // 8))
        self._ctx.memory_barrier(moderngl.ALL_BARRIER_BITS)

    def draw(
        self,
        target: SplineTarget,
        passes: Passes,
        prepare: Callable[[moderngl.ComputeShader], None],
        render: Callable[[moderngl.Buffer], None],
    ) -> None:
        """Draw what may show, in two rounds.

        Parameters
        ----------
        target : SplineTarget
            Cleared.
        passes : Passes
        prepare : callable
            Tells a program where nodes and segments are.
        render : callable
            Draws the listed segments by the calls in a buffer.
        """
        with passes.timed("seen before"):
            self._list(prepare, second=False)
            render(self.buffers["commands"])
        with passes.timed("pyramid"):
            self._make_pyramid(target)
        with passes.timed("others"):
            self._list(prepare, second=True)
            render(self.buffers["commands"])

    def _list(self, prepare: Callable[[moderngl.ComputeShader], None], *, second: bool) -> None:
        ctx = self._ctx
        self.buffers["counts"].write(bytes(16))
        for binding, name in enumerate(("seen", "listed", "counts", "commands")):
            self.buffers[name].bind_to_storage_buffer(binding)
        cull = self._programs.compute("splines/cull.comp", ["TUBES"])
        prepare(cull)
        cull["second_round"] = int(second)
        if second:
            self._pyramid.bind(cull)
        dispatch(cull, -(-self._n // _GROUP), self._max_groups)
        ctx.memory_barrier(moderngl.ALL_BARRIER_BITS)
        write = self._programs.compute("splines/commands.comp")
        write["calls"], write["batch"] = self._calls, _PER_CALL
        write.run(-(-self._calls // _GROUP))
        ctx.memory_barrier(moderngl.ALL_BARRIER_BITS)

    def _make_pyramid(self, target: SplineTarget) -> None:
        target.write_keys(self._programs)
        self._pyramid.build(target.buffer)

    def bind(self, program: moderngl.Program) -> None:
        """Tell a drawing program where the list is."""
        assert self._texture is not None
        self._texture.bind(LISTED_UNIT)
        self._gl.set_sampler(program, "listed_texels", LISTED_UNIT)

    def release(self) -> None:
        """Give everything back; twice is harmless."""
        if self._texture is not None:
            self._texture.release()
            self._texture = None
        for buffer in self.buffers.values():
            buffer.release()
        self.buffers.clear()
        self._pyramid.release()


def supports_two_phase(ctx: moderngl.Context) -> bool:
    """Say whether a context has what it takes."""
    return bool(ctx.version_code >= 430)
