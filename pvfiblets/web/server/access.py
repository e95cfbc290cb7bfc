"""Who may ask the front server, and for what: plain functions of requests, tested without a network."""

from __future__ import annotations

import hmac
import logging
import secrets
from hashlib import sha256
from re import fullmatch
from struct import unpack_from
from urllib.parse import unquote, urlsplit

from pvfiblets.web.server.options import MEBIBYTE, Options, is_loopback

logger = logging.getLogger("pvfiblets.web")

# What a browser sends is small: state changes, pointer events. Files come by POST.
LARGEST_MESSAGE = MEBIBYTE
LARGEST_SESSION = 256 * MEBIBYTE  # bytes of a session file: no larger one is written or read
REFUSED = "The server refused what this page sent"
# wslink cuts messages into chunks with a header each: an identifier, an offset, and the size of the whole message, as
# little-endian uint32 (wslink/chunking.py). Its receiver allocates that size at once, so it is looked at here first.
CHUNK_HEADER = 12


class RefusedError(Exception):
    """A request that is turned away."""

    def __init__(self, status: int, reason: str) -> None:
        self.status = status  # the HTTP status
        self.reason = reason  # message for the browser and the log: no secrets, no paths of the server
        super().__init__(reason)


class Access:
    """The checks of one server."""

    def __init__(self, options: Options, secret: bytes) -> None:
        self._token = options.token
        self._secret = secret  # A key of this run of the server: cookies of an earlier run open nothing
        self._loopback = options.on_loopback
        self._origins = {origin.rstrip("/").lower() for origin in options.origins}

    def check_host(self, host: str | None) -> None:
        """Refuse names that a server on loopback does not have: a foreign name that resolves to 127.0.0.1."""
        if not host:
            raise RefusedError(400, "no Host header")
        try:
            name = (urlsplit(f"//{host}").hostname or "") if _is_host(host) else ""
        except ValueError:  # brackets around no address
            name = ""
        if not name:
            raise RefusedError(400, "malformed Host header")
        named = {urlsplit(origin).netloc for origin in self._origins}
        if self._loopback and not is_loopback(name) and host.lower() not in named:
            raise RefusedError(403, "this server answers to localhost only")

    def check_origin(self, origin: str | None, host: str | None) -> None:
        """Refuse pages of other sites: their scripts would act with the cookies of this one."""
        if origin is None:
            raise RefusedError(403, "no Origin header")
        if origin.rstrip("/").lower() in self._origins:
            return
        try:
            parts = urlsplit(origin)
        except ValueError as error:
            raise RefusedError(403, "malformed Origin header") from error
        if parts.scheme not in ("http", "https") or not host or parts.netloc.lower() != host.lower():
            raise RefusedError(403, "foreign origin")

    def check_path(self, raw: str) -> None:
        """Refuse paths that climb or break lines, however they are written, and addresses of other servers."""
        if not raw.startswith("/"):
            raise RefusedError(400, "an address that does not begin with /")
        path = raw.partition("?")[0]
        for _ in range(3):  # %252e%252e is unquoted twice by someone, some day
            if ".." in path.replace("\\", "/").split("/") or "\\" in path:
                raise RefusedError(404, "no such page")
            if any(character < " " or character == "\x7f" for character in path):
                raise RefusedError(404, "a path with control characters")
            path = unquote(path)
        if len(raw) > 8192:
            raise RefusedError(414, "the address is too long")

    @property
    def asks(self) -> bool:
        """Whether a token is required."""
        return self._token is not None

    def is_token(self, text: str | None) -> bool:
        """Return whether a text is the token, in time that does not depend on how much of it is right."""
        if self._token is None:
            return True
        return text is not None and _same(text, self._token)

    def pass_cookie(self) -> str:
        """Return what a browser that showed the token keeps instead of it."""
        return hmac.new(self._secret, (self._token or "").encode(), sha256).hexdigest()

    def is_pass(self, cookie: str | None) -> bool:
        """Return whether a cookie is :meth:`pass_cookie`'s."""
        return self._token is None or (cookie is not None and _same(cookie, self.pass_cookie()))

    def new_session(self) -> str:
        """Return what a browser without a session is to call the one that it may begin."""
        name = secrets.token_urlsafe(24)
        return f"{name}.{self._signature(name)}"

    def is_session(self, cookie: str | None) -> bool:
        """Return whether :meth:`new_session` issued a cookie: sessions have no other source of names."""
        if cookie is None:
            return False
        name, _, signature = cookie.rpartition(".")
        return _same(signature, self._signature(name))

    def _signature(self, name: str) -> str:
        text = name.encode(errors="backslashreplace")
        return hmac.new(self._secret, b"session " + text, sha256).hexdigest()[:32]


def _same(given: str, expected: str) -> bool:
    # What browsers send may not be Unicode that can be encoded.
    return hmac.compare_digest(given.encode(errors="backslashreplace"), expected.encode())


def _is_host(text: str) -> bool:
    return fullmatch(r"(\[[0-9A-Fa-f:.]+\]|[A-Za-z0-9._-]+)(:\d{1,5})?", text) is not None


def announced_size(chunk: bytes) -> int:
    """Return the size of the whole message that a chunk of wslink's belongs to."""
    if len(chunk) < CHUNK_HEADER:
        raise RefusedError(400, "a message shorter than its header")
    size: int = unpack_from("<I", chunk, 8)[0]
    return size


def check_message(chunk: bytes) -> None:
    """Refuse chunks that are too large, or that announce a message that is."""
    if len(chunk) > LARGEST_MESSAGE or announced_size(chunk) > LARGEST_MESSAGE:
        raise RefusedError(413, f"a message above {LARGEST_MESSAGE:,} bytes")
    if unpack_from("<I", chunk, 4)[0] + len(chunk) - CHUNK_HEADER > announced_size(chunk):
        raise RefusedError(400, "a chunk beyond the end of its message")
