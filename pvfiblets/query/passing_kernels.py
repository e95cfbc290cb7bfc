"""Compiled kernels: balls about fiblets, and what the points of a fiblet say of its streamline; see :mod:`.passing`."""

from __future__ import annotations

import math
from typing import Any

import numba
import numpy as np

from ..codec.capsule_kernels import end_part
from ..codec.jit import kernel, parallel_kernel
from .point_flags import ALL, ANY, FIRST, LAST

__all__ = ["balls", "count_samples", "fill_samples", "merge", "reduce_fiblets", "run_balls", "settle"]


@parallel_kernel
def balls(
    anchors: Any, low: Any, fine: Any, ends: Any, reach: Any, origin: Any, scale: Any, units: Any, out: Any, radii: Any
) -> None:
    """Balls about the capsules of consecutive fiblets, and what joins each to the next (:mod:`..capsules`).

    Parameters
    ----------
    anchors : (n or n + 1, 2) uint32
        Of the fiblets, and of the one after them if the last does not end its streamline.
    low : (n or n + 1, 3) uint16
        Lower halves of 32-bit anchors; read if ``fine``.
    ends : (n,) uint32
        End vector of each fiblet's streamline; read where the fiblet ends it.
    reach : (n,) uint16
    origin, scale : (3,) float64
        Anchor grid, mm.
    units : (float, float, float)
        ``reach_scale``, ``end_scale``, and what is added to radii for rounding, mm.
    out, radii : (n, 3), (n,) float64
        Filled: centres and radii, mm.
    """
    reach_scale, end_scale, slack = units
    for f in numba.prange(len(reach)):
        last = anchors[f, 1] >> 31
        chord = 0.0
        for axis in range(3):
            q = _coordinate(anchors, low, fine, f, axis)
            a = scale[axis] * q
            if last:
                b = a + end_scale * end_part(np.int64(ends[f]), axis)
            else:
                b = scale[axis] * _coordinate(anchors, low, fine, f + 1, axis)
            out[f, axis] = 0.5 * (a + b) + origin[axis]
            chord += (b - a) * (b - a)
        radii[f] = 0.5 * math.sqrt(chord) + reach_scale * reach[f] + slack


