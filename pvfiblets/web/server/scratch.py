"""Temporary files of sessions: where they are, and how they go when a session did not take them away itself.

The front server has a folder, and each session's process a folder in it, the temporary folder of all its code.
A killed process cleans nothing up, so the front server does; the next front server cleans up after a killed one.
A session records files written elsewhere before it writes them, until they are whole.
"""

from __future__ import annotations

import contextlib
import os
import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import IO

try:
    import fcntl
except ImportError:  # Windows, where folders of dead gates stay until its own clean-up
    fcntl = None  # type: ignore[assignment]

__all__ = ["PRIVATE", "Notes", "Scratch", "remove_abandoned"]

PREFIX = "pvfiblets-serve-"
PRIVATE = ".pvfiblets-"  # prefix of names that sessions record: nothing else is ever removed
_LOCK, _NOTES = "lock", "notes"
_SESSION, _RESTORE = "session.json", "restore.json"


class Scratch:
    """The front server's folder: the sessions' folders are in it."""

    def __init__(self) -> None:
        remove_abandoned()
        self.folder = Path(tempfile.mkdtemp(prefix=PREFIX))
        # As long as this process lives: the system lets go of it, however the process ends.
        self._lock: IO[str] | None = (self.folder / _LOCK).open("w")
        if fcntl is not None and not (_locked(self._lock) and (self.folder / _LOCK).exists()):
            self._lock.close()
            raise OSError(f"{self.folder}: another server took this folder for an abandoned one; start again")

    def session(self) -> Path:
        """Make a folder for a session."""
        return Path(tempfile.mkdtemp(dir=self.folder))

    def rescue(self, folder: Path) -> Path | None:
        """Move the session that a dead process kept to a folder of its own, and return that; None if it kept none."""
        for name in (_RESTORE, _SESSION):  # a session to restore counts more than the initial files
            if (folder / name).is_file():
                found = self.session()
                (folder / name).replace(found / _SESSION)
                return found
        return None

    def close(self) -> None:
        """Remove everything; twice is harmless."""
        if self._lock is not None:
            self._lock.close()
            self._lock = None
        for folder in self.folder.glob("*/"):
            remove(folder)
        shutil.rmtree(self.folder, ignore_errors=True)


class Notes:
    """Unfinished files that a session writes outside of its folder."""

    def __init__(self, folder: Path | None) -> None:
        self._file = None if folder is None else folder / _NOTES
        self.session = None if folder is None else folder / _SESSION
        self._open: list[Path] = []

    @contextlib.contextmanager
    def private(self, beside: Path) -> Iterator[Path]:
        """Give a hidden folder in another, which is gone afterwards, whatever happens."""
        # If this process is killed before, files beside the folder that have a second name in it, the same one, go with
        # it. Where a file system has no hard links, they stay.
        found = Path(tempfile.mkdtemp(prefix=PRIVATE, dir=beside))
        self._open.append(found)
        self._write()
        try:
            yield found
        finally:
            shutil.rmtree(found, ignore_errors=True)
            self._open.remove(found)
            self._write()

    def keep(self, session: str) -> None:
        """Keep a session in the private folder, in case this process dies."""
        assert self.session is not None
        part = self.session.with_suffix(".part")
        part.write_text(session, encoding="utf-8")
        part.replace(self.session)

    def restored(self) -> bytes:
        """Return the session that :func:`hand_over` put here, which this process keeps from now on."""
        assert self.session is not None
        self.session.with_name(_RESTORE).replace(self.session)
        return self.session.read_bytes()

    def _write(self) -> None:
        if self._file is not None:
            self._file.write_text("\n".join(map(str, self._open)), encoding="utf-8")


def hand_over(rescued: Path, folder: Path) -> None:
    """Move a rescued session to the folder of the process that is to restore it."""
    (rescued / _SESSION).replace(folder / _RESTORE)
    rescued.rmdir()


def remove(folder: Path) -> None:
    """Remove a session's folder, and the files that it recorded."""
    notes = folder / _NOTES
    for line in notes.read_text(encoding="utf-8").splitlines() if notes.is_file() else ():
        noted = Path(line)
        if noted.name.startswith(PRIVATE) and not noted.is_symlink():
            for part in noted.glob("*"):
                other = noted.parent / part.name
                with contextlib.suppress(OSError):
                    if os.path.samestat(part.lstat(), other.lstat()):
                        other.unlink()
            shutil.rmtree(noted, ignore_errors=True)
    shutil.rmtree(folder, ignore_errors=True)


def remove_abandoned() -> None:
    """Remove the folders of this user's gates that live no more."""
    if fcntl is None:
        return
    for folder in Path(tempfile.gettempdir()).glob(PREFIX + "*"):
        with contextlib.suppress(OSError):
            if folder.is_symlink() or folder.stat().st_uid != os.getuid():
                continue
            with (folder / _LOCK).open("r+") as lock:
                if not _locked(lock):
                    continue
                for part in folder.glob("*/"):
                    remove(part)
                shutil.rmtree(folder, ignore_errors=True)


def _locked(file: IO[str]) -> bool:
    """Take a lock if it is free; return whether this process holds it now."""
    if fcntl is None:
        return False
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        return False
    return True
