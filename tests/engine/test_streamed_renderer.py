"""Sets larger than GPU memory, drawn part by part: held against a renderer of all of the set, bit by bit."""

import numpy as np
import pytest

from pvfiblets import regions
from pvfiblets.engine import EngineError, FibletRenderer, FibletStyle, View
from pvfiblets.engine.errors import GPUMemoryError
from pvfiblets.engine.fiblets.data.filter_textures import Filter
from pvfiblets.engine.fiblets.data.sampled_volume import VolumeSource
from pvfiblets.engine.fiblets.gather.paint import Paint
from pvfiblets.engine.fiblets.parts import streamed_renderer as streamed
from pvfiblets.engine.fiblets.parts.parts import Stretches, in_view, reach_of
from pvfiblets.engine.fiblets.parts.streamed_renderer import StreamedRenderer, streamed_renderer

from .pictures import SIZE, assert_alike, brain_with_gaps, read

WHOLE_BRAIN = {"eye": (0, -300, 40), "target": (0, -10, 20), "far": 900.0}
NEAR = {"eye": (60, -60, 90), "target": (20, 0, 40), "far": 900.0}


@pytest.fixture(scope="module")
def brain():
    return brain_with_gaps(1500, 1.5)


@pytest.fixture
def made(gl, brain):
    """Renderers of all of the set, and of parts of it; the latter has memory for a third."""
    renderers = []

    def make(pipeline="auto", share=1 / 3, **options):
        whole = FibletRenderer(gl, brain, pipeline=pipeline, culling=None)
        needed = sum(b["bytes"] for b in whole.explain()["buffers"]) + 2 * brain.n_points
        parts = streamed_renderer(gl, brain, pipeline=pipeline, max_total_bytes=int(share * needed), **options)
        renderers.extend([whole, parts])
        return whole, parts

    yield make
    for renderer in renderers:
        renderer.release()


@pytest.mark.more
@pytest.mark.parametrize(
    "pipeline", ["compute", "geometry", pytest.param("tessellation", marks=pytest.mark.exhaustive)]
)
def test_a_complete_picture_is_that_of_the_whole_set(made, camera, pipeline):
    whole, parts = made(pipeline)
    assert isinstance(parts, StreamedRenderer)
    for place in (WHOLE_BRAIN, NEAR):
        view = View(SIZE, camera(SIZE, **place))
        for style in (FibletStyle(values="height"), FibletStyle(line_width=4.0, across=True, edges=True)):
            assert_alike(read(parts.render(view, style)), read(whole.render(view, style)))
            assert parts.share == 1.0
            assert not parts.unfinished


@pytest.mark.few(1)
@pytest.mark.parametrize("style", [FibletStyle(radius=0.5, across=True), FibletStyle(tolerance=2.0),
                                   FibletStyle(6.0, ends=True, edges=True),
                                   FibletStyle(values="curvature"), FibletStyle(values="arc_length")])  # fmt: skip
def test_styles_are_those_of_the_whole_set(made, camera, style):
    whole, parts = made()
    view = View(SIZE, camera(SIZE, **NEAR))
    assert_alike(read(parts.render(view, style)), read(whole.render(view, style)))


