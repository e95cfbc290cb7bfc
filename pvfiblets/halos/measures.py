"""Lengths of lines with halos, and arc lengths at their points."""

from __future__ import annotations

import numpy as np

from pvfiblets.halos.geometry import HaloLines


def line_lengths(lines: HaloLines) -> np.ndarray:
    """Return the length of each line."""
    along = np.concatenate([arc_lengths(lines), np.zeros(1)])
    lengths = np.where(np.diff(lines.offsets) > 0, along[lines.offsets[1:] - 1], 0.0)
    return np.asarray(lengths)


def arc_lengths(lines: HaloLines) -> np.ndarray:
    """``(n_points,)`` mm from the first point of each point's line."""
    steps = np.zeros(lines.n_points)
    if lines.n_points > 1:
        steps[1:] = np.linalg.norm(np.diff(lines.points.astype(np.float64), axis=0), axis=1)
    counts = np.diff(lines.offsets)
    first = lines.offsets[:-1][counts > 0]
    steps[first] = 0.0
    total = np.cumsum(steps)
    return np.asarray(total - np.repeat(total[first], counts[counts > 0]))
