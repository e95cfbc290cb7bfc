"""A fiblet set on the GPU: pages grouped into chunks, each within the driver's limit for one storage buffer.

A chunk holds whole pages, so that the page-relative indices of the records stay good, and the anchor of the fiblet that
follows its last one, so that no shader looks into another chunk. What culling reads (anchors, reach) stays in buffers
apart from what decoding reads (words, codes).

Budget, bytes per fiblet: anchors 8, radius 2, words 12, codes 58 when full, and the visibility bits and draw lists
that the passes exchange, 2.9: 82.9, or 1.38 per point. Clusters of large sets take 4.2 bytes more, a streamline's
end vector 4.

What shaders count in 32 bits. Within a chunk: fiblets, bytes of codes, and points. A buffer of less than 2^31 bytes
holds less than 2^31 / 12 fiblets, and n fiblets of N points have at least n (N - 2) bytes of codes: less than
2^31 (1 + 2 / 12) points, which is below 2^32. Over all chunks: fiblets and streamlines only. Here all of them are
Python's or 64-bit integers.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import moderngl
import numpy as np
import numpy.typing as npt

from ....codec import layout
from ....codec.editing.point_arrays import colour_columns
from ...errors import EngineError, GPUMemoryError
from ...gl.bindings import BLOCKS, STORAGE
from ...gl.uniform_struct import Field, UniformStruct

if TYPE_CHECKING:
    from ....codec.fibletset import FibletSet

CHUNK_BLOCK = UniformStruct(
    "Chunk",
    Field("chunk_fiblets", "uint", "fiblets here"),
    Field("chunk_first", "uint", "number of the first among all"),
    Field("chunk_points_before", "uint", "points of its streamline in earlier chunks"),
    Field("chunk_first_rank", "uint", "rank of the first streamline here"),
    Field("chunk_pages", "uint", "pages here"),
    Field("chunk_end_words", "uint", "word of `bounds` where end vectors begin"),
    Field("value_bits", "uint", "of a stored per-point value; 32 of one that is no code"),
    Field("value_table", "uint", "words before the codes: what each code means"),
)


CLUSTER = 64
CLUSTER_BIAS, CLUSTER_STEP = 32768.0, 2.0  # fiblets of a cluster (`.clusters`), and what its box counts in

CLUSTERED = 1 << 21  # fiblets of a set that has clusters: fewer are tested one by one in as little time


@dataclass(frozen=True)
class ChunkPlan:
    """Consecutive whole pages that fit into buffers together."""

    pages: tuple[int, int]  # first page and one past the last
    fiblets: tuple[int, int]  # the same for fiblets, bytes of codes, and points, counted over the whole set
    codes: tuple[int, int]
    points: tuple[int, int]
    sizes: dict[str, int]  # bytes of each buffer that holds the records
    values: int  # bytes of the largest buffer that a per-point value may ask for

    @property
    def nbytes(self) -> int:
        """Bytes of GPU memory that :func:`pvfiblets.engine.fiblets.data.upload.upload_chunk` takes."""
        return sum(self.sizes.values()) + CHUNK_BLOCK.nbytes


_STORED = ("anchors", "decoding", "codes", "bounds", "pages", "anchors_low", "values")
BINDINGS = {**{name: STORAGE[name] for name in _STORED}, "starts": STORAGE["values"]}
"""Storage bindings of a chunk's buffers."""


@dataclass
class Chunk:
    """One chunk's buffers."""

    plan: ChunkPlan
    kinds: frozenset[int]
    buffers: dict[str, moderngl.Buffer] = field(default_factory=dict)
    _bound: dict[str, moderngl.Buffer] = field(default_factory=dict, repr=False)
    _binding: list[tuple[Callable[..., None], int]] = field(default_factory=list, repr=False)

    @property
    def n_fiblets(self) -> int:
        """Number of fiblets."""
        return self.plan.fiblets[1] - self.plan.fiblets[0]

    def bind_storage(self) -> None:
        """Bind its uniform block, and what there is of its buffers to their storage bindings."""
        if self._bound != self.buffers:
            self._look()
        for bind, binding in self._binding:
            bind(binding, 0, -1)

    def bind_block(self) -> None:
        """Bind its uniform block alone."""
        if self._bound != self.buffers:
            self._look()
        bind, binding = self._binding[0]
        bind(binding, 0, -1)

    def _look(self) -> None:
        """Find what to call: every pass of every picture does, once a chunk, so moderngl's own functions in C."""
        held = self._bound = dict(self.buffers)
        self._binding = [(held["chunk"].mglo.bind_to_uniform_block, BLOCKS["Chunk"])]
        self._binding += [(held[name].mglo.bind_to_storage_buffer, at) for name, at in BINDINGS.items() if name in held]

    def release(self) -> None:
        """Give the buffers back; twice is harmless."""
        for buffer in self.buffers.values():
            buffer.release()
        self.buffers.clear()
        self._bound.clear()
        self._binding.clear()


