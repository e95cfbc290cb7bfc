"""The light that lines have by default, against its formula, and the colours that it leaves alone."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv

from pvfiblets.mappers import Colouring
from pvfiblets.mappers.line_light import LegendColours, LineLight

COLOUR = np.array([255, 127.5, 63.75])
SHOULDER = np.array([-1.0, 1.0, 1.0]) / 3**0.5
"""From where the light of the camera's lights comes: right, up, towards the viewer."""
TO_VIEW = np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]])
"""From data to view coordinates, seen from -y with z upwards."""


def unit(*vector):
    return np.array(vector, float) / np.linalg.norm(vector)


def lamp(light_type, *towards, intensity=1.0, color="white"):
    light = pv.Light(position=np.array(towards) * 1e3, focal_point=(0, 0, 0), light_type=light_type, color=color)
    light.positional, light.intensity = False, intensity
    return light


@pytest.fixture
def rod(make_plotter, make_fibres, tools):
    """Return a function: colour of a short straight rod in the middle of the view from -y, or its share of COLOUR."""

    def run(direction, *lights, effect=None, lighting="none", specular=0.0):
        along = np.linspace(-10, 10, 41)[:, None] * unit(*direction)
        fibres = make_fibres(type(tools.helices(1, 2)).from_list([along]))
        mapper, actor = fibres.actor(lighting=True, colouring=Colouring("solid", color=tuple(COLOUR / 255)))
        mapper.set_effect("light", LineLight() if effect is None else effect)
        actor.GetProperty().SetSpecular(specular)
        plotter = make_plotter(lighting=lighting, window_size=(61, 61))
        plotter.add_actor(actor, reset_camera=False)
        for light in lights:
            plotter.add_light(light)
        plotter.camera_position = [(0, -200, 0), (0, 0, 0), (0, 0, 1)]
        plotter.camera.view_angle = 4.0
        plotter.renderer.ResetCameraClippingRange()
        image = tools.picture(plotter, mapper)
        middle = image[28:33, 28:33]
        return np.median(middle[tools.covered(middle)], axis=0)

    return run


RODS = [(1, 0, 0), (0, 0, 1), (0.1, 1, 0.1), (-1, -1, 1), (1, 0.7, 0.2), (0.3, -0.8, 0.5)]


def share(direction, towards):
    return 0.6 + 0.4 * (1.0 - (unit(*direction) @ towards) ** 4)


@pytest.mark.few(5)
@pytest.mark.parametrize("direction", RODS)
@pytest.mark.parametrize("lighting", ["light kit", "headlight"])
def test_lights_of_the_camera_come_over_the_shoulder(rod, direction, lighting):
    """However many they are; and the kit's warm and cold light is white."""
    lights = [lamp("headlight", 0, 0, 1)] if lighting == "headlight" else []
    seen = rod(direction, *lights, lighting="none" if lights else lighting)
    assert np.allclose(seen, COLOUR * share(direction, SHOULDER @ TO_VIEW), atol=2)


def test_no_direction_loses_more_than_two_fifths(rod):
    """The direction of the light itself has the least: the floor. Lines along the view axis keep what others do."""
    least = rod(SHOULDER @ TO_VIEW, lamp("headlight", 0, 0, 1))
    assert np.allclose(least, 0.6 * COLOUR, atol=2)
    axes = [share(axis, SHOULDER @ TO_VIEW) for axis in np.eye(3)]
    np.testing.assert_allclose(axes, 1.0 - 0.4 / 9)


@pytest.mark.parametrize("direction", RODS)
def test_a_light_in_the_scene_shines_from_where_it_is(rod, direction):
    towards = unit(3, 1, 2)
    assert np.allclose(rod(direction, lamp("scene light", *towards)), COLOUR * share(direction, towards), atol=2)


def test_lights_in_the_scene_count_by_their_strength(rod):
    a, b = unit(3, 1, 2), unit(-1, -4, 1)
    seen = rod((1, 0, 0), lamp("scene light", *a, intensity=0.9), lamp("scene light", *b, intensity=0.3))
    assert np.allclose(seen, COLOUR * (0.75 * share((1, 0, 0), a) + 0.25 * share((1, 0, 0), b)), atol=2)


def test_weak_lights_are_weak_and_coloured_ones_coloured(rod):
    weak = rod((1, 0, 0), lamp("headlight", 0, 0, 1, intensity=0.4))
    assert np.allclose(weak, 0.4 * COLOUR * share((1, 0, 0), SHOULDER @ TO_VIEW), atol=2)
    red = rod((1, 0, 0), lamp("headlight", 0, 0, 1, color="red"))
    assert np.allclose(red, COLOUR * (1, 0, 0) * share((1, 0, 0), SHOULDER @ TO_VIEW), atol=2)


@pytest.mark.parametrize("lighting", ["light kit", "headlight"])
def test_highlights_are_added(rod, lighting):
    lights = [lamp("headlight", 0, 0, 1)] if lighting == "headlight" else []
    kind = "none" if lights else lighting
    assert (rod((1, 0, 0), *lights, lighting=kind, specular=0.5) > rod((1, 0, 0), *lights, lighting=kind) + 5)[1:].all()


@pytest.mark.few(5)
@pytest.mark.parametrize("lighting", ["light kit", "headlight"])
@pytest.mark.parametrize("direction", RODS)
def test_colours_of_a_legend_stay_as_they_are(rod, direction, lighting):
    lights = [lamp("headlight", 0, 0, 1)] if lighting == "headlight" else []
    seen = rod(direction, *lights, effect=LegendColours(), lighting="none" if lights else lighting)
    assert np.allclose(seen, COLOUR, atol=1)
