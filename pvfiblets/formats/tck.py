"""MRtrix tracks (``.tck``): a text header, then rows of three numbers in RAS+ mm.

Format: https://mrtrix.readthedocs.io/en/latest/getting_started/image_data.html#tracks-file-format-tck

A row whose x is NaN ends a streamline, a row whose x is infinite ends the data: MRtrix reads
no more of these rows. What is made of input that breaks these rules:

================================================  =================================================
the file                                          the result
================================================  =================================================
no magic line, no END, bad datatype or offset     FormatError
data end without the infinity row                 read, and counted in ``dropped``, if the last
                                                  streamline is closed and the header's count is
                                                  met; else FormatError at the end of the file
last streamline not closed before the infinity    kept: the end closes it
count in the header differs from the data         read; ``dropped`` tells by how many (tools that
                                                  stop early leave such counts)
bytes after the infinity row                      left out and counted
a row of a finite x with NaN or infinity          the point is left out, the line cut there, and
                                                  both are counted
two NaN rows in succession                        a streamline without points, kept
================================================  =================================================

The other keys of the header (``step_size``, ``timestamp``, ``command_history``) go along as ``space["tck_header"]``.
``space["tck_rows"]``, a fingerprint of the rows, shows the writer whether the points still belong to that header.
"""

from __future__ import annotations

import math
import warnings
import zlib
from collections.abc import Iterator, Mapping
from os import PathLike
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvfiblets.errors import FormatError
from pvfiblets.formats.mapped import MappedFile, forget
from pvfiblets.formats.rows import check_rounding, finite_rows, without_rows
from pvfiblets.formats.scratch import is_long, spans
from pvfiblets.invalid_points import CUT, NONFINITE
from pvfiblets.streamlines import Streamlines, offsets_from_counts
from pvfiblets.support.ragged import cut_offsets
from pvfiblets.support.whole_files import replacing

Array = NDArray[Any]
Ints = NDArray[np.int64]

MAGIC_TRACKS = "mrtrix tracks"
_HEADER_LIMIT = 1 << 24  # no header is longer; the search for its END stops here (16 MiB of command history)

_BLOCK_POINTS = 1 << 20  # points written at a time

HOLDS: tuple[str, ...] = ()  # parts of Streamlines besides the points that the format can carry

_DATATYPES = {
    "Float32": "<f4",
    "Float32LE": "<f4",
    "Float32BE": ">f4",
    "Float64": "<f8",
    "Float64LE": "<f8",
    "Float64BE": ">f8",
}
_OF_THE_FILE = ("datatype", "count", "file")  # keys that each writer sets anew

HEADER, ROWS = "tck_header", "tck_rows"  # keys of `Streamlines.space`

_FINGERPRINT_ROWS = 64
_SAME_STEP = 1e-3  # relative difference below which `step_size` stays as it is written

NO_END_MARKER = "end marker missing"
AFTER_END = "bytes after the end marker"
FEWER = "streamlines that the header's count promises and the file lacks"
MORE = "streamlines beyond the header's count (kept)"


class Header(NamedTuple):
    """Contents of the text header (shared with ``.tsf``, which has the same layout)."""

    fields: dict[str, str]  # values by key in lower case; repeated keys have a line each
    dtype: np.dtype[Any]
    data_position: int
    n_streamlines: int | None


