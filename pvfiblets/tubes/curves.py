"""The curves of a tube: the two quadratics that stand for each cubic, and the boxes around them, in float64.

Source: Russig, Gumhold and Salm, "GPU-based raycasting of Hermite spline tubes" (2020), section 3.2. Symbols: a
segment runs from node ``n_i`` to ``n_j`` with the derivatives ``m_i`` and ``m_j`` by its parameter ``t`` in 0..1; all
of them have the components ``x, y, z, r``. Its halves have the Bezier control points ``a_1..a_3`` and ``b_1..b_3``::

    a_1 = n_i       a_2 = n_i + c m_i       a_3 = b_1 = (a_2 + b_2) / 2       b_2 = n_j - c m_j       b_3 = n_j

The halves meet with one tangent whatever ``c`` is. The paper takes ``c = 1/3``, and they meet ``(m_i - m_j) / 24`` off
the cubic. With ``c = 1/4`` they meet on the cubic's own middle and have its derivatives at both ends; between, they
leave it by ``k t^2 (t - 1/2)`` and its mirror image, ``k = 2 (n_i - n_j) + m_i + m_j``, hence by ``|k| / 54`` at most,
a third of the way along.

A tube is what the sphere of radius ``r`` around the curve sweeps. Control radii are never below 0, so that no sphere
has a negative radius, and the tube lies within the convex hull of its control spheres.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from .spline_tubes import SplineTubes, chord_lengths

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

MIDDLE = 0.25  # distance of the middle control points along the end tangents: `c` above

_BLOCK = 1 << 14  # segments measured at a time, so that the samples of millions of them need no gigabytes


def controls(tubes: SplineTubes, segments: npt.ArrayLike | None = None, middle: float = MIDDLE) -> Array:
    """Control points of the halves of segments."""
    # Negative control radii are raised to 0 before the halves are joined, so that they still meet with one derivative.
    #
    # Russig et al. 2020, section 3.2, "Segment subdivision".
    if not 0.0 <= middle <= 1.0:
        raise ValueError(f"middle is {middle!r}, expected a number of 0 to 1, such as {MIDDLE} or 1 / 3 (the paper)")
    start, stop, slope, end_slope = _ends(tubes, segments)
    found = np.empty((*start.shape[:-1], 2, 3, 4))
    found[..., 0, 0, :] = start
    found[..., 0, 1, :] = start + middle * slope
    found[..., 1, 1, :] = stop - middle * end_slope
    found[..., 1, 2, :] = stop
    radii = found[..., 1, 3]
    np.maximum(radii, 0.0, out=radii)
    joint = found[..., 0, 1, :] + 0.5 * (found[..., 1, 1, :] - found[..., 0, 1, :])
    found[..., 0, 2, :] = found[..., 1, 0, :] = joint
    return found


def evaluate(controls: npt.ArrayLike, t: npt.ArrayLike) -> Array:
    """Points of quadratic Bezier curves."""
    first, second, third = _points(controls)
    t = np.asarray(t, np.float64)[..., None]
    found: Array = (1.0 - t) ** 2 * first + 2.0 * t * (1.0 - t) * second + t**2 * third
    return found


def derivative(controls: npt.ArrayLike, t: npt.ArrayLike) -> Array:
    """Derivatives of quadratic Bezier curves by their own parameter."""
    first, second, third = _points(controls)
    t = np.asarray(t, np.float64)[..., None]
    found: Array = 2.0 * ((1.0 - t) * (second - first) + t * (third - second))
    return found


def cubic(tubes: SplineTubes, segments: npt.ArrayLike, t: npt.ArrayLike) -> Array:
    """``(..., 4)`` x, y, z, r (mm) of the Hermite cubics themselves, which the halves approximate; r may be below 0."""
    start, stop, slope, end_slope = _ends(tubes, segments)
    t = np.asarray(t, np.float64)[..., None]
    rest = 1.0 - t
    nodes = rest**2 * (1.0 + 2.0 * t) * start + t**2 * (3.0 - 2.0 * t) * stop
    found: Array = nodes + rest**2 * t * slope - rest * t**2 * end_slope
    return found


def sample_spheres(controls: npt.ArrayLike, count: int = 33) -> Array:
    """Spheres along curves, at even steps of the parameter, both ends included."""
    if count < 2:
        raise ValueError(f"count is {count}, expected at least 2: the ends of each curve")
    return evaluate(np.asarray(controls, np.float64)[..., None, :, :], np.linspace(0.0, 1.0, count))


# --------------------------------------------------------------------------------------------------------- boxes


@dataclass(frozen=True, eq=False)
class Boxes:
    """Oriented boxes."""

    centre: Array  # `(k, 3)` mm
    axes: Array  # `(k, 3, 3)`: rows are the unit vectors of a right-handed frame, in the paper `R`
    half: Array  # `(k, 3)` mm, half of each edge

    @property
    def corners(self) -> Array:
        """(k, 8, 3) mm: corner ``i + 2 j + 4 k`` is that at the far end of the first axis if i, and so on."""
        signs = np.array([[2 * (corner >> axis & 1) - 1 for axis in range(3)] for corner in range(8)], np.float64)
        offsets = (signs * self.half[:, None]) @ self.axes
        return self.centre[:, None] + offsets

    @property
    def volume(self) -> Array:
        """(k,) mm³."""
        return np.prod(2.0 * self.half, axis=1)

    def inside(self, points: npt.ArrayLike, slack: float = 0.0) -> npt.NDArray[np.bool_]:
        """Whether points lie in the boxes, each in the one of its first index: ``(k, ..., 3)`` to ``(k, ...)``."""
        points = np.asarray(points, np.float64)
        between = tuple(range(1, points.ndim - 1))
        local = (points - np.expand_dims(self.centre, between)) @ np.swapaxes(self.axes, 1, 2)
        found: npt.NDArray[np.bool_] = np.all(np.abs(local) <= np.expand_dims(self.half, between) + slack, axis=-1)
        return found


def boxes(controls: npt.ArrayLike) -> Boxes:
    """Box of each half, along the chord and as tight as that allows."""
    # The first axis runs from start to end, the second to the side that the curve bends to. Where the curve ends at its
    # start, the first axis is that of its bend; where it does not bend, the second is any one across.
    #
    # Russig et al. 2020, section 3.2, "Silhouettes": the extrema of `q(t) - r(t)` and `q(t) + r(t)`, which lie at the
    # ends or where the derivative, linear in `t`, is 0.
    given = np.asarray(controls, np.float64).reshape(-1, 3, 4)
    # Coordinates count from the start, so that a tube far from 0 keeps its digits.
    points = given[:, :, :3] - given[:, :1, :3]
    axes = _frames(points)
    local = points @ np.swapaxes(axes, 1, 2)
    low = _least(local - given[:, :, 3:])
    high = -_least(-local - given[:, :, 3:])
    middle = low + 0.5 * (high - low)
    return Boxes(given[:, 0, :3] + (middle[:, None] @ axes)[:, 0], axes, 0.5 * (high - low))


def _frames(points: Array) -> Array:
    """Return (k, 3, 3) rows x, y, z: along the chord, towards the bend, across both."""
    chord, tangent = _unit(points[:, 2]), _unit(points[:, 1])
    x = np.where(chord.any(axis=1, keepdims=True), chord, tangent)
    x[~x.any(axis=1)] = (1.0, 0.0, 0.0)
    # A direction across, where the tangent gives none: that of the axis that x has least of.
    spare = np.zeros_like(x)
    np.put_along_axis(spare, np.abs(x).argmin(axis=1)[:, None], 1.0, axis=1)
    across = tangent - x * np.einsum("ki,ki->k", tangent, x)[:, None]
    straight = np.einsum("ki,ki->k", across, across) <= 1e-24
    across[straight] = spare[straight]
    y = _unit(across)
    # Once more: the remainder of a tangent that hardly leaves x is not at right angles to it to the last digit.
    y = _unit(y - x * np.einsum("ki,ki->k", y, x)[:, None])
    return np.stack([x, y, np.cross(x, y)], axis=1)


def _unit(vectors: Array) -> Array:
    """Return vectors of length 1, or 0 where the given is 0; lengths near the ends of float64 do no harm."""
    largest = np.abs(vectors).max(axis=-1, keepdims=True)
    vectors = vectors / np.where(largest > 0.0, largest, 1.0)
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    found: Array = vectors / np.where(length > 0.0, length, 1.0)
    return found


def _least(values: Array) -> Array:
    """Return (k, 3): the least that quadratic Bezier functions, (k, 3, 3) control values, take on 0..1."""
    first, second, third = _points(values)
    bend = (first - second) + (third - second)
    with np.errstate(over="ignore", divide="ignore", invalid="ignore"):
        turn = (first - second) / bend
    # Any place on the curve may be taken, so that an invalid turn, or one outside, need not be distinguished.
    turn = np.clip(np.where(np.isfinite(turn), turn, 0.0), 0.0, 1.0)
    there = (1.0 - turn) ** 2 * first + 2.0 * turn * (1.0 - turn) * second + turn**2 * third
    found: Array = np.minimum(np.minimum(first, third), there)
    return found


# ------------------------------------------------------------------------------------------------- approximation


def deviations(
    tubes: SplineTubes, segments: npt.ArrayLike | None = None, middle: float = MIDDLE, samples: int = 64
) -> Array:
    """Return how far the halves leave the cubics, segment by segment, measured at equal parameters."""
    if samples < 2:
        raise ValueError(f"samples is {samples}, expected at least 2")
    chosen = _chosen(tubes, segments)
    t = np.linspace(0.0, 1.0, samples + 1)
    second = t > 0.5
    found = np.empty((len(chosen), 2))
    for first in range(0, len(chosen), _BLOCK):
        some = chosen[first : first + _BLOCK]
        halves = controls(tubes, some, middle)
        shown = evaluate(np.where(second[:, None, None], halves[:, 1, None], halves[:, 0, None]), 2.0 * t - second)
        true = cubic(tubes, some[:, None], t)
        found[first : first + _BLOCK, 0] = np.linalg.norm(shown[..., :3] - true[..., :3], axis=-1).max(axis=1)
        found[first : first + _BLOCK, 1] = np.abs(shown[..., 3] - np.maximum(true[..., 3], 0.0)).max(axis=1)
    return found


def deviation(tubes: SplineTubes, middle: float = MIDDLE, samples: int = 64) -> float:
    """Return the greatest distance of the drawn surface from the cubic tube's, mm."""
    # Two spheres are no further apart than their centres are plus what their radii differ by.
    return float(deviations(tubes, None, middle, samples).sum(axis=1).max(initial=0.0))


