"""Compiled kernels: what of a compressed set lies under an area of the screen; see :mod:`.screen`."""

from __future__ import annotations

import math

import numba
import numpy as np

from ...codec.jit import kernel, parallel_kernel
from ...codec.kernels.capsule_kernels import anchor_part, end_part
from ...codec.layout import PAGE_BITS
from ...support.array_types import Bools, Float64s, Int64s, UInt16s, UInt32s

_RANK_MASK, _BEGIN, _END = (1 << 14) - 1, 30, 31


@kernel
def _inside(polygon: Float64s, x: float, y: float) -> bool:
    """Whether a point lies in a polygon by the even-odd rule."""
    found = False
    j = len(polygon) - 1
    for i in range(len(polygon)):
        ax, ay, bx, by = polygon[i, 0], polygon[i, 1], polygon[j, 0], polygon[j, 1]
        if (ay > y) != (by > y) and x < (bx - ax) * (y - ay) / (by - ay) + ax:
            found = not found
        j = i
    return found


@kernel
def _along(ax: float, ay: float, bx: float, by: float, x: float, y: float) -> tuple[float, float]:
    """Return the place on a segment nearest to another, from 0 to 1, and the square of the distance."""
    dx, dy = bx - ax, by - ay
    squares = dx * dx + dy * dy
    s = min(max(((x - ax) * dx + (y - ay) * dy) / squares, 0.0), 1.0) if squares > 0.0 else 0.0
    ex, ey = x - ax - s * dx, y - ay - s * dy
    return s, ex * ex + ey * ey


@kernel
def _distance(polygon: Float64s, x: float, y: float) -> float:
    """Distance of a point from the area of a polygon; 0 inside."""
    if _inside(polygon, x, y):
        return 0.0
    least = np.inf
    j = len(polygon) - 1
    for i in range(len(polygon)):
        _, squares = _along(polygon[j, 0], polygon[j, 1], polygon[i, 0], polygon[i, 1], x, y)
        least = min(least, squares)
        j = i
    return math.sqrt(least)


@parallel_kernel
def distances(polygon: Float64s, points: Float64s) -> Float64s:
    """``(n,)`` distances of points ``(n, 2)`` from the area of a polygon ``(k, 2)``, 0 inside."""
    found = np.empty(len(points))
    for i in numba.prange(len(points)):
        found[i] = _distance(polygon, points[i, 0], points[i, 1])
    return found


@kernel
def _touching(
    polygon: Float64s, tolerance: float, x0: float, y0: float, x1: float, y1: float
) -> tuple[bool, float, float]:
    """Whether a segment comes within ``tolerance`` of a polygon's area, and the ends of the part that does."""
    # Of two segments that do not cross, an end of one is nearest to the other: it suffices to look at crossings, at the
    # segment's ends, and at the polygon's corners. Between the first and the last of those places the segment may leave
    # a polygon that is not convex.
    first, last = np.inf, -np.inf
    if _distance(polygon, x0, y0) <= tolerance:
        first, last = 0.0, 0.0
    if _distance(polygon, x1, y1) <= tolerance:
        first, last = min(first, 1.0), 1.0
    if first == 0.0 and last == 1.0:
        return True, 0.0, 1.0
    dx, dy = x1 - x0, y1 - y0
    j = len(polygon) - 1
    for i in range(len(polygon)):
        ax, ay, bx, by = polygon[j, 0], polygon[j, 1], polygon[i, 0], polygon[i, 1]
        j = i
        ex, ey = bx - ax, by - ay
        turn = dx * ey - dy * ex
        if turn != 0.0:
            s = ((ax - x0) * ey - (ay - y0) * ex) / turn
            u = ((ax - x0) * dy - (ay - y0) * dx) / turn
            if 0.0 <= s <= 1.0 and 0.0 <= u <= 1.0:
                first, last = min(first, s), max(last, s)
        s, squares = _along(x0, y0, x1, y1, bx, by)
        if squares <= tolerance * tolerance:
            first, last = min(first, s), max(last, s)
    return last >= first, first, last


