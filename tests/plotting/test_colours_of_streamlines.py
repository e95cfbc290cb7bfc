"""Colours by ends, number, parcels, group, criterion, distance and coding error."""

from __future__ import annotations

import nibabel
import numpy as np
import pytest
import pyvista as pv

import pvfiblets
from pvfiblets import Streamlines, compress, regions
from pvfiblets.plotting.fiblets.scalars import find_fiblet_scalars
from pvfiblets.plotting.fiblets.sources import as_fiblets
from pvfiblets.query.bundles.colours import distinct_colours
from pvfiblets.synthetic import brain_streamlines


def test_ends_colour_by_the_direction_from_end_to_end(plotter, colours_in):
    bow = [np.array([[0.0, 0, 0], [5, 8, 0], [10, 0, 0]]), np.array([[0.0, 0, 0], [8, 0, 5], [0, 0, -10.0]])]
    plotter.add_fiblets(bow, scalars="ends", lighting=False)
    plotter.show(auto_close=False)
    found = np.array(sorted(colours_in(plotter.screenshot(None))))
    assert np.abs(found - [[0, 0, 255], [255, 0, 0]]).max() <= 3  # the codec's error


def test_lines_without_a_direction_are_grey(plotter):
    ring = [np.array([[0.0, 0, 0], [5, 8, 0], [0, 0, 0]]), np.array([[1.0, 1, 1]])]
    lines = Streamlines.from_list([*ring, np.zeros((0, 3)), np.array([[0.0, 0, 0], [0, 1, 0]])])
    values = plotter.add_fiblets(lines, scalars="ends", max_error=1e-6).active_scalars.values
    assert values[[1, 2]].tolist() == [[128] * 3] * 2
    assert values[3].tolist() == [0, 255, 0]


def test_numbers_and_chance(plotter, three_lines):
    actor = plotter.add_fiblets(three_lines, scalars="id")
    assert actor.clim == (0.0, 2.0)
    assert actor.scalars_title == "streamline"
    assert np.linalg.norm(np.diff(distinct_colours(3000), axis=0), axis=1).min() > 0.3
    actor.scalars = "random"
    assert len(np.unique(actor.active_scalars.values, axis=0)) == 3
    assert not actor.active_scalars.mapped


@pytest.fixture
def atlas():
    """Parcel 1 in the left half of 40 mm, 2 in the right one, 0 above z = 0; voxels of 2 mm, the first axis flipped."""
    numbers = np.ones((20, 20, 20), np.int16)
    numbers[:10] = 2
    numbers[:, :, 10:] = 0
    affine = np.diag([-2.0, 2.0, 2.0, 1.0])
    affine[:3, 3] = (19.0, -19.0, -19.0)
    return nibabel.Nifti1Image(numbers, affine)


def test_parcels_at_both_ends(plotter, atlas, tmp_path):
    ends = [(-9, 9), (9, -9), (-9, -3), (9, 30)]
    lines = [np.array([[a, 0.0, -5.0], [b, 3.0, -5.0]]) for a, b in ends] + [np.array([[-9.0, 0, -5], [9, 0, 5]])]
    lines.append(np.zeros((0, 3)))
    fiblets = pvfiblets.compress(streamlines := Streamlines.from_list(lines))
    wanted = ["1 - 2", "1 - 2", "1 - 1", "", "", ""]
    assert pvfiblets.end_parcels(streamlines, atlas).tolist() == wanted
    assert fiblets.end_parcels(atlas).tolist() == wanted
    assert fiblets.end_parcels((np.asarray(atlas.dataobj), atlas.affine)).tolist() == wanted
    nibabel.save(atlas, tmp_path / "atlas.nii.gz")
    assert fiblets.end_parcels(tmp_path / "atlas.nii.gz").tolist() == wanted
    named = fiblets.end_parcels(atlas, {1: "left", 2: "right"})
    assert named[0] == "left - right"
    actor = plotter.add_fiblets(fiblets, scalars=named)
    assert actor.active_scalars.categories == {0: "left - left", 1: "left - right"}
    plotter.show(auto_close=False)
    with pytest.raises(TypeError, match="atlas is a int"):
        fiblets.end_parcels(3)
    with pytest.raises(ValueError, match="fractions"):
        fiblets.end_parcels((np.full((2, 2, 2), 0.5), np.eye(4)))
    with pytest.raises(ValueError, match="shape"):
        fiblets.end_parcels((np.zeros((2, 2)), np.eye(4)))
    with pytest.raises(ValueError, match="affine"):
        fiblets.end_parcels((np.zeros((2, 2, 2), int), np.zeros((4, 4))))


