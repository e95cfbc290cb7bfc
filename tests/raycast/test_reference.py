"""The float64 reference of rays through volumes against closed forms, and against plain NumPy on noise."""

from __future__ import annotations

import hypothesis
import numpy as np
import pytest
from hypothesis import strategies as st

from pvfiblets.raycast.reference import Rays, composite, gradient, isosurface, mip, rays, sample
from pvfiblets.raycast.reference_profiles import profiles
from pvfiblets.raycast.transfer import Transfer
from pvfiblets.raycast.volume import FILTERS, RaycastVolume

from .analytic import GRIDS, Ball, Gaussian, Layers, Plane, camera, middle, within

SIZE = (32, 24)
SHAPE = (20, 18, 16)
VIEWS = {"perspective": {}, "parallel": {"height": 24.0}}


def view(affine, shape=SHAPE, *, away=(30, 20, 10), **choices):
    at = middle(shape, affine)
    return camera(at + away, at, **choices)


def noise(shape=(7, 6, 8), seed=0, affine=None, dtype=np.float32):
    values = np.random.default_rng(seed).random(shape)
    if np.dtype(dtype).kind in "ui":
        values *= 255
    return RaycastVolume(values.astype(dtype), affine)


def straight(origin, direction, far, *, near=0.0):
    """One ray."""
    direction = np.array(direction, float)
    return Rays(
        np.array([origin], float), direction[None] / np.linalg.norm(direction), np.full(1, near), np.full(1, far),
        np.eye(4),
    )  # fmt: skip


def trilinear(values, places):
    """By the eight corners."""
    values = values.astype(float)
    low = np.clip(np.floor(places).astype(int), 0, np.array(values.shape) - 2)
    u = places - low
    found = 0.0
    for corner in np.ndindex(2, 2, 2):
        weight = np.prod(np.where(corner, u, 1 - u), axis=-1)
        found = found + weight * values[tuple(np.moveaxis(low + corner, -1, 0))]
    return found


def tricubic(values, places):
    """By Catmull-Rom's weights of 4 x 4 x 4 voxels; the last one repeats."""
    low = np.clip(np.floor(places).astype(int), 0, np.array(values.shape) - 2)
    u = places - low
    weights = np.stack([
        -u**3 / 2 + u**2 - u / 2, 1.5 * u**3 - 2.5 * u**2 + 1, -1.5 * u**3 + 2 * u**2 + u / 2, u**3 / 2 - u**2 / 2
    ], axis=-1)  # fmt: skip
    found = 0.0
    for i, j, k in np.ndindex(4, 4, 4):
        at = np.clip(low + np.array([i, j, k]) - 1, 0, np.array(values.shape) - 1)
        weight = weights[..., 0, i] * weights[..., 1, j] * weights[..., 2, k]
        found = found + weight * values[tuple(np.moveaxis(at, -1, 0))]
    return found


def nearest(values, places):
    return values[tuple(np.moveaxis(np.floor(places + 0.5).astype(int), -1, 0))].astype(float)


PLAIN = {"nearest": nearest, "trilinear": trilinear, "tricubic": tricubic}


def along(volume, through, how, n):
    """t and plain samples along those of the rays that are in the volume, n + 1 each."""
    some = through[~np.isnan(through.near)]
    t = some.near[:, None] + (some.far - some.near)[:, None] * np.linspace(0, 1, n + 1)
    places = some.origins[:, None] + t[..., None] * some.directions[:, None]
    voxels = places @ volume.inverse[:3, :3].T + volume.inverse[:3, 3]
    voxels = np.clip(voxels, 0, np.array(volume.shape) - 1.0)
    return some, t, PLAIN[how](volume.values, voxels)


# --------------------------------------------------------------------------------------------------------------- rays


