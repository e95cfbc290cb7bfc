"""Sums of streamlines in the voxels of a grid, and their conversion to PyVista images and files."""

from __future__ import annotations

from dataclasses import dataclass
from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from .map_files import check_suffix, image_of, write_map
from .voxel_grid import VoxelGrid

if TYPE_CHECKING:
    import pyvista

Array = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class DensityMap:
    """A number for each voxel of a grid, made by :func:`pvfiblets.density`.

    It is accepted wherever volumes are: ``plotter.add_raycast_volume(found)``, ``actor.scalars = found.to_image()``.

    Attributes
    ----------
    values : numpy.ndarray
        ``(nx, ny, nz)``, of directions ``(nx, ny, nz, 3)``; int32 where streamlines without weights are counted, else
        float64. 0 where no streamline is, never NaN.
    grid : VoxelGrid
        Position of the voxels.
    name, unit : str
        Name and unit of the numbers.
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
        """Write a file of NIfTI, MRtrix or VTK; it appears under its name when it is whole.

        Parameters
        ----------
        path : str or PathLike
            Ends in ``.nii``, ``.nii.gz``, ``.mif``, ``.mif.gz`` or ``.vti``. Of VTK's image the points are the voxels'
            centres, as of :meth:`to_image`.
        dtype : dtype_like, optional
            Of the numbers in the file; by default int32 for counts and float32 for everything else.

        Raises
        ------
        ValueError
            If the name has another suffix, or MIF has no such type.
        OSError
            If the place cannot be written to.
        """
        check_suffix(path)
        kind = np.dtype(dtype if dtype is not None else np.int32 if self.values.dtype.kind == "i" else np.float32)
        write_map(path, self.values.astype(kind, copy=False), self.grid, self.name)
