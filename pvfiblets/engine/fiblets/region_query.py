"""Streamlines that pass a region, computed on the GPU from the drawn records.

The GPU classifies fiblets by their capsules and decodes the undecided ones, in float32 with a
margin (``shaders/fiblets/compute/query.comp``). Streamlines that the margin leaves open are settled from the same
records in float64 by :func:`pvfiblets.query.selection.passing.region_flags`: the answers are its own, bit for bit.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import ExitStack
from typing import TYPE_CHECKING, Any

import moderngl
import numpy as np
import numpy.typing as npt

from ...query.selection.point_flags import ALL, ANY, FIRST, LAST, Sampling, check_sampling
from ..errors import GPUMemoryError
from ..frame import FRAME_BLOCK, Array
from ..gl.bindings import ANSWER_STORAGE, BLOCKS
from ..gl.gl_version import version_of
from ..gl.moderngl_extras import GLExtras
from ..gl.passes import GROUP_SIZE, dispatch, work_groups
from ..gl.shaders import Programs
from ..regions.uniform_block import RegionBlock
from .data.chunks import Chunk, reserve_buffer, storage_buffer

if TYPE_CHECKING:
    from ...codec.fibletset import FibletSet
    from ...query.regions.region import Region

__all__ = ["ALL", "ANY", "FIRST", "LAST", "RegionQuery", "nearest_anchor"]

BATCH = 1 << 20  # fiblets asked at a time, so that no dispatch runs for long

_STAGES = 3

# As shaders/fiblets/compute/query.comp has them.
_INSIDE, _OUTSIDE, _UNSURE, _FIRST_INSIDE, _FIRST_UNSURE, _LAST_INSIDE, _LAST_UNSURE = (1 << k for k in range(7))

Bytes = npt.NDArray[np.uint8]


class RegionQuery:
    """Asks one set that is on the GPU."""

    def __init__(
        self,
        ctx: moderngl.Context,
        gl: GLExtras,
        programs: Programs,
        fiblets: FibletSet,  # the whole set, with its codes
        chunks: Sequence[Chunk],  # what of it is on the GPU
        max_groups: int,  # work groups per axis of a dispatch; 0 for as many as the driver allows
    ) -> None:
        self._ctx = ctx
        self._gl = gl
        self._programs = programs
        self._fiblets = fiblets
        self._chunks = chunks
        self._max_groups = max_groups
        self._block = RegionBlock(ctx, gl)
        self._frame: moderngl.Buffer | None = None
        self.unsure = 0  # how many streamlines of the last query were settled in float64

    @property
    def available(self) -> bool:
        """Whether the GPU can answer: the whole set is there, compute shaders, and large enough storage blocks."""
        if version_of(self._ctx) < 430 or sum(c.n_fiblets for c in self._chunks) < self._fiblets.n_fiblets:
            return False
        largest = self._gl.get_integer("GL_MAX_SHADER_STORAGE_BLOCK_SIZE")
        return all(buffer.size <= largest for chunk in self._chunks for buffer in chunk.buffers.values())

    def flags(self, features: Sequence[str], region: Region, sampling: Sampling = "lines") -> Bytes:
        """Return the answers for every streamline, by the GPU where it can, else by the CPU."""
        from ...query.selection.passing import region_flags

        lines = check_sampling(sampling) == "lines"
        fiblets = self._fiblets
        self.unsure = 0
        if not (self.available and self._prepare(region)):
            return region_flags(fiblets, region, sampling=sampling)
        marks = self._ask([*features, *self._block.features], lines)
        ids = np.arange(len(marks)) if fiblets.rank_to_id is None else np.asarray(fiblets.rank_to_id)
        found = np.zeros(fiblets.n_streamlines, np.uint8)
        found[ids] = _answers(marks)
        unsure = ids[_open(marks)]
        self.unsure = len(unsure)
        if len(unsure):
            found[unsure] = region_flags(fiblets, region, sampling=sampling, ids=unsure)[unsure]
        return found

    def _prepare(self, region: Region) -> bool:
        """Bring uniform blocks and fields up to date; False if there is no room for the fields."""
        fiblets = self._fiblets
        origin, scale = np.asarray(fiblets.origin, np.float64), np.asarray(fiblets.anchor_scale, np.float64)
        reference = nearest_anchor(region, origin, scale, 2**32 - 1 if fiblets.anchors_low is not None else 2**16 - 1)
        to_data = np.eye(4)
        to_data[:3, 3] = origin + scale * reference
        try:
            self._block.write(region, to_data)
        except GPUMemoryError:
            self._block.release()
            return False
        if self._frame is None:
            self._frame = self._ctx.buffer(bytes(FRAME_BLOCK.nbytes))
        FRAME_BLOCK.write(self._frame, reference=reference)
        self._frame.bind_to_uniform_block(BLOCKS["Frame"])
        return True

    def _ask(self, features: Sequence[str], lines: bool) -> Bytes:
        """``(n_ranks,)`` what the shader says of each streamline that has points."""
        program = self._programs.compute("fiblets/compute/query.comp", features)
        program["lines"] = int(lines)
        self._block.bind(program)
        marks = np.zeros(int(self._fiblets.pages[-1, 0]), np.uint8)
        for chunk in self._chunks:
            first, last = (int(self._fiblets.pages[page, 0]) for page in chunk.plan.pages)
            last = min(last + 1, len(marks))  # its last streamline may go on in the next chunk
            marks[first:last] |= self._ask_chunk(program, chunk, last - first)
        return marks

    def _ask_chunk(self, program: moderngl.ComputeShader, chunk: Chunk, ranks: int) -> Bytes:
        groups = self._max_groups or work_groups(self._ctx)
        batch = min(BATCH, chunk.n_fiblets)
        with ExitStack() as stack:
            answers = storage_buffer(self._ctx, np.zeros(ranks, np.uint8), "answers")
            stack.callback(answers.release)
            lists = reserve_buffer(self._ctx, 4 * (2 + 2 * batch), "lists of fiblets")
            stack.callback(lists.release)
            chunk.bind_storage()
            answers.bind_to_storage_buffer(ANSWER_STORAGE["answers"])
            lists.bind_to_storage_buffer(ANSWER_STORAGE["lists"])  # in the place of per-point values
            for first in range(0, chunk.n_fiblets, batch):
                size = min(batch, chunk.n_fiblets - first)
                program["batch_first"], program["batch_size"] = first, size
                lists.write(bytes(8))
                for stage in range(_STAGES):
                    # How many fiblets each stage left to the next.
                    count = np.frombuffer(lists.read(8), "<u4")[stage - 1] if stage else size
                    program["stage"] = stage
                    dispatch(program, -(-int(count) // GROUP_SIZE), groups)
                    self._ctx.memory_barrier(moderngl.ALL_BARRIER_BITS)
            return np.frombuffer(answers.read(ranks), np.uint8)

    @property
    def nbytes(self) -> int:
        """Bytes of GPU memory."""
        return self._block.nbytes + (0 if self._frame is None else self._frame.size)

    def release(self) -> None:
        """Release the GPU memory; twice is harmless."""
        self._block.release()
        if self._frame is not None:
            self._frame.release()
            self._frame = None


def nearest_anchor(region: Region, origin: Array, scale: Array, top: int) -> npt.NDArray[np.int64]:
    """Choose the anchor that rounding is made relative to: near the middle of a region, where answers turn."""
    low, high = np.asarray(region.bounds, np.float64).reshape(3, 2).T
    first, last = origin, origin + scale * top
    # Where a region has no end, the set's end stands for it; of an empty region any anchor serves.
    middle = np.clip(low, first, last) / 2 + np.clip(high, first, last) / 2
    steps = np.divide(middle - origin, scale, out=np.zeros(3), where=scale > 0.0)
    chosen: npt.NDArray[np.int64] = np.rint(np.clip(np.nan_to_num(steps), 0, top)).astype(np.int64)
    return chosen


def _answers(marks: Bytes) -> Bytes:
    """Answers as far as the marks settle them."""
    found: npt.NDArray[Any] = np.where(marks & _INSIDE, ANY, 0)
    found |= np.where(marks & (_OUTSIDE | _UNSURE), 0, ALL)
    found |= np.where(marks & _FIRST_INSIDE, FIRST, 0) | np.where(marks & _LAST_INSIDE, LAST, 0)
    return found.astype(np.uint8)


def _open(marks: Bytes) -> npt.NDArray[np.bool_]:
    """Return the answers that an unsure point could change."""
    both = _INSIDE | _OUTSIDE
    some = (marks & _UNSURE != 0) & (marks & both != both)
    opened: npt.NDArray[np.bool_] = some | (marks & (_FIRST_UNSURE | _LAST_UNSURE) != 0)
    return opened
