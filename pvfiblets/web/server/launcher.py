"""Sessions: one process each, started, watched and ended.

A session lives while a browser is connected, and for `timeout` seconds after the last one has gone: a reload or a lost
connection finds it as it was. Its process ends with it, which frees its GPU memory. The process ends by
itself when its standard input closes, so that none is left behind when the front server dies.
"""

from __future__ import annotations

import asyncio
import contextlib
import json
import logging
import os
import secrets
import sys
import time
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from pvfiblets.support import memory
from pvfiblets.web.server import endings, scratch, tokens
from pvfiblets.web.server.log_limiter import printable
from pvfiblets.web.server.options import Options

logger = logging.getLogger("pvfiblets.web")

GRACE = 5.0  # seconds that a process has to end by itself
RESCUED = 3600.0  # seconds that the session of a dead process can be restored
MOST_RESCUED = 32
MOST_WAITING = 1 << 16  # bytes sent to a process and not read yet
SHARED = "shared"
WORKER = (sys.executable, "-m", "pvfiblets.web.worker")


@dataclass
class Session:
    """One scene and the process that holds it."""

    id: str = field(repr=False)  # what the browser's cookie says
    # what every request to the process must carry, so that other users of this machine cannot make one
    key: str = field(default_factory=lambda: secrets.token_hex(32), repr=False)
    port: int | None = None  # where its process listens on loopback, once it does
    failure: str | None = None  # why it ended, if it was not asked to
    connections: int = 0  # browsers (or tabs) that are connected now
    short: str = field(default_factory=lambda: secrets.token_hex(3))  # what logs call it: nothing of the cookie
    seen: float = field(default_factory=time.monotonic)
    process: asyncio.subprocess.Process | None = None
    tasks: list[asyncio.Task[None]] = field(default_factory=list)
    ready: asyncio.Event = field(default_factory=asyncio.Event)
    ended: bool = False
    folder: Path | None = None  # of its temporary files; it goes with the process
    doing: str = ""  # what its process opens now, for people; empty if nothing
    # what its process wrote to standard error last
    last_lines: deque[str] = field(default_factory=lambda: deque(maxlen=50), repr=False)


@dataclass
class Rescued:
    """The session that a dead process had kept, in a folder of the scratch folder."""

    folder: Path
    since: float = field(default_factory=time.monotonic)
    wanted: bool = False  # by the browser, for the next process of its session


