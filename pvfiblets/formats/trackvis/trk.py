"""TrackVis tracks (``.trk``, ``.trk.gz``): a header of 1000 bytes, then one record per streamline.

Format: http://trackvis.org/docs/?subsect=fileformat. A record is an int32 count n, n rows of
(x, y, z, scalars...) and the streamline's properties, all 4 bytes wide, in the byte order that
the header's own size (1000) reveals. Coordinates are millimetres from the corner of the first
voxel along the header's voxel order; they are moved to RAS+ mm, voxel centres at integers, as
nibabel does it and with nibabel's header logic.

What is made of input that breaks the rules:

=============================================  ====================================================
the file                                       the result
=============================================  ====================================================
wrong magic, size, version, voxel size, affine FormatError at the field
negative count of a record or of the header    FormatError at the count
data end inside a record, or before the        FormatError at the end of the file
header's count is met
more data than the header's count              left out, its bytes counted
header's count 0                               means "not recorded": records up to the end
affine not recorded (version 1, or zero)       that of the voxel sizes and order, with a warning;
                                               recorded in ``space``
a point with NaN or infinity                   left out with its scalars, the line cut there; both
                                               are counted
a record of no points                          a streamline without points, kept
=============================================  ====================================================
"""

from __future__ import annotations

import gzip
from array import array
from collections.abc import Iterator
from contextlib import contextmanager
from os import PathLike, fspath
from pathlib import Path
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from pvfiblets.errors import FormatError
from pvfiblets.formats.gzipped import DENSEST, ODD, check_swelling, inflate
from pvfiblets.formats.mapped import MappedFile, forget
from pvfiblets.formats.rows import finite, transformed, without_rows
from pvfiblets.formats.scratch import is_long, scratch_array, scratch_bytes, spans
from pvfiblets.formats.trackvis.header import HEADER_SIZE, Header, parse_header
from pvfiblets.formats.trackvis.writer import write
from pvfiblets.streamlines import Streamlines
from pvfiblets.support.memory import check_room

__all__ = ["HOLDS", "info", "iter_chunks", "read", "write"]

Array = NDArray[Any]
Ints = NDArray[np.int64]

HOLDS = ("per_point", "per_streamline")  # parts of Streamlines besides the points that the format can carry

AFTER_LAST = "bytes after the last streamline"

_READ_BYTES = 1 << 20  # compressed files are inflated by this much at a time


class _Words(Protocol):
    """The data after the header as 4-byte words, served from front to back."""

    path: str

    def window(self, first: int, n: int) -> Array:
        """Return words ``[first, first + n)`` as int32 of the file's order; fewer at the end."""

    def long(self, first: int, n: int) -> Array:
        """Return what :meth:`window` does, mapped or on disk, for so many words that memory should not hold them."""

    def rest(self, first: int) -> int:
        """Return how many bytes follow word `first`."""

    def odd_bytes(self) -> int:
        """Return how many bytes at the end do not fill a word (known once the end is met)."""

    def most(self) -> int:
        """Return how many words there can be at most."""


class _MappedWords:
    def __init__(self, file: MappedFile, order: str) -> None:
        self.path = file.path
        self._file = file
        n, self._odd = divmod(file.size - HEADER_SIZE, 4)
        self._words = file.array(f"{order}i4", HEADER_SIZE, n, "the records")

    def window(self, first: int, n: int) -> Array:
        self._file.forget(HEADER_SIZE, first * 4)
        return self._words[first : first + n]

    long = window

    def rest(self, first: int) -> int:
        return (len(self._words) - first) * 4 + self._odd

    def odd_bytes(self) -> int:
        return self._odd

    def most(self) -> int:
        return len(self._words)


