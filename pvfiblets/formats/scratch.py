"""Arrays too long for memory, in files without a name: for what must be at hand as one, such as one very long line.

They lie where the system keeps temporary files (``TMPDIR`` names another place), take their size in bytes there,
and are gone with the process, however it ends.
"""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

from pvfiblets.support.whole_files import naming_target

LONG = 4_000_000  # points of one line beyond which its arrays are kept on disk and gone through in parts

SPAN = 1_000_000  # rows of each part


def is_long(n: int) -> bool:
    """Whether a line has so many points that it is kept on disk."""
    return n > LONG


def scratch_array(shape: tuple[int, ...], dtype: DTypeLike) -> NDArray[Any]:
    """Make an array of zeros on disk."""
    kind = np.dtype(dtype)
    size = int(np.prod(shape)) * kind.itemsize
    if size == 0:
        return np.zeros(shape, kind)
    with _naming(size), tempfile.TemporaryFile() as file:
        _take_room(file.fileno(), size)
        return np.memmap(file, kind, "r+", shape=shape)


def scratch_bytes(pieces: Iterable[bytes]) -> NDArray[np.uint8]:
    """Write an unknown number of bytes to disk, and map them."""
    size = 0
    with tempfile.TemporaryFile() as file:
        for piece in pieces:
            with _naming(size + len(piece)):
                file.write(piece)
            size += len(piece)
        file.flush()
        return np.memmap(file, np.uint8, "r+") if size else np.zeros(0, np.uint8)


def _naming(size: int) -> AbstractContextManager[None]:
    return naming_target(Path(tempfile.gettempdir()) / "a temporary file", size)


def _take_room(file: int, size: int) -> None:
    """Reserve disk space now: a full disk during writes to a map ends the process."""
    if hasattr(os, "posix_fallocate"):
        os.posix_fallocate(file, 0, size)
    else:
        os.truncate(file, size)


def spans(n: int, size: int = 0) -> Iterator[tuple[int, int]]:
    """Ranges of rows, one after the other, of at most `size` (:data:`SPAN`) each."""
    size = size or SPAN
    for first in range(0, n, size):
        yield first, min(first + size, n)