@kernel
def _project(matrix: Float64s, points: Float64s, i: int, clip: Float64s) -> None:
    x, y, z = points[i, 0], points[i, 1], points[i, 2]
    for row in range(4):
        clip[row] = matrix[row, 0] * x + matrix[row, 1] * y + matrix[row, 2] * z + matrix[row, 3]


@kernel
def _part_inside(points: Float64s, i: int, j: int, planes: Float64s) -> tuple[float, float]:
    """Part of the segment from point ``i`` to ``j`` on the kept side of all planes: ``(t0, t1)``, t0 > t1 if none."""
    t0, t1 = 0.0, 1.0
    for k in range(len(planes)):
        a, b, c, d = planes[k, 0], planes[k, 1], planes[k, 2], planes[k, 3]
        at = a * points[i, 0] + b * points[i, 1] + c * points[i, 2] + d
        to = a * points[j, 0] + b * points[j, 1] + c * points[j, 2] + d
        if at < 0.0 and to < 0.0:
            return 1.0, 0.0
        if at < 0.0:
            t0 = max(t0, at / (at - to))
        elif to < 0.0:
            t1 = min(t1, at / (at - to))
        elif not (at >= 0.0 and to >= 0.0):
            return 1.0, 0.0  # not a number
    return t0, t1


@kernel
def _segment(points: Float64s, i: int, j: int, matrix: Float64s, planes: Float64s, size: Float64s, polygon: Float64s,
             tolerance: float, work: Float64s) -> tuple[bool, float, float, float, float]:  # fmt: skip
    """Whether a segment is hit; where the first and the last place lie (0 to 1); their depths (-1 to 1)."""
    t0, t1 = _part_inside(points, i, j, planes)
    if t0 > t1:
        return False, 0.0, 0.0, 0.0, 0.0
    p, q, a, b = work[0], work[1], work[2], work[3]
    _project(matrix, points, i, p)
    _project(matrix, points, j, q)
    for row in range(4):
        a[row] = p[row] + t0 * (q[row] - p[row])
        b[row] = p[row] + t1 * (q[row] - p[row])
    if not (a[3] > 0.0 and b[3] > 0.0):
        return False, 0.0, 0.0, 0.0, 0.0
    x0, y0 = (a[0] / a[3] + 1.0) * 0.5 * size[0], (a[1] / a[3] + 1.0) * 0.5 * size[1]
    x1, y1 = (b[0] / b[3] + 1.0) * 0.5 * size[0], (b[1] / b[3] + 1.0) * 0.5 * size[1]
    found, s0, s1 = _touching(polygon, tolerance, x0, y0, x1, y1)
    z0, z1 = a[2] / a[3], b[2] / b[3]
    # What divides the picture evenly divides the segment by the ends' w.
    u0 = s0 * a[3] / (s0 * a[3] + (1.0 - s0) * b[3])
    u1 = s1 * a[3] / (s1 * a[3] + (1.0 - s1) * b[3])
    return found, t0 + u0 * (t1 - t0), t0 + u1 * (t1 - t0), z0 + s0 * (z1 - z0), z0 + s1 * (z1 - z0)


@kernel
def _set(words: UInt32s, i: int) -> bool:
    return len(words) == 0 or bool((words[i >> 5] >> np.uint32(i & 31)) & np.uint32(1))


