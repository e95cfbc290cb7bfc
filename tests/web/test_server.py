"""The front server, by real HTTP and WebSocket clients; the sessions behind it draw nothing (stub_worker.py)."""

import io
import json
import os
import signal
import socket
import subprocess
import sys
from pathlib import Path

import aiohttp
import pytest

from pvfiblets.web.server.access import LARGEST_MESSAGE
from tests.web.visitors import TOKEN, Browser, gate, message, raw, until


def alive(pid):
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    return Path(f"/proc/{pid}/stat").read_text().split()[2] != "Z" if Path("/proc").is_dir() else True


async def gone(pid):
    await until(lambda: not alive(pid))


async def test_the_state_of_a_session_is_told_to_its_browser_alone(tmp_path):
    async with gate(tmp_path) as server, Browser(server) as browser, Browser(server) as stranger:
        await browser.enter()
        told = json.loads((await browser.get("/status"))[1])
        assert told == {"state": "running", "connected": 0}
        async with browser.socket():
            assert json.loads((await browser.get("/status"))[1])["connected"] == 1
        status, text = await stranger.get("/status")
        assert status == 401
        assert "running" not in text
        await stranger.get(f"/?token={TOKEN}")
        assert json.loads((await stranger.get("/status"))[1]) == {"state": "none"}
        await browser.post("/end")
        assert json.loads((await browser.get("/status"))[1])["state"] == "none"


async def test_nothing_is_shown_without_the_token(tmp_path, caplog):
    async with gate(tmp_path) as server, Browser(server) as browser:
        for path in ("/", "/index.html", "/anything", "/download/x", f"/?token={TOKEN}x", "/?token="):
            status, text = await browser.get(path)
            assert status == 401
            assert "token" in text
            assert TOKEN not in text
        with pytest.raises(aiohttp.WSServerHandshakeError, match="401"):
            async with browser.socket():
                pass
        status, text = await browser.post("/token", data={"token": "wrong-wrong"})
        assert status == 401
        assert "not the token" in text
    assert caplog.text.count("refused") == 8
    assert TOKEN not in caplog.text
    assert "wrong-wrong" not in caplog.text


@pytest.mark.parametrize(
    "request_",
    ["GARBAGE", "GET / HTTP/9.9", "POST /session HTTP/1.1\r\nContent-Length: zz", "GET / HTTP/1.1\r\nHost: localhost"],
)
async def test_no_answer_names_versions_of_libraries(tmp_path, request_):
    async with gate(tmp_path) as server:
        head = (await raw(server, f"{request_}\r\nConnection: close\r\n\r\n".encode())).partition(b"\r\n\r\n")[0]
    assert b"Server: pvfiblets" in head.splitlines()
    assert b"aiohttp" not in head


async def test_the_token_opens_a_session_and_leaves_the_address(tmp_path):
    async with gate(tmp_path) as server, Browser(server) as browser:
        assert server.url == f"http://127.0.0.1:{server.port}/?token={TOKEN}"
        async with browser.http.get(server.url, allow_redirects=False) as answer:
            assert answer.status == 303
            assert answer.headers["Location"] == "/"
            cookie = answer.headers["Set-Cookie"]
            assert TOKEN not in cookie
            assert "HttpOnly" in cookie
            assert "SameSite=Lax" in cookie
        await browser.enter()
        async with browser.http.get(browser.base + "/index.html") as answer:
            assert "frame-ancestors" in answer.headers["Content-Security-Policy"]
            assert answer.headers["Server"] == "pvfiblets"  # no versions
            assert answer.headers["X-Content-Type-Options"] == "nosniff"
            assert (await answer.json())["cookie"] is None  # the process behind has no use for it
        async with browser.socket() as socket:
            await socket.send_bytes(message(b"hello"))
            assert (await socket.receive_bytes()) == message(b"hello")
        async with Browser(server) as other:  # by the form
            assert (await other.post("/token", data={"token": f" {TOKEN} "}))[0] == 200