@kernel
def _coordinate(anchors: Any, low: Any, fine: Any, f: int, axis: int) -> float:
    word = anchors[f, axis // 2]
    q = float((word >> 16) & 0xFFFF) if axis == 1 else float(word & 0xFFFF)
    return q * 65536.0 + float(low[f, axis]) if fine else q


@kernel
def _told(state: int, begin: int, end: int, flags: int) -> int:
    """Flags of a streamline once it is known that all points of one fiblet are in (1) or out (-1)."""
    if state < 0:
        return flags & ~ALL
    flags |= ANY
    if begin:
        flags |= FIRST
    if end:
        flags |= LAST
    return flags


@parallel_kernel
def settle(states: Any, anchors: Any, ranks: Any, wanted: Any, bits: int, flags: Any, open_: Any) -> None:
    """Take in the fiblets that lie surely in or out, and mark the others where they can still tell something.

    Parameters
    ----------
    states : (n,) int8
        1 in, -1 out, 0 undecided.
    anchors : (n, 2) uint32
    ranks : (n,) int64
        Streamline of each fiblet, counted from the first of ``flags``; consecutive.
    wanted : (n_ranks,) bool
        Streamlines that are asked about; others are left as they are.
    bits : int
        Flags that are asked for.
    flags : (n_ranks,) uint8
        Changed in place.
    open_ : (n,) bool
        Filled.
    """
    n = len(states)
    parts = 64
    for part in numba.prange(parts):
        # Whole streamlines, so that no two threads write one's flags.
        i, stop = n * part // parts, n * (part + 1) // parts
        while 0 < i < n and ranks[i] == ranks[i - 1]:
            i += 1
        while 0 < stop < n and ranks[stop] == ranks[stop - 1]:
            stop += 1
        while i < stop:
            rank, first = ranks[i], i
            found = np.int64(flags[rank])
            while i < stop and ranks[i] == rank:
                if states[i] != 0:
                    found = _told(states[i], anchors[i, 1] >> 30 & 1, anchors[i, 1] >> 31, found)
                i += 1
            known = wanted[rank]
            if known:
                flags[rank] = found
            undecided = (bits & ANY and not found & ANY) or (bits & ALL and found & ALL)
            for f in range(first, i):
                ends = (bits & FIRST and anchors[f, 1] >> 30 & 1) or (bits & LAST and anchors[f, 1] >> 31)
                open_[f] = known and states[f] == 0 and (undecided or ends)


@parallel_kernel
def reduce_fiblets(inside: Any, starts: Any, found: Any) -> None:
    """Flags of each fiblet by itself, from those of its points.

    ``inside`` is ``(n_points,)`` bool, ``starts`` ``(n + 1,)`` int64, ``found`` ``(n,)`` uint8, filled.
    """
    for f in numba.prange(len(found)):
        some, every = False, True
        for i in range(starts[f], starts[f + 1]):
            some |= inside[i]
            every &= inside[i]
        flags = 0
        if some:
            flags |= ANY
        if every:
            flags |= ALL
        if inside[starts[f]]:
            flags |= FIRST
        if inside[starts[f + 1] - 1]:
            flags |= LAST
        found[f] = flags


@kernel
def merge(found: Any, which: Any, anchors: Any, ranks: Any, flags: Any) -> None:
    """Take in fiblets whose points were looked at.

    ``found`` is ``(m,)`` uint8 of :func:`reduce_fiblets`, ``which`` ``(m,)`` their rows in ``anchors`` and ``ranks``;
    the rest is as in :func:`settle`.
    """
    for m in range(len(found)):
        f = which[m]
        kept = ANY
        if anchors[f, 1] >> 30 & 1:
            kept |= FIRST
        if anchors[f, 1] >> 31:
            kept |= LAST
        together = np.int64(flags[ranks[f]]) | (np.int64(found[m]) & kept)
        if not found[m] & ALL:
            together &= ~ALL
        flags[ranks[f]] = together


@parallel_kernel
def run_balls(points: Any, run: int, centres: Any, radii: Any) -> None:
    """Balls about runs of consecutive points, ``(n_points, 3)`` float64; the last run may be shorter.

    ``centres`` ``(n, 3)`` and ``radii`` ``(n,)`` float64 are filled, mm.
    """
    for k in numba.prange(len(radii)):
        first, last = run * k, min(run * (k + 1), len(points))
        for axis in range(3):
            low = high = points[first, axis]
            for i in range(first + 1, last):
                low, high = min(low, points[i, axis]), max(high, points[i, axis])
            centres[k, axis] = 0.5 * low + 0.5 * high
        widest = 0.0
        for i in range(first, last):
            squares = 0.0
            for axis in range(3):
                squares += (points[i, axis] - centres[k, axis]) ** 2
            widest = max(widest, squares)
        radii[k] = math.sqrt(widest) * (1.0 + 2.0**-40)


@parallel_kernel
def count_samples(points: Any, starts: Any, joints: Any, joined: Any, sampling: float, counts: Any) -> None:
    """Positions that each fiblet is looked at: its points, and those between them and up to the next fiblet.

    Parameters
    ----------
    points : (n_points, 3) float64
    starts : (n + 1,) int64
    joints : (n, 3) float64
        First point of the next fiblet, read where ``joined`` ``(n,)`` bool.
    sampling : float
        No two positions on a segment are farther apart, mm.
    counts : (n,) float64
        Filled; a float, because a step of 10^6 mm and a sampling of 10^-6 mm are no whole number of 32 bits.
    """
    for f in numba.prange(len(counts)):
        total = 0.0
        for i in range(starts[f], starts[f + 1]):
            total += _pieces(points, i, starts[f + 1], joints, joined, f, sampling)
        counts[f] = total


@kernel
def _pieces(points: Any, i: int, stop: int, joints: Any, joined: Any, f: int, sampling: float) -> float:
    """Pieces that the segment from point ``i`` is cut into, 1 where there is none: positions at its beginning."""
    squares = 0.0
    for axis in range(3):
        if i + 1 < stop:
            apart = points[i + 1, axis] - points[i, axis]
        elif joined[f]:
            apart = joints[f, axis] - points[i, axis]
        else:
            apart = 0.0
        squares += apart * apart
    return max(1.0, math.ceil(math.sqrt(squares) / sampling))


@parallel_kernel
def fill_samples(points: Any, starts: Any, joints: Any, joined: Any, sampling: float, at: Any, out: Any) -> None:
    """Write the positions that :func:`count_samples` counted.

    ``at`` ``(n + 1,)`` int64: where each fiblet's go in ``out`` ``(at[n], 3)`` float64. The last position of a fiblet
    that ends its streamline is its last point.
    """
    for f in numba.prange(len(joined)):
        k = at[f]
        for i in range(starts[f], starts[f + 1]):
            pieces = int(_pieces(points, i, starts[f + 1], joints, joined, f, sampling))
            for piece in range(pieces):
                for axis in range(3):
                    p = points[i, axis]
                    if piece:
                        q = points[i + 1, axis] if i + 1 < starts[f + 1] else joints[f, axis]
                        p += (q - p) * (piece / pieces)
                    out[k, axis] = p
                k += 1
