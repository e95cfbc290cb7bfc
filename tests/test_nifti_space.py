"""Where images of NIfTI lie: against nibabel's matrices, and tract ends whose side is known."""

from __future__ import annotations

import json
import re
import warnings

import nibabel as nib
import numpy as np
import pytest

import pvfiblets
from pvfiblets.cli.command import main
from pvfiblets.support.nifti_space import affine_of, code_of, nifti_space

AFFINE = np.array([[2.0, 0, 0, -19], [0, 2, 0, -19], [0, 0, 2, -19], [0, 0, 0, 1]])
MIRRORED = np.array([[-2.0, 0, 0, 19], [0, 2, 0, -19], [0, 0, 2, -19], [0, 0, 0, 1]])
LABELS = np.zeros((20,) * 3, "i2")
LABELS[1:4], LABELS[10:12], LABELS[17:19] = 1, 2, 3


def image(path, sform, qform, other=AFFINE, unit="mm"):
    made = nib.Nifti1Image(LABELS, None)
    made.header.set_zooms((2, 2, 2))
    made.header.set_sform(AFFINE, sform)
    made.header.set_qform(other, qform)
    made.header.set_xyzt_units(unit)
    nib.save(made, path)
    return path


@pytest.fixture
def tract(tmp_path):
    """Five lines from the left (x = -15) to the middle, two from the right."""
    lines = [[[x, i, 0], [2, i, 0]] for x, n in ((-15, 5), (15, 2)) for i in range(n)]
    made = nib.streamlines.Tractogram([np.array(one, "f4") for one in lines], affine_to_rasmm=np.eye(4))
    nib.streamlines.save(made, tmp_path / "a.tck")
    return tmp_path / "a.tck"


def matrix_of(path):
    return np.loadtxt(path, delimiter=",", skiprows=1)[:, 1:]


LEFT_HAS_5 = [[0, 5, 0], [5, 0, 2], [0, 2, 0]]
LEFT_HAS_2 = [[0, 2, 0], [2, 0, 5], [0, 5, 0]]
ZERO = (
    r"zero.nii does not say where it lies .sform_code and qform_code are 0..*i right to left, .*MRtrix swaps left and "
    r"right.*--nifti-space RAS"
)
DISAGREE = (
    r"sform \(code {}\) and the qform \(code 1\) of .*\.nii differ by up to 40 mm, and left and right are swapped.*"
    r" i left to right.*ITK.* i right to left.*--nifti-space qform"
)


@pytest.mark.filterwarnings("always")
@pytest.mark.parametrize(
    ("arguments", "said", "options", "right"),
    [
        (("zero.nii", 0, 0), ZERO, [], LEFT_HAS_2),  # nibabel's mirror of tck2connectome's
        (("zero.nii", 0, 0), None, ["--nifti-space", "RAS"], LEFT_HAS_5),
        (("zero.nii", 0, 0), None, ["--nifti-space", "LAS"], LEFT_HAS_2),
        (("disagree.nii", 1, 1, MIRRORED), DISAGREE.format(1), [], LEFT_HAS_5),
        (("template.nii", 4, 1, MIRRORED), DISAGREE.format(4), [], LEFT_HAS_5),
        (("template.nii", 4, 1, MIRRORED), None, ["--nifti-space", "sform"], LEFT_HAS_5),
        (("template.nii", 4, 1, MIRRORED), None, ["--nifti-space", "qform"], LEFT_HAS_2),
        (("micron.nii", 1, 1, AFFINE, "micron"), "micron.nii .*in microns.*as millimetres.*by 0.001", [], LEFT_HAS_5),
        (("qform.nii", 0, 1), None, [], LEFT_HAS_5),
    ],
)  # fmt: skip
def test_connectome_says_once_what_places_the_labels(tract, tmp_path, capsys, arguments, said, options, right):
    labels = image(tmp_path / arguments[0], *arguments[1:])
    assert main(["connectome", str(tract), str(labels), str(tmp_path / "m.csv"), *options]) == 0
    np.testing.assert_array_equal(matrix_of(tmp_path / "m.csv"), right)
    error = capsys.readouterr().err
    assert error.count("\n") == (said is not None)
    if said:
        assert re.search(said, error)
        assert main(["connectome", str(tract), str(labels), str(tmp_path / "m.csv"), *options]) == 0
        assert capsys.readouterr().err == ""  # once per file