async def test_foreign_pages_and_names_are_refused(tmp_path, caplog):
    async with gate(tmp_path) as server, Browser(server) as browser:
        await browser.enter()
        for origin in ("http://evil.example", "http://127.0.0.1:1", "null"):
            with pytest.raises(aiohttp.WSServerHandshakeError, match="403"):
                async with browser.socket(origin):
                    pass
            assert (await browser.post("/new", origin))[0] == 403
            assert (await browser.post("/upload?name=a.trk", origin, data=b"x"))[0] == 403
        assert (await browser.get("/", headers={"Host": "evil.example"}))[0] == 403
        async with browser.http.get(browser.base + "/ws") as answer:
            assert answer.status in (400, 403)
        async with browser.http.request("DELETE", browser.base + "/") as answer:
            assert answer.status == 405
    assert "foreign origin" in caplog.text


async def test_paths_that_climb_never_reach_a_session(tmp_path):
    async def get(server, path, cookies):
        return await raw(
            server, f"GET {path} HTTP/1.1\r\nHost: 127.0.0.1\r\nCookie: {cookies}\r\nConnection: close\r\n\r\n"
        )

    async with gate(tmp_path) as server, Browser(server) as browser:
        await browser.enter()
        cookies = browser.cookies()
        assert b"200 OK" in (await get(server, "/fine", cookies))
        for path in (
            "/../../etc/passwd",
            "/a/%2e%2e/%2e%2e/etc/passwd",
            "/a/..%2f..%2fetc",
            "/%252e%252e/x",
            "/a\\..\\b",
        ):
            answer = await get(server, path, cookies)
            assert b" 404 " in answer.partition(b"\r\n")[0]
            assert b"pid" not in answer


@pytest.mark.few(2)
@pytest.mark.parametrize("bad", [message(b"x" * LARGEST_MESSAGE), message(b"x", 2**32 - 1), b"short", "text"])
async def test_a_browser_that_sends_too_much_is_cut_off_and_may_come_back(tmp_path, bad):
    async with gate(tmp_path) as server, Browser(server) as browser:
        pid = await browser.enter()
        async with browser.socket() as socket:
            await (socket.send_str(bad) if isinstance(bad, str) else socket.send_bytes(bad))
            answer = await socket.receive()
            assert answer.type in (aiohttp.WSMsgType.CLOSE, aiohttp.WSMsgType.CLOSED, aiohttp.WSMsgType.CLOSING)
        async with browser.socket() as socket:
            await socket.send_bytes(message(b"again"))
            assert (await socket.receive_bytes()) == message(b"again")
        assert (await browser.pid()) == pid


async def test_what_is_cut_off_is_said_on_the_page(tmp_path):
    async with gate(tmp_path) as server, Browser(server) as browser:
        await browser.enter()
        for bad in (message(b"x" * LARGEST_MESSAGE), message(b"x", 2**32 - 1)):
            async with browser.socket() as socket:
                await socket.send_bytes(bad)
                await socket.receive()
        said = []
        while len(said) < 2:
            said = [told["say"] for told in json.loads((await browser.get("/told"))[1])]
        assert all("refused" in one and f"{LARGEST_MESSAGE:,} bytes" in one for one in said)


async def test_sessions_are_larger_than_messages_and_where_nothing_may_be_uploaded(tmp_path, monkeypatch):
    monkeypatch.setattr("pvfiblets.web.server.front.LARGEST_SESSION", 8 * LARGEST_MESSAGE)
    async with gate(tmp_path, upload=0) as server, Browser(server) as browser:
        await browser.enter()
        most = 8 * LARGEST_MESSAGE
        assert await browser.post("/session", data=io.BytesIO(b"x" * most)) == (200, str(most))
        assert (await browser.post("/session", data=io.BytesIO(b"x" * (most + 1))))[0] == 413
        assert (await browser.post("/upload?name=a.trk", data=b"x"))[0] == 413


