"""Compiled kernels: measures along streamlines; see :mod:`.measures`.

``points`` are ``(n_points, 3)`` float64 mm, ``offsets`` ``(n + 1,)`` int64; ``out`` is filled.
"""

from __future__ import annotations

import math

import numba

from ...codec.jit import kernel, parallel_kernel
from ...support.array_types import Float32s, Float64s, Floats, Int64s

LONG_ENOUGH = 4.0  # times the error: curvature times a chord's square; errors in any direction change means by 1 % then
TURN = 1.0  # radians between chords beyond which they are too long for the curve
STRAIGHT = 0.1  # radians that errors may turn a line by as a whole: it is straight as far as anybody can see


@kernel
def _turn(points: Float64s, i: int, s: int, around: float) -> float:
    """Angle between the chords to points ``s`` before and after over half the length of both, 1/mm."""
    ax, ay, az = points[i, 0] - points[i - s, 0], points[i, 1] - points[i - s, 1], points[i, 2] - points[i - s, 2]
    bx, by, bz = points[i + s, 0] - points[i, 0], points[i + s, 1] - points[i, 1], points[i + s, 2] - points[i, 2]
    la, lb = math.sqrt(ax * ax + ay * ay + az * az), math.sqrt(bx * bx + by * by + bz * bz)
    if la == 0.0 or lb == 0.0:
        return 0.0
    ax, ay, az, bx, by, bz = ax / la, ay / la, az / la, bx / lb, by / lb, bz / lb
    apart = math.sqrt((ax - bx) ** 2 + (ay - by) ** 2 + (az - bz) ** 2)
    along = math.sqrt((ax + bx) ** 2 + (ay + by) ** 2 + (az + bz) ** 2)
    return 4.0 * math.atan2(apart, along) / around


@kernel
def _length(points: Float64s, i: int) -> float:
    """Length of the segment that leads to point ``i``, mm."""
    squares = 0.0
    for axis in range(3):
        squares += (points[i, axis] - points[i - 1, axis]) ** 2
    return math.sqrt(squares)


@parallel_kernel
def curvatures(points: Float64s, offsets: Int64s, error: float, out: Float32s, bears: Float64s) -> None:
    """Curvature at every point, ``(n_points,)``, 1/mm, over chords that an error of positions, mm, changes little."""
    # `bears` `(n,)` is the error that each line's mean bears, mm: less than the one given where it is too short.
    for line in numba.prange(len(offsets) - 1):
        a, b = offsets[line], offsets[line + 1]
        for i in range(a, b):
            out[i] = 0.0
        bears[line] = math.inf
        if b - a < 3:
            continue
        total = 0.0
        for i in range(a + 1, b):
            total += _length(points, i)
        s, most = 1, (b - a - 1) // 2
        while True:
            around, found = 0.0, 0.0
            for i in range(a + 1, a + 2 * s + 1):
                around += _length(points, i)
            for i in range(a + s, b - s):
                out[i] = _turn(points, i, s, around)
                found += out[i]
                if i + 1 < b - s:
                    around += _length(points, i + s + 1) - _length(points, i - s + 1)
            chord = s * total / (b - a - 1)
            turn = found / (b - a - 2 * s) * chord
            if turn * chord >= LONG_ENOUGH * error or turn > TURN or s >= most:
                break
            s = min(max(s + 1, s * 5 // 4), most)
        for i in range(a, a + s):
            out[i] = out[a + s]
        for i in range(b - s, b):
            out[i] = out[b - s - 1]
        if chord > 0.0:
            bears[line] = max(turn * chord / LONG_ENOUGH, STRAIGHT * chord * chord / total)


@parallel_kernel
def arc_lengths(points: Float64s, offsets: Int64s, out: Floats) -> None:
    """Length of the streamline up to every point, ``(n_points,)``, mm."""
    for s in numba.prange(len(offsets) - 1):
        total = 0.0
        for i in range(offsets[s], offsets[s + 1]):
            if i > offsets[s]:
                total += _length(points, i)
            out[i] = total


@parallel_kernel
def means(values: Float32s, offsets: Int64s, out: Float64s) -> None:
    """Mean of each streamline's values, ``(n,)``; NaN without any."""
    for s in numba.prange(len(out)):
        total = 0.0
        for i in range(offsets[s], offsets[s + 1]):
            total += values[i]
        out[s] = total / (offsets[s + 1] - offsets[s])


@parallel_kernel
def least(values: Float64s, offsets: Int64s, out: Float64s) -> None:
    """Least of each streamline's values, ``(n,)``; NaN without any."""
    for s in numba.prange(len(out)):
        out[s] = math.nan
        for i in range(offsets[s], offsets[s + 1]):
            if not out[s] <= values[i]:
                out[s] = values[i]


@parallel_kernel
def resample(points: Float64s, values: Float64s, offsets: Int64s, places: Float64s, found: Float64s) -> None:
    """Positions and values at places of equal arc length along each streamline, its ends included."""
    # `values` is `(n_points,)` float64; `places` `(n, m, 3)` and `found` `(n, m)` float64 are filled. A value next to a
    # point without one (NaN) is NaN. Where a streamline has no length, all places are its first.
    for s in numba.prange(len(offsets) - 1):
        a, b, m = offsets[s], offsets[s + 1], found.shape[1]
        total = 0.0
        for i in range(a + 1, b):
            total += _length(points, i)
        i, before, step = a, 0.0, 0.0
        for k in range(m):
            wanted = total * k / max(m - 1, 1)
            # Segment i leads from arc length `before` to `before + step`.
            while i + 1 < b:
                step = _length(points, i + 1)
                if before + step >= wanted or i + 2 == b:
                    break
                before += step
                i += 1
            t = min(max((wanted - before) / step, 0.0), 1.0) if step > 0.0 and i + 1 < b else 0.0
            if t == 0.0:
                found[s, k] = values[i]
            elif t == 1.0:
                found[s, k] = values[i + 1]
            else:
                found[s, k] = values[i] + t * (values[i + 1] - values[i])
            for axis in range(3):
                places[s, k, axis] = points[i, axis]
                if t > 0.0:
                    places[s, k, axis] += t * (points[i + 1, axis] - points[i, axis])
