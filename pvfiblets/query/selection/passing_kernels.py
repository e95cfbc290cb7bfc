"""Compiled kernels: balls about fiblets, and what the points of a fiblet say of its streamline; see :mod:`.passing`."""

from __future__ import annotations

import math

import numba
import numpy as np

from ...codec.jit import kernel, parallel_kernel
from ...codec.kernels.capsule_kernels import anchor_part, end_part
from ...support.array_types import Bools, Float32s, Float64s, Int8s, Int32s, Int64s, UInt8s, UInt16s, UInt32s
from ..regions.classify import classify_ball
from .point_flags import ALL, ANY, FIRST, LAST

RUN = 8  # consecutive segments that are settled together


@parallel_kernel
def balls(anchors: UInt32s, low: UInt16s, fine: bool, ends: UInt32s, reach: UInt16s, origin: Float64s, scale: Float64s,
          units: tuple[float, float, float], out: Float64s, radii: Float64s) -> None:  # fmt: skip
    """Balls about the capsules of consecutive fiblets, and what joins each to the next (:mod:`..capsules`)."""
    reach_scale, end_scale, slack = units
    for f in numba.prange(len(reach)):
        last = anchors[f, 1] >> 31
        chord = 0.0
        for axis in range(3):
            q = anchor_part(anchors, low, fine, f, axis)
            a = scale[axis] * q
            if last:
                b = a + end_scale * end_part(np.int64(ends[f]), axis)
            else:
                b = scale[axis] * anchor_part(anchors, low, fine, f + 1, axis)
            out[f, axis] = 0.5 * (a + b) + origin[axis]
            chord += (b - a) * (b - a)
        radii[f] = 0.5 * math.sqrt(chord) + reach_scale * reach[f] + slack


@kernel
def _flags_of_fiblet(state: int, begin: int, end: int, flags: int) -> int:
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
def settle(
    states: Int8s, anchors: UInt32s, ranks: Int64s, wanted: Bools, bits: int, flags: UInt8s, open_: Bools
) -> None:
    """Take in the fiblets that lie surely in or out, and mark the others where they can still tell something."""
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
                    found = _flags_of_fiblet(states[i], anchors[i, 1] >> 30 & 1, anchors[i, 1] >> 31, found)
                i += 1
            known = wanted[rank]
            if known:
                flags[rank] = found
            undecided = (bits & ANY and not found & ANY) or (bits & ALL and found & ALL)
            for f in range(first, i):
                ends = (bits & FIRST and anchors[f, 1] >> 30 & 1) or (bits & LAST and anchors[f, 1] >> 31)
                open_[f] = known and states[f] == 0 and (undecided or ends)


@parallel_kernel
def reduce_fiblets(inside: Bools, starts: Int64s, found: UInt8s) -> None:
    """Flags of each fiblet by itself, from its points' flags."""
    # `inside` is `(n_points,)` bool, `starts` `(n + 1,)` int64, `found` `(n,)` uint8, filled.
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
def merge(found: UInt8s, which: Int64s, anchors: UInt32s, ranks: Int64s, flags: UInt8s) -> None:
    """Take in fiblets whose points were looked at."""
    # `found` is `(m,)` uint8 of `reduce_fiblets`, `which` `(m,)` their rows in `anchors` and `ranks`; the rest is as in
    # `settle`.
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


@kernel
def _ball_side(points: Float64s, first: int, last: int, packed: tuple[Int32s, Float64s, Float64s, Float32s]) -> int:
    """Side of the ball that holds points ``first`` to ``last``, about the middle of their chord."""
    x = 0.5 * points[first, 0] + 0.5 * points[last, 0]
    y = 0.5 * points[first, 1] + 0.5 * points[last, 1]
    z = 0.5 * points[first, 2] + 0.5 * points[last, 2]
    widest = 0.0
    for i in range(first, last + 1):
        dx, dy, dz = points[i, 0] - x, points[i, 1] - y, points[i, 2] - z
        widest = max(widest, dx * dx + dy * dy + dz * dz)
    ops, rows, grids, values = packed
    return classify_ball(ops, rows, grids, values, x, y, z, math.sqrt(widest) * (1.0 + 2.0**-40))


