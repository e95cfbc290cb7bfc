"""What people get wrong on the command line: one clear sentence each, which names the word, and no traceback."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import nibabel as nib
import numpy as np
import pytest

from pvfiblets import formats
from pvfiblets.cli import main
from pvfiblets.synthetic import brain_streamlines


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("mistakes")
    brain = brain_streamlines(20, 2.0, seed=3, fa=True)
    formats.write(folder / "a.trx", brain)
    formats.write(folder / "a b ü.tck", brain)
    assert main(["convert", str(folder / "a.trx"), str(folder / "a.fiblets"), "--quiet"]) == 0
    (folder / "folder").mkdir()
    (folder / "empty.tck").touch()
    (folder / "text.tck").write_text("hello")
    nib.save(nib.Nifti1Image(np.zeros((4, 4, 4), np.int16), np.eye(4)), folder / "zeros.nii")
    return folder


MISUSED = [
    ("convert a.trx b.fiblets --max-eror 1", "unrecognized arguments: --max-eror 1; did you mean --max-error?"),
    ("compres a.trx b.fiblets", "invalid choice: 'compres'"),
    ("infos a.trx", "did you mean info?"),
    ("convert a.trx b.fiblets --effort hihg", "did you mean high?"),
    ("convert a.trx b.fiblets c.fiblets", "unrecognized arguments: c.fiblets"),
    ("convert a.trx", "the following arguments are required: OUT"),
    ("convert a.trx b.fiblets --max-error big", "--max-error: 'big' is no number"),
    ("convert a.trx b.fiblets --max-error 0", "--max-error: 0 is not above zero"),
    ("convert a.trx b.fiblets --max-error -1", "--max-error: -1 is not above zero"),
    ("convert a.trx b.fiblets --max-angle 900", "--max-angle: 900 is not above 0 and up to 90 degrees, or none"),
    ("convert a.trx b.fiblets --per-point-bits 12", "invalid choice: 12 (choose from"),
    ("demo --streamlines 1.5", "--streamlines: '1.5' is no whole number"),
    ("density a.trx d.nii", "one of the arguments --voxel --like is required"),
    ("screenshot a.trx -o a.png --size 10", "'10' is not WIDTHxHEIGHT, such as 1200x900"),
    ("screenshot a.trx -o a.png --size 10x16385", "10x16385: each side must be from 1 to 16384 pixels"),
    ("screenshot a.trx -o a.png --clim 1", "--clim: expected 2 arguments"),
    ("batch convert a.trx", "the following arguments are required: -o/--output"),
]

WRONG = [
    ("info missing.tck", "missing.tck: No such file"),
    ("info folder", "folder is a folder; give a file of one of .*.fiblets, .*.tck"),
    ("info zeros.nii", "zeros.nii: no format has this suffix; .*.fiblets, .*.tck"),
    ("info '~/missing.tck'", "missing.tck: No such file"),
    ("info 'no such ü.tck'", "no such ü.tck: No such file"),
    ("convert '*.nothing' b.fiblets", r"\*.nothing: no format has this suffix"),
    ("convert a.trx b", "b: no format has this suffix; .*.fiblets, .*.tck"),
    ("convert a.trx b.trk.gz", r"b.trk.gz: the format .trk.gz has no write\(\); formats that have: .fib, .fiblets"),
    ("convert a.trx nowhere/b.tck", "nowhere/b.tck: there is no folder .*nowhere; make it first"),
    ("convert a.trx ./a.trx", "a.trx would be overwritten by itself; give another name"),
    ("convert a.trx b.fiblets --per-point md", "no per-point array 'md'; the streamlines have: fa"),
    ("convert a.trx b.trk --max-error 1", "--max-error, .* are for .fiblets files; b.trk is of another format"),
    ("convert empty.tck b.fiblets", "empty.tck, byte 0: found b'', expected the line 'mrtrix tracks'"),
    ("convert text.tck b.fiblets", "text.tck, byte 0: found b'hello', expected the line"),
    ("convert https://example.org/a.tck b.fiblets", "https://example.org/a.tck is an address; .*fetch the file first"),
    ("convert a.trx https://example.org/b.tck", "https://example.org/b.tck is an address, and files are written here"),
    ("screenshot https://example.org/a.tck -o a.png", "https://example.org/a.tck is an address; .*fetch the file"),
    ("convert a.trx b.fiblets --max-memory much", "'much' is no size of memory; give one such as 4G"),
    ("verify a.trx a.fiblets", "a.trx is no .fiblets file; give the compressed file first, then its original"),
    ("verify a.fiblets text.tck", "text.tck, byte 0: found b'hello'"),
    ("table a.trx t.csv --group AF", "a.trx has no group 'AF'; it has: callosum"),
    ("table a.trx nowhere/t.csv", "nowhere/t.csv: there is no folder .*nowhere; make it first"),
    ("density a.trx d.png --voxel 2", "d.png is no name of a NIfTI file; let it end in .nii or .nii.gz"),
    ("density a.trx d.nii --voxel 1 2", "--voxel has 2 numbers; give one side in mm, or three"),
    ("density a.trx d.nii --voxel 2 --contrast md", "a.trx has no array 'md' of single numbers; there are: bundle, fa"),
    ("connectome a.trx zeros.nii m.xyz", "m.xyz has no suffix of a matrix; use one of .csv"),
    ("connectome a.trx zeros.nii m.csv --radius -1", "radius is -1.0; give mm, 0 or more"),
    ("screenshot a.trx -o a.doc", "a.doc: pictures are written as .png, .jpg, .bmp or .tif"),
    ("screenshot missing.tck -o a.png", "missing.tck: No such file"),
    ("serve missing.tck --port 0", "missing.tck: No such file"),
    ("serve a.trx --port 99999999", "--port 99999999: a port is from 0 to 65535"),
    ("serve --root nowhere", "nowhere: not a folder; --root names the one"),
    ("report --only nothing -o out", "no study 'nothing'; choose among codec"),
    ("report -o a.trx", "a.trx: it is a file; name a folder"),
    ("demo --output a.trx", "a.trx: it is a file; name a folder"),
]  # fmt: skip

DRAWN = [
    ("screenshot a.trx -o nowhere/a.png", "nowhere/a.png: there is no folder .*nowhere; make it first"),
    ("screenshot a.trx -o a.png --scalars md", "no array 'md'. Per point: "),
    ("screenshot a.trx -o a.png --color blurple", "Invalid color input: .blurple."),
    ("screenshot a.trx -o a.png --cmap blurple", "cmap is 'blurple', which is no colour map; give a name"),
    ("screenshot a.trx -o a.png --groups AF", "no group 'AF'; there are: 'callosum'"),
    ("screenshot a.trx -o a.png --clip blob", "the kind of --clip is 'blob'; choose one of plane, slab"),
]  # fmt: skip


@pytest.fixture
def here(folder, monkeypatch, tmp_path):
    monkeypatch.chdir(folder)
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.delenv("DISPLAY", raising=False)
    before = sorted(folder.iterdir())
    yield folder
    left = [path for path in sorted(folder.iterdir()) if path not in before]
    assert all(path.name == "out" for path in left), left  # a report's folder is made first


@pytest.mark.parametrize(("words", "says"), MISUSED)
def test_misused_commands_end_with_2_and_say_how_to_use_them(here, capsys, words, says):
    with pytest.raises(SystemExit) as done:
        main(shlex.split(words))
    assert done.value.code == 2
    said = capsys.readouterr().err
    assert said.startswith("usage: pvfiblets ")
    last = said.splitlines()[-1]
    assert says in last
    assert last.startswith("pvfiblets")
    command = words.split()[0]
    assert command in ("compres", "infos") or f"usage: pvfiblets {command}" in said


@pytest.mark.parametrize(("words", "says"), [*WRONG, *DRAWN])
def test_what_cannot_be_done_ends_with_1_and_one_sentence(here, capsys, words, says):
    assert main(shlex.split(words)) == 1
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.count("\n") == 1
    assert re.match(f"pvfiblets: (|.*/|there is |--step, ){says}", captured.err), captured.err


def test_names_with_blanks_and_other_letters_are_as_good(here, capsys, tmp_path):
    target = tmp_path / "ö ü.fiblets"
    assert main(["convert", "a b ü.tck", str(target), "--json"]) == 0
    assert main(["info", str(target)]) == 0
    assert "ö ü.fiblets" in capsys.readouterr().out
    assert Path(target).exists()
