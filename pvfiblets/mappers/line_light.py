"""The light that falls on lines unless another is asked for, by which their colours stay what they are."""

from __future__ import annotations

from typing import Any

import numpy as np

from pvfiblets.mappers.shader_effects import Draw, Piece

__all__ = ["LegendColours", "LineLight", "light_of"]


def light_of(renderer: Any) -> tuple[float, float, float]:
    """Return what the lights of a renderer that are on add up to, red, green and blue."""
    lights = renderer.GetLights()
    on = [light for light in (lights.GetItemAsObject(i) for i in range(lights.GetNumberOfItems())) if light.GetSwitch()]
    total = sum((light.GetIntensity() * np.array(light.GetDiffuseColor()) for light in on), np.zeros(3))
    return float(total[0]), float(total[1]), float(total[2])


class LineLight(Piece):
    """Illuminated lines (Zöckler 1996, Mallo 2005) with a floor: light shows shape and leaves colours true."""

    features = frozenset({"line_light"})

    def set_uniforms(self, kept: Any, program: Any, draw: Draw) -> None:  # noqa: ARG002 - as of all extras
        """Set what the lights of the scene add up to."""
        program.SetUniform3f("fibletLights", light_of(draw.renderer))


class LegendColours(Piece):
    """Colours as they are, whatever the lights: those that a scalar bar or a legend explains."""

    features = frozenset({"legend_colours"})
