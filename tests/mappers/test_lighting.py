"""Light on lines against the arithmetic of its models: VTK's, that of illuminated lines, and the default one."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv

from pvfiblets.mappers import Colouring
from pvfiblets.mappers.effects.line_light import LegendColours, LineLight
from pvfiblets.mappers.effects.shading import Illuminated

COLOUR = np.array([255, 127.5, 63.75])
AMBIENT, DIFFUSE, SPECULAR, POWER = 0.05, 0.5, 0.3, 6.0
SHOULDER = np.array([-1.0, 1.0, 1.0]) / 3**0.5
"""From where the default light of the camera's lights comes: right, up, towards the viewer."""
TO_VIEW = np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]])
"""From data to view coordinates, seen from -y with z upwards."""
RODS = [(1, 0, 0), (1, 0.7, 0.2), (0.1, 0.5, 0.9), (0.5, -2.0, 0.3)]


def unit(*vector):
    return np.array(vector, float) / np.linalg.norm(vector)


def lamp(*place, positional=False, intensity=1.0, color="white", attenuation=(1, 0, 0), cone=90.0):
    """A light of the scene; one that is not positional shines from that direction."""
    place = np.array(place) * (1 if positional else 1e3)
    light = pv.Light(position=place, focal_point=(0, 0, 0), light_type="scene light", cone_angle=cone, color=color)
    light.positional, light.intensity, light.attenuation_values = positional, intensity, attenuation
    return light


def headlight(intensity=1.0, color="white"):
    light = pv.Light(light_type="headlight", intensity=intensity, color=color)
    light.positional = False
    return light


@pytest.fixture
def rod(make_plotter, make_fibres, tools):
    """Return a function: colour of a short straight rod in the middle of the view from -y."""

    def run(direction, *lights, effect=None, light=None, lighting=True, place=None, distance=200):
        along = np.linspace(-10, 10, 41)[:, None] * unit(*direction)
        fibres = make_fibres(type(tools.helices(1, 2)).from_list([along]))
        mapper, actor = fibres.actor(lighting=lighting, colouring=Colouring("solid", color=tuple(COLOUR / 255)))
        if effect is not None:
            mapper.set_effect("light", effect)
        prop = actor.GetProperty()
        plain = isinstance(effect, LineLight | LegendColours)
        given = {"Ambient": 0.0, "Diffuse": 1.0} if plain else {"Ambient": AMBIENT, "Diffuse": DIFFUSE}
        for name, value in {**given, "Specular": 0.0, "SpecularPower": POWER, **(light or {})}.items():
            getattr(prop, f"Set{name}")(value)
        if place is not None:
            place(actor)
        kit = [one for one in lights if isinstance(one, str)]
        plotter = make_plotter(lighting=kit[0] if kit else "none", window_size=(61, 61))
        plotter.add_actor(actor, reset_camera=False)
        for one in lights:
            if not isinstance(one, str):
                plotter.add_light(one)
        plotter.camera_position = [(0, -distance, 0), (0, 0, 0), (0, 0, 1)]
        plotter.camera.view_angle = 4.0
        plotter.renderer.ResetCameraClippingRange()
        image = tools.picture(plotter, mapper)
        middle = image[28:33, 28:33]
        return np.median(middle[tools.covered(middle)], axis=0)

    return run


# VTK's model, of the normal that is nearest to the viewer


@pytest.mark.parametrize("tilt", [0, 20, 50, 75])
def test_a_tilted_line_is_lit_by_the_sine(rod, tilt):
    """The best normal makes the angle of the tilt with the viewer: diffuse falls with its cosine."""
    angle = np.radians(tilt)
    seen = rod((np.cos(angle), np.sin(angle), 0), headlight())
    assert np.allclose(seen, COLOUR * (AMBIENT + DIFFUSE * np.cos(angle)), atol=3)


def test_lights_add_and_one_from_behind_does_not(rod):
    """The rod along x has the normal -y; a light 60 degrees off in z gives half."""
    one = rod((1, 0, 0), lamp(0, -50, 86.6))
    assert np.allclose(one, COLOUR * (AMBIENT + DIFFUSE / 2), atol=2)
    assert np.allclose(rod((1, 0, 0), lamp(0, -50, 86.6), lamp(0, 100, 0)), one, atol=1)
    both = rod((1, 0, 0), lamp(0, -50, 86.6), lamp(0, -50, -86.6))
    assert np.allclose(both, COLOUR * (AMBIENT + DIFFUSE), atol=3)


