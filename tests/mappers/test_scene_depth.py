"""Depth of other actors, against what VTK says itself; what they hide is culled, and comes back."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkFloatArray
from vtkmodules.vtkRenderingCore import vtkMapper

import pvfiblets
from pvfiblets.mappers import fiblets as mapper_module
from pvfiblets.mappers.frames import windows
from pvfiblets.mappers.frames.scene_depth import OutsideDepth
from pvfiblets.synthetic import brain_streamlines

EMPTY = 0xFFFFFFFF
SCALE = 2.0**32


@pytest.fixture
def seen(monkeypatch):
    """Return a list that takes, for each draw of a mapper, the copied keys or None, with the GL error after it."""
    found = []
    draw = mapper_module.FibletMapper._draw

    def spy(self, program):
        context = windows.context_of(self._active.find(self.actor).GetRenderWindow())
        viewport = windows.gl_viewport(context.window)
        with context.foreign():
            outside = OutsideDepth(context.ctx)
            texture = outside.copy(viewport)
            keys = None
            if texture is not None:
                keys = np.frombuffer(texture.read(alignment=1), "u4").reshape(viewport[3], viewport[2])
            found.append((keys, context.ctx.error))
            outside.release()
            outside.release()
        return draw(self, program)

    monkeypatch.setattr(mapper_module.FibletMapper, "_draw", spy)
    return found


def scene(make_plotter, fibres, order, setup=None, **options):
    """Show a white sphere and fiblets, added in some order; return the plotter and the mapper."""
    plotter = make_plotter(**options)
    mapper, actor = fibres.actor()
    for what in order:
        if what == "fiblets":
            plotter.add_actor(actor, reset_camera=False)
        else:
            plotter.add_mesh(pv.Sphere(radius=25.0), color="white", lighting=False, reset_camera=False)
    plotter.camera_position = [(60, -150, 70), (0, 0, 0), (0, 0, 1)]
    plotter.renderer.ResetCameraClippingRange((-60, 60, -60, 60, -60, 60))
    if setup is not None:
        setup(plotter)
    return plotter, mapper


def depth_of_sphere(make_plotter, camera):
    """Return VTK's own depth buffer of the sphere alone, between the same near and far planes."""
    planes = camera.clipping_range
    plotter = make_plotter()
    plotter.add_mesh(pv.Sphere(radius=25.0), lighting=False, reset_camera=False)
    plotter.camera = camera
    plotter.show(auto_close=False)
    plotter.camera.clipping_range = planes
    plotter.render_window.Render()
    assert plotter.camera.clipping_range == planes
    width, height = plotter.window_size
    data = vtkFloatArray()
    plotter.render_window.GetZbufferData(0, 0, width - 1, height - 1, data)
    return vtk_to_numpy(data).reshape(height, width)


def test_the_depth_of_what_was_added_before_is_there(make_plotter, lines, tools, seen):
    plotter, mapper = scene(make_plotter, lines, ["sphere", "fiblets"])
    tools.picture(plotter, mapper)
    keys, error = seen[-1]
    assert error == "GL_NO_ERROR"
    reference = depth_of_sphere(make_plotter, plotter.camera.copy())
    covered = keys != EMPTY
    assert covered.sum() > 500
    np.testing.assert_array_equal(covered, reference < 1.0)
    behind = keys[covered] / SCALE - reference[covered]
    assert behind.min() > 2.0**-25, "VTK's rounding of depth must not make hidden what it would show"
    assert behind.max() < 1e-6


def test_what_was_added_later_is_not(make_plotter, lines, tools, seen):
    plotter, mapper = scene(make_plotter, lines, ["fiblets", "sphere"])
    tools.picture(plotter, mapper)
    assert (seen[-1][0] == EMPTY).all()


def test_a_pixel_is_covered_only_if_all_its_samples_are(make_plotter, lines, tools, seen):
    """A pixel of an unlit white sphere on black is pure white where, and only where, all samples are."""
    plotter, mapper = scene(make_plotter, lines, ["sphere", "fiblets"], lambda p: p.enable_anti_aliasing("msaa"))
    mapper.actor.SetVisibility(True)
    tools.picture(plotter, mapper)
    keys, error = seen[-1]
    assert error == "GL_NO_ERROR"
    alone, _ = scene(make_plotter, lines, ["sphere"], lambda p: p.enable_anti_aliasing("msaa"))
    image = tools.picture(alone)[::-1]
    edge = (image[..., 0] > 0) & (image[..., 0] < 255)
    assert edge.sum() > 20, "there must be pixels that are covered in part"
    np.testing.assert_array_equal(keys != EMPTY, image[..., 0] == 255)


def test_depth_peeling_has_none(make_plotter, lines, tools, seen):
    plotter, mapper = scene(make_plotter, lines, ["sphere", "fiblets"], lambda p: p.enable_depth_peeling())
    mapper.actor.GetProperty().SetOpacity(0.5)
    tools.picture(plotter, mapper)
    assert [(keys, error) for keys, error in seen if keys is None] == [(None, "GL_NO_ERROR")] * len(seen)
    assert seen


