"""Few fiblets are drawn by one program: the picture is the same, and fewer programs are compiled."""

import numpy as np
import pytest

from pvfiblets import regions
from pvfiblets.engine import FibletRenderer, FibletStyle, View
from pvfiblets.engine.fiblets.data.filter_textures import Filter
from pvfiblets.engine.fiblets.pipelines import compute

from .pictures import SIZE, assert_same, read, unpacked_tangent

PLANES = {"clip_planes": [(1.0, 0.0, 0.0, 5.0)]}
REGION = {"region": regions.Box((-30.0, 30.0, -30.0, 30.0, -30.0, 30.0))}
CASES = {
    "thin": ({}, {}, FibletStyle()),
    "from inside": ({"eye": (3, -2, 1), "target": (30, 10, 0), "near": 0.05, "far": 200.0, "angle": 80.0}, {},
                    FibletStyle()),
    "wide, from inside": ({"eye": (3, -2, 1), "target": (30, 10, 0), "near": 0.05, "far": 200.0, "angle": 80.0}, {},
                          FibletStyle(7.0)),
    "all in view": ({"height": 400.0}, {}, FibletStyle(values="arc_length")),
    "simplified": ({"height": 400.0}, {}, FibletStyle(tolerance=2.0)),
    "planes": ({}, PLANES, FibletStyle(3.0, tolerance=0.5)),
    "region": ({}, REGION, FibletStyle()),
}  # fmt: skip


ROUNDING = 2.0**-22
"""Of depths: a segment that needed no clipping has a bit of difference if it was looked whether it does."""


def assert_alike(one, other):
    """The same pixels and streamlines; depths, tangents and places but for the rounding of clipping."""
    np.testing.assert_array_equal(one.drawn, other.drawn)
    drawn = one.drawn
    assert np.abs(one.window_depth - other.window_depth).max() <= ROUNDING
    assert (one.owner != other.owner)[drawn].mean() <= 1e-3, "lines at one depth"
    same = drawn & (one.owner == other.owner)
    np.testing.assert_array_equal(one.ids[same][:, 0], other.ids[same][:, 0])
    tangents = (unpacked_tangent(picture.ids[same][:, 1]) for picture in (one, other))
    assert np.abs(np.subtract(*tangents)).max() <= 0.01
    assert np.abs(one.position - other.position)[same].max() <= 0.05


@pytest.mark.few(2)
@pytest.mark.parametrize("culling", ["two-phase", "coverage", None])
@pytest.mark.parametrize("name", CASES)
def test_the_picture_is_the_same(gl, fabricate, random_lines, camera, monkeypatch, name, culling):
    fiblets = fabricate(random_lines(60, seed=8), kind=2)
    of_camera, of_view, style = CASES[name]
    mask = np.ones(fiblets.n_streamlines, bool)
    mask[::5] = False
    found = {}
    for few in (0, 10**6):
        monkeypatch.setattr(compute, "FEW", few)
        renderer = FibletRenderer(gl, fiblets, pipeline="compute", culling=culling)
        pictures = []
        for turn in range(3):
            eye = np.array(of_camera.get("eye", (0.0, -260.0, 60.0))) + (4.0 * turn, 0.0, 0.0)
            view = View(SIZE, camera(SIZE, **{**of_camera, "eye": tuple(eye)}), **of_view)
            if turn == 2:
                renderer.filtering = Filter(streamlines=mask)
            pictures.append(read(renderer.render(view, style)))
        found[few] = pictures, renderer.explain()
        renderer.release()
    (classes, told), (together, told_together) = found.values()
    assert classes[0].drawn.sum() > 100
    for one, other in zip(classes, together, strict=True):
        assert_alike(one, other)
    assert ("ONE_CLASS" in told["features"], "ONE_CLASS" in told_together["features"]) == (False, True)
    assert told["fiblets"] == told_together["fiblets"]


def test_sums_are_the_same(gl, fabricate, random_lines, camera, monkeypatch):
    fiblets = fabricate(random_lines(60, seed=8), kind=2)
    view = View(SIZE, camera(SIZE, eye=(0, -90, 20)))
    sums = []
    for few in (0, 10**6):
        monkeypatch.setattr(compute, "FEW", few)
        renderer = FibletRenderer(gl, fiblets, pipeline="compute")
        sums.append(np.array(renderer.gather(view, FibletStyle(3.0)).read()))
        renderer.release()
    assert sums[0].sum() > 0
    np.testing.assert_array_equal(*sums)


def test_fewer_programs_are_compiled(gl, fabricate, random_lines, camera, monkeypatch):
    fiblets = fabricate(random_lines(60, seed=8), kind=2)
    monkeypatch.setattr(compute, "READ_LISTS", False)
    compiled = {}
    for few in (0, 10**6):
        monkeypatch.setattr(compute, "FEW", few)
        renderer = FibletRenderer(gl, fiblets, pipeline="compute", culling=None)
        renderer.render(View(SIZE, camera(SIZE)), FibletStyle())
        compiled[few] = len(renderer._programs._programs)
        renderer.release()
    assert compiled == {0: 3 + 3 * 3, 10**6: 3 + 3}


def test_software_compiles_what_draws_something(gl, fabricate, random_lines, camera, monkeypatch):
    """A program takes 0.3 s: that of a class is made when a picture first has fiblets of it."""
    lists = False, True
    lines = fabricate(random_lines(60, seed=8, longest=40), kind=2)
    renderers = [FibletRenderer(gl, lines, culling=None) for _ in lists]
    counts = []
    for case in ("thin", "from inside"):  # beyond the picture's sides; before the near plane, too
        pictures = []
        for one, reads in zip(renderers, lists, strict=True):
            monkeypatch.setattr(compute, "READ_LISTS", reads)
            pictures.append(read(one.render(View(SIZE, camera(SIZE, **CASES[case][0])), FibletStyle())))
        assert pictures[0].drawn.sum() > 500
        assert_same(*pictures)
        counts.append([len(one._programs._programs) for one in renderers])
    for one in renderers:
        one.release()
    (every, some), later = counts
    assert every == 3 + 3 * 3
    assert some < later[1] <= later[0] == every
