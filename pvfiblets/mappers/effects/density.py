"""`Density`, an effect of a mapper of fiblets: light adds up where lines lie on each other, or numbers count them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets.engine.fiblets.gather.paint import Paint
from pvfiblets.mappers.effects.gathering import Sums, paint_of
from pvfiblets.mappers.effects.shader_effects import ShaderEffect
from pvfiblets.mappers.frames.scene import in_motion
from pvfiblets.mappers.frames.shifted_cameras import draws_sample

if TYPE_CHECKING:
    import moderngl

    from pvfiblets.mappers.effects.shader_effects import Draw

TONES = ("log", "sqrt", "linear")  # functions from the number of lines to brightness


@dataclass(frozen=True)
class Density(ShaderEffect):
    """All lines of a pixel count, not the nearest alone.

    With a colouring of mode ``'pixel_count'`` the number of lines in a pixel goes through its table. With any other,
    a pixel has the mean colour of its lines (of directions, at full brightness), the more of it the more lines there
    are, over the background.
    """

    bright: bool = True  # whether brightness tells the number of lines; False with a colouring of mode `'pixel_count'`
    # whether lines are a pixel wide whatever their width, so that each takes the pixels that it runs through once
    thin: bool = True
    # lines in a pixel of full brightness, or of the table's last colour; the number in the frame's fullest pixel by
    # default
    most: float | None = None
    tone: str = "log"  # how brightness grows with n of m lines: log(1 + n) / log(1 + m), sqrt(n / m), n / m
    # told the number of lines in the fullest pixel of every picture, where `most` is not given
    found: Callable[[float], None] | None = field(default=None, compare=False)

    translucent = True
    smooth_edges = False

    def __post_init__(self) -> None:
        if self.tone not in TONES:
            raise ValueError(f"tone is {self.tone!r}; choose one of {TONES}")
        if self.most is not None and not (np.isfinite(self.most) and self.most > 0.0):
            raise ValueError(f"most is {self.most!r}; give a finite number of lines above 0, or None")

    @property
    def features(self) -> frozenset[str]:
        """Pieces of the resolve; the colouring adds its table's."""
        return frozenset({"sums", "density"} if self.bright else {"sums"})

    @property
    def style(self) -> Mapping[str, Any]:
        """Thin lines, if wanted."""
        return {"line_width": 1.0, "radius": None, "across": False} if self.thin else {}

    def make(self, ctx: moderngl.Context) -> Sums:
        """Make room for a window's sums."""
        return Sums(ctx)

    def prepare(self, kept: Sums, draw: Draw) -> Mapping[str, Any]:
        """Add up lines in the engine, unless VTK selects."""
        if draw.renderer.GetSelector() is not None:
            return kept.textures(draw, None)
        counts = draw.colouring.mode == "pixel_count"
        textures = kept.textures(draw, Paint() if counts else paint_of(draw, lit=False))
        if self.most is None and not (kept.known and draws_sample(draw.renderer)):
            kept.most = draw.engine.most_lines(wait=not in_motion(draw.renderer))
            kept.known = True
        return textures

    def set_uniforms(self, kept: Sums, program: Any, draw: Draw) -> None:
        """Set the uniforms that read the sums, and their maximum."""
        kept.set_uniforms(program)
        most = kept.most if self.most is None else self.most
        if self.most is None and self.found is not None and kept.held is not None:
            self.found(most)
        if self.bright:
            program.SetUniformi("fibletTone", -1 if kept.held is None else TONES.index(self.tone))
            program.SetUniformf("fibletMost", max(most, 1.0))
            program.SetUniformi("fibletHue", int(draw.colouring.mode == "orientation"))
        if draw.colouring.mode == "pixel_count" and self.most is None:
            program.SetUniform3f("colour_range", draw.colouring.scaled_range((draw.colouring.clim[0], most)))
