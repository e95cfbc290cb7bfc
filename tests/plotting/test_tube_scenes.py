"""Spline tubes among VTK's meshes, lamps and passes look as meshes of the same shape do."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv

BAR = np.array([(x, 0.0, 0.0) for x in np.linspace(-20.0, 20.0, 5)])
RADIUS = 4.0


@pytest.fixture
def both():
    """Return a function: pictures of a bar as a tube and as a mesh, in the same scene."""

    def pictures(arrange):
        found = []
        for kind in ("tube", "mesh"):
            plotter = pv.Plotter(off_screen=True, window_size=(200, 160), lighting="none")
            plotter.set_background("black")
            plotter.disable_anti_aliasing()
            if kind == "tube":
                actor = plotter.add_spline_tubes(BAR, radius=RADIUS, color="white")
            else:
                bar = pv.Cylinder(radius=RADIUS, height=40.0, resolution=180, capping=False)
                balls = [pv.Sphere(radius=RADIUS, center=(x, 0, 0), theta_resolution=90, phi_resolution=90)
                         for x in (-20.0, 20.0)]  # fmt: skip
                actor = plotter.add_mesh(pv.merge([bar, *balls]), color="white", smooth_shading=True)
            plotter.camera_position = [(30, -70, 60), (0, 0, -5), (0, 0, 1)]
            arrange(plotter, actor)
            plotter.show(auto_close=False)
            found.append(plotter.screenshot(None)[..., :3].astype(int))
            plotter.close()
        return found

    return pictures


def lamp(plotter, *, positional):
    light = pv.Light(position=(20, -30, 80), focal_point=(0, 0, 0), light_type="scene light", cone_angle=60)
    light.positional = positional
    plotter.add_light(light)
    plotter.add_mesh(pv.Plane(center=(0, 0, -15), i_size=100, j_size=100), color="white")


@pytest.mark.few(1)
@pytest.mark.parametrize("positional", [True, False])
def test_shadows_fall_as_those_of_meshes(both, positional):
    def dark(plotter, _actor):
        lamp(plotter, positional=positional)
        plotter.enable_shadows()

    def bright(plotter, _actor):
        lamp(plotter, positional=positional)

    tube, mesh = both(dark)
    assert (np.abs(tube - mesh).max(axis=2) > 40).mean() < 2e-3
    assert ((both(bright)[0] - tube).max(axis=2) > 40).mean() > 0.05  # the shadow on the floor


def test_culling_of_front_faces_leaves_tubes_as_they_are(both):
    """What is drawn has fronts only, without which nothing would be left."""

    def culled(plotter, actor):
        lamp(plotter, positional=False)
        actor.prop.culling = "front" if "Spline" in type(actor).__name__ else "none"

    tube, mesh = both(culled)
    assert (np.abs(tube - mesh).max(axis=2) > 40).mean() < 2e-3


SHEAR = np.array([(1, 0.2, 0.5, 3), (-0.3, 1, 0, 0), (0, 0.4, 0.7, -2), (0, 0, 0, 1)], float)


@pytest.mark.few(2)
@pytest.mark.parametrize("effect", ["shear", "ssao", "eye dome", "stereo", "parallel", "volume"])
def test_other_passes_and_places_show_the_same_as_for_meshes(both, effect):
    grid = pv.ImageData(dimensions=(9, 9, 9), spacing=(4, 4, 4), origin=(-16, -16, -16))
    grid["far"] = np.linalg.norm(grid.points, axis=1)

    def arrange(plotter, actor):
        lamp(plotter, positional=False)
        if effect == "shear":
            actor.user_matrix = SHEAR
        elif effect == "ssao":
            plotter.enable_ssao(radius=6)
        elif effect == "eye dome":
            plotter.enable_eye_dome_lighting()
        elif effect == "stereo":
            plotter.enable_stereo_render()
        elif effect == "parallel":
            plotter.enable_parallel_projection()
        else:
            plotter.add_volume(grid, opacity=[0.0, 0.2, 0.4], show_scalar_bar=False)

    tube, mesh = both(arrange)
    assert (tube.max(axis=2) > 0).mean() > 0.1
    assert (np.abs(tube - mesh).max(axis=2) > 40).mean() < 4e-3


def test_peeling_supersampling_and_a_second_window_show_the_tubes(plotter):
    actor = plotter.add_spline_tubes(BAR, radius=RADIUS, color="white", lighting=False)
    plotter.view_xz()
    plotter.show(auto_close=False)
    plain = plotter.screenshot(None)
    plotter.enable_depth_peeling()
    plotter.render()
    assert (plotter.screenshot(None) == plain).all()
    plotter.disable_depth_peeling()
    other = pv.Plotter(off_screen=True, window_size=plotter.window_size)
    other.set_background("black")
    other.add_actor(actor)
    other.camera_position = plotter.camera_position
    for _ in range(2):
        plotter.render()
        assert (plotter.screenshot(None) == plain).all()
        assert other.screenshot(None).any()
    other.close()
    plotter.enable_anti_aliasing("ssaa")
    plotter.render()
    smooth = plotter.screenshot(None)
    assert ((smooth > 0) & (smooth < 255)).any()
    assert smooth.sum(dtype=float) == pytest.approx(plain.sum(dtype=float), rel=0.02)
