"""Numbers in a file, plain or compressed, as many as a header promises: a wrong promise costs no memory."""

from __future__ import annotations

import bz2
import gzip
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import IO, Any, Literal

import numpy as np
import numpy.typing as npt

from pvfiblets.errors import FormatError
from pvfiblets.support.memory import check_room

Packing = Literal["raw", "gzip", "zlib", "bzip2", "ascii"]

PIECE = 1 << 18  # bytes read at a time
LOOKED_AT = 1 << 24  # bytes unpacked beyond the needed ones, to see whether the data are whole


def numbers(
    path: Path, start: int, count: int, dtype: npt.DTypeLike, packing: Packing = "raw", skip: int = 0
) -> npt.NDArray[Any]:
    """Read numbers."""
    kind = np.dtype(dtype)
    needed, size = count * kind.itemsize, path.stat().st_size
    if packing == "raw":
        start = size - needed if skip == -1 else start + skip
        if start < 0 or size - start < needed:
            found = max(size - max(start, 0), 0)
            raise FormatError(
                path,
                None,
                f"{found} bytes of data",
                f"{needed} behind the skipped bytes, from the header's sizes and type",
            )
        return np.memmap(path, kind, "r", start, (count,))
    if packing == "ascii":
        return _of_text(path, start, count, kind)
    unpacked = _unpacked(path, start, needed, packing, skip)
    if len(unpacked) < needed:
        raise FormatError(
            path, None, f"{len(unpacked) // kind.itemsize} numbers", f"{count}, as the header's sizes say"
        )
    return np.frombuffer(unpacked, kind, count)


def data_file(header: Path, name: str) -> Path:
    """Return the place of a file that a header names."""
    path = header.parent / name
    try:
        there = path.is_file()
    except OSError:  # a name that no file can have
        there = False
    if not there:
        raise FileNotFoundError(f"{header}: its data are in {name!r}, and there is no file {path}")
    return path


def _unpacked(path: Path, start: int, needed: int, packing: Packing, skip: int) -> bytearray:
    """Return what compressed data hold from `skip` on, as far as it is needed."""
    check_room(needed + max(skip, 0))
    kept = bytearray()
    try:
        with path.open("rb") as file:
            file.seek(start)
            stream = _OPENERS[packing](file)
            most = None if skip == -1 else skip + needed
            while most is None or len(kept) < most:
                piece = stream.read(PIECE if most is None else min(PIECE, most - len(kept)))
                if not piece:
                    break
                kept += piece
                if skip == -1:
                    del kept[: max(len(kept) - needed, 0)]
            for _ in range(LOOKED_AT // PIECE):  # at the end checksums are compared
                if not stream.read(PIECE):
                    break
    except (OSError, EOFError, ValueError, zlib.error) as error:
        raise FormatError(path, start, f"damaged {packing} data ({error})", f"whole {packing} data") from None
    if skip > 0:
        del kept[:skip]
    return kept


def _gzip(file: IO[bytes]) -> gzip.GzipFile:
    return gzip.GzipFile(fileobj=file)


class _Inflated:
    """File interface that the zlib module lacks."""

    def __init__(self, file: IO[bytes]) -> None:
        self._file = file
        self._machine = zlib.decompressobj()
        self._rest = b""

    def read(self, n: int) -> bytes:
        while not self._machine.eof:
            self._rest = self._rest or self._file.read(PIECE)
            if not self._rest:
                raise EOFError("it ends too early")
            piece = self._machine.decompress(self._rest, n)
            self._rest = self._machine.unconsumed_tail
            if piece:
                return piece
        return b""


_OPENERS: dict[str, Callable[[IO[bytes]], Any]] = {"gzip": _gzip, "bzip2": bz2.BZ2File, "zlib": _Inflated}


def _of_text(path: Path, start: int, count: int, kind: np.dtype[Any]) -> npt.NDArray[Any]:
    """Return numbers written as text, read piece by piece: as objects they would take many times their place."""
    wide = np.float64 if kind.kind == "f" else np.int64
    found, parts, rest = 0, [], b""
    with path.open("rb") as file:
        file.seek(start)
        while found < count:
            piece = file.read(PIECE // 4)
            words = (rest + piece).split()
            rest = words.pop() if piece and words and not (rest + piece)[-1:].isspace() else b""
            try:
                parts.append(np.array(words, wide).astype(kind))
            except (ValueError, OverflowError):
                raise FormatError(path, start, "other than numbers", "numbers as text, as the encoding says") from None
            found += len(words)
            if not piece:
                break
    if found < count:
        raise FormatError(path, None, f"{found} numbers", f"{count}, as the header's sizes say")
    return np.concatenate(parts)[:count]
