"""Distances from boxes and ellipsoids, straight or stretched by any affine map."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]


def box_distance(linear: Array, unit: Array) -> Array:
    """Distances of positions from the box ``max |u_i| <= 1``."""
    # The nearest point lies in the box itself, within a face, an edge or a corner. For each of the 26 the nearest point
    # of its whole plane or line follows from least squares. Candidates outside of their face or edge are dropped; the
    # least distance is right, as each is the distance to a point of the box, and the true nearest point is among them.
    edges = np.linalg.inv(linear)  # mm per unit coordinate, columns
    lengths = np.linalg.norm(edges, axis=0)
    axes = edges / lengths
    if np.abs(axes.T @ axes - np.eye(3)).max() <= 1e-14:  # not sheared: along each axis by itself
        straight: Array = np.linalg.norm(np.maximum(np.abs(unit) - 1.0, 0.0) * lengths, axis=1)
        return straight
    found = np.full(len(unit), np.inf)
    found[(np.abs(unit) <= 1.0).all(axis=1)] = 0.0
    for pattern in np.ndindex(3, 3, 3):
        fixed = np.array(pattern) != 1
        if not fixed.any():
            continue
        # Free axes by least squares; the others are at -1 or +1.
        away = unit[:, fixed] - (np.array(pattern)[fixed] - 1.0)
        apart = away @ edges[:, fixed].T
        free = edges[:, ~fixed]
        inside = np.ones(len(unit), bool)
        if free.shape[1]:
            steps = np.linalg.lstsq(free, apart.T, rcond=None)[0].T
            inside = (np.abs(unit[:, ~fixed] + steps) <= 1.0 + 1e-12).all(axis=1)
            apart = apart - steps @ free.T
        np.minimum(found, np.where(inside, np.linalg.norm(apart, axis=1), np.inf), out=found)
    return found


def ellipsoid_distance(linear: Array, unit: Array) -> Array:
    """Distances of positions from the ellipsoid ``u . u <= 1``."""
    # With semi-axes `s_i` and `y` in the ellipsoid's own frame the nearest point is `x_i = s_i^2 y_i / (t + s_i^2)` for
    # the root `t >= 0` of `sum (s_i y_i / (t + s_i^2))^2 = 1` (Eberly 2013, "Distance from a point to an ellipse, an
    # ellipsoid, or a hyperellipsoid"), which falls with t, bracketed by `max s_i |y_i| - s_i^2` and `|s y| - min
    # s_i^2`, and found by bisection to the last bit.
    # linear^-1 = turn diag(s) other, and a rotation of the unit ball is the unit ball.
    _, semi, other = np.linalg.svd(np.linalg.inv(linear))
    found = np.zeros(len(unit))
    if semi[0] - semi[2] <= 1e-14 * semi[0]:
        return np.maximum(np.linalg.norm(unit, axis=1) - 1.0, 0.0) * semi[0]
    outside = np.einsum("ij,ij->i", unit, unit) > 1.0
    if not outside.any():
        return found
    # In units of the longest semi-axis.
    s = semi / semi[0]
    y = np.abs(unit[outside] @ other.T) * s
    low = np.maximum((s * y - s * s).max(axis=1), 0.0)
    high = np.maximum(np.linalg.norm(s * y, axis=1), low)
    for _ in range(100):
        middle = 0.5 * (low + high)
        beyond = ((s * y / (middle[:, None] + s * s)) ** 2).sum(axis=1) > 1.0
        low = np.where(beyond, middle, low)
        high = np.where(beyond, high, middle)
    t = high[:, None]
    found[outside] = np.linalg.norm(y * (t / (t + s * s)), axis=1) * semi[0]
    return found
