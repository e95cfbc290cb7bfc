"""Compiled kernel of Gaussian smoothing."""

from __future__ import annotations

import numba
import numpy as np

from pvfiblets.codec.jit import parallel_kernel
from pvfiblets.support.array_types import Float32s, Float64s

STRIP = 512  # numbers of a row that are summed together: 4 KB, which stay in the cache


@parallel_kernel
def along(values: Float32s, weights: Float64s, out: Float32s) -> None:
    """Filter the middle axis of a contiguous float32 array, ends repeated; sums are float64."""
    before, n, after = values.shape
    reach = len(weights) // 2
    if after == 1:
        for row in numba.prange(before):
            for i in range(n):
                total = 0.0
                for k in range(-reach, reach + 1):
                    total += weights[k + reach] * values[row, min(max(i + k, 0), n - 1), 0]
                out[row, i, 0] = total
    else:
        for each in numba.prange(before * n):
            row, i = each // n, each % n
            total_of = np.empty(STRIP)
            for first in range(0, after, STRIP):
                size = min(STRIP, after - first)
                total_of[:size] = 0.0
                for k in range(-reach, reach + 1):
                    at, weight = min(max(i + k, 0), n - 1), weights[k + reach]
                    for j in range(size):
                        total_of[j] += weight * values[row, at, first + j]
                for j in range(size):
                    out[row, i, first + j] = total_of[j]
