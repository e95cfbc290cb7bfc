"""Strips where lines turn: sharp and slight bends, bends by cuts and by the eye, bends too sharp for their width."""

import numpy as np
import pytest

from pvfiblets.engine import View
from pvfiblets.halos.reference import LINE, NOTHING

from .halos import ABOVE, EYES, PLAIN, SIZE, assert_shows, draw_halos, look, of_lines, wandering, zigzag

SCALE = 90 / 32
"""Pixels per mm at z = 0 of the cameras of ABOVE, but for a part in a hundred."""


@pytest.fixture(scope="module", params=EYES)
def view(request, camera):
    return View(SIZE, camera(SIZE, **EYES[request.param]))


@pytest.fixture(scope="module", params=ABOVE)
def above(request, camera):
    return View(SIZE, camera(SIZE, **ABOVE[request.param]))


@pytest.fixture
def shows(gl):
    """Return a function that draws and holds the picture against the reference's."""

    def check(drawn, view, some, **tolerances):
        found = draw_halos(gl, drawn, view, some)
        return found, *assert_shows(found, drawn, view, some, **tolerances)

    return check


def bend(degrees, *, rise=(0.0, 0.0), length=10.0, to_go=10.0, **values):
    """A line that turns at 0, in the plane across the cameras of ABOVE but for how much its ends are nearer."""
    turn = np.radians(degrees)
    end = to_go * np.array([np.cos(turn), np.sin(turn)])
    return of_lines([[-length, 0, rise[0]], [0, 0, 0], [*end, rise[1]]], **values)


def away_from(drawn):
    """(h, w) mm from the axis of a flat line to each pixel, under the parallel camera of ABOVE."""
    w, h = SIZE
    y, x = np.mgrid[:h, :w]
    pixels = np.stack([x + 0.5 - w / 2, y + 0.5 - h / 2], axis=-1) / SCALE
    a, b = drawn.points[:-1, None, None, :2], drawn.points[1:, None, None, :2]
    along = ((pixels - a) * (b - a)).sum(axis=-1) / np.maximum(((b - a) ** 2).sum(axis=-1), 1e-30)
    foot = a + np.clip(along, 0.0, 1.0)[..., None] * (b - a)
    return np.linalg.norm(pixels - foot, axis=-1).min(axis=0)


SLENDER = look(line_width=0.8, strip_width=3.0, **PLAIN)

LOOKS = {
    "plain": PLAIN,
    "the paper's": {},
    "wide": {**PLAIN, "line_width": 2.5, "strip_width": 10.0},
    "cue": {**PLAIN, "width_cue": 0.8},
    "taper 3": {"n_tapered": 3, "t_tapered": 0.1},
    "filter": {"filter_by": "number", "low": 0.4, "filter_taper": 1.0},
}


# ----------------------------------------------------------------------------------------------------- slight and sharp


@pytest.mark.few(12)
@pytest.mark.parametrize("name", LOOKS)
@pytest.mark.parametrize("seed", range(2))
def test_lines_that_turn_at_random(shows, view, seed, name):
    _, _, both = shows(zigzag(seed=seed), view, look(**LOOKS[name]), least=0.3)
    assert both.sum() > 300


def test_lines_that_turn_at_random_with_planes(shows, view):
    for plane in ([[0.3, 1.0, 0.1, 1.0]], [[-1.0, 0, 0.5, 0.3]]):
        shows(zigzag(), View(SIZE, view.model_view_projection, plane), look(**PLAIN), least=0.3)


