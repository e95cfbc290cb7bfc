"""SplineTubes.simplify: dense samples of both curves, closed forms, and what has to stay."""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from scipy.spatial import cKDTree

import pvfiblets as pf
from pvfiblets.tubes import NodeValues, SplineTubes, as_spline_tubes
from pvfiblets.tubes.curves import controls
from pvfiblets.tubes.measures import tube_lengths

DENSE = 400  # samples of a merged segment


def sampled(tubes, count):
    """(n_segments, count, k) samples of the cubics: x, y, z, radius, values."""
    nodes = np.column_stack([tubes.points, tubes.radius, *(v.values for v in tubes.values.values())])
    slopes = np.column_stack([tubes.tangents, tubes.radius_slopes, *(v.slopes for v in tubes.values.values())])
    (a, b), (m, n) = nodes[tubes.segments.T], slopes[tubes.segments.T]
    chords = np.linalg.norm((b - a)[:, :3], axis=1) if tubes.scaled else np.ones(len(a))
    t = np.linspace(0.0, 1.0, count)
    basis = np.array([2 * t**3 - 3 * t**2 + 1, t**3 - 2 * t**2 + t, 3 * t**2 - 2 * t**3, t**3 - t**2])
    return np.einsum("bt,bsk->stk", basis, np.array([a, m * chords[:, None], b, n * chords[:, None]]))


def drawn(tubes, count):
    """(n_segments, 2 count, 4) samples of the two quadratics that are drawn for each cubic."""
    t = np.linspace(0.0, 1.0, count)
    basis = np.array([(1 - t) ** 2, 2 * t * (1 - t), t**2])
    return np.einsum("bt,shbk->shtk", basis, controls(tubes)).reshape(tubes.n_segments, 2 * count, 4)


def assert_near(samples, others, tolerance):
    """All samples have one of the others near; those are rows of curves."""
    apart = np.linalg.norm(np.diff(others[..., :3], axis=1), axis=2).max(initial=0.0)
    flat = others.reshape(-1, others.shape[-1])
    far, _ = cKDTree(flat[:, :3]).query(samples.reshape(-1, samples.shape[-1])[:, :3])
    assert far.max() <= np.hypot(tolerance, 0.5 * apart) * (1 + 1e-6)


def assert_in_order(samples, others, units):
    """The discrete Fréchet distance of two curves, in units of each column, is at most 1 and a little."""
    away = np.linalg.norm(samples[:, None, :3] - others[None, :, :3], axis=2)[..., None] / units[0]
    rest = np.abs(samples[:, None, 3:] - others[None, :, 3:]) / units[1:]
    steps = [np.concatenate([np.linalg.norm(np.diff(c[:, :3], axis=0), axis=1)[:, None] / units[0],
                             np.abs(np.diff(c[:, 3:], axis=0)) / units[1:]], axis=1).max() for c in (samples, others)]
    free = np.concatenate([away, rest], axis=2).max(axis=2) <= 1.0 + max(steps)
    places = np.arange(len(others))
    reached = np.logical_and.accumulate(free[0])
    for row in free[1:]:
        reached[1:] |= reached[:-1].copy()
        entered = np.maximum.accumulate(np.where(reached & row, places, -1))
        reached = row & (entered > np.maximum.accumulate(np.where(row, -1, places)))
    assert reached[-1]


