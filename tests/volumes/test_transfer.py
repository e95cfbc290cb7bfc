"""Transfer functions: what opacity means, what is seen in an interval, and steps integrated exactly."""

from __future__ import annotations

import hypothesis
import numpy as np
import pytest
from hypothesis import strategies as st

from pvfiblets.volumes import RaycastVolume, Transfer
from pvfiblets.volumes.transfer import LARGEST_DEPTH


def table(k, seed=0):
    return np.random.default_rng(seed).random((k, 4))


def test_values_are_looked_up_linearly():
    transfer = Transfer(table(5), (-2.0, 6.0))
    entries = transfer.table.astype(np.float64)
    np.testing.assert_allclose(transfer.lookup([-2.0, 0.0, 2.0, 4.0, 6.0]), entries, atol=1e-15)
    np.testing.assert_allclose(transfer.lookup([-2.1, -1e30, 6.1, 1e30]), entries[[0, 0, 4, 4]])
    values = np.linspace(-3.0, 7.0, 101)
    expected = [np.interp(values, np.linspace(-2.0, 6.0, 5), entries[:, c]) for c in range(4)]
    np.testing.assert_allclose(transfer.lookup(values), np.stack(expected, axis=1), atol=1e-14)
    assert transfer.lookup(1.0).shape == (4,)
    np.testing.assert_array_equal(transfer.colour(values), transfer.lookup(values)[:, :3])


def test_a_unit_length_has_the_opacity_of_the_table():
    for unit in (1e-3, 1.0, 40.0):
        transfer = Transfer(table(6), (0.0, 1.0), unit)
        values = np.linspace(0.0, 1.0, 57)
        kappa = transfer.extinction(values)
        np.testing.assert_allclose(1.0 - np.exp(-kappa * unit), transfer.lookup(values)[:, 3], atol=1e-14)
        # Two halves of a unit, one behind the other, are as opaque as it is.
        half = 1.0 - np.exp(-kappa * unit / 2)
        np.testing.assert_allclose(half + (1 - half) * half, transfer.lookup(values)[:, 3], atol=1e-14)
        np.testing.assert_allclose(transfer.emission(values), kappa[:, None] * transfer.colour(values), rtol=1e-14)
    full = Transfer([[1, 1, 1, 0], [1, 1, 1, 1]], (0, 1), unit=2.0)
    assert (full.extinction(0.0), full.extinction(1.0)) == (0.0, LARGEST_DEPTH / 2.0)  # finite
    low, high = np.array([[0, 0], [1, 1]], np.uint8), np.array([[0, 1], [1, 1]], np.uint8)
    np.testing.assert_array_equal(full.visible_range(low, high), [[False, True], [True, True]])


@hypothesis.given(
    st.lists(st.sampled_from([0.0, 0.0, 0.0, 1e-6, 1.0]), min_size=2, max_size=9),
    st.floats(-0.5, 1.5), st.floats(-0.5, 1.5), st.booleans(),
)  # fmt: skip
def test_what_is_seen_between_two_values(opacities, low, high, whole):
    if whole:  # ends on entries
        low, high = (np.round(v * (len(opacities) - 1)) / (len(opacities) - 1) for v in (low, high))
    else:  # an opacity of 1e-330 is none
        low, high = np.round(low, 6), np.round(high, 6)
    low, high = min(low, high), max(low, high)
    rgba = np.ones((len(opacities), 4))
    rgba[:, 3] = opacities
    transfer = Transfer(rgba, (0.0, 1.0))
    nodes = np.linspace(0.0, 1.0, len(opacities))
    places = np.r_[low, high, np.linspace(low, high, 200), nodes[(nodes >= low) & (nodes <= high)]]
    assert transfer.visible_range(low, high) == (transfer.lookup(places)[:, 3] > 0.0).any()


def step_of(transfer, front, back, step, n=40000):
    """Colour and opacity of a step by the midpoint rule with thin layers, each exactly as opaque as it is."""
    x = (np.arange(n) + 0.5) / n
    values = front + (back - front) * x
    depths = transfer.extinction(values) * step / n
    before = np.concatenate([[0.0], np.cumsum(depths)])
    weights = np.exp(-before[:-1]) * -np.expm1(-depths)
    return np.append(weights @ transfer.colour(values), -np.expm1(-before[-1]))


