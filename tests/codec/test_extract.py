"""Some streamlines as a renumbered set: what decompress gives for them, bit for bit, in memory and in every format."""

import numpy as np
import pytest

import pvfiblets as pf
from pvfiblets.formats import UnknownFormatError
from pvfiblets.streamlines import Streamlines

from .samples import assert_equal_streamlines, extremes, smooth
from .test_restrict import every_kind


def assert_equal(part, wanted, whole):
    part.verify()
    assert_equal_streamlines(part.decompress(dtype=np.float64), wanted)
    assert part.n_streamlines == len(part) == len(wanted)
    held = np.clip(np.reshape(wanted.bounds, (3, 2)).T, *np.reshape(whole.bounds, (3, 2)).T)  # in the originals' bounds
    assert part.bounds == (tuple(held.T.ravel()) if wanted.n_points else (0.0,) * 6)
    assert {k: list(v) for k, v in part.per_group.items()} == {k: list(v) for k, v in wanted.per_group.items()}


def with_groups():
    lines = every_kind()
    return Streamlines(
        lines.points, lines.offsets, lines.per_point, {**lines.per_streamline, "three": np.arange(219).reshape(73, 3)},
        {**lines.groups, "none": np.zeros(0, int)}, {"some": {"colour": np.array([1, 2, 3])}},
        np.diag([2.0, 2.0, 2.0, 1.0]), {"dimensions": [3, 4, 5], "voxel_order": "LAS"}, {"lost": 2},
    )  # fmt: skip


@pytest.mark.few(1)
@pytest.mark.parametrize("order", ["input", "hilbert"])
@pytest.mark.parametrize("mapped", [False, True])
@pytest.mark.parametrize("effort", ["fast", "small"])
def test_parts_of_every_kind(order, mapped, effort, tmp_path):
    whole = pf.compress(with_groups(), per_point=["height", "fine"], per_point_bits=16, order=order, effort=effort)
    if mapped:
        whole.save(tmp_path / "a.fiblets")
        whole = pf.FibletSet.open(tmp_path / "a.fiblets")
    rng = np.random.default_rng(0)
    for ids in (np.arange(73), np.array([5]), rng.permutation(73), rng.permutation(73)[:30], np.array([0, 18, 72])):
        part = whole.extract(ids)
        assert_equal(part, whole.decompress(ids, dtype=np.float64), whole)
        assert_equal(part[::-2], whole.decompress(ids[::-2], dtype=np.float64), whole)
        assert part.parameters == whole.parameters
        np.testing.assert_array_equal(part.affine, whole.affine)
        assert (part.space, part.dropped) == (whole.space, whole.dropped)
        part.save(tmp_path / "b.fiblets")
        assert_equal(pf.FibletSet.open(tmp_path / "b.fiblets"), whole.decompress(ids, dtype=np.float64), whole)


def test_ways_to_choose():
    whole = pf.compress(with_groups())
    mask = np.arange(73) % 3 == 0
    for chosen, ids in (
        (5, [5]), (-1, [72]), (slice(10, 20), range(10, 20)), (mask, np.flatnonzero(mask)),
        (slice(None, None, -1), range(72, -1, -1)),
        ([3, 3, -70, 1, 3], [3, 1]), (np.uint8([9, 2]), [9, 2]),
    ):  # fmt: skip
        assert_equal(whole[chosen], whole.decompress(np.array(ids), dtype=np.float64), whole)
    assert whole[5].n_streamlines == 1
    with pytest.raises(IndexError, match="streamline 73 is not among the 73"):
        whole[73]
    with pytest.raises(IndexError, match="a mask of shape"):
        whole[mask[:5]]


@pytest.mark.filterwarnings("ignore:.*have no points")
@pytest.mark.parametrize("ids", [[], np.zeros(73, bool), slice(0, 0), [0]])
def test_a_part_without_points_is_a_set_and_can_be_saved(ids, tmp_path):
    whole = pf.compress(with_groups(), per_point=["height"])
    part = whole[ids]
    assert_equal(part, whole.decompress(ids, dtype=np.float64), whole)
    assert part.n_points == 0
    for name in ("a.fiblets", "a.trk", "a.tck", "a.trx", "a.vtk", "a.vtp"):
        part.save(tmp_path / name)
        assert len(pf.read(tmp_path / name)) == len(part), name


@pytest.mark.few(7)
@pytest.mark.parametrize("name", extremes())
def test_extreme_lines(name):
    whole = pf.compress(extremes()[name])
    ids = np.flatnonzero(np.arange(len(whole)) % 3 != 1)[::-1]
    assert_equal(whole[ids], whole.decompress(ids, dtype=np.float64), whole)


def test_anchors_of_32_bits(tmp_path):
    whole = pf.compress(smooth(20, 200), max_error=1e-5)
    whole.save(tmp_path / "a.fiblets")
    mapped = pf.FibletSet.open(tmp_path / "a.fiblets").decompress(dtype=np.float64)
    np.testing.assert_array_equal(mapped.points, whole.decompress(dtype=np.float64).points)
    assert whole.anchors_low is not None
    assert_equal(whole[[19, 2]], whole.decompress([19, 2], dtype=np.float64), whole)


@pytest.mark.few(3)
@pytest.mark.filterwarnings("ignore:.*have no points")
@pytest.mark.parametrize("suffix", [".trk", ".tck", ".trx", ".vtk", ".vtp"])
def test_a_part_is_saved_in_any_format(suffix, tmp_path):
    whole = pf.compress(every_kind(), per_point=["height"])
    part = whole[[41, 3, 70, 0]]
    lost = part.save(tmp_path / f"a{suffix}")
    read = pf.read(tmp_path / f"a{suffix}")
    np.testing.assert_array_equal(read.counts, part.decompress().counts)
    np.testing.assert_allclose(read.points, part.decompress().points, rtol=1e-6, atol=1e-3)
    assert ("groups" in lost) == (suffix in (".trk", ".tck"))
    if "per_point" not in lost:
        np.testing.assert_allclose(read.per_point["height"].ravel(), part.decompress().per_point["height"], rtol=1e-6)


def test_formats_that_cannot_be_written_say_so(tmp_path):
    part = pf.compress(every_kind())[:3]
    with pytest.raises(UnknownFormatError, match=r"no write\(\)"):
        part.save(tmp_path / "a.trk.gz")
    assert part.save(tmp_path / "without_suffix") == []
    assert len(pf.FibletSet.open(tmp_path / "without_suffix")) == 3