def read_header(file: MappedFile, magic: str) -> Header:
    """Parse the header of a tck or tsf file."""
    head = file.bytes(0, min(file.size, 64), "the header")
    if not head.startswith(magic.encode()):
        raise FormatError(file.path, 0, repr(head[:20]), f"the line {magic!r}")
    size = 1 << 12  # nearly every header fits; copying the limit at once costs as much as a small file's points
    text = file.bytes(0, min(file.size, size), "the header")
    while size < min(file.size, _HEADER_LIMIT) and b"\nEND\n" not in text and b"\nEND\r" not in text:
        size *= 16
        text = file.bytes(0, min(file.size, size, _HEADER_LIMIT), "the header")
    fields: dict[str, str] = {}
    places: dict[str, int] = {}
    position = 0
    while True:
        newline = text.find(b"\n", position)
        line = text[position : newline if newline >= 0 else len(text)].strip()
        if line == b"END":
            end = newline + 1 if newline >= 0 else len(text)
            break
        if newline < 0:
            raise FormatError(file.path, len(text), "no END line", "END after the header's fields")
        key, colon, value = line.partition(b":")
        if colon:
            name = key.decode("utf-8", "replace").strip().lower()
            text_value = value.decode("utf-8", "replace").strip()
            fields[name] = f"{fields[name]}\n{text_value}" if name in fields else text_value
            places.setdefault(name, position)
        position = newline + 1

    datatype = fields.get("datatype", "Float32LE")
    kind = {name.lower(): value for name, value in _DATATYPES.items()}.get(datatype.lower())
    if kind is None:
        raise FormatError(file.path, places["datatype"], f"datatype {datatype!r}", f"one of {list(_DATATYPES)}")
    words = fields.get("file", f". {end}").split()
    if len(words) != 2 or words[0] != "." or not words[1].isdecimal():
        raise FormatError(
            file.path,
            places["file"],
            f"file: {fields['file']!r}",
            "'. OFFSET', the data in the same file; write separate data into one file first",
        )
    data_position = int(words[1][:18])
    if not end <= data_position <= file.size:
        raise FormatError(
            file.path,
            places.get("file", end),
            f"data at byte {data_position}",
            f"an offset from {end} (end of the header) to {file.size} (end of the file)",
        )
    count = fields.get("count")
    if count is not None and not count.isdecimal():
        raise FormatError(file.path, places["count"], f"count {count!r}", "a number of streamlines")
    return Header(
        fields,
        np.dtype(kind),
        data_position,
        None if count is None else int(count[:18]),
    )


class Window(NamedTuple):
    """Streamlines parsed from consecutive rows."""

    rows: Array
    counts: Ints
    used: int  # rows consumed: up to and with the last delimiter, or the end marker
    ended: bool
    tail: int  # points after the last delimiter
    first_end: int  # rows up to and with the first delimiter; 0 where there is none
    dropped: int  # points left out
    cuts: int  # streamlines added where lines are cut at these points


def parse_rows(rows: Array, dtype: np.dtype[Any], last: bool) -> Window:
    """Split rows at their delimiters."""
    finite, special, values = finite_rows(rows, dtype)
    is_nan: Array = np.asarray(np.isnan(values[:, 0]))
    is_end: Array = np.asarray(np.isinf(values[:, 0]))
    ended = bool(is_end.any())
    n = len(rows)
    if ended:
        at = int(np.argmax(is_end))
        n = int(special[at])
        special, is_nan = special[:at], is_nan[:at]
    delimiters = special[is_nan]
    tail_from = int(delimiters[-1]) + 1 if len(delimiters) else 0
    take = n if ended or last else tail_from
    special, is_nan = (a[special < take] for a in (special, is_nan))
    bad = special[~is_nan]
    edges = np.concatenate([delimiters, [take]]) if take > tail_from else delimiters
    # The points before edge i, bad ones included: its row number, less the delimiters before it.
    offsets = np.concatenate([[0], edges - np.arange(len(edges))])
    offsets, _ = cut_offsets(offsets, bad - np.searchsorted(delimiters, bad))
    return Window(
        finite[: take - len(special)],
        np.diff(offsets),
        take + 1 if ended else take,
        ended,
        take - tail_from,
        int(delimiters[0]) + 1 if len(delimiters) else 0,
        len(bad),
        len(offsets) - 1 - len(edges),
    )


