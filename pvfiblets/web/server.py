"""The gate: the one public port of ``pvfiblets serve``.

Every request passes the same checks in the same order: host, path, method, origin, token. What is left is passed on to
the process of the browser's session, HTTP and WebSocket alike. The browser's cookies, and nothing in addresses, say
who it is: the token leaves the address with the first answer.
"""

from __future__ import annotations

import asyncio
import logging
import secrets
import time
from collections.abc import Awaitable, Callable, Sequence
from urllib.parse import urlencode

import aiohttp
from aiohttp import web
from yarl import URL

from pvfiblets.web import pages
from pvfiblets.web.access import LARGEST_MESSAGE, Access, RefusedError, check_message
from pvfiblets.web.launcher import SHARED, WORKER, Launcher, Session
from pvfiblets.web.options import Options

logger = logging.getLogger("pvfiblets.web")

KEY_HEADER = "X-Pvfiblets-Key"
HEARTBEAT = 20.0  # seconds between pings: a browser that is gone without a word is found by them
WRONG_TOKEN = 1.0  # seconds that a wrong token waits for its answer
# Vue compiles its templates in the browser, which needs 'unsafe-eval'; nothing is loaded from, or sent to, elsewhere.
POLICY = (
    "default-src 'self'; script-src 'self' 'unsafe-inline' 'unsafe-eval'; style-src 'self' 'unsafe-inline'; "
    "img-src 'self' blob: data:; font-src 'self' data:; connect-src 'self'; object-src 'none'; base-uri 'self'; "
    "form-action 'self'; frame-ancestors 'self'"
)
HEADERS = {
    "Content-Security-Policy": POLICY,
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "same-origin",
    "Cache-Control": "no-store",
}
# Pages and files of the application, and what it sends away.
PASSED_ON = frozenset({"GET", "HEAD"})
UPLOAD = "/upload"
DOWNLOAD = "/download/"


