"""VTK's and PyVista's own pickers find what this package draws, with real positions and streamlines."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv
from vtkmodules.vtkCommonDataModel import vtkSelectionNode
from vtkmodules.vtkRenderingCore import (
    vtkCellPicker,
    vtkHardwarePicker,
    vtkPicker,
    vtkPointPicker,
    vtkPropPicker,
)
from vtkmodules.vtkRenderingOpenGL2 import vtkOpenGLHardwareSelector

from pvfiblets.mappers import follow


@pytest.fixture
def scene(plotter, three_lines):
    """Three lines seen along (1, 1, 1), drawn once."""
    actor = plotter.add_fiblets(three_lines, color="white", line_width=3)
    plotter.camera_position = "iso"
    plotter.show(auto_close=False)
    return actor


def pixel_of(plotter, point):
    """Window pixel of a world position."""
    plotter.renderer.SetWorldPoint(*point, 1.0)
    plotter.renderer.WorldToDisplay()
    return np.array(plotter.renderer.GetDisplayPoint()[:2])


@pytest.mark.parametrize("kind", [vtkCellPicker, vtkPointPicker, vtkPropPicker, vtkHardwarePicker])
def test_pickers_find_the_actor_and_the_place(plotter, scene, three_lines, kind):
    for line, at in ((0, 30), (1, 10), (2, 35)):
        target = three_lines.points[three_lines.offsets[line] + at]
        picker = kind()
        if hasattr(picker, "SetTolerance"):
            picker.SetTolerance(0.01)
        assert picker.Pick(*pixel_of(plotter, target), 0.0, plotter.renderer)
        assert picker.GetActor() is scene
        assert np.linalg.norm(np.array(picker.GetPickPosition()) - target) < 0.6
        if hasattr(picker, "GetCellId"):
            data = pv.wrap(picker.GetDataSet())
            assert data.cell_data["streamline"][picker.GetCellId()] == line
    picker = kind()
    assert not picker.Pick(3.0, 3.0, 0.0, plotter.renderer)
    if kind is vtkCellPicker:  # one of a class of one's own is told
        mine, pixel = type("Mine", (kind,), {}), pixel_of(plotter, three_lines.points[30])
        assert not mine().Pick(*pixel, 0.0, plotter.renderer)
        assert follow(mine()).Pick(*pixel, 0.0, plotter.renderer)


def test_the_place_is_that_of_a_mesh_of_the_same_lines(plotter, scene, three_lines):
    pixel = pixel_of(plotter, three_lines.points[30])
    mesh = plotter.add_mesh(scene.fiblets.decompress().to_polydata(), line_width=3, reset_camera=False)
    found = []
    for shown, other in ((scene, mesh), (mesh, scene)):
        other.pickable = False
        shown.pickable = True
        picker = vtkCellPicker()
        assert picker.Pick(*pixel, 0.0, plotter.renderer)
        assert picker.GetActor() is shown
        found.append((picker.GetPickPosition(), picker.GetCellId(), picker.GetSubId()))
    np.testing.assert_allclose(found[0][0], found[1][0], atol=1e-6)
    assert found[0][1:] == found[1][1:]


def test_hidden_streamlines_are_not_found(plotter, scene, three_lines):
    pixel = pixel_of(plotter, three_lines.points[30])
    scene.show_only([1, 2])
    picker = vtkCellPicker()
    picker.SetTolerance(0.01)
    assert not picker.Pick(*pixel, 0.0, plotter.renderer)
    scene.show_all()
    scene.clip((-20, 2, -20, 20, -20, 20))  # point 30 lies at x = 5
    assert not picker.Pick(*pixel, 0.0, plotter.renderer)
    assert picker.Pick(*pixel_of(plotter, three_lines.points[20]), 0.0, plotter.renderer)
    assert scene.bounds[1] > 7  # VTK's data are what is drawn again
    assert not scene.mapper.is_readable


def test_tubes_are_hit_at_their_surface(plotter, three_lines):
    tubes = plotter.add_spline_tubes(three_lines.to_polydata(), radius=2.0)
    plotter.camera_position = "xy"
    plotter.show(auto_close=False)
    picker = vtkCellPicker()
    picker.SetTolerance(0.0)
    assert picker.Pick(*pixel_of(plotter, (5.0, -9.0, 0.0)), 0.0, plotter.renderer)
    assert picker.GetActor() is tubes
    x, y, z = picker.GetPickPosition()
    assert abs(np.hypot(y + 10.0, z) - 2.0) < 0.08  # 12 flat sides
    assert z > 1.0
    assert pv.wrap(picker.GetDataSet()).cell_data["streamline"][picker.GetCellId()] == 0
    assert vtkPicker().Pick(*pixel_of(plotter, (5.0, -9.0, 0.0)), 0.0, plotter.renderer)


def test_picked_cells_of_balls_are_streamlines(plotter, three_lines):
    """Alone, and beside tubes."""
    for rest in ([], [three_lines.points[:41]]):
        places = np.array([(-3.0, 4.0, 0.0), (6.0, 0.0, 0.0)])
        actor = plotter.add_spline_tubes([*rest, places[:1], places[1:]], radius=1.5)
        plotter.camera_position = "xy"
        plotter.show(auto_close=False)
        for ball, place in enumerate(places, len(rest)):
            picker = vtkCellPicker()
            assert picker.Pick(*pixel_of(plotter, place), 0.0, plotter.renderer)
            assert pv.wrap(picker.GetDataSet()).cell_data["streamline"][picker.GetCellId()] == ball
        plotter.remove_actor(actor)


def test_hardware_selection_gives_segments_of_the_streamlines_that_are_seen(plotter, scene, three_lines):
    before = plotter.screenshot()
    pixel = pixel_of(plotter, three_lines.points[30]).round().astype(int)
    x, y = (int(part) for part in pixel)
    selector = vtkOpenGLHardwareSelector()
    selector.SetFieldAssociation(1)
    selector.SetRenderer(plotter.renderer)
    selector.SetArea(x - 6, y - 6, x + 6, y + 6)
    selection = selector.Select()
    assert selection.GetNumberOfNodes() == 1
    node = selection.GetNode(0)
    assert node.GetProperties().Get(vtkSelectionNode.PROP()) is scene
    ids = pv.convert_array(node.GetSelectionList())
    data = pv.wrap(scene.mapper.GetDataSetInput())
    assert set(data.cell_data["streamline"][ids]) == {0}
    seen = {scene.mapper.pick_at(i, j, tolerance=0) for i in range(x - 6, x + 7) for j in range(y - 6, y + 7)} - {None}
    pieces = {int(place) for _, place in seen}
    assert len(pieces ^ set(ids.tolist())) <= 2  # ends of the area
    np.testing.assert_array_equal(plotter.screenshot(), before)


def click(plotter, pixel, button="right"):
    x, y = (round(part) for part in pixel)
    getattr(plotter.iren, f"_mouse_{button}_button_press")(x, y)
    getattr(plotter.iren, f"_mouse_{button}_button_release")(x, y)


def test_mesh_point_and_element_picking(plotter, scene, three_lines):
    pixel = pixel_of(plotter, three_lines.points[30])
    found = []
    plotter.enable_mesh_picking(found.append, use_actor=True, show=False, left_clicking=False)
    click(plotter, pixel)
    assert found == [scene]
    plotter.disable_picking()
    plotter.enable_mesh_picking(found.append, show=False)
    click(plotter, pixel)
    assert found[1].n_cells == 3
    assert found[1].n_points == 123
    plotter.disable_picking()
    plotter.enable_point_picking(found.append, show_point=False)
    click(plotter, pixel)
    assert np.linalg.norm(found[2] - three_lines.points[30]) < 0.6
    plotter.disable_picking()
    plotter.enable_surface_point_picking(found.append, show_point=False)
    click(plotter, pixel)
    assert np.linalg.norm(found[3] - three_lines.points[30]) < 2.0  # PyVista's tolerance is 7 pixels
    plotter.disable_picking()
    plotter.store_click_position()
    plotter.click_position = tuple(round(part) for part in pixel)
    assert np.linalg.norm(np.array(plotter.pick_click_position()) - three_lines.points[30]) < 0.6


def test_rectangles_find_lines_that_run_through_them(plotter, scene, three_lines):
    found = []

    def drag(first, last):
        plotter.iren._mouse_left_button_press(*(round(part) for part in first))
        plotter.iren._mouse_move(*(round(part) for part in last))
        plotter.iren._mouse_left_button_release(*(round(part) for part in last))

    ends = [pixel_of(plotter, three_lines.points[i]) for i in (82, 122)]
    low, high = np.min(ends, axis=0) - 4, np.max(ends, axis=0) + 4
    plotter.enable_rectangle_through_picking(found.append, start=True, show=False)
    drag(low, high)
    assert list(found[0].cell_data["streamline"]) == [2]
    plotter.disable_picking()
    for method, arguments in (("enable_rectangle_visible_picking", {}), ("enable_cell_picking", {"through": False})):
        with pytest.warns(UserWarning, match="finds triangles, not lines"):
            getattr(plotter, method)(**arguments)
        plotter.disable_picking()
    plotter.enable_cell_picking()
    meshes = pv.Plotter(off_screen=True)
    meshes.add_mesh(pv.Sphere())
    meshes.enable_rectangle_visible_picking()
    meshes.close()


def test_of_large_sets_pickers_get_what_lies_near(plotter, monkeypatch):
    lines = [np.linspace((0, i, 0), (90, i, 0), 100) for i in range(60)]
    actor = plotter.add_fiblets(lines, color="white")
    plotter.camera_position = "xy"
    plotter.show(auto_close=False)
    monkeypatch.setattr("pvfiblets.mappers.vtk_pipeline.vtk_overrides.MOST_POINTS", 2000)
    monkeypatch.setattr("pvfiblets.mappers.vtk_pipeline.readable_lines.MOST_POINTS", 2000)
    picker = vtkCellPicker()
    picker.SetTolerance(0.005)
    assert picker.Pick(*pixel_of(plotter, (41.3, 33.0, 0.0)), 0.0, plotter.renderer)
    data = pv.wrap(picker.GetDataSet())
    assert data.n_points <= 2000
    assert data.cell_data["streamline"][picker.GetCellId()] == 33
    selector = vtkOpenGLHardwareSelector()
    selector.SetFieldAssociation(1)
    selector.SetRenderer(plotter.renderer)
    selector.SetArea(0, 0, 199, 199)
    with pytest.warns(UserWarning, match="not which streamline"):
        selected = selector.Select()
    assert selected.GetNode(0).GetProperties().Get(vtkSelectionNode.PROP()) is actor
