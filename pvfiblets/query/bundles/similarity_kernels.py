"""Compiled kernels: streamlines of few points, how far they are apart, and clusters of them.

The distance is the minimum average direct-flip one (MDF): the mean distance of corresponding points, taken directly and
with one of the two streamlines turned round, whichever is less (Garyfallidis et al. 2012, section 2.2). The distance of
the two mean points is never greater, which settles most pairs.
"""

from __future__ import annotations

import math
from typing import Any

import numba
import numpy as np

from ...codec.jit import kernel, parallel_kernel
from ...support.array_types import Float32s, Float64s, Floats, Int32s, Int64s

BLOCK = 128  # streamlines that a thread takes at a time
SLACK = 1e-3  # mm, for rounding of means to float32


@parallel_kernel
def resample(points: Floats, offsets: Int64s, out: Float32s) -> None:
    """Positions at equal arc length along each streamline, its ends included."""
    n, m = out.shape[0], out.shape[1]
    for block in numba.prange((n + BLOCK - 1) // BLOCK):
        first, last = block * BLOCK, min((block + 1) * BLOCK, n)
        most = 0
        for s in range(first, last):
            most = max(most, offsets[s + 1] - offsets[s])
        arc = np.empty(max(most, 1))
        for s in range(first, last):
            a, count = offsets[s], offsets[s + 1] - offsets[s]
            arc[0] = 0.0
            for i in range(1, count):
                dx = float(points[a + i, 0]) - float(points[a + i - 1, 0])
                dy = float(points[a + i, 1]) - float(points[a + i - 1, 1])
                dz = float(points[a + i, 2]) - float(points[a + i - 1, 2])
                arc[i] = arc[i - 1] + math.sqrt(dx * dx + dy * dy + dz * dz)
            total, i = arc[count - 1], 0
            for k in range(m):
                wanted = total * k / max(m - 1, 1)
                while i + 2 < count and arc[i + 1] < wanted:
                    i += 1
                step = arc[i + 1] - arc[i] if i + 1 < count else 0.0
                t = min(max((wanted - arc[i]) / step, 0.0), 1.0) if step > 0.0 else 0.0
                for axis in range(3):
                    p = float(points[a + i, axis])
                    if t > 0.0:
                        p += t * (float(points[a + i + 1, axis]) - p)
                    out[s, k, axis] = p


@kernel
def _mean_gap(a: Float32s, b: Float32s, flipped: bool, limit: float) -> float:
    """Mean distance of the points of two lines; some number above `limit` if it is above that."""
    n = len(a)
    total, most = 0.0, limit * n
    for i in range(n):
        j = n - 1 - i if flipped else i
        dx, dy, dz = float(a[i, 0]) - b[j, 0], float(a[i, 1]) - b[j, 1], float(a[i, 2]) - b[j, 2]
        total += math.sqrt(dx * dx + dy * dy + dz * dz)
        if total > most:
            return np.inf
    return total / n


@parallel_kernel
def nearest(lines: Float32s, others: Float32s, limit: float, distances: Float64s, which: Int64s) -> None:
    """Nearest of some lines to each line."""
    m, k = lines.shape[1], len(others)
    means = np.zeros((k, 3))
    for j in range(k):
        for i in range(m):
            for axis in range(3):
                means[j, axis] += others[j, i, axis] / m
    for block in numba.prange((len(lines) + BLOCK - 1) // BLOCK):
        for s in range(block * BLOCK, min((block + 1) * BLOCK, len(lines))):
            x, y, z = 0.0, 0.0, 0.0
            for i in range(m):
                x += lines[s, i, 0]
                y += lines[s, i, 1]
                z += lines[s, i, 2]
            x, y, z = x / m, y / m, z / m
            best, found = limit, -1
            for j in range(k):
                reach = best + SLACK
                if (x - means[j, 0]) ** 2 + (y - means[j, 1]) ** 2 + (z - means[j, 2]) ** 2 > reach * reach:
                    continue
                for flipped in (False, True):
                    gap = _mean_gap(lines[s], others[j], flipped, best)
                    if gap < best or (gap == best and found < 0):
                        best, found = gap, j
            distances[s] = best if found >= 0 else np.inf
            which[s] = found


@parallel_kernel
def pairs(lines: Any, others: Any, out: Any) -> None:
    """Distance of each line from each of some others, ``(n, k)`` float64, mm."""
    for s in numba.prange(len(lines)):
        for j in range(len(others)):
            direct = _mean_gap(lines[s], others[j], False, np.inf)
            out[s, j] = min(direct, _mean_gap(lines[s], others[j], True, np.inf))


@kernel
def add_to_clusters(lines: Float32s, first: int, threshold: float, most: int, centroids: Float32s, means: Float32s,
                    counts: Int64s, used: int, labels: Int32s) -> tuple[int, int]:  # fmt: skip
    """Put lines into clusters, one after the other; QuickBundles (Garyfallidis et al. 2012, section 2.3)."""
    n, m, room = lines.shape[0], lines.shape[1], len(counts)
    squares = np.empty(room, np.float32)
    for s in range(first, n):
        line = lines[s]
        x, y, z = 0.0, 0.0, 0.0
        for i in range(m):
            x += line[i, 0]
            y += line[i, 1]
            z += line[i, 2]
        fx, fy, fz = np.float32(x / m), np.float32(y / m), np.float32(z / m)
        for j in range(used):
            dx, dy, dz = means[0, j] - fx, means[1, j] - fy, means[2, j] - fz
            squares[j] = dx * dx + dy * dy + dz * dz
        best = threshold if used < most else np.inf
        reach = np.float32((best + SLACK) * (best + SLACK))
        found, turned = -1, False
        for j in range(used):
            if squares[j] > reach:
                continue
            for flipped in (False, True):
                gap = _mean_gap(line, centroids[j], flipped, best)
                if gap < best or (gap <= best and found < 0):
                    best, found, turned = gap, j, flipped
                    reach = np.float32((best + SLACK) * (best + SLACK))
        if found < 0:
            if used == room:
                return s, used
            found = used
            used += 1
        size = counts[found]
        for axis in range(3):
            mean = 0.0
            for i in range(m):
                value = line[m - 1 - i if turned else i, axis]
                new = (centroids[found, i, axis] * np.float32(size) + value) / np.float32(size + 1)
                centroids[found, i, axis] = new
                mean += new
            means[axis, found] = mean / m
        counts[found] = size + 1
        labels[s] = found
    return n, used
