"""Compiled kernels: polylines through voxels, exactly, and what the voxels on their way hold."""

from __future__ import annotations

from typing import Any

import numba
import numpy as np

from ...codec.jit import kernel, parallel_kernel
from ...codec.kernels.decode_kernels import decode_one
from ...codec.layout import PAGE_BITS
from ...support.array_types import Bools, Float64s, Int32s, Int64s, UInt8s, UInt16s, UInt32s
from ..density.voxel_walk_kernels import walk, within
from .index_kernels import ROWS, next_anchor

ANY, OUT, FIRST, LAST = 1, 2, 4, 8
"""Flags of a fiblet: some position lies in the region, some does not, its first point does, its last point does."""
BAD, DAMAGED = 255, -(1 << 62)
HERE, CHANGED = 1, 2  # flags of a voxel: it is in the region, and this stroke changed it
BLOCK = 64


@kernel
def _voxel_of(u: Float64s, i: int, shape: tuple[int, int, int]) -> int:
    if not within(u, i, shape):
        return -1
    return (int(u[i, 0]) * shape[1] + int(u[i, 1])) * shape[2] + int(u[i, 2])


@kernel
def _place(points: Float64s, a: int, b: int, linear: Float64s, corner: Float64s, u: Float64s) -> None:
    for i in range(a, b):
        x, y, z = points[i, 0] - corner[0], points[i, 1] - corner[1], points[i, 2] - corner[2]
        for k in range(3):
            u[i - a, k] = linear[k, 0] * x + linear[k, 1] * y + linear[k, 2] * z


