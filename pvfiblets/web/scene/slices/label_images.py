"""Images of slices that may have a table of labels: what a layer of the kind ``"image"`` is made of."""

from __future__ import annotations

import contextlib
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from pvfiblets.errors import FormatError
from pvfiblets.images.files import stem_of
from pvfiblets.slices.image import SliceImage, as_slice_image
from pvfiblets.slices.labels import LabelTable, as_label_table

LARGEST = 4 << 20  # bytes of a table
BESIDE = (".tsv", ".ctab", ".label", ".lbl")
"""Suffixes of tables that are taken without being asked for: BIDS lays them beside its images under the same name."""


@dataclass(frozen=True, eq=False)
class LabelledImage(SliceImage):
    """An image, and what its labels are called."""

    table: LabelTable | None = None


def read_image(place: Path) -> LabelledImage:
    """Read an image; errors as of :func:`.as_slice_image`."""
    found = as_slice_image(place)
    return LabelledImage(found.values, found.affine, found.name, found.is_labels, found.is_colours, found.fixels)


def with_table(image: LabelledImage, place: Path) -> LabelledImage:
    """Return an image whose labels have the names and colours of a file."""
    if place.stat().st_size > LARGEST:
        raise ValueError(f"{place.name} has {place.stat().st_size:,} bytes; tables of labels have {LARGEST:,} at most")
    return replace(image, table=as_label_table(place))


def table_beside(image: SliceImage, place: Path) -> Path | None:
    """Return the table that lies beside a file of labels under its name; None if none does, or these are no labels."""
    if image.n_volumes != 1:
        return None
    if image.values.dtype.kind == "f":
        some = image.values.ravel(order="K")[:: max(1, image.values.size // 100_000)]
        if not (np.isfinite(some) & (some == np.rint(some))).all():
            return None
    for suffix in BESIDE:
        found = place.with_name(stem_of(place.name) + suffix)
        with contextlib.suppress(FormatError, OSError):
            if found.is_file() and found.stat().st_size <= LARGEST:
                as_label_table(found)
                return found
    return None


def facts_of(image: LabelledImage) -> dict[str, Any]:
    """Return what the tab Info says of an image."""
    return {
        "voxels": list(image.shape),
        "volumes": image.n_volumes,
        "spacing_mm": image.voxel_size,
        "affine": image.affine,
        "dtype": str(image.values.dtype),
    }
