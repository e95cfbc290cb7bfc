"""Spacings against brute force and against lattices, and the widths that follow from them."""

from __future__ import annotations

import numpy as np
import pytest

from pvfiblets.halos import HaloLines, HaloPoints, HaloStyle
from pvfiblets.halos.neighbours import Cloud, Frame, Paths, distances
from pvfiblets.halos.spacing import default_widths, line_spacing, point_spacing


def lines_of(*parts):
    return HaloLines(np.concatenate(parts), np.cumsum([0, *map(len, parts)]))


def walks(n, m, step, seed=0, box=100.0):
    """Random walks of `m` points from anywhere in a box."""
    rng = np.random.default_rng(seed)
    start = rng.random((n, 1, 3)) * box
    points = start + np.cumsum(rng.normal(size=(n, m, 3)) * step, axis=1)
    return HaloLines(points.reshape(-1, 3), np.arange(n + 1) * m)


def to_segments(places, start, stop):
    """Distances from places to segments, each to each."""
    chord = stop - start
    square = np.einsum("ij,ij->i", chord, chord)
    along = np.einsum("pij,ij->pi", places[:, None] - start, chord) / np.where(square > 0.0, square, 1.0)
    foot = start + np.clip(along, 0.0, 1.0)[..., None] * chord
    return np.linalg.norm(foot - places[:, None], axis=2)


