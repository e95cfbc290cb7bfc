"""`RayOcclusion`, an effect of a mapper: surfaces of a volume are darker where rays from them meet it again."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from pvfiblets.mappers.effects.shader_effects import ShaderEffect
from pvfiblets.mappers.effects.shading import extent, positive, share

if TYPE_CHECKING:
    import moderngl

    from pvfiblets.engine.volumes.ray_occlusion import RayOcclusionPass
    from pvfiblets.mappers.effects.shader_effects import Draw

_WHAT = "of ray occlusion"


@dataclass(frozen=True)
class RayOcclusion(ShaderEffect):
    """Surfaces of a volume are darker where the volume itself stands over them, seen or not.

    From every pixel's point of a surface rays are cast into the hemisphere around its normal, the more the steeper. The
    colour is darkened by the share of them that crosses any of the surfaces within a radius. Clipping planes and the
    box of the volume hold for them, and regions as far as the picture shows where they end; other things in the scene,
    and the camera's near plane, do not.

    Source: Lesar, "Real-time ray casting of volumetric data" (2015), section III.G, equation 10.
    """

    # rays of each pixel, 1 to 2048: the error falls faster than the inverse of their number's square root
    samples: int = 32
    # mm: farther geometry does not count. By default a 20th of the diagonal of the data's bounds.
    radius: float | None = None
    strength: float = 1.0  # 0 to 1
    seed: int = 0  # of the directions: the same picture with the same seed is the same to the last bit
    # take the mean over pixels that show the same piece of surface: the fewer the rays, the more it errs less
    smooth: bool = True
    features: ClassVar[frozenset[str]] = frozenset({"ray_occlusion"})

    def __post_init__(self) -> None:
        from pvfiblets.engine.volumes.ray_occlusion import MAX_SAMPLES

        for name, low, high in (("samples", 1, MAX_SAMPLES), ("seed", 0, 2**32 - 1)):
            number = getattr(self, name)
            if isinstance(number, bool) or int(number) != number or not low <= number <= high:
                raise ValueError(f"{name} {_WHAT} is {number!r}; give a whole number from {low} to {high}")
            object.__setattr__(self, name, int(number))
        if self.radius is not None:
            object.__setattr__(self, "radius", positive(self.radius, f"radius {_WHAT}", "mm"))
        object.__setattr__(self, "smooth", bool(self.smooth))
        object.__setattr__(self, "strength", share(self.strength, f"strength {_WHAT}"))

    def make(self, ctx: moderngl.Context) -> RayOcclusionPass:
        """Make the pass."""
        from pvfiblets.engine.volumes.ray_occlusion import RayOcclusionPass

        return RayOcclusionPass(ctx)

    def prepare(self, kept: Any, draw: Draw) -> Mapping[str, Any]:
        """Run it."""
        radius = extent(draw) / 20.0 if self.radius is None else self.radius
        to_data = np.linalg.inv(draw.frame.model[:3, :3])
        texture = kept.draw(
            draw.engine,
            draw.buffer,
            draw.style.casting,
            draw.view,
            to_data,
            radius=radius,
            samples=self.samples,
            seed=self.seed,
            smooth=self.smooth,
        )
        return {"fibletRayOcclusionMap": texture}

    def set_uniforms(self, kept: Any, program: Any, draw: Draw) -> None:  # noqa: ARG002 - as of all effects
        """Set the strength, which changes without any ray cast anew."""
        program.SetUniform2f("fibletRayOcclusion", (self.strength, self.strength / self.samples))
