"""Compiled kernels: segments cut at the faces of voxels, and sums over voxels; see :mod:`.volume`.

Positions ``u`` are in voxels from the grid's corner: faces are at whole numbers, and voxel ``floor(u)`` holds ``u``
(:mod:`.voxel_walk_kernels`). An *item* is a point and the segment that begins there, if it is not the last of its
streamline.
"""

from __future__ import annotations

import math

import numba
import numpy as np

from ...codec.jit import kernel, parallel_kernel
from ...support.array_types import Float64s, Int32s, Int64s
from .voxel_walk_kernels import clip, end_voxels, faces, voxel_along, within

BLOCK = 2048  # items that a thread takes together
TILE_BITS = 10  # voxels of a tile belong to one thread
COUNT, AMOUNT, DIRECTION, VALUE = 0, 1, 2, 3


@parallel_kernel
def place(points: Float64s, line: Int64s, corner: Float64s, linear: Float64s, u: Float64s, lengths: Float64s) -> int:
    """Positions in voxels ``u`` (n, 3), and lengths (n,) in mm of the segments that begin at points."""
    # Returns how many points are not finite, or so far from the next one that the length is not.
    n = len(points)
    n_blocks = (n + BLOCK - 1) // BLOCK
    bad = np.zeros(n_blocks, np.int64)
    for block in numba.prange(n_blocks):
        for i in range(block * BLOCK, min((block + 1) * BLOCK, n)):
            # The corner first: far from the origin, the difference has digits that the product would lose.
            x, y, z = points[i, 0] - corner[0], points[i, 1] - corner[1], points[i, 2] - corner[2]
            for k in range(3):
                u[i, k] = linear[k, 0] * x + linear[k, 1] * y + linear[k, 2] * z
            finite = math.isfinite(u[i, 0] + u[i, 1] + u[i, 2])
            lengths[i] = 0.0
            if i + 1 < n and line[i + 1] == line[i]:
                dx = points[i + 1, 0] - points[i, 0]
                dy = points[i + 1, 1] - points[i, 1]
                dz = points[i + 1, 2] - points[i, 2]
                lengths[i] = math.sqrt(dx * dx + dy * dy + dz * dz)
                # What is not finite at the next point is counted there.
                finite &= math.isfinite(lengths[i]) or not math.isfinite(dx + dy + dz)
            bad[block] += not finite
    return int(bad.sum())


