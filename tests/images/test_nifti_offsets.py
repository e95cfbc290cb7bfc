"""NIfTI's scaling keeps the steps of its numbers whatever is added to them."""

import nibabel as nib
import numpy as np
import pytest

from pvfiblets.images.sources import as_image


@pytest.mark.parametrize(
    ("slope", "inter", "kind"), [(0.5, 1e8, "f8"), (1.0, 1.7e9, "f8"), (0.5, -3.0, "f4"), (2.0, 100.0, "f4")]
)
def test_steps_beside_an_offset(tmp_path, slope, inter, kind):
    stored = np.arange(60, dtype="i2").reshape(3, 4, 5)
    image = nib.Nifti1Image(stored, np.eye(4))
    image.header.set_slope_inter(slope, inter)
    nib.save(image, tmp_path / "a.nii")
    raw = bytearray((tmp_path / "a.nii").read_bytes())
    raw[112:120] = np.array([slope, inter], "<f4").tobytes()  # nibabel scales what it saves
    raw[-stored.nbytes :] = stored.tobytes(order="F")
    (tmp_path / "a.nii").write_bytes(raw)
    found = as_image(tmp_path / "a.nii").values
    assert found.dtype == kind
    np.testing.assert_array_equal(found, stored * float(np.float32(slope)) + float(np.float32(inter)))
