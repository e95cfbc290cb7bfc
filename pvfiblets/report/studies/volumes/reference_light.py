"""Compiled kernels: how light comes through the cells of a volume along a ray; see :mod:`.reference`.

Each stretch of a ray on which the field is monotone (:mod:`.reference_cells`) is taken apart once more where the field
passes an entry of the transfer function's table. In between extinction and colour have no kink, and Gauss quadrature of
high order, halved where it has to be, finds

    tau(s) = int kappa ds,        I = int kappa c exp(-tau) ds

A transfer function is handed over as the values of its entries, `knots` (m,), and `pieces` (m + 1, 10): before, between
and after them, each from one value to another, and RGBA there and there. Lengths count in its unit.
"""

from __future__ import annotations

import math

import numpy as np

from pvfiblets.codec.jit import kernel

from ....support.array_types import Float32s, Float64s
from .reference_cells import Scratch, enter, evaluated, extrema, leave, limits, scratch, solved
from .reference_kernels import step, stretch

DEEPEST = 60  # halvings of a piece after which its ends are neighbouring floats

ROUNDING = 1e-15  # of a part; no halving makes it less


@kernel
def _before(knots: Float64s, value: float, itself: bool) -> int:
    """How many knots lie below a value, or at it if `itself`."""
    low, high = 0, len(knots)
    while low < high:
        middle = (low + high) // 2
        if knots[middle] < value or (itself and knots[middle] == value):
            low = middle + 1
        else:
            high = middle
    return low


@kernel
def _depth(alpha: float, cap: float) -> float:
    """Optical depth of one unit."""
    return min(-math.log1p(-alpha), cap) if alpha < 1.0 else cap


@kernel
def _quadrature(
    memory: Scratch, degree: int, length: float, piece: Float64s, rule: tuple[Float64s, ...], cap: float, part: Float64s
) -> None:
    """Optical depth and colour of a part of a stretch of a length, by one Gauss rule."""
    # `part` (7,) is where the part begins and ends, 0 to 1. The others are filled in: the optical depth, RGB, and the
    # opacity as the rule has it, which is that of the optical depth only if the nodes lie closely enough.
    nodes, weights, sums, found = rule
    size = (part[1] - part[0]) * length
    for i in range(len(nodes)):
        value = evaluated(memory.polynomial, degree, part[0] + (part[1] - part[0]) * nodes[i], memory.work)[0]
        share = min(max((value - piece[0]) / (piece[1] - piece[0]), 0.0), 1.0)
        found[i, 0] = _depth(piece[5] + (piece[9] - piece[5]) * share, cap)
        for c in range(3):
            found[i, 1 + c] = piece[2 + c] + (piece[6 + c] - piece[2 + c]) * share
    for k in range(2, 7):
        part[k] = 0.0
    for i in range(len(nodes)):
        before = 0.0
        for j in range(len(nodes)):
            before += sums[i, j] * found[j, 0]
        weight = size * weights[i] * found[i, 0]
        part[2] += weight
        weight *= math.exp(-size * before)
        part[6] += weight
        for c in range(3):
            part[3 + c] += weight * found[i, 1 + c]


@kernel
def _integrate(memory: Scratch, degree: int, a: float, b: float, length: float, piece: Float64s,
               rule: tuple[Float64s, ...], cap: float, tolerance: float, stack: Float64s,
               light: Float64s) -> None:  # fmt: skip
    """Add the light of a piece of a stretch without kinks: `light` (4,) is RGB and transparency so far."""
    # What both halves of a part give together is kept if the part itself gives the same, else they are parts.
    # Rows of the stack are parts as `_quadrature` has them; the last two are the halves of the uppermost.
    halves, top, known = DEEPEST + 1, 0, False
    stack[0, 0], stack[0, 1] = a, b
    while top >= 0:
        part, left, right = stack[top], stack[halves], stack[halves + 1]
        middle = 0.5 * (part[0] + part[1])
        left[0], left[1], right[0], right[1] = part[0], middle, middle, part[1]
        for row in (halves, halves + 1, top):
            if row != top or not known:
                _quadrature(memory, degree, length, piece, rule, cap, stack[row])
        half, whole = math.exp(-left[2]), math.exp(-left[2] - right[2])
        error = abs(math.exp(-part[2]) - whole)
        error = max(error, abs(left[6] + half * right[6] - 1.0 + whole))
        for c in range(3, 6):
            error = max(error, abs(part[c] - left[c] - half * right[c]))
        allowed = max(tolerance * (part[1] - part[0]), ROUNDING)
        known = True
        if light[3] * error <= allowed or top == DEEPEST or not part[0] < middle < part[1]:
            for c in range(3):
                light[c] += light[3] * (left[3 + c] + half * right[3 + c])
            light[3] *= whole
            top -= 1
        else:
            # The front half comes first.
            for k in range(7):
                stack[top, k], stack[top + 1, k] = right[k], left[k]
            top += 1


