"""Choosing what an actor shows: masks and painted regions equal NumPy's, and the picture follows."""

from __future__ import annotations

import nibabel as nib
import numpy as np
import pytest
import pyvista as pv
from scipy.ndimage import map_coordinates

import pvfiblets.plotting
from pvfiblets import Streamlines, compress, regions
from pvfiblets.synthetic import brain_streamlines


@pytest.fixture
def tract():
    """Some streamlines of a brain, with groups, numbers and a streamline without points."""
    lines = [np.asarray(line) for line in brain_streamlines(400, seed=4)]
    lines[17] = np.zeros((0, 3))
    streamlines = Streamlines.from_list(lines)
    rng = np.random.default_rng(3)
    streamlines.per_streamline = {"weight": np.where(np.arange(400) % 50 == 7, np.nan, rng.random(400))}
    streamlines.per_point = {"fa": rng.random(streamlines.n_points).astype(np.float32)}
    streamlines.groups = {"left": np.arange(0, 120), "right": np.arange(100, 300)}
    return compress(streamlines, per_point=("fa",))


@pytest.fixture
def shown(tract):
    """A plotter that shows them."""
    plotter = pv.Plotter(off_screen=True, window_size=(240, 200))
    actor = plotter.add_fiblets(tract)
    plotter.show(auto_close=False)
    yield plotter, actor
    plotter.close()


def seen(plotter, actor):
    """Streamlines in the picture."""
    plotter.render()
    found = {actor.pick_at(x, y) for x in range(0, 240, 3) for y in range(0, 200, 3)}
    return {hit[0] for hit in found if hit is not None}


def test_numbers_per_streamline(shown, tract):
    plotter, actor = shown
    lengths, weights = tract.lengths(), tract.per_streamline["weight"]
    assert actor.criterion("length", (50.0, 100.0)) == "length"
    long = (lengths >= 50.0) & (lengths <= 100.0)
    np.testing.assert_array_equal(actor.shown, long)
    assert actor.criterion("weight", (None, 0.5)) == "weight"
    with np.errstate(invalid="ignore"):
        np.testing.assert_array_equal(actor.shown, long & (weights <= 0.5))
    here = seen(plotter, actor)
    assert here
    assert actor.shown[list(here)].all()
    actor.criterion("weight", (-np.inf, 0.5), keep_nan=True)
    np.testing.assert_array_equal(actor.shown, long & ~(weights > 0.5))
    actor.criterion("length", (0.0, 50.0))  # another range of the same
    assert dict(actor.criteria) == {"length": (0.0, 50.0), "weight": (-np.inf, 0.5)}
    actor.remove_criterion("weight")
    np.testing.assert_array_equal(actor.shown, lengths <= 50.0)
    actor.criterion(np.arange(400), (10, 20), name="number")
    np.testing.assert_array_equal(actor.shown, (lengths <= 50.0) & (np.arange(400) >= 10) & (np.arange(400) <= 20))
    report = actor.explain()
    assert report["streamlines"] == {"total": 400, "shown": int(actor.shown.sum())}
    assert set(report["criteria"]) == {"length", "number"}
    actor.remove_criterion()
    assert actor.mapper.filtering is None


def test_any_array_of_a_source_filters_whichever_colours(plotter):
    """A source that is compressed as it is added; `q` is x, and 5 to 10 of it are left of three lines along x."""
    x = np.linspace(-18.0, 18.0, 181)
    lines = Streamlines.from_list([np.c_[x, np.full(181, y), 0 * x] for y in (-8.0, 0.0, 8.0)])
    lines.per_point = {"fa": np.tile(x, 3), "q": np.tile(x, 3), "code": np.array(["a"] * 543)}
    lines.per_streamline = {"w": np.array([1.0, 2.0, 3.0])}
    actor = plotter.add_fiblets(lines, scalars="fa", line_width=3, show_scalar_bar=False, lighting=False)
    actor.criterion("q", (5.0, 10.0))
    actor.criterion("w", (2.0, 2.0))
    plotter.view_xy()
    plotter.show(auto_close=False)
    width, height = plotter.window_size
    hits = [actor.pick_at(x, y) for x in range(width) for y in range(height)]
    places = [hit for hit in hits if hit is not None]
    assert {line for line, _ in places} == {1}
    at = np.interp([along for _, along in places], np.arange(181), x)
    assert (at.min(), at.max()) == pytest.approx((5.0, 10.0), abs=0.3)


