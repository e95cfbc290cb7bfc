"""Lamps for light through a volume, from VTK's lights and an actor's property."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets.mappers.effects.shader_effects import ShaderEffect
from pvfiblets.mappers.frames.scene import items_of, to_array

if TYPE_CHECKING:
    from vtkmodules.vtkRenderingCore import vtkActor, vtkRenderer

    from pvfiblets.engine.volumes.shading import Lamp, Shading


class OwnLight(ShaderEffect):
    """Light that is shaded already: what the actor's property reflects does not count again."""

    features = frozenset({"own_light"})


def shading_of(renderer: vtkRenderer, actor: vtkActor) -> Shading:
    """Return the lights of a renderer that are on, as an actor's property reflects them."""
    from pvfiblets.engine.volumes.shading import Shading

    on = [light for light in items_of(renderer.GetLights()) if light.GetSwitch() and light.GetIntensity() > 0.0]
    lamps = tuple(_lamp(light) for light in on)
    camera, reflection = renderer.GetActiveCamera(), actor.GetProperty()
    if camera.GetParallelProjection():
        eye = (*(-np.array(camera.GetDirectionOfProjection())).tolist(), 0.0)
    else:
        eye = (*camera.GetPosition(), 1.0)
    return Shading(
        lamps,
        eye,
        tuple(to_array(actor.GetMatrix()).ravel().tolist()),
        reflection.GetAmbient(),
        reflection.GetDiffuse(),
        reflection.GetSpecular(),
        reflection.GetSpecularPower(),
    )


def _lamp(light: Any) -> Lamp:
    from pvfiblets.engine.volumes.shading import Lamp

    place, aim = np.array(light.GetTransformedPosition()), np.array(light.GetTransformedFocalPoint())
    colour, highlight = (
        tuple(light.GetIntensity() * channel for channel in colours)
        for colours in (light.GetDiffuseColor(), light.GetSpecularColor())
    )
    positional = bool(light.GetPositional())
    return Lamp(
        tuple((place if positional else place - aim).tolist()),
        positional,
        colour,
        highlight,
        tuple((aim - place).tolist()),
        light.GetConeAngle(),
        light.GetExponent(),
        light.GetAttenuationValues(),
    )
