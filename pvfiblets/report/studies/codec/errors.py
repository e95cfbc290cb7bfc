"""Errors of points and directions, measured alike for every method."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from ...record import Figure

ONE_POINT = 1e-3  # pixels
LEAST_SUM = 1e-3  # of two unit vectors; a shorter one has no direction
PIXELS = 2000.0  # of a full-screen view, along the diagonal of the bounds

Floats = npt.NDArray[np.floating]
Ints = npt.NDArray[np.int64]


def distances(original: Floats, decoded: Floats) -> npt.NDArray[np.float64]:
    """Distance of each decoded point from its original, ``(n,)`` float64, in their unit."""
    if original.shape != decoded.shape:
        raise ValueError(f"{len(original)} points were coded and {len(decoded)} came back")
    apart = np.linalg.norm(np.asarray(decoded, np.float64) - np.asarray(original, np.float64), axis=1)
    if not np.isfinite(apart).all():
        raise ValueError(f"{int((~np.isfinite(apart)).sum())} of {len(apart)} decoded points are not finite")
    return apart


def median_step(points: Floats, offsets: Ints) -> float:
    """Median distance between consecutive points of a streamline, zeros left out; NaN without any."""
    points = np.asarray(points, np.float64)
    lengths = np.linalg.norm(np.diff(points, axis=0), axis=1)
    inside = np.ones(len(lengths), bool)
    joins = offsets[1:-1] - 1
    inside[joins[(joins >= 0) & (joins < len(lengths))]] = False
    lengths = lengths[inside & (lengths > 0.0)]
    return float(np.median(lengths)) if lengths.size else float("nan")


def error_figures(apart: npt.NDArray[np.float64], step: float, unit: str = "mm") -> dict[str, Figure]:
    """Return the largest, mean and 99.9th percentile of distances, in their unit and in steps."""
    if not len(apart):
        return {}
    numbers = {
        "max": float(apart.max()),
        "mean": float(apart.mean()),
        "p99.9": float(np.quantile(apart, 0.999)),
    }
    figures = {name: Figure(value, unit) for name, value in numbers.items()}
    scale = 1.0 / step if step > 0.0 else float("nan")
    return figures | {f"{name} in steps": Figure(value * scale, "steps") for name, value in numbers.items()}


def direction_angles(
    original: Floats, decoded: Floats, offsets: Ints, firsts: Ints | None = None
) -> npt.NDArray[np.float64]:
    """Angles between the tangents of original and decoded lines, at both ends of every segment that shows."""
    # A tangent is the sum of the unit vectors of a point's two segments, as a unit vector; at an end of a line, that of
    # the only one. A pixel is a 2000th of the bounds' diagonal. A segment shows where the original one is longer than
    # that; of one that is shorter than a thousandth of it the ends are one point twice, and it has no direction. Points
    # at which the original line turns back on itself have no tangent and are left out.
    points = np.asarray(original, np.float64)
    if len(points) < 2:
        return np.empty(0)
    inside = np.ones(len(points) - 1, bool)
    joins = offsets[1:-1] - 1
    inside[joins[(joins >= 0) & (joins < len(inside))]] = False
    lengths = np.linalg.norm(np.diff(points, axis=0), axis=1)
    pixel = np.linalg.norm(np.ptp(points, axis=0)) / PIXELS
    shown = inside & (lengths > pixel)
    true, _ = _tangents(points, inside & (lengths > ONE_POINT * pixel))
    drawn, before = _tangents(np.asarray(decoded, np.float64), inside)
    if firsts is not None:
        after = drawn[firsts] - before[firsts]
        drawn[firsts] = np.where(after.any(axis=1, keepdims=True), after, drawn[firsts])
    short = np.linalg.norm(drawn, axis=1) <= LEAST_SUM
    drawn[short] = before[short]
    ends = np.concatenate([np.flatnonzero(shown), np.flatnonzero(shown) + 1])
    ends = ends[np.linalg.norm(true[ends], axis=1) > LEAST_SUM]
    a, b = true[ends], drawn[ends]
    angles = np.degrees(np.arctan2(np.linalg.norm(np.cross(a, b), axis=1), (a * b).sum(1)))
    angles[~b.any(axis=1)] = 90.0
    return angles


def _tangents(points: npt.NDArray[np.float64], leads: npt.NDArray[np.bool_]) -> tuple[Floats, Floats]:
    """Sums of the unit vectors of both segments at each point, and of the segments before, ``(n, 3)`` each."""
    steps = np.diff(points, axis=0)
    steps[~leads] = 0.0
    lengths = np.linalg.norm(steps, axis=1, keepdims=True)
    units = np.divide(steps, lengths, out=np.zeros_like(steps), where=lengths > 0.0)
    none = np.zeros((1, 3))
    before = np.concatenate([none, units])
    return before + np.concatenate([units, none]), before


def direction_figures(
    original: Floats, decoded: Floats, offsets: Ints, firsts: Ints | None = None
) -> dict[str, Figure]:
    """Return the largest, mean and 99th percentile of :func:`direction_angles`; nothing where no segment shows."""
    angles = direction_angles(original, decoded, offsets, firsts)
    if not len(angles):
        return {}
    numbers = {"max": angles.max(), "mean": angles.mean(), "p99": np.quantile(angles, 0.99)}
    return {f"direction {name}": Figure(float(value), "degrees") for name, value in numbers.items()}