def test_none_where_vtk_moves_depth_afterwards(make_plotter, lines, tools, seen):
    plotter, mapper = scene(make_plotter, lines, ["sphere", "fiblets"])
    before = vtkMapper.GetResolveCoincidentTopology()
    try:
        vtkMapper.SetResolveCoincidentTopologyToPolygonOffset()
        tools.picture(plotter, mapper)
    finally:
        vtkMapper.SetResolveCoincidentTopology(before)
    assert seen[-1] == (None, "GL_NO_ERROR")


@pytest.mark.parametrize("depth", [0.0, 0.5, 0.999999, 1.0 - 2.0**-24, 1.0])
def test_no_depth_becomes_the_key_of_nothing_by_overflow(make_plotter, depth):
    """The shader itself, on a depth that is known: near 1 the margin must empty the pixel, not wrap it to 0."""
    # In a window's context: the session's own does not outlive the first VTK window that is closed.
    with windows.borrowed_context(make_plotter().render_window) as context:
        picture = context.depth_texture((1, 1), np.float32(depth).tobytes())
        framebuffer = context.framebuffer([], picture)
        with context.scope(framebuffer):
            outside = OutsideDepth(context)
            key = int(np.frombuffer(outside.copy((0, 0, 1, 1)).read(), "u4")[0])
            outside.release()
        assert context.error == "GL_NO_ERROR"
        framebuffer.release()
        picture.release()
    assert key == EMPTY or key / SCALE > depth
    assert (key == EMPTY) == (depth > 1.0 - 2.0**-23)


@pytest.fixture(scope="module")
def fiblets():
    return pvfiblets.compress(brain_streamlines(600, 0.5, 3))


def behind_a_wall(fiblets, *, wall_first=True, culling="two-phase", samples=0):
    """A wall in front of most of a brain."""
    plotter = pv.Plotter(off_screen=True, window_size=(320, 240))
    plotter.set_background("black")
    if not samples:
        plotter.disable_anti_aliasing()
    plane = pv.Plane(center=(0, -140, 10), direction=(0, 1, 0), i_size=150, j_size=150, i_resolution=1, j_resolution=1)
    if wall_first:
        wall = plotter.add_mesh(plane, color="white", render=False)
    actor = plotter.add_fiblets(fiblets, culling=culling, render=False)
    if not wall_first:
        wall = plotter.add_mesh(plane, color="white", render=False)
    plotter.camera_position = [(0, -450, 10), (0, -18, 10), (0, 0, 1)]
    plotter.reset_camera_clipping_range()
    plotter.show(auto_close=False)
    return plotter, actor, wall


def turn(plotter, degrees):
    plotter.camera.azimuth += degrees
    plotter.render()
    return plotter.screenshot(None, return_img=True)


@pytest.mark.few(1)
@pytest.mark.parametrize("samples", [0, 4])
@pytest.mark.parametrize("wall_first", [True, False])
def test_pictures_are_those_without_culling(fiblets, wall_first, samples):
    culled, actor, wall = behind_a_wall(fiblets, wall_first=wall_first, samples=samples)
    whole, _, other_wall = behind_a_wall(fiblets, wall_first=wall_first, culling=None, samples=samples)
    for move in range(8):
        for it in (wall, other_wall):
            if move == 3:
                it.SetVisibility(False)
            if move == 4:
                it.SetVisibility(True)
            if move == 6:
                it.SetPosition(40, 0, 0)
        a, b = (turn(plotter, 3.0 if move % 2 else 0.0) for plotter in (culled, whole))
        assert (a == b).all(), f"move {move}"
    actor.prop.line_width = 4
    culled.render()
    culled.close()
    whole.close()


def drawn(actor):
    """Fiblets in the plan of the last redraw."""
    return actor.explain()["fiblets"]["drawn"]


def test_less_is_drawn_behind_a_wall(fiblets):
    shares = {}
    for wall_first in (True, False):
        plotter, actor, _ = behind_a_wall(fiblets, wall_first=wall_first)
        turn(plotter, 2.0)
        turn(plotter, 2.0)
        shares[wall_first] = drawn(actor) / fiblets.n_fiblets
        plotter.close()
    assert shares[True] < 0.7 * shares[False]


def test_picking_looks_behind_the_wall(fiblets):
    plotter, actor, _ = behind_a_wall(fiblets)
    turn(plotter, 2.0)
    with_wall = actor.mapper.pick_at(160, 120, tolerance=3)
    plotter.close()
    free, other, _ = behind_a_wall(fiblets, wall_first=False)
    turn(free, 2.0)
    assert with_wall == other.mapper.pick_at(160, 120, tolerance=3)
    assert np.isfinite(with_wall[1])
    free.close()
