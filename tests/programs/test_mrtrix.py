"""MRtrix3's commands beside ours, on walks through a cube of 40 mm with eight labels."""

from __future__ import annotations

import json
import subprocess

import nibabel as nib
import numpy as np
import pytest

import pvfiblets as pf
from pvfiblets import formats
from pvfiblets.cli.command import main
from pvfiblets.images.sources import as_image
from pvfiblets.streamlines import Streamlines

from .rows import beside

MRTRIX = "MRtrix3"


def run(*command, fails=False):
    """Run a command of MRtrix; return what it says."""
    said = [*map(str, command), *(() if fails else ("-quiet",)), "-force"]
    done = subprocess.run(said, capture_output=True, text=True, timeout=240, check=False)
    assert (done.returncode != 0) == fails, done.stderr
    return done.stdout + done.stderr


def numbers(path):
    """Return the numbers of a file of MRtrix's, or of a table of ours without names."""
    text = [line for line in path.read_text().splitlines() if line and not line.startswith("#")]
    if "," in text[0] and not text[0].split(",")[0]:
        return np.array([[cell or 0.0 for cell in line.split(",")[1:]] for line in text[1:]], float)
    return np.array([line.replace(",", " ").split() for line in text], float)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder, rng = tmp_path_factory.mktemp("mrtrix"), np.random.default_rng(0)
    walks = [np.cumsum(rng.normal(0, 1.2, (40, 3)), 0) + rng.uniform(5, 35, 3) for _ in range(60)]
    pf.write(folder / "walks.tck", Streamlines.from_list([np.clip(walk, 1, 38).astype("f4") for walk in walks]))
    pf.write(folder / "long.tck", Streamlines.from_list([np.array([[0, 2, 2], [39, 2, 2]], "f4")]))
    octants = np.arange(1, 9, dtype="i2").reshape(2, 2, 2).repeat(20, 0).repeat(20, 1).repeat(20, 2)
    nib.save(nib.Nifti1Image(octants, np.eye(4)), folder / "labels.nii")
    nib.save(nib.Nifti1Image(rng.normal(10, 3, (40, 40, 40)).astype("f4"), np.eye(4)), folder / "fa.nii")
    for name in ("weights", "numbers"):
        np.savetxt(folder / f"{name}.txt", rng.uniform(0, 9, 60))
    return folder


def matrices(folder, theirs, ours):
    run("tck2connectome", folder / "walks.tck", folder / "labels.nii", folder / "theirs.csv", "-symmetric", *theirs)
    assert (
        main(["connectome", str(folder / "walks.tck"), str(folder / "labels.nii"), str(folder / "ours.csv"), *ours])
        == 0
    )
    return np.nan_to_num(numbers(folder / "theirs.csv")), np.nan_to_num(numbers(folder / "ours.csv"))


@beside(MRTRIX)
@pytest.mark.parametrize(
    ("theirs", "ours"), [(["-scale_length"], ["--statistic", "sum"]), (["-scale_length", "-stat_edge", "mean"], [])]
)
def test_matrices_of_lengths(folder, theirs, ours):
    """`tck2connectome -scale_length`: the sum of lengths, unless `-stat_edge mean`.

    Here: `--contrast length --statistic sum`; `--contrast length` alone is the mean.
    """
    found = matrices(folder, theirs, ["--contrast", "length", *ours])
    np.testing.assert_allclose(*found, rtol=1e-5)


@beside(MRTRIX)
def test_matrices_of_numbers_and_weights(folder):
    """`tck2connectome -scale_file`, `-tck_weights_in`: sums of numbers and of weights.

    Here: `--contrast FILE --statistic sum`; `--weights FILE`.
    """
    found = matrices(
        folder,
        ["-scale_file", folder / "numbers.txt"],
        ["--contrast", str(folder / "numbers.txt"), "--statistic", "sum"],
    )
    np.testing.assert_allclose(*found, rtol=1e-5)
    found = matrices(folder, ["-tck_weights_in", folder / "weights.txt"], ["--weights", str(folder / "weights.txt")])
    np.testing.assert_allclose(*found, rtol=1e-5)