# ------------------------------------------------------------------------------------------------------- helpers


def _points(controls: npt.ArrayLike) -> tuple[Array, Array, Array]:
    """Return the three control points."""
    given = np.asarray(controls, np.float64)
    if given.ndim < 2 or given.shape[-2] != 3:
        raise ValueError(f"controls have the shape {given.shape}, expected (..., 3, d): three points of each curve")
    return given[..., 0, :], given[..., 1, :], given[..., 2, :]


def _chosen(tubes: SplineTubes, segments: npt.ArrayLike | None) -> Ints:
    """Return indices of segments; IndexError if there are none of that number."""
    count = len(tubes.segments)
    if segments is None:
        return np.arange(count)
    given: npt.NDArray[Any] = np.asarray(segments)
    if given.size == 0:
        given = given.astype(np.int64)
    if given.dtype.kind not in "iu":
        raise IndexError(f"segments are of type {given.dtype}, expected indices, 0 to {count - 1}")
    wrong = given[(given < 0) | (given >= count)]
    if wrong.size:
        raise IndexError(f"there is no segment {wrong.flat[0]}, expected indices of 0 to {count - 1}")
    return given.astype(np.int64)


def _ends(tubes: SplineTubes, segments: npt.ArrayLike | None) -> tuple[Array, Array, Array, Array]:
    """Return (..., 4) each: nodes and derivatives by the segment's parameter, at start and end."""
    ends = np.asarray(tubes.segments)[_chosen(tubes, segments)]
    nodes = np.column_stack([tubes.points, tubes.radius]).astype(np.float64, copy=False)
    slopes = np.column_stack([tubes.tangents, tubes.radius_slopes]).astype(np.float64, copy=False)
    start, stop = nodes[ends[..., 0]], nodes[ends[..., 1]]
    scale: Any = 1.0
    if tubes.scaled:
        chords = stop[..., :3] - start[..., :3]
        scale = chord_lengths(chords.reshape(-1, 3)).reshape(*chords.shape[:-1], 1)
    return start, stop, scale * slopes[ends[..., 0]], scale * slopes[ends[..., 1]]
