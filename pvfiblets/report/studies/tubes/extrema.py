"""Extrema of ``h + sigma sqrt(g)`` on -1..1, of many problems at once: what :mod:`.reference` rests on.

``h`` is a quadratic, ``(n, 3)`` coefficients over ``1, u, u^2``. ``g`` is a sum of squares of quadratics, each with a
sign: ``w``, ``(n, k, 3)``, and ``signs``, ``(k,)``. For a ray it is ``r^2 - y^2 - z^2``, for the distance of a point
``x^2 + y^2 + z^2``.

Where the derivative is 0, ``2 h' sqrt(g) = -sigma g'``, hence ``4 g h'^2 = g'^2``: a polynomial of degree 6 whose roots
are the eigenvalues of its companion matrix. How that keeps its digits, :mod:`.reference` tells.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

RAY = np.array([1.0, -1.0, -1.0])  # signs of the squares of r, y, z in the `g` of a ray

_SHIFTS = (0.0, 0.4, -0.3)
_SPREAD = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 17)  # g often falls to 0 as 1 - u^2 does: u = sin(angle) spreads well
_GOLDEN = 0.5 * (np.sqrt(5.0) - 1.0)


def intervals(w: Array) -> tuple[Ints, Array, Array]:
    """Return row, start and end in -1..1 of all intervals on which ``g >= 0``, of (n, 3, 3) powers of r, y, z."""
    g = _form(w, RAY)
    turns = _roots(g[:, 1:] * np.arange(1.0, 5.0))
    for _ in range(3):
        _, slope, bend = _jet(w, RAY, turns)
        turns = np.clip(turns - _ratio(slope, bend), -1.0, 1.0)
    spread = np.broadcast_to(np.sin(_SPREAD[::2]), (len(w), 9))
    places = np.concatenate([spread, turns], axis=1)
    rows = np.flatnonzero((_square(w, RAY, places) >= 0.0).any(axis=1))
    w = w[rows]
    places = np.sort(np.concatenate([places[rows], np.clip(_roots(g[rows]), -1.0, 1.0)], axis=1), axis=1)
    inside = _square(w, RAY, places) >= 0.0
    rises, falls = inside[:, 1:] & ~inside[:, :-1], inside[:, :-1] & ~inside[:, 1:]
    # Both are in the order of rows and places, so that the k-th start belongs to the k-th end.
    row, first = np.nonzero(np.concatenate([inside[:, :1], rises], axis=1))
    last = np.nonzero(np.concatenate([falls, inside[:, -1:]], axis=1))[1]
    low, high = np.full(len(row), -1.0), np.full(len(row), 1.0)
    for ends, column, step in ((low, first, -1), (high, last, 1)):
        cut = np.flatnonzero(column > 0 if step < 0 else column < places.shape[1] - 1)
        r, c = row[cut], column[cut]
        ends[cut] = _crossing(w[r], places[r, c + step], places[r, c])
    return rows[row], low, high


def _crossing(w: Array, outside: Array, inside: Array) -> Array:
    """Return where ``g`` is 0 between two places with none of its extrema between them, by Newton's method."""
    ends = _square(w, RAY, np.stack([outside, inside], axis=1))
    u = np.where(-ends[:, 0] < ends[:, 1], outside, inside)
    left = np.arange(len(u))
    outside, inside = outside.copy(), inside.copy()
    for _ in range(100):
        value, slope, _ = (found[:, 0] for found in _jet(w[left], RAY, u[left, None]))
        held = value >= 0.0
        inside[left[held]] = u[left[held]]
        outside[left[~held]] = u[left[~held]]
        a, b = outside[left], inside[left]
        target = u[left] - _ratio(value, slope)
        # A double root makes a step that is none; halving finds it, too.
        target = np.where((target - a) * (target - b) <= 0.0, target, 0.5 * (a + b))
        moved = np.abs(target - u[left])
        u[left] = target
        left = left[(moved > 2e-16) & (np.abs(a - b) > 2e-16)]
        if not len(left):
            break
    return u


def critical(h: Array, w: Array, signs: Array) -> Array:
    """Return (n, 6) places in -1..1: real parts of the roots of ``4 g h'^2 - g'^2``."""
    along, across = _exponent(h[:, 1:]), _exponent(w)
    both = np.maximum(along, across)[:, None]
    slope = np.ldexp(h[:, 1:] * (1.0, 2.0), -both)
    g = _form(balanced(w), signs)
    rise = np.ldexp(g[:, 1:] * np.arange(1.0, 5.0), across[:, None] - both)
    return np.clip(_roots(4.0 * _product(g, _product(slope, slope)) - _product(rise, rise)), -1.0, 1.0)


