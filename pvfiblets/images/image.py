"""Numbers on a grid of voxels, and where the grid lies."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from .affines import affine as checked
from .affines import invert_affine
from .sampling import sample

Array = npt.NDArray[np.float64]


def three_axes(values: npt.ArrayLike) -> npt.NDArray[Any]:
    """Return an array without axes of length 1 behind the third."""
    whole: npt.NDArray[Any] = np.asarray(values)
    return whole.reshape(whole.shape[:3]) if whole.ndim > 3 and set(whole.shape[3:]) == {1} else whole


@dataclass(frozen=True, eq=False)
class Image:
    """An image in RAS+ mm, whose numbers are read when they are first needed."""

    shape: tuple[int, ...]  # (nx, ny, nz), and volumes or components behind them
    affine: Array  # (4, 4) voxel indices to mm
    read: Callable[[], npt.NDArray[Any]] = field(repr=False)
    name: str = ""  # of what the numbers are, if it is known
    what: str = "the image"  # what errors call it, such as a file's name
    is_labels: bool = False  # the file says that its numbers are labels
    space_code: int = 1  # NIfTI's code of the space that these mm are of

    @cached_property
    def values(self) -> npt.NDArray[Any]:
        """The numbers, in the image's shape."""
        return self.read()

    @cached_property
    def inverse(self) -> Array:
        """``(4, 4)`` mm to voxel indices."""
        what = f"the affine of {self.what}"
        return invert_affine(checked(self.affine, what), what)

    @property
    def single(self) -> npt.NDArray[Any]:
        """The numbers ``(nx, ny, nz)`` of an image that has one for each voxel."""
        if len(self.shape) < 3 or any(n != 1 for n in self.shape[3:]):  # before anything is read
            colours = ", as RGB colours have" if len(self.shape) == 4 and self.shape[3] in (3, 4) else ""
            volume = ": give one of its volumes, such as (image[..., 0], affine)" if len(self.shape) > 3 else ""
            raise ValueError(
                f"{self.what} has the shape {self.shape}{colours}; three axes (nx, ny, nz) with one number per voxel "
                f"are needed{volume}"
            )
        values = self.values
        if values.dtype.names is not None:
            raise ValueError(
                f"{self.what} holds colours, the fields {', '.join(values.dtype.names)} of each voxel; one number each "
                "is needed: take one of them, or their mean"
            )
        if values.dtype.kind not in "biuf":
            raise ValueError(f"{self.what} is of type {values.dtype}; give real numbers, such as abs() of complex ones")
        return three_axes(values)

    @cached_property
    def labels(self) -> npt.NDArray[Any]:
        """The whole numbers ``(nx, ny, nz)`` of an image of labels; NaN is 0, no label."""
        values = self.single
        if values.dtype.kind in "biu":
            return values
        whole = np.nan_to_num(np.rint(values), nan=0.0)
        if not np.array_equal(whole, np.where(np.isnan(values), 0.0, values)) or not np.isfinite(whole).all():
            raise ValueError(
                f"{self.what} holds fractions, not labels; compare it first, as in (image > 0.5).astype(int)"
            )
        return whole.astype(np.int64)

    def at(self, points: npt.ArrayLike, *, nearest: bool | None = None) -> Array:
        """Return the values at points ``(n, 3)`` in mm, ``(n,)``; NaN outside. By default whole numbers are nearest."""
        values = self.single
        is_nearest = values.dtype.kind in "bui" if nearest is None else nearest
        return sample(values, self.inverse, points, nearest=is_nearest)
