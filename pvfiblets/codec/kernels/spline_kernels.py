"""Compiled kernels: fiblets of cubic splines (outlook of Russig et al. 2020, section 5).

Symbols, in units of the lattice's edge about the fiblet's anchor
    P, v         place and slope (per point) where a piece begins; the first slope is in the record
    n            points that the piece spans; `d` and `e` are the two vectors of its node, whole numbers
    x            m / n, for m = 1 .. n

A piece is ``P + m v + x^2 (d - 2 e) + 2 e x^3``: straight on, bent by `d` at its end, and by `e` between its ends. The
next begins at ``P + n v + d`` with the slope ``v + 2 (d + e) / n``, so that the curve and its slope are continuous.
Points keep their parameters: point i of a fiblet is decoded at i.

Coding is greedy and in closed loop: each piece is as long as the error bound and the bound of directions allow. `d` and
`e` are the least-squares fit to the points of the piece and to two after it, so that the slope leads on to them.
"""

from __future__ import annotations

import numba
import numpy as np
import numpy.typing as npt

from ...support.array_types import Float64s, Int64s, UInt8s, UInt16s, UInt32s
from ..jit import kernel, parallel_kernel
from ..layout import MAX_POINTS, NODE_BITS, NODE_BYTES, SLOPE_BITS, SLOPE_SHIFT, SPLINE, WIDE
from .capsule_kernels import capsule
from .direction_kernels import anchor_of, follows, take_points
from .turn_kernels import excess, may_turn

BLOCK = 64  # slots that share one thread's scratch
HALVINGS = 2  # of the lattice's edge
AHEAD = 2  # points behind a piece that its fit counts
_FIRST = 8  # span that is tried first
_LARGEST = (1 << (NODE_BITS - 1)) - 1
_STEEPEST = (1 << (SLOPE_BITS - 1)) - 1
_UNBOUND = -2.0


def _normal_equations() -> npt.NDArray[np.float64]:
    """Sums of ff, fg and gg by points of a piece and points ahead of it; a point is ``d f + e g``."""
    sums = np.zeros((MAX_POINTS, AHEAD + 1, 3))
    for n in range(1, MAX_POINTS):
        x = np.arange(1, n + 1) / n
        for ahead in range(AHEAD + 1):
            beyond = np.arange(1, ahead + 1) / n
            f, g = np.append(x**2, 1.0 + 2.0 * beyond), np.append(2.0 * (x**3 - x**2), 2.0 * beyond)
            sums[n, ahead] = (f * f).sum(), (f * g).sum(), (g * g).sum()
    return sums


NORMAL_EQUATIONS = _normal_equations()


@kernel
def slope(word: int, axis: int) -> float:
    """One component of a fiblet's first slope, from its record."""
    level = (word >> (SLOPE_BITS * axis)) & ((1 << SLOPE_BITS) - 1)
    if level > _STEEPEST:
        level -= 1 << SLOPE_BITS
    return level * 4.0 ** (word >> (3 * SLOPE_BITS)) * 0.5**SLOPE_SHIFT


