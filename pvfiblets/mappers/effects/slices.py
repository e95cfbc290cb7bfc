"""`Slices`, an effect of a mapper of fiblets: where it is translucent, all lines show through each other.

The mapper's geometry then has two triangles for the nearest lines and for each slice of those behind them
(`pvfiblets.mappers.vtk_pipeline.proxy`), the farthest first, so that VTK blends them with all else that is translucent,
by depth peeling too.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

from pvfiblets.engine.fiblets.gather.gathering import SLICES
from pvfiblets.engine.fiblets.gather.paint import Paint
from pvfiblets.mappers.effects.gathering import Sums, paint_of
from pvfiblets.mappers.effects.shader_effects import ShaderEffect

if TYPE_CHECKING:
    import moderngl

    from pvfiblets.mappers.effects.shader_effects import Draw


@dataclass(frozen=True)
class Slices(ShaderEffect):
    """All lines behind the nearest show, blended in slices by distance (`pvfiblets.engine.fiblets.gather.gathering`).

    The nearest line of each pixel is exact, and so is what all lines let through where they have the same opacity.
    Lines of one slice are blended as if they were mixed evenly.
    """

    features: ClassVar[frozenset[str]] = frozenset(
        {"sums", "slices", "slices_colour", "layers_covered", "layers_geometry"}
    )
    count: ClassVar[int] = SLICES + 1

    def make(self, ctx: moderngl.Context) -> Sums:
        """Make room for a window's sums."""
        return Sums(ctx)

    def prepare(self, kept: Sums, draw: Draw) -> Mapping[str, Any]:
        """Add up lines in the engine, unless nothing shows through or VTK selects."""
        through = draw.renderer.GetSelector() is None and draw.actor.HasTranslucentPolygonalGeometry()
        textures = kept.textures(draw, _paint(draw) if through else None, sliced=True)
        keys = None if kept.held is None else kept.held.keys
        return {**textures, "fibletSliceKeys": draw.buffer.depth if keys is None else keys}

    def set_uniforms(self, kept: Sums, program: Any, draw: Draw) -> None:  # noqa: ARG002 - as of all effects
        """Set the number of slices, and how to read them."""
        kept.set_uniforms(program)
        program.SetUniformi("fibletLayerCount", 1 if kept.held is None else self.count)
        paint = kept.paint
        varied = 0.0 if paint is None or paint.opacity is None else paint.absorbance
        program.SetUniformf("fibletAbsorbance", varied)


def _paint(draw: Draw) -> Paint:
    opacity = float(draw.actor.GetProperty().GetOpacity()) if draw.colouring.translucent() else None
    return paint_of(draw, lit="line_light" in draw.actor.GetMapper().features, opacity=opacity)
