"""Gzipped files: inflated piece by piece, and what they say of their size."""

from __future__ import annotations

import gzip
import struct
import zlib
from os import PathLike
from pathlib import Path

from pvfiblets.errors import FormatError
from pvfiblets.memory import check_room

DENSEST = 1032
"""How many bytes of deflate's come out of one, at most."""
ODD = 100
"""Tractograms never inflate by as much: what does is made to."""


def inflate(path: str, stream: gzip.GzipFile, n: int) -> bytes:
    """Return up to `n` decompressed bytes; FormatError where the compressed data are damaged."""
    try:
        return stream.read(n)
    except (OSError, EOFError, zlib.error) as error:
        raise FormatError(path, stream.tell(), f"damaged gzip data ({error})", "an intact gzip file") from error


def stated_size(path: str | PathLike[str]) -> int:
    """Return how many bytes a file says that it inflates to; it may lie, and counts only to 4 GB.

    What cannot be true is 0.
    """
    place = Path(path)
    size = place.stat().st_size
    if size < 18:  # of the smallest gzip file
        return 0
    with place.open("rb") as file:
        file.seek(-4, 2)
        (stated,) = struct.unpack("<I", file.read(4))
    return int(stated) if stated <= DENSEST * size else 0


def check_swelling(path: str | PathLike[str], *, whole: bool = False) -> None:
    """Refuse a file that says that it inflates to more than there is memory.

    Parameters
    ----------
    path : str or PathLike
    whole : bool
        Whether it is inflated whole. Otherwise only what inflates absurdly is refused: all else is read in pieces.

    Raises
    ------
    TooLargeError
        If it does.
    """
    stated = stated_size(path)
    if whole or stated > ODD * Path(path).stat().st_size:
        check_room(stated)
