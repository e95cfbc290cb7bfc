"""What other methods of keeping streamlines decode to, against closed forms."""

import sys
import types
import zlib

import numpy as np
import pytest

from pvfiblets.report.studies.codec.baselines import octahedral
from pvfiblets.report.studies.codec.baselines.directions import PaperFiblets, QFib, widest_turn
from pvfiblets.report.studies.codec.baselines.linearised import LinesPacked, linearised
from pvfiblets.report.studies.codec.baselines.numbers import float16, int16, squeezed_by_zlib, squeezed_by_zstd
from pvfiblets.report.studies.codec.data_sets import synthetic_tracking
from pvfiblets.report.studies.codec.errors import distances, median_step


def directions(n, seed=0):
    v = np.random.default_rng(seed).normal(size=(n, 3))
    axes = np.concatenate([np.eye(3), -np.eye(3), [[1, 1, 0], [-1, 1, 0], [-1, 0, -1], [-1e-9, 1, 1]]])
    v = np.concatenate([v, axes])
    return v / np.linalg.norm(v, axis=1, keepdims=True)


@pytest.mark.parametrize("levels", [16, 256])
def test_octahedral_codes_are_off_by_no_more_than_the_grid_allows(levels):
    wanted = directions(4000)
    codes = [octahedral.pack(*v, levels) for v in wanted]
    got = np.array([octahedral.unpack(i, j, levels) for i, j in codes])
    assert np.min(codes) >= 0
    assert np.max(codes) <= levels - 1
    np.testing.assert_allclose(np.linalg.norm(got, axis=1), 1.0, rtol=1e-14)
    angles = np.arctan2(np.linalg.norm(np.cross(wanted, got), axis=-1), (wanted * got).sum(-1))
    # A cell's half-diagonal in the square is sqrt(2) / (levels - 1); on the octahedron's faces, which are tilted,
    # lengths grow by up to sqrt(3), and the faces are 1 / sqrt(3) from the centre at least.
    worst = 3.0 * np.sqrt(2.0) / (levels - 1)
    assert angles.max() <= worst
    assert angles.max() > 0.2 * worst  # and the bound is not an empty one


def test_codes_on_the_octahedron_stand_for_themselves_and_what_is_beyond_the_cap_goes_to_its_edge():
    for i in range(16):
        for j in range(16):
            v = np.array(octahedral.unpack(i, j, 16))
            again = np.array(octahedral.unpack(*octahedral.pack(*v, 16), 16))
            np.testing.assert_allclose(again, v, atol=1e-12)  # on the folded edge two codes are one direction
    ratio = octahedral.ratio_of(np.radians(30.0))
    v = np.array([np.cos(1.0), np.sin(1.0) * np.cos(2.0), np.sin(1.0) * np.sin(2.0)])  # 57 degrees off
    back = np.array(octahedral.to_cap(*octahedral.from_cap(*v, ratio, 1.0, 1.0), ratio, 1.0))
    assert np.degrees(np.arccos(back[0])) == pytest.approx(30.0)
    assert np.arctan2(back[2], back[1]) == pytest.approx(2.0)
    assert octahedral.from_cap(1.0, 0.0, 0.0, ratio, 2.0, 2.0) == (1.0, 0.0, 0.0)


@pytest.mark.parametrize("spread", [1.0, 2.0])
@pytest.mark.parametrize("degrees", [0.01, 5.0, 60.0, 179.0])
def test_the_stretched_cap_keeps_ratios_of_areas_and_comes_back(spread, degrees):
    ratio = octahedral.ratio_of(np.radians(degrees))
    rng = np.random.default_rng(1)
    share, azimuth = rng.uniform(1e-6, 0.999, 300), rng.uniform(0, 2 * np.pi, 300)
    away = share * ratio  # 1 - x: the area of a cap is in proportion to it (Archimedes)
    lateral = np.sqrt(away * (2.0 - away))
    for v, s, a in zip(np.stack([1 - away, lateral * np.cos(azimuth), lateral * np.sin(azimuth)], 1), share, azimuth,
                       strict=True):  # fmt: skip
        w = octahedral.from_cap(*v, ratio, spread, spread)
        assert np.linalg.norm(w) == pytest.approx(1.0, abs=1e-9)
        assert 1.0 - w[0] == pytest.approx(spread * s, abs=1e-7)
        assert np.cos(np.arctan2(w[2], w[1]) - a) == pytest.approx(1.0)
        np.testing.assert_allclose(octahedral.to_cap(*w, ratio, spread), v, atol=1e-8)


