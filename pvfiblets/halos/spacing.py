"""How far apart lines or points lie, and the widths that suit them."""

from __future__ import annotations

import numpy as np

from .things import HaloLines, HaloPoints

__all__ = ["default_widths", "line_spacing", "point_spacing"]


def line_spacing(lines: HaloLines, samples: int = 2000, seed: int = 0) -> float:
    """Median distance from a place on a line to the nearest other line, mm."""
    return _share_of_extent(lines)


def point_spacing(points: HaloPoints, samples: int = 2000, seed: int = 0) -> float:
    """Median distance from a point to the nearest other point, mm."""
    return _share_of_extent(points)


def default_widths(
    drawn: HaloLines | HaloPoints,
    line_width: float | None = None,
    strip_width: float | None = None,
    max_displacement: float | None = None,
) -> tuple[float, float, float]:
    """Line width, strip width and largest displacement, mm: those given, and the rest as suits the data."""
    diagonal = _diagonal(drawn) or 1.0
    if line_width is None:
        spacing = line_spacing(drawn) if isinstance(drawn, HaloLines) else point_spacing(drawn)
        line_width = float(np.clip(0.4 * spacing, diagonal / 3000, diagonal / 150))
    if strip_width is None:
        strip_width = (6.0 if isinstance(drawn, HaloLines) else 10.0) * line_width
    if max_displacement is None:
        max_displacement = max(4.0 * strip_width, diagonal / 50.0)
    return line_width, strip_width, max_displacement


def _diagonal(drawn: HaloLines | HaloPoints) -> float:
    bounds = np.asarray(drawn.bounds)
    return float(np.linalg.norm(bounds[1::2] - bounds[::2]))


def _share_of_extent(drawn: HaloLines | HaloPoints) -> float:
    return _diagonal(drawn) / 60.0 or 1.0
