"""Compiled kernels: rays walked through the cells of a volume, one after the other; see :mod:`.reference`.

Rays are in voxel coordinates, for the nearest voxel's filter half a voxel further, so that every cell begins at whole
numbers. Each cell's stretch is taken apart where the field turns (:func:`.reference_cells.extrema`); between these
places it is monotone. Rays whose far end is not beyond their near one, or is NaN, are not filled in.
"""

from __future__ import annotations

import math

import numpy as np

from pvfiblets.codec.jit import kernel

from ....support.array_types import Float32s, Float64s, Int64s
from .reference_cells import NEAREST, Scratch, along, enter, evaluated, extrema, leave, limits, sample, scratch, solved

SHORTEST = 1e-14  # part of its distance along a ray that a stretch takes at least to count


@kernel
def stretch(
    field: Float32s, how: int, origin: Float64s, direction: Float64s, a: float, b: float, memory: Scratch
) -> int:
    """Polynomial of the current cell from ``a`` to ``b`` mm along a ray; gives its degree."""
    for k in range(3):
        start = origin[k] - memory.cell[k]
        memory.ends[0, k] = min(max(start + a * direction[k], 0.0), 1.0)
        memory.ends[1, k] = min(max(start + b * direction[k], 0.0), 1.0)
    return along(field, how, memory)


@kernel
def step(field: Float32s, how: int, direction: Float64s, axis: int, cell: Int64s) -> bool:
    """Go on to the cell beyond a border; say whether there is one."""
    if axis < 0:
        return False
    cell[axis] += 1 if direction[axis] > 0.0 else -1
    return 0 <= cell[axis] <= field.shape[axis] - (1 if how == NEAREST else 2)


# ------------------------------------------------------------------------------------------------------- isosurfaces


@kernel
def _side(value: float, level: float, rounding: float) -> int:
    """1 above a level, -1 below it, and 0 at it, but for rounding."""
    return (value > level + rounding) - (value < level - rounding)


@kernel
def _crossed(state: int, before: int, after: int) -> int:
    """Whether a monotone function is at or above a level at its end, 1, or below it, -1."""
    # By the sides that its ends are on, and the one, 1 or -1, that it was on before, if any. A function that only
    # touches the level has been on one side all along; one that stays at it is at it.
    if after != 0:
        return after
    if before == 0:
        return 1
    return state if state != 0 else before


@kernel
def _next(
    degree: int, a: float, b: float, levels: Float64s, states: Int64s, only: int, rounding: float, memory: Scratch
) -> tuple[float, int]:
    """Which level the polynomial of a stretch crosses first from ``a`` to ``b``, and where."""
    # Between the two it is monotone. -1 for none. Takes the sides of all levels, or of `only` one, to `b`.
    start = evaluated(memory.polynomial, degree, a, memory.work)[0]
    end = evaluated(memory.polynomial, degree, b, memory.work)[0]
    where, which = math.inf, -1
    for k in range(len(levels)):
        if only < 0 or k == only:
            side = _crossed(states[k], _side(start, levels[k], rounding), _side(end, levels[k], rounding))
            if states[k] * side == -1:
                s = solved(memory.polynomial, degree, a, b, levels[k], memory.work)
                # Of several that a jump crosses at once, the one that a steep ramp would come to first.
                if s < where or (s == where and (levels[k] < levels[which]) == (side > 0)):
                    where, which = s, k
            states[k] = side
    return where, which


@kernel
def _open(low: float, high: float, levels: Float64s, only: int) -> bool:
    """Whether the levels that are looked for may be between two values."""
    found = False
    for k in range(len(levels)):
        found = found or ((only < 0 or k == only) and low <= levels[k] <= high)
    return found


@kernel
def _first_crossing(field: Float32s, how: int, origin: Float64s, direction: Float64s, near: float, far: float,
                    levels: Float64s, rounding: float, voxel: Int64s,
                    memory: Scratch) -> tuple[int, float, float]:  # fmt: skip
    """Give the level that is crossed first, its t, and t of its next crossing or the far end; fill in the voxel."""
    states = np.zeros(len(levels), np.int64)
    t, hit, level, started = near, math.nan, -1, False
    enter(field, how, origin, direction, t, memory.cell)
    while True:
        out, axis = leave(origin, direction, memory.cell, t)
        until = min(out, far)
        # What is shorter is rounding's, and would seem level.
        if until - t > SHORTEST * until:
            low, high = limits(field, how, memory.cell)
            # Nearest voxels jump past levels that no voxel has.
            if how == NEAREST or not started or _open(low, high, levels, level):
                degree = stretch(field, how, origin, direction, t, until, memory)
                if not started:
                    for k in range(len(levels)):
                        states[k] = _side(memory.polynomial[0], levels[k], rounding)
                    started = True
                for i in range(extrema(degree, memory) - 1):
                    a, b = memory.places[i], memory.places[i + 1]
                    s, which = _next(degree, a, b, levels, states, level, rounding, memory)
                    if which >= 0:
                        if level >= 0:
                            return level, hit, t + s * (until - t)
                        level, hit = which, t + s * (until - t)
                        for k in range(3):
                            voxel[k] = memory.cell[k]
        if out >= far or not step(field, how, direction, axis, memory.cell):
            return level, hit, far
        t = max(t, until)


