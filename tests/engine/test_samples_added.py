"""Samples of lines that are added to those of other lines, beside both drawn alone."""

import numpy as np
import pytest

from pvfiblets import compress
from pvfiblets.engine import FibletRenderer, FibletStyle, View
from pvfiblets.engine.fiblets.data import chunks
from pvfiblets.engine.fiblets.data.filter_textures import Filter
from pvfiblets.engine.gbuffer import EMPTY, GBuffer
from pvfiblets.report.studies.stability.render_checks import camera
from pvfiblets.synthetic import brain_streamlines

SIZE = (320, 240)


@pytest.mark.parametrize("clustered", [1 << 21, 1])
@pytest.mark.parametrize("culling", [None, "two-phase"])
def test_each_sample_is_the_nearer_line_and_of_two_at_one_depth_the_later(gl, culling, clustered, monkeypatch):
    monkeypatch.setattr(chunks, "CLUSTERED", clustered)
    lines = brain_streamlines(150, step=1.0, seed=3)
    eye = (0.0, -280.0, 60.0)
    matrix = camera(SIZE, eye=np.array(eye), target=(0, -18, 8), near=100.0, far=500.0)
    view, style = View(SIZE, matrix), FibletStyle(4.0, values="arc_length")
    fiblets = compress(lines)
    renderers = [FibletRenderer(gl, fiblets, pipeline="compute", culling=culling) for _ in range(2)]
    for renderer, first in zip(renderers, (0, 50), strict=True):  # 50 streamlines are drawn by both
        renderer.filtering = Filter((np.arange(150) >= first) & (np.arange(150) < first + 100))

    def drawn(order):
        target = GBuffer(gl, SIZE)
        for adds, number in enumerate(order):
            (one,) = renderers[number].sampled(view, style, (0, 0, *SIZE))
            assert list(one.draw(view, style, target, bool(adds))) == []
        textures = (target.depth, target.owner, target.ids, target.position)
        found = [np.frombuffer(t.read(), "<u4").reshape(SIZE[0] * SIZE[1], -1) for t in textures]
        target.release()
        return found

    for first, second in ((0, 1), (1, 0)):
        (there, _, *kept), (depth, owner, *taken) = drawn([first]), drawn([second])
        both = drawn([first, second])
        np.testing.assert_array_equal(both[0], np.minimum(there, depth))
        shows = (depth <= there) & (depth != EMPTY)
        assert (depth == there)[shows].sum() > 500
        assert (shows & (depth < there)).sum() > 500
        np.testing.assert_array_equal(both[1], np.where(shows, owner, EMPTY))
        lit = both[0][:, 0] != EMPTY
        for after, now, before in zip(both[2:], taken, kept, strict=True):
            np.testing.assert_array_equal(after[lit], np.where(shows, now, before)[lit])
    for renderer in renderers:
        renderer.release()
