"""Regions of a view: what is shown lies in the region, what lies in it is shown; every pipeline, all culling."""

import numpy as np
import pytest

from pvfiblets import compress, regions
from pvfiblets.engine import FibletRenderer, FibletStyle, View
from pvfiblets.synthetic import brain_streamlines
from tests.drivers import MESH

from .likeness import assert_like
from .pictures import EVERY_POINT, SIZE, assert_same, draw, read
from .region_shapes import torus

PIPELINES = ["compute", "tessellation", "geometry", *MESH]
FAR = {"eye": (120, -200, 110), "target": (0, 0, 0), "far": 700.0}


TORUS = regions.Surface(*torus(30.0, 12.0, 48, 24))
BALL, BOX = regions.Sphere((5.0, -3.0, 2.0), 28.0), regions.Box((-25.0, 25.0, -20.0, 25.0, -25.0, 25.0))
REGIONS = {
    "ball": BALL,
    "slab": regions.Slab((0.3, 1.0, 0.1), (0.0, 5.0, 0.0), 8.0),
    "torus": TORUS,
    "outside a torus": ~TORUS,
    "box without a ball": BOX - BALL,
    "torus or ball": TORUS.moved(np.array([[1.0, 0, 0, 5], [0, 0.0, -1, 0], [0, 1, 0, 3], [0, 0, 0, 1]])) | BALL,
}


def unprojected(view, depth):
    """Data position of the centre of every pixel at its window depth, (h, w, 3)."""
    w, h = view.size
    x, y = np.meshgrid((np.arange(w) + 0.5) / w * 2 - 1, (np.arange(h) + 0.5) / h * 2 - 1)
    clip = np.stack([x, y, 2 * depth - 1, np.ones_like(x)], axis=-1)
    data = clip @ np.linalg.inv(view.model_view_projection).T
    return data[..., :3] / data[..., 3:]


def sure(region, points, margin=0.02):
    """+1 where a ball of `margin` mm about a position (n, 3) lies in the region, -1 outside, 0 between."""
    rng = np.random.default_rng(0).normal(size=(30, 3))
    inside = np.stack([region.contains(points + margin * d / np.linalg.norm(d)) for d in rng])
    return np.where(inside.all(0), 1, np.where((~inside).all(0), -1, 0))


def state(region, view, picture):
    """What :func:`sure` says of every drawn pixel of a picture, (h, w); 0 where nothing is drawn."""
    found = np.zeros(picture.drawn.shape, int)
    found[picture.drawn] = sure(region, unprojected(view, picture.window_depth)[picture.drawn])
    return found


@pytest.mark.few(1)
@pytest.mark.parametrize("pipeline", PIPELINES)
@pytest.mark.parametrize("name", REGIONS)
def test_a_picture_shows_what_lies_in_the_region(gl, fabricate, random_lines, camera, name, pipeline):
    region = REGIONS[name]
    fiblets = fabricate(random_lines(150, seed=2), kind=2)
    matrix = camera(SIZE, **FAR)
    view, free = View(SIZE, matrix, (), region), View(SIZE, matrix)
    picture = draw(gl, fiblets, view, pipeline=pipeline, culling=None)
    whole = draw(gl, fiblets, free, pipeline=pipeline, culling=None)
    assert picture.drawn.sum() > 200
    assert (state(region, view, picture) >= 0).all(), "something outside is shown"
    kept = state(region, view, whole) > 0
    assert kept.any()
    difference = picture.depth[kept].astype(np.int64) - whole.depth[kept].astype(np.int64)
    assert np.abs(difference).max() <= 2048, "something inside is not shown"
    assert (picture.ids[..., 0][kept] == whole.ids[..., 0][kept]).mean() > 0.999
    assert (picture.depth[picture.drawn] >= whole.depth[picture.drawn].astype(np.int64) - 2048).all()


