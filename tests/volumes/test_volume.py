"""What a volume keeps, what it refuses, and where it lies."""

from __future__ import annotations

import numpy as np
import pytest

from pvfiblets.volumes import RaycastVolume


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


def test_a_constant_volume():
    assert RaycastVolume(np.full((2, 2, 2), -3, np.int16)).value_range == (-3.0, -3.0)


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


def test_the_affine_is_its_own():
    affine = np.diag([2.0, 2.0, 2.0, 1.0])
    volume = RaycastVolume(numbers(), affine)
    affine[0, 0] = 7.0
    assert volume.spacing.tolist() == [2.0, 2.0, 2.0]
    with pytest.raises(ValueError, match="read-only"):
        volume.affine[0, 0] = 3.0


@pytest.mark.parametrize("spacing", [1e-6, 1e6])
def test_extreme_spacings(spacing):
    volume = RaycastVolume(numbers(), np.diag([spacing, spacing, 3.0, 1.0]))
    np.testing.assert_allclose(volume.spacing, [spacing, spacing, 3.0])


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
    [
        (np.eye(3), "give a finite \\(4, 4\\) matrix"),
        (np.diag([1, 1, np.nan, 1]), "give a finite \\(4, 4\\) matrix"),
        (np.ones((4, 4)), "ends in the row \\(0, 0, 0, 1\\)"),
        (np.diag([1.0, 0.0, 1.0, 1.0]), "flattens space \\(spacing \\[1.0, 0.0, 1.0\\] mm\\)"),
        ([[1, 2, 0, 0], [2, 4, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]], "flattens space"),
    ],
)
def test_what_is_no_place(affine, message):
    with pytest.raises(ValueError, match=message):
        RaycastVolume(numbers(), affine)
