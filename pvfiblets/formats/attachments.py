"""Values that lie in a file of their own beside the tractogram.

``.tsf``
    MRtrix track scalars: laid out as tck with one number per point, so it must have the same
    streamlines with the same numbers of points. A missing value (NaN inside a streamline) cannot
    looks like the end of a streamline; such a file does not fit and is refused.
``.npy``
    An array, ``(n,)`` or ``(n, k)``.
``.txt``, ``.csv``
    Numbers separated by blanks or commas, one row per line; ``#`` begins a comment. MRtrix
    writes weights as one line: a single row of `n` numbers is taken as a column.

Where n is the number of streamlines, the values are per streamline, where it is the number of
points, per point; streamlines first, should both be equal.
"""

from __future__ import annotations

import tokenize
import warnings
from collections.abc import Mapping
from os import PathLike, fspath
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pvfiblets.errors import FormatError
from pvfiblets.formats.mapped import MappedFile
from pvfiblets.formats.registry import UnknownFormatError
from pvfiblets.formats.tck import Data, timestamp_in, timestamp_of, write_rows
from pvfiblets.invalid_points import NONFINITE
from pvfiblets.streamlines import Streamlines, offsets_from_counts

Array = NDArray[Any]

MAGIC_SCALARS = "mrtrix track scalars"
SUFFIXES = (".tsf", ".npy", ".txt", ".csv")


def attach(streamlines: Streamlines, path: str | PathLike[str], name: str | None = None) -> str:
    """Add a file's values to `streamlines` (see :func:`pvfiblets.formats.attach`)."""
    where, values = values_for(path, streamlines.counts, streamlines.space)
    getattr(streamlines, where)[name_of(path) if name is None else name] = values
    return where


def is_values_file(what: Any, held: Any = None) -> bool:
    """Whether something is the path of a file of values, by its suffix, and no name of an array that `held` has."""
    if not isinstance(what, (str, PathLike)) or Path(what).suffix.lower() not in SUFFIXES:
        return False
    return not any(what in getattr(held, part, ()) for part in ("per_point", "per_streamline"))


def name_of(path: str | PathLike[str]) -> str:
    """Return what values of a file are called: its name without the suffix."""
    return Path(path).stem


def values_for(
    path: str | PathLike[str], counts: NDArray[np.int64], space: Mapping[str, Any] | None = None
) -> tuple[str, Array]:
    """Read the values of a file for streamlines of so many points."""
    text = fspath(Path(path).expanduser())
    suffix = Path(text).suffix.lower()
    if suffix == ".tsf":
        return "per_point", _scalars_of(counts, text, timestamp_in(space or {}))
    return _place(counts, text, read_rows(text, suffix))


def read_values(path: str | PathLike[str]) -> Array:
    """Read one number per row of a ``.tsf``, ``.npy``, ``.txt`` or ``.csv`` file, whatever they belong to."""
    text = fspath(path)
    suffix = Path(text).suffix.lower()
    values = read_scalars(text)[0] if suffix == ".tsf" else read_rows(text, suffix)
    if values.ndim == 2 and 1 in values.shape:
        values = values.reshape(-1)
    if values.ndim != 1:
        raise FormatError(text, None, f"values of shape {values.shape}", "one number per row")
    return values


def numbers_or_name(given: str | None) -> Any:
    """Return the numbers of a file of values; a text that names no such file is the name of an array."""
    if given is None or Path(given).suffix.lower() not in SUFFIXES:
        return given
    return read_values(given)


def read_rows(path: str, suffix: str) -> Array:
    """Read the rows of numbers of a ``.npy``, ``.txt`` or ``.csv`` file."""
    if suffix == ".npy":
        return _read_npy(path)
    if suffix in (".txt", ".csv"):
        return _read_text(path)
    raise UnknownFormatError(f"{path}: values can be attached from {', '.join(SUFFIXES)}, not {suffix!r}")


def _place(counts: NDArray[np.int64], path: str, values: Array) -> tuple[str, Array]:
    fits = len(counts), int(counts.sum())
    # A row becomes a column, unless it is the one row of a single streamline or point.
    wide = values.ndim == 2 and len(values) == 1 and 1 not in fits and values.shape[1] in fits
    if wide or values.shape[1:] == (1,):
        values = values.reshape(-1)
    n = len(values) if values.ndim else 0
    for where, rows in zip(("per_streamline", "per_point"), fits, strict=True):
        if n == rows and values.ndim:
            return where, values
    raise FormatError(
        path,
        None,
        f"values of shape {values.shape}",
        f"{fits[0]} rows (one per streamline) or {fits[1]} (one per point)",
    )


