"""Uploads through the front server, by real sockets, to a session's real process."""

import asyncio
import contextlib
from urllib.parse import quote

import aiohttp
import msgpack
import pytest
import pyvista as pv

from pvfiblets.support import memory
from pvfiblets.web.server.access import Access, RefusedError
from pvfiblets.web.server.front import FrontServer
from pvfiblets.web.server.launcher import WORKER
from pvfiblets.web.server.options import Options
from pvfiblets.web.server.rpc_allowlist import MalformedError, check_call, guard_messages
from pvfiblets.web.server.scratch import Notes, remove
from tests.web import bombs
from tests.web.visitors import TOKEN, Browser, gate, message, raw, until

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


async def aborted(browser, name, begun):
    """Send a part of an upload, and hang up when it has begun."""
    head = (
        f"POST /upload?name={name} HTTP/1.1\r\nHost: 127.0.0.1:{browser.gate.port}\r\nOrigin: {browser.base}\r\n"
        f"Cookie: {browser.cookies()}\r\nContent-Length: 3000000\r\n\r\n"
    )
    _, writer = await asyncio.open_connection("127.0.0.1", browser.gate.port)
    writer.write(head.encode() + bytes(1_500_000))
    await writer.drain()
    await until(begun)
    writer.transport.abort()


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
                await aborted(browser, "half.ply", names)
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


HOST = "Host: 127.0.0.1\r\nConnection: close\r\n"


REQUESTS = [
    ("GET / HTTP/1.1\r\nConnection: close\r\n\r\n", 400),  # no Host
    ("GET / HTTP/1.1\r\nHost: [:::::]\r\nConnection: close\r\n\r\n", 400),
    ("GET / HTTP/1.1\r\nHost: \xff\r\nConnection: close\r\n\r\n", 400),
    (f"GET /%0d%0aSet-Cookie:%20a=b HTTP/1.1\r\n{HOST}\r\n", 404),
    (f"GET /%0d%0aSet-Cookie:%20a=b?token={TOKEN} HTTP/1.1\r\n{HOST}\r\n", 404),
    (f"GET /%250d%250a?token={TOKEN} HTTP/1.1\r\n{HOST}\r\n", 404),
    (f"GET /?token={TOKEN}&x=%0d%0aSet-Cookie:%20a=b HTTP/1.1\r\n{HOST}\r\n", 303),
    (f"GET /?token=%ff%fe HTTP/1.1\r\n{HOST}\r\n", 401),
    (f"GET http://evil.example/ HTTP/1.1\r\n{HOST}\r\n", 400),
    (f"GET @evil.example/ HTTP/1.1\r\n{HOST}\r\n", 400),
    (f"OPTIONS * HTTP/1.1\r\n{HOST}\r\n", 400),
    (f"CONNECT evil.example:80 HTTP/1.1\r\n{HOST}\r\n", 400),
    (f"GET / HTTP/1.1\r\n{HOST}Cookie: \xff\udcfe=\xff; pvfiblets-pass-1=\xff\r\n\r\n", 401),
    (f"GET / HTTP/1.1\r\n{HOST}X: {'x' * 9000}\r\n\r\n", 400),
    (f"GET / HTTP/1.1\r\n{HOST}" + "".join(f"X{n}: y\r\n" for n in range(500)) + "\r\n", 400),
    (f"GET /{'x' * 9000} HTTP/1.1\r\n{HOST}\r\n", 400),
    (f"GET / HTTP/9.9\r\n{HOST}\r\n", 400),
    (f"GET / HTTP/1.1\r\n{HOST}Bad Header\r\n\r\n", 400),
    ("\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03" + "\x00" * 50, 400),  # TLS
    ("SSH-2.0-OpenSSH_9.6\r\n\r\n", 400),
    (f"POST /token HTTP/1.1\r\n{HOST}Origin: http://[::\r\nContent-Length: 0\r\n\r\n", 403),
    (
        f"POST /token HTTP/1.1\r\n{HOST}Origin: http://127.0.0.1\r\nContent-Length: 9\r\n"
        "Content-Type: application/x-www-form-urlencoded; charset=none-such\r\n\r\ntoken=%ff",
        401,
    ),
    (
        f"POST /token HTTP/1.1\r\n{HOST}Origin: http://127.0.0.1\r\nContent-Length: 9\r\n"
        "Content-Type: multipart/form-data\r\n\r\ntoken=abc",
        401,
    ),
    (f"POST /token HTTP/1.1\r\n{HOST}Origin: http://127.0.0.1\r\nContent-Length: 300000\r\n\r\n" + "a=b&" * 75000, 413),
    (f"POST /token HTTP/1.1\r\n{HOST}Origin: http://127.0.0.1\r\nContent-Length: 400\r\n\r\n" + "a=b&" * 100, 400),
    (f"POST /token HTTP/1.1\r\n{HOST}Origin: http://127.0.0.1\r\nTransfer-Encoding: chunked\r\n\r\nzz\r\n\r\n", 400),
    (f"GET /ws HTTP/1.1\r\n{HOST}Origin: http://127.0.0.1\r\nUpgrade: websocket\r\n\r\n", 401),
]


