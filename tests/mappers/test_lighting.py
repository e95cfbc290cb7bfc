"""Lights on fiblets against the arithmetic of VTK's light model."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv

from pvfiblets.mappers import Colouring


@pytest.fixture
def rod(make_plotter, make_fibres, tools):
    """Return a function: colour of a straight rod, seen from -y, by direction of the rod and lights."""

    def run(direction, lights=None, *, parallel=True, lighting=True, prepare=None):
        along = np.linspace(-10, 10, 41)[:, None] * np.asarray(direction, float)
        fibres = make_fibres(type(tools.helices(1, 2)).from_list([along]))
        mapper, actor = fibres.actor(lighting=lighting, colouring=Colouring("solid", color=(1.0, 0.5, 0.25)))
        actor.GetProperty().SetAmbient(0.1)
        actor.GetProperty().SetDiffuse(0.8)
        actor.GetProperty().SetSpecular(0.0)
        if prepare:
            prepare(actor)
        plotter = make_plotter(lighting="none" if lights is not None else "light kit")
        plotter.add_actor(actor)
        for light in lights or ():
            plotter.add_light(light)
        plotter.camera_position = "xz"
        if parallel:
            plotter.enable_parallel_projection()
        plotter.reset_camera()
        image = tools.picture(plotter, mapper)
        mask = tools.covered(image)
        assert mask.sum() > 20
        return np.median(image[mask], axis=0)

    return run


def headlight(intensity=1.0):
    light = pv.Light(light_type="headlight", intensity=intensity)
    light.positional = False
    return light


def sun(x, y, z):
    light = pv.Light(position=(x, y, z), focal_point=(0, 0, 0), light_type="scene light")
    light.positional = False
    return light


def test_a_headlight_lights_a_line_across_the_view_fully(rod):
    assert np.allclose(rod((1, 0, 0), [headlight()]), np.array([255, 127, 64]) * 0.9, atol=1.5)


@pytest.mark.parametrize("tilt", [20, 50, 75])
def test_a_tilted_line_is_lit_by_the_sine(rod, tilt):
    """The best normal makes the angle of the tilt with the viewer: diffuse falls with its cosine."""
    angle = np.radians(tilt)
    seen = rod((np.cos(angle), np.sin(angle), 0), [headlight()])
    expected = np.array([255, 127.5, 63.75]) * (0.1 + 0.8 * np.cos(angle))
    assert np.allclose(seen, expected, atol=3)


def test_a_light_from_the_side(rod):
    """The rod along x has the normal -y; a light 60 degrees off in z gives half."""
    light = sun(0, -np.cos(np.pi / 3) * 100, np.sin(np.pi / 3) * 100)
    seen = rod((1, 0, 0), [light])
    assert np.allclose(seen, np.array([255, 127.5, 63.75]) * (0.1 + 0.8 * 0.5), atol=2)


def test_two_lights_add_and_one_from_behind_does_not(rod):
    one = rod((1, 0, 0), [sun(0, -50, 86.6)])
    two = rod((1, 0, 0), [sun(0, -50, 86.6), sun(0, 100, 0)])
    assert np.allclose(one, two, atol=1)
    three = rod((1, 0, 0), [sun(0, -50, 86.6), sun(0, -50, -86.6)])
    assert np.allclose(three, np.array([255, 127.5, 63.75]) * (0.1 + 0.8), atol=3)


def test_without_lighting_the_colour_is_exact(rod):
    def flat(actor):
        actor.GetProperty().SetAmbient(0.0)
        actor.GetProperty().SetDiffuse(1.0)

    seen = rod((0.5, 0.6, 0.3), [headlight(0.3)], lighting=False, prepare=flat)
    assert np.allclose(seen, (255, 128, 64), atol=1)


@pytest.mark.parametrize(
    "place",
    [
        lambda actor: actor.SetOrientation(0, 0, 50),
        lambda actor: (actor.SetScale(1, 1, -1), actor.SetOrientation(0, 0, 50)),
    ],
    ids=["turned", "mirrored"],
)
def test_the_normal_follows_the_actor(rod, place):
    seen = rod((1, 0, 0), [headlight()], prepare=place)
    expected = np.array([255, 127.5, 63.75]) * (0.1 + 0.8 * np.cos(np.radians(50)))
    assert np.allclose(seen, expected, atol=3)


def test_non_uniform_scale_turns_tangents_as_it_turns_lines(rod):
    """A rod at 45 degrees, stretched threefold along x, lies at atan(1/3)."""
    seen = rod((1, 1, 0), [headlight()], prepare=lambda actor: actor.SetScale(3, 1, 1), parallel=True)
    expected = np.array([255, 127.5, 63.75]) * (0.1 + 0.8 * np.cos(np.arctan(1 / 3)))
    assert np.allclose(seen, expected, atol=3)


def test_specular_highlights_need_the_position(rod):
    def shiny(actor):
        actor.GetProperty().SetSpecular(1.0)
        actor.GetProperty().SetSpecularPower(20.0)
        actor.GetProperty().SetDiffuse(0.0)

    seen = rod((1, 0, 0), [headlight()], prepare=shiny, parallel=False)
    # Normal, light and viewer coincide in the middle of the picture: full highlight.
    assert seen.min() > 230


def test_the_default_lights_of_a_plotter(rod):
    assert rod((1, 0, 0)).max() > 100


def test_a_line_straight_at_the_viewer_has_no_nan(make_plotter, make_fibres, tools):
    along = np.linspace(-10, 10, 41)[:, None] * np.array((0.0, 1.0, 0.0))
    fibres = make_fibres(type(tools.helices(1, 2)).from_list([along, along + np.array((5, 0, 0))]))
    mapper, actor = fibres.actor(lighting=True, colouring=Colouring("solid"))
    plotter = make_plotter(lighting="none")
    plotter.add_light(headlight())
    plotter.add_actor(actor)
    plotter.camera_position = "xz"
    plotter.enable_parallel_projection()
    plotter.reset_camera()
    image = tools.picture(plotter, mapper)
    if fibres.kind == "engine":  # GL draws no line of no length on the screen
        assert tools.covered(image).any()
        assert image[tools.covered(image)].min() > 200
