"""Surfaces cut by regions: areas and borders are those of the formulas, data is interpolated."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv

from pvfiblets import regions
from pvfiblets.plotting.cut_surfaces import cut_surface


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
    [
        (regions.Plane((1.0, 0.0, 0.0), (2.0, 0.0, 0.0)), 30.0),
        (~regions.Slab((0.0, 1.0, 0.0), (0.0, 0.0, 0.0), 2.0), 80.0),
        (regions.Box((-1.0, 2.0, -2.0, 2.0, -1.0, 1.0)), 12.0),
        (~regions.Box((-1.0, 2.0, -2.0, 2.0, -1.0, 1.0)), 88.0),
        (regions.Sphere((0.0, 0.0, 50.0), 1.0), 0.0),
        (~regions.Sphere((0.0, 0.0, 50.0), 1.0), 100.0),
        (pv.Cube(center=(0, 0, 0), x_length=4, y_length=6, z_length=2), 24.0),
    ],
)
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
