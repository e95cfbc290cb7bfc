"""The front server: the one public port of ``pvfiblets serve``.

Every request passes the same checks in the same order: host, path, method, origin, token. Accepted requests go to
the process of the browser's session, HTTP and WebSocket alike. The browser's cookies identify it, never its
address: the token leaves the address with the first answer.
"""

from __future__ import annotations

import asyncio
import contextlib
import logging
import secrets
import time
from collections.abc import Awaitable, Callable, Sequence
from urllib.parse import parse_qs, urlencode

from aiohttp import web

from pvfiblets.web.server import pages
from pvfiblets.web.server.access import LARGEST_SESSION, REFUSED, Access, RefusedError
from pvfiblets.web.server.connections import BACKLOG, Connection, Connections, room
from pvfiblets.web.server.launcher import SHARED, WORKER, Launcher, Session
from pvfiblets.web.server.log_limiter import LogLimiter
from pvfiblets.web.server.options import Options
from pvfiblets.web.server.pages import HEADERS
from pvfiblets.web.server.relay import HEARTBEAT, Relay

logger = logging.getLogger("pvfiblets.web")

PATIENCE = 30.0  # seconds for a whole request to come, and for a body that stops
WRONG_TOKEN = 1.0  # seconds that a wrong token waits for its answer
# Methods of requests for pages and files of the application, and for its downloads.
PASSED_ON = frozenset({"GET", "HEAD"})
UPLOAD, SESSION = "/upload", "/session"
LOGS = ("pvfiblets.web", "aiohttp.server", "asyncio")


async def _unnamed(_request: web.Request, response: web.StreamResponse) -> None:
    """Name the program without the versions of its libraries, of web sockets too."""
    response.headers["Server"] = HEADERS["Server"]


