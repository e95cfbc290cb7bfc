"""QFib, and fiblets as the paper has them: constant steps by quantised directions within the file's widest turn.

QFib (Mercier et al. 2020, from its description in Schertzer et al. 2022, section 3.2.1): a streamline is its first two
points and one quantised unit vector for each further point. The vector is coded within a cap around the direction
before, as decoded; the cap is stretched over the whole sphere and rounded on an octahedron of 16 x 16 (one byte) or
256 x 256 values (two). The widest turn of the file is the cap's half-angle; every step is the file's median step. The
encoder aims from the decoded point, so that only what steps differ by adds up, along the streamline's whole length.

Paper's fiblets (section 3.2.2 and appendices A, B): the same anew every 60 points, the first two of them in 16 bits an
axis over the file's cube; the cap is stretched over half an octahedron of 16 x 16 values; and frames are propagated,
each built around the turned X by the constant vector of equation 2. A fiblet has 80 bytes, however few its points.

Where the description leaves things open: directions are rounded, not searched; QFib's octahedron has its corner at
the direction before and is turned about it by the frame of Duff et al., "Building an orthonormal basis, revisited",
2017; a streamline's first two points are float32; and the cap is made wider, so that the widest turn is half a radian
short of where the stretch puts all of the rim (`studies.codec.baselines.octahedral`). This costs 6 % of the codes.
Without it, one
direction beyond the cap, which closed loops do ask for, comes back as any, and the streamline flies off.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from pvfiblets.codec.jit import kernel

from .....support.array_types import Float64s, Floats, Int64s, UInt16s
from ..errors import median_step
from . import COUNT_BYTES
from .octahedral import from_cap, pack, ratio_of, to_cap, unpack

HEADER_BYTES = 32  # step, widest turn, origin and scale
FIBLET_POINTS = 60
FIBLET_BYTES = 80
TOP = 65535.0
QFIB_LIMIT = 1.0 + math.cos(0.5)
LEAST_RATIO = 1e-14  # of a file of straight lines, whose cap would be a point


@dataclass
class DirectionsPacked:
    """Streamlines by first points and codes; see the module."""

    firsts: npt.NDArray[np.float64]
    codes: npt.NDArray[np.uint16]
    starts: npt.NDArray[np.int64]
    step: float
    ratio: float
    levels: int
    spread: float
    limit: float
    propagated: bool
    nbytes: int

    def points(self) -> npt.NDArray[np.float64]:
        """Decode all points, ``(n, 3)`` float64."""
        decoded = np.empty((len(self.codes), 3))
        how = (self.step, self.ratio, self.levels, self.spread, self.limit, self.propagated)
        decode(self.firsts, self.codes, self.starts, how, decoded)
        return decoded


class QFib:
    """QFib with codes of 8 or 16 bits."""

    def __init__(self, bits: int) -> None:
        self.bits = bits

    def __call__(self, points: npt.NDArray[np.floating], offsets: npt.NDArray[np.int64]) -> DirectionsPacked:
        """Pack streamlines."""
        firsts = _first_two(points, offsets).astype(np.float32).astype(np.float64)
        counts = np.diff(offsets)
        size = (12 * np.minimum(counts, 2) + self.bits // 8 * np.maximum(counts - 2, 0) + COUNT_BYTES).sum()
        return _packed(points, offsets, offsets, firsts, 1 << (self.bits // 2), 2.0, False, HEADER_BYTES + int(size))


class PaperFiblets:
    """Fiblets as Schertzer et al. 2022 describe them."""

    def __call__(self, points: npt.NDArray[np.floating], offsets: npt.NDArray[np.int64]) -> DirectionsPacked:
        """Pack streamlines."""
        counts = np.diff(offsets)
        pieces = -(-counts // FIBLET_POINTS)
        nth = np.arange(pieces.sum()) - np.repeat(np.cumsum(pieces) - pieces, pieces)
        starts = np.append(np.repeat(offsets[:-1], pieces) + FIBLET_POINTS * nth, len(points))
        lower = points.min(0).astype(np.float64) if len(points) else np.zeros(3)
        edge = float((points.max(0).astype(np.float64) - lower).max()) if len(points) else 0.0
        unit = edge / TOP if edge > 0.0 else 1.0
        firsts = np.rint((_first_two(points, starts) - lower) / unit) * unit + lower
        size = HEADER_BYTES + FIBLET_BYTES * (len(starts) - 1)
        return _packed(points, offsets, starts, firsts, 16, 1.0, True, size)


def _first_two(points: npt.NDArray[np.floating], starts: npt.NDArray[np.int64]) -> npt.NDArray[np.float64]:
    """First two points of each piece, ``(m, 2, 3)``; the first twice where there is one."""
    if not len(points):
        return np.zeros((len(starts) - 1, 2, 3))
    first = np.minimum(starts[:-1], len(points) - 1)
    second = np.minimum(np.where(np.diff(starts) > 1, first + 1, first), len(points) - 1)
    return np.stack([points[first], points[second]], axis=1).astype(np.float64)


def _packed(
    points: Any, offsets: Any, starts: Any, firsts: Any, levels: int, spread: float, propagated: bool, nbytes: int
) -> DirectionsPacked:
    step = median_step(points, offsets)
    limit = QFIB_LIMIT if spread == 2.0 else spread
    ratio = min(max(ratio_of(widest_turn(points, offsets)), LEAST_RATIO) * spread / limit, 2.0)
    how = (0.0 if math.isnan(step) else step, ratio, levels, spread, limit, propagated)
    codes = np.zeros(len(points), np.uint16)
    encode(points, firsts, starts, how, codes)
    return DirectionsPacked(firsts, codes, starts, *how, nbytes)


def widest_turn(points: npt.NDArray[np.floating], offsets: npt.NDArray[np.int64]) -> float:
    """Return the widest angle between consecutive segments of a streamline, radians; 0 without any."""
    return float(_widest(points, offsets))


@kernel
def _widest(points: Floats, offsets: Int64s) -> float:
    widest = 0.0
    for s in range(len(offsets) - 1):
        for i in range(offsets[s] + 2, offsets[s + 1]):
            ax = np.float64(points[i - 1, 0]) - np.float64(points[i - 2, 0])
            ay = np.float64(points[i - 1, 1]) - np.float64(points[i - 2, 1])
            az = np.float64(points[i - 1, 2]) - np.float64(points[i - 2, 2])
            bx = np.float64(points[i, 0]) - np.float64(points[i - 1, 0])
            by = np.float64(points[i, 1]) - np.float64(points[i - 1, 1])
            bz = np.float64(points[i, 2]) - np.float64(points[i - 1, 2])
            cx, cy, cz = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
            turn = math.atan2(math.sqrt(cx * cx + cy * cy + cz * cz), ax * bx + ay * by + az * bz)
            widest = max(widest, turn)
    return widest


@kernel
def _basis(x: float, y: float, z: float) -> tuple[float, ...]:
    """Two unit vectors across a unit vector (Duff et al. 2017)."""
    sign = math.copysign(1.0, z)
    a = -1.0 / (sign + z)
    b = x * y * a
    return 1.0 + sign * x * x * a, sign * b, -sign * x, b, sign + y * y * a, -y


@kernel
def _turned(frame: tuple[float, ...], x: float, y: float, z: float) -> tuple[float, float, float]:
    """A vector of the frame ``(forward, left, up)`` in the world's coordinates."""
    return (
        frame[0] * x + frame[3] * y + frame[6] * z,
        frame[1] * x + frame[4] * y + frame[7] * z,
        frame[2] * x + frame[5] * y + frame[8] * z,
    )


