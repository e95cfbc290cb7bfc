"""Volumes from images and arrays: the right number at the right place, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv

from pvfiblets.volumes import as_raycast_volume

from .small_volume import AFFINE, AXES, ORIGIN, SHAPE, SPACING, VALUES, assert_is_the_volume, image

# Images of VTK


def test_an_image_lies_where_its_points_are():
    grid = image()
    volume = as_raycast_volume(grid)
    assert_is_the_volume(volume, "ct")
    assert volume.values.dtype == np.int16
    assert np.shares_memory(volume.values, grid["ct"])
    voxels = np.stack(np.meshgrid(*[np.arange(n) for n in SHAPE], indexing="ij"), -1).reshape(-1, 3, order="F")
    np.testing.assert_allclose(voxels @ volume.affine[:3, :3].T + volume.affine[:3, 3], grid.points, atol=1e-5)
    np.testing.assert_allclose(volume.bounds, grid.bounds, atol=1e-5)


def test_an_extent_that_begins_elsewhere():
    part = image().extract_subset([1, 2, 0, 3, 2, 4])
    part.offset = (5, -2, 1)
    volume = as_raycast_volume(part)
    np.testing.assert_array_equal(volume.values, part["ct"].reshape(part.dimensions, order="F"))
    np.testing.assert_allclose(volume.affine[:3, 3], part.points[0], atol=1e-5)
    np.testing.assert_allclose(volume.bounds, part.bounds, atol=1e-5)


def test_a_plain_image_of_vtk():
    from vtkmodules.vtkCommonDataModel import vtkImageData

    plain = vtkImageData()
    plain.ShallowCopy(image())
    plain.GetPointData().SetActiveScalars("ct")
    assert_is_the_volume(as_raycast_volume(plain))
    only = vtkImageData()
    only.CopyStructure(plain)
    only.GetPointData().AddArray(plain.GetPointData().GetArray("ct"))
    assert only.GetPointData().GetScalars() is None
    assert_is_the_volume(as_raycast_volume(only))


def test_arrays_are_chosen():
    grid = image(other=np.arange(60, dtype=np.float32))
    grid.set_active_scalars("ct")
    assert as_raycast_volume(grid).name == "ct"
    other = as_raycast_volume(grid, scalars="other")
    np.testing.assert_array_equal(other.values.ravel(order="F"), np.arange(60))
    given = as_raycast_volume(grid, scalars=np.arange(60)[::-1])
    np.testing.assert_array_equal(given.values.ravel(order="F"), np.arange(60)[::-1])


def test_cells_become_points_as_in_add_volume():
    grid = pv.ImageData(dimensions=(4, 5, 6), spacing=(1, 2, 3), origin=(7, 8, 9))
    grid.cell_data["fa"] = np.random.default_rng(0).random(grid.n_cells)
    expected = grid.cell_data_to_point_data()["fa"].reshape(4, 5, 6, order="F")
    for scalars in (None, "fa", grid.cell_data["fa"]):
        volume = as_raycast_volume(grid, scalars=scalars)
        np.testing.assert_allclose(volume.values, expected, rtol=1e-6)
        np.testing.assert_allclose(volume.bounds, grid.bounds)


def test_active_cells_are_taken_before_points():
    grid = image()
    grid.cell_data["fa"] = np.ones(grid.n_cells)
    grid.set_active_scalars("fa", preference="cell")
    np.testing.assert_array_equal(as_raycast_volume(grid).values, 1.0)


@pytest.mark.parametrize(
    ("make", "error", "message"),
    [
        (lambda: pv.ImageData(dimensions=SHAPE), ValueError, r"no active scalars among its arrays \[\]"),
        (lambda: pv.ImageData(dimensions=(4, 4, 1)), ValueError, "no active scalars"),
        (pv.Sphere, TypeError, "cannot be cast through a PolyData; sample it on a grid first"),
        (lambda: pv.StructuredGrid(np.eye(3), np.eye(3), np.eye(3)), TypeError, "cast through a StructuredGrid"),
        (lambda: pv.MultiBlock([image()]), TypeError, "a MultiBlock is no grid"),
    ],
)  # fmt: skip
def test_images_that_are_no_volumes(make, error, message):
    with pytest.raises(error, match=message):
        as_raycast_volume(make())


def test_arrays_that_are_not_there():
    with pytest.raises(ValueError, match=r"no array 'fa' of numbers among its arrays \['ct'\]; choose one by scalars="):
        as_raycast_volume(image(), scalars="fa")
    with pytest.raises(
        ValueError, match=r"shape \(7,\); expected one number for each of the image's 60 points or 24 cells"
    ):
        as_raycast_volume(image(), scalars=np.zeros(7))
    with pytest.raises(ValueError, match="scalars='fa' chooses among the arrays of a VTK image; leave it out"):
        as_raycast_volume(VALUES, scalars="fa")
    with pytest.raises(ValueError, match="'rgb' has 3 numbers per voxel, RGB colours perhaps; one is needed"):
        as_raycast_volume(image(rgb=np.zeros((60, 3), np.uint8)), scalars="rgb")


# Arrays, and places that are given


def test_arrays():
    volume = as_raycast_volume(VALUES)
    assert np.shares_memory(volume.values, VALUES)
    np.testing.assert_array_equal(volume.affine, np.eye(4))
    assert_is_the_volume(as_raycast_volume(VALUES, affine=AFFINE))
    assert_is_the_volume(as_raycast_volume((VALUES, AFFINE)))
    assert_is_the_volume(as_raycast_volume(VALUES[..., None], spacing=SPACING, origin=ORIGIN, direction=AXES))
    assert_is_the_volume(as_raycast_volume(VALUES, spacing=SPACING, origin=ORIGIN, direction=AXES.ravel()))
    assert_is_the_volume(as_raycast_volume(VALUES.tolist(), affine=AFFINE))
    np.testing.assert_array_equal(as_raycast_volume(VALUES, spacing=2).spacing, 2.0)


def test_masked_voxels_are_missing():
    masked = np.ma.masked_less(VALUES, 0)
    volume = as_raycast_volume(masked)
    np.testing.assert_array_equal(volume.missing, VALUES < 0)
    assert volume.value_range[0] == VALUES[VALUES >= 0].min()


def test_what_is_given_takes_the_place_of_the_sources():
    grid = image()
    np.testing.assert_allclose(as_raycast_volume(grid, affine=np.eye(4)).affine, np.eye(4))
    spaced = as_raycast_volume(grid, spacing=(1, 2, 3))
    np.testing.assert_allclose(spaced.spacing, (1, 2, 3))
    np.testing.assert_allclose(spaced.affine[:3, :3] / (1, 2, 3), AXES)
    moved = as_raycast_volume(as_raycast_volume(grid), origin=(0, 0, 1))
    np.testing.assert_allclose(moved.affine[:3, 3], (0, 0, 1))
    np.testing.assert_allclose(moved.affine[:3, :3], AFFINE[:3, :3])
    missing = np.where(VALUES > 250, np.nan, VALUES)
    kept = as_raycast_volume(as_raycast_volume(missing), spacing=3.0)
    np.testing.assert_array_equal(kept.missing, VALUES > 250)
    volume = as_raycast_volume(VALUES)
    assert as_raycast_volume(volume) is volume


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"spacing": (1, 0, 1)}, r"spacing=\(1, 0, 1\); expected one or three finite lengths above 0"),
        ({"spacing": (1, 1)}, "spacing="),
        ({"spacing": np.nan}, "spacing=nan"),
        ({"origin": (1, 1)}, r"origin=\(1, 1\); expected three finite coordinates"),
        ({"direction": np.eye(2)}, "expected a finite"),
        ({"direction": 2 * np.eye(3)}, r"have the lengths \[2.0, 2.0, 2.0\]; expected 1: lengths belong into spacing"),
        ({"direction": np.eye(3)[[0, 0, 1]]}, "lengths"),
        ({"direction": [[1, 1, 0], [0, 0, 0], [0, 0, 1]]}, "flattens space"),
        ({"affine": np.eye(4), "spacing": 1}, "affine says spacing, origin and direction too; give either"),
        ({"affine": np.zeros((4, 4))}, "ends in the row"),
        ({"shape": SHAPE}, "shape and dtype are of files of bare numbers, such as .raw; leave them out"),
    ],
)
def test_bad_places(given, message):
    with pytest.raises(ValueError, match=message):
        as_raycast_volume(VALUES, **given)


@pytest.mark.parametrize(
    ("source", "error", "message"),
    [
        (
            np.zeros((4, 4, 4, 3)),
            ValueError,
            r"\(4, 4, 4, 3\), as RGB colours have; three axes .* such as image\[..., 0\]",
        ),
        (np.zeros((4, 4)), ValueError, r"the shape \(4, 4\); three axes \(nx, ny, nz\)"),
        ([[1, 2], [3]], ValueError, "rows are of unlike lengths"),
        (5, TypeError, "cannot be cast through a int; give a pyvista.ImageData"),
        ({"a": 1}, TypeError, "cannot be cast through a dict"),
    ],
)
def test_bad_sources(source, error, message):
    with pytest.raises(error, match=message):
        as_raycast_volume(source)


def test_smoothing_comes_last():
    values = VALUES.astype(float)
    values[1, 1, 1] = np.nan
    volume = as_raycast_volume(values, smooth=1.0, spacing=2.0)
    in_mm = as_raycast_volume(values, smooth=2.0, smooth_unit="mm", spacing=2.0)
    np.testing.assert_array_equal(volume.values, in_mm.values)
    assert volume.n_missing == 1
    assert np.ptp(volume.values) < 0.8 * np.ptp(VALUES)
