"""The format of a file without a name, such as standard input, by its content."""

from __future__ import annotations

import gzip
import zlib
from os import PathLike
from pathlib import Path
from zipfile import BadZipFile, ZipFile

_BEGINNINGS = {
    b"mrtrix tracks": ".tck",
    b"TRACK": ".trk",
    b"# vtk DataFile": ".vtk",
    b"<?xml": ".vtp",
    b"<VTKFile": ".vtp",
}
_ZIP, _GZIP = b"PK", b"\x1f\x8b"


def suffix_by_content(path: str | PathLike[str]) -> str | None:
    """Return the suffix of the tractogram format that a file's first bytes are of, or None."""
    with Path(path).open("rb") as file:
        begin = file.read(32)
    if begin.startswith(_ZIP):
        return _of_zip(path)
    if begin.startswith(_GZIP):
        return _of_gzip(path)
    return next((suffix for bytes_, suffix in _BEGINNINGS.items() if begin.startswith(bytes_)), None)


def _of_zip(path: str | PathLike[str]) -> str | None:
    try:
        with ZipFile(path) as archive:
            names = [name.rpartition("/")[2] for name in archive.namelist()]
    except (BadZipFile, OSError, ValueError, NotImplementedError):
        return None
    if any(name.startswith(("positions.", "offsets.")) and not name.endswith(".npy") for name in names):
        return ".trx"
    return ".fiblets" if "header.json" in names and any(name.endswith(".npy") for name in names) else ".trx"


def _of_gzip(path: str | PathLike[str]) -> str | None:
    try:
        with gzip.open(path) as file:
            begin = file.read(5)
    except (OSError, EOFError, zlib.error):
        return None
    return ".trk.gz" if begin == b"TRACK" else ".tt.gz"
