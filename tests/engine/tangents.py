"""Tangents of decoded lines in float64, by the rule of ``shaders/fiblets/attributes/tangent.glsl``.

At a point the mean of the unit vectors along the segments before and after it; at the first point of a line and of a
fiblet that of the segment after it; between points, interpolated. Segments of no length have no direction, and leave
that of the last one before them.
"""

import numpy as np

from pvfiblets.codec import layout


def unit(vectors):
    """Vectors as unit vectors; none stays none."""
    return vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-300)


def _mean(before, after):
    total = before + after
    return unit(total) if np.linalg.norm(total) > 1e-3 else before


def borders_of(fiblets):
    """Index within its streamline of each fiblet's first point, streamline by streamline, as the records have it."""
    counts = layout.unpack("last", fiblets.decoding).astype(int) + 1
    begins = np.flatnonzero(layout.unpack("begin", fiblets.anchors))
    return [np.cumsum(part) - part for part in np.split(counts, begins[1:])]


def tangents_at_ends(line, per_fiblet=60):
    """(n - 1, 2, 3) unit tangents at both ends of the segments of a line; +x for a line of no length.

    ``per_fiblet``: points of a fiblet, or the first point of each.
    """
    line = np.asarray(line, float)
    borders = {*range(0, len(line), per_fiblet)} if np.isscalar(per_fiblet) else {*np.asarray(per_fiblet).tolist()}
    none = np.zeros(3)
    along = [*unit(np.diff(line, axis=0)), none]
    found = np.empty((len(line) - 1, 2, 3))
    before = end = none
    for k in range(len(line) - 1):
        if k in borders:
            before = none
            end = along[k]
        start, here, after = end, along[k], along[k + 1]
        last = here if here.any() else before
        end = after if after.any() and k + 1 in borders else _mean(last, after)
        found[k] = start if start.any() else end, end
        before = last
    found[~found.any(axis=2)] = 1.0, 0.0, 0.0
    return found


def tangents_at(lines, streamline, place, per_fiblet=60):
    """(m, 3) unit tangents at places along streamlines; ``per_fiblet`` may be those of each streamline."""
    some = [s for s in np.unique(streamline) if len(lines[s]) > 1]
    known = {s: tangents_at_ends(lines[s], per_fiblet if np.isscalar(per_fiblet) else per_fiblet[s]) for s in some}
    found = np.tile([1.0, 0.0, 0.0], (len(place), 1))
    for k, (s, p) in enumerate(zip(streamline, place, strict=True)):
        if s in known:
            i = min(int(p), len(known[s]) - 1)
            start, end = known[s][i]
            found[k] = start + (p - i) * (end - start)
    return unit(found)
