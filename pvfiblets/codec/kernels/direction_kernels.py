"""Compiled kernels: direction codes in closed loop, and decoding.

Every code aims from the *decoded* previous point, in the decoded frame, at the true next point, so that errors do not
add up. Nothing here uses fast-math, so that codes are those of a literal reference in the tests, bit for bit.
Points are float32 or float64 arrays in mm; the origin is taken off in float64 as they are read.
"""

from __future__ import annotations

import math

import numba
import numpy as np

from ...support.array_types import Float64s, Int32s, Int64s, UInt8s, UInt16s, UInt32s
from ..jit import kernel, parallel_kernel
from ..layout import DIRECTION_SCALE, MAX_POINTS, STEP_LEVELS
from .capsule_kernels import capsule
from .nearest import CELLS, EXTENT
from .turn_kernels import excess, may_turn, within

BLOCK = 64  # slots that share one thread's scratch
_CELL = CELLS / (2.0 * EXTENT)


@parallel_kernel
def scan(points: Float64s, offsets: Int64s, found: Float64s) -> None:
    """Bounds, longest squared segment and farthest last fiblet, by thousands of streamlines."""
    # `found` is `(ceil(n_streamlines / 1024), 8)` float64: least x, y, z; greatest x, y, z; longest segment squared;
    # largest distance along an axis from the last point of a streamline to one of the last 60. A coordinate that is not
    # finite makes the row's bounds infinite.
    n = len(offsets) - 1
    for row in numba.prange(len(found)):
        for axis in range(3):
            found[row, axis] = math.inf
            found[row, 3 + axis] = -math.inf
        found[row, 6] = 0.0
        found[row, 7] = 0.0
        for s in range(row * 1024, min((row + 1) * 1024, n)):
            for i in range(offsets[s], offsets[s + 1]):
                squares = 0.0
                for axis in range(3):
                    value = np.float64(points[i, axis])
                    if not math.isfinite(value):
                        found[row, axis] = -math.inf
                        found[row, 3 + axis] = math.inf
                        continue
                    found[row, axis] = min(found[row, axis], value)
                    found[row, 3 + axis] = max(found[row, 3 + axis], value)
                    if i > offsets[s]:
                        squares += (value - np.float64(points[i - 1, axis])) ** 2
                found[row, 6] = max(found[row, 6], squares)
            last = offsets[s + 1] - 1
            if last >= offsets[s]:
                for i in range(max(last - MAX_POINTS + 1, offsets[s]), last):
                    for axis in range(3):
                        apart = abs(np.float64(points[last, axis]) - np.float64(points[i, axis]))
                        found[row, 7] = max(found[row, 7], apart)


@kernel
def quantise(value: float, scale: float, top: float) -> float:
    """Anchor coordinate as a whole number (float64 holds all 32 bits)."""
    if scale <= 0.0:
        return 0.0
    return min(max(float(np.rint(value / scale)), 0.0), top)


@kernel
def anchor_of(points: Float64s, origin: Float64s, i: int, scale: Float64s, top: float, anchor: Float64s) -> None:
    """Point ``i`` as an anchor holds it, into ``anchor``, from the origin."""
    for axis in range(3):
        anchor[axis] = scale[axis] * quantise(np.float64(points[i, axis]) - origin[axis], scale[axis], top)


@kernel
def take_points(points: Float64s, origin: Float64s, first: int, n: int, true: Float64s) -> None:
    """Points ``first`` to ``first + n`` into ``true``, in float64 and from the origin."""
    for i in range(n):
        for axis in range(3):
            true[i, axis] = np.float64(points[first + i, axis]) - origin[axis]


@kernel
def turn(w: float, x: float, y: float, z: float, t: Float64s) -> tuple[float, ...]:
    """Product of the frame ``(w, x, y, z)`` and a code's quaternion ``t``: the frame one step on."""
    return (
        w * t[0] - x * t[1] - y * t[2] - z * t[3],
        w * t[1] + x * t[0] + y * t[3] - z * t[2],
        w * t[2] - x * t[3] + y * t[0] + z * t[1],
        w * t[3] + x * t[2] - y * t[1] + z * t[0],
    )