def test_numbers_per_point(shown, tract):
    _, actor = shown
    actor.criterion("fa", (0.2, 0.9))
    decoded = tract.decompress()
    values = decoded.per_point["fa"].astype(np.float64)
    words = actor.mapper.filtering.points
    bits = np.unpackbits(words.view(np.uint8), bitorder="little")[: tract.n_points].astype(bool)
    np.testing.assert_array_equal(bits, (values >= 0.2) & (values <= 0.9))
    assert actor.mapper.filtering.streamlines is None
    assert "POINT_MASK" not in actor.explain()["features"]  # of the last picture
    actor.criterion(regions.Distance(regions.Sphere((0, 0, 20), 10.0), per="point"), (0.0, 15.0), name="near")
    words = actor.mapper.filtering.points
    both = np.unpackbits(words.view(np.uint8), bitorder="little")[: tract.n_points].astype(bool)
    near = np.linalg.norm(decoded.points.astype(float) - (0, 0, 20), axis=1) - 10.0 <= 15.0
    far = np.abs(np.linalg.norm(decoded.points.astype(float) - (0, 0, 20), axis=1) - 25.0) > 1e-3
    np.testing.assert_array_equal(both[far], (bits & near)[far])


def test_several_without_a_name_add_up(shown):
    _, actor = shown
    rising, falling = np.arange(400.0), np.arange(400.0)[::-1].copy()
    names = [actor.criterion(rising, (100, 400)), actor.criterion(falling, (100, 400))]
    assert names == ["values 1", "values 2"]
    np.testing.assert_array_equal(np.flatnonzero(actor.shown), np.arange(100, 300))
    assert actor.criterion(rising, (150, 400)) == "values 1"
    np.testing.assert_array_equal(np.flatnonzero(actor.shown), np.arange(150, 300))
    near = [actor.criterion(regions.Distance((x, 0.0, 20.0)), (0.0, 500.0)) for x in (0.0, 10.0, 0.0)]
    assert near == ["distance 1", "distance 2", "distance 1"]
    assert len(actor.criteria) == 4


def test_regions(shown, tract):
    plotter, actor = shown
    decoded = tract.decompress(dtype=np.float64)
    ball = regions.Sphere((10.0, 0.0, 20.0), 20.0)
    lines = [np.asarray(line) for line in decoded]
    through = np.array([len(line) > 0 and bool(ball.contains(line).any()) for line in lines])
    ends = np.array([len(line) > 0 and bool(ball.contains(line[[0, -1]]).any()) for line in lines])
    np.testing.assert_array_equal(actor.streamlines_where(ball), through)
    for chosen, wanted in ((ball, through), (~regions.passes(ball), ~through)):
        actor.select(chosen)
        np.testing.assert_array_equal(actor.selection, np.flatnonzero(wanted))
    actor.show_only(ball)
    np.testing.assert_array_equal(actor.shown, through)
    actor.show_only(None)
    actor.deselect()
    np.testing.assert_array_equal(actor.streamlines_where(regions.ends_in(ball)), ends)
    actor.include(ball)
    np.testing.assert_array_equal(actor.shown, through)
    name = actor.exclude(regions.ends_in(ball))
    np.testing.assert_array_equal(actor.shown, through & ~ends)
    here = seen(plotter, actor)
    assert here
    assert actor.shown[list(here)].all()
    assert len(actor.conditions) == 2
    actor.remove_condition(name)
    np.testing.assert_array_equal(actor.shown, through)
    actor.include((-10.0, 30.0, -20.0, 20.0, 0.0, 40.0), name="include 1")
    box = regions.Box((-10.0, 30.0, -20.0, 20.0, 0.0, 40.0))
    np.testing.assert_array_equal(actor.shown, [len(x) > 0 and bool(box.contains(x).any()) for x in lines])


