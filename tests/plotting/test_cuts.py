"""Cuts by planes are VTK's own; surfaces cut by regions have the areas and borders of the formulas."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv
from vtkmodules.vtkCommonDataModel import vtkPlane

from pvfiblets import compress, regions
from pvfiblets.plotting.cut_surfaces import cut_surface
from pvfiblets.plotting.filtering.region_sources import slab
from pvfiblets.synthetic import brain_streamlines

SIZE = (240, 200)
SLAB = regions.Slab((0.2, 1.0, 0.0), (0.0, -10.0, 0.0), 12.0)
BOX = (-40.0, 35.0, -60.0, 30.0, -30.0, 50.0)


@pytest.fixture(scope="module")
def brain():
    return compress(brain_streamlines(250, seed=4))


@pytest.fixture
def scene():
    """What makes a plotter that shows an actor, and is closed afterwards."""
    made = []

    def make(add):
        plotter = pv.Plotter(off_screen=True, window_size=SIZE)
        made.append(plotter)
        actor = add(plotter)
        plotter.camera_position = [(150.0, -260.0, 120.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0)]
        plotter.show(auto_close=False)
        return plotter, actor

    yield make
    for plotter in made:
        plotter.close()


def lines(brain, **settings):
    def add(plotter):
        actor = plotter.add_fiblets(brain, show_scalar_bar=False)
        for name, value in settings.items():
            setattr(actor, name, value)
        return actor

    return add


def ball(plotter):
    axes = np.linspace(-1.0, 1.0, 24, dtype=np.float32)
    field = 1.2 - np.sqrt(axes[:, None, None] ** 2 + axes[:, None] ** 2 + axes**2)
    image = pv.ImageData(dimensions=(24, 24, 24), spacing=(6, 6, 6), origin=(-69, -69, -69))
    image["field"] = field.ravel(order="F")
    return plotter.add_raycast_volume(image, mode="isosurface", values=0.4, show_scalar_bar=False)


def picture(plotter):
    plotter.render()
    return plotter.screenshot(return_img=True).astype(int)


def vtk_planes(*cuts):
    planes = []
    for normal, origin in cuts:
        plane = vtkPlane()
        plane.SetNormal(normal)
        plane.SetOrigin(origin)
        planes.append(plane)
    return planes


def sides_of_box():
    low, high = np.array(BOX[::2]), np.array(BOX[1::2])
    return [(sign * axis, low if sign > 0 else high) for axis in np.eye(3) for sign in (1.0, -1.0)]


UNIT = np.array([0.2, 1.0, 0.0]) / np.hypot(0.2, 1.0)
SAME = {
    "plane": (((1.0, 0.5, 0.0), (3.0, 0.0, 0.0)), [((1.0, 0.5, 0.0), (3.0, 0.0, 0.0))]),
    "slab": (SLAB, [(UNIT, (0, -10, 0) - 6.0 * UNIT), (-UNIT, (0, -10, 0) + 6.0 * UNIT)]),
    "box": (BOX, sides_of_box()),
}
LOOKS = {
    "thin": {},
    "wide": {"line_width": 4},
    "tubes": {"tube_radius": 1.0},
    "layers": {"opacity": 0.5, "transparency": 3},
}


@pytest.mark.few(1)
@pytest.mark.every("value")
@pytest.mark.parametrize("look", [*LOOKS, "volume"])
@pytest.mark.parametrize("name", SAME)
def test_a_cut_by_planes_is_one_by_planes_of_vtk(scene, brain, name, look):
    what, planes = SAME[name]
    plotter, actor = scene(ball if look == "volume" else lines(brain, **LOOKS[look]))
    whole = picture(plotter)
    actor.clip(what)
    cut, told = picture(plotter), actor.explain()
    assert (cut != whole).any()
    assert "region" not in {buffer["name"] for buffer in told["buffers"]}
    assert "CLIP_REGION" not in told["features"]
    actor.unclip()
    np.testing.assert_array_equal(picture(plotter), whole)
    for plane in vtk_planes(*planes):
        actor.mapper.AddClippingPlane(plane)
    other = picture(plotter)
    # The planes of both are told in float64, and differ in a last digit: a pixel on the very edge may.
    assert (cut != other).any(axis=2).sum() <= 2
    assert (other != whole).any()


@pytest.mark.parametrize(
    ("normal", "origin", "middle"),
    [("z", 7.5, 7.5), ("-z", 7.5, -7.5), ((0, 0, 3), 7.5, 7.5), ((0, 0, 2), (90.0, -4.0, -6.0), -6.0)],
)
def test_a_slab_lies_where_its_origin_says(normal, origin, middle):
    """One number counts along the normal, of whatever length; a point is a point of its middle."""
    z = np.linspace(-20.0, 20.0, 401) + 0.01
    points = np.column_stack([np.full_like(z, 3.0), np.full_like(z, -11.0), z])
    np.testing.assert_array_equal(slab(normal, origin, 5.0).contains(points), np.abs(z - middle) <= 2.5)


def test_a_cut_follows_where_the_actor_is(scene, brain):
    """Cuts are in world coordinates, whatever the actor's placement."""
    plotter, actor = scene(lines(brain, line_width=2))
    turn = np.array([[0.0, -1.2, 0, 10], [1.2, 0.0, 0, -5], [0, 0, 1.2, 3], [0, 0, 0, 1]])
    actor.user_matrix = turn
    actor.clip(((0.0, 0.0, 1.0), (0.0, 0.0, 3.0)))
    placed = picture(plotter)
    actor.unclip()
    actor.user_matrix = np.eye(4)
    plotter.remove_actor(actor)
    moved = plotter.add_fiblets(brain, show_scalar_bar=False, line_width=2, user_matrix=turn)
    moved.mapper.AddClippingPlane(vtk_planes(((0.0, 0.0, 1.0), (0.0, 0.0, 3.0)))[0])
    assert (placed != picture(plotter)).any(axis=2).sum() <= 2


