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


@pytest.mark.more
def test_every_order_of_memory_gives_the_same_picture(plain, tmp_path):
    for mode in ("isosurface", "composite"):
        for order in (
            np.asfortranarray(WHOLE),
            np.repeat(WHOLE, 2, 0)[::2],
            WHOLE[::-1, :, ::-1].copy()[::-1, :, ::-1],
        ):
            assert (picture((order, PLACE), mode) == plain[mode]).all()
    WHOLE.ravel(order="F").tofile(tmp_path / "v.raw")
    mapped = np.memmap(tmp_path / "v.raw", np.float32, "r", 0, WHOLE.shape, "F")
    assert (picture((mapped, PLACE)) == plain["isosurface"]).all()
    mask = picture((WHOLE > 30, PLACE), values=0.5)
    assert shows(mask).sum() == pytest.approx(shows(plain["isosurface"]).sum(), rel=0.05)


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


@pytest.mark.parametrize(
    ("values", "told"),
    [
        (BALL * np.float32(1e-42), "a range that float32, in which rays are cast, cannot compute with"),
        (np.where(BALL > 50, 3e38, -3e38), "run from -3e\\+38 to 3e\\+38, a range that"),
        (BALL.astype(float) * 1e60, "beyond float32's 3.40282e\\+38: scale them"),
        (BALL.astype("M8[s]"), "of type datetime64"),
        (BALL.astype(object), "of type object"),
        (np.ones(4), "three axes"),
        ([[[1, 2], [3]], [[1, 2], [3, 4]]], "rows are of unlike lengths"),
        ((BALL, "here"), "affine='here'; expected a \\(4, 4\\) matrix"),
        ((BALL, np.eye(3)), "give a finite \\(4, 4\\) matrix"),
        ((BALL, np.full((4, 4), np.nan)), "give a finite \\(4, 4\\) matrix"),
    ],
)
def test_numbers_that_cannot_be_shown_are_refused(plotter, values, told):
    with pytest.raises(ValueError, match=told):
        plotter.add_raycast_volume(values)
    assert not plotter.actors


@pytest.mark.parametrize("name", ["spacing", "origin", "direction", "affine"])
def test_words_for_places_are_refused_by_name(plotter, name):
    with pytest.raises(ValueError, match=f"{name}='there'; expected "):
        plotter.add_raycast_volume(BALL, **{name: "there"})


def test_ranges_near_the_ends_of_float32_are_right(plain):
    for scale in (1e-29, 1e35):
        scaled = (WHOLE * np.float32(scale), PLACE)
        for mode in MODES:
            values = 30.0 * float(np.float32(scale))
            off = np.abs(picture(scaled, mode, values=values) - plain[mode]).max(-1)
            assert (off > 3).sum() <= 5


# Places --------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_voxels_of_any_size_look_the_same(plain, scale):
    for mode in MODES:
        image = picture((WHOLE, np.diag([scale, scale, scale, 1.0]) @ PLACE), mode)
        assert (np.abs(image - plain[mode]).max(-1) > 3).sum() <= 5


@pytest.mark.parametrize("far", [1e6, -1e8])
def test_volumes_far_away_look_the_same(plain, far):
    moved = PLACE.copy()
    moved[:3, 3] += far
    for mode in MODES:
        assert (np.abs(picture((WHOLE, moved), mode) - plain[mode]).max(-1) > 3).sum() <= 5


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


def test_matrices_that_flatten_show_nothing():
    assert not shows(picture((BALL, PLACE), user_matrix=np.diag([1.0, 0.0, 1.0, 1.0]))).any()


@pytest.mark.few(1)
@pytest.mark.parametrize("box", [(30, 40, 0, 5, 0, 5), (-5, -1, 0, 20, 0, 20), (0, 20, 21, 30, 0, 20)])
def test_boxes_beside_the_volume_show_nothing(box):
    for mode in MODES:
        assert not shows(picture((BALL + 1.0, PLACE), mode, opacity=[0.5, 1], box=box)).any()


