"""``pyvista.read`` and ``save`` know tractograms, and PolyData can be compressed."""

from __future__ import annotations

from contextlib import nullcontext

import nibabel as nib
import numpy as np
import pytest
import pyvista as pv


@pytest.mark.parametrize("suffix", [".tck", ".trk", ".trx", ".fiblets"])
def test_lines_go_out_and_come_back(three_lines, tmp_path, suffix):
    path = tmp_path / f"lines{suffix}"
    told = pytest.warns(UserWarning, match=r"cannot hold per_point \(.*height") if suffix == ".tck" else nullcontext()
    with told:
        pv.wrap(three_lines.to_polydata()).save(path)
    back = pv.read(path)
    assert isinstance(back, pv.PolyData)
    assert back.n_lines == 3
    np.testing.assert_allclose(back.points, three_lines.points, atol=0.06)


def test_nibabels_own_file_lands_where_nibabel_says(tmp_path):
    lines = [np.random.default_rng(i).normal(size=(5 + i, 3)).astype(np.float32) for i in range(4)]
    affine = np.diag([2.0, 2.0, 2.0, 1.0])
    affine[:3, 3] = -20.0
    tractogram = nib.streamlines.Tractogram(lines, affine_to_rasmm=np.eye(4))
    header = {"voxel_sizes": (2, 2, 2), "dimensions": (20, 20, 20), "voxel_to_rasmm": affine, "voxel_order": "RAS"}
    nib.streamlines.save(nib.streamlines.TrkFile(tractogram, header), tmp_path / "a.trk")
    data = pv.read(tmp_path / "a.trk")
    np.testing.assert_allclose(data.points, np.concatenate(lines), atol=1e-4)
    assert data.n_lines == 4


def test_every_declared_suffix_has_a_reader():
    known = {registration.extension for registration in pv.registered_readers()}
    assert {".tck", ".trk", ".trk.gz", ".trx", ".tt.gz", ".fiblets"} <= known


def test_a_gzipped_file_is_read_by_its_double_suffix(shared_data):
    assert pv.read(shared_data / "nv_stroke.trk.gz").n_lines == 36763


def test_only_polydata_can_be_saved(tmp_path):
    with pytest.raises((TypeError, ValueError), match="PolyData"):
        pv.ImageData(dimensions=(2, 2, 2)).save(tmp_path / "image.trk")


def test_the_accessor_compresses_lines_with_their_data(three_lines):
    data = pv.wrap(three_lines.to_polydata())
    fiblets = data.fiblets.compress(per_point=["height"], max_error=0.01)
    back = fiblets.decompress()
    np.testing.assert_allclose(back.points, three_lines.points, atol=0.011)
    np.testing.assert_allclose(back.per_streamline["weight"], [1.0, 10.0, 100.0])
    np.testing.assert_allclose(back.per_point["height"], three_lines.per_point["height"], atol=0.003)
    assert len(data.fiblets.to_streamlines()) == 3
