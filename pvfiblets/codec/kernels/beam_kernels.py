"""Direction codes with look-ahead: a beam of paths instead of one greedy path (``effort='high'``).

Greedy closed loop takes the code nearest to the next point; where that leaves the frame pointing badly, the point after
pays for it. Here several partial codings are kept at once. Each is extended by the nearest code and by that code's
nearest neighbours, and the ones with the least sum of squared errors go on. Several cap angles are tried; the result
is the one with the least sum of squares among the codings within the error bound.
"""

from __future__ import annotations

import math

import numba
import numpy as np

from ...support.array_types import Float64s, Int32s, Int64s, UInt8s, UInt16s, UInt32s
from ..jit import kernel, parallel_kernel
from ..layout import MAX_POINTS, STEP_LEVELS
from .capsule_kernels import capsule
from .direction_kernels import (
    BLOCK,
    _nearest,
    _smallest_cap,
    _step_index,
    anchor_of,
    first_frame,
    follows,
    pack_direction,
    quantise,
    take_points,
    turn,
)
from .turn_kernels import excess, may_turn

WIDTH = 6  # partial codings kept
BRANCH = 5  # continuations tried from each: the nearest code and four of its neighbours


@kernel
def neighbours(directions: Float64s) -> UInt8s:
    """The ``BRANCH - 1`` codes nearest to each code: ``(caps, 256, BRANCH - 1)`` uint8."""
    caps = len(directions)
    found = np.zeros((caps, 256, BRANCH - 1), np.uint8)
    for cap in range(caps):
        for code in range(256):
            taken = np.zeros(256, np.bool_)
            taken[code] = True
            for k in range(BRANCH - 1):
                nearest, least = 0, 1e9
                for other in range(256):
                    d = 0.0
                    for axis in range(3):
                        d += (directions[cap, other, axis] - directions[cap, code, axis]) ** 2
                    if d < least and not taken[other]:
                        nearest, least = other, d
                taken[nearest] = True
                found[cap, code, k] = nearest
    return found


@kernel
def _beam(true: Float64s, n: int, step: float, cap: int, give_up: float,
          tables: tuple[Float64s, Float64s, Float64s, Int32s, UInt8s], near: UInt8s,
          scratch: tuple[Float64s, Float64s, Float64s, UInt8s, UInt8s], codes: UInt8s) -> float:  # fmt: skip
    """Code ``true[:n]`` from the anchor ``scratch[0]``; return the sum of squared errors, inf above the error bound."""
    anchor, states, fresh, parents, chosen = scratch
    quats, dirs, ratios, starts, listed = tables
    table, reach, start, ratio = quats[cap], dirs[cap], starts[cap], ratios[cap]
    px, py, pz = anchor[0], anchor[1], anchor[2]
    total = (true[0, 0] - px) ** 2 + (true[0, 1] - py) ** 2 + (true[0, 2] - pz) ** 2
    word = pack_direction(true[1, 0] - px, true[1, 1] - py, true[1, 2] - pz)
    dx, dy, dz, w, x, y, z = first_frame(word)
    px += step * dx
    py += step * dy
    pz += step * dz
    first = (true[1, 0] - px) ** 2 + (true[1, 1] - py) ** 2 + (true[1, 2] - pz) ** 2
    if total > give_up or first > give_up:
        return math.inf
    # A state: position, frame, sum of squared errors.
    states[0, 0], states[0, 1], states[0, 2] = px, py, pz
    states[0, 3], states[0, 4], states[0, 5], states[0, 6] = w, x, y, z
    states[0, 7] = total + first
    alive = 1
    for i in range(2, n):
        kept = 0
        for s in range(alive):
            px, py, pz = states[s, 0], states[s, 1], states[s, 2]
            w, x, y, z = states[s, 3], states[s, 4], states[s, 5], states[s, 6]
            ax, ay, az = true[i, 0] - px, true[i, 1] - py, true[i, 2] - pz
            l0 = ax * (1.0 - 2.0 * (y * y + z * z)) + ay * (2.0 * (x * y + w * z)) + az * (2.0 * (x * z - w * y))
            l1 = ax * (2.0 * (x * y - w * z)) + ay * (1.0 - 2.0 * (x * x + z * z)) + az * (2.0 * (y * z + w * x))
            l2 = ax * (2.0 * (x * z + w * y)) + ay * (2.0 * (y * z - w * x)) + az * (1.0 - 2.0 * (x * x + y * y))
            nearest = _nearest(l0, l1, l2, ratio, start, listed, reach)
            for b in range(BRANCH):
                code = nearest if b == 0 else int(near[cap, nearest, b - 1])
                # The error needs no frame: |aim|^2 - 2 step aim.d + step^2, with d in the frame of the aim.
                ex, ey, ez = l0 - step * reach[code, 0], l1 - step * reach[code, 1], l2 - step * reach[code, 2]
                error = ex * ex + ey * ey + ez * ez
                if error > give_up:
                    continue
                score = states[s, 7] + error
                place = kept
                while place > 0 and fresh[place - 1, 7] > score:
                    place -= 1
                if place >= WIDTH:
                    continue
                for move in range(min(kept, WIDTH - 1), place, -1):
                    for v in range(10):
                        fresh[move, v] = fresh[move - 1, v]
                fresh[place, 7] = score
                fresh[place, 8] = s
                fresh[place, 9] = code
                kept = min(kept + 1, WIDTH)
        if kept == 0:
            return math.inf
        for k in range(kept):
            s, code = int(fresh[k, 8]), int(fresh[k, 9])
            parents[i, k], chosen[i, k] = s, code
            w, x, y, z = states[s, 3], states[s, 4], states[s, 5], states[s, 6]
            qw, qx, qy, qz = turn(w, x, y, z, table[code])
            fresh[k, 0] = states[s, 0] + step * (1.0 - 2.0 * (qy * qy + qz * qz))
            fresh[k, 1] = states[s, 1] + step * (2.0 * (qx * qy + qw * qz))
            fresh[k, 2] = states[s, 2] + step * (2.0 * (qx * qz - qw * qy))
            fresh[k, 3], fresh[k, 4], fresh[k, 5], fresh[k, 6] = qw, qx, qy, qz
        for k in range(kept):
            for v in range(8):
                states[k, v] = fresh[k, v]
        alive = kept
    k = 0
    for i in range(n - 1, 1, -1):
        codes[i - 2] = chosen[i, k]
        k = parents[i, k]
    return float(states[0, 7])


