"""TRX (``.trx``): a zip, or a folder, of plain arrays, RAS+ mm.

Format: https://github.com/tee-ar-ex/trx-spec. Entries are named ``folder/name.columns.dtype``;
one column is not named. Files of a folder and stored entries are memory-mapped, deflated entries
inflated from front to back, so all stream. A folder of this content is read under any name.

What is made of input that breaks the rules:

=================================================  ================================================
the file                                           the result
=================================================  ================================================
no zip, damaged or truncated zip, encryption,      FormatError
a compression other than deflate
an array's size that contradicts the header, or    FormatError at the entry
offsets that decrease or leave the points
a count of the header that is one off, where all   read by the arrays, with a warning
arrays agree about it
a group that names streamlines that do not exist   FormatError at the entry
a point with NaN or infinity                       left out with its data, the line cut there; both
                                                   are counted
entries outside the specification's folders        left out and counted
=================================================  ================================================
"""

from __future__ import annotations

import json
import warnings
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pvfiblets.errors import FormatError
from pvfiblets.formats.mapped import forget
from pvfiblets.formats.rows import finite, without_rows
from pvfiblets.formats.scratch import is_long
from pvfiblets.formats.trackvis.header import along_affine
from pvfiblets.formats.ziparrays import ArrayEntry, FolderArrays, ZipArrays
from pvfiblets.streamlines import Streamlines, blocks
from pvfiblets.support.whole_files import replacing

Array = NDArray[Any]

HOLDS = ("per_point", "per_streamline", "groups", "per_group")
"""Parts of Streamlines besides the points that the format can carry."""

UNKNOWN = "entries of unknown meaning"