@kernel
def _around(x: float, y: float, z: float) -> tuple[float, ...]:
    """Frame of a forward vector by the constant vector of equation 2: up and left across it."""
    # The constant is (0, 0, 1) turned a little, so that no decoded direction and no axis is along it.
    vx, vy, vz = 0.0871557427, 0.0436193874, 0.9952393
    ux, uy, uz = y * vz - z * vy, z * vx - x * vz, x * vy - y * vx
    r = math.sqrt(ux * ux + uy * uy + uz * uz)
    if r == 0.0:
        ux, uy, uz, r = 1.0, 0.0, 0.0, 1.0
    ux, uy, uz = ux / r, uy / r, uz / r
    return x, y, z, uy * z - uz * y, uz * x - ux * z, ux * y - uy * x, ux, uy, uz


@kernel
def _next_frame(
    frame: tuple[float, ...], local: tuple[float, float, float], dx: float, dy: float, dz: float, propagated: bool
) -> tuple[float, ...]:
    """The frame that the next direction is coded in: built anew, or turned on from the one before."""
    if not propagated:
        ax, ay, az, bx, by, bz = _basis(dx, dy, dz)
        return dx, dy, dz, ax, ay, az, bx, by, bz
    turn = _around(local[0], local[1], local[2])
    lx, ly, lz = _turned(frame, turn[3], turn[4], turn[5])
    ux, uy, uz = _turned(frame, turn[6], turn[7], turn[8])
    return dx, dy, dz, lx, ly, lz, ux, uy, uz


