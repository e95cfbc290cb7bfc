"""Compiled kernels: splitting and coding of fiblets on the integer lattice. Same arithmetic as :mod:`.reference`."""

from __future__ import annotations

from typing import Any

import numba
import numpy as np

from .capsule_kernels import capsule
from .direction_kernels import quantise, take_points
from .jit import kernel, parallel_kernel
from .layout import DIRECTION, LATTICE8, MAX_POINTS, WIDE, WIDE_HEADER

__all__ = ["encode_lattices", "plan_lattices"]

RECORD_BYTES = 22
LATTICE_LIMIT = 2.0**30
MAX_HALVINGS = 15
TREE_DEPTH = 6
NONE = 1 << 30
_NODES = 1 << (TREE_DEPTH + 1)


@kernel
def _box(true: Any, a: int, b: int, anchor: Any, h: float, lo: Any, n: Any) -> int:
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
def _anchor(true: Any, i: int, scale: Any, top: float, anchor: Any) -> None:
    for axis in range(3):
        anchor[axis] = scale[axis] * quantise(true[i, axis], scale[axis], top)


@kernel
def _plan(true: Any, count: int, scale: Any, top: float, h: float, cuts: Any) -> Any:
    """Cheapest split by repeated halving: sizes of the pieces into ``cuts``; their number and their bytes of codes."""
    low = np.zeros(_NODES, np.int64)
    high = np.zeros(_NODES, np.int64)
    size = np.zeros(_NODES, np.int64)
    whole = np.zeros(_NODES, np.uint8)
    box = np.zeros(_NODES, np.int64)
    anchor, lo, n = np.empty(3), np.empty(3, np.int64), np.empty(3, np.int64)
    # Nodes of a heap: children of k are 2k and 2k + 1. A node that needs one byte a point is never split further.
    low[1], high[1] = 0, count
    last = 1
    for node in range(1, _NODES):
        if node > last:
            break
        if high[node] == low[node]:
            whole[node] = 1
            continue
        _anchor(true, low[node], scale, top, anchor)
        box[node] = _box(true, low[node], high[node], anchor, h, lo, n)
        size[node] = _size(box[node], high[node] - low[node])
        if box[node] >> 3 == LATTICE8 or 2 * node + 1 >= _NODES:
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
            total += size[node] - RECORD_BYTES
        else:
            stack[depth] = 2 * node + 1
            stack[depth + 1] = 2 * node
            depth += 2
    return pieces, total


@parallel_kernel
def plan_lattices(
    points: Any,
    origin: Any,
    slots: Any,
    wanted: Any,
    scale: Any,
    top: float,
    h: float,
    pieces: Any,
    size: Any,
    cuts: Any,
) -> None:
    """Plan the slots named in ``wanted``.

    Fills ``pieces (k,)`` and ``size (k,)`` (bytes of codes) and, where a slot's points stand in ``cuts (n_points,)``,
    the numbers of points of its pieces. See :func:`.reference.plan_lattice`.
    """
    for w in numba.prange(len(wanted)):
        first, n = slots[wanted[w], 0], slots[wanted[w], 1]
        true = np.empty((MAX_POINTS, 3))
        take_points(points, origin, first, n, true)
        mine = cuts[first : first + n]
        pieces[w], size[w] = _plan(true, n, scale, top, h, mine)


@kernel
def _put(codes: Any, at: int, value: int, width: int) -> None:
    for byte in range(width):
        codes[at + byte] = (value >> (8 * byte)) & 0xFF


@kernel
def _encode(true: Any, a: int, b: int, scale: Any, top: float, h: float, codes: Any, at: int, decoded: Any) -> Any:
    """Code one piece at ``codes[at:]``; returns kind, shape, step, cap and the number of bytes written."""
    anchor, lo, n = np.empty(3), np.empty(3, np.int64), np.empty(3, np.int64)
    _anchor(true, a, scale, top, anchor)
    for axis in range(3):
        decoded[a, axis] = anchor[axis]
    if b - a == 1:
        return DIRECTION, 0, 0, 0, 0
    found = _box(true, a, b, anchor, h, lo, n)
    halvings = 0
    while halvings < MAX_HALVINGS:
        if _box(true, a, b, anchor, h * 0.5 ** (halvings + 1), lo, n) != found:
            break
        halvings += 1
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
def encode_lattices(
    points: Any,
    origin: Any,
    slots: Any,
    wanted: Any,
    scale: Any,
    top: float,
    h: float,
    end_scale: float,
    cuts: Any,
    end: Any,
    at: Any,
    out: Any,
) -> None:
    """Code the slots named in ``wanted`` as planned.

    ``at`` is ``(k, 2)``: first fiblet and first code byte of each slot in the arrays of ``out``: ``codes``, ``shape``,
    ``step``, ``cap``, ``kind``, ``count``, ``code_start``, ``point_start``, ``radius`` and ``end_words``, one row a
    fiblet.
    """
    codes, shape, step, cap, kind, counts, code_start, point_start, radius, end_words = out
    for w in numba.prange(len(wanted)):
        slot = wanted[w]
        first, n = slots[slot, 0], slots[slot, 1]
        more = 0 if end[slot] else 1
        true = np.empty((MAX_POINTS + 1, 3))
        decoded = np.empty((MAX_POINTS + 1, 3))
        take_points(points, origin, first, n + more, true)
        following = np.empty(3)
        fiblet, byte = at[w, 0], at[w, 1]
        a = 0
        while a < n:
            b = a + cuts[first + fiblet - at[w, 0]]
            kind[fiblet], shape[fiblet], step[fiblet], cap[fiblet], used = _encode(
                true, a, b, scale, top, h, codes, byte, decoded
            )
            counts[fiblet] = b - a
            code_start[fiblet] = byte
            point_start[fiblet] = first + a
            ends = b == n + more
            if not ends:
                _anchor(true, b, scale, top, following)
            radius[fiblet], end_words[fiblet] = capsule(decoded, a, b, ends, following, end_scale)
            fiblet += 1
            byte += used
            a = b
