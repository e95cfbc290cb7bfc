"""Small files that swell: a session refuses them in a sentence, keeps nothing of them, and goes on."""

import asyncio
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import threading

import pytest

import pvfiblets
from pvfiblets.cli.serve import memory_of
from pvfiblets.support import memory
from pvfiblets.web.server import endings
from pvfiblets.web.server.front import FrontServer
from pvfiblets.web.server.launcher import WORKER
from pvfiblets.web.server.options import SMALLEST_MEMORY, Options, chosen_memory
from tests.web import bombs
from tests.web.desk import Desk
from tests.web.visitors import Browser, gate, run, until

pytestmark = pytest.mark.skipif(not memory.CAN_LIMIT, reason="only Linux limits the data of a process")

ROOM = 250_000_000
BOMBS = {
    "one.trk.gz": lambda path: bombs.trk_of_one(path, 400),
    "many.trk.gz": lambda path: bombs.trk_that_says_so(path, 400),
    "lines.trx": lambda path: bombs.trx(path, 400),
    "lines.tt.gz": lambda path: bombs.tt(path, 400),
    "head.nii.gz": lambda path: bombs.nii(path, 400),
    "head.nrrd": lambda path: bombs.nrrd(path, 400),
    "head.vti": lambda path: bombs.vti(path, 400),
    "mesh.vtp": lambda path: bombs.vtp(path, 400),
    # These say less than they take.
    "empty.trk.gz": lambda path: bombs.trk_of_none(path, 400),
    "track.tt.gz": lambda path: bombs.tt_that_says_less(path, 400),
    "scaled.nii.gz": lambda path: bombs.nii(path, 80, 2.0),
    # These say more than they hold, and would make VTK end the process.
    "points.ply": lambda path: bombs.ply(path, 4000),
    "points.vtk": lambda path: bombs.vtk(path, 4000),
}
SAYS_MORE = ("points.ply", "points.vtk")
SAYS_LESS = ("empty.trk.gz", "track.tt.gz", "scaled.nii.gz")
SWELLS = ("many.trk.gz", "lines.trx", "lines.tt.gz")


