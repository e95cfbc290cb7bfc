"""Sweeps of one ratio each from where rays at tubes are easy to where float32 no longer suffices."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from pvfiblets.tubes import curves

from .cameras import unit
from .tubes_rays import Rays, aimed, halves

__all__ = ["SWEEPS"]

DECADES = tuple(10.0**k for k in range(7))


def longer(ratio: float, count: int, rng: Any) -> Rays:
    """Return rays at halves so many radii long."""
    return aimed(halves(count, rng, ratio, 1.0, 0.1, 0.3), rng)


def thicker(ratio: float, count: int, rng: Any) -> Rays:
    """Return rays at halves of so many lengths in radius."""
    return aimed(halves(count, rng, 1.0, ratio, 0.1, 0.3 / ratio), rng)


def overshooting(ratio: float, count: int, rng: Any) -> Rays:
    """Return rays at halves of Hermite segments with tangents of so many chords, the radius a tenth of a chord."""
    chord = unit(rng.normal(size=(count, 3)))
    slopes = ratio * unit(chord[:, None] + 0.5 * rng.normal(size=(count, 2, 3)))
    made = np.zeros((count, 3, 4))
    inner = np.stack([curves.MIDDLE * slopes[:, 0], chord - curves.MIDDLE * slopes[:, 1]], axis=1)
    made[:, 1, :3], made[:, 2, :3] = inner[:, 0], inner.mean(axis=1)
    made[:, :, 3] = 0.1
    return aimed(made, rng)


def widening(ratio: float, count: int, rng: Any) -> Rays:
    """Return rays at halves whose radius changes by so many lengths."""
    made = halves(count, rng, 1.0, 0.1, 0.1, 0.0)
    made[:, :, 3] += ratio * (0.5 * np.arange(3) + rng.uniform(-0.1, 0.1, (count, 3)) * [0.0, 1.0, 0.0])
    return aimed(made, rng)


def lengthwise(degrees: float, count: int, rng: Any) -> Rays:
    """Return rays at so many degrees from the axis of straight halves, 20 radii long."""
    made = halves(count, rng, 20.0, 1.0, 0.0, 0.3)
    axis = unit(made[:, 2, :3])
    beside = unit(np.cross(axis, rng.normal(size=axis.shape)))
    angle = np.radians(degrees)
    return aimed(made, rng, np.cos(angle) * axis + np.sin(angle) * beside)


SWEEPS: dict[str, tuple[str, tuple[float, ...], Callable[[float, int, Any], Rays]]] = {
    "length": ("length over radius", (1.0, 10.0, 100.0, 300.0, 500.0, 1e3, 3e3, 1e4, 3e4, 1e5, 1e6), longer),
    "radius": ("radius over length", DECADES, thicker),
    "tangents": ("tangents over chord", (1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 300.0, 1000.0), overshooting),
    "slope": ("change of radius over length", (0.0, 0.1, 0.5, 0.9, 0.99, 1.0, 1.01, 1.1, 2.0, 5.0, 10.0, 30.0, 100.0),
              widening),
    "angle": ("degrees between ray and axis", (90.0, 60.0, 30.0, 10.0, 3.0, 1.0, 0.3, 0.1, 0.01, 0.001, 0.0),
              lengthwise),
}  # fmt: skip
