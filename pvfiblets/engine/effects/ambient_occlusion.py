"""Ambient occlusion in screen space: ``shaders/effects/ssao.frag`` and its mean over 4 x 4 pixels."""

from __future__ import annotations

from typing import Any

import moderngl
import numpy as np
import numpy.typing as npt

from .projection import Projection
from .screen import ScreenEffect

MAX_SAMPLES = 256  # pixels looked at around each; more change nothing that 8 bits can show

GAIN, BIAS = 6.0, 0.1
"""A wall as high as the ball, along one side of a line, takes about half of the light with a gain of 6. What rises
over a line by less than 6 degrees does not count: neighbours in a flat bundle are never quite at one depth."""


class AmbientOcclusionPass(ScreenEffect):
    """Openness of each pixel of a G-buffer."""

    def __init__(self, ctx: moderngl.Context) -> None:
        super().__init__(ctx, {"gain": GAIN, "bias": BIAS})

    def draw(
        self,
        buffer: Any,
        lens: Projection,
        directions_to_view: npt.NDArray[np.float64],
        *,
        radius: float,
        samples: int,
        strength: float,
        normals_to_view: npt.NDArray[np.float64] | None = None,
    ) -> moderngl.Texture:
        """Bring the texture up to date."""
        turn = tuple(np.asarray(directions_to_view, np.float64).T.ravel().tolist())
        uniforms = lens.uniforms() | {
            "data_to_view": turn,
            "parallel": int(lens.scale[2] == 0.0),
            "radius": radius,
            "samples": samples,
            "strength": strength,
        }
        textures, features = {"keys": buffer.depth, "ids": buffer.ids}, []
        if normals_to_view is not None:
            textures, features = {"keys": buffer.depth, "normals": buffer.across}, ["SURFACE_NORMALS"]
            turn = tuple(np.asarray(normals_to_view, np.float64).T.ravel().tolist())
            uniforms["normals_to_view"] = turn
        texture = self._target("occlusion", lens.size, "f1")
        self._target("rough occlusion", lens.size, "f1")
        rough = self._targets["rough occlusion"][0]

        def passes() -> None:
            self._pass("ssao", "rough occlusion", textures, uniforms, features)
            self._pass("ssao_blur", "occlusion", {"keys": buffer.depth, "rough": rough}, uniforms)

        made_of = buffer, buffer.generation, lens.key, *features, turn, radius, samples, strength
        self._once(made_of, passes)
        return texture