@pytest.fixture(scope="module")
def opened(tmp_path_factory, lines):
    """Return what became of each bomb, and of a file like any after them."""
    folder = tmp_path_factory.mktemp("bombs")
    pvfiblets.write(folder / "lines.trk", lines)
    shutil.copy(folder / "lines.trk", folder / "after.trk")
    for name, make in BOMBS.items():
        make(folder / name)
        assert (folder / name).stat().st_size < 2_000_000
    command = [sys.executable, "-m", "tests.web.bombs", str(folder), str(ROOM), *BOMBS, "after.trk"]
    environment = os.environ | memory.ENVIRONMENT
    done = subprocess.run(command, capture_output=True, text=True, timeout=300, env=environment)
    assert done.returncode == 0, done.stderr[-2000:]
    found = [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")]
    return {one["name"]: one for one in found}


@pytest.mark.few(1)
@pytest.mark.parametrize("name", BOMBS)
def test_a_bomb_is_refused_in_one_sentence_and_leaves_nothing(opened, name):
    found = opened[name]
    assert found["said"].startswith(f"ValueError: {name} was not opened: ")
    if name in SAYS_MORE:
        assert "rows that its header says" in found["said"]
    elif name in SWELLS:
        assert re.search(r"it inflates to \d+ MB, [\d,]+ times its size, .* `pvfiblets convert` makes", found["said"])
    else:
        assert re.search(r"of the \d+ MB that a session may have; remove layers, .*er --max-memory$", found["said"])
        assert ("it needs more memory than is left" if name in SAYS_LESS else "it says that it takes") in found["said"]
    assert found["layers"] == found["kept"] == ["lines.trk"]
    assert found["left"] == []
    assert found["job"] == {}


def test_bombs_leave_a_page_that_answers_and_memory_that_is_free(opened):
    for found in opened.values():
        assert found["gap"] < 2.0, found
    assert opened["after.trk"]["said"] == ""
    assert opened["after.trk"]["layers"] == ["lines.trk", "after.trk"]
    # What the first bombs made the program load and compile stays, and the allocator keeps some pieces.
    assert sum(found["more"] for found in opened.values()) < 60_000_000


async def test_what_is_opened_meanwhile_waits_for_its_turn_and_the_page_names_it(scene, folder):
    desk = Desk(scene, folder)
    go, seen = threading.Event(), []

    def slow(progress, cancel):
        while not go.wait(0.01):
            if cancel():
                raise ValueError("stopped")
        return "done"

    files = desk.files
    first = asyncio.create_task(files.run_in_background("a.trk", slow, "reading"))
    await until(lambda: desk.page.job.get("text") == "a.trk: reading")
    others = [asyncio.create_task(files.run_in_background(f"{i}.trk", slow, "reading")) for i in range(16)]
    await until(lambda: desk.page.job.get("then"))
    seen.append(desk.page.job)
    with pytest.raises(ValueError, match="16 others wait"):
        await files.run_in_background("one too many.trk", slow, "reading")
    files.cancel()
    with pytest.raises(ValueError, match="stopped"):
        await first
    await until(lambda: desk.page.job.get("text") == "0.trk: reading")
    seen.append(desk.page.job)
    go.set()
    assert await asyncio.gather(*others) == ["done"] * 16
    assert seen[0]["text"] == "a.trk: reading"
    assert seen[0]["then"].startswith("then 0.trk, 1.trk, ")
    assert seen[1]["text"] == "0.trk: reading"  # what is cancelled makes room for the next
    assert seen[1]["then"].startswith("then 1.trk, ")
    assert desk.page.job == {}


def test_what_cannot_be_drawn_for_want_of_memory_is_not_kept(scene, folder, monkeypatch):
    desk = Desk(scene, folder)
    scene.open("lines.fiblets")
    state, kept = scene.state, dict(scene.store.loaded)

    def add_actor(*_):
        raise MemoryError("Unable to allocate 3.00 GiB for an array with shape (3, 1) and data type float32")

    monkeypatch.setattr("pvfiblets.web.scene.scene.add_actor", add_actor)
    with pytest.raises(ValueError, match="ball.ply was not opened: it needs more memory than is left; remove"):
        asyncio.run(desk.files.open("ball.ply"))
    assert scene.state is state
    assert scene.store.loaded == kept


def test_what_a_session_may_have_is_chosen_checked_and_said(monkeypatch, tmp_path):
    monkeypatch.setattr("pvfiblets.web.server.options.of_machine", lambda: 100 * 2**30)
    assert chosen_memory("auto", 1) == 80 * 2**30
    assert chosen_memory("auto", 2) == 40 * 2**30
    assert chosen_memory("auto", 8) == 20 * 2**30  # few are full at once
    assert chosen_memory("3G", 8) == 3 * 2**30
    monkeypatch.setattr("pvfiblets.web.server.options.of_machine", lambda: 2**30)
    assert chosen_memory("auto", 8) == SMALLEST_MEMORY
    monkeypatch.setattr("pvfiblets.web.server.options.of_machine", lambda: 0)
    assert chosen_memory("auto", 8) is None
    with pytest.raises(ValueError, match="--max-memory 'lots' is no size of memory; give one such as 4G"):
        chosen_memory("lots", 8)
    with pytest.raises(ValueError, match=r"--max-memory 100 MB: a session needs 640 MB .* give at least that"):
        Options(root=str(tmp_path), token=None, memory=100 << 20).checked()
    monkeypatch.setattr("pvfiblets.web.server.options.CAN_LIMIT", False)
    with pytest.raises(ValueError, match="--max-memory: this system cannot"):
        Options(root=str(tmp_path), token=None, memory=2**30).checked()
    options = Options(root=str(tmp_path), token=None, memory=3 * 2**30)
    assert memory_of(options) == "A session may have 3.0 GB of memory (--max-memory)."
    assert "no limit of memory: this system cannot" in memory_of(Options(root=str(tmp_path), token=None))


async def _ending(server, browser):
    """Return the page of a session that ends by itself."""
    await browser.get("/")
    await browser.begin()  # as the script of the page does; until then there is no process
    for _ in range(600):
        status, text = await browser.get("/")
        if status == 410:
            return re.sub(r"\s+", " ", text)
        await asyncio.sleep(0.1)
    raise AssertionError("the session did not end")


@pytest.mark.more
def test_a_session_beyond_its_resources_is_reported(tmp_path):
    async def test():
        server = FrontServer(Options(port=0, root=str(tmp_path), memory=300 << 20), WORKER)
        try:
            await server.start()
            async with Browser(server) as browser:
                return await _ending(server, browser)
        finally:
            await server.stop()

    page = run(test())
    assert re.search(r"--max-memory 300 MB: a session takes \d+ MB on this machine .* with \d+ MB or more<", page)


@pytest.mark.more
def test_a_file_with_which_vtk_ends_the_process_is_named(tmp_path):
    bombs.gltf(tmp_path / "points.gltf", 1000)

    async def test():
        options = Options(port=0, root=str(tmp_path), mesh=[str(tmp_path / "points.gltf")], memory=768 << 20)
        server = FrontServer(options, WORKER)
        try:
            await server.start()
            async with Browser(server) as browser:
                return await _ending(server, browser)
        finally:
            await server.stop()

    page = run(test())
    assert "ran out of memory (a session may have 768 MB) while it opened points.gltf; open a smaller file, or" in page


def test_a_process_that_c_ends_for_want_of_memory_has_a_sentence(tmp_path, caplog):
    """The stub dies as VTK does."""
    (tmp_path / "abort").write_text("head.glb")

    async def test():
        async with gate(tmp_path, memory=2**30, token=None) as server, Browser(server) as browser:
            return await _ending(server, browser)

    page = run(test())
    assert "its process ran out of memory (a session may have 1.0 GB) while it opened head.glb; open a smaller" in page
    assert "larger --max-memory" in page
    assert "exit code" not in page
    assert "SIGABRT" in caplog.text


def test_other_ends_are_told_apart():
    killed = endings.reason(-signal.SIGKILL, [], "", 2**30)
    assert "ended unexpectedly: the system stopped it, most likely since this machine ran out of memory" in killed
    assert endings.reason(-signal.SIGSEGV, ["WARNING: something"], "a.trk", None) == (
        "its process ended unexpectedly while it opened a.trk"
    )
    assert endings.reason(0, [], "", None) == "its process ended unexpectedly"
    assert endings.reason(-6, ["  what():  std::bad_alloc"], "", None).startswith("its process ran out of memory; ")
    assert [endings.shown(code) for code in (3, -9, -250)] == ["exit code 3", "SIGKILL", "signal 250"]