async def test_what_cannot_be_read_has_an_answer_and_no_traceback(tmp_path, caplog):
    async def check(server, text, status):
        answer = await raw(server, text.encode("latin-1", "surrogateescape"))
        head = answer.partition(b"\r\n\r\n")[0]
        assert head.startswith(b"HTTP/1."), (text, answer)
        assert int(head.split()[1]) == status, text
        assert b"\nset-cookie: a" not in head.lower()
        assert b"Traceback" not in answer

    async with gate(tmp_path) as server:
        await asyncio.gather(*(check(server, text, status) for text, status in REQUESTS))
    assert len(caplog.records) > 10
    assert not [record for record in caplog.records if record.exc_info]
    assert TOKEN not in caplog.text
    assert all(record.getMessage().isprintable() for record in caplog.records)


async def test_a_session_is_told_nothing_malformed(tmp_path, caplog):
    async with gate(tmp_path) as server, Browser(server) as browser:
        await browser.enter()
        head = f"{HOST}Cookie: {browser.cookies()}\r\nOrigin: http://127.0.0.1\r\n"
        for text, status in (
            (f"GET /a%0d%0ab HTTP/1.1\r\n{head}\r\n", 404),
            (f"GET /a%00b HTTP/1.1\r\n{head}\r\n", 404),
            (f"GET //[x HTTP/1.1\r\n{head}\r\n", None),
            (f"GET /ws HTTP/1.1\r\n{head}\r\n", 400),
            (f"GET /ws HTTP/1.1\r\n{head}Upgrade: websocket\r\nSec-WebSocket-Version: 99\r\n\r\n", 400),
            (f"GET /begin HTTP/1.1\r\n{head}\r\n", 400),
            (f"POST /upload HTTP/1.1\r\n{head}Content-Length: -5\r\n\r\n", 400),
            (f"POST /upload HTTP/1.1\r\n{head}Transfer-Encoding: chunked\r\n\r\nzz\r\n\r\n", None),
            (f"PUT /x HTTP/1.1\r\n{head}\r\n", 405),
        ):
            answer = await raw(server, text.encode("latin-1"))
            found = int(answer.split()[1])
            assert found == status or (status is None and found < 500), (text, answer)
        assert await browser.pid()
    assert not [record for record in caplog.records if record.exc_info]


@pytest.mark.parametrize("token", ["ключ-ключ", "\udcff\udcfe", "\ud800"])
def test_texts_that_cannot_be_encoded_are_no_token(token):
    access = Access(Options(token=TOKEN), b"secret")
    assert not access.is_token(token)
    assert not access.is_pass(token)
    assert not access.is_session(token)
    assert access.is_session(access.new_session())
    with pytest.raises(RefusedError):
        access.check_origin("http://[", "127.0.0.1")


