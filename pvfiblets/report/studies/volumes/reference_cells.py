"""Compiled kernels: the field along a ray within one cell, as a polynomial that is known exactly.

Within a cell the field is a polynomial in each coordinate: constant, linear or cubic by the filter. Along the stretch
of a ray from ``a`` to ``b`` in the cell it is therefore one of degree 0, 3 or 9 in ``s``, 0 at ``a`` to 1 at ``b``.
They are held here by Bernstein coefficients: with ``c[i, j, k]`` the coefficients of the field over the box with the
corners ``a`` and ``b``, of degree ``m`` along each axis, the coefficients on its diagonal are::

    p[r] = sum over i + j + k = r of c[i, j, k] * C(m, i) C(m, j) C(m, k) / C(3m, r)

Coefficients are means of the voxels' values (differences of neighbours besides, where cubic), so that no digits are
lost in short stretches, and the polynomial lies between the least and the greatest of them. A field that is the same
all over a cell gives coefficients that are the same to the last bit.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from pvfiblets.codec.jit import kernel
from pvfiblets.support.array_types import Float32s, Float64s, Int64s

NEAREST, TRILINEAR, TRICUBIC = range(3)

OVERSHOOT = ((4.0 / 3.0) ** 3 - 1.0) / 2.0
"""By how much of the spread of 64 voxels Catmull-Rom's coefficients lie beyond them at most: along each axis by a sixth
of the spread to either side."""

HALVINGS = 200  # more than Newton's method, kept in its bracket, ever takes


class Scratch(NamedTuple):
    """Memory that the kernels write to; one for each thread."""

    cell: Any  # (3,) int64
    ends: Any  # (2, 3) where a ray enters and leaves the cell, 0 to 1
    tensor: Any  # (64,) values of 4 x 4 x 4 voxels, then coefficients
    polynomial: Any  # (10,) coefficients along the ray
    table: Any  # (10, 10) coefficients of its derivatives
    places: Any  # (10,) 0, where it turns, 1
    work: Any  # (10,)


@kernel
def scratch() -> Scratch:
    """Fresh memory."""
    return Scratch(
        np.zeros(3, np.int64),
        np.zeros((2, 3)),
        np.zeros(64),
        np.zeros(10),
        np.zeros((10, 10)),
        np.zeros(10),
        np.zeros(10),
    )


@kernel
def enter(field: Float32s, how: int, origin: Float64s, direction: Float64s, t: float, cell: Int64s) -> None:
    """Put the cell that a ray is in at ``t`` into `cell`."""
    for k in range(3):
        # A voxel is a cell of its own where the nearest one counts; else there is one between each two.
        last = field.shape[k] - (1 if how == NEAREST else 2)
        cell[k] = min(max(math.floor(origin[k] + t * direction[k]), 0), last)


@kernel
def leave(origin: Float64s, direction: Float64s, cell: Int64s, t: float) -> tuple[float, int]:
    """Where a ray leaves a cell ``[cell, cell + 1)`` that it is in at ``t``, and across which axis."""
    nearest, axis = math.inf, -1
    for k in range(3):
        if direction[k] != 0.0:
            plane = cell[k] + 1.0 if direction[k] > 0.0 else float(cell[k])
            at = (plane - origin[k]) / direction[k]
            if at < nearest:
                nearest, axis = at, k
    return max(nearest, t), axis


@kernel
def _at(field: Float32s, i: int, j: int, k: int) -> float:
    """A voxel; beyond the edges, the last one."""
    nx, ny, nz = field.shape
    return np.float64(field[min(max(i, 0), nx - 1), min(max(j, 0), ny - 1), min(max(k, 0), nz - 1)])


@kernel
def limits(field: Float32s, how: int, cell: Int64s) -> tuple[float, float]:
    """Numbers that the field in a cell does not go below and above."""
    if how == NEAREST:
        value = _at(field, cell[0], cell[1], cell[2])
        return value, value
    margin = 1 if how == TRICUBIC else 0
    low, high = math.inf, -math.inf
    for i in range(-margin, 2 + margin):
        for j in range(-margin, 2 + margin):
            for k in range(-margin, 2 + margin):
                value = _at(field, cell[0] + i, cell[1] + j, cell[2] + k)
                low, high = min(low, value), max(high, value)
    if how == TRICUBIC:
        # A little more, for what rounding adds.
        beyond = (high - low) * (OVERSHOOT + 1e-9)
        low, high = low - beyond, high + beyond
    return low, high


@kernel
def _between(a: float, b: float, u: float) -> float:
    return a + (b - a) * u


@kernel
def _blossom(p: float, q: float, r: float, s: float, x: float, y: float, z: float) -> float:
    """The symmetric form of a cubic in Bernstein coefficients, at three places."""
    p, q, r = _between(p, q, x), _between(q, r, x), _between(r, s, x)
    return _between(_between(p, q, y), _between(q, r, y), z)


@kernel
def _restrict(tensor: Float64s, how: int, axis: int, i: int, j: int, a: float, b: float) -> None:
    """Turn values along one axis into coefficients over ``a`` to ``b``: 2 of a line, 4 of Catmull-Rom's cubic."""
    # `tensor` is flat, and `i` and `j` say which line of that axis it is.
    first = 4 * i + j if axis == 0 else (16 * i + j if axis == 1 else 16 * i + 4 * j)
    step = 16 if axis == 0 else (4 if axis == 1 else 1)
    p, q = tensor[first], tensor[first + step]
    if how == TRILINEAR:
        tensor[first], tensor[first + step] = _between(p, q, a), _between(p, q, b)
        return
    r, s = tensor[first + 2 * step], tensor[first + 3 * step]
    p, q, r, s = q, q + (r - p) / 6.0, r - (s - q) / 6.0, r
    tensor[first] = _blossom(p, q, r, s, a, a, a)
    tensor[first + step] = _blossom(p, q, r, s, a, a, b)
    tensor[first + 2 * step] = _blossom(p, q, r, s, a, b, b)
    tensor[first + 3 * step] = _blossom(p, q, r, s, b, b, b)


