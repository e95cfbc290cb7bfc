"""Values of positions along a bundle at the points of its streamlines: the inverse of a tract profile."""

from __future__ import annotations

import csv
import os
from collections.abc import Container
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ...codec.decompress import select_streamlines
from ...errors import FormatError
from ...formats.attachments import read_values
from ...streamlines import Streamlines
from ...support.ragged import blocks
from ...support.real_numbers import real_numbers
from ..measures.chunks import without_groups
from .tract_profile import as_line, bundle_lines, resampled_lines, runs_backwards

if TYPE_CHECKING:
    from ...codec.fibletset import FibletSet

__all__ = ["TABLES", "Profile", "read_profile", "read_profiles", "values_along"]

Floats = npt.NDArray[np.float64]
Profile = tuple[Floats, Floats | None]  # numbers of positions along a bundle, and these positions if they are known
TABLES = (".csv", ".tsv", ".txt", ".npy")
PLACES = ("bundle", "position", "share_of_length", "x", "y", "z")  # columns that say where values are
CHUNK = 1 << 20  # points decoded, or places resampled, together


def values_along(
    data: FibletSet | Streamlines, ids: Any, values: npt.ArrayLike, *, orient_by: npt.ArrayLike | None = None
) -> Floats:
    """Return for each point of a bundle the value of its position along the bundle.

    Parameters
    ----------
    data : FibletSet or Streamlines
        The tractogram.
    ids : array_like, slice, Bundle, Cluster or str
        The bundle's streamlines, or the name of a group.
    values : array_like
        ``(n,)`` numbers at equal steps of arc length from the bundle's start to its end, such as the ``mean`` of
        :func:`tract_profile`; NaN for no value.
    orient_by : array_like, optional
        ``(m, 3)`` mm: a line; streamlines that run against it are reversed. By default the first of the bundle.

    Returns
    -------
    numpy.ndarray
        ``(n_points,)`` float64, interpolated linearly. NaN for points whose nearest position has no value, and for
        points of other streamlines.

    Raises
    ------
    KeyError
        If no group has that name.
    IndexError
        If a streamline is out of range.
    ValueError
        If `values` are not two or more numbers.
    """
    numbers = real_numbers(values, "values along a bundle")
    if numbers.ndim != 1:
        raise ValueError(f"values along a bundle have the shape {numbers.shape}; give one number for each position")
    n = len(numbers)
    if n < 2:
        raise ValueError(f"values along a bundle have {n} numbers; give 2 or more, the first and last for its ends")
    chosen = select_streamlines(len(data), bundle_lines(data, ids))
    offsets = np.asarray(data.offsets if isinstance(data, Streamlines) else data.offsets())
    counts = np.diff(offsets)
    chosen = chosen[counts[chosen] > 0]
    found = np.full(int(offsets[-1]), np.nan)
    bare = without_groups(data)
    like = None if orient_by is None else as_line(orient_by, n)
    for a, b in blocks(np.concatenate([[0], np.cumsum(np.maximum(counts[chosen], n))]), CHUNK):
        some = chosen[a:b]
        part: Any = bare[some] if isinstance(bare, Streamlines) else bare.decompress(some, dtype=np.float64)
        places = resampled_lines(part.points, np.zeros(part.n_points), part.offsets, n)[0]
        like = places[0] if like is None else like
        shares = _shares(np.asarray(part.points, np.float64), np.asarray(part.offsets))
        backwards = np.repeat(runs_backwards(places, like), np.diff(part.offsets))
        rows = np.repeat(offsets[some] - part.offsets[:-1], counts[some]) + np.arange(part.n_points)
        found[rows] = _between(numbers, np.where(backwards, 1.0 - shares, shares))
    return found


