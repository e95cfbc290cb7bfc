"""Long work beside everything else: in a thread of its own, one thing at a time, with progress on the page."""

from __future__ import annotations

import asyncio
import contextlib
import threading
import time
from collections.abc import AsyncIterator, Callable
from typing import TYPE_CHECKING, Any

from pvfiblets.support import memory
from pvfiblets.web.actions import Actions

if TYPE_CHECKING:
    from pvfiblets.web.app import Explorer
    from pvfiblets.web.scene.files.loading import Cancel, Progress

    Work = Callable[[Progress, Cancel], Any]

MOST_WAITING = 16
LATEST = 0.2  # seconds between two reports of progress


class BackgroundWork(Actions):
    """Long tasks in a thread, while the page goes on."""

    def __init__(self, app: Explorer) -> None:
        super().__init__(app)
        self._stop = threading.Event()
        self._doing = ""  # name of the background work, for people
        self._working = asyncio.Lock()
        self._waiting: list[str] = []  # for their turn, for people
        self.tell: Callable[[str], None] = lambda _: None  # called with the opened file's name, "" after it

    async def run_in_background(self, name: str, work: Work, what: str, *, cancellable: bool = True) -> Any:
        """Do what takes long in a thread of its own, with progress; the page goes on."""
        # One task at a time: others wait, and the page names them.
        app = self._app
        loop = asyncio.get_running_loop()
        reported = 0.0
        stop = threading.Event()

        def show(what: str, share: float) -> None:
            if stop.is_set():
                return
            with app.state:
                text = f"{name}: {what}"
                app.page.job = {"text": text, "share": 100.0 * share, "cancellable": cancellable, "then": self._then}

        def progress(what: str, share: float) -> None:  # in the thread
            nonlocal reported
            if (now := time.monotonic()) - reported > LATEST:
                reported = now
                loop.call_soon_threadsafe(show, what, share)

        async with self._turn(name):
            self._stop = stop
            self._doing = name
            self.tell(name)
            show(what, 0.0 if cancellable else -1.0)
            try:
                return await asyncio.to_thread(memory.within, lambda: work(progress, stop.is_set))
            finally:
                self.tell("")
                await asyncio.sleep(0)  # let the last report of the thread come first
                with app.state:
                    app.page.job = {}

    def cancel(self) -> None:
        """Cancel the running task at its next check; the next one begins then."""
        self._stop.set()
        if self._app.page.job:
            text = f"{self._doing}: stopping"
            self._app.page.job = {"text": text, "share": -1.0, "cancellable": False, "then": self._then}

    @property
    def _then(self) -> str:
        """Return the names of waiting tasks, for people."""
        return f"then {', '.join(self._waiting)}" if self._waiting else ""

    @contextlib.asynccontextmanager
    async def _turn(self, name: str) -> AsyncIterator[None]:
        """Wait for the running task; the page shows that."""
        if len(self._waiting) >= MOST_WAITING:
            raise ValueError(f"{name}: {MOST_WAITING} others wait for their turn; wait until some of them are done")
        self._waiting.append(name)
        self._show_waiting()
        try:
            await self._working.acquire()
        finally:
            self._waiting.remove(name)
        self._show_waiting()
        try:
            yield
        finally:
            self._working.release()

    def _show_waiting(self) -> None:
        if self._app.page.job:
            with self._app.state:
                self._app.page.job = {**self._app.page.job, "then": self._then}
