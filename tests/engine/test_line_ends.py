"""Ends of streamlines as discs: all pixels within half a width of an end's place in the window, and no others."""

import re

import numpy as np
import pytest

from pvfiblets import Streamlines, compress, regions
from pvfiblets.codec.editing.restrict import restrict
from pvfiblets.engine import FibletRenderer, FibletStyle, View
from pvfiblets.engine.fiblets.data import chunks
from pvfiblets.engine.fiblets.data.filter_textures import Filter
from pvfiblets.engine.fiblets.gather.paint import Paint
from pvfiblets.engine.gbuffer import GBuffer
from pvfiblets.engine.gl import shaders
from pvfiblets.synthetic import brain_streamlines
from tests.drivers import MESH

from .emulated import emulated_renderer
from .pictures import EMPTY, SIZE, assert_same, draw, read
from .polylines import to_clip, to_window
from .test_filter_textures import packed

PIPELINES = ["compute", "tessellation", "geometry", *MESH]
ROUNDING = 0.01  # pixels
DEPTHS = 1e-6  # of the window


def ends_of(lines):
    """First and last points, a point once: (n, 3) points, (n,) streamlines and places."""
    found = [(line[k], s, k) for s, line in enumerate(lines) for k in sorted({0, len(line) - 1}) if len(line)]
    points, streamlines, places = zip(*found, strict=True)
    return np.array(points), np.array(streamlines), np.array(places)


class Discs:
    """What each pixel shows, in float64."""

    def __init__(self, lines, matrix, width, keep=None, aside=0.0):
        points, self.streamlines, self.places = ends_of(lines)
        kept = np.ones(len(points), bool) if keep is None else keep(points, self.streamlines)
        clip = to_clip(points, matrix)
        window = to_window(clip, SIZE)
        kept &= (clip[:, 3] > 0) & (np.abs(clip[:, 2]) <= clip[:, 3])
        x, y = np.meshgrid(np.arange(SIZE[0]) + 0.5, np.arange(SIZE[1]) + 0.5)
        places = np.stack([x, y], -1) + aside  # where in its square each pixel is asked
        away = np.linalg.norm(places[..., None, :] - window[:, :2], axis=-1)
        within = (away <= width / 2) & kept
        depth = np.where(within, window[:, 2], np.inf)
        self.nearest, self.depth = depth.argmin(-1), depth.min(-1)
        self.drawn = within.any(-1)
        self.sure = ~((np.abs(away - width / 2) < ROUNDING) & kept).any(-1)
        self.count = within.sum(-1)
        if depth.shape[-1] > 1:  # and of two as near as each other neither is
            two = np.sort(depth, -1)[..., :2]
            self.sure &= ~(two[..., 1] < two[..., 0] + DEPTHS)

    def check(self, picture):
        assert self.drawn.sum() > 20
        assert (picture.drawn == self.drawn)[self.sure].all()
        both = self.drawn & picture.drawn & self.sure
        shown = self.nearest[both]
        assert (picture.ids[both][:, 0] == self.streamlines[shown]).all()
        np.testing.assert_allclose(picture.position[both][:, 0], self.places[shown], atol=1e-3)
        np.testing.assert_allclose(picture.window_depth[both], self.depth[both], atol=DEPTHS)


def ends(width, **more):
    return FibletStyle(line_width=width, ends=True, **more)


VIEWS = {
    "parallel": {"height": 160.0},
    "perspective": {},
    "close": {"eye": (0, -60, 0), "near": 20.0, "far": 90.0},  # which cuts some away
}


@pytest.mark.few(6)
@pytest.mark.every("value")
@pytest.mark.parametrize("pipeline", PIPELINES)
@pytest.mark.parametrize("width", [1.0, 4.0, 9.0])
@pytest.mark.parametrize("kind", [1, 2, 3])
@pytest.mark.parametrize("where", VIEWS)
def test_discs_about_ends(gl, fabricate, random_lines, camera, pipeline, width, kind, where):
    fiblets = fabricate(random_lines(150, seed=kind), kind=kind, per_fiblet=17)
    matrix = camera(SIZE, **VIEWS[where])
    picture = draw(gl, fiblets, View(SIZE, matrix), ends(width), pipeline=pipeline)
    Discs(fiblets.lines, matrix, width).check(picture)


