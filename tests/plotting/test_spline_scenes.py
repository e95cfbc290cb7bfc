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
