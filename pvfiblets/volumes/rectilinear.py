"""Grids whose planes lie at uneven distances, on the even ones that rays are cast through."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

MOST_TIMES = 4  # greatest ratio of the even grid's planes along an axis to the uneven one's

EVEN = 1e-6  # tolerance of even planes, as a part of the mean distance

Array = npt.NDArray[np.float64]


def evenly(values: npt.NDArray[Any], axes: tuple[Array, Array, Array]) -> tuple[npt.NDArray[Any], Array]:
    """Return the values at even distances, and their affine."""
    affine = np.eye(4)
    for axis, at in enumerate(axes):
        apart = np.diff(at)
        if not (np.isfinite(at).all() and (apart > 0.0).all()):
            raise ValueError(f"the grid's {'xyz'[axis]} coordinates do not increase; sort them, and leave doubles out")
        affine[axis, 3] = at[0]
        if not len(apart):
            continue
        span = float(at[-1] - at[0])
        if (np.abs(apart - apart.mean()) > EVEN * apart.mean()).any():
            count = min(int(np.ceil(span / apart.min())) + 1, MOST_TIMES * len(at))
            values = _along(values, axis, at, np.linspace(at[0], at[-1], count))
            affine[axis, axis] = span / (count - 1)
        else:
            affine[axis, axis] = span / len(apart)
    return values, affine


def _along(values: npt.NDArray[Any], axis: int, at: Array, wanted: Array) -> npt.NDArray[np.float32]:
    """Values at places along an axis, interpolated linearly."""
    below = np.clip(np.searchsorted(at, wanted, side="right") - 1, 0, len(at) - 2)
    share = ((wanted - at[below]) / (at[below + 1] - at[below])).astype(np.float32)
    shape = [-1 if k == axis else 1 for k in range(3)]
    low, high = (np.take(values, below + k, axis).astype(np.float32) for k in (0, 1))
    made: npt.NDArray[np.float32] = low + share.reshape(shape) * (high - low)
    return made
