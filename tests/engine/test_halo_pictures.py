"""Lines and points with halos against the float64 reference: every look, bends, cuts, filters, and where it is hard."""

import numpy as np
import pytest

from pvfiblets.engine import View
from pvfiblets.halos import HaloLines, HaloPoints
from pvfiblets.report.studies.halos.reference import HALO, LINE, NOTHING

from .halos import (
    ABOVE,
    EYES,
    PLAIN,
    SIZE,
    assert_same,
    assert_shows,
    draw_halos,
    equation_4,
    look,
    moved,
    of_lines,
    scattered,
    wandering,
    with_numbers,
    zigzag,
)


@pytest.fixture(scope="module", params=EYES)
def view(request, camera):
    return View(SIZE, camera(SIZE, **EYES[request.param]))


@pytest.fixture(scope="module", params=ABOVE)
def above(request, camera):
    return View(SIZE, camera(SIZE, **ABOVE[request.param]))


@pytest.fixture
def shows(gl):
    """Return a function that draws and holds the picture against the reference's."""

    def check(drawn, view, some, *, values=None, **tolerances):
        found = draw_halos(gl, drawn, view, some, values=values)
        return found, *assert_shows(found, drawn, view, some, **tolerances)

    return check


# ------------------------------------------------------------------------------------------------------------- looks

LOOKS = {
    "plain": PLAIN,
    "the paper's": {},
    "hard edges": {**PLAIN, "smooth": False},
    "wide": {**PLAIN, "line_width": 2.5, "strip_width": 10.0},
    "all line": {**PLAIN, "line_width": 3.0},
    "square": {"displacement": "square"},
    "square root": {"displacement": "square root"},
    "table of 2": {"displacement": (0.3, 1.0)},
    "table of 5": {"displacement": (0.0, 0.8, 0.1, 0.9, 0.5)},
    "table of 64": {"displacement": tuple(np.linspace(0, 1, 64) ** 3)},
    "shallow": {"max_displacement": 0.4},
    "deep": {"max_displacement": 60.0},
    "cue": {**PLAIN, "width_cue": 0.8},
    "full cue": {"width_cue": 1.0, "min_width": 0.0},
    "taper 1": {"n_tapered": 1, "t_tapered": 0.5},
    "taper 3": {"n_tapered": 3, "t_tapered": 0.1},
    "taper 9": {"n_tapered": 9, "t_tapered": 0.4},
}


@pytest.mark.few(22)
@pytest.mark.parametrize("name", LOOKS)
@pytest.mark.parametrize("kind", ["lines", "points"])
def test_every_look(shows, view, kind, name):
    drawn = wandering() if kind == "lines" else scattered()
    some = look(**({"line_width": 1.2} | LOOKS[name]))
    _, wanted, _ = shows(drawn, view, some)
    assert (wanted.kind == LINE).sum() > 50
    assert (wanted.kind == HALO).sum() > (100 if name != "all line" else -1)


@pytest.mark.parametrize("cue", [0.0, 0.7])
def test_thin_lines_are_widened_to_their_least_width(shows, view, cue):
    some = look(line_width=0.2, min_width=3.0, width_cue=cue)
    found, wanted, _ = shows(wandering(), view, some)
    assert found.ink.sum() == pytest.approx(wanted.ink.sum(), rel=0.01)
    thin, _, _ = shows(wandering(), view, look(line_width=0.2, min_width=0.0))
    assert (found.kind == LINE).sum() > 3 * (thin.kind == LINE).sum()
    shows(scattered(), view, some)


@pytest.mark.parametrize("min_width", [0.0, 1.0, 3.0])
def test_long_segments_that_recede(gl, camera, min_width):
    """From wider than the least width to far thinner: the line is straight, and its width right, all along."""
    size = (200, 150)
    view = View(size, camera(size, eye=(0, 0, 10), up=(0, 1, 0), near=1.0, far=500.0, angle=40.0))
    some = look(line_width=0.05, strip_width=0.6, max_displacement=1.0, n_tapered=0, min_width=min_width)
    for end in ([10, 5, -100], [40, 20, -100], [-30, 25, 0]):
        drawn = of_lines([[-1, -1, 5], end])
        assert_shows(draw_halos(gl, drawn, view, some), drawn, view, some)