async def test_uploads_have_a_limit(tmp_path):
    async with gate(tmp_path, upload=1000) as server, Browser(server) as browser:
        await browser.enter()
        assert await browser.post("/upload?name=a.trk", data=b"x" * 1000) == (200, "1000")
        assert (await browser.post("/upload?name=a.trk", data=b"x" * 1001))[0] == 413

        async def endless():
            for _ in range(5):
                yield b"x" * 500

        assert (await browser.post("/upload?name=a.trk", data=endless()))[0] == 411  # no length


async def test_every_browser_has_a_process_of_its_own_and_keeps_it(tmp_path):
    async with gate(tmp_path) as server, Browser(server) as one, Browser(server) as other:
        first, second = await one.enter(), await other.enter()
        assert first != second
        assert (await one.pid(), await other.pid()) == (first, second)
    await gone(first)  # with the server
    await gone(second)


async def test_shared_sessions_are_one_process(tmp_path):
    async with gate(tmp_path, shared=True) as server, Browser(server) as one, Browser(server) as other:
        pid = await one.enter()
        assert (await other.enter()) == pid
        await other.post("/end")  # one of them must not end it for all
        assert (await one.pid()) == pid


async def test_beyond_the_limit_there_is_a_page_until_a_place_is_free(tmp_path):
    async with (
        gate(tmp_path, limit=2) as server,
        Browser(server) as one,
        Browser(server) as two,
        Browser(server) as three,
    ):
        pid = await one.enter()
        await two.enter()
        status, text = await three.get(f"/?token={TOKEN}")
        assert status == 503
        assert "2 sessions are open" in text
        assert (await one.post("/end"))[0] == 200
        await gone(pid)
        await three.enter()


async def test_a_failing_session_touches_no_other_and_says_so(tmp_path):
    async with gate(tmp_path) as server, Browser(server) as one, Browser(server) as other:
        pid, kept = await one.enter(), await other.enter()
        async with one.socket() as lost, other.socket() as socket:
            os.kill(pid, signal.SIGKILL)
            assert (await lost.receive()).type in (aiohttp.WSMsgType.CLOSE, aiohttp.WSMsgType.CLOSED)
            await socket.send_bytes(message(b"still here"))
            assert (await socket.receive_bytes()) == message(b"still here")

        async def told():
            status, text = await one.get("/")
            return text if status == 410 else None

        assert "ended unexpectedly" in await until(told)
        assert (await other.pid()) == kept
        await one.post("/new")
        assert (await one.enter()) not in (pid, kept)


async def died(browser, server, state):
    """Kill the process of a browser's session, which had kept a state, and wait until that is known."""
    pid = await browser.pid()
    session = server.launcher.find(next(one.value for one in browser.http.cookie_jar if "session" in one.key))
    if state is not None:
        (session.folder / "session.json").write_text(state)
    os.kill(pid, signal.SIGKILL)
    await until(lambda: session.ended)
    return json.loads((await browser.get("/status"))[1])


async def test_the_last_state_of_a_dead_session_is_restored_to_its_browser_alone(tmp_path, monkeypatch):
    async with gate(tmp_path) as server, Browser(server) as one, Browser(server) as other:
        first, kept = await one.enter(), await other.enter()
        assert (await died(one, server, "mine"))["restore"]
        status, text = await one.get("/")
        assert status == 410
        assert "Restore" in text
        await one.post("/new?restore=1")
        assert (await one.enter()) not in (first, kept)

        async def told():
            return json.loads((await one.get("/told"))[1])

        assert await until(told) == [{"restore": True}]
        assert (await one.get("/kept"))[1] == "mine"
        await other.post("/new?restore=1")  # its own, which is whole, ends
        await other.enter()
        assert json.loads((await other.get("/told"))[1]) == []
        # A process that dies of what it restores takes nothing along; of one that kept nothing there is nothing.
        assert (await died(one, server, "of the start"))["restore"]
        await one.post("/new?restore=1")
        await one.enter()
        assert (await one.get("/kept"))[1] == "mine"
        assert not (await died(other, server, None))["restore"]
        # Without, and after its time, it goes.
        scratch = server.launcher._scratch
        assert (await died(one, server, "of the start"))["restore"]
        await one.post("/new")
        assert not list(scratch.folder.rglob("*.json"))
        await one.enter()
        assert (await died(one, server, "late"))["restore"]
        assert len(list(scratch.folder.rglob("*.json"))) == 1
        monkeypatch.setattr("pvfiblets.web.server.launcher.RESCUED", -1.0)
        await server.launcher.end_idle()
        assert not list(scratch.folder.rglob("*.json"))
        assert not json.loads((await one.get("/status"))[1])["restore"]


