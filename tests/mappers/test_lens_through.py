"""Depth of field of what hides nothing: light and peaks of volumes, and glass, lie where they begin."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv

from pvfiblets.mappers.frames.scene import lenses

SIZE, FAR, FRONT = (200, 150), 100.0, 20.0
N = 49


def slab():
    """A slab whose values rise from its front to a depth of 4 mm, in squares across the view."""
    x = np.linspace(-24.0, 24.0, N)
    at = np.stack(np.meshgrid(x, x, x, indexing="ij"), axis=-1)
    inside = np.clip((FRONT - np.abs(at[..., 2])) / 4.0, 0.0, 1.0)
    return (inside * (0.8 + 0.2 * np.sign(np.sin(at[..., 0] * 1.3) * np.sin(at[..., 1] * 1.3)))).astype(np.float32)


LOOKS = {
    "light": {"mode": "composite", "opacity": [0, 0.7, 0.9, 1], "opacity_unit_distance": 0.5},
    "peaks": {"mode": "mip", "opacity": [0, 0.7, 0.9, 1]},
    "first peaks": {"mode": "local-mip", "peak": 0.15, "opacity": [0, 0.7, 0.9, 1]},
    "glass": {"mode": "isosurface", "values": 0.5, "opacity": 0.7},
}


NEAREST = {"light": 80.0, "peaks": 84.0, "first peaks": 84.0, "glass": 82.4}  # mm from the eye, in the middle


@pytest.fixture
def scene():
    made = []

    def make(**look):
        plotter = pv.Plotter(off_screen=True, window_size=SIZE)
        made.append(plotter)
        plotter.set_background("navy")
        actor = plotter.add_raycast_volume(
            slab(), origin=(-24, -24, -24), clim=(0, 1), cmap="gray", show_scalar_bar=False, **look
        )
        plotter.camera_position = [(0, 0, FAR), (0, 0, 0), (0, 1, 0)]
        plotter.enable_parallel_projection()  # slanted rays would find greater values behind
        plotter.camera.parallel_scale = 26.0
        plotter.show(auto_close=False)
        return plotter, actor

    yield make
    for plotter in made:
        plotter.close()


def shot(plotter):
    plotter.render()
    return np.array(plotter.screenshot(return_img=True)).astype(int)


@pytest.mark.few(1)
@pytest.mark.parametrize("look", LOOKS)
def test_what_is_in_focus_is_sharp_and_the_rest_is_not(scene, look):
    plotter, actor = scene(**LOOKS[look])
    sharp = shot(plotter)
    middle = (slice(60, 90), slice(85, 115))
    detail = np.abs(np.diff(sharp[middle], axis=1)).mean()
    off = {}
    for distance in (NEAREST[look], 4 * FAR):
        plotter.picture.depth_of_field = {"focal_distance": distance, "aperture": 8.0}
        off[distance] = np.abs(shot(plotter)[middle] - sharp[middle]).mean()
    assert off[NEAREST[look]] < 0.2 * detail
    assert off[4 * FAR] > 0.5 * detail
    assert not lenses  # nothing is kept between frames


@pytest.mark.parametrize("look", ["light", "first peaks", "glass"])
def test_the_focus_follows_what_one_looks_at(scene, look):
    plotter, actor = scene(**LOOKS[look])
    plotter.picture.depth_of_field = {"focal_distance": "center"}
    plotter.render()
    assert plotter.picture.focal_distance == pytest.approx(NEAREST[look], abs=1.5)


@pytest.mark.few(1)
@pytest.mark.parametrize("look", ["light", "peaks"])
def test_what_hardly_shows_is_not_looked_at(scene, look):
    """A mesh behind a box of air stays as it was with the same box of nothing at all."""
    options = dict(LOOKS[look], opacity=[0, 0, 0, 0, 0, 0, 0, 1], thresholds=(0.0, None))
    pictures = []
    for visible in (True, False):
        plotter, actor = scene(**options)
        actor.volume = type(actor.volume)(np.full((N, N, N), 0.05, np.float32), actor.volume.affine)
        actor.visibility = visible
        plotter.add_mesh(pv.Plane(center=(0, 0, -40), i_size=60, j_size=60), color="tomato", show_edges=True)
        plotter.picture.depth_of_field = {"focal_distance": FAR + 40.0, "aperture": 8.0}
        pictures.append(shot(plotter))
    assert np.abs(pictures[0] - pictures[1]).max() <= 2


def test_fog_in_front_of_a_mesh_keeps_the_depth_of_the_mesh_behind_faint_light(scene):
    plotter, actor = scene(mode="composite", opacity=[0, 0.0002], opacity_unit_distance=1.0)
    plotter.add_mesh(pv.Plane(center=(0, 0, -40), i_size=60, j_size=60, i_resolution=20), show_edges=True)
    sharp = shot(plotter)
    plotter.picture.depth_of_field = {"focal_distance": FAR + 40.0, "aperture": 8.0}
    assert np.abs(shot(plotter) - sharp).max() <= 3
