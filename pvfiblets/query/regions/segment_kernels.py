"""Compiled kernels: which parts of a segment lie in a region; see :mod:`.segments`."""

from __future__ import annotations

import math

import numba
import numpy as np

from ...codec.jit import kernel, parallel_kernel
from ...support.array_types import Bools, Float64s, Int32s, Int64s, UInt8s
from ..density.voxel_walk_kernels import walk
from .shape_kernels import unit
from .surface_kernels import segment_crossings, winding_number

_PLANE, _SLAB, _BOX, _SPHERE, _SURFACE, _LABELS = range(6)
_AND, _NOT = -1, -3
_BLOCK = 256
_NONE = (2.0, -1.0)


@kernel
def _at_least(a: float, b: float) -> tuple[float, float]:
    """The share of [0, 1] where ``a + t (b - a) >= 0``."""
    if a >= 0.0 and b >= 0.0:
        return 0.0, 1.0
    if a < 0.0 and b < 0.0:
        return _NONE
    t = a / (a - b)
    return (0.0, t) if a >= 0.0 else (t, 1.0)


@kernel
def _within_one(span: tuple[float, float], a: float, b: float) -> tuple[float, float]:
    """The share of a span where ``|a + t (b - a)| <= 1``."""
    low, high = _at_least(1.0 + a, 1.0 + b), _at_least(1.0 - a, 1.0 - b)
    return max(span[0], low[0], high[0]), min(span[1], low[1], high[1])


@kernel
def _in_ball(p: tuple[float, float, float], q: tuple[float, float, float]) -> tuple[float, float]:
    """The share of [0, 1] where ``|p + t (q - p)| <= 1``."""
    near, far = p[0] * p[0] + p[1] * p[1] + p[2] * p[2], q[0] * q[0] + q[1] * q[1] + q[2] * q[2]
    if near <= 1.0 and far <= 1.0:
        return 0.0, 1.0
    dx, dy, dz = q[0] - p[0], q[1] - p[1], q[2] - p[2]
    squares = dx * dx + dy * dy + dz * dz
    if not squares > 0.0:
        return _NONE
    # The nearer end loses less in the cross product, whose length is that of the perpendicular times the segment's.
    x, y, z = p if near <= far else q
    cx, cy, cz = y * dz - z * dy, z * dx - x * dz, x * dy - y * dx
    room = 1.0 - (cx * cx + cy * cy + cz * cz) / squares
    middle = -(p[0] * dx + p[1] * dy + p[2] * dz) / squares
    if near > 1.0 and far > 1.0 and not (room >= 0.0 and 0.0 < middle < 1.0):
        return _NONE
    half = math.sqrt(max(room, 0.0) / squares)
    begin = 0.0 if near <= 1.0 else min(max(middle - half, 0.0), 1.0)
    end = 1.0 if far <= 1.0 else min(max(middle + half, 0.0), 1.0)
    return begin, end


@kernel
def _convex_span(row: Float64s, p: tuple[float, float, float], q: tuple[float, float, float]) -> tuple[float, float]:
    """Return the span of a segment in a plane's half-space, slab, box or ball; closed, (2, -1) if nowhere."""
    a, b = unit(row, p[0], p[1], p[2]), unit(row, q[0], q[1], q[2])
    kind = row[0]
    if kind == _PLANE:
        return _at_least(a[2], b[2])
    if kind == _SPHERE:
        return _in_ball(a, b)
    span = _within_one((0.0, 1.0), a[2], b[2])
    if kind == _BOX:
        span = _within_one(_within_one(span, a[0], b[0]), a[1], b[1])
    return span if span[0] <= span[1] else _NONE


@kernel
def _holds(ops: Int32s, held: int) -> bool:
    """Whether an expression holds, from the bits of its leaves."""
    stack = 0  # of bits, the top in bit 0
    for word in ops:
        if word >= 0:
            stack = stack << 1 | (held >> int(word) & 1)
        elif word == _NOT:
            stack ^= 1
        else:
            top = stack & 1
            stack >>= 1
            stack = stack & (top | ~1) if word == _AND else stack | top
    return stack != 0


