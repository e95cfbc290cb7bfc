"""Tubes and halos in part: hidden segments and points, and regions that cut, by sets of the rest and dense samples."""

import numpy as np
import pytest

from pvfiblets import regions
from pvfiblets.engine import View
from pvfiblets.engine.halos import HaloDrawStyle, HaloRenderer
from pvfiblets.engine.tubes import TubeRenderer, TubeStyle
from pvfiblets.halos import HaloLines, HaloPoints
from pvfiblets.report.studies.halos.reference import HALO, LINE, NOTHING
from pvfiblets.tubes.curves import controls, evaluate

from .halos import EYES, PLAIN, draw_halos, look, read_halos, scattered, wandering
from .line_tubes import rays
from .region_shapes import torus
from .test_clip_regions import sure, unprojected
from .tubes import EYE, bundle, draw_splines, many, read_splines

SIZE = (96, 72)
TORUS = regions.Surface(*torus(8.0, 3.5, 48, 24))
BALL, BOX = regions.Sphere((1.0, -2.0, 2.0), 7.0), regions.Box((-6.0, 7.0, -5.0, 8.0, -6.0, 5.0))
REGIONS = {"ball": BALL, "outside a ball": ~BALL, "torus": TORUS, "box without a ball": BOX - BALL, "box": BOX}


def splines_with(gl, tubes, view, *, filtering=None, **options):
    renderer = TubeRenderer(gl, tubes, **options)
    renderer.render(view, TubeStyle())  # what was drawn before must not stay
    renderer.filtering = filtering
    found = read_splines(renderer.render(view, TubeStyle(values="number")))
    again = read_splines(renderer.render(view, TubeStyle(values="number")))
    renderer.filtering = None
    whole = read_splines(renderer.render(view, TubeStyle(values="number")))
    renderer.release()
    np.testing.assert_array_equal(found.owner, again.owner)
    return found, whole


@pytest.mark.parametrize("silhouettes", ["rectangles", "boxes", "pulled-boxes"])
@pytest.mark.parametrize("make", [bundle, many])
def test_hidden_segments_are_as_if_they_were_not_there(gl, camera, make, silhouettes):
    tubes, view = make(), View(SIZE, camera(SIZE, **EYE))
    kept = np.random.default_rng(1).random(tubes.n_segments) < 0.4
    found, whole = splines_with(gl, tubes, view, filtering=kept, silhouettes=silhouettes)
    alone = draw_splines(gl, tubes.with_segments(kept), view, "number", silhouettes=silhouettes)
    assert found.drawn.sum() > 300
    np.testing.assert_array_equal(found.drawn, alone.drawn)
    drawn = alone.drawn
    np.testing.assert_array_equal(found.owner[drawn], np.flatnonzero(kept)[alone.owner[drawn]])
    for name in ("z", "t", "tube", "value", "normal"):
        np.testing.assert_array_equal(getattr(found, name)[drawn], getattr(alone, name)[drawn])
    np.testing.assert_array_equal(whole.owner, draw_splines(gl, tubes, view, "number", silhouettes=silhouettes).owner)


def halos_with(gl, drawn, view, style, filtering):
    renderer = HaloRenderer(gl, drawn)
    renderer.render(view, style)
    renderer.filtering = filtering
    found = read_halos(renderer.render(view, style))
    renderer.filtering = None
    whole = read_halos(renderer.render(view, style))
    renderer.release()
    np.testing.assert_array_equal(whole.kind, draw_halos(gl, drawn, view, style.look).kind)
    return found


@pytest.mark.parametrize("more", [PLAIN, {"n_tapered": 2}, {"filter_by": "number", "low": 0.3}], ids=str)
def test_hidden_pieces_of_lines_leave_lines_that_end_there(gl, camera, more):
    lines, view = wandering(12), View(SIZE, camera(SIZE, **EYES["perspective"]))
    style = HaloDrawStyle(look=look(**more))
    kept = np.random.default_rng(3).random(lines.n_segments) < 0.6
    found = halos_with(gl, lines, view, style, kept)
    starts = np.setdiff1d(np.arange(lines.n_points), lines.offsets[1:] - 1)[kept]
    breaks = sorted({*range(lines.n_points + 1)} - {int(start) + 1 for start in starts})
    alone = draw_halos(gl, HaloLines(lines.points, breaks, lines.values), view, style.look)
    assert (found.kind == LINE).sum() > 100
    np.testing.assert_array_equal(found.kind, alone.kind)
    np.testing.assert_array_equal(found.owner, alone.owner)
    np.testing.assert_array_equal(found.depth, alone.depth)
    line = found.kind == LINE
    np.testing.assert_array_equal(
        found.line[line], np.searchsorted(lines.offsets, found.owner[line], side="right") - 1
    )


def test_hidden_points_are_as_if_they_were_not_there(gl, camera):
    points, view = scattered(80), View(SIZE, camera(SIZE, **EYES["perspective"]))
    style = HaloDrawStyle(look=look(width_cue=0.0, line_width=1.5, strip_width=5.0))
    kept = np.random.default_rng(3).random(80) < 0.5
    found = halos_with(gl, points, view, style, kept)
    alone = draw_halos(gl, HaloPoints(points.points[kept]), view, style.look)
    assert (found.kind == LINE).sum() > 100
    differs = found.kind != alone.kind  # the other set has another lattice
    assert differs.sum() <= 3
    both = (alone.kind == LINE) & ~differs
    np.testing.assert_array_equal(found.owner[both], np.flatnonzero(kept)[alone.owner[both]])


