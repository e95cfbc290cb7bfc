"""Decoding in plain NumPy and float64: what a fiblet's codes mean, literally, with no thought for speed.

Compiled decoding must give the same points, and shaders the same within 1e-3 step. Points are millimetres relative to
the set's origin. ``P_0`` is the anchor, ``P_1 = P_0 + step d_1``; each code turns the frame, ``q <- q T[cap][code]``,
and ``P <- P + step (q X)`` (paper: Schertzer et al. 2022, section 3.3.1 and appendix B).
"""

from __future__ import annotations

from typing import TypeVar

import numpy as np
import numpy.typing as npt

from pvfiblets.codec.direction_codebook import quaternions
from pvfiblets.codec.layout import DIRECTION_SCALE, PLAIN_BYTES, WIDE_HEADER, Kind

Array = npt.NDArray[np.float64]
Number = TypeVar("Number", bound=np.floating)


def first_frame(word: int) -> tuple[Array, Array]:
    """First direction and frame of a fiblet (the paper's ``M_0``, section 3.3.2)."""
    d, forward = _unpack_direction(word)
    dx, dy, dz = d
    q = np.array([1.0 + dx, 0.0, -dz, dy]) if forward else np.array([1.0 - dx, 0.0, dz, -dy])
    r = 1.0 / np.sqrt(q[0] * q[0] + q[2] * q[2] + q[3] * q[3])
    w, y, z = q[0] * r, q[2] * r, q[3] * r
    return d, (np.array([w, 0.0, y, z]) if forward else np.array([-z, y, 0.0, w]))


def rotate_x(q: npt.NDArray[Number]) -> npt.NDArray[Number]:
    """First column of a quaternion's rotation matrix: where it turns X."""
    w, x, y, z = q
    return np.array([1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)])


def product(a: npt.NDArray[Number], b: npt.NDArray[Number]) -> npt.NDArray[Number]:
    """Product of two quaternions, ``w`` first."""
    w, x, y, z = a
    tw, tx, ty, tz = b
    return np.array(
        [
            w * tw - x * tx - y * ty - z * tz,
            w * tx + x * tw + y * tz - z * ty,
            w * ty - x * tz + y * tw + z * tx,
            w * tz + x * ty - y * tx + z * tw,
        ]
    )


def decode_direction(
    anchor: Array, shape: int, length: float, cap: int, codes: npt.NDArray[np.uint8], count: int
) -> Array:
    """Points of a DIRECTION fiblet, ``(count, 3)`` float64 (paper, section 3.3.1)."""
    points = np.empty((count, 3))
    points[0] = anchor
    if count == 1:
        return points
    d, q = first_frame(shape)
    points[1] = anchor + length * d
    for i in range(2, count):
        q = product(q, quaternions()[cap, codes[i - 2]].astype(np.float64))
        points[i] = points[i - 1] + length * rotate_x(q)
    return points


def decode_lattice(
    anchor: Array, kind: int, shape: int, step: int, edge: float, codes: npt.NDArray[np.uint8], count: int
) -> Array:
    """Points of a lattice fiblet, ``(count, 3)`` float64; ``edge`` is the file's edge halved ``cap`` times, mm."""
    if kind == Kind.WIDE and step & 7 == 0:
        steps = codes[: PLAIN_BYTES * (count - 1)].view("<i4").reshape(-1, 3).astype(np.int64)
        return anchor + edge * np.concatenate([np.zeros((1, 3), np.int64), np.cumsum(steps, axis=0)])
    if kind == Kind.WIDE:
        lo = codes[:12].view("<i4").astype(np.int64)
        nx, ny = (int(n) for n in codes[12:20].view("<u4"))
        width, body = step & 7, codes[WIDE_HEADER:]
    else:
        lo = np.array([(shape >> s & 0xFF) for s in (0, 8, 16)], np.uint8).view(np.int8).astype(np.int64)
        nx, ny, width, body = (shape >> 24) + 1, (step & 0xFF) + 1, kind, codes
    k = np.zeros((count, 3), np.int64)
    for i in range(1, count):
        value = int.from_bytes(body[(i - 1) * width : i * width].tobytes(), "little")
        k[i] = k[i - 1] + lo + (value % nx, value // nx % ny, value // (nx * ny))
    return anchor + edge * k


def decode_spline(
    anchor: Array, shape: int, nodes: int, edge: float, codes: npt.NDArray[np.uint8], count: int
) -> Array:
    """Points of a fiblet of splines, ``(count, 3)`` float64, as Hermite curves between nodes."""
    scale = 4.0 ** (shape >> 30) / 8.0
    place, slope = np.zeros(3), scale * np.array([_signed(shape >> 10 * axis, 10) for axis in range(3)], float)
    local = [place]
    for node in range(nodes):
        word = int.from_bytes(codes[6 * node : 6 * node + 6].tobytes(), "little")
        n = word & 63
        d, e = np.array([_signed(word >> (6 + 7 * k), 7) for k in range(6)], float).reshape(2, 3)
        end, then = place + n * slope + d, slope + 2.0 * (d + e) / n
        for m in range(1, n + 1):
            x = m / n
            local.append(
                (1.0 + 2.0 * x) * (1.0 - x) ** 2 * place + x * (1.0 - x) ** 2 * n * slope
                + x * x * (3.0 - 2.0 * x) * end + x * x * (x - 1.0) * n * then
            )  # fmt: skip
        place, slope = end, then
    assert len(local) == count
    return anchor + edge * np.array(local)


def _signed(bits: int, width: int) -> int:
    bits &= (1 << width) - 1
    return bits - (1 << width) if bits >> (width - 1) else bits


def _unpack_direction(word: int) -> tuple[Array, bool]:
    """Unit vector that two snorm16 on the octahedron about +x stand for, and whether its x is not negative."""
    iu, iv = _int16(word & 0xFFFF), _int16(word >> 16)
    u, v = iu / DIRECTION_SCALE, iv / DIRECTION_SCALE
    forward = abs(iu) + abs(iv) <= int(DIRECTION_SCALE)
    x = 1.0 - abs(u) - abs(v)
    y, z = (u, v) if forward else ((1.0 - abs(v)) * _sign(u), (1.0 - abs(u)) * _sign(v))
    r = 1.0 / np.sqrt(x * x + y * y + z * z)
    return np.array([x * r, y * r, z * r]), forward


def _sign(value: float) -> float:
    return 1.0 if value >= 0.0 else -1.0


def _int16(bits: int) -> int:
    return bits - 0x10000 if bits & 0x8000 else bits
