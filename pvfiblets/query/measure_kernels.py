"""Compiled kernels: measures along streamlines; see :mod:`.measures`.

``points`` are ``(n_points, 3)`` float64 mm, ``offsets`` ``(n + 1,)`` int64; ``out`` is filled.
"""

from __future__ import annotations

import math
from typing import Any

import numba

from ..codec.jit import kernel, parallel_kernel

__all__ = ["arc_lengths", "curvatures", "least", "means", "resample"]


@kernel
def _turn(points: Any, i: int) -> float:
    """Curvature at point ``i`` between two others; see ``shaders/fiblets/attributes/turn.glsl``."""
    ax, ay, az = points[i, 0] - points[i - 1, 0], points[i, 1] - points[i - 1, 1], points[i, 2] - points[i - 1, 2]
    bx, by, bz = points[i + 1, 0] - points[i, 0], points[i + 1, 1] - points[i, 1], points[i + 1, 2] - points[i, 2]
    la, lb = math.sqrt(ax * ax + ay * ay + az * az), math.sqrt(bx * bx + by * by + bz * bz)
    if la == 0.0 or lb == 0.0:
        return 0.0
    ax, ay, az, bx, by, bz = ax / la, ay / la, az / la, bx / lb, by / lb, bz / lb
    apart = math.sqrt((ax - bx) ** 2 + (ay - by) ** 2 + (az - bz) ** 2)
    along = math.sqrt((ax + bx) ** 2 + (ay + by) ** 2 + (az + bz) ** 2)
    return 4.0 * math.atan2(apart, along) / (la + lb)


@parallel_kernel
def curvatures(points: Any, offsets: Any, out: Any) -> None:
    """Curvature at every point, ``(n_points,)``, 1/mm."""
    for s in numba.prange(len(offsets) - 1):
        a, b = offsets[s], offsets[s + 1]
        for i in range(a + 1, b - 1):
            out[i] = _turn(points, i)
        if b - a > 2:
            out[a], out[b - 1] = out[a + 1], out[b - 2]
        else:
            for i in range(a, b):
                out[i] = 0.0


@parallel_kernel
def arc_lengths(points: Any, offsets: Any, out: Any) -> None:
    """Length of the streamline up to every point, ``(n_points,)``, mm."""
    for s in numba.prange(len(offsets) - 1):
        total = 0.0
        for i in range(offsets[s], offsets[s + 1]):
            if i > offsets[s]:
                squares = 0.0
                for axis in range(3):
                    squares += (points[i, axis] - points[i - 1, axis]) ** 2
                total += math.sqrt(squares)
            out[i] = total


@parallel_kernel
def means(values: Any, offsets: Any, out: Any) -> None:
    """Mean of each streamline's values, ``(n,)``; NaN without any."""
    for s in numba.prange(len(out)):
        total = 0.0
        for i in range(offsets[s], offsets[s + 1]):
            total += values[i]
        out[s] = total / (offsets[s + 1] - offsets[s])


@parallel_kernel
def least(values: Any, offsets: Any, out: Any) -> None:
    """Least of each streamline's values, ``(n,)``; NaN without any."""
    for s in numba.prange(len(out)):
        out[s] = math.nan
        for i in range(offsets[s], offsets[s + 1]):
            if not out[s] <= values[i]:
                out[s] = values[i]


@parallel_kernel
def resample(points: Any, values: Any, offsets: Any, places: Any, found: Any) -> None:
    """Positions and values at places of equal arc length along each streamline, its ends included.

    ``values`` is ``(n_points,)`` float64; ``places`` ``(n, m, 3)`` and ``found`` ``(n, m)`` float64 are filled. A value
    between two points of which one has none (NaN) has none. Where a streamline has no length, all places are its first.
    """
    for s in numba.prange(len(offsets) - 1):
        a, b, m = offsets[s], offsets[s + 1], found.shape[1]
        total = 0.0
        for i in range(a + 1, b):
            total += math.sqrt(
                (points[i, 0] - points[i - 1, 0]) ** 2
                + (points[i, 1] - points[i - 1, 1]) ** 2
                + (points[i, 2] - points[i - 1, 2]) ** 2
            )
        i, before, step = a, 0.0, 0.0
        for k in range(m):
            wanted = total * k / max(m - 1, 1)
            # Segment i leads from arc length `before` to `before + step`.
            while i + 1 < b:
                step = math.sqrt(
                    (points[i + 1, 0] - points[i, 0]) ** 2
                    + (points[i + 1, 1] - points[i, 1]) ** 2
                    + (points[i + 1, 2] - points[i, 2]) ** 2
                )
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