def test_subsets_and_groups(shown):
    _, actor = shown
    actor.subset(0.25, seed=3)
    quarter = actor.shown
    assert quarter.sum() == 100
    actor.subset(150, seed=3)
    assert actor.shown.sum() == 150
    assert (actor.shown | ~quarter).all()
    actor.subset(every=7)
    np.testing.assert_array_equal(np.flatnonzero(actor.shown), np.arange(0, 400, 7))
    actor.subset()
    assert actor.mapper.filtering is None
    actor.groups_shown = ["left"]
    np.testing.assert_array_equal(np.flatnonzero(actor.shown), np.arange(120))
    actor.groups_shown = ["left", "right"]
    np.testing.assert_array_equal(np.flatnonzero(actor.shown), np.arange(300))
    actor.groups_shown = []
    assert not actor.shown.any()
    actor.groups_shown = None
    actor.show_only([3, 5, -1])
    np.testing.assert_array_equal(np.flatnonzero(actor.shown), [3, 5, 399])
    twin = actor.copy()
    np.testing.assert_array_equal(twin.shown, actor.shown)
    actor.show_all()
    assert actor.shown.all()
    assert not twin.shown.all()


def test_other_fiblets_are_chosen_from_the_same_way(shown):
    plotter, actor = shown
    actor.criterion("length", (50.0, 100.0))
    actor.include(regions.Sphere((10.0, 0.0, 20.0), 30.0))
    actor.subset(0.5)
    other = compress(brain_streamlines(150, seed=9))
    actor.fiblets = other
    plotter.render()
    lengths = other.lengths()
    through = other.select(regions.passes(regions.Sphere((10.0, 0.0, 20.0), 30.0)))
    np.testing.assert_array_equal(actor.shown, (lengths >= 50.0) & (lengths <= 100.0) & through)


def test_refused_choices_leave_all_as_it_was(shown):
    _, actor = shown
    actor.criterion("length", (50.0, 100.0))
    before = actor.shown
    with pytest.raises(KeyError, match="weight"):
        actor.criterion("wieght", (0.0, 1.0))
    with pytest.raises(ValueError, match="range is \\(2, 1\\); give two numbers, the low one first"):
        actor.criterion("length", (2.0, 1.0))
    with pytest.raises(ValueError, match="range is \\(nan, 1\\)"):
        actor.criterion("length", (np.nan, 1.0))
    with pytest.raises(ValueError, match="give two numbers"):
        actor.criterion("length", 5.0)
    with pytest.raises(ValueError, match="399"):
        actor.criterion(np.arange(399), (0, 1))
    with pytest.raises(KeyError, match="there is no group 'front'; there are: 'left', 'right'"):
        actor.groups_shown = ["front"]
    with pytest.raises(TypeError, match="it has no position; give regions.Labels"):
        actor.include(np.zeros((3, 3, 3), int))
    with pytest.raises(ValueError, match="amount is 401; there are 400 streamlines"):
        actor.subset(401)
    with pytest.raises(ValueError, match="amount is 1.5"):
        actor.subset(1.5)
    with pytest.raises(ValueError, match="give one of them"):
        actor.subset(0.5, every=2)
    with pytest.raises(ValueError, match="amount is 'half'; give a share"):
        actor.subset("half")
    for every in (0, 2.5, np.nan, np.inf, "2"):
        with pytest.raises(ValueError, match=f"every is {every!r}; give a whole number"):
            actor.subset(every=every)
    with pytest.raises(IndexError):
        actor.show_only([400])
    with pytest.raises(KeyError, match="there is no criterion 'fa'; there are: 'length'"):
        actor.remove_criterion("fa")
    with pytest.raises(KeyError, match="there is no cut 'a'; there are: none"):
        actor.unclip("a")
    with pytest.raises(ValueError, match=r"'x' is an axis, and no region; give the plane as \('x', origin\)"):
        actor.clip("x")  # as of PyVista's filter of this name
    with pytest.raises(TypeError, match="is no region"):
        actor.clip(3.0)
    with pytest.raises(ValueError, match="a label volume cannot cut"):
        actor.clip(regions.Labels(np.ones((3, 3, 3), int), np.eye(4)))
    for what, told in ((pv.Plane(), "open"), (pv.PolyData(), "no faces")):
        with pytest.raises(ValueError, match=told):
            actor.clip(what)
    assert not actor.clips
    np.testing.assert_array_equal(actor.shown, before)


