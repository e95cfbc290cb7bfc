"""Gaussian smoothing against sums written out, with and without missing voxels."""

from __future__ import annotations

import hypothesis
import numpy as np
import pytest
from hypothesis import strategies as st

from pvfiblets.volumes import RaycastVolume, smoothed
from pvfiblets.volumes.smoothing import gaussian


def matrix(n, sigma):
    """(n, n): what smoothing along an axis of n voxels is, float64."""
    out = np.eye(n)
    if sigma > 0:
        reach = max(int(4 * sigma + 0.5), 1)
        offsets = np.arange(-reach, reach + 1)
        with np.errstate(over="ignore"):
            weights = np.exp(-(offsets**2) / (2.0 * sigma**2))
        out = np.zeros((n, n))
        for i in range(n):
            np.add.at(out[i], np.clip(i + offsets, 0, n - 1), weights / weights.sum())
    return out


def expected(values, sigma):
    along = [matrix(n, s) for n, s in zip(values.shape, np.broadcast_to(sigma, 3), strict=True)]
    known = ~np.isnan(values.astype(float))
    total = np.einsum("ai,bj,ck,ijk->abc", *along, np.where(known, values, 0).astype(float), optimize=True)
    weight = np.einsum("ai,bj,ck,ijk->abc", *along, known.astype(float), optimize=True)
    return np.where(known, total / np.maximum(weight, 1e-300), np.nan)


@hypothesis.given(
    shape=st.tuples(*[st.integers(2, 15)] * 3), sigma=st.tuples(*[st.sampled_from([0.0, 0.3, 1.0, 2.7])] * 3),
    order=st.sampled_from("CF"), dtype=st.sampled_from([np.uint8, np.int16, np.float32]), seed=st.integers(0, 99),
    missing=st.sampled_from([0.0, 0.3]),
)  # fmt: skip
def test_sums_written_out(shape, sigma, order, dtype, seed, missing):
    rng = np.random.default_rng(seed)
    values = np.asarray(rng.normal(100, 40, shape).clip(0, 255), dtype, order=order)
    if dtype == np.float32:
        values[rng.random(shape) < missing] = np.nan
    before = values.copy()
    got = gaussian(values, sigma)
    assert got.dtype == np.float32
    np.testing.assert_allclose(got, expected(values, sigma), rtol=1e-5, atol=1e-4)
    np.testing.assert_array_equal(values, before)


def test_rows_longer_than_a_strip():
    values = np.random.default_rng(0).normal(size=(3, 40, 30)).astype(np.float32)
    np.testing.assert_allclose(gaussian(values, (0.8, 1.2, 0.5)), expected(values, (0.8, 1.2, 0.5)), atol=1e-5)


def test_a_gaussian_becomes_a_wider_one():
    x = np.indices((41, 41, 41)) - 20.0
    square = (x**2).sum(axis=0)
    values = np.exp(-square / (2 * 3.0**2)).astype(np.float32)
    got = gaussian(values, 2.0)
    variance = 3.0**2 + 2.0**2
    np.testing.assert_allclose(got, (9.0 / variance) ** 1.5 * np.exp(-square / (2 * variance)), atol=2e-4)


def test_in_mm_each_axis_has_its_own_spacing():
    values = np.random.default_rng(0).integers(0, 255, (9, 10, 11), np.uint8)
    affine = np.array([[0, 2.0, 0, 5], [-0.5, 0, 0, 6], [0, 0, 4.0, 7], [0, 0, 0, 1]])
    volume = RaycastVolume(values, affine, name="ct")
    got = smoothed(volume, 2.0, "mm")
    np.testing.assert_allclose(got.values, expected(values, (4.0, 1.0, 0.5)), atol=1e-3)
    np.testing.assert_array_equal(got.affine, affine)
    assert got.name == "ct"


def test_missing_voxels_of_a_volume_stay_missing():
    values = np.random.default_rng(0).normal(size=(8, 8, 8)).astype(np.float32)
    values[2:5, 3, 4:] = np.nan
    got = smoothed(RaycastVolume(values), 1.0)
    np.testing.assert_array_equal(got.missing, np.isnan(values))
    known = ~np.isnan(values)
    np.testing.assert_allclose(got.values[known], expected(values, 1.0)[known], atol=1e-5)
    everywhere = smoothed(RaycastVolume(np.full((3, 3, 3), np.nan)), 1.0)
    assert everywhere.n_missing == 27


def test_nothing_to_do():
    volume = RaycastVolume(np.zeros((2, 2, 2), np.uint8))
    assert smoothed(volume, (0, 0, 0)) is volume
    tiny = gaussian(np.arange(8, dtype=np.float32).reshape(2, 2, 2), 1e-200)
    np.testing.assert_array_equal(tiny.ravel(), np.arange(8))


@pytest.mark.parametrize("sigma", [-1.0, np.nan, np.inf, (1.0, 2.0)])
def test_bad_deviations(sigma):
    with pytest.raises(ValueError, match="expected one or three finite numbers, 0 or above"):
        smoothed(RaycastVolume(np.zeros((2, 2, 2))), sigma)


def test_bad_units():
    with pytest.raises(ValueError, match="the unit of sigma is 'cm'; choose 'voxels' or 'mm'"):
        smoothed(RaycastVolume(np.zeros((2, 2, 2))), 1.0, "cm")