def test_depth_cueing_ends_at_the_eye(shows, camera):
    """What lies behind the eye counts as beside it: a line that comes from behind is as wide as the reference's."""
    drawn = of_lines([[-2, -40, -1], [-2, 30, 4]], [[3, -60, 0], [1.5, 20, -2]], [[-20, 40, -9], [20, 40, 9]])
    view = View(SIZE, camera(SIZE, eye=(0, 0, 0), target=(0, 30, 0), near=1.0, far=100.0, angle=60.0))
    _, wanted, _ = shows(drawn, view, look(width_cue=0.9, **PLAIN))
    assert (wanted.kind == LINE).sum() > 300


def test_smooth_edges(shows, view):
    """Ink goes from 1 to 0 over a pixel about a line's edge, on both sides of it."""
    for drawn in (wandering(), scattered()):
        found, wanted, both = shows(drawn, view, look(line_width=1.4, **PLAIN))
        between = both & (wanted.ink > 0.05) & (wanted.ink < 0.95)
        assert between.sum() > 150
        assert np.abs(found.ink - wanted.ink)[both].max() < 0.02
        assert ((found.ink > 0.5) == (found.kind == LINE))[both & (abs(wanted.ink - 0.5) > 0.02)].all()


def test_edges_that_are_not_smooth(gl, view):
    found = draw_halos(gl, wandering(), view, look(smooth=False))
    assert (found.ink == (found.kind == LINE)).all()


@pytest.mark.parametrize("count", [2, 3, 4, 5, 6, 9])
@pytest.mark.parametrize(("n", "t"), [(1, 0.5), (2, 0.2), (5, 0.3), (1000, 0.01)])
def test_ends_of_lines_with_few_vertices(shows, above, count, n, t):
    places = np.stack([np.linspace(-10, 10, count), np.sin(0.4 * np.arange(count)), np.zeros(count)], axis=1)
    shows(of_lines(places), above, look(line_width=3.0, strip_width=9.0, n_tapered=n, t_tapered=t))


# ---------------------------------------------------------------------------------------------------------- filtering


@pytest.mark.few(15)
@pytest.mark.parametrize("taper", [0.0, 2.0, 30.0])
@pytest.mark.parametrize(("low", "high"), [(0.4, np.inf), (-np.inf, 0.55), (0.3, 0.6), (0.0, 1.0), (2.0, 3.0)])
def test_filters(shows, view, low, high, taper):
    some = look(filter_by="number", low=low, high=high, filter_taper=taper)
    for drawn in (wandering(seed=2), scattered()):
        _, wanted, _ = shows(drawn, view, some)
        assert (wanted.kind != NOTHING).any() == (low < 1)


def test_what_has_no_number_is_not_there(shows, view):
    for drawn in (wandering(), scattered()):
        numbers = drawn.values["number"].copy()
        numbers[::5] = np.nan
        drawn = with_numbers(drawn, numbers)
        found, _, _ = shows(drawn, view, look(filter_by="n"))
        owners = np.unique(found.owner[found.kind == LINE])
        assert len(owners) > 10
        assert not np.isnan(numbers[owners]).any()
        if isinstance(drawn, HaloLines):
            assert not np.isnan(numbers[owners + 1]).any()
        taper, _, _ = shows(drawn, view, look(filter_by="n", low=0.2, filter_taper=2.0))
        assert taper.shown.sum() < found.shown.sum()


def test_thresholds_that_are_numbers_of_the_data_pass(shows, above):
    """In float32, as which both are compared."""
    x = np.linspace(-12, 12, 9)
    points = HaloPoints(np.stack([x, 0 * x, 0 * x], axis=1), {"n": np.arange(9) / 10})
    found, _, _ = shows(points, above, look(filter_by="n", low=0.3, high=0.7))
    assert set(np.unique(found.owner)) == {-1, 3, 4, 5, 6, 7}


@pytest.mark.parametrize("taper", [0.0, 2.0])
@pytest.mark.parametrize("label", [0.3, 7.0, 1 / 3, 123456.0])
@pytest.mark.parametrize("kind", ["lines", "points"])
def test_labels_can_be_filtered_by(gl, view, kind, label, taper):
    """What has exactly the number of both thresholds everywhere is there without a hole, and ends nowhere."""
    drawn = wandering() if kind == "lines" else scattered()
    drawn = with_numbers(drawn, np.full(drawn.n_points, label))
    all_of_it = draw_halos(gl, drawn, view, look())
    assert_same(all_of_it, draw_halos(gl, drawn, view, look(filter_by="n", low=label, high=label, filter_taper=taper)))


