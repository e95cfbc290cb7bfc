"""What draws, how much of it, and what is done where memory does not suffice, from PyVista's side."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv

from pvfiblets import compress
from pvfiblets.codec.restrict import even_share
from pvfiblets.engine.errors import EngineError
from pvfiblets.engine.fiblets import memory_fit
from pvfiblets.synthetic import brain_streamlines


def shot(plotter):
    plotter.show(auto_close=False) if plotter._first_time else plotter.render()
    return plotter.screenshot(None)


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


def test_counting_leaves_the_picture_as_it_was(plotter, three_lines):
    plotter.add_mesh(pv.Sphere(radius=6.0), color="white")
    actor = plotter.add_fiblets(three_lines, line_width=3.0)
    before = shot(plotter)
    actor.explain()
    np.testing.assert_array_equal(shot(plotter), before)


def test_what_does_not_fit_is_refused_or_sampled(plotter, monkeypatch):
    fiblets = compress(brain_streamlines(3000, step=1.0))
    monkeypatch.setattr(memory_fit, "free_memory", lambda ctx, gl: memory_fit.PICTURE_BYTES + 400_000)
    actor = plotter.add_fiblets(fiblets)
    with pytest.raises(EngineError, match=r"MB are available.*; draw fewer streamlines, or .* by fit='sample'"):
        plotter.show(auto_close=False)
    actor.fit = "sample"
    monkeypatch.setattr(memory_fit, "RESERVE", 0.0)
    assert (shot(plotter) > 0).any()
    assert 0.0 < actor.share < 0.9
    assert actor.explain()["share"] == actor.share
    assert f"{actor.share:.1%} of the streamlines drawn" in repr(actor)
    drawn = even_share(fiblets, actor.share)
    assert len(drawn) == round(3000 * actor.share)
    found = {hit[0] for x in range(0, 200, 8) for y in range(0, 200, 8) if (hit := actor.pick_at(x, y))}
    assert found
    assert found <= set(drawn.tolist()), "numbers are those of the whole set"
