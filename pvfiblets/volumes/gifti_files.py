"""Files of GIFTI: nibabel reads them, its complaints become errors, and the files that they name can be listed before.

Format: https://www.nitrc.org/projects/gifti
"""

from __future__ import annotations

import gzip
import zlib
from pathlib import Path
from typing import IO, Any
from xml.parsers import expat

from pvfiblets.errors import FormatError
from pvfiblets.formats.gzipped import check_ratio

SUFFIXES = (".gii", ".gii.gz")
VALUES = tuple(f".{what}{suffix}" for what in ("label", "shape", "func") for suffix in SUFFIXES)
"""Suffixes of files with numbers for the vertices of a surface in another file."""

_BUFFER = 1 << 16  # nibabel's own is 35 MB


def _open(path: Path) -> IO[bytes]:
    check_ratio(path)
    opened: Any = gzip.open if path.name.lower().endswith(".gz") else open
    return opened(path, "rb")


def read_gifti(path: Path) -> Any:
    """Read a file."""
    from nibabel.gifti.parse_gifti_fast import GiftiImageParser

    parser = GiftiImageParser(buffer_size=_BUFFER)
    with _open(path) as file:
        try:
            parser.parse(fptr=file)
        except Exception as error:  # of XML, numbers, base64 and compression
            said = error or type(error).__name__
            raise FormatError(path, None, f"no whole GIFTI data ({said})", "a GIFTI file") from error
    if parser.img is None:
        raise FormatError(path, None, "no element <GIFTI>", "a GIFTI file")
    return parser.img


def named_files(path: Path) -> list[str]:
    """Return the files that it says its numbers lie in, as it names them."""
    found: list[str] = []

    def begin(_: str, attributes: dict[str, str]) -> None:
        if named := attributes.get("ExternalFileName"):
            found.append(named)

    parser = expat.ParserCreate()
    parser.StartElementHandler = begin
    with _open(path) as file:
        try:
            parser.ParseFile(file)
        except (expat.ExpatError, LookupError, ValueError, OSError, EOFError, zlib.error) as error:  # of encodings, too
            raise FormatError(path, None, f"no whole GIFTI data ({error})", "a GIFTI file") from None
    return found
