"""Temporary files that killed writers leave beside their target: finding the abandoned ones, and removing them.

A file or folder in the making is hidden and named by its target, machine and process, and locked for as long as its
writer lives: the system gives the lock up with the process, whatever ended it.
"""

from __future__ import annotations

import hashlib
import itertools
import os
import platform
import re
import shutil
import warnings
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import cache
from os import PathLike
from pathlib import Path

_NAME = re.compile(r"\..+\.([0-9a-f]{8})-([0-9]+)\.(part|old|scratch)")
_NUMBERS = itertools.count()
_ID = Path("/etc/machine-id")


def unfinished(target: Path, kind: str = "part") -> Path:
    """Return where this process makes a target."""
    return target.with_name(f".{target.name}.{_machine()}-{os.getpid()}.{kind}")


@contextmanager
def locked(place: Path) -> Iterator[None]:
    """Hold a file or folder that is there as one in the making; where locks are not kept, do nothing."""
    held = _lock(place)
    try:
        yield
    finally:
        if held is not None:
            os.close(held)


@contextmanager
def scratch_folder_for(target: Path) -> Iterator[Path]:
    """Make a temporary folder beside a target, and remove it afterwards."""
    whole = target.resolve()
    place = unfinished(whole.with_name(f"{whole.name}.{next(_NUMBERS)}"), "scratch")  # threads have one each
    place.mkdir(mode=0o700)
    try:
        with locked(place):
            yield place
    finally:
        shutil.rmtree(place, ignore_errors=True)


def remove_unfinished(folder: str | PathLike[str]) -> list[Path]:
    """Remove what killed writers left in a folder, and warn of what that was."""
    # Only if three things agree: this machine wrote it, no process has the writer's number, and its lock is free. So
    # files that another machine writes to a shared folder stay, and a container's with the same name. Without such
    # locks (Windows) nothing is removed.
    gone: list[Path] = []
    with suppress(OSError):
        for entry in sorted(Path(folder).iterdir()):
            found = _NAME.fullmatch(entry.name)
            if found is None or found[1] != _machine() or _lives(int(found[2])):
                continue
            held = _lock(entry)
            if held is None:
                continue
            with suppress(OSError):
                if entry.is_dir() and not entry.is_symlink():
                    shutil.rmtree(entry)
                else:
                    entry.unlink()
                gone.append(entry)
            os.close(held)
    if gone:
        names = ", ".join(entry.name for entry in gone)
        warnings.warn(f"removed what a killed conversion left in {folder}: {names}", UserWarning, stacklevel=3)
    return gone


@cache
def _machine() -> str:
    name = platform.node()
    with suppress(OSError):
        name += _ID.read_text(encoding="ascii", errors="replace")
    return hashlib.sha256(name.encode()).hexdigest()[:8]


def _lives(process: int) -> bool:
    if os.name != "posix":  # there, the same call would end it
        return True
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except (OSError, OverflowError):
        return True
    return True


def _lock(place: Path) -> int | None:
    """Open and lock a file or folder; None where somebody else has it, or there are no locks."""
    try:
        import fcntl
    except ImportError:
        return None
    try:
        held = os.open(place, os.O_RDONLY if place.is_dir() else os.O_RDWR)
    except OSError:
        return None
    try:
        fcntl.flock(held, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        os.close(held)
        return None
    return held