@kernel
def along(field: Float32s, how: int, memory: Scratch) -> int:
    """Bernstein coefficients of the field in a cell, from one place in it to another; gives their degree."""
    # Takes `memory.cell` and `memory.ends`, and leaves the coefficients in `memory.polynomial`.
    cell, tensor, polynomial = memory.cell, memory.tensor, memory.polynomial
    if how == NEAREST:
        polynomial[0] = _at(field, cell[0], cell[1], cell[2])
        return 0
    n, first = (2, 0) if how == TRILINEAR else (4, -1)
    for i in range(n):
        for j in range(n):
            for k in range(n):
                tensor[16 * i + 4 * j + k] = _at(field, cell[0] + i + first, cell[1] + j + first, cell[2] + k + first)
    for axis in range(3):
        for i in range(n):
            for j in range(n):
                _restrict(tensor, how, axis, i, j, memory.ends[0, axis], memory.ends[1, axis])
    degree = 3 * (n - 1)
    for r in range(degree + 1):
        polynomial[r] = 0.0
    # Differences to one of them, so that equal numbers stay equal.
    common = tensor[0]
    for i in range(n):
        for j in range(n):
            for k in range(n):
                weight = _choose(n - 1, i) * _choose(n - 1, j) * _choose(n - 1, k)
                polynomial[i + j + k] += weight * (tensor[16 * i + 4 * j + k] - common)
    for r in range(degree):
        polynomial[r] = common + polynomial[r] / _choose(degree, r)
    polynomial[degree] = tensor[21 * (n - 1)]
    return degree


@kernel
def _choose(n: int, k: int) -> float:
    found = 1.0
    for i in range(k):
        found = found * (n - i) / (i + 1)
    return found


