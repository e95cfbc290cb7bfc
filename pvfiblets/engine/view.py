"""What is drawn from where (`View`) and how (`Style`): small frozen values that a redraw is decided on."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from ..query.shapes import Region
    from .fiblets.sampled_volume import VolumeSource

__all__ = ["MAX_CLIP_PLANES", "Style", "View"]

MAX_CLIP_PLANES = 8
"""As many as OpenGL itself promises (GL_MAX_CLIP_DISTANCES); a box takes six."""


@dataclass(frozen=True, eq=False)
class View:
    """A picture's size and camera.

    Parameters
    ----------
    size : tuple of int
        Width and height in pixels, each at least 1.
    model_view_projection : array_like
        ``(4, 4)`` float64: data coordinates in mm (column vectors) to OpenGL clip coordinates. Perspective or
        parallel; any actor placement belongs in it.
    clip_planes : array_like, optional
        ``(k, 4)`` float64 planes (a, b, c, d) in data coordinates, k <= 8: of the fiblets only what lies where
        ax + by + cz + d >= 0 for all of them is there, and what lies behind a cut shows. They need not be
        normalised. None, or planes that nothing touches, cost nothing.
    region : Region, optional
        Of the fiblets only what lies in it is there (:mod:`pvfiblets.regions`), data coordinates. None costs nothing.

    Raises
    ------
    ValueError
        If the size is not positive, the matrix is not 4 x 4 and finite, or the planes are not finite, not four numbers
        each or too many.
    """

    size: tuple[int, int]
    model_view_projection: npt.NDArray[np.float64]
    clip_planes: Sequence[Sequence[float]] | npt.NDArray[np.float64] = ()
    region: Region | None = None
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
        object.__setattr__(self, "_key", (width, height, matrix.tobytes(), planes.tobytes(), self.region))

    def __eq__(self, other: object) -> bool:
        return self._key == other._key if isinstance(other, View) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._key)


@dataclass(frozen=True)
class Style:
    """How fiblets become pixels.

    Parameters
    ----------
    line_width : float
        Pixels, at least 1. Exactly 1 draws thin lines as OpenGL does; more draws round brushes of that diameter.
    values : str or VolumeSource, optional
        The per-point value to write beside each pixel: ``'curvature'`` (1/mm), ``'arc_length'`` (mm from the
        streamline's first point), the name of an array in ``FibletSet.per_point``, or a volume to be sampled at the
        points (:mod:`pvfiblets.engine.fiblets.sampled_volume`). None costs nothing.
    tolerance : float
        Pixels. A fiblet whose points all lie this near to the segment between its ends is drawn as that segment, as is
        one that takes up to four pixels in all (paper: Schertzer et al. 2022, section 3.4.4). 0 draws every point.
    across : bool
        Whether to write where across a line each pixel lies, for shading it as if it were round (``GBuffer.across``).
        Thin lines have nothing to write.
    radius : float, optional
        Millimetres. Draws tubes of that radius, closed by half spheres, instead of lines of a width in pixels: each
        pixel shows the nearest point of their surface. Where they are thinner than a pixel they are drawn a pixel wide.
        ``line_width`` is then not looked at.

    Raises
    ------
    ValueError
        If the line width is below 1, the tolerance below 0, the radius not positive, or any of them not finite.
    """

    line_width: float = 1.0
    values: str | VolumeSource | None = None
    tolerance: float = 0.5
    across: bool = False
    radius: float | None = None

    def __post_init__(self) -> None:
        if not (math.isfinite(self.line_width) and self.line_width >= 1.0):
            raise ValueError(f"line_width is {self.line_width}; give a finite number of pixels, 1 or more")
        if not (math.isfinite(self.tolerance) and self.tolerance >= 0.0):
            raise ValueError(f"tolerance is {self.tolerance}; give a finite number of pixels, 0 or more")
        if self.radius is not None and not (math.isfinite(self.radius) and self.radius > 0.0):
            raise ValueError(f"radius is {self.radius}; give a finite number of millimetres above 0, or None for lines")

    @property
    def half_width(self) -> float:
        """Pixels that a line reaches to either side of its axis at least; 0 for thin lines."""
        if self.radius is not None:
            return 0.5
        return 0.0 if self.line_width == 1.0 else self.line_width / 2.0

    @property
    def reach(self) -> float:
        """Millimetres that a line reaches to either side of its axis, beside what pixels add."""
        return 0.0 if self.radius is None else self.radius

    @property
    def relief(self) -> str | None:
        """What ``GBuffer.across`` holds: ``'across'`` of wide lines, ``'normal'`` of tubes, or None for nothing."""
        if not self.across or self.half_width == 0.0:
            return None
        return "across" if self.radius is None else "normal"
