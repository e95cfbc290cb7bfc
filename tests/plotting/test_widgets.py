"""Widgets and slabs that cut: what dragging does, driven as VTK's events drive it, without a display."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv

from pvfiblets import compress, regions
from pvfiblets.synthetic import brain_streamlines

RNG = np.random.default_rng(0)
PLACES = RNG.uniform(-80, 80, (4000, 3))


@pytest.fixture
def shown():
    """A plotter that shows a small brain."""
    plotter = pv.Plotter(off_screen=True, window_size=(200, 160))
    actor = plotter.add_fiblets(compress(brain_streamlines(300, seed=4)))
    plotter.show(auto_close=False)
    yield plotter, actor
    plotter.close()


def same(region, expected):
    np.testing.assert_array_equal(region.contains(PLACES), expected.contains(PLACES))


def test_a_plane_follows_its_widget(shown):
    plotter, actor = shown
    widget = plotter.fiblets.add_clip_plane_widget(normal="x", origin=(5.0, 0.0, 0.0))
    (name,) = actor.clips
    same(actor.clips[name], regions.Plane((1.0, 0.0, 0.0), (5.0, 0.0, 0.0)))
    plotter.render()
    buffers = {row["name"]: row["bytes"] for row in actor.explain()["buffers"]}
    renderer = actor.mapper._renderers()[0]
    generation = renderer._buffer.generation
    for shift in (10.0, 12.0):
        widget.SetOrigin(shift, 1.0, 2.0)
        widget.SetNormal(0.6, 0.8, 0.0)
        widget.InvokeEvent("InteractionEvent")
        plotter.render()
        same(actor.clips[name], regions.Plane((0.6, 0.8, 0.0), (shift, 1.0, 2.0)))
    assert list(actor.clips) == [name]
    assert actor.mapper._renderers()[0] is renderer, "the engine's renderer was made anew"
    assert renderer._buffer.generation == generation + 2
    assert {row["name"]: row["bytes"] for row in actor.explain()["buffers"]} == buffers
    plotter.fiblets.clear_widgets()
    assert not actor.clips
    assert not plotter.widgets.plane_widgets
    plotter.fiblets.add_clip_plane_widget(actor, normal="-z", origin=(0.0, 0.0, 3.0), invert=True, name="top")
    same(actor.clips["top"], ~regions.Plane((0.0, 0.0, -1.0), (0.0, 0.0, 3.0)))
    plotter.fiblets.add_clip_plane_widget(actor, normal="y", name="top")  # takes its place
    assert list(actor.clips) == ["top"]
    assert len(plotter.widgets.plane_widgets) == 1
    plotter.fiblets.clear_widgets()
    assert "CLIP_REGION" not in actor.explain()["features"]


def test_a_box_may_be_turned(shown):
    plotter, actor = shown
    bounds = (-30.0, 20.0, -25.0, 35.0, -10.0, 40.0)
    widget = plotter.fiblets.add_clip_box_widget(bounds=bounds, name="box")
    same(actor.clips["box"], regions.Box(bounds))
    import vtkmodules.vtkCommonTransforms as transforms

    turn = transforms.vtkTransform()
    turn.Translate(4.0, -3.0, 2.0)
    turn.RotateWXYZ(33.0, 1.0, 2.0, 3.0)
    widget.SetTransform(turn)
    widget.InvokeEvent("InteractionEvent")
    matrix = np.array([[turn.GetMatrix().GetElement(i, j) for j in range(4)] for i in range(4)])
    same(actor.clips["box"], regions.Box(bounds).moved(matrix))
    plotter.fiblets.clear_widgets()
    assert not actor.clips
    assert not plotter.widgets.box_widgets


def test_a_slab_shows_the_slice_of_a_volume(shown):
    plotter, actor = shown
    volume = pv.ImageData(dimensions=(20, 20, 20), spacing=(8, 8, 8), origin=(-76, -76, -76))
    volume["values"] = np.arange(8000, dtype=float)
    slab = plotter.fiblets.add_slab(normal="z", origin=(0, 0, 10), thickness=6.0, volume=volume)
    same(actor.clips[slab.name], regions.Slab((0, 0, 1), (0, 0, 10), 6.0))
    assert slab.slice_actor in plotter.actors.values()
    slab.position = 22.0
    assert slab.position == pytest.approx(22.0)
    slab.thickness = 2.0
    same(actor.clips[slab.name], regions.Slab((0, 0, 1), (0, 0, 22.0), 2.0))
    low, high = slab.slice_actor.bounds[4:]
    assert low == pytest.approx(22.0)
    assert high == pytest.approx(22.0)
    plotter.render()
    slab.normal = "y"
    same(actor.clips[slab.name], regions.Slab((0, 1, 0), slab.origin, 2.0))
    with pytest.raises(ValueError, match="thickness"):
        slab.thickness = -1.0
    assert slab.thickness == 2.0
    slab.remove()
    slab.remove()
    assert not actor.clips
    assert slab.slice_actor is None
    off = plotter.fiblets.add_slab(normal="x", origin=-500.0, volume=volume)
    plotter.render()
    np.testing.assert_array_equal(off.origin, (-500.0, 0.0, 0.0))
    off.position = 9.0
    plotter.render()
    assert off.slice_actor.bounds[:2] == pytest.approx((9.0, 9.0))
    off.remove()


def test_a_slab_follows_a_widget(shown):
    plotter, actor = shown
    widget, slab = plotter.fiblets.add_clip_slab_widget(normal="x", thickness=10.0)
    widget.SetOrigin(7.0, 0.0, 0.0)
    widget.SetNormal(0.0, 1.0, 0.0)
    widget.InvokeEvent("InteractionEvent")
    np.testing.assert_allclose(slab.normal, (0, 1, 0))
    same(actor.clips[slab.name], regions.Slab((0, 1, 0), (7.0, 0.0, 0.0), 10.0))
    plotter.fiblets.clear_widgets()
    assert not actor.clips


def test_a_mesh_is_dragged_and_only_its_matrix_changes(shown):
    plotter, actor = shown
    torus = pv.ParametricTorus(ringradius=40, crosssectionradius=15).clean()
    widget, mesh = plotter.fiblets.add_clip_mesh_widget(torus, name="ring")
    plotter.render()
    first = actor.clips["ring"]
    move = np.eye(4)
    move[:3, 3] = 10.0, -5.0, 3.0
    mesh.user_matrix = move
    widget._user_interact_callback(mesh.user_matrix)
    plotter.render()
    same(actor.clips["ring"], first.moved(move))
    (leaf,) = actor.clips["ring"].leaves
    assert leaf.field is first.leaves[0].field, "the mesh's distances were computed anew"
    plotter.fiblets.clear_widgets()
    assert not actor.clips
    assert mesh not in plotter.actors.values()


def test_without_fiblets_there_is_nothing_to_cut():
    plotter = pv.Plotter(off_screen=True)
    try:
        with pytest.raises(ValueError, match="add_fiblets"):
            plotter.fiblets.add_clip_plane_widget()
        actor = plotter.add_fiblets([[(0, 0, 0), (1, 1, 1)]])
        with pytest.raises(ValueError, match="open"):
            plotter.fiblets.add_clip_mesh_widget(pv.Plane(), actor)
    finally:
        plotter.close()


def test_a_slab_that_is_refused_leaves_no_cut(shown):
    plotter, actor = shown
    with pytest.raises(TypeError, match="volume is a ndarray; give a pyvista dataset"):
        plotter.fiblets.add_slab(volume=np.zeros((3, 3, 3)))
    with pytest.raises(TypeError):
        plotter.fiblets.add_slab(volume=pv.Wavelet(), no_such_option=1)
    assert not actor.clips
