"""Sweeps of one ratio each from where rays at tubes are easy to where float32 no longer suffices."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from pvfiblets.tubes import SplineTubes, curves

from ...cameras import Camera, unit
from .rays import Rays, aimed, halves

__all__ = ["PICTURE_SWEEPS", "SWEEPS"]

DECADES = tuple(10.0**k for k in range(7))


def longer(ratio: float, count: int, rng: np.random.Generator) -> Rays:
    """Return rays at halves so many radii long."""
    return aimed(halves(count, rng, ratio, 1.0, 0.1, 0.3), rng)


def thicker(ratio: float, count: int, rng: np.random.Generator) -> Rays:
    """Return rays at halves of so many lengths in radius."""
    return aimed(halves(count, rng, 1.0, ratio, 0.1, 0.3 / ratio), rng)


def overshooting(ratio: float, count: int, rng: np.random.Generator) -> Rays:
    """Return rays at halves of Hermite segments with tangents of so many chords, the radius a tenth of a chord."""
    chord = unit(rng.normal(size=(count, 3)))
    slopes = ratio * unit(chord[:, None] + 0.5 * rng.normal(size=(count, 2, 3)))
    made = np.zeros((count, 3, 4))
    inner = np.stack([curves.MIDDLE * slopes[:, 0], chord - curves.MIDDLE * slopes[:, 1]], axis=1)
    made[:, 1, :3], made[:, 2, :3] = inner[:, 0], inner.mean(axis=1)
    made[:, :, 3] = 0.1
    return aimed(made, rng)


def widening(ratio: float, count: int, rng: np.random.Generator) -> Rays:
    """Return rays at halves whose radius changes by so many lengths."""
    made = halves(count, rng, 1.0, 0.1, 0.1, 0.0)
    made[:, :, 3] += ratio * (0.5 * np.arange(3) + rng.uniform(-0.1, 0.1, (count, 3)) * [0.0, 1.0, 0.0])
    return aimed(made, rng)


def lengthwise(degrees: float, count: int, rng: np.random.Generator) -> Rays:
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

SIDE = 48  # pixels of a sweep's picture
EXTENT = 24.0  # radii from the middle of the tubes to their ends
BACKWARDS = unit(np.array([0.2, 1.0, 0.3]))


def nine_tubes(centre: Any) -> SplineTubes:
    """Return bent tubes beside each other, of a radius of about 1 and 10 long; the first is straight, in the middle."""
    rng = np.random.default_rng(5)
    grid = 11.0 * np.array([[x, y, 0.0] for y in (0, -1, 1) for x in (0, -1, 1)])
    axes = Camera((1, 1), BACKWARDS, np.zeros(3), 1.0, 2.0).axes
    run = 5.0 * unit(rng.normal(size=(9, 3)))
    run[0] = 5.0 * axes[0]
    bends = 2.0 * run[:, None] + rng.normal(0.0, 3.0, (9, 2, 3)) * (np.arange(9) > 0)[:, None, None]
    ends = np.stack([grid @ axes - run, grid @ axes + run], axis=1)
    radius, slopes = rng.uniform(0.8, 1.2, (9, 2)), rng.normal(0.0, 0.3, (9, 2))
    radius[0], slopes[0] = 1.0, 0.0
    return SplineTubes(
        points=ends.reshape(-1, 3) + centre, segments=np.arange(18).reshape(9, 2), radius=radius.ravel(),
        tangents=bends.reshape(-1, 3), radius_slopes=slopes.ravel(), scaled=False, tubes=np.arange(9), n_tubes=9,
    )  # fmt: skip


def from_afar(ratio: float) -> tuple[SplineTubes, Camera]:
    """Return tubes and a camera so many radii away, ever longer, so that they fill the picture as they do from near."""
    slant, near = min(EXTENT / ratio, 1.0), max(ratio - EXTENT, 0.5 * (ratio - 1.0))
    middle = np.zeros(3)
    return nine_tubes(middle), Camera((SIDE, SIDE), ratio * BACKWARDS, middle, near, ratio + EXTENT, slant)


def moved(ratio: float) -> tuple[SplineTubes, Camera]:
    """Return tubes that lie so many of their extents away from 0, and a camera before them."""
    centre = 2.0 * EXTENT * ratio * unit(np.array([1.0, -0.7, 0.4]))
    eye = centre + 60.0 * BACKWARDS
    return nine_tubes(centre), Camera((SIDE, SIDE), eye, centre, 60.0 - EXTENT, 60.0 + EXTENT, EXTENT / 60.0)


PICTURE_SWEEPS: dict[str, tuple[str, tuple[float, ...], Callable[[float], tuple[SplineTubes, Camera]]]] = {
    "distance": ("distance of the eye over radius", (1.1, 1.5, 3.0, 10.0, *(10.0**k for k in range(2, 8))), from_afar),
    "offset": ("distance from 0 over extent", tuple(10.0**k for k in range(8)), moved),
}
