"""A parser of legacy VTK poly data that trusts no number in the file."""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable
from os import PathLike
from typing import Any
from urllib.parse import unquote_to_bytes

import numpy as np
from numpy.typing import NDArray

from pvfiblets.errors import FormatError
from pvfiblets.formats.mapped import MappedFile
from pvfiblets.formats.read_whole import TEXT_ARRAYS
from pvfiblets.streamlines import offsets_from_counts
from pvfiblets.support.vtk_space import FIELD

Array = NDArray[Any]
Ints = NDArray[np.int64]

_TYPES = {
    "unsigned_char": ">u1",
    "char": ">i1",
    "signed_char": ">i1",
    "unsigned_short": ">u2",
    "short": ">i2",
    "unsigned_int": ">u4",
    "int": ">i4",
    "unsigned_long": ">u8",
    "long": ">i8",
    "float": ">f4",
    "double": ">f8",
    "vtkidtype": ">i4",
    "vtktypeint64": ">i8",
    "vtktypeuint64": ">u8",
}
"""vtkIdType is written as 32 bits whatever its size in memory; long has 8 bytes on Unix."""

_CELLS = ("VERTICES", "LINES", "POLYGONS", "TRIANGLE_STRIPS")  # in the order of cell data

LAST_NUMBER = "last number, at the very end of the file, perhaps cut short (kept)"

_LINE_LIMIT = 1 << 16
_TEXT_BLOCK = 1 << 22


