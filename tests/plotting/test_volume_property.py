"""What is set of a volume's ``prop`` changes the picture, as in VTK, or one sentence says what does."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
import pyvista as pv

SETTINGS = {
    "color": "red",
    "ambient": 0.6,
    "diffuse": 0.2,
    "specular": 0.9,
    "line_width": 9.0,
    "point_size": 20.0,
    "style": "wireframe",
    "show_edges": True,
    "interpolation": "pbr",
    "render_lines_as_tubes": True,
    "render_points_as_spheres": True,
}
MODES = [
    {},
    {"shade": True},
    {"mode": "mip"},
    {"mode": "local-mip"},
    {"mode": "minimum"},
    {"mode": "isosurface"},
]


@pytest.fixture
def ball():
    across = np.mgrid[:16, :16, :16] - 7.5
    image = pv.ImageData(dimensions=(16, 16, 16))
    image["values"] = (100.0 * np.exp(-(across**2).sum(axis=0) / 30.0)).ravel(order="F")
    return image


@pytest.fixture
def plotter():
    plotter = pv.Plotter(off_screen=True, window_size=(40, 40))
    plotter.picture.antialias = "off"  # or edges are smoothed further in each picture
    yield plotter
    plotter.close()


def picture(plotter):
    if not plotter.camera_set:
        plotter.show(auto_close=False)
    plotter.render()
    return np.asarray(plotter.screenshot(), int)


@pytest.mark.few(1)
@pytest.mark.parametrize("made", MODES, ids=str)
def test_each_setting_changes_the_picture_or_says_why_not(plotter, ball, made):
    for name, value in SETTINGS.items():
        plotter.clear_actors()
        actor = plotter.add_raycast_volume(ball, opacity=[0.2, 1.0], **made)
        before = picture(plotter)
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            setattr(actor.prop, name, value)
            after = picture(plotter)
        told = [str(one.message) for one in said]
        if np.array_equal(before, after):
            assert len(told) == 1, (name, told)
            assert told[0].startswith(f"prop.{name} changes nothing "), told
        else:
            assert not told, name


def test_what_was_said_is_forgotten_with_the_mode(plotter, ball):
    actor = plotter.add_raycast_volume(ball, mode="mip")
    with pytest.warns(UserWarning, match="no lamp shines"):
        actor.prop.specular = 0.5
    actor.mode = "isosurface"
    actor.prop.specular = 0.7
    actor.copy()
    plotter.render()


@pytest.mark.few(3)
@pytest.mark.parametrize("made", MODES, ids=str)
@pytest.mark.parametrize("light", [{"ambient": 0.6}, {"diffuse": 0.2}, {"specular": 0.9}, {"shade": True}], ids=str)
def test_each_argument_of_light_changes_the_picture_or_says_why_not(plotter, ball, made, light):
    pictures, told = [], []
    for more in ({}, light):
        plotter.clear_actors()
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            plotter.add_raycast_volume(ball, opacity=[0.2, 1.0], **{**made, **more})
        pictures.append(picture(plotter))
        told.append([str(one.message) for one in said])
    same = np.array_equal(*pictures)
    if more.items() <= made.items() or (light == {"shade": True} and made.get("mode") == "isosurface"):
        assert same  # it was so before, or is so in any case
        assert not any(told)
    else:
        assert told == [[], [one for one in told[1] if " changes nothing in mode " in one][: int(same)]]
        assert len(told[1]) == int(same)
