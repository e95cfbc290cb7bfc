"""A stored zip of ``.npy`` arrays that can be mapped into memory: the container of ``.fiblets`` files.

Members are stored, not deflated, and start at multiples of 64 bytes (padding sits in each local header's extra
field), so that an array is a slice of the file. ``numpy.load`` reads the same file, and zip's own CRC-32 guards every
member.
"""

from __future__ import annotations

import errno
import io
import json
import math
import os
import struct
import tokenize
import zipfile
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from ...errors import FormatError
from ...formats.mapped import forget
from ...support.whole_files import replacing

__all__ = ["HEADER", "Member", "array_member", "check_members", "forget", "open_archive", "write_archive"]

HEADER = "header.json"
ALIGNMENT = 64
_LOCAL_HEADER = 30
_ZIP64_EXTRA = 20  # what zipfile adds to a local header when told to allow for more than 4 GiB
_PADDING_ID = 0xD935  # the extra-field id that zip aligners use
_DATE = (1980, 1, 1, 0, 0, 0)  # equal sets make equal files


@dataclass(frozen=True)
class Member:
    """An array to be written, perhaps in pieces."""

    dtype: np.dtype[Any]  # type of its values
    shape: tuple[int, ...]  # its shape
    pieces: Callable[[], Iterable[bytes | memoryview]]  # gives its bytes in C order, piece by piece


def array_member(array: npt.NDArray[Any]) -> Member:
    """A member whose array is at hand."""

    def pieces() -> Iterator[memoryview]:
        flat = np.ascontiguousarray(array).reshape(-1).view(np.uint8) if array.size else np.empty(0, np.uint8)
        for a in range(0, len(flat), 1 << 24):
            yield flat[a : a + (1 << 24)].data

    return Member(array.dtype, array.shape, pieces)


def write_archive(
    path: str | os.PathLike[str], header: Mapping[str, Any], members: Mapping[str, Member], *, small: bool = False
) -> None:
    """Write a container; the file appears under its name only when it is whole."""
    # Where it is `small`, nothing is spent on a header that people can read, or on places where members can be mapped.
    size = sum(math.prod(member.shape) * member.dtype.itemsize for member in members.values())
    with replacing(path, size) as file, zipfile.ZipFile(file, "w", zipfile.ZIP_STORED) as archive:
        layout: dict[str, Any] = {"separators": (",", ":")} if small else {"indent": 1}
        _write(archive, HEADER, [json.dumps(header, allow_nan=False, **layout).encode()], aligned=not small)
        for name, member in members.items():
            _write(archive, name, _with_npy_header(member), aligned=not small)


def _with_npy_header(member: Member) -> Iterator[bytes | memoryview]:
    buffer = io.BytesIO()
    descr = np.lib.format.dtype_to_descr(member.dtype)
    np.lib.format.write_array_header_1_0(buffer, {"descr": descr, "fortran_order": False, "shape": member.shape})
    yield buffer.getvalue()
    yield from member.pieces()


def _write(archive: zipfile.ZipFile, name: str, pieces: Iterable[bytes | memoryview], *, aligned: bool) -> None:
    info = zipfile.ZipInfo(name, _DATE)
    assert archive.fp is not None
    if aligned:
        start = archive.fp.tell() + _LOCAL_HEADER + len(name.encode()) + _ZIP64_EXTRA
        padding = -(start + 4) % ALIGNMENT
        info.extra = struct.pack("<HH", _PADDING_ID, padding) + bytes(padding)
    with archive.open(info, "w", force_zip64=True) as stream:
        for piece in pieces:
            stream.write(piece)


def open_archive(path: str | os.PathLike[str]) -> tuple[dict[str, Any], dict[str, npt.NDArray[Any]]]:
    """Map a container: header, and arrays by member name, without reading them."""
    try:
        with zipfile.ZipFile(path) as archive, Path(path).open("rb") as stream:
            if HEADER not in archive.namelist():
                raise FormatError(path, 0, "a zip without a member header.json", "a .fiblets file")
            size, told = os.fstat(stream.fileno()).st_size, archive.getinfo(HEADER)
            _check_stored(path, told)
            if max(told.compress_size, told.file_size) > size:
                found = f"a header.json of {told.file_size} bytes, {told.compress_size} as stored, in {size}"
                raise FormatError(path, told.header_offset, found, "a member that fits")
            try:
                header = json.loads(archive.read(HEADER))
            except (ValueError, zipfile.BadZipFile) as error:
                raise FormatError(path, 0, f"a damaged header.json ({error})", "JSON as it was written") from error
            arrays = {
                info.filename: _map(path, stream, info, size) for info in archive.infolist() if info.filename != HEADER
            }
    except (
        zipfile.BadZipFile,
        zipfile.LargeZipFile,
        NotImplementedError,
        RuntimeError,
        struct.error,
        EOFError,
        OSError,
    ) as error:
        # Offsets of a damaged directory make seeking fail with EINVAL; a missing file is its own error.
        if isinstance(error, OSError) and error.errno != errno.EINVAL:
            raise
        raise FormatError(
            path, None, f"no readable zip ({error})", "a whole .fiblets file: copy or make it again"
        ) from error
    if not isinstance(header, dict):
        raise FormatError(path, 0, "a header.json that is not an object", "a .fiblets file")
    return header, arrays


def _check_stored(path: str | os.PathLike[str], info: zipfile.ZipInfo) -> None:
    if info.compress_type != zipfile.ZIP_STORED:
        raise FormatError(path, info.header_offset, f"member {info.filename} deflated", "stored members (zip -0)")


def _map(path: str | os.PathLike[str], stream: io.BufferedReader, info: zipfile.ZipInfo, size: int) -> npt.NDArray[Any]:
    _check_stored(path, info)
    stream.seek(info.header_offset)
    local = stream.read(_LOCAL_HEADER)
    if len(local) < _LOCAL_HEADER or local[:4] != b"PK\x03\x04":
        raise FormatError(path, info.header_offset, "no local header", f"that of member {info.filename}")
    name_length, extra_length = struct.unpack("<HH", local[26:30])
    start = info.header_offset + _LOCAL_HEADER + name_length + extra_length
    stream.seek(start)
    try:
        version = np.lib.format.read_magic(stream)
        if version != (1, 0):
            raise ValueError(f"npy version {version}")
        shape, fortran, dtype = np.lib.format.read_array_header_1_0(stream)
    except (ValueError, SyntaxError, TypeError, tokenize.TokenError) as error:
        raise FormatError(path, start, f"member {info.filename} without an .npy header ({error})", "one") from error
    at = stream.tell()
    n = 1
    for length in shape:
        n *= int(length)
    if dtype.hasobject or fortran or at + n * dtype.itemsize > min(start + info.file_size, size):
        raise FormatError(
            path,
            at,
            f"member {info.filename} of shape {shape}, {dtype}, in {info.file_size} bytes",
            "a plain array that fits",
        )
    if n == 0:
        return np.empty(shape, dtype)
    return np.memmap(path, dtype, "r", at, shape)


def check_members(path: str | os.PathLike[str]) -> list[str]:
    """Compare every member with its checksum."""
    damaged = []
    with zipfile.ZipFile(path) as archive:
        for info in archive.infolist():
            try:
                with archive.open(info) as stream:
                    while stream.read(1 << 24):
                        pass
            except zipfile.BadZipFile:
                damaged.append(info.filename)
    return damaged
