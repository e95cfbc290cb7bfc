"""From whatever holds a volume to a source of colours: images of PyVista, arrays with an affine, and NIfTI."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np
import pyvista as pv

from pvfiblets.engine.fiblets.data.sampled_volume import VolumeSource
from pvfiblets.support.nifti_space import affine_of

SUFFIXES = (".nii", ".nii.gz", ".mgh", ".mgz")
"""Of a text that is not the name of an array but the path of a volume."""


def as_volume(scalars: Any) -> VolumeSource | None:
    """Return the volume that ``scalars`` are; ``None`` if they are something else."""
    if isinstance(scalars, VolumeSource):
        return scalars
    if isinstance(scalars, pv.ImageData):
        return _of_image(scalars)
    if isinstance(scalars, tuple) and len(scalars) == 2 and np.ndim(scalars[1]) == 2:
        values = np.asarray(scalars[0])
        if values.ndim < 3:
            return None
        return VolumeSource(_three_axes(values, "the volume"), np.asarray(scalars[1]))
    if isinstance(scalars, (str, os.PathLike)):
        path = os.fspath(scalars)
        if not path.lower().endswith(SUFFIXES):
            return None
        import nibabel as nib

        name = Path(path).name
        return _of_nibabel(nib.load(path), name, name.partition(".")[0])
    if hasattr(scalars, "dataobj") and hasattr(scalars, "affine"):
        return _of_nibabel(scalars, "the image", "volume")
    return None


def _three_axes(values: np.ndarray, what: str) -> np.ndarray:
    """Return an array without axes of one behind the third."""
    shape = values.shape
    if len(shape) < 3 or any(n != 1 for n in shape[3:]):
        raise ValueError(
            f"{what} has shape {shape}; one number per voxel is needed: give one of its volumes, "
            "such as image[..., 0]"
        )
    return values.reshape(shape[:3]) if len(shape) > 3 else values


def _of_nibabel(image: Any, what: str, name: str) -> VolumeSource:
    """Return a volume of nibabel's; numbers are as stored unless the file scales them."""
    affine = affine_of(image)
    if affine is None:
        raise ValueError(f"{what} has no affine; give (array, affine)")
    _three_axes(np.broadcast_to(np.float32(0), image.shape), what)  # before anything is read
    values = _three_axes(np.asanyarray(image.dataobj), what)
    return VolumeSource(values, affine, name=name)


def _of_image(image: pv.ImageData) -> VolumeSource:
    """Return an image's active scalars where they lie."""
    association, name = image.active_scalars_info
    if name is None:
        raise ValueError(
            f"the image has no active scalars among its arrays {image.array_names}; give it some, "
            "such as image['fa'] = values, or choose by image.set_active_scalars(name)"
        )
    data = image.point_data if association == pv.FieldAssociation.POINT else image.cell_data
    of_cells = data.association == pv.FieldAssociation.CELL
    values = np.asarray(data[name])
    sides = tuple(max(n - 1, 1) if of_cells else n for n in image.dimensions)
    if values.ndim != 1:
        raise ValueError(
            f"the image's array {name!r} has {values.shape[1]} numbers per voxel; one is needed: "
            "take a column, or a norm, first"
        )
    place = np.array(image.index_to_physical_matrix, np.float64)
    first = np.array(image.extent[0::2], np.float64)
    if of_cells:
        first += [0.5 if n > 1 else 0.0 for n in image.dimensions]
    place[:3, 3] += place[:3, :3] @ first
    return VolumeSource(values.reshape(sides, order="F"), place, name=name)