def test_without_lighting_the_colour_is_exact(rod):
    plain = rod((0.5, 0.6, 0.3), headlight(0.3), lighting=False, light={"Ambient": 0.0, "Diffuse": 1.0})
    assert np.allclose(plain, (255, 128, 64), atol=1)
    seen = rod((1, 0.7, 0.2), lamp(1, 2, 3), lighting=False, effect=Illuminated())
    assert np.allclose(seen, COLOUR * (AMBIENT + DIFFUSE), atol=1)  # nothing to illuminate


@pytest.mark.parametrize(
    ("direction", "place", "angle"),
    [
        ((1, 0, 0), lambda actor: actor.SetOrientation(0, 0, 50), 50.0),
        ((1, 0, 0), lambda actor: (actor.SetScale(1, 1, -1), actor.SetOrientation(0, 0, 50)), 50.0),
        ((1, 1, 0), lambda actor: actor.SetScale(3, 1, 1), np.degrees(np.arctan(1 / 3))),
    ],
    ids=["turned", "mirrored", "stretched"],
)
def test_the_normal_follows_the_actor(rod, direction, place, angle):
    seen = rod(direction, headlight(), place=place)
    assert np.allclose(seen, COLOUR * (AMBIENT + DIFFUSE * np.cos(np.radians(angle))), atol=3)


def test_specular_highlights_need_the_position(rod):
    """Normal, light and viewer coincide in the middle of the picture: full highlight."""
    assert rod((1, 0, 0), headlight(), light={"Specular": 1.0, "Diffuse": 0.0}).min() > 230


@pytest.mark.parametrize("effect", [None, LineLight(), Illuminated()])
def test_highlights_come_and_go_with_the_property(make_plotter, make_fibres, tools, effect):
    def drawn(*values):
        grey = Colouring("solid", color=(0.6, 0.6, 0.6))
        mapper, actor = make_fibres(tools.helices(5, 40)).actor(lighting=True, colouring=grey)
        if effect is not None:
            mapper.set_effect("light", effect)
        plotter = make_plotter(lighting="light kit")
        plotter.add_actor(actor)
        pictures = []
        for value in values:
            actor.GetProperty().SetSpecular(value)
            pictures.append(tools.picture(plotter, mapper).astype(int))
        return pictures

    dull, bright, again = drawn(0.0, 0.8, 0.0)
    (at_once,) = drawn(0.8)
    assert (bright - dull).max() > 25
    np.testing.assert_array_equal(bright, at_once)
    np.testing.assert_array_equal(again, dull)


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
    assert tools.covered(image).any()
    assert image[tools.covered(image)].min() > 200


# Illuminated lines


def lit(tangent, *lights, viewer=(0.0, -1.0, 0.0)):
    """The maximum-normal model: colour of a line under (direction to the light, intensity)."""
    tangent, viewer = unit(*tangent), np.array(viewer)
    diffuse = specular = 0.0
    for light, intensity in lights:
        lt, vt = light @ tangent, viewer @ tangent
        diffuse += intensity * np.sqrt(1 - lt**2)
        specular += intensity * max(0.0, np.sqrt(1 - lt**2) * np.sqrt(1 - vt**2) - lt * vt) ** POWER
    return COLOUR * (AMBIENT + DIFFUSE * diffuse) + 255 * SPECULAR * specular


ILLUMINATED = {"effect": Illuminated(), "light": {"Specular": SPECULAR}}
PLACE = np.array((70.0, -90.0, 40.0))
STRENGTH = 1 / (0.5 + 1e-4 * (PLACE @ PLACE))
EYE = np.array((0, -1.0, 0))


@pytest.mark.parametrize("direction", RODS)
@pytest.mark.parametrize(
    ("lights", "wanted"),
    [
        ([lamp(3, 1, 2)], [(unit(3, 1, 2), 1.0)]),
        ([lamp(-1, -4, 1)], [(unit(-1, -4, 1), 1.0)]),
        ([lamp(*PLACE, positional=True, attenuation=(0.5, 0, 1e-4))], [(unit(*PLACE), STRENGTH)]),
        ([headlight(0.8)], [(EYE, 0.8)]),
        ([lamp(3, 1, 2, intensity=0.4), lamp(*PLACE, positional=True, intensity=0.3), headlight(0.2)],
         [(unit(3, 1, 2), 0.4), (unit(*PLACE), 0.3), (EYE, 0.2)]),
    ],
    ids=["from behind", "from the front", "positional", "headlight", "all kinds"],
)  # fmt: skip
def test_illuminated_lines_have_the_light_of_the_maximum_normal(rod, lights, wanted, direction):
    assert np.allclose(rod(direction, *lights, **ILLUMINATED), lit(direction, *wanted), atol=3)


