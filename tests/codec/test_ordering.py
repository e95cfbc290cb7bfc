"""Streamlines coded along a space-filling curve: compact in space, and given back in their own order."""

import numpy as np
import pytest

import pvfiblets as pf
from pvfiblets.codec import layout
from pvfiblets.codec.encoding import ordering
from pvfiblets.streamlines import Streamlines
from pvfiblets.synthetic import brain_streamlines

from .samples import extremes, smooth, wandering


@pytest.mark.parametrize(("dimensions", "bits"), [(2, 4), (3, 3), (6, 2)])
def test_the_curve_visits_every_cell_and_goes_by_single_steps(dimensions, bits):
    axes = np.meshgrid(*[np.arange(1 << bits)] * dimensions, indexing="ij")
    cells = np.stack([a.ravel() for a in axes], axis=1)
    keys = ordering.hilbert_keys(cells, bits)
    np.testing.assert_array_equal(np.sort(keys), np.arange(len(cells)))
    steps = np.abs(np.diff(cells[np.argsort(keys)], axis=0)).sum(axis=1)
    assert (steps == 1).all()


def lines_with_everything():
    """Lines of both kinds, some empty, with values per point and per streamline, and a group."""
    whole = Streamlines.concatenate([smooth(40, 130), wandering(40, 30)])
    shuffled = whole[np.random.default_rng(1).permutation(80)]
    counts = np.insert(np.asarray(shuffled.counts), [0, 17, 40, 80], 0)
    offsets = np.concatenate([[0], np.cumsum(counts)])
    return Streamlines(
        shuffled.points, offsets,
        per_point={"height": np.asarray(shuffled.points[:, 2])},
        per_streamline={"number": np.arange(84)},
        groups={"some": np.array([3, 70, 41, 0])},
    )  # fmt: skip


def assert_same(a, b):
    np.testing.assert_array_equal(a.points, b.points)
    np.testing.assert_array_equal(a.offsets, b.offsets)
    np.testing.assert_array_equal(a.per_point["height"], b.per_point["height"])
    np.testing.assert_array_equal(a.per_streamline["number"], b.per_streamline["number"])
    assert a.groups["some"].tolist() == b.groups["some"].tolist()


@pytest.mark.few(1)
@pytest.mark.parametrize("mapped", [False, True])
def test_everything_comes_back_in_the_order_of_the_input(mapped, tmp_path):
    lines = lines_with_everything()
    plain = pf.compress(lines, per_point=["height"])
    ordered = pf.compress(lines, per_point=["height"], order="hilbert")
    assert plain.in_order
    assert not ordered.in_order
    if mapped:
        ordered.save(tmp_path / "a.fiblets")
        ordered = pf.FibletSet.open(tmp_path / "a.fiblets")
    ordered.verify()
    assert sorted(ordered.rank_to_id) == np.flatnonzero(np.diff(lines.offsets)).tolist()
    assert_same(ordered.decompress(), plain.decompress())
    np.testing.assert_array_equal(ordered.offsets(), plain.offsets())
    np.testing.assert_array_equal(ordered.lengths(), plain.lengths())
    for ids in ([5, 3, 70, 0, 5], np.arange(84) % 3 == 0, slice(10, 60, 7)):
        assert_same(ordered.decompress(ids), plain.decompress(ids))
    for chunk, other in zip(ordered.iter_chunks(700), _blocks(lines, plain, 700), strict=True):
        np.testing.assert_array_equal(chunk.points, other.points)
        np.testing.assert_array_equal(chunk.per_point["height"], other.per_point["height"])
        np.testing.assert_array_equal(chunk.per_streamline["number"], other.per_streamline["number"])
    assert pf.measure_error(lines, ordered).max_mm <= ordered.promise
    coded = ordered.in_coded_order(lines.per_point["height"])
    assert np.abs(coded - ordered.per_point["height"].values()).max() <= ordered.per_point["height"].max_error
    np.testing.assert_array_equal(plain.in_coded_order(lines.per_point["height"]), lines.per_point["height"])


def _blocks(lines, fiblets, size):
    return [fiblets.decompress(np.arange(a, b)) for a, b in lines.blocks(size)]


def test_streamlines_of_one_cell_keep_their_order():
    """So that the same input makes the same file everywhere."""
    ends = np.repeat(np.random.default_rng(0).uniform(0.0, 100.0, (7, 3)), 300, axis=0)
    order = ordering.ends_order(ends, ends + 1e-9)
    cells = order // 300
    assert (np.diff(order)[np.diff(cells) == 0] > 0).all()


@pytest.mark.few(6)
@pytest.mark.parametrize("name", extremes())
def test_extreme_lines_can_be_ordered(name):
    lines = extremes()[name]
    fiblets = pf.compress(lines, order="hilbert")
    fiblets.verify()
    np.testing.assert_array_equal(fiblets.decompress().offsets, lines.offsets)
    assert pf.measure_error(lines, fiblets).max_mm <= fiblets.promise


def test_neighbours_on_the_curve_are_neighbours_in_space():
    """The area that the box around 8 consecutive streamlines shows, beside that in the order of tracking."""
    lines = brain_streamlines(8000, 2.0)

    def shown(fiblets):
        anchors = np.stack([layout.unpack(f"anchor_{a}", fiblets.anchors) for a in "xyz"], axis=1)
        starts = np.flatnonzero(layout.unpack("begin", fiblets.anchors))[::8]
        size = (np.maximum.reduceat(anchors, starts) - np.minimum.reduceat(anchors, starts)) * fiblets.anchor_scale
        return float((size[:, 0] * size[:, 1] + size[:, 1] * size[:, 2] + size[:, 2] * size[:, 0]).mean())

    assert shown(pf.compress(lines, order="hilbert")) < 0.35 * shown(pf.compress(lines))


def test_orders_that_there_are_none_of_are_refused(tmp_path):
    with pytest.raises(ValueError, match="order is 'z'; 'input' or 'hilbert' is needed"):
        pf.compress(smooth(2, 10), order="z")
    pf.write(tmp_path / "a.tck", smooth(2, 10))
    with pytest.raises(ValueError, match="needs all streamlines in memory"):
        pf.compress_file(tmp_path / "a.tck", tmp_path / "a.fiblets", order="hilbert")
