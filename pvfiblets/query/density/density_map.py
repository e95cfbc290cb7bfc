"""What streamlines add up to in the voxels of a grid, and how it leaves for an image of PyVista or a NIfTI file."""

from __future__ import annotations

import gzip
from contextlib import ExitStack
from dataclasses import dataclass
from os import PathLike, fspath
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ...support.whole_files import replacing
from .voxel_grid import VoxelGrid

if TYPE_CHECKING:
    import pyvista

__all__ = ["DensityMap", "check_target"]

Array = npt.NDArray[np.float64]
SUFFIXES = (".nii", ".nii.gz")
NIFTI1_MOST = 32767
"""Voxels along an axis that a NIfTI-1 header can name."""


def check_target(path: str | PathLike[str]) -> None:
    """Raise a ValueError unless a name is one of a NIfTI file."""
    if not fspath(path).lower().endswith(SUFFIXES):
        raise ValueError(f"{fspath(path)} is no name of a NIfTI file; let it end in {' or '.join(SUFFIXES)}")


@dataclass(frozen=True, eq=False)
class DensityMap:
    """Numbers of the voxels of a grid, made by :func:`pvfiblets.density`.

    Goes wherever volumes go: ``plotter.add_raycast_volume(found)``, ``actor.scalars = found.to_image()``.

    Attributes
    ----------
    values : numpy.ndarray
        ``(nx, ny, nz)``, of directions ``(nx, ny, nz, 3)``; int32 where streamlines without weights are counted, else
        float64. 0 where no streamline is, never NaN.
    grid : VoxelGrid
        Where the voxels lie.
    name, unit : str
        What the numbers are.
    share_outside : float
        Share of the streamlines' length, or of their end points, that lies outside the grid and is in no voxel, 0 to 1;
        weights do not count.
    """

    values: npt.NDArray[Any]
    grid: VoxelGrid
    name: str
    unit: str
    share_outside: float

    def __repr__(self) -> str:
        unit = f" ({self.unit})" if self.unit else ""
        return f"DensityMap({self.name}{unit}, {' x '.join(map(str, self.grid.shape))} voxels)"

    @property
    def affine(self) -> Array:
        """``(4, 4)`` voxel indices, whole at the voxels' centres, to mm."""
        return self.grid.affine

    def to_image(self) -> pyvista.ImageData:
        """Return the map as an image whose points are the voxels' centres.

        Returns
        -------
        pyvista.ImageData
            The numbers are its active scalars, named :attr:`name`, without a copy. Its direction matrix carries the
            affine's rotation, flips and shears.
        """
        return image_of(self.values, self.affine, self.name)

    def save(self, path: str | PathLike[str], *, dtype: npt.DTypeLike | None = None) -> None:
        """Write a NIfTI file; it appears under its name when it is whole.

        Parameters
        ----------
        path : str or PathLike
            Ends in ``.nii`` or ``.nii.gz``.
        dtype : dtype_like, optional
            Of the numbers in the file; by default int32 for counts and float32 for everything else.

        Raises
        ------
        ValueError
            If the name has another suffix.
        OSError
            If the place cannot be written to.
        """
        import nibabel

        check_target(path)
        kind = np.dtype(dtype if dtype is not None else np.int32 if self.values.dtype.kind == "i" else np.float32)
        kinds = nibabel.Nifti1Image if max(self.grid.shape) <= NIFTI1_MOST else nibabel.Nifti2Image
        image = kinds(self.values.astype(kind, copy=False), self.affine, dtype=kind)
        code = self.grid.space_code
        image.set_sform(self.affine, code)
        image.set_qform(self.affine, code if _is_rigid(self.affine) else 0)  # a quaternion holds no shear
        image.header.set_xyzt_units("mm")
        image.header["descrip"] = f"pvfiblets density: {self.name}".encode()[:79]
        with ExitStack() as stack:
            file: Any = stack.enter_context(replacing(path))
            if fspath(path).lower().endswith(".gz"):
                file = stack.enter_context(gzip.GzipFile("", "wb", 6, file, mtime=0))
            image.to_stream(file)


def image_of(values: npt.NDArray[Any], affine: Array, name: str) -> pyvista.ImageData:
    """Return numbers ``(i, j, k, ...)`` as an image whose points are the voxels' centres, where an affine puts them."""
    import pyvista

    image = pyvista.ImageData(dimensions=values.shape[:3])
    spacing = np.linalg.norm(affine[:3, :3], axis=0)
    image.origin, image.spacing = affine[:3, 3], spacing
    image.direction_matrix = affine[:3, :3] / spacing
    image.point_data[name] = values.reshape(-1, *values.shape[3:], order="F")
    image.set_active_scalars(name)
    return image


def _is_rigid(affine: Array) -> bool:
    """Whether an affine's axes stand at right angles."""
    axes = affine[:3, :3] / np.linalg.norm(affine[:3, :3], axis=0)
    return bool(np.abs(axes.T @ axes - np.eye(3)).max() < 1e-6)
