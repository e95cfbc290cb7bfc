"""An image may stand in every form wherever one is taken, and has the same numbers at the same places."""

from __future__ import annotations

import nibabel as nib
import numpy as np
import pytest
import pyvista as pv
from scipy.ndimage import map_coordinates

from pvfiblets import bundles, compress, connectome, density, read_volume, regions
from pvfiblets.errors import FormatError
from pvfiblets.images.image import Image
from pvfiblets.images.sources import as_image, is_image
from pvfiblets.plotting.fiblets.sources import as_volume
from pvfiblets.plotting.filtering.region_sources import as_region
from pvfiblets.query.density.voxel_grid import grid_like
from pvfiblets.query.painting.painter import RegionPainter
from pvfiblets.query.regions.region_text import parse_region
from pvfiblets.slices.image import as_slice_image
from pvfiblets.streamlines import Streamlines
from pvfiblets.volumes import RaycastVolume, as_raycast_volume
from tests.images.test_image_files import mif
from tests.volumes.test_source_files import metaimage, nrrd

SHAPE = (7, 6, 5)
VALUES = np.random.default_rng(0).integers(0, 4, SHAPE).astype(np.int16)
TURN = np.linalg.qr(np.random.default_rng(4).normal(size=(3, 3)))[0]
AFFINE = np.eye(4)
AFFINE[:3, :3], AFFINE[:3, 3] = TURN * (2.0, 1.5, 3.0), (-3.0, 4.0, 5.0)
FORMS = ("nii", "nii.gz", "mgz", "mif", "mif.gz", "nrrd", "mha", "vti", "pair", "nibabel", "ImageData", "cells",
         "raycast", "slices")  # fmt: skip


def in_form(form, folder):
    """Return the image in one of its forms."""
    path = folder / f"lab.{form}"
    if form in ("nii", "nii.gz"):
        nib.save(nib.Nifti1Image(VALUES, AFFINE), path)
    elif form == "mgz":
        nib.save(nib.MGHImage(VALUES, AFFINE), path)
    elif form.startswith("mif"):
        mif(path, VALUES.astype("<i2"), "-0,+2,+1", "Int16LE", np.column_stack([TURN, AFFINE[:3, 3]]))
    elif form == "nrrd":
        nrrd(path, VALUES, affine=AFFINE)
    elif form == "mha":
        metaimage(path, values=VALUES, affine=AFFINE)
    else:
        return _in_memory(form, path)
    return path


def _in_memory(form, path):
    grid = pv.ImageData(dimensions=SHAPE, spacing=(2.0, 1.5, 3.0), origin=AFFINE[:3, 3], direction_matrix=TURN)
    grid["v"] = VALUES.ravel(order="F")
    if form == "vti":
        grid.save(path)
        return path
    if form == "cells":
        corner = AFFINE[:3, 3] - 0.5 * AFFINE[:3, :3].sum(axis=1)
        grid = pv.ImageData(dimensions=np.add(SHAPE, 1), spacing=(2.0, 1.5, 3.0), origin=corner, direction_matrix=TURN)
        grid.cell_data["v"] = VALUES.ravel(order="F")
    return {
        "pair": (VALUES, AFFINE), "nibabel": nib.Nifti1Image(VALUES, AFFINE), "ImageData": grid, "cells": grid,
        "raycast": RaycastVolume(VALUES, AFFINE), "slices": as_slice_image((VALUES, AFFINE)),
    }[form]  # fmt: skip


@pytest.fixture(scope="module")
def lines():
    rng = np.random.default_rng(3)
    voxels = [np.cumsum(rng.normal(0, 0.4, (20, 3)), axis=0) + (3, 2.5, 2) for _ in range(20)]
    return Streamlines.from_list([v @ AFFINE[:3, :3].T + AFFINE[:3, 3] for v in voxels])