class Data:
    """The rows of one file, parsed window by window."""

    def __init__(self, path: str | PathLike[str], magic: str, columns: int) -> None:
        self.file = MappedFile(path)
        self.header = read_header(self.file, magic)
        kind = self.header.dtype
        self.columns = columns
        self.n_rows = (self.file.size - self.header.data_position) // (kind.itemsize * columns)
        self.rows = self.file.array(kind, self.header.data_position, self.n_rows * columns, "rows").reshape(-1, columns)

    def windows(self, max_rows: int) -> Iterator[tuple[Window, dict[str, int]]]:
        """Yield each window and what to report with it; the last one carries the count check."""
        kind = self.header.dtype.newbyteorder("=")
        position, found, size = 0, 0, max_rows
        while True:
            last = position + size >= self.n_rows
            window = parse_rows(self.rows[position : position + size], kind, last)
            if not (window.used or window.ended or last):
                size *= 2  # one streamline is longer than the window
                if not is_long(size):
                    continue
                window, last = self._long(position, kind)
            elif size > max_rows and 0 < window.first_end < window.used:
                # The streamline fits now, but others came along: they wait for their own window.
                last = False
                window = parse_rows(self.rows[position : position + window.first_end], kind, last)
            size = max_rows
            stride = self.header.dtype.itemsize * self.columns
            self.file.forget(self.header.data_position + position * stride, window.used * stride)
            position += window.used
            found += len(window.counts) - window.cuts
            dropped = {reason: n for reason, n in ((NONFINITE, window.dropped), (CUT, window.cuts)) if n}
            if window.ended or last:
                yield window, dropped | self._closing(window, position, found)
                return
            yield window, dropped

    def _long(self, position: int, kind: np.dtype[Any]) -> tuple[Window, bool]:
        """Return the streamline that begins at a row, mapped or on disk, and whether the data end with it."""
        n, last, ended = 0, True, False
        special: list[int] = []
        for a, b in spans(self.n_rows - position):
            rows = self.rows[position + a : position + b]
            odd = np.flatnonzero(~np.isfinite(rows).all(axis=1))
            values = rows[odd]
            closing = np.flatnonzero(~np.isfinite(values[:, 0]))
            self.file.forget(0, self.header.data_position + (position + b) * self.rows.strides[0])
            n = b
            if len(closing):
                at = int(closing[0])
                n, last, ended = a + int(odd[at]), False, bool(np.isinf(values[at, 0]))
                odd = odd[:at]
            special += (odd + a).tolist()
            if len(closing):
                break
        points = self.rows[position : position + n]
        bad = np.array(special, np.int64)
        if special or points.dtype != kind or not points.flags.aligned:
            points = without_rows(points, bad, kind, long=True)
        used = n if last else n + 1
        counts = np.diff(cut_offsets(np.array([0, n]), bad)[0])
        tail = n if ended or last else 0
        return Window(points, counts, used, ended, tail, used, len(bad), len(counts) - 1), last

    def _closing(self, window: Window, position: int, found: int) -> dict[str, int]:
        """Judge the end of the data: what to report, or FormatError."""
        report: dict[str, int] = {}
        promised = self.header.n_streamlines
        stride = self.header.dtype.itemsize * self.columns
        end = self.header.data_position + position * stride
        if not window.ended:
            met = promised is None or found == promised
            if window.tail or end != self.file.size or not met:
                raise FormatError(
                    self.file.path,
                    self.file.size,
                    f"the end of the file after {found} streamlines"
                    + (" (the last one not closed)" if window.tail else ""),
                    (f"{promised} streamlines and " if promised else "")
                    + "a row of infinity that ends the data: the file is truncated",
                )
            report[NO_END_MARKER] = 1
        elif end != self.file.size:
            report[AFTER_END] = self.file.size - end
        if promised is not None and promised != found:
            report[FEWER if promised > found else MORE] = abs(promised - found)
        return report


def read(path: str | PathLike[str], *, progress: bool = False) -> Streamlines:  # noqa: ARG001
    """Read a whole tck file (see :func:`pvfiblets.formats.read`)."""
    data = Data(path, MAGIC_TRACKS, 3)
    space = _kept_header(data)
    parts = [_streamlines(w, d, space) for w, d in data.windows(max(1, data.n_rows))]
    return parts[0] if len(parts) == 1 else Streamlines.concatenate(parts)


