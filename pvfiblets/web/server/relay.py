"""Traffic between browsers and the processes of their sessions, once the front server has let it in."""

from __future__ import annotations

import asyncio
import logging
import time
from collections.abc import AsyncIterator, Callable

import aiohttp
from aiohttp import web
from yarl import URL

from pvfiblets.web.server.access import LARGEST_MESSAGE, RefusedError, check_message
from pvfiblets.web.server.launcher import Session
from pvfiblets.web.server.pages import HEADERS
from pvfiblets.web.worker import KEY_HEADER

logger = logging.getLogger("pvfiblets.web")

HEARTBEAT = 20.0  # seconds between pings: a browser that is gone without a word is found by them
UNREAD = 60.0  # seconds that a piece of an answer waits for its reader
SLOWEST = 1024  # bytes a second of an upload, over all of it


class Relay:
    """Passes on what browsers ask and what sessions answer."""

    def __init__(self, patience: float) -> None:
        self._patience = patience  # seconds that an upload may stop
        self._sockets: dict[str, set[web.WebSocketResponse]] = {}
        self._closing: set[asyncio.Task[object]] = set()
        self._client: aiohttp.ClientSession | None = None

    def start(self) -> None:
        """Prepare to ask sessions."""
        self._client = aiohttp.ClientSession(auto_decompress=False, timeout=aiohttp.ClientTimeout(total=None))

    async def stop(self) -> None:
        """Close all connections to sessions."""
        if self._client is not None:
            await self._client.close()

    async def upload(self, request: web.Request, session: Session) -> web.StreamResponse:
        """Pass a request on with its body."""
        return await self.forward(request, session, self._paced(request))

    async def _paced(self, request: web.Request) -> AsyncIterator[bytes]:
        """Give the body of a request as it comes, while it comes; only the time that is waited for it counts."""
        waited, received = 0.0, 0
        while True:
            begun = time.monotonic()
            try:
                async with asyncio.timeout(self._patience + received / SLOWEST - waited):
                    piece = await request.content.readany()
            except TimeoutError as error:
                raise RefusedError(408, "the rest of an upload did not come") from error
            if not piece:
                return
            waited += time.monotonic() - begun
            received += len(piece)
            yield piece

    async def forward(
        self, request: web.Request, session: Session, body: AsyncIterator[bytes] | None = None
    ) -> web.StreamResponse:
        """Ask a session's process, and pass its answer on."""
        assert self._client is not None
        response: web.StreamResponse | None = None
        headers = {KEY_HEADER: session.key}
        for name in ("Accept", "Accept-Encoding", "Content-Type", "Content-Length", "Range"):
            if name in request.headers and (body is not None or not name.startswith("Content-")):
                headers[name] = request.headers[name]
        address = f"http://127.0.0.1:{session.port}{request.raw_path}"
        try:
            async with self._client.request(
                request.method, URL(address, encoded=True), headers=headers, data=body, allow_redirects=False
            ) as answer:
                response = web.StreamResponse(status=answer.status, headers=HEADERS)
                for name in (
                    "Content-Type",
                    "Content-Encoding",
                    "Content-Length",
                    "Content-Disposition",
                    "Content-Range",
                ):
                    if name in answer.headers:
                        response.headers[name] = answer.headers[name]
                if request.path.startswith("/__") and answer.status == 200:  # libraries; their folders carry versions
                    response.headers["Cache-Control"] = "private, max-age=3600"
                await response.prepare(request)
                async for piece in answer.content.iter_any():
                    async with asyncio.timeout(UNREAD):
                        await response.write(piece)
                async with asyncio.timeout(UNREAD):
                    await response.write_eof()
                return response
        except (aiohttp.ClientError, ConnectionError) as error:
            if isinstance(error.__cause__, RefusedError):  # of the body
                raise error.__cause__ from error
            if response is not None and response.prepared:  # too late for an error; a short body shows it
                if request.transport is not None:
                    request.transport.abort()
                return response
            raise RefusedError(502, "the session does not answer") from error
        except TimeoutError:  # of the reader; of the session's process it is a ClientError
            place = request.path.split("/")[1]  # and no more: names of downloads are secrets
            logger.warning("closed /%.40s: client %s read nothing for %g s", place, request.remote, UNREAD)
            if request.transport is not None:
                request.transport.abort()
            return response if response is not None else web.Response(status=408)

    async def connect(
        self, request: web.Request, session: Session, refused: Callable[[str], None]
    ) -> web.StreamResponse:
        """Connect a browser's WebSocket with its session's, while both last; `refused` receives bad messages."""
        assert self._client is not None
        # Pictures are compressed already: no permessage-deflate.
        browser = web.WebSocketResponse(heartbeat=HEARTBEAT, max_msg_size=LARGEST_MESSAGE, compress=False)
        if not browser.can_prepare(request):
            raise RefusedError(400, "not a WebSocket")
        try:
            inner = await self._client.ws_connect(
                f"ws://127.0.0.1:{session.port}/ws", headers={KEY_HEADER: session.key}, max_msg_size=0, compress=0
            )
        except aiohttp.ClientError as error:
            raise RefusedError(502, "the session does not answer") from error
        async with inner:
            await browser.prepare(request)
            session.connections += 1
            sockets = self._sockets.setdefault(session.id, set())
            sockets.add(browser)
            try:
                pumps = {
                    asyncio.create_task(self._upwards(browser, inner, refused)),
                    asyncio.create_task(self._downwards(inner, browser)),
                }
                _, rest = await asyncio.wait(pumps, return_when=asyncio.FIRST_COMPLETED)
                for pump in rest:
                    pump.cancel()
                await asyncio.gather(*pumps, return_exceptions=True)
            finally:
                session.connections -= 1
                session.seen = time.monotonic()
                sockets.discard(browser)
                if not browser.closed:
                    await browser.close()
        return browser

    async def _upwards(
        self,
        browser: web.WebSocketResponse,
        inner: aiohttp.ClientWebSocketResponse,
        refused: Callable[[str], None],
    ) -> None:
        async for message in browser:
            if getattr(message.data, "code", None) == aiohttp.WSCloseCode.MESSAGE_TOO_BIG:  # an error of aiohttp's
                refused(f"a message above {LARGEST_MESSAGE:,} bytes")
            if message.type is not aiohttp.WSMsgType.BINARY:
                break
            try:
                check_message(message.data)
            except RefusedError as refusal:
                refused(refusal.reason)
                await browser.close(code=aiohttp.WSCloseCode.MESSAGE_TOO_BIG, message=refusal.reason.encode())
                return
            await inner.send_bytes(message.data)

    async def _downwards(self, inner: aiohttp.ClientWebSocketResponse, browser: web.WebSocketResponse) -> None:
        async for message in inner:
            if message.type is not aiohttp.WSMsgType.BINARY:
                break
            await browser.send_bytes(message.data)  # waits for a slow browser, and so makes the session wait

    def hang_up(self, session: Session) -> None:
        """Close the WebSockets of a session that has ended."""
        for socket in self._sockets.pop(session.id, set()):
            task = asyncio.ensure_future(socket.close(code=aiohttp.WSCloseCode.GOING_AWAY, message=b"session ended"))
            self._closing.add(task)
            task.add_done_callback(self._closing.discard)
