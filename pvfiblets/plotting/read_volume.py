"""Volumes of files as PyVista's images, where the file says that they lie."""

from __future__ import annotations

from os import PathLike

import pyvista as pv

from pvfiblets.images.sources import as_image
from pvfiblets.query.density.map_files import image_of


def read_volume(path: str | PathLike[str]) -> pv.ImageData:
    """Read an image file with its position and orientation, which ``pv.read`` discards.

    Parameters
    ----------
    path : str or PathLike
        Of NIfTI, MGH, MRtrix, NRRD, MetaImage or VTK's ``.vti``.

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
    image = as_image(path)
    return image_of(image.single, image.affine, image.name)
