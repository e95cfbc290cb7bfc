"""Uploads through the front server, by real sockets, to a session's real process."""

from __future__ import annotations

import asyncio
import contextlib
from urllib.parse import quote

import pytest
import pyvista as pv

from pvfiblets import memory
from pvfiblets.web.launcher import WORKER
from pvfiblets.web.options import Options
from pvfiblets.web.scratch import Notes, remove
from pvfiblets.web.server import FrontServer
from tests.web import bombs
from tests.web.visitors import Browser

REFUSED = (
    "a" * 260 + ".ply", "a\n.ply", "a\r\nX: y.ply", "\x1b[2J.ply", ".a.ply", " a.ply", "<img src=x>.ply", "a&b.ply",
    "CON.ply", "com1.x.ply", "../a.ply", "b/a.ply", "b\\a.ply", "/etc/a.ply", "a.exe", "a", "", "a\0.ply", "a:b.ply",
    "session.json",
)  # fmt: skip
DAMAGED = {
    "outside.nhdr": b"NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: raw\ndata file: /etc/passwd\n\n",
    "damaged.trk": b"TRACK",
    "pieces.vtk": b"no such file",
}


async def post(browser, name, body):
    return await browser.post(f"/upload?name={quote(name, safe='')}", data=body)


async def aborted(browser, name):
    """Send a part of an upload, and hang up."""
    head = (
        f"POST /upload?name={name} HTTP/1.1\r\nHost: 127.0.0.1:{browser.gate.port}\r\nOrigin: {browser.base}\r\n"
        f"Cookie: {browser.cookies()}\r\nContent-Length: 3000000\r\n\r\n"
    )
    _, writer = await asyncio.open_connection("127.0.0.1", browser.gate.port)
    writer.write(head.encode() + bytes(1_500_000))
    await writer.drain()
    await asyncio.sleep(0.3)
    writer.transport.abort()


async def until(condition):
    async with asyncio.timeout(120):
        while not condition():
            await asyncio.sleep(0.05)


@pytest.mark.more
@pytest.mark.skipif(not memory.CAN_LIMIT, reason="only Linux limits the data of a process")
def test_uploads_by_a_real_session(tmp_path):
    root, apart = tmp_path / "root", tmp_path / "apart"
    root.mkdir()
    apart.mkdir()
    pv.Sphere().save(apart / "good.ply")
    good = (apart / "good.ply").read_bytes()
    bombs.gltf(apart / "bomb.gltf", 1000)

    def names():
        return sorted(path.name for path in root.rglob("*"))

    async def test():
        server = FrontServer(Options(port=0, root=str(root), memory=768 << 20), WORKER)
        try:
            await server.start()
            async with Browser(server) as browser:
                await browser.get("/")
                assert await browser.begin() == "ready"
                for name in REFUSED:
                    status, text = await post(browser, name, good)
                    assert (status, "\n" in text, str(root) in text) == (400, False, False), (name, text)
                assert names() == []

                await aborted(browser, "half.ply")
                await until(lambda: names() == [])

                assert (await post(browser, "good.ply", good))[0] == 200
                status, text = await post(browser, "good.ply", b"other")
                assert status == 409
                assert "exists already" in text
                for name, body in DAMAGED.items():
                    assert (await post(browser, name, body))[0] == 200
                await until(lambda: names() == ["good.ply"])
                assert (root / "good.ply").read_bytes() == good

                # VTK ends the process on this one.
                (session,) = server.launcher.sessions.values()
                assert (await post(browser, "bomb.gltf", (apart / "bomb.gltf").read_bytes()))[0] == 200
                await until(lambda: session.ended)
                assert "bomb.gltf" in session.failure
                assert names() == ["good.ply"]
        finally:
            await server.stop()

    asyncio.run(asyncio.wait_for(test(), 300))


def test_of_a_killed_session_only_what_was_not_opened_goes(tmp_path):
    session, root = tmp_path / "session", tmp_path / "root"
    session.mkdir()
    root.mkdir()
    stack = contextlib.ExitStack()
    hidden = stack.enter_context(Notes(session).private(root))
    for name in ("a.ply", "b.ply"):
        (hidden / name).write_bytes(b"x")
    (root / "a.ply").hardlink_to(hidden / "a.ply")
    (root / "b.ply").write_bytes(b"x")  # of the same name and content, but another file
    (root / "c.ply").write_bytes(b"x")
    remove(session)
    assert not hidden.exists()
    session.mkdir()  # for the process that only seemed to be killed
    stack.close()
    assert sorted(path.name for path in root.iterdir()) == ["b.ply", "c.ply"]