def least(h: Array, w: Array, signs: Array, sigma: float, starts: Array) -> tuple[Array, Array]:
    """Return the least ``h + sigma sqrt(g)`` on -1..1 and its place, sought at starts, at both ends and all over."""
    size = np.frexp(np.maximum(np.abs(h[:, 1:]).max(axis=1), np.abs(w).max(axis=(1, 2))))[1]
    offset, rows = h[:, 0], np.arange(len(h))
    h, w = np.ldexp(h * (0.0, 1.0, 1.0), -size[:, None]), np.ldexp(w, -size[:, None, None])
    starts = np.concatenate([starts, np.broadcast_to([-1.0, 1.0], (len(h), 2))], axis=1)
    u, best = _polished(h, w, signs, sigma, starts[rows, _value(h, w, signs, sigma, starts).argmin(axis=1)])
    spread = np.broadcast_to(np.sin(_SPREAD), (len(h), len(_SPREAD)))
    tried = _value(h, w, signs, sigma, spread)
    pick = tried.argmin(axis=1)
    missed = np.flatnonzero(tried[rows, pick] < best - 1e-14)
    second, there = _polished(h, w, signs, sigma, spread[rows, pick])
    u, best = np.where(there < best - 1e-15, second, u), np.minimum(there, best)
    # No root led there, so that Newton's method may not have either: the sections do, more slowly.
    if len(missed):
        near = _golden(h[missed], w[missed], signs, sigma, _SPREAD[pick[missed]])
        near, there = _polished(h[missed], w[missed], signs, sigma, near)
        u[missed] = np.where(there < best[missed], near, u[missed])
        best[missed] = np.minimum(there, best[missed])
    return offset + np.ldexp(best, size), u


def _polished(h: Array, w: Array, signs: Array, sigma: float, u: Array) -> tuple[Array, Array]:
    """Return better places of an extremum of ``h + sigma sqrt(g)``, and the values there, by Newton's method."""
    best = _value(h, w, signs, sigma, u[:, None])[:, 0]
    for _ in range(4):
        value, rise, bend = (found[:, 0] for found in _jet(w, signs, u[:, None]))
        root = np.sqrt(np.maximum(value, 0.0))
        slope = h[:, 1] + 2.0 * h[:, 2] * u
        # The derivative times 2 sqrt(g), which is finite where g is 0.
        change = 4.0 * h[:, 2] * root + slope * _ratio(rise, root) + sigma * bend
        target = np.clip(u - _ratio(2.0 * slope * root + sigma * rise, change), -1.0, 1.0)
        there = _value(h, w, signs, sigma, target[:, None])[:, 0]
        # An extremum is flat: a step may seem to lose what only rounding makes of it.
        kept = there <= best + 1e-15
        u, best = np.where(kept, target, u), np.where(kept, np.minimum(there, best), best)
    return u, best


def _golden(h: Array, w: Array, signs: Array, sigma: float, angle: Array) -> Array:
    """Return the place of the least ``h + sigma sqrt(g)`` about an angle of the spread, by golden sections."""
    step = _SPREAD[1] - _SPREAD[0]
    low, high = np.maximum(angle - step, _SPREAD[0]), np.minimum(angle + step, _SPREAD[-1])
    for _ in range(48):
        inner = np.stack([high - _GOLDEN * (high - low), low + _GOLDEN * (high - low)], axis=1)
        value = _value(h, w, signs, sigma, np.sin(inner))
        left = value[:, 0] <= value[:, 1]
        low, high = np.where(left, low, inner[:, 0]), np.where(left, inner[:, 1], high)
    places = np.sin(np.stack([angle, 0.5 * (low + high)], axis=1))
    pick = _value(h, w, signs, sigma, places).argmin(axis=1)
    found: Array = places[np.arange(len(places)), pick]
    return found


# ---------------------------------------------------------------------------------------------------- polynomials


def powers(controls: Array) -> Array:
    """Return (n, d, 3) coefficients over ``1, u, u^2``, ``u = 2 t - 1``, of (n, 3, d) control points."""
    first, second, third = controls[:, 0], controls[:, 1], controls[:, 2]
    ends = 0.25 * (first + third)
    return np.stack([ends + 0.5 * second, 0.5 * (third - first), ends - 0.5 * second], axis=-1)


def moved(curves: Array, low: Array, high: Array) -> Array:
    """Return coefficients over -1..1 of what curves, (n, ..., 3), are from low to high."""
    shape = (-1,) + (1,) * (curves.ndim - 2)
    middle, half = (0.5 * (low + high)).reshape(shape), (0.5 * (high - low)).reshape(shape)
    a, b, c = curves[..., 0], curves[..., 1], curves[..., 2]
    return np.stack([a + (b + c * middle) * middle, (b + 2.0 * c * middle) * half, c * half**2], axis=-1)