@pytest.mark.parametrize("name", VIEWS)
@pytest.mark.parametrize("grid", GRIDS)
def test_rays_go_through_the_centres_of_pixels_and_the_box_of_the_voxels(grid, name):
    affine = GRIDS[grid]
    matrix = view(affine, **VIEWS[name])
    through = rays(matrix, SIZE, RaycastVolume(np.zeros(SHAPE, np.uint8), affine))
    assert np.abs(np.linalg.norm(through.directions, axis=-1) - 1).max() < 1e-12
    y, x = np.mgrid[:24, :32] + 0.5
    for t in (np.zeros(x.shape), np.full(x.shape, 35.0)):
        clip = through.points(t) @ matrix[:, :3].T + matrix[:, 3]
        assert (clip[..., 3] > 0).all()
        assert np.abs((clip[..., 0] / clip[..., 3] + 1) * 16 - x).max() < 1e-9
        assert np.abs((clip[..., 1] / clip[..., 3] + 1) * 12 - y).max() < 1e-9
        assert np.abs(through.depth(t) - (clip[..., 2] / clip[..., 3] + 1) / 2).max() < 1e-12
    assert np.abs(through.depth(np.zeros(x.shape))).max() < 1e-12  # they begin on the near plane
    inverse = np.linalg.inv(affine)

    def outside(t):
        places = through.points(t) @ inverse[:3, :3].T + inverse[:3, 3]
        return np.maximum(-places, places - (np.array(SHAPE) - 1)).max(axis=-1)

    seen = ~np.isnan(through.near)
    assert 50 < seen.sum() < seen.size
    assert np.abs(outside(through.near)[seen]).max() < 1e-9
    assert np.abs(outside(through.far)[seen]).max() < 1e-9
    t = np.linspace(0, 100, 2001)[:, None, None] * np.ones(x.shape)
    assert (outside(t).min(axis=0)[~seen] > 0).all()


def test_a_camera_inside_sees_from_its_near_plane_on():
    volume = RaycastVolume(np.zeros(SHAPE, np.uint8))
    through = rays(camera((9, 8, 7), (3, 2, 1), near=0.5, far=30.0), SIZE, volume)
    assert (through.near == 0).all()
    # Nearer ends than the far side: the far plane itself.
    short = rays(camera((9, 8, 7), (3, 2, 1), near=0.5, far=2.0), SIZE, volume)
    assert np.abs(short.depth(short.far) - 1).max() < 1e-12


def test_planes_box_and_opaque_things_end_rays():
    volume = RaycastVolume(np.zeros(SHAPE, np.uint8))
    matrix = view(np.eye(4))
    whole = rays(matrix, SIZE, volume)
    planes = np.array([[2.0, 0, 0, -10], [-1, 0, -1, 20]])
    cut = rays(matrix, SIZE, volume, clip_planes=planes, box=(0, 19, 4, 9, -50, 50))
    seen = ~np.isnan(cut.near)
    assert 20 < seen.sum() < (~np.isnan(whole.near)).sum()
    assert (cut.near >= whole.near)[seen].all()
    assert (cut.far <= whole.far)[seen].all()
    for t in (cut.near, cut.far):
        p = cut.points(t)[seen]
        sides = [
            2 * p[:, 0] - 10,
            20 - p[:, 0] - p[:, 2],
            p[:, 1] - 4,
            9 - p[:, 1],
            p[:, 2],
            15 - p[:, 2],
            19 - p[:, 0],
        ]
        assert np.abs(np.min(sides, axis=0)).max() < 1e-9  # on the nearest of them
    depths = np.ones(whole.near.shape)
    depths[:12] = whole.depth((whole.near + whole.far) / 2)[:12]
    stopped = rays(matrix, SIZE, volume, depths=depths)
    seen = ~np.isnan(whole.near)
    expected = whole.far.copy()
    expected[:12] = ((whole.near + whole.far) / 2)[:12]
    assert np.abs(stopped.far - expected)[seen].max() < 1e-7
    assert np.isnan(rays(matrix, SIZE, volume, depths=np.zeros((24, 32))).near).all()
    assert np.isnan(rays(matrix, SIZE, volume, clip_planes=[[0, 0, 0, -1]]).near).all()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"matrix": np.zeros((4, 4))}, "flattens space"), ({"matrix": np.eye(3)}, r"\(4, 4\)"),
        ({"matrix": np.full((4, 4), np.nan)}, "finite"), ({"size": (0, 5)}, "one pixel"),
        ({"clip_planes": [[1, 0, 0]]}, "clip_planes"), ({"depths": np.ones((3, 3))}, r"\(24, 32\)"),
        ({"depths": np.full((24, 32), np.nan)}, "depths"), ({"box": (0, 1)}, "box"),
    ],
)  # fmt: skip
def test_bad_rays_are_named(change, message):
    given = {"matrix": view(np.eye(4)), "size": SIZE, "volume": RaycastVolume(np.zeros(SHAPE))} | change
    with pytest.raises(ValueError, match=message):
        rays(**given)


# ------------------------------------------------------------------------------------------------------ the field


