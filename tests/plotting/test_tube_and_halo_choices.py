"""Which tubes, lines and points an actor shows: masks equal NumPy's, and the picture is that of the rest alone."""

from __future__ import annotations

import warnings
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
import pyvista as pv

from pvfiblets import Streamlines, regions
from pvfiblets.halos import HaloLines
from pvfiblets.tubes.curves import controls, evaluate

CENTRE, RADIUS = np.array([2.0, -1.0, 3.0]), 6.0
BALL = regions.Sphere(CENTRE, RADIUS)
BOX = (-9.0, 6.0, -8.0, 9.0, -7.0, 8.0)
FIXED = {
    "tubes": {"radius": 0.6, "show_scalar_bar": False},
    "lines": {
        "line_width": 0.6, "strip_width": 1.6, "max_displacement": 1.5, "width_cue": 0.0, "show_scalar_bar": False
    },
}  # fmt: skip
KINDS = list(FIXED)


@pytest.fixture(scope="module")
def tract():
    """Crooked lines with groups and numbers of points and lines; one of them has no points."""
    rng = np.random.default_rng(7)
    parts = [rng.normal(0.0, 1.6, (n, 3)).cumsum(axis=0) + rng.uniform(-12.0, 12.0, 3) for n in rng.integers(4, 12, 60)]
    parts[11] = np.zeros((0, 3))
    lines = Streamlines.from_list(parts)
    lines.per_point = {"fa": rng.random(lines.n_points), "other": rng.random(lines.n_points)}
    lines.per_streamline = {"weight": np.where(np.arange(60) % 10 == 3, np.nan, rng.random(60))}
    lines.groups = {"left": np.arange(0, 25), "right": np.arange(20, 45)}
    return lines


def add(plotter, kind, source, **more):
    adding = plotter.add_spline_tubes if kind == "tubes" else plotter.add_halo_lines
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "the source holds no lines")
        return adding(source, **{**FIXED[kind], **more})


@pytest.fixture(params=KINDS)
def stage(plotter, tract, request):
    """A plotter, its actor, and what shows another source in its place."""
    actor = add(plotter, request.param, tract, color="orange")
    plotter.camera_position = [(15.0, -60.0, 22.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0)]
    plotter.camera.clipping_range = (20.0, 120.0)
    return plotter, actor, request.param


def dense(actor, kind, tract):
    """Each line as a user sees it, by many points."""
    if kind == "lines":
        share = np.linspace(0.0, 1.0, 400)[:, None]
        return [
            np.concatenate([a + share * (b - a) for a, b in pairwise(line)] or [line])
            for line in tract
        ]
    halves = controls(actor.tubes)
    places = np.stack([evaluate(halves, np.full(halves.shape[:2], t))[..., :3] for t in np.linspace(0, 1, 200)])
    return [places[:, actor.tubes.tubes == i].reshape(-1, 3) for i in range(actor.tubes.n_tubes)]


def holds(lines, test, how=np.any):
    return np.array([len(line) > 0 and bool(how(test(line))) for line in lines])


def shot(plotter, *, only=None):
    """The picture of all actors or of one."""
    for actor in plotter.actors.values():
        actor.SetVisibility(only is None or actor is only)
    plotter.render()
    return plotter.screenshot(None, return_img=True)


def assert_shows_alone(plotter, actor, kind, part, **more):
    """The picture of the actor is that of a part of its source."""
    alone = add(plotter, kind, part, color="orange", reset_camera=False, **more)
    wanted, found = shot(plotter, only=alone), shot(plotter, only=actor)
    plotter.remove_actor(alone)
    assert (wanted.max(axis=2) > 0).sum() > 150
    differs = (np.abs(wanted.astype(int) - found) > 8).any(axis=2)
    assert differs.sum() <= 4, f"{differs.sum()} pixels"  # another set of nodes lies on another lattice


