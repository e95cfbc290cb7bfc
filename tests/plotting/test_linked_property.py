"""What is set of ``actor.prop``, ``actor.mapper`` and its look-up table shows, as with any PyVista actor."""

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


ADDS = {
    "add_fiblets": {},
    "add_spline_tubes": {"radius": 1.0},
    "add_halo_lines": {"line_width": 1.0, "strip_width": 2.0},
}


def outside(actor):
    actor.mapper.scalar_range = (2.0, 20.0)
    actor.mapper.lookup_table.below_range_color = "red"
    actor.mapper.lookup_table.above_range_color = "lime"


def one_entry(actor):
    actor.mapper.lookup_table.values[0, :3] = (255, 0, 255)


def all_entries(actor):
    actor.mapper.lookup_table.values = np.array([[255, 0, 0, 255], [0, 255, 0, 255], [0, 0, 255, 255]], np.uint8)


def no_scalars(actor):
    actor.mapper.scalar_visibility = False
    actor.prop.color = "orange"


def no_scalars_and_back(actor):
    actor.mapper.SetScalarVisibility(False)
    actor.prop.color = "orange"
    actor.mapper.ScalarVisibilityOn()


CHANGES = {
    "map": lambda actor: setattr(actor.mapper.lookup_table, "cmap", "jet"),
    "applied map": lambda actor: actor.mapper.lookup_table.apply_cmap("plasma", 5, flip=True),
    "range": lambda actor: setattr(actor.mapper, "scalar_range", (2.0, 20.0)),
    "range by VTK": lambda actor: actor.mapper.SetScalarRange(2.0, 20.0),
    "logarithm": lambda actor: setattr(actor.mapper.lookup_table, "log_scale", True),
    "table": lambda actor: setattr(actor.mapper, "lookup_table", pv.LookupTable("jet", n_values=7)),
    **{change.__name__: change for change in (outside, one_entry, all_entries, no_scalars, no_scalars_and_back)},
}


@pytest.mark.few(3)
@pytest.mark.parametrize("change", CHANGES.values(), ids=CHANGES.keys())
@pytest.mark.parametrize("add", ADDS)
def test_as_with_add_mesh(plotter, three_lines, colours_in, add, change):
    mesh = three_lines.to_polydata()
    actor = plotter.add_mesh(mesh, scalars="weight", lighting=False, line_width=3)
    plotter.view_isometric()
    plotter.remove_scalar_bar()
    plotter.show(auto_close=False)
    change(actor)
    plotter.render()
    wanted = colours_in(plotter.screenshot(None))
    plotter.remove_actor(actor)
    ours = getattr(plotter, add)(three_lines, scalars="weight", lighting=False, **ADDS[add])
    plotter.remove_scalar_bar()
    plotter.render()
    change(ours)
    plotter.render()
    found = colours_in(plotter.screenshot(None))
    if add == "add_halo_lines":
        found.discard((255, 255, 255))
    for colour in wanted:
        assert min(np.abs(np.subtract(colour, other)).max() for other in found) <= 1, (colour, found)
    assert add == "add_halo_lines" or len(found) == len(wanted)  # edges of halos are mixed


def test_what_was_written_is_kept_as_settings(plotter, three_lines):
    actor = plotter.add_fiblets(three_lines, scalars="weight")
    plotter.render()
    actor.mapper.lookup_table.cmap = "jet"
    actor.n_colors = 5
    assert actor.cmap.name == "jet"
    assert actor.lookup_table.n_values == 5
    actor.lookup_table.scalar_range = (3.0, 7.0)
    actor.lookup_table.nan_color = "red"
    actor.scalars = "length"
    assert actor.clim == (3.0, 7.0)
    assert actor.nan_color == pv.Color("red")
    twin = actor.copy()
    assert (twin.clim, twin.cmap.name, twin.n_colors) == ((3.0, 7.0), "jet", 5)
    actor.lookup_table.values[:, 3] = 100
    plotter.render()
    assert actor.mapper.colouring.translucent()
    actor.clim = (0.0, 1.0)
    assert (actor.lookup_table.values[:, 3] == 100).all()


@pytest.mark.few(1)
@pytest.mark.parametrize("mode", ["composite", "mip", "isosurface"])
def test_volumes(plotter, mode):
    image = pv.ImageData(dimensions=(12, 12, 12), origin=(-6, -6, -6))
    image["r"] = np.linalg.norm(image.points, axis=1)
    wanted = []
    for settings in ({"cmap": "jet"}, {"cmap": "jet", "clim": (2.0, 7.0)}):
        actor = plotter.add_raycast_volume(image, mode=mode, show_scalar_bar=False, **settings)
        plotter.show(auto_close=False)
        plotter.render()
        wanted.append(plotter.screenshot(None).astype(int))
        plotter.remove_actor(actor)
    actor = plotter.add_raycast_volume(image, mode=mode, cmap="gray", show_scalar_bar=False)
    plotter.render()
    actor.mapper.lookup_table.cmap = "jet"
    plotter.render()
    assert np.abs(plotter.screenshot(None) - wanted[0]).max() <= 1
    actor.mapper.lookup_table.scalar_range = (2.0, 7.0)
    plotter.render()
    assert np.abs(plotter.screenshot(None) - wanted[1]).max() <= 1
    actor.lookup_table.values[:, 3] = 0
    plotter.render()
    assert (plotter.screenshot(None).max() == 0) == (mode != "isosurface")


@pytest.mark.parametrize(("add", "instead"), [("add_spline_tubes", "radius in mm"), ("add_halo_lines", "in mm")])
def test_an_undrawable_width_warns(plotter, three_lines, add, instead):
    actor = getattr(plotter, add)(three_lines)
    with pytest.warns(UserWarning, match=f"prop.line_width changes nothing here: .*{instead}"):
        actor.prop.line_width = 5
    actor.prop.ambient = 0.5
