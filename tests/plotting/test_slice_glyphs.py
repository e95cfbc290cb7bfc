"""Glyphs on slices, and slices at any angle."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv

import pvfiblets.plotting  # noqa: F401 - registers the components


@pytest.fixture
def peaks():
    values = np.zeros((9, 10, 11, 6), np.float32)
    values[2:7, 3:8, 4:9, 0] = 1.0
    return values, np.diag([2.0, 2.0, 2.0, 1.0])


def test_glyphs_follow_the_slices_and_only_those_that_are_shown_are_made(plotter, peaks):
    slices = plotter.add_slices((peaks[0][..., 0], peaks[1]), position=(8.0, 10.0, 12.0))
    found = slices.add_glyphs(peaks)
    slices["coronal"].visible = slices["sagittal"].visible = False
    assert found.n_glyphs == 0
    plotter.show(auto_close=False)
    assert found.n_glyphs == 25
    slices.position = (8.0, 10.0, 2.0)
    plotter.render()
    assert found.n_glyphs == 0
    slices["sagittal"].visible = True
    plotter.render()
    assert found.n_glyphs == 25
    found.remove()
    assert len(plotter.actors) == 3


@pytest.mark.parametrize(("kind", "n"), [("peaks", 3), ("tensor", 6), ("sh", 6), ("sh", 45)])
def test_every_kind_is_seen_in_its_colour(plotter, kind, n):
    values = np.zeros((7, 7, 7, n))
    values[3, 3, 3, 0] = 1.0  # along x; of harmonics the same in all directions
    if kind == "tensor":
        values[3, 3, 3, 1:3] = 0.2
    slices = plotter.add_slices(np.zeros((7, 7, 7)), clim=(0, 1), planes="axial")
    slices.add_glyphs((values, np.eye(4)), kind, size=4.0, line_width=4)
    plotter.view_xy()
    plotter.show(auto_close=False)
    picture = plotter.screenshot(return_img=True).astype(int)
    if kind == "sh":
        assert (picture.max(axis=2) > 60).sum() > 1000
    else:
        red = (picture[..., 0] > 60) & (picture[..., 1:].max(axis=-1) < 40)
        assert 60 < red.sum() < 3000
        assert red[100].sum() > 60


def test_glyphs_of_other_numbers_are_refused(plotter, peaks):
    slices = plotter.add_slices((peaks[0][..., 0], peaks[1]))
    for arguments, said in (
        ({"kind": "tensors"}, "kind is"), ({"kind": "sh", "basis": "x"}, "basis is"), ({"size": 0}, "size is"),
        ({"kind": "tensor", "tensor": "x"}, "tensor is"),
    ):  # fmt: skip
        with pytest.raises(ValueError, match=said):
            slices.add_glyphs(peaks, **arguments)
    with pytest.raises(ValueError, match="peaks are three each"):
        slices.add_glyphs(peaks[0][..., :4])
    assert len(plotter.actors) == 3


def test_a_workspace_shows_glyphs_in_its_panes(peaks):
    plotter = pv.Plotter(off_screen=True, window_size=(200, 200), shape=(2, 2))
    workspace = plotter.slices.workspace((peaks[0][..., 0], peaks[1]), layout="axial")
    workspace.position = (8.0, 10.0, 12.0)
    found = workspace.slices.add_glyphs(peaks)
    plotter.show(auto_close=False)
    assert found.n_glyphs == 25  # the one pane's
    workspace.layout = "row"
    plotter.render()
    assert found.n_glyphs == 6 * 25  # three panes' and three slices' of the 3-D view
    plotter.close()


def test_an_oblique_slice_is_where_its_widget_is(plotter):
    at = np.stack(np.mgrid[:20, :20, :20], axis=-1)
    slices = plotter.add_slices(at.sum(axis=-1).astype(np.float32), clim=(0, 57), planes=())
    plane = plotter.slices.add_oblique(normal=(1, 1, 1))
    assert np.ptp(slices.pixels(plane.grid)[..., 0][slices.pixels(plane.grid)[..., 3] > 0]) <= 8
    (widget,) = plotter.widgets.plane_widgets
    widget.SetOrigin(5.0, 5.0, 5.0)
    widget.SetNormal(0.0, 0.0, 1.0)
    widget.InvokeEvent("InteractionEvent")
    np.testing.assert_allclose(plane.normal, (0, 0, 1), atol=1e-9)
    np.testing.assert_allclose(plane.origin, (5, 5, 5))
    np.testing.assert_allclose(plane.grid.positions()[..., 2], 5.0, atol=1e-9)
    with pytest.raises(ValueError, match="another plane has"):
        plotter.slices.add_oblique()
