"""Glyphs against dipy's harmonics and NumPy's eigenvectors."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
from dipy.core.sphere import Sphere
from dipy.reconst.shm import sh_to_sf

from pvfiblets.slices import glyphs
from pvfiblets.slices.image import SliceImage
from pvfiblets.slices.spherical_harmonics import degrees, sh_matrix

AFFINE = np.array([[2.0, 0.5, 0.0, -5.0], [0.0, 2.5, 0.3, 4.0], [0.1, 0.0, 3.0, 9.0], [0.0, 0.0, 0.0, 1.0]])
RNG = np.random.default_rng(0)
DIRECTIONS = RNG.normal(size=(60, 3))
DIRECTIONS /= np.linalg.norm(DIRECTIONS, axis=1, keepdims=True)


@pytest.mark.parametrize(("basis", "dipys", "legacy"), [
    ("mrtrix", "tournier07", False), ("tournier07_legacy", "tournier07", True),
    ("descoteaux07", "descoteaux07", False), ("descoteaux07_legacy", "descoteaux07", True),
])  # fmt: skip
@pytest.mark.parametrize(("degree", "full"), [(0, False), (4, False), (12, False), (5, True)])
def test_harmonics_are_dipys(basis, dipys, legacy, degree, full):
    n = (degree + 1) ** 2 if full else (degree + 1) * (degree + 2) // 2
    coefficients = RNG.normal(size=(7, n))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PendingDeprecationWarning)
        wanted = sh_to_sf(coefficients, Sphere(xyz=DIRECTIONS), sh_order_max=degree, basis_type=dipys,
                          full_basis=full, legacy=legacy)  # fmt: skip
    assert degrees(n, full) == degree
    with pytest.raises(ValueError, match="7 numbers per voxel"):
        degrees(7, False)
    with pytest.raises(ValueError, match="basis is"):
        sh_matrix(DIRECTIONS, 2, "fsl")
    np.testing.assert_allclose(coefficients @ sh_matrix(DIRECTIONS, degree, basis, full).T, wanted, atol=1e-9)


def test_lobes_reach_as_far_as_the_function():
    values = RNG.normal(size=(2, 3, 4, 15))
    image = SliceImage(values, AFFINE)
    voxels = np.array([[0, 1, 2], [1, 2, 3]])
    found = glyphs.lobes(image, voxels, DIRECTIONS, 1.0, True, "mrtrix", False)
    middle = voxels @ AFFINE[:3, :3].T + AFFINE[:3, 3]
    out = np.linalg.norm(found.points - middle[:, None], axis=-1)
    sphere = Sphere(xyz=DIRECTIONS)
    sf = sh_to_sf(values[tuple(voxels.T)], sphere, sh_order_max=4, basis_type="tournier07", legacy=False)
    half = 0.5 * np.linalg.norm(AFFINE[:3, :3], axis=0).min()
    np.testing.assert_allclose(out, half * np.maximum(sf, 0) / sf.max(axis=1, keepdims=True), atol=1e-9)


@pytest.mark.parametrize("tensor", ["mrtrix", "dipy", "fsl"])
def test_ellipsoids_have_the_eigenvectors_as_axes(tensor):
    turn = np.linalg.qr(RNG.normal(size=(3, 3)))[0]
    own = np.array([0.3, 0.5, 1.7])
    matrix = turn @ np.diag(own) @ turn.T
    parts = {"mrtrix": [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)],
             "dipy": [(0, 0), (0, 1), (1, 1), (0, 2), (1, 2), (2, 2)],
             "fsl": [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)]}[tensor]  # fmt: skip
    image = SliceImage(np.array([matrix[one] for one in parts]).reshape(1, 1, 1, 6), np.diag([2.0, 2.0, 2.0, 1.0]))
    found = glyphs.ellipsoids(image, np.zeros((1, 3), int), turn.T, 1.0, True, tensor)
    np.testing.assert_allclose(abs(found.points[0] @ turn), np.diag(own / own[-1]), atol=1e-12)
    np.testing.assert_array_equal(found.colours[0, 0], np.rint(255 * abs(turn[:, 2])))


def test_lines_of_peaks_go_through_the_centres_of_voxels():
    values = np.zeros((2, 2, 2, 6), np.float32)
    values[0, 1, 1] = 0, 3, 4, 0.5, 0, 0
    image = SliceImage(values, AFFINE)
    found = glyphs.lines_of_peaks(image, np.array([[0, 1, 1]]), 1.0, 5.0)
    middle = AFFINE[:3] @ (0, 1, 1, 1)
    half = 0.5 * np.linalg.norm(AFFINE[:3, :3], axis=0).min()
    along = half * np.array([0, 0.6, 0.8])
    np.testing.assert_allclose(found.points[0], [middle - along, middle + along])
    np.testing.assert_allclose(found.points[1, 1] - middle, (0.1 * half, 0, 0), atol=1e-9)
    assert found.colours[:, 0].tolist() == [[0, 153, 204], [255, 0, 0]]


def test_a_plane_along_the_grid_takes_one_layer_and_what_is_zero_is_left_out():
    values = np.ones((4, 5, 6, 3))
    values[1, 2] = 0.0
    image = SliceImage(values, np.diag([2.0, 2.0, 2.0, 1.0]))
    for z, layer in ((4.0, 2), (4.9, 2), (3.2, 2), (5.1, 3)):
        found = glyphs.voxels_on_plane(image, np.array([0.0, 0.0, z]), np.array([0.0, 0.0, 1.0]))
        assert np.unique(found[:, 2]).tolist() == [layer]
        assert len(found) == 19
    n = np.array([0.6, 0.0, 0.8])
    found = glyphs.voxels_on_plane(image, np.array([3.0, 0.0, 5.0]), n)
    away = (found * 2.0 - (3.0, 0.0, 5.0)) @ n
    assert abs(away).max() <= 0.8 + 1e-6
    assert not len(glyphs.voxels_on_plane(image, np.array([0.0, 0.0, 100.0]), n))