async def test_a_session_that_cannot_start_says_why(tmp_path):
    (tmp_path / "fail").write_text("there is no OpenGL <here>")
    async with gate(tmp_path) as server, Browser(server) as browser:
        await browser.get(f"/?token={TOKEN}")
        assert await browser.begin() == "ask again"
        status, text = await browser.get("/")
        assert status == 410
        assert "there is no OpenGL &lt;here&gt;" in text


async def test_a_process_that_cannot_be_started_is_said_and_takes_no_place(tmp_path):
    async with gate(tmp_path, limit=1) as server, Browser(server) as browser:
        await browser.enter()
        await browser.post("/end")
        command, server.launcher._command = server.launcher._command, (str(tmp_path / "no-such-program"),)
        await browser.get("/")
        assert await browser.begin() == "ask again"
        status, text = await browser.get("/")
        assert status == 410
        assert "no process could be started: No such file or directory" in text
        assert not server.launcher.sessions
        server.launcher._command = command
        await browser.post("/new")
        assert await browser.begin() == "ready"


async def test_sessions_without_a_browser_end_and_others_wait(tmp_path):
    async with gate(tmp_path, timeout=900.0) as server, Browser(server) as left, Browser(server) as stays:
        pid, kept = await left.enter(), await stays.enter()

        async def pass_time(seconds):
            for session in server.launcher.sessions.values():
                session.seen -= seconds
            await server.launcher.end_idle()

        async with stays.socket() as socket:
            async with left.socket():
                await pass_time(1000.0)
                assert alive(pid)  # connected
            await until(lambda: sum(one.connections for one in server.launcher.sessions.values()) == 1)
            await pass_time(800.0)
            assert (await left.pid()) == pid  # a reload within the time finds it
            await pass_time(800.0)
            await gone(pid)
            await socket.send_bytes(message(b"mine"))
            assert (await socket.receive_bytes()) == message(b"mine")
        assert alive(kept)
        assert (await left.enter()) != pid  # a new one, without a word


async def test_nobody_speaks_to_a_session_past_the_gate(tmp_path):
    async with gate(tmp_path) as server, Browser(server) as browser:
        await browser.enter()
        (session,) = server.launcher.sessions.values()
        async with browser.http.get(f"http://127.0.0.1:{session.port}/index.html") as answer:
            assert answer.status == 403
        headers = {"X-Pvfiblets-Key": "0" * 64}
        async with browser.http.get(f"http://127.0.0.1:{session.port}/index.html", headers=headers) as answer:
            assert answer.status == 403
        assert session.key not in repr(session)


IDLE = """
import asyncio
import sys
import trame.app
from pvfiblets.web.worker import listen

sys.argv = ["worker", "--timeout", "1"]  # as if trame's own clock were set to a second instead of 300
server = trame.app.get_server()


def ready(**_):
    print(server.port, flush=True)
    asyncio.get_running_loop().call_later(1.5, lambda: print("later", flush=True))  # than its clock's


server.controller.on_server_ready.add(ready)
listen(server)
print("stopped", flush=True)
"""


def test_a_session_has_no_clock_of_its_own():
    process = subprocess.Popen(
        [sys.executable, "-c", IDLE], stdout=subprocess.PIPE, stdin=subprocess.DEVNULL, text=True
    )
    try:
        port = int(process.stdout.readline())
        assert process.stdout.readline() == "later\n"
        with socket.create_connection(("127.0.0.1", port), timeout=60.0):
            pass
        assert process.poll() is None
    finally:
        process.kill()
        assert "stopped" not in process.communicate()[0]
