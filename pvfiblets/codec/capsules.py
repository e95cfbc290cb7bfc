"""Capsules: where a fiblet is, as far as culling knows before anything is decoded.

Symbols: ``A`` is the fiblet's anchor as decoded; ``B`` is the next fiblet's anchor as decoded, or, for a fiblet that
ends its streamline, ``A`` plus the streamline's end vector; ``r`` is the radius, ``reach * reach_scale``.

Every decoded point of the fiblet, every segment between them, and the segment that joins the last of them to the next
fiblet lie within ``r`` of the segment ``AB``. A capsule is convex, so that it suffices to measure points. Streamlines
bend little in 60 steps: on made-up tracking with steps of 0.5 mm a sphere about the chord has 35 times the volume, with
steps of 0.1 mm 150 times; the sphere of radius ``N delta`` around the first point (Schertzer et al. 2022, section
3.4.1) has eight times that.

An end vector costs one word a streamline: three signed 10-bit integers in units of ``end_scale``. Its rounding is no
error: ``r`` is measured from the rounded ``B``.

The GPU decodes in float32, to within a thousandth of a step. ``r`` is enlarged by ``MARGIN`` times the length of the
line drawn, about the same for a full fiblet, so that a GPU's decoded points stay within the capsule too.

This is the literal reference; `capsule_kernels` compute the same.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
MARGIN = 2.0**-16
SMALLEST = float(np.finfo(np.float64).tiny)  # square of a chord whose inverse is finite


def distances(points: Array, a: Array, b: Array) -> Array:
    """Distances of points from a segment."""
    chord = b - a
    squares = float(chord @ chord)
    t = np.clip((points - a) @ chord / squares, 0.0, 1.0) if squares >= SMALLEST else np.zeros(len(points))
    found: Array = np.linalg.norm(points - a - t[:, None] * chord, axis=1)
    return found


def capsule_radius(points: Array, b: Array) -> float:
    """Radius that the encoder states for a fiblet, before it is rounded up to a whole number of ``reach_scale``."""
    drawn = np.concatenate([points, b[None]])
    arc = float(np.linalg.norm(np.diff(drawn, axis=0), axis=1).sum())
    return float(distances(points, points[0], b).max()) + MARGIN * arc


def capsule_ends(anchors: Array, end: npt.NDArray[np.bool_], vectors: Array, following: Array | None) -> Array:
    """Return the ends of the chords of consecutive fiblets."""
    last = anchors[-1:] if following is None else following[None]
    ends = np.concatenate([anchors[1:], last])
    ends[end] = anchors[end] + vectors
    return ends