@kernel
def load(codes: UInt8s, at: int, node: Float64s) -> int:
    """Unpack the node at byte `at` into `d` and `e`, the rows of `node`; returns its span."""
    word = np.int64(0)
    for byte in range(NODE_BYTES):
        word |= np.int64(codes[at + byte]) << (8 * byte)
    for k in range(6):
        level = (word >> (6 + NODE_BITS * k)) & ((1 << NODE_BITS) - 1)
        node[k // 3, k % 3] = level - (1 << NODE_BITS) if level > _LARGEST else level
    return int(word & 63)


@kernel
def point_of(state: Float64s, node: Float64s, m: int, n: int, axis: int) -> float:
    """One component of point `m` of a piece; rows of `state` are its place and its slope."""
    x = m / n
    d, e = node[0, axis], node[1, axis]
    return float(state[0, axis] + m * state[1, axis] + x * x * ((d - 2.0 * e) + 2.0 * e * x))


@kernel
def advance(state: Float64s, node: Float64s, n: int) -> None:
    """Go on to where the next piece begins."""
    for axis in range(3):
        d, e = node[0, axis], node[1, axis]
        state[0, axis] += n * state[1, axis] + d
        state[1, axis] += 2.0 * (d + e) / n


@kernel
def _first_slope(true: Float64s, n: int, anchor: Float64s, h: float) -> int:
    """Word of the slope at the first point, of the parabola through the anchor that is nearest to four points."""
    wanted = np.empty(3)
    for axis in range(3):
        s2, s3, s4, b1, b2 = 0.0, 0.0, 0.0, 0.0, 0.0
        for m in range(1, min(5, n)):
            r = (true[m, axis] - anchor[axis]) / h
            s2, s3, s4 = s2 + m * m, s3 + m * m * m, s4 + m * m * m * m
            b1, b2 = b1 + m * r, b2 + m * m * r
        apart = s2 * s4 - s3 * s3
        wanted[axis] = (b1 * s4 - b2 * s3) / apart if apart > 0.0 else b1
    steepest = max(abs(wanted[0]), abs(wanted[1]), abs(wanted[2]))
    finest = 0
    while finest < 3 and steepest > (_STEEPEST - 1) * 4.0**finest * 0.5**SLOPE_SHIFT:
        finest += 1
    word = finest << (3 * SLOPE_BITS)
    for axis in range(3):
        level = float(np.rint(wanted[axis] / (4.0**finest * 0.5**SLOPE_SHIFT)))
        level = min(max(level, -float(_STEEPEST)), float(_STEEPEST))
        word |= (int(level) & ((1 << SLOPE_BITS) - 1)) << (SLOPE_BITS * axis)
    return word


@kernel
def _fit(true: Float64s, first: int, n: int, ahead: int, anchor: Float64s, h: float, state: Float64s, sums: Float64s,
         node: Float64s) -> bool:  # fmt: skip
    """Least-squares node of a piece of span `n` from point `first` on; whether its numbers are small enough."""
    ff, fg, gg = sums[0], sums[1], sums[2]
    for axis in range(3):
        bf, bg = 0.0, 0.0
        for m in range(1, n + ahead + 1):
            r = (true[first + m, axis] - anchor[axis]) / h - state[0, axis] - m * state[1, axis]
            x = m / n
            if m <= n:
                bf += x * x * r
                bg += 2.0 * (x - 1.0) * x * x * r
            else:
                bf += (2.0 * x - 1.0) * r
                bg += 2.0 * (x - 1.0) * r
        apart = ff * gg - fg * fg
        d = float(np.rint((bf * gg - bg * fg) / apart if apart > 1e-9 * ff * gg else bf / ff))
        # With `d` rounded, `e` is fitted anew; a single last point says nothing of it.
        e = float(np.rint((bg - fg * d) / gg)) if gg > 1e-9 else -d
        if not (abs(d) <= _LARGEST and abs(e) <= _LARGEST):
            return False
        node[0, axis], node[1, axis] = d, e
    return True


@kernel
def _turned(x: float, y: float, z: float, unit: Float64s, cosine: float) -> bool:
    """Whether a segment is turned too far."""
    if cosine == _UNBOUND:
        return False
    along = x * unit[0] + y * unit[1] + z * unit[2]
    squares = (x * x + y * y + z * z) * cosine * cosine
    if cosine >= 0.0:
        return along <= 0.0 or along * along < squares
    return along < 0.0 and along * along > squares


@kernel
def _holds(true: Float64s, first: int, n: int, last: int, anchor: Float64s, h: float, state: Float64s, node: Float64s,
           limit: float, turns: tuple[Float64s, Float64s, Float64s, bool], decoded: Float64s) -> bool:  # fmt: skip
    """Whether a piece keeps the bounds; its points into `decoded`."""
    units, cosines, following, leads = turns
    for m in range(1, n + 1):
        i = first + m
        squares = 0.0
        for axis in range(3):
            decoded[i, axis] = anchor[axis] + h * point_of(state, node, m, n, axis)
            squares += (decoded[i, axis] - true[i, axis]) ** 2
        if squares > limit:
            return False
        x, y = decoded[i, 0] - decoded[i - 1, 0], decoded[i, 1] - decoded[i - 1, 1]
        z = decoded[i, 2] - decoded[i - 1, 2]
        if _turned(x, y, z, units[i - 1], cosines[i - 1]):
            return False
    if first + n == last and leads:
        x, y, z = following[0] - decoded[last, 0], following[1] - decoded[last, 1], following[2] - decoded[last, 2]
        return not _turned(x, y, z, units[last], cosines[last])
    return True


@kernel
def _put(codes: UInt8s, at: int, n: int, node: Float64s) -> None:
    word = np.int64(n)
    for k in range(6):
        word |= (np.int64(node[k // 3, k % 3]) & ((1 << NODE_BITS) - 1)) << (6 + NODE_BITS * k)
    for byte in range(NODE_BYTES):
        codes[at + byte] = (word >> (8 * byte)) & 0xFF


@kernel
def _pieces(true: Float64s, n: int, total: int, room: int, anchor: Float64s, h: float, limit: float, word: int,
            sums: Float64s, turns: tuple[Float64s, Float64s, Float64s, bool],
            scratch: tuple[Float64s, Float64s, Float64s], decoded: Float64s, codes: UInt8s) -> int:  # fmt: skip
    """Code ``true[:n]`` into `codes`; returns the number of nodes, 0 if they take more bytes than `room`."""
    state, node, best = scratch
    for axis in range(3):
        state[0, axis], state[1, axis] = 0.0, slope(word, axis)
    first, last, nodes, span = 0, n - 1, 0, _FIRST
    while first < last:
        if (nodes + 1) * NODE_BYTES > room:
            return 0
        # Spans are doubled while the bounds hold, then bisected.
        good, bad, tried = 0, last - first + 1, min(span, last - first)
        while bad - good > 1:
            ahead = min(AHEAD, total - 1 - first - tried)
            if _fit(true, first, tried, ahead, anchor, h, state, sums[tried, ahead], node) and _holds(
                true, first, tried, last, anchor, h, state, node, limit, turns, decoded
            ):
                good = tried
                best[:] = node
            else:
                bad = tried
            tried = min(2 * good, bad - 1) if bad == last - first + 1 else (good + bad) // 2
        if good == 0:
            return 0
        for m in range(1, good + 1):
            for axis in range(3):
                decoded[first + m, axis] = anchor[axis] + h * point_of(state, best, m, good, axis)
        _put(codes, nodes * NODE_BYTES, good, best)
        advance(state, best, good)
        first, nodes, span = first + good, nodes + 1, good
    return nodes


@parallel_kernel
def encode_splines(points: Float64s, origin: Float64s, slots: Int64s, scale: Float64s, top: float, edge: float,
                   promise: float, bound: tuple[float, float, float], end_scale: float, sums: Float64s, tails: bool,
                   out: tuple[UInt8s, UInt8s, UInt32s, UInt16s, UInt8s, Float64s, UInt8s, UInt32s, UInt8s],
) -> None:  # fmt: skip
    """Code the slots that are not yet, of streamlines that splines make smaller than directions would."""
    # A streamline's last few points take more bytes as a spline. With `tails` they are splines as well if the slot
    # before saves that much: a set without a fiblet of directions is drawn by programs without them. Their codes stand
    # in the free bytes of the slot before.
    ok, kind, shape, step, cap, radius, end, end_words, codes = out
    h = edge * 0.5**HALVINGS
    for block in numba.prange((len(slots) + BLOCK - 1) // BLOCK):
        true, decoded = np.empty((MAX_POINTS + AHEAD, 3)), np.empty((MAX_POINTS, 3))
        scratch = (np.empty((2, 3)), np.empty((2, 3)), np.empty((2, 3)))
        units, cosines = np.empty((MAX_POINTS, 5)), np.empty(MAX_POINTS)
        anchor, following = np.empty(3), np.empty(3)
        for slot in range(block * BLOCK, min((block + 1) * BLOCK, len(slots))):
            first, n = slots[slot, 0], slots[slot, 1]
            at, room = first, n - 3
            if tails:
                if not end[slot] or slot == 0 or end[slot - 1] or kind[slot - 1] != WIDE:
                    continue
                before = (step[slot - 1] >> 3) * NODE_BYTES
                at, room = slots[slot - 1, 0] + before, slots[slot - 1, 1] - 2 - before + max(n - 2, 0)
            if ok[slot] or room < NODE_BYTES:
                continue
            total = n if end[slot] else n + min(AHEAD, slots[slot + 1, 1])
            take_points(points, origin, first, total, true)
            anchor_of(points, origin, first, scale, top, anchor)
            decoded[0] = anchor
            if not end[slot]:
                anchor_of(points, origin, first + n, scale, top, following)
            around = follows(slots, end, slot)
            leads = around[1]
            may_turn(points, first, n, around, bound, units)
            for i in range(n if leads else n - 1):
                chord = units[i, 3]
                if i == 0 and units[i, 4] >= 0.0:
                    chord = min(chord, units[i, 4])
                cosines[i] = 1.0 - 0.5 * chord * chord if chord < 2.0 else _UNBOUND
            word = _first_slope(true, n, anchor, h)
            turns = (units, cosines, following, leads)
            nodes = _pieces(
                true, n, total, room, anchor, h, promise * promise, word, sums, turns, scratch, decoded,
                codes[at : first + n],
            )  # fmt: skip
            if nodes == 0 < n - 1 or excess(units, 0, n, decoded, following, leads) > 1.0:
                continue
            ok[slot], kind[slot], shape[slot], step[slot], cap[slot] = 1, WIDE, word, SPLINE + 8 * nodes, HALVINGS
            radius[slot], end_words[slot] = capsule(decoded, 0, n, end[slot], following, end_scale)
