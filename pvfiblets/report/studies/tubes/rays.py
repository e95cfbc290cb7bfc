"""Rays at halves of spline tubes, their right hits, and the errors of answers: for the tubes' error report.

The error of a ray, over the radius of the sphere that it should meet: along the ray, where it meets the tube and
should; where it meets the tube and should not, or the other way round, how far it passes from the silhouette, which is
how much the radius would have to change to make that answer right.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any

import numpy as np
import numpy.typing as npt

from pvfiblets.tubes import SplineTubes, curves

from ...cameras import orbit, unit
from .reference import Hits, hits, surface_distance

Array = npt.NDArray[np.float64]
Mask = npt.NDArray[np.bool_]

GOAL = 1e-4  # of the radius


@dataclass(frozen=True, eq=False)
class Rays:
    """A ray and a half each."""

    controls: Array  # (n, 3, 4) control points, mm
    # (n, 3); directions are unit vectors
    origins: Array
    directions: Array

    @cached_property
    def truth(self) -> Hits:
        """The hit of each ray, from its origin or from before it."""
        return hits(self.controls, self.origins, self.directions)

    @cached_property
    def clearance(self) -> Array:
        """(n,) mm from each ray to its tube; negative: how much thinner the tube would have to be to be missed."""
        return clearance(self.controls, self.origins, self.directions)

    def errors(self, l: Array, t: Array, kind: npt.NDArray[np.int64]) -> dict[str, float]:  # noqa: E741
        """Return :func:`summary` of an answer: place along the ray, on the half, and 0 for a miss."""
        met, should = kind > 0, self.truth.kind > 0
        radius = radius_at(self.controls, np.where(should, self.truth.t, t))
        flipped = met != should
        error = np.abs(np.where(flipped, self.clearance, l - self.truth.l))
        error[~met & ~should] = 0.0
        return summary(error / radius, missed=should & ~met, false=met & ~should)


def summary(error: Array, missed: Mask, false: Mask) -> dict[str, float]:
    """Return the figures of errors over the radius, for rays with some missed or false hits."""
    flipped = missed | false
    middle, high, higher = np.quantile(error, (0.5, 0.99, 0.999)) if len(error) else (0.0, 0.0, 0.0)
    return {
        "p50": float(middle), "p99": float(high), "p99.9": float(higher), "max": float(error.max(initial=0.0)),
        "above_goal": share(error > GOAL), "missed": share(missed), "false": share(false),
        "silhouette": float(error[flipped].max(initial=0.0)),
    }  # fmt: skip


def share(mask: Mask) -> float:
    """Return how many of a mask are true, of 1."""
    return float(mask.mean()) if len(mask) else 0.0


def radius_at(controls: Array, t: Array) -> Array:
    """Return (n,) mm above 0: radii of halves at their t."""
    at = np.clip(np.nan_to_num(t, nan=0.5), 0.0, 1.0)
    return np.maximum(curves.evaluate(controls, at)[..., 3], 1e-9 * controls[..., 3].max(axis=-1) + 1e-300)


def clearance(controls: Array, origins: Array, directions: Array) -> Array:
    """Return (n,) the least distance from the ray's line to the axis at t, less the radius there."""
    flat = controls.copy()
    flat[..., :3] -= origins[:, None]
    flat[..., :3] -= np.einsum("nki,ni->nk", flat[..., :3], directions)[..., None] * directions[:, None]
    return surface_distance(flat, np.zeros_like(origins))


def halves(count: int, rng: np.random.Generator, length: Any, radius: Any, bend: float, change: Any) -> Array:
    """Return (count, 3, 4) halves of a length and radius: bent by a share of the length, radii by a share of theirs."""
    made = np.zeros((count, 3, 4))
    run = length * unit(rng.normal(size=(count, 3)))
    made[:, 2, :3] = run
    made[:, 1, :3] = 0.5 * run + rng.normal(0.0, bend * length, (count, 3))
    made[:, :, 3] = radius * (1.0 + change * rng.uniform(-1.0, 1.0, (count, 3)))
    return made


