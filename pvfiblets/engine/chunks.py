"""A fiblet set on the GPU: pages grouped into chunks, each within the driver's limit for one storage buffer.

A chunk holds whole pages, so that the page-relative indices of the records stay good, and the anchor of the fiblet that
follows its last one, so that no shader looks into another chunk. What culling reads (anchors, reach) stays in buffers
apart from what decoding reads (words, codes).

Budget, bytes per fiblet: anchors 8, reach 2, words 12, codes 58 when full, and the eight bits by which the passes tell
each other what to draw: 81, or 1.35 per point.
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import moderngl
import numpy as np
import numpy.typing as npt

from ..codec import layout
from .errors import EngineError
from .passes import is_software

if TYPE_CHECKING:
    from ..codec.fibletset import FibletSet

__all__ = ["Chunk", "ChunkPlan", "plan_chunks", "storage_buffer", "upload_chunk"]


@dataclass(frozen=True)
class ChunkPlan:
    """Consecutive whole pages that fit into buffers together.

    Attributes
    ----------
    pages : tuple of int
        First page and one past the last.
    fiblets, codes, points : tuple of int
        The same for fiblets, bytes of codes, and points, counted over the whole set.
    """

    pages: tuple[int, int]
    fiblets: tuple[int, int]
    codes: tuple[int, int]
    points: tuple[int, int]

    @property
    def nbytes(self) -> int:
        """Bytes of GPU memory that :func:`upload_chunk` takes, but for the options."""
        n = self.fiblets[1] - self.fiblets[0]
        return n * 22 + self.codes[1] - self.codes[0] + 64


@dataclass
class Chunk:
    """One chunk's buffers."""

    plan: ChunkPlan
    kinds: frozenset[int]
    buffers: dict[str, moderngl.Buffer] = field(default_factory=dict)

    @property
    def n_fiblets(self) -> int:
        """Number of fiblets."""
        return self.plan.fiblets[1] - self.plan.fiblets[0]

    def release(self) -> None:
        """Give the buffers back; twice is harmless."""
        for buffer in self.buffers.values():
            buffer.release()
        self.buffers.clear()


def plan_chunks(fiblets: FibletSet, max_buffer_bytes: int) -> list[ChunkPlan]:
    """Group pages so that no buffer of a group is larger than a limit.

    Parameters
    ----------
    fiblets : FibletSet
    max_buffer_bytes : int
        The driver's limit for one storage block.

    Returns
    -------
    list of ChunkPlan
        Covering all pages in order.

    Raises
    ------
    EngineError
        If one page alone is too large.
    """
    pages = np.asarray(fiblets.pages, np.int64)
    n, n_pages = int(fiblets.n_fiblets), len(fiblets.pages) - 1
    firsts = np.minimum(np.arange(n_pages + 1) * layout.PAGE, n)
    value_bytes = max((a.codes.dtype.itemsize for a in fiblets.per_point.values()), default=0)

    def largest(begin: int, end: int) -> int:
        count = int(firsts[end] - firsts[begin]) + 1
        codes, points = (int(pages[end, column] - pages[begin, column]) for column in (1, 2))
        return max(count * 12, codes + 8, (points + 1) * value_bytes + 4)

    plans = []
    begin = 0
    while begin < n_pages:
        if largest(begin, begin + 1) > max_buffer_bytes:
            raise EngineError(
                f"page {begin} of the fiblets needs a buffer of {largest(begin, begin + 1)} bytes; buffers are "
                f"limited to {max_buffer_bytes} here"
            )
        end = begin + 1
        while end < n_pages and largest(begin, end + 1) <= max_buffer_bytes:
            end += 1
        plans.append(
            ChunkPlan(
                (begin, end),
                (int(firsts[begin]), int(firsts[end])),
                (int(pages[begin, 1]), int(pages[end, 1])),
                (int(pages[begin, 2]), int(pages[end, 2])),
            )
        )
        begin = end
    return plans


def storage_buffer(ctx: moderngl.Context, data: npt.NDArray[Any] | bytes, what: str) -> moderngl.Buffer:
    """Make a buffer of some data, padded to whole words and one more.

    Raises
    ------
    EngineError
        If memory does not suffice.
    """
    raw = data if isinstance(data, bytes) else np.ascontiguousarray(data).reshape(-1).view(np.uint8)
    size = len(raw) + 4 + (-len(raw)) % 4
    try:
        buffer = ctx.buffer(reserve=size)
    except (moderngl.Error, MemoryError) as error:
        raise EngineError(f"no GPU memory for {size} bytes of {what}: {error}") from error
    if (problem := ctx.error) != "GL_NO_ERROR":
        buffer.release()
        raise EngineError(f"no GPU memory for {size} bytes of {what}: {problem}")
    if len(raw):
        buffer.write(raw)
    return buffer


