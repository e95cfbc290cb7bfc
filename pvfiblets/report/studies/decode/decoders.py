"""Decoding of one fiblet's direction codes by several variants, compiled alike, for the study of decoding.

All variants fill the same scratch with one rigid motion a point and then put these together:

- *sequential* (Schertzer et al. 2022, section 3.3.1): frame and point move on from one to the next;
- *prefix* (section 3.3.2): Sklansky's network of products of motions, as ``shaders/fiblets/decode/parallel.glsl``.
Here one
  thread does the work of all 32, so its time is that of the work, not that of a graphics card;

with rotations as *quaternions* or *matrices*, from a *table*, or by the *closed form* of
:mod:`pvfiblets.codec.direction_codebook`: ``rho = (i / 256)^(7/8)``, turned by ``i`` golden angles, lifted to the cap
by ``x = 1 - Ratio rho^2``. The codec's table holds 16-bit integers; *rounded* rounds to these as well.

Numbers are float32 or float64, as the arrays given are. Constants come in an array of that kind, since numba would
take float64 for literals and no float32 would be left.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from pvfiblets.codec.direction_codebook import cap_ratios, packed_scales, quaternions
from pvfiblets.codec.jit import kernel
from pvfiblets.support.array_types import Floats, UInt8s

POINTS = 60
ELEMENTS = 64
PASSES = 6
SEQUENTIAL, PREFIX = 0, 1
QUATERNION, MATRIX = 0, 1
TABLE, CLOSED, ROUNDED = 0, 1, 2
GOLDEN_TURN = (3.0 - math.sqrt(5.0)) / 2.0  # the golden angle in turns


def inputs(dtype: npt.DTypeLike) -> tuple[Any, ...]:
    """Return what all variants read, in one kind of number."""
    q = quaternions().astype(np.float64)
    w, x, y, z = np.moveaxis(q, -1, 0)
    rows = [
        1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y),
        2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x),
        2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y),
    ]  # fmt: skip
    constants = np.array([0.0, 1.0, 2.0, 0.875, 256.0, GOLDEN_TURN, 2.0 * math.pi])
    arrays = (q, np.stack(rows, axis=-1), cap_ratios(), packed_scales(), np.arange(256.0), constants)
    return tuple(np.ascontiguousarray(array.astype(dtype)) for array in arrays)


@kernel
def _closed(number: float, ratio: float, unit: float, rounded: bool, c: Floats) -> tuple[float, float, float]:
    """Quaternion ``(w, y, z)`` of a code, whose x is 0."""
    one = c[1]
    t = number / c[4]
    rho = math.sqrt(t * math.sqrt(t * math.sqrt(t)))
    turns = number * c[5]
    turns = turns - math.floor(turns)
    along = c[0] + math.cos(turns * c[6])
    across = c[0] + math.sin(turns * c[6])
    x = one - ratio * (rho * rho)
    lateral = rho * math.sqrt(ratio * (one + x))
    w, y, z = one + x, -lateral * across, lateral * along
    r = one / math.sqrt(w * w + y * y + z * z)
    w, y, z = w * r, y * r, z * r
    if rounded:
        y, z = np.rint(y / unit) * unit, np.rint(z / unit) * unit
        w = math.sqrt(one - y * y - z * z)
    return w, y, z


@kernel
def _fill_quaternions(
    codes: UInt8s, cap: int, source: int, first: Floats, tables: tuple[Floats, ...], q: Floats
) -> None:
    table, _, ratios, units, numbers, c = tables
    for k in range(4):
        q[1, k] = first[k]
    for i in range(len(codes)):
        code = codes[i]
        if source == TABLE:
            for k in range(4):
                q[i + 2, k] = table[cap, code, k]
        else:
            w, y, z = _closed(numbers[code], ratios[cap], units[cap], source == ROUNDED, c)
            q[i + 2, 0], q[i + 2, 1], q[i + 2, 2], q[i + 2, 3] = w, c[0], y, z


@kernel
def _matrix(w: float, x: float, y: float, z: float, c: Floats, m: Floats) -> None:
    one, two = c[1], c[2]
    m[0], m[1], m[2] = one - two * (y * y + z * z), two * (x * y - w * z), two * (x * z + w * y)
    m[3], m[4], m[5] = two * (x * y + w * z), one - two * (x * x + z * z), two * (y * z - w * x)
    m[6], m[7], m[8] = two * (x * z - w * y), two * (y * z + w * x), one - two * (x * x + y * y)


@kernel
def _fill_matrices(codes: UInt8s, cap: int, source: int, first: Floats, tables: tuple[Floats, ...], m: Floats) -> None:
    _, table, ratios, units, numbers, c = tables
    _matrix(first[0], first[1], first[2], first[3], c, m[1])
    for i in range(len(codes)):
        code = codes[i]
        if source == TABLE:
            for k in range(9):
                m[i + 2, k] = table[cap, code, k]
        else:
            w, y, z = _closed(numbers[code], ratios[cap], units[cap], source == ROUNDED, c)
            _matrix(w, c[0], y, z, c, m[i + 2])


@kernel
def _product(a: tuple[float, ...], b: tuple[float, ...]) -> tuple[float, ...]:
    return (
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
        a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
    )


@kernel
def _matrix_product(a: Any, b: Floats) -> tuple[float, ...]:
    return (
        a[0] * b[0] + a[1] * b[3] + a[2] * b[6],
        a[0] * b[1] + a[1] * b[4] + a[2] * b[7],
        a[0] * b[2] + a[1] * b[5] + a[2] * b[8],
        a[3] * b[0] + a[4] * b[3] + a[5] * b[6],
        a[3] * b[1] + a[4] * b[4] + a[5] * b[7],
        a[3] * b[2] + a[4] * b[5] + a[5] * b[8],
        a[6] * b[0] + a[7] * b[3] + a[8] * b[6],
        a[6] * b[1] + a[7] * b[4] + a[8] * b[7],
        a[6] * b[2] + a[7] * b[5] + a[8] * b[8],
    )


@kernel
def _sequential_quaternions(q: Floats, anchor: Floats, step: float, c: Floats, out: Floats) -> None:
    one, two = c[1], c[2]
    f = (q[1, 0], q[1, 1], q[1, 2], q[1, 3])
    x, y, z = anchor[0], anchor[1], anchor[2]
    out[0, 0], out[0, 1], out[0, 2] = x, y, z
    for i in range(1, len(out)):
        if i > 1:
            f = _product(f, (q[i, 0], q[i, 1], q[i, 2], q[i, 3]))
        x += step * (one - two * (f[2] * f[2] + f[3] * f[3]))
        y += step * (two * (f[1] * f[2] + f[0] * f[3]))
        z += step * (two * (f[1] * f[3] - f[0] * f[2]))
        out[i, 0], out[i, 1], out[i, 2] = x, y, z


@kernel
def _sequential_matrices(m: Floats, anchor: Floats, step: float, out: Floats) -> None:
    f = (m[1, 0], m[1, 1], m[1, 2], m[1, 3], m[1, 4], m[1, 5], m[1, 6], m[1, 7], m[1, 8])
    x, y, z = anchor[0], anchor[1], anchor[2]
    out[0, 0], out[0, 1], out[0, 2] = x, y, z
    for i in range(1, len(out)):
        if i > 1:
            f = _matrix_product(f, m[i])
        x += step * f[0]
        y += step * f[3]
        z += step * f[6]
        out[i, 0], out[i, 1], out[i, 2] = x, y, z


@kernel
def _prefix_quaternions(q: Floats, t: Floats, anchor: Floats, step: float, c: Floats, out: Floats) -> None:
    zero, one, two = c[0], c[1], c[2]
    q[0, 0], q[0, 1], q[0, 2], q[0, 3] = one, zero, zero, zero
    t[0, 0], t[0, 1], t[0, 2] = zero, zero, zero
    n = len(out)
    for i in range(1, n):
        w, x, y, z = q[i, 0], q[i, 1], q[i, 2], q[i, 3]
        t[i, 0] = step * (one - two * (y * y + z * z))
        t[i, 1] = step * (two * (x * y + w * z))
        t[i, 2] = step * (two * (x * z - w * y))
    for p in range(PASSES):
        for thread in range(ELEMENTS // 2):
            low = ((thread >> p) << (p + 1)) + (1 << p) - 1
            high = low + 1 + (thread & ((1 << p) - 1))
            if high >= n:
                continue
            w, x, y, z = q[low, 0], q[low, 1], q[low, 2], q[low, 3]
            vx, vy, vz = t[high, 0], t[high, 1], t[high, 2]
            ux, uy, uz = two * (y * vz - z * vy), two * (z * vx - x * vz), two * (x * vy - y * vx)
            t[high, 0] = t[low, 0] + (vx + w * ux + (y * uz - z * uy))
            t[high, 1] = t[low, 1] + (vy + w * uy + (z * ux - x * uz))
            t[high, 2] = t[low, 2] + (vz + w * uz + (x * uy - y * ux))
            q[high, 0], q[high, 1], q[high, 2], q[high, 3] = _product(
                (w, x, y, z), (q[high, 0], q[high, 1], q[high, 2], q[high, 3])
            )
    for i in range(n):
        for axis in range(3):
            out[i, axis] = anchor[axis] + t[i, axis]


@kernel
def _prefix_matrices(m: Floats, t: Floats, anchor: Floats, step: float, c: Floats, out: Floats) -> None:
    for k in range(9):
        m[0, k] = c[1] if k % 4 == 0 else c[0]
    t[0, 0], t[0, 1], t[0, 2] = c[0], c[0], c[0]
    n = len(out)
    for i in range(1, n):
        t[i, 0], t[i, 1], t[i, 2] = step * m[i, 0], step * m[i, 3], step * m[i, 6]
    for p in range(PASSES):
        for thread in range(ELEMENTS // 2):
            low = ((thread >> p) << (p + 1)) + (1 << p) - 1
            high = low + 1 + (thread & ((1 << p) - 1))
            if high >= n:
                continue
            a = m[low]
            vx, vy, vz = t[high, 0], t[high, 1], t[high, 2]
            t[high, 0] = t[low, 0] + (a[0] * vx + a[1] * vy + a[2] * vz)
            t[high, 1] = t[low, 1] + (a[3] * vx + a[4] * vy + a[5] * vz)
            t[high, 2] = t[low, 2] + (a[6] * vx + a[7] * vy + a[8] * vz)
            b = _matrix_product(a, m[high])
            for k in range(9):
                m[high, k] = b[k]
    for i in range(n):
        for axis in range(3):
            out[i, axis] = anchor[axis] + t[i, axis]


@kernel
def decode(anchors: Floats, firsts: Floats, codes: UInt8s, cap: int, step: Floats, how: tuple[int, int, int],
           tables: tuple[Floats, ...], scratch: tuple[Floats, Floats, Floats], out: Floats) -> None:  # fmt: skip
    """Decode fiblets of equal length."""
    order, algebra, source = how
    q, m, t = scratch
    c = tables[5]
    for f in range(len(codes)):
        if algebra == QUATERNION:
            _fill_quaternions(codes[f], cap, source, firsts[f], tables, q)
            if order == SEQUENTIAL:
                _sequential_quaternions(q, anchors[f], step[0], c, out[f])
            else:
                _prefix_quaternions(q, t, anchors[f], step[0], c, out[f])
        else:
            _fill_matrices(codes[f], cap, source, firsts[f], tables, m)
            if order == SEQUENTIAL:
                _sequential_matrices(m, anchors[f], step[0], out[f])
            else:
                _prefix_matrices(m, t, anchors[f], step[0], c, out[f])
