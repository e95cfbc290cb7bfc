"""Lengths and arc lengths of spline tubes, and slopes of numbers at their nodes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from pvfiblets.tubes.curves import controls, derivative
from pvfiblets.tubes.spline_tubes import NodeValues, SplineTubes

RADIUS, ARC_LENGTH = "radius", "arc_length"

_BLOCK = 1 << 15  # segments measured at a time
_GAUSS = ((0.5 - 0.15**0.5, 5 / 18), (0.5, 4 / 9), (0.5 + 0.15**0.5, 5 / 18))


def tube_lengths(tubes: SplineTubes) -> np.ndarray:
    """Return the length of each tube's centre line."""
    found: np.ndarray = np.bincount(tubes.tubes, segment_lengths(tubes), tubes.n_tubes)
    return found


def segment_lengths(tubes: SplineTubes) -> np.ndarray:
    """Lengths of centre lines, mm, by Gauss's rule of three points for each half of a segment."""
    lengths = np.zeros(tubes.n_segments)
    for first in range(0, tubes.n_segments, _BLOCK):
        some = np.arange(first, min(first + _BLOCK, tubes.n_segments))
        halves = controls(tubes, some)[..., :3]
        for place, weight in _GAUSS:
            lengths[some] += weight * np.linalg.norm(derivative(halves, place), axis=-1).sum(axis=1)
    return lengths


def with_radius(tubes: SplineTubes) -> SplineTubes:
    """Return tubes whose nodes have their radius as numbers."""
    return replace(tubes, values={**tubes.values, RADIUS: NodeValues(tubes.radius, tubes.radius_slopes)})


def with_arc_length(tubes: SplineTubes) -> SplineTubes:
    """Tubes whose nodes say how far they are along their tube, in the order of its segments, mm."""
    # A node that is at two places at once, as one that tubes share or at which one closes, becomes a node for each.
    order = np.argsort(tubes.tubes, kind="stable")
    until = np.cumsum(segment_lengths(tubes)[order])
    begin = np.concatenate([np.zeros(1), until])[: len(until)]
    first = np.searchsorted(tubes.tubes[order], tubes.tubes[order])
    places = np.empty((tubes.n_segments, 2))
    places[order] = np.stack([begin, until], axis=1) - begin[first][:, None]
    ends, flat = tubes.segments.ravel(), places.ravel()
    rank = np.lexsort((flat, ends))
    new = np.ones(len(rank), bool)
    new[1:] = (np.diff(ends[rank]) != 0) | (np.diff(flat[rank]) != 0.0)
    along = np.zeros(tubes.n_nodes)
    along[ends] = flat
    if np.count_nonzero(new) > np.count_nonzero(np.bincount(ends, minlength=tubes.n_nodes)):
        nodes, along = ends[rank[new]], flat[rank[new]]
        segments = np.empty(len(rank), np.int64)
        segments[rank] = np.cumsum(new) - 1
        tubes = replace(
            tubes,
            points=tubes.points[nodes],
            segments=segments.reshape(-1, 2),
            radius=tubes.radius[nodes],
            tangents=tubes.tangents[nodes],
            radius_slopes=tubes.radius_slopes[nodes],
            values={key: NodeValues(held.values[nodes], held.slopes[nodes]) for key, held in tubes.values.items()},
        )
    held = NodeValues(along, np.linalg.norm(tubes.tangents, axis=1))
    return replace(tubes, values={**tubes.values, ARC_LENGTH: held})


def node_slopes(tubes: SplineTubes, rows: np.ndarray) -> np.ndarray:
    """Slopes at nodes, by length or by segment as the tubes' tangents are; 0 where a value is none."""
    start, end = tubes.segments.T
    chords = tubes.lengths() if tubes.scaled else np.ones(tubes.n_segments)
    moving = (start != end) & (chords > 0.0)
    start, end, chords = start[moving], end[moving], chords[moving]
    flat = rows.reshape(len(rows), -1)
    with np.errstate(invalid="ignore", over="ignore"):
        steps = (flat[end] - flat[start]) / chords[:, None]
    steps[~np.isfinite(steps)] = 0.0
    ends = np.concatenate([start, end])
    count = np.maximum(np.bincount(ends, minlength=tubes.n_nodes), 1)
    found = [np.bincount(ends, np.tile(column, 2), tubes.n_nodes) / count for column in steps.T]
    return np.stack(found, axis=1).reshape(rows.shape)
