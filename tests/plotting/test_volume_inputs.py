"""Volumes as users have them: every type of number, any place and size, and whatever else comes; right, or refused."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv

import pvfiblets.plotting.volumes.component  # noqa: F401 - for environments that were installed before it was there
from pvfiblets.engine import EngineError

X = np.linspace(-10.0, 10.0, 21)
BALL = np.maximum(120.0 - 12.0 * np.sqrt(X[:, None, None] ** 2 + X[:, None] ** 2 + X**2), 0.0).astype(np.float32)
BALL[:10] *= 0.75  # so that turning it over shows
BALL[:, :, :8] *= 0.5
WHOLE = np.rint(BALL)
PLACE = np.eye(4)
PLACE[:3, 3] = -10.0
MODES = {"isosurface": {"values": 30.0}, "composite": {"opacity": [0, 0.2]}, "mip": {}}
SIZE = 90


def picture(source, mode="isosurface", *, plotter=None, camera=None, **arguments):
    """A small picture, as the camera that PyVista sets by the bounds sees it."""
    own = pv.Plotter(off_screen=True, window_size=(SIZE, SIZE)) if plotter is None else plotter
    own.disable_anti_aliasing()
    arguments = {"show_scalar_bar": False, "cmap": "viridis", **MODES[mode], **arguments}
    actor = own.add_raycast_volume(source, mode=mode, **arguments)
    own.view_vector((0.5, -1.0, 0.4), viewup=(0, 0, 1))
    if camera is not None:
        camera(own)
    image = own.screenshot(None).astype(int)
    actor.raise_pending()
    if plotter is None:
        own.close()
    return image


def shows(image):
    return (image != image[0, 0]).any(-1)


@pytest.fixture(scope="module")
def plain():
    return {mode: picture((WHOLE, PLACE), mode) for mode in MODES}


# Numbers -------------------------------------------------------------------------------------------------------------


@pytest.mark.few(3)
@pytest.mark.parametrize(
    "dtype", ["i1", "u1", "u2", "i2", "i4", "u4", "i8", "u8", "f2", "f8", "g", ">i2", ">u2", ">f4", ">f8"]
)
def test_every_type_of_number_gives_the_same_picture(plain, dtype):
    for mode in ("isosurface", "mip"):
        off = np.abs(picture((WHOLE.astype(dtype), PLACE), mode) - plain[mode]).max(-1)
        assert (off > 3).sum() <= 12  # pixels at edges; samples of bytes are of 16 bits


def test_islands_of_nothing_change_nothing_else(plain):
    holed = WHOLE.copy()
    holed[11:14, 9:12, 9:12] = np.nan
    holed[10, 10, 18:], holed[0, 0, 0] = np.inf, -np.inf
    for mode in ("isosurface", "mip"):
        image = picture((holed, PLACE), mode, clim=(0, 120))
        assert shows(image).sum() > 0.8 * shows(plain[mode]).sum()
        assert shows(image).sum() < 1.3 * shows(plain[mode]).sum()


@pytest.mark.parametrize("value", [0.0, -1e37, 1e-40, np.nan])
def test_volumes_of_one_value(value):
    even = np.full((3, 3, 3), value, np.float32)
    assert not shows(picture(even, values=5.0)).any()
    seen = shows(picture(even, "mip", opacity=1.0))
    assert seen.sum() > 1000  # its colours begin at its value


def test_ranges_near_the_ends_of_float32_are_right(plain):
    for scale in (1e-29, 1e35):
        scaled = (WHOLE * np.float32(scale), PLACE)
        for mode in MODES:
            values = 30.0 * float(np.float32(scale))
            off = np.abs(picture(scaled, mode, values=values) - plain[mode]).max(-1)
            assert (off > 3).sum() <= 5


# Places --------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("scale", "far"), [(1e-6, 0.0), (1e6, 0.0), (1.0, 1e6), (1.0, -1e8)])
def test_voxels_of_any_size_anywhere_look_the_same(plain, scale, far):
    place = np.diag([scale, scale, scale, 1.0]) @ PLACE
    place[:3, 3] += far
    for mode in ("isosurface", "composite"):
        assert (np.abs(picture((WHOLE, place), mode) - plain[mode]).max(-1) > 3).sum() <= 5


@pytest.mark.few(4)
@pytest.mark.parametrize("axes", [(0, 1, 2), (1, 2, 0), (2, 1, 0)])
@pytest.mark.parametrize("flips", [(1, 1, -1), (-1, -1, -1)])
def test_the_order_of_voxels_does_not_matter(plain, axes, flips):
    stored = WHOLE.transpose(axes)[tuple(slice(None, None, flip) for flip in flips)]
    place = np.eye(4)
    place[:3, :3] = np.eye(3)[:, axes] * flips
    place[:3, 3] = place[:3, :3] @ np.full(3, -10.0)
    for mode in ("isosurface", "mip"):
        assert (np.abs(picture((stored, place), mode) - plain[mode]).max(-1) > 3).sum() <= 10


def test_sheared_places_and_matrices_look_as_meshes():
    """By the affine of the data, and by the actor's matrix: a contour of PyVista's, moved alike."""
    shear = np.array([[1.0, 0.0, 0.5, 0.0], [0.3, 1.0, 0.0, 0.0], [0.0, 0.0, 1.2, 0.0], [0.0, 0.0, 0.0, 1.0]])
    grid = pv.ImageData(dimensions=BALL.shape, origin=(-10, -10, -10))
    grid["v"] = BALL.ravel(order="F")
    surface = grid.contour([30.0]).transform(shear, inplace=False)

    def close(plotter):
        plotter.reset_camera(bounds=(-12, 12, -12, 12, -12, 12))

    other = pv.Plotter(off_screen=True, window_size=(SIZE, SIZE))
    other.disable_anti_aliasing()
    other.add_mesh(surface, color="black", lighting=False)
    other.view_vector((0.5, -1.0, 0.4), viewup=(0, 0, 1))
    close(other)
    wanted = shows(other.screenshot(None))
    other.close()
    black = {"color": "black", "lighting": False, "camera": close}
    for source, more in (((BALL, shear @ PLACE), {}), ((BALL, PLACE), {"user_matrix": shear})):
        found = shows(picture(source, **black, **more))
        assert wanted.sum() > 600
        assert (found != wanted).sum() < 0.05 * wanted.sum()


def test_volumes_beyond_the_limit_say_the_number():
    with pytest.raises(EngineError, match=r"300000 voxels along an axis, .*262144 at most; give octree=False"):
        picture(np.zeros((300_000, 2, 2), np.uint8))
    long = np.zeros((20_000, 2, 2), np.uint8)
    long[10_000:] = 1
    assert picture(long, mode="mip", clim=(0, 1), octree=False).any()
    assert picture(long, mode="mip", clim=(0, 1)).any()


# Scenes --------------------------------------------------------------------------------------------------------------


def test_volumes_are_cut_by_meshes_and_by_widgets_regions():
    """What is left of a ball without an octant, in all modes; cuts are named, live and copied."""
    corner = pv.Cube(bounds=(0, 20, -20, 0, 0, 20)).triangulate()
    for mode in MODES:
        plotter = pv.Plotter(off_screen=True, window_size=(SIZE, SIZE))
        whole = picture((WHOLE, PLACE), mode, plotter=plotter)
        (actor,) = plotter.raycast_volumes
        assert actor.clip(corner, inside=False) == "clip 1"
        plotter.render()
        less = plotter.screenshot(None).astype(int)
        # The greatest values of rays lie half way through the ball, which the octant that faces the eye does not reach.
        assert ((np.abs(less - whole).max(-1) > 8).sum() > 100) == (mode != "mip")
        actor.clip(corner, name="rest")  # with its inside nothing is left
        plotter.render()
        assert not shows(plotter.screenshot(None)).any()
        actor.unclip("rest")
        twin = actor.copy()
        assert list(twin.clips) == list(actor.clips) == actor.explain()["clips"] == ["clip 1"]
        actor.unclip()
        plotter.render()
        assert (plotter.screenshot(None) == whole).all()
        plotter.remove_actor(actor)
        plotter.add_actor(twin, reset_camera=False)
        plotter.render()
        assert (plotter.screenshot(None) == less).all()
        plotter.close()


def test_cuts_stay_in_the_world_when_the_volume_moves(plotter):
    """A half of a moved ball: the plane stays where it is."""
    actor = plotter.add_raycast_volume((WHOLE, PLACE), mode="mip", opacity=1.0, color="white", show_scalar_bar=False)
    plotter.disable_anti_aliasing()
    actor.clip(((1, 0, 0), (0, 0, 0)))
    plotter.camera_position = [(0, -100, 0), (0, 0, 0), (0, 0, 1)]
    plotter.enable_parallel_projection()
    plotter.camera.parallel_scale = 20.0
    plotter.camera.clipping_range = 20, 200
    for x in (0.0, 6.0, -6.0):
        actor.position = (x, 0, 0)
        columns = np.flatnonzero(shows(plotter.screenshot(None) if plotter._first_time else _rendered(plotter)).any(0))
        middle = plotter.window_size[0] / 2
        mm = plotter.window_size[1] / 40.0
        assert columns.min() == pytest.approx(middle, abs=1.0)
        assert columns.max() == pytest.approx(middle + (10.0 + x) * mm, abs=1.5)


def _rendered(plotter):
    plotter.render()
    return plotter.screenshot(None)


RED, BLUE, KAPPA = np.array([1.0, 0.2, 0.0]), np.array([0.0, 0.4, 1.0]), 0.06
