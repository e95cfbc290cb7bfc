"""Compiled kernels: the voxels on the way of a segment.

The walk is that of Amanatides and Woo 1987, "A fast voxel traversal algorithm for ray tracing", with two changes. How
many faces of each axis a segment crosses is known from the voxels of its ends, so that the walk ends where it must.
And where it crosses face ``m`` is computed as ``(m - u0) / (u1 - u0)`` each time instead of being added up, so that a
long segment is cut as exactly as a short one.

Positions ``u`` are in voxels from the grid's corner: faces are at whole numbers, and voxel ``floor(u)`` holds ``u``.
"""

from __future__ import annotations

import math

from ...codec.jit import kernel
from ...support.array_types import Float64s, Int64s


@kernel
def within(u: Float64s, i: int, shape: tuple[int, int, int]) -> bool:
    """Whether point ``i`` lies in the grid."""
    return (
        u[i, 0] >= 0.0 and u[i, 0] < shape[0]
        and u[i, 1] >= 0.0 and u[i, 1] < shape[1]
        and u[i, 2] >= 0.0 and u[i, 2] < shape[2]
    )  # fmt: skip


@kernel
def clip(u: Float64s, i: int, shape: tuple[int, int, int]) -> tuple[float, float]:
    """Return the shares of segment ``i`` between which it lies in the grid; (1, 0) if nowhere."""
    enter, leave = 0.0, 1.0
    for k in range(3):
        a, d = u[i, k], u[i + 1, k] - u[i, k]
        if d == 0.0:
            if not (a >= 0.0 and a < shape[k]):
                return 1.0, 0.0
            continue
        low, high = -a / d, (shape[k] - a) / d
        if d < 0.0:
            low, high = high, low
        enter, leave = max(enter, low), min(leave, high)
    if not enter < leave:
        return 1.0, 0.0
    return enter, leave


@kernel
def voxel_along(x: float, n: int) -> int:
    """Voxel of a position in, or within rounding of, the grid."""
    return int(min(max(math.floor(x), 0.0), n - 1.0))


@kernel
def end_voxels(u: Float64s, i: int, shape: tuple[int, int, int], enter: float, leave: float) -> tuple[int, ...]:
    """Voxels in which the part of segment ``i`` within the grid begins and ends."""
    ax = u[i, 0] if enter == 0.0 else u[i, 0] + enter * (u[i + 1, 0] - u[i, 0])
    ay = u[i, 1] if enter == 0.0 else u[i, 1] + enter * (u[i + 1, 1] - u[i, 1])
    az = u[i, 2] if enter == 0.0 else u[i, 2] + enter * (u[i + 1, 2] - u[i, 2])
    bx = u[i + 1, 0] if leave == 1.0 else u[i, 0] + leave * (u[i + 1, 0] - u[i, 0])
    by = u[i + 1, 1] if leave == 1.0 else u[i, 1] + leave * (u[i + 1, 1] - u[i, 1])
    bz = u[i + 1, 2] if leave == 1.0 else u[i, 2] + leave * (u[i + 1, 2] - u[i, 2])
    nx, ny, nz = shape
    return (
        voxel_along(ax, nx), voxel_along(ay, ny), voxel_along(az, nz),
        voxel_along(bx, nx), voxel_along(by, ny), voxel_along(bz, nz),
    )  # fmt: skip


@kernel
def faces(u: Float64s, i: int, k: int, first: int, last: int) -> tuple[int, int, int, float]:
    """Return for one axis: the first face crossed, the step to the next, their number, and the segment's extent."""
    # `first` and `last` are rounded where the segment enters and leaves the grid; they never make it turn back.
    d = u[i + 1, k] - u[i, k]
    if d > 0.0:
        return first + 1, 1, max(last - first, 0), d
    return first, -1, max(first - last, 0), d


@kernel
def walk(
    u: Float64s, i: int, shape: tuple[int, int, int], strides: tuple[int, int, int], on: Int64s, stops: Float64s
) -> tuple[int, float]:
    """Voxels on the way from ``u[i]`` to ``u[i + 1]``, in order: how many, and the share where the first begins."""
    # A voxel counts if some length of the segment lies in it, or one of its ends.
    sx, sy, sz = strides
    one, other = within(u, i, shape), within(u, i + 1, shape)
    enter, leave = 0.0, 1.0
    if not (one and other):
        enter, leave = clip(u, i, shape)
        if enter > leave:
            if not (one or other):
                return 0, 0.0
            # An end on the grid's face is all of it.
            k = i if one else i + 1
            on[0], stops[0] = int(u[k, 0]) * sx + int(u[k, 1]) * sy + int(u[k, 2]) * sz, float(k - i)
            return 1, float(k - i)
    x, y, z, ex, ey, ez = end_voxels(u, i, shape, enter, leave)
    on[0], stops[0] = x * sx + y * sy + z * sz, leave
    if x == ex and y == ey and z == ez:
        return 1, enter
    fx, gx, mx, dx = faces(u, i, 0, x, ex)
    fy, gy, my, dy = faces(u, i, 1, y, ey)
    fz, gz, mz, dz = faces(u, i, 2, z, ez)
    tx = (fx - u[i, 0]) / dx if mx else math.inf
    ty = (fy - u[i, 1]) / dy if my else math.inf
    tz = (fz - u[i, 2]) / dz if mz else math.inf
    n, now, holds = 0, enter, one
    while True:
        last = mx + my + mz == 0
        then = leave if last else min(max(min(tx, ty, tz), now), leave)
        if then > now or holds or (last and other):
            on[n], stops[n] = x * sx + y * sy + z * sz, then
            n += 1
        if last:
            return n, enter
        holds, now = False, then
        if tx <= ty and tx <= tz:
            x, mx, fx = x + gx, mx - 1, fx + gx
            tx = (fx - u[i, 0]) / dx if mx else math.inf
        elif ty <= tz:
            y, my, fy = y + gy, my - 1, fy + gy
            ty = (fy - u[i, 1]) / dy if my else math.inf
        else:
            z, mz, fz = z + gz, mz - 1, fz + gz
            tz = (fz - u[i, 2]) / dz if mz else math.inf