@pytest.mark.parametrize("kind", [nib.Nifti1Image, nib.Nifti2Image])
def test_the_matrices_are_nibabels(tmp_path, kind):
    turned = np.eye(4)
    turned[:3, :3] = np.linalg.qr(np.random.default_rng(0).normal(size=(3, 3)))[0] * [2.0, 3.0, 4.0]
    made = kind(np.zeros((5, 6, 7), "f4"), None)
    made.header.set_zooms((2, 3, 4))
    made.header.set_sform(turned, 2)
    turned[:3, 3] = 100.0
    made.header.set_qform(turned, 1)
    nib.save(made, tmp_path / "a.nii.gz")
    loaded = nib.load(tmp_path / "a.nii.gz")
    with pytest.warns(UserWarning, match=r"differ by up to 173 mm\."):
        np.testing.assert_array_equal(affine_of(loaded), loaded.get_sform())
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        np.testing.assert_array_equal(affine_of(loaded), loaded.get_sform())
        assert code_of(loaded) == 2
        with nifti_space("qform"):
            np.testing.assert_array_equal(affine_of(loaded), loaded.get_qform())
            assert code_of(loaded) == 1
        with nifti_space("LAS"):  # as nibabel places it without codes
            bare = kind(np.zeros((5, 6, 7), "f4"), None)
            bare.header.set_zooms((2, 3, 4))
            np.testing.assert_allclose(affine_of(loaded), bare.header.get_base_affine())
        with nifti_space("RAS"):
            np.testing.assert_allclose(
                affine_of(loaded), [[2, 0, 0, -4], [0, 3, 0, -7.5], [0, 0, 4, -12], [0, 0, 0, 1]]
            )


@pytest.mark.parametrize(("unit", "factor"), [("micron", 0.001), ("meter", 1000.0), ("mm", 1.0), ("unknown", 1.0)])
def test_units_of_the_header_count_where_they_are_chosen(tmp_path, unit, factor):
    path = image(tmp_path / f"{unit}.nii", 1, 1, unit=unit)
    with nifti_space(units="header"), warnings.catch_warnings():
        warnings.simplefilter("error")
        np.testing.assert_allclose(affine_of(nib.load(path)), np.diag([factor] * 3 + [1.0]) @ AFFINE)


def test_images_without_doubt_and_those_in_memory_are_taken_as_they_are(tmp_path):
    near = AFFINE.copy()
    near[0, 3] += 0.15  # less than a tenth of a voxel
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        np.testing.assert_array_equal(affine_of(nib.load(image(tmp_path / "near.nii", 1, 1, near))), AFFINE)
        np.testing.assert_array_equal(affine_of(nib.Nifti1Image(LABELS, MIRRORED)), MIRRORED)
        np.testing.assert_array_equal(affine_of(nib.MGHImage(LABELS.astype("i4"), MIRRORED)), MIRRORED)
        assert affine_of(nib.Nifti1Image(LABELS, None)) is None
        path = image(tmp_path / "moved.nii", 1, 1, MIRRORED)
        loaded = nib.load(path)
        given = nib.Nifti1Image(LABELS, 3.0 * np.eye(4), loaded.header)  # an affine of the caller's
        np.testing.assert_array_equal(affine_of(given), 3.0 * np.eye(4))


def test_a_missing_matrix_and_unknown_words_are_refused(tmp_path):
    path = image(tmp_path / "s.nii", 1, 0)
    with (
        nifti_space("qform"),
        pytest.raises(ValueError, match=r"s\.nii has no qform: its qform_code is 0; choose sform"),
    ):
        affine_of(nib.load(path))
    with pytest.raises(ValueError, match="unknown matrix 'LPS'; choose one of 'sform'"), nifti_space("LPS"):
        pass
    with pytest.raises(ValueError, match="unknown units 'm'; choose 'mm' or 'header'"), nifti_space(units="m"):
        pass


