"""Streamlines that are hard to keep, to draw or to pick, made by formulas and seeded random numbers."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from pvfiblets.streamlines import Streamlines

Array = npt.NDArray[np.float64]


def lines_of(*lines: npt.ArrayLike) -> Streamlines:
    """Return streamlines of ``(n, 3)`` arrays."""
    return Streamlines.from_list([np.asarray(line, np.float64).reshape(-1, 3) for line in lines])


def tracking(n: int = 12, points: int = 130, step: float = 0.5, seed: int = 0) -> Streamlines:
    """Smooth lines of constant step that wander within some 100 mm, as tracking gives them."""
    rng = np.random.default_rng(seed)
    turns = np.cumsum(rng.normal(0.0, 0.03, (n, points, 3)), axis=1)
    directions = rng.normal(size=(n, 1, 3)) + turns
    directions *= step / np.linalg.norm(directions, axis=2, keepdims=True)
    places = np.cumsum(directions, axis=1) + rng.uniform(-30.0, 30.0, (n, 1, 3))
    return Streamlines(places.reshape(-1, 3), points * np.arange(n + 1))


def turning(turn: float, points: int = 130, step: float = 0.5) -> Array:
    """One line of constant step that turns by an angle at every point, about an axis that turns as well."""
    forwards, up = np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])
    directions = [forwards]
    for _ in range(points - 2):
        side = np.cross(up, forwards)
        forwards, up = _turned(forwards, side, turn), _turned(up, side, 0.37)  # the second about the new one
        forwards /= np.linalg.norm(forwards)
        up -= (up @ forwards) * forwards
        up /= np.linalg.norm(up)
        directions.append(forwards)
    return np.concatenate([np.zeros((1, 3)), np.cumsum(step * np.array(directions), axis=0)])


def _turned(a: Array, b: Array, angle: float) -> Array:
    """A unit vector turned towards another at a right angle to it; small angles keep their digits."""
    turned: Array = a - 2.0 * np.sin(angle / 2.0) ** 2 * a + np.sin(angle) * b
    return turned


def zigzag(points: int = 500, step: float = 1.0) -> Array:
    """A line that goes back and forth between two places."""
    line = np.zeros((points, 3))
    line[1::2, 0] = step
    return line


def helix(points: int = 500, turn: float = np.pi - 1e-3, pitch: float = 0.01, radius: float = 0.5) -> Array:
    """A helix sampled so coarsely that it turns by nearly half a circle from point to point."""
    i = np.arange(points)
    return np.stack([radius * np.cos(turn * i), radius * np.sin(turn * i), pitch * i], axis=1)


def from_segments(points: npt.ArrayLike, a: npt.ArrayLike, b: npt.ArrayLike) -> Array:
    """Distances of points from the nearest of some segments, right for denormal lengths too."""
    p, a, b = (np.asarray(x, np.float64).reshape(-1, 3) for x in (points, a, b))
    scale = float(max(np.abs(p[:, None] - a).max(initial=0.0), np.abs(b - a).max(initial=0.0))) or 1.0
    away, chord = (p[:, None] - a) / scale, (b - a) / scale
    squares = (chord**2).sum(axis=1)
    along = (away * chord).sum(axis=2) / np.where(squares > 0.0, squares, 1.0)
    found: Array = scale * np.linalg.norm(away - np.clip(along, 0.0, 1.0)[..., None] * chord, axis=2).min(axis=1)
    return found


def differences(a: npt.ArrayLike, b: npt.ArrayLike) -> Array:
    """Distances of points one by one, right for denormal and for huge ones too."""
    delta = np.abs(np.asarray(a, np.float64) - np.asarray(b, np.float64))
    most = delta.max(axis=1, initial=0.0)
    scale = np.where(most > 0.0, most, 1.0)[:, None]
    found: Array = most * np.sqrt(((delta / scale) ** 2).sum(axis=1))
    return found
