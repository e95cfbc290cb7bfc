"""Unit vectors on an octahedron, and a cap of the sphere stretched over all of it.

Octahedral: Meyer et al., "On floating-point normal vectors", 2010 ([MSS*10] of the fiblets paper). The vector is
divided by its 1-norm; the half behind ``x = 0`` is folded outwards, and the square ``[-1, 1]^2`` of ``(y, z)`` is
rounded to ``levels`` values an axis, both ends among them.

Stretching: Rousseau and Boubekeur, "Unorganized unit vectors sets quantization", 2020 ([RB20]): the cap of half-angle
``alpha`` around X is mapped to the sphere (``spread = 2``; QFib) or to the half with ``x >= 0`` (``spread = 1``; the
fiblets paper, appendix A) so that areas keep their ratios: ``c' = 1 - spread (1 - c) / Ratio``,
``Ratio = 1 - cos alpha``, where ``c`` is a vector's x. All of the cap's rim falls on the one point ``-X`` of the
sphere, around which codes hold azimuths badly or not at all; vectors near the rim or beyond it are therefore kept
``limit`` away from X at most.
"""

from __future__ import annotations

import math

from pvfiblets.codec.jit import kernel


@kernel
def pack(x: float, y: float, z: float, levels: int) -> tuple[int, int]:
    """Return the two whole numbers, ``0`` to ``levels - 1``, of a vector that is not 0."""
    norm = abs(x) + abs(y) + abs(z)
    u = y / norm
    v = z / norm
    if x < 0.0:
        folded_u = (1.0 - abs(v)) * (1.0 if u >= 0.0 else -1.0)
        v = (1.0 - abs(u)) * (1.0 if v >= 0.0 else -1.0)
        u = folded_u
    half = 0.5 * (levels - 1)
    return math.floor(0.5 + half * (1.0 + u)), math.floor(0.5 + half * (1.0 + v))


@kernel
def unpack(i: int, j: int, levels: int) -> tuple[float, float, float]:
    """Return the unit vector of two whole numbers."""
    half = 0.5 * (levels - 1)
    u = i / half - 1.0
    v = j / half - 1.0
    x = 1.0 - abs(u) - abs(v)
    if x < 0.0:
        folded_u = (1.0 - abs(v)) * (1.0 if u >= 0.0 else -1.0)
        v = (1.0 - abs(u)) * (1.0 if v >= 0.0 else -1.0)
        u = folded_u
    r = 1.0 / math.sqrt(x * x + u * u + v * v)
    return x * r, u * r, v * r


def ratio_of(angle: float) -> float:
    """Return ``1 - cos(angle)`` with all digits where the angle is small."""
    return 2.0 * math.sin(0.5 * angle) ** 2


@kernel
def from_cap(x: float, y: float, z: float, ratio: float, spread: float, limit: float) -> tuple[float, float, float]:
    """Stretch the cap around X: unit vector to unit vector, whose ``1 - x`` is ``limit`` at most."""
    lateral = math.sqrt(y * y + z * z)
    if lateral == 0.0:
        return (1.0, 0.0, 0.0) if x > 0.0 else (1.0 - limit, math.sqrt(max(limit * (2.0 - limit), 0.0)), 0.0)
    away = lateral * lateral / (1.0 + x) if x > 0.0 else 1.0 - x  # 1 - x with all digits
    away = min(spread * away / ratio, limit)
    width = math.sqrt(max(away * (2.0 - away), 0.0)) / lateral
    return 1.0 - away, y * width, z * width


@kernel
def to_cap(x: float, y: float, z: float, ratio: float, spread: float) -> tuple[float, float, float]:
    """Undo :func:`from_cap`, but for its limit."""
    lateral = math.sqrt(y * y + z * z)
    if lateral == 0.0:
        return (1.0, 0.0, 0.0) if x > 0.0 else (1.0 - ratio, math.sqrt(max(ratio * (2.0 - ratio), 0.0)), 0.0)
    away = ratio * (1.0 - x) / spread
    width = math.sqrt(max(away * (2.0 - away), 0.0)) / lateral
    return 1.0 - away, y * width, z * width