def test_lines_that_pass_a_ball_are_those_of_numpy(stage, tract):
    plotter, actor, kind = stage
    lines = dense(actor, kind, tract)
    near = holds(lines, lambda line: np.linalg.norm(line - CENTRE, axis=1) <= RADIUS)
    assert 5 < near.sum() < 50
    assert actor.include(BALL) == "include 1"
    np.testing.assert_array_equal(actor.shown, near)
    assert_shows_alone(plotter, actor, kind, tract[near])
    np.testing.assert_array_equal(actor.streamlines_where(BALL), near)
    actor.select(BALL)
    np.testing.assert_array_equal(actor.selection, np.flatnonzero(near))
    actor.select(~regions.passes(BALL))
    np.testing.assert_array_equal(actor.selection, np.flatnonzero(~near))
    actor.deselect()
    b = np.reshape(BOX, (3, 2))
    boxed = holds(lines, lambda line: ((line >= b[:, 0]) & (line <= b[:, 1])).all(axis=1), np.all)
    assert actor.exclude(regions.stays_in(regions.Box(BOX)), name="not within") == "not within"
    np.testing.assert_array_equal(actor.shown, near & ~boxed)
    assert list(actor.conditions) == ["include 1", "not within"]
    actor.remove_condition("include 1")
    np.testing.assert_array_equal(actor.shown, ~boxed)
    actor.remove_condition()
    assert actor.mapper.filtering is None
    assert actor.shown.all()


def test_every_kind_of_region_and_ends(stage, tract):
    _, actor, kind = stage
    lines = dense(actor, kind, tract)
    ends = [(line[0], line[-1]) if len(line) else None for line in tract]
    first = np.array([e is not None and np.linalg.norm(e[0] - CENTRE) <= RADIUS for e in ends])
    last = np.array([e is not None and np.linalg.norm(e[1] - CENTRE) <= RADIUS for e in ends])
    np.testing.assert_array_equal(actor.streamlines_where(regions.ends_in(BALL, "first")), first)
    np.testing.assert_array_equal(actor.streamlines_where(regions.ends_in(BALL, "any")), first | last)
    np.testing.assert_array_equal(actor.streamlines_where(regions.ends_in(BALL, "both")), first & last)
    b = np.reshape(BOX, (3, 2))
    boxed = holds(lines, lambda line: ((line >= b[:, 0]) & (line <= b[:, 1])).all(axis=1))
    np.testing.assert_array_equal(actor.streamlines_where(BOX), boxed)
    mesh = pv.Box(BOX).triangulate()
    np.testing.assert_array_equal(actor.streamlines_where(mesh), boxed)
    labels = pv.ImageData(dimensions=(15, 17, 15), origin=(-8.5, -7.5, -6.5))
    labels["label"] = np.ones(labels.n_points, np.uint8)
    np.testing.assert_array_equal(actor.streamlines_where(labels), boxed)
    mask = np.arange(60) % 2 == 0
    actor.include(mask)
    actor.exclude(regions.passes(BALL))
    near = holds(lines, lambda line: np.linalg.norm(line - CENTRE, axis=1) <= RADIUS)
    np.testing.assert_array_equal(actor.shown, mask & ~near)


def test_ranges_of_values_of_lines(stage, tract):
    plotter, actor, kind = stage
    weights = tract.per_streamline["weight"]
    assert actor.criterion("weight", (0.3, None)) == "weight"  # which colours nothing
    with np.errstate(invalid="ignore"):
        np.testing.assert_array_equal(actor.shown, weights >= 0.3)
    assert_shows_alone(plotter, actor, kind, tract[weights >= 0.3])
    actor.criterion("weight", (0.3, None), keep_nan=True)
    np.testing.assert_array_equal(actor.shown, ~(weights < 0.3))
    assert dict(actor.criteria) == {"weight": (0.3, np.inf)}
    actor.criterion("n_points", (0, 6))
    np.testing.assert_array_equal(actor.shown, ~(weights < 0.3) & (tract.counts <= 6))
    actor.remove_criterion()
    steps = [np.linalg.norm(np.diff(line, axis=0), axis=1).sum() for line in dense(actor, kind, tract)]
    if kind == "lines":
        steps = [np.linalg.norm(np.diff(line, axis=0), axis=1).sum() for line in tract]
        actor.criterion("length", (10.0, 25.0))
        np.testing.assert_array_equal(actor.shown, (np.array(steps) >= 10.0) & (np.array(steps) <= 25.0))
    else:
        from pvfiblets.tubes.measures import tube_lengths

        actor.criterion("length", (10.0, 25.0))
        lengths = tube_lengths(actor.tubes)
        np.testing.assert_array_equal(actor.shown, (lengths >= 10.0) & (lengths <= 25.0))
    actor.remove_criterion("length")
    actor.criterion(np.arange(60), (10, 19))
    np.testing.assert_array_equal(np.flatnonzero(actor.shown), np.arange(10, 20))