def test_volumes_beyond_the_limit_say_the_number():
    with pytest.raises(EngineError, match=r"300000 voxels along an axis, .*262144 at most; give octree=False"):
        picture(np.zeros((300_000, 2, 2), np.uint8))
    long = np.zeros((20_000, 2, 2), np.uint8)
    long[10_000:] = 1
    assert picture(long, mode="mip", clim=(0, 1), octree=False).any()
    assert picture(long, mode="mip", clim=(0, 1)).any()


# Files ---------------------------------------------------------------------------------------------------------------


def test_nifti_files_of_several_volumes_and_oblique_ones(tmp_path):
    nib = pytest.importorskip("nibabel")
    turn = np.eye(4)
    turn[:3, :3] = np.array([[0.8, -0.6, 0.0], [0.6, 0.8, 0.0], [0.0, 0.0, -1.5]])
    turn[:3, 3] = 12.5, -3.0, 1e4
    nib.save(nib.Nifti1Image(WHOLE.astype(np.int16), turn), tmp_path / "one.nii.gz")
    nib.save(nib.Nifti1Image(np.stack([WHOLE] * 2, -1).astype(np.int16), turn), tmp_path / "two.nii")
    assert (picture(tmp_path / "one.nii.gz") == picture((WHOLE, turn.astype(np.float32)))).mean() > 0.99
    plotter = pv.Plotter(off_screen=True)
    with pytest.raises(ValueError, match=r"two.nii has the shape \(21, 21, 21, 2\)"):
        plotter.add_raycast_volume(tmp_path / "two.nii")
    (tmp_path / "cut.nii").write_bytes((tmp_path / "two.nii").read_bytes()[:500])
    with pytest.raises(ValueError, match="cut.nii"):
        plotter.add_raycast_volume(tmp_path / "cut.nii")
    plotter.close()


# Scenes --------------------------------------------------------------------------------------------------------------


def test_actors_leave_and_come_back_and_go_to_other_windows(plain):
    first = pv.Plotter(off_screen=True, window_size=(SIZE, SIZE))
    assert (picture((WHOLE, PLACE), "mip", plotter=first) == plain["mip"]).all()
    (actor,) = first.raycast_volumes
    first.remove_actor(actor)
    first.render()
    assert not shows(first.screenshot(None)).any()
    assert actor.explain()["gpu_bytes"] == 0
    first.add_actor(actor, reset_camera=False)
    first.render()
    assert (first.screenshot(None) == plain["mip"]).all()
    second = pv.Plotter(off_screen=True, window_size=(SIZE, SIZE))
    second.disable_anti_aliasing()
    second.add_actor(actor.copy())
    second.camera_position = first.camera_position
    assert np.abs(second.screenshot(None).astype(int) - plain["mip"]).max() <= 1
    second.clear_actors()
    second.add_actor(actor)
    assert np.abs(second.screenshot(None).astype(int) - plain["mip"]).max() <= 1
    first.remove_actor(actor)
    first.close()
    second.close()


def test_enlarged_pictures_show_the_same(plain):
    for mode in ("composite", "mip"):
        plotter = pv.Plotter(off_screen=True, window_size=(SIZE, SIZE))
        picture((WHOLE, PLACE), mode, plotter=plotter)
        large = plotter.screenshot(None, scale=2).astype(float)
        small = large.reshape(SIZE, 2, SIZE, 2, 3).mean((1, 3))
        assert np.quantile(np.abs(small - plain[mode]), 0.99) < 12
        plotter.close()


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


def test_cuts_that_mean_nothing_are_refused(plotter):
    actor = plotter.add_raycast_volume(BALL)
    for what, error, told in (
        (pv.Plane(), ValueError, "open"),
        (pv.PolyData(), ValueError, "no faces"),
        (3.0, TypeError, "is no region"),
        (pv.ImageData(dimensions=(3, 3, 3)), ValueError, "active data"),
    ):
        with pytest.raises(error, match=told):
            actor.clip(what)
    with pytest.raises(KeyError, match="there is no cut 'x'; there are: none"):
        actor.unclip("x")
    assert not actor.clips


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


