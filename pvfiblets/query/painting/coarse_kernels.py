"""Compiled kernels: what a stroke does to fiblets, as far as their coarse form tells it; see :mod:`.fiblet_index`.

A part of a fiblet runs within a radius of its chord. Where no voxel so near to the chord changed, nothing changed for
it. And as the part leads from about one end of the chord to about the other, it crosses each disc of that radius across
the chord: where all voxels that hold a disc are in the region, the fiblet passes it, wherever in the disc that may be.
"""

from __future__ import annotations

import math
from typing import Any

import numba
import numpy as np

from ...codec.jit import kernel, parallel_kernel
from .index_kernels import LEAF
from .walk_kernels import ANY, CHANGED, HERE

__all__ = ["ADDED", "ALL_FLAGS", "GONE", "OPEN", "REMOVED", "SAME", "SURE", "settle"]

ADDED, REMOVED, ALL_FLAGS = 0, 1, 2
"""What is asked: of voxels that came in, or that went, whether it is passed; of any, all flags."""
SAME, SURE, GONE, OPEN = 0, 1, 2, 3
"""Nothing changes for a fiblet; it passes now; it does no more; it must be decoded."""
STEP = 0.7  # voxels between discs, at most
WIDEST = 2.0  # voxels: a larger radius settles nothing


@kernel
def _kept(code: int) -> float:
    return float(code - 256 if code > 127 else code)


@kernel
def _cut(u: Any, k: int, reach: Any, box: Any) -> Any:
    """From which to which share of part ``k`` it may be in a box of voxels; (1, 0) if nowhere."""
    enter, leave = 0.0, 1.0
    for axis in range(3):
        a, d = u[k, axis], u[k + 1, axis] - u[k, axis]
        low, high = box[axis] - reach[axis] - a, box[3 + axis] + reach[axis] - a
        if low > max(d, 0.0) or high < min(d, 0.0):
            return 1.0, 0.0
        if d > 0.0:
            enter, leave = max(enter, low / d), min(leave, high / d)
        elif d < 0.0:
            enter, leave = max(enter, high / d), min(leave, low / d)
    return enter, leave


@kernel
def _bits(mask: Any, shape: Any, low: Any, high: Any, bit: int, every: bool) -> bool:
    """Whether some voxel, or every one, that holds positions of a box has a bit of the mask."""
    x0, y0, z0 = int(math.floor(low[0])), int(math.floor(low[1])), int(math.floor(low[2]))
    x1, y1, z1 = int(math.floor(high[0])), int(math.floor(high[1])), int(math.floor(high[2]))
    if every:
        if x0 < 0 or y0 < 0 or z0 < 0 or x1 >= shape[0] or y1 >= shape[1] or z1 >= shape[2]:
            return False
    else:
        x0, y0, z0 = max(x0, 0), max(y0, 0), max(z0, 0)
        x1, y1, z1 = min(x1, shape[0] - 1), min(y1, shape[1] - 1), min(z1, shape[2] - 1)
    for x in range(x0, x1 + 1):
        for y in range(y0, y1 + 1):
            row = (x * shape[1] + y) * shape[2]
            for z in range(z0, z1 + 1):
                if (mask[row + z] & bit != 0) != every:
                    return not every
    return every


@kernel
def _part(u: Any, k: int, reach: Any, share: float, box: Any, mask: Any, shape: Any, touching: int, inside: int,
          low: Any, high: Any) -> Any:  # fmt: skip
    """Whether part ``k`` may meet voxels of the bit ``touching``, and surely meets those of the bit ``inside``.

    `share` of the part at either end may have no point of the fiblet across from it. ``inside`` 0: not asked.
    """
    enter, leave = _cut(u, k, reach, box)
    if enter > leave:
        return False, False
    if not (reach[0] <= WIDEST and reach[1] <= WIDEST and reach[2] <= WIDEST):
        return True, False
    longest = 0.0
    for axis in range(3):
        longest = max(longest, abs(u[k + 1, axis] - u[k, axis]))
    pieces = max(int(math.ceil((leave - enter) * longest / STEP)), 1)
    touches = False
    for i in range(pieces):
        s = enter + (leave - enter) * i / pieces
        t = enter + (leave - enter) * (i + 1) / pieces
        if not touches:
            for axis in range(3):
                a, d = u[k, axis], u[k + 1, axis] - u[k, axis]
                low[axis], high[axis] = min(a + s * d, a + t * d) - reach[axis], max(a + s * d, a + t * d) + reach[axis]
            touches = _bits(mask, shape, low, high, touching, False)
            if touches and not inside:
                return True, False
        middle = 0.5 * (s + t)
        if inside and share <= middle <= 1.0 - share:
            for axis in range(3):
                at = u[k, axis] + middle * (u[k + 1, axis] - u[k, axis])
                low[axis], high[axis] = at - reach[axis], at + reach[axis]
            if _bits(mask, shape, low, high, inside, True):
                return True, True
    return touches, False