@pytest.mark.parametrize("how", FILTERS)
def test_samples_are_those_of_plain_numpy(how):
    volume = noise((2, 5, 4), affine=GRIDS["oblique"])
    places = np.random.default_rng(1).random((500, 3)) * (np.array(volume.shape) - 1)
    points = places @ volume.affine[:3, :3].T + volume.affine[:3, 3]
    assert np.abs(sample(volume, points, how) - PLAIN[how](volume.values, places)).max() < 1e-12
    assert sample(volume, points.reshape(5, 100, 3), how).shape == (5, 100)


@pytest.mark.parametrize("grid", GRIDS)
@pytest.mark.parametrize(("how", "field"), [
    ("trilinear", Plane((0.5, -1.0, 2.0), 3.0)), ("tricubic", Ball((4.0, 5.0, 3.0), 2.0)),
])  # fmt: skip
def test_gradients_are_per_mm_in_the_axes_of_space(grid, how, field):
    volume = field.volume((9, 10, 8), GRIDS[grid])
    places = 2 + np.random.default_rng(2).random((200, 3)) * (np.array(volume.shape) - 5)
    if how == "trilinear":  # a plane's gradient is right up to the edge
        places = places * 0 + np.array(volume.shape) - 1
    points = places @ volume.affine[:3, :3].T + volume.affine[:3, 3]
    assert np.abs(gradient(volume, points, how) - field.gradient(points)).max() < 1e-10


# ------------------------------------------------------------------------------------------------------- isosurfaces


@pytest.mark.parametrize("name", VIEWS)
@pytest.mark.parametrize("grid", GRIDS)
def test_a_plane(grid, name):
    affine = GRIDS[grid]
    field = Plane((0.25, 0.5, -1.0), -float(np.dot((0.25, 0.5, -1.0), middle(SHAPE, affine))))
    volume = field.volume(SHAPE, affine)
    through = rays(view(affine, **VIEWS[name]), SIZE, volume)
    found, expected = isosurface(volume, 0.5, through), field.crossing(through, 0.5)
    hit = ~np.isnan(expected)
    assert hit.sum() > 20
    assert (hit == (found.value == 0)).all()
    assert (hit == ~np.isnan(found.t)).all()
    assert np.abs(found.t - expected)[hit].max() < 1e-10
    assert np.abs(found.depth - np.where(hit, through.depth(expected), 1.0)).max() < 1e-12
    assert np.abs(found.gradient - field.normal)[hit].max() < 1e-10
    assert np.isnan(found.gradient[~hit]).all()
    assert np.abs(found.chord - (through.far - expected))[hit].max() < 1e-10


@pytest.mark.parametrize("name", VIEWS)
@pytest.mark.parametrize("grid", GRIDS)
def test_a_ball_by_the_tricubic_filter(grid, name):
    """That filter gives quadratic fields back as they are."""
    affine = GRIDS[grid]
    field = Ball(tuple(middle(SHAPE, affine)), 3.5)
    volume = field.volume(SHAPE, affine)
    through = rays(view(affine, **VIEWS[name]), SIZE, volume)
    found, expected = isosurface(volume, 0.0, through, filter="tricubic"), field.crossing(through)
    hit = ~np.isnan(expected)
    assert hit.sum() > 20
    assert (hit == (found.value == 0)).all()
    assert np.abs(found.t - expected)[hit].max() < 1e-10
    assert np.abs(found.chord - field.chord(through))[hit].max() < 1e-10
    assert np.abs(found.gradient - field.gradient(through.points(expected)))[hit].max() < 1e-10


def test_of_several_surfaces_the_nearest_shows():
    field = Ball((10.0, 9.0, 8.0), 4.0)
    volume = field.volume(SHAPE)
    values = [12.0, 0.0, -20.0]
    through = rays(view(np.eye(4), near=25.0), SIZE, volume, clip_planes=[[-1.0, 0, 0, 13.5]])
    found = isosurface(volume, values, through, filter="tricubic")
    each = np.stack([field.crossing(through, value) for value in values])
    hit = ~np.isnan(each).all(axis=0)
    nearest = np.where(np.isnan(each), np.inf, each)
    assert set(found.value[hit]) == {0, 1, 2}  # the cut opens all of them
    assert (found.value == np.where(hit, nearest.argmin(axis=0), -1)).all()
    assert np.abs(found.t - nearest.min(axis=0))[hit].max() < 1e-10


