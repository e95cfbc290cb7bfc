"""Lines and points with halos from all kinds of sources, with the requested values."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple, cast

import numpy as np
import numpy.typing as npt

from pvfiblets.lines import Lines, are_words, flat, gather, joined, numbers_or_colours, numbers_or_rgba, refuse_words
from pvfiblets.streamlines import Streamlines
from pvfiblets.support.vtk_space import space_of_dataset, to_ras

from .geometry import HaloLines, HaloPoints

if TYPE_CHECKING:
    from pvfiblets.codec.fibletset import FibletSet

SCALARS, FILTER = "scalars", "filter"  # names of unnamed arrays

Array = npt.NDArray[Any]


class LinesAndValues(NamedTuple):
    """Lines with halos, and the data of whole lines."""

    lines: HaloLines  # lines in the order of their source; `lines.values` holds the requested values at their points
    # `(n_lines,)` numbers or `(n_lines, 4)` float32 RGBA in 0..1: `scalars` that have a row for each line
    line_values: Mapping[str, Array]


def as_halo_lines(
    source: Any,
    *,
    scalars: str | npt.ArrayLike | None = None,
    rgb: bool | None = None,
    filter_by: str | npt.ArrayLike | None = None,
) -> LinesAndValues:
    """Make lines with halos of line data."""
    # A point with NaN or infinity ends its line: each piece is a line with the data of the whole, and a warning counts
    # them. A point that several lines use becomes a point of each. Where cells of two points were joined to lines,
    # their data is that of segments: a point has the mean of the two that meet there.
    if isinstance(source, HaloLines):
        ids = np.arange(source.n_points)
        made = _Lines(Lines(source.points, ids, source.offsets, source.n_lines, source.values), source.values)
    else:
        made = _Lines(gather(source, "lines with halos", keep_single=True), {})
    return made.build(scalars, rgb, filter_by)


def as_halo_points(
    source: Any,
    *,
    scalars: str | npt.ArrayLike | None = None,
    rgb: bool | None = None,
    filter_by: str | npt.ArrayLike | None = None,
) -> HaloPoints:
    """Make points with halos of a point cloud."""
    points, rows, elsewhere = _points_of(source)
    kept = dict(source.values) if isinstance(source, HaloPoints) else {}
    values: dict[str, Array] = {}
    if scalars is not None:
        name, array, per_line = rows.find(scalars, "scalars", SCALARS, elsewhere)
        values[name] = _values(rows.at_points(array, per_line), name, rgb)
    if filter_by is not None:
        name, array, per_line = rows.find(filter_by, "filter_by", FILTER, elsewhere)
        _put(values, name, rows.at_points(_numbers(array, name), per_line))
    return HaloPoints(points, {**kept, **values})


# ---------------------------------------------------------------------- rows of arrays


@dataclass(frozen=True, eq=False)
class _Rows:
    """Data of points and of whole lines, and how many rows each has."""

    n_points: int
    point_data: Mapping[str, Array]
    n_lines: int | None = None
    line_data: Mapping[str, Array] = field(default_factory=dict)
    counts: Array | None = None
    pieces: Lines | None = None

    def find(
        self, given: Any, what: str, unnamed: str, elsewhere: str = "", *, words: bool = False
    ) -> tuple[str, Array, bool]:
        """Return the argument's name, the array, and whether its rows are lines instead of points."""
        if isinstance(given, str):
            if given in self.point_data:
                return given, flat(self.point_data[given], f"{what} {given!r}", words=words), False
            if given in self.line_data:
                return given, flat(self.line_data[given], f"{what} {given!r}", words=words), True
            known = [
                f"{title} {', '.join(map(repr, data))}"
                for title, data in (("point data", self.point_data), ("line data", self.line_data))
                if data
            ]
            raise ValueError(
                f"{what} is {given!r}, which the source does not have; it has {' and '.join(known) or 'no data'}"
                + elsewhere
            )
        array = flat(joined(given, (self.n_points, self.n_lines)), what, words=words)
        if array.ndim and len(array) == self.n_points:
            return unnamed, array, False
        if array.ndim and len(array) == self.n_lines:
            return unnamed, array if self.pieces is None else self.pieces.of_tubes(array), True
        known_rows = f"{self.n_points} points" + ("" if self.n_lines is None else f" or of {self.n_lines} lines")
        raise ValueError(f"{what} has the shape {array.shape}, expected a row for each of {known_rows}")

    def at_points(self, array: Array, per_line: bool) -> Array:
        """Repeat rows of lines for their points."""
        return np.repeat(array, self.counts, axis=0) if per_line and self.counts is not None else array


