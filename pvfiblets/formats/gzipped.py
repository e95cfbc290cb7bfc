"""Gzipped files: inflated piece by piece; and what compressed files say of their size."""

from __future__ import annotations

import gzip
import struct
import zlib
from contextlib import suppress
from os import PathLike
from pathlib import Path
from zipfile import BadZipFile, ZipFile

from pvfiblets.errors import FibletsError, FormatError
from pvfiblets.support.memory import check_room, shown

DENSEST = 1032  # most bytes of output per byte of deflate's
SMALL = 64 << 20  # bytes that are always allowed
ODD = 100  # largest plausible ratio of inflation; larger ones are crafted


def inflate(path: str, stream: gzip.GzipFile, n: int) -> bytes:
    """Return up to `n` decompressed bytes; FormatError where the compressed data are damaged."""
    try:
        return stream.read(n)
    except (OSError, EOFError, zlib.error) as error:
        raise FormatError(path, stream.tell(), f"damaged gzip data ({error})", "an intact gzip file") from error


def stated_size(path: str | PathLike[str]) -> int:
    """Return how many bytes a file says that it inflates to; it may lie, and counts only to 4 GB."""
    # What cannot be true is 0.
    place = Path(path)
    size = place.stat().st_size
    if size < 18:  # of the smallest gzip file
        return 0
    with place.open("rb") as file:
        file.seek(-4, 2)
        (stated,) = struct.unpack("<I", file.read(4))
    return int(stated) if stated <= DENSEST * size else 0


def inflated_size(path: str | PathLike[str]) -> int:
    """Return how many bytes a file says that it inflates to, which may be a lie; 0 where it is not compressed."""
    name = str(path).lower()
    if name.endswith(".gz"):
        return stated_size(path)
    if not name.endswith(".trx"):
        return 0
    with suppress(BadZipFile, OSError), ZipFile(path) as archive:
        return sum(min(info.file_size, info.compress_size * DENSEST) for info in archive.infolist())
    return 0


def check_ratio(path: str | PathLike[str]) -> None:
    """Raise for an implausible ratio of inflation, before a long wait."""
    size, stated = Path(path).stat().st_size, inflated_size(path)
    if stated > max(ODD * size, SMALL):
        raise FibletsError(
            f"it inflates to {shown(stated)}, {stated / max(size, 1):,.0f} times its size, as no tractogram does; "
            "`pvfiblets convert` makes a .fiblets file of it that can be opened"
        )


def check_swelling(path: str | PathLike[str], *, whole: bool = False) -> None:
    """Refuse a file that says that it inflates to more than there is memory."""
    stated = stated_size(path)
    if whole or stated > ODD * Path(path).stat().st_size:
        check_room(stated)
