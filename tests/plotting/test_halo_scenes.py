"""Halos in whole scenes: both eyes of stereo pictures, other actors and passes, pickers, and fiblets' own halos."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv
from vtkmodules.vtkCommonDataModel import vtkPlane

from .views import facing
from .views import shot as plain_shot

BACK = 211  # lightgrey


def curves(count=30, points=150, seed=0):
    """Arcs about 90 mm across, around the origin."""
    random = np.random.default_rng(seed)
    found = []
    for _ in range(count):
        t = np.linspace(0, 4, points) + random.uniform(0, 6)
        found.append(np.c_[20 * np.cos(t), 20 * np.sin(t), 4 * t] + random.normal(size=3) * 10 - (0, 0, 20))
    return found


def opened(**options):
    plotter = pv.Plotter(off_screen=True, **{"window_size": (200, 160), **options})
    plotter.disable_anti_aliasing()
    plotter.set_background("lightgrey")
    return plotter


def looked_at(plotter):
    plotter.camera_position = [(60, -150, 70), (0, 0, 0), (0, 0, 1)]
    plotter.camera.clipping_range = 60, 300


def shot(plotter):
    return plain_shot(plotter)[..., :3].astype(int)


@pytest.fixture(scope="module")
def eyes():
    """A picture for every kind of stereo that VTK has for a flat screen, and one of a single eye."""
    plotter = opened()
    plotter.add_halo_lines(curves(), line_width=0.8, strip_width=4.0, color="darkred", halo_color="white")
    dots = np.random.default_rng(1).normal(size=(200, 3)) * 12
    plotter.add_halo_points(dots, point_size=1.5, halo_size=5.0, light_on_dark=False)
    plotter.add_mesh(pv.Sphere(radius=10, center=(20, 0, 0)), color="steelblue")
    looked_at(plotter)
    found = {"mono": shot(plotter)}
    plotter.enable_stereo_render()
    found["PyVista's"] = shot(plotter)
    for kind in ("Left", "Right", "RedBlue", "Anaglyph", "Interlaced", "Dresden", "Checkerboard",
                 "SplitViewportHorizontal"):  # fmt: skip
        getattr(plotter.render_window, f"SetStereoTypeTo{kind}")()
        found[kind] = shot(plotter)
    plotter.disable_stereo_render()
    assert (shot(plotter) == found["mono"]).all()

    plotter.close()
    return found


def test_each_eye_sees_its_own_picture(eyes):
    """As much of them differs as of VTK's own lines would, and each is a picture of lines and halos."""
    assert 0.02 < (eyes["Left"] != eyes["Right"]).any(-1).mean() < 0.3
    for eye in ("Left", "Right"):
        assert (eyes[eye] != eyes["mono"]).any()
        for colour in ((139, 0, 0), (255, 255, 255), (BACK, BACK, BACK)):
            assert (eyes[eye] == colour).all(-1).sum() > 300


def test_pictures_for_two_eyes_hold_both(eyes):
    """In red and blue (VTK's anaglyph takes part of the saturation away besides), and woven in every way."""
    wanted = np.zeros_like(eyes["Left"])
    wanted[..., 0], wanted[..., 2] = eyes["Left"].sum(-1) // 3, eyes["Right"].sum(-1) // 3
    assert (eyes["RedBlue"] == wanted).all()
    assert (eyes["PyVista's"] == eyes["Anaglyph"]).all()
    rows, columns = np.mgrid[:160, :200]
    left_of = {"Interlaced": rows % 2 == 1, "Dresden": columns % 2 == 0, "Checkerboard": (rows + columns) % 2 == 1}
    for kind, left in left_of.items():
        wanted = np.where(left[..., None], eyes["Left"], eyes["Right"])
        assert (eyes[kind] == wanted).all(), kind
    halves = np.concatenate([eyes["Left"][:, ::2], eyes["Right"][:, ::2]], axis=1)
    assert (eyes["SplitViewportHorizontal"] == halves).all()


def ink(picture):
    """0: background, 1: line, 2: halo."""
    return np.where((picture == 0).all(-1), 1, np.where((picture == 255).all(-1), 2, 0))


@pytest.mark.few(2)
@pytest.mark.parametrize("effect", ["peeling", "ssao", "eye dome", "shadows"])
def test_passes_of_vtk_leave_lines_and_halos_what_they_are(effect):
    plotter = opened()
    plotter.add_halo_lines(curves(), line_width=0.8, strip_width=4.0, halo_color="yellow", smooth=False)
    plotter.add_mesh(pv.Sphere(radius=10, center=(20, 0, 0)), color="steelblue", lighting=False)
    looked_at(plotter)
    plain = shot(plotter)
    if effect == "peeling":
        plotter.enable_depth_peeling()
    elif effect == "ssao":
        plotter.enable_ssao(radius=6)
    elif effect == "eye dome":
        plotter.enable_eye_dome_lighting()
    else:
        plotter.enable_shadows()
    after = shot(plotter)
    line = (plain == 0).all(-1)
    assert (after[line] == 0).all(-1).mean() > 0.97  # darker than black there is nothing
    if effect == "peeling":
        assert (after == plain).all()
    halo = (plain == (255, 255, 0)).all(-1)
    assert (after[halo][:, 2] == 0).mean() > 0.97
    plotter.close()


def test_translucent_meshes_are_seen_between_lines_and_behind(plotter):
    plotter.set_background("white")
    plotter.add_halo_lines([[(-20, 0, 0), (20, 0, 0)]], line_width=4, strip_width=16, max_displacement=10)
    for y, colour in ((-5, "red"), (5, "blue")):
        wall = pv.Plane(center=(0, y, 0), direction=(0, 1, 0), i_size=60, j_size=60)
        plotter.add_mesh(wall, color=colour, opacity=0.5, lighting=False)
    plotter.enable_depth_peeling()
    facing(plotter)
    column = shot(plotter)[:, 100]
    assert np.abs(column[100] - (128, 0, 0)).max() <= 2  # the line, behind red, before blue
    assert np.abs(column[100 - 13] - (255, 128, 128)).max() <= 2  # halo, 2.6 mm: 3 mm back, before blue
    assert np.abs(column[100 - 35] - (191, 64, 128)).max() <= 2  # halo, 7 mm: 8.8 mm back, behind both


def test_clipping_planes_and_boxes_cut_both_lines_and_points(plotter):
    rows = [[(-20, 0, z), (20, 0, z)] for z in (-5, 5)]
    actor = plotter.add_halo_lines(rows, line_width=1, strip_width=4, light_on_dark=True, tapering=False)
    points = plotter.add_halo_points(
        np.array([(x, 0, 12) for x in (-10.0, -1.0, 0.5, 10.0)]), point_size=2, halo_size=3, light_on_dark=True
    )
    facing(plotter)
    plane = vtkPlane()
    plane.SetNormal(1, 0, 0)
    for one in (actor, points):
        one.mapper.AddClippingPlane(plane)
    picture = shot(plotter).max(-1) > 0
    x = (np.arange(200) - 99.5) / 5
    assert not picture[60:, x < -0.2].any()
    assert picture[75, x > 0.2].all()  # z = 5
    found = picture[:60].any(axis=0)
    assert found[np.abs(x - 0.5) < 0.8].all()  # points are there as a whole, by their middles
    assert not found[x < -1].any()
