"""Compiled kernels: splitting and coding of fiblets on the integer lattice."""

from __future__ import annotations

import math

import numba
import numpy as np

from ...support.array_types import Float64s, Int64s, UInt8s, UInt16s, UInt32s
from ..jit import kernel, parallel_kernel
from ..lattice_limits import LATTICE_LIMIT, MAX_HALVINGS, RECORD_BYTES, TREE_DEPTH, TURNED_TOO_FAR
from ..layout import DIRECTION, LATTICE8, MAX_POINTS, WIDE, WIDE_HEADER
from .capsule_kernels import capsule
from .direction_kernels import follows, quantise, take_points
from .turn_kernels import excess, may_turn

NONE = 1 << 30
_NODES = 1 << (TREE_DEPTH + 1)


@kernel
def _box(true: Float64s, a: int, b: int, anchor: Float64s, h: float, lo: Int64s, n: Int64s) -> int:
    """Box of the lattice steps of ``true[a:b]``, into ``lo`` and ``n``; bytes per code + 8 * kind, or 0 if none."""
    for axis in range(3):
        lo[axis] = 0
        n[axis] = 1
    if b - a < 2:
        return 1 + 8 * LATTICE8
    high = np.empty(3, np.int64)
    for axis in range(3):
        before = 0
        for i in range(a + 1, b):
            k = float(np.rint((true[i, axis] - anchor[axis]) / h))
            if abs(k) > LATTICE_LIMIT:
                return 0
            delta = int(k) - before
            before = int(k)
            if i == a + 1:
                lo[axis] = delta
                high[axis] = delta
            else:
                lo[axis] = min(lo[axis], delta)
                high[axis] = max(high[axis], delta)
        n[axis] = high[axis] - lo[axis] + 1
    cells = float(n[0]) * float(n[1]) * float(n[2])
    if cells > 4294967296.0:
        return 0
    width = 4
    if cells <= 256.0:
        width = 1
    elif cells <= 65536.0:
        width = 2
    elif cells <= 16777216.0:
        width = 3
    narrow = width <= 2 and n[0] <= 256 and n[1] <= 256
    for axis in range(3):
        narrow = narrow and lo[axis] >= -128 and lo[axis] <= 127
    return width + 8 * (width if narrow else WIDE)


@kernel
def _size(found: int, count: int) -> int:
    if found == 0:
        return NONE
    return RECORD_BYTES + (WIDE_HEADER if found >> 3 == WIDE else 0) + (count - 1) * (found & 7)


@kernel
def _anchor(true: Float64s, i: int, scale: Float64s, top: float, anchor: Float64s) -> None:
    for axis in range(3):
        anchor[axis] = scale[axis] * quantise(true[i, axis], scale[axis], top)


@kernel
def _turned(true: Float64s, a: int, b: int, edge: float, turns: tuple[Float64s, Float64s, Float64s, bool]) -> float:
    """:func:`.turn_kernels.excess` of ``true[a:b]`` on a lattice of this edge about the anchor in ``drawn[a]``."""
    units, drawn, following, leads = turns
    for axis in range(3):
        for i in range(a + 1, b):
            drawn[i, axis] = drawn[a, axis] + edge * np.rint((true[i, axis] - drawn[a, axis]) / edge)
    return excess(units, a, b, drawn, following, leads)


@kernel
def _halvings(
    true: Float64s, a: int, b: int, h: float, turns: tuple[Float64s, Float64s, Float64s, bool]
) -> tuple[int, float]:
    """Least halvings of the edge that turn no segment too far, and the excess; the least excess if none does."""
    found, least = 0, math.inf
    for halvings in range(MAX_HALVINGS + 1):
        over = _turned(true, a, b, h * 0.5**halvings, turns)
        if over < least:
            found, least = halvings, over
        if over <= 1.0 or b - a < 2:
            break
    return found, least


@kernel
def _about(
    true: Float64s, a: int, b: int, total: int, scale: Float64s, top: float, drawn: Float64s, following: Float64s
) -> bool:
    """Anchors of ``true[a:b]`` and of what follows, into ``drawn[a]`` and ``following``; whether anything does."""
    _anchor(true, a, scale, top, drawn[a])
    if b < total:
        _anchor(true, b, scale, top, following)
    return b < total


