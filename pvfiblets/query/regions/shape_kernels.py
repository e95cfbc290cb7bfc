"""Compiled kernels: which positions a region holds; the shapes and their rows are described in :mod:`.classify`."""

from __future__ import annotations

import math

import numba

from ...codec.jit import kernel, parallel_kernel
from ...support.array_types import Bools, Float64s, Int32s, Int64s

_PLANE, _SLAB, _BOX, _SPHERE = range(4)
_AND, _OR, _NOT = -1, -2, -3
_BLOCK = 4096


@kernel
def unit(row: Float64s, x: float, y: float, z: float) -> tuple[float, float, float]:
    """Unit coordinates of a position; the order of operations is that of :mod:`.shapes`."""
    x -= row[10]
    y -= row[11]
    z -= row[12]
    return (
        row[1] * x + row[2] * y + row[3] * z,
        row[4] * x + row[5] * y + row[6] * z,
        row[7] * x + row[8] * y + row[9] * z,
    )


@kernel
def _holds(row: Float64s, x: float, y: float, z: float) -> bool:
    u, v, w = unit(row, x, y, z)
    kind = row[0]
    if kind == _PLANE:
        return w >= 0.0
    if kind == _SLAB:
        return abs(w) <= 1.0
    if kind == _BOX:
        return abs(u) <= 1.0 and abs(v) <= 1.0 and abs(w) <= 1.0
    return u * u + v * v + w * w <= 1.0


@parallel_kernel
def evaluate(ops: Int32s, rows: Float64s, known: Bools, places: Int64s, points: Float64s, out: Bools) -> None:
    """Find the points that a region holds."""
    # `known` is (k, n) bool: known results of leaves, of leaf i in row `places[i]` if that is not -1 (surfaces,
    # labels); the other leaves are computed here. `points` is (n, 3) float64, `out` (n,) bool.
    n = len(points)
    for block in numba.prange((n + _BLOCK - 1) // _BLOCK):
        for i in range(block * _BLOCK, min((block + 1) * _BLOCK, n)):
            x, y, z = points[i, 0], points[i, 1], points[i, 2]
            if not (math.isfinite(x) and math.isfinite(y) and math.isfinite(z)):
                out[i] = False
                continue
            stack = 0  # of bits, the top in bit 0
            for word in ops:
                if word >= 0:
                    place = places[word]
                    bit = known[place, i] if place >= 0 else _holds(rows[word], x, y, z)
                    stack = stack << 1 | (1 if bit else 0)
                elif word == _NOT:
                    stack ^= 1
                else:
                    top = stack & 1
                    stack >>= 1
                    if word == _AND:
                        stack &= top | ~1
                    else:
                        stack |= top
            out[i] = stack != 0
