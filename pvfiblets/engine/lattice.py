"""Places as three integers of a lattice, the form of points in shaders.

The lattice has 2^30 to 2^31 steps over the set's largest extent. Differences of integers are exact: however far from
the origin a set lies, a segment is as exact as its own size in float32.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from ..invalid_points import warn_of_far
from .errors import EngineError

TOP = 2**31 - 1  # the largest integer of a place

_LARGEST = float(np.finfo(np.float32).max)
_BLOCK = 1 << 20  # points at a time: float64 of all would take more memory than the places


def lattice(
    points: npt.NDArray[np.floating[Any]], what: str
) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    """Return the place 0 and mm per integer of a lattice that holds all points."""
    if not len(points):
        return np.zeros(3), np.ones(3)
    low, high = points.min(axis=0).astype(np.float64), points.max(axis=0).astype(np.float64)
    extent = float((high - low).max())
    if not extent < _LARGEST / 4.0:
        raise EngineError(f"{what} extend over {extent:g} mm, more than float32 holds; scale them down")
    # A set without extent gets steps that keep its widths in range; none are taken.
    step = extent / TOP if extent > TOP * 1e-36 else 1e-36
    # A power of two, so that integers times it are exact in float32's range and in float64.
    scale = 2.0 ** np.ceil(np.log2(step))
    warn_of_far(points, low, high, scale / (math.hypot(*(high - low)) or 1.0))
    return low, np.full(3, scale)


def places(
    points: npt.NDArray[np.floating[Any]], origin: npt.NDArray[np.float64], scale: npt.NDArray[np.float64]
) -> npt.NDArray[np.uint32]:
    """Return (n, 3) uint32: the nearest places."""
    found: npt.NDArray[np.uint32] = np.empty((len(points), 3), "<u4")
    for first in range(0, len(points), _BLOCK):
        part = points[first : first + _BLOCK].astype(np.float64)
        found[first : first + len(part)] = np.clip(np.rint((part - origin) / scale), 0, TOP)
    return found
