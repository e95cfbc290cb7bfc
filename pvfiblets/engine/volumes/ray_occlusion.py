"""Ambient occlusion of surfaces in a volume by rays through the volume (``shaders/volumes/ray_occlusion.frag``)."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import moderngl
import numpy as np
import numpy.typing as npt

from ...volumes.octree import LEAF
from ..effects.screen import ScreenEffect
from ..errors import EngineError
from ..gl.bindings import VOLUME_OCCLUSION
from ..gl.work_limits import WorkLimits
from .renderer import VolumeRenderer
from .uniform_blocks import CONSTANTS

if TYPE_CHECKING:
    from ...volumes.raycast_options import RaycastOptions
    from ...volumes.volume import RaycastVolume
    from ..gbuffer import GBuffer
    from ..view import View

MAX_SAMPLES = 2048  # rays of a pixel: the most that float16 counts one by one

MOST_TURNS = 20_000
"""Turns of loops in one draw of a pixel. Mesa's software OpenGL leaves all loops after 65,535 without a word, lanes of
a vector do not turn together, and other drivers kill what draws for seconds: more rays are cast in several draws."""

LIFT = 0.25
"""Voxels by which rays start above the surface: shading has smoother normals than the field has surfaces, and rays that
are flat to the one would start below the other."""

GOLDEN = (3242174889, 2447445414)
"""Steps of the sequence of directions, over 2^32: 1 / p and 1 / p^2 for the root p of p^3 = p + 1 (Roberts' R2)."""

AWAY, NEAR, BEND, MEAN_SAMPLES = 0.06, 0.2, 0.15, 16.0
"""What the mean looks at: parts of the radius out of a pixel's plane and from its place, and 1 less the cosine between
normals, all for so many rays. Of four other choices none erred less on both sets of the report's study of volumes;
with these no number of rays errs more than without the mean."""

_NAME, _MEAN = "ray occlusion", "mean ray occlusion"


class RayOcclusionPass(ScreenEffect):
    """How open each pixel's point of a surface is, by equation 10.

    Source: Lesar, "Real-time ray casting of volumetric data" (2015), section III.G.
    """

    def __init__(self, ctx: moderngl.Context) -> None:
        super().__init__(ctx, {**CONSTANTS, "lift": LIFT, "golden_u": GOLDEN[0], "golden_v": GOLDEN[1]})

    def draw(
        self,
        renderer: VolumeRenderer,
        buffer: GBuffer,
        casting: RaycastOptions,
        view: View,
        to_data: npt.ArrayLike | None = None,
        *,
        radius: float,
        samples: int = 32,
        seed: int = 0,
        smooth: bool = False,
    ) -> moderngl.Texture:
        """Bring the texture up to date."""
        if casting.mode != "isosurface":
            raise EngineError(f"rays of occlusion start on surfaces; the picture is of mode {casting.mode!r}")
        turn = np.eye(3) if to_data is None else np.asarray(to_data, np.float64)
        uniforms = {
            "to_data": tuple(turn.T.ravel().tolist()),
            "radius": float(radius),
            "seed": int(seed) & 0xFFFFFFFF,
        }
        turns = turns_of_ray(renderer.volume, casting, turn, radius)
        portion = max(1, min(samples, MOST_TURNS // turns))
        texture = self._target(_NAME, buffer.size, "f2")
        if smooth:
            texture = self._target(_MEAN, buffer.size, "f2")
        elif _MEAN in self._targets:
            self._drop(_MEAN)
            self._timers.drop(_MEAN)
        read = {"surface_depth": buffer.depth, "surface_position": buffer.position}

        def bound(program: moderngl.Program, textures: Mapping[str, Any]) -> None:
            for name, of_picture in textures.items():
                of_picture.use(VOLUME_OCCLUSION[name])
                program[name] = VOLUME_OCCLUSION[name]

        def mean() -> None:
            program, array = self._programs.screen("volumes/ray_occlusion_mean.frag")
            bound(program, read | {"surface_normal": buffer.across, "rough": self._targets[_NAME][0]})
            # The less chance there is in a pixel, the less may be lost to the mean.
            reach = math.sqrt(MEAN_SAMPLES / samples)
            in_data = float(radius) * float(np.linalg.norm(turn, 2))
            for name, part in {"away": AWAY * in_data, "near": NEAR * in_data, "bend": BEND}.items():
                program[name] = part * reach
            with self._timers.timed(_MEAN):
                self._targets[_MEAN][1].use()
                array.render(moderngl.TRIANGLES, vertices=3)

        def rays() -> None:
            cut = [] if view.region is None else ["CLIP_REGION"]
            whole = [] if casting.octree else ["VOLUME_WHOLE"]
            features = [*renderer.field_features(casting), *whole, *cut]
            program, array = self._programs.screen("volumes/ray_occlusion.frag", features)
            renderer.bind_field(program)
            if cut:
                clip = view.model_view_projection @ renderer.volume.affine
                program["to_clip"] = tuple((clip / np.abs(clip).max()).T.ravel().tolist())
            bound(program, read)
            for name, value in uniforms.items():
                program[name] = value
            with self._timers.timed(_NAME):
                target, limits = self._targets[_NAME][1], WorkLimits.from_context(self._ctx)
                target.use()
                target.clear()
                self._ctx.enable(moderngl.BLEND)
                self._ctx.blend_equation = moderngl.FUNC_ADD, moderngl.FUNC_ADD
                self._ctx.blend_func = moderngl.ONE, moderngl.ONE
                for first in range(0, samples, portion):
                    program["first_sample"] = first
                    program["samples"] = min(portion, samples - first)
                    limits.draw(target, portion * turns, lambda: array.render(moderngl.TRIANGLES, vertices=3))
                self._ctx.blend_func = moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA
                self._ctx.disable(moderngl.BLEND)
            if smooth:
                mean()

        self._once((buffer, buffer.generation, samples, smooth, *uniforms.values()), rays)
        return texture


def turns_of_ray(
    volume: RaycastVolume, casting: RaycastOptions, to_data: npt.NDArray[np.float64], radius: float
) -> int:
    """Return how often the loops of a ray may turn: once a step, and for each leaf once a level of the octree."""
    size = np.array(volume.shape, np.float64)
    along = float(np.linalg.norm(to_data, 2))
    mm = min(radius * along, volume.diagonal)
    steps = mm / casting.step_mm(volume.spacing, volume.shape)
    leaves = min(float(np.linalg.norm(volume.inverse[:3, :3], 2)) * mm, float(size.sum())) * 3.0 / LEAF + 4.0
    return math.ceil(steps + leaves * (2.0 + math.log2(max(size.max() / LEAF, 1.0) + 1.0)))
