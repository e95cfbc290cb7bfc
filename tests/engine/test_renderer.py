"""`FibletRenderer`: pictures that repeat and do not depend on paging, when it redraws, what it says and refuses."""

import numpy as np
import pytest

from pvfiblets.engine import EngineError, FibletRenderer, FibletStyle, View, gbuffer
from pvfiblets.engine.gl import passes

from .pictures import SIZE, assert_same, draw, read

PASSES = ["clear", "cull", "visible", "pyramid", "occlusion", "refine", "depth", "resolve_owner", "resolve_ties"]
LATER_PASSES = ["last picture", *PASSES[:3], "predicted", *PASSES[3:]]


@pytest.mark.few(1)
@pytest.mark.parametrize("tolerance", [0.0, 0.5])
def test_ties_go_to_the_first_and_pictures_repeat(gl, fabricate, random_lines, camera, tolerance):
    """Every line four times over: ties in every pixel, and still the same bytes every time."""
    fiblets = fabricate(random_lines(60, seed=11) * 4, kind=2)
    view, style = View(SIZE, camera(SIZE)), FibletStyle(tolerance=tolerance)
    first = draw(gl, fiblets, view, style)
    assert first.drawn.sum() > 1000
    assert (first.ids[first.drawn][:, 0] < 60).all()
    for _ in range(5):
        assert_same(draw(gl, fiblets, view, style), first)


@pytest.mark.more
def test_paging_changes_nothing(gl, fabricate, random_lines, camera):
    """40,000 short fiblets in three pages: one chunk, three chunks, and dispatches folded into rows."""
    fiblets = fabricate(random_lines(700, seed=12, longest=230), kind=2, per_fiblet=2)
    assert fiblets.n_fiblets > 2 * 16384
    view = View(SIZE, camera(SIZE))
    limits = {"max_buffer_bytes": 12 * (16384 + 1)}
    for style in (FibletStyle(), FibletStyle(2.5, values="arc_length"), FibletStyle(tolerance=0.0)):
        whole = draw(gl, fiblets, view, style)
        drawn = whole.drawn
        renderer = FibletRenderer(gl, fiblets, max_groups=9, **limits)
        assert len(renderer._chunks) == 3
        renderer.release()
        pieces = draw(gl, fiblets, view, style, max_groups=16, **limits)
        assert (pieces.depth == whole.depth).all()
        assert (pieces.owner == whole.owner).all()
        assert (pieces.ids[drawn] == whole.ids[drawn]).all()
        assert np.abs(pieces.position[drawn] - whole.position[drawn]).max() < 1e-3


def test_redraws_only_when_something_changed(gl, fabricate, random_lines, camera):
    fiblets = fabricate(random_lines(20), kind=2)
    renderer = FibletRenderer(gl, fiblets)
    view = View(SIZE, camera(SIZE))
    first = renderer.render(view, FibletStyle())
    assert first.generation == 1
    assert renderer.render(View(SIZE, camera(SIZE)), FibletStyle()) is first
    assert first.generation == 1
    assert renderer.render(view, FibletStyle(line_width=2.0)).generation == 2
    assert renderer.render(View(SIZE, camera(SIZE, near=25.0)), FibletStyle(line_width=2.0)).generation == 3
    assert renderer.render(view, FibletStyle(line_width=2.0, tolerance=0.0)).generation == 4
    resized = renderer.render(View((100, 50), camera((100, 50))))
    assert resized.generation == 5
    assert resized.depth.size == (100, 50)
    renderer.release()


def test_explain_lists_only_what_is_used(gl, fabricate, random_lines, camera, monkeypatch):
    # Which classes of fiblets there are is not waited for, as on a card: software leaves out what has none.
    monkeypatch.setattr("pvfiblets.engine.fiblets.pipelines.compute.READ_LISTS", False)
    renderer = FibletRenderer(gl, fabricate(random_lines(20), kind=2))
    renderer.render(View(SIZE, camera(SIZE)))
    plain = renderer.explain()
    # some lines leave the screen
    first = ["CLIPPING", "CLIPPING_DEPTH", "LATTICE"]
    assert plain["features"] == first
    assert [p["name"] for p in plain["passes"]] == PASSES
    assert all(p["ms"] >= 0 for p in plain["passes"])
    renderer.render(View(SIZE, camera(SIZE, near=10.0)))  # the first picture could not look at one before it
    plain = renderer.explain()
    assert plain["features"] == sorted([*first, "CULL_PYRAMID"])
    assert [p["name"] for p in plain["passes"]] == LATER_PASSES
    names = {b["name"] for b in plain["buffers"]}
    assert not names & {"values", "starts", "anchors_low", "rank_to_id"}
    assert {"anchors", "bounds", "decoding", "codes", "pages", "rotations", "visibility_bits", "occlusion"} <= names
    renderer.render(View(SIZE, camera(SIZE)), FibletStyle(2.0, values="curvature", tolerance=0.0))
    rich = renderer.explain()
    assert set(rich["features"]) == {
        "LATTICE", "WIDE_LINES", "CLIPPING", "CLIPPING_DEPTH", "VALUES_CURVATURE", "CULL_PYRAMID",
    }  # fmt: skip
    assert "starts" in {b["name"] for b in rich["buffers"]}
    renderer.render(View(SIZE, camera(SIZE)))
    assert renderer.explain()["features"] == plain["features"]
    assert renderer.explain()["buffers"] == plain["buffers"]
    renderer.release()


