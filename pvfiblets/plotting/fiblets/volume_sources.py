"""Conversion of every image source to a source of colours."""

from __future__ import annotations

from typing import Any

from pvfiblets.engine.fiblets.data.sampled_volume import VolumeSource
from pvfiblets.images.sources import as_image, is_image


def as_volume(scalars: Any) -> VolumeSource | None:
    """Return the volume that ``scalars`` are; ``None`` if they are something else."""
    if isinstance(scalars, VolumeSource):
        return scalars
    if not is_image(scalars):
        return None
    image = as_image(scalars)
    return VolumeSource(image.single, image.affine, name=image.name or "volume")
