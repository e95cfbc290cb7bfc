"""What a volume keeps, what it refuses, where it lies, and Gaussian smoothing against sums written out."""

from __future__ import annotations

import hypothesis
import numpy as np
import pytest
from hypothesis import strategies as st

from pvfiblets.volumes import RaycastVolume, smoothed
from pvfiblets.volumes.smoothing import gaussian


def numbers(shape=(3, 4, 5), dtype=np.uint8):
    return np.arange(np.prod(shape)).reshape(shape).astype(dtype)


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16, np.int16, np.float32])
def test_types_that_are_kept_are_not_copied(dtype):
    values = np.asfortranarray(numbers(dtype=dtype))
    volume = RaycastVolume(values)
    assert volume.values.dtype == dtype
    assert np.shares_memory(volume.values, values)
    assert volume.value_range == (0.0, 59.0)
    assert volume.n_missing == 0


@pytest.mark.parametrize(
    ("dtype", "kept"),
    [(bool, np.uint8), (np.int8, np.int16), (np.float16, np.float32), (np.int32, np.float32), (np.uint32, np.float32),
     (np.int64, np.float32), (np.uint64, np.float32), (np.float64, np.float32), (">i2", np.int16), (">f4", np.float32)],
)  # fmt: skip
def test_other_types_become_one_that_holds_them(dtype, kept):
    values = numbers(dtype=dtype)
    volume = RaycastVolume(values)
    assert volume.values.dtype == kept
    assert volume.values.dtype.isnative
    np.testing.assert_array_equal(volume.values, values)


def test_a_memory_map_stays_one(tmp_path):
    numbers().tofile(tmp_path / "v.raw")
    mapped = np.memmap(tmp_path / "v.raw", np.uint8, "r", 0, (3, 4, 5))
    volume = RaycastVolume(mapped)
    assert np.shares_memory(volume.values, mapped)
    assert not volume.values.flags.writeable


def test_missing_is_least_and_infinite_is_the_nearest_finite():
    values = numbers(dtype=np.float64) - 7.0
    values[0, 0, 0], values[1, 1, 1], values[2, 2, 2], values[2, 3, 4] = np.nan, np.inf, -np.inf, np.nan
    volume = RaycastVolume(values)
    finite = values[np.isfinite(values)]
    assert volume.value_range == (finite.min(), finite.max())
    assert volume.n_missing == 2
    np.testing.assert_array_equal(volume.missing, np.isnan(values))
    expected = np.where(np.isposinf(values), finite.max(), np.where(np.isfinite(values), values, finite.min()))
    np.testing.assert_array_equal(volume.values, expected.astype(np.float32))
    assert np.isnan(values[0, 0, 0])  # the array that was given is as it was


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_without_any_finite_value(value):
    volume = RaycastVolume(np.full((2, 3, 4), value))
    assert volume.value_range == (0.0, 0.0)
    assert volume.n_missing == (24 if np.isnan(value) else 0)
    np.testing.assert_array_equal(volume.values, 0.0)


def test_where_it_lies():
    rng = np.random.default_rng(4)
    affine = np.eye(4)
    affine[:3] = rng.normal(size=(3, 4)) * 5.0 + 1e6
    volume = RaycastVolume(numbers(), affine, name="t1")
    assert volume.shape == volume.dims == (3, 4, 5)
    assert (volume.n_points, volume.n_streamlines, volume.promise, volume.name) == (60, 1, 0.0, "t1")
    voxels = np.stack(np.meshgrid(*[np.arange(n) for n in volume.shape], indexing="ij"), -1).reshape(-1, 3)
    mm = np.array([affine[:3, :3] @ voxel + affine[:3, 3] for voxel in voxels])
    np.testing.assert_allclose(np.reshape(volume.bounds, (3, 2)), np.stack([mm.min(0), mm.max(0)], 1), rtol=1e-15)
    np.testing.assert_allclose(volume.spacing, [np.sqrt((affine[:3, i] ** 2).sum()) for i in range(3)])
    np.testing.assert_allclose(volume.inverse @ affine, np.eye(4), atol=1e-3)  # 10^6 mm away
    affine[0, 0] += 7.0  # its own is a copy
    assert volume.affine[0, 0] == affine[0, 0] - 7.0
    with pytest.raises(ValueError, match="read-only"):
        volume.affine[0, 0] = 3.0


@pytest.mark.parametrize(
    ("values", "message"),
    [
        (np.zeros((4, 4)), r"shape \(4, 4\); give three axes"),
        (np.zeros((4, 4, 4, 3)), r"shape \(4, 4, 4, 3\); give three axes \(nx, ny, nz\), such as image\[..., 0\]"),
        (np.zeros((4, 1, 4)), "a 2-D image; rays need two voxels or more along each axis"),
        (np.zeros((4, 0, 4)), "no voxels"),
        (np.zeros((4, 4, 4), complex), "of type complex128; give bool, integers or floats"),
        (np.zeros((4, 4, 4), [("R", "u1"), ("G", "u1")]), "hold the fields R, G; one number each is needed"),
        (np.full((2, 2, 2), "a"), "of type <U1"),
        (np.full((2, 2, 2), 1e39), "from 1e\\+39 to 1e\\+39, beyond float32's 3.40282e\\+38: scale them"),
    ],
)
def test_what_is_no_volume(values, message):
    with pytest.raises(ValueError, match=message):
        RaycastVolume(values)


@pytest.mark.parametrize(
    ("affine", "message"),
    [(np.eye(3), "give a finite \\(4, 4\\) matrix"), (np.diag([1, 1, np.nan, 1]), "give a finite \\(4, 4\\) matrix"),
     (np.ones((4, 4)), "ends in the row \\(0, 0, 0, 1\\)"),
     (np.diag([1.0, 0.0, 1.0, 1.0]), "flattens space \\(spacing \\[1.0, 0.0, 1.0\\] mm\\)"),
     ([[1, 2, 0, 0], [2, 4, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]], "flattens space")],
)  # fmt: skip
def test_what_is_no_place(affine, message):
    with pytest.raises(ValueError, match=message):
        RaycastVolume(numbers(), affine)


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


def test_bad_deviations():
    for sigma in (-1.0, np.nan, np.inf, (1.0, 2.0)):
        with pytest.raises(ValueError, match="expected one or three finite numbers, 0 or above"):
            smoothed(RaycastVolume(np.zeros((2, 2, 2))), sigma)
    with pytest.raises(ValueError, match="the unit of sigma is 'cm'; choose 'voxels' or 'mm'"):
        smoothed(RaycastVolume(np.zeros((2, 2, 2))), 1.0, "cm")
