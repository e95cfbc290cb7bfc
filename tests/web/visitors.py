"""A gate whose sessions draw nothing (stub_worker.py), and who comes to it: browsers, sockets that misbehave."""

import asyncio
import contextlib
import inspect
import sys
from pathlib import Path

import aiohttp

from pvfiblets.web.server.front import FrontServer
from pvfiblets.web.server.options import Options

TOKEN = "correct-horse-battery"
STUB = (sys.executable, str(Path(__file__).with_name("stub_worker.py")))


@contextlib.asynccontextmanager
async def gate(tmp_path, patience=30.0, **options):
    found = FrontServer(Options(port=0, root=str(tmp_path), **{"token": TOKEN} | options), STUB, patience)
    try:
        await found.start()
        yield found
    finally:
        await found.stop()


class Browser:
    """A client with cookies of its own."""

    def __init__(self, gate):
        self.gate = gate
        self.base = f"http://127.0.0.1:{gate.port}"
        self.http = aiohttp.ClientSession(cookie_jar=aiohttp.CookieJar(unsafe=True))

    async def __aenter__(self):
        return self

    async def __aexit__(self, *_):
        await self.http.close()

    async def get(self, path, **more):
        async with self.http.get(aiohttp.client.URL(self.base + path, encoded=True), **more) as answer:
            return answer.status, await answer.text()

    async def post(self, path, origin=None, **more):
        headers = {"Origin": self.base if origin is None else origin} | more.pop("headers", {})
        async with self.http.post(self.base + path, headers=headers, **more) as answer:
            return answer.status, await answer.text()

    async def enter(self):
        """Show the token, do what the page's script does, and return the session's process."""
        status, text = await self.get(f"/?token={TOKEN}")
        if not text.startswith("{"):
            assert status == 200, text
            assert "/begin" in text
            assert await self.begin() == "ready"
            status, text = await self.get("/")
        assert status == 200
        return await self.pid()

    async def begin(self):
        """Return what the script of the page that opens is told."""
        async with self.http.ws_connect(self.base + "/begin", origin=self.base) as socket:
            return (await socket.receive()).data

    async def pid(self):
        async with self.http.get(self.base + "/index.html") as answer:
            return (await answer.json())["pid"]

    def socket(self, origin=None):
        return self.http.ws_connect(self.base + "/ws", origin=self.base if origin is None else origin, max_msg_size=0)

    def cookies(self):
        return "; ".join(f"{cookie.key}={cookie.value}" for cookie in self.http.cookie_jar)


def message(content, total=None):
    return b"id__" + bytes(4) + (len(content) if total is None else total).to_bytes(4, "little") + content


async def raw(gate, text, *, seconds=60.0):
    """Send bytes as they are, and return all that comes back until the connection is closed."""
    reader, writer = await asyncio.open_connection("127.0.0.1", gate.port)
    try:
        writer.write(text if isinstance(text, bytes) else text.encode())
        return await asyncio.wait_for(reader.read(), seconds)
    finally:
        writer.close()
        with contextlib.suppress(ConnectionError):
            await writer.wait_closed()


def run(coroutine):
    return asyncio.run(asyncio.wait_for(coroutine, 250))


async def until(condition):
    """Let other tasks run until a condition, which may be a coroutine's, holds; only a hang reaches the bound."""
    async with asyncio.timeout(120):
        while not (found := await held if inspect.isawaitable(held := condition()) else held):
            await asyncio.sleep(0.01)
    return found
