"""Arrays in a zip archive, or in a folder of the same files: mapped, or inflated front to back where deflated."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from os import PathLike, fspath
from pathlib import Path
from typing import IO, Any
from zipfile import ZIP_DEFLATED, ZIP_STORED, BadZipFile, ZipFile, ZipInfo

import numpy as np
from numpy.typing import NDArray

from pvfiblets.errors import FormatError
from pvfiblets.formats.mapped import MappedFile, forget
from pvfiblets.formats.scratch import scratch_array, scratch_bytes, spans
from pvfiblets.support.memory import check_room

Array = NDArray[Any]

_SIZES = {"float": (16, 32, 64), "int": (8, 16, 32, 64), "uint": (8, 16, 32, 64)}
_TYPES = {
    f"{kind}{bits}": np.dtype(f"{kind}{bits}").newbyteorder("<") for kind, sizes in _SIZES.items() for bits in sizes
} | {"bit": np.dtype(bool), "bool": np.dtype(bool)}
"""Type by the last part of an entry's name; truth values take a byte each."""

_DEFLATE_LIMIT = 1040  # deflate cannot compress by more than 1032 to 1: a larger promise is damage

_PIECE = 1 << 24  # bytes inflated at a time where they are not wanted, or go to disk

_ZIP_ERRORS = (
    BadZipFile,
    EOFError,
    IndexError,
    KeyError,
    NotImplementedError,
    OSError,
    OverflowError,
    RuntimeError,
    ValueError,
    struct.error,
    zlib.error,
)
"""Errors of zipfile for damaged archives (RuntimeError: encrypted; OSError: absurd seeks)."""


class ZipArrays:
    """The arrays of a zip archive."""

    def __init__(self, path: str | PathLike[str]) -> None:
        self.file = MappedFile(path)
        self.path = self.file.path
        if self.file.size == 0:
            raise FormatError(self.path, 0, "an empty file", "a zip archive")
        with self.damage(0, "the archive"):
            self.archive = ZipFile(self.path)
        self.entries: list[ArrayEntry] = []  # those whose name ends in a known type
        self.odd_names = 0  # how many files have a name that says no type, besides `header.json`
        try:
            self._list()
        except BaseException:
            self.archive.close()
            raise

    def close(self) -> None:
        """Close the archive; arrays that were read stay valid."""
        for entry in self.entries:
            entry.close()
        self.archive.close()

    def _list(self) -> None:
        self._sort(self.archive.infolist())

    def _sort(self, infos: Iterable[ZipInfo]) -> None:
        self._infos: dict[str, ZipInfo] = {}
        for info in infos:
            if info.filename in self._infos or not info.filename:
                raise FormatError(
                    self.path,
                    info.header_offset,
                    f"a second file of the name {info.filename!r}",
                    "each name once, and none empty",
                )
            if not info.filename.endswith("/"):
                self._infos[info.filename] = info
        for info in self._infos.values():
            if info.filename == "header.json":
                continue
            *folder, last = info.filename.split("/")
            *parts, kind = last.split(".")
            if not parts or kind not in _TYPES:
                self.odd_names += 1
                continue
            columns = 1
            if len(parts) > 1 and parts[-1].isdecimal() and len(parts[-1]) < 9:
                columns = int(parts.pop())
            self.entries.append(ArrayEntry(self, info, tuple(folder), ".".join(parts), columns, _TYPES[kind]))

    @contextmanager
    def damage(self, position: int, what: str) -> Iterator[None]:
        """Turn what zipfile raises on damaged input into FormatError."""
        try:
            yield
        except FormatError:
            raise
        except _ZIP_ERRORS as error:
            found = f"{what} is damaged ({type(error).__name__}: {error})"
            raise FormatError(self.path, position, found, "an intact zip archive") from error

    def raw(self, name: str) -> tuple[bytes, int]:
        """Return the content of a small file in the archive, and where it begins."""
        if name not in self._infos:
            raise FormatError(self.path, None, f"no {name} in the archive", f"a file {name}")
        info = self._infos[name]
        self.check_size(info)
        check_room(info.file_size)
        with self.damage(info.header_offset, name):
            return self.archive.read(info), info.header_offset

    def check_size(self, info: ZipInfo) -> None:
        """Raise FormatError for a size that the archive cannot hold, before memory is spent."""
        at = info.header_offset
        if info.flag_bits & 1:
            raise FormatError(self.path, at, f"{info.filename} encrypted", "no encryption")
        if info.compress_type == ZIP_DEFLATED:
            most = info.compress_size * _DEFLATE_LIMIT + 64
        elif info.compress_type == ZIP_STORED:
            most = info.compress_size
        else:
            raise FormatError(
                self.path,
                at,
                f"{info.filename} compressed by method {info.compress_type}",
                "stored or deflated; pack the file again",
            )
        if info.compress_size > self.file.size or info.file_size > most:
            raise FormatError(
                self.path,
                at,
                f"{info.filename} of {info.file_size} bytes",
                f"at most {min(most, self.file.size * _DEFLATE_LIMIT)}: the archive is damaged",
            )

    def open(self, info: ZipInfo) -> IO[bytes]:
        """Open a file in the archive for reading from its beginning."""
        with self.damage(info.header_offset, info.filename):
            return self.archive.open(info)

    def stored(self, info: ZipInfo) -> tuple[MappedFile, int]:
        """Return the map of an uncompressed file, and its first byte in it."""
        file, at = self.file, info.header_offset
        head = file.bytes(at, 30, f"the local header of {info.filename}")
        if head[:4] != b"PK\x03\x04":
            raise FormatError(file.path, at, repr(head[:4]), "a local header b'PK\\x03\\x04'")
        name_size, extra_size = struct.unpack("<HH", head[26:30])
        return file, at + 30 + name_size + extra_size


