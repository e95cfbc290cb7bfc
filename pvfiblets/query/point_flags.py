"""What a region's flags say of a streamline's points, and the spacing of positions between them."""

from __future__ import annotations

import math

__all__ = ["ALL", "ANY", "FIRST", "LAST", "check_sampling"]

ANY, ALL, FIRST, LAST = 1, 2, 4, 8
"""Flags of a streamline for a region: some point lies in it, every point does, the first does, the last does."""


def check_sampling(sampling: float | None) -> float:
    """Return the sampling, 0 for None, or raise a ValueError that names it."""
    if sampling is None:
        return 0.0
    spacing = float(sampling)
    if not (math.isfinite(spacing) and spacing > 0.0):
        raise ValueError(f"sampling is {spacing}; a length in mm above 0 is needed, or None to test the points only")
    return spacing
