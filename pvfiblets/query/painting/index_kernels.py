"""Compiled kernels: a spatial index over fiblets; see :mod:`.fiblet_index`.

A leaf is `LEAF` fiblets that run alike. Each fiblet is kept as a few chords between some of its points, in bytes beside
beside their leaf's, and a radius: every point of the fiblet lies within it of the chord of its part.
"""

from __future__ import annotations

import math

import numba
import numpy as np

from ...codec.jit import kernel, parallel_kernel
from ...codec.kernels.capsule_kernels import anchor_part, end_part
from ...codec.kernels.decode_kernels import decode_one
from ...codec.layout import PAGE_BITS
from ...support.array_types import Bools, Float32s, Float64s, Int64s, UInt8s, UInt16s, UInt32s

LEAF = 32
BLOCK = 1024
ROWS = 65  # points that a record can name, and the next fiblet's first
UP = 1.0 + 1e-6  # rounds a length in float32 up


@kernel
def next_anchor(
    anchors: UInt32s, low: UInt16s, fine: bool, origin: Float64s, scale: Float64s, f: int, out: Float64s, row: int
) -> int:
    """Write the first point of the next fiblet, which this one leads to, into a row; how many that is: 0 or 1."""
    if anchors[f, 1] >> 31 or f + 1 >= len(anchors):
        return 0
    for axis in range(3):
        out[row, axis] = scale[axis] * anchor_part(anchors, low, fine, f + 1, axis) + origin[axis]
    return 1