@parallel_kernel
def candidates(first: int, count: int, arrays: tuple[UInt32s, UInt16s, UInt16s, UInt32s, Int64s],
               grid: tuple[Float64s, Float64s, bool, float, float, float], spaces: Float64s, ranks: Bools, found: Bools,
               balls: Float64s) -> int:  # fmt: skip
    """Capsules of consecutive fiblets that reach into all half spaces; returns how many."""
    anchors, low, reach, ends, rank_base = arrays
    origin, scale, fine, reach_scale, end_scale, slack = grid
    total = 0
    for m in numba.prange(count):
        f = first + m
        w1 = np.int64(anchors[f, 1])
        rank = rank_base[f >> PAGE_BITS] + ((w1 >> 16) & _RANK_MASK)
        found[m] = False
        if len(ranks) and not (0 <= rank < len(ranks) and ranks[rank]):
            continue
        ends_here = bool((w1 >> _END) & 1) or f + 1 >= len(anchors)
        radius = reach[f] * reach_scale + slack
        inside = True
        for k in range(len(spaces)):
            at, to = spaces[k, 3], spaces[k, 3]
            for axis in range(3):
                a = anchor_part(anchors, low, fine, f, axis) * scale[axis] + origin[axis]
                if not ends_here:
                    b = anchor_part(anchors, low, fine, f + 1, axis) * scale[axis] + origin[axis]
                else:
                    b = a + end_scale * (end_part(np.int64(ends[rank]), axis) if rank < len(ends) else 0)
                at += spaces[k, axis] * a
                to += spaces[k, axis] * b
            if max(at, to) + radius < 0.0:
                inside = False
                break
        if not inside:
            continue
        chord = 0.0
        for axis in range(3):
            a = anchor_part(anchors, low, fine, f, axis) * scale[axis] + origin[axis]
            if not ends_here:
                b = anchor_part(anchors, low, fine, f + 1, axis) * scale[axis] + origin[axis]
            else:
                b = a + end_scale * (end_part(np.int64(ends[rank]), axis) if rank < len(ends) else 0)
            balls[m, axis] = 0.5 * (a + b)
            chord += (b - a) * (b - a)
        balls[m, 3] = 0.5 * math.sqrt(chord) + radius
        found[m] = True
        total += 1
    return total


@kernel
def _nearest(points: Float64s, start: int, count: int, first_point: int,
             screen: tuple[Float64s, Float64s, Float64s, Float64s, float],
             words: UInt32s) -> tuple[float, float]:  # fmt: skip
    """Depth and place of one fiblet; see :func:`hits`."""
    matrix, planes, size, polygon, tolerance = screen
    work = np.empty((4, 4))
    best, place = np.inf, 0.0
    for i in range(max(count - 1, 1)):
        j = min(i + 1, count - 1)
        if not (_set(words, first_point + i) and _set(words, first_point + j)):
            continue
        found, ta, tb, za, zb = _segment(points, start + i, start + j, matrix, planes, size, polygon, tolerance, work)
        if found and min(za, zb) < best:
            best = min(za, zb)
            place = i + ta if za <= zb else i + tb
    return best, place


@parallel_kernel
def hits(points: Float64s, starts: Int64s, counts: Int64s, first_point: Int64s,
         screen: tuple[Float64s, Float64s, Float64s, Float64s, float], words: UInt32s, depths: Float64s,
         places: Float64s) -> None:  # fmt: skip
    """Nearest place of each fiblet that lies under the area."""
    for m in numba.prange(len(starts)):
        depths[m], places[m] = _nearest(points, starts[m], counts[m], first_point[m], screen, words)


@parallel_kernel
def spans(points: Float64s, starts: Int64s, counts: Int64s, first_point: Int64s,
          screen: tuple[Float64s, Float64s, Float64s, Float64s, float], words: UInt32s,
          out: Float64s) -> None:  # fmt: skip
    """The same for every segment: ``out (n, 2)``, the part of the segment from each point that lies under the area."""
    # NaN where there is none; parameters as for `hits`.
    for m in numba.prange(len(starts)):
        _parts(points, starts[m], counts[m], first_point[m], screen, words, out)


@kernel
def _parts(points: Float64s, start: int, count: int, first_point: int,
           screen: tuple[Float64s, Float64s, Float64s, Float64s, float], words: UInt32s,
           out: Float64s) -> None:  # fmt: skip
    """Parts of one fiblet's segments; see :func:`spans`."""
    matrix, planes, size, polygon, tolerance = screen
    work = np.empty((4, 4))
    for i in range(count):
        out[start + i, 0] = out[start + i, 1] = np.nan
    for i in range(max(count - 1, 1)):
        j = min(i + 1, count - 1)
        if not (_set(words, first_point + i) and _set(words, first_point + j)):
            continue
        found, ta, tb, _, _ = _segment(points, start + i, start + j, matrix, planes, size, polygon, tolerance, work)
        if found:
            out[start + i, 0], out[start + i, 1] = min(ta, tb), max(ta, tb)
