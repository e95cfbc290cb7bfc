"""Compiled search for how far values may lie off a step's chord (:func:`pvfiblets.volumes.steepness.allowed_bends`)."""

from __future__ import annotations

import math

import numba
import numpy as np
import numpy.typing as npt

from pvfiblets.codec.jit import kernel, parallel_kernel
from pvfiblets.support.array_types import Float32s, Float64s

LEAST = 0.25  # entries: the lowest tent that is tried


def tents(table: npt.NDArray[np.float32], off: float) -> npt.NDArray[np.float64]:
    """Height of tents over the chord of a step up to which light differs by no more than a number."""
    out = np.empty((len(table) - 1, len(table) - 1))
    _tents(table, off, out)
    return out


@kernel
def _half(table: Float32s, front: float, back: float, light: Float64s) -> None:
    """Light of half a step between two values: a whole one's mean colour, and the root of what that leaves."""
    last = len(table) - 1
    front, back = min(max(front, 0.0), float(last)), min(max(back, 0.0), float(last))
    i, j = min(int(front), last - 1), min(int(back), last - 1)
    u, v = front - i, back - j
    for c in range(4):
        light[c] = (1.0 - u) * ((1.0 - v) * table[i, j, c] + v * table[i, j + 1, c]) + u * (
            (1.0 - v) * table[i + 1, j, c] + v * table[i + 1, j + 1, c]
        )
    opacity = light[3]
    light[3] = 1.0 - math.sqrt(max(1.0 - opacity, 0.0))
    share = light[3] / opacity if opacity > 1e-9 else 0.5
    for c in range(3):
        light[c] *= share


@kernel
def _by_way_of(table: Float32s, front: float, middle: float, back: float, light: Float64s, behind: Float64s) -> None:
    """Light of two half steps."""
    _half(table, front, middle, light)
    _half(table, middle, back, behind)
    left = 1.0 - light[3]
    for c in range(4):
        light[c] += left * behind[c]


@parallel_kernel
def _tents(table: Float32s, off: float, out: Float64s) -> None:
    n = len(table) - 1
    for i in numba.prange(n):
        chord, light, behind = np.empty(4), np.empty(4), np.empty(4)
        for j in range(n):
            front, back = i + 0.5, j + 0.5
            middle = 0.5 * (front + back)
            _by_way_of(table, front, middle, back, chord, behind)
            height, before, fine = LEAST, 0.0, 0.0
            while fine < n:
                error = 0.0
                for side in (-1.0, 1.0):
                    _by_way_of(table, front, middle + side * height, back, light, behind)
                    for c in range(4):
                        error = max(error, abs(light[c] - chord[c]))
                if error > off:
                    # Between this one and the last one it grows about evenly.
                    fine += (height - fine) * (off - before) / (error - before)
                    break
                fine, before = height, error
                height = min(2.0 * height, n + 0.0) if height < n else n + 1.0
            out[i, j] = min(fine, n)