@pytest.mark.parametrize("add", ["add_fiblets", "add_spline_tubes", "add_halo_lines"])
@pytest.mark.parametrize("kind", [np.float64, np.float32])
def test_equal_values_with_rounding_have_one_colour(plotter, add, kind):
    """Values that differ in the last place only, as those of equal lines do."""
    x = np.linspace(0.0, 10.0, 21)
    lines = [np.c_[x, np.full(21, y), 0 * x] for y in (0.0, 2.0, 4.0)]
    values = kind(76.8262314628991) + np.arange(3, dtype=kind) * np.spacing(kind(76.8262314628991))
    lit = {} if add == "add_halo_lines" else {"lighting": False}
    actor = getattr(plotter, add)(lines, scalars=values, **lit)
    assert actor.clim == pytest.approx((76.8262314,) * 2, rel=1e-3)
    indices = [actor.lookup_table.GetIndex(float(value)) for value in values]
    assert len(set(indices)) == 1
    hours = kind(1.7e9) + 3600 * np.arange(3, dtype=kind)
    seconds = getattr(plotter, add)(lines, scalars=hours, show_scalar_bar=False, **lit)
    assert seconds.clim == pytest.approx((1.7e9, 1.7e9 + 7200), abs=130)


def test_lines_of_one_length_have_one_colour(plotter):
    rng = np.random.default_rng(0)
    turns = np.linalg.qr(rng.normal(size=(60, 3, 3)))[0]
    bow = np.c_[np.linspace(-36, 36, 200), 12.0 * np.cos(np.linspace(-2, 2, 200)), np.zeros(200)]
    actor = plotter.add_fiblets([bow @ turn.T for turn in turns], scalars="length", exact=True)
    lengths = actor.fiblets.lengths()
    assert np.ptp(lengths) > 0.0
    assert {actor.lookup_table.GetIndex(length) for length in lengths} == {0}


@pytest.fixture
def streamlines():
    lines = Streamlines.from_list([np.asarray(line) for line in brain_streamlines(120, seed=4)])
    lines.groups = {"front": np.arange(10, 50), "back": np.arange(40, 90)}
    return lines


def test_groups_are_labels(streamlines):
    fiblets = compress(streamlines)
    found = find_fiblet_scalars(fiblets, "group")
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
        find_fiblet_scalars(compress(Streamlines.from_list([np.zeros((3, 3))])), "group")


@pytest.mark.parametrize("scalars", ["group", ["left", "right", ""] * 40])
def test_categories_have_neither_range_nor_logarithm(streamlines, scalars):
    plotter = pv.Plotter(off_screen=True, window_size=(150, 120))
    try:
        actor = plotter.add_fiblets(streamlines, scalars=scalars)
        before = actor.mapper.colouring.map_values([0.0, 1.0, np.nan])
        assert len(np.unique(before, axis=0)) == 3
        actor.scalars = "length"
        actor.clim, actor.log_scale = (30.0, 60.0), True
        actor.scalars = scalars
        np.testing.assert_array_equal(actor.mapper.colouring.map_values([0.0, 1.0, np.nan]), before)
        assert actor.clim == (-0.5, 1.5)
        assert not actor.lookup_table.log_scale
        actor.scalars = "length"
        assert actor.clim == (30.0, 60.0)
        assert actor.lookup_table.log_scale
    finally:
        plotter.close()


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


def test_distance_of_points(streamlines):
    ball = regions.Sphere((0.0, 0.0, 20.0), 15.0)
    fiblets, name = as_fiblets(streamlines, scalars=regions.Distance(ball, per="point"))
    points = fiblets.decompress(dtype=np.float64).points
    expected = np.maximum(np.linalg.norm(points - (0.0, 0.0, 20.0), axis=1) - 15.0, 0.0)
    stored = fiblets.per_point[name]
    np.testing.assert_allclose(stored.values(), expected, atol=stored.max_error + 1e-4)
    assert stored.max_error < (stored.hi - stored.lo) / 250
    assert find_fiblet_scalars(fiblets, name).title == "distance [mm]"


def test_coding_error_is_that_of_every_point(streamlines):
    fiblets, name = as_fiblets(streamlines, scalars="coding_error", max_error=0.2)
    error = np.linalg.norm(fiblets.decompress(dtype=np.float64).points - streamlines.points.astype(float), axis=1)
    stored = fiblets.per_point[name]
    np.testing.assert_allclose(stored.values(), error, atol=stored.max_error + 1e-5)
    assert 0.0 < stored.hi <= 0.2
    with pytest.raises(KeyError, match="only while streamlines are compressed"):
        find_fiblet_scalars(compress(streamlines), "coding_error")


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