def network(seed, scaled, size=1.0):
    """A tree and a ring whose branches have 1 to 40 segments, a sphere, segments of no length, and a bare node."""
    rng = np.random.default_rng(seed)
    points, segments, owner = [rng.normal(size=3) * 10], [], []
    junctions = [0]
    for tube in range(rng.integers(1, 7)):
        at, n = rng.choice(junctions), rng.integers(1, 41)
        walk = points[at] + np.cumsum(np.cumsum(rng.normal(size=(n, 3)) * 0.05, axis=0) + rng.normal(size=3), axis=0)
        rows = [at, *range(len(points), len(points) + n)]
        points += list(walk)
        if rng.random() < 0.2 and n > 3:
            points[rows[2]] = points[rows[1]]
        pairs = [(a, b) if rng.random() < 0.97 else (b, a) for a, b in pairwise(rows)]
        segments += pairs
        owner += [tube] * len(pairs)
        junctions += [int(rng.choice(rows)), rows[-1]]
    turn = np.linspace(0, 2 * np.pi, 31)[:-1]
    rows = len(points) + np.arange(30)
    points += list(np.stack([30 + 5 * np.cos(turn), 5 * np.sin(turn), np.sin(2 * turn)], axis=1))
    segments += list(zip(rows, np.roll(rows, -1), strict=True))
    points += [np.full(3, 50.0), np.full(3, 60.0)]
    segments.append((len(points) - 2, len(points) - 2))
    owner += [7] * 30 + [8]
    points, segments = np.array(points) * size, np.array(segments)
    n = len(points)
    tangents, chords = np.zeros((n, 3)), points[segments[:, 1]] - points[segments[:, 0]]
    lengths = np.linalg.norm(chords, axis=1)
    lengths[lengths == 0.0] = 1.0
    for end in segments.T:
        np.add.at(tangents, end, chords / (lengths[:, None] if scaled else 1.0) / 2)
    tangents[rng.random(n) < 0.03] = 0.0
    tangents[-2:] = 0.0
    values = rng.normal() + np.cumsum(rng.normal(size=n)) * 0.1
    shuffle = rng.permutation(len(segments)) if rng.random() < 0.3 else np.arange(len(segments))
    return SplineTubes(
        points, segments[shuffle], size * (1.0 + 0.1 * rng.random(n)), tangents,
        size * 0.02 * rng.normal(size=n), scaled, np.array(owner)[shuffle], 9,
        {"v": NodeValues(values, 0.02 * rng.normal(size=n)), "w": NodeValues(np.sin(np.arange(n) / 9), np.zeros(n))},
        {"name": np.arange(9)},
    )  # fmt: skip


@given(st.integers(0, 10**6), st.booleans(), st.sampled_from([1e-6, 1.0, 1e6]), st.sampled_from([0.3, 0.03, 0.003]))
@example(0, True, 1.0, 0.3)
@example(0, False, 1.0, 0.3)
def test_networks_stay_within_the_bound_and_keep_their_nodes(seed, scaled, size, tolerance):
    whole = network(seed, scaled, size)
    tolerance *= size
    small = whole.simplify(tolerance)
    assert small.n_segments <= whole.n_segments
    assert (small.n_tubes, small.scaled, list(small.values)) == (9, scaled, ["v", "w"])
    np.testing.assert_array_equal(small.tube_values["name"], np.arange(9))
    for tube in range(9):
        old, new = whole.subset([tube]), small.subset([tube])
        assert (old.n_segments > 0) == (new.n_segments > 0)
        if not old.n_segments:
            continue
        before, after = sampled(old, 40), sampled(new, DENSE)
        assert_near(before, after, tolerance)
        assert_near(after, sampled(old, 200), tolerance)
        stayed = {tuple(pair.ravel()) for pair in old.points[old.segments]}
        merged = np.array([tuple(pair.ravel()) not in stayed for pair in new.points[new.segments]])
        if merged.any():
            assert_near(drawn(new.with_segments(merged), DENSE), sampled(old, 200), tolerance)
    # All that is not within a tube's run: ends, bifurcations, turned segments, places where tubes meet.
    def corners(tubes):
        places = list(map(tuple, tubes.points.tolist()))
        counts = Counter((places[node], kind) for pair in tubes.segments.tolist() for kind, node in enumerate(pair))
        return {p: (counts[p, 0], counts[p, 1]) for p, _ in counts if (counts[p, 0], counts[p, 1]) != (1, 1)}

    twice = Counter(map(tuple, whole.points.tolist()))
    old = {place: count for place, count in corners(whole).items() if twice[place] == 1}
    new = corners(small)
    assert {place: new.get(place) for place in old} == old
    assert set(map(tuple, small.points.tolist())) <= set(twice)


