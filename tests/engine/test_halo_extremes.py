"""Lines and points with halos where it is hard: no length, end on, all around, far away, tiny and huge."""

import numpy as np
import pytest

from pvfiblets.engine import View
from pvfiblets.halos import HaloLines, HaloPoints
from pvfiblets.halos.reference import HALO, LINE

from .halos import (
    ABOVE,
    EYES,
    PLAIN,
    SIZE,
    assert_same,
    assert_shows,
    draw_halos,
    look,
    moved,
    of_lines,
    scattered,
    wandering,
)


@pytest.fixture(scope="module", params=ABOVE)
def above(request, camera):
    return View(SIZE, camera(SIZE, **ABOVE[request.param]))


@pytest.fixture(scope="module", params=EYES)
def view(request, camera):
    return View(SIZE, camera(SIZE, **EYES[request.param]))


BROAD = look(line_width=2.0, strip_width=7.0, **PLAIN)
TAPERED = look(line_width=2.0, strip_width=7.0, min_width=0.0)


# --------------------------------------------------------------------------------------------------- no length, end on

REPEATED = {
    "twice in the middle": [[-9, 0, 0], [0, 0, 0], [0, 0, 0], [9, 1, 0]],
    "five times in a bend": [[-9, 0, 0], *[[0, 0, 0]] * 5, [0, 9, 0]],
    "at the start": [[-9, 0, 0], [-9, 0, 0], [9, 0, 0]],
    "at the end": [[-9, 0, 0], [9, 0, 0], [9, 0, 0], [9, 0, 0]],
    "all": [[3, 1, 0]] * 6,
    "two that are one": [[3, 1, 0]] * 2,
}


@pytest.mark.parametrize("some", [BROAD, TAPERED], ids=["square", "tapered"])
@pytest.mark.parametrize("name", REPEATED)
def test_repeated_points(gl, above, name, some):
    drawn = of_lines(REPEATED[name], [[-9, -9, 1], [9, -9, 1]])
    found = draw_halos(gl, drawn, above, some)
    assert_shows(found, drawn, above, some, least=0.3)
    assert found.shown[:45].any()  # the other line


def test_a_step_that_hardly_is_one(gl, above):
    """Half discs around either end; whichever way it goes, all within is there."""
    for step in (1e-9, 1e-6, 1e-4):
        drawn = of_lines([[-9, 0, 0], [0, 0, 0], [0, step, 0], [9, 0, 0]])
        found = draw_halos(gl, drawn, above, BROAD)
        straight = draw_halos(gl, of_lines([[-9, 0, 0], [9, 0, 0]]), above, BROAD)
        assert (found.kind == straight.kind).mean() > 0.999


@pytest.mark.parametrize("kind", ABOVE)
def test_strips_seen_end_on(gl, camera, kind):
    """V is parallel to D: the segment itself has no strip, and its neighbours end round."""
    view = View(SIZE, camera(SIZE, **ABOVE[kind]))
    alone = of_lines([[0, 0, -5], [0, 0, 5]], [[0, 0, -9], [0, 0, -8], [0, 0, -7]])
    found = draw_halos(gl, alone, view, BROAD)
    assert (found.kind == LINE).sum() <= np.pi * (2.2 / 2 * 90 / 32) ** 2
    bent = of_lines([[-9, 0, 0], [0, 0, 0], [0, 0, -6]])
    found = draw_halos(gl, bent, view, BROAD)
    assert found.kind[45, 60] == LINE  # it ends round at the picture's middle
    if kind == "parallel":
        assert_shows(found, bent, view, BROAD)


@pytest.mark.parametrize("degrees", [179.0, 179.999, 180.0, -180.0])
def test_a_line_that_turns_back(gl, above, degrees):
    """As far back as it came, beneath or upon itself; round where it turns."""
    turn = np.radians(degrees)
    for deep in (0.0, -4.0, 4.0):
        drawn = of_lines([[-9, 0, 0], [0, 0, 0], [9 * np.cos(turn), 9 * np.sin(turn), deep]])
        found = draw_halos(gl, drawn, above, BROAD)
        y, x = np.argwhere(found.kind == LINE).T
        scale = 90 / 32
        assert abs((x.max() + 1 - 60) / scale - 1.0) < 0.6
        assert abs((60 - x.min()) / scale - 9.0) < 1.2
        if deep:
            assert_shows(found, drawn, above, BROAD, least=0.3)


def test_lines_of_one_point_and_no_lines(gl, view):
    none = HaloLines(np.zeros((0, 3)), [0])
    one_each = of_lines(*np.random.default_rng(0).uniform(-9, 9, (7, 1, 3)))
    for drawn in (none, HaloLines(np.zeros((0, 3)), [0, 0, 0]), one_each, HaloPoints(np.zeros((0, 3)))):
        for planes in ((), [[0, 1.0, 0, 0]]):
            assert not draw_halos(gl, drawn, View(SIZE, view.model_view_projection, planes), look()).shown.any()
    with_values = HaloLines(np.zeros((0, 3)), [0], {"n": np.zeros(0), "c": np.zeros((0, 4), np.float32)})
    for values in ("n", "c"):
        assert not draw_halos(gl, with_values, view, look(filter_by="n"), values=values).shown.any()


