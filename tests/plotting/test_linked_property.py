"""``actor.prop`` is that of any PyVista actor: what is set there shows."""

from __future__ import annotations

import gc
import weakref

import numpy as np
import pytest
import pyvista as pv


@pytest.fixture
def lines():
    """A line across the picture, and one along the view axis."""
    along = np.linspace(-10.0, 10.0, 41)[:, None]
    return [along * np.array([1.0, 0.0, 0.0]), along * np.array([0.0, 0.0, 1.0]) + np.array([0.0, 5.0, 0.0])]


def picture(plotter):
    plotter.camera_position = "xy"
    plotter.show(auto_close=False, interactive=False)
    plotter.render()
    return np.asarray(plotter.screenshot(return_img=True))[..., :3].astype(int)


@pytest.mark.parametrize("given", [{}, {"color": "white"}])
def test_color(plotter, lines, given):
    actor = plotter.add_fiblets(lines, lighting=False, **given)
    picture(plotter)
    actor.prop.color = "tomato"
    assert actor.color == pv.Color("tomato")
    image = picture(plotter)
    assert {tuple(map(int, c)) for c in np.unique(image[image.any(-1)], axis=0)} == {pv.Color("tomato").int_rgb}
    actor.prop.opacity = 0.5
    assert (actor.opacity, actor.lighting) == (0.5, False)
    assert abs(picture(plotter)[:, 60].max() - pv.Color("tomato").int_rgb[0] / 2) <= 1
    actor.prop = pv.Property(color="blue", line_width=5, lighting=False)
    assert (actor.color, actor.line_width, actor.lighting) == (pv.Color("blue"), 5, False)
    image = picture(plotter)
    assert {tuple(map(int, c)) for c in np.unique(image[image.any(-1)], axis=0)} == {(0, 0, 255)}
    actor.prop.line_width = 2
    assert actor.line_width == 2
    actor.scalars = "length"  # whose colours are theirs, as with any mesh
    before = picture(plotter)
    actor.prop.color = "tomato"
    assert actor.scalars == "length"
    assert np.array_equal(picture(plotter), before)
    prop, gone = actor.prop, weakref.ref(actor)
    plotter.close()
    del actor
    gc.collect()
    assert gone() is None  # the property keeps no actor alive
    prop.color = "red"


def test_line_width(plotter, lines):
    actor = plotter.add_fiblets(lines, lighting=False)
    thin = (picture(plotter)[:, 60] > 0).any(-1).sum()
    actor.prop.line_width = 7
    assert actor.line_width == 7
    assert (picture(plotter)[:, 60] > 0).any(-1).sum() == thin + 6
    actor.line_width = 3
    assert actor.prop.line_width == 3
    actor.prop.line_width = 1000
    assert actor.line_width == 64


def test_lines_as_tubes(plotter, lines):
    actor = plotter.add_fiblets(lines, line_width=15)
    flat = picture(plotter)
    actor.prop.render_lines_as_tubes = True
    assert actor.tube_shading
    column = picture(plotter)[:, 60].sum(-1)
    lit = np.flatnonzero(column)
    assert column[lit[-1]] < 0.7 * column[lit].max()  # the kit's light comes from above
    actor.tube_shading = False
    assert not actor.prop.render_lines_as_tubes
    assert np.array_equal(picture(plotter), flat)


def test_spline_tubes_and_halos_have_their_colour(plotter, lines):
    for add in (plotter.add_spline_tubes, plotter.add_halo_lines):
        actor = add(lines, color="white", lighting=False)
        actor.prop.color = "red"
        assert actor.color == pv.Color("red")
        image = picture(plotter)
        assert (image[..., 0] > image[..., 1] + 100).any()  # lines with halos have soft edges
        plotter.remove_actor(actor)


def test_copies_have_a_property_of_their_own_or_share_one(plotter, lines):
    actor = plotter.add_fiblets(lines, color="red")
    deep, shallow = actor.copy(), actor.copy(deep=False)
    actor.prop.color = "blue"
    assert (deep.color, shallow.color) == (pv.Color("red"), pv.Color("blue"))
    shallow.scalars = "length"
    assert actor.color == pv.Color("blue")