@pytest.mark.parametrize("pipeline", PIPELINES)
def test_a_line_of_one_segment_has_both_ends(gl, fabricate, camera, pipeline):
    """Far apart, on each other, and cut by the side of the picture; the middle stays empty."""
    lines = [
        np.array([[-40.0, 0, 20], [40, 0, 25]]),
        np.array([[0.0, -3, -20], [1, 3, -20]]),
        np.array([[0.0, 0, -45], [300, 0, -45]]),
    ]
    fiblets = fabricate(lines, kind=3)
    matrix = camera(SIZE)
    picture = draw(gl, fiblets, View(SIZE, matrix), ends(11.0), pipeline=pipeline)
    Discs(fiblets.lines, matrix, 11.0).check(picture)


def test_a_disc_beside_the_picture_reaches_into_it(gl, fabricate, camera):
    size, matrix = SIZE, camera(SIZE, height=240.0)
    line = np.array([[162.2, 0.0, 0.0], [400.0, 0.0, 0.0]])  # window x = 322.2
    fiblets = fabricate([line], kind=3)
    for pipeline in ("compute", "geometry"):
        drawn = draw(gl, fiblets, View(size, matrix), ends(6.0), pipeline=pipeline).drawn
        assert drawn[120].nonzero()[0].tolist() == [319]


@pytest.mark.parametrize("pipeline", PIPELINES)
def test_far_lines_keep_both_ends(gl, fabricate, random_lines, camera, pipeline):
    """Fiblets drawn as one segment, half a pixel beside their points at most."""
    fiblets = fabricate(random_lines(60, seed=4), kind=2)
    view = View(SIZE, camera(SIZE, eye=(0, -900, 0), far=1200.0))
    every = draw(gl, fiblets, view, ends(7.0, tolerance=0.0), pipeline=pipeline)
    far = draw(gl, fiblets, view, ends(7.0, tolerance=0.5), pipeline=pipeline)
    assert (every.drawn != far.drawn).sum() < 0.1 * every.drawn.sum()
    assert (far.ids[..., 0] == every.ids[..., 0])[far.drawn & every.drawn].mean() > 0.95


@pytest.mark.parametrize("pipeline", PIPELINES)
def test_planes_leave_ends_on_the_kept_side(gl, fabricate, random_lines, camera, pipeline):
    fiblets = fabricate(random_lines(150, seed=9), kind=3, per_fiblet=20)
    matrix = camera(SIZE)
    view = View(SIZE, matrix, clip_planes=[(1.0, 0, 0, -5.0)])
    picture = draw(gl, fiblets, view, ends(1.0), pipeline=pipeline)
    discs = Discs(fiblets.lines, matrix, 1.0, keep=lambda points, _: points[:, 0] >= 5.0)
    points, _, _ = ends_of(fiblets.lines)
    edge = np.abs(points[:, 0] - 5.0) < 0.5  # which the plane cuts as it cuts wide lines
    discs.sure &= ~edge[discs.nearest]
    clear = Discs(fiblets.lines, matrix, 3.0, keep=lambda points, _: np.abs(points[:, 0] - 5.0) < 0.5)
    discs.sure &= ~clear.drawn
    discs.check(picture)


@pytest.mark.parametrize("pipeline", PIPELINES)
def test_regions_cut_discs_at_the_depth_of_their_points(gl, fabricate, random_lines, camera, pipeline):
    fiblets = fabricate(random_lines(150, seed=9), kind=3, per_fiblet=20)
    matrix, ball = camera(SIZE), regions.Sphere((5.0, -3.0, 2.0), 28.0)
    picture = draw(gl, fiblets, View(SIZE, matrix, region=ball), ends(9.0), pipeline=pipeline)
    assert picture.drawn.sum() > 50
    # All that is drawn lies in the ball, and where all of a disc does, it is there.
    y, x = np.nonzero(picture.drawn)
    window = np.c_[2 * (x + 0.5) / SIZE[0] - 1, 2 * (y + 0.5) / SIZE[1] - 1, 2 * picture.window_depth[y, x] - 1]
    places = to_clip(window, np.linalg.inv(matrix))
    away = np.linalg.norm(places[:, :3] / places[:, 3:] - (5.0, -3.0, 2.0), axis=1)
    assert (away < 28.0 + 1e-2).all()
    well_inside = Discs(
        fiblets.lines, matrix, 9.0, keep=lambda points, _: np.linalg.norm(points - (5.0, -3.0, 2.0), axis=1) < 20.0
    )
    assert picture.drawn[well_inside.drawn & well_inside.sure].all()
    anywhere = Discs(fiblets.lines, matrix, 9.0)
    assert not picture.drawn[~anywhere.drawn & anywhere.sure].any()


