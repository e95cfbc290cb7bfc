"""Tangents of decoded lines in float64, by the rule of ``shaders/fiblets/attributes/tangent.glsl``.

At a point the mean of the unit vectors along the segments before and after it, stepping over those of no length; at the
first point of a line and of a fiblet that of the segment after it; between points, interpolated.
"""

from __future__ import annotations

import numpy as np


def unit(vectors):
    """Vectors as unit vectors; none stays none."""
    return vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-300)


def point_tangents(line, per_fiblet=60):
    """(n, 3) unit tangents at the points of a line; +x for a line of no length."""
    n = len(line)
    along = unit(np.diff(line, axis=0))
    long = np.flatnonzero((along != 0).any(axis=1))
    if not len(long):
        return np.tile([1.0, 0.0, 0.0], (n, 1))
    before, after = np.zeros((n, 3)), np.zeros((n, 3))
    for i in range(n):
        earlier, later = long[long < i], long[long >= i]
        before[i] = along[earlier[-1]] if len(earlier) else 0.0
        after[i] = along[later[0]] if len(later) else 0.0
    first = (np.arange(n) % per_fiblet == 0) & (after != 0).any(axis=1)
    sums = before + after
    back = np.linalg.norm(sums, axis=1) < 1e-3
    return unit(np.where(first[:, None], after, np.where(back[:, None], before, sums)))


def tangents_at(lines, streamline, place, per_fiblet=60):
    """(m, 3) unit tangents at places along streamlines."""
    known = {s: point_tangents(lines[s], per_fiblet) for s in np.unique(streamline)}
    found = np.empty((len(place), 3))
    for k, (s, p) in enumerate(zip(streamline, place, strict=True)):
        at = known[s]
        i = min(int(p), max(len(at) - 2, 0))
        found[k] = at[i] + (p - i) * (at[min(i + 1, len(at) - 1)] - at[i])
    return unit(found)
