"""The compute pipeline (OpenGL 4.3): decode in registers, rasterise into images with atomics.

=============  =========================================================================================
pass           what it does
=============  =========================================================================================
clear          empties depth and owners
cull           one bit per fiblet: can it show? (frustum)
depth          draws the shown fiblets' depth with imageAtomicMin; marks those that came nearest somewhere
attributes     draws those again and writes streamline, tangent and place where their depth was kept
settle         the same once more, and only if two fiblets tied in a pixel and wrote in the wrong order
=============  =========================================================================================

The sources are in ``shaders/compute``; what a program includes is decided by features.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import moderngl

from ..chunks import Chunk
from ..gbuffer import GBuffer
from ..passes import Passes, dispatch
from ..shaders import Programs

__all__ = ["CONSTANTS", "ComputePipeline"]

GROUP_SIZE = 64
GROUP_WORDS = 8
CONSTANTS = {"group_size": GROUP_SIZE, "group_words": GROUP_WORDS}

_BINDINGS = {
    "cull": {"anchors": 0, "pages": 4, "reach": 5, "shown": 6, "candidates": 7, "anchors_low": 8},
    "depth": {
        "anchors": 0, "decoding": 1, "codes": 2, "pages": 4, "shown": 6, "candidates": 7, "anchors_low": 8,
    },
    "attributes": {
        "anchors": 0, "decoding": 1, "codes": 2, "pages": 4, "candidates": 7, "anchors_low": 8, "rank_to_id": 9,
        "values": 10, "starts": 11,
    },
}  # fmt: skip
_AFTER_WRITES = moderngl.SHADER_STORAGE_BARRIER_BIT | moderngl.SHADER_IMAGE_ACCESS_BARRIER_BIT


class ComputePipeline:
    """Draws chunks into a G-buffer.

    Parameters
    ----------
    ctx : moderngl.Context
    programs : Programs
    max_groups : int
        Work groups per axis of a dispatch.
    """

    def __init__(self, ctx: moderngl.Context, programs: Programs, max_groups: int) -> None:
        self._ctx = ctx
        self._programs = programs
        self._max_groups = max_groups
        self._status = ctx.buffer(reserve=16)

    def draw(self, chunks: Sequence[Chunk], target: GBuffer, features: Iterable[str], passes: Passes) -> None:
        """Draw all chunks; the ``Frame`` and ``Coding`` blocks and the direction table are bound already.

        Parameters
        ----------
        chunks : sequence of Chunk
        target : GBuffer
        features : iterable of str
            Keys of :data:`pvfiblets.engine.shaders.FEATURES`.
        passes : Passes
            Takes the times.
        """
        features = list(features)
        clear, cull, depth, attributes = (
            self._programs.compute(f"compute/{name}.comp", features)
            for name in ("clear", "cull", "depth", "attributes")
        )
        target.depth.bind_to_image(0, read=True, write=True)
        target.owner.bind_to_image(1, read=True, write=True)
        target.ids.bind_to_image(2, read=False, write=True)
        target.position.bind_to_image(3, read=False, write=True)
        self._status.write(bytes(16))
        with passes.timed("clear"):
            dispatch(clear, target.size[1], self._max_groups)
        with passes.timed("cull"):
            self._run(cull, "cull", chunks, 32 * GROUP_SIZE)
        self._ctx.memory_barrier(_AFTER_WRITES)
        with passes.timed("depth"):
            self._run(depth, "depth", chunks, 32 * GROUP_WORDS)
        self._ctx.memory_barrier(_AFTER_WRITES)
        self._status.bind_to_storage_buffer(6)
        for name, settling in (("attributes", False), ("settle", True)):
            attributes["settling"] = settling
            with passes.timed(name):
                self._run(attributes, "attributes", chunks, 32 * GROUP_WORDS)
            self._ctx.memory_barrier(_AFTER_WRITES)
        self._ctx.memory_barrier(moderngl.ALL_BARRIER_BITS)

    def _run(self, program: moderngl.ComputeShader, stage: str, chunks: Sequence[Chunk], per_group: int) -> None:
        for chunk in chunks:
            chunk.buffers["chunk"].bind_to_uniform_block(2)
            for name, binding in _BINDINGS[stage].items():
                if name in chunk.buffers:
                    chunk.buffers[name].bind_to_storage_buffer(binding)
            dispatch(program, -(-chunk.n_fiblets // per_group), self._max_groups)

    def release(self) -> None:
        """Give the pipeline's own buffer back; twice is harmless."""
        self._status.release()
