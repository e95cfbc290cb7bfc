"""Positions of accumulation samples in a pixel.

A pixel's colour is the mean over its square: a box filter one pixel wide, as multisampling has it. It is estimated by
the mean of the pictures at n places p_i of that square. The effect on edges decides how good places are. The
share of the square U on one side of a straight edge is estimated by the share of the places there; the squared error of
that, averaged over all straight lines that cut the square, is by Crofton's formula (the lines between two points are as
many as their distance) proportional to the *energy distance* of the places and the square:

    E = 2 mean |p_i - u| - mean |p_i - p_j| - mean |u - u'|,    u, u' uniform in U.

`sample_positions` descends this from points of a Kronecker sequence. No direction of edges is preferred, as a regular
grid prefers diagonal ones.

Sources: Santaló, "Integral geometry and geometric probability" (1976), section 3.2 (Crofton's formula); Székely and
Rizzo, "Energy statistics" (2013).
"""

from __future__ import annotations

from functools import cache

import numpy as np
import numpy.typing as npt

MOST = 256  # samples: with 256, the error is below one level of eight bits at nearly all edges

CENTRED = 8  # samples from which on one of them is the pixel's middle: fewer would be a worse picture by it

STEPS = 120
GOLDEN = (5.0**0.5 - 1.0) / 2.0
WITHIN = 0.5214054331647207  # mean distance of two points of a unit square

Array = npt.NDArray[np.float64]


@cache
def sample_positions(n: int) -> tuple[tuple[float, float], ...]:
    """Return places of samples, in an order in which the first few are good ones, too."""
    if not 1 <= n <= MOST:
        raise ValueError(f"the number of samples is {n!r}; give one from 1 to {MOST}")
    i = np.arange(n)
    points = np.column_stack([(i + 0.5) / n, ((i - 0.5 * (n - 1)) * GOLDEN + 0.5) % 1.0]) - 0.5
    fixed = int(np.argmin((points**2).sum(axis=1))) if n >= CENTRED else -1
    if fixed >= 0:
        points[fixed] = 0.0
    for step in range(STEPS):
        downhill = _pull(points)
        if fixed >= 0:
            downhill[fixed] = 0.0
        points = np.clip(points + 0.5 * (1.0 - step / STEPS) * downhill, -0.5, 0.5)
    middle = [] if fixed < 0 else [(0.0, 0.0)]
    return tuple(_ordered(points if fixed < 0 else np.delete(points, fixed, axis=0)) + middle)


def sample_squares(side: int) -> tuple[tuple[int, int], ...]:
    """Return column and row of each of side² samples in a grid of side x side squares, one sample in each square."""
    places = np.array(sample_positions(side * side))
    rows = np.argsort(places[:, 1], kind="stable").reshape(side, side)
    rows = np.take_along_axis(rows, np.argsort(places[rows, 0], axis=1, kind="stable"), axis=1)
    return tuple((int(at) % side, int(at) // side) for at in np.argsort(rows.ravel()))


def energy_distance(points: npt.ArrayLike) -> float:
    """Return the mean squared error that points make of edges, up to a factor; 0 for the whole square."""
    places = np.asarray(points, np.float64)
    apart = np.linalg.norm(places[:, None] - places, axis=-1)
    return float(2.0 * _to_square(places).mean() - apart.mean() - WITHIN)


def _pull(points: Array) -> Array:
    """Return the way down of n E / 2 at each of n points, (n, 2)."""
    apart = points[:, None] - points
    lengths = np.linalg.norm(apart, axis=-1)
    np.fill_diagonal(lengths, 1.0)
    away = (apart / lengths[..., None]).sum(axis=1) / len(points)
    pulled: Array = away - _to_square_gradient(points)
    return pulled


def _corners(points: Array) -> tuple[Array, Array, Array]:
    """Return ways to the square's corners (u, v), and the sign that each has in an integral over the square."""
    ends = np.array([0.5, -0.5])
    u, v = (points[:, axis, None, None] + np.meshgrid(ends, ends, indexing="ij")[axis] for axis in (0, 1))
    return u, v, np.array([[1.0, -1.0], [-1.0, 1.0]])


def _to_square(points: Array) -> Array:
    """Return the mean distance of each point to all of the square: G with G_uv = |(u, v)|, between the corners."""
    u, v, sign = _corners(points)
    long_u, long_v = (np.maximum(np.abs(side), 1e-12) for side in (u, v))
    g = 2.0 * u * v * np.hypot(u, v) + u**3 * np.arcsinh(v / long_u) + v**3 * np.arcsinh(u / long_v)
    total: Array = (sign * g).sum(axis=(1, 2)) / 6.0
    return total


def _to_square_gradient(points: Array) -> Array:
    """Return the gradient of `_to_square`, (n, 2)."""
    u, v, sign = _corners(points)
    parts = []
    for a, b in ((u, v), (v, u)):
        g = b * np.hypot(a, b) + a**2 * np.arcsinh(b / np.maximum(np.abs(a), 1e-12))
        parts.append((sign * g).sum(axis=(1, 2)) / 2.0)
    return np.stack(parts, axis=1)


def _ordered(points: Array) -> list[tuple[float, float]]:
    """Return points ordered so that each has the least energy distance together with its predecessors."""
    to_square = _to_square(points)
    to_chosen = np.zeros(len(points))
    left = np.ones(len(points), bool)
    ordered = []
    for k in range(1, len(points) + 1):
        at = int(np.argmin(np.where(left, to_square - to_chosen / k, np.inf)))
        left[at] = False
        ordered.append((float(points[at, 0]), float(points[at, 1])))
        to_chosen += np.linalg.norm(points - points[at], axis=1)
    return ordered
