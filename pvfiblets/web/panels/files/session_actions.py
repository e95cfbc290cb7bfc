"""Sessions of the page: saved, kept in the served folder, opened with progress, and restored after a crash."""

from __future__ import annotations

import asyncio
import logging
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pvfiblets.errors import FibletsError
from pvfiblets.web.background_work import BackgroundWork
from pvfiblets.web.scene.files.loading import Cancelled
from pvfiblets.web.session import files as session

if TYPE_CHECKING:
    from aiohttp import web

    from pvfiblets.web.app import Explorer

logger = logging.getLogger("pvfiblets.web")

SESSION = ".json"  # the suffix of sessions

QUIET, LATEST = 1.0, 10.0  # seconds after the last, and after the first change that is not kept yet
LARGEST_KEPT = 64 << 20  # bytes


class SessionActions(BackgroundWork):
    """The sessions of an application."""

    def __init__(self, app: Explorer) -> None:
        super().__init__(app)
        self._timer: asyncio.TimerHandle | None = None
        self._changed: float | None = None  # when the first change came that is not kept yet
        self._kept = ""
        self._restoring = False
        self._starting: asyncio.Future[Any] | None = None  # opens what the server was started with

    def save_session(self) -> str:
        """Return the session as JSON."""
        return session.to_text(self._app.scene)

    def store_session(self, name: str) -> None:
        """Write the session to a file of the served folder."""
        app = self._app
        name = str(name).strip().removesuffix(SESSION) + SESSION
        app.confined.writable(name, (SESSION,))
        session.save(app.scene, name)
        app.page.dialog = ""
        app.say(f"The session is saved in the served folder as {name}.", "success")

    def open_session(self, path: str) -> None:
        """Open a session file in the served folder; its paths are looked for beside it first."""
        place = self._app.confined.existing(path)
        self.load_session(session.read(place), place.parent)

    async def receive_session(self, request: web.Request) -> web.Response:
        """Open the session that a browser uploads; the front server has checked its size."""
        from aiohttp import web

        self.load_session(await request.content.read())
        return web.Response(text="taken")

    def load_session(self, content: str | bytes, folder: Path | None = None) -> None:
        """Become what a session file says; where it is malformed, all stays as it is."""
        self._app.later(self._become(content, folder))

    async def _become(self, content: str | bytes, folder: Path | None = None) -> None:
        app = self._app
        scene = app.scene
        try:
            prepared = await self.run_in_background(
                "session",
                lambda progress, cancel: session.prepare(scene, session.from_text(content), folder, progress, cancel),
                "reading",
            )
        except Cancelled:
            app.say("The session was not loaded: cancelled.")
            return
        session.apply(scene, prepared)
        app.refresh()

    # For the case that this process dies

    def keep_soon(self) -> None:
        """Write the session to the private folder once nothing changes for a moment; the server restores it."""
        if self._app.notes.session is None or self._restoring:
            return
        loop = asyncio.get_running_loop()
        now = loop.time()
        self._changed = now if self._changed is None else self._changed
        if self._timer is not None:
            self._timer.cancel()
        self._timer = loop.call_at(min(now + QUIET, self._changed + LATEST), self._keep)

    def _keep(self) -> None:
        self._timer = self._changed = None
        if self._restoring:
            return
        try:
            text = session.to_text(self._app.scene)
            if text != self._kept and len(text) <= LARGEST_KEPT:
                self._app.notes.keep(text)
                self._kept = text
        except (FibletsError, OSError, MemoryError) as error:
            logger.warning("the session is not kept: %s", error)

    def restore(self) -> None:
        """Become the session that a process before this one kept, after the files of the server's start."""
        self._app.later(self._restore())

    async def _restore(self) -> None:
        self._restoring = True  # the kept session stays, even if reading it ends this process
        try:
            content = self._app.notes.restored()
            if self._starting is not None:
                await asyncio.wait([self._starting])
            await self._become(content)
        finally:
            self._restoring = False
