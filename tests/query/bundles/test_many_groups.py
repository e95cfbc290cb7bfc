"""Sets of many groups are measured in one pass, and profiles by the points themselves."""

from __future__ import annotations

import numpy as np
import pytest

from pvfiblets import Streamlines, compress
from pvfiblets.query.bundles import statistics
from pvfiblets.query.bundles.tract_profile import tract_profile
from pvfiblets.query.density.volume import density


@pytest.fixture(scope="module")
def lines() -> Streamlines:
    rng = np.random.default_rng(1)
    points = (rng.normal(0, 8, (60, 1, 3)) + np.cumsum(rng.normal(0, 1, (60, 12, 3)), 1)).reshape(-1, 3)
    groups = {f"edge_{i}": rng.integers(0, 60, i % 7) for i in range(90)}
    return Streamlines(
        points, np.arange(0, 721, 12), per_point={"fa": rng.random(720)}, per_streamline={"w": rng.random(60)},
        groups=groups,
    )  # fmt: skip


@pytest.mark.parametrize("compressed", [False, True])
def test_groups_that_overlap_are_measured_as_each_alone(lines, monkeypatch, compressed):
    monkeypatch.setattr(statistics, "CHUNK", 50)  # bundles go on from part to part
    data = compress(lines, per_point=["fa"]) if compressed else lines
    whole = data.decompress(dtype=np.float64) if compressed else lines
    table = statistics.bundle_table(data, weights="points")
    for row, (name, members) in enumerate(lines.groups.items()):
        ids = np.unique(members)
        alone = whole[ids]
        lengths = [np.linalg.norm(np.diff(line, axis=0), axis=1).sum() for line in alone]
        assert (table["bundle"][row], table["count"][row], table["points"][row]) == (name, len(ids), 12 * len(ids))
        if not len(ids):
            assert np.isnan([table["length_mean"][row], table["mean_fa"][row], table["std_w"][row]]).all()
            assert table["volume_voxels"][row] == 0
            continue
        for key, value in {
            "length_mean": np.mean(lengths), "length_std": np.std(lengths), "length_min": min(lengths),
            "length_max": max(lengths), "length_total": sum(lengths), "mean_w": np.mean(lines.per_streamline["w"][ids]),
            "mean_fa": np.mean(alone.per_point["fa"], dtype=float), "std_fa": np.std(alone.per_point["fa"], dtype="f8"),
            "volume_voxels": np.count_nonzero(density(alone, 1.0).values),
        }.items():  # fmt: skip
            assert table[key][row] == pytest.approx(value, rel=1e-9, abs=1e-12), key


def test_the_voxels_of_a_bundle_end_at_points_that_are_none():
    points = np.array([[0.5, 0.5, 0.5], [2.5, 0.5, 0.5], [np.nan] * 3, [7.5, 0.5, 0.5], [8.5, 0.5, 0.5]])
    with pytest.warns(UserWarning, match="non-finite"):
        table = statistics.bundle_table(Streamlines(points, [0, 5], groups={"a": [0]}))
    assert table["volume_voxels"].tolist() == [5]  # 0 to 2, 7 and 8


def test_a_profile_of_curvature_takes_the_points_of_a_set_that_would_be_coded():
    turn = np.arange(1200) * 0.1 / 50  # arcs of 50 mm radius, two megabytes
    arc = np.c_[50 * np.cos(turn), 50 * np.sin(turn), 0 * turn]
    shifts = np.random.default_rng(0).normal(0, 2, (150, 1, 3))
    lines = Streamlines((arc + shifts).reshape(-1, 3).astype(np.float32), np.arange(0, 150 * 1200 + 1, 1200))
    found = tract_profile(lines, np.arange(150), "curvature", 20, weights="equal")
    np.testing.assert_allclose(found.mean, 0.02, rtol=0.01)


def test_voxels_are_given_once(lines):
    with pytest.raises(ValueError, match="either"):
        statistics.bundle_table(lines, voxel_size=1.0, like=(np.zeros((2, 2, 2)), np.eye(4)))
