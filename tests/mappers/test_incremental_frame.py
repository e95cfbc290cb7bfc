"""Frames whose fiblets are drawn beforehand, piece by piece: the usual pixels, and nothing drawn twice."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv

from pvfiblets.engine import pieces
from pvfiblets.mappers.frames.incremental_frame import draw_in_pieces
from pvfiblets.mappers.frames.windows import contexts_with
from pvfiblets.synthetic import brain_streamlines


@pytest.fixture(scope="module")
def lines():
    return brain_streamlines(150, 0.5, seed=2)


@pytest.fixture
def shown(lines, monkeypatch):
    """Return a maker of plotters that have drawn a frame, and of their engines."""
    monkeypatch.setattr(pieces.Pieces.__init__, "__defaults__", (0.0,))
    made = []

    def make(antialias="off"):
        plotter = pv.Plotter(off_screen=True, window_size=(160, 120))
        made.append(plotter)
        plotter.add_mesh(pv.Sphere(radius=12.0, center=(0, -40, 0)))
        actor = plotter.add_fiblets(lines, line_width=1.5)
        plotter.picture.antialias = antialias
        plotter.picture.pace_by_hand()
        plotter.show(auto_close=False, interactive=False)
        (context,) = contexts_with(actor.mapper)
        return plotter, context.slot(actor.mapper).renderer, actor

    yield make
    for plotter in made:
        plotter.close()


def pixels(plotter):
    """Read what the window shows, without drawing."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkRenderingCore import vtkWindowToImageFilter

    grab = vtkWindowToImageFilter()
    grab.SetInput(plotter.render_window)
    grab.ShouldRerenderOff()
    grab.ReadFrontBufferOff()
    grab.Update()
    return vtk_to_numpy(grab.GetOutput().GetPointData().GetScalars()).copy()


def turn(plotter, angle):
    plotter.camera.Azimuth(angle)
    plotter.reset_camera_clipping_range()


@pytest.mark.few(1)
@pytest.mark.parametrize("antialias", ["off", "coverage"])
def test_a_frame_finds_its_fiblets_drawn_and_shows_the_same(shown, antialias):
    (ahead, engine, _), (usual, _, _) = shown(antialias), shown(antialias)
    for angle in (20.0, 25.0):
        for plotter in (ahead, usual):
            turn(plotter, angle)
        assert sum(1 for _ in draw_in_pieces(ahead.render_window)) > 3
        drawn = engine._generation
        for plotter in (ahead, usual):
            plotter.render()
        assert engine._generation == drawn
        assert np.array_equal(pixels(ahead), pixels(usual))


def test_samples_find_their_fiblets_drawn_and_the_mean_is_the_same(shown):
    (ahead, engine, _), (usual, _, _) = shown(4), shown(4)
    for plotter in (ahead, usual):
        turn(plotter, 20.0)
        plotter.render()
    more, count = True, 0
    while more:
        pieces_drawn = sum(1 for _ in draw_in_pieces(ahead.render_window, refining=True))
        drawn = engine._generation
        more = ahead.picture.refine()
        if pieces_drawn:
            count += 1
            assert engine._generation == drawn
    assert count == 4
    while usual.picture.refine():
        pass
    assert ahead.picture.samples == usual.picture.samples == 4
    assert np.array_equal(pixels(ahead), pixels(usual))


def test_what_changes_meanwhile_is_in_the_frame(shown):
    (ahead, _, actor), (usual, _, other) = shown(), shown()
    for plotter in (ahead, usual):
        turn(plotter, 20.0)
    steps = draw_in_pieces(ahead.render_window)
    next(steps)
    turn(ahead, 40.0)
    next(steps)
    ahead.render()
    assert next(steps, None) is None  # the frame has overtaken it
    turn(usual, 40.0)
    usual.render()
    assert np.array_equal(pixels(ahead), pixels(usual))
    turn(ahead, 5.0)
    steps = draw_in_pieces(ahead.render_window)
    next(steps)
    ahead.remove_actor(actor)
    usual.remove_actor(other)
    ahead.render()
    assert next(steps, None) is None
    turn(usual, 5.0)
    usual.render()
    assert np.array_equal(pixels(ahead), pixels(usual))


def test_windows_of_other_kinds_are_left_to_the_frame(shown):
    plotter, _, actor = shown()
    turn(plotter, 20.0)
    plotter.enable_ssao()
    assert not list(draw_in_pieces(plotter.render_window))
    plotter.disable_ssao()
    actor.visibility = False
    assert not list(draw_in_pieces(plotter.render_window))
    actor.visibility = True
    assert list(draw_in_pieces(plotter.render_window))