class _InflatedWords:
    """Words of a gzip stream; data before the last window are dropped."""

    def __init__(self, path: str, stream: gzip.GzipFile, order: str) -> None:
        self.path = path
        self._stream = stream
        self._dtype = np.dtype(f"{order}i4")
        self._kept = bytearray()
        self._first = 0
        self._ended = False

    def window(self, first: int, n: int) -> Array:
        del self._kept[: (first - self._first) * 4]
        self._first = first
        while len(self._kept) < n * 4 and not self._ended:
            piece = inflate(self.path, self._stream, min(n * 4 - len(self._kept), _READ_BYTES))
            self._ended = not piece
            self._kept += piece
        # A copy: the buffer must stay free to grow.
        whole = min(n, len(self._kept) // 4) * 4
        return np.frombuffer(bytes(self._kept[:whole]), self._dtype)

    def long(self, first: int, n: int) -> Array:
        del self._kept[: (first - self._first) * 4]
        words = scratch_bytes(self._pieces(n * 4))
        self._first = first + len(words) // 4
        return words[: len(words) // 4 * 4].view(self._dtype)

    def _pieces(self, n: int) -> Iterator[bytes]:
        """Return the next `n` bytes from the buffer and the stream."""
        kept = bytes(self._kept[:n])
        del self._kept[:n]
        yield kept
        n -= len(kept)
        while n and not self._ended:
            piece = inflate(self.path, self._stream, min(n, _READ_BYTES))
            self._ended = not piece
            n -= len(piece)
            yield piece

    def rest(self, first: int) -> int:
        total = len(self._kept) - (first - self._first) * 4
        while not self._ended:
            piece = inflate(self.path, self._stream, _READ_BYTES)
            self._ended = not piece
            total += len(piece)
        return total

    def odd_bytes(self) -> int:
        return len(self._kept) % 4 if self._ended else 0

    def most(self) -> int:
        return Path(self.path).stat().st_size * DENSEST // 4


class _Batch(NamedTuple):
    starts: Ints
    counts: Ints
    used: int


def _walk(words: Array, header: Header, max_points: int, max_records: int) -> _Batch:
    """Hop from record to record through complete records; stop before the first that is not."""
    # Each record says where the next begins, so this is sequential by nature: one integer is read per streamline. A
    # negative count stops the walk too.
    ints = np.ascontiguousarray(words, np.int32).data
    k, p, n_words = header.row_words, header.n_properties, len(ints)
    starts = array("q")
    position = points = 0
    while position < n_words and len(starts) < max_records:
        n = ints[position]
        after = position + 1 + n * k + p
        if n < 0 or after > n_words or (points + n > max_points and starts):
            break
        starts.append(position)
        points += n
        position = after
    first = np.frombuffer(starts, np.int64) if starts else np.zeros(0, np.int64)
    return _Batch(first, words[first].astype(np.int64), position)


def _streamlines(words: Array, batch: _Batch, header: Header, dropped: dict[str, int], long: bool) -> Streamlines:
    k, p = header.row_words, header.n_properties
    floats = words[: batch.used].view(words.dtype.str.replace("i", "f"))
    after = batch.starts + 1 + batch.counts * k
    properties = after[:, None] + np.arange(p)
    other = np.concatenate([batch.starts[:, None], properties], axis=1).ravel()
    rows = without_rows(floats[:, None], other, np.float32, long=long).reshape(-1, k)
    values = floats[properties].astype(np.float32)
    return finite(
        transformed(rows[:, :3], header.to_ras, long=long),
        batch.counts,
        {name: _column(rows, part, long) for name, part in header.scalars.items()},
        dropped,
        per_streamline={name: _column(values, part, False) for name, part in header.properties.items()},
        affine=header.affine,
        space=header.space,
    )


def _column(rows: Array, part: slice, long: bool) -> Array:
    block = rows[:, part]
    if long:
        copied = scratch_array(block.shape, block.dtype)
        for a, b in spans(len(block)):
            copied[a:b] = block[a:b]
            forget(copied, a, b)
            forget(rows, 0, b)
        block = copied
        return block[:, 0] if block.shape[1] == 1 else block
    return block[:, 0].copy() if block.shape[1] == 1 else block.copy()


def _chunks(words: _Words, header: Header, max_points: int) -> Iterator[Streamlines]:
    promised = header.n_streamlines or None
    position = found = 0
    # Enough for `max_points` points in streamlines of two points or more.
    normal = size = max_points * header.row_words + (max_points // 2 + 1) * (1 + header.n_properties)
    while True:
        window = words.window(position, size)
        left = len(window) if promised is None else promised - found
        batch = _walk(window, header, max_points, left)
        at = HEADER_SIZE + 4 * (position + batch.used)
        stopped = batch.used < len(window) and len(batch.starts) < left
        if stopped and (n := int(window[batch.used])) < 0:
            raise FormatError(words.path, at, f"a streamline of {n} points", "0 points or more")
        long = False
        if stopped and len(batch.starts) == 0:
            need = 1 + n * header.row_words + header.n_properties
            # More than there can be is damage, which the end will show.
            long = is_long(n) and len(window) == size and position + need <= words.most()
            if long:
                if 4 * need > ODD * Path(words.path).stat().st_size:
                    check_room(4 * need)
                window = words.long(position, need)
            if len(window) < (need if long else size):
                raise FormatError(
                    words.path,
                    HEADER_SIZE + 4 * (position + len(window)),
                    "the end of the file",
                    f"{need} words of the streamline that begins at byte {at}: the file is truncated",
                )
            if not long:
                if size == normal and position + need <= words.most():
                    check_room(4 * need)
                # Grow by doubling, not to `need` at once: a damaged count must not cost memory.
                size = min(need, 2 * size)
                continue
            batch, size = _Batch(np.zeros(1, np.int64), np.array([n]), need), need
            at += 4 * need
        found += len(batch.starts)
        position += batch.used
        complete = promised is not None and found == promised
        at_end = batch.used == len(window) < size
        size = normal
        if not (complete or at_end):
            yield _streamlines(window, batch, header, {}, long)
            continue
        if not complete and (odd := words.odd_bytes()):
            raise FormatError(words.path, at, f"{odd} bytes and the end of the file", "a record: it is truncated")
        if promised is not None and not complete:
            raise FormatError(
                words.path,
                at,
                f"the end of the file after {found} streamlines",
                f"{promised} streamlines, as the header (byte 988) promises",
            )
        rest = words.rest(position) if complete else 0
        yield _streamlines(window, batch, header, {AFTER_LAST: rest} if rest else {}, long)
        return


@contextmanager
def _opened(path: str | PathLike[str]) -> Iterator[tuple[_Words, Header]]:
    name = fspath(path)
    if name.lower().endswith(".gz"):
        check_swelling(name)
        with gzip.open(name, "rb") as stream:
            header = parse_header(name, inflate(name, stream, HEADER_SIZE))
            yield _InflatedWords(name, stream, header.order), header
        return
    file = MappedFile(path)
    header = parse_header(name, file.bytes(0, min(file.size, HEADER_SIZE), "the header"))
    yield _MappedWords(file, header.order), header


def read(path: str | PathLike[str], *, progress: bool = False) -> Streamlines:  # noqa: ARG001
    """Read a whole trk or trk.gz file (see :func:`pvfiblets.formats.read`)."""
    with _opened(path) as (words, header):
        # One window that holds every record: no file has more words than this.
        parts = list(_chunks(words, header, 1 << 40))
    return parts[0] if len(parts) == 1 else Streamlines.concatenate(parts)


def iter_chunks(path: str | PathLike[str], max_points: int) -> Iterator[Streamlines]:
    """Stream a trk or trk.gz file (see :func:`pvfiblets.formats.iter_chunks`)."""
    with _opened(path) as (words, header):
        yield from _chunks(words, header, max_points)


def info(path: str | PathLike[str]) -> dict[str, Any]:
    """Header facts (see :func:`pvfiblets.formats.info`); the header has no number of points."""
    with _opened(path) as (_, header):
        pass
    return {
        "streamlines": header.n_streamlines or None,
        "points": None,
        "dtype": "float32",
        "per_point": list(header.scalars),
        "per_streamline": list(header.properties),
        "affine": header.affine,
        **header.space,
    }
