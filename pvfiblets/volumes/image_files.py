"""Images of three, four and five axes from files, as their formats keep them, in RAS+ mm."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from pvfiblets.support.nifti_space import affine_of

__all__ = ["SUFFIXES", "colour_fields", "read_image", "values_of_nibabel"]

NIBABEL = (".nii", ".nii.gz", ".mgh", ".mgz")
SUFFIXES = (*NIBABEL, ".mif", ".mif.gz", ".mih", ".nrrd", ".nhdr", ".mhd", ".mha", ".vti")
"""Of files that say what they hold."""

LABEL_INTENT = 1002
"""NIFTI_INTENT_LABEL."""

Array = npt.NDArray[np.float64]


def read_image(path: Path) -> tuple[npt.NDArray[Any], Array, str, bool]:
    """Read an image."""
    lower = path.name.lower()
    suffix = max((one for one in SUFFIXES if lower.endswith(one)), key=len, default=None)
    if suffix is None:
        path.stat()  # first of all, whether it is there
        raise ValueError(f"{path.name} is no image that is read here; give a file that ends in {', '.join(SUFFIXES)}")
    name = path.name[: -len(suffix)]
    if suffix in NIBABEL:
        from .nibabel_files import opened

        with opened(path) as image:
            values, affine, is_labels = values_of_nibabel(image)
        return values, affine, name, is_labels
    if suffix in (".mif", ".mif.gz", ".mih"):
        from .mif import read_mif

        return *read_mif(path), name, False
    if suffix in (".nrrd", ".nhdr"):
        from .nrrd import read_nrrd

        return *read_nrrd(path, components=True), name, False
    if suffix in (".mhd", ".mha"):
        from .metaimage import read_metaimage

        return *read_metaimage(path, components=True), name, False
    from .sources import as_raycast_volume

    volume = as_raycast_volume(path)
    return volume.numbers, volume.affine, name, False


def values_of_nibabel(image: Any) -> tuple[npt.NDArray[Any], Array, bool]:
    """Return the numbers of an image of nibabel, scaled ones as float32, its affine, and whether they are labels."""
    affine = affine_of(image)
    if affine is None:
        raise ValueError("the image has no affine; give (array, affine)")
    data = image.dataobj
    kind = getattr(data, "dtype", np.dtype(np.float32))
    scaled = getattr(data, "slope", 1.0) not in (1.0, None) or getattr(data, "inter", 0.0) not in (0.0, None)
    if scaled and hasattr(data, "get_scaled") and kind.kind in "iuf":
        values = data.get_scaled(dtype=np.float32)  # half of what the default, float64, takes
    else:
        values = np.asarray(data)
    header = getattr(image, "header", None)
    intent = header["intent_code"] if header is not None and "intent_code" in header else 0
    return values, affine, int(intent) == LABEL_INTENT


def colour_fields(values: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Return voxels with the fields R, G, B and maybe A as a last axis of three or four bytes."""
    names = values.dtype.names or ()
    if names not in (("R", "G", "B"), ("R", "G", "B", "A")):
        raise ValueError(f"each voxel holds the fields {', '.join(names)}; expected R, G, B and maybe A")
    return np.stack([values[one] for one in names], axis=-1)
