"""The camera and data of a picture (`View`), and its appearance (`Style`): frozen values; changes cause redraws."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from ..query.regions.shapes import Region
    from .fiblets.data.sampled_volume import VolumeSource

MAX_CLIP_PLANES = 8  # OpenGL's guaranteed GL_MAX_CLIP_DISTANCES; a box takes six


@dataclass(frozen=True, eq=False)
class View:
    """A picture's size and camera."""

    size: tuple[int, int]  # width and height in pixels, each at least 1
    # `(4, 4)` float64: data coordinates in mm (column vectors) to OpenGL clip coordinates. Perspective or parallel; any
    # actor placement belongs in it.
    model_view_projection: npt.NDArray[np.float64]
    # `(k, 4)` float64 planes (a, b, c, d) in data coordinates, k <= 8: fiblets remain only where ax + by + cz + d >= 0
    # for all of them, and a cut reveals the fiblets behind it. They need not be normalised. None, or planes that
    # nothing touches, cost nothing.
    clip_planes: Sequence[Sequence[float]] | npt.NDArray[np.float64] = ()
    # region that clips the fiblets (`pvfiblets.regions`), data coordinates. None costs nothing.
    region: Region | None = None
    # whether drawing may wait until the GPU has said in how many layers a region's closed surfaces lie there. If not,
    # the number of earlier pictures is used: where a ray meets more, the picture lacks the farthest until the number
    # has come back, two or three pictures later.
    waits: bool = True
    _key: tuple[object, ...] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        width, height = (int(n) for n in self.size)
        if width < 1 or height < 1:
            raise ValueError(f"size is {self.size}; give a width and a height of at least one pixel")
        matrix = np.array(self.model_view_projection, np.float64)
        if matrix.shape != (4, 4) or not np.isfinite(matrix).all():
            raise ValueError(f"model_view_projection must be a finite (4, 4) matrix, got {matrix.tolist()}")
        matrix.flags.writeable = False
        planes = np.array(self.clip_planes, np.float64)
        if planes.size == 0:
            planes = planes.reshape(0, 4)
        if planes.ndim != 2 or planes.shape[1] != 4 or not np.isfinite(planes).all():
            raise ValueError(f"clip_planes must be finite rows (a, b, c, d), got {planes.tolist()}")
        if len(planes) > MAX_CLIP_PLANES:
            raise ValueError(f"{len(planes)} clip planes are more than {MAX_CLIP_PLANES}; leave some out")
        planes.flags.writeable = False
        object.__setattr__(self, "size", (width, height))
        object.__setattr__(self, "model_view_projection", matrix)
        object.__setattr__(self, "clip_planes", planes)
        object.__setattr__(self, "_key", (width, height, matrix.tobytes(), planes.tobytes(), self.region, self.waits))

    def __eq__(self, other: object) -> bool:
        return self._key == other._key if isinstance(other, View) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._key)


@dataclass(frozen=True)
class Style:
    """The style of a drawable: the fields that all drawables share."""

    # name of the drawable's value to write for each pixel. None costs nothing.
    values: str | VolumeSource | None = field(default=None, kw_only=True)
    # whether pixels show only lines that cover their middles. Otherwise lines thinner than a pixel are widened to one,
    # or many of their pixels would be missed; the mean of many pictures, of other middles each, misses none.
    exact: bool = field(default=False, kw_only=True)
    # whether to write where the edges run of what each pixel shows (`GBuffer.edges`), for smoothing them. Volumes have
    # none.
    edges: bool = field(default=False, kw_only=True)

    @property
    def half_width(self) -> float:
        """Pixels that a line reaches to either side of its axis at least; 0 for thin lines."""
        return 0.0

    @property
    def reach(self) -> float:
        """Millimetres that the drawable reaches beyond its bounds on the screen, beside what pixels add."""
        return 0.0

    @property
    def thickness(self) -> float:
        """Millimetres that the drawable reaches beyond its bounds towards the viewer."""
        return 0.0

    @property
    def detail(self) -> float:
        """Error of simplification in pixels; 0 for none."""
        return 0.0

    @property
    def relief(self) -> str | None:
        """Contents of ``GBuffer.across`` (:meth:`.GBuffer.want_relief`), or None for nothing."""
        return None


def check_at_least(name: str, value: float, least: float, unit: str) -> None:
    """Raise where a number of a style is not finite or too small."""
    if not (math.isfinite(value) and value >= least):
        raise ValueError(f"{name} is {value}; give a finite number of {unit}, {least:g} or more")
