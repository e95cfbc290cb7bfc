"""The base of effects that show all lines of a pixel: the engine's sums, as textures and uniforms.

The engine adds up what lines add (`pvfiblets.engine.fiblets.gather.gathering`); which colours they have is the
mapper's to say.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets.engine.fiblets.gather.gathering import Gathered
from pvfiblets.engine.fiblets.gather.paint import Paint
from pvfiblets.mappers.effects.blank_arrays import BlankArrays
from pvfiblets.mappers.effects.uniforms import colour_uniforms
from pvfiblets.mappers.frames.scene import others_opaque
from pvfiblets.mappers.frames.scene_depth import OutsideDepth
from pvfiblets.mappers.frames.scene_state import scene_state

if TYPE_CHECKING:
    import moderngl

    from pvfiblets.mappers.effects.shader_effects import Draw

_SHOULDER = np.array([-1.0, 1.0, 1.0]) / np.sqrt(3.0)
"""Direction of light in view coordinates (``shaders/frame/gentle_light.glsl``)."""


def paint_of(draw: Draw, *, lit: bool, opacity: float | None = None) -> Paint:
    """Return the colours that lines have in a draw."""
    colouring, textures = draw.colouring, draw.textures
    light = None
    if lit:
        to_light = np.linalg.inv(draw.frame.directions_to_view) @ _SHOULDER
        light = tuple(float(x) for x in to_light / (np.linalg.norm(to_light) or 1.0))
    varied = opacity is not None
    return Paint(
        colouring.mode,
        textures={name: textures[name] for name in ("colour_list", "colour_table") if name in textures},
        uniforms=colour_uniforms(colouring, draw.fiblets),
        logarithm="table_logarithm" in colouring.features,
        light=light,
        opacity=opacity,
        opacities=textures.get("fibletOpacities") if varied else None,
        value_opacity=varied and colouring.opacity_source is not None,
        version=colouring,
    )


class Sums:
    """An effect's state in one window: the engine that has sums, or empty textures."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx  # of the window
        self._engine: Any = None
        self._outside: OutsideDepth | None = None
        self._blank = BlankArrays(ctx, "none")
        self.held: Gathered | None = None  # of the last draw
        self.most = 1.0  # lines in its fullest pixel, where an effect asked for that
        self.known = False  # whether one has
        self.paint: Paint | None = None  # of the last draw

    def textures(self, draw: Draw, paint: Paint | None, *, sliced: bool = False) -> dict[str, Any]:
        """Return textures by the names of their samplers."""
        self.paint = paint
        if paint is None:
            self._drop()
        else:
            self._engine = draw.engine
            hidden = draw.actor is not None and others_opaque(draw.renderer, draw.actor)
            self.held = draw.engine.gather(
                draw.view,
                draw.style,
                paint,
                sliced=sliced,
                outside=(lambda: self._depth(draw)) if hidden else None,
                state=scene_state(draw.renderer) if hidden else None,
            )
        found = {}
        for name, dtype, words in (("fibletSumWords", "u4", True), ("fibletSumFloats", "f4", False)):
            here = self.held is not None and self.held.words is words
            found[name] = self.held.texture if here and self.held is not None else self._blank.named(name, 1, dtype)
        return found

    def _depth(self, draw: Draw) -> moderngl.Texture | None:
        """Return the depth of the scene's opaque objects, or None if it cannot be read."""
        if self._outside is None:
            self._outside = OutsideDepth(self._ctx)
        viewport = draw.frame.viewport
        found = self._outside.copy(viewport)
        return self._outside.copy_of_window(draw.renderer, viewport[2:]) if found is None else found

    def set_uniforms(self, program: Any) -> None:
        """Set the shape of the sums."""
        held = self.held
        program.SetUniform2i("fibletSumShape", (0, 0) if held is None or not held.words else held.shape)

    def explain(self) -> dict[str, list[dict[str, Any]]]:
        """Return the engine's ``passes``, and ``buffers``, name and bytes."""
        return {"passes": [], "buffers": self._blank.buffers()}

    def _drop(self) -> None:
        if self._engine is not None:
            self._engine.drop_gathered()
        self._engine = self.held = None

    def release(self) -> None:
        """Give everything back; twice is harmless."""
        self._drop()
        self._blank.release()
        if self._outside is not None:
            self._outside.release()
            self._outside = None
