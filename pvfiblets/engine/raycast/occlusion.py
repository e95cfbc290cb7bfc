"""Ambient occlusion of surfaces in a volume by rays through the volume: ``shaders/raycast/occlusion.frag``."""

from __future__ import annotations

from typing import TYPE_CHECKING

import moderngl
import numpy as np
import numpy.typing as npt

from ..effects.screen import FIRST_UNIT, ScreenEffect
from ..errors import EngineError
from .blocks import CONSTANTS
from .renderer import FEATURES_OF_FILTER, RaycastRenderer

if TYPE_CHECKING:
    from ...raycast.casting import Casting
    from ..gbuffer import GBuffer

__all__ = ["GOLDEN", "LIFT", "MAX_SAMPLES", "RayOcclusionPass"]

MAX_SAMPLES = 4096
"""Rays of a pixel; more change nothing that 11 bits can show."""

LIFT = 0.25
"""Voxels by which rays start above the surface: shading has smoother normals than the field has surfaces, and rays that
are flat to the one would start below the other."""

GOLDEN = (3242174889, 2447445414)
"""Steps of the sequence of directions, over 2^32: 1 / p and 1 / p^2 for the root p of p^3 = p + 1 (Roberts' R2)."""

_NAME = "ray occlusion"


class RayOcclusionPass(ScreenEffect):
    """How open each pixel's point of a surface is, by equation 10.

    Parameters
    ----------
    ctx : moderngl.Context

    Notes
    -----
    Source: Lesar, "Real-time ray casting of volumetric data" (2015), section III.G.
    """

    def __init__(self, ctx: moderngl.Context) -> None:
        super().__init__(ctx, {**CONSTANTS, "lift": LIFT, "golden_u": GOLDEN[0], "golden_v": GOLDEN[1]})

    def draw(
        self,
        renderer: RaycastRenderer,
        buffer: GBuffer,
        casting: Casting,
        to_data: npt.ArrayLike = np.eye(3),
        *,
        radius: float,
        samples: int = 32,
        seed: int = 0,
    ) -> moderngl.Texture:
        """Bring the texture up to date.

        Parameters
        ----------
        renderer : RaycastRenderer
            What drew the picture, and nothing else since.
        buffer : GBuffer
            The picture.
        casting : Casting
            What it was drawn with: of mode ``'isosurface'``.
        to_data : array_like, optional
            ``(3, 3)``: directions in the world, in mm of which the hemisphere and the radius are, to those in the
            volume's coordinates.
        radius : float
            mm of the world: what is farther does not occlude. Above 0.
        samples : int, default: 32
            Rays of each pixel, 1 to `MAX_SAMPLES`.
        seed : int, default: 0
            The same picture with the same seed has the same rays; 32 bits are looked at.

        Returns
        -------
        moderngl.Texture
            float16, the share of the rays that meets nothing, 1 where nothing shows; valid until the next draw.

        Raises
        ------
        EngineError
            If the picture is of another mode, or memory does not suffice.
        """
        if casting.mode != "isosurface":
            raise EngineError(f"rays of occlusion start on surfaces; the picture is of mode {casting.mode!r}")
        turn = np.asarray(to_data, np.float64)
        uniforms = {
            "to_data": tuple(turn.T.ravel().tolist()),
            "radius": float(radius),
            "samples": int(samples),
            "seed": int(seed) & 0xFFFFFFFF,
        }
        texture = self._target(_NAME, buffer.size, "f2")

        def rays() -> None:
            program, array = self._programs.screen("raycast/occlusion.frag", FEATURES_OF_FILTER[casting.filter])
            renderer.bind_field(program)
            read = {"shown_depth": buffer.depth, "shown_position": buffer.position}
            for unit, (name, of_picture) in enumerate(read.items(), start=FIRST_UNIT + 8):
                of_picture.use(unit)
                program[name] = unit
            for name, value in uniforms.items():
                program[name] = value
            if _NAME not in self._queries:
                self._queries[_NAME] = self._ctx.query(time=True)
            with self._queries[_NAME]:
                self._targets[_NAME][1].use()
                array.render(moderngl.TRIANGLES, vertices=3)

        self._once((buffer, buffer.generation, *uniforms.values()), rays)
        return texture
