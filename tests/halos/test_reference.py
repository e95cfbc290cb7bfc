"""The float64 reference of halos against closed forms: one strip, one disc, two that cross, and how sure it is."""

from __future__ import annotations

import hypothesis
import numpy as np
import pytest
from hypothesis import strategies as st

from pvfiblets.halos import HaloLines, HaloPoints, HaloStyle
from pvfiblets.report.studies.halos.reference import HALO, LINE, picture

from .views import CAMERAS, PLAIN, SIZE, centres, kinds, line, lines, parallel, perspective, window_depth

# ------------------------------------------------------------------------------------------------------- one strip


@pytest.mark.parametrize(("camera", "k"), [("parallel", 1.0), ("perspective", 100.0 / 120.0)])
def test_a_strip_across_the_view(camera, k):
    x, y = centres()
    look = HaloStyle(line_width=6.2, strip_width=21.0, max_displacement=30.0, **PLAIN)
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
    look = HaloStyle(line_width=9.0, strip_width=9.0, max_displacement=0.0, **PLAIN)
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
    look = HaloStyle(2.0, 30.0, 40.0, displacement=name, **PLAIN)
    found = picture(line([-99, 0, 120], [99, 0, 120]), look, parallel(), SIZE)
    _, y = centres()
    halo = (abs(y) > 1) & (abs(y) < 15)
    assert ((found.kind == HALO) == halo).all()
    assert np.abs(found.depth - window_depth(120 + 40 * function(abs(y) / 15)))[halo].max() < 1e-12


def test_depth_is_displaced_along_the_view_axis():
    """A halo off the picture's middle is as far behind by its distance along the axis, not along its ray."""
    look = HaloStyle(2.0, 20.0, 50.0, **PLAIN)
    found = picture(line([-60, 40, 120], [60, 40, 120]), look, perspective(), SIZE)
    x, y = centres()
    away = abs(y * 1.2 - 40)
    halo = (away > 1) & (away < 10) & (abs(x) * 1.2 < 60)
    assert halo.sum() > 300
    assert np.abs(found.depth - window_depth(120 + 5 * away, "perspective"))[halo].max() < 1e-12


@pytest.mark.parametrize("smooth", [True, False])
def test_ink_between_line_and_halo(smooth):
    look = HaloStyle(7.3, 21.0, 40.0, n_tapered=0, min_width=0.0, smooth=smooth)
    found = picture(line([-99, 0, 120], [99, 0, 120]), look, parallel(), SIZE)
    _, y = centres()
    expected = np.clip(3.65 - abs(y) + 0.5, 0, 1) if smooth else abs(y) < 3.65
    assert np.abs(found.ink - expected).max() < 1e-12
    assert ((found.kind == LINE) == (abs(y) < 3.65)).all()


def test_thin_lines_take_their_least_width_and_keep_their_halo_beside_it():
    _, y = centres()
    for width, inked, reach in ((0.2, 2.5, 2.5 + 9.9), (9.0, 4.5, 10.0)):
        look = HaloStyle(width, 20.0, 30.0, n_tapered=0, min_width=5.0, smooth=False)
        found = picture(line([-99, 0.2, 120], [99, 0.2, 120]), look, parallel(), SIZE)
        assert (found.kind == kinds(abs(y - 0.2) < inked, abs(y - 0.2) < reach)).all()


@pytest.mark.parametrize("camera", CAMERAS)
def test_depth_cueing_by_width(camera):
    """The nearest line has its width, the farthest what the cue leaves, and the strip keeps its own."""
    look = HaloStyle(6.0, 14.0, 1.0, width_cue=0.75, **PLAIN)
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
    flat, y = picture(line([-9, 0, 80], [9, 0, 80]), look, parallel(), SIZE), centres()[1]  # has no depth to cue
    assert ((flat.kind == LINE) == ((abs(y) < 3) & (abs(x) < 9))).all()


# ------------------------------------------------------------------------------------------------------------ points


@pytest.mark.parametrize(("camera", "k"), [("parallel", 1.0), ("perspective", 100.0 / 120.0)])
def test_a_point_is_a_round_cone(camera, k):
    look = HaloStyle(8.0, 30.0, 60.0, min_width=0.0, smooth=False)
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
    look = HaloStyle(8.0, 10.0, 0.0, min_width=0.0)
    seen = lambda found: set(np.unique(found.owner)) - {-1}  # noqa: E731
    assert seen(picture(scene, look, parallel(), SIZE)) == {0, 1, 2}  # one is before the near plane
    assert seen(picture(scene, look, parallel(), SIZE, clip_planes=[[1, 0, 0, 1.0]])) == {1, 2}
    look = HaloStyle(8.0, 10.0, 0.0, min_width=0.0, filter_by="n", low=2.0)
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


@pytest.mark.parametrize("away", [0.0, 7.9, 8.1, 12.0, 25.0, 39.9, 40.1, 90.0])
def test_the_halo_of_a_line_on_another(away):
    look = HaloStyle(8.0, 40.0, 40.0, **PLAIN)
    found = picture(crossing(away), look, parallel(), SIZE)
    column = found.kind[:, SIZE[0] // 2]
    white = np.count_nonzero(column == HALO) / 2
    assert abs(white - equation_4(away, look)) <= 0.5
    # The farther line is black up to there, and the nearer one all along.
    assert np.count_nonzero(column == LINE) == SIZE[1] - 2 * white
    row = found.kind[SIZE[1] // 2]
    assert (row == LINE).all()


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
    look = HaloStyle(2.0, 9.0, 6.0, width_cue=0.3, **more)
    matrix = CAMERAS[camera](size)
    shift = np.eye(4)
    shift[:2, 3] = 2 * step * np.array([np.cos(angle), np.sin(angle)]) / size
    still, moved = (picture(scene, look, m, size) for m in (matrix, shift @ matrix))
    firm = (still.margin > 1.5 * step) & (still.gap > 2e-2)
    assert firm.mean() > 0.2
    same = still.kind == moved.kind
    assert same[firm].all()
    assert (still.owner == moved.owner)[firm].all()
