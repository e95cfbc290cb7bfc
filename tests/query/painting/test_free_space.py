"""How far voxels are from a set, against SciPy's distances."""

import numpy as np
import pytest
from scipy.ndimage import distance_transform_cdt

from pvfiblets.query.painting import free_space
from pvfiblets.query.painting.free_space import FAR, FreeSpace


def region():
    rng = np.random.default_rng(3)
    there = rng.random((30, 24, 44)) < 0.001
    there[10:16, 5:9, 20:23] = True
    return there


def bits_of(there):
    """Return bits of voxels of which one says whether they are there, and others what is of no consequence."""
    noise = np.random.default_rng(5).integers(0, 256, there.shape, np.uint8) & ~np.uint8(4)
    return noise | np.where(there, np.uint8(4), np.uint8(0))


BOX = np.array([2, 3, 1, 29, 20, 43])


def steps_to(there):
    """Return how many voxels each is from the nearest of a set."""
    return np.minimum(distance_transform_cdt(~there, "chessboard"), FAR)


def test_distances_are_those_of_scipy():
    there = region()
    low, high = BOX[:3], BOX[3:]
    found = FreeSpace.from_bits(bits_of(there), 4, BOX)
    np.testing.assert_array_equal(found.first, low)
    cut = there[tuple(map(slice, low, high))]
    np.testing.assert_array_equal(found.steps, steps_to(cut))
    beyond = FreeSpace.from_bits(bits_of(~there), 4, BOX, beyond=True)
    np.testing.assert_array_equal(beyond.steps, steps_to(np.pad(cut, 1, constant_values=True))[1:-1, 1:-1, 1:-1])


def test_in_large_boxes_they_are_powers_of_two_and_never_too_long(monkeypatch):
    monkeypatch.setattr(free_space, "LARGE", 1)
    there = region()
    found = FreeSpace.from_bits(bits_of(there), 4, BOX).steps
    exact = steps_to(there[tuple(map(slice, BOX[:3], BOX[3:]))])
    assert set(np.unique(found)) <= {0, 1, 2, 4, 8, 16}
    assert (found <= exact).all()
    assert (2 * found[exact > 0].astype(int) > exact[exact > 0]).all()


@pytest.mark.parametrize("beyond", [False, True])
def test_a_box_without_voxels_is_far_from_all(beyond):
    found = FreeSpace.from_bits(bits_of(region()), 4, [np.inf] * 3 + [-np.inf] * 3, beyond=beyond)
    np.testing.assert_array_equal(found.steps, [[[FAR]]])
