"""The files of a sharded set: a folder here, or anywhere that fsspec reaches, kept in a cache.

What is far away is fetched a file at a time, when it is first asked for, and kept on disk under its checksum, so that
a changed set never meets files of before. The cache has a size; the least recently used files go first. A lost
connection is tried again, from the byte where it broke.
"""

from __future__ import annotations

import hashlib
import os
import time
import warnings
from collections.abc import Callable
from os import PathLike
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

from ...errors import FormatError
from ...support.addresses import is_url
from ...support.cache_folder import cache_folder
from ...support.whole_files import replacing
from .manifest import StoredFile

PIECE = 1 << 22
TRIES = 5
PAUSE = 0.5  # seconds before the second try; each further one waits twice as long


def store_at(place: str | PathLike[str], cache: Cache | None = None, **options: Any) -> Folder | Remote:
    """Return what gives the files of a set."""
    return (
        Remote(os.fspath(place), cache or Cache(), **options)
        if is_url(place)
        else Folder(Path(place).expanduser().resolve())
    )


class Folder:
    """Files of a folder on this machine."""

    def __init__(self, path: Path) -> None:
        self.name = os.fspath(path)
        self._path = path

    def read(self, name: str) -> bytes:
        """Return a small file's bytes."""
        return (self._path / name).read_bytes()

    def is_here(self, file: StoredFile) -> bool:
        """Whether a file need not be fetched."""
        return (self._path / file.name).is_file()

    def local(self, file: StoredFile) -> Path:
        """Return the path of a file that is as long as it should be."""
        path = self._path / file.name
        try:
            size = path.stat().st_size
        except FileNotFoundError:
            raise FormatError(self.name, None, f"no file {file.name}", "all files that its manifest names") from None
        if size != file.bytes:
            raise FormatError(path, None, f"{size} bytes", f"{file.bytes}, as its manifest says: copy it again")
        return path


class Cache:
    """Files on this machine that were fetched from elsewhere.

    Parameters
    ----------
    folder : str or PathLike, optional
        ``shards`` in the program's cache folder by default.
    size : int
        Bytes that it holds at most, but for the files in use last.
    """

    def __init__(self, folder: str | PathLike[str] | None = None, size: int = 10_000_000_000) -> None:
        if size < 1:
            raise ValueError(f"a cache of {size} bytes holds nothing; give a size such as 10 GB")
        self.folder = cache_folder() / "shards" if folder is None else Path(folder).expanduser()
        self.size = size

    def place(self, file: StoredFile) -> Path:
        """Return where a file is, or would be."""
        return self.folder / f"{file.sha256}-{file.name}"

    def held(self, file: StoredFile) -> Path | None:
        """Return where a file is, or ``None``; it counts as used now."""
        path = self.place(file)
        try:
            if path.stat().st_size != file.bytes:
                return None
            os.utime(path)
        except OSError:
            return None
        return path

    def make_room(self, needed: int) -> None:
        """Remove the least recently used files until the given number of bytes fits."""
        # A set that has a file mapped goes on reading it: its name goes, its bytes stay until it is closed.
        files = []
        for path in self.folder.iterdir():
            try:
                told = path.stat()
            except OSError:
                continue
            if not path.name.startswith("."):
                files.append((told.st_mtime_ns, told.st_size, path))
        left = self.size - needed - sum(size for _, size, _ in files)
        for _, size, path in sorted(files):
            if left >= 0:
                break
            try:
                path.unlink()
            except OSError:  # Windows keeps mapped files
                continue
            left += size


class Remote:
    """Files at an address."""

    def __init__(self, url: str, cache: Cache, wait: Callable[[float], None] = time.sleep, **options: Any) -> None:
        try:
            import fsspec
        except ImportError as error:
            raise ImportError(
                f"{url}: addresses are read by fsspec, which is not installed: pip install pvfiblets[cluster]"
            ) from error
        # takes the seconds to wait for before another try
        self.name, self._url, self._cache, self._wait = url, url.rstrip("/"), cache, wait  # as fsspec takes it
        self._system = fsspec.filesystem(urlsplit(url).scheme, **options)

    def read(self, name: str) -> bytes:
        """Return a small file's bytes."""
        return bytes(self._again(f"{self._url}/{name}", lambda: self._system.cat_file(f"{self._url}/{name}")))

    def is_here(self, file: StoredFile) -> bool:
        """Whether a file need not be fetched."""
        return self._cache.held(file) is not None

    def local(self, file: StoredFile) -> Path:
        """Return the path of a file, fetched if the cache lacks it."""
        held = self._cache.held(file)
        if held is not None:
            return held
        self._cache.folder.mkdir(parents=True, exist_ok=True)
        self._cache.make_room(file.bytes)
        url, target = f"{self._url}/{file.name}", self._cache.place(file)
        found = hashlib.sha256()
        with replacing(target, file.bytes) as out:
            while out.tell() < file.bytes:
                start, stop = out.tell(), min(out.tell() + PIECE, file.bytes)
                piece = self._piece(url, start, stop)
                if len(piece) == file.bytes:  # a server that knows no ranges sends all
                    piece = piece[start:]
                elif len(piece) != stop - start:
                    raise FormatError(url, start, f"{len(piece)} bytes", f"the requested {stop - start}")
                out.write(piece)
                found.update(piece)
            if found.hexdigest() != file.sha256:
                raise FormatError(url, None, "other bytes than its manifest names", "the set as it was written")
        return target

    def _piece(self, url: str, start: int, stop: int) -> bytes:
        return bytes(self._again(url, lambda: self._system.cat_file(url, start=start, end=stop)))

    def _again(self, url: str, work: Callable[[], Any]) -> Any:
        """Do what a lost connection may break, some times."""
        for tried in range(TRIES):
            try:
                return work()
            except (FileNotFoundError, PermissionError):
                raise
            except Exception as error:  # each file system has errors of its own
                if tried == TRIES - 1:
                    raise OSError(
                        f"{url}: it cannot be fetched, in {TRIES} tries; the last one said: {error}"
                    ) from error
                pause = PAUSE * 2**tried
                warnings.warn(f"{url}: {error}; trying again in {pause:g} s", stacklevel=2)
                self._wait(pause)
        raise AssertionError("unreachable")
