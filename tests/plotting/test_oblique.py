"""The oblique slice of a workspace: what its pane shows, and what turns it."""

from __future__ import annotations

import nibabel as nib
import numpy as np
import pytest
import pyvista as pv

import pvfiblets.plotting  # noqa: F401 - registers the components
from pvfiblets.plotting.slices.layouts import LAYOUTS, viewports
from tests.plotting.test_workspace import AFFINE, RAMP, SHAPE, Mouse, ramp

NORMAL = np.array([0.3, -0.5, 0.9]) / np.linalg.norm([0.3, -0.5, 0.9])


@pytest.fixture
def five():
    plotter = pv.Plotter(off_screen=True, window_size=(600, 400), shape=(1, 5), border=False)
    plotter.set_background("black", all_renderers=True)
    yield plotter
    plotter.close()


@pytest.fixture
def workspace(five):
    made = five.slices.workspace((ramp(), AFFINE), clim=(-2, 2))
    made.add_oblique(NORMAL)
    five.show(auto_close=False)
    return made


def line_of(normal, pane):
    """Return the unit direction, of the window's right and up, in which a plane cuts a pane."""
    along = np.cross(pane.toward, normal)
    flat = np.array([along @ axis for axis in pane.axes])
    return flat / np.linalg.norm(flat)


def handle_of(workspace, name):
    """Return the pixel of a handle of the oblique slice's line."""
    pane = workspace.panes[name]
    middle = np.array(pane.pixel_of(workspace.position))
    return middle, middle + 0.36 * min(pane.pixels) * line_of(workspace.oblique.normal, pane)


@pytest.mark.more
def test_its_pane_shows_what_lies_in_its_plane(five, workspace):
    workspace.cross_hair, workspace.told = False, False
    workspace.position = (3.0, -5.0, 9.0)
    pane = workspace.panes["oblique"]
    five.render()
    picture = five.screenshot(return_img=True)[::-1].astype(float)
    left, bottom = pane.renderer.GetOrigin()
    width, height = pane.pixels
    y, x = np.mgrid[bottom + 30 : bottom + height - 30, left + 30 : left + width - 30]
    at = np.stack([pane.position_at(*pixel) for pixel in zip(x.ravel(), y.ravel(), strict=True)])
    np.testing.assert_allclose((at - workspace.position) @ NORMAL, 0.0, atol=1e-9)
    voxels = nib.affines.apply_affine(np.linalg.inv(AFFINE), at)
    inside = ((voxels > 0.5) & (voxels < np.array(SHAPE) - 1.5)).all(axis=1)
    assert inside.mean() > 0.3
    wanted = np.clip((at @ RAMP + 2.0) / 4.0, 0.0, 1.0) * 255.0
    found = picture[y.ravel(), x.ravel(), 0]
    assert np.abs(found - wanted)[inside].max() <= 4.0


@pytest.mark.few(1)
@pytest.mark.parametrize("name", ["axial", "coronal", "sagittal"])
@pytest.mark.parametrize("angle", [25.0, -70.0])
def test_a_drag_of_a_handle_turns_its_line_as_far_as_the_mouse(five, workspace, name, angle):
    turned = []
    workspace.oblique.on_turn(turned.append)
    workspace.position = (2.0, -4.0, 6.0)
    five.render()
    pane, before = workspace.panes[name], workspace.oblique.normal
    middle, handle = handle_of(workspace, name)
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    away = np.array([[c, -s], [s, c]]) @ (handle - middle)
    Mouse(five).drag("Left", np.rint(handle), np.rint(middle + away))
    after = workspace.oblique.normal
    np.testing.assert_allclose(workspace.position, (2.0, -4.0, 6.0))  # the cross-hair stays
    assert before @ pane.toward == pytest.approx(after @ pane.toward)  # turned about the pane's own direction
    wanted = away / np.linalg.norm(away)
    assert line_of(after, pane) @ wanted > np.cos(np.radians(1.5))
    np.testing.assert_allclose(turned[-1], after)


