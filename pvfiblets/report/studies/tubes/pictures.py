"""Pictures of spline tubes against float64: how far off silhouettes and depths are, and what depth is stored as."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from pvfiblets.tubes import SplineTubes, curves

from ...cameras import Camera
from .rays import radius_at
from .reference import ENTRY, nearest_hits

Array = npt.NDArray[np.float64]
Mask = npt.NDArray[np.bool_]

EMPTY = 0xFFFFFFFF


def helices(count: int, nodes: int = 25) -> SplineTubes:
    """Return tubes of varying radius around helices, beside each other on a circle."""
    t = np.linspace(0.0, 4.0 * np.pi, nodes)
    shift = 2.0 * np.pi * np.arange(count)[:, None] / count
    ring = 0.8 * count * np.stack([np.cos(shift), np.sin(shift), 0.0 * shift], axis=2)
    points = ring + np.stack(np.broadcast_arrays(np.cos(t + shift), np.sin(t + shift), 0.5 * t), axis=2)
    slopes = np.stack(np.broadcast_arrays(-np.sin(t + shift), np.cos(t + shift), 0.5), axis=2)
    radius = np.broadcast_to(0.4 + 0.2 * np.sin(2.0 * t), (count, nodes))
    growth = np.broadcast_to(0.4 * np.cos(2.0 * t), (count, nodes))
    first = (np.arange(count)[:, None] * nodes + np.arange(nodes - 1)).ravel()
    return SplineTubes(
        points=points.reshape(-1, 3), segments=np.stack([first, first + 1], axis=1), radius=radius.ravel(),
        tangents=slopes.reshape(-1, 3) * t[1], radius_slopes=growth.ravel() * t[1], scaled=False,
        tubes=np.repeat(np.arange(count), nodes - 1), n_tubes=count,
    )  # fmt: skip


def outline(mask: Mask) -> float:
    """Return the length of a mask's outline in its pixels: Crofton's formula with lines in four directions."""
    straight = (mask[1:] != mask[:-1]).sum() + (mask[:, 1:] != mask[:, :-1]).sum()
    slanted = (mask[1:, 1:] != mask[:-1, :-1]).sum() + (mask[1:, :-1] != mask[:-1, 1:]).sum()
    return math.pi / 8.0 * (float(straight) + float(slanted) / math.sqrt(2.0))


@dataclass(frozen=True, eq=False)
class Truth:
    """The right picture of tubes, in all pixels or in some."""

    camera: Camera
    pixels: npt.NDArray[np.int64]  # `(n,)` int64, counted in rows from below
    along: Array  # `(n,)` mm along each pixel's ray to the first tube, infinite where there is none
    radius: Array  # `(n,)` mm of the sphere that is met; 1 where there is none
    forwards: Array  # `(n,)` mm forwards by mm of ray

    @classmethod
    def from_tubes(cls, tubes: SplineTubes, camera: Camera, pixels: npt.NDArray[np.int64] | None = None) -> Truth:
        """Meet the rays of pixels, all by default, with all halves, in float64."""
        halves = curves.controls(tubes).reshape(-1, 3, 4)
        pixels = np.arange(camera.size[0] * camera.size[1]) if pixels is None else pixels
        directions, forwards = camera.rays(pixels)
        met = nearest_hits(halves, camera.eye, directions, start=camera.near / forwards, end=camera.far / forwards)
        there = met.kind == ENTRY
        radius = np.ones(len(there))
        radius[there] = radius_at(halves[met.half[there]], met.t[there])
        return cls(camera, pixels, np.where(there, met.l, np.inf), radius, forwards)

    @property
    def there(self) -> Mask:
        """``(n,)``: whether anything is met."""
        return np.isfinite(self.along)

    def errors(self, shown: Array, there: Mask) -> dict[str, float]:
        """Return the errors of a picture; this reference holds all its pixels."""
        width, height = self.camera.size
        length = outline(self.there.reshape(height, width))
        off = self.depth_errors(shown, there)
        middle, high = np.quantile(off, (0.5, 0.99)) if len(off) else (math.nan, math.nan)
        return {
            "silhouette": float((there != self.there).sum()) / max(length, 1.0),
            "depth p50": float(middle),
            "depth p99": float(high),
        }

    def depth_errors(self, shown: Array, there: Mask) -> Array:
        """Return errors along the rays over the radius, of pixels that show a tube and should."""
        both = there & self.there
        off: Array = np.abs(shown[both] / self.forwards[both] - self.along[both]) / self.radius[both]
        return off

    def stored(self, rounded: Callable[[Array], Array]) -> float:
        """Return the 99th percentile of errors, radii, that rounding the right window depth to a format makes alone."""
        there = self.there
        exact = self.along[there] * self.forwards[there]
        kept = self.camera.distance(rounded(1.0 - self.camera.depth(exact)))
        off = np.abs(kept - exact) / self.forwards[there] / self.radius[there]
        return float(np.quantile(off, 0.99)) if len(off) else math.nan


def sampled(there: Mask, count: int, rng: np.random.Generator) -> npt.NDArray[np.int64]:
    """Return so many pixels at most of a picture, ``(height, width)``: half show something, half are empty beside it.

    Empty pixels next to others are where holes would be.
    """
    grid = np.pad(there, 1)
    beside = grid[:-2, 1:-1] | grid[2:, 1:-1] | grid[1:-1, :-2] | grid[1:-1, 2:]
    parts = [np.flatnonzero(mask.ravel()) for mask in (there, beside & ~there)]
    return np.sort(np.concatenate([rng.permutation(part)[: count // 2] for part in parts]))


def _float32(reversed_depth: Array) -> Array:
    return 1.0 - (1.0 - reversed_depth).astype(np.float32).astype(np.float64)


def _fixed(bits: int) -> Callable[[Array], Array]:
    levels = 2.0**bits - 1.0
    return lambda reversed_depth: 1.0 - np.round((1.0 - reversed_depth) * levels) / levels


FORMATS: dict[str, Callable[[Array], Array]] = {
    "float32": _float32,
    "24 bits": _fixed(24),
    "key of 32 bits, rounded once": _fixed(32),
}
"""Stored formats of depth: functions of 1 less the window depth, which return it after rounding."""


def reversed_depth_of(keys: npt.NDArray[np.uint32]) -> Array:
    """Return 1 less the window depth of a G-buffer's keys."""
    return (EMPTY - keys.astype(np.float64)) / EMPTY