@pytest.mark.parametrize("pipeline", PIPELINES)
def test_filters_hide_ends(gl, fabricate, random_lines, camera, pipeline):
    """Of hidden streamlines both, and of cut ones those whose segment is gone; a cut makes no new end."""
    fiblets = fabricate(random_lines(120, seed=3), kind=2, per_fiblet=12)
    view, rng = View(SIZE, camera(SIZE)), np.random.default_rng(1)
    keep, bits = rng.random(fiblets.n_streamlines) < 0.5, rng.random(fiblets.n_points) < 0.7
    first = np.concatenate([[0], np.cumsum([len(line) for line in fiblets.lines])])

    def shown(_points, streamlines):
        places = ends_of(fiblets.lines)[2]
        counts = np.diff(first)[streamlines]
        at = first[streamlines] + places
        alone = (counts == 1) | ((places > 0) & (places % 12 == 0))  # a fiblet of one point is drawn where that is kept
        beside = np.where(alone, at, np.where(places == 0, at + 1, at - 1))
        return keep[streamlines] & bits[at] & bits[beside]

    renderer = FibletRenderer(gl, fiblets, pipeline=pipeline)
    try:
        renderer.filtering = Filter(keep, packed(bits))
        picture = read(renderer.render(view, ends(5.0)))
        Discs(fiblets.lines, view.model_view_projection, 5.0, keep=shown).check(picture)
    finally:
        renderer.release()


@pytest.mark.parametrize("culling", ["two-phase", "coverage", None])
@pytest.mark.parametrize("pipeline", ["compute", "geometry"])
def test_fiblets_without_an_end_are_culled(gl, random_lines, camera, pipeline, culling):
    lines = [line for line in random_lines(400, seed=8) if len(line) > 130]  # three fiblets or more
    fiblets = compress(Streamlines.from_list(lines), max_error=1e-3)
    view = View(SIZE, camera(SIZE, height=600.0))
    renderer = FibletRenderer(gl, fiblets, pipeline=pipeline, culling=culling)
    try:
        pictures = [read(renderer.render(view, ends(3.0 + 1e-9 * k))) for k in range(3)]
        counts = renderer.explain()["fiblets"]
        assert "LINE_ENDS" in renderer.explain()["features"]
    finally:
        renderer.release()
    assert counts["in_frustum"] == 2 * len(lines) < counts["total"]
    plain = draw(gl, fiblets, view, ends(3.0), pipeline=pipeline, culling=None)
    for picture in pictures if culling != "coverage" else []:
        assert_same(picture, plain)


def test_clusters_lose_no_disc(gl, camera, monkeypatch):
    fiblets = compress(brain_streamlines(1500, step=0.5, seed=2), max_error=1e-3)
    plain, views = FibletRenderer(gl, fiblets, culling=None), []
    monkeypatch.setattr(chunks, "CLUSTERED", 0)
    clustered = FibletRenderer(gl, fiblets, culling="two-phase")
    try:
        assert all("clusters" in chunk.buffers for chunk in clustered._chunks)
        for turn in np.linspace(0.0, 1.0, 5):
            eye = (300 * np.sin(turn), -300 * np.cos(turn), 40.0)
            views.append(View(SIZE, camera(SIZE, eye=eye, near=50.0, far=600.0)))
        for view in [*views, views[-1], views[0]]:
            assert_same(read(clustered.render(view, ends(6.0))), read(plain.render(view, ends(6.0))))
    finally:
        clustered.release()
        plain.release()


def test_pipelines_show_the_same(gl, random_lines, camera):
    fiblets = compress(Streamlines.from_list(random_lines(200, seed=5)), max_error=1e-3)
    view = View(SIZE, camera(SIZE))
    pictures = [draw(gl, fiblets, view, ends(5.0, edges=True), pipeline=name) for name in PIPELINES]
    for picture in pictures[1:]:
        assert (picture.drawn == pictures[0].drawn).all()
        assert (picture.ids[..., 0] == pictures[0].ids[..., 0])[picture.drawn].mean() > 0.999


