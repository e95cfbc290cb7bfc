"""The choice of a pipeline, from PyVista's side."""

from __future__ import annotations

import re

import numpy as np
import pytest
import pyvista as pv

from pvfiblets.engine.errors import EngineError


def shot(plotter):
    plotter.show(auto_close=False) if plotter._first_time else plotter.render()
    return plotter.screenshot(None)


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


def test_a_closed_plotter_says_so(three_lines):
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
