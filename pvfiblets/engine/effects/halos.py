"""Depth-dependent halos of Everts et al. 2009 in screen space: ``shaders/effects/halo.frag``."""

from __future__ import annotations

import math
from typing import Any

import moderngl

from .projection import Projection
from .screen import ScreenEffect

WIDEST = 24.0  # greatest width of a halo, pixels of the finished picture; lines near the viewer would have wider ones

TILE = 8  # pixels of a tile's side: as wide as a usual halo, so that few tiles are looked into


class HaloPass(ScreenEffect):
    """Pixels of the halos of a G-buffer's lines, and their depths."""

    def __init__(self, ctx: moderngl.Context) -> None:
        super().__init__(ctx, {"tile": TILE})

    def draw(
        self,
        buffer: Any,
        lens: Projection,
        *,
        width: float,
        depth: float,
        nearest: float = 0.0,
        pixel_scale: float = 1.0,
    ) -> moderngl.Texture:
        """Bring the texture up to date."""
        widest = WIDEST * pixel_scale
        reach = math.ceil(min(width * lens.pixels_per_mm(nearest), widest))
        uniforms = lens.uniforms() | {"width": width, "depth": depth, "widest": widest, "reach": reach}
        across, up = (-(-side // TILE) for side in lens.size)
        texture = self._target("halos", lens.size, "u4")
        distances = self._target("distances", lens.size, "f4")
        tiles = self._target("tiles", (across, up), "f4")
        keys = {"keys": buffer.depth}

        def passes() -> None:
            self._pass("linear_depth", "distances", keys, uniforms)
            self._pass("tile_min_distance", "tiles", {"distances": distances}, uniforms)
            self._pass("halo", "halos", keys | {"distances": distances, "tiles": tiles}, uniforms)

        self._once((buffer, buffer.generation, lens.key, width, depth, reach, widest), passes)
        return texture
