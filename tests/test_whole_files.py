"""Files that cannot be written: the user's path, why, what to do, and nothing half left behind."""

from __future__ import annotations

import errno
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import pvfiblets
from pvfiblets.cli import main
from pvfiblets.formats import tck
from pvfiblets.streamlines import Streamlines
from pvfiblets.whole_files import naming_target, replacing

SUFFIXES = (".tck", ".trk", ".trx", ".vtk", ".vtp", ".fiblets")
OURS = (".tck", ".trk", ".trx", ".fiblets")  # the others are VTK's to write


@pytest.fixture
def lines():
    return Streamlines.from_list([np.cumsum(np.full((40, 3), 0.5), axis=0)])


def written(lines, path):
    if path.suffix == ".fiblets":
        pvfiblets.compress(lines).save(path)
    else:
        pvfiblets.write(path, lines)


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_a_folder_that_is_not_there_is_named(lines, tmp_path, suffix):
    path = tmp_path / "nowhere" / f"lines{suffix}"
    with pytest.raises(FileNotFoundError, match="there is no folder .*nowhere; make it first") as caught:
        written(lines, path)
    assert caught.value.filename == str(path)


@pytest.mark.skipif(not Path("/proc/self").is_dir(), reason="/proc is a folder that nobody can write to")
@pytest.mark.parametrize("suffix", SUFFIXES)
def test_a_folder_that_cannot_be_written_is_named(lines, suffix):
    path = Path(f"/proc/lines{suffix}")
    with pytest.raises(OSError, match="the folder /proc cannot be written to; choose another one") as caught:
        written(lines, path)
    assert caught.value.filename == str(path)


class Full:
    """A file on a disk that has room for a few bytes."""

    def __init__(self, file, room):
        self._file, self._room = file, room

    def write(self, data):
        self._room -= len(memoryview(data).cast("B"))
        if self._room < 0:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        return self._file.write(data)

    def __getattr__(self, name):
        return getattr(self._file, name)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._file.close()


@pytest.mark.parametrize("suffix", OURS)
def test_a_full_disk_is_told_with_what_is_free_and_leaves_the_old_file(lines, tmp_path, monkeypatch, suffix):
    path = tmp_path / f"lines{suffix}"
    path.write_bytes(b"old")
    before = Path.open
    monkeypatch.setattr(Path, "open", lambda self, mode="r", *more, **named: (
        Full(before(self, mode, *more, **named), 100) if mode == "wb" else before(self, mode, *more, **named)))
    with pytest.raises(OSError, match=r"no space is left for it \(.*free in .*MB\); make room there") as caught:
        written(lines, path)
    assert (caught.value.errno, caught.value.filename) == (errno.ENOSPC, str(path))
    assert path.read_bytes() == b"old"
    assert [found.name for found in tmp_path.iterdir()] == [path.name]


def test_the_command_says_it_in_one_line(lines, tmp_path, capsys):
    tck.write(tmp_path / "lines.tck", lines)
    target = tmp_path / "nowhere" / "lines.fiblets"
    assert main(["convert", str(tmp_path / "lines.tck"), str(target), "--quiet"]) == 1
    said = capsys.readouterr().err
    assert said == f"pvfiblets: {target}: there is no folder {target.parent}; make it first\n"


def test_errors_of_other_files_stay_as_they_are(tmp_path):
    with pytest.raises(FileNotFoundError) as caught, replacing(tmp_path / "out"):
        (tmp_path / "source").read_bytes()
    assert caught.value.filename == str(tmp_path / "source")
    assert not list(tmp_path.iterdir())
    broken = OSError(errno.EIO, "the source's disk is broken")
    with pytest.raises(OSError, match="is broken") as caught, naming_target(tmp_path / "out"):
        raise broken
    assert caught.value is broken


@pytest.mark.skipif(sys.platform == "win32", reason="no limit on the size of files")
@pytest.mark.parametrize("name", ["a.trx", "a.tck", "a.fiblets"])
def test_a_file_that_may_not_be_as_large_says_what_it_takes(name, tmp_path):
    """In a process of its own, whose files may have 64 kB."""
    code = """
import resource, signal, sys
from pvfiblets.cli import main
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (1 << 16, 1 << 16))
sys.exit(main(["convert", sys.argv[1], sys.argv[2], "--quiet"]))
"""
    from pvfiblets import formats
    from pvfiblets.synthetic import brain_streamlines

    formats.write(tmp_path / "source.trx", brain_streamlines(400, 1.0))
    target = tmp_path / "made" / name
    target.parent.mkdir()
    command = [sys.executable, "-c", code, str(tmp_path / "source.trx"), str(target)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120)
    assert done.returncode == 1, done.stdout
    assert done.stderr.count("\n") == 1
    assert f"{target}: it is larger than files may be here" in done.stderr
    assert list(target.parent.iterdir()) == []