@kernel
def pack_direction(x: float, y: float, z: float) -> int:
    """Quantise a vector to two snorm16 on the octahedron about +x."""
    if x == 0.0 and y == 0.0 and z == 0.0:
        x = 1.0
    norm = abs(x) + abs(y) + abs(z)
    u = y / norm
    v = z / norm
    if x < 0.0:
        su = 1.0 if u >= 0.0 else -1.0
        sv = 1.0 if v >= 0.0 else -1.0
        u, v = (1.0 - abs(v)) * su, (1.0 - abs(u)) * sv
    iu = int(np.rint(u * DIRECTION_SCALE))
    iv = int(np.rint(v * DIRECTION_SCALE))
    return (iu & 0xFFFF) | ((iv & 0xFFFF) << 16)


@kernel
def first_frame(word: int) -> tuple[float, ...]:
    """First direction and frame ``(dx, dy, dz, w, x, y, z)`` of a fiblet (the paper's ``M_0``, section 3.3.2)."""
    iu = word & 0xFFFF
    iv = (word >> 16) & 0xFFFF
    if iu >= 0x8000:
        iu -= 0x10000
    if iv >= 0x8000:
        iv -= 0x10000
    u = iu / DIRECTION_SCALE
    v = iv / DIRECTION_SCALE
    forward = abs(iu) + abs(iv) <= 32767
    x = 1.0 - abs(u) - abs(v)
    if forward:
        y, z = u, v
    else:
        y = (1.0 - abs(v)) * (1.0 if u >= 0.0 else -1.0)
        z = (1.0 - abs(u)) * (1.0 if v >= 0.0 else -1.0)
    r = 1.0 / math.sqrt(x * x + y * y + z * z)
    dx, dy, dz = x * r, y * r, z * r
    if forward:
        qw, qy, qz = 1.0 + dx, -dz, dy
    else:
        qw, qy, qz = 1.0 - dx, dz, -dy
    r = 1.0 / math.sqrt(qw * qw + qy * qy + qz * qz)
    qw, qy, qz = qw * r, qy * r, qz * r
    if forward:
        return dx, dy, dz, qw, 0.0, qy, qz
    return dx, dy, dz, -qz, qy, 0.0, qw


@kernel
def _nearest(l0: float, l1: float, l2: float, ratio: float, start: Int32s, listed: UInt8s, table: Float64s) -> int:
    """Code whose direction is nearest to (l0, l1, l2); see `nearest`."""
    n = math.sqrt(l0 * l0 + l1 * l1 + l2 * l2)
    m = ratio * n * (n + l0)
    if m > 0.0:
        s = 1.0 / math.sqrt(m)
        i = (l1 * s + EXTENT) * _CELL
        j = (l2 * s + EXTENT) * _CELL
        if i >= 0.0 and j >= 0.0 and i < CELLS and j < CELLS:
            cell = int(j) * CELLS + int(i)
            a = start[cell]
            b = start[cell + 1]
            best = int(listed[a])
            if b - a > 1:
                top = l0 * table[best, 0] + l1 * table[best, 1] + l2 * table[best, 2]
                for k in range(a + 1, b):
                    code = int(listed[k])
                    score = l0 * table[code, 0] + l1 * table[code, 1] + l2 * table[code, 2]
                    if score > top:
                        top = score
                        best = code
            return best
    best = 0
    top = l0 * table[0, 0] + l1 * table[0, 1] + l2 * table[0, 2]
    for code in range(1, 256):
        score = l0 * table[code, 0] + l1 * table[code, 1] + l2 * table[code, 2]
        if score > top:
            top = score
            best = code
    return best