@pytest.mark.parametrize(
    "some", [SLENDER, look(line_width=0.8, strip_width=3.0, min_width=0.0)], ids=["square", "tapered"]
)
@pytest.mark.parametrize("rise", [(0.0, 0.0), (3.0, -3.0), (-5.0, 5.0), (4.0, 2.0), (-20.0, 0.0), (0.0, 20.0)])
def test_bends_of_all_angles(shows, above, rise, some):
    angles = [0.0, 1.0, 15.0, 45.0, 58.0, -58.0, 62.0, -75.0, 90.0, 120.0, -150.0, 170.0]
    bends = [bend(degrees, rise=rise, length=3.0, to_go=4.0).points for degrees in angles]
    where = [(9.0 * (i % 4) - 13.0, 9.0 * (i // 4) - 10.0, 0.0) for i in range(12)]
    shows(of_lines(*(line + place for line, place in zip(bends, where, strict=True))), above, some)


CORNER = of_lines([[-9, -4, 0], [0, -4, 0], [0, 8, 3]], n=[0.0, 1.0, 2.0])
"""A bend of 90 degrees."""


@pytest.mark.parametrize(
    ("more", "planes"),
    [({}, []), ({}, [[1, 0, 0, 5.0]]), ({}, [[-1, 0, 0, -2.0]]), ({}, [[0, -1, 0, 1.0]]),
     ({"filter_by": "n", "low": 0.4}, []), ({"filter_by": "n", "high": 1.3, "filter_taper": 2.0}, []),
     ({"filter_by": "n", "low": 1.0}, []), ({"filter_by": "n", "high": 1.0}, []),
     ({"n_tapered": 1}, []), ({"width_cue": 0.9}, [])],
)  # fmt: skip
def test_a_strip_that_ends_round_keeps_what_is_along_it(shows, above, more, planes):
    """The half disc at a sharp bend is beyond the segment: all that varies along it ends at the vertex."""
    view = View(SIZE, above.model_view_projection, planes)
    shows(CORNER, view, look(**({"line_width": 2.0, "strip_width": 7.0} | PLAIN | more)))


@pytest.mark.parametrize("displacement", ["linear", (0.0, 0.0, 1.0)])
@pytest.mark.parametrize("deep", [0.0, 2.0])
def test_no_halo_notches_the_lines_own_bend(gl, camera, deep, displacement):
    """Where halos lie as deep as their line, that is seen all the same: as far as half its width from the axis."""
    view = View(SIZE, camera(SIZE, **ABOVE["parallel"]))
    some = look(line_width=2.0, strip_width=9.0, max_displacement=deep, displacement=displacement, **PLAIN)
    for degrees in (30.0, 80.0, -120.0, 165.0):
        drawn = bend(degrees)
        found, away = draw_halos(gl, drawn, view, some), away_from(drawn)
        inner = np.hypot(*np.meshgrid(np.arange(SIZE[0]) - 59.5, np.arange(SIZE[1]) - 44.5)) < 8 * SCALE
        sure = inner & (np.abs(away - 1.0) * SCALE > 0.01)
        assert ((found.kind == LINE) == (away < 1.0))[sure].all()


# ------------------------------------------------------------------------------------------------------- cuts, the eye


@pytest.mark.parametrize("degrees", [30.0, -59.0, 61.0, 90.0, 150.0])
def test_planes_that_cut_next_to_a_bend(shows, above, degrees):
    """Square, however little of a segment is left, and round at the bend itself; by either side of the plane."""
    turn = np.radians(degrees)
    line = bend(degrees, rise=(1.0, 2.0), length=3.0, to_go=3.0).points
    for side, way in ((-1.0, np.array([-1.0, 0.0])), (1.0, np.array([np.cos(turn), np.sin(turn)]))):
        # One after the other across the way of the segment that is cut, the plane ever farther along it.
        along, across = np.array([*way, 0.0]), np.array([-way[1], way[0], 0.0])
        lines = [line + 7.0 * i * across - off * along for i, off in enumerate((1e-4, 0.01, 0.1, 0.5, 2.0), -2)]
        for sign in (-1.0, 1.0):
            plane = sign * np.array([*way, 0.2 * side, 0.0])
            shows(of_lines(*lines), View(SIZE, above.model_view_projection, [plane]), SLENDER, least=0.5)


@pytest.mark.parametrize("degrees", [40.0, 100.0])
def test_a_cut_is_square_however_wide_the_strip_is_beside_a_bend(gl, camera, degrees):
    """Of the segment after the bend is left far less than its strip is wide: nothing is beyond the cut."""
    turn = np.radians(degrees)
    way = np.array([np.cos(turn), np.sin(turn), 0.0])
    some = look(line_width=3.0, strip_width=12.0, **PLAIN)
    y, x = (np.mgrid[: SIZE[1], : SIZE[0]] + 0.5 - np.array([45, 60])[:, None, None]) / SCALE
    for left in (0.05, 0.6, 2.0):
        view = View(SIZE, camera(SIZE, **ABOVE["parallel"]), [[*-way, left]])
        found = draw_halos(gl, bend(degrees), view, some)
        assert_shows(found, bend(degrees), view, some, least=0.3)
        beyond = x * way[0] + y * way[1] > left + 0.01
        on_its_way = (x > 0.01) & (abs(y) < 6.0) if degrees < 90 else found.owner == 1
        assert not (found.shown & beyond & on_its_way & (found.owner == 1)).any()
        assert not (found.kind == LINE)[beyond & (x > 3.1)].any()


@pytest.mark.parametrize("angle", [60.0, 110.0])
def test_bends_with_an_end_behind_the_eye(shows, camera, angle):
    """Which way such a segment goes in the window is known; how much of it there is ends at the near plane."""
    view = View(SIZE, camera(SIZE, eye=(0, 0, 0), target=(0, 1, 0), near=0.2, far=80.0, angle=angle))
    some = look(line_width=0.3, strip_width=1.0, **PLAIN)
    for behind in ([2, -8, 1], [-3, -1, -2], [0.4, -20, 0.1], [9, -9, 9]):
        lines = []
        for vertex in ([1, 4, 0.5], [-2, 6, 1], [0.3, 3, -1.2]):
            for ahead in ([3, 9, 2], [-4, 5, 0], [1.2, 4.1, -3], [-1, 12, 1]):
                lines += [[behind, vertex, ahead], [ahead, np.add(vertex, 0.2), behind]]
        found, _, _ = shows(of_lines(*lines), view, some, least=0.5)
        shown = np.unique(found.owner[found.kind == LINE])
        assert (shown % 6 == 0).sum() > 1
        assert (shown % 6 == 4).sum() > 1


def test_a_camera_among_lines_that_turn(shows, camera):
    for seed in range(3):
        view = View(SIZE, camera(SIZE, eye=(0, 0, 1), target=(4, 3, 0), near=0.1, far=100.0, angle=80.0))
        shows(zigzag(10, 9, seed), view, look(**PLAIN), least=0.2)
        shows(wandering(10, 9, seed), view, look(**PLAIN), least=0.4)


# ----------------------------------------------------------------------------------------- too sharp for their width


def ring(radius, n, degrees=360.0, *, around=0.0):
    t = np.radians(around) + np.linspace(0.0, np.radians(degrees), n)
    return np.stack([radius * np.cos(t), radius * np.sin(t), np.zeros(n)], axis=1)


@pytest.mark.parametrize(("radius", "n"), [(r, n) for r in (0.3, 1.5, 4.0) for n in (7, 13, 41)] + [(1.5, 200)])
def test_a_ring_of_less_than_its_strips_width(gl, camera, radius, n):
    """A disc without a hole, and a line that no halo of it touches."""
    view = View(SIZE, camera(SIZE, **ABOVE["parallel"]))
    some = look(line_width=0.5, strip_width=12.0, max_displacement=4.0, smooth=False, **PLAIN)
    drawn = of_lines(ring(radius, n, 540.0))
    found, away = draw_halos(gl, drawn, view, some), away_from(drawn)
    sure = np.abs(away - 0.25) * SCALE > 0.01
    assert ((found.kind == LINE) == (away < 0.25))[sure].all()
    sure = np.abs(away - 6.0) * SCALE > 0.01
    assert (found.shown == (away < 6.0))[sure].all()
    assert (found.depth[found.shown] < 1.0).all()
    if n < 100:
        assert_shows(found, drawn, view, some, least=0.0)


@pytest.mark.parametrize("degrees", [30.0, -50.0, 59.0])
def test_ends_after_a_bend_stay_square(gl, camera, degrees):
    """The last segment is far shorter than its strip is wide; nothing of it is beyond the line's end."""
    view = View(SIZE, camera(SIZE, **ABOVE["parallel"]))
    some = look(line_width=4.0, strip_width=14.0, **PLAIN)
    turn = np.radians(degrees)
    way = np.array([np.cos(turn), np.sin(turn)])
    y, x = (np.mgrid[: SIZE[1], : SIZE[0]] + 0.5 - np.array([45, 60])[:, None, None]) / SCALE
    for left in (0.01, 0.5, 2.0):
        for flip in (False, True):
            drawn = bend(degrees, to_go=left)
            drawn = of_lines(drawn.points[::-1]) if flip else drawn
            found = draw_halos(gl, drawn, view, some)
            assert_shows(found, drawn, view, some, least=0.3)
            beyond = x * way[0] + y * way[1] > left + 0.01
            before = x * (1 + way[0]) + y * way[1] < 0.01  # on the first segment's side of the bisector
            assert not found.shown[beyond & ~before].any()


@pytest.mark.parametrize("seed", range(2))
def test_lines_that_turn_within_their_strips(gl, view, seed):
    """Steps of a tenth of the width, in all directions: no holes, nothing out of place, and everything finite."""
    drawn = wandering(3, 50, seed, wander=0.4, step=0.6)
    for more in (PLAIN, {"width_cue": 0.5}, {"filter_by": "number", "low": 0.3}):
        some = look(strip_width=6.0, **more)
        found = draw_halos(gl, drawn, view, some)
        wanted, _ = assert_shows(found, drawn, view, some, least=0.0)
        assert np.isfinite(found.depth).all()
        beside = np.abs(wanted.margin) > 0.03
        assert (found.shown == (wanted.kind != NOTHING))[beside].all()
