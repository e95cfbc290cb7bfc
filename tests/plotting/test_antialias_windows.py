"""Windows, movement and servers: when samples are drawn, and which pictures are plain."""

from __future__ import annotations

import asyncio
import os
import subprocess
import sys
from types import SimpleNamespace

import numpy as np
import pytest

from pvfiblets.antialias import VARIABLE
from pvfiblets.plotting.antialias_pacing import REST
from tests.display import display

from .refined_scene import Renders, drawn, grabbed, real_default, shot  # noqa: F401 - a fixture


@pytest.fixture
def scene():
    with drawn() as plotter:
        yield plotter


@pytest.fixture
def clock(monkeypatch):
    """Return a list with the seconds that windows have for the time; tests move them on."""
    now = [1000.0]
    monkeypatch.setattr("pvfiblets.plotting.antialias_pacing.time", SimpleNamespace(monotonic=lambda: now[0]))
    return now


def test_a_window_draws_sample_after_sample_until_it_is_finished(scene, clock, monkeypatch):
    """As on a screen: after each frame a timer is asked for, whose event draws the next sample."""
    monkeypatch.setattr("pvfiblets.plotting.antialias_pacing.Pacer.seen", True)
    interactor, asked = scene.iren.interactor, []
    interactor.AddObserver("CreateTimerEvent", lambda *_: asked.append(1))
    renders = Renders(scene)
    interactor.InvokeEvent("TimerEvent")
    assert renders.since() == 0
    scene.camera.Azimuth(3.0)
    scene.render()
    assert renders.since() == 1
    plain = grabbed(scene)
    interactor.InvokeEvent("TimerEvent")  # too early: somebody else's
    assert renders.since() == 0
    clock[0] += REST
    for count in range(1, 17):
        interactor.InvokeEvent("TimerEvent")
        assert (renders.since(), scene.picture.samples) == (1, count)
        assert np.array_equal(grabbed(scene), plain) == (count < 8)
        clock[0] += 0.002
    for _ in range(3):
        interactor.InvokeEvent("TimerEvent")
        clock[0] += 2 * REST
    assert renders.since() == 0
    finished = grabbed(scene)
    assert np.array_equal(shot(scene), finished)


def test_while_the_camera_moves_pictures_are_plain_and_no_timer_is_asked_for(scene, clock, monkeypatch):
    monkeypatch.setattr("pvfiblets.plotting.antialias_pacing.Pacer.seen", True)
    scene.enable_trackball_style()
    interactor, renders = scene.iren.interactor, Renders(scene)
    interactor.SetEventInformation(60, 60)
    interactor.LeftButtonPressEvent()
    for x in (70, 80, 90):
        interactor.SetEventInformation(x, 65)
        interactor.MouseMoveEvent()
        assert scene.picture.samples == 1
        assert scene.picture._pacer._due == 0.0
        assert not scene.picture.refine()
    assert renders.since() == 3
    interactor.LeftButtonReleaseEvent()
    assert scene.picture._pacer._due > 0.0
    assert renders.since() == 1
    clock[0] += REST
    interactor.InvokeEvent("TimerEvent")
    assert (renders.since(), scene.picture.samples) == (1, 1)
    assert scene.picture.refine()


def test_a_server_sends_the_finished_picture_once(scene, monkeypatch):
    """As in a notebook: the interactor must not render, pictures are sent when the plotter renders."""
    monkeypatch.setattr("pvfiblets.plotting.antialias_pacing.REST", 0.02)
    sent = []
    scene.add_on_render_callback(lambda _: sent.append(scene.picture.samples))
    scene.iren.interactor.EnableRenderOff()
    renders = Renders(scene)

    async def look():
        scene.camera.Azimuth(3.0)
        scene.render()
        assert sent == [1]
        async with asyncio.timeout(120):
            while len(sent) < 2:
                await asyncio.sleep(0.01)
        assert scene.picture._pacer._call is None  # nothing more is to come

    asyncio.run(look())
    assert sent == [1, 16]
    assert renders.since() == 18  # plain, samples, and one more to be sent
    scene.iren.interactor.EnableRenderOn()


WINDOW = """
import sys, time
import numpy as np, pyvista as pv
plotter = pv.Plotter(window_size=(200, 150))
plotter.add_fiblets([[(0, 0, 0), (9, 4, 0)], [(0, 5, 0), (9, 1, 2)]], color="white", lighting=False)
frames = []
plotter.render_window.AddObserver("EndEvent", lambda *_: frames.append(plotter.picture.samples))
plotter.show(interactive_update=True, auto_close=False)
def until_finished():
    end = time.monotonic() + 60.0
    while (plotter.picture.samples < 16 or plotter.picture._pacer._due) and time.monotonic() < end:
        plotter.iren.process_events()
        time.sleep(0.002)
until_finished()
frames.clear()
plotter.iren.interactor.SetEventInformation(90, 70)
plotter.iren.interactor.MouseWheelForwardEvent()
print("turned", plotter.picture.samples)
until_finished()
print("finished", frames.count(16), frames[-1])
plotter.close()
"""


@pytest.mark.more
def test_a_window_on_a_screen_refines_by_itself(tmp_path):
    without = (VARIABLE, "VTK_DEFAULT_OPENGL_WINDOW", "PYVISTA_OFF_SCREEN")
    environment = {name: value for name, value in os.environ.items() if name not in without}
    command = [sys.executable, "-c", WINDOW]
    with display() as environment["DISPLAY"]:
        done = subprocess.run(command, capture_output=True, text=True, check=False, env=environment, timeout=120)
    told = [line for line in done.stdout.splitlines() if not line.startswith("\x1b")]
    assert told == ["turned 1", "finished 1 16"], done.stderr