class _Lines:
    """Lines in the making."""

    def __init__(self, source: Lines, kept: Mapping[str, Array]) -> None:
        self.source, self.kept = source, kept
        self.rows = _Rows(len(source.points), source.point_data, source.n_rows, source.line_data, pieces=source)
        n = len(source.ids)
        # Most sources list their points line by line: then nothing need be copied.
        self.in_order = n == len(source.points) and bool((source.ids == np.arange(n)).all())
        # Consecutive cells of two points are one line; their cell data belong to segments.
        self.joined = source.tube_of is not None and len(source.counts) != source.n_tubes

    def build(self, scalars: Any, rgb: bool | None, filter_by: Any) -> LinesAndValues:
        values: dict[str, Array] = {}
        line_values: dict[str, Array] = {}
        if scalars is not None:
            name, array, per_line = self.rows.find(scalars, "scalars", SCALARS, words=True)
            refuse_words(array, f"scalars {name!r}", per_line and not self.joined)
            array = array if are_words(array) else _values(array, name, rgb)
            if per_line and not self.joined:
                line_values[name] = array
            else:
                values[name] = self._at_points(array, per_line)
        if filter_by is not None:
            name, array, per_line = self.rows.find(filter_by, "filter_by", FILTER)
            if name in line_values and (isinstance(scalars, str) != isinstance(filter_by, str)):
                raise ValueError(_clash(name))
            _put(values, name, self._at_points(_numbers(array, name), per_line))
        points = self._in_order(self.source.points)
        return LinesAndValues(HaloLines(points, self.source.offsets, {**self.kept, **values}), line_values)

    def _in_order(self, array: Array) -> Array:
        return array if self.in_order else array[self.source.ids]

    def _at_points(self, array: Array, per_line: bool) -> Array:
        """Rows for the points of all lines, one line after the other."""
        if not per_line:
            return self._in_order(array)
        if not self.joined:
            return np.repeat(array, self.source.counts, axis=0)
        segments, cells = self.source.segments()
        flat = array.reshape(len(array), -1)
        rows = np.zeros((len(self.source.ids), flat.shape[1]))
        uses = np.maximum(np.bincount(segments.ravel(), minlength=len(rows)), 1)
        for column in range(flat.shape[1]):
            for end in segments.T:
                rows[:, column] += np.bincount(end, flat[cells, column], len(rows))
        rows /= uses[:, None]
        return rows.reshape(-1, *array.shape[1:]).astype(array.dtype if array.dtype.kind == "f" else np.float64)


def _points_of(source: Any) -> tuple[Array, _Rows, str]:
    """Points, their data, and a message about data that are not at points."""
    if isinstance(source, HaloPoints):
        return source.points, _Rows(source.n_points, source.values), ""
    if hasattr(source, "decompress") and hasattr(source, "fiblet_points"):
        source = cast("FibletSet", source).decompress()
    if isinstance(source, Streamlines):
        rows = _Rows(source.n_points, source.per_point, len(source), source.per_streamline, source.counts)
        return source.points, rows, ""
    if hasattr(source, "IsA"):
        return _points_of_vtk(source)
    try:
        points = np.asarray(source)
    except ValueError:  # arrays of unlike lengths
        points = np.zeros(0, object)
    if points.dtype.kind not in "fiub":
        raise TypeError(
            f"points with halos cannot be made from a {type(source).__name__}; give a data set with points, "
            "Streamlines, a FibletSet or an (n, 3) array (np.concatenate(...) of a list of arrays)"
        )
    if points.size == 0 and points.ndim < 2:
        points = points.reshape(0, 3)
    return points, _Rows(len(points) if points.ndim else 0, {}), ""


def _points_of_vtk(mesh: Any) -> tuple[Array, _Rows, str]:
    from vtkmodules.util.numpy_support import vtk_to_numpy

    if not mesh.IsA("vtkDataSet"):
        whole = "; give its combine()" if mesh.IsA("vtkCompositeDataSet") else "; give a data set with points"
        raise TypeError(f"points with halos cannot be made from a {type(mesh).__name__}{whole}")
    held = mesh.GetPoints()
    # A copy: VTK may move its own memory at any time.
    points = np.zeros((0, 3), np.float32) if held is None else np.array(vtk_to_numpy(held.GetData()))
    points = to_ras(points, space_of_dataset(mesh))
    attributes = mesh.GetPointData()
    arrays = [attributes.GetArray(i) for i in range(attributes.GetNumberOfArrays())]  # None for text
    data = {a.GetName(): np.array(vtk_to_numpy(a)) for a in arrays if a is not None and a.GetName()}
    cells = mesh.GetCellData()
    names = [cells.GetArrayName(i) for i in range(cells.GetNumberOfArrays())]
    listed = ", ".join(map(repr, names))
    elsewhere = f"; cell data {listed} becomes point data by cell_data_to_point_data()" if names else ""
    return points, _Rows(len(points), data), elsewhere


# ---------------------------------------------------------------------- arrays


def _values(array: Array, name: str, rgb: bool | None) -> Array:
    """Numbers as they are, magnitudes of vectors, colours as float32 RGBA in 0..1."""
    found = numbers_or_rgba(numbers_or_colours(array, name, rgb), name, rgb)
    return found if found.ndim == 1 else found.astype(np.float32)


def _numbers(array: Array, name: str) -> Array:
    if array.ndim != 1:
        raise ValueError(
            f"filter_by {name!r} has the shape {array.shape}, expected one number in each row; give one column, or the "
            "norm of vectors"
        )
    return array


def _put(values: dict[str, Array], name: str, array: Array) -> None:
    """Store values to filter by, unless something else has their name."""
    held = values.get(name)
    if held is not None and (held.shape != array.shape or not np.array_equal(held, array, equal_nan=True)):
        raise ValueError(_clash(name))
    values[name] = array


def _clash(name: str) -> str:
    return f"scalars and filter_by are different arrays, but both are called {name!r}; give both by name, or rename one"
