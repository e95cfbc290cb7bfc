"""Views of a workspace in which nothing has changed keep their picture, and show what drawing them would show."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv
from PIL import Image
from vtkmodules.vtkRenderingCore import vtkHardwareSelector

import pvfiblets.plotting  # noqa: F401 - registers the components
from pvfiblets.engine import FibletRenderer
from pvfiblets.streamlines import Streamlines

ALL = {"axial", "coronal", "sagittal", "3d"}


@pytest.fixture
def four():
    plotter = pv.Plotter(off_screen=True, window_size=(320, 320), shape=(2, 2))
    plotter.set_background("black", all_renderers=True)
    yield plotter
    plotter.close()


@pytest.fixture
def workspace(four):
    x, y, z = np.mgrid[-12:12, -14:14, -10:10]
    affine = np.diag([2.0, 2.0, 2.0, 1.0])
    affine[:3, 3] = -24, -28, -20
    made = four.slices.workspace((np.exp(-(x**2 + y**2 + z**2) / 60.0), affine), clim=(0, 1))
    steps = np.linspace(-15.0, 15.0, 31)
    lines = [np.stack([steps, np.full(31, k), 0.1 * k * steps], axis=1) for k in range(-12, 13, 2)]
    four.add_fiblets(Streamlines.from_list(lines), scalars="length", name="lines")
    four.add_mesh(pv.Sphere(radius=6.0, center=(0, 0, 12)), name="ball")
    made.add_contours(pv.Sphere(radius=9.0), "lime", name="ring")
    four.show(auto_close=False)
    four.render()
    return made


def drawn(four, workspace, change):
    """Make a change and a frame; return which views were drawn, and the picture as bytes a pixel."""
    names = {renderer.GetAddressAsString(""): name for name, renderer in workspace._renderers.items()}
    before = dict(workspace._kept.frames)
    change()
    four.render()
    after = workspace._kept.frames
    return {names[one] for one in after if after[one] > before[one]}, four.screenshot(return_img=True)


def whole(four, workspace):
    """Return the picture when all views are drawn."""
    workspace._kept.forget()
    four.render()
    return four.screenshot(return_img=True)


def turned(four, _):
    four.subplot(1, 1)
    four.camera.Azimuth(25)


def colour(four, _):
    four.actors["ball"].prop.color = "red"


def line_width(four, _):
    next(iter(four.fiblets)).line_width = 4


def title(four, _):
    four.subplot(1, 1)
    four.add_text("a title", name="title")


def bright(four, _):
    four.subplot(0, 1)
    four.picture.gamma = 1.5


def light(four, _):
    four.subplot(1, 1)
    four.renderer.lights[0].intensity = 0.4


CHANGES = [
    (lambda *_: None, set()),
    (turned, {"3d"}),
    (colour, {"3d"}),
    (title, {"3d"}),
    (light, {"3d"}),
    (bright, {"coronal"}),
    (line_width, ALL),
    (lambda _, w: setattr(w.panes["axial"], "zoom", 2.0), {"axial"}),
    (lambda _, w: w.panes["coronal"].pan_by(10, 4), {"coronal"}),
    (lambda _, w: setattr(w, "position", (4.0, 2.0, 6.0)), ALL),
    (lambda _, w: setattr(w.slices.layers[0], "cmap", "hot"), ALL),
    (lambda _, w: setattr(w, "thickness", 9.0), ALL),
    (lambda _, w: setattr(w, "cross_hair", False), {"axial", "coronal", "sagittal"}),
    (lambda _, w: w.remove_contours("ring"), {"axial", "coronal", "sagittal"}),
    (lambda _, w: setattr(w, "layout", "axial"), {"axial"}),
    (lambda _, w: setattr(w, "layout", "grid"), ALL),
    (lambda f, _: f.remove_actor("lines"), ALL),
    (lambda f, _: setattr(f, "window_size", (280, 300)), ALL),
]


def test_only_what_changed_is_drawn_and_the_picture_is_that_of_all(four, workspace):
    whole(four, workspace)
    for n, (change, expected) in enumerate(CHANGES):
        found, picture = drawn(four, workspace, lambda change=change: change(four, workspace))
        assert found == expected, n
        np.testing.assert_array_equal(picture, whole(four, workspace), err_msg=str(n))
    first = whole(four, workspace)
    selector = vtkHardwareSelector()  # leaves nothing behind
    selector.SetRenderer(workspace._renderers["3d"])
    selector.SetArea(140, 0, 279, 149)
    assert selector.Select().GetNumberOfNodes() > 0
    four.render()
    np.testing.assert_array_equal(four.screenshot(return_img=True), first)


@pytest.mark.more
def test_enlarged_pictures_leave_nothing_behind(four, workspace):
    first = whole(four, workspace)
    for samples in ("off", 2):  # a tile has no part of some views
        for at in range(4):
            four.subplot(*divmod(at, 2))
            four.picture.antialias = samples
        large = four.screenshot(return_img=True, scale=2)
        small = np.asarray(Image.fromarray(large).resize((320, 320), Image.Resampling.BOX))
        assert abs(small.astype(int) - first).mean() < 6.0
        four.render()
        np.testing.assert_array_equal(four.screenshot(return_img=True), whole(four, workspace))


def test_pictures_at_rest_are_refined_all_the_same(four, workspace):
    for at in range(4):
        four.subplot(*divmod(at, 2))
        four.picture.antialias = 4
    found, picture = drawn(four, workspace, lambda: turned(four, workspace))
    assert "3d" in found
    while four.picture.refine():
        pass
    for at in range(4):
        four.subplot(*divmod(at, 2))
        assert four.picture.samples == 4
    picture = four.screenshot(return_img=True)
    np.testing.assert_array_equal(picture, whole(four, workspace))


def test_pictures_at_rest_are_refined_view_by_view(four, workspace):
    for at in range(4):
        four.subplot(*divmod(at, 2))
        four.picture.antialias = 4
    four.render()
    counts = []
    more = True
    while more:  # whoever waits for the window waits for one view
        before = sum(workspace._kept.frames.values())
        more = four.picture.refine()
        counts.append(sum(workspace._kept.frames.values()) - before)
    assert max(counts) == 1
    assert sum(counts) >= 16


def test_all_views_are_drawn_once_the_workspace_has_stopped(four, workspace):
    workspace.stop()
    four.render()
    assert workspace._kept is None
    assert all(one.GetDraw() for one in workspace._renderers.values())


MOVES = [  # of the cross-hair or something else, and how many views draw their lines again: those whose slab moved
    (lambda _, w: setattr(w, "position", w.position + (5.0, 3.0, 0.0)), 2),
    (lambda _, w: w.step("axial", toward=1), 1),
    (lambda _, w: w.step("sagittal", up=2), 1),
    (colour, 0),
    (lambda _, w: setattr(w.slices.layers[0], "cmap", "hot"), 0),
    (lambda _, w: w.panes["coronal"].pan_by(10, 4), 1),
    (turned, 1),
    (line_width, 4),
]


@pytest.mark.parametrize("antialias", ["off", "coverage"])
def test_lines_are_drawn_again_where_the_slab_has_moved(four, workspace, monkeypatch, antialias):
    for at in range(4):
        four.subplot(*divmod(at, 2))
        four.picture.antialias = antialias
    for shift in (1.0, 2.0):  # the first frame of a camera leaves out what meshes hide
        workspace.position = workspace.position + shift
        four.render()
    views, steps = [], FibletRenderer._steps

    def counted(self, view, *args, **more):
        views.append(view)
        return steps(self, view, *args, **more)

    monkeypatch.setattr(FibletRenderer, "_steps", counted)
    for n, (change, expected) in enumerate(MOVES):
        views.clear()
        _, picture = drawn(four, workspace, lambda change=change: change(four, workspace))
        assert len(views) == expected, n
        four.render()
        with monkeypatch.context() as patch:
            patch.setattr("pvfiblets.mappers.frames.scene.PICTURES_PER_WINDOW", 0.0)
            np.testing.assert_array_equal(picture, whole(four, workspace), err_msg=str(n))
        for _ in range(2):
            whole(four, workspace)


def test_a_pixel_of_any_view_is_picked_without_drawing_lines_again(four, workspace, monkeypatch):
    actor = next(iter(four.fiblets))
    for _ in range(2):
        whole(four, workspace)
    before = [actor.mapper.pick_at(*_middle(one), renderer=one, tolerance=40) for one in four.renderers]
    assert None not in before
    monkeypatch.setattr(FibletRenderer, "_steps", None)
    again = [actor.mapper.pick_at(*_middle(one), renderer=one, tolerance=40) for one in four.renderers]
    assert again == before


def _middle(renderer):
    return [at + 0.5 * size for at, size in zip(renderer.GetOrigin(), renderer.GetSize(), strict=True)]