class _Trx:
    """The entries of one trx file, checked against its header."""

    def __init__(self, archive: ZipArrays) -> None:
        self.zip = archive
        self.path = archive.path
        header = self._header()
        self.n_streamlines = self._count(header, "NB_STREAMLINES")
        self.n_points = self._count(header, "NB_VERTICES")
        self.affine = self._affine(header)
        self.space: dict[str, Any] = {}
        dimensions = header.get("DIMENSIONS")
        if isinstance(dimensions, list) and len(dimensions) == 3 and all(isinstance(d, int) for d in dimensions):
            self.space["dimensions"] = tuple(dimensions)
        self.per_point: dict[str, ArrayEntry] = {}
        self.per_streamline: dict[str, ArrayEntry] = {}
        self.groups: dict[str, ArrayEntry] = {}
        self.per_group: dict[str, dict[str, ArrayEntry]] = {}
        self.positions: ArrayEntry | None = None
        self.offsets: ArrayEntry | None = None
        self.unknown = self.zip.odd_names
        for entry in self.zip.entries:
            self._sort(entry)
        self._mend_counts()
        self._check_sizes()

    def _header(self) -> dict[str, Any]:
        raw, position = self.zip.raw("header.json")
        try:
            header = json.loads(raw)
        except (ValueError, RecursionError) as error:
            raise FormatError(self.path, position, f"header.json ({error})", "JSON") from error
        if not isinstance(header, dict):
            raise FormatError(self.path, position, f"a {type(header).__name__}", "a JSON object")
        self._header_position = position
        return header

    def _count(self, header: dict[str, Any], key: str) -> int:
        value = header.get(key)
        if not isinstance(value, int) or isinstance(value, bool) or value < 0:
            raise FormatError(self.path, self._header_position, f"{key} = {value!r}", "a whole number, 0 or more")
        return value

    def _affine(self, header: dict[str, Any]) -> NDArray[np.float64]:
        value = header.get("VOXEL_TO_RASMM", np.eye(4).tolist())
        try:
            affine = np.asarray(value, np.float64)
        except (TypeError, ValueError, OverflowError):
            affine = np.zeros(0)
        if affine.shape != (4, 4) or not np.isfinite(affine).all():
            raise FormatError(
                self.path,
                self._header_position,
                f"VOXEL_TO_RASMM = {value!r}"[:200],
                "4 x 4 finite numbers",
            )
        return affine

    def _sort(self, entry: ArrayEntry) -> None:
        """Put an entry where its folder says."""
        folder = entry.folder
        if folder == ("dpv",):
            self.per_point[_free(entry.name, self.per_point)] = entry
        elif folder == ("dps",):
            self.per_streamline[_free(entry.name, self.per_streamline)] = entry
        elif folder == ("groups",):
            self.groups[_free(entry.name, self.groups)] = entry
        elif len(folder) == 2 and folder[0] == "dpg":
            self.per_group.setdefault(folder[1].rstrip(), {})[entry.name] = entry
        elif folder == () and entry.name == "positions":
            self.positions = entry
        elif folder == () and entry.name == "offsets":
            self.offsets = entry
        else:
            self.unknown += 1

    def _mend_counts(self) -> None:
        """Believe the arrays where the header is one off and they leave one reading."""
        offsets, positions = self.offsets, self.positions
        if offsets is None or positions is None or offsets.rows < 1 or offsets.dtype.kind not in "iu":
            return
        points, by_point = positions.rows, [entry.rows for entry in self.per_point.values()]
        streamlines, by_line = self.n_streamlines, [entry.rows for entry in self.per_streamline.values()]
        odd = abs(points - self.n_points) == 1 and all(rows == points for rows in by_point)
        usual = offsets.rows in (streamlines, streamlines + 1) and all(rows == streamlines for rows in by_line)
        if usual and not odd:
            return  # as it should be
        last = int(offsets.take(offsets.rows - 1, offsets.rows).reshape(-1)[0])
        if odd and (last == points or (by_point and last < points and streamlines == offsets.rows)):
            self._warn("NB_VERTICES", self.n_points, points)
            self.n_points = points
        for count in (streamlines - 1, streamlines + 1):
            closed = offsets.rows == count + 1 and last == self.n_points
            opened = offsets.rows == count and last < self.n_points
            backed = bool(by_line) and all(rows == count for rows in by_line)
            # Without data of streamlines, a total in place of the last streamline may as well be an empty one.
            if (backed and (closed or opened)) or (closed and not by_line and count > streamlines):
                self._warn("NB_STREAMLINES", streamlines, count)
                self.n_streamlines = count
                return

    def _warn(self, key: str, value: int, count: int) -> None:
        warnings.warn(
            f"{self.path}: {key} is {value}, but all arrays have {count}, which is used; write the file again",
            stacklevel=2,
        )

    def _check_sizes(self) -> None:
        position = self._header_position
        if self.positions is None and self.n_points:
            raise FormatError(self.path, position, "no positions", f"an array of {self.n_points} points")
        if self.offsets is None and self.n_streamlines:
            raise FormatError(self.path, position, "no offsets", f"offsets of {self.n_streamlines} streamlines")
        if self.positions is not None:
            if self.positions.columns != 3 or self.positions.dtype.kind != "f":
                raise FormatError(
                    self.path,
                    self.positions.position,
                    f"positions of {self.positions.columns} columns of {self.positions.dtype}",
                    "3 columns of float16, float32 or float64",
                )
            self.positions.expect(self.n_points, "positions", "NB_VERTICES")
        if self.offsets is not None and (self.offsets.columns != 1 or self.offsets.dtype.kind not in "iu"):
            raise FormatError(self.path, self.offsets.position, f"offsets of {self.offsets.dtype}", "integers")
        for name, entry in self.per_point.items():
            entry.expect(self.n_points, f"dpv/{name}", "NB_VERTICES")
        for name, entry in self.per_streamline.items():
            entry.expect(self.n_streamlines, f"dps/{name}", "NB_STREAMLINES")

    def all_offsets(self) -> NDArray[np.int64]:
        """Read the (n_streamlines + 1,) offsets; files have them with or without the last one."""
        entry = self.offsets
        if entry is None:
            return np.zeros(1, np.int64)
        if entry.rows not in (self.n_streamlines, self.n_streamlines + 1):
            entry.expect(self.n_streamlines, "offsets", "NB_STREAMLINES")
        raw = entry.whole().reshape(-1)
        offsets = np.append(raw[: self.n_streamlines].astype(np.int64), self.n_points)
        steps = np.diff(offsets, prepend=0)
        # The last entry, where there is one, is a total; some writers leave it 0.
        total = int(raw[-1]) if len(raw) > self.n_streamlines else self.n_points
        bad = np.flatnonzero(steps < 0)
        if len(bad) or (len(offsets) > 1 and offsets[0] != 0) or total not in (0, self.n_points):
            at = int(bad[0]) if len(bad) else 0 if offsets[0] else self.n_streamlines
            raise FormatError(
                self.path,
                entry.position,
                f"offset {at} is {int(raw[min(at, len(raw) - 1)])}",
                f"offsets from 0 up to {self.n_points} that never decrease",
            )
        if len(offsets) == 1 and self.n_points:
            raise FormatError(
                self.path,
                self._header_position,
                f"{self.n_points} points and no streamline",
                "a streamline for every point",
            )
        return offsets

    def all_groups(self) -> tuple[dict[str, Array], dict[str, dict[str, Array]]]:
        """Read groups, checked to name streamlines that exist, and their data."""
        groups = {}
        for name, entry in self.groups.items():
            ids = entry.whole().reshape(-1)
            if ids.dtype.kind not in "iu":
                raise FormatError(self.path, entry.position, f"group {name!r} of {ids.dtype}", "integers")
            if len(ids) and not (ids.min() >= 0 and ids.max() < self.n_streamlines):
                raise FormatError(
                    self.path,
                    entry.position,
                    f"group {name!r} with streamlines {ids.min()} to {ids.max()}",
                    f"indices below {self.n_streamlines}",
                )
            # Ascending, so that pieces joined again give the same groups.
            groups[name] = np.sort(ids.astype(np.int64))
        data = {
            group: {name: _one_row(entry.whole()) for name, entry in values.items()}
            for group, values in self.per_group.items()
        }
        return groups, data

    def chunks(self, max_points: int) -> Iterator[Streamlines]:
        """Yield consecutive streamlines of at most `max_points` points, at least one piece."""
        offsets = self.all_offsets()
        groups, per_group = self.all_groups()
        dropped = {UNKNOWN: self.unknown} if self.unknown else {}
        for start, stop in list(blocks(offsets, max_points)) or [(0, 0)]:
            first, last = int(offsets[start]), int(offsets[stop])
            long = last - first > max_points and is_long(last - first)  # one streamline
            if self.positions is None:
                points = np.zeros((0, 3), np.float32)
            else:
                points = _floats(self.positions.take(first, last, long=long), long)
            yield finite(
                points,
                np.diff(offsets[start : stop + 1]),
                {k: e.flat(e.take(first, last, long=long), long=long) for k, e in self.per_point.items()},
                dropped,
                per_streamline={k: e.flat(e.take(start, stop)) for k, e in self.per_streamline.items()},
                groups={k: v[(v >= start) & (v < stop)] - start for k, v in groups.items()},
                per_group=per_group,
                affine=self.affine,
                space=self.space,
            )
            dropped = {}


