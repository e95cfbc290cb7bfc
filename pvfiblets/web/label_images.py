"""Images of slices that may have a table of labels: what a layer of the kind ``"image"`` is made of."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from pvfiblets.slices.image import SliceImage, as_slice_image
from pvfiblets.slices.labels import LabelTable, as_label_table

__all__ = ["LabelledImage", "facts_of", "read_image", "with_table"]

LARGEST = 4 << 20  # bytes of a table


@dataclass(frozen=True, eq=False)
class LabelledImage(SliceImage):
    """An image, and what its labels are called.

    Parameters
    ----------
    table : LabelTable, optional
    """

    table: LabelTable | None = None


def read_image(place: Path) -> LabelledImage:
    """Read an image; errors as of :func:`.as_slice_image`."""
    found = as_slice_image(place)
    return LabelledImage(found.values, found.affine, found.name, found.is_labels, found.is_colours)


def with_table(image: LabelledImage, place: Path) -> LabelledImage:
    """Return an image whose labels have the names and colours of a file.

    Raises
    ------
    FormatError
        If the file holds no table of labels.
    ValueError
        If it is larger than tables are.
    """
    if place.stat().st_size > LARGEST:
        raise ValueError(f"{place.name} has {place.stat().st_size:,} bytes; tables of labels have {LARGEST:,} at most")
    return replace(image, table=as_label_table(place))


def facts_of(image: LabelledImage) -> dict[str, Any]:
    """Return what the tab Info says of an image."""
    return {
        "voxels": list(image.shape),
        "volumes": image.n_volumes,
        "spacing_mm": image.voxel_size,
        "affine": image.affine,
        "dtype": str(image.values.dtype),
    }
