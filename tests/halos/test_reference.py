"""The float64 reference of halos against closed forms: one strip, one disc, two that cross, ends, bends and cuts."""

from __future__ import annotations

import hypothesis
import numpy as np
import pytest
from hypothesis import strategies as st

from pvfiblets.halos import HaloLines, HaloPoints, Look
from pvfiblets.halos.reference import HALO, LINE, NOTHING, picture
from pvfiblets.halos.strips_reference import mask, places_along, rates

SIZE = (80, 60)
NEAR, FAR = 50.0, 250.0
PLAIN = {"n_tapered": 0, "min_width": 0.0, "smooth": False}


def parallel(size=SIZE):
    """The middle of the picture looks along +z from z = 0; one pixel per mm; y is up."""
    w, h = size
    return np.array([
        [2 / w, 0, 0, 0], [0, 2 / h, 0, 0], [0, 0, 2 / (FAR - NEAR), -(FAR + NEAR) / (FAR - NEAR)], [0, 0, 0, 1.0],
    ])  # fmt: skip


def perspective(size=SIZE, *, focal=100.0):
    """The same with the eye at 0: what is z mm away takes focal / z pixels per mm."""
    w, h = size
    return np.array([
        [2 * focal / w, 0, 0, 0], [0, 2 * focal / h, 0, 0],
        [0, 0, (FAR + NEAR) / (FAR - NEAR), -2 * FAR * NEAR / (FAR - NEAR)], [0, 0, 1.0, 0],
    ])  # fmt: skip


CAMERAS = {"parallel": parallel, "perspective": perspective}


def window_depth(z, camera="parallel"):
    """Of a place z mm away."""
    if camera == "perspective":
        return FAR * (z - NEAR) / (z * (FAR - NEAR))
    return (z - NEAR) / (FAR - NEAR)


def line(*points, **values):
    return HaloLines(np.array(points, float), [0, len(points)], {k: np.array(v, float) for k, v in values.items()})


def lines(*several):
    return HaloLines(np.concatenate(several).astype(float), np.cumsum([0, *map(len, several)]))


def centres(size=SIZE):
    """x and y of the pixels' centres, from the picture's middle."""
    w, h = size
    y, x = np.mgrid[:h, :w] + 0.5
    return x - w / 2, y - h / 2


def kinds(inked, there):
    return np.where(inked & there, LINE, np.where(there, HALO, NOTHING))


# ------------------------------------------------------------------------------------------------------- one strip


@pytest.mark.parametrize(("camera", "k"), [("parallel", 1.0), ("perspective", 100.0 / 120.0)])
def test_a_strip_across_the_view(camera, k):
    x, y = centres()
    look = Look(line_width=6.2, strip_width=21.0, max_displacement=30.0, **PLAIN)
    found = picture(line([-20, 3.1, 120], [31, 3.1, 120]), look, CAMERAS[camera](), SIZE)
    along, away = x / k, abs(y / k - 3.1)
    there = (along > -20) & (along < 31) & (away < 10.5)
    inked = there & (away < 3.1)
    assert (found.kind == kinds(inked, there)).all()
    depth = window_depth(120 + 30 * away / 10.5 * ~inked, camera)
    assert np.abs(found.depth - np.where(there, depth, 1.0)).max() < 1e-12
    assert (found.owner == np.where(there, 0, -1)).all()
    assert np.abs(found.t - (along + 20) / 51)[there].max() < 1e-12
    assert (found.ink == inked).all()
    assert np.isinf(found.gap).all()
    edges = [abs(along + 20), abs(along - 31), abs(away - 3.1), abs(away - 10.5)]
    assert np.abs(found.margin - np.min(edges, axis=0) * k)[there].max() < 1e-9


