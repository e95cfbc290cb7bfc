"""Compiled kernels: what a stroke does to fiblets, as far as their coarse form tells it; see :mod:`.fiblet_index`.

A part of a fiblet runs within a radius of its chord. Where no voxel so near to the chord changed, nothing changed for
it. And as the part leads from about one end of the chord to about the other, it crosses each disc of that radius across
the chord: where all voxels that hold a disc are in the region, the fiblet passes it, wherever in the disc that may be.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numba
import numpy as np

from ...codec.jit import kernel, parallel_kernel
from ...support.array_types import Float32s, Float64s, Int64s, UInt8s
from .index_kernels import LEAF
from .walk_kernels import ANY, CHANGED, HERE

if TYPE_CHECKING:
    from .free_space import FreeSpace

ADDED, REMOVED, ALL_FLAGS = 0, 1, 2  # query: of added or removed voxels, whether they are passed; otherwise all flags
SAME, SURE, GONE, OPEN = 0, 1, 2, 3  # nothing changes for a fiblet; it passes now; it does no more; it must be decoded
BLOCK, FEW = 256, 16
STEP = 0.7  # voxels between discs, at most
WIDEST = 2.0  # voxels: a larger radius settles nothing


@kernel
def _signed_byte(code: int) -> float:
    return float(code - 256 if code > 127 else code)


@kernel
def _cut(u: Float64s, k: int, reach: Float64s, box: Float64s) -> tuple[float, float]:
    """Return the shares of part ``k`` between which it may be in a box of voxels; (1, 0) if nowhere."""
    for axis in range(3):
        a, b = u[k, axis], u[k + 1, axis]
        low, high = box[axis] - reach[axis], box[3 + axis] + reach[axis]
        if (a < low and b < low) or (a > high and b > high):
            return 1.0, 0.0
    enter, leave = 0.0, 1.0
    for axis in range(3):
        a, d = u[k, axis], u[k + 1, axis] - u[k, axis]
        low, high = box[axis] - reach[axis] - a, box[3 + axis] + reach[axis] - a
        if d > 0.0:
            enter, leave = max(enter, low / d), min(leave, high / d)
        elif d < 0.0:
            enter, leave = max(enter, high / d), min(leave, low / d)
    return enter, leave


@kernel
def _bits(mask: UInt8s, shape: tuple[int, int, int], low: Float64s, high: Float64s, bit: int, every: bool) -> bool:
    """Whether some voxel, or every one, that holds positions of a box has a bit of the mask."""
    x0, y0, z0 = math.floor(low[0]), math.floor(low[1]), math.floor(low[2])
    x1, y1, z1 = math.floor(high[0]), math.floor(high[1]), math.floor(high[2])
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
def _free(steps: UInt8s, first: Int64s, u: Float64s, k: int, t: float) -> int:
    """Voxels from the one at ``t`` of part ``k`` to the nearest of a set, at least."""
    x = min(max(math.floor(u[k, 0] + t * (u[k + 1, 0] - u[k, 0])) - first[0], 0), steps.shape[0] - 1)
    y = min(max(math.floor(u[k, 1] + t * (u[k + 1, 1] - u[k, 1])) - first[1], 0), steps.shape[1] - 1)
    z = min(max(math.floor(u[k, 2] + t * (u[k + 1, 2] - u[k, 2])) - first[2], 0), steps.shape[2] - 1)
    return steps[x, y, z]


@kernel
def _deep(steps: UInt8s, first: Int64s, at: Float64s, k: int, radius: float, rows: Float64s, slack: float) -> bool:
    """Whether all within a radius, mm, of position ``k`` is farther than 0 from a set, which all beyond a box is in."""
    x, y, z = math.floor(at[k, 0]) - first[0], math.floor(at[k, 1]) - first[1], math.floor(at[k, 2]) - first[2]
    if x < 0 or y < 0 or z < 0 or x >= steps.shape[0] or y >= steps.shape[1] or z >= steps.shape[2]:
        return False
    return steps[x, y, z] - 1 >= radius * max(rows[0], rows[1], rows[2]) * (1.0 + 1e-9) + slack


@kernel
def _longest(u: Float64s, k: int) -> float:
    return max(abs(u[k + 1, 0] - u[k, 0]), abs(u[k + 1, 1] - u[k, 1]), abs(u[k + 1, 2] - u[k, 2]))


@kernel
def _holds(u: Float64s, k: int, t: float, reach: Float64s, mask: UInt8s, shape: tuple[int, int, int], inside: int,
           low: Float64s, high: Float64s) -> bool:  # fmt: skip
    """Whether every voxel that holds positions of the disc across part ``k`` at ``t`` has a bit."""
    for axis in range(3):
        at = u[k, axis] + t * (u[k + 1, axis] - u[k, axis])
        low[axis], high[axis] = at - reach[axis], at + reach[axis]
    x, y, z = (math.floor(0.5 * (low[0] + high[0])), math.floor(0.5 * (low[1] + high[1])),
               math.floor(0.5 * (low[2] + high[2])))  # fmt: skip
    if x < 0 or y < 0 or z < 0 or x >= shape[0] or y >= shape[1] or z >= shape[2]:
        return False
    if mask[(x * shape[1] + y) * shape[2] + z] & inside == 0:  # most often, where it is not
        return False
    return _bits(mask, shape, low, high, inside, True)


@kernel
def _along(u: Float64s, k: int, enter: float, leave: float, reach: Float64s, kept: Float64s, radius: float,
           mask: UInt8s, shape: tuple[int, int, int], touching: int, inside: int, steps: UInt8s, first: Int64s,
           low: Float64s, high: Float64s) -> tuple[bool, bool]:  # fmt: skip
    widest = max(reach[0], reach[1], reach[2])
    if not widest <= WIDEST:
        return True, False
    longest, square = _longest(u, k), 0.0
    if 0.5 * longest * (leave - enter) <= _free(steps, first, u, k, 0.5 * (enter + leave)) - 1 - widest:
        return False, False  # no voxel is near to any of it, as below
    for axis in range(3):
        square += (kept[k + 1, axis] - kept[k, axis]) ** 2
    # So much of the part, at either end, may have no point of the fiblet across from it.
    share = radius / math.sqrt(square) * (1.0 + 1e-6) if square > 0.0 else np.inf
    if inside:  # where it is deepest in a region, most often
        for quarter in (2, 1, 3):
            at = enter + 0.25 * quarter * (leave - enter)
            if share <= at <= 1.0 - share and _holds(u, k, at, reach, mask, shape, inside, low, high):
                return True, True
    touches, s = False, enter
    while True:
        # Skip ahead as far as no voxel is near. Positions so many voxels apart, rounded up, lie in
        # voxels no farther from each other than that.
        ahead = _free(steps, first, u, k, s) - 1 - widest
        if ahead >= 0.5 * STEP:
            if longest * (leave - s) <= ahead:
                return touches, False
            s += ahead / longest
            continue
        t = leave if longest * (leave - s) <= STEP else s + STEP / longest
        if not touches:
            for axis in range(3):
                a, d = u[k, axis], u[k + 1, axis] - u[k, axis]
                low[axis], high[axis] = min(a + s * d, a + t * d) - reach[axis], max(a + s * d, a + t * d) + reach[axis]
            touches = _bits(mask, shape, low, high, touching, False)
            if touches and not inside:
                return True, False
        middle = 0.5 * (s + t)
        across = inside and share <= middle <= 1.0 - share
        if across and _holds(u, k, middle, reach, mask, shape, inside, low, high):
            return True, True
        if t >= leave:
            return touches, False
        s = t


@kernel
def _part(u: Float64s, k: int, kept: Float64s, radius: float, rows: Float64s, slack: float, box: Float64s, mask: UInt8s,
          shape: tuple[int, int, int], touching: int, inside: int, steps: UInt8s, first: Int64s, reach: Float64s,
          low: Float64s, high: Float64s) -> tuple[bool, bool]:  # fmt: skip
    """Whether part ``k`` may meet voxels of the bit ``touching``, and surely meets voxels of the bit ``inside``."""
    # `inside` 0: not asked.
    for axis in range(3):
        reach[axis] = radius * rows[axis] * (1.0 + 1e-9) + slack
    enter, leave = _cut(u, k, reach, box)
    if enter > leave:
        return False, False
    return _along(u, k, enter, leave, reach, kept, radius, mask, shape, touching, inside, steps, first, low, high)


@kernel
def _fiblet(u: Float64s, parts: int, only: int, kept: Float64s, pieces: UInt8s, row: int, unit: float, rows: Float64s,
            slack: float, box: Float64s, mask: UInt8s, shape: tuple[int, int, int], touching: int, inside: int,
            steps: UInt8s, first: Int64s, reach: Float64s, low: Float64s,
            high: Float64s) -> tuple[bool, bool]:  # fmt: skip
    """The same of a whole fiblet, or of its parts whose bits are in `only`."""
    touches = False
    for k in range(parts):
        if not only >> k & 1:
            continue
        radius = unit * pieces[row, 3 * parts + 3 + k]
        one, sure = _part(u, k, kept, radius, rows, slack, box, mask, shape, touching, inside, steps, first, reach, low,
                          high)  # fmt: skip
        if sure:
            return True, True
        touches = touches or one
        if touches and not inside:
            break
    return touches, False


@kernel
def _place(k: int, pieces: UInt8s, row: int, leaves: Float32s, leaf: int, unit: float, linear: Float64s, mean: Float64s,
           kept: Float64s, u: Float64s) -> None:  # fmt: skip
    """Position ``k`` of a fiblet in mm and in voxels."""
    x = unit * _signed_byte(pieces[row, 3 * k])
    y = unit * _signed_byte(pieces[row, 3 * k + 1])
    z = unit * _signed_byte(pieces[row, 3 * k + 2])
    kept[k, 0], kept[k, 1] = leaves[leaf, 3 * k] + x, leaves[leaf, 3 * k + 1] + y
    kept[k, 2] = leaves[leaf, 3 * k + 2] + z
    for axis in range(3):
        u[k, axis] = mean[k, axis] + (linear[axis, 0] * x + linear[axis, 1] * y + linear[axis, 2] * z)


@kernel
def _apart(
    pieces: UInt8s, row: int, k: int, parts: int, centre: Float64s, box: Float64s, unit: float, radius: float
) -> bool:
    """Whether part ``k`` of a fiblet lies beyond one face of a box along the axes of mm: told without its voxels."""
    reach = radius * pieces[row, 3 * parts + 3 + k] * (1.0 + 1e-9)
    for axis in range(3):
        a = centre[k, axis] + unit * _signed_byte(pieces[row, 3 * k + axis])
        b = centre[k + 1, axis] + unit * _signed_byte(pieces[row, 3 * k + 3 + axis])
        low, high = box[0, axis] - reach, box[1, axis] + reach
        if (a < low and b < low) or (a > high and b > high):
            return True
    return False


@kernel
def _clear(mean: Float64s, k: int, leaves: Float32s, leaf: int, rows: Float64s, slack: float, box: Float64s,
           steps: UInt8s, first: Int64s, reach: Float64s) -> bool:  # fmt: skip
    """Whether the capsule of part ``k`` of a leaf meets no voxel of a set in a box."""
    for axis in range(3):
        reach[axis] = float(leaves[leaf, 3 * len(mean) + k]) * rows[axis] * (1.0 + 1e-9) + slack
    enter, leave = _cut(mean, k, reach, box)
    widest, longest = max(reach[0], reach[1], reach[2]), _longest(mean, k)
    while enter <= leave:
        ahead = _free(steps, first, mean, k, enter) - 1 - widest
        if ahead < STEP:
            return False
        enter = enter + ahead / longest if longest > 0.0 else np.inf
    return True


@parallel_kernel
def close_parts(near: Int64s, leaves: Float32s, parts: int, linear: Float64s, corner: Float64s, rows: Float64s,
                box: Float64s, free: FreeSpace, found: UInt8s) -> None:  # fmt: skip
    """Bits of the parts of some leaves whose capsules come near voxels in a box, ``found (n,)`` uint8."""
    # `free` is the box's `.FreeSpace` about these voxels.
    steps, first = free
    nodes = parts + 1
    for block in numba.prange((len(near) + BLOCK - 1) // BLOCK):
        mean, reach = np.empty((nodes, 3)), np.empty(3)
        for j in range(block * BLOCK, min((block + 1) * BLOCK, len(near))):
            leaf = near[j]
            slack = _mean(leaves, leaf, nodes, linear, corner, mean)
            found[j] = 0
            for k in range(parts):
                if not _clear(mean, k, leaves, leaf, rows, slack, box, steps, first, reach):
                    found[j] |= 1 << k


@kernel
def _mean(leaves: Float32s, leaf: int, nodes: int, linear: Float64s, corner: Float64s, mean: Float64s) -> float:
    """Mean course of a leaf in voxels, and by how much rounding may be wrong."""
    largest = 0.0
    for k in range(nodes):
        x = float(leaves[leaf, 3 * k]) - corner[0]
        y = float(leaves[leaf, 3 * k + 1]) - corner[1]
        z = float(leaves[leaf, 3 * k + 2]) - corner[2]
        for axis in range(3):
            mean[k, axis] = linear[axis, 0] * x + linear[axis, 1] * y + linear[axis, 2] * z
            largest = max(largest, abs(mean[k, axis]))
    return 1e-9 * (1.0 + largest)


@parallel_kernel
def settle(near: Int64s, bits: UInt8s, leaves: Float32s, pieces: UInt8s, parts: int, per_stretch: int, stretch: int,
           states: UInt8s, asked: int, linear: Float64s, corner: Float64s, rows: Float64s, mask: UInt8s,
           shape: tuple[int, int, int], changed: Float64s, whole: Float64s, in_mm: Float64s, about_changed: FreeSpace,
           about_whole: FreeSpace, within: FreeSpace, found: UInt8s) -> None:  # fmt: skip
    """Compute the new state of the fiblets of some leaves, ``found (n, LEAF)`` uint8: :data:`SAME` and so on."""
    changed_steps, changed_first = about_changed
    whole_steps, whole_first = about_whole
    within_steps, within_first = within
    nodes, every = parts + 1, (1 << parts) - 1
    for block in numba.prange((len(near) + FEW - 1) // FEW):
        mean, u, kept = np.empty((nodes, 3)), np.empty((nodes, 3)), np.empty((nodes, 3))
        reach, low, high, centre = np.empty(3), np.empty(3), np.empty(3), np.empty((nodes, 3))
        for j in range(block * FEW, min((block + 1) * FEW, len(near))):
            leaf = near[j]
            at = leaf // per_stretch * stretch + leaf % per_stretch * LEAF
            many = min(LEAF, min((leaf // per_stretch + 1) * stretch, len(states)) - at)
            slack = _mean(leaves, leaf, nodes, linear, corner, mean)
            unit, radius = float(leaves[leaf, 3 * nodes + parts]), float(leaves[leaf, 3 * nodes + parts + 1])
            close = np.int64(bits[j])
            every_one = False  # a point of each fiblet lies so near to each mean position
            none = asked == REMOVED  # where nothing of the region is near, no fiblet passes it any more
            for k in range(parts):
                none = none and _clear(mean, k, leaves, leaf, rows, slack, whole, whole_steps, whole_first, reach)
            for k in range(nodes):
                for axis in range(3):
                    centre[k, axis] = float(leaves[leaf, 3 * k + axis])
                wide = float(leaves[leaf, 3 * nodes + min(k, parts - 1)])
                every_one |= asked == ADDED and _deep(within_steps, within_first, mean, k, wide, rows, slack)
            for i in range(LEAF):
                found[j, i] = SAME
                if i >= many:
                    continue
                passed = states[at + i] & ANY != 0
                if (asked == ADDED and passed) or (asked == REMOVED and not passed):
                    continue
                if every_one or none:
                    found[j, i] = SURE if every_one else GONE
                    continue
                only = np.int64(0)
                for k in range(parts):
                    if close >> k & 1 and not _apart(pieces, at + i, k, parts, centre, in_mm, unit, radius):
                        only |= 1 << k
                if only == 0:
                    continue
                for k in range(nodes):
                    if (only | only << 1) >> k & 1:
                        _place(k, pieces, at + i, leaves, leaf, unit, linear, mean, kept, u)
                if asked == ADDED:
                    for k in range(nodes):
                        if (only | only << 1) >> k & 1 and found[j, i] != SURE:
                            wide = radius * pieces[at + i, 3 * nodes + min(k, parts - 1)]
                            if _deep(within_steps, within_first, u, k, wide, rows, slack):
                                found[j, i] = SURE
                    if found[j, i] == SURE:
                        continue
                inside = HERE if asked == ADDED else 0
                touches, sure = _fiblet(u, parts, only, kept, pieces, at + i, radius, rows, slack, changed, mask, shape,
                                        CHANGED, inside, changed_steps, changed_first, reach, low, high)  # fmt: skip
                if touches and asked == REMOVED:
                    for k in range(nodes):
                        _place(k, pieces, at + i, leaves, leaf, unit, linear, mean, kept, u)
                    touches, sure = _fiblet(u, parts, every, kept, pieces, at + i, radius, rows, slack, whole, mask,
                                            shape, HERE, HERE, whole_steps, whole_first, reach, low,
                                            high)  # fmt: skip
                    found[j, i] = SAME if sure else OPEN if touches else GONE
                elif touches:
                    found[j, i] = SURE if sure else OPEN
