"""Derivatives of ragged lines, against formulas worked out node by node and dense linear algebra."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pvfiblets.support.ragged import offsets_from_counts
from pvfiblets.tubes.tangents import METHODS, Steps, derivatives


def ragged(rng, counts):
    offsets = offsets_from_counts(counts)
    return rng.normal(size=(int(offsets[-1]), 3)), offsets


def one(points, method="finite", values=None):
    points = np.asarray(points, float)
    steps = Steps.between(points, np.array([0, len(points)]))
    return derivatives(points if values is None else values, steps, method)


def parabola_slope(x, y, at):
    """Slope at x[at] of the parabola through three points."""
    return np.polyval(np.polyder(np.polyfit(x - x[at], y, 2)), 0.0)


def natural_by_moments(h, y):
    """Derivatives of the natural spline from its second derivatives, the other way round than the module goes."""
    n = len(h)
    matrix, known = np.eye(n + 1), np.zeros(n + 1)
    for i in range(1, n):
        matrix[i, i - 1 : i + 2] = h[i - 1] / 6, (h[i - 1] + h[i]) / 3, h[i] / 6
        known[i] = (y[i + 1] - y[i]) / h[i] - (y[i] - y[i - 1]) / h[i - 1]
    m = np.linalg.solve(matrix, known)
    start = (y[1:] - y[:-1]) / h - h * (2 * m[:-1] + m[1:]) / 6
    return np.append(start, (y[-1] - y[-2]) / h[-1] + h[-1] * (m[-2] + 2 * m[-1]) / 6)


@given(st.integers(0, 10**6), st.lists(st.integers(0, 9), max_size=7))
def test_each_line_by_itself(seed, counts):
    points, offsets = ragged(np.random.default_rng(seed), counts)
    value = points[:, 0] ** 2 + points[:, 1]
    steps = Steps.between(points, offsets)
    columns = np.column_stack([points, value])
    found = {k: np.column_stack([derivatives(points, steps, k), derivatives(value, steps, k)]) for k in METHODS}
    for first, last in itertools.pairwise(offsets):
        n = int(last - first)
        h = np.linalg.norm(np.diff(points[first:last], axis=0), axis=1)
        x = np.append(0.0, np.cumsum(h))
        for k, column in enumerate(columns[first:last].T):
            mine = {name: found[name][first:last, k] for name in METHODS}
            if n == 1:
                assert all(d == 0.0 for d in mine.values())
            if n < 2:
                continue
            for i in range(n):
                a, b = max(i - 1, 0), min(i + 1, n - 1)
                full = (column[b] - column[a]) * (0.5 if b - a == 2 else 1.0)
                assert mine["catmull-rom"][i] == pytest.approx(full, abs=1e-12)
                if b - a == 1:
                    assert mine["finite"][i] == pytest.approx((column[b] - column[a]) / h[a], abs=1e-12)
                elif k < 3 or 1 / 3 < h[a] / h[i] < 3:
                    slope = parabola_slope(x[a : b + 1], column[a : b + 1], 1)
                    assert mine["finite"][i] == pytest.approx(slope, abs=1e-7)
            np.testing.assert_allclose(mine["natural"], natural_by_moments(h, column), rtol=1e-8, atol=1e-9)


@pytest.mark.parametrize("count", [3, 4, 7, 50])
def test_closed_lines_are_smooth_where_they_meet(count):
    angle = 2 * np.pi * np.arange(count + 1) / count
    ring = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    ring[-1] = ring[0]
    round_ = np.stack([-np.sin(angle), np.cos(angle), 0 * angle], axis=1)
    for name in METHODS:
        found = one(ring, name)
        np.testing.assert_array_equal(found[0], found[-1])
        # By symmetry all tangents run along the circle and are equally long.
        length = found[0] @ round_[0]
        assert length > 0
        np.testing.assert_allclose(found, length * round_, atol=1e-12)
    rng = np.random.default_rng(count)
    wild = rng.normal(size=(count + 1, 3))
    wild[-1] = wild[0]
    # Round three times gives a middle round that knows nothing of ends: each row's reach halves twice over and more.
    found, rounds = one(wild, "natural"), np.concatenate([*[wild[:-1]] * 40, wild[:1]])
    steps = Steps.between(rounds[:-1], np.array([0, len(rounds) - 1]))
    middle = derivatives(rounds[:-1], steps, "natural")[20 * count : 21 * count]
    np.testing.assert_allclose(found[:-1], middle, atol=1e-12)


@pytest.mark.parametrize("name", METHODS)
def test_a_node_twice_in_a_row_is_a_sharp_corner(name):
    rng = np.random.default_rng(1)
    left, right = rng.normal(size=(6, 3)), rng.normal(size=(5, 3))
    right[0] = left[-1]
    both = one(np.concatenate([left, right]), name)
    np.testing.assert_allclose(both[:6], one(left, name), atol=1e-13)
    np.testing.assert_allclose(both[6:], one(right, name), atol=1e-13)
    three = np.concatenate([left, left[-1:], right])  # three times: the middle one has no neighbours
    assert not one(three, name)[6].any()
    assert not one(np.ones((4, 3)), name).any()


@pytest.mark.parametrize("name", METHODS)
def test_missing_values_break_their_own_line_only(name):
    points = np.cumsum(np.ones((7, 3)), axis=0)
    values = np.array([0.0, 1, 2, np.nan, 10, 12, np.inf])
    expected = np.array([1, 1, 1, 0, 2, 2, 0]) / (1.0 if name == "catmull-rom" else np.sqrt(3))
    np.testing.assert_allclose(one(points, name, values), expected, atol=1e-14)


@pytest.mark.parametrize("name", METHODS)
@pytest.mark.parametrize("size", [5e-324, 1e-310, 1e-30, 1e-6, 1e6, 1e30, 1e150])
def test_any_size_stays_finite(name, size):
    rng = np.random.default_rng(5)
    shape = np.round(rng.normal(size=(20, 3)), 1) * 10
    with np.errstate(under="ignore"):
        points = shape * size
    for values in (points, np.arange(20.0), rng.normal(size=(20, 4))):
        found = one(points, name, values)
        assert np.isfinite(found).all()
    scale = size if name == "catmull-rom" else 1.0
    if size > 1e-300:
        np.testing.assert_allclose(one(points, name), scale * one(shape, name), rtol=1e-9, atol=1e-9 * scale)


@given(st.integers(0, 10**6))
def test_steps_of_very_unlike_lengths_stay_in_reach(seed):
    rng = np.random.default_rng(seed)
    h = 10.0 ** rng.uniform(-12, 3, 15)
    points = np.zeros((16, 3))
    points[1:, 0] = np.cumsum(h)
    h = np.diff(points[:, 0])
    radius = rng.uniform(0.5, 1.5, 16)
    tangents, slopes = one(points), one(points, "finite", radius)
    np.testing.assert_allclose(tangents[:, 0], 1.0, atol=1e-9)
    # What a slope leads to along either of its steps is a few times what the radius changes at all.
    longest = np.maximum(np.append(h, 0), np.append(0, h))
    assert np.all(np.abs(slopes) * longest <= 3.0 * (radius.max() - radius.min()) * (1 + 1e-12))
    assert np.isfinite(one(points, "natural", radius)).all()


def test_a_long_spline_is_solved_to_the_last_digits():
    rng = np.random.default_rng(2)
    points = np.zeros((800, 3))
    points[:, 0] = np.cumsum(10.0 ** rng.uniform(-3, 3, 800))
    value = rng.normal(size=800)
    h = np.diff(points[:, 0])
    d = one(points, "natural", value)
    # The second derivatives of neighbouring cubics agree at the node between them.
    s = np.diff(value) / h
    ends, starts = (2 * d[:-1] + 4 * d[1:] - 6 * s) / h, (6 * s - 4 * d[:-1] - 2 * d[1:]) / h
    slopes = np.abs(d[1:-1]) + np.abs(s[1:]) + np.abs(s[:-1])
    size = np.abs(ends[:-1]) + np.abs(starts[1:]) + slopes * (1 / h[1:] + 1 / h[:-1])
    assert np.all(np.abs(ends[:-1] - starts[1:]) <= 1e-13 * size)


def test_no_such_method():
    with pytest.raises(ValueError, match="method is 'cubic', expected one of 'finite'"):
        one(np.zeros((2, 3)), "cubic")
    assert one(np.zeros((0, 3))).shape == (0, 3)
    assert one([[0, 0, 0], [1, 0, 0], [0, 0, 0]])[:, 0].tolist() == [1, 0, -1]  # there and back is not closed
