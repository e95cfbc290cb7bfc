"""DIPY's HDF5 files (``.dpy``): points and offsets, RAS+ mm with voxel centres at integer indices.

Format: ``dipy.io.dpy``; group ``streamlines`` with ``tracks``, (n, 3) float, and ``offsets``, n + 1 integers. It
stores no affine, space or values. The h5py library reads it. The file must be read whole.
"""

from __future__ import annotations

from collections.abc import Iterator
from os import PathLike, fspath
from typing import Any

import numpy as np

from pvfiblets.errors import FormatError
from pvfiblets.formats.mapped import MappedFile
from pvfiblets.formats.read_whole import facts, only_finite, pieces
from pvfiblets.streamlines import Streamlines

_MAGIC = b"\x89HDF\r\n\x1a\n"


def read(path: str | PathLike[str], *, progress: bool = False) -> Streamlines:  # noqa: ARG001
    """Read a dpy file (see :func:`pvfiblets.formats.read`)."""
    file = MappedFile(path)
    magic = file.bytes(0, min(len(_MAGIC), file.size), "the magic")
    if magic != _MAGIC:
        raise FormatError(path, 0, repr(magic), f"the magic {_MAGIC!r} of HDF5")
    try:
        import h5py
    except ImportError as error:
        raise ImportError(f"{fspath(path)}: .dpy files need h5py; run pip install h5py") from error
    try:
        with h5py.File(path, "r") as data:
            points, offsets = (np.asarray(data["streamlines"][name]) for name in ("tracks", "offsets"))
    except (OSError, KeyError, TypeError, AttributeError, RuntimeError, ValueError) as error:
        expected = "streamlines/tracks and streamlines/offsets"
        raise FormatError(path, None, f"damaged HDF5 data ({error})", expected) from error
    try:
        lines = Streamlines(points, offsets)
    except (ValueError, TypeError) as error:
        raise FormatError(path, None, str(error), "tracks of 3 columns, and offsets from 0 to their number") from error
    return only_finite(lines)


def iter_chunks(path: str | PathLike[str], max_points: int) -> Iterator[Streamlines]:
    """Read the whole file, then give it in pieces (see :func:`pvfiblets.formats.iter_chunks`)."""
    yield from pieces(read(path), max_points)


def info(path: str | PathLike[str]) -> dict[str, Any]:
    """Facts of the file, which is read whole (see :func:`pvfiblets.formats.info`)."""
    return facts(read(path))