@beside(MRTRIX)
@pytest.mark.parametrize("sampling", ["points", "lines"])
def test_regions_that_lines_pass(folder, tmp_path, sampling):
    """`tckedit -include`: tests points only: a line that crosses the region between two points is dropped, with a
    warning only if the header has `step_size`.

    Here: tests the line between points, too; `--sampling points` follows MRtrix.
    """
    run("tckedit", folder / "walks.tck", folder / "long.tck", tmp_path / "both.tck")
    run("tckedit", tmp_path / "both.tck", tmp_path / "theirs.tck", "-include", "20,2,2,6")
    assert (
        main(
            [
                "batch",
                "select",
                str(tmp_path / "both.tck"),
                "-o",
                str(tmp_path / "out"),
                "--quiet",
                "--to",
                ".tck",
                "--passes",
                "sphere:20,2,2,6",
                "--sampling",
                sampling,
            ]
        )
        == 0
    )
    theirs, ours = formats.read(tmp_path / "theirs.tck"), formats.read(next((tmp_path / "out").rglob("*.tck")))
    assert len(theirs) > 0
    assert len(ours) == len(theirs) + (sampling == "lines")
    np.testing.assert_array_equal(theirs.points, ours.points[: theirs.n_points])


@beside(MRTRIX)
def test_voxels_that_a_long_segment_crosses(folder, tmp_path):
    """`tckmap`: places points by the header's `step_size`; without this key it finds two of the 40 voxels of one
    long segment.

    Here: counts every voxel that a segment crosses, and ignores the header; `.tck` files get their largest step as
    `step_size`, so tckmap finds all 40.
    """

    def counted(source):
        run("tckmap", source, tmp_path / "map.nii", "-template", folder / "fa.nii")
        return int((nib.load(tmp_path / "map.nii").get_fdata() > 0).sum())

    assert counted(folder / "long.tck") == 40
    bare = b"".join(
        line
        for line in (folder / "long.tck").read_bytes().splitlines(keepends=True)
        if not line.startswith(b"step_size")
    )
    lost = len((folder / "long.tck").read_bytes()) - len(bare)
    (tmp_path / "bare.tck").write_bytes(bare.replace(b"\nEND\n", b"\nEND\n" + b"\0" * lost, 1))
    assert counted(tmp_path / "bare.tck") == 2
    assert (
        main(
            [
                "density",
                str(tmp_path / "bare.tck"),
                str(tmp_path / "ours.nii"),
                "--like",
                str(folder / "fa.nii"),
                "--quiet",
            ]
        )
        == 0
    )
    assert (nib.load(tmp_path / "ours.nii").get_fdata() > 0).sum() == 40


@beside(MRTRIX)
def test_lengths_in_voxels(folder, tmp_path):
    """`tckmap -precise -contrast length`: multiplies the length in a voxel by the streamline's length, along splines
    through the points; `-precise` alone is mm in a voxel.

    Here: `density --contrast length`: mm of the segments in a voxel.
    """
    run("tckmap", folder / "walks.tck", tmp_path / "theirs.nii", "-template", folder / "fa.nii", "-precise")
    assert (
        main(
            [
                "density",
                str(folder / "walks.tck"),
                str(tmp_path / "ours.nii"),
                "--like",
                str(folder / "fa.nii"),
                "--contrast",
                "length",
                "--quiet",
            ]
        )
        == 0
    )
    theirs, ours = (nib.load(tmp_path / f"{who}.nii").get_fdata() for who in ("theirs", "ours"))
    exact = formats.read(folder / "walks.tck").lengths().sum()
    assert ours.sum() == pytest.approx(exact, rel=1e-6)
    assert exact * 1.02 < theirs.sum() < exact * 1.06
    assert np.corrcoef(theirs.ravel(), ours.ravel())[0, 1] > 0.9