def read_scalars(path: str | PathLike[str]) -> tuple[Array, NDArray[np.int64]]:
    """Read a tsf file."""
    data = Data(path, MAGIC_SCALARS, 1)
    values, counts = [], []
    for window, dropped in data.windows(max(1, data.n_rows)):
        if NONFINITE in dropped:  # a row of one number is never partly finite
            raise FormatError(fspath(path), None, "infinite values", "finite values")
        values.append(window.rows[:, 0])
        counts.append(window.counts)
    return np.concatenate(values), np.concatenate(counts)


def write_scalars(path: str | PathLike[str], streamlines: Streamlines, name: str) -> None:
    """Write the per-point array `name`, of one column, as a tsf file."""
    values = streamlines.per_point[name]
    if values.ndim != 1 or not np.isfinite(values).all():
        raise ValueError(
            f"per_point[{name!r}] of shape {values.shape} must have one finite value per point to "
            "be written as tsf; choose a column, or replace NaN first"
        )
    wide = values.dtype.itemsize == 8 and values.dtype.kind == "f"
    kind = np.dtype("<f8" if wide else "<f4")
    write_rows(path, MAGIC_SCALARS, streamlines, values[:, None], kind, [f"timestamp: {timestamp_of(streamlines)}"])


def _scalars_of(wanted: NDArray[np.int64], path: str, timestamp: str | None) -> Array:
    values, counts = read_scalars(path)
    header = Data(path, MAGIC_SCALARS, 1).header
    if np.array_equal(counts, wanted):
        of = header.fields.get("timestamp")
        if None not in (of, timestamp) and of != timestamp:
            warnings.warn(
                f"{path} has the timestamp {of}, its tracks have {timestamp}: the values may be of other streamlines, "
                "and mrview refuses the pair; make the .tsf file again from these tracks",
                UserWarning,
                stacklevel=2,
            )
        return values
    if len(counts) != len(wanted):
        found, expected = f"{len(counts)} streamlines", f"{len(wanted)} as the tractogram has"
    else:
        i = int(np.flatnonzero(counts != wanted)[0])
        found = f"{counts[i]} values in streamline {i}"
        expected = f"{wanted[i]}, one for each of its points"
    at = offsets_from_counts(counts + 1)
    size = values.dtype.itemsize
    first = int(np.argmax(counts != wanted)) if len(counts) == len(wanted) else 0
    raise FormatError(path, header.data_position + int(at[first]) * size, found, expected)


def _read_npy(path: str) -> Array:
    file = MappedFile(path)
    magic = file.bytes(0, min(6, file.size), "the magic")
    if magic != b"\x93NUMPY":
        raise FormatError(path, 0, repr(magic), "the magic b'\\x93NUMPY'")
    wide = file.bytes(6, 1, "the version of its format")[0] > 1
    length = int.from_bytes(file.bytes(8, 4 if wide else 2, "the size of its header"), "little")
    file.check(12 if wide else 10, length, "its header")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # of headers as Python 2 wrote them
            # Mapping checks the shape against the file's size before memory is spent.
            values = np.load(path, mmap_mode="r", allow_pickle=False)
    except (ValueError, EOFError, OSError, OverflowError, TypeError, SyntaxError, tokenize.TokenError) as error:
        raise FormatError(path, 6, f"a damaged header ({error})", "an array of numbers") from error
    return _as_numbers(path, np.array(values))


def _read_text(path: str) -> Array:
    try:
        text = Path(path).read_text("utf-8")
    except UnicodeDecodeError as error:
        raise FormatError(path, error.start, f"byte {error.object[error.start]}", "text") from error
    with warnings.catch_warnings():
        # An empty file gives an empty array, which is judged by its length.
        warnings.simplefilter("ignore", UserWarning)
        try:
            values = np.loadtxt(text.replace(",", " ").splitlines(), np.float64, ndmin=2)
        except ValueError as error:
            raise FormatError(path, None, str(error), "rows of numbers of equal length") from error
    return values


def _as_numbers(path: str, values: Array) -> Array:
    if values.dtype.kind not in "fiub" or values.ndim not in (1, 2):
        raise FormatError(path, None, f"{values.dtype} of shape {values.shape}", "numbers of 1 or 2 dimensions")
    return values.astype(values.dtype.newbyteorder("="))