def _floats(rows: Array, long: bool) -> Array:
    """Points as float32 or float64; a very long streamline's points stay mapped, if they can."""
    kind = np.dtype(np.float64 if rows.dtype.itemsize == 8 else np.float32)
    if long and rows.dtype == kind and rows.flags.aligned:
        return rows
    return without_rows(rows, np.zeros(0, np.int64), kind, long=long)


@contextmanager
def _opened(path: str | PathLike[str]) -> Iterator[_Trx]:
    archive = FolderArrays(path) if Path(path).is_dir() else ZipArrays(path)
    try:
        yield _Trx(archive)
    finally:
        archive.close()


def _one_row(values: Array) -> Array:
    """Return a group's value without the axis of one row that the format stores."""
    return values[0] if values.ndim == 2 and len(values) == 1 else values


def _free(name: str, taken: dict[str, Any]) -> str:
    """Return the name without the blanks that some writers pad it with, made unique."""
    bare = name.rstrip() or name
    return bare if bare not in taken else name


def read(path: str | PathLike[str], *, progress: bool = False) -> Streamlines:  # noqa: ARG001
    """Read a whole trx file (see :func:`pvfiblets.formats.read`)."""
    with _opened(path) as trx:
        return next(trx.chunks(max(1, trx.n_points)))


def iter_chunks(path: str | PathLike[str], max_points: int) -> Iterator[Streamlines]:
    """Stream a trx file (see :func:`pvfiblets.formats.iter_chunks`)."""
    # In memory besides a piece: the offsets, the groups and the groups' data.
    with _opened(path) as trx:
        yield from trx.chunks(max_points)