@pytest.mark.few(1)
@pytest.mark.every("value")
@pytest.mark.parametrize("pipeline", PIPELINES)
@pytest.mark.parametrize("name", ["ball", "torus", "box without a ball"])
def test_tubes_are_cut_and_are_else_as_they_were(gl, fabricate, random_lines, camera, name, pipeline):
    region, style = REGIONS[name], FibletStyle(radius=1.5)
    fiblets = fabricate(random_lines(60, seed=2), kind=2)
    matrix = camera(SIZE, **FAR)
    view, free = View(SIZE, matrix, (), region), View(SIZE, matrix)
    whole = draw(gl, fiblets, free, style, pipeline=pipeline, culling=None)
    renderer = FibletRenderer(gl, fiblets, pipeline=pipeline, culling=None)
    first = read(renderer.render(view, style))
    renderer.render(free, style)
    again = read(renderer.render(view, style))  # with the boundaries that are there already
    renderer.release()
    assert_same(first, again)
    assert first.drawn.sum() > 200
    assert (state(region, view, first) >= 0).all()
    kept = state(region, view, whole) > 0
    assert kept.sum() > 100
    np.testing.assert_array_equal(first.depth[kept], whole.depth[kept])


@pytest.mark.few(1)
@pytest.mark.parametrize("pipeline", PIPELINES[1:])
@pytest.mark.parametrize("style", [FibletStyle(), FibletStyle(6.0)], ids=["thin", "wide"])
def test_pipelines_agree(gl, fabricate, random_lines, camera, pipeline, style):
    fiblets = fabricate(random_lines(100, seed=4), kind=1, per_fiblet=7)
    for region in (REGIONS["torus"], REGIONS["box without a ball"]):
        view = View(SIZE, camera(SIZE, **FAR), (), region)
        reference = draw(gl, fiblets, view, style, culling=None)
        assert_like(draw(gl, fiblets, view, style, pipeline=pipeline, culling=None), reference)


def test_wide_lines_are_cut_by_their_pixels(gl, fabricate, random_lines, camera):
    fiblets = fabricate(random_lines(100, seed=5), kind=2)
    view = View(SIZE, camera(SIZE, **FAR), (), BALL)
    picture = draw(gl, fiblets, view, FibletStyle(9.0, tolerance=0.0), culling=None)
    assert picture.drawn.any()
    assert (state(BALL, view, picture) >= 0).all()


@pytest.mark.more
@pytest.mark.parametrize("pipeline", PIPELINES)
def test_fiblets_outside_are_culled_and_hidden_ones_stay_exact(gl, camera, pipeline):
    fiblets = compress(brain_streamlines(1500 if pipeline == "compute" else 400, seed=3))
    culled = FibletRenderer(gl, fiblets, pipeline=pipeline)
    whole = FibletRenderer(gl, fiblets, pipeline=pipeline, culling=None)
    try:
        views = [View((200, 150), camera((200, 150), **FAR), (), region) for region in (None, *REGIONS.values(), None)]
        counts = []
        for view in views:
            picture = read(culled.render(view, EVERY_POINT))
            assert_same(picture, read(whole.render(view, EVERY_POINT)))
            report = culled.explain()
            counts.append(report["fiblets"]["in_frustum"])
            assert ("CLIP_REGION" in report["features"]) == (view.region is not None)
            assert ("region" in {row["name"] for row in report["buffers"]}) == (view.region is not None)
        assert counts[0] == counts[-1]
        assert counts[1] < 0.6 * counts[0], "a ball leaves most of a brain out"
    finally:
        culled.release()
        whole.release()


def test_moving_a_region_uploads_nothing(gl, camera):
    fiblets = compress(brain_streamlines(300, seed=1))
    renderer = FibletRenderer(gl, fiblets)
    surface = TORUS
    try:
        sizes, pictures = [], []
        for shift in (0.0, 5.0, 10.0):
            matrix = np.eye(4)
            matrix[0, 3] = shift
            view = View((160, 120), camera((160, 120), **FAR), (), surface.moved(matrix))
            pictures.append(read(renderer.render(view, EVERY_POINT)).depth)
            fields = renderer._kept._block._textures
            sizes.append((fields.nbytes, id(fields._texture), [id(b) for b in renderer._chunks[0].buffers.values()]))
        assert sizes[0] == sizes[1] == sizes[2]
        assert (pictures[0] != pictures[1]).any()
        assert renderer.render(view, EVERY_POINT).generation == renderer._buffer.generation == 3
    finally:
        renderer.release()


def test_labels_cannot_cut(gl, camera):
    fiblets = compress(brain_streamlines(20, seed=1))
    renderer = FibletRenderer(gl, fiblets)
    labels = regions.Labels(np.ones((3, 3, 3), int), np.eye(4))
    try:
        with pytest.raises(ValueError, match="label"):
            renderer.render(View((60, 50), camera((60, 50)), (), labels))
    finally:
        renderer.release()
