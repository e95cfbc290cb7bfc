"""Streamlines resampled to a constant step, only where the user asks for it."""

from __future__ import annotations

import math
from typing import Any

import numba
import numpy as np

from ..streamlines import Streamlines
from .jit import parallel_kernel

__all__ = ["resample"]


def resample(streamlines: Streamlines, step: float) -> Streamlines:
    """Resample streamlines at equal arc length.

    Parameters
    ----------
    streamlines : Streamlines
        Any steps.
    step : float
        Distance between new points along each streamline, mm. Both ends stay where they are, so the last step is
        shorter unless the length is a whole number of steps.

    Returns
    -------
    Streamlines
        Same number of streamlines; per-point values interpolated linearly (a NaN at either end gives NaN), the rest
        kept.

    Raises
    ------
    ValueError
        If ``step`` is not a positive number.
    """
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
def _arc_lengths(points: Any, offsets: Any, arc: Any) -> None:
    for s in numba.prange(len(offsets) - 1):
        sum_ = 0.0
        for i in range(offsets[s] + 1, offsets[s + 1]):
            squares = 0.0
            for axis in range(3):
                squares += (np.float64(points[i, axis]) - np.float64(points[i - 1, axis])) ** 2
            sum_ += math.sqrt(squares)
            arc[i] = sum_


@parallel_kernel
def _locate(arc: Any, offsets: Any, fresh: Any, step: float, low: Any, weight: Any) -> None:
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
