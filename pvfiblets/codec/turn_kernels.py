"""Compiled kernels: how far the encoder may turn segments, so that no tangent turns by more than an angle.

Same arithmetic as :mod:`.turn_reference`, which says why; :mod:`.tangents` says what a tangent is.
"""

from __future__ import annotations

import math
from typing import Any

from .jit import kernel
from .tangents import LEAST_SUM, ONE_POINT, direction, unit

__all__ = ["excess", "may_turn", "within"]

_MARGIN = 0.99  # for what rounding does to either side of a comparison


@kernel
def may_turn(points: Any, first: int, n: int, follows: Any, bound: Any, units: Any) -> None:
    """Directions of a slot's segments, and how far each may be turned; see :func:`.turn_reference.may_turn`.

    Parameters
    ----------
    points : (n_points, 3) float32 or float64
        All points, mm.
    first, n : int
        First point and number of points of the slot.
    follows : (bool, bool, bool)
        Whether a segment leads to the slot's first point, one from its last, and one on from there.
    bound : (float, float)
        Only segments longer than the first (mm) count; sine of the angle, infinite where any direction will do.
    units : (>= n, 4) float64
        Row ``i`` is filled with the unit vector of the segment from point ``i`` on, and with the largest distance from
        it of the unit vector that is drawn.
    """
    shortest, sine = bound
    one_point = shortest * ONE_POINT
    last = n if follows[1] else n - 1
    bx = by = bz = length = 0.0
    if follows[0]:
        bx, by, bz, length = direction(points, first - 1)
        if length <= one_point:
            bx = by = bz = 0.0
    longer = length > shortest
    for i in range(last + 1):
        before = longer
        leads = i < last or follows[2]
        cx = cy = cz = length = 0.0
        if leads:
            cx, cy, cz, length = direction(points, first + i)
            if length <= one_point:
                cx = cy = cz = 0.0
        longer = length > shortest
        limit = math.inf
        if before or longer:
            x, y, z = bx + cx, by + cy, bz + cz
            size = math.sqrt(x * x + y * y + z * z)
            if size > LEAST_SUM:
                limit = sine * size
                if leads and (i > 0 or follows[0]):
                    limit *= 0.5
        if i > 0:
            units[i - 1, 3] = min(units[i - 1, 3], limit)
        if i < last:
            units[i, 0], units[i, 1], units[i, 2], units[i, 3] = cx, cy, cz, limit
        bx, by, bz = cx, cy, cz


@kernel
def excess(units: Any, a: int, b: int, decoded: Any, following: Any, leads: bool) -> float:
    """Greatest ratio of a turn to what is allowed, over the segments that lead on from ``decoded[a:b]``.

    ``leads``: a segment leads from the last of them to ``following``.
    """
    worst = 0.0
    for i in range(a, b if leads else b - 1):
        allowed = units[i, 3]
        if allowed == math.inf:
            continue
        if i + 1 < b:
            x, y, z, _ = direction(decoded, i)
        else:
            x, y, z, _ = unit(
                following[0] - decoded[i, 0], following[1] - decoded[i, 1], following[2] - decoded[i, 2]
            )
        x, y, z = x - units[i, 0], y - units[i, 1], z - units[i, 2]
        worst = max(worst, math.sqrt(x * x + y * y + z * z) / allowed)
    return worst


@kernel
def _cosine(points: Any, i: int, one_point: float) -> Any:
    """Cosine of the turn at point ``i``, and the length of the segment from it on.

    Where a segment has no direction, that of a turn whose tangent's sum is as long: that of one unit vector.
    """
    ax, ay, az, before = direction(points, i - 1)
    bx, by, bz, length = direction(points, i)
    if before <= one_point or length <= one_point:
        return -0.5, length
    return ax * bx + ay * by + az * bz, length


@kernel
def within(
    points: Any, first: int, n: int, follows: Any, bound: Any, step: float, apart: float, least: float
) -> bool:
    """Whether no segment of a slot can be turned too far: told of nearly all direction codes by few figures.

    ``apart`` is the largest distance of a decoded point from its original, the next slot's first included. All segments
    drawn have the length ``step``, but for the one to the next slot. Turns within the slot have cosines of at least
    ``least``. True is certain; for False, :func:`excess` decides.

    A segment drawn as ``e`` instead of ``d`` has its unit vector turned by at most ``2 |e - d| / (|d| + |e|)``, and
    ``|e - d|`` is at most twice ``apart``. Of a turn of cosine ``c`` the tangent's sum is ``sqrt(2 + 2 c)`` long.
    """
    if n < 3:
        return False
    one_point = ONE_POINT * bound[0]
    shortest = step
    if follows[0]:
        cosine, _ = _cosine(points, first, one_point)
        least = min(least, cosine)
    if follows[1]:
        cosine, length = _cosine(points, first + n - 1, one_point)
        shortest = min(shortest, length)
        least = min(least, cosine)
        if follows[2]:
            cosine, _ = _cosine(points, first + n, one_point)
            least = min(least, cosine)
    if shortest - 2.0 * apart <= one_point or least <= -1.0:
        return False
    return 2.0 * apart / (shortest - apart) <= _MARGIN * bound[1] * 0.5 * math.sqrt(2.0 + 2.0 * least)
