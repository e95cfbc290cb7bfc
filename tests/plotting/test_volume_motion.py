"""Volumes are drawn coarser while an interactor moves the camera, and as they are set when it rests."""

from __future__ import annotations

import numpy as np
import pytest

from pvfiblets.volumes.interactive_quality import InteractiveQuality
from pvfiblets.volumes.raycast_options import RaycastOptions
from pvfiblets.volumes.transfer import Transfer


def ball(n=24):
    x = np.linspace(-1, 1, n)
    return np.clip(1 - np.sqrt(x[:, None, None] ** 2 + x[:, None] ** 2 + x**2), 0, 1).astype(np.float32)


@pytest.fixture
def watched(plotter):
    """A plotter, its actor, and what each of its pictures was cast by."""
    actor = plotter.add_raycast_volume(ball(), mode="isosurface", values=0.4)
    plotter.show(auto_close=False, interactive=False)
    shown = []
    plain = actor._mapper._style

    def style(renderer, viewport):
        made = plain(renderer, viewport)
        shown.append(made.casting)
        return made

    actor._mapper._style = style
    return plotter, actor, shown


def drag(plotter, *, left=True):
    """Press, move, and let go, as a window system tells it: pictures are drawn by VTK itself."""
    interactor = plotter.iren.interactor
    interactor.SetEventInformation(100, 100)
    interactor.LeftButtonPressEvent()
    for x in (110, 120):
        interactor.SetEventInformation(x, 105)
        interactor.MouseMoveEvent()
    if left:
        interactor.LeftButtonReleaseEvent()


STYLES = ["enable_trackball_style", "enable_terrain_style"]


@pytest.mark.parametrize("style", STYLES)
def test_coarser_in_motion_and_whole_at_rest(watched, style):
    plotter, actor, shown = watched
    getattr(plotter, style)()
    plotter.render()
    assert shown.pop() == actor.casting
    shown.clear()
    drag(plotter, left=False)
    plotter.render()
    assert {(casting.step, casting.sparse) for casting in shown} == {(1.0, 2)}
    shown.clear()
    plotter.iren.interactor.LeftButtonReleaseEvent()
    assert [casting == actor.casting for casting in shown] == [True]  # by itself, once
    plotter.render()
    assert shown[-1] == actor.casting
    actor.interactive_quality = 1  # switches it off
    shown.clear()
    drag(plotter)
    assert len(shown) >= 2
    assert all(casting == actor.casting for casting in shown)


def test_light_keeps_its_table_unless_told():
    transfer = Transfer([[0, 0, 0, 0], [1, 1, 1, 1]], (0, 1))
    light, surface = (
        RaycastOptions("composite", transfer=transfer, step=0.5),
        RaycastOptions(values=(0.5,), step=0.5, sparse=4),
    )
    half = InteractiveQuality.of_quality(0.5)
    moving = half.applied_to(light)
    assert (moving.step, moving.sparse, moving.integrator) == (0.5, 2, "preintegrated")
    assert (half.applied_to(surface).step, half.applied_to(surface).sparse) == (1.0, 4)
    told = InteractiveQuality.of_quality({"step": 3, "sparse": 4})
    assert (told.applied_to(light).step, told.applied_to(light).sparse) == (1.5, 4)
    assert (InteractiveQuality.of_quality(0.0).step, InteractiveQuality.of_quality(0.0).sparse) == (4.0, 4)
    assert InteractiveQuality.of_quality(1) is InteractiveQuality.of_quality({}) is None
