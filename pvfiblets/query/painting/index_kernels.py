"""Compiled kernels: a spatial index over fiblets; see :mod:`.fiblet_index`.

A leaf is `LEAF` fiblets and one capsule that holds theirs: about the chord between the means of their chords' ends. By
convexity, each chord lies within the larger of its two ends' distances from it.
"""

from __future__ import annotations

import math
from typing import Any

import numba
import numpy as np

from ...codec.capsule_kernels import end_part
from ...codec.jit import kernel, parallel_kernel
from ...codec.layout import PAGE_BITS

__all__ = ["LEAF", "capsules", "leaves", "near_fiblets", "near_leaves", "sort_once", "sort_parts"]

LEAF = 32
BLOCK = 1024


@kernel
def _anchor(anchors: Any, low: Any, fine: bool, f: int, axis: int) -> float:
    word = anchors[f, axis // 2]
    q = float((word >> 16) & 0xFFFF) if axis == 1 else float(word & 0xFFFF)
    return q * 65536.0 + float(low[f, axis]) if fine else q


@kernel
def _capsule(
    f: int, anchors: Any, low: Any, fine: bool, ends: Any, bases: Any, origin: Any, scale: Any, end_scale: float,
    out: Any,
) -> None:  # fmt: skip
    """Ends of the chord of fiblet `f`, mm: ``out`` (6,)."""
    rank = bases[f >> PAGE_BITS] + ((anchors[f, 1] >> 16) & 0x3FFF)
    for axis in range(3):
        a = scale[axis] * _anchor(anchors, low, fine, f, axis)
        if anchors[f, 1] >> 31 or f + 1 >= len(anchors):
            b = a + end_scale * (end_part(np.int64(ends[rank]), axis) if rank < len(ends) else 0)
        else:
            b = scale[axis] * _anchor(anchors, low, fine, f + 1, axis)
        out[axis], out[3 + axis] = a + origin[axis], b + origin[axis]


@parallel_kernel
def capsules(
    first: int, anchors: Any, low: Any, fine: bool, ends: Any, bases: Any, origin: Any, scale: Any, end_scale: float,
    out: Any,
) -> None:  # fmt: skip
    """Chords of consecutive fiblets from `first` on, ``out`` (n, 6) float32 mm, all turned to one half of space."""
    for block in numba.prange((len(out) + BLOCK - 1) // BLOCK):
        c = np.empty(6)
        for k in range(block * BLOCK, min((block + 1) * BLOCK, len(out))):
            _capsule(first + k, anchors, low, fine, ends, bases, origin, scale, end_scale, c)
            turned = (c[3] - c[0]) + 0.37 * (c[4] - c[1]) + 0.11 * (c[5] - c[2]) < 0.0
            for axis in range(3):
                a, b = c[axis], c[3 + axis]
                out[k, axis], out[k, 3 + axis] = (b, a) if turned else (a, b)


@kernel
def _widest(keys: Any, lo: int, hi: int) -> int:
    best, widest = 0, -1.0
    for d in range(6):
        low, high = keys[lo, d], keys[lo, d]
        for i in range(lo + 1, hi):
            low, high = min(low, keys[i, d]), max(high, keys[i, d])
        if high - low > widest:
            best, widest = d, high - low
    return best


@kernel
def _swap(keys: Any, order: Any, i: int, j: int) -> None:
    for d in range(6):
        keys[i, d], keys[j, d] = keys[j, d], keys[i, d]
    order[i], order[j] = order[j], order[i]


@kernel
def _split(keys: Any, order: Any, lo: int, hi: int) -> int:
    """Part rows ``lo`` to ``hi`` at the median of their widest column, at a multiple of a leaf; where that is."""
    middle = lo + LEAF * (((hi - lo + LEAF - 1) // LEAF + 1) // 2)
    d = _widest(keys, lo, hi)
    a, b = lo, hi - 1
    while a < b:  # quickselect (Hoare 1961)
        pivot = keys[(a + b) // 2, d]
        i, j = a, b
        while i <= j:
            while keys[i, d] < pivot:
                i += 1
            while keys[j, d] > pivot:
                j -= 1
            if i <= j:
                _swap(keys, order, i, j)
                i += 1
                j -= 1
        if middle <= j:
            b = j
        elif middle >= i:
            a = i
        else:
            break
    return middle


@parallel_kernel
def sort_once(keys: Any, order: Any, parts: Any, middles: Any) -> None:
    """Part each of some ranges of rows ``parts (n, 2)`` in two; ``middles (n,)`` is filled."""
    for p in numba.prange(len(parts)):
        lo, hi = parts[p, 0], parts[p, 1]
        middles[p] = _split(keys, order, lo, hi) if hi - lo > LEAF else hi


@parallel_kernel
def sort_parts(keys: Any, order: Any, parts: Any) -> None:
    """Part ranges of rows until none is larger than a leaf."""
    for p in numba.prange(len(parts)):
        stack = np.empty((128, 2), np.int64)
        stack[0, 0], stack[0, 1] = parts[p, 0], parts[p, 1]
        depth = 1
        while depth:
            depth -= 1
            lo, hi = stack[depth, 0], stack[depth, 1]
            if hi - lo <= LEAF:
                continue
            middle = _split(keys, order, lo, hi)
            stack[depth, 0], stack[depth, 1] = lo, middle
            stack[depth + 1, 0], stack[depth + 1, 1] = middle, hi
            depth += 2


@parallel_kernel
def leaves(keys: Any, order: Any, reach: Any, first: int, unit: float, slack: float, out: Any) -> None:
    """Capsule of each leaf: ``out (n_leaves, 7)`` float32, ends and radius, mm; ``reach`` is of the whole set."""
    for k in numba.prange(len(out)):
        lo, hi = k * LEAF, min((k + 1) * LEAF, len(keys))
        for d in range(6):
            total = 0.0
            for i in range(lo, hi):
                total += keys[i, d]
            out[k, d] = total / (hi - lo)
        radius = 0.0
        for i in range(lo, hi):
            a, b = 0.0, 0.0
            for d in range(3):
                a += (float(keys[i, d]) - out[k, d]) ** 2
                b += (float(keys[i, 3 + d]) - out[k, 3 + d]) ** 2
            radius = max(radius, math.sqrt(max(a, b)) + unit * reach[first + order[i]])
        out[k, 6] = np.float32(radius * (1.0 + 1e-6) + slack)


@kernel
def _meets(c: Any, reach: Any, boxes: Any) -> bool:
    """Whether a segment ``c (6,)`` in voxels, widened by ``reach (3,)``, meets one of the boxes ``(n, 6)``.

    The first box holds all others.
    """
    for k in range(len(boxes)):
        enter, leave = 0.0, 1.0
        for axis in range(3):
            low, high = boxes[k, axis] - reach[axis], boxes[k, 3 + axis] + reach[axis]
            a, d = c[axis], c[3 + axis] - c[axis]
            if d == 0.0:
                if a < low or a > high:
                    leave = -1.0
                continue
            s, t = (low - a) / d, (high - a) / d
            enter, leave = max(enter, min(s, t)), min(leave, max(s, t))
        if enter <= leave:
            if k or len(boxes) == 1:
                return True
        elif k == 0:
            return False
    return False


@kernel
def _to_voxels(c: Any, radius: float, linear: Any, corner: Any, rows: Any, out: Any, reach: Any) -> None:
    for axis in range(3):
        a, b = 0.0, 0.0
        for j in range(3):
            a += linear[axis, j] * (c[j] - corner[j])
            b += linear[axis, j] * (c[3 + j] - corner[j])
        out[axis], out[3 + axis] = a, b
        reach[axis] = radius * rows[axis] + 1e-9 * (1.0 + abs(a) + abs(b))


@parallel_kernel
def near_leaves(held: Any, linear: Any, corner: Any, rows: Any, boxes: Any, found: Any) -> None:
    """Leaves whose capsules meet boxes of voxels: ``found (n_leaves,)`` bool.

    ``linear (3, 3)`` and ``corner (3,)`` take mm to voxels whose faces are at whole numbers, ``rows (3,)`` are the
    lengths of its rows.
    """
    for block in numba.prange((len(held) + BLOCK - 1) // BLOCK):
        c, u, reach = np.empty(6), np.empty(6), np.empty(3)
        for k in range(block * BLOCK, min((block + 1) * BLOCK, len(held))):
            for d in range(6):
                c[d] = held[k, d]
            _to_voxels(c, float(held[k, 6]), linear, corner, rows, u, reach)
            found[k] = _meets(u, reach, boxes)


@parallel_kernel
def near_fiblets(
    which: Any, anchors: Any, low: Any, fine: bool, ends: Any, reach_of: Any, bases: Any, origin: Any, scale: Any,
    units: Any, linear: Any, corner: Any, rows: Any, boxes: Any, found: Any,
) -> None:  # fmt: skip
    """The same of some fiblets ``which (m,)`` by their own capsules; ``units``: ``reach_scale, end_scale, slack``."""
    for block in numba.prange((len(which) + BLOCK - 1) // BLOCK):
        c, u, reach = np.empty(6), np.empty(6), np.empty(3)
        for k in range(block * BLOCK, min((block + 1) * BLOCK, len(which))):
            f = which[k]
            _capsule(f, anchors, low, fine, ends, bases, origin, scale, units[1], c)
            _to_voxels(c, units[0] * reach_of[f] + units[2], linear, corner, rows, u, reach)
            found[k] = _meets(u, reach, boxes)
