"""Lines and points with halos against the float64 reference: every look, both projections, filters and cuts."""

import numpy as np
import pytest

from pvfiblets.engine import View
from pvfiblets.halos import HaloLines, HaloPoints
from pvfiblets.halos.reference import HALO, LINE, NOTHING

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
    of_lines,
    scattered,
    wandering,
    with_numbers,
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
