"""Grids of voxels to count in: where they lie, taken from an image or laid about some bounds."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from ...images.affines import affine as checked
from ...images.affines import invert_affine
from ...images.sources import as_image

Array = npt.NDArray[np.float64]

MOST = 1 << 40  # largest number of voxels


@dataclass(frozen=True, eq=False)
class VoxelGrid:
    """Voxels in space.

    Voxel (i, j, k) holds the positions whose indices ``v = inverse(affine) p`` have ``i - 1/2 <= v_1 < i + 1/2``, and
    so on: a position on a face belongs to the voxel above it.
    """

    shape: tuple[int, int, int]  # `(nx, ny, nz)`
    # `(4, 4)` voxel indices, whole at the voxels' centres as in NIfTI, to mm; may be oblique, flipped or sheared
    affine: Array
    space_code: int = 1  # NIfTI's code of the space that these mm are of; 1 is the scanner's
    linear: Array = field(init=False, repr=False)  # (3, 3) mm to voxels

    def __post_init__(self) -> None:
        sides = np.asarray(self.shape)
        if sides.shape != (3,) or sides.dtype.kind not in "iu" or (sides < 1).any():
            raise ValueError(f"the grid's shape is {self.shape!r}; give (nx, ny, nz), three whole numbers above 0")
        affine = checked(self.affine, "the grid's affine")
        object.__setattr__(self, "shape", tuple(int(n) for n in sides))
        object.__setattr__(self, "linear", np.ascontiguousarray(invert_affine(affine, "the grid's affine")[:3, :3]))
        affine.flags.writeable = False
        object.__setattr__(self, "affine", affine)

    @property
    def n_voxels(self) -> int:
        """Voxels of the grid."""
        return math.prod(self.shape)

    @cached_property
    def corner(self) -> Array:
        """``(3,)`` mm: the outer corner of voxel (0, 0, 0), from which faces lie at whole numbers of voxels."""
        return np.asarray(self.affine[:3, 3] - 0.5 * self.affine[:3, :3].sum(axis=1), np.float64)


def grid_about(low: npt.ArrayLike, high: npt.ArrayLike, voxel_size: float | npt.ArrayLike) -> VoxelGrid:
    """Return the grid along the axes of space that holds a box."""
    # Faces lie at whole multiples of the voxel's size, so that grids of one size fit each other.
    size = np.asarray(voxel_size, np.float64)
    if size.shape not in ((), (3,)) or not np.isfinite(size).all() or not (size > 0.0).all():
        raise ValueError(f"voxel_size is {voxel_size!r}; give a finite number of mm above 0, or three")
    size = np.broadcast_to(size, 3)
    with np.errstate(over="ignore"):
        first = np.floor(np.asarray(low, np.float64) / size)
        sides = np.maximum(np.floor(np.asarray(high, np.float64) / size) - first + 1.0, 1.0)
    # Beyond 2^52 multiples of the size are no longer told from each other.
    if not (np.abs(first) < 2.0**52).all() or not math.prod(sides.tolist()) < MOST:
        raise ValueError(
            f"voxels of {size.tolist()} mm are too small for {np.asarray(low).tolist()} to {np.asarray(high).tolist()} "
            "mm; give a larger voxel_size"
        )
    affine = np.diag([*size, 1.0])
    affine[:3, 3] = (first + 0.5) * size
    nx, ny, nz = (int(n) for n in sides)
    return VoxelGrid((nx, ny, nz), affine)


def grid_like(image: Any) -> VoxelGrid:
    """Return the grid of an image."""
    if isinstance(image, VoxelGrid):
        return image
    if isinstance(image, tuple) and len(image) == 2 and np.ndim(image[0]) == 1:  # a shape
        return VoxelGrid(image[0], image[1])
    found = as_image(image, "like")
    if len(found.shape) < 3:
        raise ValueError(f"like has the shape {found.shape}; an image of three axes is needed")
    nx, ny, nz = found.shape[:3]
    return VoxelGrid((nx, ny, nz), found.affine, found.space_code)
