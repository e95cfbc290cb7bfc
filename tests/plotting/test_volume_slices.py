"""Images that are one voxel thick are drawn as thick as their voxels; `add_volume` shows them in one colour."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv

from pvfiblets.volumes import as_raycast_volume


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_a_slice_is_as_thick_as_its_voxels(axis):
    shape = np.insert([5, 4], axis, 1)
    numbers = np.arange(20.0).reshape(shape)
    image = pv.ImageData(dimensions=shape, spacing=(2.0, 3.0, 4.0), origin=(7.0, 8.0, 9.0))
    image["n"] = numbers.ravel(order="F")
    volume = as_raycast_volume(image)
    np.testing.assert_array_equal(volume.values, np.repeat(numbers, 2, axis))
    middle = np.array(volume.bounds).reshape(-1, 2).mean(axis=1) if np.ndim(volume.bounds) == 1 else None
    assert middle is None or middle[axis] == pytest.approx(image.center[axis])
    first, last = (volume.affine @ np.append(place, 1.0) for place in (np.zeros(3), np.array(volume.shape) - 1))
    np.testing.assert_allclose((first + last)[:3] / 2.0, image.center)
    assert (last - first)[axis] == pytest.approx(image.spacing[axis])


def test_its_values_are_seen(plotter):
    """From above, along y as many of one colour: the numbers rise along x."""
    image = pv.ImageData(dimensions=(20, 20, 1))
    image["n"] = image.points[:, 0]
    plotter.add_raycast_volume(image, cmap=["red", "blue"], n_colors=2, opacity=1.0, show_scalar_bar=False)
    plotter.view_xy()
    picture = plotter.screenshot(None)[100]
    seen = np.flatnonzero(picture.any(axis=1))
    first, last = picture[seen[8]], picture[seen[-8]]
    assert first[0] > 200 > 50 > first[2]
    assert last[2] > 200 > 50 > last[0]


def test_bytes_of_four_are_colours():
    volume = as_raycast_volume(np.full((3, 3, 1, 4), 200, np.uint8))
    assert volume.colours is not None
    assert volume.shape == volume.colours.shape[:3] == (3, 3, 2)