def test_a_strip_that_recedes_lies_in_the_plane_of_its_axis_and_of_what_is_level_across_it():
    """Where the eye's ray meets that plane is the fragment's place; the width goes by its depth."""
    a, b = np.array([-20.0, -12, 80]), np.array([45.0, 20, 160])
    look = Look(line_width=9.0, strip_width=9.0, max_displacement=0.0, **PLAIN)
    found = picture(line(a, b), look, perspective(), SIZE)
    x, y = centres()
    ends = [100 * p[:2] / p[2] for p in (a, b)]
    e = (ends[1] - ends[0]) / np.linalg.norm(ends[1] - ends[0])
    across = np.array([-e[1], e[0], 0.0])
    rays = np.stack([x / 100, y / 100, np.ones_like(x)], axis=-1)
    # a + t (b - a) + s across = z ray
    systems = np.stack([*np.broadcast_arrays(b - a, across, rays)[:2], -rays], axis=-1)
    t, s, z = np.moveaxis(np.linalg.solve(systems, np.broadcast_to(-a[:, None], (*x.shape, 3, 1)))[..., 0], -1, 0)
    there = (t > 0) & (t < 1) & (abs(s) < 4.5) & (z > 0)
    assert there.sum() > 300
    assert (found.kind == kinds(there, there)).all()
    assert np.abs(found.t - t)[there].max() < 1e-9
    assert np.abs(found.depth - window_depth(z, "perspective"))[there].max() < 1e-12


@pytest.mark.parametrize(
    ("name", "function"),
    [("linear", lambda r: r), ("square", lambda r: r**2), ("square root", np.sqrt),
     ((0.0, 0.7, 0.2), lambda r: np.where(r < 0.5, 1.4 * r, 1.2 - r))],
)  # fmt: skip
def test_equation_3(name, function):
    look = Look(2.0, 30.0, 40.0, displacement=name, **PLAIN)
    found = picture(line([-99, 0, 120], [99, 0, 120]), look, parallel(), SIZE)
    _, y = centres()
    halo = (abs(y) > 1) & (abs(y) < 15)
    assert ((found.kind == HALO) == halo).all()
    assert np.abs(found.depth - window_depth(120 + 40 * function(abs(y) / 15)))[halo].max() < 1e-12


def test_depth_is_displaced_along_the_view_axis():
    """A halo off the picture's middle is as far behind by its distance along the axis, not along its ray."""
    look = Look(2.0, 20.0, 50.0, **PLAIN)
    found = picture(line([-60, 40, 120], [60, 40, 120]), look, perspective(), SIZE)
    x, y = centres()
    away = abs(y * 1.2 - 40)
    halo = (away > 1) & (away < 10) & (abs(x) * 1.2 < 60)
    assert halo.sum() > 300
    assert np.abs(found.depth - window_depth(120 + 5 * away, "perspective"))[halo].max() < 1e-12


@pytest.mark.parametrize("smooth", [True, False])
def test_ink_between_line_and_halo(smooth):
    look = Look(7.3, 21.0, 40.0, n_tapered=0, min_width=0.0, smooth=smooth)
    found = picture(line([-99, 0, 120], [99, 0, 120]), look, parallel(), SIZE)
    _, y = centres()
    expected = np.clip(3.65 - abs(y) + 0.5, 0, 1) if smooth else abs(y) < 3.65
    assert np.abs(found.ink - expected).max() < 1e-12
    assert ((found.kind == LINE) == (abs(y) < 3.65)).all()


def test_thin_lines_take_their_least_width_and_keep_their_halo_beside_it():
    _, y = centres()
    for width, inked, reach in ((0.2, 2.5, 2.5 + 9.9), (9.0, 4.5, 10.0)):
        look = Look(width, 20.0, 30.0, n_tapered=0, min_width=5.0, smooth=False)
        found = picture(line([-99, 0.2, 120], [99, 0.2, 120]), look, parallel(), SIZE)
        assert (found.kind == kinds(abs(y - 0.2) < inked, abs(y - 0.2) < reach)).all()


@pytest.mark.parametrize("camera", CAMERAS)
def test_depth_cueing_by_width(camera):
    """The nearest line has its width, the farthest what the cue leaves, and the strip keeps its own."""
    look = Look(6.0, 14.0, 1.0, width_cue=0.75, **PLAIN)
    places = ((-29.1, 60), (-9.1, 80), (14.1, 100))
    scene = lines(*([[x, -90, z], [x, 90, z]] for x, z in places))
    found = picture(scene, look, CAMERAS[camera](), SIZE)
    x, _ = centres()
    for i, ((place, z), cue) in enumerate(zip(places, (1.0, 0.625, 0.25), strict=True)):
        k = 1.0 if camera == "parallel" else 100 / z
        away = abs(x - place * k) / k
        at = found.owner == 2 * i
        assert at.sum() > 100
        assert (at == (away < 7)).all()
        assert ((found.kind == LINE) == (away < 3 * cue))[at].all()