@pytest.mark.few(4)
@pytest.mark.parametrize("form", FORMS)
def test_every_form_is_taken_wherever_an_image_is(tmp_path, lines, form):
    given = in_form(form, tmp_path)
    assert is_image(given)
    image = as_image(given)
    np.testing.assert_array_equal(image.single, VALUES)
    np.testing.assert_allclose(image.affine, AFFINE, atol=1e-5)
    np.testing.assert_array_equal(as_volume(given).values, VALUES)
    np.testing.assert_array_equal(as_slice_image(given).values[..., 0], VALUES)
    assert as_raycast_volume(given).n_points in (VALUES.size, np.prod(np.add(SHAPE, 1)))
    np.testing.assert_allclose(grid_like(given).affine, AFFINE, atol=1e-5)
    assert RegionPainter(given).labels.shape == SHAPE
    inside = as_region(given).contains(lines.points)
    np.testing.assert_array_equal(inside, regions.Labels(VALUES, AFFINE).contains(lines.points))
    fiblets = compress(lines, exact=True)
    np.testing.assert_array_equal(connectome(fiblets, given).matrix, connectome(fiblets, (VALUES, AFFINE)).matrix)
    assert fiblets.end_parcels(given).tolist() == fiblets.end_parcels((VALUES, AFFINE)).tolist()
    np.testing.assert_array_equal(density(fiblets, like=given).values, density(fiblets, like=(SHAPE, AFFINE)).values)
    wanted = bundles.bundle_table(lines, {"all": slice(None)}, images={"x": (VALUES, AFFINE)}, like=given)
    table = bundles.bundle_table(lines, {"all": slice(None)}, images={"x": given}, like=given)
    np.testing.assert_allclose(table["mean_x"], wanted["mean_x"], rtol=1e-5)
    if isinstance(given, type(tmp_path)):
        np.testing.assert_array_equal(read_volume(given).active_scalars, VALUES.ravel(order="F"))
        part = parse_region(f"{given}:2").contains(lines.points)
        np.testing.assert_array_equal(part, regions.Labels(VALUES, AFFINE, 2).contains(lines.points))
        np.testing.assert_array_equal(RegionPainter.open(given).labels, VALUES)


@pytest.mark.parametrize("nearest", [False, True])
def test_values_at_points_are_those_of_scipy(nearest):
    values = np.random.default_rng(1).normal(size=SHAPE)
    image = as_image((values, AFFINE))
    voxels = np.random.default_rng(2).uniform(-1.0, np.array(SHAPE), (500, 3))
    found = image.at(voxels @ AFFINE[:3, :3].T + AFFINE[:3, 3], nearest=nearest)
    wanted = map_coordinates(values, voxels.T, order=0 if nearest else 1, mode="nearest")
    inside = ((voxels >= -0.5) & (voxels <= np.array(SHAPE) - 0.5)).all(axis=1)
    np.testing.assert_array_equal(np.isnan(found), ~inside)
    np.testing.assert_allclose(found[inside], wanted[inside], atol=1e-12)


def test_only_the_header_is_read_where_only_the_grid_is_needed(tmp_path):
    nib.save(nib.Nifti1Image(np.zeros((20, 20, 20, 3), np.float32), AFFINE), tmp_path / "a.nii")
    whole = (tmp_path / "a.nii").read_bytes()
    image = as_image(tmp_path / "a.nii")
    (tmp_path / "a.nii").write_bytes(whole[:400])
    assert grid_like(image).shape == (20, 20, 20)
    with pytest.raises(ValueError, match=r"a.nii has the shape \(20, 20, 20, 3\)"):  # before anything is read
        _ = image.single
    with pytest.raises(FormatError, match="what nibabel cannot read"):
        _ = image.values


def test_volumes_that_rays_are_cast_through_keep_their_numbers():
    values = 1e8 + np.arange(np.prod(SHAPE), dtype=np.float64).reshape(SHAPE)
    values[1, 1, 1] = np.nan
    np.testing.assert_array_equal(as_image(RaycastVolume(values, AFFINE)).single, values)
    masked = np.ma.masked_equal(VALUES, 3)
    np.testing.assert_array_equal(np.isnan(as_image((masked, AFFINE)).single), VALUES == 3)


@pytest.mark.parametrize(
    ("given", "error", "message"),
    [
        (5, TypeError, r"the atlas is a int; give the path of an image \(.nii, .*\), an image of nibabel, \(array,"),
        ((VALUES, np.eye(3)), ValueError, r"the affine of the atlas is .*; give a finite \(4, 4\) matrix"),
        ((VALUES, "here"), ValueError, r"the affine of the atlas is here; give a finite \(4, 4\) matrix"),
        ("brain.trk", FileNotFoundError, "brain.trk"),
        ((VALUES[0], AFFINE), ValueError, r"the atlas has the shape \(6, 5\); three axes \(nx, ny, nz\)"),
        ((VALUES + 0.5, AFFINE), ValueError, "the atlas holds fractions, not labels; compare it first"),
        ((np.full(SHAPE, 1j), AFFINE), ValueError, r"the atlas is of type complex128; give real numbers"),
        (nib.Nifti1Image(VALUES, None), ValueError, r"the atlas has no affine; give \(array, affine\)"),
        (pv.ImageData(dimensions=SHAPE), ValueError, r"no active scalars among its arrays \[\]; choose one by set_a"),
    ],
)
def test_what_is_no_image_of_labels_is_refused(given, error, message):
    with pytest.raises(error, match=message):
        _ = as_image(given, "the atlas").labels


def test_nan_is_no_label():
    values = VALUES.astype(float)
    values[VALUES == 0] = np.nan
    np.testing.assert_array_equal(as_image((values, AFFINE)).labels, VALUES)
    assert not is_image(([1, 2], [3, 4]))
    assert not is_image("fa")
    assert is_image(Image(SHAPE, AFFINE, lambda: VALUES))
