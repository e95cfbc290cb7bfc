"""What draws, how much of it, and what is done where memory does not suffice, from PyVista's side."""

from __future__ import annotations

import numpy as np
import pytest

from pvfiblets import compress
from pvfiblets.codec.editing.restrict import even_share
from pvfiblets.engine.errors import EngineError
from pvfiblets.engine.fiblets.data import memory_fit
from pvfiblets.engine.fiblets.parts.streamed_renderer import StreamedRenderer
from pvfiblets.synthetic import brain_streamlines

from .refined_scene import Renders
from .views import shot


def test_what_draws_and_how_much_is_known_after_the_first_picture(plotter, three_lines):
    actor = plotter.add_fiblets(three_lines)
    assert actor.share is None
    assert actor.explain()["fiblets"]["visible"] is None
    shot(plotter)
    assert actor.pipeline_in_use == plotter.fiblets.pipelines().auto
    assert actor.share == actor.explain()["share"] == 1.0
    assert "of the streamlines drawn" not in repr(actor)
    n = actor.fiblets.n_fiblets
    counts = actor.explain()["fiblets"]
    assert counts["total"] == counts["in_frustum"] == counts["visible"] == n
    assert counts["drawn"] in (n, None)


def test_what_does_not_fit_is_refused_or_sampled(plotter, monkeypatch):
    fiblets = compress(brain_streamlines(3000, step=1.0))
    monkeypatch.setattr(memory_fit, "free_memory", lambda ctx, gl: memory_fit.PICTURE_BYTES + 400_000)
    actor = plotter.add_fiblets(fiblets)
    with pytest.raises(EngineError, match=r"MB are available.*; draw fewer .* by fit='sample', .* by fit='stream'"):
        plotter.show(auto_close=False)
    actor.fit = "sample"
    monkeypatch.setattr(memory_fit, "RESERVE", 0.0)
    assert (shot(plotter) > 0).any()
    assert 0.0 < actor.share < 0.9
    assert actor.explain()["share"] == actor.share
    assert f"{actor.share:.1%} of the streamlines drawn" in repr(actor)
    one = 1.0 / 3000.0  # a share of the streamlines is as even as whole ones can be
    drawn = even_share(fiblets, actor.share + one)
    assert abs(len(drawn) * one - actor.share) < 2.5 * one
    found = {hit[0] for x in range(0, 200, 8) for y in range(0, 200, 8) if (hit := actor.pick_at(x, y))}
    assert found
    assert found <= set(drawn.tolist()), "numbers are those of the whole set"


@pytest.fixture
def little_memory(monkeypatch):
    """Graphics memory for a quarter of the set, which streaming may use all of."""
    monkeypatch.setattr(memory_fit, "free_memory", lambda ctx, gl: memory_fit.PICTURE_BYTES + 160_000)
    monkeypatch.setattr(memory_fit, "is_software", lambda ctx: False)
    monkeypatch.setattr(memory_fit, "RESERVE", 0.0)


@pytest.fixture(scope="module")
def too_large():
    return compress(brain_streamlines(3000, step=1.0))


def test_what_does_not_fit_is_drawn_part_by_part_as_if_it_did(plotter, too_large, little_memory, monkeypatch):
    plotter.picture.antialias = "refined"
    actor = plotter.add_fiblets(too_large, fit="stream")
    picture = shot(plotter)
    told = actor.explain()
    assert told["parts"]["total"] > told["parts"]["there"] > 0
    assert actor.share == 1.0
    places = [(x, y) for x in range(0, 200, 8) for y in range(0, 200, 8)]
    hits = [actor.pick_at(*at) for at in places]
    plotter.remove_actor(actor)
    monkeypatch.undo()
    actor = plotter.add_fiblets(too_large, reset_camera=False)
    plotter.picture.antialias = "coverage"  # a set in parts is not drawn 16 times over
    np.testing.assert_array_equal(picture, shot(plotter))
    assert hits == [actor.pick_at(*at) for at in places]