def _flat_ended(count: int, rng: np.random.Generator) -> Array:
    """Return (count, 3, 4) halves of segments of length 1 with every combination of slopes of 0 at their nodes."""
    chord, pairs = unit(rng.normal(size=(count, 3))), np.arange(2 * count).reshape(-1, 2)
    slopes = np.concatenate(
        [chord[:, None] + rng.normal(0.0, 0.6, (count, 2, 3)), rng.normal(0.0, 0.08, (count, 2, 1))], axis=2
    )
    slopes *= rng.integers(0, 2, (count, 2, 2))[..., [0, 0, 0, 1]]  # of position and of radius
    tubes = SplineTubes(
        points=np.stack([np.zeros_like(chord), chord], axis=1).reshape(-1, 3), segments=pairs,
        radius=rng.uniform(0.05, 0.15, 2 * count), tangents=slopes[..., :3].reshape(-1, 3),
        radius_slopes=slopes[..., 3].ravel(), scaled=False, tubes=np.arange(count), n_tubes=count,
    )  # fmt: skip
    return curves.controls(tubes)[np.arange(count), rng.integers(0, 2, count)]


def aimed(controls: Array, rng: np.random.Generator, directions: Array | None = None, eye: Array | None = None) -> Rays:
    """Return rays that pass some sphere of each half within 1.15 radii of its middle: from anywhere, or from an eye."""
    count = len(controls)
    sphere = curves.evaluate(controls, rng.uniform(0.0, 1.0, count))
    if directions is None:
        directions = unit(rng.normal(size=(count, 3)) if eye is None else sphere[:, :3] - eye)
    beside = unit(np.cross(directions, rng.normal(size=(count, 3))))
    at = sphere[:, :3] + 1.15 * np.sqrt(rng.uniform(0.0, 1.0, count))[:, None] * sphere[:, 3:] * beside
    if eye is not None:
        return Rays(controls, np.broadcast_to(eye, at.shape).copy(), unit(at - eye))
    size = np.abs(controls - controls.mean(axis=1, keepdims=True)).max(axis=(1, 2)) + controls[..., 3].max(axis=1)
    return Rays(controls, at - 10.0 * size[:, None] * directions, directions)


CLASSES: dict[str, Callable[[int, Any], Array]] = {
    "thin": partial(halves, length=1.0, radius=0.02, bend=0.05, change=0.3),
    "usual": partial(halves, length=1.0, radius=0.1, bend=0.1, change=0.3),
    "bent": partial(halves, length=1.0, radius=0.1, bend=0.6, change=0.3),
    "thick": partial(halves, length=1.0, radius=2.0, bend=0.3, change=0.3),
    "blob": partial(halves, length=1.0, radius=20.0, bend=0.3, change=0.1),
    "cone": partial(halves, length=1.0, radius=0.3, bend=0.1, change=1.0),
    "flat-ended": _flat_ended,
}


def of_class(name: str, count: int, seed: int = 0) -> Rays:
    """Return rays at synthetic halves of one class, from all around."""
    rng = np.random.default_rng([seed, list(CLASSES).index(name)])
    return aimed(CLASSES[name](count, rng), rng)


def of_set(tubes: Any, count: int, size: tuple[int, int], seed: int = 0) -> Rays:
    """Return rays at halves of a set that are in the picture, one half of them from far and the other from close by."""
    rng = np.random.default_rng([seed, 7])
    parts = []
    for view in ("far", "close"):
        camera = orbit(tubes, view, 4, size)[0]
        chosen = rng.integers(0, tubes.n_segments, 40 * count)
        middle = tubes.points[tubes.segments[chosen]].mean(axis=1)
        reach = tubes.radius[tubes.segments[chosen]].max(axis=1)
        x, y, w = camera.project(middle).T
        beside = (np.abs(y) < camera.slant) & (np.abs(x) < camera.slant * size[0] / size[1])
        shown = (w > camera.near + 2.0 * reach) & beside
        some = curves.controls(tubes, chosen[shown][: count // 2])
        parts.append(aimed(some[np.arange(len(some)), rng.integers(0, 2, len(some))], rng, eye=camera.eye))
    return Rays(
        *(np.concatenate([getattr(part, key) for part in parts]) for key in ("controls", "origins", "directions"))
    )
