"""Compiled kernel: distances of points from lines that stand for the same streamlines with other points."""

from __future__ import annotations

import math
from typing import Any

import numba
import numpy as np
import numpy.typing as npt

from ...support.array_types import Float64s, Floats, Int64s
from ..jit import kernel, parallel_kernel

NEAR = 8  # segments on either side of where arc length says that the nearest one is


def line_distances(
    points: npt.NDArray[Any],
    offsets: npt.NDArray[np.int64],
    others: npt.NDArray[Any],
    other_offsets: npt.NDArray[np.int64],
    enough: float,
) -> npt.NDArray[np.float64]:
    """Distance of each point from the other line of its streamline."""
    found = np.full(len(points), math.inf)
    _distances(np.ascontiguousarray(points), offsets, np.ascontiguousarray(others), other_offsets, enough, found)
    return found


@kernel
def _arc(points: Floats, first: int, stop: int, arc: Float64s) -> None:
    arc[0] = 0.0
    for i in range(first + 1, stop):
        squares = 0.0
        for axis in range(3):
            squares += (np.float64(points[i, axis]) - np.float64(points[i - 1, axis])) ** 2
        arc[i - first] = arc[i - first - 1] + math.sqrt(squares)


@kernel
def _away(points: Floats, i: int, others: Floats, j: int, k: int) -> float:
    """Squared distance of a point from the segment from ``others[j]`` to ``others[k]``."""
    squares = along = 0.0
    for axis in range(3):
        edge = np.float64(others[k, axis]) - np.float64(others[j, axis])
        squares += edge * edge
        along += (np.float64(points[i, axis]) - np.float64(others[j, axis])) * edge
    t = min(max(along / squares, 0.0), 1.0) if squares > 0.0 else 0.0
    away = 0.0
    for axis in range(3):
        edge = np.float64(others[k, axis]) - np.float64(others[j, axis])
        away += (np.float64(points[i, axis]) - np.float64(others[j, axis]) - t * edge) ** 2
    return away


@parallel_kernel
def _distances(
    points: Floats, offsets: Int64s, others: Floats, other_offsets: Int64s, enough: float, found: Float64s
) -> None:
    for s in numba.prange(len(offsets) - 1):
        first, stop = offsets[s], offsets[s + 1]
        begin, end = other_offsets[s], other_offsets[s + 1]
        if stop == first or end == begin:
            continue
        mine, theirs = np.empty(stop - first), np.empty(end - begin)
        _arc(points, first, stop, mine)
        _arc(others, begin, end, theirs)
        scale = theirs[-1] / mine[-1] if mine[-1] > 0.0 else 0.0
        at = 0
        for i in range(first, stop):
            while at + 1 < len(theirs) and theirs[at + 1] <= mine[i - first] * scale:
                at += 1
            least = _away(points, i, others, begin + at, begin + at)
            for j in range(max(at - NEAR, 0), min(at + NEAR, len(theirs) - 1)):
                least = min(least, _away(points, i, others, begin + j, begin + j + 1))
            if least > enough * enough:
                for j in range(len(theirs) - 1):
                    least = min(least, _away(points, i, others, begin + j, begin + j + 1))
            found[i] = math.sqrt(least)
