"""Volumes among VTK's meshes, lights, cuts, passes and pickers: against closed forms, and VTK's own pictures."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv
from vtkmodules.vtkCommonDataModel import vtkPlane
from vtkmodules.vtkRenderingCore import vtkActor, vtkMapper

from pvfiblets.codec.encoding.compress import compress
from pvfiblets.mappers import Colouring, FibletMapper
from pvfiblets.mappers.effects.slices import Slices
from pvfiblets.streamlines import Streamlines
from pvfiblets.volumes import Transfer
from pvfiblets.volumes.raycast_options import RaycastOptions

from .visible_volumes import (
    HALF,
    blob,
    fog,
    in_box,
    inner,
    into_ball,
    light,
    look,
    made,
    middle,
    over,
    ramp,
    rays,
    through_table,
    volume,
    wall,
)  # fmt: skip


@pytest.mark.few(2)
@pytest.mark.parametrize(
    ("eye", "parallel"),
    [((0.0, -100.0, 0.0), True), ((30.0, -70.0, 25.0), True), ((30.0, -50.0, 20.0), False), ((4.0, -9.0, 3.0), False)],
    ids=["front", "oblique", "perspective", "inside"],
)
def test_light_is_that_of_each_rays_way_through_the_volume(make_plotter, tools, eye, parallel):
    mapper, actor = made(fog(), light())
    plotter = make_plotter()
    plotter.add_actor(actor, reset_camera=False)
    image = tools.picture(look(plotter, eye, parallel), mapper).astype(float)
    first, last = in_box(*rays(eye, parallel))
    wanted = over(last - first, np.zeros(3))
    there = inner(last > first)
    assert there.mean() > 0.8
    assert np.abs(image - wanted)[there].max() <= 2.5


def passes(name):
    def setup(plotter):
        if name == "peeling":
            plotter.enable_depth_peeling()
        elif name == "blended":
            plotter.renderer.SetUseOIT(False)
        elif name in ("msaa", "ssaa"):
            plotter.enable_anti_aliasing(name)

    return setup


@pytest.mark.few(2)
@pytest.mark.parametrize("name", ["default", "peeling", "blended", "msaa", "ssaa"])
@pytest.mark.parametrize("mesh_first", [True, False], ids=["mesh-first", "mesh-last"])
def test_rays_end_at_meshes(make_plotter, tools, name, mesh_first):
    """A white ball in fog, pixel by pixel, in every pass that VTK has for what is translucent."""
    mapper, actor = made(fog(), light())
    plotter, eye = make_plotter(), (30.0, -50.0, 20.0)
    ball = pv.Sphere(radius=9.0, theta_resolution=120, phi_resolution=120)
    if mesh_first:
        plotter.add_mesh(ball, color="white", lighting=False, reset_camera=False)
    plotter.add_actor(actor, reset_camera=False)
    if not mesh_first:
        plotter.add_mesh(ball, color="white", lighting=False, reset_camera=False)
    passes(name)(plotter)
    image = tools.picture(look(plotter, eye, False), mapper).astype(float)
    starts, ways = rays(eye, False)
    first, last = in_box(starts, ways)
    solid = into_ball(starts, ways, 9.0)
    wanted = over(np.minimum(last, solid) - first, np.where(np.isfinite(solid), 1.0, 0.0)[..., None] * np.ones(3))
    reach = 2 if name == "ssaa" else 1  # its filter is wider than a pixel
    there = inner(last > first, reach) & inner(np.isfinite(solid), reach)
    error = np.abs(image - wanted)[there].max(axis=-1)
    assert np.isfinite(solid)[there].sum() > 2000
    assert np.percentile(error, 97.0 if name == "ssaa" else 99.5) <= 3.0


def test_rays_end_at_fiblets(make_plotter, tools):
    """A line through the fog's middle, wide on the screen, added after the fog."""
    mapper, actor = made(fog(), light())
    line = Streamlines.from_list([np.c_[np.linspace(-30, 30, 61), np.zeros(61), np.zeros(61)]])
    lines, other = FibletMapper(compress(line), line_width=7.0, colouring=Colouring("solid")), vtkActor()
    lines.attach(other)
    other.GetProperty().SetLighting(False)
    plotter = make_plotter()
    plotter.add_actor(actor, reset_camera=False)
    plotter.add_actor(other, reset_camera=False)
    image = tools.picture(look(plotter), mapper, lines)
    assert np.abs(middle(image) - over(np.array(HALF), np.ones(3))).max() <= 2.5
    assert image[100, 235].tolist() == [255, 255, 255]  # beside the fog
    assert np.abs(image[60, 120] - over(np.array(2 * HALF), np.zeros(3))).max() <= 2.5