@parallel_kernel
def run_sides(
    points: Float64s, starts: Int64s, packed: tuple[Int32s, Float64s, Float64s, Float32s], sides: Int8s
) -> None:
    """Sides of runs of :data:`RUN` segments of fiblets, each by a ball about it: ``sides`` (n_points,) int8."""
    # Fiblet f has the points `starts[f]` to `starts[f + 1]`. The side of a run is given to the first points of its
    # segments, that of a fiblet's last run to its last point too. `packed` is the region (`classify.Packed`).
    for f in numba.prange(len(starts) - 1):
        last = starts[f + 1] - 1
        for first in range(starts[f], last + 1, RUN):
            end = min(first + RUN, last)
            if first < last or first == starts[f]:
                side = _ball_side(points, first, end, packed)
                for i in range(first, end + 1):
                    sides[i] = side


@parallel_kernel
def open_segments(points: Float64s, starts: Int64s, sides: Int8s, asked: Bools,
                  packed: tuple[Int32s, Float64s, Float64s, Float32s], open_: Bools) -> None:  # fmt: skip
    """Mark the segments of fiblets ``asked`` (n,) bool that balls leave undecided: ``open_`` (n_points,) bool."""
    # The other arguments are as in `run_sides`.
    for f in numba.prange(len(asked)):
        last = starts[f + 1] - 1
        open_[last] = False
        for i in range(starts[f], last):
            open_[i] = asked[f] and sides[i] == 0 and _ball_side(points, i, i + 1, packed) == 0


@kernel
def _alike(mask: Bools, ax: float, ay: float, az: float, bx: float, by: float, bz: float) -> bool:
    """Whether all voxels of the box between two of them are chosen, or none is; outside of the grid none is."""
    ni, nj, nk = mask.shape
    count = total = 0
    for i in range(int(min(ax, bx)), int(max(ax, bx)) + 1):
        for j in range(int(min(ay, by)), int(max(ay, by)) + 1):
            for k in range(int(min(az, bz)), int(max(az, bz)) + 1):
                total += 1
                if 0 <= i < ni and 0 <= j < nj and 0 <= k < nk and mask[i, j, k]:
                    count += 1
    return count == 0 or count == total


@parallel_kernel
def label_points(
    points: Float64s, starts: Int64s, mask: Bools, linear: Float64s, centre: Float64s, inside: Bools, open_: Bools
) -> None:
    """Flag fiblets' points in chosen voxels, and mark the segments to test: both (n_points,) bool."""
    # The voxels of `mask` (i, j, k) are the nearest to `linear (points - centre)`. A segment needs no test if it
    # crosses one face of voxels at most, and so lies in the voxels of its ends, or if all voxels about it are alike.
    ni, nj, nk = mask.shape
    # Read once: the compiler cannot exclude that the written arrays are these.
    cx, cy, cz = centre[0], centre[1], centre[2]
    a0, a1, a2 = linear[0, 0], linear[0, 1], linear[0, 2]
    b0, b1, b2 = linear[1, 0], linear[1, 1], linear[1, 2]
    c0, c1, c2 = linear[2, 0], linear[2, 1], linear[2, 2]
    for f in numba.prange(len(starts) - 1):
        first, last = starts[f], starts[f + 1] - 1
        bx = by = bz = 0.0
        for i in range(first, last + 1):
            ax, ay, az = bx, by, bz
            x, y, z = points[i, 0] - cx, points[i, 1] - cy, points[i, 2] - cz
            bx = np.floor(a0 * x + a1 * y + a2 * z + 0.5)
            by = np.floor(b0 * x + b1 * y + b2 * z + 0.5)
            bz = np.floor(c0 * x + c1 * y + c2 * z + 0.5)
            within = 0.0 <= bx < ni and 0.0 <= by < nj and 0.0 <= bz < nk  # false for NaN
            inside[i] = mask[int(bx), int(by), int(bz)] if within else False
            if i > first:
                steps = abs(bx - ax) + abs(by - ay) + abs(bz - az)
                open_[i - 1] = not (steps <= 1.0 or (steps <= 3.0 and _alike(mask, ax, ay, az, bx, by, bz)))
        open_[last] = False


@kernel
def merge_segments(found: UInt8s, rows: Int64s, ranks: Int64s, flags: UInt8s) -> None:
    """Take in segments of fiblets ``rows``: ``found`` (m,) is 1 where some of it is in, plus 2 where some is not."""
    for m in range(len(found)):
        rank = ranks[rows[m]]
        if found[m] & 1:
            flags[rank] |= ANY
        if found[m] & 2:
            flags[rank] &= ~ALL
