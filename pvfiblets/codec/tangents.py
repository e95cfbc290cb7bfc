"""Errors of drawn directions: the angle between tangents, which set a line's colour and light.

The tangent at a point is the sum of the unit vectors of the segment before and of the segment after, as a unit vector;
at an end it is that of the only one. A segment of no length has no direction and adds nothing, nor does one shorter
than a thousandth of a pixel in truth: its ends are one point twice, and its direction is that of their rounding. A
renderer interpolates tangents along each segment, so that they are compared at its two ends.

Segments shorter than a pixel of a picture of the whole set show no direction of their own. They are left out; where one
is next to a longer segment, it counts in the tangent that they share. Where the true line turns back on itself, the sum
has no direction, and the point is left out as well.

Drawn tangents are as the shaders have them (``fiblets/attributes/tangent.glsl``): the same, but at the first point of a
fiblet that of the segment after it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

PIXELS = 2000.0  # pixels of a full-screen view along the diagonal of the bounds

ONE_POINT = 1e-3  # pixels: points that are no farther apart are one, and no direction leads from one to the other

LEAST_SUM = 1e-3
"""Sums of two unit vectors that are shorter have no direction: the line turns by more than 179.9 degrees."""


def pixel(bounds: Sequence[float]) -> float:
    """Side of a pixel where a picture shows the whole set."""
    return math.hypot(bounds[1] - bounds[0], bounds[3] - bounds[2], bounds[5] - bounds[4]) / PIXELS