def plan_chunks(
    fiblets: FibletSet, max_buffer_bytes: int, max_fiblets: int | None = None, *, clustered: bool = False
) -> list[ChunkPlan]:
    """Group pages so that no buffer of a group is larger than a limit."""
    n_pages = len(fiblets.pages) - 1
    plans = []
    begin = 0
    while begin < n_pages:
        plan = _plan(fiblets, begin, begin + 1, clustered)
        if (largest := _largest(plan)) > max_buffer_bytes:
            raise EngineError(
                f"page {begin} of the fiblets needs a buffer of {largest} bytes; buffers are limited to "
                f"{max_buffer_bytes} here"
            )
        while plan.pages[1] < n_pages:
            longer = _plan(fiblets, begin, plan.pages[1] + 1, clustered)
            if _largest(longer) > max_buffer_bytes or longer.fiblets[1] - longer.fiblets[0] > (max_fiblets or math.inf):
                break
            plan = longer
        plans.append(plan)
        begin = plan.pages[1]
    return plans


def _plan(fiblets: FibletSet, begin: int, end: int, clustered: bool) -> ChunkPlan:
    """Plan pages ``begin`` to ``end`` as one chunk."""
    # Sums of NumPy's 32-bit integers would wrap; Python's do not.
    (rank, code, point), (last_rank, last_code, last_point) = (
        [int(value) for value in fiblets.pages[page]] for page in (begin, end)
    )
    first, last = (min(page * layout.PAGE, int(fiblets.n_fiblets)) for page in (begin, end))
    n, ranks = last - first, last_rank - rank + 1  # the last streamline may go on in the next page
    ids = 0 if fiblets.rank_to_id is None else -(-ranks // 4)
    sizes = {
        "anchors": 4 * layout.WORDS["anchors"] * (n + 1),
        "bounds": 4 * -(-n // 2) + 4 * ranks,
        "decoding": 4 * layout.WORDS["decoding"] * n,
        "codes": last_code - code + 4,  # four bytes are read at once
        "pages": 16 * (end - begin + ids),
    }
    if fiblets.anchors_low is not None:
        sizes["anchors_low"] = 6 * (n + 1)
    if clustered:
        sizes["clusters"] = 4 * (3 * -(-n // CLUSTER) + n)
    widest = max((values.drawn_bytes for values in fiblets.per_point.values()), default=0)
    tables = max((values.table_bytes for values in fiblets.per_point.values()), default=0)
    if any(name.endswith("[2]") and colour_columns(fiblets.per_point, name[:-3]) for name in fiblets.per_point):
        widest = 4
    return ChunkPlan(
        (begin, end),
        (first, last),
        (code, last_code),
        (point, last_point),
        {name: padded(size) for name, size in sizes.items()},
        padded(max(widest * (last_point - point + 1) + tables, 4 * (n + 1))),
    )


def _largest(plan: ChunkPlan) -> int:
    return max(plan.values, *plan.sizes.values())


def padded(size: int) -> int:
    """Bytes of a buffer for so many bytes: whole words and one more."""
    return size + 4 + (-size) % 4


def reserve_buffer(ctx: moderngl.Context, size: int, what: str) -> moderngl.Buffer:
    """Make a buffer of undefined content."""
    try:
        buffer = ctx.buffer(reserve=size)
    except (moderngl.Error, MemoryError) as error:
        raise GPUMemoryError(f"no GPU memory for {size} bytes of {what}: {error}") from error
    if (problem := ctx.error) != "GL_NO_ERROR":
        buffer.release()
        raise GPUMemoryError(f"no GPU memory for {size} bytes of {what}: {problem}")
    return buffer


def storage_buffer(ctx: moderngl.Context, data: npt.NDArray[Any] | bytes, what: str) -> moderngl.Buffer:
    """Make a buffer of some data, padded with zeros to whole words and one more."""
    raw = data if isinstance(data, bytes) else np.ascontiguousarray(data).reshape(-1).view(np.uint8)
    buffer = reserve_buffer(ctx, padded(len(raw)), what)
    if len(raw):
        buffer.write(raw)
    buffer.write(bytes(buffer.size - len(raw)), offset=len(raw))  # drivers leave old memory in it
    return buffer
