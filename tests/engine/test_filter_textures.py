"""Streamlines and points that the caller left out: gone, in every pipeline, and what is behind them shows."""

import moderngl
import numpy as np
import pytest

from pvfiblets import Streamlines, compress
from pvfiblets.codec.editing.restrict import restrict
from pvfiblets.engine import EngineError, FibletRenderer, FibletStyle, View
from pvfiblets.engine.errors import GPUMemoryError
from pvfiblets.engine.fiblets.data.filter_textures import Filter, FilterTextures
from pvfiblets.query.selection.bits import stretch
from pvfiblets.synthetic import brain_streamlines
from tests.drivers import MESH

from .pictures import EVERY_POINT, SIZE, assert_same, read

PIPELINES = ["compute", "tessellation", "geometry", *MESH]
STYLES = {"thin": EVERY_POINT, "far detail": FibletStyle(), "wide": FibletStyle(5.0, tolerance=0.0)}


def packed(bits):
    whole = np.zeros(-(-len(bits) // 32) * 32, bool)
    whole[: len(bits)] = bits
    return np.packbits(whole, bitorder="little").view("<u4")


def filtered(gl, fiblets, view, style, wanted, **options):
    renderer = FibletRenderer(gl, fiblets, **options)
    try:
        renderer.filtering = wanted
        return read(renderer.render(view, style)), renderer.explain()
    finally:
        renderer.release()


def same_pixels(a, b):
    """Depth, streamline, tangent and place, but not which fiblet: its number depends on which others there are."""
    np.testing.assert_array_equal(a.depth, b.depth)
    drawn = a.drawn
    np.testing.assert_array_equal(a.ids[drawn], b.ids[drawn])
    np.testing.assert_array_equal(a.position[drawn], b.position[drawn])


@pytest.mark.more
@pytest.mark.every("value")
@pytest.mark.parametrize("pipeline", PIPELINES)
@pytest.mark.parametrize("style", STYLES)
def test_kept_streamlines_look_as_if_there_were_no_others(gl, random_lines, camera, pipeline, style):
    lines = random_lines(120, seed=1)
    lines[7] = lines[31] = np.zeros((0, 3))
    lines = Streamlines.from_list(lines)
    view = View(SIZE, camera(SIZE))
    for fiblets in (compress(lines), compress(lines, max_error=1e-5), compress(lines, order="hilbert")):
        keep = np.random.default_rng(2).random(fiblets.n_streamlines) < 0.4
        picture, report = filtered(gl, fiblets, view, STYLES[style], Filter(streamlines=keep), pipeline=pipeline)
        alone, _ = filtered(gl, restrict(fiblets, keep), view, STYLES[style], None, pipeline=pipeline)
        same_pixels(picture, alone)
        assert keep[picture.ids[..., 0][picture.drawn]].all()
        assert picture.drawn.any()
        assert "STREAMLINE_MASK" in report["features"]
        assert report["fiblets"]["in_frustum"] < report["fiblets"]["total"]


def kept_segments(picture, lines, bits):
    """Whether the segment that a pixel shows is one between two kept points, (n,) for drawn pixels."""
    starts = np.concatenate([[0], np.cumsum([len(line) for line in lines])])
    ids, place = picture.ids[..., 0][picture.drawn], picture.position[..., 0][picture.drawn].astype(float)
    points = np.array([len(line) for line in lines])[ids]
    first = np.minimum(np.floor(place), np.maximum(points - 2, 0)).astype(int)
    # A joint belongs to both segments.
    near = np.abs(place - np.round(place)) < 2e-3
    kept = np.zeros(len(ids), bool)
    for shift in (0, -1, 1):
        i = np.clip(first + shift, 0, np.maximum(points - 2, 0))
        a = starts[ids] + i
        here = bits[a] & bits[np.minimum(a + np.where(points > 1, 1, 0), len(bits) - 1)]
        kept |= here & ((shift == 0) | near)
    return kept


@pytest.mark.few(1)
@pytest.mark.every("pair")
@pytest.mark.parametrize("pipeline", PIPELINES)
@pytest.mark.parametrize("style", STYLES)
@pytest.mark.parametrize("kind", [1, 2, 3])
def test_segments_between_kept_points_are_drawn_and_no_others(
    gl, fabricate, random_lines, camera, pipeline, style, kind
):
    lines = random_lines(90, seed=5)
    fiblets = fabricate(lines, kind=kind, per_fiblet=7 * kind)
    # Runs of kept and left out points, and a few single ones.
    rng = np.random.default_rng(kind)
    bits = np.repeat(rng.random(fiblets.n_points) < 0.6, rng.integers(1, 40, fiblets.n_points))[: fiblets.n_points]
    view = View(SIZE, camera(SIZE))
    whole, _ = filtered(gl, fiblets, view, STYLES[style], None, pipeline=pipeline)
    picture, report = filtered(gl, fiblets, view, STYLES[style], Filter(points=packed(bits)), pipeline=pipeline)
    assert "POINT_MASK" in report["features"]
    if style != "far detail":  # a whole fiblet is one segment there, of places evenly spread
        assert kept_segments(picture, lines, bits).all()
    # What was nearest and is kept is there still.
    shown = np.zeros(whole.drawn.shape, bool)
    shown[whole.drawn] = kept_segments(whole, lines, bits)
    near = np.abs(whole.position[..., 0] - np.round(whole.position[..., 0])) < 0.2  # joints may be the other segment's
    sure = shown & ~near
    assert sure.any()
    if style == "far detail":  # a fiblet that is cut is drawn by its points, up to half a pixel beside
        assert (picture.depth[sure] != 0xFFFFFFFF).mean() > 0.9
        return
    # Programs that clip may round a depth otherwise than others; a wide line gains round ends where it is cut.
    assert (picture.depth[sure] <= whole.depth[sure] + np.uint32(1024)).all()
    if style == "thin":
        assert (picture.depth[sure] >= whole.depth[sure] - np.uint32(1024)).all()
        assert (picture.ids[sure] == whole.ids[sure]).all(axis=-1).mean() > 0.995


@pytest.mark.few(2)
@pytest.mark.parametrize("pipeline", PIPELINES)
def test_keeping_everything_changes_nothing(gl, fabricate, random_lines, camera, pipeline):
    fiblets = fabricate(random_lines(60, seed=7), kind=2)
    view = View(SIZE, camera(SIZE))
    everything = Filter(np.ones(fiblets.n_streamlines, bool), packed(np.ones(fiblets.n_points, bool)))
    whole, _ = filtered(gl, fiblets, view, EVERY_POINT, None, pipeline=pipeline)
    picture, _ = filtered(gl, fiblets, view, EVERY_POINT, everything, pipeline=pipeline)
    assert_same(picture, whole)
    nothing, report = filtered(
        gl, fiblets, view, EVERY_POINT, Filter(points=packed(np.zeros(fiblets.n_points, bool))), pipeline=pipeline
    )
    assert not nothing.drawn.any()
    assert report["fiblets"]["in_frustum"] == 0


@pytest.mark.few(1)
@pytest.mark.parametrize("culling", ["two-phase", "coverage", None])
def test_filters_change_live_and_culling_stays_right(gl, camera, culling):
    fiblets = compress(brain_streamlines(3000, seed=3))
    view = View(SIZE, camera(SIZE, eye=(0, -300, 0), target=(0, 0, 0), far=700.0))
    rng = np.random.default_rng(1)
    renderer = FibletRenderer(gl, fiblets, culling=culling)
    reference = FibletRenderer(gl, fiblets, culling=None)
    try:
        first = read(renderer.render(view, EVERY_POINT))
        for share in (0.5, 0.05, 0.9, None):
            mask = None if share is None else rng.random(len(fiblets)) < share
            wanted = None if share is None else Filter(mask, packed(rng.random(fiblets.n_points) < 0.995))
            renderer.filtering = reference.filtering = wanted
            assert renderer.filtering is wanted
            picture = read(renderer.render(view, EVERY_POINT))
            assert_same(picture, read(reference.render(view, EVERY_POINT)))
        assert_same(picture, first)
        assert "filter" not in {buffer["name"] for buffer in renderer.explain()["buffers"]}
    finally:
        renderer.release()
        reference.release()


@pytest.mark.more
@pytest.mark.parametrize("pipeline", PIPELINES)
def test_sets_in_many_chunks(gl, camera, pipeline):
    fiblets = compress(brain_streamlines(4000, seed=5))
    view = View(SIZE, camera(SIZE, eye=(0, -300, 0), target=(0, 0, 0), far=700.0))
    rng = np.random.default_rng(4)
    wanted = Filter(rng.random(len(fiblets)) < 0.7, packed(rng.random(fiblets.n_points) < 0.99))
    one, _ = filtered(gl, fiblets, view, EVERY_POINT, wanted, pipeline=pipeline)
    many, _ = filtered(gl, fiblets, view, EVERY_POINT, wanted, pipeline=pipeline, max_buffer_bytes=1_000_000)
    assert_same(many, one)


def test_a_part_of_the_set_is_filtered_as_the_whole(gl, camera):
    fiblets = compress(brain_streamlines(2000, seed=6))
    view = View(SIZE, camera(SIZE, eye=(0, -300, 0), target=(0, 0, 0), far=700.0))
    rng = np.random.default_rng(9)
    mask, bits = rng.random(len(fiblets)) < 0.7, rng.random(fiblets.n_points) < 0.99
    wanted = Filter(mask, packed(bits))
    room = int(0.55 * fiblets.nbytes)
    renderer = FibletRenderer(gl, fiblets, fit="sample", max_total_bytes=room)
    whole = FibletRenderer(gl, fiblets)
    try:
        assert renderer.share < 0.9
        renderer.filtering = wanted
        picture = read(renderer.render(view, EVERY_POINT))
        there = np.zeros(len(fiblets), bool)
        there[np.asarray(renderer._fiblets.rank_to_id)] = True
        whole.filtering = Filter(mask & there, wanted.points)
        same_pixels(picture, read(whole.render(view, EVERY_POINT)))
    finally:
        renderer.release()
        whole.release()


def test_filters_for_another_set_are_refused(gl, fabricate, random_lines):
    fiblets = fabricate(random_lines(20, seed=1), kind=2)
    renderer = FibletRenderer(gl, fiblets)
    try:
        with pytest.raises(ValueError, match="19 streamlines are kept or not; the set has 20"):
            renderer.filtering = Filter(np.ones(19, bool))
        with pytest.raises(ValueError, match="32 points are kept or not"):
            renderer.filtering = Filter(points=np.ones(1, np.uint32))
        with pytest.raises(TypeError, match="give one row of bool"):
            Filter(np.ones(20))
        with pytest.raises(TypeError, match="give one row of uint32"):
            Filter(points=np.ones((2, 20), np.uint32))
    finally:
        renderer.release()
    with pytest.raises(EngineError, match="released"):
        renderer.filtering = None


def test_without_memory_everything_is_drawn_again(gl, fabricate, random_lines, camera, monkeypatch):
    fiblets = fabricate(random_lines(20, seed=1), kind=2)
    view, half = View(SIZE, camera(SIZE)), np.arange(20) % 2 == 0
    bits = np.zeros(fiblets.n_points // 32 + 1, np.uint32)
    with_everything, _ = filtered(gl, fiblets, view, EVERY_POINT, None)
    renderer = FibletRenderer(gl, fiblets)
    made, texture = [], FilterTextures._texture
    try:
        renderer.filtering = Filter(half, bits)
        made += [renderer._kept._filter._streamlines, *renderer._kept._filter._points]
        renderer.render(view, EVERY_POINT)

        def fails(self, held, words):
            if held is not made[0]:
                raise GPUMemoryError("none left")
            return texture(self, held, words)

        monkeypatch.setattr(FilterTextures, "_texture", fails)
        with pytest.raises(GPUMemoryError):
            renderer.filtering = Filter(~half, ~bits)
        assert renderer.filtering is None
        assert_same(read(renderer.render(view, EVERY_POINT)), with_everything)
        assert all(isinstance(one.mglo, moderngl.InvalidObject) for one in made)
    finally:
        renderer.release()


def test_stretches_of_bits():
    bits = np.random.default_rng(3).random(1000) < 0.5
    words = packed(bits)
    for first, last in ((0, 1000), (1, 999), (31, 33), (32, 64), (63, 1002), (997, 1002), (500, 500)):
        row = np.unpackbits(stretch(words, first, last).view(np.uint8), bitorder="little")
        wanted = bits[first:last]
        np.testing.assert_array_equal(row[: len(wanted)], wanted)
