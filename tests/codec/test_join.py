"""Sets behind each other: parts of one keep every bit, others keep their promise, data are joined or refused."""

import numpy as np
import pytest

import pvfiblets as pf
from pvfiblets.streamlines import Streamlines

from .samples import smooth
from .test_extract import assert_equal, with_groups


@pytest.mark.parametrize("order", ["input", "hilbert"])
def test_parts_of_one_set_keep_every_bit(order, tmp_path):
    whole = pf.compress(with_groups(), per_point=["height", "fine"], per_point_bits=16, order=order)
    first, second = np.array([5, 0, 18, 40]), np.arange(20, 73)
    both = whole[first] + whole[second]
    wanted = whole.decompress(np.concatenate([first, second]), dtype=np.float64)
    wanted.dropped = {"lost": 4}
    assert_equal(both, wanted, both)
    assert both.parameters == whole.parameters
    assert both.dropped == {"lost": 4}
    both.save(tmp_path / "a.fiblets")
    assert_equal(pf.FibletSet.open(tmp_path / "a.fiblets"), wanted, both)


def test_more_than_a_page_of_fiblets():
    whole = pf.compress(Streamlines.from_list([np.cumsum(np.ones((60, 3)), axis=0) + i for i in range(9000)]))
    both = whole[:8999] + whole + whole[3000:]
    assert both.n_fiblets > 16384
    both.verify()
    points = whole.decompress(dtype=np.float64).points.reshape(9000, -1, 3)
    wanted = np.concatenate([points[:8999], points, points[3000:]])
    np.testing.assert_array_equal(both.decompress(dtype=np.float64).points, wanted.reshape(-1, 3))


def test_other_sets_are_coded_again_within_the_promise():
    one, two = smooth(0), smooth(1)
    both = pf.compress(one) + pf.compress(two, max_error=0.03)
    both.verify()
    wanted = Streamlines.concatenate([one, two])
    got = both.decompress(dtype=np.float64)
    np.testing.assert_array_equal(got.offsets, wanted.offsets)
    assert np.linalg.norm(got.points - wanted.points, axis=1).max() <= both.promise


def test_nothing_and_gaps():
    whole = pf.compress(with_groups(), per_point=["height"])
    assert pf.FibletSet.concatenate([whole]) is whole
    assert_equal(whole[:0] + whole[:3], whole.decompress([0, 1, 2], dtype=np.float64), whole)
    assert len(whole[:0] + whole[:0]) == 0
    with pytest.raises(ValueError, match="no set to concatenate"):
        pf.FibletSet.concatenate([])
    with pytest.raises(ValueError, match="not every set has per_point 'height'"):
        whole[:20] + pf.compress(with_groups())[20:]
    with pytest.raises(TypeError, match="unsupported operand"):
        whole + 1


def test_iteration_gives_the_points_of_each_streamline():
    whole = pf.compress(with_groups(), order="hilbert")
    for line, wanted in zip(whole, whole.decompress(), strict=True):
        np.testing.assert_array_equal(line, wanted)
