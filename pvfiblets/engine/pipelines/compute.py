"""The compute pipeline (OpenGL 4.3): decode in registers, rasterise into images with atomics.

=============  =================================================================================================
pass           what it does
=============  =================================================================================================
clear          empties depth and owners
cull           plans the drawing: which fiblets can show, which were seen last time, which need clipping
depth          draws depth with imageAtomicMin, first those seen last time; marks those that came nearest somewhere
own            draws these candidates again: where depth was kept, the least fiblet index owns the pixel
attributes     draws those with such pixels again and writes streamline, tangent and place of their pixels
=============  =================================================================================================

Last time's fiblets only decide the order: the picture is the same whatever was seen before. Fiblets inside all planes
of the view volume are drawn by programs without clipping; the others, if there are any, by two programs with it. The
caller's planes concern the second of these alone, and the cull pass.

The sources are in ``shaders/compute``; what a program includes is decided by features.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence

import moderngl
import numpy as np

from ...codec.layout import MAX_POINTS
from ..chunks import Chunk, storage_buffer
from ..errors import EngineError
from ..gbuffer import GBuffer
from ..passes import Passes, dispatch, is_software
from ..shaders import Programs
from ..view import MAX_CLIP_PLANES

__all__ = ["CLIPPING", "CLIP_PLANES", "CONSTANTS", "ComputePipeline"]

GROUP_SIZE = 64
GROUP_WORDS = 8
CONSTANTS = {"group_size": GROUP_SIZE, "group_words": GROUP_WORDS, "max_clip_planes": MAX_CLIP_PLANES}

CLIPPING = ("CLIPPING", "CLIPPING_DEPTH")
CLIP_PLANES = "CLIP_PLANES"

BINDINGS = {
    "anchors": 0,
    "decoding": 1,
    "codes": 2,
    "pages": 4,
    "reach": 2,
    "anchors_low": 6,
    "values": 7,
    "starts": 7,
}
"""Storage bindings of a chunk's buffers; 3 is the direction table, 5 the pipeline's own. OpenGL promises eight: those
that no pass reads together share a number."""

SOFTWARE_ITERATIONS = 60_000
"""What one invocation may loop under Mesa's software OpenGL, which leaves all loops of a shader for good after 65,535
iterations in sum and says nothing."""

WIDEST_IN_SOFTWARE = 100
"""Pixels of line width with which one segment of each fiblet stays within that."""

_DECODING = frozenset({"anchors", "decoding", "codes", "pages", "anchors_low"})
_READS = {
    "cull": frozenset({"anchors", "pages", "reach", "anchors_low"}),
    "depth": _DECODING,
    "own": _DECODING,
    "attributes": _DECODING | {"values", "starts"},
}


class ComputePipeline:
    """Draws chunks into a G-buffer.

    Parameters
    ----------
    ctx : moderngl.Context
    programs : Programs
    n_fiblets : int
        In all chunks.
    max_groups : int
        Work groups per axis of a dispatch.

    Attributes
    ----------
    buffers : dict of str to moderngl.Buffer
        ``marks``, eight bits per fiblet: see ``shaders/compute/marks.glsl``.
    """

    def __init__(self, ctx: moderngl.Context, programs: Programs, n_fiblets: int, max_groups: int) -> None:
        self._ctx = ctx
        self._programs = programs
        self._max_groups = max_groups
        self._software = is_software(ctx)
        self._shares = [(0, MAX_POINTS)]
        words = -(-n_fiblets // 32)
        self.buffers: dict[str, moderngl.Buffer] = {}
        self.buffers["marks"] = storage_buffer(ctx, np.zeros(words * 8, np.uint32), "marks")

    def draw(
        self,
        chunks: Sequence[Chunk],
        target: GBuffer,
        features: Sequence[str],
        passes: Passes,
        line_width: float,
        segment: float,
    ) -> None:
        """Draw all chunks; the ``Frame`` and ``Coding`` blocks and the direction table are bound already.

        Parameters
        ----------
        chunks : sequence of Chunk
        target : GBuffer
        features : sequence of str
            Keys of :data:`pvfiblets.engine.shaders.FEATURES`.
        passes : Passes
            Takes the times.
        line_width : float
            Pixels; counts with the feature ``WIDE_LINES``.
        segment : float
            Pixels that the longest segments in the picture take, roughly.

        Raises
        ------
        EngineError
            If lines are so wide that software OpenGL would lose parts of them.
        """
        if self._software:
            self._shares = _shares(line_width, segment)
        for index, texture in enumerate((target.depth, target.owner, target.ids, target.position)):
            texture.bind_to_image(index, read=True, write=True)
        self.buffers["marks"].bind_to_storage_buffer(5)
        plain = [feature for feature in features if feature not in (*CLIPPING, CLIP_PLANES)]
        planes = [CLIP_PLANES] if CLIP_PLANES in features else []
        # One program for each class of fiblets that cull.comp tells apart; without clipping there is only the first.
        variants = [plain, [*plain, CLIPPING[0]], [*plain, *CLIPPING, *planes]] if CLIPPING[0] in features else [plain]
        with passes.timed("clear"):
            dispatch(self._program("clear", plain), target.size[1], self._max_groups)
        with passes.timed("cull"):
            self._run("cull", [*plain, *planes], chunks, 32 * GROUP_SIZE)
        self._barrier()
        with passes.timed("depth"):
            for first in (0, len(CLIPPING) + 1):
                self._run_classes("depth", variants, chunks, first)
                self._barrier()
        with passes.timed("own"):
            self._run_classes("own", variants, chunks)
        self._barrier()
        with passes.timed("attributes"):
            self._run_classes("attributes", variants, chunks)
        self._ctx.memory_barrier(moderngl.ALL_BARRIER_BITS)

    def _program(self, stage: str, features: Sequence[str]) -> moderngl.ComputeShader:
        return self._programs.compute(f"compute/{stage}.comp", features)

    def _barrier(self) -> None:
        self._ctx.memory_barrier(moderngl.SHADER_STORAGE_BARRIER_BIT | moderngl.SHADER_IMAGE_ACCESS_BARRIER_BIT)

    def _run_classes(
        self, stage: str, variants: Sequence[Sequence[str]], chunks: Sequence[Chunk], first: int = 0
    ) -> None:
        for part, features in enumerate(variants, first):
            program = self._program(stage, features)
            program["part"] = part
            if "WIDE_LINES" not in features:
                self._run(stage, features, chunks, 32 * GROUP_WORDS)
                continue
            for share in self._shares:
                program["share"] = share
                self._run(stage, features, chunks, 32 * GROUP_WORDS)
                if len(self._shares) > 1:  # of two segments with the same depth the later one writes the pixel
                    self._barrier()

    def _run(self, stage: str, features: Sequence[str], chunks: Sequence[Chunk], per_group: int) -> None:
        program = self._program(stage, features)
        for chunk in chunks:
            chunk.buffers["chunk"].bind_to_uniform_block(2)
            for name in _READS[stage] & chunk.buffers.keys():
                chunk.buffers[name].bind_to_storage_buffer(BINDINGS[name])
            dispatch(program, -(-chunk.n_fiblets // per_group), self._max_groups)

    def release(self) -> None:
        """Give the pipeline's own buffers back; twice is harmless."""
        for buffer in self.buffers.values():
            buffer.release()
        self.buffers.clear()


def _shares(line_width: float, segment: float) -> list[tuple[int, int]]:
    """Cut the segments of a fiblet into ranges whose pixels software OpenGL draws before it leaves the loops.

    An invocation draws ``32 * GROUP_WORDS / GROUP_SIZE`` fiblets or fewer, and waits for its neighbours' segments.
    Over each pixel of a segment's longer side stand at most sqrt(2) widths, 1.2 on average.
    """
    if line_width == 1.0:
        return [(0, MAX_POINTS)]
    fiblets = 32 * GROUP_WORDS // GROUP_SIZE
    count = int(SOFTWARE_ITERATIONS / ((1.2 * line_width + 1.0) * fiblets * (segment + line_width)))
    if count < 1 and line_width > WIDEST_IN_SOFTWARE:
        raise EngineError(
            f"a line width of {line_width:g} pixels is more than software OpenGL draws whole; give at most "
            f"{WIDEST_IN_SOFTWARE}"
        )
    ranges = math.ceil(MAX_POINTS / max(count, 1))
    edges = [MAX_POINTS * i // ranges for i in range(ranges + 1)]
    return list(itertools.pairwise(edges))
