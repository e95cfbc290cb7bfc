"""Compiled kernels: directions of segments, and the angles between tangents; see `tangents`."""

from __future__ import annotations

import math

import numba
import numpy as np

from ...support.array_types import Bools, Float64s, Floats, Int64s, UInt8s
from ..jit import kernel, parallel_kernel
from ..tangents import LEAST_SUM, ONE_POINT


@kernel
def direction(points: Floats, i: int) -> tuple[float, ...]:
    """Unit vector from point ``i`` to the next one and its length; zeros where it has none."""
    return unit(
        np.float64(points[i + 1, 0]) - np.float64(points[i, 0]),
        np.float64(points[i + 1, 1]) - np.float64(points[i, 1]),
        np.float64(points[i + 1, 2]) - np.float64(points[i, 2]),
    )


@kernel
def unit(x: float, y: float, z: float) -> tuple[float, ...]:
    """Unit vector of a vector and its length; zeros where it has none."""
    largest = max(abs(x), abs(y), abs(z))
    if largest == 0.0:
        return 0.0, 0.0, 0.0, 0.0
    x, y, z = x / largest, y / largest, z / largest  # squares of the smallest numbers would be 0
    size = math.sqrt(x * x + y * y + z * z)
    return x / size, y / size, z / size, size * largest


@parallel_kernel
def tangent_angles(
    true: Floats, drawn: Float64s, offsets: Int64s, firsts: Bools, shortest: float, degrees: Float64s, uses: UInt8s
) -> None:
    """Angle between true and drawn tangent at every point."""
    for s in numba.prange(len(offsets) - 1):
        ax = ay = az = bx = by = bz = 0.0  # directions of the segment before, true and drawn
        longer = False
        for i in range(offsets[s], offsets[s + 1]):
            cx = cy = cz = dx = dy = dz = 0.0
            before = longer
            longer = False
            if i + 1 < offsets[s + 1]:
                cx, cy, cz, length = direction(true, i)
                if length <= shortest * ONE_POINT:
                    cx = cy = cz = 0.0
                dx, dy, dz, _ = direction(drawn, i)
                longer = length > shortest
            tx, ty, tz = ax + cx, ay + cy, az + cz
            ux, uy, uz = bx + dx, by + dy, bz + dz
            if firsts[i] and (dx != 0.0 or dy != 0.0 or dz != 0.0):
                ux, uy, uz = dx, dy, dz
            degrees[i] = 0.0
            uses[i] = int(before) + int(longer)
            if tx * tx + ty * ty + tz * tz <= LEAST_SUM * LEAST_SUM:
                uses[i] = 0
            if uses[i] > 0:
                if ux * ux + uy * uy + uz * uz <= LEAST_SUM * LEAST_SUM:
                    ux, uy, uz = bx, by, bz
                px, py, pz = ty * uz - tz * uy, tz * ux - tx * uz, tx * uy - ty * ux
                across, along = math.sqrt(px * px + py * py + pz * pz), tx * ux + ty * uy + tz * uz
                degrees[i] = 90.0 if across == 0.0 and along == 0.0 else math.degrees(math.atan2(across, along))
            ax, ay, az, bx, by, bz = cx, cy, cz, dx, dy, dz