@beside(MRTRIX)
def test_counts_and_lengths(folder, tmp_path, capsys):
    """`tckinfo`, `tckstats`: `tckinfo` prints the header's count, `-count` the file's; lengths are measured from
    points, whatever `step_size` says.

    Here: `info` counts; `table` measures from points.
    """
    data = (folder / "walks.tck").read_bytes().replace(b"count: 60\n", b"count: 99\n")
    (tmp_path / "wrong.tck").write_bytes(data)
    assert "99" in run("tckinfo", tmp_path / "wrong.tck")
    assert "actual count in file: 60" in run("tckinfo", tmp_path / "wrong.tck", "-count")
    assert main(["info", str(tmp_path / "wrong.tck"), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["streamlines"] == 60
    run("tckstats", folder / "walks.tck", "-dump", tmp_path / "lengths.txt")
    np.testing.assert_allclose(
        numbers(tmp_path / "lengths.txt")[:, 0], formats.read(folder / "walks.tck").lengths(), rtol=1e-5
    )


@beside(MRTRIX)
def test_means_along_streamlines(folder, tmp_path, capsys):
    """`tcksample -stat_tck mean`: weights each point by half the length of its two segments.

    Here: `table --by bundle --image` does the same; `--weights points` gives all points equal weights.
    """
    pf.write(tmp_path / "one.tck", Streamlines.from_list([formats.read(folder / "walks.tck")[0]]))
    run("tcksample", tmp_path / "one.tck", folder / "fa.nii", tmp_path / "mean.txt", "-stat_tck", "mean")
    assert main(["table", "--by", "bundle", "--image", f"fa={folder / 'fa.nii'}", str(tmp_path / "one.tck")]) == 0
    names, values = (line.split(",") for line in capsys.readouterr().out.strip().splitlines()[-2:])
    assert float(values[names.index("mean_fa")]) == pytest.approx(numbers(tmp_path / "mean.txt")[0, 0], rel=1e-4)


@beside(MRTRIX)
def test_scalars_of_another_timestamp(folder, tmp_path):
    """`.tsf` beside `.tck`: `tsfvalidate` and mrview compare the timestamps of both as text.

    Here: a `.tck` keeps its timestamp as long as its points are the same; otherwise it gets one computed from its
    points. A `.tsf` of another timestamp causes a warning.
    """
    run("tcksample", folder / "walks.tck", folder / "fa.nii", tmp_path / "fa.tsf")
    pf.write(tmp_path / "again.tck", pf.read(folder / "walks.tck"))
    run("tsfvalidate", tmp_path / "fa.tsf", tmp_path / "again.tck")
    pf.write(tmp_path / "moved.tck", Streamlines.from_list([line + 1 for line in pf.read(folder / "walks.tck")]))
    assert "timestamp" in run("tsfvalidate", tmp_path / "fa.tsf", tmp_path / "moved.tck", fails=True)


@beside(MRTRIX)
def test_vtk_files_of_both(folder, tmp_path):
    """`tckconvert` and VTK: writes ASCII `.vtk` files but cannot read them; reads `double` points of a binary
    `.vtk` as floats, with exit code 0.

    Here: reads both; writes float, and with `--double` doubles and a note.
    """
    lines = formats.read(folder / "walks.tck")
    run("tckconvert", folder / "walks.tck", tmp_path / "theirs.vtk")
    np.testing.assert_allclose(formats.read(tmp_path / "theirs.vtk").points, lines.points, atol=1e-4)
    run("tckconvert", tmp_path / "theirs.vtk", tmp_path / "back.tck", fails=True)
    pf.write(tmp_path / "ours.vtk", Streamlines(lines.points.astype(np.float64), lines.offsets))
    run("tckconvert", tmp_path / "ours.vtk", tmp_path / "back.tck")
    np.testing.assert_allclose(formats.read(tmp_path / "back.tck").points, lines.points, atol=1e-5)


@beside(MRTRIX)
@pytest.mark.parametrize("name", ["a.mif", "a.mif.gz", "a.mih"])
@pytest.mark.parametrize("strides", ["1,2,3", "-3,1,-2"])
def test_images(folder, tmp_path, name, strides):
    """`.mih`, strides, `.mif.gz`: a `.mih` header ends without `END`; axes are stored in the order and direction of
    `-strides`.

    Here: reads all of them as `mrconvert` places them.
    """
    run("mrconvert", folder / "fa.nii", tmp_path / name, "-strides", strides)
    image = as_image(tmp_path / name)
    values, affine = image.values, image.affine
    truth = nib.load(folder / "fa.nii")
    run("mrconvert", tmp_path / name, tmp_path / "back.nii", "-strides", "1,2,3")
    np.testing.assert_array_equal(nib.load(tmp_path / "back.nii").get_fdata(), truth.get_fdata())
    at = np.argwhere(values > 15)
    voxels = np.round(nib.affines.apply_affine(np.linalg.inv(truth.affine) @ affine, at)).astype(int)
    assert len(at) > 100
    np.testing.assert_allclose(values[tuple(at.T)], truth.get_fdata()[tuple(voxels.T)], rtol=1e-6)
