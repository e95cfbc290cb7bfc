"""Depth of other actors, as the fiblets' mapper finds it at the moment it draws, against what VTK says itself."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkFloatArray
from vtkmodules.vtkRenderingCore import vtkMapper

from pvfiblets.mappers import fiblets as mapper_module
from pvfiblets.mappers import windows
from pvfiblets.mappers.scene_depth import OutsideDepth

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


def test_the_depth_of_what_was_added_before_is_there(make_plotter, plain, tools, seen):
    plotter, mapper = scene(make_plotter, plain, ["sphere", "fiblets"])
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


def test_what_was_added_later_is_not(make_plotter, plain, tools, seen):
    plotter, mapper = scene(make_plotter, plain, ["fiblets", "sphere"])
    tools.picture(plotter, mapper)
    assert (seen[-1][0] == EMPTY).all()


def test_a_pixel_is_covered_only_if_all_its_samples_are(make_plotter, plain, tools, seen):
    """A pixel of an unlit white sphere on black is pure white where, and only where, all samples are."""
    plotter, mapper = scene(make_plotter, plain, ["sphere", "fiblets"], lambda p: p.enable_anti_aliasing("msaa"))
    mapper.actor.SetVisibility(True)
    tools.picture(plotter, mapper)
    keys, error = seen[-1]
    assert error == "GL_NO_ERROR"
    alone, _ = scene(make_plotter, plain, ["sphere"], lambda p: p.enable_anti_aliasing("msaa"))
    image = tools.picture(alone)[::-1]
    edge = (image[..., 0] > 0) & (image[..., 0] < 255)
    assert edge.sum() > 20, "there must be pixels that are covered in part"
    np.testing.assert_array_equal(keys != EMPTY, image[..., 0] == 255)


def test_depth_peeling_has_none(make_plotter, plain, tools, seen):
    plotter, mapper = scene(make_plotter, plain, ["sphere", "fiblets"], lambda p: p.enable_depth_peeling())
    mapper.actor.GetProperty().SetOpacity(0.5)
    tools.picture(plotter, mapper)
    assert [(keys, error) for keys, error in seen if keys is None] == [(None, "GL_NO_ERROR")] * len(seen)
    assert seen


def test_none_where_vtk_moves_depth_afterwards(make_plotter, plain, tools, seen):
    plotter, mapper = scene(make_plotter, plain, ["sphere", "fiblets"])
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
