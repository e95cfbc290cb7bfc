"""Compiled kernels: the winding number of a closed triangle mesh, and distances from its triangles.

Winding number: along +z from a position, each triangle met counts its turning sense in the projection along z. Whether
it is met is settled in that projection edge by edge, by the crossings of a ray along +x. An edge shared by two
triangles is evaluated from the same end both times (the smaller number first), so that it adds to one just when it
takes from the other, and no position falls between; of its ends the lower counts. Triangles are found through a grid
of cells in the projection.

Distance: a tree of boxes (bounding volume hierarchy), nearer child first. The triangle that was nearest to the position
before is looked at first: positions that follow one another are near each other, and most of the tree is then out of
reach at once.
"""

from __future__ import annotations

import math

import numba
import numpy as np

from ...codec.jit import kernel, parallel_kernel
from ...support.array_types import Float64s, Int32s, Int64s

_BLOCK = 1024
_FEW = 4  # triangles of a leaf of the tree
_DEEPEST = 64


@kernel
def build_cells(
    points: Float64s, triangles: Int64s, low: Float64s, steps: Float64s, nx: int, ny: int
) -> tuple[Int64s, Int64s]:
    """Return first places ``(nx ny + 1,)`` and triangle numbers of the cells, int64; ``steps`` are cells per mm."""
    counts = np.zeros(nx * ny + 1, np.int64)
    members = np.empty(0, np.int64)
    for filling in range(2):
        for t in range(len(triangles)):
            a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
            x0, x1 = _cells(points[a, 0], points[b, 0], points[c, 0], low[0], steps[0], nx)
            y0, y1 = _cells(points[a, 1], points[b, 1], points[c, 1], low[1], steps[1], ny)
            for j in range(y0, y1 + 1):
                for i in range(x0, x1 + 1):
                    if filling:
                        members[counts[j * nx + i]] = t
                        counts[j * nx + i] += 1
                    else:
                        counts[j * nx + i + 1] += 1
        if filling:
            counts[1:] = counts[:-1].copy()
            counts[0] = 0
        else:
            counts = np.cumsum(counts)
            members = np.empty(counts[-1], np.int64)
    return counts, members


@kernel
def _cell(value: float, low: float, step: float, n: int) -> int:
    # Rises with value, rounding included: a triangle's range holds the cell of whatever lies within the triangle.
    return min(max(int((value - low) * step), 0), n - 1)


@kernel
def _cells(a: float, b: float, c: float, low: float, step: float, n: int) -> tuple[int, int]:
    return _cell(min(a, b, c), low, step, n), _cell(max(a, b, c), low, step, n)


@kernel
def _crossing(points: Float64s, a: int, b: int, x: float, y: float) -> int:
    """Return +1 or -1 if the edge crosses the ray from (x, y) along +x upwards or downwards, 0 if it does not."""
    sign = 1
    if a > b:
        a, b, sign = b, a, -1
    ay, by = points[a, 1], points[b, 1]
    if (ay > y) == (by > y):
        return 0
    side = (points[b, 0] - points[a, 0]) * (y - ay) - (x - points[a, 0]) * (by - ay)
    # side / (by - ay) is how far right of x the edge passes.
    if (side > 0.0) if by > ay else (side < 0.0):
        return sign if by > ay else -sign
    return 0


@kernel
def winding_number(points: Float64s, triangles: Int64s, first: Int64s, members: Int64s, low: Float64s, high: Float64s,
                   steps: Float64s, nx: int, ny: int, x: float, y: float, z: float) -> int:  # fmt: skip
    """Winding number of a mesh, by its cells of :func:`build_cells`, about a position."""
    if not (low[0] <= x <= high[0] and low[1] <= y <= high[1] and low[2] <= z <= high[2]):
        return 0
    cell = _cell(y, low[1], steps[1], ny) * nx + _cell(x, low[0], steps[0], nx)
    found = 0
    for k in range(first[cell], first[cell + 1]):
        t = members[k]
        a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
        az, bz, cz = points[a, 2], points[b, 2], points[c, 2]
        if max(az, bz, cz) <= z:
            continue
        turns = _crossing(points, a, b, x, y) + _crossing(points, b, c, x, y) + _crossing(points, c, a, x, y)
        if turns == 0:
            continue
        if min(az, bz, cz) > z:
            found += turns
            continue
        # Above the position is the triangle if the position is on the lower side of its plane; from the smallest
        # number first, so that a triangle is one plane however it is written.
        while a > b or a > c:
            a, b, c = b, c, a
        ux, uy, uz = points[b, 0] - points[a, 0], points[b, 1] - points[a, 1], points[b, 2] - points[a, 2]
        vx, vy, vz = points[c, 0] - points[a, 0], points[c, 1] - points[a, 1], points[c, 2] - points[a, 2]
        wx, wy, wz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
        height = (x - points[a, 0]) * wx + (y - points[a, 1]) * wy + (z - points[a, 2]) * wz
        if (height < 0.0) if turns > 0 else (height > 0.0):
            found += turns
    return found