def test_without_culling_nothing_of_it_is_there(gl, fabricate, random_lines, camera):
    renderer = FibletRenderer(gl, fabricate(random_lines(20), kind=2), culling=None)
    renderer.render(View(SIZE, camera(SIZE)))
    said = renderer.explain()
    renderer.release()
    assert not [name for name in said["features"] if name.startswith("CULL")]
    assert [p["name"] for p in said["passes"]] == [
        name for name in PASSES if name not in ("pyramid", "occlusion", "refine")
    ]
    assert "occlusion" not in {b["name"] for b in said["buffers"]}


def test_timer_queries_are_read_where_opengl_is_hardware(gl, fabricate, random_lines, camera, monkeypatch):
    monkeypatch.setattr(passes, "is_software", lambda ctx: False)
    renderer = FibletRenderer(gl, fabricate(random_lines(20), kind=2))
    for near_plane, expected in ((10.0, PASSES), (20.0, LATER_PASSES)):
        renderer.render(View(SIZE, camera(SIZE, near=near_plane)))
        times = renderer.explain()["passes"]
        assert [p["name"] for p in times] == expected
        assert all(p["ms"] >= 0 for p in times)  # of compute work llvmpipe answers with its clock
    renderer.release()


def test_streamlines_without_points_keep_their_numbers(gl, fabricate, random_lines, camera):
    lines = random_lines(30, seed=15)
    ids = np.arange(30) * 2 + 5
    plain, numbered = fabricate(lines, kind=2), fabricate(lines, kind=2, rank_to_id=ids)
    view = View(SIZE, camera(SIZE))
    a, b = draw(gl, plain, view), draw(gl, numbered, view)
    assert (a.depth == b.depth).all()
    assert (b.ids[a.drawn][:, 0] == ids[a.ids[a.drawn][:, 0]]).all()


@pytest.mark.more
def test_all_optional_buffers_at_once(gl, fabricate, random_lines, camera):
    """Fine anchors, numbered streamlines and a per-point value, in several chunks."""
    lines = random_lines(700, seed=12, longest=230)
    ids = np.arange(700) * 3 + 1
    plain = fabricate(lines, kind=2, per_fiblet=2)
    rich = fabricate(lines, kind=2, per_fiblet=2, low=True, rank_to_id=ids)
    view, style = View(SIZE, camera(SIZE)), FibletStyle(1.0, values="arc_length")
    a = draw(gl, plain, view, style)
    b = draw(gl, rich, view, style, max_buffer_bytes=12 * (16384 + 1))
    same = a.drawn & b.drawn
    assert same.sum() > 0.95 * a.drawn.sum()
    agree = (b.ids[..., 0] == ids[np.where(same, a.ids[..., 0], 0)])[same]  # anchors differ by their rounding
    assert agree.mean() > 0.9
    assert (np.unique(b.ids[same][:, 0]) % 3 == 1).all()


def test_limits_are_told(gl, fabricate, random_lines, camera):
    fiblets = fabricate(random_lines(20), kind=2)
    with pytest.raises(EngineError, match="buffers are limited to 100"):
        FibletRenderer(gl, fiblets, max_buffer_bytes=100)
    with pytest.raises(EngineError, match="MB are available"):
        FibletRenderer(gl, fiblets, max_total_bytes=100)
    with pytest.raises(EngineError, match="culling is 'twice'; choose 'two-phase'"):
        FibletRenderer(gl, fiblets, culling="twice")
    renderer = FibletRenderer(gl, fiblets)
    with pytest.raises(EngineError, match="largest texture"):
        renderer.render(View((10**6, 10), camera(SIZE)))
    with pytest.raises(EngineError, match="no per-point array 'fa'"):
        renderer.render(View(SIZE, camera(SIZE)), FibletStyle(values="fa"))
    renderer.render(View(SIZE, camera(SIZE)))  # and works after all of these
    renderer.release()


def test_a_picture_after_relief_had_no_memory(gl, fabricate, random_lines, camera, monkeypatch):
    fiblets = fabricate(random_lines(20, seed=11), kind=2)
    view, plain, relief = View(SIZE, camera(SIZE)), FibletStyle(5.0), FibletStyle(5.0, across=True)
    renderer = FibletRenderer(gl, fiblets)
    try:
        before = read(renderer.render(view, plain))
        monkeypatch.setitem(gbuffer.RELIEF, "across", "no such type")
        with pytest.raises(EngineError, match="no memory for a picture"):
            renderer.render(view, relief)
        assert_same(read(renderer.render(view, plain)), before)
    finally:
        renderer.release()