@pytest.mark.parametrize(
    "call",
    [
        None, 5, [], "text", {}, {"id": 1, "method": "m"}, {"id": "a"}, {"id": "a", "method": 7},
        {"id": "a", "method": []}, {"id": "a", "method": "m", "args": 5}, {"id": "a", "method": "m", "args": {"a": 1}},
        {"id": "a", "method": "m", "kwargs": {"a": 1}}, {"id": "a", "method": "m", "kwargs": {b"a": 1}},
    ],
)  # fmt: skip
def test_calls_that_are_none_are_refused(call):
    with pytest.raises(MalformedError):
        check_call(call)


def test_calls_as_the_page_makes_them_pass():
    check_call({"wslink": "1.0", "id": "rpc:c1:0", "method": "trame.trigger", "args": ["view", []], "kwargs": {}})
    check_call({"wslink": "1.0", "id": "system:c0:0", "method": "wslink.hello", "args": [{"secret": "s"}]})


class Told:
    is_binary = True

    def __init__(self, data):
        self.data = data


async def test_malformed_messages_close_their_connection_with_a_line_in_the_log(caplog):
    """With wslink's own handler; the connection is a record."""
    from wslink.backends.aiohttp import AioHttpWsHandler, WebAppServer
    from wslink.websocket import ServerProtocol

    class Connection:
        closed = False

        async def close(self, **_):
            self.closed = True

        async def send_bytes(self, data):
            self.sent = data

    def call(number, content):
        return {"wslink": "1.0", "id": f"rpc:c1:{number}", "method": "none", "args": content}

    protocol = ServerProtocol()
    handler = AioHttpWsHandler(protocol, WebAppServer({}))
    said = []
    guard_messages(handler, said.append)
    packed = msgpack.packb({"a": 1})
    bad = [
        message(b"\xc1"), message(packed + b"more"), message(packed[:-1]), message(b"\x91" * 5000),
        message(msgpack.packb([1])), message(msgpack.packb(call(1, 5))), b"short", b"",
        message(b"\xa2\xff\xff"), message(b"abc", 2), message(msgpack.packb({"id": "system:1", "method": 5})),
    ]  # fmt: skip
    for data in bad:
        connection = handler.connections["one"] = Connection()
        await handler.onConnect(None, "one")
        handler.authentified_client_ids.add("one")
        handler.unchunkers["one"].set_max_message_size(2**20)
        await handler.onMessage(True, Told(data), "one")
        assert connection.closed, data
    assert len(said) == len(bad)  # the page says why it was cut off
    connection = handler.connections["one"] = Connection()
    await handler.onConnect(None, "one")
    handler.unchunkers["one"].set_max_message_size(2**20)
    for number in range(100):  # each announces a MiB and never comes
        if connection.closed:
            break
        header = number.to_bytes(4, "little") + bytes(4) + (2**20).to_bytes(4, "little")
        await handler.onMessage(True, Told(header + b"x"), "one")
    assert number < 32
    connection = handler.connections["one"] = Connection()
    await handler.onConnect(None, "one")
    await handler.onMessage(True, Told(message(msgpack.packb(call(1, [])))), "one")
    assert not connection.closed
    assert b"Unregistered" in connection.sent
    assert caplog.text.count("refused a message") == 12
    assert not [record for record in caplog.records if record.exc_info]


async def test_what_a_worker_says_is_limited_and_cannot_move_the_cursor(tmp_path, caplog):
    """Browsers report errors of their scripts, which workers write to their log."""
    (tmp_path / "noise").write_text("\x1b[2J" + "x" * 20_000)
    caplog.set_level("INFO", "pvfiblets.web")
    async with gate(tmp_path) as server, Browser(server) as browser:
        await browser.enter()
        await browser.get("/noise")  # answered when all was said; the rest of it is read at the end
    lines = [record.getMessage() for record in caplog.records if "| " in record.getMessage()]
    assert 100 < len(lines) <= 201
    assert all(len(line) < 1200 for line in lines)
    assert "\x1b" not in caplog.text
    assert "more lines were left out" in caplog.text


async def test_a_worker_that_goes_in_the_middle_of_an_answer_is_no_mistake_of_the_gate(tmp_path, caplog):
    async with gate(tmp_path) as server, Browser(server) as browser:
        await browser.enter()
        with pytest.raises(aiohttp.ClientError):
            await browser.get("/half")
    assert not [record for record in caplog.records if record.exc_info]
