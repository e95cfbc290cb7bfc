"""How lines in memory lie to a region, exactly: every point and every segment is tested in float64."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from .point_flags import ALL, ANY, FIRST, LAST, Sampling, check_sampling

if TYPE_CHECKING:
    from ..regions.region import Region

SEGMENTS = 1 << 16  # tested together


def line_flags(
    points: npt.NDArray[Any], offsets: npt.NDArray[np.int64], region: Region, sampling: Sampling = "lines"
) -> npt.NDArray[np.uint8]:
    """Return the flags of each line, as :func:`.passing.region_flags` does of compressed ones."""
    between = check_sampling(sampling) == "lines"
    flags = np.zeros(len(offsets) - 1, np.uint8)
    filled = np.flatnonzero(np.diff(offsets))
    if not len(filled):
        return flags
    places, starts, stops = np.asarray(points, np.float64), offsets[filled], offsets[filled + 1]
    inside = region.contains(places)
    some, every = np.logical_or.reduceat(inside, starts), np.logical_and.reduceat(inside, starts)
    if between:
        # What lies between points changes nothing for lines with points on both sides.
        open_ = some == every
        owners = np.repeat(np.arange(len(filled)), stops - starts)
        goes_on = open_[owners]
        goes_on[stops - 1] = False
        segments = np.flatnonzero(goes_on)
        for first in range(0, len(segments), SEGMENTS):
            a = segments[first : first + SEGMENTS]
            found = _segment_flags(region, places[a], places[a + 1])
            some[owners[a[found & 1 != 0]]] = True
            every[owners[a[found & 2 != 0]]] = False
    flags[filled] = ANY * some + ALL * every + FIRST * inside[starts] + LAST * inside[stops - 1]
    return flags


def _segment_flags(
    region: Region, a: npt.NDArray[np.float64], b: npt.NDArray[np.float64]
) -> npt.NDArray[np.uint8]:
    from ..regions.segments import segment_flags

    return segment_flags(region, a, b)
