"""Which streamline is under a pixel; VTK's and PyVista's own pickers."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv
from vtkmodules.vtkCommonDataModel import vtkDataObject
from vtkmodules.vtkRenderingCore import vtkHardwareSelector, vtkPropPicker

from pvfiblets.mappers.frames import windows


@pytest.fixture
def scene(make_plotter, make_fibres, tools):
    """Return rods along x at five heights, seen from -y."""
    helices = tools.helices(1, 2)
    along = np.linspace(0, 40, 41)[:, None] * np.array((1.0, 0.0, 0.0))
    fibres = make_fibres(type(helices).from_list([along + np.array((0, 0, 8 * i)) for i in range(5)]))
    mapper, actor = fibres.actor()
    plotter = make_plotter()
    plotter.add_actor(actor)
    plotter.camera_position = "xz"
    plotter.reset_camera()
    tools.picture(plotter, mapper)

    def display(point):
        plotter.renderer.SetWorldPoint(*map(float, point), 1.0)
        plotter.renderer.WorldToDisplay()
        return plotter.renderer.GetDisplayPoint()[:2]

    return plotter, mapper, actor, display


def test_pick_at_finds_streamline_and_position(scene, make_fibres):
    _, mapper, _, display = scene
    for streamline in range(5):
        for position in (3.0, 20.5, 38.0):
            found = mapper.pick_at(*display((position, 0, 8 * streamline)))
            assert found is not None
            assert found[0] == streamline
            assert found[1] == pytest.approx(position, abs=0.6)
    assert mapper.pick_at(*display((20, 0, 4))) is None
    assert mapper.pick_at(-5, 5) is None
    assert mapper.pick_at(10_000, 5) is None
    x, y = display((20, 0, 16))
    assert mapper.pick_at(x, y + 4, tolerance=0) is None
    assert mapper.pick_at(x, y + 4, tolerance=6)[0] == 2
    mapper, _ = make_fibres().actor()
    assert mapper.pick_at(5, 5) is None  # nothing was drawn


@pytest.mark.parametrize("effect", ["ssaa", "ssao", "none"])
def test_pick_at_in_the_second_subplot(make_plotter, make_fibres, tools, effect):
    helices = tools.helices(1, 2)
    along = np.linspace(0, 40, 41)[:, None] * np.array((1.0, 0.0, 0.0))
    fibres = make_fibres(type(helices).from_list([along, along + np.array((0, 0, 20))]))
    plotter = make_plotter(shape=(1, 2), window_size=(400, 200))
    mapper, actor = fibres.actor()
    plotter.subplot(0, 1)
    plotter.add_actor(actor)
    plotter.camera_position = "xz"
    plotter.reset_camera()
    if effect == "ssaa":
        plotter.enable_anti_aliasing("ssaa")
    if effect == "ssao":
        plotter.enable_ssao()
    tools.picture(plotter, mapper)
    plotter.renderer.SetWorldPoint(30.0, 0.0, 20.0, 1.0)
    plotter.renderer.WorldToDisplay()
    x, y, _ = plotter.renderer.GetDisplayPoint()
    assert x > 200
    found = mapper.pick_at(x, y)
    assert found is not None
    assert found[0] == 1
    assert found[1] == pytest.approx(30, abs=1)


def test_hardware_selection_of_points_draws_no_error(scene, tools):
    plotter, mapper, _, _ = scene
    before = tools.picture(plotter, mapper)
    selector = vtkHardwareSelector()
    selector.SetRenderer(plotter.renderer)
    selector.SetFieldAssociation(vtkDataObject.FIELD_ASSOCIATION_POINTS)
    selector.SetArea(0, 0, 200, 150)
    selector.Select()
    mapper.raise_pending()
    assert np.array_equal(tools.picture(plotter, mapper), before)


def test_a_mesh_in_front_is_picked_first(scene):
    plotter, mapper, _, display = scene
    box = plotter.add_mesh(pv.Box((15, 25, -6, -4, 10, 20)), reset_camera=False)
    plotter.renderer.ResetCameraClippingRange()
    picker = vtkPropPicker()
    picker.PickProp(*display((20, 0, 16)), plotter.renderer)
    assert picker.GetViewProp() is box
    mapper.raise_pending()


@pytest.mark.parametrize("change", ["size", "multisampling", "peeling"])
def test_picking_leaves_no_error_when_vtk_has_other_framebuffers(make_plotter, lines, tools, change):
    """moderngl must not bind again a framebuffer that VTK has deleted."""
    mapper, actor = lines.actor()
    plotter = make_plotter()
    plotter.add_actor(actor)
    tools.picture(plotter, mapper)
    context = windows.context_of(plotter.render_window)
    if change == "size":
        plotter.window_size = (310, 170)
    elif change == "multisampling":
        plotter.enable_anti_aliasing("msaa")
    else:
        plotter.enable_depth_peeling()
        actor.GetProperty().SetOpacity(0.5)
    tools.picture(plotter, mapper)
    mapper.pick_at(100, 80, tolerance=50)
    assert context.ctx.error == "GL_NO_ERROR"
