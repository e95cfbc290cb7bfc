"""Colours by group, by criterion, by distance and by coding error: the numbers are those of NumPy."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv

from pvfiblets import Streamlines, compress, regions
from pvfiblets.plotting.fiblets.scalars import find_scalars
from pvfiblets.plotting.fiblets.sources import as_fiblets, with_point_values
from pvfiblets.synthetic import brain_streamlines


@pytest.fixture
def streamlines():
    lines = Streamlines.from_list([np.asarray(line) for line in brain_streamlines(120, seed=4)])
    lines.groups = {"front": np.arange(10, 50), "back": np.arange(40, 90)}
    return lines


def test_groups_are_labels(streamlines):
    fiblets = compress(streamlines)
    found = find_scalars(fiblets, "group")
    expected = np.full(120, np.nan)
    expected[40:90] = 1
    expected[10:50] = 0  # the first group that a streamline is in
    np.testing.assert_array_equal(found.values, expected)
    plotter = pv.Plotter(off_screen=True, window_size=(150, 120))
    try:
        actor = plotter.add_fiblets(fiblets, scalars="group")
        plotter.show(auto_close=False)
        assert actor.lookup_table.n_values == 2
        table = actor.lookup_table
        assert [table.GetAnnotation(i) for i in range(table.GetNumberOfAnnotatedValues())] == ["front", "back"]
        shown = [tuple(row) for row in np.asarray(table.values)[:, :3] / 255.0]
        np.testing.assert_allclose(shown, [actor.bundles[name].color for name in ("front", "back")], atol=0.5 / 255.0)
        assert len({tuple(np.rint(255 * np.array(one.color)).astype(int)) for one in actor.bundles}) == 2
        assert "group" in plotter.scalar_bars
        actor.scalars = "length"
        assert table.GetNumberOfAnnotatedValues() == 0
        assert actor.lookup_table.n_values == 256
    finally:
        plotter.close()
    with pytest.raises(KeyError, match="no groups"):
        find_scalars(compress(Streamlines.from_list([np.zeros((3, 3))])), "group")


def test_thirty_groups_have_thirty_colours_before_any_bundle_has_its_own(streamlines):
    streamlines.groups = {f"group {k}": np.arange(4 * k, 4 * k + 4) for k in range(30)}
    plotter = pv.Plotter(off_screen=True, window_size=(100, 100))
    try:
        actor = plotter.add_fiblets(streamlines, scalars="group", show_scalar_bar=False)
        before = np.array(actor.lookup_table.values)
        assert len(np.unique(before, axis=0)) == 30
        actor.bundles["group 7"].color = "white"
        after = np.array(actor.lookup_table.values)
        assert np.flatnonzero((before != after).any(axis=1)).tolist() == [7]  # no other changes with it
        actor.cmap = "viridis"  # what is asked for goes before
        assert not np.array_equal(np.array(actor.lookup_table.values), after)
    finally:
        plotter.close()


def test_measures_of_streamlines(streamlines):
    fiblets = compress(streamlines)
    lines = list(fiblets.decompress(dtype=np.float64))
    apart = [np.linalg.norm(line[-1] - line[0]) for line in lines]
    np.testing.assert_allclose(find_scalars(fiblets, "end_distance").values, apart, atol=1e-6)
    np.testing.assert_array_equal(find_scalars(fiblets, "n_points").values, [len(line) for line in lines])
    place = np.array([3.0, -5.0, 20.0])
    least = [np.linalg.norm(line - place, axis=1).min() for line in lines]
    found = find_scalars(fiblets, regions.Distance(place))
    np.testing.assert_allclose(found.values, least, atol=1e-6)


def test_distance_of_points(streamlines):
    ball = regions.Sphere((0.0, 0.0, 20.0), 15.0)
    fiblets, name = as_fiblets(streamlines, scalars=regions.Distance(ball, per="point"))
    points = fiblets.decompress(dtype=np.float64).points
    expected = np.maximum(np.linalg.norm(points - (0.0, 0.0, 20.0), axis=1) - 15.0, 0.0)
    stored = fiblets.per_point[name]
    np.testing.assert_allclose(stored.values(), expected, atol=(stored.hi - stored.lo) / stored.levels + 1e-4)
    assert find_scalars(fiblets, name).title == "distance [mm]"


def test_coding_error_is_that_of_every_point(streamlines):
    fiblets, name = as_fiblets(streamlines, scalars="coding_error", max_error=0.2)
    error = np.linalg.norm(fiblets.decompress(dtype=np.float64).points - streamlines.points.astype(float), axis=1)
    stored = fiblets.per_point[name]
    np.testing.assert_allclose(stored.values(), error, atol=(stored.hi - stored.lo) / stored.levels + 1e-5)
    assert 0.0 < stored.hi <= 0.2
    with pytest.raises(KeyError, match="only while streamlines are compressed"):
        find_scalars(compress(streamlines), "coding_error")


def test_the_name_of_a_criterion_colours(streamlines):
    plotter = pv.Plotter(off_screen=True, window_size=(150, 120))
    try:
        actor = plotter.add_fiblets(streamlines)
        plotter.show(auto_close=False)
        numbers = np.linspace(0.0, 1.0, 120)
        actor.criterion(numbers, (0.2, 0.8), name="mine")
        actor.scalars = "mine"
        assert actor.clim == (0.0, 1.0)
        actor.criterion(regions.Distance((0.0, 0.0, 0.0), per="point"), (0.0, 60.0), name="near")
        actor.scalars = "near"
        plotter.render()
        assert actor.scalars_title == "distance [mm]"
        assert dict(actor.criteria) == {"mine": (0.2, 0.8), "near": (0.0, 60.0)}
        assert actor.mapper.filtering.points is not None
    finally:
        plotter.close()


def test_arrays_stay_what_they_were(streamlines):
    fiblets = compress(streamlines)
    assert with_point_values(fiblets, None) == (fiblets, None)
    assert with_point_values(fiblets, "length") == (fiblets, "length")