def test_a_ball_by_the_trilinear_filter_comes_nearer_by_the_square_of_the_spacing():
    errors = []
    for n in (9, 17, 33):
        affine = np.diag([16 / (n - 1)] * 3 + [1.0])
        field = Ball((8.0, 7.875, 8.125), 5.0)
        volume = field.volume((n, n, n), affine)
        through = rays(camera((30, 20, 10), (8, 8, 8)), SIZE, volume)
        # Where the surface is nearly along the ray, its place is as uncertain as rays near it are.
        steep = np.nan_to_num(field.chord(through)) > 5.0
        errors.append(np.abs(isosurface(volume, 0.0, through).t - field.crossing(through))[steep].max())
        # The field comes short by sum spacing^2 / 4, and its slope along the ray is the chord.
        assert errors[-1] < 3 * affine[0, 0] ** 2 / 4 / 5.0 * 1.5
    assert errors[0] > 2.5 * errors[1] > 6 * errors[2]


@hypothesis.given(
    corners=st.lists(st.integers(-8, 8), min_size=8, max_size=8),
    ends=st.lists(st.integers(1, 63), min_size=4, max_size=4),
    axis=st.integers(0, 2),
)
def test_a_cell_is_the_cubic_that_its_corners_make(corners, ends, axis):
    """The cubic by four values of the ray's, its roots as eigenvalues."""
    volume = RaycastVolume(np.array(corners, np.float32).reshape(2, 2, 2))
    start = np.insert(np.array(ends[:2]) / 64, axis, 0.0)
    end = np.insert(np.array(ends[2:]) / 64, axis, 1.0)
    length = np.linalg.norm(end - start)
    through = straight(start, end - start, length)
    s = np.arange(4) / 3
    at = trilinear(volume.values, start + s[:, None] * (end - start))
    cubic = np.polynomial.polynomial.polyfit(s, at - 0.25, 3)
    roots = np.polynomial.polynomial.polyroots(np.trim_zeros(np.where(abs(cubic) < 1e-12, 0, cubic), "b"))
    roots = np.sort(roots[(abs(roots.imag) < 1e-7) & (roots.real > 0) & (roots.real < 1)].real)
    steep = np.abs(np.polynomial.polynomial.polyval(roots, np.polynomial.polynomial.polyder(cubic)))
    hypothesis.assume((steep > 1e-3).all() and (np.abs(np.polynomial.polynomial.polyval([0, 1], cubic)) > 1e-9).all())
    found = isosurface(volume, 0.25, through)
    assert (found.value[0] == 0) == (len(roots) > 0)
    if len(roots):
        assert abs(found.t[0] / length - roots[0]) < 1e-7
        assert abs(found.chord[0] / length - (roots[1] if len(roots) > 1 else 1.0) + roots[0]) < 1e-7
    turns = np.polynomial.polynomial.polyroots(np.polynomial.polynomial.polyder(cubic)) if cubic[2:].any() else []
    turns = [turn.real for turn in turns if abs(turn.imag) < 1e-9 and 0 < turn.real < 1]
    greatest = np.polynomial.polynomial.polyval([0.0, 1.0, *turns], cubic).max() + 0.25
    assert abs(mip(volume, through).value[0] - greatest) < 1e-9


@pytest.mark.parametrize("how", FILTERS)
def test_first_crossings_in_noise(how):
    """They lie on the surface, no plain sample before them is on its other side, and those behind are."""
    volume = noise(affine=GRIDS["flat voxels"])
    through = rays(view(volume.affine, volume.shape), SIZE, volume)
    found = isosurface(volume, [0.6, 0.3], through, filter=how)
    some, t, values = along(volume, through, how, 1500)
    at, level, chord = (array[~np.isnan(through.near)] for array in (found.t, found.value, found.chord))
    hit = level >= 0
    assert 0.5 < hit.mean() < 1
    before = t < np.where(hit, at, np.inf)[:, None] - 1e-9
    for value in (0.6, 0.3):
        side = values >= value
        assert (side == side[:, :1])[before].all()
    value = np.array([0.6, 0.3])[level]
    between = (t > (at + 1e-9)[:, None]) & (t < (at + chord - 1e-9)[:, None])
    assert ((values >= value[:, None]) != (values[:, :1] >= value[:, None]))[between].all()
    if how != "nearest":
        assert np.abs(sample(volume, some.points(at)[hit], how) - value[hit]).max() < 1e-12