@pytest.mark.few(4)
@pytest.mark.parametrize("scaled", [False, True])
@pytest.mark.parametrize("seed", range(6))
def test_radii_and_values_stay_within_the_bound_in_order_along_the_tube(seed, scaled):
    rng = np.random.default_rng(seed)
    t = np.sort(rng.uniform(0, 6, 90)) if seed % 2 else np.linspace(0, 6, 90)
    points = np.stack([10 * np.cos(t), 10 * np.sin(2 * t), t**2 / 4], axis=1)
    whole = as_spline_tubes(points, radius=1 + 0.3 * np.sin(3 * t), scalars=np.cos(5 * t), scaled=scaled)
    for tolerance, share in ((0.1, 10.0), (0.1, 0.01), (1.0, 0.05)):
        small = whole.simplify(tolerance, value_share=share)
        assert small.n_segments < (60 if scaled or seed % 2 == 0 else 89)
        units = np.array([tolerance, tolerance, share * np.ptp(whole.values["scalars"].values)])
        before, after = sampled(whole, 12).reshape(-1, 5), sampled(small, 60).reshape(-1, 5)
        assert_in_order(before, after, units)


def test_derivatives_by_parameter_grow_with_the_number_of_merged_segments():
    t = np.linspace(0, 2, 101)
    points = np.stack([10 * t, 3 * np.cos(t), 0 * t], axis=1)
    whole = as_spline_tubes(points, radius=1 + 0.1 * np.sin(t), scalars=np.sin(t), scaled=False)
    small = whole.simplify(0.01)
    assert small.n_segments < 20
    old = np.searchsorted(points[:, 0], small.points[small.segments, 0])
    count = np.diff(old, axis=1)
    expected, found = (
        np.column_stack([tubes.tangents, tubes.radius_slopes, tubes.values["scalars"].slopes])[rows]
        for tubes, rows in ((whole, old), (small, small.segments))
    )
    # Steps differ in length by 2 %.
    np.testing.assert_allclose(found, expected * count[..., None], rtol=0.03, atol=1e-9)


def test_a_circle_and_a_helix_take_few_segments():
    t = np.linspace(0, 2 * np.pi, 2001)
    places = np.stack([10 * np.cos(t), 10 * np.sin(t), 0 * t], axis=1)
    places[-1] = places[0]
    circle = as_spline_tubes(places, radius=0.5)
    small = circle.simplify(0.05)
    assert small.n_segments <= 10
    assert small.joined_ends.all()
    place = drawn(small, DENSE)[..., :3]
    np.testing.assert_allclose(np.linalg.norm(place, axis=2), 10.0, atol=0.05)
    assert tube_lengths(small) == pytest.approx(tube_lengths(circle), rel=2e-3)
    # The error of the halves falls with the third power of the step, that of the cubics with the fourth.
    counts = [circle.simplify(tolerance).n_segments for tolerance in (1e-1, 1e-2, 1e-3, 1e-4)]
    ratios = np.divide(counts[1:], counts[:-1])
    assert (ratios < 10 ** (1 / 3) * 1.25).all()

    t = np.linspace(0, 60, 5001)
    helix = as_spline_tubes(np.stack([10 * np.cos(t), 10 * np.sin(t), 2 * t], axis=1), radius=0.5, method="catmull-rom")
    small = helix.simplify(0.05)
    assert small.n_segments <= 100
    assert small.joined_ends[1:, 0].all()
    assert small.joined_ends[:-1, 1].all()
    x, y, z = drawn(small, DENSE)[..., :3].reshape(-1, 3).T
    assert np.hypot(x - 10 * np.cos(z / 2), y - 10 * np.sin(z / 2)).max() < 0.06


