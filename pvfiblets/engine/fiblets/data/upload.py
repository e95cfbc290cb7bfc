"""Records on their way to the GPU, slice by slice: a mapped file is read once and never stands in memory as a whole."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import TYPE_CHECKING, Any

import moderngl
import numpy as np
import numpy.typing as npt

from ....codec import layout
from ....codec.files.archive import forget
from ....support.progress_bar import progress_bar
from ...errors import EngineError, GPUMemoryError
from .chunks import CHUNK_BLOCK, Chunk, ChunkPlan, reserve_buffer

if TYPE_CHECKING:
    from ....codec.fibletset import FibletSet
    from .memory_fit import Fitted, MemoryBudget

SLICE_BYTES = 1 << 24  # bytes that are copied at a time

Show = Callable[[int], object]
Array = npt.NDArray[Any]


def rows_of(array: Array, first: int, last: int) -> Iterator[Array]:
    """Yield rows of an array in slices of `SLICE_BYTES`; release each slice of a mapped array before the next."""
    rows = max(SLICE_BYTES // max(array[:1].nbytes, 1), 1)
    for at in range(first, last, rows):
        end = min(at + rows, last)
        yield np.asarray(array[at:end])
        forget(array, max(at - rows, first), end)  # the slice before ended within a page of the memory's


def fill_buffer(
    ctx: moderngl.Context, size: int, pieces: Iterable[Array], what: str, show: Show | None = None
) -> moderngl.Buffer:
    """Make a buffer of arrays that follow on each other."""
    buffer = reserve_buffer(ctx, size, what)
    at = 0
    try:
        for piece in pieces:
            if not piece.size:
                continue
            raw = np.ascontiguousarray(piece).reshape(-1).view(np.uint8)
            buffer.write(raw, offset=at)
            at += len(raw)
            if show is not None:
                show(len(raw))
    except BaseException:
        buffer.release()
        raise
    return buffer


def upload_chunk(ctx: moderngl.Context, fiblets: FibletSet, plan: ChunkPlan, show: Show | None = None) -> Chunk:
    """Copy one chunk to the GPU."""
    first, last = plan.fiblets
    n = last - first
    # Its last streamline may go on in the next chunk: one rank more than begins here.
    ranks = int(fiblets.pages[plan.pages[0], 0]), min(int(fiblets.pages[plan.pages[1], 0]) + 1, len(fiblets.ends))
    kinds = np.zeros(layout.SPLINE + 1, np.int64)
    arrays = {
        "anchors": _with_next(fiblets.anchors, first, last),
        "bounds": _bounds(fiblets, (first, last), ranks),
        "decoding": _counting(fiblets.decoding, first, last, kinds),
        "codes": _codes(fiblets, plan),
        "pages": _pages(fiblets, plan, ranks),
    }
    if (low := fiblets.anchors_low) is not None:
        arrays["anchors_low"] = _with_next(low, first, last)
    if "clusters" in plan.sizes:
        from .clusters import cluster_words

        arrays["clusters"] = cluster_words(fiblets, first, last)
    before = _points_before(fiblets, first)
    if max(before, last) >= 2**32:
        raise EngineError(f"fiblet {first} is {before} points into its streamline; shaders count less than 2^32")
    block = CHUNK_BLOCK.pack(
        chunk_fiblets=n,
        chunk_first=first,
        chunk_points_before=before,
        chunk_first_rank=ranks[0],
        chunk_pages=plan.pages[1] - plan.pages[0],
        chunk_end_words=-(-n // 2),
        value_bits=0,
        value_table=0,
    )
    chunk = Chunk(plan, frozenset())
    try:
        for name, pieces in arrays.items():
            chunk.buffers[name] = fill_buffer(ctx, plan.sizes[name], pieces, name, show)
        chunk.buffers["chunk"] = ctx.buffer(block)
    except BaseException:
        chunk.release()
        raise
    chunk.kinds = frozenset(np.flatnonzero(kinds).tolist())
    return chunk


def upload_fitting(
    ctx: moderngl.Context,
    fiblets: FibletSet,
    room: MemoryBudget,
    fit: str | None,
    chunks: list[Chunk],
    progress: bool,
    most: float = 1.0,
) -> Fitted:
    """Copy what fits, and say what that is."""
    fitted = room.fitted(fiblets, fit, most)
    while True:
        needed = sum(plan.nbytes for plan in fitted.plans)
        try:
            with progress_bar(progress, total=needed, unit="B", unit_scale=True, desc="to the GPU") as bar:
                for plan in fitted.plans:
                    chunks.append(upload_chunk(ctx, fitted.fiblets, plan, bar.update))  # noqa: PERF401 - kept one by one
        except GPUMemoryError:
            if fit != "sample":
                raise
        else:
            return fitted
        # A driver that did not say how much memory is free says now that it was less.
        release_chunks(chunks)
        fitted = room.fitted(fiblets, fit, fitted.share / 2.0)


def release_chunks(chunks: list[Chunk]) -> None:
    """Give chunks back and forget them; twice is harmless."""
    for chunk in chunks:
        chunk.release()
    chunks.clear()


def _counting(decoding: Array, first: int, last: int, kinds: npt.NDArray[np.int64]) -> Iterator[Array]:
    """Decoding words; which kinds of fiblets they are of is counted in passing."""
    for rows in rows_of(decoding, first, last):
        kinds += np.bincount(layout.coded_kind(rows), minlength=len(kinds))
        yield rows


def _codes(fiblets: FibletSet, plan: ChunkPlan) -> Iterator[Array]:
    yield from rows_of(fiblets.codes, *plan.codes)
    yield np.zeros(4, np.uint8)


def _pages(fiblets: FibletSet, plan: ChunkPlan, ranks: tuple[int, int]) -> Iterator[Array]:
    """Page table, relative to the chunk but for the ranks, and behind it the streamlines by rank."""
    table = np.zeros((plan.pages[1] - plan.pages[0], 4), np.uint32)
    table[:, :3] = np.asarray(fiblets.pages[slice(*plan.pages)]) - [0, plan.codes[0], plan.points[0]]
    yield table
    if fiblets.rank_to_id is not None:
        for ids in rows_of(fiblets.rank_to_id, *ranks):
            yield ids.astype(np.uint32)


def _bounds(fiblets: FibletSet, rows: tuple[int, int], ranks: tuple[int, int]) -> Iterator[Array]:
    """Radii, two to a word, and behind them the end vectors of these streamlines."""
    yield from rows_of(fiblets.reach, *rows)
    if (rows[1] - rows[0]) % 2:
        yield np.zeros(1, np.uint16)
    yield from rows_of(fiblets.ends, *ranks)


def _with_next(array: Array, first: int, last: int) -> Iterator[Array]:
    """Rows first..last inclusive; zeros stand for the row after the set's last."""
    yield from rows_of(array, first, min(last + 1, len(array)))
    if last == len(array):
        yield np.zeros((1, array.shape[1]), array.dtype)


def _rank_of(fiblets: FibletSet, index: int) -> int:
    """Rank of one fiblet's streamline among the streamlines with points."""
    words = np.asarray(fiblets.anchors[index])
    return int(fiblets.pages[index >> layout.PAGE_BITS, 0]) + int(layout.unpack("rank", words))


def _points_before(fiblets: FibletSet, index: int) -> int:
    """Points that a fiblet's streamline has before it."""
    if index >= fiblets.n_fiblets or layout.unpack("begin", np.asarray(fiblets.anchors[index])):
        return 0
    rank, low, high = _rank_of(fiblets, index), -1, index
    while high - low > 1:  # ranks never fall: the streamline's first fiblet lies in (low, high]
        middle = (low + high) // 2
        low, high = (low, middle) if _rank_of(fiblets, middle) == rank else (middle, high)

    def first_point(i: int) -> int:
        base = int(fiblets.pages[i >> layout.PAGE_BITS, 2])
        return base + int(layout.unpack("point", np.asarray(fiblets.decoding[i])))

    return first_point(index) - first_point(high)
