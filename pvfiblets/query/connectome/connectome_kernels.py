"""Compiled kernels: which label is nearest to a point; see :mod:`.matrix`."""

from __future__ import annotations

import math

import numba
import numpy as np

from ...codec.jit import parallel_kernel
from ...support.array_types import Float64s, Int64s

BLOCK = 256  # points a thread looks at in one go


@parallel_kernel
def nearest_labels(points: Float64s, labels: Int64s, inverse: Float64s, linear: Float64s, offsets: Int64s,
                   distances: Float64s, slack: float, radius: float, found: Int64s) -> None:  # fmt: skip
    """Give each point the label of the nearest centre of a labelled voxel, at most a radius away."""
    for block in numba.prange((len(points) + BLOCK - 1) // BLOCK):
        for p in range(block * BLOCK, min((block + 1) * BLOCK, len(points))):
            found[p] = 0
            if not math.isfinite(points[p, 0] + points[p, 1] + points[p, 2]):
                continue
            v = np.empty(3)
            cell = np.empty(3, np.int64)
            far = False
            for axis in range(3):
                v[axis] = inverse[axis, 3]
                for k in range(3):
                    v[axis] += inverse[axis, k] * points[p, k]
                far |= not abs(v[axis]) < 2.0**40
                cell[axis] = np.int64(math.floor(v[axis] + 0.5)) if not far else 0
            if far:
                continue
            best = math.inf if radius == 0.0 else radius
            for m in range(len(offsets)):
                # Whatever comes later is at least so far from the point.
                if m > 0 and (radius == 0.0 or distances[m] - slack > best):
                    break
                i, j, k = cell[0] + offsets[m, 0], cell[1] + offsets[m, 1], cell[2] + offsets[m, 2]
                if i < 0 or j < 0 or k < 0 or i >= labels.shape[0] or j >= labels.shape[1] or k >= labels.shape[2]:
                    continue
                if labels[i, j, k] == 0:
                    continue
                square = 0.0
                for axis in range(3):
                    d = linear[axis, 0] * (i - v[0]) + linear[axis, 1] * (j - v[1]) + linear[axis, 2] * (k - v[2])
                    square += d * d
                away = math.sqrt(square)
                if away < best or (away == best and found[p] == 0):
                    best, found[p] = away, labels[i, j, k]
