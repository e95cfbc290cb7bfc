"""The process of one session: ``python -m pvfiblets.web.worker``, started by the front server and by nothing else.

It reads its settings from standard input, says on standard output where it listens, and ends when standard input
closes. Every request must carry the front server's key, so that no other process on this machine can use it.
"""

from __future__ import annotations

import asyncio
import contextlib
import hmac
import json
import logging
import os
import sys
import tempfile
import threading
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, TextIO

from pvfiblets.errors import FibletsError
from pvfiblets.web.server.log_limiter import LogLimiter

if TYPE_CHECKING:
    from pvfiblets.web.app import Explorer
    from pvfiblets.web.server.options import Options

KEY_HEADER = "X-Pvfiblets-Key"
LEAST = 256 << 20  # bytes that must be left for pictures and files


def main() -> int:
    """Run a session until its gate has gone."""
    told = json.loads(sys.stdin.readline())
    # What others print goes to standard error: standard output is for the front server.
    speaker = os.fdopen(os.dup(1), "w", buffering=1)
    os.dup2(2, 1)
    sys.argv = sys.argv[:1]  # trame reads the command line too
    logging.basicConfig(level=logging.WARNING, format="%(levelname)s %(name)s: %(message)s", stream=sys.stderr)
    for handler in logging.root.handlers:  # browsers report errors of their scripts here, as many as they like
        handler.addFilter(LogLimiter())
    try:
        _run(told, speaker)
    except FibletsError as error:
        print(json.dumps({"failure": str(error)}), file=speaker)
        return 1
    except Exception as error:
        print(json.dumps({"failure": f"{type(error).__name__}: {error}"}), file=speaker)
        raise
    return 0


def _run(told: dict[str, Any], speaker: TextIO) -> None:
    from pvfiblets.support.nifti_space import nifti_space
    from pvfiblets.support.surface_space import as_stored
    from pvfiblets.web.server.options import Options

    options = Options.from_dict(told["options"])
    folder = Path(told["folder"])
    tempfile.tempdir = str(folder)  # of all that runs here: the front server takes it away where this process cannot
    if sys.platform.startswith("linux") and not os.environ.get("DISPLAY"):
        os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")  # VTK need not try X and complain
    with nifti_space(options.nifti_space, units=options.nifti_units), as_stored(options.tkras):
        _serve(options, folder, told["key"], speaker)


def _serve(options: Options, folder: Path, key: str, speaker: TextIO) -> None:
    from pvfiblets.web.server.rpc_allowlist import guard_messages

    loop = asyncio.new_event_loop()
    asyncio.set_event_loop(loop)
    app = make_app(options, folder)
    hold_to(options.memory)
    app.files.tell = lambda doing: print(json.dumps({"doing": doing}), file=speaker)
    server = app.server

    def bind(web_server: Any) -> None:
        # wslink offers no other way to its table of methods, which is what must be guarded.
        for handler in web_server._ws_handlers:  # noqa: SLF001
            app.doors.guard(handler.functionMap)
            guard_messages(handler, app.complain)
        web_server.app.middlewares.append(key_check(key))
        app.add_routes(web_server.app.router)

    def ready(**_: Any) -> None:
        threading.Thread(target=_obey, args=(loop, app), daemon=True).start()
        print(json.dumps({"port": server.port}), file=speaker)

    server.controller.on_server_bind.add(bind)
    server.controller.on_server_ready.add(ready)
    listen(server)
    app.close()


def listen(server: Any) -> None:
    """Run a server of trame's on a port of loopback until it is stopped."""
    # It never stops by itself, as trame's do 300 seconds after the last browser has gone: when a session ends is the
    # gate's to say (`pvfiblets.web.server.launcher`), which keeps the only clock.
    server.start(
        port=0,
        host="127.0.0.1",
        timeout=0,
        open_browser=False,
        show_connection_info=False,
        disable_logging=True,
        exec_mode="main",
        backend="aiohttp",
    )


def hold_to(most: int | None) -> None:
    """Limit the memory of this process as configured."""
    if most is None:
        return
    from pvfiblets.support import memory

    taken = memory.taken()
    if taken + LEAST > most:
        raise FibletsError(
            f"--max-memory {memory.shown(most)}: a session takes {memory.shown(taken)} on this machine before it opens "
            f"anything; start the server with {memory.shown(taken + LEAST)} or more"
        )
    memory.limit(most)
    with contextlib.suppress(OSError):  # where the machine runs out, a session goes first, never the server
        Path("/proc/self/oom_score_adj").write_text("500", encoding="ascii")


def make_app(options: Options, folder: Path) -> Explorer:
    """Return the application of a session."""
    from pvfiblets.web.app import Explorer
    from pvfiblets.web.server.scratch import Notes

    return Explorer(options, Notes(folder))


def key_check(key: str) -> Callable[..., Awaitable[Any]]:
    """Return a middleware of aiohttp that lets in only requests with the front server's key."""
    from aiohttp import web

    @web.middleware
    async def check(request: web.Request, handler: Callable[[web.Request], Awaitable[Any]]) -> Any:
        if not hmac.compare_digest(request.headers.get(KEY_HEADER, "").encode(errors="backslashreplace"), key.encode()):
            raise web.HTTPForbidden
        return await handler(request)

    return check


def _obey(loop: asyncio.AbstractEventLoop, app: Any) -> None:
    """Do what the front server says, a line of JSON each, until it says no more."""
    while line := sys.stdin.readline():
        told = json.loads(line)
        if "say" in told:
            loop.call_soon_threadsafe(app.complain, told["say"])
        elif told.get("restore"):
            loop.call_soon_threadsafe(app.files.restore)
    asyncio.run_coroutine_threadsafe(app.server.stop(), loop)


if __name__ == "__main__":
    sys.exit(main())
