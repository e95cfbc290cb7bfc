"""SplineTubes: what they accept, and what they say of their shape."""

from __future__ import annotations

import re

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pvfiblets import SplineTubes
from pvfiblets.tubes.spline_tubes import NodeValues, chord_lengths


def tubes(points, segments, *, radius=1.0, tangents=0.0, slopes=0.0, scaled=True, owner=None, **rest):
    points = np.asarray(points, float).reshape(-1, 3)
    n, segments = len(points), np.asarray(segments, int).reshape(-1, 2)
    owner = np.zeros(len(segments), int) if owner is None else owner
    rest.setdefault("n_tubes", int(max(owner, default=-1)) + 1)
    return SplineTubes(
        points,
        segments,
        np.broadcast_to(radius, n),
        np.broadcast_to(tangents, (n, 3)),
        np.broadcast_to(slopes, n),
        scaled,
        owner,
        **rest,
    )


def hermite(tube, segment, t):
    """Position and radius of the cubic itself, in the basis of the textbook."""
    i, j = tube.segments[segment]
    scale = np.linalg.norm(tube.points[j] - tube.points[i]) if tube.scaled else 1.0
    basis = (2 * t**3 - 3 * t**2 + 1, t**3 - 2 * t**2 + t, -2 * t**3 + 3 * t**2, t**3 - t**2)
    return [
        np.multiply.outer(basis[0], n[i])
        + np.multiply.outer(basis[1], scale * m[i])
        + np.multiply.outer(basis[2], n[j])
        + np.multiply.outer(basis[3], scale * m[j])
        for n, m in ((tube.points, tube.tangents), (tube.radius, tube.radius_slopes))
    ]


@given(st.integers(0, 10**6), st.booleans())
def test_bounds_hold_every_sphere_and_are_not_much_larger(seed, scaled):
    rng = np.random.default_rng(seed)
    tube = tubes(
        rng.normal(size=(5, 3)),
        [[0, 1], [1, 2], [3, 1], [4, 4]],
        radius=rng.uniform(0, 1, 5),
        tangents=rng.normal(size=(5, 3)),
        slopes=rng.normal(size=5),
        scaled=scaled,
    )
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for segment in range(4):
        place, radius = hermite(tube, segment, np.linspace(0, 1, 101))
        radius = np.maximum(radius, 0.0)[:, None]
        low, high = np.minimum(low, (place - radius).min(0)), np.maximum(high, (place + radius).max(0))
    bounds = np.array(tube.bounds).reshape(3, 2)
    assert np.all(bounds[:, 0] <= low + 1e-12)
    assert np.all(bounds[:, 1] >= high - 1e-12)
    # What a curve's control points reach beyond the curve is a part of its derivatives.
    spare = np.abs(tube.tangents).max() + np.abs(tube.radius_slopes).max()
    spare *= max(tube.lengths().max(), 1.0)
    assert np.all(bounds[:, 0] >= low - spare)
    assert np.all(bounds[:, 1] <= high + spare)


def test_bounds_of_a_straight_tube_are_its_own():
    tube = tubes([[0, 0, 0], [10, 0, 0]], [[0, 1]], radius=[1, 2], tangents=[1, 0, 0], slopes=0.1)
    # The sphere at the end is the widest one and the furthest out; the other end's is at -1.
    assert tube.bounds == pytest.approx((-1, 12, -2, 2, -2, 2))
    assert all(np.isnan(tubes([], []).bounds))
    # Nodes that no segment uses are nowhere.
    assert tubes([[0, 0, 0], [9, 9, 9]], [[0, 0]]).bounds == (-1, 1, -1, 1, -1, 1)


@given(st.integers(0, 10**6))
def test_joined_ends_agree_with_looking_one_by_one(seed):
    rng = np.random.default_rng(seed)
    segments = rng.integers(0, 12, (7, 2))
    found = tubes(rng.normal(size=(12, 3)), segments).joined_ends
    assert found.dtype == bool
    pairs = [tuple(pair) for pair in segments.tolist() if pair[0] != pair[1]]
    for (i, j), joined in zip(segments.tolist(), found.tolist(), strict=True):
        before = i != j and any(end == i for _, end in pairs)
        after = i != j and any(start == j for start, _ in pairs)
        assert joined == [before, after]


