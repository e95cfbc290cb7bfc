"""Directions within the angle that is promised: on extreme, made-up and real lines, and by the bound's own proof."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import pvfiblets as pf
from pvfiblets.report.studies.codec.errors import direction_angles
from pvfiblets.streamlines import Streamlines

from .samples import extremes, noisy, smooth, wandering
from .turn_reference import cut, may_turn

FILES = [
    "dipy_EuDX_small_25.trk", "dipy_hist_tractogram.trk", "dipy_tracks300.trk", "gen_fibercup_det_0.25mm.tck",
    "nib_complex_big_endian.trk", "nib_matlab_nan.tck", "nib_standard.LPS.trk", "nv_colby.trx",
    "nv_stroke.trk.gz", "nv_tract.FAT_R.vtk", "nv_tract.IFOF_R.trk", "nv_tract.SLF1_R.tck", "trxpy_small.trx",
    "trxpy_small_compressed.trx", "trxrs_tinytrack_small.tt.gz", "ukf_2T_fw_fiber.vtk",
    "vtk_Coastlines_Los_Alamos.vtp", "wholebrain_eudx_0.5mm_fifth.tck", "wma_brain_0002.vtk",
]  # fmt: skip


def angles(lines, *, begun=True, **options):
    """Angles between the tangents of lines and of what is drawn, by plain NumPy; of bare points if not ``begun``."""
    fiblets = pf.compress(lines, **options)
    decoded, offsets = fiblets.decompress(dtype=np.float64).points, np.asarray(lines.offsets, np.int64)
    return direction_angles(lines.points, decoded, offsets, fiblets.fiblet_points() if begun else None)


@pytest.mark.few(1)
@pytest.mark.parametrize("name", FILES)
def test_every_real_file_keeps_its_directions(shared_data, name):
    found = angles(pf.read(shared_data / name))
    assert found.max() <= 10.0
    assert np.quantile(found, 0.99) < 5.0


@pytest.mark.few(4)
@pytest.mark.parametrize("effort", ["fast", "high", "small"])
@pytest.mark.parametrize(("make", "kept"), [(smooth, 1.0), (noisy, 1.3), (wandering, 15.0)])
def test_any_angle_is_kept_and_none_leaves_directions_alone(make, kept, effort):
    lines = make()
    # The first two turn at every point by more than such angles, so that no first point of a fiblet can keep them.
    begun = make is wandering
    coarse = 0.4 * float(np.median(np.linalg.norm(np.diff(lines[0], axis=0), axis=1)))
    free = angles(lines, begun=begun, max_error=coarse, max_angle=None, effort=effort).max()
    bound = angles(lines, begun=begun, max_error=coarse, max_angle=kept, effort=effort).max()
    assert bound <= kept < free


@pytest.mark.few(6)
@pytest.mark.parametrize("name", extremes())
def test_directions_cost_no_extreme_line_its_promise(name):
    lines = extremes()[name]
    fiblets = pf.compress(lines, max_angle=0.5)
    fiblets.verify()
    assert pf.measure_error(lines, fiblets).max_mm <= fiblets.promise


def test_doubled_points_and_short_segments_beside_long_ones():
    """Joints of edited lines: a point twice, or nearly, or with a stub, between segments a hundred times as long."""
    rng = np.random.default_rng(4)
    lines = []
    for k in range(300):
        steps = 4.0 * (rng.normal(size=3) + 0.15 * rng.normal(size=(14, 3)))
        steps[rng.integers(1, 13)] *= (0.0, 1e-7, 0.02)[k % 3]
        lines.append(np.cumsum(steps, axis=0) + rng.uniform(-60, 60, 3))
    made = Streamlines.from_list(lines)
    found = angles(made)
    assert found.max() <= 10.0
    assert angles(made, max_angle=None).max() > 20.0


def test_the_bound_is_that_of_the_bend():
    line = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [1, 1, 0], [0.9, 1, 0]])
    turns = may_turn(line, 0.5, 30.0)
    np.testing.assert_allclose(turns.units, [[1, 0, 0], [0, 1, 0], [0, 0, 0], [-1, 0, 0]])
    # At the corner half of sin 30 sqrt 2, at either side of the point that stands twice half of sin 30.
    np.testing.assert_allclose(turns.allowed, [0.5 * np.sqrt(0.5), 0.25, 0.25, np.inf])
    assert turns.excess(line[:4], line[4]) == 0.0
    assert turns[:2].excess(np.array([[0.0, 0, 0], [1, 0, 0], [1.0, 0.9, 0.1]])) == pytest.approx(
        np.linalg.norm(np.array([0, 0.9, 0.1]) / np.hypot(0.9, 0.1) - [0, 1, 0]) / 0.25
    )


@settings(max_examples=100)
@given(st.integers(0, 2**32 - 1), st.floats(0.5, 90.0))
def test_segments_within_their_bounds_keep_the_angle(seed, angle):
    """The proof, tried: segments turned by as much as they may, in any direction, turn no tangent farther."""
    rng = np.random.default_rng(seed)
    line = np.cumsum(rng.normal(size=(12, 3)), axis=0)
    turns = may_turn(line, 0.0, angle)
    steps = []
    for unit, allowed in zip(turns.units, turns.allowed, strict=True):
        across = np.cross(unit, rng.normal(size=3))
        across /= np.linalg.norm(across)
        turn = 2.0 * np.arcsin(min(0.5 * allowed, 1.0)) * rng.choice([0.0, 0.5, 0.999999])
        steps.append(np.cos(turn) * unit + np.sin(turn) * across)
    drawn = np.concatenate([[[0.0, 0, 0]], np.cumsum(steps, axis=0)])
    assert turns.excess(drawn) <= 1.0
    assert direction_angles(line, drawn, np.array([0, 12])).max() <= angle * (1.0 + 1e-9)


@settings(max_examples=100)
@given(st.integers(0, 2**32 - 1), st.floats(5.0, 90.0))
def test_first_segments_within_their_bounds_keep_the_angle(seed, angle):
    """The same where fiblets begin, at points where they may."""
    rng = np.random.default_rng(seed)
    line = np.cumsum(rng.normal(size=3) + 0.3 * rng.normal(size=(12, 3)), axis=0)
    turns = may_turn(line, 0.0, angle)
    for i in np.flatnonzero(np.isfinite(turns.first) & (turns.first > 0.0)):
        across = np.cross(turns.units[i], rng.normal(size=3))
        across /= np.linalg.norm(across)
        turn = 2.0 * np.arcsin(0.5 * turns.first[i]) * 0.999999
        drawn = np.array([line[i], line[i] + np.cos(turn) * turns.units[i] + np.sin(turn) * across])
        assert turns[i : i + 1].excess(drawn) == pytest.approx(max(1.0, turns.first[i] / turns.allowed[i]), rel=1e-3)
        moved = line.copy()
        moved[i:] += drawn[1] - line[i + 1]
        moved[i] = line[i]
        found = direction_angles(line[i - 1 : i + 2], moved[i - 1 : i + 2], np.array([0, 3]), np.array([1]))
        assert found[1] <= angle * (1.0 + 1e-9)


def test_fiblets_begin_where_lines_bend_little():
    """Corners at every 60th point, of which each would be the first of a fiblet."""
    steps = np.tile([[1.0, 0.0, 0.0]], (400, 1))
    for corner in range(60, 400, 60):
        steps[corner:] = np.roll(steps[corner:], 1, axis=1)
    lines = Streamlines.from_list([np.cumsum(steps, axis=0)])
    firsts = pf.compress(lines).fiblet_points()
    corners = np.arange(60, 400, 60) - 1
    assert not np.isin(firsts, corners).any()
    assert angles(lines).max() <= 10.0
    assert np.diff(pf.compress(lines, max_angle=None).fiblet_points()).tolist() == [60] * 6


def test_lines_that_bend_everywhere_are_cut_where_they_bend_least():
    lines = wandering(30, 200)
    fiblets = pf.compress(lines)
    fiblets.verify()
    assert fiblets.fiblet_counts().max() <= 60
    enough = 0.8 * 2.0 * np.sin(np.radians(5.0))
    for s, line in enumerate(lines):
        turns = may_turn(line, 0.0, 10.0)
        mine = set((fiblets.fiblet_points() - lines.offsets[s]).tolist())
        assert set(cut(turns, 10.0)) <= mine
        for a, b in pairwise(cut(turns, 10.0)):
            assert 40 < b - a <= 60
            if b < len(turns.bends):
                assert turns.bends[b] <= max(turns.bends[a + 41 : a + 61].min(), enough)
