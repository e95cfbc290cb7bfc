"""Temporary files of sessions and servers that were killed."""

import asyncio
import os
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

from pvfiblets.web.server.scratch import PRIVATE, Notes, Scratch
from tests.web.test_server import Browser, gate

SERVER = """
import sys, time
from pathlib import Path
from pvfiblets.web.server.scratch import Notes, Scratch
scratch = Scratch()
folder = scratch.session()
(folder / "lines.trk").write_text("large")
with Notes(folder).private(Path(sys.argv[1])) as home:
    (home / "part.trk").write_text("half of it")
    print(scratch.folder, home, sep="\\n", flush=True)
    time.sleep(600)
"""


@pytest.fixture(autouse=True)
def temporary(tmp_path, monkeypatch):
    """Let everything temporary lie in a folder of the test's own."""
    found = tmp_path / "tmp"
    found.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(found))
    monkeypatch.setenv("TMPDIR", str(found))
    return found


@pytest.mark.parametrize("how", ["killed", "ended"])
async def test_what_a_session_left_goes_with_it(tmp_path, temporary, how):
    (tmp_path / ".pvfiblets-part").mkdir()
    (tmp_path / ".pvfiblets-part" / "half.trk").write_text("half of it")
    async with gate(tmp_path) as found, Browser(found) as browser:
        pid = await browser.enter()
        (session,) = found.launcher.sessions.values()
        assert (session.folder / "session.tmp").read_text() == str(pid)
        assert session.folder.is_relative_to(temporary)
        if how == "killed":
            os.kill(pid, signal.SIGKILL)
        else:
            await found.launcher.end(session)
        while session.folder.exists():
            await asyncio.sleep(0.02)
        assert not (tmp_path / ".pvfiblets-part").exists()
        assert len(list(temporary.iterdir())) == 1  # the server's own
    assert list(temporary.iterdir()) == []


@pytest.mark.skipif(sys.platform == "win32", reason="locks of files are POSIX's")
def test_a_server_takes_away_what_dead_ones_left_and_no_other(tmp_path, temporary):
    def start():
        process = subprocess.Popen([sys.executable, "-c", SERVER, str(tmp_path)], stdout=subprocess.PIPE, text=True)
        return process, Path(process.stdout.readline().strip()), Path(process.stdout.readline().strip())

    dead, living = start(), start()
    others = [temporary / "pvfiblets-serve-notes.txt", temporary / "pvfiblets-serve-folder", temporary / "data"]
    others[0].write_text("somebody's")
    others[1].mkdir()
    others[2].mkdir()
    try:
        dead[0].kill()
        dead[0].wait(30)
        assert dead[1].exists()
        assert (dead[2] / "part.trk").exists()
        scratch = Scratch()
        assert not dead[1].exists()
        assert not dead[2].exists()
        assert (living[2] / "part.trk").exists()
        assert len(list(living[1].rglob("lines.trk"))) == 1
        assert all(other.exists() for other in others)
        scratch.close()
        assert not scratch.folder.exists()
        scratch.close()
    finally:
        for process, *_ in (dead, living):
            process.kill()
            process.wait(30)
            process.stdout.close()


def test_nothing_but_what_is_private_is_removed(tmp_path):
    scratch = Scratch()
    folder = scratch.session()
    kept, private = tmp_path / "data", tmp_path / f"{PRIVATE}1"
    for place in (kept, private):
        place.mkdir()
        (place / "file").write_text("text")
    (tmp_path / f"{PRIVATE}link").symlink_to(kept)
    (folder / "notes").write_text(f"{kept}\n{private}\n{tmp_path / (PRIVATE + 'link')}\n{tmp_path / 'missing'}")
    scratch.close()
    assert (kept / "file").exists()
    assert not private.exists()


def test_a_private_folder_goes_whatever_happens(tmp_path):
    notes = Notes(tmp_path)

    def fail():
        with notes.private(tmp_path) as home:
            (home / "file").write_text("text")
            assert (tmp_path / "notes").read_text() == str(home)
            raise RuntimeError("no room")

    with pytest.raises(RuntimeError, match="no room"):
        fail()
    assert not list(tmp_path.glob(f"{PRIVATE}*"))
    assert (tmp_path / "notes").read_text() == ""