def brute_force(lines, places, own):
    """Distances from places to the nearest other line, those through the place itself left out."""
    points = lines.points.astype(np.float64)
    line = np.repeat(np.arange(lines.n_lines), np.diff(lines.offsets))
    first = np.flatnonzero(line[1:] == line[:-1])
    found = []
    for some in np.array_split(np.arange(len(places)), max(len(places) * len(first) // 500_000, 1)):
        far = to_segments(places[some], points[first], points[first + 1])
        nearest = np.full((len(some), lines.n_lines), np.inf)
        np.minimum.at(nearest, (slice(None), line[first]), far)
        nearest[np.arange(len(some)), own[some]] = np.inf
        nearest[nearest < 1e-6] = np.inf
        found.append(nearest.min(axis=1))
    return np.concatenate(found)


def places_on(lines, n, seed=5):
    """Places in the frame of the lines, mm as well, and the lines that they are on."""
    paths = Paths(lines, Frame.around(lines.points))
    where = np.random.default_rng(seed).random(n) * paths.length
    own = paths.line_at(where)
    places = paths.at(own, where)
    return paths, places, own


@pytest.mark.parametrize(
    ("n", "m", "step"),
    [(200, 30, 0.5), (300, 20, 2.0), (40, 10, 40.0), (3, 200, 1.0), (400, 2, 30.0), (60, 100, 0.01)],
    ids=["bundles", "dense", "long", "three", "sticks", "knots"],
)
def test_distances_are_those_of_brute_force(n, m, step):
    lines = walks(n, m, step, seed=n)
    assert line_spacing(lines, seed=3) == line_spacing(lines, seed=3)
    assert line_spacing(lines, seed=4) == pytest.approx(line_spacing(lines, seed=3), rel=0.2)
    paths, places, own = places_on(lines, 150)
    frame = paths.frame
    wanted = brute_force(lines, places * frame.size + frame.origin, own)
    found = distances(paths, places, own) * frame.size
    known = np.isfinite(found)
    assert len(found) == len(places)
    share = found[known] / wanted[known]
    assert share.min() >= 1.0 - 1e-9
    assert share.max() <= 1.01
    assert known.sum() > len(found) / 2
    # What is not known is farther than all that is.
    assert wanted[~known].min(initial=np.inf) >= wanted[known].max()


@pytest.mark.parametrize("offset", [0.0, 1e6])
@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_a_sheet_of_long_segments_is_as_far_apart_as_it_is(scale, offset):
    y = np.arange(40) * 0.25
    ends = np.stack([np.stack([np.full(40, x), y, 0 * y], axis=1) for x in (0.0, 10.0)], axis=1)
    lines = HaloLines((ends.reshape(-1, 3) + offset) * scale, np.arange(41) * 2)
    assert line_spacing(lines) == pytest.approx(0.25 * scale, rel=1e-4)
    assert line_spacing(lines, samples=1) == pytest.approx(0.25 * scale, rel=1e-4)
    assert line_spacing(HaloLines(lines.points[:4], [0, 2, 4])) == pytest.approx(0.25 * scale, rel=1e-4)


def test_how_many_points_lines_have_does_not_matter():
    x = np.linspace(0, 10, 2001)
    many_and_few = [x[:: 1 + 999 * (i % 2)] for i in range(20)]
    parts = [np.stack([x, np.full(len(x), 0.5 * i), 0 * x], axis=1) for i, x in enumerate(many_and_few)]
    assert line_spacing(lines_of(*parts)) == pytest.approx(0.5, rel=1e-3)
    assert line_spacing(lines_of(*[part.astype(np.float32) for part in parts])) == pytest.approx(0.5, rel=1e-3)


def test_duplicates_and_crossings_are_passed_over():
    lines = walks(150, 20, 1.0)
    four = HaloLines(np.tile(lines.points, (4, 1)), np.arange(4 * 150 + 1) * 20)
    assert line_spacing(four) == pytest.approx(line_spacing(lines), rel=0.1)
    paths, places, own = places_on(lines, 100)
    whole = Paths(four, paths.frame)
    among_four, among_one = distances(whole, places, own), distances(paths, places, own)
    known = np.isfinite(among_four) & np.isfinite(among_one)
    np.testing.assert_allclose(among_four[known], among_one[known], rtol=0.01)
    assert known.sum() > 50
    # Only duplicates: as if it were one.
    two = lines_of(lines.points[:20], lines.points[:20])
    assert line_spacing(two) == line_spacing(HaloLines(lines.points[:20], [0, 20]))


def test_zero_length_segments_and_lines():
    flat = [[[0.0, y, 0], [0, y, 0], [9, y, 0], [9, y, 0]] for y in (0, 2, 4)]
    assert line_spacing(lines_of(*map(np.array, flat))) == pytest.approx(2.0, rel=1e-4)
    # A line without length is a point to others.
    with_point = lines_of(np.array([[0.0, 0, 0], [0, 0, 1e-3]]), np.array([[1.0, 0, 0], [1, 0, 0]]))
    assert line_spacing(with_point) == pytest.approx(1.0, rel=1e-3)
    # Lines of one point, or none, are not there.
    few = HaloLines(
        np.array([[5.0, 0, 0], [0, 0, 0], [9, 0, 0], [5, 0.1, 0], [0, 3, 0], [9, 3, 0]]), [0, 0, 1, 3, 4, 6, 6]
    )
    assert line_spacing(few) == pytest.approx(3.0, rel=1e-4)


def test_without_neighbours_the_extent_tells():
    one = HaloLines(np.array([[0.0, 0, 0], [30, 40, 0]]), [0, 2])
    assert line_spacing(one) == pytest.approx(50 / 60)
    assert line_spacing(HaloLines(one.points, [0, 1, 2])) == pytest.approx(50 / 60)
    assert line_spacing(HaloLines(np.repeat(one.points, 2, axis=0), [0, 2, 4])) == pytest.approx(50 / 60)
    assert point_spacing(HaloPoints(np.array([[7.0, 8, 9]]))) == 1.0
    assert point_spacing(HaloPoints(np.full((50, 3), 7.0))) == 1.0
    assert line_spacing(HaloLines(np.full((50, 3), 7.0), [0, 25, 50])) == 1.0
    assert line_spacing(HaloLines(np.zeros((0, 3)), [0])) == 1.0
    assert line_spacing(HaloLines(np.zeros((0, 3)), [0, 0, 0])) == 1.0
    assert point_spacing(HaloPoints(np.zeros((0, 3)))) == 1.0


@pytest.mark.parametrize("n", [2, 30, 3000])
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_points_against_brute_force(n, dtype):
    points = np.random.default_rng(n).random((n, 3)).astype(dtype)
    cloud = Cloud(points, Frame.around(points))
    some = np.arange(min(n, 500))
    far = np.linalg.norm(points[some, None].astype(np.float64) - points[None], axis=2)
    far[some, some] = np.inf
    found = distances(cloud, cloud.at(some), some) * cloud.frame.size
    known = np.isfinite(found)
    np.testing.assert_allclose(found[known], far.min(axis=1)[known], rtol=1e-6)
    assert point_spacing(HaloPoints(points)) == pytest.approx(np.median(found), rel=0.1)
    twice = np.concatenate([points, points, points])
    assert point_spacing(HaloPoints(twice), samples=4 * n) == pytest.approx(point_spacing(HaloPoints(points), 4 * n))
    grid = np.stack(np.meshgrid(*[np.arange(12) * 3.0] * 3), axis=-1).reshape(-1, 3)
    assert point_spacing(HaloPoints(grid * [1, 1, n % 2])) == pytest.approx(3.0)
    for measure, drawn in ((line_spacing, walks(3, 3, 1.0)), (point_spacing, HaloPoints(points))):
        with pytest.raises(ValueError, match="samples is 0"):
            measure(drawn, samples=0)


def test_one_far_away_does_not_change_what_is_near():
    points = np.random.default_rng(2).random((20_000, 3))
    alone = point_spacing(HaloPoints(points))
    assert point_spacing(HaloPoints(np.concatenate([points, [[3e4, 0, 0]]]))) == pytest.approx(alone, rel=0.1)
    lines = walks(2000, 10, 0.5)
    far = lines_of(lines.points, np.array([[3e6, 0, 0], [3e6, 1, 0]]))
    far = HaloLines(far.points, [*lines.offsets, lines.n_points + 2])
    assert line_spacing(far) == pytest.approx(line_spacing(lines), rel=0.25)


@pytest.mark.more
def test_what_is_too_dense_is_asked_at_fewer_places_or_not_at_all(monkeypatch):
    rng = np.random.default_rng(1)
    fan = np.stack([np.zeros((3000, 3)), rng.random((3000, 3))], axis=1).reshape(-1, 3)
    lines = HaloLines(fan, np.arange(3001) * 2)
    whole = line_spacing(lines)
    monkeypatch.setattr("pvfiblets.halos.neighbours._MOST_PAIRS", 1 << 14)
    monkeypatch.setattr("pvfiblets.halos.neighbours._MOST_ARCS", 1 << 16)
    assert line_spacing(lines) == pytest.approx(whole, rel=0.8)
    monkeypatch.setattr("pvfiblets.halos.neighbours._MOST_PAIRS", 1)
    monkeypatch.setattr("pvfiblets.halos.neighbours._MOST_ARCS", 1)
    assert line_spacing(lines) == pytest.approx(Frame.around(fan).diagonal / 60)


# ---------------------------------------------------------------------- widths


def sheet(spacing):
    """A square sheet, 100 mm wide, of lines so far apart."""
    y = np.arange(0, 100 + spacing / 2, spacing)
    ends = np.stack([np.stack([np.full(len(y), x), y, 0 * y], axis=1) for x in (0.0, 100.0)], axis=1)
    return HaloLines(ends.reshape(-1, 3), np.arange(len(y) + 1) * 2)


DIAGONAL = 100 * 2**0.5


def test_default_widths_of_lines_and_points():
    for spacing, line, strip in (
        (0.5, 0.2, 1.2), (0.35, 0.14, DIAGONAL / 150), (0.05, DIAGONAL / 1200, DIAGONAL / 150),
        (50.0, DIAGONAL / 200, 6 * DIAGONAL / 200),
    ):  # fmt: skip
        assert default_widths(sheet(spacing)) == pytest.approx((line, strip, 4 * strip), rel=1e-3)
    grid = np.stack(np.meshgrid(np.arange(100.0), np.arange(100.0), 0.0), axis=-1).reshape(-1, 3)
    diagonal = 99 * 2**0.5
    assert default_widths(HaloPoints(grid)) == pytest.approx((0.4, 4.0, 16.0))
    assert default_widths(HaloPoints(grid[:2])) == pytest.approx((1 / 200, 1 / 20, 1 / 5))
    assert default_widths(HaloPoints(grid), 0.1) == pytest.approx((0.1, diagonal / 80, diagonal / 20))
    assert default_widths(HaloPoints(grid), 0.01) == pytest.approx((0.01, 0.27, 1.08))


@pytest.mark.parametrize("given", [(0.1, None, None), (None, 0.3, None), (None, None, 5.0), (0.1, 0.3, 5.0)])
def test_what_is_given_stays_and_all_make_a_look(given):
    for drawn in (sheet(0.5), HaloPoints(np.eye(3)), HaloLines(np.zeros((0, 3)), [0]), HaloPoints(np.zeros((4, 3)))):
        found = default_widths(drawn, *given)
        assert [f for f, g in zip(found, given, strict=True) if g is not None] == [g for g in given if g is not None]
        assert found[0] <= found[1]
        HaloStyle(*found)


@pytest.mark.parametrize("size", [1e-12, 1e12, 1e300])
def test_widths_scale_with_the_data(size):
    lines = walks(20, 10, 1.0)
    found = default_widths(HaloLines(lines.points * size, lines.offsets))
    np.testing.assert_allclose(np.array(found) / size, default_widths(lines), rtol=1e-3)
