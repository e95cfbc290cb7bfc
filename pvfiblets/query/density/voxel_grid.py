"""Grids of voxels to count in: where they lie, taken from an image or laid about some bounds."""

from __future__ import annotations

import math
import os
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from ...errors import FormatError
from ...support.nifti_space import affine_of, code_of
from ..regions.placement import affine as checked
from ..regions.placement import invert_affine

__all__ = ["VoxelGrid", "grid_about", "grid_like"]

Array = npt.NDArray[np.float64]

MOST = 1 << 40
"""Voxels beyond which no machine's memory is asked."""
SUFFIXES = (".nii", ".nii.gz", ".mgh", ".mgz")
_EXPECTED = (
    "an image of nibabel or its path (" + ", ".join(SUFFIXES) + "), a pyvista.ImageData, (array, affine), "
    "(shape, affine), or something with values and affine"
)


@dataclass(frozen=True, eq=False)
class VoxelGrid:
    """Voxels in space.

    Voxel (i, j, k) holds the positions whose indices ``v = inverse(affine) p`` have ``i - 1/2 <= v_1 < i + 1/2``, and
    so on: a position on a face belongs to the voxel above it.

    Parameters
    ----------
    shape : tuple of int
        ``(nx, ny, nz)``.
    affine : array_like
        ``(4, 4)`` voxel indices, whole at the voxels' centres as in NIfTI, to mm; may be oblique, flipped or sheared.
    space_code : int
        NIfTI's code of the space that these mm are of; 1 is the scanner's.

    Raises
    ------
    ValueError
        If the affine cannot be inverted, or a side is no whole number above 0.
    """

    shape: tuple[int, int, int]
    affine: Array
    space_code: int = 1
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
    """Return the grid along the axes of space that holds a box.

    Faces lie at whole multiples of the voxel's size, so that grids of one size fit each other.
    """
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
    if isinstance(image, (str, os.PathLike)):
        return grid_like(_loaded(os.fspath(image)))
    if hasattr(image, "IsA") and image.IsA("vtkImageData"):
        return _of_vtk(image)
    if hasattr(image, "affine") and hasattr(image, "dataobj"):
        affine = affine_of(image)
        if affine is None:
            raise ValueError("like is an image without an affine; give (array, affine)")
        return VoxelGrid(_sides(image.shape), affine, code_of(image))
    if hasattr(image, "affine") and hasattr(image, "values"):
        return VoxelGrid(_sides(np.shape(image.values)), image.affine)
    if isinstance(image, tuple) and len(image) == 2 and np.shape(image[1]) == (4, 4):
        shape = image[0] if np.ndim(image[0]) == 1 else np.shape(image[0])
        return VoxelGrid(_sides(shape), image[1])
    raise TypeError(f"like is a {type(image).__name__}; give {_EXPECTED}")


def _sides(shape: Any) -> tuple[int, int, int]:
    if len(shape) < 3:
        raise ValueError(f"like has the shape {tuple(shape)}; an image of three axes is needed")
    return shape[0], shape[1], shape[2]


def _loaded(path: str) -> Any:
    if not path.lower().endswith(SUFFIXES):
        raise ValueError(f"like is {path!r}, no image that nibabel reads; give {_EXPECTED}")
    import nibabel
    from nibabel.filebasedimages import ImageFileError
    from nibabel.spatialimages import HeaderDataError

    try:
        return nibabel.load(path)
    except (ImageFileError, HeaderDataError, EOFError) as error:
        raise FormatError(path, None, f"what nibabel cannot read ({error})", "a NIfTI or MGH image") from None


def _of_vtk(image: Any) -> VoxelGrid:
    sides = np.array(image.GetDimensions())
    first = np.array(image.GetExtent()[0::2], np.float64)
    of_cells = image.GetPointData().GetScalars() is None and image.GetCellData().GetScalars() is not None
    if hasattr(image, "active_scalars_info"):  # PyVista says which of the two is meant
        association, name = image.active_scalars_info
        of_cells = name is not None and getattr(association, "name", "") == "CELL"
    if of_cells:
        first += np.where(sides > 1, 0.5, 0.0)
        sides = np.maximum(sides - 1, 1)
    matrix = image.GetIndexToPhysicalMatrix()
    place = np.array([[matrix.GetElement(i, j) for j in range(4)] for i in range(4)])
    place[:3, 3] += place[:3, :3] @ first
    return VoxelGrid((int(sides[0]), int(sides[1]), int(sides[2])), place)