@kernel
def _greedy(true: Float64s, n: int, step: float, cap: int, give_up: float,
            tables: tuple[Float64s, Float64s, Float64s, Int32s, UInt8s], codes: UInt8s,
            decoded: Float64s) -> float:  # fmt: skip
    """Code ``true[:n]`` from the anchor in ``decoded[0]``; returns the largest squared error, inf above ``give_up``."""
    quats, dirs, ratios, starts, listed = tables
    table = quats[cap]
    reach = dirs[cap]
    start = starts[cap]
    ratio = ratios[cap]
    px, py, pz = decoded[0, 0], decoded[0, 1], decoded[0, 2]
    ex, ey, ez = true[0, 0] - px, true[0, 1] - py, true[0, 2] - pz
    worst = ex * ex + ey * ey + ez * ez
    word = pack_direction(true[1, 0] - px, true[1, 1] - py, true[1, 2] - pz)
    dx, dy, dz, w, x, y, z = first_frame(word)
    px += step * dx
    py += step * dy
    pz += step * dz
    decoded[1, 0], decoded[1, 1], decoded[1, 2] = px, py, pz
    ex, ey, ez = true[1, 0] - px, true[1, 1] - py, true[1, 2] - pz
    worst = max(worst, ex * ex + ey * ey + ez * ez)
    for i in range(2, n):
        if worst > give_up:
            return math.inf
        ax, ay, az = true[i, 0] - px, true[i, 1] - py, true[i, 2] - pz
        l0 = ax * (1.0 - 2.0 * (y * y + z * z)) + ay * (2.0 * (x * y + w * z)) + az * (2.0 * (x * z - w * y))
        l1 = ax * (2.0 * (x * y - w * z)) + ay * (1.0 - 2.0 * (x * x + z * z)) + az * (2.0 * (y * z + w * x))
        l2 = ax * (2.0 * (x * z + w * y)) + ay * (2.0 * (y * z - w * x)) + az * (1.0 - 2.0 * (x * x + y * y))
        code = _nearest(l0, l1, l2, ratio, start, listed, reach)
        codes[i - 2] = code
        w, x, y, z = turn(w, x, y, z, table[code])
        px += step * (1.0 - 2.0 * (y * y + z * z))
        py += step * (2.0 * (x * y + w * z))
        pz += step * (2.0 * (x * z - w * y))
        decoded[i, 0], decoded[i, 1], decoded[i, 2] = px, py, pz
        ex, ey, ez = true[i, 0] - px, true[i, 1] - py, true[i, 2] - pz
        worst = max(worst, ex * ex + ey * ey + ez * ez)
    return worst if worst <= give_up else math.inf


@kernel
def _smallest_cap(true: Float64s, n: int, ratios: Float64s) -> int:
    """Index of the smallest cap angle that holds every turn of the points."""
    least = 1.0
    for i in range(2, n):
        ax = true[i - 1, 0] - true[i - 2, 0]
        ay = true[i - 1, 1] - true[i - 2, 1]
        az = true[i - 1, 2] - true[i - 2, 2]
        bx, by, bz = true[i, 0] - true[i - 1, 0], true[i, 1] - true[i - 1, 1], true[i, 2] - true[i - 1, 2]
        norm = math.sqrt((ax * ax + ay * ay + az * az) * (bx * bx + by * by + bz * bz))
        if norm > 0.0:
            least = min(least, (ax * bx + ay * by + az * bz) / norm)
    for cap in range(len(ratios)):
        if 1.0 - ratios[cap] <= least:
            return cap
    return len(ratios) - 1


@kernel
def _step_index(true: Float64s, n: int, lo: float, hi: float) -> int:
    """Index of a fiblet's step between the file's least and greatest."""
    if hi <= lo:
        return 0
    arc = 0.0
    for i in range(1, n):
        dx, dy, dz = true[i, 0] - true[i - 1, 0], true[i, 1] - true[i - 1, 1], true[i, 2] - true[i - 1, 2]
        arc += math.sqrt(dx * dx + dy * dy + dz * dz)
    return int(np.rint(min(max((arc / (n - 1) - lo) / (hi - lo) * STEP_LEVELS, 0.0), float(STEP_LEVELS))))


@kernel
def _apart(points: Float64s, origin: Float64s, i: int, decoded: Float64s) -> float:
    """Distance of a decoded point (from the origin) from point ``i``."""
    x = np.float64(points[i, 0]) - origin[0] - decoded[0]
    y = np.float64(points[i, 1]) - origin[1] - decoded[1]
    z = np.float64(points[i, 2]) - origin[2] - decoded[2]
    return math.sqrt(x * x + y * y + z * z)