@kernel
def _plan(
    true: Float64s, count: int, total: int, scale: Float64s, top: float, h: float, units: Float64s, cuts: UInt8s
) -> tuple[int, int]:
    """Cheapest split by repeated halving: sizes of the pieces into ``cuts``; their number and their bytes of codes."""
    low = np.zeros(_NODES, np.int64)
    high = np.zeros(_NODES, np.int64)
    size = np.zeros(_NODES, np.int64)
    whole = np.zeros(_NODES, np.uint8)
    box = np.zeros(_NODES, np.int64)
    lo, n = np.empty(3, np.int64), np.empty(3, np.int64)
    drawn, following = np.empty((MAX_POINTS, 3)), np.empty(3)
    # Nodes of a heap: children of k are 2k and 2k + 1. A node that needs one byte a point is never split further.
    low[1], high[1] = 0, count
    last = 1
    for node in range(1, _NODES):
        if node > last:
            break
        if high[node] == low[node]:
            whole[node] = 1
            continue
        leads = _about(true, low[node], high[node], total, scale, top, drawn, following)
        halvings, over = _halvings(true, low[node], high[node], h, (units, drawn, following, leads))
        box[node] = _box(true, low[node], high[node], drawn[low[node]], h * 0.5**halvings, lo, n)
        size[node] = _size(box[node], high[node] - low[node])
        if over > 1.0:
            size[node] += TURNED_TOO_FAR
        if low[node] > 0 and units[low[node], 4] < 0.0:
            size[node] += TURNED_TOO_FAR
        if (box[node] >> 3 == LATTICE8 and over <= 1.0) or 2 * node + 1 >= _NODES:
            whole[node] = 1
            continue
        middle = low[node] + (high[node] - low[node]) // 2
        low[2 * node], high[2 * node] = low[node], middle
        low[2 * node + 1], high[2 * node + 1] = middle, high[node]
        last = 2 * node + 1
    for node in range(last, 0, -1):
        if whole[node] == 0 and 2 * node + 1 < _NODES and high[node] > low[node]:
            split = size[2 * node] + size[2 * node + 1]
            if size[node] <= split:
                whole[node] = 1
            else:
                size[node] = split
    stack = np.empty(2 * TREE_DEPTH + 2, np.int64)
    stack[0] = 1
    depth = 1
    pieces = 0
    total = 0
    while depth > 0:
        depth -= 1
        node = stack[depth]
        if high[node] == low[node]:
            continue
        if whole[node]:
            cuts[pieces] = high[node] - low[node]
            pieces += 1
            total += _size(box[node], high[node] - low[node]) - RECORD_BYTES
        else:
            stack[depth] = 2 * node + 1
            stack[depth + 1] = 2 * node
            depth += 2
    return pieces, total


@parallel_kernel
def plan_lattices(points: Float64s, origin: Float64s, slots: Int64s, wanted: Int64s, end: UInt8s, scale: Float64s,
                  top: float, h: float, bound: tuple[float, float, float], pieces: Int64s, size: Int64s,
                  cuts: UInt8s) -> None:  # fmt: skip
    """Plan the slots named in ``wanted``."""
    # Fills `pieces (k,)` and `size (k,)` (bytes of codes) and, where a slot's points stand in `cuts (n_points,)`, the
    # numbers of points of its pieces.
    for w in numba.prange(len(wanted)):
        slot = wanted[w]
        first, n = slots[slot, 0], slots[slot, 1]
        total = n if end[slot] else n + 1
        true, units = np.empty((MAX_POINTS + 1, 3)), np.empty((MAX_POINTS, 5))
        take_points(points, origin, first, total, true)
        may_turn(points, first, n, follows(slots, end, slot), bound, units)
        mine = cuts[first : first + n]
        pieces[w], size[w] = _plan(true, n, total, scale, top, h, units, mine)


@kernel
def _put(codes: UInt8s, at: int, value: int, width: int) -> None:
    for byte in range(width):
        codes[at + byte] = (value >> (8 * byte)) & 0xFF