def read_profile(path: str | os.PathLike[str], column: str = "mean", bundle: str | None = None) -> Profile:
    """Read the numbers of a bundle's positions, and the positions from the columns x, y, z if a table has them."""
    where = Path(path).expanduser()
    names, rows = _table(where)
    if not names:
        return read_values(where).astype(np.float64), None
    if column not in names:
        raise KeyError(f"{where} has no column {column!r}; it has: {', '.join(names)}")
    if "bundle" in names:
        at = names.index("bundle")
        known = list(dict.fromkeys(row[at] for row in rows))
        if bundle not in known and len(known) > 1:
            raise ValueError(f"{where} has profiles of {', '.join(known)}; give the name of one of these groups as ids")
    return _profile(where, names, rows, column, bundle)


def _profile(where: Path, names: list[str], rows: list[list[str]], column: str, bundle: str | None) -> Profile:
    if "bundle" in names:
        at = names.index("bundle")
        chosen = [row for row in rows if row[at] == bundle]
        rows = chosen or rows
    wanted = [column, *(axis for axis in "xyz" if axis in names)]
    cells = [[row[names.index(name)] or "nan" for row in rows] for name in wanted]
    if wrong := next((cell for found in cells for cell in found if not _is_number(cell)), None):
        raise FormatError(where, None, f"the cell {wrong!r}", f"numbers in the columns {', '.join(wanted)}")
    values, *core = (np.array(found, np.float64) for found in cells)
    return values, np.stack(core, axis=1) if len(core) == 3 and np.isfinite(core).all() else None


def read_profiles(
    path: str | os.PathLike[str], groups: Container[str] = ()
) -> dict[str, dict[str | None, Profile]]:
    """Read each column of values of a file, by those of its bundles that are groups, or of None for all streamlines.

    Numbers without a head are the column ``""``.
    """
    where = Path(path).expanduser()
    names, rows = _table(where)
    if not names:
        return {"": {None: (read_values(where).astype(np.float64), None)}}
    cells = dict(zip(names, zip(*rows, strict=True), strict=True)) if rows else {}
    numbers = [name for name, column in cells.items() if all(map(_is_number, filter(None, column)))]
    columns = [name for name in numbers if name not in PLACES]
    if not columns:
        raise FormatError(where, None, f"no numbers in the columns {', '.join(names)}", "a column of values")
    bundles = list(dict.fromkeys(cells.get("bundle", ())))
    known: list[str | None] = [name for name in bundles if name in groups]
    if len(bundles) > 1 and not known:
        raise ValueError(f"{path} has profiles of {', '.join(bundles)}; the tractogram has no groups of these names")
    return {
        column: {name: _profile(where, names, rows, column, name) for name in known or [None]} for column in columns
    }


def _table(where: Path) -> tuple[list[str], list[list[str]]]:
    """Return names of a table's columns, and its rows; nothing of numbers without a head."""
    if where.suffix.lower() == ".npy":
        return [], []
    with where.open(newline="") as file:
        rows = [row for row in csv.reader(file, delimiter="\t" if where.suffix.lower() == ".tsv" else ",") if row]
    if all(_is_number(word) for cell in (rows[0] if rows else []) for word in cell.split()):
        return [], []
    names, rows = rows[0], rows[1:]
    if ragged := next((row for row in rows if len(row) != len(names)), None):
        raise FormatError(where, None, f"the row {ragged}", f"{len(names)} cells in each row, as in the first")
    return names, rows


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _shares(points: Floats, offsets: npt.NDArray[np.int64]) -> Floats:
    """Return the arc length up to each point as a share of its streamline's; 0 where that has no length."""
    from ..measures.measure_kernels import arc_lengths

    along = np.empty(len(points))
    arc_lengths(points, offsets, along)
    length = np.repeat(along[offsets[1:] - 1], np.diff(offsets))
    return np.divide(along, length, out=np.zeros(len(points)), where=length > 0.0)


def _between(values: Floats, shares: Floats) -> Floats:
    """Interpolate between positions; without a value on one side, take the nearest position."""
    at = np.clip(shares, 0.0, 1.0) * (len(values) - 1)
    low = np.minimum(at.astype(np.int64), len(values) - 2)
    t = at - low
    first, second = values[low], values[low + 1]
    mixed = first * (1.0 - t) + second * t
    return np.where(np.isnan(first) | np.isnan(second), np.where(t < 0.5, first, second), mixed)