def test_values_that_voxels_have_and_rays_along_edges_and_diagonals():
    """Whole numbers and quarters, so that rays touch, begin and end on surfaces, or run along them, all the time."""
    rng = np.random.default_rng(8)
    for shape in ((2, 2, 2), (3, 2, 4), (4, 5, 3), (5, 3, 4)):
        volume = RaycastVolume(rng.integers(0, 3, shape).astype(np.uint8))
        start, end = (rng.integers(0, 4 * np.array(shape) - 3, (500, 3)) / 4 for _ in range(2))
        start, end = (array[(start != end).any(axis=1)] for array in (start, end))
        length = np.linalg.norm(end - start, axis=1)
        through = Rays(start, (end - start) / length[:, None], np.zeros(len(start)), length, np.eye(4))
        s = (np.arange(600) + 0.5) / 600
        values = trilinear(volume.values, start[:, None] + s[:, None] * (end - start)[:, None])
        for level in (0.5, 1.0, 1.3):
            side = values >= level - 1e-12
            flips = side[:, 1:] != side[:, :-1]
            expected = np.where(flips.any(axis=1), (s[flips.argmax(axis=1)] + 0.5 / 600) * length, np.nan)
            found = isosurface(volume, level, through).t
            assert (np.isnan(found) == np.isnan(expected)).all()
            assert (np.nan_to_num(np.abs(found - expected)) < 0.51 * length / 600).all()


def test_nearest_voxels_jump_half_way_between_them():
    """Of several values that the jump passes, the one shows that a steep ramp would come to first."""
    volume = Layers((0, 0, 100, 0, 40, 40)).volume(dtype=np.uint8)
    there = isosurface(volume, [60, 20, 30], straight((4.2, 4.2, 0), (0, 0, 1), 5.0), filter="nearest")
    assert (there.t[0], there.value[0], there.chord[0]) == (1.5, 1, 1.0)  # up past 20 first
    assert (there.gradient[0] == 0).all()  # at the centre of the voxel entered, between two alike
    back = isosurface(volume, [60, 20, 30], straight((4.2, 4.2, 5), (0, 0, -1), 5.0), filter="nearest")
    assert (back.t[0], back.value[0], back.chord[0]) == (1.5, 2, 1.0)  # down past 30 first
    assert (back.gradient[0] == (0, 0, -30)).all()  # between 100 and 40
    oblique = straight((1.0, 1.0, 0.0), (1, 0, 1), 5.0)
    assert abs(isosurface(volume, 20, oblique, filter="nearest").t[0] - 1.5 * np.sqrt(2)) < 1e-12


@pytest.mark.parametrize("how", ["trilinear", "tricubic"])
@pytest.mark.parametrize(
    ("values", "expected"),
    [
        ((0, 5, 0, 0), np.nan), ((9, 5, 9, 9), np.nan),  # touched only
        ((5, 5, 0, 0), "from 1"), ((5, 9, 9, 9), np.nan), ((5, 0, 0, 0), np.nan),  # begins there
        ((0, 5, 5, 0), "from 0"), ((9, 5, 5, 9), np.nan),  # level: at the value counts as above it
        ((5, 5, 5, 5), np.nan), ((0, 0, 5, 9), 2.0), ((9, 9, 5, 0), 2.0),
    ],
)  # fmt: skip
def test_what_counts_as_a_crossing(values, expected, how):
    volume = Layers(values).volume()
    found = isosurface(volume, 5.0, straight((4.0, 4.0, 0.0), (0, 0, 1), 3.0), filter=how).t[0]
    if isinstance(expected, str):
        # By the cubic filter, levels between different voxels bulge.
        assert found == (1.0 if how == "trilinear" else found)
        assert 0.0 < found <= 1.0 + 1e-12
    elif how == "trilinear" or np.isfinite(expected):
        assert found == expected or (np.isnan(found) and np.isnan(expected))


def test_a_ray_that_begins_on_a_surface_sees_the_next_one():
    volume = Layers((0, 10, 0, 10)).volume()
    found = isosurface(volume, 5.0, straight((4, 4, 0.5), (0, 0, 1), 2.5))
    assert found.t[0] == 1.0


@pytest.mark.parametrize(("scale", "offset"), [(1e-6, 0.0), (1.0, 1e6), (1e5, -1e7)])
def test_places_and_sizes_far_from_one_mm(scale, offset):
    """The picture is that of a grid at 0 with voxels of 1 mm."""
    move = np.diag([scale] * 3 + [1.0])
    move[:3, 3] = offset
    plain, moved = noise(), noise(affine=move)
    matrix = view(np.eye(4), plain.shape)
    at_zero, far_away = rays(matrix, SIZE, plain), rays(matrix @ np.linalg.inv(move), SIZE, moved)
    a, b = isosurface(plain, 0.5, at_zero), isosurface(moved, 0.5, far_away)
    # Rounding of the matrix moves rays by as much.
    near = 1e-3 if offset else 1e-6
    same = ~np.isnan(a.t) & ~np.isnan(b.t)
    assert np.mean((a.value >= 0) == (b.value >= 0)) > 0.999
    assert np.mean(np.abs(a.t - b.t / scale)[same] < near) > 0.999
    assert np.abs(composite(plain, _haze(), at_zero) - composite(moved, _haze(scale), far_away)).max() < near