class FolderArrays(ZipArrays):
    """The arrays of a folder that holds what an archive would."""

    def __init__(self, path: str | PathLike[str]) -> None:
        self.path = fspath(path)
        self.entries, self.odd_names = [], 0
        self._files: dict[str, MappedFile] = {}
        place = Path(path)
        self._sort(self._info(place, file) for file in sorted(place.rglob("*")) if file.is_file())

    def _info(self, folder: Path, file: Path) -> ZipInfo:
        if not file.resolve().is_relative_to(folder.resolve()):
            raise FormatError(self.path, None, f"{file.name}, a link that leads out of the folder", "a file")
        info = ZipInfo(file.relative_to(folder).as_posix())
        info.file_size = info.compress_size = file.stat().st_size
        info.header_offset = 0
        return info

    def close(self) -> None:
        """Nothing is open; arrays that were read stay valid."""

    def raw(self, name: str) -> tuple[bytes, int]:
        """Return the content of a small file in the folder, and where it begins."""
        if name not in self._infos:
            raise FormatError(self.path, None, f"no {name} in the folder", f"a file {name}")
        check_room(self._infos[name].file_size)
        return (Path(self.path) / name).read_bytes(), 0

    def check_size(self, info: ZipInfo) -> None:
        """Accept every size: it is that of a file."""

    def stored(self, info: ZipInfo) -> tuple[MappedFile, int]:
        """Return a file, and its first byte."""
        if info.filename not in self._files:
            self._files[info.filename] = MappedFile(Path(self.path) / info.filename)
        return self._files[info.filename], 0


class ArrayEntry:
    """One array of the archive, ``(rows, columns)``, served from front to back or whole."""

    def __init__(
        self,
        home: ZipArrays,
        info: ZipInfo,
        folder: tuple[str, ...],
        name: str,
        columns: int,
        dtype: np.dtype[Any],
    ) -> None:
        home.check_size(info)
        self._home, self._info = home, info
        self.folder, self.name, self.columns, self.dtype = folder, name, columns, dtype
        self.position = info.header_offset
        stride = columns * dtype.itemsize
        if columns == 0 or info.file_size % stride:
            raise FormatError(
                home.path,
                self.position,
                f"{info.filename} of {info.file_size} bytes",
                f"a multiple of {stride} bytes ({columns} columns of {dtype})",
            )
        self.rows = info.file_size // stride
        self._stream: IO[bytes] | None = None
        self._next = 0

    def close(self) -> None:
        """Close the stream of a deflated array."""
        if self._stream is not None:
            self._stream.close()
            self._stream = None

    def expect(self, rows: int, what: str, source: str) -> None:
        """Raise FormatError unless the array has the header's number of rows."""
        if self.rows != rows:
            raise FormatError(
                self._home.path,
                self.position,
                f"{what} with {self.rows} rows",
                f"{rows}, the header's {source}",
            )

    def whole(self) -> Array:
        """Return the whole array in native order, one axis where it has one column."""
        self.close()
        return self.flat(self.take(0, self.rows))

    def flat(self, rows: Array, *, long: bool = False) -> Array:
        """Copy rows to native order, on disk where they are `long`; one axis where there is one column."""
        native: Array
        if long:
            native = scratch_array(rows.shape, bool if rows.dtype == bool else rows.dtype.newbyteorder("="))
            for a, b in spans(len(rows)):
                native[a:b] = rows[a:b].view(np.uint8) != 0 if rows.dtype == bool else rows[a:b]
                forget(native, a, b)
                forget(rows, a, b)
        elif rows.dtype == bool:
            native = rows.view(np.uint8) != 0  # a byte that is neither 0 nor 1 is true
        else:
            native = rows.astype(rows.dtype.newbyteorder("="))
        return native[:, 0] if self.columns == 1 else native

    def take(self, first: int, last: int, *, long: bool = False) -> Array:
        """Return rows ``[first, last)`` as stored; `first` must not go back, if compressed."""
        # Inflated rows that are `long` lie on disk (`.scratch`).
        if self._info.compress_type == ZIP_STORED:
            return self._mapped(first, last)
        if self._stream is None or first < self._next:
            self.close()
            self._stream, self._next = self._home.open(self._info), 0
        stride = self.columns * self.dtype.itemsize
        with self._home.damage(self.position, self._info.filename):
            self._skip((first - self._next) * stride)
            if long:
                rows = self._inflated(last - first)
            else:
                rows = np.frombuffer(self._read((last - first) * stride), self.dtype).reshape(-1, self.columns)
        self._next = last
        return rows

    def _skip(self, n: int) -> None:
        for first, last in spans(n, _PIECE):
            self._read(last - first)

    def _inflated(self, n: int) -> Array:
        size = n * self.columns * self.dtype.itemsize
        return (
            scratch_bytes(self._read(b - a) for a, b in spans(size, _PIECE)).view(self.dtype).reshape(-1, self.columns)
        )

    def _read(self, n: int) -> bytes:
        assert self._stream is not None
        check_room(n)
        data = self._stream.read(n) if n else b""
        if len(data) != n:
            raise FormatError(
                self._home.path,
                self.position,
                f"the end of {self._info.filename} after {self._stream.tell()} bytes",
                f"{self._info.file_size} bytes",
            )
        return data

    def _mapped(self, first: int, last: int) -> Array:
        file, begin = self._home.stored(self._info)
        stride = self.columns * self.dtype.itemsize
        file.forget(begin, first * stride)
        values = file.array(self.dtype, begin + first * stride, (last - first) * self.columns, self._info.filename)
        return values.reshape(-1, self.columns)
