"""Some streamlines as a set of their own: the same points bit for bit, under their own numbers, and no more read."""

from dataclasses import replace

import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis import given

import pvfiblets as pf
from pvfiblets.codec import layout
from pvfiblets.codec.editing.restrict import even_share, restrict
from pvfiblets.streamlines import Streamlines

from .samples import extremes, noisy, smooth, wandering


def assert_restricted(whole, ids, part):
    """``part`` holds these streamlines of ``whole``, bit for bit, and no points of others."""
    part.verify()
    assert part.n_streamlines == whole.n_streamlines
    wanted, got = whole.decompress(dtype=np.float64), part.decompress(dtype=np.float64)
    expected = np.zeros(len(whole), np.int64)
    expected[ids] = wanted.counts[ids]
    np.testing.assert_array_equal(got.counts, expected)
    np.testing.assert_array_equal(got.points, wanted[np.unique(ids)].points)
    for name, values in wanted[np.unique(ids)].per_point.items():
        np.testing.assert_array_equal(got.per_point[name], values)
    assert got.per_streamline.keys() == wanted.per_streamline.keys()
    for name, rows in wanted.per_streamline.items():
        np.testing.assert_array_equal(got.per_streamline[name], rows)
    assert {k: v.tolist() for k, v in got.groups.items()} == {k: v.tolist() for k, v in wanted.groups.items()}
    assert part.parameters == whole.parameters
    assert part.bounds == whole.bounds


def every_kind():
    """Lines of every kind of fiblet, some without points, with values of both sorts and a group."""
    lines = Streamlines.concatenate([smooth(30, 130, 0.2), noisy(10, 70, 0.2), wandering(30, 90)])
    points = np.asarray(lines.points, np.float64)
    points[lines.offsets[40] :] *= 0.3
    points[lines.offsets[50] + 7] += 1e3  # one step too long for a lattice of two bytes
    counts = np.insert(np.asarray(lines.counts), [0, 17, 70], 0)
    offsets = np.concatenate([[0], np.cumsum(counts)])
    return Streamlines(
        points, offsets,
        per_point={"height": points[:, 2], "fine": np.arange(len(points)) % 1000.0},
        per_streamline={"number": np.arange(73)},
        groups={"some": np.array([3, 70, 41, 0])},
    )  # fmt: skip


@pytest.mark.few(1)
@pytest.mark.parametrize("order", ["input", "hilbert"])
@pytest.mark.parametrize("mapped", [False, True])
@pytest.mark.parametrize("effort", ["fast", "small"])
def test_of_every_kind_the_same_points_come_back(order, mapped, effort, tmp_path):
    whole = pf.compress(every_kind(), per_point=["height", "fine"], per_point_bits=16, order=order, effort=effort)
    kinds = set(layout.coded_kind(whole.decoding))
    assert kinds == {0, 1, 2, 3, *([layout.SPLINE] if effort == "small" else [])}
    if mapped:
        whole.save(tmp_path / "a.fiblets")
        whole = pf.FibletSet.open(tmp_path / "a.fiblets")
    rng = np.random.default_rng(0)
    for ids in (np.arange(73), np.array([5]), np.array([72, 0, 5, 5, 18]), rng.permutation(73)[:30], np.zeros(0, int)):
        part = restrict(whole, ids)
        assert_restricted(whole, ids, part)
        again = restrict(part, ids[::2])
        assert_restricted(part, ids[::2], again)
    assert_restricted(whole, np.arange(10, 60, 7), restrict(whole, slice(10, 60, 7)))
    assert_restricted(whole, np.flatnonzero(np.arange(73) % 3 == 0), restrict(whole, np.arange(73) % 3 == 0))
    assert not isinstance(part.anchors, np.memmap)
    restrict(whole, [3, 70]).save(tmp_path / "b.fiblets")
    assert_restricted(whole, np.array([3, 70]), pf.FibletSet.open(tmp_path / "b.fiblets"))


@pytest.mark.few(8)
@pytest.mark.parametrize("name", extremes())
def test_extreme_lines_survive(name):
    whole = pf.compress(extremes()[name])
    ids = np.flatnonzero(np.arange(len(whole)) % 3 != 1)
    assert_restricted(whole, ids, restrict(whole, ids))


def test_anchors_of_32_bits_keep_their_lower_halves():
    whole = pf.compress(smooth(20, 200), max_error=1e-5)
    assert whole.anchors_low is not None
    ids = np.array([2, 3, 11, 19])
    part = restrict(whole, ids)
    assert part.anchors_low is not None
    assert len(part.anchors_low) == part.n_fiblets
    assert_restricted(whole, ids, part)