@kernel
def _constant(piece: Float64s, value: float, length: float, cap: float, light: Float64s) -> None:
    """The same where the value, or all that depends on it, does not change."""
    share = 0.0
    if piece[1] > piece[0]:
        share = min(max((value - piece[0]) / (piece[1] - piece[0]), 0.0), 1.0)
    depth = length * _depth(piece[5] + (piece[9] - piece[5]) * share, cap)
    for c in range(3):
        light[c] -= math.expm1(-depth) * light[3] * (piece[2 + c] + (piece[6 + c] - piece[2 + c]) * share)
    light[3] *= math.exp(-depth)


@kernel
def _through(memory: Scratch, degree: int, a: float, b: float, length: float, knots: Float64s, pieces: Float64s,
             rule: tuple[Float64s, ...], cap: float, tolerance: float, stack: Float64s,
             light: Float64s) -> None:  # fmt: skip
    """Add the light of a stretch from ``a`` to ``b``, between which the field is monotone."""
    first = evaluated(memory.polynomial, degree, a, memory.work)[0]
    last = evaluated(memory.polynomial, degree, b, memory.work)[0]
    if first == last:
        _constant(pieces[_before(knots, first, True)], first, (b - a) * length, cap, light)
        return
    rises = last > first
    j, end = _before(knots, first, rises), _before(knots, last, not rises)
    while True:
        s = b if j == end else solved(memory.polynomial, degree, a, b, knots[j if rises else j - 1], memory.work)
        piece = pieces[j]
        if s > a and (piece[5] > 0.0 or piece[9] > 0.0):
            same = True
            for c in range(2, 6):
                same = same and piece[c] == piece[c + 4]
            if same:
                _constant(piece, piece[0], (s - a) * length, cap, light)
            else:
                _integrate(memory, degree, a, s, length, piece, rule, cap, tolerance, stack, light)
        if j == end:
            return
        a, j = s, j + (1 if rises else -1)


@kernel
def _seen(low: float, high: float, knots: Float64s, pieces: Float64s) -> bool:
    """Whether anything from one value to another has opacity."""
    for j in range(_before(knots, low, False), _before(knots, high, True) + 1):
        if pieces[j, 5] > 0.0 or pieces[j, 9] > 0.0:
            return True
    return False


@kernel
def _integral(field: Float32s, how: int, origin: Float64s, direction: Float64s, near: float, far: float,
              knots: Float64s, pieces: Float64s, unit: float, rule: tuple[Float64s, ...], cap: float, tolerance: float,
              memory: Scratch, stack: Float64s, light: Float64s) -> None:  # fmt: skip
    """Add the light of a ray's cells until it ends, or the rest changes nothing any more."""
    t = near
    enter(field, how, origin, direction, t, memory.cell)
    while True:
        out, axis = leave(origin, direction, memory.cell, t)
        until = min(out, far)
        if until > t:
            low, high = limits(field, how, memory.cell)
            if _seen(low, high, knots, pieces):
                degree = stretch(field, how, origin, direction, t, until, memory)
                places = extrema(degree, memory)
                # Of the tolerance, the cell has the share that it has of the ray.
                fine = tolerance * (until - t) / (far - near)
                for i in range(places - 1):
                    _through(
                        memory, degree, memory.places[i], memory.places[i + 1], (until - t) / unit, knots, pieces, rule,
                        cap, fine, stack, light,
                    )  # fmt: skip
        if light[3] < 1e-3 * tolerance or out >= far or not step(field, how, direction, axis, memory.cell):
            return
        t = until if until > t else t


@kernel
def integrals(field: Float32s, how: int, origins: Float64s, directions: Float64s, near: Float64s, far: Float64s,
              knots: Float64s, pieces: Float64s, unit: float, nodes: Float64s, weights: Float64s, sums: Float64s,
              cap: float, tolerance: float, light: Float64s) -> None:  # fmt: skip
    """Light that comes along rays."""
    for i in range(len(light)):
        if near[i] < far[i]:
            rule = nodes, weights, sums, np.empty((len(nodes), 4))
            _integral(
                field, how, origins[i], directions[i], near[i], far[i], knots, pieces, unit, rule, cap, tolerance,
                scratch(), np.empty((DEEPEST + 3, 7)), light[i],
            )  # fmt: skip
