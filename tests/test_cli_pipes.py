"""``-``: standard input and output in place of files, as a shell joins programs."""

from __future__ import annotations

import io
import json
import subprocess
import sys
from types import SimpleNamespace

import nibabel as nib
import numpy as np
import pytest
from PIL import Image

from pvfiblets import formats
from pvfiblets.cli import main
from pvfiblets.formats.recognise import suffix_by_content
from pvfiblets.synthetic import brain_streamlines

WRITTEN = (".tck", ".trk", ".trx", ".vtk", ".vtp", ".fiblets")


@pytest.fixture(scope="module")
def brain():
    return brain_streamlines(60, 1.0, seed=3)


@pytest.fixture(scope="module")
def files(brain, tmp_path_factory):
    folder = tmp_path_factory.mktemp("pipes")
    for suffix in (".tck", ".trk", ".trx", ".vtk", ".vtp"):
        formats.write(folder / f"a{suffix}", brain)
    assert main(["convert", str(folder / "a.trx"), str(folder / "a.fiblets"), "--no-exact"]) == 0
    return folder


@pytest.fixture
def shell(monkeypatch, capfdbinary):
    """Run a command with bytes as its standard input; return exit code, standard output and standard error."""

    def run(data, *words):
        monkeypatch.setattr(sys, "stdin", SimpleNamespace(buffer=io.BytesIO(data), isatty=lambda: False))
        capfdbinary.readouterr()
        code = main([str(word) for word in words])
        out, err = capfdbinary.readouterr()
        return code, out, err.decode()

    return run


@pytest.mark.parametrize("suffix", WRITTEN)
def test_each_format_goes_in_and_out(shell, files, brain, suffix, tmp_path):
    source = (files / f"a{suffix}").read_bytes()
    code, out, err = shell(source, "convert", "-", "-", "--format", "tck")
    assert code == 0, err
    assert out.startswith(b"mrtrix tracks")
    (tmp_path / "a.tck").write_bytes(out)
    points = nib.streamlines.load(tmp_path / "a.tck").streamlines.get_data()
    np.testing.assert_allclose(points, brain.points, atol=0.11 if suffix == ".fiblets" else 1e-4)
    assert "standard output: 60 streamlines" in err
    assert "of standard input" in err
    assert "pvfiblets-pipe" not in err

    code, out, err = shell(b"", "convert", files / "a.tck", "-", "--format", suffix)
    assert code == 0, err
    (tmp_path / f"b{suffix}").write_bytes(out)
    assert suffix_by_content(tmp_path / f"b{suffix}") == suffix
    assert len(formats.read(tmp_path / f"b{suffix}")) == 60


@pytest.mark.parametrize("name", ["nv_stroke.trk.gz", "trxrs_tinytrack_small.tt.gz", "trxpy_small_compressed.trx",
                                  "nv_colby.trx", "nib_complex_big_endian.trk", "vtk_track1.binary.vtk"])  # fmt: skip
def test_real_files_are_known_by_their_content(shared_data, name):
    assert name.endswith(suffix_by_content(shared_data / name))


def test_what_is_said_of_standard_input(shell, files):
    code, out, _ = shell((files / "a.trk").read_bytes(), "info", "-", "--json")
    facts = json.loads(out)
    assert (code, facts["file"], facts["format"], facts["streamlines"]) == (0, "standard input", ".trk", 60)
    assert facts["bytes"] == (files / "a.trk").stat().st_size
    code, out, _ = shell((files / "a.fiblets").read_bytes(), "verify", "-", files / "a.trx", "--json")
    assert json.loads(out)["kept"] is True
    code, out, _ = shell((files / "a.trx").read_bytes(), "verify", files / "a.fiblets", "-", "--json")
    assert json.loads(out)["kept"] is True
    code, out, _ = shell((files / "a.trx").read_bytes(), "table", "-")
    assert out.count(b"\n") == 61


