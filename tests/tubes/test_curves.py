"""The quadratic halves, the cubics they stand for, and the boxes around them."""

from __future__ import annotations

import numpy as np
import pytest

from pvfiblets.tubes.curves import (
    MIDDLE,
    boxes,
    controls,
    cubic,
    derivative,
    deviation,
    deviations,
    evaluate,
    sample_spheres,
)
from pvfiblets.tubes.spline_tubes import SplineTubes


def some_tubes(n=40, scaled=False, seed=0, radius=5.0):
    """Nodes at random, each joined with the next; radii stay far from 0."""
    rng = np.random.default_rng(seed)
    segments = np.column_stack([np.arange(n - 1), np.arange(1, n)])
    return SplineTubes(
        points=rng.normal(size=(n, 3)) * 3.0,
        segments=segments,
        radius=radius + rng.random(n),
        tangents=rng.normal(size=(n, 3)) * 2.0,
        radius_slopes=rng.normal(size=n) * 0.5,
        scaled=scaled,
        tubes=np.zeros(n - 1, int),
        n_tubes=1,
    )


def ends(tubes):
    """Values and derivatives by the segment's parameter at both ends, the long way."""
    values, slopes = [], []
    for i, j in tubes.segments:
        chord = np.sqrt(((tubes.points[j] - tubes.points[i]) ** 2).sum()) if tubes.scaled else 1.0
        values.append([[*tubes.points[k], tubes.radius[k]] for k in (i, j)])
        slopes.append([[*(tubes.tangents[k] * chord), tubes.radius_slopes[k] * chord] for k in (i, j)])
    return np.array(values), np.array(slopes)


@pytest.mark.parametrize("scaled", [False, True])
def test_the_cubic_is_the_one_polynomial_with_those_ends(scaled):
    tubes = some_tubes(scaled=scaled)
    values, slopes = ends(tubes)
    # The four conditions as a linear system for the coefficients of 1, t, t^2, t^3.
    system = np.array([[1, 0, 0, 0], [1, 1, 1, 1], [0, 1, 0, 0], [0, 1, 2, 3]], float)
    for segment in range(tubes.n_segments):
        coefficients = np.linalg.solve(system, np.vstack([values[segment], slopes[segment]]))
        for t in (0.0, 0.2, 0.5, 0.9, 1.0):
            expected = t ** np.arange(4) @ coefficients
            np.testing.assert_allclose(cubic(tubes, segment, t), expected, atol=1e-12)


@pytest.mark.parametrize("scaled", [False, True])
@pytest.mark.parametrize("middle", [0.1, MIDDLE, 1 / 3])
def test_halves_join_smoothly_and_keep_the_end_directions(scaled, middle):
    tubes = some_tubes(scaled=scaled)
    halves = controls(tubes, middle=middle)
    values, slopes = ends(tubes)
    assert halves.shape == (39, 2, 3, 4)
    np.testing.assert_allclose(evaluate(halves[:, 0], 0.0), values[:, 0])
    np.testing.assert_allclose(evaluate(halves[:, 1], 1.0), values[:, 1])
    np.testing.assert_allclose(evaluate(halves[:, 0], 1.0), evaluate(halves[:, 1], 0.0), rtol=1e-14)
    np.testing.assert_allclose(derivative(halves[:, 0], 1.0), derivative(halves[:, 1], 0.0), atol=1e-12)
    # By the segment's parameter a half is run through twice as fast: 2 * 2 c m.
    np.testing.assert_allclose(2.0 * derivative(halves[:, 0], 0.0), 4.0 * middle * slopes[:, 0], atol=1e-12)
    np.testing.assert_allclose(2.0 * derivative(halves[:, 1], 1.0), 4.0 * middle * slopes[:, 1], atol=1e-12)


def test_where_halves_meet_is_the_middle_of_the_cubic_with_a_quarter_and_beside_it_with_a_third():
    tubes = some_tubes()
    _, slopes = ends(tubes)
    true = cubic(tubes, np.arange(39), 0.5)
    np.testing.assert_allclose(controls(tubes)[:, 0, 2], true, atol=1e-12)
    beside = controls(tubes, middle=1 / 3)[:, 0, 2] - true
    np.testing.assert_allclose(beside, (slopes[:, 0] - slopes[:, 1]) / 24.0, atol=1e-12)


@pytest.mark.parametrize("scaled", [False, True])
def test_deviation_is_a_fifty_fourth_of_the_third_difference(scaled):
    tubes = some_tubes(scaled=scaled)
    values, slopes = ends(tubes)
    k = 2.0 * (values[:, 0] - values[:, 1]) + slopes.sum(axis=1)
    found = deviations(tubes, samples=600)  # 600 steps fall on a third of each half
    np.testing.assert_allclose(found[:, 0], np.linalg.norm(k[:, :3], axis=1) / 54.0, rtol=1e-9)
    np.testing.assert_allclose(found[:, 1], np.abs(k[:, 3]) / 54.0, rtol=1e-9, atol=1e-12)
    assert deviation(tubes, samples=600) == pytest.approx(found.sum(axis=1).max())
    assert deviation(tubes, middle=1 / 3) > deviation(tubes)


