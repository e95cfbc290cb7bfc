"""Compiled kernels: how far the encoder may turn segments, so that no tangent turns by more than an angle.

`tangents` says what a tangent is, and why its bounds are what they are.
"""

from __future__ import annotations

import math

import numba

from ...support.array_types import Float64s, Int64s
from ..jit import kernel, parallel_kernel
from ..layout import MAX_POINTS
from ..tangents import FIRST_SHARE, LEAST_SUM, LOOK_BACK, ONE_POINT
from .tangent_kernels import direction, unit

_MARGIN = 0.99  # for what rounding does to either side of a comparison


@kernel
def may_turn(points: Float64s, first: int, n: int, follows: tuple[bool, bool, bool], bound: tuple[float, float, float],
             units: Float64s) -> None:  # fmt: skip
    """Directions of a slot's segments, and how far each may be turned."""
    shortest, sine, chord = bound
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
        limit = first_limit = math.inf
        if before or longer:
            x, y, z = bx + cx, by + cy, bz + cz
            size = math.sqrt(x * x + y * y + z * z)
            if size > LEAST_SUM:
                limit = sine * size
                if leads and (i > 0 or follows[0]):
                    limit *= 0.5
                    first_limit = chord - _bend(x, y, z, size, cx, cy, cz)
                    if first_limit < (1.0 - FIRST_SHARE) * chord:
                        first_limit = -1.0
        if i > 0:
            units[i - 1, 3] = min(units[i - 1, 3], limit)
        if i < last:
            units[i, 0], units[i, 1], units[i, 2], units[i, 3], units[i, 4] = cx, cy, cz, limit, first_limit
        bx, by, bz = cx, cy, cz


@kernel
def _bend(x: float, y: float, z: float, size: float, cx: float, cy: float, cz: float) -> float:
    """Distance of the unit vector of a sum of this size from one of its two unit vectors."""
    x, y, z = x / size - cx, y / size - cy, z / size - cz
    return math.sqrt(x * x + y * y + z * z)


@kernel
def _first_bend(points: Float64s, i: int, bound: tuple[float, float, float]) -> float:
    """Bend between the tangent at point ``i``, which has a segment on either side, and the segment after it."""
    one_point = bound[0] * ONE_POINT
    bx, by, bz, before = direction(points, i - 1)
    cx, cy, cz, length = direction(points, i)
    if before <= bound[0] and length <= bound[0]:
        return 0.0
    if before <= one_point:
        bx = by = bz = 0.0
    if length <= one_point:
        cx = cy = cz = 0.0
    x, y, z = bx + cx, by + cy, bz + cz
    size = math.sqrt(x * x + y * y + z * z)
    return _bend(x, y, z, size, cx, cy, cz) if size > LEAST_SUM else 0.0


@kernel
def _next_slot(points: Float64s, a: int, stop: int, bound: tuple[float, float, float]) -> int:
    """Return the end of the slot that begins at point ``a``, in a streamline that ends before ``stop``."""
    if stop - a <= MAX_POINTS:
        return stop
    found, least = a + MAX_POINTS, math.inf
    for i in range(a + MAX_POINTS, a + MAX_POINTS - LOOK_BACK, -1):
        if i + 1 == stop:  # a single point draws no segment
            return i
        bend = _first_bend(points, i, bound)
        if bend < least:
            found, least = i, bend
        if bend <= FIRST_SHARE * bound[2]:
            break
    return found


@parallel_kernel
def cut(
    points: Float64s, offsets: Int64s, bound: tuple[float, float, float], per: Int64s, at: Int64s, slots: Int64s
) -> None:
    """Cut streamlines into slots of at most 60 points."""
    # Called twice: with an empty `slots`, to fill `per (n_streamlines,)` with the number of slots of each streamline;
    # and with `at (n_streamlines,)`, the first slot of each, to fill `slots (m, 2)` with first points and counts.
    for s in numba.prange(len(offsets) - 1):
        a = offsets[s]
        found = 0
        while a < offsets[s + 1]:
            b = _next_slot(points, a, offsets[s + 1], bound)
            if len(slots) > 0:
                slots[at[s] + found, 0], slots[at[s] + found, 1] = a, b - a
            found += 1
            a = b
        per[s] = found


@kernel
def excess(units: Float64s, a: int, b: int, decoded: Float64s, following: Float64s, leads: bool) -> float:
    """Greatest ratio of a turn to its bound, over the segments that lead on from the fiblet ``decoded[a:b]``."""
    # `leads`: a segment leads from the last of them to `following`.
    worst = 0.0
    for i in range(a, b if leads else b - 1):
        allowed = units[i, 3]
        if i == a and units[i, 4] >= 0.0:
            allowed = min(allowed, units[i, 4])
        if allowed == math.inf:
            continue
        if i + 1 < b:
            x, y, z, _ = direction(decoded, i)
        else:
            x, y, z, _ = unit(following[0] - decoded[i, 0], following[1] - decoded[i, 1], following[2] - decoded[i, 2])
        x, y, z = x - units[i, 0], y - units[i, 1], z - units[i, 2]
        worst = max(worst, math.sqrt(x * x + y * y + z * z) / allowed)
    return worst


@kernel
def _cosine(points: Float64s, i: int, one_point: float) -> tuple[float, float]:
    """Cosine of the turn at point ``i``, and the length of the segment from it on."""
    # Where a segment has no direction, that of a turn whose tangent's sum is as long: that of one unit vector.
    ax, ay, az, before = direction(points, i - 1)
    bx, by, bz, length = direction(points, i)
    if before <= one_point or length <= one_point:
        return -0.5, length
    return ax * bx + ay * by + az * bz, length


@kernel
def within(points: Float64s, first: int, n: int, follows: tuple[bool, bool, bool], bound: tuple[float, float, float],
           step: float, apart: float, least: float) -> bool:  # fmt: skip
    """Whether no segment of a slot can be turned too far: told of nearly all direction codes by few figures."""
    # `apart` is the largest distance of a decoded point from its original, the next slot's first included. All segments
    # drawn have the length `step`, but for the one to the next slot. Turns within the slot have cosines of at least
    # `least`. True is certain; for False, `excess` decides.
    #
    # A segment drawn as `e` instead of `d` has its unit vector turned by at most `2 |e - d| / (|d| + |e|)`, and `|e -
    # d|` is at most twice `apart`. Of a turn of cosine `c` the tangent's sum is `sqrt(2 + 2 c)` long.
    if n < 3:
        return False
    one_point = ONE_POINT * bound[0]
    shortest = step
    if follows[0]:
        cosine, _ = _cosine(points, first, one_point)
        least = min(least, cosine)
        first_limit = bound[2] - _first_bend(points, first, bound)
        if first_limit >= (1.0 - FIRST_SHARE) * bound[2] and 2.0 * apart > _MARGIN * first_limit * (step - apart):
            return False
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