@kernel
def _follow(true: Float64s, n: int, step: float, cap: int, quats: Float64s, codes: UInt8s, decoded: Float64s) -> float:
    """Decode from the anchor in ``decoded[0]``; returns the largest squared error."""
    px, py, pz = decoded[0, 0], decoded[0, 1], decoded[0, 2]
    word = pack_direction(true[1, 0] - px, true[1, 1] - py, true[1, 2] - pz)
    dx, dy, dz, w, x, y, z = first_frame(word)
    worst = (true[0, 0] - px) ** 2 + (true[0, 1] - py) ** 2 + (true[0, 2] - pz) ** 2
    for i in range(1, n):
        if i > 1:
            w, x, y, z = turn(w, x, y, z, quats[cap, codes[i - 2]])
            dx, dy, dz = 1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)
        px, py, pz = px + step * dx, py + step * dy, pz + step * dz
        decoded[i, 0], decoded[i, 1], decoded[i, 2] = px, py, pz
        worst = max(worst, (true[i, 0] - px) ** 2 + (true[i, 1] - py) ** 2 + (true[i, 2] - pz) ** 2)
    return worst


@parallel_kernel
def encode_directions(points: Float64s, origin: Float64s, slots: Int64s, scale: Float64s, top: float,
                      steps: tuple[float, float], promise: float, bound: tuple[float, float, float], end_scale: float,
                      tables: tuple[Float64s, Float64s, Float64s, Int32s, UInt8s],
                      out: tuple[UInt8s, UInt32s, UInt16s, UInt8s, Float64s, UInt8s, UInt32s, UInt8s],
) -> None:  # fmt: skip
    """Try to code every slot with direction bytes, looking ahead; see :func:`.direction_kernels.encode_directions`."""
    ok, shape, step_index, cap_index, radius, end, end_words, codes = out
    lo, hi = steps
    give_up = promise * promise
    near = neighbours(tables[1])
    n_slots = len(slots)
    for block in numba.prange((n_slots + BLOCK - 1) // BLOCK):
        true, decoded = np.empty((MAX_POINTS, 3)), np.empty((MAX_POINTS, 3))
        trial = np.empty((2, MAX_POINTS), np.uint8)
        anchor, states, fresh = np.empty(3), np.empty((WIDTH, 10)), np.empty((WIDTH + 1, 10))
        parents, chosen = np.zeros((MAX_POINTS, WIDTH), np.uint8), np.zeros((MAX_POINTS, WIDTH), np.uint8)
        scratch = (anchor, states, fresh, parents, chosen)
        units = np.empty((MAX_POINTS, 5))
        for slot in range(block * BLOCK, min((block + 1) * BLOCK, n_slots)):
            if ok[slot]:
                continue
            first, n = slots[slot, 0], slots[slot, 1]
            take_points(points, origin, first, n, true)
            for axis in range(3):
                anchor[axis] = scale[axis] * quantise(true[0, axis], scale[axis], top)
                decoded[0, axis] = anchor[axis]
            shape[slot] = 0
            step_index[slot] = 0
            cap_index[slot] = 0
            ok[slot] = 0
            if n == 1:
                ok[slot] = 1
            else:
                index = _step_index(true, n, lo, hi)
                step = lo if hi <= lo else lo + index * (hi - lo) / STEP_LEVELS
                step_index[slot] = index
                smallest = _smallest_cap(true, n, tables[2])
                best, mine, used = math.inf, 0, 0
                # Half the error bound first: a low mean is not worth a point near the limit.
                for largest in (0.25 * give_up, give_up):
                    for cap in range(max(smallest - 1, 0), min(smallest + 3, len(tables[2]))):
                        score = _beam(true, n, step, cap, largest, tables, near, scratch, trial[1 - mine])
                        if score < best:
                            best, mine, used = score, 1 - mine, cap
                    if best < math.inf:
                        break
                if best < math.inf:
                    shape[slot] = pack_direction(true[1, 0] - anchor[0], true[1, 1] - anchor[1], true[1, 2] - anchor[2])
                    cap_index[slot] = used
                    for i in range(n - 2):
                        codes[first + i] = trial[mine, i]
                    ok[slot] = 1 if _follow(true, n, step, used, tables[0], trial[mine], decoded) <= give_up else 0
            if not end[slot]:
                anchor_of(points, origin, first + n, scale, top, anchor)
            if ok[slot] and bound[1] < math.inf and n + 1 - end[slot] > 1:
                may_turn(points, first, n, follows(slots, end, slot), bound, units)
                if excess(units, 0, n, decoded, anchor, not end[slot]) > 1.0:
                    ok[slot] = 0
            if ok[slot]:
                radius[slot], end_words[slot] = capsule(decoded, 0, n, end[slot], anchor, end_scale)
