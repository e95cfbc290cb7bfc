"""A scene whose pictures are refined, and what looks at them."""

from __future__ import annotations

from contextlib import contextmanager

import numpy as np
import pytest
import pyvista as pv
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkRenderingCore import vtkWindowToImageFilter

from pvfiblets.antialias import VARIABLE
from pvfiblets.mappers.frames import windows

SIZE = (150, 110)


@pytest.fixture(autouse=True)
def real_default(monkeypatch):
    monkeypatch.delenv(VARIABLE)


def fill(plotter, **more):
    """Show slanted lines, a mesh's slanted edges and something translucent, without light."""
    t = np.linspace(0.0, 1.0, 20)[:, None]
    lines = [np.array([-30.0, -20 + 5 * k, 0.0]) + t * np.array([60.0, 17 + k, 4.0]) for k in range(4)]
    actor = plotter.add_fiblets(lines, color="yellow", lighting=False, line_width=2, **more)
    plotter.add_mesh(pv.Cone(center=(0, -14, -9), height=30, radius=8), color="red", lighting=False)
    plotter.add_mesh(pv.Disc(center=(9, 9, 5), inner=0, outer=11), color="blue", opacity=0.5, lighting=False)
    plotter.camera_position = [(0, 0, 100), (0, 0, 0), (0, 1, 0)]
    plotter.renderer.ResetCameraClippingRange()
    return actor


@contextmanager
def drawn():
    """Return a plotter of such things, drawn once."""
    plotter = pv.Plotter(off_screen=True, window_size=SIZE)
    plotter.set_background("black")
    plotter.disable_anti_aliasing()
    fill(plotter)
    plotter.show(auto_close=False)
    yield plotter
    for context in windows._contexts.values():
        context.window.MakeCurrent()
        assert context.ctx.error == "GL_NO_ERROR"
    plotter.close()
    assert not any(context.alive for context in windows._contexts.values())


def ours(plotter):
    """Return the plotter's first actor of fiblets."""
    return next(iter(plotter.fiblets))


class Renders:
    """Counts frames of a window."""

    def __init__(self, plotter):
        self.count = 0
        plotter.render_window.AddObserver("EndEvent", self._count)

    def _count(self, *_):
        self.count += 1

    def since(self):
        count, self.count = self.count, 0
        return count


def shot(plotter, **how):
    """Return a screenshot."""
    return np.asarray(plotter.screenshot(None, **how)).astype(int)


def grabbed(plotter):
    """Return the picture as it is, unfinished or not."""
    interactor = plotter.iren.interactor
    interactor.EnableRenderOff()
    grab = vtkWindowToImageFilter()
    grab.SetInput(plotter.render_window)
    grab.ShouldRerenderOff()
    grab.ReadFrontBufferOff()
    grab.Update()
    interactor.EnableRenderOn()
    width, height, _ = grab.GetOutput().GetDimensions()
    pixels = vtk_to_numpy(grab.GetOutput().GetPointData().GetScalars()).reshape(height, width, -1)
    return pixels[::-1].astype(int)
