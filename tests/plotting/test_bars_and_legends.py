"""Scalar bars, look-up tables and legends are those of a PyVista user's habits; `add_mesh` is the measure."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv

from pvfiblets import Streamlines

ADDERS = ("add_fiblets", "add_spline_tubes", "add_halo_lines")


@pytest.fixture
def mesh(three_lines):
    """The three lines as PyVista has them, with a number at every point."""
    lines = [np.asarray(line) for line in three_lines]
    cells = np.concatenate([[len(line), *(41 * i + np.arange(len(line)))] for i, line in enumerate(lines)])
    data = pv.PolyData(np.concatenate(lines), lines=cells)
    data["height"] = np.tile(np.linspace(0.0, 1.0, 41), 3)
    return data


def annotated(table):
    """Return words by values; PyVista's own getter reads past their end."""
    count = table.GetNumberOfAnnotatedValues()
    return {table.GetAnnotatedValue(i).ToDouble(): table.GetAnnotation(i) for i in range(count)}


@pytest.mark.parametrize("add", ADDERS)
def test_a_scalar_bar_can_be_added_later_and_a_removed_one_stays_removed(plotter, mesh, add):
    actor = getattr(plotter, add)(mesh, scalars="height", show_scalar_bar=False)
    bar = plotter.add_scalar_bar("mine", vertical=True)
    plotter.show(auto_close=False)
    assert list(plotter.scalar_bars.keys()) == ["mine"]
    assert bar.GetLookupTable() is actor.lookup_table
    assert tuple(bar.GetLookupTable().GetRange()) == pytest.approx((0.0, 1.0))
    plotter.remove_scalar_bar()
    for name, value in (("scalars", "length"), ("clim", (0.0, 3.0)), ("cmap", "jet")):
        setattr(actor, name, value)
        plotter.render()
        assert list(plotter.scalar_bars.keys()) == []
    assert plotter.add_scalar_bar("again").GetLookupTable() is actor.lookup_table
    plotter.remove_scalar_bar()
    ball = plotter.add_mesh(pv.Sphere().elevation(), scalars="Elevation", show_scalar_bar=False)
    getattr(plotter, add)(mesh, color="red")  # one colour takes no bar from a mesh
    assert plotter.add_scalar_bar("ball").GetLookupTable() is ball.mapper.lookup_table


@pytest.mark.parametrize("first_log", [True, False])
@pytest.mark.parametrize("add", [*ADDERS, "add_raycast_volume"])
def test_a_logarithmic_scale_shares_a_bar_with_a_linear_one(plotter, mesh, add, first_log):
    """As in `add_mesh`: both are drawn over the range of the data, the logarithmic one from above zero."""
    mesh["height"] = mesh["height"] * 68.5 - 28.5
    source, name = mesh, {"scalars": "height"}
    if add == "add_raycast_volume":
        source, name = pv.ImageData(dimensions=(4, 4, 4)), {}
        source["height"] = np.linspace(-28.5, 40.0, 64)
    actors = [getattr(plotter, add)(source, log_scale=log, **name) for log in (first_log, not first_log)]
    logarithmic, linear = actors if first_log else actors[::-1]
    assert len(plotter.scalar_bars) == 1
    assert linear.clim == pytest.approx((-28.5, 40.0), abs=0.2)
    assert 0.0 < logarithmic.clim[0] < 2.0
    assert logarithmic.clim[1] == pytest.approx(40.0, abs=0.2)


def test_a_bar_that_two_actors_share_has_the_range_of_both(plotter, mesh):
    other = mesh.copy()
    other["height"] = mesh["height"] * 3.0 - 1.0
    ranges = []
    for add in ("add_mesh", "add_fiblets"):
        actors = [getattr(plotter, add)(data, scalars="height") for data in (mesh, other)]
        ranges.append([actor.mapper.scalar_range for actor in actors])
        assert list(plotter.scalar_bars.keys()) == ["height"]
        plotter.show(auto_close=False) if plotter._first_time else plotter.render()
        plotter.clear_actors()
        plotter.scalar_bars.clear()
    np.testing.assert_allclose(ranges[1], ranges[0], atol=1e-6)
    plotter.add_fiblets(other, scalars="height")
    first = plotter.add_fiblets(mesh, scalars="height")
    first.color = "red"
    first.scalars = "height"
    assert list(plotter.scalar_bars.keys()) == ["height"]
    assert first.clim == pytest.approx(ranges[0][1])


@pytest.mark.parametrize("add", ADDERS)
def test_a_lookup_table_keeps_its_range_and_colours(plotter, mesh, add):
    table = pv.LookupTable("jet", n_values=7, scalar_range=(0.25, 0.5), below_range_color="blue",
                           above_range_color="red", nan_color="green", annotations={0.3: "here"})  # fmt: skip
    theirs = plotter.add_mesh(mesh, scalars="height", cmap=table, name="one")
    actor = getattr(plotter, add)(mesh, scalars="height", cmap=table, name="one")
    assert actor.clim == theirs.mapper.scalar_range == (0.25, 0.5)
    for name in ("n_values", "below_range_color", "above_range_color", "nan_color"):
        assert getattr(actor.lookup_table, name) == getattr(table, name)
    assert annotated(actor.lookup_table) == {0.3: "here"}
    actor.clim = (0.0, 1.0)
    assert actor.lookup_table.scalar_range == (0.0, 1.0)
    actor.above_color = "white"
    assert actor.lookup_table.above_range_color == pv.Color("white")
    actor.cmap = "viridis"
    assert annotated(actor.lookup_table) == {}
    words = {0.2: "low", 0.8: "high"}
    plotter.add_mesh(mesh, scalars="height", annotations=words, name="one")
    theirs = annotated(plotter.mapper.lookup_table)
    actor = getattr(plotter, add)(mesh, scalars="height", annotations=words, name="one")
    plotter.show(auto_close=False)
    assert annotated(actor.lookup_table) == theirs == words
    actor.annotations = None
    assert annotated(actor.lookup_table) == {}
    with pytest.raises(ValueError, match=r"annotations is \['low'\]; give a dict from numbers to words"):
        actor.annotations = ["low"]


