"""`Paint`: what a line adds to the pixels that it takes, where all lines of a pixel are added up."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from ...gl.bindings import GATHERING

__all__ = ["Paint", "set_uniforms"]

MOST_OPAQUE = 0.999
"""Opacity of a line beyond which it counts as no more opaque (``shaders/fiblets/gather/paint_weight.glsl``)."""


@dataclass(frozen=True)
class Paint:
    """What a line adds to the pixels that it takes, beside being there.

    Parameters
    ----------
    source : {'none', 'direction', 'solid', 'streamline', 'table', 'point'}
        No colour; the absolute value of its direction; one colour; a colour per streamline; the style's per-point value
        through a table, or as the colour that it is.
    color : tuple of 3 floats
        For ``'solid'``, 0 to 1.
    colours : moderngl.Texture, optional
        RGBA of 8 bits, row by row: of streamlines, or of a table with the colours of below, above and NaN at its end.
    entries : int
        Of the table, without these three.
    range : tuple of 3 floats
        Values of the table's ends and entries per unit; logarithms if ``logarithm``.
    logarithm : bool
    light : tuple of 3 floats, optional
        Unit vector, data coordinates, to a light that dims lines which run towards it. None: colours as they are.
    opacity : float, optional
        Of the whole drawable, where colours have opacities of their own; None where all lines have the same.
    opacities : moderngl.Texture, optional
        RGBA of 8 bits, row by row: alphas are those of streamlines; with ``opacity``.
    value_opacity : bool
        Whether the style's per-point value is an opacity; with ``opacity``.
    version : object
        Another one if the content of textures is another.
    """

    source: str = "none"
    color: tuple[float, ...] = (1.0, 1.0, 1.0)
    colours: Any = None
    entries: int = 0
    range: tuple[float, float, float] = (0.0, 1.0, 1.0)
    logarithm: bool = False
    light: tuple[float, ...] | None = None
    opacity: float | None = None
    opacities: Any = None
    value_opacity: bool = False
    version: Any = None

    @property
    def features(self) -> tuple[str, ...]:
        """Keys of :data:`pvfiblets.engine.gl.shaders.FEATURES`."""
        if self.source == "none":
            return ()
        wanted = {
            f"PAINT_{self.source.upper()}": True,
            "PAINT_LOGARITHM": self.logarithm,
            "PAINT_LIGHT": self.light is not None,
            "PAINT_ALPHA": self.opacity is not None,
            "PAINT_OPACITIES": self.opacities is not None,
            "PAINT_VALUE_OPACITY": self.value_opacity,
        }
        return ("PAINTED", *(name for name, on in wanted.items() if on))

    @property
    def absorbance(self) -> float:
        """Absorbance that a weight of 1 stands for, where colours have opacities of their own."""
        return -math.log(1.0 - min(self.opacity or 0.0, MOST_OPAQUE)) / 255.0

    def bind(self, program: Any) -> None:
        """Bind textures, and set those uniforms that a program has."""
        if self.colours is not None and "paint_colours" in program:
            self.colours.use(GATHERING["paint_colours"])
        if self.opacities is not None and "paint_opacities" in program:
            self.opacities.use(GATHERING["paint_opacities"])
        unit = self.absorbance
        set_uniforms(
            program,
            paint_colours=GATHERING["paint_colours"],
            paint_opacities=GATHERING["paint_opacities"],
            paint_solid=tuple(self.color[:3]),
            paint_entries=self.entries,
            paint_range=self.range,
            paint_light=self.light,
            paint_opacity=self.opacity,
            paint_unit=1.0 / unit if unit > 0.0 else 0.0,
        )


def set_uniforms(program: Any, **values: Any) -> None:
    """Set those uniforms of a program that it has."""
    for name, value in values.items():
        if name in program:
            program[name] = value
