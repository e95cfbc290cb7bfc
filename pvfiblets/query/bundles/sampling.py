"""Values of images at positions, by trilinear interpolation in float64."""

from __future__ import annotations

import os
from typing import Any

import numpy as np
import numpy.typing as npt

from ...support.nifti_space import affine_of
from ..density.voxel_grid import grid_like
from ..measures.image_samples import three_axes

__all__ = ["Image", "as_image"]

Floats = npt.NDArray[np.float64]


class Image:
    """Numbers on a grid, to be had anywhere between the centres of its voxels.

    Parameters
    ----------
    values : numpy.ndarray
        ``(i, j, k)`` numbers.
    affine : numpy.ndarray
        ``(4, 4)`` voxel indices to mm.
    """

    def __init__(self, values: npt.NDArray[Any], affine: npt.NDArray[np.float64]) -> None:
        if values.ndim != 3 or values.dtype.kind not in "buif":
            raise ValueError(
                f"the image has the shape {values.shape} and type {values.dtype}; one number per voxel is needed: "
                "give one of its volumes, such as (image[..., 0], affine)"
            )
        self.values, self.affine = values, affine
        self._inverse = np.linalg.inv(affine)

    def at(self, points: npt.ArrayLike) -> Floats:
        """Return the values at positions."""
        v = np.asarray(points, np.float64) @ self._inverse[:3, :3].T + self._inverse[:3, 3]
        sides = np.array(self.values.shape)
        inside = ((v >= -0.5) & (v <= sides - 0.5)).all(axis=1)
        out = np.full(len(v), np.nan)
        v = np.clip(v[inside], 0.0, sides - 1.0)
        low = np.minimum(np.floor(v).astype(np.int64), np.maximum(sides - 2, 0))
        high, t = np.minimum(low + 1, sides - 1), v - low
        total = np.zeros(len(v))
        for corner in range(8):
            upper = [bool(corner >> axis & 1) for axis in range(3)]
            at = tuple((high if up else low)[:, axis] for axis, up in enumerate(upper))
            weight = np.prod([t[:, axis] if up else 1.0 - t[:, axis] for axis, up in enumerate(upper)], axis=0)
            # Nothing is added of a voxel without weight, which may be NaN.
            total += np.where(weight > 0.0, weight * self.values[at], 0.0)
        out[inside] = total
        return out


def as_image(given: Any) -> Image | None:
    """Take an image, None if it is something else."""
    if isinstance(given, Image):
        return given
    if isinstance(given, (str, os.PathLike)):
        from ..density.voxel_grid import SUFFIXES

        if not os.fspath(given).lower().endswith(SUFFIXES):
            return None
        import nibabel

        given = nibabel.load(given)
    if hasattr(given, "dataobj") and hasattr(given, "affine"):
        affine = affine_of(given)
        if affine is None:
            raise ValueError("the image has no affine; give (array, affine)")
        return Image(three_axes(np.asanyarray(given.dataobj)), affine)
    if isinstance(given, tuple) and len(given) == 2 and np.shape(given[1]) == (4, 4):
        return Image(three_axes(np.asarray(given[0])), np.asarray(given[1], np.float64))
    if hasattr(given, "IsA") and given.IsA("vtkImageData"):
        grid = grid_like(given)
        return Image(np.asarray(given.active_scalars).reshape(grid.shape, order="F"), grid.affine)
    if hasattr(given, "affine") and hasattr(given, "values"):
        return Image(three_axes(np.asarray(given.values)), np.asarray(given.affine, np.float64))
    return None