def test_a_drag_beside_the_handles_moves_the_cross_hair_and_the_slice_with_it(five, workspace):
    pane = workspace.panes["axial"]
    middle, handle = handle_of(workspace, "axial")
    across = np.array([-(handle - middle)[1], (handle - middle)[0]])
    Mouse(five).drag("Left", np.rint(middle + across))
    np.testing.assert_allclose(workspace.position, pane.position_at(*np.rint(middle + across)))
    np.testing.assert_allclose(workspace.oblique.plane.origin, workspace.position)
    np.testing.assert_allclose(workspace.oblique.normal, NORMAL)


def test_the_wheel_over_its_pane_goes_along_its_normal(five, workspace):
    pane, before = workspace.panes["oblique"], workspace.position
    left, bottom = pane.renderer.GetOrigin()
    Mouse(five).send("MouseWheelForwardEvent", left + 40, bottom + 40)
    moved = workspace.position - before
    np.testing.assert_allclose(moved / np.linalg.norm(moved), pane.toward, atol=1e-12)
    voxels = np.linalg.inv(AFFINE[:3, :3]) @ moved
    assert abs(voxels).max() == pytest.approx(1.0)


def test_the_widget_turns_and_pushes_it_and_follows(five, workspace):
    widget = five.widgets.plane_widgets[0]
    assert widget.GetCurrentRenderer() is five.renderers[3]
    widget.SetNormal(0.0, 0.6, 0.8)
    widget.SetOrigin(5.0, -3.0, 8.0)
    widget.InvokeEvent("InteractionEvent")
    np.testing.assert_allclose(workspace.oblique.normal, [0.0, 0.6, 0.8])
    np.testing.assert_allclose(workspace.position, [5.0, -3.0, 8.0])
    workspace.oblique.normal = NORMAL
    workspace.position = (1.0, 2.0, 3.0)
    np.testing.assert_allclose(widget.GetNormal(), NORMAL, atol=1e-6)
    np.testing.assert_allclose(widget.GetOrigin(), [1.0, 2.0, 3.0])
    workspace.oblique.visible = False
    assert not widget.GetEnabled()


def test_without_a_fifth_view_it_has_no_pane_and_turns_all_the_same():
    plotter = pv.Plotter(off_screen=True, window_size=(400, 400), shape=(2, 2), border=False)
    workspace = plotter.slices.workspace((ramp(), AFFINE))
    oblique = workspace.add_oblique((0, 0.6, 0.8), widget=False)
    assert oblique.pane is None
    assert set(workspace.panes) == {"axial", "coronal", "sagittal"}
    with pytest.raises(ValueError, match="no such pane"):
        workspace.layout = "oblique"
    with pytest.raises(ValueError, match="already"):
        workspace.add_oblique()
    plotter.show(auto_close=False)
    middle, handle = handle_of(workspace, "sagittal")
    away = handle - middle
    Mouse(plotter).drag("Left", np.rint(handle), np.rint(middle + [-away[1], away[0]]))
    np.testing.assert_allclose(abs(oblique.normal), [0.0, 0.8, 0.6], atol=0.02)
    workspace.remove()
    plotter.close()


@pytest.mark.parametrize("aspect", [0.6, 1.5])
def test_views_of_a_layout_fill_the_window_and_do_not_overlap(aspect):
    for layout in LAYOUTS:
        boxes = list(viewports(layout, aspect, oblique=True).values())
        area = sum((right - left) * (top - bottom) for left, bottom, right, top in boxes)
        assert area == pytest.approx(1.0)
        for n, a in enumerate(boxes):
            for b in boxes[n + 1 :]:
                assert min(a[2], b[2]) - max(a[0], b[0]) < 1e-9 or min(a[3], b[3]) - max(a[1], b[1]) < 1e-9


def test_a_hidden_oblique_slice_gives_its_place_to_the_others(five, workspace):
    workspace.layout = "oblique"
    assert [one.GetDraw() for one in five.renderers] == [0, 0, 0, 0, 1]
    workspace.oblique.visible = False
    assert [one.GetDraw() for one in five.renderers] == [1, 1, 1, 1, 0]
    workspace.layout = "grid"
    workspace.oblique.visible = True
    assert [one.GetDraw() for one in five.renderers] == [1, 1, 1, 1, 1]