def test_a_flat_scene_has_no_depth_to_cue():
    look = Look(6.0, 14.0, 1.0, width_cue=0.75, **PLAIN)
    found = picture(line([-9, 0, 80], [9, 0, 80]), look, parallel(), SIZE)
    x, y = centres()
    assert ((found.kind == LINE) == ((abs(y) < 3) & (abs(x) < 9))).all()


# ------------------------------------------------------------------------------------------------------------ points


@pytest.mark.parametrize(("camera", "k"), [("parallel", 1.0), ("perspective", 100.0 / 120.0)])
def test_a_point_is_a_round_cone(camera, k):
    look = Look(8.0, 30.0, 60.0, min_width=0.0, smooth=False)
    found = picture(HaloPoints(np.array([[3.0, -2.0, 120.0]])), look, CAMERAS[camera](), SIZE)
    x, y = centres()
    away = np.hypot(x / k - 3, y / k + 2)
    assert (found.kind == kinds(away < 4, away < 15)).all()
    there = away < 15
    depth = window_depth(120 + 60 * away / 15 * (away > 4), camera)
    assert np.abs(found.depth - depth)[there].max() < 1e-12
    assert (found.owner == there - 1).all()
    assert np.abs(found.margin - k * np.minimum(abs(away - 4), abs(away - 15)))[there].max() < 1e-9


def test_points_are_there_or_not_by_their_centres():
    scene = HaloPoints(
        np.array([[-20.0, 0, 100], [0, 0, 100], [20, 0, 100], [0, 0, 20]]), {"n": np.array([1, 2, 3, 2])}
    )
    look = Look(8.0, 10.0, 0.0, min_width=0.0)
    seen = lambda found: set(np.unique(found.owner)) - {-1}  # noqa: E731
    assert seen(picture(scene, look, parallel(), SIZE)) == {0, 1, 2}  # one is before the near plane
    assert seen(picture(scene, look, parallel(), SIZE, clip_planes=[[1, 0, 0, 1.0]])) == {1, 2}
    look = Look(8.0, 10.0, 0.0, min_width=0.0, filter_by="n", low=2.0)
    assert seen(picture(scene, look, parallel(), SIZE)) == {1, 2}
    scene = HaloPoints(scene.points, {"n": np.array([1, np.nan, 3, 2])})
    assert seen(picture(scene, look, parallel(), SIZE)) == {2}


# -------------------------------------------------------------------------------------------------------- appendix A


def equation_4(away, look):
    """Width of the halo of a line on another one that lies so far behind it, and crosses it; signs as they must be.

    The paper's second and third case have line and strip the wrong way round.
    """
    least = look.line_width * look.max_displacement / look.strip_width
    if away <= least:
        return 0.0
    if away >= look.max_displacement:
        return (look.strip_width - look.line_width) / 2
    return (look.strip_width * away / look.max_displacement - look.line_width) / 2


def crossing(away):
    return lines([[-60, 0, 100], [60, 0, 100]], [[0, -60, 100 + away], [0, 60, 100 + away]])