@parallel_kernel
def look(places: Int64s, order: UInt32s, arrays: tuple[UInt32s, UInt32s, UInt8s, Int64s], low: UInt16s, fine: bool,
         origin: Float64s, scale: Float64s, steps: tuple[float, float, float], tables: Float64s, linear: Float64s,
         corner: Float64s, mask: UInt8s, shape: tuple[int, int, int], found: UInt8s) -> None:  # fmt: skip
    """Flags of fiblets: ``found (m,)`` uint8; :data:`BAD` for a record that points beyond the arrays."""
    # `order[places]` are the fiblets, the arrays up to `tables` as in `.decode_kernels.decode`; `mask` is flat, in C
    # order, 1 in the region.
    most, strides = shape[0] + shape[1] + shape[2] + 4, (shape[1] * shape[2], shape[2], 1)
    for block in numba.prange((len(found) + BLOCK - 1) // BLOCK):
        p, u, on, stops = np.empty((ROWS, 3)), np.empty((ROWS, 3)), np.empty(most, np.int64), np.empty(most)
        for j in range(block * BLOCK, min((block + 1) * BLOCK, len(found))):
            f = np.int64(order[places[j]])
            n = decode_one(f, arrays, low, fine, origin, scale, steps, tables, p, 0)
            if n == 0:
                found[j] = BAD
                continue
            own = n
            n += next_anchor(arrays[0], low, fine, origin, scale, f, p, n)
            _place(p, 0, n, linear, corner, u)
            first, last = _voxel_of(u, 0, shape), _voxel_of(u, own - 1, shape)
            flags = FIRST | ANY if first >= 0 and mask[first] & HERE else OUT
            if last >= 0 and mask[last] & HERE:
                flags |= LAST
            for i in range(n - 1):
                if flags & ANY and flags & OUT:
                    break
                many, _ = walk(u, i, shape, strides, on, stops)
                if not (within(u, i, shape) and within(u, i + 1, shape)):
                    flags |= OUT
                for k in range(many):
                    flags |= ANY if mask[on[k]] & HERE else OUT
            found[j] = flags


@kernel
def _apart_from(u: Float64s, i: int, box: Float64s) -> bool:
    """Whether a segment lies beyond one face of a box of voxels, by more than one."""
    for axis in range(3):
        a, b = u[i, axis], u[i + 1, axis]
        if (a < box[axis] - 1.0 and b < box[axis] - 1.0) or (a > box[3 + axis] + 1.0 and b > box[3 + axis] + 1.0):
            return True
    return False


@parallel_kernel
def passes(places: Int64s, order: UInt32s, arrays: tuple[UInt32s, UInt32s, UInt8s, Int64s], low: UInt16s, fine: bool,
           origin: Float64s, scale: Float64s, steps: tuple[float, float, float], tables: Float64s, linear: Float64s,
           corner: Float64s, mask: UInt8s, bit: int, box: Float64s, shape: tuple[int, int, int],
           found: UInt8s) -> None:  # fmt: skip
    """Whether fiblets meet voxels with a bit of ``mask``, all within ``box (6,)``; ``found (m,)`` uint8."""
    # Other parameters, and what `BAD` means, as for `look`.
    most, strides = shape[0] + shape[1] + shape[2] + 4, (shape[1] * shape[2], shape[2], 1)
    for block in numba.prange((len(found) + BLOCK - 1) // BLOCK):
        p, u, on, stops = np.empty((ROWS, 3)), np.empty((ROWS, 3)), np.empty(most, np.int64), np.empty(most)
        for j in range(block * BLOCK, min((block + 1) * BLOCK, len(found))):
            f = np.int64(order[places[j]])
            n = decode_one(f, arrays, low, fine, origin, scale, steps, tables, p, 0)
            found[j] = BAD if n == 0 else 0
            n += next_anchor(arrays[0], low, fine, origin, scale, f, p, n) if n else 0
            _place(p, 0, n, linear, corner, u)
            at = _voxel_of(u, 0, shape) if n else -1
            if at >= 0 and mask[at] & bit:
                found[j] = ANY
            for i in range(n - 1):
                if found[j]:
                    break
                if _apart_from(u, i, box):
                    continue
                many, _ = walk(u, i, shape, strides, on, stops)
                for k in range(many):
                    if mask[on[k]] & bit:
                        found[j] = ANY


@parallel_kernel
def lines_of(places: Int64s, order: UInt32s, anchors: UInt32s, bases: Int64s, ids: Int64s, lines: Int64s) -> None:
    """Streamlines of the fiblets ``order[places]``, ``lines (m,)`` int64; -1 where a damaged file leads to none."""
    # `bases` and `ids` lead to them (`ids` empty: ranks are streamlines).
    for k in numba.prange(len(places)):
        f = np.int64(order[places[k]])
        rank: Any = np.int64(bases[f >> PAGE_BITS] + ((anchors[f, 1] >> 16) & 0x3FFF))
        if len(ids):
            rank = ids[rank] if rank < len(ids) else -1
        lines[k] = rank


@kernel
def apply(places: Int64s, lines: Int64s, found: UInt8s, order: UInt32s, anchors: UInt32s, states: UInt8s, n_any: Int32s,
          n_out: Int32s, ends: UInt8s) -> int:  # fmt: skip
    """Take new flags of fiblets over; returns by how many more streamlines the region is passed."""
    # `order[places]` are the fiblets, of `lines_of`, `states (n_fiblets,)` the flags before, in that order. Of
    # streamlines, `n_any, n_out` count fiblets and `ends` holds FIRST and LAST. Where `n_out` is empty, only ANY is
    # told.
    more, whole = 0, len(n_out) > 0
    for k in range(len(places)):
        line, new = lines[k], found[k]
        if line < 0 or line >= len(n_any):  # of a damaged file
            return DAMAGED
        old = states[places[k]]
        before = n_any[line] > 0
        n_any[line] += int(new & ANY != 0) - int(old & ANY != 0)
        more += int(n_any[line] > 0) - int(before)
        if whole:
            word = anchors[np.int64(order[places[k]]), 1]
            n_out[line] += int(new & OUT != 0) - int(old & OUT != 0)
            if word >> 30 & 1:
                ends[line] = ends[line] & ~FIRST | new & FIRST
            if word >> 31:
                ends[line] = ends[line] & ~LAST | new & LAST
        states[places[k]] = new
    return more


@kernel
def _ordered(
    u: Float64s, n: int, shape: tuple[int, int, int], labels: UInt16s, wanted: Int64s, on: Int64s, stops: Float64s
) -> bool:
    strides = (shape[1] * shape[2], shape[2], 1)
    next_, at = 0, _voxel_of(u, 0, shape)
    while next_ < len(wanted) and at >= 0 and labels[at] == wanted[next_]:
        next_ += 1
    for i in range(n - 1):
        many, _ = walk(u, i, shape, strides, on, stops)
        for k in range(many):
            while next_ < len(wanted) and labels[on[k]] == wanted[next_]:
                next_ += 1
    return next_ == len(wanted)


@parallel_kernel
def in_order(points: Float64s, offsets: Int64s, linear: Float64s, corner: Float64s, labels: UInt16s,
             shape: tuple[int, int, int], wanted: Int64s, either: bool, found: Bools) -> None:  # fmt: skip
    """Whether streamlines come through labels in an order, ``found (n,)`` bool; `either`: or in the reverse one."""
    for s in numba.prange(len(found)):
        a, b = offsets[s], offsets[s + 1]
        most = shape[0] + shape[1] + shape[2] + 4
        u, on, stops = np.empty((b - a, 3)), np.empty(most, np.int64), np.empty(most)
        _place(points, a, b, linear, corner, u)
        found[s] = b > a and (
            _ordered(u, b - a, shape, labels, wanted, on, stops)
            or (either and _ordered(u, b - a, shape, labels, wanted[::-1], on, stops))
        )
