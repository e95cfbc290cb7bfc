"""VTK's clipping planes on the mapper, against polylines that are cut the same way."""

from __future__ import annotations

import numpy as np
import pytest
from vtkmodules.vtkCommonDataModel import vtkPlane

from pvfiblets.streamlines import Streamlines


def plane(origin, normal) -> vtkPlane:
    result = vtkPlane()
    result.SetOrigin(origin)
    result.SetNormal(normal)
    return result


CUTS = {
    "one, seen edge on": [((0, 0, 0), (0, 0, 1))],
    "one, away from the viewer": [((0, 0, 0), (0, -1, 0))],
    "one, towards the viewer": [((0, 0, 0), (0.2, 1, -0.1))],
    "front and side": [((0, 5, 0), (0, 1, 0)), ((-15, 0, 0), (1, 0.2, 0))],
    "a slab": [((0, -5, 0), (0, 1, 0)), ((0, 5, 0), (0, -1, 0))],
    "all of it": [((0, 0, 500), (0, 0, 1))],
    "nothing": [((0, 0, -500), (0, 0, 1))],
    "six, of which one is in front": [
        ((0, 0, -25), (0, 0, 1)), ((-30, 0, 0), (1, 0, 0.1)), ((0, -5, 0), (0, 1, 0)),
        ((0, 30, 0), (0, -1, 0)), ((0, 31, 0), (0, -1, 0.1)), ((0, 32, 0), (0, -1, -0.1)),
    ],
    "two that meet in front": [((0, 0, 0), (1, 1, 0)), ((10, 0, 0), (-1, 1, 0))],
    "a box": [
        ((-12, 0, 0), (1, 0, 0)), ((15, 0, 0), (-1, 0, 0)), ((0, -15, 0), (0, 1, 0)),
        ((0, 12, 0), (0, -1, 0)), ((0, 0, -14), (0, 0, 1)), ((0, 0, 9), (0, 0, -1)),
    ],
}  # fmt: skip


@pytest.mark.few(3)
@pytest.mark.every("value")
@pytest.mark.parametrize("cut", CUTS)
@pytest.mark.parametrize("parallel", [False, True], ids=["perspective", "parallel"])
def test_planes_cut_fiblets_as_they_cut_polylines(compare, make_fibres, tools, cut, parallel):
    def scene(plotter, actor, mapper):
        for origin, normal in CUTS[cut]:
            mapper.AddClippingPlane(plane(origin, normal))
        if parallel:
            plotter.enable_parallel_projection()
        plotter.reset_camera()

    ours, theirs = compare(scene, make_fibres(tools.helices(300, 60)))
    if cut == "all of it":
        assert not ours.any()
        assert not theirs.any()
        return
    assert tools.agreement(tools.covered(ours), tools.covered(theirs)) >= 0.99
    # No holes where what is in front was cut away. At a plane the engine draws the pixel of the cut, which OpenGL
    # leaves out: in a slab a tenth of the pieces are not ten pixels long.
    assert tools.covered(ours).sum() == pytest.approx(tools.covered(theirs).sum(), rel=0.15)


BOX = CUTS["a box"]


def test_a_box_a_million_millimetres_away(compare, make_fibres, tools):
    offset = np.array([1e6, -2e6, 3e6])
    near = tools.helices(150, 60)
    far = Streamlines(np.asarray(near.points, np.float64) + offset, near.offsets)

    def scene(plotter, actor, mapper):
        # VTK's polylines hold float32 positions: the reference is drawn here and moved by its actor.
        moved = offset if hasattr(mapper, "fiblets") else 0 * offset
        if not hasattr(mapper, "fiblets"):
            mapper.SetInputData(near_lines)
        for origin, normal in BOX:
            mapper.AddClippingPlane(plane(np.array(origin) + moved, normal))
        plotter.camera_position = [np.array((70, -75, 65)) + moved, moved, (0, 0, 1)]
        plotter.camera.clipping_range = 20, 250

    fibres = make_fibres(far)
    # What the fiblets decode to, with the offset taken off in float64.
    points = np.asarray(fibres.reference.points, np.float64) - offset
    near_lines = tools.polylines(Streamlines(points, fibres.reference.offsets))
    ours, theirs = compare(scene, fibres)
    assert tools.agreement(tools.covered(ours), tools.covered(theirs)) >= 0.98


def test_planes_are_in_world_coordinates(compare, tools):
    def scene(plotter, actor, mapper):
        actor.SetPosition(10, 0, 20)
        actor.SetScale(1.2, 0.8, -1.0)
        actor.SetOrientation(10, 40, 70)
        mapper.AddClippingPlane(plane((5, 0, 10), (1, 0, 1)))
        plotter.reset_camera()

    ours, theirs = compare(scene)
    assert tools.agreement(tools.covered(ours), tools.covered(theirs)) >= 0.985


def test_more_planes_than_can_be_drawn_are_told(make_plotter, lines):
    mapper, actor = lines.actor()
    plotter = make_plotter()
    plotter.add_actor(actor)
    for height in range(9):
        mapper.AddClippingPlane(plane((0, 0, -100 - height), (0, 0, 1)))
    plotter.show(auto_close=False)
    with pytest.raises(ValueError, match="9 clip planes are more than 8"):
        mapper.raise_pending()


def test_what_is_cut_away_is_not_picked_and_planes_come_and_go(make_plotter, lines, tools):
    mapper, actor = lines.actor()
    plotter = make_plotter()
    plotter.add_actor(actor)
    plotter.camera_position = "xz"
    whole = tools.picture(plotter, mapper)
    mapper.AddClippingPlane(plane((0, 0, 10), (0, 0, 1)))
    left = tools.covered(tools.picture(plotter, mapper))
    height, shown = left.shape[0], np.argwhere(tools.covered(whole))
    gone = [(row, column) for row, column in shown if not tools.grown(tools.grown(left))[row, column]][::40]
    assert len(gone) > 10
    assert all(mapper.pick_at(column, height - 1 - row, tolerance=1) is None for row, column in gone)
    mapper.GetClippingPlanes().GetItem(0).SetOrigin(0, 0, 20)
    less = tools.covered(tools.picture(plotter, mapper))
    assert 0 < less.sum() < left.sum() < tools.covered(whole).sum()
    assert not (less & ~tools.grown(left)).any()
    mapper.RemoveAllClippingPlanes()
    assert np.array_equal(tools.picture(plotter, mapper), whole)
