"""The study of work counts what a frame does, beside the same read from its frame and its bits."""

import math

import numpy as np
import pytest

from pvfiblets import compress
from pvfiblets.engine import FibletRenderer, FibletStyle, View
from pvfiblets.engine.fiblets.data import chunks
from pvfiblets.engine.fiblets.pipelines import compute
from pvfiblets.report.studies.culling.pictures import views
from pvfiblets.report.studies.work import study as work
from pvfiblets.report.studies.work.counts import counted, frame_lanes, pass_work
from pvfiblets.synthetic import brain_streamlines
from tests.engine.visibility_bits import planned

from .little import little

SIZE = (160, 120)


@pytest.fixture(scope="module")
def brain():
    return compress(brain_streamlines(2000, step=0.25))


@pytest.mark.parametrize("clustered", [False, True])
def test_counts_are_those_of_the_bits(gl, brain, monkeypatch, clustered):
    monkeypatch.setattr(chunks, "CLUSTERED", 0 if clustered else 1 << 30)
    renderer = FibletRenderer(gl, brain, culling="two-phase")
    path = views(brain.bounds, "far", 1.14, 3, SIZE)
    for view in path[:-1]:
        renderer.render(view)
    with counted() as calls:
        renderer.render(path[-1])
    found = pass_work(renderer, SIZE[0] * SIZE[1], 100)
    assert found["visible"].fiblets == planned(renderer, unseen=False).sum() > 0
    assert found["predicted"].fiblets + found["depth"].fiblets == planned(renderer, seen=False).sum() > 0
    assert found["refine"].fiblets >= found["depth"].fiblets
    if clustered:
        assert found["cull"].fiblets == found["visible"].fiblets
        assert found["predicted"].fiblets <= found["predicted: tests"].fiblets <= brain.n_fiblets + 63
        assert found["occlusion"].fiblets % 64 == 0
    else:
        assert found["cull"].fiblets == brain.n_fiblets
    # clear, seeing and choosing; lists and drawings of five rounds; what is tested, in two passes
    assert calls.dispatches.total() <= 30
    assert calls.dispatches["cull"] == 1
    assert calls.barriers.total() < 20
    renderer.release()


def test_lanes_are_all_in_use_in_lists_and_most_in_long_rounds(gl, brain, monkeypatch):
    view = views(brain.bounds, "far", 1.14, 1, SIZE)[0]
    for share in (1, 8, 10_000):
        monkeypatch.setattr(compute, "LIST_SHARE", share)
        monkeypatch.setitem(compute_constants(), "list_share", share)
        renderer = FibletRenderer(gl, brain, culling=None)
        renderer.render(View(SIZE, view.model_view_projection), FibletStyle())
        lanes = [frame_lanes(renderer, compute.REST, width) for width in (8, 32, 64)]
        assert lanes == sorted(lanes, reverse=True)
        assert lanes[2] > (0.99 if share == 1 else 0.9)
        assert math.isnan(frame_lanes(renderer, compute.PREDICTED, 8))
        renderer.release()


def compute_constants():
    """Constants of shaders, which the fixtures of a test put back."""
    from pvfiblets.engine.fiblets.pipelines import CONSTANTS

    return CONSTANTS


@pytest.mark.more
def test_every_scene_is_counted(gl, monkeypatch):
    monkeypatch.setattr(work, "QUICK_SEGMENTS", (5e4,))
    monkeypatch.setattr(work, "QUICK_SIZE", SIZE)
    monkeypatch.setattr(work, "STEP", 0.5)
    left = []
    records = list(work.STUDY.run(little(left_out=left)))
    assert not left
    frames = {record.data: record.costs for record in records if record.method == "frame"}
    assert list(frames) == [f"0.05 M segments, {scene}" for scene in work.SCENES]
    for costs in frames.values():
        assert 0 < costs["visible"].value <= costs["drawn"].value <= costs["fiblets"].value
        assert costs["here"].value > 0
        assert np.isfinite([figure.value for figure in costs.values()]).all()
    assert frames["0.05 M segments, first"]["tested"].value >= frames["0.05 M segments, first"]["fiblets"].value