def _two_fogs(shift, peeling, order):
    """The colour of two fogs of 20 mm, the blue one shifted away from the eye."""
    plotter = pv.Plotter(off_screen=True, window_size=(30, 30))
    plotter.disable_anti_aliasing()
    plotter.set_background("black")
    if peeling:
        plotter.enable_depth_peeling(8)
    for which in order:
        place = np.diag([5.0, 5.0, 5.0, 1.0])
        place[:3, 3] = -10.0, -10.0 + shift * which, -10.0
        light = {"opacity": 1.0 - np.exp(-KAPPA), "opacity_unit_distance": 1.0, "clim": (0, 2), "stop": 1.0}
        fog = (np.ones((5, 5, 5), np.uint8), place)
        plotter.add_raycast_volume(fog, color=(RED, BLUE)[which], show_scalar_bar=False, **light)
    plotter.camera_position = [(0, -100, 0), (0, 0, 0), (0, 0, 1)]
    plotter.enable_parallel_projection()
    plotter.camera.parallel_scale = 8
    plotter.camera.clipping_range = 20, 300
    colour = plotter.screenshot(None)[15, 15].astype(float)
    plotter.close()
    return colour


@pytest.mark.more
@pytest.mark.parametrize("order", [(0, 1), (1, 0)])
def test_two_volumes_in_a_pixel_are_what_the_docs_say(order):
    """Without depth peeling right in one place, with it one behind the other; whatever the order."""
    left = np.exp(-KAPPA * 20.0)
    together = 255.0 * (1.0 - left**2) * (RED + BLUE) / 2.0
    behind = 255.0 * (1.0 - left) * (RED + left * BLUE)
    assert _two_fogs(0.0, False, order) == pytest.approx(together, abs=1.5)
    for shift in (20.0, 30.0):
        assert _two_fogs(shift, True, order) == pytest.approx(behind, abs=1.5)
    # Neither is right between: the docs tell how far off.
    assert np.abs(_two_fogs(30.0, False, order) - behind).max() == pytest.approx(62.0, abs=3.0)
    assert np.abs(_two_fogs(0.001, True, order) - together).max() == pytest.approx(62.0, abs=3.0)


@pytest.mark.parametrize(
    ("setting", "wrong", "told"),
    [
        ("step", "x", "step is 'x'; give a number of voxels from 0.001 to 1000"),
        ("stop", "x", "stop is 'x'; give an opacity above 0, at most 1"),
        ("homogeneous", "x", "homogeneous is 'x'; give a difference of values"),
        ("iterations", 2.5, "iterations is 2.5; give a whole number from 1 to 64"),
        ("iterations", "x", "iterations is 'x'"),
        ("box", "corner", "box is 'corner'; give \\(xmin"),
        ("peak", "x", "peak is 'x'; give the least value of a peak"),
        ("opacity_unit_distance", "x", "opacity_unit_distance is 'x'; give a length above 0, mm"),
        ("smooth", "x", "sigma='x'; expected one or three finite numbers"),
        ("values", 1e40, "finite numbers that float32 holds"),
        ("cmap", [], "cmap is an empty list"),
    ],
)
def test_words_and_numbers_out_of_range_are_refused_by_name(setting, wrong, told):
    plotter = pv.Plotter(off_screen=True)
    actor = plotter.add_raycast_volume(BALL, mode="isosurface" if setting == "values" else "composite")
    with pytest.raises(ValueError, match=told):
        plotter.add_raycast_volume(BALL, mode=actor.mode, **{setting: wrong})
    with pytest.raises(ValueError, match=told):
        setattr(actor, setting, wrong)
    assert len(plotter.raycast_volumes) == 1
    plotter.close()