def iter_chunks(path: str | PathLike[str], max_points: int) -> Iterator[Streamlines]:
    """Stream a tck file (see :func:`pvfiblets.formats.iter_chunks`); memory-mapped."""
    data = Data(path, MAGIC_TRACKS, 3)
    space = _kept_header(data)
    # One row more than the points: the delimiter that closes the last streamline.
    for window, dropped in data.windows(max_points + 1):
        yield _streamlines(window, dropped, space)


def _streamlines(window: Window, dropped: dict[str, int], space: dict[str, str]) -> Streamlines:
    return Streamlines(window.rows, offsets_from_counts(window.counts), space=space, dropped=dropped)


def _kept_header(data: Data) -> dict[str, str]:
    lines = [
        f"{key}: {line}"
        for key, value in data.header.fields.items()
        if key not in _OF_THE_FILE
        for line in value.split("\n")
    ]
    if not lines or not data.n_rows:
        return {}
    n = data.n_rows - int(np.isinf(data.rows[-1, 0]))
    return {HEADER: "\n".join(lines), ROWS: _fingerprint(n, _picked(data.rows, _fingerprint_rows(n)))}


def timestamp_in(space: Mapping[str, Any]) -> str | None:
    """Return the timestamp of the ``.tck`` file that streamlines come from."""
    lines = str(space.get(HEADER, "")).split("\n")
    return next((line.partition(": ")[2] for line in lines if line.startswith("timestamp: ")), None)


def timestamp_of(streamlines: Streamlines) -> str:
    """Return the timestamp of a ``.tck`` file of these streamlines."""
    # MRtrix compares it as text, to tell which `.tsf` files belong to which tracks. New ones are made from the points,
    # not from the time, so that the same points give the same file.
    now = _rows_of(streamlines)
    kept = timestamp_in(streamlines.space) if streamlines.space.get(ROWS) == now else None
    return kept or f"0.{zlib.crc32(now.encode()):010d}"


def _rows_of(streamlines: Streamlines) -> str:
    """Return the fingerprint of the rows that the streamlines take in a file."""
    n = streamlines.n_points + len(streamlines)
    at = _fingerprint_rows(n)
    closing = streamlines.offsets[1:] + np.arange(len(streamlines))
    line = np.searchsorted(closing, at)
    is_point = closing[line] != at
    rows = np.full((len(at), 3), np.nan)
    rows[is_point] = _picked(streamlines.points, (at - line)[is_point])
    return _fingerprint(n, rows)


def _picked(array: Array, rows: Ints) -> Array:
    """Return some rows of what may be mapped; with each, a system may bring a megabyte into memory."""
    picked = np.empty((len(rows), array.shape[1]), array.dtype)
    for to, row in enumerate(rows.tolist()):
        picked[to] = array[row]
        forget(array, 0, row + 1)
    return picked


def _fingerprint_rows(n: int) -> Ints:
    return np.unique(np.linspace(0, max(n - 1, 0), min(n, _FINGERPRINT_ROWS)).astype(np.int64))


def _fingerprint(n: int, rows: Array) -> str:
    with np.errstate(over="ignore", invalid="ignore"):
        known = np.where(np.isfinite(rows), rows, 0).astype("<f4")
    return f"{n} rows, {zlib.crc32(known.tobytes()):08x}"


def info(path: str | PathLike[str]) -> dict[str, Any]:
    """Header facts (see :func:`pvfiblets.formats.info`); ``points`` follows from the count."""
    data = Data(path, MAGIC_TRACKS, 3)
    count = data.header.n_streamlines
    return {
        "streamlines": count,
        "points": None if count is None else max(0, data.n_rows - count - 1),
        "dtype": data.header.dtype.newbyteorder("=").name,
        "header": data.header.fields,
    }


def write(path: str | PathLike[str], streamlines: Streamlines, *, double: bool = False) -> None:
    """Write a tck file of float32, or of float64 if `double` (see :func:`pvfiblets.formats.write`)."""
    if not double:
        check_rounding(path, streamlines.points)
    fields, changes = _header_for(streamlines)
    write_rows(path, MAGIC_TRACKS, streamlines, streamlines.points, np.dtype("<f8" if double else "<f4"), fields)
    if changes:
        warnings.warn(
            f"{path}: the points differ from the header's description; changed {', '.join(changes)}",
            UserWarning,
            stacklevel=3,
        )


