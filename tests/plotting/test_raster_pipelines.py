"""The pipelines that draw through OpenGL's rasteriser, inside VTK's own drawing: whatever VTK has on, and put back."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv

MODES = ["plain", "second of two views", "depth peeling", "ambient occlusion", "multisampling", "clipped"]


def pictures(lines, pipeline, mode, width):
    """Two pictures, the second from elsewhere, as arrays."""
    two = mode == "second of two views"
    plotter = pv.Plotter(off_screen=True, window_size=(300, 200), shape=(1, 2) if two else (1, 1))
    if two:
        plotter.subplot(0, 1)
    see_through = 0.5 if mode == "depth peeling" else 1.0
    plotter.add_mesh(pv.Sphere(radius=8.0), color="white", opacity=see_through)
    actor = plotter.add_fiblets(lines, line_width=width, pipeline=pipeline)
    if mode == "depth peeling":
        plotter.enable_depth_peeling()
    elif mode == "ambient occlusion":
        plotter.enable_ssao()
    elif mode == "multisampling":
        plotter.enable_anti_aliasing("msaa")
    elif mode == "clipped":
        actor.mapper.AddClippingPlane(_plane())
    plotter.show(auto_close=False)
    found = [plotter.screenshot(None, return_img=True)]
    plotter.camera.azimuth = 40
    plotter.render()
    found.append(plotter.screenshot(None, return_img=True))
    plotter.close()
    return [picture.astype(int) for picture in found]


def _plane():
    from vtkmodules.vtkCommonDataModel import vtkPlane

    plane = vtkPlane()
    plane.SetNormal(1.0, 0.3, 0.1)
    return plane


@pytest.fixture(scope="module")
def lines():
    """Return 120 wandering lines."""
    rng = np.random.default_rng(0)
    steps = [rng.normal(0, 0.5, (100, 3)) + rng.normal(0, 0.3, 3) for _ in range(120)]
    return [np.cumsum(step, axis=0) + rng.uniform(-20, 20, 3) for step in steps]


@pytest.mark.few(1)
@pytest.mark.every("value")
@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("pipeline", ["tessellation", "geometry"])
def test_pictures_are_those_of_compute(lines, pipeline, mode):
    for width in (1.0, 4.0):
        expected = pictures(lines, "compute", mode, width)
        for picture, reference in zip(pictures(lines, pipeline, mode, width), expected, strict=True):
            assert reference.std() > 5.0
            assert (np.abs(picture - reference) > 8).any(axis=-1).mean() < 5e-4
