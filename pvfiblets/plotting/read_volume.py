"""Volumes of files as PyVista's images, where the file says that they lie."""

from __future__ import annotations

from os import PathLike
from pathlib import Path

import pyvista as pv

from pvfiblets.plotting.fiblets.volume_sources import SUFFIXES, as_volume
from pvfiblets.query.density.map_files import image_of

__all__ = ["read_volume"]


def read_volume(path: str | PathLike[str]) -> pv.ImageData:
    """Read a NIfTI or MGH file with its place in space, which ``pv.read`` loses.

    Parameters
    ----------
    path : str or PathLike
        Ends in ``.nii``, ``.nii.gz``, ``.mgh`` or ``.mgz``.

    Returns
    -------
    pyvista.ImageData
        Its points are the voxels' centres, in the millimetres of the file's affine: origin, spacing and direction
        matrix carry it, as nibabel reads it. The numbers are its active scalars, under the file's name.

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    ValueError
        If it has another suffix, or more than one number per voxel.

    Examples
    --------
    >>> import pvfiblets
    >>> image = pvfiblets.read_volume("fa.nii.gz")  # doctest: +SKIP
    >>> plotter.add_fiblets("brain.trx", scalars=image)  # doctest: +SKIP
    """
    place = Path(path).expanduser()
    if not place.name.lower().endswith(SUFFIXES):
        raise ValueError(f"{path} is no volume that is read here; give a file that ends in {', '.join(SUFFIXES)}")
    source = as_volume(place)
    assert source is not None  # of that suffix
    return image_of(source.values, source.affine, source.name)