def test_planes_of_vtk_and_cuts_add_up_beyond_what_there_is_room_for(scene, brain):
    """Eight planes there can be: of VTK's six and a box's six, those of the box are cut as a region, to the same."""
    plotter, actor = scene(lines(brain))
    actor.clip(BOX)
    boxed = picture(plotter)
    for plane in vtk_planes(*((normal, 5.0 * np.asarray(origin)) for normal, origin in sides_of_box())):
        actor.mapper.AddClippingPlane(plane)  # nothing is out there to be cut
    both = picture(plotter)
    assert "CLIP_REGION" in actor.explain()["features"]
    assert (boxed != both).any(axis=2).mean() < 0.02


@pytest.mark.few(1)
@pytest.mark.parametrize(
    ("pipeline", "detail"), [("compute", 0.0), ("compute", 0.5), ("geometry", 0.0), ("tessellation", 0.0)]
)
def test_tubes_end_in_closed_faces_where_planes_cut(scene, pipeline, detail):
    """A tube cut towards the eye shows a disc; its axis alone would leave it open."""
    line = np.column_stack([np.linspace(-60.0, 60.0, 121), np.zeros(121), np.zeros(121)])
    from pvfiblets import Streamlines

    fiblets = compress(Streamlines(line.astype(np.float32), np.array([0, 121])))
    plotter, actor = scene(lines(fiblets, pipeline=pipeline, tube_radius=20.0, detail=detail))
    plotter.camera_position = [(300.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0)]
    actor.clip(((-1.0, 0.0, 0.0), (10.0, 0.0, 0.0)))
    by_plane = (picture(plotter) != 255).any(axis=2)
    actor.unclip()
    actor.clip(regions.Plane((-1.0, 0.0, 0.0), (10.0, 0.0, 0.0)) | regions.Sphere((0.0, 900.0, 0.0), 1.0))
    by_region = (picture(plotter) != 255).any(axis=2)
    radius = 20.0 / np.tan(np.radians(15.0)) / 290.0 * SIZE[1] / 2.0
    assert by_plane.sum() == pytest.approx(np.pi * radius**2, rel=0.05)
    assert by_region.sum() < 0.6 * by_plane.sum(), "a region keeps what of the surface is inside, and closes nothing"


@pytest.mark.few(1)
@pytest.mark.parametrize("pipeline", ["compute", "geometry", "tessellation"])
def test_a_region_that_holds_all_of_bent_tubes_leaves_no_crack(scene, pipeline):
    """Half spheres at joints show on the outer side of bends alone; what a region keeps is as it is without one."""
    turn = np.linspace(0.0, 12.0, 70)
    line = np.column_stack([30.0 * np.cos(turn), 30.0 * np.sin(turn), 5.0 * turn - 30.0])
    from pvfiblets import Streamlines

    fiblets = compress(Streamlines(line.astype(np.float32), np.array([0, 70])))
    plotter, actor = scene(lines(fiblets, pipeline=pipeline, tube_radius=6.0))
    plotter.camera_position = [(120.0, -150.0, 90.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0)]
    whole = picture(plotter)
    actor.clip(regions.Sphere((0.0, 0.0, 0.0), 80.0) | regions.Sphere((0.0, 9.0, 0.0), 80.0))
    kept = picture(plotter)
    assert "CLIP_REGION" in actor.explain()["features"]
    assert ((whole != 255).any(axis=2)).mean() > 0.05
    np.testing.assert_array_equal(kept, whole)