def test_lines_of_one_point_among_others(gl, view):
    drawn = wandering()
    parts = [[[0.0, 0, 0]], drawn.points[:7], [[5.0, 5, 5]], [[5.0, 5, 6]], drawn.points[7:], [[1.0, 1, 1]]]
    offsets = np.cumsum([0, 1, 7, 1, 1, *np.diff(drawn.offsets)[1:], 1])
    found = draw_halos(gl, HaloLines(np.concatenate(parts), offsets), view, look())
    assert (found.kind == draw_halos(gl, drawn, view, look()).kind).all()


# ------------------------------------------------------------------------------------------------------ wide and flat


def test_strips_wider_than_the_scene(gl, view):
    """Of straight lines, one halo each over the whole picture; all pixels show the nearest."""
    drawn = wandering(6, 2, seed=1, step=14.0)
    some = look(strip_width=500.0, max_displacement=50.0, **PLAIN)
    found = draw_halos(gl, drawn, view, some)
    assert_shows(found, drawn, view, some)
    assert found.shown.mean() > 0.3
    bent, some = wandering(6, 9, seed=1), look(strip_width=40.0, max_displacement=50.0, **PLAIN)
    found = draw_halos(gl, bent, view, some)
    assert_shows(found, bent, view, some, least=0.0)
    assert (found.kind == LINE).sum() > 300


def test_halos_that_do_not_lie_back_hide_all_behind_their_lines(gl, above):
    some = look(strip_width=6.0, max_displacement=0.0, **PLAIN)
    drawn = of_lines([[-15, 0, 0], [15, 0, 0]], [[0, -15, -0.01], [0, 15, -0.01]])
    found = draw_halos(gl, drawn, above, some)
    assert_shows(found, drawn, above, some)
    behind = np.flatnonzero(found.owner[:, 60] == 2)
    k = 90 / 32
    assert np.diff(behind).max() == pytest.approx(6.0 * k, abs=1.5)


def test_a_halo_behind_the_far_plane_is_there(gl, camera):
    view = View(SIZE, camera(SIZE, eye=(0, 0, 60), up=(0, 1, 0), near=10.0, far=61.0, height=32.0))
    some = look(strip_width=8.0, max_displacement=1000.0, **PLAIN)
    drawn = of_lines([[-15, 0, 0], [15, 0, 0]])
    found = draw_halos(gl, drawn, view, some)
    assert_shows(found, drawn, view, some)
    assert (found.kind == HALO).sum() > (found.kind == LINE).sum()


@pytest.mark.parametrize("size", [(1, 1), (1, 50), (70, 1), (3, 2)])
def test_small_pictures(gl, camera, size):
    for drawn in (wandering(), scattered()):
        view = View(size, camera(size, **EYES["parallel"]))
        assert_shows(draw_halos(gl, drawn, view, look()), drawn, view, look(), least=0.0)


# ------------------------------------------------------------------------------------------------ behind and all around


@pytest.mark.parametrize("angle", [70.0, 120.0])
def test_a_camera_within_the_data(gl, camera, angle):
    """Segments begin and end behind the eye."""
    eye = {"eye": (0, 0, 1), "target": (4, 3, 0), "near": 0.1, "far": 100.0, "angle": angle}
    view = View(SIZE, camera(SIZE, **eye))
    sticks = wandering(30, 2, seed=5, step=25.0)
    found = draw_halos(gl, sticks, view, look(**PLAIN))
    assert_shows(found, sticks, view, look(**PLAIN))
    assert found.shown.sum() > 2000
    points = scattered(200)
    assert_shows(draw_halos(gl, points, view, look()), points, view, look())


@pytest.mark.parametrize("kind", EYES)
def test_a_small_part_of_long_lines(gl, camera, kind):
    """Segments of hundreds of pictures' width, most of which is cut off beside the picture."""
    closer = {"height": 0.4} if kind == "parallel" else {"angle": 0.4}
    view = View(SIZE, camera(SIZE, **EYES[kind] | closer | {"target": (0.5, 0.0, -0.4)}))
    some = look(line_width=0.02, strip_width=0.1, max_displacement=0.2, n_tapered=1, t_tapered=0.4, width_cue=0.4)
    ways = np.random.default_rng(1).normal(0, 1, (8, 2, 3)) * [40, 20, 40]
    lines = [np.array([[0.5, 0, -0.4] + a, [0.5, 0, -0.4] - 0.9 * a + 0.004 * b]) for a, b in ways]
    drawn = of_lines(*lines)
    found = draw_halos(gl, drawn, view, some)
    wanted, _ = assert_shows(found, drawn, view, some, depth=1e-5)
    assert (wanted.kind == LINE).sum() > 500