def _header_for(streamlines: Streamlines) -> tuple[list[str], list[str]]:
    """Return the lines of a header that describe the points, and the replaced lines of the kept header."""
    lines = [line for line in str(streamlines.space.get(HEADER, "")).split("\n") if line]
    before = {key: value for key, _, value in (line.partition(": ") for line in lines)}
    after = {"timestamp": timestamp_of(streamlines)}
    now = _rows_of(streamlines)
    if "step_size" not in before or streamlines.space.get(ROWS) != now:
        step = _largest_step(streamlines)
        for key in ("step_size", *(["output_step_size"] if "output_step_size" in before else [])):
            if step > 0 and not math.isclose(_number(before.get(key)), step, rel_tol=_SAME_STEP):
                after[key] = f"{step:.7g}"
    changes = [f"{key} from {before[key]} to {new}" for key, new in after.items() if before.get(key, new) != new]
    if not str(streamlines.space.get(ROWS)).startswith(now.split(",")[0]):
        # Files of values of the other streamlines have another size: their timestamp needs no warning.
        changes = [change for change in changes if not change.startswith("timestamp")]
    kept = [line for line in lines if line.partition(": ")[0] not in after]
    return kept + [f"{key}: {value}" for key, value in after.items()], changes


def _number(text: str | None) -> float:
    try:
        return float(text or "nan")
    except ValueError:
        return math.nan


def _largest_step(streamlines: Streamlines) -> float:
    """Return the length (mm) of the longest segment, 0 without one; of mapped points nothing stays in memory."""
    points, most = streamlines.points, 0.0
    ends = streamlines.offsets[1:] - 1  # the segment from such a point leads to another streamline
    for first in range(0, len(points) - 1, _BLOCK_POINTS):
        block = points[first : first + _BLOCK_POINTS + 1].astype(np.float64)
        squares = (np.diff(block, axis=0) ** 2).sum(axis=1)
        a, b = np.searchsorted(ends, (first, first + len(squares)))
        squares[ends[a:b] - first] = 0.0
        most = max(most, float(np.fmax.reduce(squares, initial=0.0)))
        forget(points, 0, first + len(block))
    return math.sqrt(most)


def write_rows(
    path: str | PathLike[str],
    magic: str,
    streamlines: Streamlines,
    values: Array,
    kind: np.dtype[Any],
    fields: list[str],
) -> None:
    """Write (n_points, k) `values` in MRtrix' layout, one NaN row after each streamline, with more lines of header."""
    k = values.shape[1]
    own = (f"datatype: Float{kind.itemsize * 8}LE", f"count: {len(streamlines)}", "file: . ")
    head = "\n".join([magic, *fields, *own]).encode()
    # The offset stands in the header whose length it is; blanks before END take up the slack.
    offset = len(head) + len("0000000000\nEND\n")
    offset += -offset % 8
    header = head + str(offset).encode().ljust(offset - len(head) - len("\nEND\n")) + b"\nEND\n"
    size = len(header) + (len(values) + len(streamlines) + 1) * k * kind.itemsize
    with replacing(path, size) as file:
        file.write(header)
        for start, stop in streamlines.blocks(_BLOCK_POINTS):
            first, last = streamlines.offsets[start], streamlines.offsets[stop]
            if is_long(int(last - first)):  # one streamline
                for a, b in spans(int(last - first)):
                    file.write(np.ascontiguousarray(values[first + a : first + b], kind).data)
                    forget(values, 0, int(first) + b)
                file.write(np.full(k, np.nan, kind).data)
                continue
            rows = np.full((last - first + stop - start, k), np.nan, kind)
            is_point = np.ones(len(rows), bool)
            ends = streamlines.offsets[start + 1 : stop + 1] - first
            is_point[ends + np.arange(stop - start)] = False
            rows[is_point] = values[first:last]
            forget(values, 0, last)
            file.write(rows.data)
        file.write(np.full(k, np.inf, kind).data)
