"""Files that appear only when they are complete, and the errors where one cannot be written."""

from __future__ import annotations

import errno
import os
import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from os import PathLike
from pathlib import Path
from typing import BinaryIO

from .unfinished import locked, unfinished

_FULL = (errno.ENOSPC, errno.EDQUOT) if hasattr(errno, "EDQUOT") else (errno.ENOSPC,)
_CLOSED = (errno.EACCES, errno.EPERM, errno.EROFS)


@contextmanager
def replacing(path: str | PathLike[str], needed: int | None = None) -> Iterator[BinaryIO]:
    """Open a temporary file beside `path` for writing; it takes the name when all went well."""
    # A reader therefore never meets half a file, and a failed write leaves an old file as it was.
    target = Path(path)
    temporary = unfinished(target)
    with naming_target(target, needed):
        try:
            with temporary.open("wb") as file, locked(temporary):
                yield file
            temporary.replace(target)
        except BaseException:
            with suppress(OSError):
                temporary.unlink()
            raise


@contextmanager
def naming_target(path: str | PathLike[str], needed: int | Callable[[], int] | None = None) -> Iterator[None]:
    """Make errors of writing, in whichever temporary file, name the target file and the fix."""
    target = Path(path)
    try:
        yield
    except OSError as error:
        if error.errno is None or not _of_target(error, target):
            raise
        raise OSError(error.errno, _message(error, target, needed), os.fspath(path)) from error


def made_folder(path: str | PathLike[str]) -> Path:
    """Return a folder, made with its parents unless it is there."""
    folder = Path(path)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except FileExistsError:
        raise NotADirectoryError(errno.ENOTDIR, "it is a file; name a folder", os.fspath(path)) from None
    except OSError as error:
        if error.errno == errno.ENOTDIR:
            raise NotADirectoryError(error.errno, "it would lie in a file; name a folder", os.fspath(path)) from None
        if error.errno in (*_CLOSED, errno.ENOENT):
            raise OSError(error.errno, "this folder cannot be made; choose another one", os.fspath(path)) from error
        raise
    return folder


def _of_target(error: OSError, target: Path) -> bool:
    """Whether an error is of the target: of a full disk, or of a hidden file in its folder."""
    if not isinstance(error.filename, (str, bytes, os.PathLike)):
        return error.errno in (*_FULL, errno.EFBIG)
    named, folder = Path(os.fsdecode(error.filename)).absolute(), target.absolute().parent
    return named.is_relative_to(folder) and str(named.relative_to(folder)).startswith(".") and named != folder


def _message(error: OSError, target: Path, needed: int | Callable[[], int] | None) -> str:
    folder = target.absolute().parent
    takes = ""
    if isinstance(needed, int):
        takes = f"it takes {needed / 1e6:,.1f} MB"
    elif needed is not None:
        takes = f"it takes {needed() / 1e6:,.1f} MB or more"
    if error.errno in _FULL:
        free = "none"
        with suppress(OSError):
            free = f"{shutil.disk_usage(folder).free / 1e6:,.1f} MB"
        known = f"{takes}; " if takes else ""
        return f"no space is left for it ({known}free in {folder}: {free}); make room there, or write to another disk"
    if error.errno == errno.EFBIG:
        known = f"; {takes}" if takes else ""
        return f"it is larger than files may be here{known}; raise that limit (ulimit -f), or write to another disk"
    if not folder.is_dir():
        return f"there is no folder {folder}; make it first"
    if error.errno in (*_CLOSED, errno.ENOENT):
        return f"the folder {folder} cannot be written to; choose another one, or change its permissions"
    return error.strerror or "it cannot be written"