@pytest.mark.parametrize("serial", [False, True], ids=["together", "serial"])
def test_meshes_show_the_same(gl, monkeypatch, fabricate, random_lines, camera, serial):
    fiblets = fabricate(random_lines(60, seed=2), kind=2, per_fiblet=20)
    matrix = camera(SIZE)
    renderer = emulated_renderer(monkeypatch, gl, fiblets, serial=serial)
    try:
        Discs(fiblets.lines, matrix, 7.0).check(read(renderer.render(View(SIZE, matrix), ends(7.0))))
    finally:
        renderer.release()


def test_samples_of_discs(gl, fabricate, random_lines, camera):
    """Sixteen samples of a pixel, drawn as pixels at places of their own."""
    fiblets = fabricate(random_lines(60, seed=7), kind=2, per_fiblet=20)
    matrix, width = camera(SIZE), 14.0
    text = shaders.read_shader("fiblets/compute/software_raster/cover_wide.glsl")
    found = re.findall(r"vec2\((-?\d\.\d+), (-?\d\.\d+)\)", text)  # test_antialias_layers.py compares them
    aside = np.tile(np.array(found, float).reshape(4, 4, 2), (SIZE[1] // 4, SIZE[0] // 4, 1))
    renderer, target = FibletRenderer(gl, fiblets, pipeline="compute"), GBuffer(gl, SIZE)
    try:
        view, style = View(SIZE, matrix), ends(width, exact=True)
        (lines,) = renderer.sampled(view, style, (0, 0, *SIZE))
        assert list(lines.draw(view, style, target, False)) == []
        drawn = np.frombuffer(target.depth.read(), "<u4").reshape(*SIZE[::-1]) != EMPTY
        ids = np.frombuffer(target.ids.read(), "<u4").reshape(*SIZE[::-1], 2)[..., 0]
    finally:
        renderer.release()
        target.release()
    discs = Discs(fiblets.lines, matrix, width, aside=aside)
    assert (drawn == discs.drawn)[discs.sure].all()
    both = discs.sure & drawn
    assert (ids[both] == discs.streamlines[discs.nearest[both]]).all()


def test_some_streamlines_look_as_if_there_were_no_others(gl, random_lines, camera):
    fiblets = compress(Streamlines.from_list(random_lines(120, seed=1)), max_error=1e-4)
    keep, view = np.random.default_rng(2).random(fiblets.n_streamlines) < 0.4, View(SIZE, camera(SIZE))
    renderer = FibletRenderer(gl, fiblets)
    try:
        renderer.filtering = Filter(keep)
        picture = read(renderer.render(view, ends(4.0)))
    finally:
        renderer.release()
    alone = draw(gl, restrict(fiblets, keep), view, ends(4.0))
    np.testing.assert_array_equal(picture.depth, alone.depth)
    np.testing.assert_array_equal(picture.ids[picture.drawn], alone.ids[alone.drawn])


@pytest.mark.parametrize("pipeline", ["compute", "geometry"])
def test_all_ends_of_a_pixel_add_up(gl, fabricate, random_lines, camera, pipeline):
    """Together, and in slices behind the nearest; in layers, one behind the other."""
    fiblets = fabricate([line for line in random_lines(150, seed=6) if len(line) > 60], kind=3, per_fiblet=20)
    matrix, width = camera(SIZE), 21.0
    view, discs = View(SIZE, matrix), Discs(fiblets.lines, matrix, width)
    renderer = FibletRenderer(gl, fiblets, pipeline=pipeline)
    try:
        found = renderer.gather(view, ends(width), Paint()).read()[0][..., 3]
        renderer.render(view, ends(width))
        behind = renderer.gather(view, ends(width), Paint(), sliced=True).read()[..., 3].sum(0)
        layers = renderer.render_layers(view, ends(width), 3)
        drawn = np.frombuffer(layers.depth.read(), "<u4").reshape(-1, *SIZE[::-1]) != EMPTY
    finally:
        renderer.release()
    assert discs.count.max() > 3
    assert (found == discs.count)[discs.sure].all()
    assert (behind == np.maximum(discs.count - 1, 0))[discs.sure].all()
    for number, layer in enumerate(drawn):
        assert (layer == (discs.count > number))[discs.sure].all()


def test_ends_have_no_radius():
    with pytest.raises(ValueError, match="radius"):
        FibletStyle(ends=True, radius=1.0)