def _haze(unit=1.0):
    return Transfer([[1, 0, 0, 0], [0, 1, 0, 0.2], [0, 0, 1, 0.9]], (0, 1), unit)


@pytest.mark.parametrize("dtype", [np.uint8, np.int16, np.uint16, np.float32])
def test_every_type_of_voxel_is_taken_as_it_is(dtype):
    volume = noise(dtype=dtype)
    same = RaycastVolume(np.asfortranarray(volume.values.astype(np.float32)))
    through = rays(view(np.eye(4), volume.shape), SIZE, volume)
    middle = float(np.median(volume.values)) + 0.01
    assert np.array_equal(isosurface(volume, middle, through).t, isosurface(same, middle, through).t, equal_nan=True)


@pytest.mark.parametrize(
    ("values", "choices", "message"),
    [([], {}, "finite numbers"), ([np.nan], {}, "finite"), ([0.5], {"filter": "sinc"}, "'tricubic'")],
)
def test_bad_isosurfaces_are_named(values, choices, message):
    with pytest.raises(ValueError, match=message):
        isosurface(noise(), values, straight((0, 0, 0), (1, 1, 1), 1.0), **choices)


# ----------------------------------------------------------------------------------------------------------- maxima


@pytest.mark.parametrize("grid", GRIDS)
def test_the_greatest_value_of_a_ball_is_where_the_ray_is_nearest_to_its_centre(grid):
    affine = GRIDS[grid]
    field = Ball(tuple(middle(SHAPE, affine)), 3.0)
    volume = field.volume(SHAPE, affine)
    inner = (1, SHAPE[0] - 2, 1, SHAPE[1] - 2, 1, SHAPE[2] - 2)  # where the cubic has all its voxels
    through = rays(view(affine, near=28.0), SIZE, volume, box=inner)
    found, (t, value) = mip(volume, through, filter="tricubic"), field.greatest(through)
    seen = ~np.isnan(t)
    assert (seen == ~np.isnan(found.value)).all()
    assert np.abs(found.value - value)[seen].max() < 1e-9
    assert np.abs(found.t - t)[seen].max() < 1e-5


@pytest.mark.parametrize("how", FILTERS)
def test_the_greatest_value_in_noise(how):
    volume = noise(seed=3, affine=GRIDS["oblique"])
    through = rays(view(volume.affine, volume.shape, height=8.0), SIZE, volume)
    found = mip(volume, through, filter=how)
    some, t, values = along(volume, through, how, 3000 if how != "tricubic" else 600)
    greatest = found.value[~np.isnan(through.near)]
    assert (values.max(axis=1) <= greatest + 1e-12).all()
    if how == "nearest":
        assert np.isin(greatest, volume.values).all()
        assert np.mean(values.max(axis=1) == greatest) > 0.99
    else:
        assert np.abs(values.max(axis=1) - greatest).max() < 2e-3
        at = found.t[~np.isnan(through.near)]
        assert np.abs(sample(volume, some.points(at), how) - greatest).max() < 1e-12
    kept = mip(volume, through, filter=how, low=0.7, high=0.8).value[~np.isnan(through.near)]
    inside = (values >= 0.7) & (values <= 0.8)
    if how == "nearest":
        inside = np.where(inside, values, -1).max(axis=1)
        assert np.mean(np.where(inside < 0, np.isnan(kept), kept == inside)) > 0.99
    else:
        # The field is continuous: where it passes 0.8, that is the greatest.
        passes = (values > 0.8).any(axis=1) & (values < 0.8).any(axis=1)
        assert (kept[passes] == 0.8).all()
        assert np.isnan(kept[greatest < 0.7]).all()
        between = (greatest >= 0.7) & (greatest < 0.8)
        assert (kept == greatest)[between].all()


