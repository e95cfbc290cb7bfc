"""No frame waits for the GPU while a hand moves something: pipelines that only some drivers have, and panes of slices.

Scenes of one feature each are held to that by ``tests/left_out``.
"""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv

import pvfiblets.plotting  # noqa: F401 - registers the components
from pvfiblets import compress
from pvfiblets.engine.fiblets.pipelines import compute
from pvfiblets.synthetic import brain_streamlines
from tests.drivers import MESH
from tests.gl_calls import possible, recording

pytestmark = pytest.mark.skipif(not possible(), reason="calls are recorded on x86-64 and Linux only")

SIZE = (160, 120)
BALL = pv.Sphere(radius=30.0)
LATER = 4
"""Frames after which numbers of a frame have come back."""


@pytest.fixture(autouse=True)
def as_on_a_card(monkeypatch):
    """Software is asked which classes of fiblets it has while it has not compiled all."""
    monkeypatch.setattr(compute, "READ_LISTS", False)


@pytest.fixture(scope="module")
def brain():
    return compress(brain_streamlines(60, seed=1))


@pytest.fixture
def calls():
    with recording() as calls:
        yield calls


def steady(plotter, calls, move):
    """Show a plotter, move something of it as a hand does, and return what waited for the GPU once all is warm."""
    plotter.show(auto_close=False)
    plotter.render_window.SetDesiredUpdateRate(15.0)  # as VTK's interactor styles do
    for number in range(LATER):
        move(number)
        plotter.render()
    calls.forget()
    for number in range(LATER, 3 * LATER):
        move(number)
        plotter.render()
    assert sum(calls.counts.values()) > 0
    return sorted(set(calls.waits))


@pytest.fixture
def turned(calls):
    """Return a function: what waits while a camera turns about fiblets."""
    plotters = []

    def of(brain, change=lambda actor: None, **arguments):
        plotter = pv.Plotter(off_screen=True, window_size=SIZE)
        plotters.append(plotter)
        actor = plotter.add_fiblets(brain, show_scalar_bar=False, **arguments)
        change(actor)

        def move(_number):
            plotter.camera.azimuth += 1.0

        return steady(plotter, calls, move), actor

    yield of
    for plotter in plotters:
        plotter.close()


@pytest.mark.parametrize("culling", ["two-phase", "coverage", None])
@pytest.mark.parametrize("pipeline", ["geometry", *MESH])
def test_a_turning_camera_never_waits(turned, brain, pipeline, culling):
    waits, actor = turned(brain, pipeline=pipeline, culling=culling)
    assert waits == []
    assert actor.pipeline == pipeline


@pytest.mark.few(1)
@pytest.mark.parametrize(
    "arguments", [{"style": "density"}, {"opacity": 0.5}, {"opacity": 0.5, "transparency": 3}, {"line_width": 3}],
    ids=["density", "translucent", "layers", "wide"],
)  # fmt: skip
@pytest.mark.parametrize("pipeline", ["geometry", *MESH])
def test_no_style_waits_on_any_pipeline(turned, brain, pipeline, arguments):
    assert turned(brain, pipeline=pipeline, **arguments)[0] == []


@pytest.mark.parametrize("pipeline", ["geometry", *MESH])
def test_a_mesh_that_cuts_does_not_wait_on_any_pipeline(turned, brain, pipeline):
    assert turned(brain, lambda actor: actor.clip(BALL), pipeline=pipeline)[0] == []


def test_slices_of_images_and_lines_that_move_do_not_wait(calls, brain):
    x = np.linspace(-60.0, 60.0, 24)
    affine = np.diag([5.0, 5.0, 5.0, 1.0])
    affine[:3, 3] = -60.0
    image = (np.hypot(*np.meshgrid(x, x))[..., None] + x).astype(np.float32), affine
    plotter = pv.Plotter(off_screen=True, window_size=SIZE, shape=(2, 2), border=False)
    workspace = plotter.slices.workspace(image, thickness=8.0)
    plotter.add_fiblets(brain, show_scalar_bar=False)

    def move(number):
        workspace.position = (2.0 * number, 1.5 * number, number)

    try:
        assert steady(plotter, calls, move) == []
    finally:
        plotter.close()
