"""Lattice codes of many slots at once, in NumPy and in the arithmetic of `lattice_kernels`.

A slot may be split by halving, up to six times. All its parts of one size are coded together, with the parts of
other slots: a *part* is a stretch ``[a, b)`` of the points of a slot.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from ..lattice_limits import LATTICE_LIMIT, MAX_HALVINGS, RECORD_BYTES, TREE_DEPTH, TURNED_TOO_FAR
from ..layout import DIRECTION, LATTICE8, WIDE, WIDE_HEADER
from .capsule_arrays import capsules
from .direction_arrays import anchors_of
from .turn_arrays import Turning, excess

BATCH = 1024  # slots, or parts that are coded, at once
NONE = 1 << 30  # bytes, where no kind holds the steps

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]


@dataclass(frozen=True)
class Source:
    """The source of all parts: points in mm, their turns, and the anchor grid."""

    points: npt.NDArray[np.floating]
    origin: Array
    scale: Array
    top: float
    edge: float
    turning: Turning


class _Parts:
    """Stretches of points, ``counts (k,)`` from ``first (k,)`` on; ``leads``: another point follows in the streamline.

    Points ``(most, 3, k)`` stand in float64 and from the origin, anchors as a file holds them.
    """

    def __init__(self, source: Source, first: Ints, counts: Ints, leads: npt.NDArray[np.bool_]) -> None:
        rows = first + np.minimum(np.arange(int(counts.max()))[:, None], counts - 1)
        self.counts, self.leads = counts, leads
        self.true = np.ascontiguousarray(np.moveaxis(source.points[rows].astype(np.float64) - source.origin, 2, 1))
        self.anchors = anchors_of(self.true[0], source.scale, source.top)
        after = np.minimum(first + counts, len(source.points) - 1)
        relative = source.points[after].astype(np.float64).T - source.origin[:, None]
        self.following = anchors_of(relative, source.scale, source.top)
        self.units = np.moveaxis(source.turning.units[:, rows], 0, 1)
        self.allowed = source.turning.allowed[rows]
        begins = source.turning.first[first]
        np.minimum(self.allowed[0], begins, out=self.allowed[0], where=begins >= 0.0)

    def __getitem__(self, some: Any) -> _Parts:
        part = object.__new__(_Parts)
        part.counts, part.leads = self.counts[some], self.leads[some]
        most = int(part.counts.max(initial=1))
        part.true, part.units = self.true[:most, :, some], self.units[:most, :, some]
        part.anchors, part.following = self.anchors[:, some], self.following[:, some]
        part.allowed = self.allowed[:most, some]
        return part

    def levels(self, edge: Array) -> Array:
        """Lattice coordinates ``(most, 3, k)`` of all points, from the anchor."""
        found: Array = np.rint((self.true - self.anchors) / edge)
        found[0] = 0.0
        return found

    def turned(self, edge: Array) -> Array:
        """See `lattice_kernels._turned`."""
        drawn = self.anchors + edge * self.levels(edge)
        return excess(drawn, self.counts, self.following, self.leads, self.units, self.allowed)

    def halvings(self, edge: float) -> tuple[Ints, Array]:
        """Least halvings of the edge that turn no segment too far, and the excess; the least excess if none does."""
        k = len(self.counts)
        found, least = np.zeros(k, np.int64), np.full(k, np.inf)
        searched = np.arange(k)
        for halvings in range(MAX_HALVINGS + 1):
            parts = self if len(searched) == k else self[searched]
            over = parts.turned(np.full(len(searched), edge * 0.5**halvings))
            less = over < least[searched]
            found[searched[less]], least[searched[less]] = halvings, over[less]
            searched = searched[(over > 1.0) & (parts.counts > 1)]
            if not searched.size:
                break
        return found, least

    def boxes(self, edge: Array) -> tuple[Ints, Ints, Ints]:
        """Boxes of the lattice steps, ``lo`` and ``n`` ``(3, k)``; bytes per code + 8 * kind, or 0 where none holds."""
        k, most = len(self.counts), len(self.true)
        if most < 2:
            return np.zeros((3, k), np.int64), np.ones((3, k), np.int64), np.full(k, 1 + 8 * LATTICE8)
        inside = (np.arange(most)[:, None] < self.counts)[:, None]
        levels = np.where(inside, self.levels(edge), 0.0)
        held = np.abs(levels).max(axis=(0, 1)) <= LATTICE_LIMIT
        steps = np.diff(np.where(held, levels, 0.0), axis=0)
        lo = np.where(inside[1:], steps, np.inf).min(axis=0)
        high = np.where(inside[1:], steps, -np.inf).max(axis=0)
        single = self.counts < 2
        lo[:, single], high[:, single] = 0.0, 0.0
        n = high - lo + 1.0
        cells = n[0] * n[1] * n[2]
        width = np.select([cells <= 256.0, cells <= 65536.0, cells <= 16777216.0], [1, 2, 3], 4)
        narrow = (width <= 2) & (n[0] <= 256) & (n[1] <= 256) & ((lo >= -128.0) & (lo <= 127.0)).all(axis=0)
        found = np.where(held & (cells <= 4294967296.0), width + 8 * np.where(narrow, width, WIDE), 0)
        found[single] = 1 + 8 * LATTICE8
        return lo.astype(np.int64), n.astype(np.int64), found


def _sizes(found: Ints, counts: Ints) -> Ints:
    size = RECORD_BYTES + np.where(found >> 3 == WIDE, WIDE_HEADER, 0) + (counts - 1) * (found & 7)
    return np.where(found == 0, NONE, size)


def plan_lattices(
    source: Source, slots: Ints, leads: npt.NDArray[np.bool_]
) -> tuple[Ints, Ints, npt.NDArray[np.uint8]]:
    """Cheapest splits of slots ``(k, 2)`` by repeated halving."""
    plans = [_plan(source, slots[a : a + BATCH], leads[a : a + BATCH]) for a in range(0, len(slots), BATCH)]
    pieces, size, cuts = (np.concatenate(parts) for parts in zip(*plans, strict=True))
    return pieces, size, cuts


def _plan(
    source: Source, slots: Ints, leads: npt.NDArray[np.bool_]
) -> tuple[Ints, Ints, npt.NDArray[np.uint8]]:
    k, nodes = len(slots), 1 << (TREE_DEPTH + 1)
    low, high = np.zeros((nodes, k), np.int64), np.zeros((nodes, k), np.int64)
    size, bytes_, whole = (np.zeros((nodes, k), np.int64) for _ in range(3))
    high[1] = slots[:, 1]
    # Nodes of a heap: children of i are 2 i and 2 i + 1. A node that needs one byte a point is never split further.
    for depth in range(TREE_DEPTH + 1):
        level = slice(1 << depth, 2 << depth)
        whole[level][high[level] == low[level]] = 1
        node, slot = np.nonzero(high[level] > low[level])
        node += 1 << depth
        if not node.size:
            break
        for some in np.array_split(np.arange(len(node)), -(-len(node) // BATCH)):
            mine = node[some], slot[some]
            begin, stop = low[mine], high[mine]
            first, counts = slots[mine[1], 0] + begin, stop - begin
            parts = _Parts(source, first, counts, (stop < slots[mine[1], 1]) | leads[mine[1]])
            halvings, over = parts.halvings(source.edge)
            found = parts.boxes(source.edge * np.ldexp(1.0, -halvings))[2]
            cost = _sizes(found, counts)
            bytes_[mine] = cost - RECORD_BYTES
            cost += np.where(over > 1.0, TURNED_TOO_FAR, 0)
            cost += np.where((begin > 0) & (source.turning.first[first] < 0.0), TURNED_TOO_FAR, 0)
            size[mine] = cost
            kept = ((found >> 3 == LATTICE8) & (over <= 1.0)) | (depth == TREE_DEPTH)
            whole[mine] = kept
            split = mine[0][~kept], mine[1][~kept]
            middle = low[split] + (high[split] - low[split]) // 2
            left, right = (2 * split[0], split[1]), (2 * split[0] + 1, split[1])
            low[left], high[left], low[right], high[right] = low[split], middle, middle, high[split]
    for parent in range((nodes >> 1) - 1, 0, -1):
        children = size[2 * parent] + size[2 * parent + 1]
        unsettled = whole[parent] == 0
        whole[parent][unsettled & (size[parent] <= children)] = 1
        size[parent] = np.where(unsettled & (whole[parent] == 0), children, size[parent])
    reached = np.zeros((nodes, k), bool)
    reached[1] = True
    for parent in range(1, nodes >> 1):
        reached[2 * parent] = reached[2 * parent + 1] = reached[parent] & (whole[parent] == 0)
    slot, node = np.nonzero((reached & (whole == 1) & (high > low)).T)
    order = np.lexsort((low[node, slot], slot))
    slot, node = slot[order], node[order]
    pieces = np.bincount(slot, minlength=k)
    total = np.zeros(k, np.int64)
    np.add.at(total, slot, bytes_[node, slot])
    return pieces, total, (high - low)[node, slot].astype(np.uint8)


def encode_lattices(
    source: Source,
    slots: Ints,
    leads: npt.NDArray[np.bool_],
    plan: tuple[Ints, npt.NDArray[np.uint8]],
    end_scale: float,
    at: Ints,
    out: tuple[npt.NDArray[Any], ...],
) -> None:
    """Code slots as planned: ``plan`` is their number of pieces, and ``cuts``."""
    # `at` and `out` are as in `lattice_kernels.encode_lattices`.
    pieces, cuts = plan
    counts = cuts.astype(np.int64)
    slot = np.repeat(np.arange(len(slots)), pieces)
    starts = np.cumsum(pieces) - pieces
    before = np.cumsum(counts) - counts
    begin = before - before[starts][slot]
    fiblet = at[slot, 0] + np.arange(len(slot)) - starts[slot]
    more = (begin + counts < slots[slot, 1]) | leads[slot]
    first = slots[slot, 0] + begin
    widths = np.zeros(len(slot), np.int64)
    coded: list[Any] = []
    codes, shape, step, cap, kind, held_counts, code_start, point_start, radius, end_words = out
    for a in range(0, len(slot), BATCH):
        some = slice(a, a + BATCH)
        parts = _Parts(source, first[some], counts[some], more[some])
        rows = fiblet[some]
        stream = _encode(parts, source.edge, shape, step, cap, kind, rows)
        widths[some] = stream.bytes_of
        coded.append(stream)
        decoded = parts.anchors + stream.edge * stream.levels
        radius[rows], end_words[rows] = capsules(decoded, parts.counts, parts.leads, parts.following, end_scale)
    offset = np.cumsum(widths) - widths
    byte = at[slot, 1] + offset - offset[starts][slot]
    held_counts[fiblet], code_start[fiblet], point_start[fiblet] = counts, byte, first
    for a, stream in zip(range(0, len(slot), BATCH), coded, strict=True):
        stream.write(codes, byte[a : a + BATCH])


@dataclass(frozen=True)
class _Stream:
    """Codes of parts: boxes, and values ``(most - 1, k)`` of so many bytes each."""

    edge: Array
    levels: Array
    counts: Ints
    found: Ints
    lo: Ints
    n: Ints

    @property
    def bytes_of(self) -> Ints:
        """Bytes that each part takes."""
        return np.where(self.counts > 1, _sizes(self.found, self.counts) - RECORD_BYTES, 0)

    def write(self, codes: npt.NDArray[np.uint8], at: Ints) -> None:
        """Write all parts, each from its byte ``at (k,)`` on."""
        several = self.counts > 1
        wide = np.flatnonzero(several & (self.found >> 3 == WIDE))
        for place, numbers in enumerate([*self.lo, *self.n[:2]]):
            for byte in range(4):
                codes[at[wide] + 4 * place + byte] = (numbers[wide] >> (8 * byte)) & 0xFF
        cell = np.diff(self.levels, axis=0).astype(np.int64) - self.lo
        values = cell[:, 0] + self.n[0] * (cell[:, 1] + self.n[1] * cell[:, 2])
        inside = np.arange(1, len(self.levels))[:, None] < self.counts
        start = at + np.where(self.found >> 3 == WIDE, WIDE_HEADER, 0)
        width = self.found & 7
        places = start + np.arange(len(values))[:, None] * width
        for byte in range(4):
            written = inside & (byte < width)
            codes[places[written] + byte] = (values[written] >> (8 * byte)) & 0xFF


def _encode(
    parts: _Parts,
    h: float,
    shape: npt.NDArray[Any],
    step: npt.NDArray[Any],
    cap: npt.NDArray[Any],
    kind: npt.NDArray[Any],
    rows: Ints,
) -> _Stream:
    """Choose edges and boxes; see `lattice_kernels._encode`."""
    halvings, least = parts.halvings(h)
    _, _, found = parts.boxes(h * np.ldexp(1.0, -halvings))
    limit = np.maximum(1.0, least)
    finer = halvings + 1
    growing = np.flatnonzero((finer <= MAX_HALVINGS) & (parts.counts > 1))
    while growing.size:
        mine = parts[growing]
        edge = h * np.ldexp(1.0, -finer[growing])
        same = mine.boxes(edge)[2] == found[growing]
        growing, mine, edge = growing[same], mine[same], edge[same]
        if not growing.size:
            break
        fine = mine.turned(edge) <= limit[growing]
        halvings[growing[fine]] = finer[growing[fine]]
        finer[growing] += 1
        growing = growing[finer[growing] <= MAX_HALVINGS]
    halvings[parts.counts < 2] = 0
    edge = h * np.ldexp(1.0, -halvings)
    lo, n, _ = parts.boxes(edge)
    several, wide = parts.counts > 1, found >> 3 == WIDE
    narrow_shape = (lo[0] & 0xFF) | (lo[1] & 0xFF) << 8 | (lo[2] & 0xFF) << 16 | (n[0] - 1) << 24
    shape[rows] = np.where(several & ~wide, narrow_shape, 0) & 0xFFFFFFFF
    step[rows] = np.where(several, np.where(wide, found & 7, n[1] - 1), 0) & 0xFFFF
    cap[rows] = halvings
    kind[rows] = np.where(several, found >> 3, DIRECTION)
    levels = np.where((np.arange(len(parts.true))[:, None] < parts.counts)[:, None], parts.levels(edge), 0.0)
    return _Stream(edge, levels, parts.counts, found, lo, n)
