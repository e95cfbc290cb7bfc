"""VTK's clipping planes on the mapper, against polylines that are cut the same way."""

from __future__ import annotations

import numpy as np
import pytest
from vtkmodules.vtkCommonDataModel import vtkPlane


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
        ((0, 0, -25), (0, 0, 1)),
        ((-30, 0, 0), (1, 0, 0.1)),
        ((0, -5, 0), (0, 1, 0)),
        ((0, 30, 0), (0, -1, 0)),
        ((0, 31, 0), (0, -1, 0.1)),
        ((0, 32, 0), (0, -1, -0.1)),
    ],
}


@pytest.mark.parametrize("cut", CUTS)
@pytest.mark.parametrize("parallel", [False, True], ids=["perspective", "parallel"])
def test_planes_cut_fiblets_as_they_cut_polylines(compare, make_fibres, tools, cut, parallel):
    def scene(plotter, actor, mapper):
        for origin, normal in CUTS[cut]:
            mapper.AddClippingPlane(plane(origin, normal))
        if parallel:
            plotter.enable_parallel_projection()
        plotter.reset_camera()

    # Dense enough that behind every line that is cut there is another.
    ours, theirs = compare(scene, make_fibres(tools.helices(300, 60)))
    if cut == "all of it":
        assert not ours.any()
        assert not theirs.any()
        return
    assert tools.agreement(tools.covered(ours), tools.covered(theirs)) >= 0.99
    # No holes where what is in front was cut away. Ends at a plane are a pixel longer or shorter.
    assert tools.covered(ours).sum() == pytest.approx(tools.covered(theirs).sum(), rel=0.1)


def test_depth_behind_a_cut_is_that_of_polylines(compare, lines, tools):
    seen = []

    def scene(plotter, actor, mapper):
        mapper.AddClippingPlane(plane((0, 0, 0), (0.2, 1, -0.1)))
        plotter.reset_camera()
        plotter.show(auto_close=False)
        seen.append((plotter.get_image_depth(fill_value=np.nan), plotter.camera.distance))

    compare(scene)
    (ours, distance), (theirs, _) = seen
    both = ~np.isnan(ours) & ~np.isnan(theirs)
    assert both.sum() > 400
    pixel = 2 * distance * np.tan(np.radians(15)) / ours.shape[0]
    # A line passes a pixel's centre by up to half a pixel, where the slanted near plane is nearer or
    # farther: depth is good to a pixel.
    assert (np.abs(ours - theirs)[both] < pixel).mean() > 0.88


def test_planes_are_in_world_coordinates(compare, tools):
    def scene(plotter, actor, mapper):
        actor.SetPosition(10, 0, 20)
        actor.SetScale(1.2, 0.8, -1.0)
        actor.SetOrientation(10, 40, 70)
        mapper.AddClippingPlane(plane((5, 0, 10), (1, 0, 1)))
        plotter.reset_camera()

    ours, theirs = compare(scene)
    assert tools.agreement(tools.covered(ours), tools.covered(theirs)) >= 0.985


def test_planes_come_and_go(make_plotter, lines, tools):
    mapper, actor = lines.actor()
    plotter = make_plotter()
    plotter.add_actor(actor)
    plotter.camera_position = "xz"
    whole = tools.picture(plotter, mapper)
    mapper.AddClippingPlane(plane((0, 0, 0), (0, 0, 1)))
    upper = tools.covered(tools.picture(plotter, mapper))
    moving = mapper.GetClippingPlanes().GetItem(0)
    moving.SetOrigin(0, 0, 20)
    less = tools.covered(tools.picture(plotter, mapper))
    assert 0 < less.sum() < upper.sum() < tools.covered(whole).sum()
    assert not (less & ~tools.grown(upper)).any()
    mapper.RemoveAllClippingPlanes()
    assert np.array_equal(tools.picture(plotter, mapper), whole)
