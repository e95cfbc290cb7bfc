"""Compiled kernels: polylines through voxels, exactly, and what the voxels on their way hold."""

from __future__ import annotations

import math
from typing import Any

import numba
import numpy as np

from ...codec.jit import kernel, parallel_kernel
from ..density_kernels import _clip, _ends, _faces, _within

__all__ = ["ANY", "FIRST", "LAST", "OUT", "apply", "in_order", "look"]

ANY, OUT, FIRST, LAST = 1, 2, 4, 8
"""Of a fiblet: some position lies in the region, some does not, its first point does, its last point does."""
BLOCK = 64


@kernel
def _voxels(u: Any, i: int, shape: Any, out: Any) -> Any:
    """Voxels on the way from point ``i`` to the next, in order: how many, and whether the way leaves the grid."""
    _nx, ny, nz = shape
    one, other = _within(u, i, shape), _within(u, i + 1, shape)
    enter, leave = 0.0, 1.0
    if not (one and other):
        enter, leave = _clip(u, i, shape)
        if enter > leave:
            return 0, True
    x, y, z, ex, ey, ez = _ends(u, i, shape, enter, leave)
    out[0] = (x * ny + y) * nz + z
    if x == ex and y == ey and z == ez:
        return 1, not (one and other)
    fx, sx, mx, dx = _faces(u, i, 0, x, ex)
    fy, sy, my, dy = _faces(u, i, 1, y, ey)
    fz, sz, mz, dz = _faces(u, i, 2, z, ez)
    tx = (fx - u[i, 0]) / dx if mx else math.inf
    ty = (fy - u[i, 1]) / dy if my else math.inf
    tz = (fz - u[i, 2]) / dz if mz else math.inf
    n = 1
    while mx + my + mz:
        if tx <= ty and tx <= tz:
            x, mx, fx = x + sx, mx - 1, fx + sx
            tx = (fx - u[i, 0]) / dx if mx else math.inf
        elif ty <= tz:
            y, my, fy = y + sy, my - 1, fy + sy
            ty = (fy - u[i, 1]) / dy if my else math.inf
        else:
            z, mz, fz = z + sz, mz - 1, fz + sz
            tz = (fz - u[i, 2]) / dz if mz else math.inf
        out[n] = (x * ny + y) * nz + z
        n += 1
    return n, not (one and other)


@kernel
def _voxel_of(u: Any, i: int, shape: Any) -> int:
    if not _within(u, i, shape):
        return -1
    return (int(u[i, 0]) * shape[1] + int(u[i, 1])) * shape[2] + int(u[i, 2])


@kernel
def _place(points: Any, a: int, b: int, linear: Any, corner: Any, u: Any) -> None:
    for i in range(a, b):
        x, y, z = points[i, 0] - corner[0], points[i, 1] - corner[1], points[i, 2] - corner[2]
        for k in range(3):
            u[i - a, k] = linear[k, 0] * x + linear[k, 1] * y + linear[k, 2] * z


@parallel_kernel
def look(points: Any, starts: Any, joined: Any, linear: Any, corner: Any, mask: Any, shape: Any, found: Any) -> None:
    """Flags of fiblets: ``found (n,)`` uint8.

    ``points`` of fiblet ``f`` are rows ``starts[f]`` to ``starts[f + 1]``, the last of them the next fiblet's first
    where ``joined[f]``; ``mask`` is flat, in C order.
    """
    for block in numba.prange((len(found) + BLOCK - 1) // BLOCK):
        u, on = np.empty((64, 3)), np.empty(shape[0] + shape[1] + shape[2] + 4, np.int64)
        for f in range(block * BLOCK, min((block + 1) * BLOCK, len(found))):
            a, b = starts[f], starts[f + 1]
            _place(points, a, b, linear, corner, u)
            first = _voxel_of(u, 0, shape)
            last = _voxel_of(u, b - a - 1 - (1 if joined[f] else 0), shape)
            flags = 0
            if first >= 0 and mask[first]:
                flags |= FIRST | ANY
            else:
                flags |= OUT
            if last >= 0 and mask[last]:
                flags |= LAST
            for i in range(b - a - 1):
                if flags & ANY and flags & OUT:
                    break
                n, leaves = _voxels(u, i, shape, on)
                if leaves:
                    flags |= OUT
                for k in range(n):
                    flags |= ANY if mask[on[k]] else OUT
            found[f] = flags


@kernel
def apply(which: Any, found: Any, states: Any, ranks: Any, borders: Any, n_any: Any, n_out: Any, ends: Any) -> int:
    """Take new flags of fiblets over; returns by how many more streamlines the region is passed.

    ``states (n_fiblets,)`` are the flags before, ``ranks (m,)`` streamlines, ``borders (m,)`` 1 for a streamline's
    first fiblet, 2 for its last, 3 for both; ``n_any, n_out (n_ranks,)`` count fiblets, ``ends`` holds FIRST and LAST.
    """
    more = 0
    for k in range(len(which)):
        f, rank, new = which[k], ranks[k], found[k]
        old = states[f]
        before = n_any[rank] > 0
        n_any[rank] += int(new & ANY != 0) - int(old & ANY != 0)
        n_out[rank] += int(new & OUT != 0) - int(old & OUT != 0)
        more += int(n_any[rank] > 0) - int(before)
        if borders[k] & 1:
            ends[rank] = ends[rank] & ~FIRST | new & FIRST
        if borders[k] & 2:
            ends[rank] = ends[rank] & ~LAST | new & LAST
        states[f] = new
    return more


@kernel
def _ordered(u: Any, n: int, shape: Any, labels: Any, wanted: Any, on: Any) -> bool:
    next_, at = 0, _voxel_of(u, 0, shape)
    while next_ < len(wanted) and at >= 0 and labels[at] == wanted[next_]:
        next_ += 1
    for i in range(n - 1):
        many, _ = _voxels(u, i, shape, on)
        for k in range(many):
            while next_ < len(wanted) and labels[on[k]] == wanted[next_]:
                next_ += 1
    return next_ == len(wanted)


@parallel_kernel
def in_order(points: Any, offsets: Any, linear: Any, corner: Any, labels: Any, shape: Any, wanted: Any, either: bool,
             found: Any) -> None:  # fmt: skip
    """Whether streamlines come through labels in an order, ``found (n,)`` bool; `either`: or in the reverse one."""
    for s in numba.prange(len(found)):
        a, b = offsets[s], offsets[s + 1]
        u, on = np.empty((b - a, 3)), np.empty(shape[0] + shape[1] + shape[2] + 4, np.int64)
        _place(points, a, b, linear, corner, u)
        found[s] = b > a and (
            _ordered(u, b - a, shape, labels, wanted, on)
            or (either and _ordered(u, b - a, shape, labels, wanted[::-1], on))
        )
