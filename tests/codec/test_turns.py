"""Directions within the angle that is promised: on extreme, made-up and real lines, and by the bound's own proof."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import pvfiblets as pf
from pvfiblets.codec.turn_reference import Turns, may_turn
from pvfiblets.report.errors_and_times import direction_angles
from pvfiblets.streamlines import Streamlines

from .samples import extremes, noisy, smooth, wandering

FILES = [
    "dipy_EuDX_small_25.trk", "dipy_hist_tractogram.trk", "dipy_tracks300.trk", "gen_fibercup_det_0.25mm.tck",
    "nib_complex_big_endian.trk", "nib_matlab_nan.tck", "nib_standard.LPS.trk", "nv_colby.trk", "nv_colby.trx",
    "nv_stroke.trk.gz", "nv_tract.FAT_R.vtk", "nv_tract.IFOF_R.trk", "nv_tract.SLF1_R.tck", "trxpy_small.trx",
    "trxpy_small_compressed.trx", "trxrs_tinytrack_small.tt.gz", "ukf_2T_fw_fiber.vtk",
    "vtk_Coastlines_Los_Alamos.vtp", "wholebrain_eudx_0.5mm_fifth.tck", "wma_brain_0002.vtk",
]  # fmt: skip


def angles(lines: Streamlines, **options: object) -> np.ndarray:
    """Angles between the tangents of lines and of what is decoded, by plain NumPy."""
    decoded = pf.compress(lines, **options).decompress(dtype=np.float64)
    return direction_angles(lines.points, decoded.points, np.asarray(lines.offsets, np.int64))


@pytest.mark.parametrize("name", FILES)
def test_every_real_file_keeps_its_directions(shared_data: Path, name: str) -> None:
    found = angles(pf.read(shared_data / name))
    assert found.max() <= 10.0
    assert np.quantile(found, 0.99) < 5.0


@pytest.mark.parametrize("effort", ["fast", "high"])
@pytest.mark.parametrize(("make", "kept"), [(smooth, 1.0), (noisy, 1.3), (wandering, 15.0), (wandering, 1.0)])
def test_any_angle_is_kept_and_none_leaves_directions_alone(make, kept: float, effort: str) -> None:
    lines = make()
    coarse = 0.4 * float(np.median(np.linalg.norm(np.diff(lines[0], axis=0), axis=1)))
    free = angles(lines, max_error=coarse, max_angle=None, effort=effort).max()
    assert angles(lines, max_error=coarse, max_angle=kept, effort=effort).max() <= kept < free


@pytest.mark.parametrize("name", extremes())
def test_directions_cost_no_extreme_line_its_promise(name: str) -> None:
    lines = extremes()[name]
    fiblets = pf.compress(lines, max_angle=0.5)
    fiblets.verify()
    assert pf.measure_error(lines, fiblets).max_mm <= fiblets.promise


def test_doubled_points_and_short_segments_beside_long_ones() -> None:
    """Joints of edited lines: a point twice, or nearly, or with a stub, between segments a hundred times as long."""
    rng = np.random.default_rng(4)
    lines = []
    for k in range(300):
        steps = rng.normal(size=(14, 3)) * 4.0
        steps[rng.integers(1, 13)] *= (0.0, 1e-7, 0.02)[k % 3]
        lines.append(np.cumsum(steps, axis=0) + rng.uniform(-60, 60, 3))
    made = Streamlines.from_list(lines)
    found = angles(made)
    assert found.max() <= 10.0
    assert angles(made, max_angle=None).max() > 20.0


def test_the_bound_is_that_of_the_bend() -> None:
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
def test_segments_within_their_bounds_keep_the_angle(seed: int, angle: float) -> None:
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
    assert Turns(turns.units, turns.allowed).excess(drawn) <= 1.0
    assert direction_angles(line, drawn, np.array([0, 12])).max() <= angle * (1.0 + 1e-9)