@pytest.mark.parametrize("how", FILTERS)
@pytest.mark.parametrize(
    ("threshold", "value", "t"),
    [(-1.0, 3.0, 1.0), (2.5, 3.0, 1.0), (3.5, 7.0, 3.0), (7.9, 9.0, 7.0), (9.5, 9.0, 7.0), (None, 9.0, 7.0)],
)
def test_the_first_local_maximum_above_a_threshold(how, threshold, value, t):
    volume = Layers((1, 3, 2, 7, 7, 0, 5, 9, 8)).volume()
    found = mip(volume, straight((4, 4, 0), (0, 0, 1), 8.0), filter=how, threshold=threshold)
    if how == "tricubic" and value == 7.0:  # it bulges between two voxels alike
        assert 7.0 < found.value[0] < 8.0
        assert 3.0 < found.t[0] < 4.0
    elif how == "tricubic":  # it turns a little beside the voxel
        assert value <= found.value[0] < value + 0.5
        assert abs(found.t[0] - t) < 0.3
    else:
        assert found.value[0] == value
        assert found.t[0] == (t if how == "trilinear" else t - 0.5)


def test_local_maxima_at_the_ends_of_rays_and_across_a_level_field():
    falling, rising = Layers((9, 5, 2, 1)).volume(), Layers((1, 2, 5, 9)).volume()
    ray = straight((4, 4, 0), (0, 0, 1), 3.0)
    assert mip(falling, ray, threshold=4.0).value[0] == 9.0
    assert mip(rising, ray, threshold=4.0).value[0] == 9.0
    # A ray on which nothing but rounding changes has not fallen before it rises.
    wide = np.broadcast_to(np.array([0.1, 0.7, 0.9, 0.3])[:, None, None], (4, 12, 12)).copy()
    wide[:, 9:] += 1.0
    volume = RaycastVolume(wide.astype(np.float32))
    across = straight((1.3, 0.0, 0.37), (0, 1, 1), 11 * np.sqrt(2) - 1)
    assert mip(volume, across, threshold=0.5).value[0] > 1.7


def test_bad_thresholds_are_named():
    ray = straight((0, 0, 0), (1, 1, 1), 1.0)
    with pytest.raises(ValueError, match="lower one first"):
        mip(noise(), ray, low=2.0, high=1.0)
    with pytest.raises(ValueError, match="threshold is nan"):
        mip(noise(), ray, threshold=float("nan"))
    with pytest.raises(ValueError, match="lower one first"):
        composite(noise(), _haze(), ray, low=float("nan"))
    with pytest.raises(ValueError, match="tolerance"):
        composite(noise(), _haze(), ray, 0.0)


# ---------------------------------------------------------------------------------------------------------- composite


@pytest.mark.parametrize("how", FILTERS)
@pytest.mark.parametrize("alpha", [0.0, 1e-6, 0.3, 0.999, 1.0])
def test_an_even_block(how, alpha):
    """Its opacity is that of as many units as the ray is long."""
    volume = RaycastVolume(np.full((5, 6, 7), 3, np.uint8), GRIDS["oblique"])
    transfer = Transfer([[0, 0, 0, 0], [0.8, 0.4, 0.2, alpha]], (0, 3), 2.5)
    through = rays(view(volume.affine, volume.shape, height=9.0), SIZE, volume)
    found = composite(volume, transfer, through, filter=how)
    left = 1 - min(float(np.float32(alpha)), 1 - 2.0**-24)
    opacity = np.nan_to_num(1 - left ** ((through.far - through.near) / 2.5))
    # What comes from behind an opacity of 1 - 1e-11 is left out.
    assert np.abs(found[..., 3] - opacity).max() < 2e-11
    assert np.abs(found[..., :3] - opacity[..., None] * transfer.table[1, :3]).max() < 2e-11


@pytest.mark.parametrize("depth", [1e-3, 1.0, 1e3, 1e6])
@pytest.mark.parametrize("name", ["constant", "fade", "ramp", "edge", "peak", "haze", "teeth"])
def test_layers_of_which_a_closed_form_is_known(name, depth):
    """Thin to stiff, smooth and steep, from both sides and aslant."""
    profile = next(p for p in profiles([depth], 17.0) if p.name == name)
    layers = Layers(tuple(np.float32(profile.value(np.linspace(0, 17, 18)))))
    volume = layers.volume()
    for away in ((3, 2, 40), (40, 5, -20)):
        matrix = camera(np.array([4, 4, 8.5]) + away, (4, 4, 8.5), height=14.0, size=(6, 5))
        through = rays(matrix, (6, 5), volume)
        assert (~np.isnan(through.near)).any()
        expected = layers.light(through, profile.transfer)
        assert np.abs(composite(volume, profile.transfer, through) - expected).max() < 1e-8


