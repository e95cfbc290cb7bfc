"""Regions as words of a command line: a ball, a box, or the voxels of an image."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...images.files import SUFFIXES

if TYPE_CHECKING:
    from .region import Region

FORMS = "sphere:X,Y,Z,RADIUS, box:XMIN,XMAX,YMIN,YMAX,ZMIN,ZMAX (mm), or IMAGE, or IMAGE:LABEL,LABEL"


def parse_region(text: str) -> Region:
    """Return the region that a text means."""
    from .shapes import Box, Sphere

    kind, colon, rest = text.partition(":")
    if colon and kind in ("sphere", "box"):
        numbers = _numbers(text, rest, 4 if kind == "sphere" else 6)
        return Sphere(numbers[:3], numbers[3]) if kind == "sphere" else Box(numbers)
    path, labels = text, None
    if not text.lower().endswith(SUFFIXES):
        path, colon, said = text.rpartition(":")
        if not path.lower().endswith(SUFFIXES):
            raise ValueError(f"{text!r} is no region; give {FORMS}")
        labels = [int(number) for number in _numbers(text, said, None)]
    from ...images.sources import as_image
    from .labels import Labels

    image = as_image(path)
    return Labels(image.labels, image.affine, labels)


def _numbers(text: str, said: str, n: int | None) -> list[float]:
    try:
        found = [float(number) for number in said.split(",")]
    except ValueError:
        found = []
    if not found or (n is not None and len(found) != n):
        raise ValueError(f"{text!r} is no region; give {FORMS}")
    return found
