"""Frustum culling leaves out what cannot show, and nothing else."""

import numpy as np
import pytest

from pvfiblets.engine import FibletRenderer, FibletStyle, View
from pvfiblets.engine.gl import shaders

from .pictures import SIZE, assert_same, read
from .visibility_bits import planned

TEST = "outside = outside || max(a, b) < -c.r;"


@pytest.mark.more
@pytest.mark.parametrize("tolerance", [0.0, 0.5])
def test_culling_never_shows(gl, fabricate, random_lines, camera, monkeypatch, tolerance):
    """A picture drawn by a cull pass that lets everything through is the same, byte for byte."""
    fiblets = fabricate(random_lines(300, seed=13), kind=2, per_fiblet=10)
    rng = np.random.default_rng(14)
    cases = []
    for i in range(12):
        eye = rng.uniform(-60, 60, 3)
        height = 40.0 if i % 3 == 0 else None
        matrix = camera(SIZE, eye=eye, target=eye + rng.normal(0, 1, 3), near=0.5, far=60.0, height=height)
        cases.append((View(SIZE, matrix), FibletStyle(1.0 if i % 2 else 9.0, tolerance=tolerance)))

    def pictures():
        renderer = FibletRenderer(gl, fiblets, culling=None)
        for view, style in cases:
            picture = read(renderer.render(view, style))
            yield picture, planned(renderer).sum() / fiblets.n_fiblets
        renderer.release()

    culled = list(pictures())
    honest = shaders.read_shader
    assert TEST in honest("culling/frustum.glsl")
    monkeypatch.setattr(shaders, "read_shader", lambda name: honest(name).replace(TEST, ""))
    for (a, share), (b, everything) in zip(culled, pictures(), strict=True):
        assert everything == 1.0
        assert share < 1.0
        assert_same(a, b)
    assert np.mean([share for _, share in culled]) < 0.5, "culling should spare work too"
