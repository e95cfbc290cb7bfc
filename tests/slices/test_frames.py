"""Where planes lie and what of them images cover."""

from __future__ import annotations

import nibabel as nib
import numpy as np
import pytest

from pvfiblets.slices.frames import ORIENTATIONS, covered, grid_of, letters, nearest_frame, plane_axes
from pvfiblets.slices.image import SliceImage

SHEARED = np.array([[2.0, 0.7, 0.3, -20.0], [-0.4, 1.5, 0.2, 5.0], [0.1, 0.5, 3.0, 9.0], [0.0, 0.0, 0.0, 1.0]])


def image(affine=SHEARED, shape=(6, 7, 5)):
    return SliceImage(np.zeros((*shape, 1), np.float32), affine)


@pytest.mark.parametrize("orientation", ORIENTATIONS)
def test_what_a_plane_shows_holds_every_point_of_it_in_the_image(orientation):
    one = image()
    along, up = plane_axes(np.eye(3), orientation)
    position = one.center + (0.3, -0.2, 0.4)
    low_u, high_u, low_v, high_v = covered([one.corners], position, along, up)
    rng = np.random.default_rng(0)
    u, v = rng.uniform(-60, 60, (2, 200_000))
    at = position + u[:, None] * along + v[:, None] * up
    voxels = nib.affines.apply_affine(np.linalg.inv(SHEARED), at)
    inside = ((voxels >= -0.5) & (voxels <= np.array(one.shape) - 0.5)).all(axis=1)
    assert inside.sum() > 500
    for found, ends in ((u[inside], (low_u, high_u)), (v[inside], (low_v, high_v))):
        assert ends[0] <= found.min() < ends[0] + 1.0
        assert ends[1] - 1.0 < found.max() <= ends[1]


def test_a_plane_that_misses_shows_nothing_and_letters_name_its_sides():
    along, up = plane_axes(np.eye(3), "axial")
    assert covered([image().corners], np.array([0.0, 0.0, 1000.0]), along, up) is None
    for axis, pair in enumerate(("RL", "AP", "SI")):
        assert (letters(np.eye(3)[axis]), letters(-np.eye(3)[axis])) == tuple(pair)
    assert letters(np.array([0.0, 0.8, -0.6])) == "AI"
    assert letters(np.array([0.99, 0.05, 0.0])) == "R"
    with pytest.raises(ValueError, match="invertible"):
        image(np.diag([1.0, 0.0, 1.0, 1.0]))


def test_pixels_fill_the_rectangle_and_voxel_edges_are_pixel_edges():
    one = image(np.diag([2.0, 2.0, 2.0, 1.0]))
    along, up = plane_axes(np.eye(3), "coronal")
    bounds = covered([one.corners], one.center, along, up)
    grid = grid_of(bounds, one.center, along, up, 1.0)
    assert grid.shape == (12, 10)
    np.testing.assert_allclose(grid.corner, [-1.0, one.center[1], -1.0])
    np.testing.assert_allclose(grid.positions()[3, 4], grid.corner + 4.5 * grid.along + 3.5 * grid.up)


@pytest.mark.parametrize("codes", ["RAS", "LPI", "SAR", "PIL", "ARS"])
def test_the_nearest_frame_of_an_image_stored_along_other_axes_is_the_scanner_s(codes):
    stored = nib.orientations.axcodes2ornt(codes)
    affine = np.zeros((4, 4))
    affine[3, 3] = 1.0
    for axis, (world, sign) in enumerate(stored):
        affine[int(world), axis] = sign * (axis + 1.0)
    np.testing.assert_allclose(nearest_frame(affine), np.eye(3), atol=1e-12)


def test_the_nearest_frame_follows_a_tilted_and_sheared_image():
    angle = np.radians(20.0)
    tilt = np.array([[1, 0, 0], [0, np.cos(angle), -np.sin(angle)], [0, np.sin(angle), np.cos(angle)]])
    affine = np.eye(4)
    affine[:3, :3] = tilt @ np.diag([-2.0, 2.0, 3.0])
    np.testing.assert_allclose(nearest_frame(affine), tilt, atol=1e-12)
    frame = nearest_frame(SHEARED)
    np.testing.assert_allclose(frame.T @ frame, np.eye(3), atol=1e-12)
    assert np.linalg.det(frame) > 0.0