def info(path: str | PathLike[str]) -> dict[str, Any]:
    """Header facts (see :func:`pvfiblets.formats.info`)."""
    with _opened(path) as trx:
        return {
            "streamlines": trx.n_streamlines,
            "points": trx.n_points,
            "dtype": trx.positions.dtype.name if trx.positions else None,
            "per_point": list(trx.per_point),
            "per_streamline": list(trx.per_streamline),
            "groups": list(trx.groups),
            "affine": trx.affine,
            **trx.space,
        }


def write(path: str | PathLike[str], streamlines: Streamlines) -> None:
    """Write a trx file, stored without compression (see :func:`pvfiblets.formats.write`)."""
    from zipfile import ZIP_STORED, ZipFile

    arrays: dict[str, Array] = {
        _entry("positions", streamlines.points, "positions"): streamlines.points,
        "offsets.uint64": streamlines.offsets.astype("<u8"),
    }
    renamed: dict[str, str] = {}
    for folder, columns in (("dpv", streamlines.per_point), ("dps", streamlines.per_streamline)):
        names = _without_dots(columns, renamed)
        for name, values in columns.items():
            arrays[_entry(f"{folder}/{names[name]}", values, name)] = values
    groups = _without_dots({**streamlines.groups, **streamlines.per_group}, renamed)
    for name, members in streamlines.groups.items():
        ids = members.astype(np.uint32 if len(streamlines) < 2**32 else np.uint64)
        arrays[_entry(f"groups/{groups[name]}", ids, name)] = ids
    for group, data in streamlines.per_group.items():
        names = _without_dots(data, renamed)
        for name, values in data.items():
            # The format stores one row per group.
            row = values.reshape(1, -1)
            arrays[_entry(f"dpg/{_checked(groups[group])}/{names[name]}", row, name)] = row
    dimensions = streamlines.space.get("dimensions", (1, 1, 1))
    if order := streamlines.space.get("voxel_order"):
        dimensions = along_affine(dimensions, order, streamlines.affine)
    header = {
        "DIMENSIONS": [int(d) for d in dimensions],
        "VOXEL_TO_RASMM": streamlines.affine.tolist(),
        "NB_VERTICES": streamlines.n_points,
        "NB_STREAMLINES": len(streamlines),
    }
    size = sum(values.nbytes for values in arrays.values())
    with replacing(path, size) as file, ZipFile(file, "w", ZIP_STORED, allowZip64=True) as archive:
        archive.writestr("header.json", json.dumps(header))
        for name, values in arrays.items():
            with archive.open(name, "w", force_zip64=values.nbytes > 2**31 - 1) as target:
                for i in range(0, len(values), 1 << 20):
                    part = np.ascontiguousarray(values[i : i + (1 << 20)])
                    target.write(part.astype(part.dtype.newbyteorder("<"), copy=False).data)
                    forget(values, 0, min(i + (1 << 20), len(values)))
    if renamed:
        told = ", ".join(f"{name!r} is {new!r}" for name, new in renamed.items())
        warnings.warn(f"{path}: trx-python and DIPY refuse names with dots; {told} here", UserWarning, stacklevel=3)


def _without_dots(names: Iterable[str], renamed: dict[str, str]) -> dict[str, str]:
    """Return each name's name in the file, one for each, and add changed ones to `renamed`."""
    found: dict[str, str] = {}
    for name in sorted(names, key=lambda name: "." in name):  # names without dots stay
        new = name.replace(".", "_")
        while new in found.values():
            new += "_"
        found[name] = new
    renamed |= {name: new for name, new in found.items() if name != new}
    return found


def _entry(base: str, values: Array, name: str) -> str:
    kind = values.dtype
    if kind.kind not in "fiub" or kind.itemsize > 8:
        raise ValueError(f"{base!r} is {kind}; a trx file holds integers and floats up to 64 bits")
    if values.ndim > 2:
        raise ValueError(f"{base!r} has the shape {values.shape}; a trx file holds at most 2 axes")
    columns = values.shape[1] if values.ndim == 2 else 1
    if columns == 0:
        raise ValueError(f"{base!r} has no columns; remove it, since a trx file cannot hold such an array")
    _checked(name)
    suffix = "bit" if kind.kind == "b" else kind.name
    return f"{base}.{columns}.{suffix}" if columns != 1 else f"{base}.{suffix}"


def _checked(name: str) -> str:
    if not name or name != name.strip() or any(c in name for c in "/\\\0"):
        raise ValueError(f"{name!r} cannot be a name in a trx file: remove slashes and outer blanks")
    return name