@pytest.mark.parametrize("step", [1e-3, 1.0, 30.0, 1000.0])
def test_preintegration_against_thin_layers(step):
    rgba = table(7)
    rgba[2, 3], rgba[3, 3], rgba[5:, 3] = 1.0, 0.0, 1.0  # steep, and fully opaque all along a piece
    transfer = Transfer(rgba, (-3.0, 9.0), unit=2.0)
    pre = transfer.preintegrated(step)
    n = len(pre)
    assert pre.shape == (259, 259, 4)
    assert pre.dtype == np.float32
    assert pre.min() >= 0.0
    assert (pre <= pre[..., 3:]).all()
    assert pre.max() <= 1.0
    values = np.linspace(-3.0, 9.0, n)
    rng = np.random.default_rng(1)
    pairs = [*rng.integers(0, n, (12, 2)), (86, 129), (129, 86), (128, 129), (130, 129), (86, 87), (86, 85), (215, 214),
             (257, 258), (0, 258), (258, 0)]  # fmt: skip
    for front, back in pairs:
        expected = step_of(transfer, values[front], values[back], step)
        np.testing.assert_allclose(pre[front, back], expected, atol=2e-5)


def test_preintegration_of_one_value_and_of_one_colour():
    rgba = table(9)
    transfer = Transfer(rgba, (0.0, 1.0))
    pre = transfer.preintegrated(3.0)
    values = np.linspace(0.0, 1.0, len(pre))
    diagonal = pre[np.arange(len(pre)), np.arange(len(pre))]
    alpha = 1.0 - (1.0 - transfer.lookup(values)[:, 3]) ** 3
    np.testing.assert_allclose(diagonal[:, 3], alpha, atol=1e-6)
    np.testing.assert_allclose(diagonal[:, :3], alpha[:, None] * transfer.colour(values), atol=1e-6)
    rgba[:, :3] = (0.2, 0.5, 1.0)
    one = Transfer(rgba, (0.0, 1.0)).preintegrated(3.0)
    np.testing.assert_allclose(one[..., :3], one[..., 3:] * np.float32([0.2, 0.5, 1.0]), atol=1e-6)
    np.testing.assert_allclose(one[..., 3], one[..., 3].T, atol=1e-6)  # opacity is the same both ways


def test_for_a_volume():
    volume = RaycastVolume(np.arange(8, dtype=np.int16).reshape(2, 2, 2), np.diag([1.0, 2.0, 6.0, 1.0]))
    transfer = Transfer.over(volume, table(3))
    assert (transfer.clim, transfer.unit) == ((0.0, 7.0), 3.0)
    assert Transfer.over(volume, table(3), (1, 2), 5).unit == 5.0
    for value in (0.0, -4.0, 1e30):
        constant = RaycastVolume(np.full((2, 2, 2), value, np.float32))
        transfer = Transfer.over(constant, table(3))
        np.testing.assert_allclose(transfer.lookup(constant.values[0, 0, 0]), transfer.table[0])


@pytest.mark.parametrize(
    ("arguments", "message"),
    [((np.zeros((1, 4)), (0, 1)), r"shape \(1, 4\); expected \(k, 4\) RGBA, k >= 2"),
     ((np.zeros((4, 3)), (0, 1)), r"shape \(4, 3\)"),
     (([[0, 0, 0, 0], [0, 0, 0, 1.2]], (0, 1)), "A of entry 1 is 1.2; expected 0 to 1"),
     (([[0, 0, 0, 0], [0, -0.1, 0, 1]], (0, 1)), "G of entry 1 is -0.1"),
     (([[np.nan, 0, 0, 0], [0, 0, 0, 1]], (0, 1)), "R of entry 0 is nan"),
     ((np.zeros((2, 4)), (1, 0)), r"clim=\(1.0, 0.0\); expected two finite numbers, the lower one first"),
     ((np.zeros((2, 4)), (1, 1)), "clim="), ((np.zeros((2, 4)), (0, np.nan)), "clim="),
     ((np.zeros((2, 4)), (0, 1), 0.0), "the unit of opacity is 0 mm"),
     ((np.zeros((2, 4)), (0, 1), np.inf), "the unit of opacity is inf mm")],
)  # fmt: skip
def test_bad_tables(arguments, message):
    with pytest.raises(ValueError, match=message):
        Transfer(*arguments)


def test_bad_steps():
    for step in (0.0, -1.0, np.nan, np.inf):
        with pytest.raises(ValueError, match="expected a finite length above 0"):
            Transfer(table(2), (0, 1)).preintegrated(step)
    with pytest.raises(ValueError, match="has 1025 entries; tables of up to 1024 can be pre-integrated"):
        Transfer(table(1025), (0, 1)).preintegrated(1.0)
