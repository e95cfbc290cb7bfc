"""Values of images along streamlines: SciPy interpolates the same, and MRtrix's tcksample has the same statistics."""

import nibabel as nib
import numpy as np
import pytest
from scipy.ndimage import map_coordinates

import pvfiblets as pf

TURN = np.linalg.qr(np.random.default_rng(5).normal(size=(3, 3)))[0]
AFFINE = np.eye(4)
AFFINE[:3, :3], AFFINE[:3, 3] = TURN * (2.0, 1.5, 3.0), (-5.0, 3.0, 8.0)
IMAGE = np.random.default_rng(1).random((12, 14, 10)).astype(np.float32)


@pytest.fixture(scope="module")
def voxels():
    """Lines in voxels of the image, which some leave; one has a single point, one none, one lies outside."""
    rng = np.random.default_rng(2)
    made = [np.cumsum(rng.normal(0, 0.6, (n, 3)), axis=0) + (5.5, 6.5, 4.5) for n in (30, 1, 0, 17, 40, 2)]
    return [*made, made[0] + 100.0]


@pytest.fixture(scope="module")
def lines(voxels):
    return pf.Streamlines.from_list([v @ AFFINE[:3, :3].T + AFFINE[:3, 3] for v in voxels])


def values_at(voxels, order=1):
    """Values as SciPy has them: NaN outside."""
    at = np.concatenate(voxels)
    inside = ((at >= -0.5) & (at <= np.array(IMAGE.shape) - 0.5)).all(axis=1)
    return np.where(inside, map_coordinates(IMAGE.astype(float), at.T, order=order, mode="nearest"), np.nan)


@pytest.mark.parametrize("compressed", [False, True])
def test_points_have_scipys_values(voxels, lines, compressed, tmp_path):
    data = pf.compress(lines, exact=True) if compressed else lines
    nib.save(nib.Nifti1Image(IMAGE, AFFINE), tmp_path / "fa.nii.gz")
    for image in ((IMAGE, AFFINE), tmp_path / "fa.nii.gz", nib.Nifti1Image(IMAGE, AFFINE)):
        np.testing.assert_allclose(pf.sample(data, image), values_at(voxels), atol=2e-5)
    np.testing.assert_allclose(data.sample((IMAGE, AFFINE), nearest=True), values_at(voxels, 0), atol=1e-6)
    pf.write(tmp_path / "a.trx", lines)
    assert pf.sample(tmp_path / "a.trx", (IMAGE, AFFINE)).shape == (lines.n_points,)
    labels = nib.Nifti1Image((IMAGE * 9).astype(np.int16), AFFINE)
    labels.header.set_intent("label")
    found = data.sample(labels)
    assert set(found[np.isfinite(found)]) <= set(range(9))


@pytest.mark.parametrize("statistic", ["mean", "median", "min", "max"])
def test_streamlines_have_numpys_statistics(voxels, lines, statistic):
    found = lines.sample((IMAGE, AFFINE), statistic)
    values, ends = values_at(voxels), np.cumsum([0, *map(len, voxels)])
    for k, line in enumerate(lines):
        known = np.isfinite(part := values[ends[k] : ends[k + 1]])
        if not known.any():
            assert np.isnan(found[k])
        elif statistic == "mean" and len(line) > 1:
            weights = np.convolve(np.linalg.norm(np.diff(line, axis=0), axis=1), [0.5, 0.5])
            assert found[k] == pytest.approx(np.average(part[known], weights=weights[known]))
        else:
            assert found[k] == pytest.approx(getattr(np, statistic)(part[known]))
    plain = lines.sample((IMAGE, AFFINE), "mean", weights="points")
    assert plain[0] == pytest.approx(np.nanmean(values[: len(voxels[0])]))


def test_statistics_are_those_of_tcksample():
    """It printed these for the same file and image (MRtrix 3.0.3)."""
    along = np.array([1, 1.1, 1.2, 1.3, 17.0])
    line = np.c_[along, np.full((5, 2), 4.0)]
    image = (np.broadcast_to(np.arange(1.0, 11)[:, None, None], (10, 10, 10)), np.diag([2.0, 2, 2, 1]))
    lines = pf.Streamlines.from_list([line])
    for statistic, printed in {"mean": 5.5, "median": 1.6, "min": 1.5, "max": 9.5}.items():
        np.testing.assert_allclose(lines.sample(image, statistic), [printed], rtol=1e-6)
    np.testing.assert_allclose(lines.sample(image, "mean", weights="points"), [3.16], rtol=1e-6)


@pytest.mark.parametrize(
    ("given", "error", "message"),
    [
        ({"statistic": "sum"}, ValueError, "unknown statistic 'sum'; choose one of 'mean', 'median', 'min', 'max'"),
        ({"weights": "size"}, ValueError, "unknown weights 'size'; choose 'length' or 'points'"),
        ({"image": 3}, TypeError, "the image is a int; give the path of an image"),
        ({"image": (IMAGE, np.eye(3))}, ValueError, r"the affine of the image is .*; give a finite \(4, 4\) matrix"),
        ({"image": (np.zeros((3, 3, 3, 2)), AFFINE)}, ValueError, r"\(3, 3, 3, 2\); three axes"),
    ],
)
def test_what_cannot_be_sampled_is_named(lines, given, error, message):
    with pytest.raises(error, match=message):
        pf.sample(lines, **{"image": (IMAGE, AFFINE), **given})
