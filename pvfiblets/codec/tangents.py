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

How far the encoder may turn segments: let ``u`` and ``v`` be the unit vectors of the segments before and after a
point, ``u'`` and ``v'`` their decoded vectors, and ``A`` the bound of the angle between the tangents, which are the
directions of ``S = u + v`` and of ``S' = u' + v'``. From ``|S' - S| <= |u' - u| + |v' - v|`` follows that the angle
between both is at most ``A`` where

    ``|u' - u| <= sin(A) |S| / 2`` and ``|v' - v| <= sin(A) |S| / 2``.

Each segment so has a bound of its own, the lesser of its two ends', whatever its neighbours decode to: fiblets
can be coded apart from each other. At the end of a line there is one segment only, and it has the whole bound. The
sharper the bend, the shorter is ``S``, and the finer are its two segments coded.

At the first point of a fiblet the renderers draw the direction ``v'`` of the segment after it: the segment before
belongs to a fiblet that is not decoded there. So ``v'`` has to be within ``A`` of ``S`` at such a point. That bounds it
by the chord of ``A`` less the distance of ``v`` from the unit vector of ``S``, and no fiblet should begin where ``v``
alone is off by more than most of ``A``.

Points at which no segment longer than a pixel ends, and those where a line turns back on itself, bound nothing.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

PIXELS = 2000.0  # pixels of a full-screen view along the diagonal of the bounds

ONE_POINT = 1e-3  # pixels: points that are no farther apart are one, and no direction leads from one to the other

LEAST_SUM = 1e-3
"""Sums of two unit vectors that are shorter have no direction: the line turns by more than 179.9 degrees."""

FIRST_SHARE = 0.8  # of the angle that a bend may take at the first point of a fiblet; the rest is for coding
LOOK_BACK = 20  # points before the 60th among which a slot may end


def pixel(bounds: Sequence[float]) -> float:
    """Side of a pixel where a picture shows the whole set."""
    return math.hypot(bounds[1] - bounds[0], bounds[3] - bounds[2], bounds[5] - bounds[4]) / PIXELS