def test_fiblets_that_a_criterion_does_not_fit_are_refused(shown, tract):
    plotter, actor = shown
    actor.criterion(np.arange(400.0), (3.0, 90.0), name="order")
    actor.criterion("curvature", (0.0, 0.5))
    with pytest.raises(ValueError, match=r"criterion 'order' .* remove_criterion\('order'\)"):
        actor.fiblets = compress(brain_streamlines(150, seed=9))
    assert actor.fiblets is tract
    assert np.flatnonzero(actor.shown).tolist() == list(range(3, 91))
    plotter.render()
    actor.remove_criterion("order")
    # As many streamlines, so that the selection stays, but more points than there are bits of.
    actor.select([0, 399])
    actor.selection_style(width=3)
    actor.fiblets = compress(Streamlines.from_list([np.linspace((0, 0, i), (100, 0, i), 400) for i in range(400)]))
    plotter.render()
    assert actor.shown.all()


def test_label_images_of_cells_lie_where_their_voxels_are(shown):
    _, actor = shown
    image = pv.ImageData(dimensions=(5, 4, 3), spacing=(30.0, 30.0, 40.0), origin=(-60.0, -40.0, -40.0))
    image.cell_data["labels"] = np.arange(24) % 3 == 1
    centres = image.cell_centers()
    with pytest.raises(ValueError, match="no active scalars among its arrays"):
        actor.include(pv.ImageData(dimensions=(3, 3, 3)))
    actor.include(image, name="cells")
    found = actor.conditions["cells"].region.contains(np.asarray(centres.points) + (14.0, -14.0, 19.0))
    np.testing.assert_array_equal(found, np.asarray(image["labels"], bool))


@pytest.fixture
def actor():
    lines = [np.array([(0.0, y, 1.0), (9.0, y, 1.0)]) for y in range(10)]
    plotter = pv.Plotter(off_screen=True)
    yield plotter.add_fiblets(Streamlines.from_list(lines))
    plotter.close()


def test_painted_regions_filter_again_after_each_stroke(actor):
    painter = regions.RegionPainter(((10, 10, 3), np.eye(4)))
    painter.add("A")
    painter.add("B")
    live = regions.LiveRegions(actor.fiblets, painter)
    painter.paint("A", (4, 5, 1), 1.2)
    name = actor.include_painted(live, include="A")
    assert np.flatnonzero(actor.shown).tolist() == [4, 5, 6]
    painter.paint("A", (4, 8, 1), 1.2)
    assert np.flatnonzero(actor.shown).tolist() == [4, 5, 6, 7, 8, 9]
    painter.undo()
    assert np.flatnonzero(actor.shown).tolist() == [4, 5, 6]
    other = actor.include_painted(live, ends_in="B", name="ends")
    assert not actor.shown.any()
    painter.paint("B", (9, 5, 1), 0.6)
    assert np.flatnonzero(actor.shown).tolist() == [5]
    actor.remove_condition(other)
    actor.remove_condition(name)
    painter.paint("A", (4, 1, 1), 1.2)
    assert actor.shown.all()
    assert len(painter.listeners) == 1  # that of the live regions alone
    with pytest.raises(KeyError, match="no region 'C'"):
        actor.include_painted(live, include="C")


def test_a_mask_is_a_condition_and_joins_with_others(actor):
    mask = np.arange(10) < 6
    actor.include(mask, name="first")
    mask[:] = False  # it was copied
    actor.exclude(np.arange(10) == 2)
    assert np.flatnonzero(actor.shown).tolist() == [0, 1, 3, 4, 5]
    with pytest.raises(ValueError, match="shape"):
        actor.include(np.ones(9, bool))
    other = regions.LiveRegions(actor.fiblets.extract(slice(0, 5)), regions.RegionPainter(((10, 10, 3), np.eye(4))))
    with pytest.raises(ValueError, match="other fiblets"):
        actor.include_painted(other, include="A")


