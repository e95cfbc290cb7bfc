"""Compiled kernels: distances between original and decoded points, and sums of errors."""

from __future__ import annotations

import math
from typing import Any

import numba
import numpy as np

from ..jit import kernel, parallel_kernel

__all__ = ["add_up", "distances"]


@parallel_kernel
def distances(true: Any, drawn: Any, single: bool, distance: Any) -> None:
    """Distance of every decoded point from its original.

    Parameters
    ----------
    true, drawn : (n, 3) float32 or float64
        mm.
    single : bool
        Whether decoded points come as float32, and rounding to it is part of the error.
    distance : (n,) float64
        Filled, mm.
    """
    for i in numba.prange(len(true)):
        square = 0.0
        for j in range(3):
            value = drawn[i, j]
            delta = np.float64(true[i, j]) - (np.float64(np.float32(value)) if single else np.float64(value))
            square += delta * delta
        distance[i] = math.sqrt(square)


@kernel
def add_up(values: Any, weights: Any, scale: float, up: bool, histogram: Any) -> Any:
    """Sum, by weights, and largest of some values, which are counted into a histogram.

    Parameters
    ----------
    values : (n,) float64
        None is negative.
    weights : (n,) uint8
        How often each counts.
    scale : float
        Bins a unit of the values.
    up : bool
        Whether a bin ends with its edge, rather than begins there.
    histogram : (n_bins,) int64
        Added to; the last bin has all that is beyond.
    """
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
