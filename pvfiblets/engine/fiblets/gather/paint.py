"""`Paint`: what a line adds to the pixels that it takes, where all lines of a pixel are added up."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from ....colour_modes import MODES
from ...gl.bindings import GATHERING

MOST_OPAQUE = 0.999
"""Opacity of a line beyond which it counts as no more opaque (``shaders/fiblets/gather/paint_weight.glsl``)."""


@dataclass(frozen=True)
class Paint:
    """The contribution of a line to its pixels, beside its count."""

    mode: str = ""  # one of `pvfiblets.colour_modes.MODES`; `''`: no colour
    # textures of `shaders/colour` by their samplers: `colour_list` or `colour_table`
    textures: Mapping[str, Any] = field(default_factory=dict)
    uniforms: Mapping[str, Any] = field(default_factory=dict)  # uniforms of `shaders/colour`
    logarithm: bool = False  # whether the table is spread over logarithms
    # unit vector, data coordinates, to a light that dims lines which run towards it. None: colours as they are.
    light: tuple[float, ...] | None = None
    # of the whole drawable, where colours have opacities of their own; None where all lines have the same
    opacity: float | None = None
    opacities: Any = None  # RGBA of 8 bits, row by row: alphas are the streamlines' opacities; with `opacity`
    value_opacity: bool = False  # whether the style's per-point value is an opacity; with `opacity`
    version: Any = None  # another one if the content of textures is another

    @property
    def features(self) -> tuple[str, ...]:
        """Keys of :data:`pvfiblets.engine.gl.shaders.FEATURES`."""
        if not self.mode:
            return ()
        mode = MODES[self.mode]
        wanted = {
            mode.feature: True,
            "TABLE_LOGARITHM": self.logarithm,
            "PAINT_VALUE": mode.reads == "position" or self.value_opacity,
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
        found = [(name, texture, GATHERING["colours"]) for name, texture in self.textures.items()]
        found.append(("paint_opacities", self.opacities, GATHERING["paint_opacities"]))
        units = {}
        for name, texture, unit in found:
            if texture is not None and name in program:
                texture.use(unit)
                units[name] = unit
        absorbance = self.absorbance
        set_uniforms(
            program,
            **units,
            **self.uniforms,
            paint_light=self.light,
            paint_opacity=self.opacity,
            paint_unit=1.0 / absorbance if absorbance > 0.0 else 0.0,
        )


def set_uniforms(program: Any, **values: Any) -> None:
    """Set those uniforms of a program that it has."""
    for name, value in values.items():
        if name in program:
            program[name] = value