USES = {
    "density": lambda path: pvfiblets.query.density.voxel_grid.grid_like(path).affine,
    "image": lambda path: pvfiblets.images.sources.as_image(path).affine,
    "painter": lambda path: pvfiblets.query.painting.painter.RegionPainter.open(path).grid.affine,
    "slices": lambda path: pvfiblets.slices.image.as_slice_image(path).affine,
    "volume": lambda path: pvfiblets.volumes.sources.as_raycast_volume(path).affine,
    "scalars": lambda path: pvfiblets.plotting.fiblets.sources.as_volume(str(path)).affine,
    "region": lambda path: pvfiblets.plotting.filtering.region_sources.as_region(path)._volume.to_mm,
    "page's labels": lambda path: label_affine(path),
}


def label_affine(path):
    from pvfiblets.web.scene.files.loading import Files
    from pvfiblets.web.session.document import Source

    return Files(path.parent).load(Source(path.name), "labels").data.affine


def test_the_page_shows_the_warning_of_a_file_it_opens(tmp_path):
    from pvfiblets.web.scene.files.loading import Files
    from pvfiblets.web.session.document import Source

    path, files = image(tmp_path / "zero.nii", 0, 0), Files(tmp_path)
    with pytest.warns(UserWarning, match=r"zero\.nii does not say"):
        (text,) = files.load(Source(path.name), "image").facts["notes"]
    assert "MRtrix swaps left and right" in text
    assert files.load(Source(path.name), "volume").facts["notes"] == [text]  # opened again, and warned of once
    assert "notes" not in files.load(Source(image(tmp_path / "one.nii", 1, 0).name), "image").facts


@pytest.mark.parametrize("use", USES)
def test_every_use_of_a_file_or_an_image_has_the_rule(tmp_path, use):
    import pvfiblets.images.sources
    import pvfiblets.plotting.fiblets.sources
    import pvfiblets.plotting.filtering.region_sources
    import pvfiblets.query.density.voxel_grid
    import pvfiblets.query.painting.painter
    import pvfiblets.slices.image
    import pvfiblets.volumes.sources  # noqa: F401

    path = image(tmp_path / "template.nii", 4, 1, MIRRORED)
    with pytest.warns(UserWarning, match=r"left and right are swapped\."):
        np.testing.assert_allclose(USES[use](path), AFFINE)
    with nifti_space("qform"):
        np.testing.assert_allclose(USES[use](path), MIRRORED)


@pytest.mark.more
def test_a_batch_hands_the_choice_to_its_workers(tract, tmp_path):
    labels = image(tmp_path / "template.nii", 4, 1, MIRRORED)
    arguments = ["batch", "connectome", str(tract), "-o", str(tmp_path / "out"), "--labels", str(labels)]
    assert main([*arguments, "--nifti-space", "qform", "--workers", "1", "--quiet"]) == 0
    import pyarrow.parquet as pq

    rows = pq.read_table(tmp_path / "out" / "connectome.parquet").to_pylist()
    assert {(r["parcel_a"], r["parcel_b"]): r["count"] for r in rows if r["count"]} == {(1, 2): 2, (2, 3): 5}


def test_density_has_the_code_of_the_matrix(tract, tmp_path, capsys):
    like = image(tmp_path / "template.nii", 4, 1, MIRRORED)
    target = tmp_path / "out.nii"
    assert main(["density", str(tract), str(target), "--like", str(like), "--nifti-space", "qform", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["shape"] == [20, 20, 20]
    written = nib.load(target)
    np.testing.assert_array_equal(written.affine, MIRRORED)
    assert int(written.header["sform_code"]) == 1


@pytest.mark.filterwarnings("ignore:.*sform.*qform")
@pytest.mark.parametrize(("choice", "left"), [("sform", 1), ("qform", 3)])
def test_sampled_labels_follow_the_choice(tract, tmp_path, choice, left):
    labels = image(tmp_path / "template.nii", 4, 1, MIRRORED)
    target = tmp_path / "values.txt"
    assert main(["sample", str(tract), str(labels), str(target), "--nearest", "--nifti-space", choice]) == 0
    assert np.loadtxt(target)[::2].tolist() == [left] * 5 + [4 - left] * 2  # the outer ends