@kernel
def _first_frame(firsts: Float64s, s: int, propagated: bool) -> tuple[float, ...]:
    dx = firsts[s, 1, 0] - firsts[s, 0, 0]
    dy = firsts[s, 1, 1] - firsts[s, 0, 1]
    dz = firsts[s, 1, 2] - firsts[s, 0, 2]
    r = math.sqrt(dx * dx + dy * dy + dz * dz)
    if r == 0.0:
        dx, dy, dz, r = 1.0, 0.0, 0.0, 1.0
    dx, dy, dz = dx / r, dy / r, dz / r
    if propagated:
        return _around(dx, dy, dz)
    ax, ay, az, bx, by, bz = _basis(dx, dy, dz)
    return dx, dy, dz, ax, ay, az, bx, by, bz


@kernel
def encode(
    points: Floats, firsts: Float64s, starts: Int64s, how: tuple[float, float, int, float, float, bool], codes: UInt16s
) -> None:
    """Write a code for every point but the first two of each piece; codes stand where points do."""
    step, ratio, levels, spread, limit, propagated = how
    for s in range(len(starts) - 1):
        frame = _first_frame(firsts, s, propagated)
        px, py, pz = firsts[s, 1, 0], firsts[s, 1, 1], firsts[s, 1, 2]
        for i in range(starts[s] + 2, starts[s + 1]):
            ax, ay, az = np.float64(points[i, 0]) - px, np.float64(points[i, 1]) - py, np.float64(points[i, 2]) - pz
            r = math.sqrt(ax * ax + ay * ay + az * az)
            x, y, z = 1.0, 0.0, 0.0
            if r > 0.0:
                x = (ax * frame[0] + ay * frame[1] + az * frame[2]) / r
                y = (ax * frame[3] + ay * frame[4] + az * frame[5]) / r
                z = (ax * frame[6] + ay * frame[7] + az * frame[8]) / r
            x, y, z = from_cap(x, y, z, ratio, spread, limit)
            if propagated:
                # Half an octahedron is a square by itself, turned by 45 degrees (appendix A).
                norm = abs(x) + abs(y) + abs(z)
                half = 0.5 * (levels - 1)
                u = math.floor(0.5 + half * (1.0 + (y + z) / norm))
                v = math.floor(0.5 + half * (1.0 + (y - z) / norm))
            else:
                u, v = pack(x, y, z, levels)
            codes[i] = u + v * levels
            local = _local(u, v, how)
            dx, dy, dz = _turned(frame, local[0], local[1], local[2])
            px, py, pz = px + step * dx, py + step * dy, pz + step * dz
            frame = _next_frame(frame, local, dx, dy, dz, propagated)


@kernel
def _local(u: int, v: int, how: tuple[float, float, int, float, float, bool]) -> tuple[float, float, float]:
    """Direction that a code means, in the frame before it."""
    ratio, levels, spread, propagated = how[1], how[2], how[3], how[5]
    if propagated:
        half = 0.5 * (levels - 1)
        first, second = u / half - 1.0, v / half - 1.0
        y, z = 0.5 * (first + second), 0.5 * (first - second)
        x = 1.0 - abs(y) - abs(z)
        r = math.sqrt(x * x + y * y + z * z)
        return to_cap(x / r, y / r, z / r, ratio, spread)
    x, y, z = unpack(u, v, levels)
    return to_cap(x, y, z, ratio, spread)


@kernel
def decode(firsts: Float64s, codes: UInt16s, starts: Int64s, how: tuple[float, float, int, float, float, bool],
           points: Float64s) -> None:  # fmt: skip
    """Write all points, ``(n, 3)`` float64."""
    step, levels, propagated = how[0], how[2], how[5]
    for s in range(len(starts) - 1):
        a, b = starts[s], starts[s + 1]
        for i in range(a, min(a + 2, b)):
            for axis in range(3):
                points[i, axis] = firsts[s, i - a, axis]
        frame = _first_frame(firsts, s, propagated)
        px, py, pz = firsts[s, 1, 0], firsts[s, 1, 1], firsts[s, 1, 2]
        for i in range(a + 2, b):
            code = np.int64(codes[i])
            local = _local(code % levels, code // levels, how)
            dx, dy, dz = _turned(frame, local[0], local[1], local[2])
            px, py, pz = px + step * dx, py + step * dy, pz + step * dz
            points[i, 0], points[i, 1], points[i, 2] = px, py, pz
            frame = _next_frame(frame, local, dx, dy, dz, propagated)