@kernel
def _encode(
    true: Float64s, a: int, b: int, h: float, codes: UInt8s, at: int, turns: tuple[Float64s, Float64s, Float64s, bool]
) -> tuple[int, ...]:
    """Code one piece at ``codes[at:]``; returns kind, shape, step, cap and the number of bytes written."""
    # Its anchor stands in the second of `turns`, where its other points are filled in; the edge is halved further than
    # directions ask for as long as that costs no byte.
    if b - a == 1:
        return DIRECTION, 0, 0, 0, 0
    decoded = turns[1]
    anchor, lo, n = decoded[a], np.empty(3, np.int64), np.empty(3, np.int64)
    halvings, least = _halvings(true, a, b, h, turns)
    found = _box(true, a, b, anchor, h * 0.5**halvings, lo, n)
    for finer in range(halvings + 1, MAX_HALVINGS + 1):
        if _box(true, a, b, anchor, h * 0.5**finer, lo, n) != found:
            break
        if _turned(true, a, b, h * 0.5**finer, turns) <= max(1.0, least):
            halvings = finer
    edge = h * 0.5**halvings
    _box(true, a, b, anchor, edge, lo, n)
    kind, width = found >> 3, found & 7
    start = at
    if kind == WIDE:
        for axis in range(3):
            _put(codes, at + 4 * axis, lo[axis], 4)
        _put(codes, at + 12, n[0], 4)
        _put(codes, at + 16, n[1], 4)
        at += WIDE_HEADER
        shape, step = 0, width
    else:
        shape = (lo[0] & 0xFF) | (lo[1] & 0xFF) << 8 | (lo[2] & 0xFF) << 16 | (n[0] - 1) << 24
        step = n[1] - 1
    before = np.zeros(3, np.int64)
    cell = np.empty(3, np.int64)
    for i in range(a + 1, b):
        for axis in range(3):
            k = int(np.rint((true[i, axis] - anchor[axis]) / edge))
            cell[axis] = k - before[axis] - lo[axis]
            before[axis] = k
            decoded[i, axis] = anchor[axis] + edge * k
        _put(codes, at, cell[0] + n[0] * (cell[1] + n[1] * cell[2]), width)
        at += width
    return kind, shape, step, halvings, at - start


@parallel_kernel
def encode_lattices(points: Float64s, origin: Float64s, slots: Int64s, wanted: Int64s, scale: Float64s, top: float,
                    h: float, bound: tuple[float, float, float], end_scale: float, cuts: UInt8s, end: UInt8s,
                    at: Int64s,
                    out: tuple[UInt8s, UInt32s, UInt16s, UInt8s, UInt8s, Int64s, Int64s, Int64s, Float64s, UInt32s],
) -> None:  # fmt: skip
    """Code the slots named in ``wanted`` as planned."""
    # `at` is `(k, 2)`: first fiblet and first code byte of each slot in the arrays of `out`: `codes`, `shape`, `step`,
    # `cap`, `kind`, `count`, `code_start`, `point_start`, `radius` and `end_words`, one row a fiblet.
    codes, shape, step, cap, kind, counts, code_start, point_start, radius, end_words = out
    for w in numba.prange(len(wanted)):
        slot = wanted[w]
        first, n = slots[slot, 0], slots[slot, 1]
        more = 0 if end[slot] else 1
        true = np.empty((MAX_POINTS + 1, 3))
        decoded, units, following = np.empty((MAX_POINTS, 3)), np.empty((MAX_POINTS, 5)), np.empty(3)
        take_points(points, origin, first, n + more, true)
        may_turn(points, first, n, follows(slots, end, slot), bound, units)
        fiblet, byte = at[w, 0], at[w, 1]
        a = 0
        while a < n:
            b = a + cuts[first + fiblet - at[w, 0]]
            leads = _about(true, a, b, n + more, scale, top, decoded, following)
            kind[fiblet], shape[fiblet], step[fiblet], cap[fiblet], used = _encode(
                true, a, b, h, codes, byte, (units, decoded, following, leads)
            )
            counts[fiblet] = b - a
            code_start[fiblet] = byte
            point_start[fiblet] = first + a
            radius[fiblet], end_words[fiblet] = capsule(decoded, a, b, not leads, following, end_scale)
            fiblet += 1
            byte += used
            a = b
