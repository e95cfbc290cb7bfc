"""Who is connected to the front server: at most so many, from all addresses and from one, and none that sends nothing.

Beyond a limit the oldest connection that has no request in work gives way to the new one. A client that opens thousands
without finishing a request thus shuts out no other client, not even at the same address.
"""

from __future__ import annotations

import asyncio
import logging
from collections import Counter
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from ipaddress import IPv6Address, ip_address, ip_network
from typing import Any, cast

from aiohttp import web

from pvfiblets.web.server import pages

logger = logging.getLogger("pvfiblets.web")

BACKLOG = 64  # connections that the system accepts before they are counted here
OWN_FILES = 64  # that Python and its libraries have open
SESSION_FILES = 5  # three pipes of its process, and what starting it takes for a moment
LINGER = 2.0  # seconds in which the rest of a refused body is read, so that the browser reads the answer
TURNED_AWAY = b"HTTP/1.1 503 Service Unavailable\r\nContent-Length: 0\r\nRetry-After: 5\r\nConnection: close\r\n\r\n"


class Connections:
    """The open connections of one server, oldest first."""

    def __init__(self, most: int, by_address: int, proxies: Iterable[str] = ()) -> None:
        # the most in all, and from one address (for IPv6, from one network of 64 bits)
        self.most, self.by_address = most, by_address
        # addresses of proxies. Their connections count in all only; the requests that they pass on count by the address
        # that the proxy put last into `X-Forwarded-For`.
        self._proxies = {ip_address(proxy) for proxy in proxies}
        self._open: dict[Connection, str] = {}
        self._addresses: dict[str, dict[Connection, None]] = {}
        self._forwarded: Counter[str] = Counter()

    def __len__(self) -> int:
        return len(self._open)

    def enter(self, connection: Connection, address: str) -> bool:
        """Count a connection; ``False`` where it finds no room."""
        group = self._group(address)
        others = self._addresses.get(group, {})
        if not self._is_proxy(address) and len(others) >= self.by_address and not self._make_room(others):
            return False
        if len(self._open) >= self.most and not self._make_room(self._open):
            return False
        self._open[connection] = group
        self._addresses.setdefault(group, {})[connection] = None
        return True

    def leave(self, connection: Connection) -> None:
        """Count a connection no more."""
        group = self._open.pop(connection, None)
        if group is not None:
            others = self._addresses[group]
            del others[connection]
            if not others:
                del self._addresses[group]

    def _make_room(self, among: Iterable[Connection]) -> bool:
        oldest = next((connection for connection in among if not connection.busy), None)
        if oldest is None:
            return False
        self.leave(oldest)
        oldest.abort()
        return True

    def client(self, request: web.BaseRequest) -> str | None:
        """Return the address that a known proxy says a request is from, or ``None`` for one that came directly."""
        if request.remote is None or not self._is_proxy(request.remote):
            return None
        said = ",".join(request.headers.getall("X-Forwarded-For", [])).rpartition(",")[2].strip()
        try:
            return str(ip_address(said))
        except ValueError:
            return None

    @contextmanager
    def forwarded(self, client: str | None) -> Iterator[bool]:
        """Count a request that a proxy passed on, while it lasts; gives whether there is room for it."""
        if client is None:
            yield True
            return
        group = self._group(client)
        self._forwarded[group] += 1
        try:
            yield self._forwarded[group] <= self.by_address
        finally:
            self._forwarded[group] -= 1
            if not self._forwarded[group]:
                del self._forwarded[group]

    def _is_proxy(self, address: str) -> bool:
        try:
            return ip_address(address) in self._proxies
        except ValueError:
            return False

    @staticmethod
    def _group(address: str) -> str:
        try:
            found = ip_address(address)
        except ValueError:
            return address
        if not isinstance(found, IPv6Address):
            return str(found)
        mapped = found.ipv4_mapped
        return str(mapped) if mapped is not None else str(ip_network((int(found) >> 64 << 64, 64)))


class Connection(web.RequestHandler):
    """One connection, of aiohttp's server; it ends when no whole request has come in time."""

    __slots__ = ("_address", "_begun", "_connections", "_patience", "asked", "busy")

    def __init__(self, server: web.Server, connections: Connections, patience: float) -> None:
        # Bodies stay as they were sent: an upload that is inflated on its way would pass any limit.
        settings: dict[str, Any] = {"access_log": None, "auto_decompress": False, "lingering_time": LINGER}
        super().__init__(server, loop=asyncio.get_running_loop(), keepalive_timeout=patience, **settings)
        # seconds for the first request to come whole, and for each further one after the answer before it
        self._connections, self._patience = connections, patience  # where it is counted
        self._begun: asyncio.TimerHandle | None = None
        self._address = ""
        self.asked = False  # a whole request has come
        self.busy = False  # a request that may be made is in work

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Count the connection, or turn it away."""
        peer = transport.get_extra_info("peername")
        self._address = str(peer[0]) if isinstance(peer, tuple) else ""
        if not self._connections.enter(self, self._address):
            logger.warning("refused a connection from %s: too many are busy", self._address)
            self.force_close()  # reads nothing from now on
            channel = cast(asyncio.Transport, transport)
            channel.write(TURNED_AWAY)
            channel.close()
            return
        super().connection_made(transport)
        self._begun = asyncio.get_running_loop().call_later(self._patience, self._give_up)

    def connection_lost(self, exc: BaseException | None) -> None:
        """Count the connection no more."""
        self._connections.leave(self)
        if self._begun is not None:
            self._begun.cancel()
        super().connection_lost(exc)

    def _give_up(self) -> None:
        if not self.asked:
            logger.warning("closed a connection from %s: no whole request in time", self._address)
            self.abort()

    def abort(self) -> None:
        """Close the connection at once, whatever is still to be sent."""
        if self.transport is not None:
            self.transport.abort()

    def handle_error(
        self,
        request: web.BaseRequest,
        status: int = 500,
        exc: BaseException | None = None,
        message: str | None = None,
    ) -> web.StreamResponse:
        """Respond to invalid HTTP without a traceback; log the traceback of an internal error."""
        if status >= 500:
            return super().handle_error(request, status, exc, message)
        if request.writer.output_size > 0:
            raise ConnectionError("malformed HTTP after an answer has begun")
        logger.warning("refused malformed HTTP from %s: %s", request.remote, type(exc).__name__)
        text = pages.refused("this is no HTTP that can be read")
        response = web.Response(status=status, text=text, content_type="text/html", headers=pages.HEADERS)
        response.force_close()
        return response


def room(wanted: int, sessions: int) -> int:
    """Return how many connections this process has file descriptors for, up to the number that is wanted."""
    # The limit of this process is raised as far as that takes and the system allows. A connection may take two: one to
    # the browser, and one to its session.
    try:
        import resource
    except ImportError:  # Windows has no such limit
        return wanted
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    reserved = OWN_FILES + BACKLOG + SESSION_FILES * sessions
    needed = reserved + 2 * wanted
    if soft != resource.RLIM_INFINITY and soft < needed:
        raised = needed if hard == resource.RLIM_INFINITY else min(needed, hard)
        try:
            resource.setrlimit(resource.RLIMIT_NOFILE, (raised, hard))
            soft = raised
        except (OSError, ValueError):  # some systems allow less than they say
            pass
    return wanted if soft == resource.RLIM_INFINITY else max(4, min(wanted, (soft - reserved) // 2))