@kernel
def follows(slots: Int64s, end: UInt8s, slot: int) -> tuple[bool, bool, bool]:
    """Whether a segment leads to a slot's first point, one from its last, and one on from there."""
    more = end[slot] == 0
    return slot > 0 and end[slot - 1] == 0, more, more and (slots[slot + 1, 1] > 1 or end[slot + 1] == 0)


@parallel_kernel
def encode_directions(points: Float64s, origin: Float64s, slots: Int64s, scale: Float64s, top: float,
                      steps: tuple[float, float], promise: float, bound: tuple[float, float, float], end_scale: float,
                      tables: tuple[Float64s, Float64s, Float64s, Int32s, UInt8s],
                      out: tuple[UInt8s, UInt32s, UInt16s, UInt8s, Float64s, UInt8s, UInt32s, UInt8s],
) -> None:  # fmt: skip
    """Try to code every slot (at most 60 consecutive points) that is not `ok` with direction bytes."""
    ok, shape, step_index, cap_index, radius, end, end_words, codes = out
    lo, hi = steps
    give_up = promise * promise
    retry = 0.25 * give_up  # half the error bound: a wider cap is tried above it
    n_slots = len(slots)
    for block in numba.prange((n_slots + BLOCK - 1) // BLOCK):
        true = np.empty((MAX_POINTS, 3))
        decoded = np.empty((2, MAX_POINTS, 3))
        trial = np.empty((2, MAX_POINTS), np.uint8)
        following = np.empty(3)
        units = np.empty((MAX_POINTS, 5))
        for slot in range(block * BLOCK, min((block + 1) * BLOCK, n_slots)):
            if ok[slot]:
                continue
            first, n = slots[slot, 0], slots[slot, 1]
            take_points(points, origin, first, n, true)
            for axis in range(3):
                a = scale[axis] * quantise(true[0, axis], scale[axis], top)
                decoded[0, 0, axis] = a
                decoded[1, 0, axis] = a
            best = math.inf
            mine, smallest, step = 0, 0, lo
            if n == 1:
                best = 0.0
                shape[slot] = 0
                step_index[slot] = 0
                cap_index[slot] = 0
            else:
                index = _step_index(true, n, lo, hi)
                step = lo if hi <= lo else lo + index * (hi - lo) / STEP_LEVELS
                smallest = _smallest_cap(true, n, tables[2])
                for wider in range(3):
                    cap = smallest + wider
                    if cap >= len(tables[2]):
                        break
                    other = 1 - mine
                    error = _greedy(true, n, step, cap, min(give_up, best), tables, trial[other], decoded[other])
                    if error < best:
                        best = error
                        mine = other
                        cap_index[slot] = cap
                    if best <= retry:
                        break
                step_index[slot] = index
                shape[slot] = pack_direction(
                    true[1, 0] - decoded[0, 0, 0], true[1, 1] - decoded[0, 0, 1], true[1, 2] - decoded[0, 0, 2]
                )
                for i in range(n - 2):
                    codes[first + i] = trial[mine, i]
            ok[slot] = 1 if best <= give_up else 0
            if not end[slot]:
                anchor_of(points, origin, first + n, scale, top, following)
            if ok[slot] and bound[1] < math.inf and n + 1 - end[slot] > 1:
                around = follows(slots, end, slot)
                apart = math.sqrt(best)
                if around[1]:
                    apart = max(apart, _apart(points, origin, first + n, following))
                # The widest cap may be too narrow for a turn.
                least = 1.0 - tables[2][smallest] if smallest + 1 < len(tables[2]) else -1.0
                if not within(points, first, n, around, bound, step, apart, least):
                    may_turn(points, first, n, around, bound, units)
                    if excess(units, 0, n, decoded[mine], following, around[1]) > 1.0:
                        ok[slot] = 0
            if ok[slot]:
                radius[slot], end_words[slot] = capsule(decoded[mine], 0, n, end[slot], following, end_scale)
