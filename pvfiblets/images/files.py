"""Images from files of every format."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from .image import Image

_NIFTI = (".nii", ".nii.gz", ".mgh", ".mgz")
_MIF = (".mif", ".mif.gz", ".mih")
_NRRD = (".nrrd", ".nhdr")
_METAIMAGE = (".mhd", ".mha")
SUFFIXES = (*_NIFTI, *_MIF, *_NRRD, *_METAIMAGE, ".vti")  # suffixes of files with a header


def stem_of(name: str) -> str:
    """Return a file's name without the suffix of an image."""
    return name[: -len(max((one for one in SUFFIXES if name.lower().endswith(one)), key=len, default="")) or None]


def read_image(path: Path) -> Image:
    """Read the header of an image, and its numbers when they are needed."""
    lower = path.name.lower()
    if lower.endswith(_NIFTI):
        from .nifti import read_nifti as read
    elif lower.endswith(_MIF):
        from .mif import read_mif as read
    elif lower.endswith(_NRRD):
        from .nrrd import read_nrrd as read
    elif lower.endswith(_METAIMAGE):
        from .metaimage import read_metaimage as read
    elif lower.endswith(".vti"):
        from .vtk_images import read_vti as read
    else:
        path.stat()  # first of all, whether it is there
        raise ValueError(f"{path.name} is no image; give a file that ends in {', '.join(SUFFIXES)}")
    return replace(read(path), name=stem_of(path.name), what=path.name)
