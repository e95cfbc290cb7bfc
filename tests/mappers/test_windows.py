"""Windows, renderers and the life of GL objects."""

from __future__ import annotations

import gc

import numpy as np
import pytest
import pyvista as pv
from vtkmodules.vtkRenderingCore import vtkActor, vtkRenderer, vtkRenderWindow

from pvfiblets.mappers import Colouring, FibletMapper
from pvfiblets.mappers.frames import windows


def yellow(image):
    return (image[..., 0] > 100) & (image[..., 1] > 100) & (image[..., 2] < 100)


SOLID = Colouring("solid", color=(1.0, 1.0, 0.0))


def test_a_window_resize(compare, tools):
    def scene(plotter, actor, mapper):
        plotter.reset_camera()
        plotter.show(auto_close=False)
        plotter.window_size = (300, 140)

    ours, theirs = compare(scene)
    assert ours.shape == (140, 300, 3)
    assert tools.agreement(tools.covered(ours), tools.covered(theirs)) >= 0.99


def test_several_actors_in_one_renderer(make_plotter, make_fibres, tools):
    sets = [make_fibres(tools.helices(8, 60, seed)) for seed in range(3)]
    colours = [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)]
    ours, theirs = make_plotter(), make_plotter()
    mappers = []
    for fibres, colour in zip(sets, colours, strict=True):
        mapper, actor = fibres.actor(colouring=Colouring("solid", color=colour))
        ours.add_actor(actor)
        mappers.append(mapper)
        theirs.add_mesh(fibres.polydata(), color=colour, lighting=False)
    for plotter in (ours, theirs):
        plotter.camera_position = "xz"
    one, other = tools.picture(ours, *mappers), tools.picture(theirs)
    for channel in range(3):
        assert tools.agreement(one[..., channel] > 100, other[..., channel] > 100) >= 0.985


@pytest.mark.parametrize("drawn_before", [True, False])
def test_one_actor_in_two_windows_is_drawn_in_both(make_plotter, lines, tools, drawn_before):
    """All windows of EGL's say that they are current; VTK's own mapper leaves one of the two blank."""
    mapper, actor = lines.actor()
    alone = make_plotter()
    alone.add_actor(actor)
    expected = tools.picture(alone, mapper)
    alone.remove_actor(actor)
    first, second = make_plotter(), make_plotter()
    first.add_actor(actor)
    if drawn_before:
        assert np.array_equal(tools.picture(first, mapper), expected)
    second.add_actor(actor)
    for plotter in (second, first, second, first):
        assert np.array_equal(tools.picture(plotter, mapper), expected)
    second.remove_actor(actor)
    second.close()
    assert np.array_equal(tools.picture(first, mapper), expected)


def test_a_window_that_is_finalised_and_drawn_again(lines, tools):
    """The same vtkRenderWindow gets a new GL context, in which old names mean nothing."""
    mapper, actor = lines.actor()
    window, renderer = vtkRenderWindow(), vtkRenderer()
    window.SetOffScreenRendering(1)
    window.SetSize(200, 160)
    window.AddRenderer(renderer)
    renderer.AddActor(actor)
    renderer.ResetCamera()
    depths = []
    for _ in range(3):
        window.Render()
        tools.check(mapper)
        renderer.SetWorldPoint(*map(float, lines.reference[0][75]), 1.0)
        picked = mapper.pick_at(100, 80, tolerance=60)
        assert picked is not None
        depths.append(picked)
        assert len(windows._contexts) == 1
        window.Finalize()
    assert depths[0] == depths[1] == depths[2]
    mapper.release()
    window.RemoveRenderer(renderer)
    del window, renderer
    gc.collect()
    assert not windows._contexts


def test_memory_is_returned_by_remove_actor_and_by_release(make_plotter, lines, tools, renderers):
    mapper, actor = lines.actor()
    plotter = make_plotter()
    plotter.add_mesh(pv.Sphere())
    plotter.add_actor(actor)
    first = tools.picture(plotter, mapper)
    assert not renderers[-1].released
    actor.SetVisibility(False)
    assert not np.array_equal(tools.picture(plotter, mapper), first)
    actor.SetVisibility(True)
    plotter.remove_actor(actor)
    plotter.render()
    assert renderers[-1].released
    assert not windows._contexts
    plotter.add_actor(actor)
    assert np.array_equal(tools.picture(plotter, mapper), first)
    assert len(renderers) == 2
    mapper.release(plotter.render_window)
    assert renderers[-1].released
    mapper.release()
    mapper.release(plotter.render_window)
    assert np.array_equal(tools.picture(plotter, mapper), first)
    plotter.close()
    mapper.release()


def test_a_mapper_that_python_forgot_draws_and_dies_with_its_actor(make_plotter, lines, tools, renderers):
    plotter = make_plotter()

    def add():
        mapper, actor = lines.actor()
        plotter.add_actor(actor)
        return actor, mapper.GetAddressAsString("")

    actor, address = add()
    gc.collect()
    assert tools.picture(plotter).any()
    plotter.add_mesh(pv.Sphere())
    plotter.remove_actor(actor, render=False)
    del actor
    gc.collect()
    # By type: `isinstance` asks dead proxies of other libraries, which raise.
    mappers = [thing for thing in gc.get_objects() if issubclass(type(thing), FibletMapper)]
    assert all(mapper.GetAddressAsString("") != address for mapper in mappers), "something keeps the mapper alive"
    plotter.render()
    assert renderers[-1].released


def test_the_g_buffer_is_made_once_per_camera(make_plotter, lines, tools, renderers):
    mapper, actor = lines.actor()
    plotter = make_plotter()
    plotter.add_actor(actor)
    actor.GetProperty().SetOpacity(0.5)
    plotter.enable_depth_peeling()
    tools.picture(plotter, mapper)
    draws = renderers[-1]._generation
    assert draws <= 2  # the camera is reset between the first frames
    for _ in range(3):
        tools.picture(plotter, mapper)
    assert renderers[-1]._generation == draws
    plotter.camera.azimuth += 5
    tools.picture(plotter, mapper)
    assert renderers[-1]._generation == draws + 1


def test_a_failing_draw_is_raised_by_the_caller(make_plotter, lines, tools, monkeypatch):
    mapper, actor = lines.actor()
    plotter = make_plotter()
    plotter.add_actor(actor)
    whole = tools.picture(plotter, mapper)

    def broken(*_):
        raise MemoryError("no memory")

    with monkeypatch.context() as patched:
        patched.setattr(type(mapper), "_draw", broken)
        for _ in range(2):
            plotter.render()
            with pytest.raises(MemoryError, match="no memory"):
                mapper.raise_pending()
            assert not np.asarray(plotter.screenshot(return_img=True)).any(), "a failed draw shows nothing"
        mapper.raise_pending()
    assert np.array_equal(tools.picture(plotter, mapper), whole)


def test_a_mapper_of_two_actors_raises(make_plotter, lines):
    mapper, actor = lines.actor()
    twin = vtkActor()
    twin.ShallowCopy(actor)
    plotter = make_plotter()
    plotter.add_actor(actor)
    plotter.add_actor(twin)
    plotter.show(auto_close=False)
    with pytest.raises(RuntimeError, match="2 actors have this mapper.*ShallowCopy"):
        mapper.raise_pending()
