"""The choice of a pipeline, from PyVista's side, and the same pictures by each, whatever VTK has on."""

from __future__ import annotations

import re

import numpy as np
import pytest
import pyvista as pv

from pvfiblets.engine.errors import EngineError

from .views import shot


def test_a_plotter_lists_what_its_opengl_can_draw_with(plotter):
    table = plotter.fiblets.pipelines()
    assert isinstance(table, list)
    assert repr(table).startswith("pipeline")
    told = re.search(r"OpenGL version string: +(\d+)\.(\d+)", plotter.render_window.ReportCapabilities())
    version = int(told[1]), int(told[2])
    available = {info.name: info.available for info in table}
    assert set(available) == {"mesh", "mesh-serial", "compute", "tessellation", "geometry"}
    assert available["compute"] == (version >= (4, 3))
    assert available["tessellation"] == (version >= (4, 1))
    assert available["geometry"] == (version >= (3, 3))
    assert available[table.auto]


@pytest.mark.parametrize("when", ["before", "between", "after"])
def test_asking_changes_nothing_in_the_picture(plotter, three_lines, when):
    reference = pv.Plotter(off_screen=True, window_size=(200, 200))
    reference.set_background("black")
    reference.disable_anti_aliasing()
    for each in (plotter, reference):
        asks = each is plotter
        if asks and when == "before":
            each.fiblets.pipelines()
        each.add_mesh(pv.Sphere(radius=6.0), color="white")
        if asks and when == "between":
            each.fiblets.pipelines()
        each.add_fiblets(three_lines, line_width=3.0)
    first = shot(plotter)
    if when == "after":
        plotter.fiblets.pipelines()
        first = shot(plotter)
    np.testing.assert_array_equal(first, shot(reference))
    reference.close()


def test_a_closed_plotter_raises(three_lines):
    plotter = pv.Plotter(off_screen=True)
    component = plotter.fiblets
    plotter.close()
    with pytest.raises(RuntimeError, match="this plotter is closed and has no OpenGL"):
        component.pipelines()


@pytest.mark.parametrize("bad", [{"pipeline": "vulkan"}, {"culling": "often"}, {"fit": "most"}])
def test_a_bad_choice_is_refused_before_anything_is_read(plotter, bad):
    name = next(iter(bad))
    with pytest.raises(ValueError, match=f"{name} is '{bad[name]}'; expected one of "):
        plotter.add_fiblets("there is no such file.trk", **bad)


def test_choices_can_be_read_and_changed(plotter, three_lines):
    actor = plotter.add_fiblets(three_lines)
    assert (actor.pipeline, actor.culling, actor.fit, actor.pipeline_in_use) == ("auto", "auto", None, None)
    actor.pipeline, actor.culling, actor.fit = "compute", "none", "sample"
    assert (actor.pipeline, actor.culling, actor.fit) == ("compute", None, "sample")
    for name in ("pipeline", "culling", "fit"):
        with pytest.raises(ValueError, match=f"{name} is 'wrong'; expected one of"):
            setattr(actor, name, "wrong")
    assert (actor.pipeline, actor.culling, actor.fit) == ("compute", None, "sample")
    twin = actor.copy()
    assert (twin.pipeline, twin.culling, twin.fit) == ("compute", None, "sample")


def test_a_pipeline_that_is_missing_is_an_error_from_the_call_that_rendered(plotter, three_lines):
    missing = [info.name for info in plotter.fiblets.pipelines() if not info.available]
    if not missing:
        pytest.skip("this OpenGL has every pipeline")
    actor = plotter.add_fiblets(three_lines, pipeline=missing[0])
    with pytest.raises(EngineError, match=f"pipeline '{missing[0]}' cannot draw on OpenGL .*Available are 'compute'"):
        plotter.show(auto_close=False)
    actor.pipeline = "auto"
    assert (shot(plotter) > 0).any()


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