@pytest.mark.few(1)
@pytest.mark.parametrize("noisy", [False, True])
def test_directions_follow_constant_steps(noisy):
    streamlines = synthetic_tracking(0.2, noisy, 12_000, 3)
    points, offsets = streamlines.points, streamlines.offsets
    found = {}
    for name, pack in {"8": QFib(8), "16": QFib(16), "paper": PaperFiblets()}.items():
        packed = pack(points, offsets)
        decoded = packed.points()
        found[name] = distances(points, decoded) / 0.2
        lengths = np.linalg.norm(np.diff(decoded, axis=0), axis=1)
        inside = np.ones(len(lengths), bool)
        inside[packed.starts[1:-1] - 1] = False
        inside[packed.starts[:-1]] = False  # the first two points are stored as they are
        np.testing.assert_allclose(lengths[inside], packed.step, rtol=1e-9)
    # 256 times as many codes: 16 times finer.
    assert found["16"].mean() < found["8"].mean() / 5
    assert found["8"].max() < 0.5
    assert found["paper"].max() < 0.3
    counts = np.diff(offsets)
    assert QFib(8)(points, offsets).nbytes == 32 + int((4 + 24 + counts - 2).sum())
    assert QFib(16)(points, offsets).nbytes == 32 + int((4 + 24 + 2 * (counts - 2)).sum())
    assert PaperFiblets()(points, offsets).nbytes == 32 + 80 * int((-(-counts // 60)).sum())


def test_directions_of_a_circle_keep_its_turn():
    angle = np.radians(3.0)
    t = angle * np.arange(200)
    circle = np.stack([np.cos(t), np.sin(t), np.zeros_like(t)], 1) * 10.0
    offsets = np.array([0, 200])
    assert widest_turn(circle, offsets) == pytest.approx(angle, rel=1e-9)
    step = median_step(circle, offsets)
    assert step == pytest.approx(20.0 * np.sin(angle / 2))
    assert distances(circle, QFib(16)(circle, offsets).points()).max() < 0.05 * step


@pytest.mark.parametrize("pack", [QFib(8), QFib(16), PaperFiblets(), float16, int16, squeezed_by_zlib(6)])
@pytest.mark.parametrize("counts", [[1], [2], [1, 0, 3, 61], [120, 60]])
def test_short_straight_and_still_streamlines(pack, counts):
    offsets = np.concatenate([[0], np.cumsum(counts)])
    points = np.zeros((offsets[-1], 3))
    points[:, 1] = 0.5 * np.arange(len(points))
    assert distances(points, pack(points, offsets).points()).max() < 0.02
    assert distances(points * 0.0, pack(points * 0.0, offsets).points()).max() == 0.0


def test_numbers_are_off_by_half_a_unit_and_zlib_by_nothing():
    points = np.random.default_rng(2).uniform(-127, 127, (500, 3))
    got = float16(points, np.array([0, 500])).points()
    ulp = 2.0 ** (np.floor(np.log2(np.abs(points))) - 10)
    assert (np.abs(got - points) <= 0.5 * ulp).all()
    assert np.abs(got - points).max() > 0.4 * ulp.max() / 2
    with pytest.raises(ValueError, match="65504"):
        float16(points * 1e4, np.array([0, 500]))
    points = np.random.default_rng(3).uniform(-1, 1, (900, 3)) * [100, 1, 0] + [5, -7, 3]
    packed = int16(points, np.array([0, 900]))
    quantum = (points.max(0) - points.min(0)) / 65535
    assert (np.abs(packed.points() - points) <= 0.5 * quantum + 1e-12).all()
    assert packed.nbytes == 900 * 6 + 48 + 4
    points = np.random.default_rng(4).normal(size=(300, 3)).astype(np.float32)
    packed = squeezed_by_zlib(6)(points, np.array([0, 100, 300]))
    np.testing.assert_array_equal(packed.points(), points)
    assert packed.nbytes == len(zlib.compress(points.tobytes(), 6)) + 8


def test_dipy_is_asked_with_its_tolerance_and_missing_packages_are_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "zstandard", None)
    monkeypatch.setitem(sys.modules, "dipy.tracking.streamlinespeed", None)
    for make in (squeezed_by_zstd, linearised):
        with pytest.raises(ImportError):
            make(1)
    asked = []

    def compress_streamlines(lines, tol_error):
        asked.append((len(lines), tol_error))
        return [line[[0, -1]] for line in lines]

    monkeypatch.setitem(sys.modules, "dipy", types.ModuleType("dipy"))
    monkeypatch.setitem(sys.modules, "dipy.tracking", types.ModuleType("dipy.tracking"))
    module = types.ModuleType("dipy.tracking.streamlinespeed")
    module.compress_streamlines = compress_streamlines
    monkeypatch.setitem(sys.modules, "dipy.tracking.streamlinespeed", module)
    points = np.random.default_rng(5).normal(size=(12, 3))
    packed = linearised(0.25)(points, np.array([0, 5, 7, 12]))
    assert asked == [(2, 0.25)]  # of two points nothing can be left out
    assert [len(line) for line in packed.kept] == [2, 2, 2]


def test_errors_of_simplified_lines_are_distances_from_them():
    line = np.stack([np.arange(7.0), [0, 0.1, 0.2, 0, -0.3, 0, 0], np.zeros(7)], 1)
    other = line[::-1] + [0.0, 10.0, 0.0]
    points, offsets = np.concatenate([line, other]), np.array([0, 7, 14])
    packed = LinesPacked([line[[0, 3, 6]], other[[0, 6]]])
    apart = packed.distances(points, offsets)
    np.testing.assert_allclose(apart[:7], np.abs(line[:, 1]), atol=1e-12)
    np.testing.assert_allclose(apart[7:], np.abs(other[:, 1] - 10.0), atol=1e-12)
    assert packed.nbytes == 5 * 12 + 8
    with pytest.raises(ValueError, match="none of its points"):
        LinesPacked([line[[0, 3]] + 0.5, other]).distances(points, offsets)