class Gate:
    """The public server.

    Parameters
    ----------
    options : Options
        Checked options.
    command : sequence of str, optional
        What a session's process runs.
    """

    def __init__(self, options: Options, command: Sequence[str] = WORKER) -> None:
        self.options = options
        self.access = Access(options, secrets.token_bytes(32))
        self.launcher = Launcher(options, self._on_end, command)
        self._sockets: dict[str, set[web.WebSocketResponse]] = {}
        self._closing: set[asyncio.Task[object]] = set()
        self._client: aiohttp.ClientSession | None = None
        self._runner: web.AppRunner | None = None
        self.port = 0

    async def start(self) -> None:
        """Listen, and prepare the first session."""
        self._client = aiohttp.ClientSession(auto_decompress=False, timeout=aiohttp.ClientTimeout(total=None))
        app = web.Application(middlewares=[self._guard], client_max_size=64 * 1024)
        app.router.add_post("/token", self._enter)
        app.router.add_post("/new", self._new)
        app.router.add_post("/end", self._end)
        app.router.add_post("/paraview/", self._connection)
        app.router.add_post(UPLOAD, self._upload)
        app.router.add_get("/ws", self._socket)
        app.router.add_get("/{path:.*}", self._pass_on)
        self._runner = web.AppRunner(app, access_log=None, handle_signals=False)
        await self._runner.setup()
        await web.TCPSite(self._runner, self.options.host, self.options.port).start()
        self.port = int(self._runner.addresses[0][1])
        await self.launcher.start()

    async def stop(self) -> None:
        """End all sessions and stop listening."""
        await self.launcher.stop()
        if self._runner is not None:
            await self._runner.cleanup()
        if self._client is not None:
            await self._client.close()

    @property
    def url(self) -> str:
        """The address to open, with the token if one is asked for."""
        host = self.options.host
        shown = f"[{host}]" if ":" in host else {"0.0.0.0": "localhost", "::": "localhost"}.get(host, host)
        query = "" if self.options.token is None else "?" + urlencode({"token": self.options.token})
        return f"http://{shown}:{self.port}/{query}"

    # Checks

    @web.middleware
    async def _guard(
        self, request: web.Request, handler: Callable[[web.Request], Awaitable[web.StreamResponse]]
    ) -> web.StreamResponse:
        try:
            host = request.headers.get("Host")
            self.access.check_host(host)
            self.access.check_path(request.raw_path)
            if request.method not in ("GET", "HEAD", "POST"):
                raise RefusedError(405, "no such method")
            if request.method == "POST" or request.headers.get("Upgrade"):
                self.access.check_origin(request.headers.get("Origin"), host)
            if request.path != "/token" and not self.access.is_pass(request.cookies.get(self._pass_name)):
                return await self._admit(request)
            response = await handler(request)
        except RefusedError as refusal:
            self._log(request, refusal.reason)
            return self._page(pages.refused(refusal.reason), refusal.status)
        except web.HTTPException as answer:
            self._log(request, answer.reason)
            return self._page(pages.refused(answer.reason), answer.status)
        return response

    async def _admit(self, request: web.Request) -> web.StreamResponse:
        """Answer a browser that has not shown the token yet."""
        given = request.query.get("token")
        if request.method == "GET" and given is not None and self.access.is_token(given):
            rest = {name: value for name, value in request.query.items() if name != "token"}
            return self._welcome(request.path + ("?" + urlencode(rest) if rest else ""))
        if given is not None:
            await asyncio.sleep(WRONG_TOKEN)
        self._log(request, "no token" if given is None else "a wrong token")
        return self._page(pages.ask_token(given is not None), 401)

    async def _enter(self, request: web.Request) -> web.StreamResponse:
        form = await request.post()
        given = form.get("token")
        if isinstance(given, str) and self.access.is_token(given.strip()):
            return self._welcome("/")
        await asyncio.sleep(WRONG_TOKEN)
        self._log(request, "a wrong token")
        return self._page(pages.ask_token(True), 401)

    def _welcome(self, path: str) -> web.Response:
        # Two slashes would name another host.
        response = web.Response(status=303, headers=HEADERS | {"Location": "/" + path.lstrip("/")})
        self._set_cookie(response, self._pass_name, self.access.pass_cookie())
        return response

    @property
    def _pass_name(self) -> str:
        return f"pvfiblets-pass-{self.port}"  # cookies are shared by all ports of a host

    @property
    def _session_name(self) -> str:
        return f"pvfiblets-session-{self.port}"

    def _set_cookie(self, response: web.Response, name: str, value: str) -> None:
        response.set_cookie(name, value, httponly=True, samesite="Lax", path="/")

    def _page(self, text: str, status: int = 200) -> web.Response:
        return web.Response(text=text, status=status, content_type="text/html", headers=HEADERS)

    def _log(self, request: web.Request, reason: str) -> None:
        """Say what was refused: never the query, the cookies or the body, in which secrets are."""
        logger.warning("refused %s %.200r from %s: %s", request.method, request.path, request.remote, reason)

    # Sessions

    def _session(self, request: web.Request) -> Session | None:
        if self.options.shared:
            return self.launcher.find(SHARED)
        return self.launcher.find(request.cookies.get(self._session_name))

    async def _new(self, request: web.Request) -> web.StreamResponse:
        """Forget the browser's session, and begin another."""
        session = self._session(request)
        if session is not None and not self.options.shared:
            await self.launcher.end(session)
        response = web.Response(status=303, headers=HEADERS | {"Location": "/"})
        response.del_cookie(self._session_name, path="/")
        return response

    async def _end(self, request: web.Request) -> web.StreamResponse:
        session = self._session(request)
        if session is not None and not self.options.shared:
            await self.launcher.end(session)
        response = self._page(pages.ended(None))
        response.del_cookie(self._session_name, path="/")
        return response

    async def _connection(self, request: web.Request) -> web.StreamResponse:
        """Tell trame's client where its WebSocket is: it asks for a launcher first."""
        session = self._session(request)
        if session is None or session.ended:
            raise RefusedError(404, "no session")
        return web.json_response({"sessionURL": "ws://USE_HOST/ws", "secret": "wslink-secret"}, headers=HEADERS)

    async def _begin(self, request: web.Request) -> web.StreamResponse:
        """Answer a browser that opens the page: with the application, or with why not yet or not at all."""
        session = self._session(request)
        if session is None or (session.ended and self.options.shared):
            session = await self.launcher.open()
            if session is None:
                self._log(request, "the limit of sessions")
                return self._page(pages.full(self.options.limit), 503)
            response = web.Response(status=303, headers=HEADERS | {"Location": "/"})
            self._set_cookie(response, self._session_name, session.id)
            return response
        if session.ended:
            return self._page(pages.ended(session.failure), 410)
        session.seen = time.monotonic()
        if session.port is None:
            return self._page(pages.opening())
        return web.Response(status=303, headers=HEADERS | {"Location": "/index.html?reconnect=auto"})

    async def _pass_on(self, request: web.Request) -> web.StreamResponse:
        if request.path == "/":
            return await self._begin(request)
        session = self._session(request)
        if session is None or session.ended or session.port is None:
            if request.path == "/index.html":
                return web.Response(status=303, headers=HEADERS | {"Location": "/"})
            raise RefusedError(404, "no session")
        if request.method not in PASSED_ON:
            raise RefusedError(405, "no such method")
        return await self._forward(request, session, None)

    async def _upload(self, request: web.Request) -> web.StreamResponse:
        session = self._session(request)
        if session is None or session.ended or session.port is None:
            raise RefusedError(404, "no session")
        if request.content_length is None:
            raise RefusedError(411, "an upload without its length")
        if request.content_length > self.options.upload:
            raise RefusedError(413, f"an upload above {self.options.upload} bytes")
        return await self._forward(request, session, request.content)

    async def _forward(
        self, request: web.Request, session: Session, body: aiohttp.StreamReader | None
    ) -> web.StreamResponse:
        assert self._client is not None
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
                    await response.write(piece)
                await response.write_eof()
                return response
        except aiohttp.ClientConnectionError as error:
            raise RefusedError(502, "the session does not answer") from error

    # WebSocket

    async def _socket(self, request: web.Request) -> web.StreamResponse:
        session = self._session(request)
        if session is None or session.ended or session.port is None:
            raise RefusedError(404, "no session")
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
                    asyncio.create_task(self._upwards(request, browser, inner)),
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
        self, request: web.Request, browser: web.WebSocketResponse, inner: aiohttp.ClientWebSocketResponse
    ) -> None:
        async for message in browser:
            if message.type is not aiohttp.WSMsgType.BINARY:
                break
            try:
                check_message(message.data)
            except RefusedError as refusal:
                self._log(request, refusal.reason)
                await browser.close(code=aiohttp.WSCloseCode.MESSAGE_TOO_BIG, message=refusal.reason.encode())
                return
            await inner.send_bytes(message.data)
        if browser.close_code == aiohttp.WSCloseCode.MESSAGE_TOO_BIG:
            self._log(request, f"a message above {LARGEST_MESSAGE} bytes")

    async def _downwards(self, inner: aiohttp.ClientWebSocketResponse, browser: web.WebSocketResponse) -> None:
        async for message in inner:
            if message.type is not aiohttp.WSMsgType.BINARY:
                break
            await browser.send_bytes(message.data)  # waits for a slow browser, and so makes the session wait

    def _on_end(self, session: Session) -> None:
        for socket in self._sockets.pop(session.id, set()):
            task = asyncio.ensure_future(socket.close(code=aiohttp.WSCloseCode.GOING_AWAY, message=b"session ended"))
            self._closing.add(task)
            task.add_done_callback(self._closing.discard)


async def serve(options: Options, ready: Callable[[Gate], None]) -> None:
    """Serve until cancelled; `ready` is called once the port is open."""
    gate = Gate(options)
    try:
        await gate.start()
        ready(gate)
        await asyncio.Event().wait()
    finally:
        await gate.stop()
