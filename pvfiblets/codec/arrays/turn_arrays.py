"""Cuts of streamlines and greatest turns of segments, for all points at once; see `tangents`.

NumPy and nothing else, in the arithmetic of `turn_kernels`: sets that are too small to load a compiler for.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from ..layout import MAX_POINTS
from ..tangents import FIRST_SHARE, LEAST_SUM, LOOK_BACK, ONE_POINT

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Turning:
    """Greatest turns of the segments of a chunk; row ``i`` is about the segment that leads on from point ``i``."""

    units: Array  # `(3, n)` unit vectors; zeros where there is no segment, or none that has a direction
    allowed: Array  # `(n,)` largest distance of the unit vector that is drawn instead; infinite where any will do
    # `(n,)` the same where a fiblet begins with the segment, though not the streamline; -1 where none should
    first: Array
    bends: Array  # `(n,)` distance of the unit vector from the tangent at point `i`; 0 where that bounds nothing


def turning(points: npt.NDArray[np.floating], offsets: npt.NDArray[np.int64], bound: tuple[float, ...]) -> Turning:
    """Turns of the segments of streamlines."""
    n = len(points)
    if not math.isfinite(bound[1]):
        return Turning(np.zeros((3, n)), np.full(n, np.inf), np.full(n, np.inf), np.zeros(n))
    shortest, sine, chord = bound
    begins, ends = np.zeros(n, bool), np.zeros(n, bool)
    filled = offsets[1:] > offsets[:-1]
    begins[offsets[:-1][filled]] = True
    ends[offsets[1:][filled] - 1] = True
    leads, has_before = ~ends, ~begins

    units, lengths = np.zeros((3, n)), np.zeros(n)
    if n > 1:
        wide = np.ascontiguousarray(points.T, np.float64)
        units[:, :-1], lengths[:-1] = units_of(wide[:, 1:] - wide[:, :-1])
    lengths[~leads] = 0.0
    units[:, lengths <= shortest * ONE_POINT] = 0.0
    longer = lengths > shortest

    before, before_longer = np.zeros((3, n)), np.zeros(n, bool)
    before[:, 1:], before_longer[1:] = units[:, :-1], longer[:-1]
    before[:, begins], before_longer[begins] = 0.0, False
    sums = before + units
    size = _size(sums)
    bounded = (before_longer | longer) & (size > LEAST_SUM)
    both = bounded & leads & has_before
    safe = np.where(size > 0.0, size, 1.0)
    bends = np.where(both, _size(sums / safe - units), 0.0)
    first = np.where(both, chord - bends, np.inf)
    first[first < (1.0 - FIRST_SHARE) * chord] = -1.0
    limit = np.where(bounded, sine * size, np.inf)
    limit[both] *= 0.5
    allowed = limit.copy()
    np.minimum(limit[:-1], limit[1:], out=allowed[:-1], where=leads[:-1])
    return Turning(units, allowed, first, bends)


def units_of(vectors: Array) -> tuple[Array, Array]:
    """Unit vectors of vectors ``(3, ...)`` and their lengths; zeros where they have none."""
    largest = np.maximum(np.maximum(np.abs(vectors[0]), np.abs(vectors[1])), np.abs(vectors[2]))
    nothing = largest == 0.0
    scaled = vectors / np.where(nothing, 1.0, largest)  # squares of the smallest numbers would be 0
    size = _size(scaled)
    return scaled / np.where(nothing, 1.0, size), size * largest


def _size(vectors: Array) -> Array:
    x, y, z = vectors
    size: Array = np.sqrt(x * x + y * y + z * z)
    return size


def cut(
    offsets: npt.NDArray[np.int64], bends: Array, bound: tuple[float, ...]
) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64]]:
    """Slots of at most 60 points."""
    starts, stops = offsets[:-1].copy(), offsets[1:]
    per = np.zeros(len(starts), np.int64)
    lines = np.flatnonzero(stops > starts)
    firsts, counts, owners = [], [], []
    enough = FIRST_SHARE * bound[2]
    while lines.size:
        a, stop = starts[lines], stops[lines]
        b = stop.copy()
        long = np.flatnonzero(stop - a > MAX_POINTS)
        if long.size:
            last = a[long] + MAX_POINTS
            sharpness = bends[last[:, None] - np.arange(LOOK_BACK)]
            good = sharpness <= enough
            back = np.where(good.any(axis=1), good.argmax(axis=1), sharpness.argmin(axis=1))
            back[last + 1 == stop[long]] = 0  # a single point draws no segment
            b[long] = last - back
        firsts.append(a)
        counts.append(b - a)
        owners.append(lines)
        per[lines] += 1
        starts[lines] = b
        lines = lines[b < stop]
    if not firsts:
        return np.empty((0, 2), np.int64), per
    slots = np.stack([np.concatenate(firsts), np.concatenate(counts)], axis=1)
    return slots[np.argsort(slots[:, 0])], per


def excess(
    decoded: Array,
    counts: npt.NDArray[np.int64],
    following: Array,
    leads: npt.NDArray[np.bool_],
    units: Array,
    allowed: Array,
) -> Array:
    """Greatest ratio of a turn to its bound, of each of ``k`` fiblets; see `turn_kernels.excess`."""
    most, _, k = decoded.shape
    columns = np.arange(k)
    to: Array = np.empty_like(decoded)
    to[:-1], to[-1] = decoded[1:], decoded[-1]
    to[counts - 1, :, columns] = following.T
    segments = np.where(leads, counts, counts - 1)
    told = (np.arange(most)[:, None] < segments) & (allowed < np.inf)
    drawn, _ = units_of(np.moveaxis(to - decoded, 1, 0))
    apart = _size(drawn - np.moveaxis(units, 1, 0))
    ratios: Any = np.divide(apart, allowed, out=np.zeros_like(apart), where=told)
    worst: Array = ratios.max(axis=0, initial=0.0)
    return worst