def test_lengths_are_right_for_all_sizes():
    for size in (1e-310, 1e-200, 1e-30, 1.0, 1e30, 1e200):
        with np.errstate(under="ignore"):
            found = chord_lengths(np.array([[3.0, 0.0, 4.0], [0.0, 0.0, 0.0]]) * size)
        np.testing.assert_allclose(found, [5.0 * size, 0.0], rtol=1e-12)
    assert tubes([[0, 0, 0], [1e-200, 0, 0]], [[0, 1]]).lengths() == [1e-200]


def test_a_subset_keeps_its_shapes_and_values():
    rng = np.random.default_rng(0)
    points = rng.normal(size=(9, 3))
    whole = tubes(
        points,
        [[0, 1], [3, 4], [1, 2], [4, 5], [6, 7], [7, 8]],
        owner=[0, 1, 0, 1, 3, 3],
        n_tubes=4,
        tangents=rng.normal(size=(9, 3)),
        values={"a": NodeValues(np.arange(9.0), np.arange(9.0) + 0.5)},
        tube_values={"b": np.array([10, 11, 12, 13])},
    )
    part = whole.subset([3, 2, 1])
    assert (part.n_tubes, part.n_segments, part.n_nodes, part.n_streamlines) == (3, 4, 6, 3)
    # points, tangents: 3 numbers a node; radius, slopes, and values twice: one; two indices and a tube a segment
    assert part.nbytes == 8 * (6 * (3 + 3 + 4) + 4 * 3) + part.tube_values["b"].nbytes
    assert not NodeValues([0, np.nan], [0, 0]).is_colour  # values may be missing, but not their slopes
    assert NodeValues(np.zeros((1, 4)), np.zeros((1, 4))).is_colour
    assert part.tube_values["b"].tolist() == [13, 12, 11]
    np.testing.assert_array_equal(part.tubes, [0, 0, 2, 2])
    np.testing.assert_array_equal(part.points[part.segments], points[[[6, 7], [7, 8], [3, 4], [4, 5]]])
    np.testing.assert_array_equal(part.values["a"].values[part.segments], [[6, 7], [7, 8], [3, 4], [4, 5]])
    np.testing.assert_array_equal(part.values["a"].slopes, part.values["a"].values + 0.5)
    assert whole.subset(np.array([False, False, True, False])).n_segments == 0
    for wrong in ([4], [-1], [1, 1], np.ones(3, bool)):
        with pytest.raises(IndexError):
            whole.subset(wrong)


TWO = ([[0, 0, 0], [1, 0, 0]], [[0, 1]])


@pytest.mark.parametrize(
    ("how", "message"),
    [
        (lambda: tubes([[0, 0, 0], [1, np.nan, 0]], [[0, 1]]), "point 1 is [1.0, nan, 0.0]"),
        (lambda: tubes(*TWO, radius=[1, -2]), "radius 1 is -2 mm, expected 0 or more"),
        (lambda: tubes(*TWO, radius=[np.inf, 1]), "radius 0 is inf"),
        (lambda: tubes(*TWO, tangents=np.nan), "tangent 0 is"),
        (lambda: tubes(*TWO, slopes=np.inf), "radius slope 0 is inf"),
        (lambda: tubes(TWO[0], [[0, 2]]), "segment 0 is [0, 2], but there are 2 points"),
        (lambda: tubes(TWO[0], [[0, 1], [-1, 1]]), "segment 1 is [-1, 1]"),
        (lambda: tubes(*TWO, owner=[3], n_tubes=2), "the tube of segment 0 is 3, but there are 2 tubes"),
        (lambda: tubes(*TWO, tube_values={"a": [1, 2]}), "tube_values['a']"),
        (lambda: tubes(*TWO, values={"a": NodeValues(np.zeros(3), np.zeros(3))}), "values['a'] have 3 rows"),
        (lambda: SplineTubes(*TWO, [1], np.zeros((2, 3)), [0, 0], True, [0], 1), "radius have the shape (1,)"),
        (lambda: SplineTubes(TWO[0], [[0.0, 1]], [1, 1], np.zeros((2, 3)), [0, 0], True, [0], 1), "expected integers"),
        (lambda: NodeValues(np.zeros((2, 3)), np.zeros((2, 3))), "(n_nodes, 4) RGBA"),
        (lambda: NodeValues(np.zeros(2), np.zeros(3)), "slopes have the shape (3,)"),
        (lambda: NodeValues(np.zeros(2), [0, np.nan]), "slope 1 is nan"),
        (lambda: NodeValues([[0, 0, 0, 255.0]], np.zeros((1, 4))), "colour 0 is"),
    ],
)
def test_what_contradicts_itself_is_refused(how, message):
    with pytest.raises(ValueError, match=re.escape(message)):
        how()
