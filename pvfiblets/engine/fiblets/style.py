"""`FibletStyle`: how fiblets become pixels."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..view import Style, check_at_least

LARGEST_DISC = 64.0  # pixels of the discs at ends; a VTK property may exceed it

NO_WIDTH = 1e-3  # pixels: a brush that reaches none. 0 stands for thin lines.


@dataclass(frozen=True)
class FibletStyle(Style):
    """The style of fiblets.

    ``values`` is ``'curvature'`` (1/mm), ``'arc_length'`` (mm from the streamline's first point), the name of an array
    in ``FibletSet.per_point`` or of colours there, or a volume to be sampled at the points. None costs nothing.
    """

    # pixels, above 0. More than 1 draws round brushes of that diameter; else lines are thin, like OpenGL's lines of one
    # pixel. Where `exact`, all are brushes.
    line_width: float = 1.0
    # pixels. A fiblet whose points all lie this near to the segment between its ends is drawn as that segment, as is
    # one that takes up to four pixels in all (paper: Schertzer et al. 2022, section 3.4.4). 0 draws every point.
    tolerance: float = 0.0
    # whether to write where across a line each pixel lies, for shading it as if it were round (`GBuffer.across`). Thin
    # lines have nothing to write.
    across: bool = False
    # millimetres. Draws tubes of that radius, closed by half spheres, instead of lines of a width in pixels: each pixel
    # shows the nearest point of their surface. `line_width` is then not looked at.
    radius: float | None = None
    # draws discs about the first and the last point of each streamline, `line_width` pixels wide, instead of lines
    ends: bool = False
    min_width: float = 1.0  # pixels, at least 1: tubes that are thinner are drawn as wide as that, unless `exact`

    def __post_init__(self) -> None:
        if not (math.isfinite(self.line_width) and self.line_width > 0.0):
            raise ValueError(f"line_width is {self.line_width}; give a finite number of pixels above 0")
        check_at_least("min_width", self.min_width, 1.0, "pixels")
        check_at_least("tolerance", self.tolerance, 0.0, "pixels")
        if self.radius is not None and not (math.isfinite(self.radius) and self.radius > 0.0):
            raise ValueError(f"radius is {self.radius}; give a finite number of millimetres above 0, or None for lines")
        if self.ends and self.radius is not None:
            raise ValueError("ends are discs and have no radius in millimetres; leave out radius, or ends")

    @property
    def half_width(self) -> float:
        """Pixels that a line reaches to either side of its axis at least; 0 for thin lines."""
        if self.radius is not None:
            return (NO_WIDTH if self.exact else self.min_width) / 2.0
        return self.line_width / 2.0 if self.exact or self.ends or self.line_width > 1.0 else 0.0

    @property
    def reach(self) -> float:
        """Millimetres from a line's axis to its surface."""
        return self.radius or 0.0

    @property
    def thickness(self) -> float:
        """Millimetres from a line's axis to its surface."""
        return self.radius or 0.0

    @property
    def detail(self) -> float:
        """Tolerance in pixels for simplified fiblets."""
        return self.tolerance

    @property
    def relief(self) -> str | None:
        """Contents of ``GBuffer.across``: ``'across'`` of wide lines, ``'normal'`` of tubes, or None for nothing."""
        if not self.across or self.ends or (self.radius is None and self.line_width <= 1.0):
            return None
        return "across" if self.radius is None else "normal"
