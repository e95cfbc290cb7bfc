"""Volumes lie where their files say, and a volume that meets no streamline is told of."""

from __future__ import annotations

import nibabel
import numpy as np
import pytest
import pyvista as pv

import pvfiblets

AFFINE = np.array([[-2.0, 0.3, 0, 20], [0, 2.5, 0, -30], [0.1, 0, 3.0, -25], [0, 0, 0, 1]])


@pytest.fixture
def saved(tmp_path):
    """A file whose axes are flipped, oblique and far from the origin."""
    values = np.arange(20 * 24 * 18, dtype=np.float32).reshape(20, 24, 18)
    path = tmp_path / "fa.nii.gz"
    nibabel.save(nibabel.Nifti1Image(values, AFFINE), path)
    return path, values


def test_read_volume_keeps_the_place(saved):
    path, values = saved
    image = pvfiblets.read_volume(path)
    assert image.active_scalars_name == "fa"
    for index in ((0, 0, 0), (19, 0, 0), (3, 23, 7), (5, 6, 17)):
        point = image.find_closest_point((AFFINE @ [*index, 1])[:3])
        np.testing.assert_allclose(image.points[point], (AFFINE @ [*index, 1])[:3], atol=1e-4)
        assert image["fa"][point] == values[index]


def test_a_volume_colours_the_same_by_image_and_by_path(saved, plotter, three_lines):
    pictures = []
    for source in (str(saved[0]), pvfiblets.read_volume(saved[0])):
        plotter.add_fiblets(three_lines, scalars=source, name="one", show_scalar_bar=False, lighting=False)
        plotter.show(auto_close=False) if plotter._first_time else plotter.render()
        pictures.append(plotter.screenshot(None))
    np.testing.assert_array_equal(*pictures)
    assert len(np.unique(pictures[0].reshape(-1, 3), axis=0)) > 5


def test_a_volume_elsewhere_is_told_with_both_bounds(plotter, three_lines):
    far = pv.ImageData(dimensions=(4, 4, 4), origin=(100, 0, 0))
    far["fa"] = np.arange(64.0)
    told = r"no streamline meets the volume 'fa'.* x 99\.5 to 103\.5, .* x -10 to 10, .*read_volume"
    with pytest.warns(UserWarning, match=told):
        actor = plotter.add_fiblets(three_lines, scalars=far)
    near = far.copy()
    near.origin = (9.9, -10, 0)  # its outermost half voxel holds the end of one line
    actor.scalars = near
    with pytest.warns(UserWarning, match="no streamline meets"):
        actor.scalars = far


def test_what_is_no_volume_is_refused(tmp_path):
    with pytest.raises(ValueError, match=r"a\.vti is no volume that is read here; .*\.nii\.gz"):
        pvfiblets.read_volume(tmp_path / "a.vti")
    with pytest.raises(FileNotFoundError, match=r"none\.nii"):
        pvfiblets.read_volume(tmp_path / "none.nii")