@pytest.mark.parametrize("peeling", [False, True])
def test_the_picture_follows_what_moves_inside(make_plotter, tools, peeling):
    mapper, actor = made(fog(), light())
    plotter = look(make_plotter())
    plotter.add_actor(actor, reset_camera=False)
    sheet = plotter.add_mesh(wall(0.0), color="white", lighting=False, reset_camera=False)
    if peeling:
        plotter.enable_depth_peeling()
    for y in (-10.0, 5.0, 12.0, -20.0, 40.0):
        sheet.position = (0.0, y, 0.0)
        image = tools.picture(look(plotter), mapper)
        wanted = over(np.clip(y + HALF, 0.0, 2 * HALF), np.ones(3))
        assert np.abs(middle(image) - wanted).max() <= 2.5, y
    sheet.visibility = False
    assert np.abs(middle(tools.picture(plotter, mapper)) - over(np.array(2 * HALF), np.zeros(3))).max() <= 2.5
    sheet.visibility, sheet.position = True, (0.0, 0.0, 0.0)
    vtkMapper.SetResolveCoincidentTopologyToPolygonOffset()  # VTK shifts depths; a fixture puts it back
    image = tools.picture(look(plotter), mapper)
    assert np.abs(middle(image) - over(np.array(HALF), np.ones(3))).max() <= 3.0


@pytest.mark.parametrize(("y", "front"), [(-25.0, True), (25.0, False)])
def test_translucent_sheets_lie_in_order_under_depth_peeling(make_plotter, tools, y, front):
    mapper, actor = made(fog(), light())
    plotter = look(make_plotter())
    plotter.enable_depth_peeling(number_of_peels=4)
    plotter.add_actor(actor, reset_camera=False)
    plotter.add_mesh(wall(y), color="blue", opacity=0.5, lighting=False, reset_camera=False)
    blue, empty, length = np.array([0.0, 0.0, 1.0]), np.zeros(3), np.array(2 * HALF)
    wanted = 127.5 * blue + over(length, empty) / 2 if front else over(length, blue / 2)
    assert np.abs(middle(tools.picture(look(plotter), mapper)) - wanted).max() <= 3.0


def test_peaks_are_those_before_a_mesh(make_plotter, tools):
    mapper, actor = made(volume(ramp), RaycastOptions("mip", step=0.1), colouring=through_table((-HALF, HALF)))
    plotter = look(make_plotter())
    plotter.add_actor(actor, reset_camera=False)
    assert middle(tools.picture(plotter, mapper))[0] >= 254
    plotter.add_mesh(wall(5.0), color="red", lighting=False, reset_camera=False)
    image = tools.picture(look(plotter), mapper)
    assert np.abs(middle(image) - 255 * (5.0 + HALF) / (2 * HALF)).max() <= 2.5
    hit = mapper.pick_at(120, 100)
    assert hit.value == pytest.approx(HALF, abs=0.2)  # what others hide is picked through them
    assert hit.voxel[1] == 32


def test_peaks_are_those_before_a_slanted_mesh(make_plotter, tools):
    mapper, actor = made(volume(ramp), RaycastOptions("mip"), colouring=through_table((-HALF, HALF)))
    plotter = look(make_plotter())
    plotter.add_actor(actor, reset_camera=False)
    slanted = pv.Plane(center=(0.0, 3.0, 0.0), direction=(0.5, -1.0, 0.7), i_size=60, j_size=60)
    plotter.add_mesh(slanted, color="red", lighting=False, reset_camera=False)
    image = tools.picture(look(plotter), mapper)
    inside = image[90:110, 110:130].astype(float)
    assert np.abs(inside[..., 0] - inside[..., 2]).max() <= 2.5, "nothing red shows"
    assert np.ptp(inside[..., 1]) > 3.0


def test_local_peaks_are_the_first_and_others_the_greatest(make_plotter, tools):
    bumps = volume(lambda p: 0.6 * np.exp(-((p[..., 1] + 8) ** 2) / 8) + np.exp(-((p[..., 1] - 8) ** 2) / 8))
    mapper, actor = made(bumps, RaycastOptions("mip"), colouring=through_table((0.0, 1.0)))
    plotter = look(make_plotter())
    plotter.add_actor(actor, reset_camera=False)
    for casting, wanted, y in [
        (RaycastOptions("mip", step=0.1), 1.0, 8.0),
        (RaycastOptions("local-mip", step=0.1, threshold=0.3), 0.6, -8.0),
        (RaycastOptions("local-mip", step=0.1, threshold=0.8), 1.0, 8.0),
        (RaycastOptions("mip", step=0.1, high=0.7), 0.7, None),
    ]:
        mapper.casting = casting
        assert np.abs(middle(tools.picture(look(plotter), mapper)) - 255 * wanted).max() <= 12  # of the steep flank
        hit = mapper.pick_at(120, 100)
        assert hit.value == pytest.approx(wanted, abs=0.05)
        if y is not None:
            assert hit.position == pytest.approx([0.1, y, 0.1], abs=0.15)


