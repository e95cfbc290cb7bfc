"""Where rays meet tubes, in float64 and with no thought for the GPU: what the shaders are measured against.

Source: Russig, Gumhold and Salm, "GPU-based raycasting of Hermite spline tubes" (2020), section 3.2, equations 1 to 3.
In ray space the ray is the x-axis. A half of a segment is the quadratic ``p(t) = (x, y, z)`` with the radius ``r(t)``,
and the ray runs inside the sphere at ``t`` from ``h - sqrt(g)`` to ``h + sqrt(g)``::

    h(t) = x(t)        g(t) = r(t)^2 - y(t)^2 - z(t)^2        f(t) = h(t) - sqrt(g(t))

On each interval of 0..1 where ``g >= 0`` the spheres' stretches of the ray hang together: the ray enters at the least
``f`` (entry) and leaves at the greatest ``h + sqrt(g)`` (exit).

Nothing here is found by halving brackets of derivatives, as the paper and the shaders do it. Both extrema are roots of
one polynomial of degree 6, ``4 g h'^2 - g'^2``, and those are eigenvalues of its companion matrix; so are the extrema
and roots of ``g``, which bound the intervals. Four things keep that exact:

* Eigenvalues are only where Newton's method starts; it runs on ``r, y, z`` themselves, as the coefficients of ``g``
  have lost the digits of a tube that is thin for its length.
* Each interval is a problem of its own, moved to -1..1 and scaled along the ray and across it apart, so that a tube a
  million times longer than thick is as well posed as any.
* Leading coefficients may be 0: the polynomials' roots are sought in ``v``, ``u = (v + c) / (1 + c v)``, with the ``c``
  that keeps them farthest from infinity.
* Every place of an interval gives an upper bound of the entry. Places spread over it are tried beside the roots, and
  where one of them is better, the search goes on from there.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from .extrema import RAY, balanced, critical, intervals, least, moved, powers

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

MISS, ENTRY, EXIT, CAP = range(4)

_BLOCK = 1 << 13  # pairs of ray and half solved at a time: their working arrays stay in cache

_PAIRS = 1 << 21  # pairs whose bounding spheres are tried at a time


@dataclass(frozen=True, eq=False)
class Hits:
    """Hits of rays."""

    # `(n,)` float64 mm along the ray from its origin; NaN for a miss
    l: Array  # noqa: E741 - the paper's name for it
    t: Array  # `(n,)` float64, 0..1: whose sphere is met; of a cap, the sphere that holds it deepest. NaN for a miss.
    kind: Ints  # `(n,)` int64: `MISS` 0, `ENTRY` 1, `EXIT` 2 (the surface's inner side), `CAP` 3 (the inside, cut)


@dataclass(frozen=True, eq=False)
class Nearest(Hits):
    """The first hits of rays with many halves."""

    half: Ints  # `(n,)` int64 index of the half; -1 for a miss


def hits(
    controls: npt.ArrayLike,
    origins: npt.ArrayLike,
    directions: npt.ArrayLike,
    *,
    start: npt.ArrayLike = -np.inf,
    end: npt.ArrayLike = np.inf,
    capped: bool = False,
) -> Hits:
    """Meet each ray with one half of a segment."""
    # Of every interval of the curve that the ray runs inside of: its entry, if that is not before `start`; else, if the
    # ray is inside still at `start`, its exit, or with `capped` the cut at `start` itself. The nearest of these counts.
    #
    # Russig et al. 2020, section 3.2, "Intersection". Where a ray only touches, rounding decides.
    halves, origins, unit = _halves(controls), _vectors(origins, "origins"), _directions(directions)
    low, high = _limits(start, "start"), _limits(end, "end")
    n = np.broadcast_shapes(halves.shape[:1], origins.shape[:1], unit.shape[:1], low.shape, high.shape)[0]
    halves = np.broadcast_to(halves, (n, 3, 4))
    origins, unit = np.broadcast_to(origins, (n, 3)), np.broadcast_to(unit, (n, 3))
    low, high = np.broadcast_to(low, n), np.broadcast_to(high, n)
    found = Hits(np.full(n, np.nan), np.full(n, np.nan), np.zeros(n, np.int64))
    for first in range(0, n, _BLOCK):
        part = slice(first, first + _BLOCK)
        row, entry, entry_t, leave, leave_t = _stretches(halves[part], origins[part], unit[part])
        row += first
        kind = np.where(entry >= low[row], ENTRY, np.where(leave > low[row], CAP if capped else EXIT, MISS))
        place = np.choose(kind, [np.inf, entry, leave, low[row]])
        t = np.choose(kind, [np.nan, entry_t, leave_t, np.nan])
        kept = np.flatnonzero((kind != MISS) & (place <= high[row]))
        kept = kept[np.lexsort((place[kept], row[kept]))]
        kept = kept[np.diff(row[kept], prepend=-1) != 0]
        row = row[kept]
        found.l[row], found.t[row], found.kind[row] = place[kept], t[kept], kind[kept]
    cut = np.flatnonzero(found.kind == CAP)
    if len(cut):
        found.t[cut] = _deepest(halves[cut], origins[cut] + found.l[cut, None] * unit[cut])[1]
    return found


def nearest_hits(
    controls: npt.ArrayLike,
    origins: npt.ArrayLike,
    directions: npt.ArrayLike,
    *,
    start: npt.ArrayLike = -np.inf,
    end: npt.ArrayLike = np.inf,
    capped: bool = False,
) -> Nearest:
    """Meet each ray with every half, and keep the nearest hit."""
    halves, origins, unit = _halves(controls), _vectors(origins, "origins"), _directions(directions)
    low, high = _limits(start, "start"), _limits(end, "end")
    n = np.broadcast_shapes(origins.shape[:1], unit.shape[:1], low.shape, high.shape)[0]
    origins, unit = np.broadcast_to(origins, (n, 3)), np.broadcast_to(unit, (n, 3))
    low, high = np.broadcast_to(low, n), np.broadcast_to(high, n)
    found = Nearest(np.full(n, np.nan), np.full(n, np.nan), np.zeros(n, np.int64), np.full(n, -1))
    if not len(halves):
        return found
    centres = halves[:, :, :3].mean(axis=1)
    reach = (np.linalg.norm(halves[:, :, :3] - centres[:, None], axis=2) + halves[:, :, 3]).max(axis=1)
    rows = max(1, _PAIRS // len(halves))
    for first in range(0, n, rows):
        part = slice(first, first + rows)
        ray, half = _near(centres, reach, origins[part], unit[part], low[part], high[part])
        ray += first
        met = hits(halves[half], origins[ray], unit[ray], start=low[ray], end=high[ray], capped=capped)
        kept = np.flatnonzero(met.kind != MISS)
        kept = kept[np.lexsort((half[kept], met.l[kept], ray[kept]))]
        kept = kept[np.diff(ray[kept], prepend=-1) != 0]
        for name, values in (("l", met.l), ("t", met.t), ("kind", met.kind), ("half", half)):
            getattr(found, name)[ray[kept]] = values[kept]
    return found


def surface_distance(controls: npt.ArrayLike, points: npt.ArrayLike) -> Array:
    """Return distances of points from the surface of one half each: the least ``|p - p(t)| - r(t)``."""
    halves, places = _halves(controls), _vectors(points, "points")
    n = np.broadcast_shapes(halves.shape[:1], places.shape[:1])[0]
    halves, places = np.broadcast_to(halves, (n, 3, 4)), np.broadcast_to(places, (n, 3))
    parts = [_deepest(halves[k : k + _BLOCK], places[k : k + _BLOCK])[0] for k in range(0, max(n, 1), _BLOCK)]
    return np.concatenate(parts)


# --------------------------------------------------------------------------------------------------- the problems


def _near(centres: Array, reach: Array, origins: Array, unit: Array, low: Array, high: Array) -> tuple[Ints, Ints]:
    """Return the pairs of ray and half whose bounding sphere the ray comes near between its limits."""
    middle = centres.mean(axis=0)
    centres, origins = centres - middle, origins - middle
    along = unit @ centres.T - np.einsum("ni,ni->n", unit, origins)[:, None]
    squares = np.einsum("mi,mi->m", centres, centres), np.einsum("ni,ni->n", origins, origins)
    away = squares[0] + squares[1][:, None] - 2.0 * (origins @ centres.T) - along**2
    # Squares of large coordinates cancel: the loss must not cost a hit.
    slack = 1e-12 * (squares[0].max() + squares[1].max() + (reach**2).max())
    close = away <= (reach**2 + slack)
    within = reach + np.sqrt(slack)
    close &= (along + within >= low[:, None]) & (along - within <= high[:, None])
    ray, half = np.nonzero(close)
    return ray, half


def _stretches(halves: Array, origins: Array, unit: Array) -> tuple[Ints, Array, Array, Array, Array]:
    """Return of each stretch of a ray in its tube: the row, and ``l`` and ``t`` of entry and exit."""
    places = halves[:, :, :3]
    centre = 0.5 * places.min(axis=1) + 0.5 * places.max(axis=1)
    local = places - centre[:, None]
    size = np.frexp(np.maximum(np.abs(local).max(axis=(1, 2)), halves[:, :, 3].max(axis=1)))[1]
    scaled = np.ldexp(np.concatenate([halves[:, :, 3:], local], axis=2), -size[:, None, None])
    away = centre - origins
    middle = np.zeros(len(halves))
    for _ in range(2):  # the second time takes off what rounding left of the first
        part = np.einsum("ni,ni->n", away, unit)
        middle += part
        away = away - part[:, None] * unit
    with np.errstate(over="ignore"):
        away = np.ldexp(away, -size[:, None])
    bound = (np.linalg.norm(scaled[:, :, 1:], axis=2) + scaled[:, :, 0]).max(axis=1) * (1.0 + 1e-12)
    rows = np.flatnonzero(np.abs(away).max(axis=1) <= bound)
    scaled, away, unit = scaled[rows], away[rows], unit[rows]
    across = _across(unit)
    along, aside = scaled[:, :, 1:] @ unit[:, :, None], (scaled[:, :, 1:] + away[:, None]) @ across
    curves = powers(np.concatenate([along, scaled[:, :, :1], aside], axis=2))
    h, w = curves[:, 0], curves[:, 1:]
    # Only its sign bounds an interval: scaled to the largest of r, y, z, the squares of a thin tube do not vanish.
    row, low, high = intervals(balanced(w))
    h, w = moved(h[row], low, high), moved(w[row], low, high)
    starts = critical(h, w, RAY)
    entry, entry_v = least(h, w, RAY, -1.0, starts)
    leave, leave_v = least(-h, w, RAY, -1.0, starts)
    to_t = 0.25 * (high - low), 0.5 + 0.25 * (high + low)
    at, row_size = middle[rows][row], size[rows][row]
    return (
        rows[row],
        at + np.ldexp(entry, row_size),
        np.clip(to_t[1] + to_t[0] * entry_v, 0.0, 1.0),
        at + np.ldexp(-leave, row_size),
        np.clip(to_t[1] + to_t[0] * leave_v, 0.0, 1.0),
    )


def _deepest(halves: Array, points: Array) -> tuple[Array, Array]:
    """Return the least ``|p - p(t)| - r(t)`` and its ``t``."""
    local = np.concatenate([halves[:, :, 3:], halves[:, :, :3] - points[:, None]], axis=2)
    size = np.frexp(np.abs(local).max(axis=(1, 2)))[1]
    curves = powers(np.ldexp(local, -size[:, None, None]))
    h, w = -curves[:, 0], curves[:, 1:]
    found, u = np.full(len(h), np.inf), np.zeros(len(h))
    for reach in (1.0, 2.0**-7, 2.0**-14):
        # Roots that lie close together, as about a cusp, come apart only seen from near.
        low, high = np.maximum(u - reach, -1.0), np.minimum(u + reach, 1.0)
        near, part = moved(h, low, high), moved(w, low, high)
        value, v = least(near, part, np.ones(3), 1.0, critical(near, part, np.ones(3)))
        u = np.where(value < found, 0.5 * (high + low) + 0.5 * (high - low) * v, u)
        found = np.minimum(value, found)
    return np.ldexp(found, size), np.clip(0.5 + 0.5 * u, 0.0, 1.0)


# ------------------------------------------------------------------------------------------------------- helpers


def _across(unit: Array) -> Array:
    """Return (n, 3, 2): as columns, two unit vectors at right angles to each other and to each of `unit`."""
    least = np.zeros_like(unit)
    np.put_along_axis(least, np.abs(unit).argmin(axis=1)[:, None], 1.0, axis=1)
    first = np.cross(unit, least)
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    return np.stack([first, np.cross(unit, first)], axis=2)


def _halves(controls: npt.ArrayLike) -> Array:
    given = np.asarray(controls, np.float64)
    if given.shape == (3, 4):
        given = given[None]
    if given.ndim != 3 or given.shape[1:] != (3, 4):
        raise ValueError(
            f"controls have the shape {given.shape}, expected (n, 3, 4): x, y, z, r of each half's three points"
        )
    _check_finite(given, "controls")
    if given.size and given[:, :, 3].min() < 0.0:
        bad = int(np.flatnonzero((given[:, :, 3] < 0.0).any(axis=1))[0])
        radii = given[bad, :, 3].tolist()
        raise ValueError(f"controls {bad} have the radii {radii} mm, expected 0 or more; raise them to 0")
    return given


def _vectors(vectors: npt.ArrayLike, name: str) -> Array:
    given = np.asarray(vectors, np.float64)
    if given.shape == (3,):
        given = given[None]
    if given.ndim != 2 or given.shape[1] != 3:
        raise ValueError(f"{name} have the shape {given.shape}, expected (n, 3), or (3,) for all")
    _check_finite(given, name)
    return given


def _directions(directions: npt.ArrayLike) -> Array:
    given = _vectors(directions, "directions")
    zero = np.flatnonzero(~given.any(axis=1))
    if len(zero):
        raise ValueError(f"directions {zero[0]} is 0, expected a vector of any other length")
    given = np.ldexp(given, -np.frexp(np.abs(given).max(axis=1))[1][:, None])
    return given / np.linalg.norm(given, axis=1, keepdims=True)


def _limits(limit: npt.ArrayLike, name: str) -> Array:
    given = np.atleast_1d(np.asarray(limit, np.float64))
    if given.ndim != 1 or np.isnan(given).any():
        raise ValueError(f"{name} is {limit!r}, expected one number of mm, or (n,) of them, none NaN")
    return given


def _check_finite(given: Array, name: str) -> None:
    wrong = np.flatnonzero(~np.isfinite(given).all(axis=tuple(range(1, given.ndim))))
    if len(wrong):
        raise ValueError(f"{name} {wrong[0]} is {given[wrong[0]].tolist()}, expected finite numbers")