def kept_pieces(tract, good):
    """What is left of lines between neighbouring points that are both good."""
    pieces = []
    for a, b in zip(tract.offsets[:-1], tract.offsets[1:], strict=True):
        piece = [a] if b > a else []
        for i in range(a + 1, b):
            if good[i - 1] and good[i]:
                piece.append(i)
            else:
                pieces.append(piece)
                piece = [i]
        pieces.append(piece)
    return [np.array(piece) for piece in pieces if len(piece) > 1]


@pytest.mark.parametrize("kind", KINDS)
def test_ranges_of_values_of_points_leave_pieces(plotter, tract, kind):
    """Of tubes the pieces keep the slopes that they have in the whole."""
    actor = add(plotter, kind, tract, color="orange", scalars=None)
    plotter.camera_position = [(15.0, -60.0, 22.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0)]
    plotter.camera.clipping_range = (20.0, 120.0)
    fa = tract.per_point["fa"]
    actor.criterion("fa", (0.25, 0.9))
    pieces = kept_pieces(tract, (fa >= 0.25) & (fa <= 0.9))
    assert actor.shown.all()
    if kind == "lines":
        assert_shows_alone(plotter, actor, kind, Streamlines.from_list([tract.points[piece] for piece in pieces]))
    else:
        segments = np.concatenate([np.stack([piece[:-1], piece[1:]], axis=1) for piece in pieces])
        tubes = actor.tubes
        at = [np.flatnonzero((tubes.segments == segment).all(axis=1))[0] for segment in segments]
        kept = np.zeros(tubes.n_segments, bool)
        kept[at] = True
        alone = plotter.add_spline_tubes(tubes.with_segments(kept), color="orange", reset_camera=False)
        np.testing.assert_array_equal(shot(plotter, only=actor), shot(plotter, only=alone))
        plotter.remove_actor(alone)
    actor.criterion(tract.per_point["other"], (0.0, 0.5), name="half")
    both = (fa >= 0.25) & (fa <= 0.9) & (tract.per_point["other"] <= 0.5)
    np.testing.assert_array_equal(actor.mapper.filtering.sum(), sum(len(p) - 1 for p in kept_pieces(tract, both)))
    actor.show_all()
    actor.criterion("arc_length", (None, 5.0))
    assert 0 < actor.mapper.filtering.sum() < len(actor.mapper.filtering)
    actor.criterion(regions.Distance(CENTRE, "point"), (0.0, 9.0))
    near = np.linalg.norm(tract.points - CENTRE, axis=1) <= 9.0
    actor.remove_criterion("arc_length")
    np.testing.assert_array_equal(actor.mapper.filtering.sum(), sum(len(p) - 1 for p in kept_pieces(tract, near)))
    affine = np.array([[1.0, 0, 0, -20], [0, 1, 0, -20], [0, 0, 1, -20], [0, 0, 0, 1]])
    image = np.ones((40, 40, 20), np.float32), affine
    actor.remove_criterion()
    actor.criterion(image, (0.5, None))
    within = (np.abs(tract.points - [-0.5, -0.5, -10.5]) <= [20.0, 20.0, 10.0]).all(axis=1)
    np.testing.assert_array_equal(actor.mapper.filtering.sum(), sum(len(p) - 1 for p in kept_pieces(tract, within)))