@pytest.mark.more
def test_cuts_and_filters_are_those_of_the_whole_set(made, camera, brain):
    whole, parts = made()
    rng = np.random.default_rng(0)
    words = rng.integers(0, 2**32, -(-brain.n_points // 32), np.uint64).astype(np.uint32)
    kept = Filter(rng.random(brain.n_streamlines) < 0.5, words)
    for filtering in (None, kept):
        whole.filtering = parts.filtering = filtering
        for cut in ({}, {"clip_planes": [(1.0, 0.0, 0.0, 5.0)]}, {"region": regions.Sphere((0, 0, 20), 40.0)}):
            view = View(SIZE, camera(SIZE, **WHOLE_BRAIN), **cut)
            assert_alike(read(parts.render(view)), read(whole.render(view)))
    with pytest.raises(ValueError, match="5 streamlines are kept or not; the set has 1503"):
        parts.filtering = Filter(np.ones(5, bool))


def test_memory_is_kept_to(made, camera):
    _, parts = made()
    parts.render(View(SIZE, camera(SIZE, **WHOLE_BRAIN)))
    told = parts.explain()
    counts = told["parts"]
    assert counts["in_view"] == counts["total"] == counts["fetched"]
    assert 1 < counts["there"] < counts["total"]
    sizes = {one["name"]: one["bytes"] for one in told["buffers"]}
    records = sum(size for name, size in sizes.items() if name not in ("gbuffer", "parts' pictures", "depth"))
    assert records < parts._room


def test_the_same_picture_fetches_nothing_and_one_near_by_little(made, camera):
    _, parts = made()
    view = View(SIZE, camera(SIZE, **WHOLE_BRAIN))
    first = parts.render(view)
    fetched = parts.explain()["parts"]["fetched"]
    assert parts.render(view) is first
    assert parts.explain()["parts"]["fetched"] == fetched
    counts = parts.explain()["parts"]
    parts.render(View(SIZE, camera(SIZE, **NEAR)))
    # What is there is drawn first.
    assert parts.explain()["parts"]["fetched"] - fetched <= counts["total"] - counts["there"]


def test_parts_outside_the_view_are_left_out(made, camera):
    whole, parts = made()
    parts.render(View(SIZE, camera(SIZE, **WHOLE_BRAIN)))  # bounds are known from here on
    fetched = parts.explain()["parts"]["fetched"]
    away = View(SIZE, camera(SIZE, eye=(0, -300, 40), target=(0, -600, 40), far=900.0))
    assert_alike(read(parts.render(away)), read(whole.render(away)))
    counts = parts.explain()["parts"]
    assert (counts["in_view"], counts["fetched"]) == (0, fetched)


def test_hurried_pictures_fetch_no_part(made, camera):
    whole, parts = made()
    parts.hurried = True
    view = View(SIZE, camera(SIZE, **WHOLE_BRAIN))
    hurried = read(parts.render(view))
    counts = parts.explain()["parts"]
    assert counts["fetched"] == 1  # the even share
    assert parts.share < 1.0
    everything = read(whole.render(view))
    assert 0.3 < hurried.drawn.sum() / everything.drawn.sum() < 1.0
    assert (hurried.depth[hurried.drawn] >= everything.depth[hurried.drawn]).all()
    parts.render(View(SIZE, camera(SIZE, **NEAR)))
    assert parts.explain()["parts"]["fetched"] == 1
    parts.hurried = False
    assert_alike(read(parts.render(view)), everything)
    parts.hurried = True  # what has been drawn is shown, whole as it is
    assert_alike(read(parts.render(view)), everything)


def test_a_picture_goes_on_where_it_was_left(gl, made, camera):
    whole, parts = made()
    ticks = iter(range(1000))
    parts._clock = lambda: float(next(ticks))
    parts.patience = 0.5  # each part takes longer
    view = View(SIZE, camera(SIZE, **WHOLE_BRAIN))
    seen = []
    while not seen or parts.unfinished:
        seen.append(read(parts.render(view)).drawn.sum())
        assert (parts.share < 1.0) == parts.unfinished
    assert len(seen) == parts.explain()["parts"]["total"]
    assert (np.diff(seen) >= 0).all()
    assert seen[0] < seen[-1]
    assert_alike(read(parts.render(view)), read(whole.render(view)))


def test_ranges_are_those_of_the_whole_set(made, brain):
    whole, parts = made()
    volume = VolumeSource(np.arange(8, dtype=np.float32).reshape(2, 2, 2), np.eye(4))
    for values in ("height", "arc_length", "curvature", volume):
        assert parts.value_range(values) == whole.value_range(values)
    with pytest.raises(EngineError, match="no per-point array 'none'"):
        parts.value_range("none")


def test_what_needs_all_lines_says_so_and_nothing_stays_behind(made, camera, gl):
    _, parts = made()
    view = View(SIZE, camera(SIZE, **WHOLE_BRAIN))
    with pytest.raises(EngineError, match="drawn part by part has no layers of lines.*fit='sample'"):
        parts.render_layers(view)
    parts.render(View(SIZE, camera(SIZE, **WHOLE_BRAIN)))
    parts.release()
    parts.release()
    with pytest.raises(EngineError, match="released"):
        parts.render(View(SIZE, camera(SIZE, **WHOLE_BRAIN)))


@pytest.mark.more
@pytest.mark.parametrize("sliced", [False, True])
@pytest.mark.parametrize(
    "pipeline", ["compute", "geometry", pytest.param("tessellation", marks=pytest.mark.exhaustive)]
)
def test_sums_are_those_of_the_whole_set(made, camera, brain, pipeline, sliced):
    whole, parts = made(pipeline)
    view = View(SIZE, camera(SIZE, **WHOLE_BRAIN))
    for paint in (None, Paint("orientation")):
        for style in (FibletStyle(), FibletStyle(line_width=3.0)):
            found = parts.gather(view, style, paint, sliced=sliced)
            wanted = whole.gather(view, style, paint, sliced=sliced)
            assert wanted.read()[..., 3].max() > 3
            np.testing.assert_array_equal(found.read(), wanted.read())
            assert parts.most_lines() == whole.most_lines()
    fetched = parts.explain()["parts"]["fetched"]
    assert parts.gather(view, FibletStyle(line_width=3.0), paint, sliced=sliced) is found
    assert parts.explain()["parts"]["fetched"] <= fetched + 1
    kept = Filter(np.arange(brain.n_streamlines) % 3 == 0, None)
    whole.filtering = parts.filtering = kept
    found, wanted = (one.gather(view, sliced=sliced) for one in (parts, whole))
    np.testing.assert_array_equal(found.read(), wanted.read())
    parts.drop_gathered()
    assert parts.most_lines() == 0.0


def test_sums_of_hurried_pictures_fetch_no_part(made, camera):
    whole, parts = made()
    parts.hurried = True
    view = View(SIZE, camera(SIZE, **WHOLE_BRAIN))
    found = parts.gather(view).read()
    assert parts.explain()["parts"]["fetched"] == 1  # the even share
    assert 0.05 < found.sum() / whole.gather(view).read().sum() < 0.95
    parts.hurried = False
    np.testing.assert_array_equal(parts.gather(view).read(), whole.gather(view).read())


def test_what_fits_is_drawn_by_a_renderer_of_all_and_no_memory_is_said(gl, brain):
    renderer = streamed_renderer(gl, brain)
    assert isinstance(renderer, FibletRenderer)
    renderer.release()
    with pytest.raises(GPUMemoryError, match=r"0\.0 MB of GPU memory beside a picture are too .* 0\.1 are needed"):
        streamed_renderer(gl, brain, max_total_bytes=100)


def test_parts_hold_each_streamline_once_and_their_bounds_all_points(brain):
    parts = Stretches(brain, 1000, 90)
    found = []
    for number in range(len(parts)):
        part = parts.part(number)
        found.append(part.rank_to_id)
        box, points = reach_of(part), part.decompress(part.rank_to_id).points
        assert (points >= box[0]).all()
        assert (points <= box[1]).all()
        assert (box[1] - box[0] < np.ptp(points, axis=0) + 8.0 * brain.largest_radius).all()
    assert len(found) == 12
    counts = np.diff(brain.offsets())
    np.testing.assert_array_equal(np.sort(np.concatenate(found)), np.flatnonzero(counts))


def test_a_box_in_view_is_never_left_out(camera):
    rng = np.random.default_rng(3)
    style = FibletStyle(line_width=5.0)
    left_out = 0
    for _ in range(200):
        eye, target = rng.normal(0, 50, 3), rng.normal(0, 20, 3)
        view = View(SIZE, camera(SIZE, eye=eye, target=target, near=1.0, far=150.0))
        low = rng.normal(0, 80, 3)
        box = np.array([low, low + rng.uniform(0, 30, 3)])
        inside = rng.uniform(box[0], box[1], (500, 3))
        x, y, z, w = view.model_view_projection @ np.column_stack([inside, np.ones(500)]).T
        shows = (w > 0) & (np.abs(x) < w) & (np.abs(y) < w) & (np.abs(z) < w)
        if in_view(view, style, box):
            continue
        left_out += 1
        assert not shows.any()
    assert left_out > 20


def test_memory_that_runs_out_meanwhile_makes_room(gl, made, camera, monkeypatch):
    whole, parts = made()
    view = View(SIZE, camera(SIZE, **WHOLE_BRAIN))
    parts._room *= 100  # as if nobody knew
    honest, held = streamed.FibletRenderer, []

    def refusing(*given, **named):
        if sum(not one.released for one in held) >= 2:
            raise GPUMemoryError("no memory")
        held.append(honest(*given, **named))
        return held[-1]

    monkeypatch.setattr(streamed, "FibletRenderer", refusing)
    assert_alike(read(parts.render(view)), read(whole.render(view)))
    assert parts.explain()["parts"]["there"] == 2
