"""Values at a position of a workspace: numbers of its images, and streamlines near it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class PointValues:
    """Values at a position.

    Attributes
    ----------
    position : numpy.ndarray
        ``(3,)`` mm.
    voxel : tuple of int or None
        Of the lowest image; None outside of it.
    images : dict
        By layer, as of `SliceStack.values`.
    streamlines : dict
        By actor: ids of streamlines that come within the radius.
    """

    position: Array
    voxel: tuple[int, int, int] | None
    images: dict[str, Any]
    streamlines: dict[str, npt.NDArray[np.int64]]


def streamlines_near(actors: Iterable[Any], position: Array, radius: float) -> dict[str, npt.NDArray[np.int64]]:
    """Return ids of the shown streamlines that come within a radius, mm, by actor."""
    from pvfiblets.query.selection.passing import region_flags
    from pvfiblets.query.selection.point_flags import ANY
    from pvfiblets.regions import Sphere

    ball = Sphere(position, radius)
    found: dict[str, npt.NDArray[np.int64]] = {}
    for actor in actors:
        region: Any = ball
        matrix = np.array(actor.user_matrix, np.float64)
        if not np.array_equal(matrix, np.eye(4)):
            region = ball.moved(np.linalg.inv(matrix))
        flags = region_flags(actor.fiblets, region, bits=ANY)
        found[str(actor.name)] = np.flatnonzero((flags & ANY > 0) & actor.shown)
    return found


def words_of(position: Array, voxel: tuple[int, int, int] | None, values: Mapping[str, Any]) -> str:
    """Return position, voxel and values of images for people, a line each."""
    lines = ["{:.1f} {:.1f} {:.1f} mm".format(*position)]
    if voxel is not None:
        lines[0] += "   voxel {} {} {}".format(*voxel)
    for name, value in values.items():
        if isinstance(value, float):
            value = f"{value:.4g}"
        elif isinstance(value, tuple):
            value = f"{value[1]} ({value[0]})" if value[1] != str(value[0]) else str(value[0])
        elif isinstance(value, np.ndarray):
            value = " ".join(f"{part:.3g}" for part in value)
        lines.append(f"{name}: {'-' if value is None else value}")
    return "\n".join(lines)
