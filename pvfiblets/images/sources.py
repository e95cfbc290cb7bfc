"""Images from whatever may hold one: paths, arrays with an affine, and objects of nibabel and VTK."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from .affines import affine as checked
from .files import SUFFIXES, read_image
from .image import Image

EXPECTED = (
    f"the path of an image ({', '.join(SUFFIXES)}), an image of nibabel, (array, affine), a pyvista.ImageData, or "
    "anything with values and affine"
)


def is_image(given: Any) -> bool:
    """Return whether something is an image, whole or damaged; a path is one by its suffix."""
    if isinstance(given, Image):
        return True
    if isinstance(given, (str, os.PathLike)):
        return os.fspath(given).lower().endswith(SUFFIXES)
    if isinstance(given, tuple):
        return len(given) == 2 and _n_axes(given[0]) >= 3 and _n_axes(given[1]) < 3
    if hasattr(given, "IsA"):
        return bool(given.IsA("vtkImageData"))
    return hasattr(given, "affine") and (hasattr(given, "dataobj") or hasattr(given, "values"))


def as_image(given: Any, what: str = "the image") -> Image:
    """Take an image from anything that :func:`is_image` accepts."""
    if isinstance(given, Image):
        return given
    if isinstance(given, (str, os.PathLike)):
        return read_image(Path(given).expanduser())
    if isinstance(given, (tuple, list)) and len(given) == 2:
        values, place = filled(given[0]), checked(given[1], f"the affine of {what}")
        return Image(values.shape, place, lambda: values, what=what)
    if not is_image(given):
        raise TypeError(f"{what} is a {type(given).__name__}; give {EXPECTED}")
    if hasattr(given, "IsA"):
        from .vtk_images import of_vtk

        return of_vtk(given, what)
    if hasattr(given, "dataobj"):
        from .nifti import of_nibabel

        return of_nibabel(given, what)
    place, name = checked(given.affine, f"the affine of {what}"), str(getattr(given, "name", ""))
    # Volumes that rays are cast through hold their values less an offset, and their true numbers by this name.
    return Image(np.shape(given.values), place, lambda: filled(getattr(given, "numbers", given.values)), name, what)


def filled(array: Any) -> npt.NDArray[Any]:
    """Return an array whose masked numbers, if it has any, are NaN."""
    if isinstance(array, np.ma.MaskedArray) and np.ma.is_masked(array):
        array = np.ma.filled(array.astype(np.result_type(array.dtype, np.float32)), np.nan)
    return np.asarray(array)


def colour_fields(values: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Return voxels with the fields R, G, B and maybe A as a last axis of three or four bytes."""
    names = values.dtype.names or ()
    if names not in (("R", "G", "B"), ("R", "G", "B", "A")):
        raise ValueError(f"each voxel holds the fields {', '.join(names)}; expected R, G, B and maybe A")
    return np.stack([values[one] for one in names], axis=-1)


def _n_axes(given: Any) -> int:
    try:
        return np.ndim(given)
    except ValueError:  # rows of unlike lengths
        return 0