def test_a_straight_cone_becomes_one_segment():
    x = np.sort(np.random.default_rng(0).uniform(0, 100, 500))
    cone = as_spline_tubes(np.stack([x, 0 * x, 0 * x], axis=1), radius=1 + 0.01 * x, scalars=x)
    assert cone.simplify(1e-6, value_share=1e-6).n_segments == 1
    assert cone.simplify(1e-6).values["scalars"].values.tolist() == [x[0], x[-1]]


@pytest.mark.parametrize("scaled", [False, True])
def test_with_hardly_a_tolerance_all_stays(scaled):
    whole = network(3, scaled)
    small = whole.simplify(1e-13)
    for name in ("points", "radius", "tangents", "radius_slopes"):
        np.testing.assert_array_equal(getattr(small, name)[small.segments], getattr(whole, name)[whole.segments])
    np.testing.assert_array_equal(small.tubes, whole.tubes)
    np.testing.assert_array_equal(small.values["v"].slopes[small.segments], whole.values["v"].slopes[whole.segments])
    assert small.n_nodes == whole.n_nodes - 1  # the bare node


@pytest.mark.parametrize("scaled", [False, True])
def test_a_ring_stays_a_ring_and_whatever_meets_keeps_its_node(scaled):
    turn = np.linspace(0, 2 * np.pi, 65)[:-1]
    points = np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1)
    rows = np.arange(64)
    tangents = np.stack([-np.sin(turn), np.cos(turn), 0 * turn], axis=1) * (1.0 if scaled else 2 * np.pi / 64)
    ring = SplineTubes(points, np.stack([rows, np.roll(rows, -1)], axis=1), np.full(64, 0.1), tangents, np.zeros(64),
                       scaled, np.zeros(64, int), 1)
    for tolerance in (0.01, 0.3, 100.0):
        small = ring.simplify(tolerance)
        assert 2 <= small.n_segments < 12
        assert small.joined_ends.all()
        assert (small.segments[:, 1] != small.segments[:, 0]).all()
        assert small.segments[0, 0] == small.segments[-1, 1] or not scaled
    # Half of the ring is another tube: it ends where the other begins.
    halves = replace(ring, tubes=np.repeat([0, 1], 32), n_tubes=2).simplify(0.01)
    for tube in (0, 1):
        half = halves.subset([tube])
        np.testing.assert_array_equal(np.sort(half.points[:, 0])[[0, -1]], [-1.0, 1.0])
    # And a branch leaves it.
    branch = SplineTubes(
        np.vstack([points, [[2, 0, 0]]]), np.vstack([ring.segments, [[16, 64]]]), np.full(65, 0.1),
        np.vstack([tangents, tangents[:1]]), np.zeros(65), scaled, np.zeros(65, int), 1,
    ).simplify(0.01)  # fmt: skip
    assert points[16].tolist() in branch.points.tolist()
    uses = np.bincount(branch.segments.ravel())
    assert uses[branch.points.tolist().index(points[16].tolist())] == 3


