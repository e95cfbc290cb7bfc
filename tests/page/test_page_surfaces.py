"""Edges and culled faces of surfaces of pages, beside VTK's."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv

from tests.page.pages import differing

CULLING = {
    "front": {"culling": "front"},
    "back": {"culling": "back"},
    "front, of a mirrored one": {"culling": "front", "user_matrix": np.diag([-1.0, 1.0, 1.0, 1.0])},
}


@pytest.fixture
def plotter():
    plotter = pv.Plotter(off_screen=True, window_size=(200, 160))
    plotter.set_background("white")
    plotter.disable_anti_aliasing()
    yield plotter
    plotter.close()


def _agrees(plotter, visit, tmp_path):
    plotter.view_vector((1.0, -0.7, 0.4))
    plotter.camera.zoom(1.5)
    expected = plotter.screenshot(return_img=True)
    page = visit(plotter.fiblets.export_page(tmp_path / "figure.html")[0])
    wrong, drawn = differing(page.picture(), expected)
    assert drawn > 0.15
    assert wrong < 0.015  # of which most are where surfaces end


def test_edges_of_triangles_and_of_polygons(plotter, visit, tmp_path):
    """By values of points, by colours of cells, smooth, translucent; with edges of any width and opacity."""
    ball = pv.Sphere(radius=1.0, theta_resolution=12, phi_resolution=9)
    ball["height"] = ball.points[:, 2]
    plotter.add_mesh(ball, scalars="height", show_edges=True, edge_color="red", line_width=3, show_scalar_bar=False)
    cube = pv.Cube(center=(0.0, -2.0, 0.0))
    cube.cell_data["side"] = np.arange(6.0)
    plotter.add_mesh(cube, scalars="side", show_edges=True, edge_opacity=0.5, line_width=5, show_scalar_bar=False)
    prism = pv.Cylinder(center=(0.0, 2.0, 0.0), direction=(0.0, 0.0, 1.0), resolution=7)
    plotter.add_mesh(prism, color="tan", smooth_shading=True, show_edges=True, specular=0.6, opacity=0.7)
    _agrees(plotter, visit, tmp_path)


@pytest.mark.few(1)
@pytest.mark.parametrize("case", CULLING)
def test_culled_faces(case, plotter, visit, tmp_path):
    shell = pv.Sphere(radius=1.0, theta_resolution=24, phi_resolution=18).clip("z", value=0.4)
    plotter.add_mesh(shell, color="teal", **CULLING[case])
    _agrees(plotter, visit, tmp_path)