@parallel_kernel
def winding(points: Float64s, triangles: Int64s, first: Int64s, members: Int64s, low: Float64s, high: Float64s,
            steps: Float64s, nx: int, ny: int, linear: Float64s, centre: Float64s, places: Float64s,
            out: Int32s) -> None:  # fmt: skip
    """Winding numbers, into ``out`` (n,) int32, about ``linear (places - centre)``."""
    n = len(places)
    for block in numba.prange((n + _BLOCK - 1) // _BLOCK):
        for i in range(block * _BLOCK, min((block + 1) * _BLOCK, n)):
            x, y, z = places[i, 0] - centre[0], places[i, 1] - centre[1], places[i, 2] - centre[2]
            u = linear[0, 0] * x + linear[0, 1] * y + linear[0, 2] * z
            v = linear[1, 0] * x + linear[1, 1] * y + linear[1, 2] * z
            w = linear[2, 0] * x + linear[2, 1] * y + linear[2, 2] * z
            out[i] = winding_number(points, triangles, first, members, low, high, steps, nx, ny, u, v, w)


@kernel
def build_tree(points: Float64s, triangles: Int64s) -> tuple[Float64s, Int64s, Int64s]:
    """Return boxes (m, 6) float64, links (m, 2) int64 and the order of the triangles (n,) int64."""
    # A box's links are its two children, or, where the first is negative, `-1 - first` and the end of its triangles in
    # the order.
    n = len(triangles)
    middles = np.empty((n, 3))
    for t in range(n):
        for axis in range(3):
            p, q, r = points[triangles[t, 0], axis], points[triangles[t, 1], axis], points[triangles[t, 2], axis]
            middles[t, axis] = 0.5 * (min(p, q, r) + max(p, q, r))
    order = np.arange(n)
    boxes = np.empty((2 * n, 6))
    links = np.empty((2 * n, 2), np.int64)
    todo = np.empty((_DEEPEST, 3), np.int64)
    todo[0, 0], todo[0, 1], todo[0, 2] = 0, 0, n
    waiting, made = 1, 1
    while waiting > 0:
        waiting -= 1
        node, start, end = todo[waiting, 0], todo[waiting, 1], todo[waiting, 2]
        low, high = np.full(3, np.inf), np.full(3, -np.inf)
        least, most = np.full(3, np.inf), np.full(3, -np.inf)
        for k in range(start, end):
            t = order[k]
            for axis in range(3):
                for corner in range(3):
                    value = points[triangles[t, corner], axis]
                    low[axis], high[axis] = min(low[axis], value), max(high[axis], value)
                least[axis] = min(least[axis], middles[t, axis])
                most[axis] = max(most[axis], middles[t, axis])
        boxes[node, :3], boxes[node, 3:] = low, high
        if end - start <= _FEW:
            links[node, 0], links[node, 1] = -1 - start, end
            continue
        axis = int(np.argmax(most - least))
        part = order[start:end].copy()
        order[start:end] = part[np.argsort(middles[part, axis])]
        half = (start + end) // 2
        links[node, 0], links[node, 1] = made, made + 1
        todo[waiting, 0], todo[waiting, 1], todo[waiting, 2] = made, start, half
        todo[waiting + 1, 0], todo[waiting + 1, 1], todo[waiting + 1, 2] = made + 1, half, end
        waiting += 2
        made += 2
    return boxes[:made].copy(), links[:made].copy(), order


@kernel
def _box_square(boxes: Float64s, node: int, x: float, y: float, z: float) -> float:
    dx = max(boxes[node, 0] - x, x - boxes[node, 3], 0.0)
    dy = max(boxes[node, 1] - y, y - boxes[node, 4], 0.0)
    dz = max(boxes[node, 2] - z, z - boxes[node, 5], 0.0)
    return dx * dx + dy * dy + dz * dz


@kernel
def _meets_box(boxes: Float64s, node: int, p: Float64s, q: Float64s) -> bool:
    """Whether a segment meets a box, or comes as near to it as rounding could hide."""
    enter, leave = -1e-9, 1.0 + 1e-9
    for axis in range(3):
        low, high, d = boxes[node, axis] - p[axis], boxes[node, axis + 3] - p[axis], q[axis] - p[axis]
        slack = 1e-12 * (abs(low) + abs(high) + abs(d) + abs(p[axis]))
        low, high = low - slack, high + slack
        if (low > 0.0 and low > d) or (high < 0.0 and high < d):
            return False
        if d != 0.0:
            enter = max(enter, low / d if d > 0.0 else high / d)
            leave = min(leave, high / d if d > 0.0 else low / d)
    return enter <= leave + 1e-9


@kernel
def segment_crossings(points: Float64s, triangles: Int64s, boxes: Float64s, links: Int64s, order: Int64s, p: Float64s,
                      q: Float64s, stack: Int64s, ts: Float64s) -> tuple[int, Float64s]:  # fmt: skip
    """How many triangles a segment meets, and at which shares of it from 0 to 1: ``ts``, made longer where it must be.

    Triangles are taken a billionth larger than they are, so that none is missed on the edge of two; one met too often
    is harmless. Those that the segment lies in the plane of are not met: their neighbours are.
    """
    n, waiting = 0, 1
    stack[0] = 0
    dx, dy, dz = q[0] - p[0], q[1] - p[1], q[2] - p[2]
    while waiting > 0:
        waiting -= 1
        node = stack[waiting]
        if not _meets_box(boxes, node, p, q):
            continue
        left, right = links[node, 0], links[node, 1]
        if left >= 0:
            stack[waiting], stack[waiting + 1] = left, right
            waiting += 2
            continue
        for i in range(-1 - left, right):
            a, b, c = triangles[order[i], 0], triangles[order[i], 1], triangles[order[i], 2]
            ux, uy, uz = points[b, 0] - points[a, 0], points[b, 1] - points[a, 1], points[b, 2] - points[a, 2]
            vx, vy, vz = points[c, 0] - points[a, 0], points[c, 1] - points[a, 1], points[c, 2] - points[a, 2]
            wx, wy, wz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
            fall = dx * wx + dy * wy + dz * wz
            if fall == 0.0:
                continue
            x, y, z = p[0] - points[a, 0], p[1] - points[a, 1], p[2] - points[a, 2]
            t = -(x * wx + y * wy + z * wz) / fall
            if not -1e-9 <= t <= 1.0 + 1e-9:
                continue
            x, y, z = x + t * dx, y + t * dy, z + t * dz
            # Barycentric coordinates, times the squared length of the normal.
            squares = (wx * wx + wy * wy + wz * wz) * (1.0 + 1e-9)
            beta = (y * vz - z * vy) * wx + (z * vx - x * vz) * wy + (x * vy - y * vx) * wz
            gamma = (uy * z - uz * y) * wx + (uz * x - ux * z) * wy + (ux * y - uy * x) * wz
            if min(beta, gamma) < -1e-9 * squares or beta + gamma > squares:
                continue
            if n == len(ts):
                ts = np.concatenate((ts, np.empty(n)))
            ts[n] = min(max(t, 0.0), 1.0)
            n += 1
    return n, ts


@kernel
def _edge_square(px: float, py: float, pz: float, ex: float, ey: float, ez: float) -> float:
    """Squared distance of p from the segment from 0 to e."""
    squares = ex * ex + ey * ey + ez * ez
    t = min(max((px * ex + py * ey + pz * ez) / squares, 0.0), 1.0) if squares > 0.0 else 0.0
    px, py, pz = px - t * ex, py - t * ey, pz - t * ez
    return px * px + py * py + pz * pz


@kernel
def _triangle_square(points: Float64s, a: int, b: int, c: int, x: float, y: float, z: float) -> float:
    """Squared distance from a triangle: from its edges or, where the foot of the perpendicular is inside, its plane."""
    # Degenerate ones have no foot inside (the comparisons are strict) and are their edges.
    ux, uy, uz = points[b, 0] - points[a, 0], points[b, 1] - points[a, 1], points[b, 2] - points[a, 2]
    vx, vy, vz = points[c, 0] - points[a, 0], points[c, 1] - points[a, 1], points[c, 2] - points[a, 2]
    px, py, pz = x - points[a, 0], y - points[a, 1], z - points[a, 2]
    nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    squares = nx * nx + ny * ny + nz * nz
    # Barycentric coordinates of the foot, times the squared length of the normal.
    beta = (py * vz - pz * vy) * nx + (pz * vx - px * vz) * ny + (px * vy - py * vx) * nz
    gamma = (uy * pz - uz * py) * nx + (uz * px - ux * pz) * ny + (ux * py - uy * px) * nz
    if beta > 0.0 and gamma > 0.0 and beta + gamma < squares:
        height = px * nx + py * ny + pz * nz
        return height * height / squares
    found = min(_edge_square(px, py, pz, ux, uy, uz), _edge_square(px, py, pz, vx, vy, vz))
    return min(found, _edge_square(px - ux, py - uy, pz - uz, vx - ux, vy - uy, vz - uz))


@kernel
def nearest(points: Float64s, triangles: Int64s, boxes: Float64s, links: Int64s, order: Int64s, guess: int,
            share: float, stack: Int64s, reach: Float64s, x: float, y: float,
            z: float) -> tuple[float, int]:  # fmt: skip
    """Squared distance and nearest triangle; ``guess`` is looked at first. ``stack``, ``reach``: (64,) for scratch."""
    # With a `share` below 1 no triangle is nearer than that share of the square that is found.
    found = guess
    best = _triangle_square(points, triangles[guess, 0], triangles[guess, 1], triangles[guess, 2], x, y, z)
    stack[0], reach[0] = 0, _box_square(boxes, 0, x, y, z)
    waiting = 1
    while waiting > 0:
        waiting -= 1
        if not reach[waiting] < best * share:
            continue
        node = stack[waiting]
        left, right = links[node, 0], links[node, 1]
        if left < 0:
            for k in range(-1 - left, right):
                t = order[k]
                square = _triangle_square(points, triangles[t, 0], triangles[t, 1], triangles[t, 2], x, y, z)
                if square < best:
                    best, found = square, t
            continue
        near, far = _box_square(boxes, left, x, y, z), _box_square(boxes, right, x, y, z)
        if near > far:
            left, right, near, far = right, left, far, near
        if far < best * share:
            stack[waiting], reach[waiting] = right, far
            waiting += 1
        if near < best * share:
            stack[waiting], reach[waiting] = left, near
            waiting += 1
    return best, found


@parallel_kernel
def distances(
    points: Float64s, triangles: Int64s, boxes: Float64s, links: Int64s, order: Int64s, places: Float64s, out: Float64s
) -> None:
    """Distances of ``places`` (n, 3) from the nearest triangle, into ``out`` (n,)."""
    n = len(places)
    for block in numba.prange((n + _BLOCK - 1) // _BLOCK):
        stack, reach = np.empty(_DEEPEST, np.int64), np.empty(_DEEPEST)
        last = 0
        for i in range(block * _BLOCK, min((block + 1) * _BLOCK, n)):
            x, y, z = places[i, 0], places[i, 1], places[i, 2]
            best, last = nearest(points, triangles, boxes, links, order, last, 1.0, stack, reach, x, y, z)
            out[i] = math.sqrt(best)


@parallel_kernel
def nodes_of_grid(points: Float64s, triangles: Int64s, first: Int64s, members: Int64s, low: Float64s, high: Float64s,
                  steps: Float64s, nx: int, ny: int, boxes: Float64s, links: Int64s, order: Int64s, share: float,
                  origin: Float64s, step: float, out: Float64s) -> None:  # fmt: skip
    """Signed distances at grid points into ``out`` (nz, ny, nx) float64: positive where the winding number is not 0."""
    # They are lower bounds, of at least the root of `share` of the distance.
    size_z, size_y, size_x = out.shape
    for row in numba.prange(size_z * size_y):
        stack, reach = np.empty(_DEEPEST, np.int64), np.empty(_DEEPEST)
        k, j = row // size_y, row % size_y
        y, z = origin[1] + step * j, origin[2] + step * k
        last = 0
        for i in range(size_x):
            x = origin[0] + step * i
            best, last = nearest(points, triangles, boxes, links, order, last, share, stack, reach, x, y, z)
            best *= share
            turns = winding_number(points, triangles, first, members, low, high, steps, nx, ny, x, y, z)
            out[k, j, i] = math.sqrt(best) if turns != 0 else -math.sqrt(best)