@kernel
def first_crossings(field: Float32s, how: int, origins: Float64s, directions: Float64s, near: Float64s, far: Float64s,
                    levels: Float64s, rounding: float, t: Float64s, level: Int64s, chord: Float64s,
                    voxels: Int64s) -> None:  # fmt: skip
    """Where rays first cross one of several levels."""
    for i in range(len(t)):
        if near[i] < far[i]:
            found, at, again = _first_crossing(
                field, how, origins[i], directions[i], near[i], far[i], levels, rounding, voxels[i], scratch()
            )
            if found >= 0:
                level[i], t[i], chord[i] = found, at, again - at


# ----------------------------------------------------------------------------------------------------------- maxima


@kernel
def _greatest(field: Float32s, how: int, origin: Float64s, direction: Float64s, near: float, far: float, low: float,
              high: float, enough: float, fall: float, memory: Scratch) -> tuple[float, float]:  # fmt: skip
    """Give the greatest value and its t; see :func:`greatest`."""
    best, where = -math.inf, math.nan
    t = near
    enter(field, how, origin, direction, t, memory.cell)
    while True:
        out, axis = leave(origin, direction, memory.cell, t)
        until = min(out, far)
        if until > t and (best >= enough or limits(field, how, memory.cell)[1] > best):
            degree = stretch(field, how, origin, direction, t, until, memory)
            for i in range(extrema(degree, memory) - 1):
                a, b = memory.places[i], memory.places[i + 1]
                first = evaluated(memory.polynomial, degree, a, memory.work)[0]
                last = evaluated(memory.polynomial, degree, b, memory.work)[0]
                if min(first, last) > high:
                    continue
                for end in range(2):
                    s, value = (a, first) if end == 0 else (b, last)
                    if value > high:
                        s, value = solved(memory.polynomial, degree, a, b, high, memory.work), high
                    if value > best:
                        best, where = value, t + s * (until - t)
                    elif best >= enough and value < best - fall:
                        return best, where
        if out >= far or not step(field, how, direction, axis, memory.cell):
            break
        t = max(t, until)
    if best < low:
        return math.nan, math.nan
    return best, where


@kernel
def greatest(field: Float32s, how: int, origins: Float64s, directions: Float64s, near: Float64s, far: Float64s,
             low: float, high: float, enough: float, fall: float, value: Float64s, t: Float64s) -> None:  # fmt: skip
    """Greatest value along rays of those from ``low`` to ``high``, the first that is at least ``enough`` if any is."""
    for i in range(len(t)):
        if near[i] < far[i]:
            value[i], t[i] = _greatest(
                field, how, origins[i], directions[i], near[i], far[i], low, high, enough, fall, scratch()
            )


# ----------------------------------------------------------------------------------------------------------- samples


@kernel
def samples(field: Float32s, how: int, places: Float64s, values: Float64s) -> None:
    """The field at places ``(n, 3)`` float64 in voxels, into ``values`` (n,) float64."""
    for i in range(len(values)):
        values[i] = sample(field, how, places[i], scratch())


@kernel
def gradients(field: Float32s, how: int, places: Float64s, found: Float64s) -> None:
    """Central differences of the field at places ``(n, 3)`` float64 in voxels, into ``found`` (n, 3) float64."""
    # Over one voxel to either side, or to the edge of the box of the voxel centres if that is nearer.
    for i in range(len(found)):
        memory, at = scratch(), np.empty(3)
        for k in range(3):
            for axis in range(3):
                at[axis] = places[i, axis]
            if not math.isnan(at[k]):
                ahead, behind = min(at[k] + 1.0, field.shape[k] - 1.0), max(at[k] - 1.0, 0.0)
                at[k] = ahead
                difference = sample(field, how, at, memory)
                at[k] = behind
                found[i, k] = (difference - sample(field, how, at, memory)) / (ahead - behind)
