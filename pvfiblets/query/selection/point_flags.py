"""Flags of a streamline in a region, for all of it or for its points."""

from __future__ import annotations

from typing import Any, Literal, get_args

ANY, ALL, FIRST, LAST = 1, 2, 4, 8
"""Flags of a streamline for a region: some of it lies in it, all of it does, the first point does, the last does."""

Sampling = Literal["lines", "points"]
"""Sampling of a streamline: its points and all places between them, or the points alone."""


def check_sampling(sampling: Any) -> Sampling:
    """Return the sampling, or raise a ValueError that names it."""
    if sampling not in get_args(Sampling):
        raise ValueError(
            f"sampling is {sampling!r}; give 'lines' (points and all places between them, exactly) or 'points' (the "
            "points alone, as MRtrix's tckedit)"
        )
    found: Sampling = sampling
    return found