def test_a_cone_that_points_elsewhere_sheds_no_light(rod):
    light = lamp(100.0, -100.0, 0.0, positional=True, cone=20.0)
    light.focal_point = (100.0, 0.0, 0.0)
    assert np.allclose(rod((0, 0, 1), light, **ILLUMINATED), COLOUR * AMBIENT, atol=1)


def test_more_light_than_white_is_dimmed_alike(rod):
    """Without a highlight: (L.T)(V.T) is a half, as the product of the sines."""
    seen = rod((1, -1, 0), lamp(1, 0, 0, intensity=6.0), **ILLUMINATED)
    assert np.allclose(seen, lit((1, -1, 0), (unit(1, 0, 0), 1.0)), atol=2)
    several = rod((1, -1, 0), lamp(1, 0, 0, intensity=1.5), lamp(1, 0, 0, intensity=0.5), **ILLUMINATED)
    assert np.allclose(several, seen, atol=2)


# The default light


def share(direction, towards):
    return 0.8 + 0.2 * (1.0 - (unit(*direction) @ towards) ** 4)


@pytest.mark.parametrize("direction", [*RODS, (0.3, -0.8, 0.5)])
@pytest.mark.parametrize("kit", [True, False])
def test_the_cameras_lights_come_over_the_shoulder_and_legends_keep_their_colours(rod, direction, kit):
    """However many they are; and the kit's warm and cold light is white."""
    lights = ["light kit"] if kit else [headlight()]
    seen = rod(direction, *lights, effect=LineLight())
    assert np.allclose(seen, COLOUR * share(direction, SHOULDER @ TO_VIEW), atol=2)
    assert np.allclose(rod(direction, *lights, effect=LegendColours()), COLOUR, atol=1)
    if direction == RODS[0]:  # highlights are added
        assert (rod(direction, *lights, effect=LineLight(), light={"Specular": 0.5}) > seen + 5)[1:].all()


def test_no_direction_loses_more_than_a_fifth(rod):
    """The direction of the light itself has the least: the floor. Lines along the view axis keep what others do."""
    assert np.allclose(rod(SHOULDER @ TO_VIEW, headlight(), effect=LineLight()), 0.8 * COLOUR, atol=2)
    axes = [share(axis, SHOULDER @ TO_VIEW) for axis in np.eye(3)]
    np.testing.assert_allclose(axes, 1.0 - 0.2 / 9)


@pytest.mark.parametrize("direction", RODS)
def test_lights_in_the_scene_shine_from_where_they_are_by_their_strength(rod, direction):
    a, b = unit(3, 1, 2), unit(-1, -4, 1)
    assert np.allclose(rod(direction, lamp(*a), effect=LineLight()), COLOUR * share(direction, a), atol=2)
    seen = rod(direction, lamp(*a, intensity=0.9), lamp(*b, intensity=0.3), effect=LineLight())
    assert np.allclose(seen, COLOUR * (0.75 * share(direction, a) + 0.25 * share(direction, b)), atol=2)


@pytest.mark.parametrize("direction", RODS)
def test_neither_weak_nor_coloured_lights_change_colours(rod, direction):
    """As they change none of VTK's own lines; lights that stand in the scene count by their brightness."""
    plain = COLOUR * share(direction, SHOULDER @ TO_VIEW)
    for light in (headlight(0.2), headlight(3.0), headlight(color="red")):
        assert np.allclose(rod(direction, light, effect=LineLight()), plain, atol=2)
    a, b = unit(3, 1, 2), unit(-1, -4, 1)
    for more in ({"intensity": 0.2}, {"intensity": 3.0}, {"color": "red"}):
        assert np.allclose(rod(direction, lamp(*a, **more), effect=LineLight()), COLOUR * share(direction, a), atol=2)
    seen = rod(direction, lamp(*a, color="red"), lamp(*b), effect=LineLight())
    assert np.allclose(seen, COLOUR * (0.25 * share(direction, a) + 0.75 * share(direction, b)), atol=2)
