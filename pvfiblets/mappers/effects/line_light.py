"""The default light on lines, which preserves their colours."""

from __future__ import annotations

from typing import Any

from pvfiblets.mappers.effects.shader_effects import Draw, ShaderEffect


class LineLight(ShaderEffect):
    """Illuminated lines (Zöckler 1996, Mallo 2005) with a floor: light shows shape and leaves colours true."""

    features = frozenset({"line_light"})

    def set_uniforms(self, kept: Any, program: Any, draw: Draw) -> None:  # noqa: ARG002 - as of all effects
        """Set the sum of the lights' brightness, and whether one of them stands in the scene."""
        lights = draw.renderer.GetLights()
        every = [lights.GetItemAsObject(i) for i in range(lights.GetNumberOfItems())]
        on = [light for light in every if light.GetSwitch() and light.GetIntensity() > 0.0]
        brightness = sum(light.GetIntensity() * sum(light.GetDiffuseColor()) for light in on)
        program.SetUniformf("fibletLights", float(brightness))
        program.SetUniformf("fibletStanding", float(any(light.LightTypeIsSceneLight() for light in on)))


class LegendColours(ShaderEffect):
    """Unlit colours, for scalar bars and legends."""

    features = frozenset({"legend_colours"})
