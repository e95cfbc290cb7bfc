"""Compiled kernels: the capsule that holds a fiblet; see `capsules`, in whose arithmetic they are."""

from __future__ import annotations

import math

import numba
import numpy as np

from ...support.array_types import Bools, Float64s, Int64s, UInt16s, UInt32s
from ..capsules import MARGIN, SMALLEST
from ..jit import kernel, parallel_kernel
from ..layout import END_BITS, END_LEVELS

_MASK = (1 << END_BITS) - 1


@kernel
def end_word(x: float, y: float, z: float, scale: float) -> int:
    """End vector of a streamline's last fiblet (mm) as a word of ``ends``."""
    word = 0
    shift = 0
    for value in (x, y, z):
        level = min(max(float(np.rint(value / scale)), -float(END_LEVELS)), float(END_LEVELS))
        word |= (int(level) & _MASK) << shift
        shift += END_BITS
    return word


@kernel
def anchor_part(anchors: UInt32s, low: UInt16s, fine: bool, f: int, axis: int) -> float:
    """One component of an anchor, in units of the grid."""
    word = anchors[f, axis // 2]
    q = float((word >> 16) & 0xFFFF) if axis == 1 else float(word & 0xFFFF)
    return q * 65536.0 + float(low[f, axis]) if fine else q


@kernel
def end_part(word: int, axis: int) -> int:
    """One component of a word of ``ends``, in units of ``end_scale``."""
    level = (word >> (END_BITS * axis)) & _MASK
    return level - (_MASK + 1) if level > END_LEVELS else level


@kernel
def _widest(points: Float64s, a: int, b: int, bx: float, by: float, bz: float) -> float:
    """Largest distance of ``points[a:b]`` from the segment that leads from the first of them to ``(bx, by, bz)``."""
    x0, y0, z0 = points[a, 0], points[a, 1], points[a, 2]
    vx, vy, vz = bx - x0, by - y0, bz - z0
    squares = vx * vx + vy * vy + vz * vz
    inverse = 1.0 / squares if squares >= SMALLEST else 0.0
    widest = 0.0
    for i in range(a + 1, b):
        dx, dy, dz = points[i, 0] - x0, points[i, 1] - y0, points[i, 2] - z0
        t = min(max((dx * vx + dy * vy + dz * vz) * inverse, 0.0), 1.0)
        dx, dy, dz = dx - t * vx, dy - t * vy, dz - t * vz
        widest = max(widest, dx * dx + dy * dy + dz * dz)
    return math.sqrt(widest)


@kernel
def capsule_radius(points: Float64s, a: int, b: int, bx: float, by: float, bz: float) -> float:
    """See :func:`.capsules.capsule_radius`; of the fiblet that decodes to ``points[a:b]``."""
    ex, ey, ez = points[b - 1, 0] - bx, points[b - 1, 1] - by, points[b - 1, 2] - bz
    arc = math.sqrt(ex * ex + ey * ey + ez * ez)
    for i in range(a + 1, b):
        ex, ey, ez = points[i, 0] - points[i - 1, 0], points[i, 1] - points[i - 1, 1], points[i, 2] - points[i - 1, 2]
        arc += math.sqrt(ex * ex + ey * ey + ez * ez)
    return _widest(points, a, b, bx, by, bz) + MARGIN * arc


@kernel
def capsule(decoded: Float64s, a: int, b: int, end: int, following: Float64s, end_scale: float) -> tuple[float, int]:
    """Radius (mm) and word of ``ends`` of the fiblet that decodes to ``decoded[a:b]``."""
    # `following` is `(3,)`: the next fiblet's decoded anchor, mm, read unless `end` says that the fiblet ends its
    # streamline; the word is 0 where it does not.
    if not end:
        return capsule_radius(decoded, a, b, following[0], following[1], following[2]), 0
    x, y, z = decoded[a, 0], decoded[a, 1], decoded[a, 2]
    word = end_word(decoded[b - 1, 0] - x, decoded[b - 1, 1] - y, decoded[b - 1, 2] - z, end_scale)
    x += end_scale * end_part(word, 0)
    y += end_scale * end_part(word, 1)
    z += end_scale * end_part(word, 2)
    return capsule_radius(decoded, a, b, x, y, z), word


@parallel_kernel
def leaving(points: Float64s, starts: Int64s, ends: Float64s, radius: Float64s) -> Bools:
    """``(m,)`` bool: fiblets with a point outside of the capsule."""
    # `points` are decoded points `(n, 3)` float64; fiblet `f` has those from `starts[f]` to `starts[f + 1]`, and its
    # capsule leads from the first of them to `ends[f]` with `radius[f]`, mm.
    found = np.zeros(len(radius), np.bool_)
    for f in numba.prange(len(radius)):
        found[f] = _widest(points, starts[f], starts[f + 1], ends[f, 0], ends[f, 1], ends[f, 2]) > radius[f]
    return found