def test_what_is_behind_the_camera_is_not_there(gl, camera):
    view = View(SIZE, camera(SIZE, eye=(0, -62, 0), target=(0, -100, 0), near=1.0, far=500.0))
    for drawn in (wandering(), scattered()):
        for some in (look(), look(strip_width=200.0, width_cue=0.5)):
            assert not draw_halos(gl, drawn, view, some).shown.any()


def test_lines_through_the_eye(gl, camera):
    """Something or nothing, but no number that is none."""
    for height in (None, 20.0):
        view = View(SIZE, camera(SIZE, eye=(0, 0, 0), target=(0, 1, 0), near=0.1, far=50.0, height=height))
        lines = of_lines([[0, -5, 0], [0, 5, 0]], [[0.01, 0, 0], [3, 9, 0]], [[-1, 0, 0], [1, 0, 0]], [[0, 0, 0]] * 2)
        found = draw_halos(gl, lines, view, look(line_width=0.1, strip_width=0.5, **PLAIN))
        assert found.shown.sum() > 0
        draw_halos(gl, HaloPoints(lines.points), view, look())


def test_views_without_depth_or_size_are_harmless(gl):
    flat = np.diag([0.02, 0.02, 0.0, 1.0])
    for matrix in (np.zeros((4, 4)), flat, np.diag([1e-30, 1e-30, 1e-30, 1.0]), np.diag([1e30, 1e30, 1e30, 1.0])):
        for drawn in (wandering(), scattered()):
            draw_halos(gl, drawn, View(SIZE, matrix), look(width_cue=0.5))


# ----------------------------------------------------------------------------------------------------- far, tiny, huge


@pytest.mark.parametrize("kind", ["lines", "points"])
@pytest.mark.parametrize("name", EYES)
def test_a_million_millimetres_away(gl, camera, name, kind):
    """Float64 places as far from 0 as that: the same picture, pixel by pixel."""
    drawn = wandering() if kind == "lines" else scattered()
    matrix, back = camera(SIZE, **EYES[name]), np.eye(4)
    back[:3, 3] = -1e6
    planes = np.array([[0.3, 1.0, 0.1, 1.0]])
    away = planes - np.array([[0, 0, 0, 1.4e6]])
    for some in (look(), look(width_cue=0.9)):
        near = draw_halos(gl, drawn, View(SIZE, matrix, planes), some)
        far = draw_halos(gl, moved(drawn, shift=1e6), View(SIZE, matrix @ back, away), some)
        assert (near.kind != far.kind).sum() <= 2
        same = near.kind == far.kind
        assert np.abs(near.depth - far.depth)[same].max() < 1e-6
        assert (near.owner == far.owner)[same].mean() > 0.999


@pytest.mark.parametrize("scale", [1e-6, 1e6])
@pytest.mark.parametrize("name", EYES)
def test_tiny_and_huge_data(gl, camera, name, scale):
    """A picture does not depend on what a mm is."""
    matrix = camera(SIZE, **EYES[name])
    grown = np.diag([1 / scale] * 3 + [1.0])
    for drawn in (wandering(), scattered()):
        for more in ({}, {"width_cue": 0.6}, {"filter_by": "number", "low": 0.3, "filter_taper": 1.5}):
            lengths = {"line_width": 1.0, "strip_width": 4.0, "max_displacement": 2.5, "filter_taper": 0.0} | more
            scaled = {key: n * scale if key in ("line_width", "strip_width", "max_displacement", "filter_taper") else n
                      for key, n in lengths.items()}  # fmt: skip
            usual = draw_halos(gl, drawn, View(SIZE, matrix), look(**lengths))
            other = draw_halos(gl, moved(drawn, scale=scale), View(SIZE, matrix @ grown), look(**scaled))
            assert (usual.kind != other.kind).sum() <= 2
            same = usual.kind == other.kind
            assert np.abs(usual.depth - other.depth)[same].max() < 1e-6
            assert usual.shown.sum() > 300


def test_projections_that_are_scaled_are_the_same(gl, view):
    """Clip coordinates are homogeneous."""
    one = draw_halos(gl, wandering(), view, look(width_cue=0.5))
    other = draw_halos(gl, wandering(), View(SIZE, 64.0 * view.model_view_projection), look(width_cue=0.5))
    assert_same(one, other)


def test_a_line_of_many_vertices(gl, above):
    """A spiral of 10^5 vertices, far smaller than a pixel from one to the next, is as one of a few hundred."""

    def spiral(n):
        t = np.linspace(0, 1, n)
        return of_lines(np.stack([13 * t * np.cos(40 * t), 13 * t * np.sin(40 * t), -4 * t], axis=1))

    some = look(line_width=0.7, strip_width=2.0, **PLAIN)
    fine, coarse = draw_halos(gl, spiral(100_000), above, some), draw_halos(gl, spiral(1000), above, some)
    assert (fine.kind == LINE).sum() > 1000
    assert (fine.kind != coarse.kind).mean() < 0.01
    both = (fine.kind == coarse.kind) & fine.shown
    assert np.quantile(np.abs(fine.depth - coarse.depth)[both], 0.99) < 1e-3