@parallel_kernel
def chords(first: int, anchors: UInt32s, low: UInt16s, fine: bool, ends: UInt32s, bases: Int64s, origin: Float64s,
           scale: Float64s, end_scale: float, out: Float32s) -> None:  # fmt: skip
    """Chords of consecutive fiblets from `first` on, ``out`` (n, 6) float32 mm, all turned to one half of space."""
    for block in numba.prange((len(out) + BLOCK - 1) // BLOCK):
        c = np.empty(6)
        for k in range(block * BLOCK, min((block + 1) * BLOCK, len(out))):
            f = first + k
            rank = bases[f >> PAGE_BITS] + ((anchors[f, 1] >> 16) & 0x3FFF)
            for axis in range(3):
                a = scale[axis] * anchor_part(anchors, low, fine, f, axis)
                if anchors[f, 1] >> 31 or f + 1 >= len(anchors):
                    b = a + end_scale * (end_part(np.int64(ends[rank]), axis) if rank < len(ends) else 0)
                else:
                    b = scale[axis] * anchor_part(anchors, low, fine, f + 1, axis)
                c[axis], c[3 + axis] = a + origin[axis], b + origin[axis]
            turned = _turned(c[3] - c[0], c[4] - c[1], c[5] - c[2])
            for axis in range(3):
                a, b = c[axis], c[3 + axis]
                out[k, axis], out[k, 3 + axis] = (b, a) if turned else (a, b)


@kernel
def _turned(x: float, y: float, z: float) -> bool:
    """Whether a chord is taken from its end, so that chords of opposite directions lie together."""
    return x + 0.37 * y + 0.11 * z < 0.0


# ----------------------------------------------------------------------------------------------------------- sorting


@kernel
def _widest(keys: Float32s, lo: int, hi: int) -> int:
    best, widest = 0, -1.0
    for d in range(6):
        low, high = keys[lo, d], keys[lo, d]
        for i in range(lo + 1, hi):
            low, high = min(low, keys[i, d]), max(high, keys[i, d])
        if high - low > widest:
            best, widest = d, high - low
    return best


@kernel
def _swap(keys: Float32s, order: Int64s, i: int, j: int) -> None:
    for d in range(6):
        keys[i, d], keys[j, d] = keys[j, d], keys[i, d]
    order[i], order[j] = order[j], order[i]


@kernel
def _split(keys: Float32s, order: Int64s, lo: int, hi: int) -> int:
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
def sort_once(keys: Float32s, order: Int64s, parts: Int64s, middles: Int64s) -> None:
    """Part each of some ranges of rows ``parts (n, 2)`` in two; ``middles (n,)`` is filled."""
    for p in numba.prange(len(parts)):
        lo, hi = parts[p, 0], parts[p, 1]
        middles[p] = _split(keys, order, lo, hi) if hi - lo > LEAF else hi


@parallel_kernel
def sort_parts(keys: Float32s, order: Int64s, parts: Int64s) -> None:
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


# ------------------------------------------------------------------------------------------------------------ pieces


@kernel
def _apart(p: Float64s, a: Float64s, b: Float64s) -> float:
    """Distance of a point from a segment, each (3,)."""
    dx, dy, dz = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    x, y, z = p[0] - a[0], p[1] - a[1], p[2] - a[2]
    square = dx * dx + dy * dy + dz * dz
    t = min(max((x * dx + y * dy + z * dz) / square, 0.0), 1.0) if square > 0.0 else 0.0
    x, y, z = x - t * dx, y - t * dy, z - t * dz
    return math.sqrt(x * x + y * y + z * z)


@kernel
def _node(k: int, parts: int, n: int, turned: bool) -> int:
    """Number of the point of `n` at which part `k` begins."""
    at = (k * (n - 1) + parts // 2) // parts
    return n - 1 - at if turned else at


@parallel_kernel
def leaf_pieces(order: UInt32s, arrays: tuple[UInt32s, UInt32s, UInt8s, Int64s], low: UInt16s, fine: bool,
                origin: Float64s, scale: Float64s, steps: tuple[float, float, float], tables: Float64s, parts: int,
                leaves: Float32s, pieces: UInt8s, damaged: Bools) -> None:  # fmt: skip
    """Decode all fiblets and keep them coarsely; :class:`.FibletIndex` describes the filled arrays."""
    # `order (n,)` are the fiblets, the other arrays as in `.decode_kernels.decode`.
    nodes = parts + 1
    for leaf in numba.prange(len(leaves)):
        first, many = leaf * LEAF, min(LEAF, len(order) - leaf * LEAF)
        points, counts = np.empty((LEAF, ROWS, 3)), np.empty(LEAF, np.int64)
        turned = np.empty(LEAF, np.bool_)
        mean = np.zeros((nodes, 3))
        for j in range(many):
            f, p = np.int64(order[first + j]), points[j]
            n = decode_one(f, arrays, low, fine, origin, scale, steps, tables, p, 0)
            if n == 0:
                damaged[leaf] = True
                p[0, 0], p[0, 1], p[0, 2], n = origin[0], origin[1], origin[2], 1
            n += next_anchor(arrays[0], low, fine, origin, scale, f, p, n)
            counts[j] = n
            turned[j] = _turned(p[n - 1, 0] - p[0, 0], p[n - 1, 1] - p[0, 1], p[n - 1, 2] - p[0, 2])
            for k in range(nodes):
                at = _node(k, parts, n, turned[j])
                for axis in range(3):
                    mean[k, axis] += p[at, axis] / many
        widest = 0.0
        for k in range(nodes):
            for axis in range(3):
                leaves[leaf, 3 * k + axis] = mean[k, axis]
                mean[k, axis] = leaves[leaf, 3 * k + axis]  # as it is read again
                for j in range(many):
                    widest = max(widest, abs(points[j, _node(k, parts, counts[j], turned[j]), axis] - mean[k, axis]))
        leaves[leaf, 3 * nodes + parts] = max(widest / 127.0 * UP, 1e-30)
        unit = float(leaves[leaf, 3 * nodes + parts])
        radii, kept = np.zeros((LEAF, parts)), np.empty((LEAF, nodes, 3))
        for j in range(many):
            n = counts[j]
            for k in range(nodes):
                at, square = _node(k, parts, n, turned[j]), 0.0
                for axis in range(3):
                    code = round((points[j, at, axis] - mean[k, axis]) / unit)
                    pieces[first + j, 3 * k + axis] = code & 0xFF
                    kept[j, k, axis] = mean[k, axis] + unit * code
                    square += (kept[j, k, axis] - points[j, at, axis]) ** 2
                for part in range(max(k - 1, 0), min(k + 1, parts)):
                    radii[j, part] = max(radii[j, part], math.sqrt(square))
            for k in range(parts):
                a, b = _node(k, parts, n, turned[j]), _node(k + 1, parts, n, turned[j])
                for i in range(min(a, b), max(a, b) + 1):
                    radii[j, k] = max(radii[j, k], _apart(points[j, i], kept[j, k], kept[j, k + 1]))
        leaves[leaf, 3 * nodes + parts + 1] = max(radii.max() / 255.0 * UP, 1e-30)
        step = float(leaves[leaf, 3 * nodes + parts + 1])
        for j in range(many):
            for k in range(parts):
                code = min(math.ceil(radii[j, k] / step), 255)
                pieces[first + j, 3 * nodes + k] = code
                reach = 0.0
                for node in range(k, k + 2):
                    x, y, z = kept[j, node, 0], kept[j, node, 1], kept[j, node, 2]
                    x, y, z = x - mean[node, 0], y - mean[node, 1], z - mean[node, 2]
                    reach = max(reach, math.sqrt(x * x + y * y + z * z))
                reach = (reach + step * code) * UP
                leaves[leaf, 3 * nodes + k] = max(float(leaves[leaf, 3 * nodes + k]), reach)


@parallel_kernel
def leaf_boxes(leaves: Float32s, parts: int, out: Float32s) -> None:
    """Boxes along the axes that hold leaves, ``out (n, 6)`` float32 mm: lower and upper corners."""
    for leaf in numba.prange(len(leaves)):
        for axis in range(3):
            low, high = np.inf, -np.inf
            for k in range(parts):
                reach = float(leaves[leaf, 3 * (parts + 1) + k])
                a, b = float(leaves[leaf, 3 * k + axis]), float(leaves[leaf, 3 * k + 3 + axis])
                low, high = min(low, min(a, b) - reach), max(high, max(a, b) + reach)
            out[leaf, axis] = low - 1e-6 * abs(low)
            out[leaf, 3 + axis] = high + 1e-6 * abs(high)


@parallel_kernel
def near_leaves(held: Float32s, box: Float64s, found: Bools) -> None:
    """Leaves whose boxes ``(n_leaves, 6)`` meet one ``(6,)``, mm: ``found (n_leaves,)`` bool."""
    for block in numba.prange((len(held) + BLOCK - 1) // BLOCK):
        for k in range(block * BLOCK, min((block + 1) * BLOCK, len(held))):
            found[k] = (
                held[k, 0] <= box[3] and held[k, 3] >= box[0]
                and held[k, 1] <= box[4] and held[k, 4] >= box[1]
                and held[k, 2] <= box[5] and held[k, 5] >= box[2]
            )  # fmt: skip