class FrontServer:
    """The public server."""

    def __init__(self, options: Options, command: Sequence[str] = WORKER, patience: float = PATIENCE) -> None:
        self.options = options  # checked options
        self.patience = patience  # seconds that a connection may take for a whole request
        self.connections = Connections(options.connections, options.by_address, options.proxies)
        self._quiet = LogLimiter()
        self._counting: asyncio.Task[None] | None = None
        self._listener: asyncio.Server | None = None
        self.access = Access(options, secrets.token_bytes(32))
        self.launcher = Launcher(options, lambda session: self._relay.hang_up(session), command)
        self._relay = Relay(patience)
        self._runner: web.AppRunner | None = None
        self.port = 0

    async def start(self) -> None:
        """Listen, and prepare the first session."""
        for name in LOGS:
            logging.getLogger(name).addFilter(self._quiet)
        self._counting = asyncio.create_task(self._count())
        self.connections.most = room(self.options.connections, self.options.limit)
        if self.connections.most < self.options.connections:
            logger.warning(
                "at most %d connections: this system allows no more open files (ulimit -n)", self.connections.most
            )
        self._relay.start()
        app = web.Application(middlewares=[self._guard], client_max_size=64 * 1024)
        app.on_response_prepare.append(_unnamed)
        app.router.add_post("/token", self._enter)
        app.router.add_post("/new", self._new)
        app.router.add_post("/end", self._end)
        app.router.add_post("/paraview/", self._connection)
        app.router.add_post(UPLOAD, self._upload)
        app.router.add_post(SESSION, self._upload)
        app.router.add_get("/begin", self._begin)
        app.router.add_get("/status", self._status)
        app.router.add_get("/ws", self._socket)
        app.router.add_get("/{path:.*}", self._pass_on)
        self._runner = web.AppRunner(app, handle_signals=False)
        await self._runner.setup()
        server = self._runner.server
        assert server is not None
        self._listener = await asyncio.get_running_loop().create_server(
            lambda: Connection(server, self.connections, self.patience),
            self.options.host,
            self.options.port,
            backlog=BACKLOG,
        )
        self.port = int(self._listener.sockets[0].getsockname()[1])
        await self.launcher.start()

    async def stop(self) -> None:
        """End all sessions and stop listening."""
        if self._listener is not None:
            self._listener.close()
        await self.launcher.stop()
        if self._runner is not None:
            await self._runner.cleanup()
        await self._relay.stop()
        if self._counting is not None:
            self._counting.cancel()
            await asyncio.gather(self._counting, return_exceptions=True)
        self._quiet.report()
        for name in LOGS:
            logging.getLogger(name).removeFilter(self._quiet)

    async def _count(self) -> None:
        """Log now and then how much was dropped: after a flood nothing else might be logged."""
        while True:
            await asyncio.sleep(self._quiet.seconds)
            self._quiet.report()

    @property
    def url(self) -> str:
        """The address to open, with the token if one is required."""
        query = "" if self.options.token is None else "?" + urlencode({"token": self.options.token})
        return self.address + query

    @property
    def address(self) -> str:
        """The address of the first page."""
        host = self.options.host
        shown = f"[{host}]" if ":" in host else {"0.0.0.0": "localhost", "::": "localhost"}.get(host, host)
        return f"http://{shown}:{self.port}/"

    # Checks

    @web.middleware
    async def _guard(
        self, request: web.Request, handler: Callable[[web.Request], Awaitable[web.StreamResponse]]
    ) -> web.StreamResponse:
        connection = request.protocol
        assert isinstance(connection, Connection)
        connection.asked = True
        client = self.connections.client(request)
        if client is not None:
            request = request.clone(remote=client)
        with self.connections.forwarded(client) as room_left:
            return await self._answer(request, handler, connection, room_left)

    async def _answer(
        self,
        request: web.Request,
        handler: Callable[[web.Request], Awaitable[web.StreamResponse]],
        connection: Connection,
        room_left: bool,
    ) -> web.StreamResponse:
        try:
            if not room_left:
                raise RefusedError(429, "too many requests at once from one address")
            host = request.headers.get("Host")
            self.access.check_host(host)
            self.access.check_path(request.raw_path)
            if request.method not in ("GET", "HEAD", "POST"):
                raise RefusedError(405, "no such method")
            if request.method == "POST" or request.headers.get("Upgrade"):
                self.access.check_origin(request.headers.get("Origin"), host)
            if request.path == "/token" and request.method == "POST":
                return await handler(request)
            if not self.access.is_pass(request.cookies.get(self._pass_name)):
                return await self._admit(request)
            connection.busy = True
            try:
                return await handler(request)
            finally:
                connection.busy = False
        except RefusedError as refusal:
            self._log(request, refusal.reason)
            return self._page(pages.refused(refusal.reason), refusal.status)
        except web.HTTPException as answer:
            self._log(request, answer.reason)
            return self._page(pages.refused(answer.reason), answer.status)
        except (web.RequestPayloadError, TimeoutError) as error:
            slow = isinstance(error, TimeoutError)
            reason = "the rest of a request did not come" if slow else "the body is malformed"
            self._log(request, reason)
            return self._page(pages.refused(reason), 408 if slow else 400)

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
        async with asyncio.timeout(self.patience):
            form = (await request.read()).decode(errors="replace")
        try:
            given = parse_qs(form, max_num_fields=8).get("token", [""])[0]
        except ValueError as error:
            raise RefusedError(400, "too many fields") from error
        if self.access.is_token(given.strip()):
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
        """Log a refusal: never the query, the cookies or the body, which hold secrets."""
        logger.warning("refused %s %.200r from %s: %s", request.method, request.path, request.remote, reason)

    # Sessions

    def _session(self, request: web.Request) -> Session | None:
        if self.options.shared:
            return self.launcher.find(SHARED)
        return self.launcher.find(request.cookies.get(self._session_name))

    async def _new(self, request: web.Request) -> web.StreamResponse:
        """Forget the browser's session, so that it begins another: with the last state of one that failed, if asked."""
        session = self._session(request)
        restore = request.query.get("restore") == "1"
        if session is not None and session.ended:
            await self.launcher.forgive(session, restore=restore)
        elif session is not None and not self.options.shared:
            await self.launcher.end(session)
        response = web.Response(status=303, headers=HEADERS | {"Location": "/"})
        if not restore:
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
        """Return the address of its WebSocket to trame's client, which asks for a launcher first."""
        session = self._session(request)
        if session is None or session.ended:
            raise RefusedError(404, "no session")
        return web.json_response({"sessionURL": "ws://USE_HOST/ws", "secret": "wslink-secret"}, headers=HEADERS)

    async def _status(self, request: web.Request) -> web.StreamResponse:
        """Return the state of its session to a page that lost its connection."""
        session = self._session(request)
        told: dict[str, object] = {"state": "none"}
        if session is not None and session.ended:
            told = {"state": "ended", "reason": session.failure, "restore": self.launcher.can_restore(session)}
        elif session is not None:
            session.seen = time.monotonic()
            told = {"state": "running" if session.port is not None else "starting", "connected": session.connections}
        return web.json_response(told, headers=HEADERS)

    def _first_page(self, request: web.Request) -> web.StreamResponse:
        """Answer a browser that opens the page: with the application, or with why not yet or not at all."""
        # Nothing is started: clients that only fetch pages run no script, and need no more than this page.
        session = self._session(request)
        if session is None and not self.launcher.has_room:
            self._log(request, "the limit of sessions")
            return self._page(pages.full(self.options.limit), 503)
        if session is not None and session.ended:
            return self._page(pages.ended(session.failure, self.launcher.can_restore(session)), 410)
        if session is not None:
            session.seen = time.monotonic()
        if session is not None and session.port is not None:
            return web.Response(status=303, headers=HEADERS | {"Location": "/index.html?reconnect=auto"})
        response = self._page(pages.opening())
        if self._name(request) is None:
            self._set_cookie(response, self._session_name, self.access.new_session())
        return response

    def _name(self, request: web.Request) -> str | None:
        """Return what the browser's session is called, or is to be called."""
        if self.options.shared:
            return SHARED
        cookie = request.cookies.get(self._session_name)
        return cookie if self.access.is_session(cookie) else None

    async def _begin(self, request: web.Request) -> web.StreamResponse:
        """Begin the session of a page whose script has connected, and tell it when to go on."""
        name = self._name(request)
        if name is None:
            raise RefusedError(403, "no cookie of a session")
        socket = web.WebSocketResponse(heartbeat=HEARTBEAT, max_msg_size=1024)
        if not socket.can_prepare(request):
            raise RefusedError(400, "not a WebSocket")
        await socket.prepare(request)
        session = await self.launcher.open(name)
        if session is not None:
            session.connections += 1  # a waiting browser counts as connected
            try:
                waits = {asyncio.ensure_future(socket.receive()), asyncio.ensure_future(session.ready.wait())}
                await asyncio.wait(waits, return_when=asyncio.FIRST_COMPLETED)
                for wait in waits:
                    wait.cancel()
                await asyncio.gather(*waits, return_exceptions=True)
            finally:
                session.connections -= 1
                session.seen = time.monotonic()
        with contextlib.suppress(ConnectionError):
            await socket.send_str("ready" if session is not None and session.port is not None else "ask again")
            await socket.close()
        return socket

    async def _pass_on(self, request: web.Request) -> web.StreamResponse:
        if request.path == "/":
            return self._first_page(request)
        session = self._session(request)
        if session is None or session.ended or session.port is None:
            if request.path == "/index.html":
                return web.Response(status=303, headers=HEADERS | {"Location": "/"})
            raise RefusedError(404, "no session")
        if request.method not in PASSED_ON:
            raise RefusedError(405, "no such method")
        return await self._relay.forward(request, session)

    async def _upload(self, request: web.Request) -> web.StreamResponse:
        session = self._session(request)
        if session is None or session.ended or session.port is None:
            raise RefusedError(404, "no session")
        if request.content_length is None:
            raise RefusedError(411, "an upload without its length")
        most = LARGEST_SESSION if request.path == SESSION else self.options.upload
        if request.content_length > most:
            raise RefusedError(413, f"an upload above {most:,} bytes")
        return await self._relay.upload(request, session)

    async def _socket(self, request: web.Request) -> web.StreamResponse:
        session = self._session(request)
        if session is None or session.ended or session.port is None:
            raise RefusedError(404, "no session")

        def refused(reason: str) -> None:
            self._log(request, reason)
            self.launcher.tell(session, say=f"{REFUSED}: {reason}.")

        return await self._relay.connect(request, session, refused)


async def serve(options: Options, ready: Callable[[FrontServer], None]) -> None:
    """Serve until cancelled; `ready` is called once the port is open."""
    gate = FrontServer(options)
    try:
        await gate.start()
        ready(gate)
        await asyncio.Event().wait()
    finally:
        await gate.stop()
