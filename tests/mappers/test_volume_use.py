"""Volumes in windows: cuts, subplots, selection, picking, and what changes while they are shown."""

from __future__ import annotations

import numpy as np
import pytest
from vtkmodules.vtkCommonDataModel import vtkPlane

from pvfiblets.mappers import Colouring, VolumeMapper
from pvfiblets.volumes import Transfer
from pvfiblets.volumes.raycast_options import RaycastOptions

from .visible_volumes import HALF, fog, light, look, made, middle, over, ramp, volume, wall


def test_clipping_planes_of_the_mapper_cut(make_plotter, tools):
    mapper, actor = made(fog(), light())
    plotter = look(make_plotter())
    plotter.add_actor(actor, reset_camera=False)
    plane = vtkPlane()
    plane.SetNormal(0, 1, 0)
    plane.SetOrigin(0, 6.0, 0)
    mapper.AddClippingPlane(plane)
    image = tools.picture(plotter, mapper)
    assert np.abs(middle(image) - over(np.array(10.0), np.zeros(3))).max() <= 2.5
    plane.SetNormal(1, 0, 0)
    plane.SetOrigin(2.0, 0, 0)
    mapper.RemoveAllClippingPlanes()
    mapper.AddClippingPlane(plane)
    columns = np.flatnonzero(tools.covered(tools.picture(plotter, mapper)).any(axis=0))
    assert columns[0] == 130  # 2 mm right of the middle, 5 pixels a mm
    assert columns[-1] == 199


def test_subplots_end_their_own_rays(make_plotter, tools):
    """One actor in two renderers, a mesh in one of them."""
    mapper, actor = made(fog(), light())
    plotter = make_plotter(shape=(1, 2), window_size=(400, 200))
    for column in range(2):
        plotter.subplot(0, column)
        plotter.add_actor(actor, reset_camera=False)
        if column:
            plotter.add_mesh(wall(0.0), color="white", lighting=False, reset_camera=False)
        look(plotter)
    for peeling in (True, False):
        for renderer in plotter.renderers:
            renderer.SetUseDepthPeeling(peeling)
        image = tools.picture(plotter, mapper)
        assert np.abs(image[100, 100] - over(np.array(2 * HALF), np.zeros(3))).max() <= 2.5
        assert np.abs(image[100, 300] - over(np.array(HALF), np.ones(3))).max() <= 2.5
    large = plotter.screenshot(return_img=True, scale=2)[..., :3]
    mapper.raise_pending()
    assert large.shape == (400, 800, 3)
    assert np.abs(large[200, 600] - over(np.array(HALF), np.ones(3))).max() <= 2.5


@pytest.mark.few(1)
@pytest.mark.parametrize("ssaa", [False, True])
def test_places_are_picked_as_the_picture_shows_them(make_plotter, tools, ssaa):
    ball = volume(lambda p: 16.0 - np.linalg.norm(p, axis=-1), 33)
    mapper, actor = made(ball, RaycastOptions("isosurface", (4.0,), filter="tricubic"))
    plotter = look(make_plotter())
    plotter.add_actor(actor, reset_camera=False)
    if ssaa:
        plotter.enable_anti_aliasing("ssaa")
    assert mapper.pick_at(120, 100) is None
    tools.picture(plotter, mapper)
    for column, row in ((120, 100), (90, 80), (150, 130)):
        hit = mapper.pick_at(column, row)
        x, z = (column + 0.5 - 120) / 5, (row + 0.5 - 100) / 5
        assert hit.position == pytest.approx([x, -np.sqrt(144 - x**2 - z**2), z], abs=0.15)
        assert np.linalg.norm(hit.position) == pytest.approx(12.0, abs=0.02)
        assert hit.voxel == tuple(np.round(hit.position + HALF).astype(int))
        assert hit.value == 4.0
    assert mapper.pick_at(120, 190) is None
    assert mapper.pick_at(-5, 100) is None
    assert mapper.pick_at(120, 170, tolerance=20) is not None
    assert mapper.pick_at(120, 100, tolerance=-1) is None


def test_light_is_picked_where_it_begins(make_plotter, tools):
    mapper, actor = made(
        volume(ramp), RaycastOptions("composite", transfer=Transfer([[1, 1, 1, 0], [1, 1, 1, 1]], (0, 1)))
    )
    plotter = look(make_plotter())
    plotter.add_actor(actor, reset_camera=False)
    tools.picture(plotter, mapper)
    hit = mapper.pick_at(120, 100)
    assert hit.position == pytest.approx([0.1, 0.0, 0.1], abs=0.5)  # a step
    assert hit.value == pytest.approx(hit.voxel[1] - HALF)


def test_colours_that_a_mode_does_not_have_are_refused():
    mapper, _ = made(fog(), light())
    with pytest.raises(ValueError, match=r"of mode 'composite' is 'solid'; light has the colours of casting\.transfer"):
        mapper.colouring = Colouring("solid")
    with pytest.raises(ValueError, match="of mode 'mip' is 'orientation'; choose of"):
        mapper.show(RaycastOptions("mip"), Colouring())
    assert mapper.casting.mode == "composite"
    with pytest.raises(ValueError, match="of mode 'mip' is 'point_rgba'"):
        VolumeMapper(fog(), RaycastOptions("mip"), colouring=Colouring("point_rgba", source="light"))