@kernel
def _fiblet(u: Any, parts: int, reach: Any, shares: Any, box: Any, mask: Any, shape: Any, touching: int, inside: int,
            low: Any, high: Any) -> Any:  # fmt: skip
    """The same of a whole fiblet."""
    touches = False
    for k in range(parts):
        one, sure = _part(u, k, reach, shares[k], box, mask, shape, touching, inside, low, high)
        if sure:
            return True, True
        touches = touches or one
        if touches and not inside:
            break
    return touches, False


@kernel
def _share(leaves: Any, leaf: int, p: Any, unit: float, k: int, mm: float) -> float:
    """Radius as a share of the chord of part ``k``."""
    square = 0.0
    for axis in range(3):
        a = float(leaves[leaf, 3 * k + axis]) + unit * _kept(p[3 * k + axis])
        b = float(leaves[leaf, 3 * k + 3 + axis]) + unit * _kept(p[3 * k + 3 + axis])
        square += (b - a) ** 2
    return mm / math.sqrt(square) * (1.0 + 1e-9) if square > 0.0 else np.inf


@parallel_kernel
def settle(near: Any, leaves: Any, pieces: Any, parts: int, per_stretch: int, stretch: int, states: Any, asked: int,
           linear: Any, corner: Any, rows: Any, mask: Any, shape: Any, changed: Any, whole: Any,
           found: Any) -> None:  # fmt: skip
    """What becomes of the fiblets of some leaves, ``found (n, LEAF)`` uint8: :data:`SAME` and so on.

    Parameters
    ----------
    near : (n,) int64
        Leaves.
    leaves, pieces
        Of the index, of fiblets in so many `parts`.
    per_stretch, stretch : int
        Leaves, and fiblets, that were sorted together.
    states : (n_fiblets,) uint8
        Flags before.
    asked : int
        :data:`ADDED`, :data:`REMOVED` or :data:`ALL_FLAGS`.
    linear, corner, rows
        From mm to voxels, and the lengths of rows of `linear`.
    mask : (n_voxels,) uint8
        :data:`HERE` and :data:`CHANGED`.
    changed, whole : (6,) float64
        Boxes of the changed voxels, and of the region's.
    """
    nodes = parts + 1
    for j in numba.prange(len(near)):
        leaf = near[j]
        at = leaf // per_stretch * stretch + leaf % per_stretch * LEAF
        many = min(LEAF, min((leaf // per_stretch + 1) * stretch, len(states)) - at)
        mean, u = np.empty((nodes, 3)), np.empty((nodes, 3))
        reach, shares, low, high = np.empty(3), np.empty(parts), np.empty(3), np.empty(3)
        largest = 0.0
        for k in range(nodes):
            x = float(leaves[leaf, 3 * k]) - corner[0]
            y = float(leaves[leaf, 3 * k + 1]) - corner[1]
            z = float(leaves[leaf, 3 * k + 2]) - corner[2]
            for axis in range(3):
                mean[k, axis] = linear[axis, 0] * x + linear[axis, 1] * y + linear[axis, 2] * z
                largest = max(largest, abs(mean[k, axis]))
        unit, radius = float(leaves[leaf, 3 * nodes + parts]), float(leaves[leaf, 3 * nodes + parts + 1])
        close = False  # a part of the leaf, at least
        for k in range(parts):
            for axis in range(3):
                reach[axis] = float(leaves[leaf, 3 * nodes + k]) * rows[axis] * (1.0 + 1e-9) + 1e-9 * (1.0 + largest)
            enter, leave = _cut(mean, k, reach, changed)
            close = close or not enter > leave
        for i in range(LEAF):
            found[j, i] = SAME
            if i >= many or not close:
                continue
            passed = states[at + i] & ANY != 0
            if (asked == ADDED and passed) or (asked == REMOVED and not passed):
                continue
            p = pieces[at + i]
            for k in range(nodes):
                x, y, z = unit * _kept(p[3 * k]), unit * _kept(p[3 * k + 1]), unit * _kept(p[3 * k + 2])
                for axis in range(3):
                    u[k, axis] = mean[k, axis] + (linear[axis, 0] * x + linear[axis, 1] * y + linear[axis, 2] * z)
            mm = radius * p[3 * nodes]
            for axis in range(3):
                reach[axis] = mm * rows[axis] * (1.0 + 1e-9) + 1e-9 * (1.0 + largest)
            for k in range(parts):
                shares[k] = _share(leaves, leaf, p, unit, k, mm)
            if asked == ADDED:
                touches, sure = _fiblet(u, parts, reach, shares, changed, mask, shape, CHANGED, HERE, low, high)
                found[j, i] = SURE if sure else OPEN if touches else SAME
                continue
            touches, _ = _fiblet(u, parts, reach, shares, changed, mask, shape, CHANGED, 0, low, high)
            if touches and asked == REMOVED:
                touches, sure = _fiblet(u, parts, reach, shares, whole, mask, shape, HERE, HERE, low, high)
                found[j, i] = SAME if sure else OPEN if touches else GONE
            elif touches:
                found[j, i] = OPEN