class Launcher:
    """Starts and ends the sessions of one server."""

    def __init__(self, options: Options, on_end: Callable[[Session], None], command: Sequence[str] = WORKER) -> None:
        self._options = options  # the limit, the timeout and what a session opens with
        self._on_end = on_end  # called with a session that has ended, however it did
        self._command = tuple(command)  # what a session's process runs
        self.sessions: dict[str, Session] = {}
        self._failed: deque[Session] = deque(maxlen=32)
        self._rescued: dict[str, Rescued] = {}
        self._spare: Session | None = None
        self._reaper: asyncio.Task[None] | None = None
        self._scratch: scratch.Scratch | None = None

    async def start(self) -> None:
        """Begin to watch, and prepare the first session before its browser comes."""
        self._scratch = await asyncio.to_thread(scratch.Scratch)
        self._reaper = asyncio.create_task(self._reap())
        self._spare = await self._launch(SHARED if self._options.shared else secrets.token_urlsafe(24))

    def find(self, identifier: str | None) -> Session | None:
        """Return the session of a browser's cookie, ended ones included while they are remembered."""
        if identifier is None:
            return None
        found = self.sessions.get(identifier)
        if found is None:
            found = next((session for session in self._failed if session.id == identifier), None)
        return found

    @property
    def full(self) -> bool:
        """Whether no further session may start."""
        return len(self.sessions) >= self._options.limit

    @property
    def has_room(self) -> bool:
        """Whether a browser that has no session can get one."""
        return self._spare is not None or not self.full

    async def open(self, identifier: str) -> Session | None:
        """Return the session of a cookie, begun if there is none, or ``None`` at the limit."""
        session, spare = self.sessions.get(identifier), self._spare
        if session is None or session.ended:
            if spare is not None and not spare.ended:
                del self.sessions[spare.id]
                spare.id, session = identifier, spare
                self.sessions[identifier] = session
            elif self.full:
                return None
            else:
                session = await self._launch(identifier)
        if session is spare:
            self._spare = None
        session.seen = time.monotonic()
        rescued = self._rescued.get(identifier)
        if rescued is not None and rescued.wanted and session.folder is not None and not session.ended:
            del self._rescued[identifier]
            await asyncio.to_thread(scratch.hand_over, rescued.folder, session.folder)
            self.tell(session, restore=True)
        return session

    def can_restore(self, session: Session) -> bool:
        """Return whether the last state of a session that failed is there."""
        return session.ended and session.id in self._rescued

    async def forgive(self, session: Session, *, restore: bool = False) -> None:
        """Forget that a session failed, so that another may begin in its place, with its last state or without."""
        if session in self._failed:
            self._failed.remove(session)
        if not restore:
            await self._discard(session.id)
        elif session.id in self._rescued:
            self._rescued[session.id].wanted = True

    def tell(self, session: Session, **told: object) -> None:
        """Send a message to a session's process: ``restore=True``, or a sentence for its page, ``say=...``."""
        stdin = None if session.ended or session.process is None else session.process.stdin
        if stdin is not None and stdin.transport.get_write_buffer_size() < MOST_WAITING:
            stdin.write((json.dumps(told) + "\n").encode())

    async def _rescue(self, session: Session) -> None:
        """Keep what a dead process had kept of its session."""
        if self._scratch is None or session.folder is None or session is self._spare:
            return
        folder = await asyncio.to_thread(self._scratch.rescue, session.folder)
        await self._discard(session.id)
        if folder is not None:
            self._rescued[session.id] = Rescued(folder)
        while len(self._rescued) > MOST_RESCUED:
            await self._discard(next(iter(self._rescued)))

    async def _discard(self, identifier: str) -> None:
        if (rescued := self._rescued.pop(identifier, None)) is not None:
            await asyncio.to_thread(scratch.remove, rescued.folder)

    async def _launch(self, identifier: str) -> Session:
        session = Session(identifier, folder=None if self._scratch is None else self._scratch.session())
        self.sessions[identifier] = session
        environment = os.environ | {"WSLINK_READY_MSG": "", "WSLINK_WS_COMPRESS": "0", "PYTHONUNBUFFERED": "1"}
        environment.pop(tokens.VARIABLE, None)
        if self._options.memory is not None:
            environment |= memory.ENVIRONMENT
        try:
            process = await asyncio.create_subprocess_exec(
                *self._command,
                stdin=asyncio.subprocess.PIPE,
                stdout=asyncio.subprocess.PIPE,
                stderr=asyncio.subprocess.PIPE,
                env=environment,
            )
        except OSError as error:  # of memory, processes or file descriptors
            session.failure = f"no process could be started: {error.strerror}"
            logger.error("session %s: %s", session.short, session.failure)
            if session.folder is not None:
                await asyncio.to_thread(scratch.remove, session.folder)
            await self._forget(session)
            return session
        session.process = process
        assert process.stdin is not None
        # By standard input: command lines and environments can be read by others.
        told = self._options.as_dict() | {"token": None, "host": "127.0.0.1", "port": 0}
        more = {"key": session.key, "folder": None if session.folder is None else str(session.folder)}
        process.stdin.write((json.dumps({"options": told, **more}) + "\n").encode())
        with contextlib.suppress(ConnectionError):
            await process.stdin.drain()
        session.tasks = [asyncio.create_task(self._watch(session))]
        logger.info("session %s: started as process %d", session.short, process.pid)
        return session

    async def _watch(self, session: Session) -> None:
        """Read what a process says until it ends."""
        process = session.process
        assert process is not None
        assert process.stdout is not None
        assert process.stderr is not None
        errors = asyncio.create_task(self._keep(session, process.stderr))
        said = None
        async for line in process.stdout:
            try:
                told = json.loads(line)
            except ValueError:
                continue
            if isinstance(told, dict) and "port" in told:
                session.port = int(told["port"])
                session.ready.set()
            elif isinstance(told, dict) and "failure" in told:
                said = str(told["failure"])
            elif isinstance(told, dict) and "doing" in told:
                session.doing = str(told["doing"])
        code = await process.wait()
        await errors
        if not session.ended:
            await self._rescue(session)
        if session.folder is not None:
            await asyncio.to_thread(scratch.remove, session.folder)
        if not session.ended:
            session.failure = said or endings.reason(code, session.last_lines, session.doing, self._options.memory)
            logger.error("session %s: %s (%s)", session.short, session.failure, endings.shown(code))
        await self._forget(session)

    async def _keep(self, session: Session, stream: asyncio.StreamReader) -> None:
        while True:
            try:
                line = await stream.readline()
            except ValueError:  # a line longer than the buffer
                continue
            if not line:
                return
            text = printable(line.decode(errors="replace").rstrip())
            session.last_lines.append(text)
            logger.info("session %s: | %s", session.short, text, extra={"about": session.short})

    async def _forget(self, session: Session) -> None:
        session.ended = True
        session.ready.set()
        if self.sessions.get(session.id) is session:
            del self.sessions[session.id]
        if self._spare is session:
            self._spare = None
        if session.failure is not None:
            self._failed.append(session)
        self._on_end(session)

    async def end(self, session: Session) -> None:
        """End a session and its process."""
        if session.ended:
            return
        session.ended = True
        logger.info("session %s: ended", session.short)
        self._on_end(session)
        process = session.process
        if process is not None and process.returncode is None:
            if process.stdin is not None:
                process.stdin.close()
            try:
                await asyncio.wait_for(process.wait(), GRACE)
            except TimeoutError:
                process.kill()
                await process.wait()
        await asyncio.gather(*session.tasks, return_exceptions=True)

    async def _reap(self) -> None:
        while True:
            await asyncio.sleep(min(5.0, self._options.timeout / 4))
            await self.end_idle()

    async def end_idle(self) -> None:
        """End sessions whose browser has not come back in time, and forget states after their time to be restored."""
        now = time.monotonic()
        for identifier in [one for one, rescued in self._rescued.items() if now - rescued.since > RESCUED]:
            await self._discard(identifier)
        for session in list(self.sessions.values()):
            if session is self._spare or session.connections or session.ended:
                continue
            if (idle := now - session.seen) > self._options.timeout:
                logger.info("session %s: no browser for %.0f s", session.short, idle)
                await self.end(session)

    async def stop(self) -> None:
        """End all sessions."""
        if self._reaper is not None:
            self._reaper.cancel()
            await asyncio.gather(self._reaper, return_exceptions=True)
        await asyncio.gather(*(self.end(session) for session in list(self.sessions.values())))
        if self._scratch is not None:
            await asyncio.to_thread(self._scratch.close)
