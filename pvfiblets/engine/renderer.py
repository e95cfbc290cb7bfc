"""`FibletRenderer`: a fiblet set on one OpenGL context, drawn into a G-buffer when something changed."""

from __future__ import annotations

from typing import TYPE_CHECKING

import moderngl
import numpy as np
from tqdm import tqdm

from ..codec import layout, tables
from .chunks import Chunk, available_memory, plan_chunks, storage_buffer, upload_chunk
from .clipping import BLOCK_BYTES, clip_planes_block
from .errors import EngineError
from .frame import frame_block, segment_pixels
from .gbuffer import GBuffer
from .passes import Passes
from .pipelines.compute import CLIP_PLANES, CLIPPING, CONSTANTS, ComputePipeline
from .shaders import Programs
from .values import ValueSources
from .view import Style, View

if TYPE_CHECKING:
    from ..codec.fibletset import FibletSet

__all__ = ["FibletRenderer"]

REQUIRED_VERSION = 430


class FibletRenderer:
    """Draws one fiblet set.

    The context must be current in every call. The renderer binds what it needs and leaves it bound; the caller keeps
    its own OpenGL state.

    Parameters
    ----------
    ctx : moderngl.Context
        OpenGL 4.3 or later.
    fiblets : FibletSet
        Copied to the GPU here; not kept in memory otherwise.
    progress : bool
        Show a progress bar while copying.
    max_buffer_bytes, max_groups, max_total_bytes : int, optional
        Limits below the driver's own: bytes of one buffer, work groups along one axis, bytes of all buffers.

    Raises
    ------
    EngineError
        If OpenGL is older than 4.3, or memory does not suffice; nothing stays behind on the GPU.
    """

    def __init__(
        self,
        ctx: moderngl.Context,
        fiblets: FibletSet,
        *,
        progress: bool = False,
        max_buffer_bytes: int | None = None,
        max_groups: int | None = None,
        max_total_bytes: int | None = None,
    ) -> None:
        if ctx.version_code < REQUIRED_VERSION:
            raise EngineError(
                f"drawing fiblets needs OpenGL 4.3, found {ctx.version_code // 100}.{ctx.version_code % 100 // 10} "
                f"({ctx.info['GL_RENDERER']}); a newer driver, or Mesa's software OpenGL, has it"
            )
        self._ctx = ctx
        self._fiblets = fiblets
        self._chunks: list[Chunk] = []
        self._buffers: dict[str, moderngl.Buffer] = {}
        self._pipeline: ComputePipeline | None = None
        self._target: GBuffer | None = None
        self._drawn: tuple[View, Style] | None = None
        self._passes = Passes(ctx)
        self._programs = Programs(ctx, CONSTANTS)
        self._generation = 0
        self._largest_reach = 0.0
        self._segment = 0.0
        self._features: list[str] = []
        self._values: ValueSources | None = None
        self._top = 2**32 - 1 if fiblets.anchors_low is not None else 2**16 - 1
        limit = int(ctx.info["GL_MAX_SHADER_STORAGE_BLOCK_SIZE"])
        groups = int(ctx.info["GL_MAX_COMPUTE_WORK_GROUP_COUNT"][0])
        try:
            self._upload(min(limit, max_buffer_bytes or limit), max_total_bytes, progress)
            groups = min(groups, max_groups or groups)
            self._pipeline = ComputePipeline(ctx, self._programs, fiblets.n_fiblets, groups)
            self._values = ValueSources(ctx, self._programs, fiblets, self._chunks, groups)
        except BaseException:
            self.release()
            raise

    def _upload(self, max_buffer_bytes: int, max_total_bytes: int | None, progress: bool) -> None:
        fiblets = self._fiblets
        plans = plan_chunks(fiblets, max_buffer_bytes)
        if fiblets.n_fiblets > max_buffer_bytes:  # the pipeline's marks: a byte for each, in one buffer
            raise EngineError(
                f"{fiblets.n_fiblets} fiblets are more than the {max_buffer_bytes} for which this OpenGL's largest "
                "buffer keeps a byte each; draw fewer streamlines"
            )
        needed = sum(plan.nbytes for plan in plans)
        limits = [n for n in (max_total_bytes, available_memory(self._ctx)) if n is not None]
        if limits and needed > min(limits):
            raise EngineError(
                f"{fiblets.n_fiblets} fiblets need {needed / 1e6:.1f} MB of GPU memory, {min(limits) / 1e6:.1f} MB are "
                "available; draw fewer streamlines"
            )
        self._buffers["directions"] = storage_buffer(self._ctx, _direction_table(), "direction table")
        coding = np.zeros((2, 4), "<f4")
        coding[0] = *fiblets.anchor_scale, fiblets.reach_scale
        coding[1, :3] = fiblets.step_lo, fiblets.step_hi - fiblets.step_lo, fiblets.lattice
        self._buffers["coding"] = self._ctx.buffer(coding.tobytes())
        self._buffers["frame"] = self._ctx.buffer(reserve=208)
        with tqdm(total=needed, unit="B", unit_scale=True, desc="to the GPU", disable=not progress) as bar:
            for plan in plans:
                self._chunks.append(upload_chunk(self._ctx, fiblets, plan))
                first, last = plan.fiblets
                reach = float(np.max(fiblets.reach[first:last], initial=0)) * fiblets.reach_scale
                self._largest_reach = max(self._largest_reach, reach)
                bar.update(plan.nbytes)

    def render(self, view: View, style: Style | None = None) -> GBuffer:
        """Draw, unless the last picture was of the same view and style.

        Parameters
        ----------
        view : View
        style : Style, optional

        Returns
        -------
        GBuffer
            The renderer's own; the same object until the size changes.

        Raises
        ------
        EngineError
            After :meth:`release`, if the picture is too large, or if ``style.values`` names no array.
        """
        style = style or Style()
        pipeline, values = self._alive()
        if self._target is not None and self._drawn == (view, style):
            return self._target
        self._drawn = None
        if self._target is None or self._target.size != view.size:
            if self._target is not None:
                self._target.release()
                self._target = None
            self._target = GBuffer(self._ctx, view.size)
        self._bind_shared()
        features = self._decoding_features()
        source = values.activate(style.values, features)
        features += ["WIDE_LINES"] if style.line_width > 1.0 else []
        features += self._write_frame(view, style)
        self._features = features + ([source] if source else [])
        self._passes.begin()
        pipeline.draw(self._chunks, self._target, self._features, self._passes, style.line_width, self._segment)
        self._generation += 1
        self._target.generation = self._generation
        self._drawn = (view, style)
        return self._target

    def _write_frame(self, view: View, style: Style) -> list[str]:
        """Bring the uniform blocks of the camera up to date; return the features that the view asks for."""
        origin = np.asarray(self._fiblets.origin, np.float64)
        scale = np.asarray(self._fiblets.anchor_scale, np.float64)
        # Where steps vary, four times their mean stands for the longest.
        self._segment = segment_pixels(view, origin, scale, self._top, 4.0 * self._fiblets.step)
        block, margin = frame_block(view, style.line_width, origin, scale, self._top)
        self._buffers["frame"].write(block)
        planes = clip_planes_block(view, style.line_width, origin, scale, self._top, self._largest_reach)
        if planes is None:
            if "clip_planes" in self._buffers:
                self._buffers.pop("clip_planes").release()
            return list(CLIPPING) if margin < self._largest_reach else []
        if "clip_planes" not in self._buffers:
            self._buffers["clip_planes"] = self._ctx.buffer(reserve=BLOCK_BYTES)
        self._buffers["clip_planes"].write(planes)
        self._buffers["clip_planes"].bind_to_uniform_block(3)
        return [*CLIPPING, CLIP_PLANES]

    def value_range(self, values: str) -> tuple[float, float]:
        """Return the least and the greatest of a per-point value, for a colour map's range.

        Parameters
        ----------
        values : str
            As in :class:`Style`. Arc length and curvature are measured on the GPU, once.

        Returns
        -------
        tuple of float
            Of a stored array: the range that its codes span.

        Raises
        ------
        EngineError
            If there is no such array, or after :meth:`release`.
        """
        sources = self._alive()[1]
        self._bind_shared()
        return sources.range(values, self._decoding_features())

    def _alive(self) -> tuple[ComputePipeline, ValueSources]:
        if self._pipeline is None or self._values is None:
            raise EngineError("this renderer has been released; make a new one")
        return self._pipeline, self._values

    def _bind_shared(self) -> None:
        self._buffers["frame"].bind_to_uniform_block(0)
        self._buffers["coding"].bind_to_uniform_block(1)
        self._buffers["directions"].bind_to_storage_buffer(3)

    def _decoding_features(self) -> list[str]:
        kinds = frozenset().union(*(chunk.kinds for chunk in self._chunks))
        wanted = {
            "ANCHORS_LOW": self._fiblets.anchors_low is not None,
            "DIRECTION": layout.Kind.DIRECTION in kinds,
            "LATTICE": bool(kinds - {layout.Kind.DIRECTION}),
            "WIDE_LATTICE": layout.Kind.WIDE in kinds,
            "RANK_TO_ID": self._fiblets.rank_to_id is not None,
        }
        return [name for name, on in wanted.items() if on]

    def explain(self) -> dict[str, object]:
        """Say what the last redraw was made of, and wait for it to end.

        Returns
        -------
        dict
            ``passes`` (name, ms), ``features``, ``buffers`` (name, bytes), ``fiblets_total``.
        """
        buffers: dict[str, int] = {name: buffer.size for name, buffer in self._buffers.items()}
        for chunk in self._chunks:
            for name, buffer in chunk.buffers.items():
                buffers[name] = buffers.get(name, 0) + buffer.size
        if self._pipeline is not None:
            buffers |= {name: buffer.size for name, buffer in self._pipeline.buffers.items()}
        if self._target is not None:
            buffers["gbuffer"] = self._target.nbytes
        return {
            "passes": self._passes.report(),
            "features": list(self._features),
            "buffers": [{"name": name, "bytes": size} for name, size in buffers.items()],
            "fiblets_total": int(self._fiblets.n_fiblets),
        }

    def release(self) -> None:
        """Give back everything on the GPU; twice is harmless."""
        for chunk in self._chunks:
            chunk.release()
        self._chunks.clear()
        for buffer in self._buffers.values():
            buffer.release()
        self._buffers.clear()
        if self._pipeline is not None:
            self._pipeline.release()
            self._pipeline = self._values = None
        if self._target is not None:
            self._target.release()
            self._target = None
        self._programs.release()
        self._passes.release()
        self._drawn = None


def _direction_table() -> np.ndarray[tuple[int, ...], np.dtype[np.float32]]:
    """Quaternions of all cap angles and codes as the shaders take them: (4096, 4), x y z w."""
    table = np.roll(tables.quaternions().reshape(-1, 4), -1, axis=1)
    if np.any(table[:, 0]):
        raise EngineError("a direction code's rotation has an x component; shaders/decode/words.glsl leaves it out")
    return np.ascontiguousarray(table, np.float32)
