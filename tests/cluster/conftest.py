"""One cluster of two processes for each module, and a small cohort."""

import nibabel as nib
import numpy as np
import pytest

import pvfiblets as pf
from pvfiblets.cluster.connection import connected
from pvfiblets.synthetic import brain_streamlines

SUBJECTS = ("01", "02", "03")
AFFINE = np.array([[10.0, 0, 0, -100], [0, 10.0, 0, -120], [0, 0, 10.0, -80], [0, 0, 0, 1]])


@pytest.fixture(scope="module")
def client():
    with connected(None, 2, None, dashboard=False) as made:
        yield made


@pytest.fixture(scope="module")
def cohort(tmp_path_factory):
    """Three subjects, an atlas of each, and a fourth whose file is damaged."""
    root = tmp_path_factory.mktemp("cohort")
    for n, subject in enumerate(SUBJECTS):
        folder = root / f"sub-{subject}" / "ses-a" / "dwi"
        folder.mkdir(parents=True)
        brain = brain_streamlines(60, 2.0, seed=n, fa=True)
        pf.write(folder / f"sub-{subject}_ses-a_bundle-all_tractography.trx", brain)
        labels = np.ones((20, 24, 20), np.int16)
        labels[10:] += 1
        labels[:, 8 + n :] += 2
        (root / "atlas").mkdir(exist_ok=True)
        nib.save(nib.Nifti1Image(labels, AFFINE), root / "atlas" / f"sub-{subject}.nii.gz")
    folder = root / "sub-04" / "ses-a" / "dwi"
    folder.mkdir(parents=True)
    (folder / "sub-04_ses-a_bundle-all_tractography.trx").write_bytes(b"no zip")
    return root