def many_pages():
    """Four pages: short streamlines, one that runs through a whole page and across two borders, short ones again."""
    rng = np.random.default_rng(8)
    dots = [rng.uniform(-50, 50, (1 + i % 3, 3)) for i in range(9000)]
    s = np.arange(1_200_000)[:, None] * [0.001, 0.0013, 0.0017]
    helix = 40.0 * np.concatenate([np.cos(s[:, :1]), np.sin(s[:, 1:2]), np.sin(s[:, 2:])], axis=1)
    lines = Streamlines.from_list([*dots, helix, *dots])
    values = {"value": np.arange(lines.n_points) % 251.0}
    return pf.compress(Streamlines(lines.points, lines.offsets, per_point=values), per_point=["value"])


@pytest.fixture(scope="module")
def paged():
    whole = many_pages()
    assert len(whole.pages) - 1 >= 3
    ranks = whole.pages[:, 0]
    assert 9000 in ranks, "a page begins within the long streamline"
    return whole


@pytest.mark.more
def test_streamlines_that_cross_pages(paged):
    rng = np.random.default_rng(9)
    for ids in (
        np.array([9000]),
        np.array([8999, 9000, 9001]),
        np.delete(np.arange(len(paged)), 9000),
        np.delete(np.arange(len(paged)), rng.integers(0, 9000, 40)),
        np.append(9000, rng.integers(0, len(paged), 5000)),
    ):
        assert_restricted(paged, ids, restrict(paged, ids))


@pytest.mark.more
@given(st.lists(st.integers(0, 18000), max_size=30), st.booleans())
def test_any_choice(paged, ids, rest):
    few = np.unique(np.array(ids, np.int64))
    few = np.setdiff1d(np.arange(0, len(paged), 5), few) if rest else few
    part = restrict(paged, few)
    part.verify()
    np.testing.assert_array_equal(part.decompress(few).points, paged.decompress(few).points)
    np.testing.assert_array_equal(part.per_point["value"].codes, restrict(part, few).per_point["value"].codes)
    assert part.n_points == paged.decompress(few).n_points


class Watched(np.ndarray):
    """Remembers how many rows were taken out of it."""

    def __getitem__(self, key):
        taken = super().__getitem__(key)
        self.rows = getattr(self, "rows", 0) + (len(taken) if np.ndim(taken) else 1)
        return np.asarray(taken)


def test_only_pages_with_something_to_take_are_read(paged):
    names = ("anchors", "decoding", "codes", "reach")
    watched = {name: getattr(paged, name).view(Watched) for name in names}
    part = restrict(replace(paged, **watched), [12])
    assert part.n_fiblets == 1
    assert watched["anchors"].rows <= 2 * layout.PAGE + 10
    assert watched["decoding"].rows <= 4
    assert watched["codes"].rows <= 60


@pytest.mark.parametrize("order", ["input", "hilbert"])
def test_an_even_share_is_nested_and_even(order):
    lines = Streamlines.from_list([np.zeros((min(i % 4, 1), 3)) + i for i in range(4000)])
    whole = pf.compress(lines, order=order)
    assert whole.n_ranks == 3000
    before = set()
    for share in (0.0, 0.01, 0.1, 0.35, 0.5, 0.9, 1.0):
        ids = even_share(whole, share)
        assert before <= set(ids.tolist())
        before = set(ids.tolist())
        assert len(before) == len(ids) == pytest.approx(3000 * share, abs=3)
        taken = np.isin(whole.rank_to_id, ids)
        for first in range(0, 2900, 100):  # of every hundred streamlines, as coded, the same share
            assert taken[first : first + 100].sum() == pytest.approx(100 * share, abs=3)
    assert before == set(np.flatnonzero(np.diff(lines.offsets)).tolist())
    np.testing.assert_array_equal(even_share(whole, 0.3), even_share(whole, 0.3))
    with pytest.raises(ValueError, match=r"share is 1.5; a number from 0 to 1"):
        even_share(whole, 1.5)


def test_bad_choices_and_damaged_sets_are_refused():
    whole = pf.compress(every_kind())
    with pytest.raises(IndexError, match="streamline 73 is not among the 73"):
        restrict(whole, [73])
    for array, column in (("anchors", 1), ("decoding", 1)):
        words = getattr(whole, array).copy()
        words[20:40, column] ^= np.uint32(0xFFFF0F0F)
        with pytest.raises(pf.FormatError):
            restrict(replace(whole, **{array: words}), np.arange(0, 73, 2)).verify()