def rank_of(fiblets: FibletSet, index: int) -> int:
    """Rank of one fiblet's streamline among those that have points."""
    words = np.asarray(fiblets.anchors[index])
    return int(fiblets.pages[index >> layout.PAGE_BITS, 0]) + int(layout.unpack("rank", words))


def points_before(fiblets: FibletSet, index: int) -> int:
    """Points that a fiblet's streamline has before it."""
    if index >= fiblets.n_fiblets or layout.unpack("begin", np.asarray(fiblets.anchors[index])):
        return 0
    rank, low, high = rank_of(fiblets, index), -1, index
    while high - low > 1:  # ranks never fall: the streamline's first fiblet lies in (low, high]
        middle = (low + high) // 2
        low, high = (low, middle) if rank_of(fiblets, middle) == rank else (middle, high)

    def first_point(i: int) -> int:
        base = int(fiblets.pages[i >> layout.PAGE_BITS, 2])
        return base + int(layout.unpack("point", np.asarray(fiblets.decoding[i])))

    return first_point(index) - first_point(high)


def upload_chunk(ctx: moderngl.Context, fiblets: FibletSet, plan: ChunkPlan) -> Chunk:
    """Copy one chunk to the GPU.

    Raises
    ------
    EngineError
        If memory does not suffice; nothing of the chunk stays behind.
    """
    first, last = plan.fiblets
    n = last - first
    decoding = np.asarray(fiblets.decoding[first:last])
    kinds = frozenset(np.flatnonzero(np.bincount(layout.unpack("kind", decoding), minlength=4)).tolist())
    chunk = Chunk(plan, kinds)
    pages = np.zeros((plan.pages[1] - plan.pages[0], 4), np.uint32)
    pages[:, :3] = np.asarray(fiblets.pages[plan.pages[0] : plan.pages[1]]) - [0, plan.codes[0], plan.points[0]]
    n_pages, first_rank = len(pages), 0
    if (ids := fiblets.rank_to_id) is not None and n:
        first_rank, last_rank = rank_of(fiblets, first), rank_of(fiblets, last - 1)
        ranks = np.asarray(ids[first_rank : last_rank + 1]).astype(np.uint32)
        pages = np.concatenate([pages, np.resize(ranks, (-(-len(ranks) // 4), 4))])
    arrays: dict[str, Callable[[], npt.NDArray[Any]]] = {
        "anchors": lambda: _with_next(fiblets.anchors, first, last),
        "reach": lambda: np.asarray(fiblets.reach[first:last]),
        "decoding": lambda: decoding,
        "codes": lambda: np.concatenate([fiblets.codes[plan.codes[0] : plan.codes[1]], np.zeros(4, np.uint8)]),
        "pages": lambda: pages,
    }
    if (low := fiblets.anchors_low) is not None:
        arrays["anchors_low"] = lambda: _with_next(low, first, last)
    block = np.zeros(12, np.uint32)
    block[:3] = n, first, points_before(fiblets, first)
    block[4], block[6] = first_rank, n_pages
    with _all_or_nothing(chunk):
        for name, array in arrays.items():
            chunk.buffers[name] = storage_buffer(ctx, array(), name)
        chunk.buffers["chunk"] = ctx.buffer(block.tobytes())
    return chunk


@contextlib.contextmanager
def _all_or_nothing(chunk: Chunk) -> Iterator[None]:
    try:
        yield
    except BaseException:
        chunk.release()
        raise


def _with_next(array: npt.NDArray[Any], first: int, last: int) -> npt.NDArray[Any]:
    """Rows first..last inclusive; zeros stand for the row after the set's last."""
    rows = np.asarray(array[first : last + 1])
    missing = last + 1 - first - len(rows)
    return np.concatenate([rows, np.zeros((missing, rows.shape[1]), rows.dtype)]) if missing else rows


def available_memory(ctx: moderngl.Context) -> int | None:
    """Bytes that buffers can still take, where it can be known beforehand: software OpenGL on Linux."""
    table = Path("/proc/meminfo")
    if not is_software(ctx) or not table.is_file():
        return None
    for line in table.read_text(encoding="ascii").splitlines():
        if line.startswith("MemAvailable:"):
            return int(line.split()[1]) * 1024
    return None