def test_numbers_and_groups_and_subsets(stage, tract):
    plotter, actor, kind = stage
    actor.show_only([3, 5, 40])
    np.testing.assert_array_equal(np.flatnonzero(actor.shown), [3, 5, 40])
    assert_shows_alone(plotter, actor, kind, tract[[3, 5, 40]])
    actor.show_only(None)
    actor.groups_shown = "left"
    np.testing.assert_array_equal(np.flatnonzero(actor.shown), np.arange(25))
    actor.groups_shown = None
    actor.subset(0.25, seed=4)
    some = actor.shown
    assert some.sum() == 15
    actor.subset(30, seed=4)
    assert (some <= actor.shown).all()
    actor.subset(every=7)
    np.testing.assert_array_equal(np.flatnonzero(actor.shown), np.arange(0, 60, 7))
    report = actor.explain()
    assert report["streamlines"] == {"total": 60, "shown": 9}
    actor.show_all()
    assert actor.mapper.filtering is None


def test_picks_and_data_are_those_of_the_whole(stage, tract):
    plotter, actor, kind = stage
    chosen = np.arange(60) % 3 == 1
    actor.include(chosen)
    shot(plotter)
    found = {actor.pick_at(x, y) for x in range(0, 200, 2) for y in range(0, 200, 2)} - {None}
    ids = {actor.tubes.tubes[hit[0]] if kind == "tubes" else hit[0] for hit in found}
    assert len(ids) > 5
    assert chosen[list(ids)].all()
    shown = pv.wrap(actor.mapper.GetDataSetInput())
    np.testing.assert_array_equal(np.unique(shown["streamline"]), np.flatnonzero(chosen & (tract.counts > 0)))


def test_cuts_by_a_box_are_those_of_planes_and_go_again(stage):
    plotter, actor, _ = stage
    whole = shot(plotter)
    assert actor.clip(regions.Slab((0.0, 0.0, 1.0), (0.0, 0.0, 0.0), 8.0), name="slab") == "slab"
    by_slab = shot(plotter)
    actor.unclip()
    np.testing.assert_array_equal(shot(plotter), whole)
    from vtkmodules.vtkCommonDataModel import vtkPlane

    for z, side in ((-4.0, 1.0), (4.0, -1.0)):
        plane = vtkPlane()
        plane.SetOrigin(0.0, 0.0, z)
        plane.SetNormal(0.0, 0.0, side)
        actor.mapper.AddClippingPlane(plane)
    by_planes = shot(plotter)
    assert (by_planes != whole).any()
    np.testing.assert_array_equal(by_slab, by_planes)


@pytest.mark.parametrize("inside", [True, False])
def test_a_ball_cuts_the_same_wherever_the_actor_is(stage, inside):
    plotter, actor, kind = stage
    if kind == "lines":
        actor.halo_color = "white"  # cuts of halos in the background's colour show lines behind
    whole = shot(plotter)
    actor.clip(BALL, inside)
    cut = shot(plotter)
    lit = cut.max(axis=2) > 0
    assert 50 < lit.sum() < (whole.max(axis=2) > 0).sum() + 1
    shift = np.array([3.0, 0.0, -2.0])
    actor.position = tuple(shift)
    actor.clip(regions.Sphere(CENTRE + shift, RADIUS), inside, name="clip 1")
    position, focus, up = plotter.camera_position
    plotter.camera_position = [tuple(position + shift), tuple(focus + shift), up]
    plotter.camera.clipping_range = (20.0, 120.0)
    differs = (np.abs(shot(plotter).astype(int) - cut) > 16).any(axis=2)
    assert differs.sum() < 0.02 * lit.sum()
    labels = pv.ImageData(dimensions=(4, 4, 4))
    labels["label"] = np.ones(64, np.uint8)
    with pytest.raises(ValueError, match="a label volume cannot cut"):
        actor.clip(labels)
    assert list(actor.clips) == ["clip 1"]