@pytest.mark.few(1)
@pytest.mark.parametrize(
    "place",
    [None, lambda actor: actor.SetScale(1.2, 1.0, 0.7),
     lambda actor: (actor.SetScale(1, 1, -1), actor.SetOrientation(0, 0, 30))],
    ids=["plain", "stretched", "mirrored"],
)  # fmt: skip
def test_surfaces_look_as_vtks_contours(make_plotter, tools, place):
    """Silhouette, depth and light, against marching cubes on four times as many voxels."""
    drawn = volume(blob, 24)
    mapper, actor = made(drawn, RaycastOptions("isosurface", (6.0,), filter="tricubic"), lighting=True)
    if place:
        place(actor)
    matrix = np.array([[actor.GetMatrix().GetElement(i, j) for j in range(4)] for i in range(4)])
    fine = pv.ImageData(dimensions=[93] * 3, spacing=[2 * HALF / 92] * 3, origin=[-HALF] * 3)
    fine["v"] = blob(np.asarray(fine.points).reshape(93, 93, 93, 3)).ravel()
    mesh = fine.contour([6.0], scalars="v").transform(matrix, inplace=False)
    mesh = mesh.compute_normals(auto_orient_normals=True, split_vertices=False)
    mesh.clear_data()
    mesh = mesh.compute_normals(auto_orient_normals=True, split_vertices=False)
    found = []
    for thing in (actor, mesh):
        plotter = make_plotter()
        plotter.remove_all_lights()
        lamp = pv.Light(position=(60, -100, 40), focal_point=(0, 0, 0), light_type="scene light")
        lamp.positional = False
        plotter.add_light(lamp)
        if thing is actor:
            plotter.add_actor(actor, reset_camera=False)
        else:
            look_of = {"color": "white", "ambient": 0.1, "diffuse": 0.9, "specular": 0.0, "smooth_shading": True}
            plotter.add_mesh(mesh, reset_camera=False, **look_of)
        look(plotter, (30.0, -50.0, 20.0), False)
        image = tools.picture(plotter, *([mapper] if thing is actor else [])).astype(int)
        found.append((image, np.asarray(plotter.get_image_depth(fill_value=np.nan))))
    (ours, near), (theirs, near_too) = found
    both = np.isfinite(near) & np.isfinite(near_too)
    assert both.sum() > 3000
    assert tools.agreement(np.isfinite(near), np.isfinite(near_too)) > 0.999
    rim = both & inner(both)
    assert np.median(np.abs(near - near_too)[rim]) < 0.01  # mm
    assert (np.abs(near - near_too)[rim] < 0.2).mean() > 0.98
    assert np.median(np.abs(ours - theirs).max(-1)[rim]) <= 3
    assert (np.abs(ours - theirs).max(-1)[rim] <= 16).mean() > 0.97


def test_surfaces_cut_into_meshes_and_have_the_colour_of_their_value(make_plotter, tools):
    ball = volume(lambda p: 16.0 - np.linalg.norm(p, axis=-1))
    mapper, actor = made(ball, RaycastOptions("isosurface", (4.0,)), colouring=through_table((0.0, 16.0)))
    plotter = look(make_plotter())
    plotter.add_actor(actor, reset_camera=False)
    plotter.add_mesh(wall(-8.0), color="red", lighting=False, reset_camera=False)
    image = tools.picture(look(plotter), mapper)
    assert not actor.GetForceTranslucent()
    assert np.abs(middle(image) - 64).max() <= 1
    area = (image[..., 1] > 0).sum() / 25  # mm2 of what stands out of the wall: 5 pixels a mm
    assert area == pytest.approx(np.pi * (12.0**2 - 8.0**2), rel=0.02)
    mapper.casting = RaycastOptions("isosurface", (4.0, 12.0))
    assert np.abs(middle(tools.picture(plotter, mapper)) - 64).max() <= 1
    mapper.casting = RaycastOptions("isosurface", (12.0,))
    assert middle(tools.picture(plotter, mapper)).tolist() == [255, 0, 0]


@pytest.mark.few(1)
@pytest.mark.parametrize(("y", "front"), [(-25.0, True), (25.0, False)])
def test_translucent_lines_lie_in_order_under_depth_peeling(make_plotter, tools, y, front):
    """Three wide lines, one behind the other, of which all show: the volume is behind all of them, or in front."""
    plotter = look(make_plotter())
    plotter.enable_depth_peeling(number_of_peels=8)
    mapper, actor = made(fog(), light())
    plotter.add_actor(actor, reset_camera=False)
    x = np.linspace(-30.0, 30.0, 61)
    lines = [np.stack([x, np.full_like(x, y + k), np.zeros_like(x)], axis=1) for k in range(3)]
    fibres = tools.fibres(Streamlines.from_list(lines))
    drawn, among = fibres.actor(lighting=False, line_width=40, colouring=Colouring("solid", color=(0.0, 0.0, 1.0)))
    among.GetProperty().SetOpacity(0.3)
    drawn.set_effect("layers", Slices())
    plotter.add_actor(among, reset_camera=False)
    seen = middle(tools.picture(look(plotter), mapper, drawn))
    blue, empty, length = np.array([0.0, 0.0, 1.0]), np.zeros(3), np.array(2 * HALF)
    through = 0.7**3
    lit = (1.0 - through) * blue
    wanted = 255.0 * lit + through * over(length, empty) if front else over(length, lit)
    assert np.abs(seen - wanted).max() <= 3.0


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