def test_a_set_whose_parts_are_all_there_is_refined_as_any_other(plotter, too_large, little_memory, monkeypatch):
    plotter.picture.antialias = "refined"
    monkeypatch.setattr(memory_fit, "free_memory", lambda ctx, gl: memory_fit.PICTURE_BYTES + 2_000_000)
    monkeypatch.setattr(memory_fit.MemoryBudget, "fits", lambda *_: False)
    actor = plotter.add_fiblets(too_large, fit="stream")
    plotter.show(auto_close=False)
    renders = Renders(plotter)
    picture = shot(plotter)
    assert renders.since() <= 2, "samples of all parts are drawn at once"
    parts = actor.explain()["parts"]
    assert parts["there"] == parts["fetched"] == parts["total"] > 1
    assert plotter.picture.samples == 16
    # Whoever asks for one more frame at a time has the same.
    interactor = plotter.iren.interactor
    plotter.picture.pace_by_hand()
    plotter.camera.azimuth += 5.0
    plotter.render_window.SetDesiredUpdateRate(interactor.GetDesiredUpdateRate())
    plotter.render()
    plotter.camera.azimuth -= 5.0
    plotter.render_window.SetDesiredUpdateRate(interactor.GetStillUpdateRate())
    plotter.render()
    while plotter.picture.refine():
        assert not plotter.picture.fetching
    assert plotter.picture.samples == 16
    np.testing.assert_array_equal(plotter.screenshot(None, return_img=True), picture)
    monkeypatch.undo()
    plotter.remove_actor(actor)
    plotter.picture.antialias = "refined"
    plotter.add_fiblets(too_large, reset_camera=False)
    # Samples of parts are put together by OpenGL's depth test, which takes nearly equal depths as equal.
    apart = np.abs(picture.astype(int) - shot(plotter))
    assert (apart > 0).mean() < 1e-3
    assert apart.max() <= 16  # one sample


def test_samples_end_where_parts_must_be_fetched_for_them(plotter, too_large, little_memory, monkeypatch):
    """Such as for another view of the same window, which takes the memory."""
    plotter.picture.antialias = "refined"
    monkeypatch.setattr(StreamedRenderer, "resident", property(lambda one: not one.unfinished and next(answers)))
    answers = iter([*[True] * 5, *[False] * 10_000])
    actor = plotter.add_fiblets(too_large, fit="stream")
    shot(plotter)
    assert actor.share == 1.0
    assert next(answers) is False
    assert plotter.picture.samples < 16


def test_a_moving_camera_fetches_nothing_and_a_resting_one_the_rest(plotter, too_large, little_memory):
    plotter.picture.antialias = "refined"
    actor = plotter.add_fiblets(too_large, fit="stream")
    whole = shot(plotter)
    interactor = plotter.iren.interactor
    fetched = lambda: actor.explain()["parts"]["fetched"]  # noqa: E731
    plotter.render_window.SetDesiredUpdateRate(interactor.GetDesiredUpdateRate())
    before = fetched()
    for _ in range(3):
        plotter.camera.azimuth += 5.0
        plotter.render()
        assert fetched() == before + 1  # the even share
    assert actor.share < 1.0
    plotter.camera.azimuth -= 15.0
    plotter.render_window.SetDesiredUpdateRate(interactor.GetStillUpdateRate())
    # Somebody asks for more frames: each fetches a part.
    plotter.picture.pace_by_hand()
    actor._mapper._renderers()[0]._clock = iter(range(10_000)).__next__
    plotter.render()
    assert plotter.picture.fetching
    frames = 1
    while plotter.picture.refine():
        frames += 1
    assert frames > 3
    assert not plotter.picture.fetching
    assert actor.share == 1.0
    np.testing.assert_array_equal(plotter.screenshot(None, return_img=True), whole)


def test_what_parts_cannot_show_is_said_in_one_sentence(plotter, too_large, little_memory):
    plotter.add_fiblets(too_large, fit="stream", opacity=0.3, transparency="layers")
    with pytest.raises(EngineError, match="drawn part by part has no layers of lines"):
        plotter.show(auto_close=False)


@pytest.mark.few(1)
@pytest.mark.parametrize("look", [{"opacity": 0.2}, {"style": "density"}, {"opacity": "linear", "scalars": "length"}])
def test_what_all_lines_add_up_to_is_that_of_the_whole_set(plotter, too_large, monkeypatch, request, look):
    plotter.picture.antialias = "coverage"
    actor = plotter.add_fiblets(too_large, **look)
    whole = shot(plotter)
    plotter.remove_actor(actor)
    request.getfixturevalue("little_memory")
    actor = plotter.add_fiblets(too_large, fit="stream", reset_camera=False, **look)
    np.testing.assert_array_equal(shot(plotter), whole)
    assert actor.explain()["parts"]["total"] > 3
