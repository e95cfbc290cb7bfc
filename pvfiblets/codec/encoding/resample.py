"""Streamlines resampled to a constant step, only where the user asks for it."""

from __future__ import annotations

import math
from typing import Any

import numba
import numpy as np

from ...streamlines import Streamlines
from ...support.array_types import Bools, Float64s, Floats, Int64s
from ..jit import kernel, parallel_kernel


def resample(streamlines: Streamlines, step: float, within: float = math.inf) -> Streamlines:
    """Resample streamlines at equal arc length, and where that would cut corners keep points of these."""
    if not (isinstance(step, (int, float)) and math.isfinite(step) and step > 0.0):
        raise ValueError(f"step is {step!r}; 'auto' or a positive length in mm is needed")
    points, offsets = np.ascontiguousarray(streamlines.points), np.asarray(streamlines.offsets, np.int64)
    lengths = np.diff(offsets)
    arc = np.zeros(len(points))
    _arc_lengths(points, offsets, arc)
    filled = lengths > 0
    total = np.zeros(len(lengths))
    total[filled] = arc[offsets[1:][filled] - 1]
    # A last step within a billionth of a whole one is a whole one.
    count = np.where(lengths > 1, np.ceil(total / step * (1.0 - 1e-9)).astype(np.int64) + 1, lengths)
    count = np.where((lengths > 1) & (count < 2), 2, count)
    fresh = np.concatenate([[0], np.cumsum(count)])
    low, weight = np.zeros(int(fresh[-1]), np.int64), np.zeros(int(fresh[-1]))
    _locate(arc, offsets, fresh, step, low, weight)
    if within < math.inf:
        kept = np.zeros(len(points), np.bool_)
        _keep_corners(points, offsets, fresh, low, weight, float(within), kept)
        corners = np.flatnonzero(kept)
        # New points and corners in the order in which they stand along the lines; places count original points.
        place = np.concatenate([low + weight, corners.astype(np.float64)])
        owner = np.concatenate([np.repeat(np.arange(len(lengths)), count), _owners(offsets, corners)])
        order = np.lexsort([place, owner])
        low = np.concatenate([low, corners])[order]
        weight = np.concatenate([weight, np.zeros(len(corners))])[order]
        fresh = fresh + np.concatenate([[0], np.cumsum(kept)])[offsets]
    high = np.minimum(low + 1, max(len(points) - 1, 0))

    def mix(values: Any) -> Any:
        a, b = values[low].astype(np.float64), values[high].astype(np.float64)
        w = weight.reshape(-1, *([1] * (values.ndim - 1)))
        return np.where(w == 0.0, a, a * (1.0 - w) + b * w).astype(
            values.dtype if values.dtype.kind == "f" else np.float32
        )

    return Streamlines(
        mix(points),
        fresh,
        per_point={k: mix(np.asarray(v)) for k, v in streamlines.per_point.items()},
        per_streamline=streamlines.per_streamline,
        groups=streamlines.groups,
        per_group=streamlines.per_group,
        affine=streamlines.affine,
        space=streamlines.space,
        dropped=streamlines.dropped,
    )


@parallel_kernel
def _arc_lengths(points: Floats, offsets: Int64s, arc: Float64s) -> None:
    for s in numba.prange(len(offsets) - 1):
        sum_ = 0.0
        for i in range(offsets[s] + 1, offsets[s + 1]):
            squares = 0.0
            for axis in range(3):
                squares += (np.float64(points[i, axis]) - np.float64(points[i - 1, axis])) ** 2
            sum_ += math.sqrt(squares)
            arc[i] = sum_


def _owners(offsets: Any, points: Any) -> Any:
    """Streamlines that points belong to."""
    return np.searchsorted(offsets, points, side="right") - 1


@kernel
def _at(points: Floats, i: int, weight: float, found: Float64s) -> None:
    for axis in range(3):
        found[axis] = np.float64(points[i, axis])
        if weight > 0.0:
            found[axis] += weight * (np.float64(points[i + 1, axis]) - found[axis])


@kernel
def _away(points: Floats, i: int, a: Float64s, b: Float64s) -> float:
    """Squared distance of a given point from the segment ``ab``."""
    squares = along = 0.0
    for axis in range(3):
        squares += (b[axis] - a[axis]) ** 2
        along += (np.float64(points[i, axis]) - a[axis]) * (b[axis] - a[axis])
    t = min(max(along / squares, 0.0), 1.0) if squares > 0.0 else 0.0
    away = 0.0
    for axis in range(3):
        away += (np.float64(points[i, axis]) - a[axis] - t * (b[axis] - a[axis])) ** 2
    return away


@kernel
def _keep_between(
    points: Floats, low: Int64s, weight: Float64s, m: int, within: float, stack: Int64s, kept: Bools
) -> None:
    """Mark the given points between new points ``m`` and ``m + 1`` that chords pass farther away than that."""
    first = low[m] + 1
    last = low[m + 1] - 1 if weight[m + 1] == 0.0 else low[m + 1]
    a, b = np.empty(3), np.empty(3)
    depth, begin, end = 0, first - 1, last + 1  # the stretch between these, which stand for the new points at its ends
    while last >= first:
        if begin < first:
            _at(points, low[m], weight[m], a)
        else:
            _at(points, begin, 0.0, a)
        if end > last:
            _at(points, low[m + 1], weight[m + 1], b)
        else:
            _at(points, end, 0.0, b)
        farthest, most = -1, within * within
        for i in range(begin + 1, end):
            away = _away(points, i, a, b)
            if away > most:
                farthest, most = i, away
        if farthest >= 0:
            kept[farthest] = True
            stack[depth, 0], stack[depth, 1] = farthest, end
            depth += 1
            end = farthest
        elif depth > 0:
            depth -= 1
            begin, end = stack[depth, 0], stack[depth, 1]
        else:
            break


@parallel_kernel
def _keep_corners(
    points: Floats, offsets: Int64s, fresh: Int64s, low: Int64s, weight: Float64s, within: float, kept: Bools
) -> None:
    for s in numba.prange(len(fresh) - 1):
        stack = np.empty((offsets[s + 1] - offsets[s], 2), np.int64)
        for m in range(fresh[s], fresh[s + 1] - 1):
            _keep_between(points, low, weight, m, within, stack, kept)


@parallel_kernel
def _locate(arc: Float64s, offsets: Int64s, fresh: Int64s, step: float, low: Int64s, weight: Float64s) -> None:
    """Segment that each new point lies in, and how far along it."""
    for s in numba.prange(len(offsets) - 1):
        i, last = offsets[s], offsets[s + 1] - 1
        for m in range(fresh[s], fresh[s + 1]):
            target = (m - fresh[s]) * step
            if m == fresh[s + 1] - 1 and m > fresh[s]:
                low[m], weight[m] = last, 0.0
                continue
            while i < last and arc[i + 1] <= target:
                i += 1
            low[m] = i
            if i < last and arc[i + 1] > arc[i]:
                weight[m] = min(max((target - arc[i]) / (arc[i + 1] - arc[i]), 0.0), 1.0)