class LegacyParser:
    """Everything that a legacy poly data file holds.

    ``lines`` are (n_lines + 1,) offsets and (n_ids,) connectivity. ``n_cells`` counts all cells of all kinds,
    ``cells_before_lines`` the vertices, which come before the lines.
    """

    def __init__(self, path: str | PathLike[str]) -> None:
        self.file = MappedFile(path)
        self.path = self.file.path
        self._at = 0
        self.points: Array = np.zeros((0, 3), np.float32)  # (n, 3)
        self._cells: dict[str, tuple[Ints, Ints]] = {}
        self._cells_at: dict[str, int] = {}
        self.point_data: dict[str, Array] = {}
        self.cell_data: dict[str, Array] = {}
        self.field: dict[str, Array] = {}
        self.space: str | None = None  # first text of the field array `SPACE`
        # what to report: arrays of strings passed over, a last number that may be cut short
        self.notes: dict[str, int] = {TEXT_ARRAYS: 0}
        self._rows: int | None = None
        self._target: dict[str, Array] = self.field

    @property
    def lines(self) -> tuple[Ints, Ints]:
        """Offsets and connectivity of the line cells."""
        return self._cells.get("LINES", (np.zeros(1, np.int64), np.zeros(0, np.int64)))

    @property
    def n_cells(self) -> int:
        """Cells of all kinds."""
        return sum(len(offsets) - 1 for offsets, _ in self._cells.values())

    @property
    def cells_before_lines(self) -> int:
        """Vertex cells, which come before the lines in cell data."""
        return len(self._cells["VERTICES"][0]) - 1 if "VERTICES" in self._cells else 0

    # ------------------------------------------------------------------ the file's course

    def parse(self) -> None:
        """Read the file; FormatError where it breaks the format."""
        first = self._line("the first line")
        match = re.match(rb"# vtk DataFile Version (\d{1,2})\.(\d{1,3})\s*$", first, re.IGNORECASE)
        if match is None:
            raise FormatError(self.path, 0, repr(first[:30]), "'# vtk DataFile Version x.y'")
        self._offsets_style = int(match[1]) >= 5
        # The title may be empty, so it is read as it stands.
        self.title = self._raw_line().decode("utf-8", "replace").strip()
        kind = self._line("ASCII or BINARY").upper()
        if kind not in (b"ASCII", b"BINARY"):
            raise FormatError(self.path, self._line_at, repr(kind[:20]), "ASCII or BINARY")
        self._ascii = kind == b"ASCII"
        dataset = self._line("DATASET POLYDATA").upper().split()
        if dataset != [b"DATASET", b"POLYDATA"]:
            raise FormatError(
                self.path,
                self._line_at,
                repr(b" ".join(dataset)[:40]),
                "DATASET POLYDATA; extract the lines in ParaView or PyVista and save those",
            )
        readers: dict[str, Callable[[list[str]], None]] = {
            "POINTS": self._read_points,
            "FIELD": self._read_field,
            "POINT_DATA": self._begin_data,
            "CELL_DATA": self._begin_data,
            "METADATA": self._skip_metadata,
            "SCALARS": self._read_scalars,
            "COLOR_SCALARS": self._read_color_scalars,
            "LOOKUP_TABLE": self._skip_table,
            "TEXTURE_COORDINATES": self._read_texture,
            **dict.fromkeys(_CELLS, self._read_cells),
        }
        for word, columns in (
            ("VECTORS", 3), ("NORMALS", 3), ("TENSORS", 9), ("TENSORS6", 6),
            ("GLOBAL_IDS", 1), ("PEDIGREE_IDS", 1), ("EDGE_FLAGS", 1),
        ):  # fmt: skip
            readers[word] = self._attribute(columns)
        while (line := self._next_line()) is not None:
            words = line.decode("latin-1").split()
            reader = readers.get(words[0].upper())
            if reader is None:
                raise FormatError(self.path, self._line_at, repr(line[:40]), f"one of {', '.join(readers)}")
            reader(words)
        for word, (_, ids) in self._cells.items():
            if len(ids) and not (ids.min() >= 0 and ids.max() < len(self.points)):
                raise FormatError(
                    self.path,
                    self._cells_at[word],
                    f"{word} with point indices {ids.min()} to {ids.max()}",
                    f"indices below {len(self.points)}, the number of points",
                )
        for what, data, n in (
            ("POINT_DATA", self.point_data, len(self.points)),
            ("CELL_DATA", self.cell_data, self.n_cells),
        ):
            for name, array in data.items():
                if len(array) != n:
                    raise FormatError(self.path, None, f"{what} {name!r} of {len(array)} rows", f"{n} rows")

    def _read_points(self, words: list[str]) -> None:
        n = self._number(words, 1)
        self.points = self._values(n * 3, self._word(words, 2)).reshape(n, 3)
        if self.points.dtype not in (np.float32, np.float64):
            self.points = self.points.astype(np.float64)

    def _read_cells(self, words: list[str]) -> None:
        word = words[0].upper()
        first, second = self._number(words, 1), self._number(words, 2)
        at = self._cells_at[word] = self._line_at
        if self._offsets_style:
            offsets = self._named_integers("OFFSETS", first)
            ids = self._named_integers("CONNECTIVITY", second)
            # Versions since 5 count the offsets; without cells there is not even the first.
            if first == 0:
                offsets = np.zeros(1, np.int64)
            if offsets[0] != 0 or offsets[-1] != len(ids) or (np.diff(offsets) < 0).any():
                raise FormatError(
                    self.path, at, f"{word} with offsets {offsets[0]} to {offsets[-1]}",
                    f"offsets from 0 to {len(ids)} that never decrease",
                )  # fmt: skip
            self._cells[word] = offsets, ids
            return
        values = self._values(second, "int")
        starts = np.empty(first if first <= second else 0, np.int64)
        table, position = values.data, 0
        for i in range(first):
            # Each count tells where the next one stands: sequential by nature.
            if position >= second or not 0 <= (n := table[position]) <= second - position - 1:
                found = table[position] if position < second else "the end"
                raise FormatError(
                    self.path, at, f"{word} {first} {second}, where cell {i} has {found} points",
                    f"{first} cells in {second} numbers",
                )  # fmt: skip
            starts[i] = position
            position += n + 1
        if position != second:
            raise FormatError(
                self.path, at, f"{word} {first} {second}, cells that take {position} numbers",
                f"cells that take {second}",
            )  # fmt: skip
        keep = np.ones(second, bool)
        keep[starts] = False
        counts = values[starts].astype(np.int64)
        self._cells[word] = offsets_from_counts(counts), values[keep].astype(np.int64)

    def _named_integers(self, word: str, n: int) -> Ints:
        words = self._line(word).decode("latin-1").split()
        if words[0].upper() != word:
            raise FormatError(self.path, self._line_at, repr(words[0]), word)
        return self._values(n, self._word(words, 1)).astype(np.int64)

    def _begin_data(self, words: list[str]) -> None:
        self._rows = self._number(words, 1)
        self._target = self.point_data if words[0].upper() == "POINT_DATA" else self.cell_data

    def _attribute(self, columns: int) -> Callable[[list[str]], None]:
        def read(words: list[str]) -> None:
            self._keep(self._word(words, 1), columns, self._word(words, 2))

        return read

    def _read_scalars(self, words: list[str]) -> None:
        columns = self._number(words, 3) if len(words) > 3 else 1
        before = self._at
        line = self._next_line()
        if line is None or not line.upper().startswith(b"LOOKUP_TABLE"):
            self._at = before
        self._keep(self._word(words, 1), columns, self._word(words, 2))

    def _read_color_scalars(self, words: list[str]) -> None:
        # Bytes when binary, fractions of 1 when text.
        self._keep(
            self._word(words, 1),
            self._number(words, 2),
            "float" if self._ascii else "unsigned_char",
        )

    def _read_texture(self, words: list[str]) -> None:
        self._keep(self._word(words, 1), self._number(words, 2), self._word(words, 3))

    def _skip_table(self, words: list[str]) -> None:
        self._values(4 * self._number(words, 2), "float" if self._ascii else "unsigned_char")

    def _read_field(self, words: list[str]) -> None:
        n = self._number(words, 2)
        for _ in range(n):
            parts = self._line("an array of the field").decode("latin-1").split()
            while parts[0].upper() == "METADATA":
                self._skip_metadata(parts)
                parts = self._line("an array of the field").decode("latin-1").split()
            columns, rows = self._number(parts, 1), self._number(parts, 2)
            kind = self._word(parts, 3)
            if self._rows is not None and rows != self._rows:
                raise FormatError(self.path, self._line_at, f"{parts[0]!r} of {rows} rows", f"{self._rows} rows")
            self._keep(parts[0], columns, kind, rows)

    def _skip_metadata(self, words: list[str]) -> None:  # noqa: ARG002
        # A block of text that a blank line closes.
        while self._at < self.file.size and self._raw_line().strip():
            pass

    def _keep(self, name: str, columns: int, kind: str, rows: int | None = None) -> None:
        if rows is None:
            if self._rows is None:
                raise FormatError(self.path, self._line_at, f"the array {name!r}", "POINT_DATA or CELL_DATA first")
            rows = self._rows
        if kind.lower() == "string":
            texts = self._strings(rows * columns)
            if name == FIELD and self._target is self.field and texts:
                self.space = texts[0]
            else:
                self.notes[TEXT_ARRAYS] += 1
            return
        values = self._values(rows * columns, kind)
        if columns != 1:
            values = values.reshape(rows, columns)
        self._target[unquote_to_bytes(name).decode("utf-8", "replace")] = values

    # ------------------------------------------------------------------ words and numbers

    def _raw_line(self) -> bytes:
        """Return the line at the cursor without its newline, and pass it."""
        self._line_at = self._at
        stop = min(self.file.size, self._at + _LINE_LIMIT)
        end = self.file.buffer.find(b"\n", self._at, stop)
        if end < 0 and stop < self.file.size:
            raise FormatError(self.path, self._at, "no line of text", "a keyword")
        line = bytes(self.file.buffer[self._at : stop if end < 0 else end])
        self._at = stop if end < 0 else end + 1
        return line

    def _next_line(self) -> bytes | None:
        """Return the next line that is not blank, stripped; None at the end of the file."""
        while self._at < self.file.size:
            if line := self._raw_line().strip(b" \t\r\n\0"):
                return line
        return None

    def _line(self, what: str) -> bytes:
        line = self._next_line()
        if line is None:
            raise FormatError(self.path, self.file.size, "the end of the file", what)
        return line

    def _word(self, words: list[str], i: int) -> str:
        if i >= len(words):
            raise FormatError(self.path, self._line_at, repr(" ".join(words)[:60]), f"{i} words after the keyword")
        return words[i]

    def _number(self, words: list[str], i: int) -> int:
        text = self._word(words, i)
        if not (text.isascii() and text.isdecimal() and len(text) < 16):
            raise FormatError(self.path, self._line_at, repr(" ".join(words)[:60]), f"a count as word {i + 1}")
        return int(text)

    def _values(self, n: int, kind: str) -> Array:
        """Return `n` numbers of a VTK type in native order, and pass them."""
        kind = kind.lower()
        if kind == "bit" and not self._ascii:
            packed = self.file.array(np.uint8, self._at, (n + 7) // 8, f"{n} bits")
            self._at += len(packed)
            return np.unpackbits(packed, count=n)
        if kind not in _TYPES and kind != "bit":
            raise FormatError(self.path, self._line_at, f"type {kind!r}", f"one of bit, {', '.join(_TYPES)}")
        dtype = np.dtype(_TYPES.get(kind, ">u1"))
        if self._ascii:
            return self._text_values(n, dtype.newbyteorder("="))
        values = self.file.array(dtype, self._at, n, f"{n} numbers of type {kind}")
        self._at += values.nbytes
        return values.astype(dtype.newbyteorder("="))

    def _text_values(self, n: int, dtype: np.dtype[Any]) -> Array:
        # A number takes two bytes at least: one digit and one blank.
        self.file.check(self._at, max(0, 2 * n - 1), f"{n} numbers")
        parts, missing = [], n
        exact = np.int64 if dtype.kind == "i" else np.uint64 if dtype.kind == "u" else np.float64
        while missing:
            text = self._tokens(missing)
            with warnings.catch_warnings(), np.errstate(all="ignore"):
                # NumPy warns of, or raises for, text that is no number; both are judged below.
                warnings.simplefilter("ignore", DeprecationWarning)
                try:
                    part = np.fromstring(text, exact, sep=" ")
                except ValueError:
                    part = np.zeros(0, exact)
                narrow = part.astype(dtype)
            if len(part) == 0 or len(part) > missing or len(part) != len(text.split()):
                raise FormatError(
                    self.path, self._at - len(text), repr(text[:40].decode("latin-1")),
                    f"{missing} more numbers",
                )  # fmt: skip
            parts.append(narrow)
            missing -= len(part)
        return np.concatenate(parts) if parts else np.zeros(0, dtype)

    def _tokens(self, most: int) -> bytes:
        """Return text of up to `most` tokens from the cursor, and pass it."""
        block = self.file.buffer[self._at : self._at + _TEXT_BLOCK]
        blank = np.frombuffer(block, np.uint8) <= 32
        ends = np.flatnonzero(~blank[:-1] & blank[1:]) + 1
        if self._at + len(block) == self.file.size and len(blank) and not blank[-1]:
            ends = np.append(ends, len(block))
            if len(ends) <= most:
                self.notes[LAST_NUMBER] = 1
        if len(ends) == 0:
            raise FormatError(self.path, self._at, "the end of the numbers", f"{most} more numbers")
        text = block[: ends[min(most, len(ends)) - 1]]
        self._at += len(text)
        return bytes(text)

    def _strings(self, n: int) -> list[str]:
        self.file.check(self._at, n, f"{n} strings")
        texts = []
        for _ in range(n):
            if self._ascii:
                texts.append(unquote_to_bytes(self._line("a string")).decode("utf-8", "replace"))
                continue
            # The two high bits of the first byte tell how many bytes hold the length.
            head = self.file.bytes(self._at, 1, "a string's length")[0]
            width = (8, 4, 2, 1)[head >> 6]
            raw = int.from_bytes(self.file.bytes(self._at, width, "a string's length"), "big")
            length = raw & ((1 << (8 * width - 2)) - 1)
            texts.append(self.file.bytes(self._at + width, length, "a string").decode("utf-8", "replace"))
            self._at += width + length
        return texts
