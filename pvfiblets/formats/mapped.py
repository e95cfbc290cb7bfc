"""Files as memory maps whose every access is checked against the file's size.

The formats ask for "n values of this type at this byte". The request is compared with what the
file holds before anything is allocated, so that a damaged count costs no memory and gives a
:class:`FormatError` that names the byte.
"""

from __future__ import annotations

import mmap
import os
from os import PathLike, fspath
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

from pvfiblets.errors import FormatError


class MappedFile:
    """A file's bytes, read-only, through the operating system's page cache."""

    def __init__(self, path: str | PathLike[str]) -> None:
        self.path = fspath(path)
        with Path(self.path).open("rb") as file:
            self.size = os.fstat(file.fileno()).st_size
            # An empty file cannot be mapped.
            self.buffer: mmap.mmap | bytes = mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) if self.size else b""

    def array(self, dtype: DTypeLike, position: int, count: int, what: str) -> NDArray[Any]:
        """`count` values of `dtype` from byte `position`, without copying."""
        kind = np.dtype(dtype)
        self.check(position, count * kind.itemsize, what)
        if count == 0:
            return np.zeros(0, kind)
        return np.frombuffer(self.buffer, kind, count, position)

    def bytes(self, position: int, count: int, what: str) -> bytes:
        """`count` bytes from byte `position`, copied; FormatError as in :meth:`array`."""
        self.check(position, count, what)
        return bytes(self.buffer[position : position + count])

    def forget(self, position: int, n_bytes: int) -> None:
        """Release the memory behind bytes that will hardly be read again; they stay readable."""
        # Without this a file streamed piece by piece ends up resident as a whole, however small the pieces.
        if not isinstance(self.buffer, bytes):
            drop_pages(self.buffer, position, n_bytes)

    def check(self, position: int, n_bytes: int, what: str) -> None:
        """Raise FormatError unless the file holds `n_bytes` bytes from `position`."""
        if n_bytes < 0 or position < 0:
            raise FormatError(self.path, position, f"a size of {n_bytes} bytes", f"a sensible size for {what}")
        if position + n_bytes > self.size:
            raise FormatError(
                self.path,
                self.size,
                "the end of the file",
                f"{what} up to byte {position + n_bytes} ({position + n_bytes - self.size} more): "
                "the file is truncated or its header is damaged",
            )


def forget(array: NDArray[Any], first: int, last: int) -> None:
    """Release the memory behind rows of a mapped array, or of a view of one; they stay readable."""
    # Without this a file that is streamed through its map ends up resident as a whole. Arrays in memory are left alone,
    # and so are private maps (mode `'c'`), whose changes are nowhere else, and maps not of NumPy's that can be written
    # to, for they do not tell whether they are private. Give 0 for `first` where rows are read in order: reading a
    # block brings back pages of the one before, and releasing pages twice costs nothing.
    owner: Any = array
    found: Any = None
    mapped: mmap.mmap | None = None
    while owner is not None:  # the outermost map: views of it do not know where in it they begin
        found = owner if isinstance(owner, np.memmap) else found
        mapped = owner if isinstance(owner, mmap.mmap) else mapped
        owner = owner.obj if isinstance(owner, memoryview) else getattr(owner, "base", None)
    if mapped is None or array.size == 0:
        return
    if found is None:
        if not memoryview(mapped).readonly:
            return
        start, begin = 0, np.frombuffer(mapped, np.uint8).__array_interface__["data"][0]
    elif found.mode == "c":
        return
    else:
        # The map begins at the page that holds the array's first byte.
        start, begin = found.offset % mmap.ALLOCATIONGRANULARITY, found.__array_interface__["data"][0]
    row = array.strides[0]
    drop_pages(mapped, start + array.__array_interface__["data"][0] - begin + first * row, (last - first) * row)


def drop_pages(mapped: mmap.mmap, position: int, n_bytes: int) -> None:
    """Release whole pages of memory within some bytes of a map, where the system can; they stay readable."""
    if not hasattr(mmap, "MADV_DONTNEED"):
        return
    first = -(-position // mmap.PAGESIZE) * mmap.PAGESIZE
    length = (position + n_bytes) // mmap.PAGESIZE * mmap.PAGESIZE - first
    if length > 0:
        mapped.madvise(mmap.MADV_DONTNEED, first, length)