def test_layers_of_nearest_voxels():
    layers = Layers((0, 3, 1, 2, 2, 0, 3))
    volume = layers.volume(dtype=np.int16)
    transfer = Transfer([[1, 0, 0, 0.1], [0, 1, 0, 0.3], [0, 0, 1, 0.0], [1, 1, 1, 0.6]], (0, 3), 0.7)
    for away in ((3, 2, 40), (40, 5, -20)):
        through = rays(camera(np.array([4, 4, 3]) + away, (4, 4, 3), height=14.0, size=(8, 6)), (8, 6), volume)
        found = composite(volume, transfer, through, filter="nearest")
        assert np.abs(found - layers.light(through, transfer, "nearest")).max() < 1e-10


@pytest.mark.parametrize("how", ["trilinear", "tricubic"])
def test_a_gaussian(how):
    """The filters' own error is what is left: of the trilinear one (spacing / radius)^2 / 8 in each axis."""
    field = Gaussian((10.0, 10.0, 10.0), 2.5)
    volume = field.volume((41, 41, 41), np.diag([0.5, 0.5, 0.5, 1.0]))
    transfer = field.transfer(0.9, (1.0, 0.5, 0.25), 1.5)
    through = rays(camera((30, 25, 20), (10, 10, 10), size=(12, 9)), (12, 9), volume)
    error = np.abs(composite(volume, transfer, through, filter=how) - field.light(through, transfer))
    assert field.light(through, transfer).max() > 0.95
    assert error.max() < (6e-3 if how == "trilinear" else 2e-4)


@pytest.mark.parametrize("how", ["trilinear", "tricubic"])
def test_noise_against_very_many_samples(how):
    volume = noise(seed=5)
    through = rays(view(np.eye(4), volume.shape, size=(8, 6)), (8, 6), volume)
    found = composite(volume, _haze(), through, filter=how)
    some, t, values = along(volume, through, how, 20000)
    kappa, colour = _haze().extinction(values), _haze().colour(values)
    depth = (kappa[:, 1:] + kappa[:, :-1]) / 2 * np.diff(t)
    left = np.exp(-np.cumsum(np.insert(depth, 0, 0.0, axis=1), axis=1))
    light = ((left[:, :-1] - left[:, 1:])[..., None] * (colour[:, 1:] + colour[:, :-1]) / 2).sum(axis=1)
    seen = ~np.isnan(through.near)
    assert np.abs(found[seen][:, :3] - light).max() < 1e-6
    assert np.abs(found[seen][:, 3] - 1 + left[:, -1]).max() < 1e-6
    assert (found[~seen] == 0).all()
    rough = composite(volume, _haze(), through, 1e-3, filter=how)
    assert np.abs(rough - found).max() < 1e-3


@pytest.mark.parametrize("how", FILTERS)
def test_thresholds_are_a_transfer_function_that_is_nothing_beyond_them(how):
    volume = noise(seed=6, dtype=np.uint8)
    through = rays(view(np.eye(4), volume.shape, size=(8, 6)), (8, 6), volume)
    plain = Transfer([[1, 0.5, 0, 0.5], [1, 0.5, 0, 0.5]], (0, 255))
    alpha = np.zeros(256 * 64 + 1)
    steps = np.linspace(0, 256, len(alpha))
    alpha[(steps >= 100) & (steps <= 180)] = 0.5  # for the nearest voxel, both ends are there
    steep = np.concatenate([np.broadcast_to([1, 0.5, 0], (len(alpha), 3)), alpha[:, None]], axis=1)
    expected = composite(volume, Transfer(steep, (0, 256)), through, filter=how)
    found = composite(volume, plain, through, filter=how, low=100, high=180)
    assert found[..., 3].max() > 0.5
    assert np.abs(found - expected).max() < (1e-10 if how == "nearest" else 2e-3)
    assert np.abs(composite(volume, plain, through, low=-5, high=300) - composite(volume, plain, through)).max() < 1e-12


def test_rays_of_any_shape_and_some_of_them():
    volume = noise()
    through = rays(view(np.eye(4), volume.shape), SIZE, volume)
    chosen = (slice(3, 20, 2), slice(5, 9))
    assert composite(volume, _haze(), through[chosen]).shape == (9, 4, 4)
    for whole, part in (
        (composite(volume, _haze(), through), composite(volume, _haze(), through[chosen])),
        (mip(volume, through).value, mip(volume, through[chosen]).value),
        (isosurface(volume, 0.5, through).gradient, isosurface(volume, 0.5, through[chosen]).gradient),
    ):
        assert np.array_equal(whole[chosen], part, equal_nan=True)
    assert within(np.array(0.5), straight((0, 0, 0), (1, 0, 0), 1.0)) == 0.5
