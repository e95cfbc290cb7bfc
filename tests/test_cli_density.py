"""``pvfiblets density``: what it writes, prints and refuses."""

import json

import nibabel as nib
import numpy as np
import pytest

import pvfiblets as pf
from pvfiblets import formats
from pvfiblets.cli.command import main
from pvfiblets.synthetic import brain_streamlines


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A small brain in three formats, weights, and an oblique image."""
    folder = tmp_path_factory.mktemp("density")
    brain = brain_streamlines(120, 1.0, seed=4, fa=True)
    brain.per_streamline["age"] = np.linspace(1.0, 2.0, 120)
    for suffix in (".trx", ".tck"):
        formats.write(folder / f"brain{suffix}", brain)
    pf.compress(brain, per_point=["fa"]).save(folder / "brain.fiblets")
    np.savetxt(folder / "weights.txt", np.linspace(0.0, 3.0, 120)[None])
    np.save(folder / "fa.npy", brain.per_point["fa"])
    affine = np.array([[2.0, 0.3, 0, -50], [-0.3, 2.0, 0, -60], [0, 0, 2.5, -20], [0, 0, 0, 1.0]])
    nib.save(nib.Nifti1Image(np.zeros((40, 50, 30), np.int16), affine), folder / "T1.nii.gz")
    return folder


@pytest.mark.parametrize("source", ["brain.fiblets", "brain.trx", "brain.tck"])
def test_the_file_is_what_the_function_gives(folder, tmp_path, capsys, source):
    target = tmp_path / "out.nii.gz"
    source, weights = folder / source, folder / "weights.txt"
    for arguments, options in (
        (["--voxel", "4"], {"voxel_size": 4.0}),
        (["--voxel", "4", "5", "6", "--contrast", "length"], {"voxel_size": (4.0, 5.0, 6.0), "contrast": "length"}),
        (["--like", folder / "T1.nii.gz", "--contrast", "direction", "--weights", weights],
         {"like": folder / "T1.nii.gz", "contrast": "direction", "weights": np.linspace(0.0, 3.0, 120)}),
        (["--voxel", "4", "--ends-only", "--weights", weights],
         {"voxel_size": 4.0, "ends_only": True, "weights": np.linspace(0.0, 3.0, 120)}),
        (["--voxel", "4", "--contrast", folder / "fa.npy"],
         {"voxel_size": 4.0, "contrast": np.load(folder / "fa.npy")}),
    ):  # fmt: skip
        assert main(["density", str(source), str(target), *map(str, arguments), "--json"]) == 0
        result = json.loads(capsys.readouterr().out)
        exact = pf.density(source, **options)
        image = nib.load(target)
        np.testing.assert_allclose(image.affine, exact.affine, atol=1e-4)
        np.testing.assert_allclose(np.asarray(image.dataobj), exact.values, rtol=1e-6)
        assert result["shape"] == list(exact.values.shape[:3])
        assert result["high"] == pytest.approx(exact.values.max())
        assert result["share_outside"] == pytest.approx(exact.share_outside)
        assert result["file"] == str(target)


def test_names_of_arrays_and_images_of_other_formats(folder, tmp_path, capsys):
    target = tmp_path / "out.nii"
    brain = str(folder / "brain.fiblets")
    assert main(["density", brain, str(target), "--voxel", "4", "--contrast", "fa", "--weights", "age"]) == 0
    printed = capsys.readouterr().out
    assert "fa" in printed
    assert "out.nii" in printed
    exact = pf.density(brain, 4.0, contrast="fa", weights="age")
    np.testing.assert_allclose(nib.load(target).get_fdata(), exact.values, rtol=1e-6)
    exact.to_image().save(tmp_path / "grid.vti")
    assert main(["density", brain, str(target), "--like", str(tmp_path / "grid.vti"), "--quiet"]) == 0
    np.testing.assert_array_equal(nib.load(target).get_fdata(), pf.density(brain, like=exact).values)


@pytest.mark.parametrize("suffix", [".mif", ".vti"])
def test_files_of_mrtrix_and_vtk_are_written_and_read_again(folder, tmp_path, suffix):
    target = tmp_path / f"out{suffix}"
    brain = str(folder / "brain.fiblets")
    assert main(["density", brain, str(target), "--voxel", "4", "--quiet"]) == 0
    assert main(["density", brain, str(tmp_path / "again.nii"), "--like", str(target), "--quiet"]) == 0
    exact, again = pf.density(brain, 4.0), nib.load(tmp_path / "again.nii")
    np.testing.assert_array_equal(np.asarray(again.dataobj), exact.values)
    np.testing.assert_allclose(again.affine, exact.affine)


def test_what_lies_outside_is_told(folder, tmp_path, capsys):
    small = nib.Nifti1Image(np.zeros((4, 4, 4), np.int16), np.diag([2.0, 2.0, 2.0, 1.0]))
    nib.save(small, tmp_path / "small.nii")
    brain, target = str(folder / "brain.trx"), str(tmp_path / "out.nii.gz")
    assert main(["density", brain, target, "--like", str(tmp_path / "small.nii")]) == 0
    assert "% of the streamlines, which no voxel holds" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (
            ["brain.trx", "out.png", "--voxel", "2"],
            "no name of an image; let it end in .nii",
        ),
        (["brain.trx", "out.nii", "--voxel", "2", "2"], "--voxel has 2 numbers"),
        (["none.trx", "out.nii", "--voxel", "2"], "none.trx"),
        (["brain.xyz", "out.nii", "--voxel", "2"], "no format has this suffix"),
        (["brain.trx", "out.nii", "--like", "none.nii"], "none.nii"),
        (["brain.trx", "out.nii", "--like", "brain.tck"], "brain.tck"),
        (["brain.trx", "out.nii", "--voxel", "2", "--weights", "none.txt"], "none.txt"),
        (["brain.trx", "out.nii", "--voxel", "2", "--weights", "fa.npy"], "one number for each of the 120 streamlines"),
        (["brain.trx", "out.nii", "--voxel", "2", "--contrast", "none"], "no array 'none'"),
        (["brain.fiblets", "out.nii", "--voxel", "2", "--contrast", "none"], "there is no measure 'none'"),
        (["brain.fiblets", "out.nii", "--voxel", "1e-9"], "give a larger voxel_size"),
        (["brain.fiblets", "nowhere/out.nii", "--voxel", "9"], "nowhere"),
    ],
)
def test_errors_are_one_sentence(folder, monkeypatch, capsys, arguments, message):
    monkeypatch.chdir(folder)
    assert main(["density", *arguments]) == 1
    captured = capsys.readouterr()
    assert message in captured.err
    assert captured.err.count("\n") == 1
    assert not (folder / "out.nii").exists()


@pytest.mark.parametrize("arguments", [[], ["--voxel", "2", "--like", "a.nii"], ["--voxel", "-1"]])
def test_a_grid_is_given_exactly_once(arguments, capsys):
    with pytest.raises(SystemExit) as stop:
        main(["density", "a.trk", "b.nii", *arguments])
    assert stop.value.code == 2
