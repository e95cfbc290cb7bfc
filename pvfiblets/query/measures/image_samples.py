"""Values of an image at positions, linear between the centres of voxels."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

__all__ = ["sample_image", "three_axes"]

Floats = npt.NDArray[np.float64]


def three_axes(values: npt.ArrayLike) -> npt.NDArray[Any]:
    """Return an array without axes of length 1 behind the third."""
    whole: npt.NDArray[Any] = np.asarray(values)
    return whole.reshape(whole.shape[:3]) if whole.ndim > 3 and set(whole.shape[3:]) == {1} else whole


def sample_image(volume: npt.ArrayLike, affine: npt.ArrayLike, points: npt.ArrayLike) -> Floats:
    """Return the values of an image at positions."""
    values = three_axes(volume)
    if values.ndim != 3:
        raise ValueError(f"the image has shape {values.shape}; give one of three axes (i, j, k)")
    to_voxel = np.linalg.inv(np.asarray(affine, np.float64))
    at = np.asarray(points, np.float64) @ to_voxel[:3, :3].T + to_voxel[:3, 3]
    last = np.array(values.shape) - 1
    inside = ((at >= -0.5) & (at <= last + 0.5)).all(axis=1)
    found = np.full(len(at), np.nan)
    at = np.clip(at[inside], 0.0, last)
    low = np.minimum(at.astype(np.int64), np.maximum(last - 1, 0))
    share = at - low
    high = np.minimum(low + 1, last)
    total = np.zeros(len(at))
    for corner in range(8):
        side = [(corner >> axis) & 1 for axis in range(3)]
        index = tuple((high if s else low)[:, axis] for axis, s in enumerate(side))
        weight = np.prod([share[:, axis] if s else 1.0 - share[:, axis] for axis, s in enumerate(side)], axis=0)
        # A voxel that takes no part must not make a NaN of it.
        total += np.where(weight > 0.0, weight * values[index].astype(np.float64), 0.0)
    found[inside] = total
    return found
