"""The float64 reference: rays, fields and surfaces, against closed forms, and against plain NumPy on noise."""

from __future__ import annotations

import hypothesis
import numpy as np
import pytest
from hypothesis import strategies as st

from pvfiblets.report.studies.volumes.reference import gradient, isosurface, mip, rays, sample
from pvfiblets.volumes.volume import FILTERS, RaycastVolume

from .analytic import GRIDS, Ball, Layers, Plane, middle
from .noise import PLAIN, SHAPE, SIZE, VIEWS, along, noise, straight, trilinear, view

# --------------------------------------------------------------------------------------------------------------- rays


@pytest.mark.few(3)
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
    for values, choices, said in ([], {}, "finite numbers"), ([np.nan], {}, "finite"), (0.5, {"filter": "sinc"}, "cub"):
        with pytest.raises(ValueError, match=said):
            isosurface(noise(), values, straight((0, 0, 0), (1, 1, 1), 1.0), **choices)


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


def test_nearest_voxels_jump_half_way_between_them():
    """Of several values that the jump passes, the one shows that a steep ramp would come to first."""
    volume = Layers((0, 0, 100, 0, 40, 40)).volume(dtype=np.uint8)
    there = isosurface(volume, [60, 20, 30], straight((4.2, 4.2, 0), (0, 0, 1), 5.0), filter="nearest")
    assert (there.t[0], there.value[0], there.chord[0]) == (1.5, 1, 1.0)  # up past 20 first
    assert (there.gradient[0] == 0).all()  # at the centre of the voxel entered, between two alike
    back = isosurface(volume, [60, 20, 30], straight((4.2, 4.2, 5), (0, 0, -1), 5.0), filter="nearest")
    assert (back.t[0], back.value[0], back.chord[0]) == (1.5, 2, 1.0)  # down past 30 first
    assert (back.gradient[0] == (0, 0, -30)).all()  # between 100 and 40
    begins = isosurface(Layers((0, 10, 0, 10)).volume(), 5.0, straight((4, 4, 0.5), (0, 0, 1), 2.5))
    assert begins.t[0] == 1.0  # on a surface: the next one is seen
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