def test_deviation_of_what_quadratics_hold_exactly_is_0():
    tubes = SplineTubes([[0, 0, 0], [1, 1, 0]], [[0, 1]], [1, 2], [[1, 0, 0], [1, 2, 0]], [1, 1], False, [0], 1)
    assert deviation(tubes) < 1e-15
    assert deviation(SplineTubes([], [], [], [], [], False, [], 0)) == 0.0


def test_radii_never_fall_below_0():
    tubes = SplineTubes([[0, 0, 0], [1, 0, 0]], [[0, 1]], [0.1, 0.1], [[1, 0, 0]] * 2, [-4.0, 3.0], False, [0], 1)
    halves = controls(tubes)
    assert halves[..., 3].min() == 0.0
    assert halves[0, 0, 2, 3] == 0.5 * (halves[0, 0, 1, 3] + halves[0, 1, 1, 3])
    assert sample_spheres(halves)[..., 3].min() >= 0.0
    assert np.isfinite(deviation(tubes))


@pytest.mark.parametrize("size", [5e-324, 1e-310, 1e-30, 1e30, 1e150])
def test_lengths_near_the_ends_of_the_numbers(size):
    tubes = SplineTubes(
        [[0, 0, 0], [size, 0, 0]], [[0, 1]], [size, size], [[1, 0, 0], [0.0, 1, 0]], [0, 0], True, [0], 1
    )
    halves = controls(tubes)
    assert np.isfinite(halves).all()
    box = boxes(halves[0])
    for values in (box.centre, box.axes, box.half, box.corners):
        assert np.isfinite(values).all()
    gram = box.axes @ np.swapaxes(box.axes, 1, 2)
    np.testing.assert_allclose(gram, np.broadcast_to(np.eye(3), (2, 3, 3)), atol=1e-14)


def test_boxes_hold_their_tubes_and_all_sides_touch():
    rng = np.random.default_rng(3)
    halves = rng.normal(size=(200, 3, 4))
    halves[:, :, 3] = np.abs(halves[:, :, 3])
    box = boxes(halves)
    spheres = sample_spheres(halves, 2001)
    local = (spheres[..., :3] - box.centre[:, None]) @ np.swapaxes(box.axes, 1, 2)
    high = (local + spheres[..., 3:]).max(axis=1)
    low = (local - spheres[..., 3:]).min(axis=1)
    assert (high <= box.half + 1e-12).all()
    assert (low >= -box.half - 1e-12).all()
    np.testing.assert_allclose(high, box.half, atol=2e-5)
    np.testing.assert_allclose(low, -box.half, atol=2e-5)
    assert box.inside(spheres[..., :3], 1e-12).all()
    assert not box.inside(box.corners * 1.001 - 0.001 * box.centre[:, None], -1e-9).any()
    assert np.linalg.det(box.axes) == pytest.approx(np.ones(200))
    sides = box.corners.max(axis=1) - box.corners.min(axis=1)
    assert (sides.prod(axis=1) >= box.volume - 1e-9).all()


@pytest.mark.parametrize(
    ("points", "half"),
    [
        ([[0, 0, 0], [0, 0, 0], [0, 0, 0]], [1, 1, 1]),  # a sphere
        ([[0, 0, 0], [2, 0, 0], [4, 0, 0]], [3, 1, 1]),  # a capsule
        ([[0, 0, 0], [2, 0, 0], [0, 0, 0]], [1.5, 1, 1]),  # there and back
        ([[0, 0, 0], [0, 0, 0], [0, -4, 0]], [3, 1, 1]),  # a tangent of 0
        ([[1e6, 1e6, 0], [1e6, 1e6 + 2, 0], [1e6, 1e6 + 4, 0]], [3, 1, 1]),  # far away
        ([[0, 0, 0], [1, 1e-200, 0], [2, 0, 0]], [2, 1, 1]),  # hardly bent
        ([[0, 0, 0], [1, 1e-13, 0], [2, 0, 0]], [2, 1, 1]),
    ],
)
def test_boxes_of_degenerate_curves(points, half):
    halves = np.concatenate([np.array(points, float), np.ones((3, 1))], axis=1)[None]
    box = boxes(halves)
    np.testing.assert_allclose(box.half[0], half, rtol=1e-12)
    np.testing.assert_allclose(box.axes[0] @ box.axes[0].T, np.eye(3), atol=1e-14)
    spheres = sample_spheres(halves)[0]
    assert box.inside(spheres[None, :, :3]).all()


def test_bad_input_is_named():
    tubes = some_tubes()
    with pytest.raises(ValueError, match="middle is 2, expected a number of 0 to 1"):
        controls(tubes, middle=2)
    with pytest.raises(IndexError, match="no segment 39, expected indices of 0 to 38"):
        controls(tubes, [0, 39])
    with pytest.raises(IndexError, match="type float64, expected indices"):
        cubic(tubes, [0.5], 0.0)
    with pytest.raises(ValueError, match=r"shape \(2, 4\), expected \(\.\.\., 3, d\)"):
        evaluate(np.zeros((2, 4)), 0.5)
    with pytest.raises(ValueError, match="count is 1, expected at least 2"):
        sample_spheres(np.zeros((3, 4)), 1)
    with pytest.raises(ValueError, match="samples is 1, expected at least 2"):
        deviations(tubes, samples=1)
