"""Depth of field: which depths of a picture are in focus, and how wide the discs of the others are.

The lens is thin, and the camera's: what the view angle shows is what the lens shows, so that a picture out of focus
everywhere has the same things at the same places. ``shaders/effects/picture/blur.frag`` has the formulas.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from .projection import Projection

WIDEST = 64.0  # pixels: the greatest radius of a disc, as a pixel reads all pixels whose discs may reach it

STEPS = 16
"""Radii a pixel, in the table of the pixels that discs cover; the number is linear between halves of a pixel's width,
and few distances of pixels from a centre lie between two steps."""

TILE = 8  # pixels of the side of a square that stores how far discs reach into it


@dataclass(frozen=True)
class Focus:
    """Settings of a lens."""

    distance: float  # mm from the viewer's plane to the plane in focus; above 0
    aperture: float  # mm: the lens's diameter. In a parallel view it is that of a lens at the viewer's place.
    max_blur: float  # pixels, 1 to `WIDEST`: no disc has a greater radius
    darkening: float = 0.0  # 0 to 1: the share of light lost by pixels with the widest disc

    def uniforms(self, lens: Projection) -> dict[str, object]:
        """Return what ``shaders/effects/picture/blur.frag`` asks for."""
        k, w0, w1 = lens.scale
        depth, shift = float(lens.projection[2, 2]), float(lens.projection[2, 3])
        if w1 != 0.0:
            # 1 / z = ((w1 + depth) - 2 w1 f) / shift, with f = 1 - window depth
            strength = 0.5 * self.aperture * k / w1
            backdrop = strength / self.distance
            line = backdrop - strength * (w1 + depth) / shift, 2.0 * strength * w1 / shift
        else:
            # z = (shift - w0 + 2 w0 f) / depth
            strength = 0.5 * self.aperture * k / (w0 * self.distance)
            line = strength * ((shift - w0) / depth - self.distance), 2.0 * strength * w0 / depth
            backdrop = math.inf if self.aperture > 0.0 else 0.0
        return {
            "line": line,
            "backdrop": min(backdrop, self.max_blur),
            "widest": self.max_blur,
            "darkening": self.darkening,
        }


def distance_of(lens: Projection, depth: float) -> float:
    """Return how far from the viewer's plane (mm) a window depth in 0..1 lies."""
    _, w0, w1 = lens.scale
    scale, shift = float(lens.projection[2, 2]), float(lens.projection[2, 3])
    ndc = 2.0 * depth - 1.0
    return (shift - w0 * ndc) / (w1 * ndc + scale)


def disc_areas(widest: float) -> npt.NDArray[np.float32]:
    """Return how many pixels discs of radius 0, 1 / STEPS, ... cover, to a step beyond the widest."""
    side = math.ceil(widest) + 2
    offsets = np.arange(-side, side + 1, dtype=np.float64)
    apart = np.sort(np.hypot(offsets[:, None], offsets).ravel())
    radii = np.maximum(np.arange(math.ceil(widest * STEPS) + 2) / STEPS, 0.5)
    # Pixels nearer than r - 1/2 count 1, pixels up to r + 1/2 count r + 1/2 - d.
    sums = np.concatenate([[0.0], np.cumsum(apart)])
    inner, outer = (np.searchsorted(apart, radii + shift) for shift in (-0.5, 0.5))
    areas = inner + (outer - inner) * (radii + 0.5) - (sums[outer] - sums[inner])
    return areas.astype(np.float32)
