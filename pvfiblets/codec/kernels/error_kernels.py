"""Compiled kernels: distances between original and decoded points, and sums of errors."""

from __future__ import annotations

import math

import numba
import numpy as np

from ...support.array_types import Float64s, Floats, Int64s, UInt8s
from ..jit import kernel, parallel_kernel


@parallel_kernel
def distances(true: Floats, drawn: Float64s, single: bool, distance: Float64s) -> None:
    """Distance of every decoded point from its original."""
    for i in numba.prange(len(true)):
        square = 0.0
        for j in range(3):
            value = drawn[i, j]
            delta = np.float64(true[i, j]) - (np.float64(np.float32(value)) if single else np.float64(value))
            square += delta * delta
        distance[i] = math.sqrt(square)


@kernel
def add_up(values: Float64s, weights: UInt8s, scale: float, up: bool, histogram: Int64s) -> tuple[float, float]:
    """Sum, by weights, and largest of some values, which are counted into a histogram."""
    total = largest = 0.0
    last = len(histogram) - 1
    for i in range(len(values)):
        value = values[i]
        place = value * scale
        if up:
            place = math.ceil(place)
        histogram[int(place) if place < last else last] += weights[i]
        total += value * weights[i]
        largest = max(largest, value)
    return total, largest