def test_copies_and_other_lines_are_chosen_from_alike(stage, tract):
    plotter, actor, kind = stage
    actor.include(BALL)
    actor.criterion("n_points", (0, 9))
    actor.clip(BALL)
    twin = actor.copy()
    np.testing.assert_array_equal(twin.shown, actor.shown)
    assert list(twin.clips) == list(actor.clips)
    other = tract[30:]
    plotter.add_actor(twin, reset_camera=False)
    if kind == "tubes":
        expected = actor.shown[30:]
        actor.tubes = actor.tubes.subset(np.arange(30, 60))
    else:
        expected = actor.shown[30:]
        actor.lines = HaloLines(other.points, other.offsets)
    np.testing.assert_array_equal(actor.shown, expected)
    plotter.render()
    actor.show_all()
    actor.criterion(np.arange(30), (5, 9), name="number")
    if kind == "tubes":
        changed = actor.tubes.subset(np.arange(3))
        with pytest.raises(ValueError, match="criterion 'number' does not fit these lines"):
            actor.tubes = changed
        actor.tubes = replace(actor.tubes, radius=2.0 * actor.tubes.radius)
        np.testing.assert_array_equal(np.flatnonzero(actor.shown), np.arange(5, 10))


def test_any_numbers_of_the_source_colour_later(stage, tract):
    plotter, actor, kind = stage
    other = add(plotter, kind, tract, cmap="viridis", reset_camera=False)
    other.scalars = tract.per_point["other"]
    wanted = shot(plotter, only=other)
    actor.cmap = "viridis"
    actor.scalars = "other"
    np.testing.assert_array_equal(shot(plotter, only=actor), wanted)
    assert actor.scalars == "other"
    actor.scalars = "weight"
    assert actor.scalars_title == "weight"
    if kind == "lines":
        actor.filter_by = "fa"
        actor.threshold = 0.5
    with pytest.raises(KeyError, match="'other'.*Name one of these, or give an array"):
        actor.scalars = "nothing"


def test_numbers_of_the_source_stay_with_tubes_of_the_same_nodes_only(plotter, tract):
    actor = add(plotter, "tubes", tract[:20])
    actor.tubes = replace(actor.tubes, radius=2.0 * actor.tubes.radius)
    actor.criterion("fa", (0.5, None))
    fa = tract[:20].per_point["fa"]
    kept = (fa >= 0.5)[actor.tubes.segments].all(axis=1)
    np.testing.assert_array_equal(actor.mapper.filtering, kept)
    turned = replace(actor.tubes, segments=actor.tubes.segments[:, ::-1])
    with pytest.raises(KeyError, match="criterion 'fa' does not fit these lines"):
        actor.tubes = turned
    np.testing.assert_array_equal(actor.mapper.filtering, kept)
    actor.remove_criterion()
    actor.tubes = turned
    with pytest.raises(KeyError, match="there is no measure 'fa'"):
        actor.criterion("fa", (0.5, None))


def test_refused_choices_leave_all_as_it_was(stage):
    _, actor, _ = stage
    actor.include(BALL)
    before = actor.shown
    for call, error in (
        (lambda: actor.criterion("nothing", (0, 1)), KeyError),
        (lambda: actor.criterion("weight", (1, 0)), ValueError),
        (lambda: actor.criterion(np.arange(7), (0, 1)), ValueError),
        (lambda: actor.include("nothing"), (TypeError, ValueError, FileNotFoundError)),
        (lambda: actor.include(np.ones(3, bool)), ValueError),
        (lambda: actor.subset(0.5, every=2), ValueError),
        (lambda: actor.show_only([60]), IndexError),
        (lambda: setattr(actor, "groups_shown", "middle"), KeyError),
        (lambda: actor.remove_condition("include 2"), KeyError),
    ):
        with pytest.raises(error):
            call()
    np.testing.assert_array_equal(actor.shown, before)
    assert list(actor.conditions) == ["include 1"]


