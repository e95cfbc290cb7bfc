"""Packages of Python that read and write tractograms and images, beside pvfiblets."""

from __future__ import annotations

import nibabel as nib
import numpy as np
import pytest

import pvfiblets as pf
from pvfiblets import formats
from pvfiblets.other_libraries import streamlines_of
from pvfiblets.streamlines import Streamlines

from .rows import beside

LINES = [np.random.default_rng(k).normal(0, 20, (5 + k, 3)).astype("f4") for k in range(3)]


@pytest.fixture
def tractogram():
    """Return DIPY's tractogram of the lines in an image's space."""
    from dipy.io.stateful_tractogram import Space, StatefulTractogram

    affine = np.diag([2.0, 2.0, 2.0, 1.0])
    affine[:3, 3] = -90
    image = nib.Nifti1Image(np.zeros((91, 91, 91), "u1"), affine)
    return StatefulTractogram(LINES, image, Space.RASMM)


def same(found, atol=1e-4):
    assert len(found) == len(LINES)
    for one, line in zip(found, LINES, strict=True):
        np.testing.assert_allclose(one, line, atol=atol)


@beside("DIPY")
def test_objects_of_any_space(tractogram):
    """a `StatefulTractogram`: saving moves points to the file's space and back, 2e-6 mm a save, and float32 becomes
    float64.

    Here: reads points in any of its spaces and origins, and leaves the object unchanged.
    """
    tractogram.to_vox()
    tractogram.to_corner()
    before = tractogram.streamlines.get_data().copy()
    same(streamlines_of(tractogram))
    np.testing.assert_array_equal(tractogram.streamlines.get_data(), before)


@beside("trx-python")
def test_names_of_trx_files(tmp_path):
    """names with dots in `.trx`: cuts names at the first dot, and refuses files that hold others.

    Here: replaces dots, with a warning.
    """
    trx = pytest.importorskip("trx.trx_file_memmap")
    lines = Streamlines.from_list(LINES, per_point={"b1000.FA": np.arange(sum(map(len, LINES)), dtype="f4")})
    with pytest.warns(UserWarning, match=r"b1000\.FA"):
        pf.write(tmp_path / "a.trx", lines)
    found = trx.load(str(tmp_path / "a.trx"))
    same(found.streamlines)
    assert [name.replace("_", ".") for name in found.data_per_vertex] == ["b1000.FA"]
    found.close()


@beside("nibabel")
def test_empty_streamlines(tmp_path):
    """empty streamlines in `.tck` and `.trk`: drops them from a `.tck` when reading it; refuses a `.trk` that has
    per-streamline values.

    Here: keeps them in both; writing such a `.trk` causes a warning that names the code to remove them.
    """
    lines = Streamlines.from_list([LINES[0], np.zeros((0, 3), "f4"), LINES[1]])
    pf.write(tmp_path / "a.tck", lines)
    assert len(nib.streamlines.load(tmp_path / "a.tck").streamlines) == 2
    assert [len(line) for line in formats.read(tmp_path / "a.tck")] == [5, 0, 6]
    lines.per_streamline["w"] = np.arange(3.0)
    with pytest.warns(UserWarning, match="1 streamlines have no points"):
        pf.write(tmp_path / "a.trk", lines)
    with pytest.raises(ValueError, match="should match n_elements"):
        nib.streamlines.load(tmp_path / "a.trk")
    pf.write(tmp_path / "b.trk", lines[lines.counts > 0])
    assert [len(line) for line in nib.streamlines.load(tmp_path / "b.trk").streamlines] == [5, 6]


@beside("SimpleITK")
def test_matrices_of_nifti(tmp_path):
    """NIfTI with both matrices: uses the qform if the sform's code is 2 to 5, and scales units of µm and m; nibabel
    and MRtrix3 use the sform unchanged.

    Here: uses the sform, with a warning if the two differ.
    """
    import SimpleITK

    image = nib.Nifti1Image(np.zeros((4, 5, 6), "f4"), np.diag([2.0, 2.0, 2.0, 1.0]))
    image.set_sform(np.diag([2.0, 2.0, 2.0, 1.0]), 2)
    moved = np.diag([2.0, 2.0, 2.0, 1.0])
    moved[:3, 3] = 10.0
    image.set_qform(moved, 1)
    nib.save(image, tmp_path / "a.nii")
    assert SimpleITK.ReadImage(str(tmp_path / "a.nii")).GetOrigin() == (-10.0, -10.0, 10.0)
    with pytest.warns(UserWarning, match="form"):
        image = pf.read_volume(tmp_path / "a.nii")
    assert image.origin == (0.0, 0.0, 0.0)