@pytest.mark.parametrize("label", [1, 2, 3])
def test_labels_of_parts_of_lines(shows, view, label):
    """Between one label and the next nothing has either."""
    drawn = wandering(m=12, step=2.5)
    numbers = np.tile(np.repeat([1, 2, 3], 4), drawn.n_lines)
    found, _, _ = shows(with_numbers(drawn, numbers), view, look(filter_by="n", low=label, high=label, **PLAIN))
    owners = np.unique(found.owner[found.kind == LINE])
    assert len(owners) > 10
    assert (numbers[owners] == label).all()
    assert (numbers[owners + 1] == label).all()


def test_infinite_numbers_are_beyond_all_thresholds_but_infinity(gl, shows, above):
    places = np.stack([np.linspace(-12, 12, 7), np.zeros(7), np.zeros(7)], axis=1)
    drawn = of_lines(places, n=[np.inf, np.inf, 1.0, 1.0, -np.inf, -np.inf, -np.inf])
    whole, _, _ = shows(drawn, above, look(filter_by="n", **PLAIN))
    assert_same(whole, draw_halos(gl, drawn, above, look(**PLAIN)))
    for low, high, owners in (
        (1.0, np.inf, {0, 1, 2}),
        (-np.inf, 1.0, {2, 3, 4, 5}),
        (0.0, 1.0, {2}),
        (2.0, 1e38, {1}),
    ):
        found, _, _ = shows(drawn, above, look(filter_by="n", low=low, high=high, **PLAIN))
        assert set(np.unique(found.owner[found.kind == LINE])) == owners


# -------------------------------------------------------------------------------------------------------------- cuts

PLANES = {
    "one": [[0.3, 1.0, 0.1, 1.0]],
    "three": [[1.0, 0, 0, 6.0], [-1.0, 0.2, 0, 7.0], [0, 0, -2.0, 9.0]],
    "touching none": [[0, 0, 1.0, 500.0]],
    "all": [[0, 0, 1.0, -500.0]],
}


@pytest.mark.parametrize("name", PLANES)
def test_planes(shows, view, name):
    view = View(SIZE, view.model_view_projection, PLANES[name])
    for drawn in (wandering(seed=3), scattered()):
        found, _, _ = shows(drawn, view, look())
        assert found.shown.any() == (name != "all")


# -------------------------------------------------------------------------------------------- what pixels stand for


def sticks(n=14, seed=4):
    """Lines of two vertices, which no bend distorts."""
    return wandering(n, 2, seed, step=12.0)


@pytest.mark.parametrize("values", ["number", "colour"])
def test_values_and_places(shows, view, values):
    drawn = sticks()
    found, wanted, both = shows(drawn, view, look(line_width=1.5, **PLAIN), values=values)
    line = both & (wanted.kind == LINE)
    owner, t = wanted.owner[line], wanted.t[line]
    assert len(owner) > 300
    assert (found.line[line] == np.searchsorted(drawn.offsets, owner, side="right") - 1).all()
    assert np.abs(found.place[line] - (owner - drawn.offsets[found.line[line]]) - t).max() < 5e-5
    tangents = drawn.points[owner + 1] - drawn.points[owner]
    tangents /= np.linalg.norm(tangents, axis=1)[:, None]
    assert np.abs(found.tangent[line] - tangents).max() < 1e-4
    a, b = drawn.values[values][owner], drawn.values[values][owner + 1]
    if values == "number":
        assert np.abs(found.value[line] - (a + t * (b - a))).max() < 5e-5
        assert found.colour is None
    else:
        assert np.abs(found.colour[line] - (a + t[:, None] * (b - a))).max() < 1.1 / 255


@pytest.mark.parametrize("values", ["number", "colour"])
def test_values_of_points(shows, view, values):
    drawn = scattered()
    found, wanted, both = shows(drawn, view, look(line_width=1.5), values=values)
    line = both & (wanted.kind == LINE)
    owner = wanted.owner[line]
    assert len(np.unique(owner)) > 40
    assert (found.place[line] == owner).all()
    if values == "number":
        assert np.abs(found.value[line] - drawn.values[values][owner]).max() < 1e-6
    else:
        assert np.abs(found.colour[line] - drawn.values[values][owner]).max() <= 0.6 / 255


def test_places_go_on_from_segment_to_segment(shows, view):
    drawn = wandering()
    found, wanted, both = shows(drawn, view, look(line_width=1.0, **PLAIN), values="number")
    line = both & (wanted.kind == LINE)
    place = found.place[line] + drawn.offsets[found.line[line]]
    assert np.abs(place - wanted.owner[line] - wanted.t[line]).max() < 5e-5
    assert np.abs(found.value[line] - np.interp(place, np.arange(drawn.n_points), drawn.values["number"])).max() < 1e-4