def test_volumes_matrices_and_pictures_leave_clean(shell, files, tmp_path):
    tracks = (files / "a.tck").read_bytes()
    code, out, err = shell(tracks, "density", "-", "-", "--voxel", "5", "--format", "nii.gz")
    assert code == 0, err
    (tmp_path / "a.nii.gz").write_bytes(out)
    image = nib.load(tmp_path / "a.nii.gz")
    (tmp_path / "b.nii").write_bytes(shell(tracks, "density", "-", "-", "--voxel", "5")[1])
    np.testing.assert_array_equal(nib.load(tmp_path / "b.nii").get_fdata(), image.get_fdata())
    assert image.get_fdata().max() >= 1
    labels = nib.Nifti1Image((image.get_fdata() > 0).astype(np.int16), image.affine)
    nib.save(labels, tmp_path / "labels.nii")
    code, out, err = shell(tracks, "connectome", "-", tmp_path / "labels.nii", "-")
    assert code == 0, err
    assert out == b",1\n1,60\n"
    code, out, err = shell(tracks, "screenshot", "-", "-o", "-", "--size", "60x40")
    assert code == 0, err
    assert Image.open(io.BytesIO(out)).size == (60, 40)


@pytest.mark.parametrize(
    ("data", "words", "says"),
    [
        (b"", ["info", "-"], "standard input is empty"),
        (b"GIF89a", ["info", "-"], "of no format known by its first bytes; add --format"),
        (b"TRACK", ["info", "-"], "standard input"),
        (b"mrtrix tracks\n", ["convert", "-", "b.fiblets"], "standard input"),
        (b"TRACK", ["info", "-", "--format", "xyz"], "no format has this suffix"),
        (b"TRACK", ["info", "a.trk", "--format", "tck"], "no file is -"),
        (b"TRACK", ["convert", "-", "-"], "add --format"),
        (b"TRACK", ["convert", "a.trk", "-"], "add --format"),
        (b"TRACK", ["verify", "-", "-"], "one standard input"),
        (b"TRACK", ["screenshot", "-", "-", "-o", "b.png"], "one standard input"),
        (b"TRACK", ["convert", "-", "b.tck", "--format", "trk", "--format", "tck"], "only one -"),
    ],
)
def test_what_cannot_be_is_one_sentence_without_temporary_names(shell, tmp_path, monkeypatch, data, words, says):
    monkeypatch.chdir(tmp_path)
    code, out, err = shell(data, *words)
    assert (code, out) == (1, b"")
    assert says in err
    assert err.count("\n") == 1
    assert "pvfiblets-pipe" not in err
    assert not list(tmp_path.iterdir())


def test_terminals_are_neither_read_nor_filled_with_bytes(monkeypatch, capsys, files):
    monkeypatch.setattr(sys, "stdin", SimpleNamespace(isatty=lambda: True))
    assert main(["info", "-"]) == 1
    assert "a terminal here" in capsys.readouterr().err
    monkeypatch.setattr(sys.stdout, "isatty", lambda: True, raising=False)
    assert main(["convert", str(files / "a.tck"), "-", "--format", "trk"]) == 1
    assert "a terminal here" in capsys.readouterr().err


@pytest.mark.more
def test_programs_joined_by_a_shell(files, brain, tmp_path):
    """Through three processes and real pipes; and into one that does not read, without a word."""
    command = f"{sys.executable} -m pvfiblets"
    line = (
        f"{command} convert {files}/a.trx - --format trk | {command} convert - - --format fiblets --quiet"
        f" | {command} convert - {tmp_path}/b.tck"
    )
    done = subprocess.run(["bash", "-o", "pipefail", "-c", line], capture_output=True, check=False, timeout=200)
    assert done.returncode == 0, done.stderr
    assert len(formats.read(tmp_path / "b.tck")) == len(brain)
    line = f"{command} convert {files}/a.trx - --format vtk | true; {command} info {files}/a.trx | true"
    done = subprocess.run(["bash", "-c", line], capture_output=True, check=False, timeout=200)
    assert b"Traceback" not in done.stderr
    assert b"Broken" not in done.stderr