def first_inside(tubes, view, region, steps=2500):
    """Distance from the near plane at which each pixel's ray is first within a tube and the region; inf if nowhere."""
    halves = controls(tubes).reshape(-1, 3, 4)
    balls = np.concatenate([evaluate(halves, np.full(len(halves), t)) for t in np.linspace(0.0, 1.0, 40)])
    o, d = (a.reshape(-1, 3) for a in rays(view.model_view_projection, view.size))
    reach = np.linspace(5.0, 80.0, steps)
    found = np.full(len(o), np.inf)
    for k in range(len(o)):
        places = o[k] + reach[:, None] * d[k]
        # Only balls near to the ray can hold a place of it.
        away = np.linalg.norm(np.cross(balls[:, :3] - o[k], d[k]), axis=1)
        some = balls[away < balls[:, 3]]
        if not len(some):
            continue
        gaps = np.linalg.norm(places[:, None] - some[None, :, :3], axis=2) - some[None, :, 3]
        hits = np.flatnonzero((gaps <= 0.0).any(axis=1) & region.contains(places))
        if len(hits):
            found[k] = reach[hits[0]]
    return found.reshape(view.size[::-1]), o.reshape(*view.size[::-1], 3), d.reshape(*view.size[::-1], 3)


@pytest.mark.few(2)
@pytest.mark.parametrize("name", REGIONS)
def test_tubes_are_solid_where_regions_cut_them(gl, camera, name):
    size, region, tubes = (48, 36), REGIONS[name], bundle()
    view = View(size, camera(size, **EYE), (), region)
    found = draw_splines(gl, tubes, view, "number", min_width=0.0)
    wanted, o, d = first_inside(tubes, view, region)
    places = unprojected(view, found.z)
    reached = np.where(found.drawn, ((places - o) * d).sum(axis=-1), np.inf)
    assert found.drawn.sum() > 40
    both = found.drawn & np.isfinite(wanted)
    assert (found.drawn != np.isfinite(wanted)).sum() <= 0.03 * found.drawn.sum()  # samples miss thin slivers
    assert (np.abs(reached[both] - wanted[both]) < 0.05).mean() > 0.97
    assert (sure(region, places[found.drawn], 0.01) >= 0).all(), "something outside is shown"
    np.testing.assert_allclose(np.linalg.norm(found.normal[found.drawn], axis=1), 1.0, atol=2e-3)


def test_a_box_cuts_tubes_as_its_six_planes_do(gl, camera):
    tubes, matrix = many(), camera(SIZE, **EYE)
    b = BOX.bounds
    planes = [[1.0, 0, 0, -b[0]], [-1.0, 0, 0, b[1]], [0, 1.0, 0, -b[2]], [0, -1.0, 0, b[3]], [0, 0, 1.0, -b[4]],
              [0, 0, -1.0, b[5]]]  # fmt: skip
    by_planes = draw_splines(gl, tubes, View(SIZE, matrix, planes), "number")
    by_region = draw_splines(gl, tubes, View(SIZE, matrix, (), BOX), "number")
    assert by_planes.drawn.sum() > 250
    assert (by_planes.drawn != by_region.drawn).sum() <= 3
    both = by_planes.drawn & by_region.drawn
    assert (np.abs(by_planes.z - by_region.z)[both] < 1e-5).mean() > 0.995
    # On a cut several tubes that lie in each other are equally deep.
    within = both.copy()
    within[both] = sure(BOX, unprojected(View(SIZE, matrix), by_planes.z)[both]) > 0
    assert (by_planes.owner != by_region.owner)[within].mean() < 0.01


@pytest.mark.few(2)
@pytest.mark.parametrize("kind", ["lines", "points"])
@pytest.mark.parametrize("name", REGIONS)
def test_halos_go_with_what_regions_cut(gl, camera, name, kind):
    """Of what shows uncut, all within the region stays; nothing outside shows."""
    region, matrix = REGIONS[name], camera(SIZE, **EYES["perspective"])
    drawn = wandering(14) if kind == "lines" else scattered(300)
    style = look(**PLAIN, max_displacement=0.0) if kind == "lines" else look(line_width=1.2, strip_width=1.3)
    free, view = View(SIZE, matrix), View(SIZE, matrix, (), region)
    whole, found = draw_halos(gl, drawn, free, style), draw_halos(gl, drawn, view, style)
    line = found.kind == LINE
    assert line.sum() > 20
    assert (sure(region, unprojected(view, found.depth)[line]) >= 0).all(), "something outside is shown"
    inside = np.zeros(line.shape, int)
    inside[whole.kind == LINE] = sure(region, unprojected(free, whole.depth)[whole.kind == LINE])
    kept = inside > 0
    assert kept.any()
    assert (found.kind[kept] == LINE).all(), "something inside is not shown"
    np.testing.assert_array_equal(found.owner[kept], whole.owner[kept])
    np.testing.assert_array_equal(found.depth[kept], whole.depth[kept])
    assert ((found.kind == HALO) <= (whole.kind != NOTHING)).all()


def test_a_region_that_goes_leaves_nothing_behind(gl, camera):
    matrix = camera(SIZE, **EYE)
    for renderer, style in ((TubeRenderer(gl, bundle()), TubeStyle()),
                            (HaloRenderer(gl, wandering()), HaloDrawStyle(look=look()))):  # fmt: skip
        renderer.render(View(SIZE, matrix), style)
        before = renderer.explain()
        renderer.render(View(SIZE, matrix, (), BALL), style)
        cut = renderer.explain()
        assert "CLIP_REGION" in cut["features"]
        assert {"region"} == {b["name"] for b in cut["buffers"]} - {b["name"] for b in before["buffers"]}
        renderer.render(View(SIZE, matrix), style)
        after = renderer.explain()
        assert after["features"] == before["features"]
        assert after["buffers"] == before["buffers"]
        renderer.release()