def test_a_run_has_values_or_none():
    x = np.arange(41.0)
    values = np.where((x > 10) & (x < 30), np.nan, 0.0)
    line = as_spline_tubes(np.stack([x, 0 * x, 0 * x], axis=1), radius=1.0, scalars=values)
    small = line.simplify(0.1)
    np.testing.assert_array_equal(small.points[:, 0], [0, 10, 11, 29, 30, 40])
    np.testing.assert_array_equal(np.isnan(small.values["scalars"].values), [0, 0, 1, 1, 0, 0])
    colours = np.zeros((41, 3), np.uint8)
    colours[20:, 0] = 255
    line = as_spline_tubes(line.points, radius=1.0, scalars=colours)
    # The splines of colours swing around the step.
    assert {19.0, 20.0} <= set(line.simplify(0.1).points[:, 0])
    assert as_spline_tubes(line.points, radius=1.0, scalars=colours // 100).simplify(0.1).n_segments == 1


@pytest.mark.parametrize("seed", [4, 50, 71, 129, 407, 1367])
def test_radii_are_not_raised_by_merges_near_zero(seed):
    """`controls` raises control radii below 0: that may not take drawn radii out of the bound."""
    rng = np.random.default_rng(seed)
    x = np.linspace(0, 10, 101)
    high, phase, fall = rng.uniform(0, 2), rng.uniform(-1.5, 1.5), rng.uniform(0.2, 4)
    radius = high * np.cos(fall * x * 0.6 + phase) + rng.uniform(0, 0.5) if seed % 2 else high - fall * x
    radius = np.maximum(radius, 0.0)
    whole = as_spline_tubes(np.stack([x, 0 * x, 0 * x], axis=1), radius=radius)
    tolerance = rng.uniform(0.05, 0.5)
    small = whole.simplify(tolerance)
    assert small.n_segments < 20
    place = drawn(small, DENSE).reshape(-1, 4)
    assert np.abs(place[:, 3] - np.interp(place[:, 0], x, radius)).max() < 1.01 * tolerance


@pytest.mark.parametrize("scaled", [False, True])
def test_segments_of_no_length_may_be_loops(scaled):
    points = np.array([(0, 0, 0), (1, 0, 0), (2, 0, 0), (2, 0, 0), (3, 0, 0), (4, 0, 0)], float)
    tangents = np.tile([1.0, 0, 0], (6, 1))
    tangents[2:4] = [(1, 8, 0), (1, -8, 0)]
    pairs = np.stack([np.arange(5), np.arange(1, 6)], axis=1)
    whole = SplineTubes(points, pairs, np.ones(6), tangents, np.zeros(6), scaled, np.zeros(5, int), 1)
    small = whole.simplify(0.01)
    # By parameter, the segment from (2, 0, 0) to (2, 0, 0) is a loop of 2 mm; by length, there is none.
    assert_near(sampled(whole, 40), sampled(small, DENSE), 0.01)
    assert_near(sampled(small, 40), sampled(whole, DENSE), 0.01)
    assert_near(sampled(whole.simplify(5.0), 40), sampled(whole, DENSE), 5.0)
    assert whole.simplify(5.0).n_segments < 5


def test_extreme_numbers_merge_or_stay():
    x = np.linspace(0, 1, 11)
    for size in (1e-150, 1e-30, 1e30):
        line = as_spline_tubes(np.stack([size * x, 0 * x, 0 * x], axis=1), radius=0.1 * size)
        assert line.simplify(1e-3 * size).n_segments == 1
    line = as_spline_tubes(np.stack([1e30 * x, 0 * x, 0 * x], axis=1), radius=1.0)
    assert line.simplify(1e-300).n_segments == 10  # beyond float64
    still = as_spline_tubes([[1.0, 2.0, 3.0]] * 5, radius=0.5)
    assert still.simplify(0.1).bounds == still.bounds
    nothing = SplineTubes([], [], [], [], [], True, [], 2)
    assert (nothing.simplify(1.0).n_segments, nothing.simplify(1.0).n_tubes) == (0, 2)


@pytest.mark.parametrize("wrong", [0, -1.0, np.nan, np.inf, "0.1", None, True])
def test_what_is_no_tolerance_is_refused(wrong):
    whole = network(0, True)
    with pytest.raises(ValueError, match=re.escape(f"tolerance is {wrong!r}, expected a distance in mm above 0")):
        whole.simplify(wrong)
    with pytest.raises(ValueError, match=re.escape(f"value_share is {wrong!r}, expected a share")):
        whole.simplify(0.1, value_share=wrong)


@pytest.mark.few(1)
@pytest.mark.parametrize("file", ["nv_tract.FAT_R.vtk", "ukf_2T_fw_fiber.vtk", "dipy_tracks300.trk"])
def test_real_streamlines_stay_within_the_bound(shared_data, file):
    whole = as_spline_tubes(pf.read(shared_data / file), radius=0.2)
    for tolerance in (0.05, 0.5):
        small = whole.simplify(tolerance)
        assert small.n_segments < whole.n_segments
        assert_near(sampled(whole, 4), sampled(small, 200), tolerance)
        assert_near(sampled(small, 20), sampled(whole, 60), tolerance)