@pytest.mark.parametrize("away", [0.0, 3.0, 7.9, 8.1, 9.0, 12.0, 17.5, 25.0, 39.9, 40.1, 90.0])
def test_the_halo_of_a_line_on_another(away):
    look = Look(8.0, 40.0, 40.0, **PLAIN)
    found = picture(crossing(away), look, parallel(), SIZE)
    column = found.kind[:, SIZE[0] // 2]
    white = np.count_nonzero(column == HALO) / 2
    assert abs(white - equation_4(away, look)) <= 0.5
    # The farther line is black up to there, and the nearer one all along.
    assert np.count_nonzero(column == LINE) == SIZE[1] - 2 * white
    row = found.kind[SIZE[1] // 2]
    assert (row == LINE).all()


@pytest.mark.parametrize("camera", CAMERAS)
def test_neighbours_in_one_plane_have_no_halo_on_each_other(camera):
    look = Look(4.0, 30.0, 40.0, **PLAIN)
    scene = lines(*([[-90, y, 100], [90, y, 100]] for y in (-8, 0, 5)))
    found = picture(scene, look, CAMERAS[camera](), SIZE)
    _, y = centres()
    assert ((found.kind == LINE) == (np.min([abs(y - n) for n in (-8, 0, 5)], axis=0) < 2)).all()
    # The halo between two is that of the nearer: a roof whose ridge is in their middle.
    between = (y > -6) & (y < -2)
    assert (found.owner == np.where(y < -4, 0, 2))[between].all()


# ------------------------------------------------------------------------------------------------------------- ends


def test_places_along_the_mask():
    """Of the paper's: n = 2, t = 0.2; short lines go as far as their middle from both ends."""
    wanted = {
        1: [0.5], 2: [0, 1], 3: [0, 0.5, 1], 4: [0, 0.1, 0.9, 1], 5: [0, 0.1, 0.5, 0.9, 1],
        6: [0, 0.1, 0.2, 0.8, 0.9, 1], 7: [0, 0.1, 0.2, 0.5, 0.8, 0.9, 1], 8: [0, 0.1, 0.2, 0.4, 0.6, 0.8, 0.9, 1],
    }  # fmt: skip
    for count, u in wanted.items():
        assert np.abs(places_along(count, 2, 0.2) - u).max() <= 0.5 / 65535
    assert np.abs(places_along(6, 1, 0.5) - [0, 0.5, 0.5, 0.5, 0.5, 1]).max() <= 0.5 / 65535
    far = places_along(100_001, 1000, 1e-3)
    assert (np.diff(far) >= 0).all()
    assert far[0] == 0
    assert far[-1] == 1
    assert (far[1:-1] > 0).all()
    assert (far[1:-1] < 1).all()
    assert np.abs(mask(np.array([0.0, 0.5, 1.0, 3.0])) - [0, np.sqrt(0.75), 1, 1]).max() < 1e-12


def test_tapered_ends_are_round():
    """With the ends of the mask on the first segment, half an ellipse; the line narrows as its strip does."""
    x, y = centres()
    look = Look(10.0, 30.0, 20.0, n_tapered=1, t_tapered=0.2, min_width=0.0, smooth=False)
    found = picture(line([-30, 0, 100], [-10, 0, 100], [20, 0, 100], [30, 0, 100]), look, parallel(), SIZE)
    end = np.where(x < -10, (x + 30) / 20, np.where(x > 20, (30 - x) / 10, 1.0))
    m = np.sqrt(np.clip(end * (2 - end), 0, 1)) * (end > 0)
    clear = found.margin > 1e-3  # u has 16 bits
    assert clear.mean() > 0.99
    assert (found.kind == kinds(abs(y) < 5 * m, abs(y) < 15 * m))[clear].all()
    ellipse = ((x + 10) / 20) ** 2 + (y / 15) ** 2 < 1
    left = (x < -10) & clear
    assert ((found.kind != NOTHING) == ellipse)[left].all()


def test_filtered_lines_end_where_their_numbers_do():
    x, y = centres()
    scene = line([-30, 0, 100], [0, 0, 100], [30, 0, 100], n=[0.0, 6.0, 0.0])
    for low, high in ((2.0, np.inf), (-np.inf, 3.35), (2.0, 3.35), (0.0, 6.0), (7.0, 8.0)):
        look = Look(10.0, 30.0, 20.0, filter_by="n", low=low, high=high, **PLAIN)
        found = picture(scene, look, parallel(), SIZE)
        number = 6 - abs(x) / 5
        there = (number >= low) & (number <= high) & (abs(x) < 30) & (abs(y) < 15)
        assert (found.kind == kinds(abs(y) < 5, there)).all()
        assert there.any() == (low < 7)


def test_filtered_ends_narrow_over_their_mm():
    x, y = centres()
    scene = line([-30, 0, 100], [30, 0, 100], n=[0.0, 6.0])
    look = Look(10.0, 30.0, 20.0, filter_by="n", low=2.0, high=5.0, filter_taper=8.0, **PLAIN)
    found = picture(scene, look, parallel(), SIZE)
    end = np.clip(np.minimum(x + 10, 20 - x) / 8, 0, 1)
    m = np.sqrt(end * (2 - end))
    assert (found.kind == kinds((abs(y) < 5 * m), (abs(y) < 15 * m) & (end > 0))).all()


def test_what_has_no_number_is_not_there():
    x, y = centres()
    scene = line(*([10 * i, 0, 100] for i in range(-3, 4)), n=[1, 1, 1, np.nan, 1, 1, 1])
    look = Look(10.0, 30.0, 20.0, filter_by="n", **PLAIN)
    found = picture(scene, look, parallel(), SIZE)
    assert ((found.kind != NOTHING) == ((abs(x) > 10) & (abs(x) < 30) & (abs(y) < 15))).all()


def test_rates_of_numbers():
    points = np.array([[0, 0, 0], [2, 0, 0], [2, 0, 0], [2, 4, 0], [9, 9, 9], [0, 0, 0], [0, 0, 5.0]])
    numbers = np.array([0, 6, 7, 9, 1, np.nan, 4.0])
    found = rates(points, np.array([0, 4, 5, 5, 7]), numbers)
    assert found == pytest.approx([3, 3, 0.5, 0.5, 0, 0, 0])


# ------------------------------------------------------------------------------------------------------------- bends


def bent(degrees, *, length=25.0):
    turn = np.radians(degrees)
    return line([-length, -5, 100], [0, -5, 100], [length * np.cos(turn), -5 + length * np.sin(turn), 100])


@pytest.mark.parametrize("degrees", [0.0, 20.0, 59.0, -59.0, 61.0, 90.0, 150.0, 180.0])
def test_bends(degrees):
    """Either segment goes on round; up to 60 degrees it ends at the bisector, where the other is as near."""
    look = Look(6.0, 16.0, 5.0, **PLAIN)
    found = picture(bent(degrees), look, parallel(), SIZE)
    x, y = centres()
    turn = np.radians(degrees)
    e = np.array([np.cos(turn), np.sin(turn)])
    first, second = (x, y + 5), (x * e[0] + (y + 5) * e[1], (y + 5) * e[0] - x * e[1])
    off = np.hypot(x, y + 5)
    one = np.where(first[0] < 0, abs(first[1]), off) + 99 * (first[0] < -25)
    two = np.where(second[0] > 0, abs(second[1]), off) + 99 * (second[0] > 25)
    away = np.minimum(one, two)
    assert (found.kind == kinds(away < 3, away < 8)).all()
    assert np.abs(found.depth - window_depth(100 + 5 * away / 8 * (away > 3)))[found.kind != NOTHING].max() < 1e-12
    # What lies next behind the line may be the other segment as line; halos are farther.
    assert (found.other >= 0.999 * window_depth(NEAR + 5 * 3 / 8))[found.kind == LINE].all()
    assert ((found.cover > 0) == (away < 8)).all()
    inner = (away < 8) & (off < 16)
    assert np.abs(found.cover - (8 - away))[inner].max() < 1e-9
    if abs(degrees) < 60:
        side = x * (1 + e[0]) + (y + 5) * e[1]
        assert (found.owner == np.where(away < 8, side > 0, -1)).all()


@pytest.mark.parametrize("degrees", [45.0, 120.0])
def test_bends_take_everything_from_the_foot(degrees):
    """Beyond a segment's end all is as at its end: depth, width, number."""
    turn = np.radians(degrees)
    far = [25 * np.cos(turn), -5 + 25 * np.sin(turn), 130]
    look = Look(6.0, 16.0, 5.0, min_width=0.0, smooth=False, n_tapered=1, t_tapered=0.1, width_cue=0.4)
    found = picture(line([-25, -5, 100], [0, -5, 115], far), look, parallel(), SIZE)
    x, y = centres()
    off = np.hypot(x, y + 5)
    beyond = (x > 0.1) & (x * np.cos(turn) + (y + 5) * np.sin(turn) < -0.1) & (found.kind != NOTHING)
    assert beyond.sum() > (3 if degrees < 60 else 30)
    # The vertex has u = 0.5: the middle of three; of the depth there is half, and of the cue.
    assert ((found.kind == LINE) == (off < 3 * 0.8))[beyond].all()
    assert np.abs(found.depth - window_depth(115 + 5 * off / 8 * (off > 2.4)))[beyond].max() < 1e-12
    assert np.isin(found.owner + found.t, [1.0])[beyond].all()


def test_steep_bends_are_round():
    """A segment that runs at the viewer, and whose strip so soon widens much, has no bisector with the next."""
    look = Look(6.0, 16.0, 5.0, **PLAIN)
    x, y = centres()
    before = (x < -0.1) & (np.hypot(x, y) < 3)
    for z, divided in ((140, False), (101, True)):
        found = picture(line([-5, 0, z], [0, 0, 100], [25, 0, 100]), look, perspective(), SIZE)
        assert (found.owner[before] == (0 if divided else 1)).all()


def test_repeated_points_and_segments_seen_end_on_are_round():
    """With the segments beside them, a disc."""
    look = Look(6.0, 16.0, 5.0, **PLAIN)
    x, y = centres()
    for middle in ([[0, 0, 100], [0, 0, 100]], [[0, 0, 100], [0, 0, 100], [0, 0, 100]], [[0, 0, 100], [0, 0, 150]]):
        found = picture(line([-20, 0, 100], *middle), look, parallel(), SIZE)
        away = np.where(x < 0, abs(y), np.hypot(x, y)) + 99 * (x < -20)
        assert (found.kind == kinds(away < 3, away < 8)).all()


def test_lines_without_extent_show_nothing():
    look = Look(6.0, 16.0, 5.0, **PLAIN)
    for scene in (lines(np.zeros((0, 3))), line([0, 0, 100]), lines([[0, 0, 100]], [[5, 0, 100]])):
        assert not picture(scene, look, parallel(), SIZE).kind.any()
    assert not picture(HaloPoints(np.zeros((0, 3))), look, parallel(), SIZE).kind.any()


# -------------------------------------------------------------------------------------------------------------- cuts


@pytest.mark.parametrize("camera", CAMERAS)
def test_planes_cut_the_axis_square(camera):
    look = Look(6.0, 16.0, 5.0, n_tapered=0, min_width=0.0)
    k = 1.0 if camera == "parallel" else 0.8
    slanting = [[1, 0.7, 0, 9.0], [-1, 3.0, 0, 20.0]]
    found = picture(
        line([-30, 0, 125], [-5, 0, 125], [30, 0, 125]), look, CAMERAS[camera](), SIZE, clip_planes=slanting
    )
    x, y = (n / k for n in centres())
    assert ((found.kind != NOTHING) == ((x > -9) & (x < 20) & (abs(y) < 8))).all()


def test_what_lies_behind_the_eye_is_not_there():
    """A line through the near plane, and the eye's own, shows up to where it meets the near plane."""
    look = Look(2.0, 6.0, 5.0, **PLAIN)
    found = picture(line([10, 0, 150], [2, 0, -90]), look, perspective(), SIZE)
    x, _ = centres()
    at_near = 100 * np.interp(NEAR, [-90, 150], [2, 10]) / NEAR
    shown = x[found.kind != NOTHING]
    assert shown.min() == pytest.approx(np.floor(100 * 10 / 150) + 0.5, abs=1)
    assert shown.max() == pytest.approx(at_near, abs=1)
    assert not picture(line([10, 0, -50], [2, 0, -90]), look, perspective(), SIZE).kind.any()


# ----------------------------------------------------------------------------------------------------------- margins


@hypothesis.given(
    seed=st.integers(0, 10_000), camera=st.sampled_from(sorted(CAMERAS)), filtered=st.booleans(), points=st.booleans(),
    angle=st.floats(0, 6.3),
)  # fmt: skip
@hypothesis.settings(max_examples=15)
def test_no_pixel_changes_within_its_margin(seed, camera, filtered, points, angle):
    """Moved by less than that, with nothing else as deep, a pixel's centre still shows the same."""
    rng = np.random.default_rng(seed)
    size, step = (40, 30), 0.05
    walks = [np.cumsum(rng.normal(0, 5, (int(rng.integers(2, 7)), 3)), axis=0) + [0, 0, 100] for _ in range(4)]
    several = lines(*walks)
    numbers = {"n": rng.uniform(0, 1, several.n_points)}
    scene = HaloPoints(several.points, numbers) if points else HaloLines(several.points, several.offsets, numbers)
    more = {"filter_by": "n", "low": 0.3, "filter_taper": 3.0} if filtered else {}
    look = Look(2.0, 9.0, 6.0, width_cue=0.3, **more)
    matrix = CAMERAS[camera](size)
    shift = np.eye(4)
    shift[:2, 3] = 2 * step * np.array([np.cos(angle), np.sin(angle)]) / size
    still, moved = (picture(scene, look, m, size) for m in (matrix, shift @ matrix))
    firm = (still.margin > 1.5 * step) & (still.gap > 2e-2)
    assert firm.mean() > 0.2
    same = still.kind == moved.kind
    assert same[firm].all()
    assert (still.owner == moved.owner)[firm].all()