@kernel
def evaluated(polynomial: Float64s, degree: int, s: float, work: Float64s) -> tuple[float, float]:
    """A polynomial and its derivative at ``s``, by de Casteljau's scheme. `work` is ``(10,)``, overwritten."""
    if degree == 0:
        return polynomial[0], 0.0
    for i in range(degree + 1):
        work[i] = polynomial[i]
    for n in range(degree, 1, -1):
        for i in range(n):
            work[i] = _between(work[i], work[i + 1], s)
    return _between(work[0], work[1], s), degree * (work[1] - work[0])


@kernel
def solved(polynomial: Float64s, degree: int, low: float, high: float, value: float, work: Float64s) -> float:
    """Where a polynomial that is monotone from ``low`` to ``high`` takes a value; if nowhere, the end nearer to it."""
    at_low = evaluated(polynomial, degree, low, work)[0] - value
    at_high = evaluated(polynomial, degree, high, work)[0] - value
    if at_low == 0.0 or (at_low > 0.0) == (at_high > 0.0):
        return low if abs(at_low) <= abs(at_high) else high
    if at_high == 0.0:
        return high
    s, last = low + (high - low) * at_low / (at_low - at_high), math.inf
    for _ in range(HALVINGS):
        if not low < s < high:
            s = 0.5 * (low + high)
            if not low < s < high:
                break
        height, slope = evaluated(polynomial, degree, s, work)
        height -= value
        if height == 0.0:
            return s
        before = high - low
        if (height > 0.0) == (at_low > 0.0):
            low = s
        else:
            high = s
        step = height / slope if slope != 0.0 else math.inf
        # Steps that have ceased to shrink are rounding errors.
        if abs(step) <= 1e-16 or (abs(step) < 1e-12 and abs(step) >= 0.5 * last):
            return min(max(s - step, low), high)
        s, last = (s - step if abs(step) < 0.5 * before else 0.5 * (low + high)), abs(step)
    return s


@kernel
def extrema(degree: int, memory: Scratch) -> int:
    """Where ``memory.polynomial`` turns between 0 and 1: into ``memory.places``, with 0 and 1; gives their number."""
    # Between neighbouring roots of a derivative the next lower one is monotone, and so holds one root at most: from the
    # last derivative, a line, up to the first.
    polynomial, table, found, work = memory.polynomial, memory.table, memory.places, memory.work
    found[0], found[1] = 0.0, 1.0
    rises, falls = False, False
    for i in range(degree):
        table[0, i] = polynomial[i + 1] - polynomial[i]
        rises, falls = rises or table[0, i] > 0.0, falls or table[0, i] < 0.0
    if not (rises and falls):
        return 2
    for n in range(1, degree):
        for i in range(degree - n):
            table[n, i] = table[n - 1, i + 1] - table[n - 1, i]
    count = 2
    for n in range(degree - 2, -1, -1):
        # `found` splits 0..1 at the roots of derivative n + 1; replace it with the roots of derivative n.
        previous, kept, low = evaluated(table[n], degree - 1 - n, 0.0, work)[0], 1, 0.0
        for i in range(1, count):
            high = found[i]
            height = evaluated(table[n], degree - 1 - n, high, work)[0]
            if (previous > 0.0 and height < 0.0) or (previous < 0.0 and height > 0.0):
                root = solved(table[n], degree - 1 - n, low, high, 0.0, work)
                if found[kept - 1] < root < 1.0:
                    found[kept] = root
                    kept += 1
            # A root at a place itself: it turns if the signs on both sides of it differ.
            if height != 0.0:
                previous = height
            low = high
        found[kept] = 1.0
        count = kept + 1
    return count


@kernel
def sample(field: Float32s, how: int, at: Float64s, memory: Scratch) -> float:
    """The field at a place in voxels; outside the box of the voxel centres, at the nearest place in it."""
    if how == NEAREST:
        return _at(field, math.floor(at[0] + 0.5), math.floor(at[1] + 0.5), math.floor(at[2] + 0.5))
    for k in range(3):
        memory.cell[k] = min(max(math.floor(at[k]), 0), field.shape[k] - 2)
        memory.ends[0, k] = memory.ends[1, k] = min(max(at[k] - memory.cell[k], 0.0), 1.0)
    along(field, how, memory)
    return memory.polynomial[0]