def test_values_that_are_no_number_stay_so(gl, view):
    drawn = wandering()
    numbers = drawn.values["number"].copy()
    numbers[10] = np.nan
    drawn = HaloLines(drawn.points, drawn.offsets, {"n": numbers})
    found = draw_halos(gl, drawn, view, look(), values="n")
    beside = (found.kind == LINE) & np.isin(found.owner, [9, 10])
    assert beside.any()
    assert np.isnan(found.value[beside]).all()
    assert np.isfinite(found.value[(found.kind == LINE) & ~beside]).all()


def test_lines_without_points_are_counted(gl, view):
    drawn = wandering()
    offsets = np.sort(np.concatenate([drawn.offsets, drawn.offsets[[0, 0, 3, 8]]]))
    found = draw_halos(gl, HaloLines(drawn.points, offsets), view, look())
    line = found.kind == LINE
    assert len(np.unique(found.line[line])) > 5
    assert (found.line[line] == np.searchsorted(offsets, found.owner[line], side="right") - 1).all()


# -------------------------------------------------------------------------------------------------------- appendix A

CROSSED = look(line_width=1.2, strip_width=6.0, max_displacement=5.0, smooth=False, **PLAIN)


def measured(gl, camera, kind, away, k):
    """Width in mm of the front line's halo, above and below it, on lines that cross so far behind it."""
    size = (40, 240)
    view = View(size, camera(size, **ABOVE[kind]))
    across = of_lines([[-30, 0, 0], [30, 0, 0]], [[0, -40, -away], [0, 40, -away]])
    found = draw_halos(gl, across, view, CROSSED)
    assert (found.owner[120, 18:22] == 0).all()
    column = found.kind[:, 20]
    black = np.flatnonzero(found.owner[:, 20] == 2)
    front = np.flatnonzero(found.owner[:, 20] == 0)
    below, above = black[black < front[0]], black[black > front[-1]]
    assert (column[below[-1] + 1 : front[0]] == HALO).all()
    assert (column[front[-1] + 1 : above[0]] == HALO).all()
    return (front[0] - below[-1] - 1) / k, (above[0] - front[-1] - 1) / k


@pytest.mark.parametrize("kind", ABOVE)
def test_halos_are_as_wide_as_equation_4_has_it(gl, camera, kind):
    # Pixels per mm at the front line, 60 mm away.
    k = 240 / 32 if kind == "parallel" else 120 / (60 * np.tan(np.radians(15)))
    for away in np.concatenate([np.linspace(0.05, 6.0, 24), [12.0, 40.0]]):
        below, above = measured(gl, camera, kind, away, k)
        wanted = equation_4(away, CROSSED)
        assert abs(below - wanted) * k <= 1.0
        assert abs(above - wanted) * k <= 1.0


@pytest.mark.parametrize("kind", ABOVE)
def test_lines_in_one_plane_have_no_halo_on_each_other(gl, camera, kind):
    """Beside each other and crossing: all of them are black all along."""
    view = View(SIZE, camera(SIZE, **ABOVE[kind]))
    lines = [[[-15, y, 0], [15, y, 0]] for y in (-6, -4.1, -1.7, 0.4)] + [[[x, -9, 0], [x + 6, 9, 0]] for x in (-9, 2)]
    found = draw_halos(gl, of_lines(*lines), view, CROSSED)
    alone = [draw_halos(gl, of_lines(line), view, CROSSED) for line in lines]
    line = np.any([picture.kind == LINE for picture in alone], axis=0)
    assert line.sum() > 900
    assert ((found.kind == LINE) == line).all()
    assert (found.shown == np.any([picture.shown for picture in alone], axis=0)).all()


SCALE = 90 / 32
"""Pixels per mm at z = 0 of the cameras of ABOVE, but for a part in a hundred."""


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

BENT_LOOKS = {
    "plain": PLAIN,
    "the paper's": {},
    "wide": {**PLAIN, "line_width": 2.5, "strip_width": 10.0},
    "cue": {**PLAIN, "width_cue": 0.8},
    "taper 3": {"n_tapered": 3, "t_tapered": 0.1},
    "filter": {"filter_by": "number", "low": 0.4, "filter_taper": 1.0},
}


# ----------------------------------------------------------------------------------------------------- slight and sharp


@pytest.mark.few(12)
@pytest.mark.parametrize("name", BENT_LOOKS)
@pytest.mark.parametrize("seed", range(2))
def test_lines_that_turn_at_random(shows, view, seed, name):
    _, _, both = shows(zigzag(seed=seed), view, look(**BENT_LOOKS[name]), least=0.3)
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