@pytest.fixture
def square():
    """Two triangles, 10 by 10 mm, around the origin; ``x`` and ``label`` per point, ``half`` per triangle."""
    points = np.array([(-5, -5, 0), (5, -5, 0), (5, 5, 0), (-5, 5, 0)], float)
    mesh = pv.PolyData.from_regular_faces(points, [(0, 1, 2), (0, 2, 3)])
    mesh["x"] = points[:, 0]
    mesh["label"] = np.array([7, 7, 7, 7], np.uint8)
    mesh.cell_data["half"] = [1, 2]
    mesh.set_active_scalars("x", preference="point")
    return mesh


def test_a_ball_through_the_middle_of_a_triangle_cuts_a_round_hole(square):
    ball = regions.Sphere((0.5, -0.5, 1.0), 2.0)
    area = np.pi * (4.0 - 1.0)
    disc, rest = cut_surface(square, ball), cut_surface(square, ~ball)
    assert disc.area == pytest.approx(area, rel=0.002)
    assert rest.area == pytest.approx(100.0 - area, rel=1e-3)
    reach = [np.linalg.norm(part.points - (0.5, -0.5, 1.0), axis=1) for part in (disc, rest)]
    assert reach[0].max() == pytest.approx(2.0, abs=1e-6)
    assert reach[1].min() == pytest.approx(2.0, abs=1e-6)
    np.testing.assert_allclose(disc["x"], disc.points[:, 0], atol=1e-12)
    assert set(disc["label"]) == {7}
    assert disc["label"].dtype == np.uint8
    upper = disc.cell_centers().points
    np.testing.assert_array_equal(disc.cell_data["half"], np.where(upper[:, 0] > upper[:, 1], 1, 2))
    assert disc.active_scalars_name == "x"
    assert square.n_points == 4


@pytest.mark.parametrize(
    ("region", "area"),
    [(regions.Plane((1.0, 0.0, 0.0), (2.0, 0.0, 0.0)), 30.0),
     (~regions.Slab((0.0, 1.0, 0.0), (0.0, 0.0, 0.0), 2.0), 80.0),
     (regions.Box((-1.0, 2.0, -2.0, 2.0, -1.0, 1.0)), 12.0), (~regions.Box((-1.0, 2.0, -2.0, 2.0, -1.0, 1.0)), 88.0),
     (regions.Sphere((0.0, 0.0, 50.0), 1.0), 0.0), (~regions.Sphere((0.0, 0.0, 50.0), 1.0), 100.0),
     (pv.Cube(center=(0, 0, 0), x_length=4, y_length=6, z_length=2), 24.0)],
)  # fmt: skip
def test_areas_are_those_of_the_shapes(square, region, area):
    found = cut_surface(square, region)
    assert found.area == pytest.approx(area, rel=0.01, abs=1e-9)
    assert found.n_cells == 0 or np.allclose(found.compute_normals().cell_data["Normals"], (0, 0, 1))


def test_two_halves_make_the_whole():
    """A curved surface with normals, cut by another one: nothing is lost and nothing is there twice."""
    ball = pv.Sphere(radius=5.0, theta_resolution=40, phi_resolution=40)
    other = regions.Sphere((3.0, 1.0, 2.0), 4.0)
    inner, outer = cut_surface(ball, other), cut_surface(ball, ~other)
    assert inner.area + outer.area == pytest.approx(ball.area, rel=1e-7)
    # The part of a ball's surface in another ball: 2 pi R h, of the ball's own radius and the cap's height.
    distance = np.sqrt(14.0)
    height = 5.0 - (distance**2 + 25.0 - 16.0) / (2.0 * distance)
    assert inner.area == pytest.approx(2.0 * np.pi * 5.0 * height, rel=0.01)
    np.testing.assert_allclose(inner["Normals"], inner.points / 5.0, atol=0.01)


def test_what_cannot_be_cut_is_said(square):
    with pytest.raises(ValueError, match="no faces"):
        cut_surface(pv.PolyData(np.zeros((3, 3))), regions.Sphere((0, 0, 0), 1.0))
    with pytest.raises(TypeError, match="no region"):
        cut_surface(square, 3.0)
    strips = pv.Plane(i_resolution=4, j_resolution=4).strip()
    assert cut_surface(strips, regions.Plane((1, 0, 0), (0, 0, 0))).area == pytest.approx(0.5)
