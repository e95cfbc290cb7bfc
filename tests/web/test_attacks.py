"""What an attacker would try at the front server's door, with the token and without; each try stays as a test."""

from __future__ import annotations

import asyncio
import os
import struct
import time
from pathlib import Path

import aiohttp
import pytest

from pvfiblets.web import relay
from pvfiblets.web.access import LARGEST_MESSAGE
from tests.web.visitors import TOKEN, Browser, gate, raw, run

MIB = 2**20


def resident():
    """Return the bytes that this process, and the gate in it, has in memory."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def head(browser, *lines):
    return "\r\n".join(
        [*lines, "Host: 127.0.0.1", "Origin: http://127.0.0.1", f"Cookie: {browser.cookies()}", "", ""]
    ).encode()


async def upgraded(server, browser):
    """Return a raw connection that is a WebSocket now."""
    reader, writer = await asyncio.open_connection("127.0.0.1", server.port)
    writer.write(
        head(browser, "GET /ws HTTP/1.1", "Upgrade: websocket", "Connection: Upgrade", "Sec-WebSocket-Version: 13",
             "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==")
    )  # fmt: skip
    assert b"101" in (await reader.readuntil(b"\r\n\r\n")).split(b"\r\n")[0]
    return reader, writer


def frame(content, *, code=2, last=True, announced=None):
    size = len(content) if announced is None else announced
    lengths = struct.pack("!BQ", 0x80 | 127, size)
    return bytes([(0x80 if last else 0) | code]) + lengths + bytes(4) + content  # masked with nothing


async def sent_until_closed(reader, writer, pieces):
    """Send pieces until the other end closes, and return how many bytes went."""
    sent = 0
    closed = asyncio.ensure_future(reader.read())
    try:
        for piece in pieces:
            if closed.done():
                break
            writer.write(piece)
            sent += len(piece)
            await asyncio.wait_for(asyncio.shield(writer.drain()), 5)
            await asyncio.sleep(0)
    except (ConnectionError, TimeoutError):
        pass
    await asyncio.wait_for(closed, 10)
    writer.close()
    return sent


@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="memory of a process by /proc")
def test_frames_that_are_or_announce_a_gigabyte_take_no_memory(tmp_path):
    def announced():
        yield frame(b"", announced=2**30)
        for _ in range(1024):
            yield bytes(MIB)

    def fragments():
        yield frame(bytes(1000), last=False)
        for _ in range(1_000_000):
            yield frame(bytes(1000), code=0, last=False)

    def crumbs():
        yield frame(b"x", last=False)
        for _ in range(4_000):
            yield 1000 * frame(b"x", code=0, last=False)

    async def test():
        async with gate(tmp_path) as server, Browser(server) as browser:
            await browser.enter()
            before = resident()
            for pieces in (announced, fragments, crumbs):
                sent = await sent_until_closed(*await upgraded(server, browser), pieces())
                assert sent < 40 * LARGEST_MESSAGE, pieces.__name__
                assert resident() - before < 64 * MIB, pieces.__name__
            assert await browser.pid()

    run(test())


def test_a_reader_that_never_reads_takes_no_memory_and_is_given_up(tmp_path, monkeypatch, caplog):
    monkeypatch.setattr(relay, "UNREAD", 1.5)

    async def test():
        async with gate(tmp_path) as server, Browser(server) as browser:
            await browser.enter()
            before = resident() if Path("/proc/self/statm").exists() else None
            reader, writer = await asyncio.open_connection("127.0.0.1", server.port, limit=1024)
            writer.write(head(browser, "GET /endless HTTP/1.1"))
            started = time.monotonic()
            while time.monotonic() - started < 15:
                await asyncio.sleep(0.1)
                if reader.at_eof() or "did not read" in caplog.text:
                    break
            assert "did not read" in caplog.text
            assert time.monotonic() - started > 1.4
            if before is not None:
                assert resident() - before < 64 * MIB
            writer.close()
            # One that reads slowly, but reads, has all that it asked for.
            answer = await browser.http.get(browser.base + "/tenth")
            size = 0
            async for piece in answer.content.iter_chunked(MIB):
                size += len(piece)
                await asyncio.sleep(0.3)
            assert size == 10 * MIB

    run(test())


@pytest.mark.few(2)
@pytest.mark.parametrize(
    ("lines", "body"),
    [
        (
            ["Content-Length: 5", "Transfer-Encoding: chunked"],
            b"0\r\n\r\nGET /crash HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n",
        ),
        (["Content-Length: 5", "Content-Length: 50"], bytes(50)),
        (["Content-Length: 5, 50"], bytes(50)),
        (["Content-Length: +5"], bytes(5)),
        (["Content-Length: 0x5"], bytes(5)),
        (["Transfer-Encoding: chunked, identity"], b"0\r\n\r\n"),
        (["Transfer-Encoding: xchunked"], b"0\r\n\r\n"),
        (["Transfer-Encoding : chunked"], b"0\r\n\r\n"),
        (["Transfer-Encoding: chunked"], b"5\r\nhello\r\n0\r\n\r\n"),  # a size that nobody says is refused
        (["Transfer-Encoding: chunked"], b"FFFFFFFFFFFFFFFFFF\r\nhello"),
    ],
    ids=lambda value: value[0][:40] if isinstance(value, list) else "",
)
def test_bodies_whose_sizes_lie_smuggle_nothing(tmp_path, lines, body):
    async def test():
        async with gate(tmp_path) as server, Browser(server) as browser:
            pid = await browser.enter()
            request = head(browser, "POST /upload?name=a.trk HTTP/1.1", "Connection: close", *lines)
            answer = await raw(server, request + body)
            assert 400 <= int(answer.split()[1]) < 500, answer
            assert answer.count(b"HTTP/1.") == 1
            assert await browser.pid() == pid  # nobody reached /crash

    run(test())


@pytest.mark.parametrize("known", [False, True], ids=["stranger", "guest"])
def test_no_answer_can_be_framed_sniffed_or_kept(tmp_path, known):
    """Clickjacking, scripts of uploaded text, tokens in Referer and in caches."""

    async def test():
        async with gate(tmp_path) as server, Browser(server) as browser:
            if known:
                await browser.enter()
            for path in ("/", "/?token=wrong-one-here", "/status", "/download/x", "/index.html", "/nothing", "/ws"):
                async with browser.http.get(browser.base + path, allow_redirects=False) as answer:
                    policy = answer.headers["Content-Security-Policy"]
                    for wanted in (
                        "frame-ancestors 'self'",
                        "object-src 'none'",
                        "base-uri 'self'",
                        "default-src 'self'",
                    ):
                        assert wanted in policy, path
                    assert "*" not in policy
                    assert answer.headers["X-Content-Type-Options"] == "nosniff"
                    assert answer.headers["Referrer-Policy"] == "same-origin"
                    assert "Access-Control-Allow-Origin" not in answer.headers
                    assert TOKEN not in await answer.text() + str(answer.headers)

    run(test())


@pytest.mark.more
def test_a_flood_of_calls_lets_others_through(tmp_path):
    async def test():
        async with gate(tmp_path) as server, Browser(server) as browser, Browser(server) as other:
            await browser.enter()
            await other.enter()
            async with browser.socket() as link:
                message = b"id__" + bytes(4) + (10).to_bytes(4, "little") + bytes(10)

                async def flood():
                    for _ in range(20_000):
                        await link.send_bytes(message)

                flooding = asyncio.create_task(flood())
                waits = []
                while not flooding.done():
                    started = time.monotonic()
                    status, _ = await other.get("/status")
                    waits.append(time.monotonic() - started)
                    assert status == 200
                    await asyncio.sleep(0.05)
                await flooding
            assert waits
            assert max(waits) < 5.0

    run(test())


@pytest.mark.few(2)
@pytest.mark.parametrize(
    "change",
    [
        lambda cookie: cookie[:-1] + ("0" if cookie[-1] != "0" else "1"),
        lambda cookie: cookie.upper() if cookie.upper() != cookie else cookie.lower(),
        lambda _: TOKEN,
        lambda _: "",
        lambda cookie: cookie + " ",
        lambda cookie: cookie * 50,
    ],
)
def test_passes_that_are_nearly_right_open_nothing(tmp_path, change):
    async def test():
        async with gate(tmp_path) as server, Browser(server) as browser:
            await browser.enter()
            cookies = {cookie.key: cookie.value for cookie in browser.http.cookie_jar}
            name = next(key for key in cookies if "pass" in key)
            wrong = change(cookies[name])
            if wrong.strip() == cookies[name]:
                return  # HTTP itself strips blanks
            async with aiohttp.ClientSession(cookies={**cookies, name: wrong}) as http:
                answer = await http.get(browser.base + "/index.html")
                assert answer.status == 401

    run(test())