@parallel_kernel
def combine(ops: Int32s, rows: Float64s, places: Int64s, first: Int64s, spans: Float64s, a: Float64s, b: Float64s,
            together: float, out: UInt8s) -> None:  # fmt: skip
    """Flag segments with a part in a region (1), and with a part outside (2): ``out`` (m,) uint8."""
    n_leaves = len(rows)
    for block in numba.prange((len(out) + _BLOCK - 1) // _BLOCK):
        lows, highs, at = np.empty(n_leaves), np.empty(n_leaves), np.empty(n_leaves, np.int64)
        ts = np.empty(64)
        for k in range(block * _BLOCK, min((block + 1) * _BLOCK, len(out))):
            most = 2 * n_leaves
            for leaf in range(n_leaves):
                if places[leaf] >= 0:
                    most += 2 * (first[places[leaf], k + 1] - first[places[leaf], k])
            if most > len(ts):
                ts = np.empty(2 * most)
            n = 0
            p, q = (a[k, 0], a[k, 1], a[k, 2]), (b[k, 0], b[k, 1], b[k, 2])
            for leaf in range(n_leaves):
                place = places[leaf]
                if place < 0:
                    low, high = _convex_span(rows[leaf], p, q)
                    lows[leaf], highs[leaf] = low, high
                    for t in (low, high):
                        if 0.0 < t < 1.0:
                            ts[n] = t
                            n += 1
                    continue
                at[leaf] = first[place, k]
                for i in range(first[place, k], first[place, k + 1]):
                    for side in range(2):
                        if 0.0 < spans[i, side] < 1.0:
                            ts[n] = spans[i, side]
                            n += 1
            ts[:n].sort()
            found, now, i = 0, 0.0, 0
            while found != 3:
                # Between two boundaries, at their middle; then on the boundaries that are crossed at once.
                then = ts[i] if i < n else 1.0
                if then - now > together:
                    middle = 0.5 * now + 0.5 * then
                    held = _held(rows, places, first, spans, lows, highs, at, k, middle, middle)
                    found |= 1 if _holds(ops, held) else 2
                if i == n:
                    break
                now = then
                while i < n and ts[i] - now <= together:
                    now = ts[i]
                    i += 1
                held = _held(rows, places, first, spans, lows, highs, at, k, then, now)
                found |= 1 if _holds(ops, held) else 2
            out[k] = found


@kernel
def _held(rows: Float64s, places: Int64s, first: Int64s, spans: Float64s, lows: Float64s, highs: Float64s, at: Int64s,
          k: int, begin: float, end: float) -> int:  # fmt: skip
    """Bits of the leaves that hold some place from ``begin`` to ``end``, which rise from call to call."""
    # A place on the face between two voxels is in the one that comes later: no place is in both, and none is in
    # neither.
    held = 0
    for leaf in range(len(rows)):
        place = places[leaf]
        if place < 0:
            inside = lows[leaf] <= end and highs[leaf] >= begin
        else:
            stop = first[place, k + 1]
            labels = rows[leaf, 0] == _LABELS
            while at[leaf] < stop and (spans[at[leaf], 1] <= end if labels else spans[at[leaf], 1] < begin):
                at[leaf] += 1
            inside = at[leaf] < stop and spans[at[leaf], 0] <= end
        if inside:
            held |= 1 << leaf
    return held


@kernel
def _put(spans: Float64s, n: int, open_: bool, writes: bool, begin: float, end: float) -> int:
    """Add a part to the spans, or lengthen the last one if it is ``open_``; return how many there are then."""
    if not open_:
        if writes:
            spans[n, 0] = begin
        n += 1
    if writes:
        spans[n - 1, 1] = end
    return n


@parallel_kernel
def label_spans(mask: Bools, linear: Float64s, centre: Float64s, a: Float64s, b: Float64s, first: Int64s,
                spans: Float64s, writes: bool) -> None:  # fmt: skip
    """Shares of segments that lie in chosen voxels of ``mask`` (i, j, k), by `voxel_walk_kernels.walk`."""
    # Unless `writes`, only counted: `first[k + 1]` is the number of segment k. Otherwise written to `spans` from
    # `first[k]` on.
    shape = mask.shape
    flat = mask.reshape(-1)
    most, strides = shape[0] + shape[1] + shape[2] + 4, (shape[1] * shape[2], shape[2], 1)
    for block in numba.prange((len(a) + _BLOCK - 1) // _BLOCK):
        u, on, stops = np.empty((2, 3)), np.empty(most, np.int64), np.empty(most)
        for k in range(block * _BLOCK, min((block + 1) * _BLOCK, len(a))):
            for end in range(2):
                p = b[k] if end else a[k]
                x, y, z = p[0] - centre[0], p[1] - centre[1], p[2] - centre[2]
                for axis in range(3):
                    # Voxels' centres are at whole numbers here, their faces in the walk.
                    u[end, axis] = linear[axis, 0] * x + linear[axis, 1] * y + linear[axis, 2] * z + 0.5
            n, now = walk(u, 0, shape, strides, on, stops) if math.isfinite(u.sum()) else (0, 0.0)
            base = first[k] if writes else 0
            m, open_ = base, False
            for i in range(n):
                chosen = flat[on[i]]
                if chosen:
                    m = _put(spans, m, open_, writes, now, stops[i])
                open_, now = chosen, stops[i]
            if not writes:
                first[k + 1] = m


@parallel_kernel
def surface_spans(mesh: tuple[Float64s, Int64s, Int64s, Int64s, Float64s, Float64s, Float64s, int, int],
                  tree: tuple[Float64s, Int64s, Int64s], linear: Float64s, centre: Float64s, a: Float64s, b: Float64s,
                  first: Int64s, spans: Float64s, writes: bool) -> None:  # fmt: skip
    """Shares of segments that a closed mesh encloses; ``first``, ``spans`` and ``writes`` as in :func:`label_spans`."""
    # Between two triangles that it meets, a segment is where its middle is.
    points, triangles, cells, members, low, high, steps, nx, ny = mesh
    boxes, links, order = tree
    for block in numba.prange((len(a) + _BLOCK - 1) // _BLOCK):
        p, q, stack = np.empty(3), np.empty(3), np.empty(64, np.int64)
        ts = np.empty(64)
        for k in range(block * _BLOCK, min((block + 1) * _BLOCK, len(a))):
            for end in range(2):
                place, u = (b[k], q) if end else (a[k], p)
                x, y, z = place[0] - centre[0], place[1] - centre[1], place[2] - centre[2]
                for axis in range(3):
                    u[axis] = linear[axis, 0] * x + linear[axis, 1] * y + linear[axis, 2] * z
            n, ts = segment_crossings(points, triangles, boxes, links, order, p, q, stack, ts)
            ts[:n].sort()
            base = first[k] if writes else 0
            m, open_, now = base, False, 0.0
            for i in range(n + 1):
                then = ts[i] if i < n else 1.0
                if then <= now:
                    continue
                t = 0.5 * now + 0.5 * then
                x, y, z = p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1]), p[2] + t * (q[2] - p[2])
                inside = winding_number(points, triangles, cells, members, low, high, steps, nx, ny, x, y, z) != 0
                if inside:
                    m = _put(spans, m, open_, writes, now, then)
                open_, now = inside, then
            if not writes:
                first[k + 1] = m