def _exponent(values: Array) -> npt.NDArray[Any]:
    """Return (n,) exponents of 2 of the largest values; of zeros, less than any."""
    largest = np.abs(values).max(axis=tuple(range(1, values.ndim)))
    return np.where(largest > 0.0, np.frexp(largest)[1], -2000)


def balanced(w: Array) -> Array:
    """Return rows scaled by powers of 2 to numbers of about 1."""
    found: Array = np.ldexp(w, -_exponent(w)[:, None, None])
    return found


def _product(a: Array, b: Array) -> Array:
    """Return coefficients of products of polynomials, row by row."""
    found = np.zeros((len(a), a.shape[1] + b.shape[1] - 1))
    for k in range(a.shape[1]):
        found[:, k : k + b.shape[1]] += a[:, k, None] * b
    return found


def _form(w: Array, signs: Array) -> Array:
    """Return (n, 5) coefficients of ``g``, the sum of signs times squares."""
    return sum((sign * _product(w[:, k], w[:, k]) for k, sign in enumerate(signs)), np.zeros((len(w), 5)))


def _jet(w: Array, signs: Array, u: Array) -> tuple[Array, Array, Array]:
    """Return (n, k) each: ``g``, ``g'`` and ``g''`` at (n, k) places, from the squared factors, not their sum."""
    value, slope, bend = np.zeros(u.shape), np.zeros(u.shape), np.zeros(u.shape)
    for k, sign in enumerate(signs):
        a, b, c = w[:, k, 0, None], w[:, k, 1, None], w[:, k, 2, None]
        at, rise = a + (b + c * u) * u, b + 2.0 * c * u
        value += sign * at**2
        slope += 2.0 * sign * at * rise
        bend += 2.0 * sign * (rise**2 + 2.0 * c * at)
    return value, slope, bend


def _square(w: Array, signs: Array, u: Array) -> Array:
    """Return (n, k) ``g`` at (n, k) places."""
    found = np.zeros(u.shape)
    for k, sign in enumerate(signs):
        found += sign * (w[:, k, 0, None] + (w[:, k, 1, None] + w[:, k, 2, None] * u) * u) ** 2
    return found


def _value(h: Array, w: Array, signs: Array, sigma: float, u: Array) -> Array:
    """Return (n, k) ``h + sigma sqrt(g)``; a ``g`` that rounding makes negative at an interval's end counts as 0."""
    along = h[:, 0, None] + (h[:, 1, None] + h[:, 2, None] * u) * u
    found: Array = along + sigma * np.sqrt(np.maximum(_square(w, signs, u), 0.0))
    return found


def _ratio(a: Array, b: Array) -> Array:
    """Return ``a / b``, and 0 where ``b`` is 0."""
    with np.errstate(over="ignore"):
        return np.divide(a, b, out=np.zeros(np.shape(a)), where=b != 0.0)


def _shift(degree: int, c: float) -> Array:
    """Return the matrix from coefficients in ``u`` to coefficients in ``v`` of ``(1 + c v)^degree p(u)``."""
    found = np.zeros((degree + 1, degree + 1))
    for k in range(degree + 1):
        row = np.ones(1)
        for factor in [(c, 1.0)] * k + [(1.0, c)] * (degree - k):
            row = np.convolve(row, factor)
        found[k] = row
    return found


def _roots(coefficients: Array) -> Array:
    """Return (n, degree) real parts of the roots of polynomials, given by rising powers; 2 for roots at infinity."""
    n, degree = coefficients.shape[0], coefficients.shape[1] - 1
    largest = np.abs(coefficients).max(axis=1, initial=0.0, keepdims=True)
    scaled = coefficients / np.where(largest > 0.0, largest, 1.0)
    ways = np.stack([scaled @ _shift(degree, c) for c in _SHIFTS])
    lead = np.abs(ways[:, :, -1]) / np.maximum(np.abs(ways).max(axis=2), 1e-300)
    best = lead.argmax(axis=0)
    chosen, c = ways[best, np.arange(n)], np.array(_SHIFTS)[best]
    top = chosen[:, -1]
    # Only of a polynomial that is 0 throughout, or has roots at all three infinities, is less than this left.
    top = np.where(np.abs(top) < 1e-14, 1e-14, top)
    companion = np.zeros((n, degree, degree))
    companion[:, np.arange(1, degree), np.arange(degree - 1)] = 1.0
    companion[:, :, -1] = -chosen[:, :-1] / top[:, None]
    v = np.linalg.eigvals(companion)
    below = 1.0 + c[:, None] * v
    far = np.abs(below) < 1e-12
    found: Array = np.where(far, 2.0, ((v + c[:, None]) / np.where(far, 1.0, below)).real)
    return found