def test_points_with_halos_are_chosen_one_by_one(plotter):
    rng = np.random.default_rng(1)
    cloud = rng.uniform(-15.0, 15.0, (400, 3))
    looks = {"point_size": 0.8, "halo_size": 2.0, "max_displacement": 1.0, "width_cue": 0.0, "color": "orange"}
    number = rng.random(400)
    actor = plotter.add_halo_points(cloud, filter_by=number, **looks)
    plotter.camera_position = [(15.0, -60.0, 22.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0)]
    plotter.camera.clipping_range = (20.0, 120.0)
    actor.include(BALL)
    near = np.linalg.norm(cloud - CENTRE, axis=1) <= RADIUS
    np.testing.assert_array_equal(actor.shown, near)
    actor.remove_condition()
    actor.criterion("filter", (0.5, None))
    np.testing.assert_array_equal(actor.mapper.filtering, number >= 0.5)
    alone = plotter.add_halo_points(cloud[number >= 0.5], reset_camera=False, **looks)
    wanted, found = shot(plotter, only=alone), shot(plotter, only=actor)
    assert (np.abs(wanted.astype(int) - found) > 8).any(axis=2).sum() <= 4
    actor.clip((-5.0, 5.0, -20.0, 20.0, -20.0, 20.0))
    plotter.render()
    picked = {actor.pick_at(x, y) for x in range(0, 200, 2) for y in range(0, 200, 2)} - {None}
    assert picked
    assert (np.abs(cloud[list(picked)][:, 0]) <= 5.0).all()
    assert (number[list(picked)] >= 0.5).all()


def test_a_selection_stands_out_and_the_rest_fades(stage, tract):
    plotter, actor, kind = stage
    plain = shot(plotter)
    actor.select([2, -1, 30])
    np.testing.assert_array_equal(actor.selection, [2, 30, 59])
    actor.selection_style(color="lime", dim=1.0)  # into the black background
    found = shot(plotter)
    hits = {(x, y): actor.pick_at(x, y) for x in range(0, 200, 2) for y in range(0, 200, 2)}
    chosen = others = 0
    for (x, y), hit in hits.items():
        pixel = found[199 - y, x].astype(int)
        if hit is None or not plain[199 - y, x].any():
            continue
        line = actor.tubes.tubes[hit[0]] if kind == "tubes" else hit[0]
        if line in (2, 30, 59) and pixel[1] > 60 and pixel[1] > 2 * max(pixel[0], pixel[2]):
            chosen += 1
        elif line not in (2, 30, 59) and kind == "tubes" and pixel.max() < 30:
            others += 1
    assert chosen > 3
    assert kind == "lines" or others > 30
    twin = actor.copy()
    np.testing.assert_array_equal(twin.selection, actor.selection)
    actor.select(np.arange(60) < 5, mode="toggle")
    np.testing.assert_array_equal(actor.selection, [0, 1, 3, 4, 30, 59])
    actor.invert_selection()
    assert len(actor.selection) == 54
    actor.selection = slice(0, 4)
    actor.deselect(1)
    np.testing.assert_array_equal(actor.selection, [0, 2, 3])
    with pytest.raises(ValueError, match="mode is 'some'"):
        actor.select(0, mode="some")
    with pytest.raises(ValueError, match="dim is 2"):
        actor.selection_style(dim=2)
    actor.deselect()
    np.testing.assert_array_equal(shot(plotter), plain)


def test_a_selection_of_points(plotter):
    places = np.array([(x, 0.0, 0.0) for x in (-10.0, 0.0, 10.0)])
    actor = plotter.add_halo_points(places, point_size=4.0, halo_size=6.0, color="white", width_cue=0.0)
    plotter.camera_position = [(0.0, -60.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0)]
    shot(plotter)
    columns = [[x for x in range(200) if actor.pick_at(x, 100) == point] for point in range(3)]
    middles = [column[len(column) // 2] for column in columns]
    actor.select(1)
    actor.selection_style(color="lime", dim=1.0)
    assert [tuple(pixel) for pixel in shot(plotter)[99, middles].tolist()] == [(0, 0, 0), (0, 255, 0), (0, 0, 0)]
    actor.deselect()
    actor.opacity = [1.0, 0.2, 1.0]
    brightness = shot(plotter)[99, middles].max(axis=1)
    assert min(brightness[0], brightness[2]) > 200
    assert brightness[1] < 80