@parallel_kernel
def count_pieces(u: Float64s, line: Int64s, shape: tuple[int, int, int], out: Int64s) -> None:
    """At most how many pieces :func:`cut` makes of each item: ``out`` (n,) int64."""
    n = len(u)
    for block in numba.prange((n + BLOCK - 1) // BLOCK):
        for i in range(block * BLOCK, min((block + 1) * BLOCK, n)):
            inside = within(u, i, shape)
            out[i] = 1 if inside else 0
            if i + 1 < n and line[i + 1] == line[i]:
                enter, leave = 0.0, 1.0
                if not (inside and within(u, i + 1, shape)):
                    enter, leave = clip(u, i, shape)
                    if enter > leave:
                        continue
                x, y, z, ex, ey, ez = end_voxels(u, i, shape, enter, leave)
                out[i] = 1 + abs(ex - x) + abs(ey - y) + abs(ez - z)


@parallel_kernel
def cut(u: Float64s, line: Int64s, lengths: Float64s, shape: tuple[int, int, int], starts: Int64s, a: int, b: int,
        voxel: Int64s, item: Int64s, part: Float64s, middle: Float64s) -> float:  # fmt: skip
    """Cut the segments of items ``a`` to ``b`` at the faces of voxels."""
    # The loop is that of `.voxel_walk_kernels.walk`, written out: through its arrays, maps take a quarter longer.
    nx, ny, nz = shape
    n_blocks = (b - a + BLOCK - 1) // BLOCK
    inside_mm = np.zeros(n_blocks)
    for block in numba.prange(n_blocks):
        for i in range(a + block * BLOCK, min(a + (block + 1) * BLOCK, b)):
            r, stop = starts[i] - starts[a], starts[i + 1] - starts[a]
            if r == stop:
                continue
            inside = within(u, i, shape)
            enter, leave, drawn = 0.0, 1.0, i + 1 < len(u) and line[i + 1] == line[i]
            if drawn and not (inside and within(u, i + 1, shape)):
                enter, leave = clip(u, i, shape)
                drawn = enter < leave
            if not drawn:
                x, y, z = voxel_along(u[i, 0], nx), voxel_along(u[i, 1], ny), voxel_along(u[i, 2], nz)
                voxel[r], item[r], part[r], middle[r] = x + nx * (y + ny * z), i, 0.0, 0.0
                continue
            inside_mm[block] += lengths[i] * (leave - enter)
            x, y, z, ex, ey, ez = end_voxels(u, i, shape, enter, leave)
            fx, sx, mx, dx = faces(u, i, 0, x, ex)
            fy, sy, my, dy = faces(u, i, 1, y, ey)
            fz, sz, mz, dz = faces(u, i, 2, z, ez)
            tx = (fx - u[i, 0]) / dx if mx else math.inf
            ty = (fy - u[i, 1]) / dy if my else math.inf
            tz = (fz - u[i, 2]) / dz if mz else math.inf
            now, holds_point = enter, inside
            while True:
                last = mx + my + mz == 0
                then = leave if last else min(max(min(tx, ty, tz), now), leave)
                if then > now or holds_point:
                    voxel[r], item[r] = x + nx * (y + ny * z), i
                    part[r], middle[r] = then - now, 0.5 * (now + then)
                    r += 1
                holds_point = False
                now = then
                if last:
                    break
                if tx <= ty and tx <= tz:
                    x, mx, fx = x + sx, mx - 1, fx + sx
                    tx = (fx - u[i, 0]) / dx if mx else math.inf
                elif ty <= tz:
                    y, my, fy = y + sy, my - 1, fy + sy
                    ty = (fy - u[i, 1]) / dy if my else math.inf
                else:
                    z, mz, fz = z + sz, mz - 1, fz + sz
                    tz = (fz - u[i, 2]) / dz if mz else math.inf
            for rest in range(r, stop):
                voxel[rest], item[rest], part[rest], middle[rest] = -1, i, 0.0, 0.0
    return float(inside_mm.sum())


@kernel
def cut_ends(u: Float64s, offsets: Int64s, shape: tuple[int, int, int], voxel: Int64s, item: Int64s, part: Float64s,
             middle: Float64s) -> None:  # fmt: skip
    """Pieces of :func:`cut` that are the streamlines' end points: two each, all arrays ``(2 * n_streamlines,)``."""
    # A streamline of one point has one end, one without points none.
    nx, ny = shape[0], shape[1]
    for s in range(len(offsets) - 1):
        first, last = offsets[s], offsets[s + 1] - 1
        for end in range(2):
            r, i = 2 * s + end, last if end else first
            voxel[r], item[r], part[r], middle[r] = -1, first, 1.0, 0.0
            if last < first + end or not within(u, i, shape):
                continue
            voxel[r] = int(u[i, 0]) + nx * (int(u[i, 1]) + ny * int(u[i, 2]))
            if end:
                item[r], middle[r] = last - 1, 1.0


@parallel_kernel
def add_up(what: int, by_length: bool, tiles: int, n: int, voxel: Int64s, item: Int64s, part: Float64s,
           middle: Float64s, points: Float64s, line: Int64s, lengths: Float64s, weights: Float64s, values: Float64s,
           per_point: bool, base: int, visitor: Int32s, sums: Float64s) -> None:  # fmt: skip
    """Add pieces to sums over voxels, in their order whatever the number of threads."""
    # Each thread looks at all pieces, and adds the pieces in its own voxels: reading costs far less than adding.
    for own in numba.prange(tiles):
        for r in range(n):
            v = voxel[r]
            if v < 0 or (v >> TILE_BITS) & (tiles - 1) != own:
                continue
            i = item[r]
            s = line[i]
            if what == COUNT:
                if visitor[v] != base + s + 1:
                    visitor[v] = base + s + 1
                    sums[0, v] += weights[s]
                continue
            amount = weights[s] * part[r]
            if by_length:
                amount *= lengths[i]
            if what == AMOUNT:
                sums[0, v] += amount
            elif what == DIRECTION:
                if lengths[i] > 0.0:
                    share = amount / lengths[i]
                    for k in range(3):
                        sums[k, v] += share * abs(points[i + 1, k] - points[i, k])
                    sums[3, v] += amount
            else:
                value = values[i] if per_point else values[s]
                if per_point and i + 1 < len(line) and line[i + 1] == s:
                    value = (1.0 - middle[r]) * value + middle[r] * values[i + 1]
                if math.isfinite(value):
                    sums[0, v] += amount * value
                    sums[1, v] += amount


@kernel
def count_visits(n: int, voxel: Int64s, item: Int64s, owner: Int64s, visitor: Int32s, counts: Int64s) -> None:
    """Add to ``counts`` the voxels that each owner visits; ``owner`` (of each item) never falls from call to call."""
    # `visitor` (n_voxels,) is the last visitor of a voxel, from 1 on.
    for r in range(n):
        v = voxel[r]
        if v >= 0 and visitor[v] != owner[item[r]] + 1:
            visitor[v] = owner[item[r]] + 1
            counts[owner[item[r]]] += 1