@pytest.mark.parametrize("add", [*ADDERS, "add_raycast_volume"])
@pytest.mark.parametrize("more", [{}, {"color": "red"}])
def test_a_wrong_colour_map_fails_at_once(plotter, mesh, add, more):
    source = pv.ImageData(dimensions=(4, 4, 4)) if add == "add_raycast_volume" else mesh
    if add == "add_raycast_volume":
        source["values"] = np.arange(64.0)
    with pytest.raises(ValueError, match="cmap is 'viridsi', which is no colour map; .*'viridis'"):
        getattr(plotter, add)(source, cmap="viridsi", **more)
    assert len(plotter.actors) == 0
    actor = getattr(plotter, add)(source, **more)
    with pytest.raises(ValueError, match="no colour map"):
        actor.cmap = "viridsi"


def entry(plotter, text):
    return next(color for _face, label, color in plotter.renderer._labels.values() if label == text)


def test_legends_show_a_colour_of_the_lines(plotter, mesh):
    along_x = Streamlines.from_list([np.array([[0.0, 0, 0], [10, 0, 0]]), np.array([[0.0, 5, 0], [10, 5, 0]])])
    plotter.add_fiblets(along_x, label="direction")
    mapped = plotter.add_fiblets(mesh, scalars="height", cmap="jet", n_colors=5, label="numbers")
    plotter.add_fiblets(mesh, scalars=np.tile([[0, 255, 0]], (3, 1)).astype(np.uint8), label="colours")
    solid = plotter.add_fiblets(mesh, color="red", label="one")
    assert entry(plotter, "direction") == pv.Color("red")  # along x is red, by the usual convention
    middle = pv.LookupTable("jet", n_values=5).values[2, :3]
    np.testing.assert_array_equal(entry(plotter, "numbers").int_rgb, middle)
    assert entry(plotter, "colours") == pv.Color([0, 255, 0])
    assert entry(plotter, "one") == pv.Color("red")
    solid.color = "blue"
    mapped.cmap = "gray"
    assert entry(plotter, "one") == pv.Color("blue")
    assert len(set(entry(plotter, "numbers").int_rgb)) == 1
    plotter.add_legend(face=None)
    plotter.show(auto_close=False)
    plotter.remove_actor(solid)
    solid.color = "red"
    assert "one" not in {label for _face, label, _color in plotter.renderer._labels.values()}


def test_long_names_of_groups_are_neither_cut_nor_all_over_the_picture():
    names = ["Fornix", "CC", "Inferior fronto-occipital fasciculus, left hemisphere", "Middle cerebellar peduncle"]
    plotter = pv.Plotter(off_screen=True, window_size=(500, 400))
    plotter.set_background("white")
    lines = Streamlines.from_list([np.eye(3) * k for k in range(1, 5)])
    lines.groups = {name: np.array([k]) for k, name in enumerate(names)}
    actor = plotter.add_fiblets(lines, scalars="group")
    actor.visibility = False
    dark = plotter.screenshot(None).max(axis=2) < 120
    columns = np.flatnonzero(dark[:, :440].any(axis=0))
    assert 0.5 * 500 < columns[0] < 0.65 * 500
    rows = dark[150:, 400:438].any(axis=1).astype(int)
    assert np.count_nonzero(np.diff(rows) == 1) >= len(names)  # apart from each other
    plotter.close()


@pytest.mark.parametrize(("low", "high", "wanted"), [
    (1.7e9, 1.7e9 + 60.0, ["1700000000", "1700000015", "1700000030", "1700000045", "1700000060"]),
    (2459000.5, 2459001.5, ["2459000.50", "2459000.75", "2459001.00", "2459001.25", "2459001.50"]),
    (-7000.0, -6999.0, ["-7000.00", "-6999.75", "-6999.50", "-6999.25", "-6999.00"]),
])  # fmt: skip
def test_numbers_beside_a_bar_differ_where_three_digits_are_the_same(low, high, wanted):
    points = np.linspace((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), 9)
    times = Streamlines.from_list([points], per_point={"t": np.linspace(low, high, 9)})
    plotter = pv.Plotter(off_screen=True)
    actor = plotter.add_fiblets(times, scalars="t")
    bar = plotter.scalar_bars["t"]
    assert [bar.GetLabelFormat() % value for value in np.linspace(low, high, 5)] == wanted
    actor.clim = (0.0, 1.0)
    assert bar.GetLabelFormat() == pv.Plotter(off_screen=True).add_scalar_bar("x", mapper=actor.mapper).GetLabelFormat()
    plotter.close()
    plotter = pv.Plotter(off_screen=True)
    plotter.add_fiblets(times, scalars="t", scalar_bar_args={"fmt": "%.1e"})
    assert plotter.scalar_bars["t"].GetLabelFormat() == "%.1e"
    plotter.close()