SIDES = (12, 14, 12)
PLACE = np.diag([15.0, 15.0, 15.0, 1.0])
PLACE[:3, 3] = -70.0, -100.0, -60.0
GRAINS = np.random.default_rng(8).random(SIDES).astype(np.float32)


def points_shown(actor):
    """Bits of the points that a filter leaves."""
    words = actor.mapper.filtering.points
    return np.unpackbits(words.view(np.uint8), bitorder="little")[: actor.fiblets.n_points].astype(bool)


@pytest.mark.parametrize("form", ["pair", "nii.gz", "nibabel", "ImageData"])
def test_images_filter_points_as_they_colour_them(shown, tract, tmp_path, form):
    _, actor = shown
    path = tmp_path / "fa.nii.gz"
    nib.save(nib.Nifti1Image(GRAINS, PLACE), path)
    image = {
        "pair": (GRAINS, PLACE), "nii.gz": path, "nibabel": nib.load(path), "ImageData": pvfiblets.read_volume(path),
    }[form]  # fmt: skip
    name = actor.criterion(image, (0.4, 0.8))
    assert name == {"nii.gz": "fa", "ImageData": "fa 1"}.get(form, "values 1")
    points = tract.decompress(dtype=np.float64).points
    voxels = ((points - PLACE[:3, 3]) / 15.0).T
    values = map_coordinates(GRAINS.astype(float), voxels, order=1, mode="nearest")
    inside = ((voxels >= -0.5) & (voxels <= np.array(SIDES)[:, None] - 0.5)).all(axis=0)
    sure = inside & (abs(values - 0.4) > 1e-4) & (abs(values - 0.8) > 1e-4)
    wanted = (values >= 0.4) & (values <= 0.8) & inside
    np.testing.assert_array_equal(points_shown(actor)[sure | ~inside], wanted[sure | ~inside])
    assert 0 < wanted.sum() < inside.sum()
    assert actor.criterion(image, (0.0, 1.0)) == name  # another range of the same
    np.testing.assert_array_equal(points_shown(actor), inside)
    actor.criterion(image, (0.4, 0.8), keep_nan=True)
    assert points_shown(actor)[~inside].all()
    actor.scalars = name  # the name of a criterion colours
    assert actor.mapper.colouring.mode == "point_scalar"
    assert list(actor.criteria) == [name]


def test_labels_filter_by_the_nearest_voxel(shown, tract):
    _, actor = shown
    labels = (GRAINS * 5).astype(np.int16)
    actor.criterion((labels, PLACE), (2, 2))
    points = tract.decompress(dtype=np.float64).points
    voxels = np.floor((points - PLACE[:3, 3]) / 15.0 + 0.5).astype(int)
    inside = ((voxels >= 0) & (voxels < SIDES)).all(axis=1)
    wanted = np.zeros(len(points), bool)
    wanted[inside] = labels[tuple(voxels[inside].T)] == 2
    assert (points_shown(actor) == wanted).mean() > 0.9999


def test_what_is_no_image_is_refused_in_words(shown):
    _, actor = shown
    for image, told in (
        ((GRAINS, np.eye(3)), r"the affine of the image is .*; give a finite \(4, 4\) matrix"),
        ((np.zeros((3, 3, 3, 2)), PLACE), r"the image has the shape \(3, 3, 3, 2\); three axes"),
        ((GRAINS, "here"), r"the affine of the image is here; give a finite \(4, 4\) matrix"),
        ([[1.0, 2.0], [3.0]], "one number for each of the 400 streamlines"),
    ):
        with pytest.raises(ValueError, match=told):
            actor.criterion(image, (0, 1))
    with pytest.raises(FileNotFoundError, match=r"nothing\.nii"):
        actor.criterion("/nowhere/nothing.nii", (0, 1))
    with pytest.warns(UserWarning, match="no streamline meets the image 'image', so that nothing is shown: it lies in"):
        actor.criterion((GRAINS, np.diag([1.0, 1.0, 1.0, 1.0]) + np.outer([1e4, 1e4, 1e4, 0.0], [0, 0, 0, 1])), (0, 1))
