"""All features on together: every pipeline gives the same picture, and switching them off leaves nothing behind."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv

from pvfiblets import compress, regions
from pvfiblets.synthetic import brain_streamlines

pytestmark = pytest.mark.more

SIZE = (160, 120)


@pytest.fixture(scope="module")
def fiblets():
    streamlines = brain_streamlines(250, seed=2)
    streamlines.per_point = {"fa": np.random.default_rng(0).random(streamlines.n_points).astype(np.float32)}
    return compress(streamlines, per_point=("fa",))


def switch_on(actor):
    """Yield what was switched on, one feature after the other."""
    actor.clip(pv.ParametricTorus(ringradius=45, crosssectionradius=25).translate((0, 0, 15)))
    yield "clip"
    actor.criterion("fa", (0.02, 1.0))
    actor.criterion("length", (20.0, 200.0))
    yield "criteria"
    actor.exclude(regions.Sphere((0.0, 0.0, 20.0), 12.0))
    yield "exclude"
    actor.select(np.arange(0, 250, 5))
    actor.selection_style(as_tubes=True, radius=0.8, silhouette=True)
    yield "selection"
    actor.ambient_occlusion = actor.depth_cue = actor.halos = True
    yield "effects"
    actor.opacity, actor.transparency = 0.5, 3
    yield "layers"
    affine = np.diag([9.0, 9.0, 9.0, 1.0])
    affine[:3, 3] = -85.0
    actor.scalars = np.indices((20, 20, 20)).sum(0).astype(np.float32), affine
    yield "volume"
    actor.line_width, actor.tube_shading = 3, True
    yield "wide"


def switch_off(actor):
    actor.show_all()
    actor.deselect()
    actor.transparency, actor.opacity, actor.scalars = None, 1.0, None
    actor.ambient_occlusion = actor.depth_cue = actor.halos = actor.tube_shading = False
    actor.line_width = 1


@pytest.fixture(scope="module")
def shots(fiblets):
    """Pictures of every pipeline after each switch, and what is active before and in the end."""
    pictures, reports = {}, {}
    for pipeline in ("compute", "tessellation", "geometry"):
        plotter = pv.Plotter(off_screen=True, window_size=SIZE)
        try:
            actor = plotter.add_fiblets(fiblets, pipeline=pipeline, show_scalar_bar=False)
            plotter.add_mesh(pv.Sphere(radius=12, center=(30, 0, 20)), color="white")
            plotter.show(auto_close=False)
            plotter.camera.azimuth += 3.0
            plotter.render()  # the first picture could not look at one before it
            before = actor.explain()
            for name in switch_on(actor):
                plotter.camera.azimuth += 3.0
                plotter.render()
                pictures[pipeline, name] = plotter.screenshot(return_img=True).astype(int)
            on = actor.explain()
            switch_off(actor)
            plotter.render()
            reports[pipeline] = before, on, actor.explain()
        finally:
            plotter.close()
    return pictures, reports


@pytest.mark.parametrize("name", ["clip", "criteria", "exclude", "selection", "effects", "layers", "volume", "wide"])
def test_pipelines_agree(shots, name):
    pictures = shots[0]
    reference = pictures["compute", name]
    assert (reference != 255).any(axis=2).sum() > 300
    for pipeline in ("tessellation", "geometry"):
        different = (np.abs(pictures[pipeline, name] - reference) > 8).any(axis=2)
        assert different.mean() < 0.01, pipeline


@pytest.mark.parametrize("pipeline", ["compute", "tessellation", "geometry"])
def test_nothing_is_left_behind(shots, pipeline):
    before, on, after = shots[1][pipeline]
    for feature in ("CLIP_REGION", "POINT_MASK", "STREAMLINE_MASK", "VALUES_VOLUME", "WIDE_LINES", "halo", "layers"):
        assert feature in on["features"]
    assert after["features"] == before["features"]
    # What regions were asked with is kept for the next question, and told.
    left = {row["name"] for row in after["buffers"]} - {"query"}
    assert left <= {row["name"] for row in before["buffers"]}
    assert after["selection"]["gpu_bytes"] == 0
    assert after["streamlines"] == before["streamlines"]
