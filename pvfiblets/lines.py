"""The source of tubes and of lines with halos: lines and their data, from every kind of source in one form."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from os import PathLike
from typing import TYPE_CHECKING, Any, cast

import numpy as np
import numpy.typing as npt

from pvfiblets.invalid_points import CUT, NONFINITE, refuse_beyond
from pvfiblets.other_libraries import lines_of_grid, streamlines_of
from pvfiblets.streamlines import Streamlines
from pvfiblets.support.ragged import cut_offsets, offsets_from_counts
from pvfiblets.support.real_numbers import real_numbers
from pvfiblets.support.summary import warn_of_losses
from pvfiblets.support.vtk_space import space_of_dataset, to_ras

if TYPE_CHECKING:
    from pvfiblets.codec.fibletset import FibletSet

Ints = npt.NDArray[np.int64]

_EXPECTED = (
    "a PolyData with lines (or an UnstructuredGrid or MultiBlock of them), Streamlines, a FibletSet, a tractogram of "
    "nibabel, dipy or trx-python, an (n, 3) array, a list of them or (points, segments)"
)


@dataclass(frozen=True, eq=False)
class Lines:
    """Points and the lines through them."""

    points: npt.NDArray[Any]  # `(n_points, 3)` float64, mm; or float32, if that was given and `gather` may keep it
    ids: Ints  # `(n_ids,)` int64: the points of all lines, one line after the other
    offsets: Ints  # `(n_lines + 1,)` int64: line `i` goes through `ids[offsets[i]:offsets[i + 1]]`
    n_tubes: int  # tubes, those without segments included
    point_data: Mapping[str, npt.NDArray[Any]] = field(default_factory=dict)  # one row per point, and per tube
    line_data: Mapping[str, npt.NDArray[Any]] = field(default_factory=dict)
    # `(n_segments,)` int64: where the source has each segment, for sources that list segments. None: line by line.
    order: Ints | None = None
    # `(n_segments,)` int64, in the source's order: the tube of each segment, where tubes are not the lines
    tube_of: Ints | None = None
    # `(n_tubes,)` int64: the line of the source that each tube is a piece of. None: lines are whole.
    given: Ints | None = None
    n_given: int | None = None  # lines of the source, where some were cut

    def __post_init__(self) -> None:
        finite = self.points[np.isfinite(self.points)]
        refuse_beyond(float(max(finite.max(), -finite.min())) if finite.size else 0.0)

    @property
    def counts(self) -> Ints:
        """``(n_lines,)`` int64: points of each line."""
        return np.diff(self.offsets)

    @property
    def shared(self) -> bool:
        """Whether a point is on more than one line, or on one line more than once."""
        return len(self.ids) > len(self.points) or bool(np.bincount(self.ids, minlength=1).max() > 1)

    @property
    def n_rows(self) -> int:
        """Rows of an array that has one for each line of the source."""
        return self.n_tubes if self.n_given is None else self.n_given

    def of_tubes(self, array: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """Return an array of the source's lines with a row for each tube."""
        return array if self.given is None else array[self.given]

    def line_of(self, row: int) -> int:
        """The line that holds a row of `ids`."""
        return int(np.searchsorted(self.offsets, row, side="right")) - 1

    def segments(self) -> tuple[Ints, Ints]:
        """Return ``(n_segments, 2)`` rows of `ids` and ``(n_segments,)`` tubes."""
        # A line of one point has one segment, from its point to itself.
        counts = self.counts
        starts = np.ones(len(self.ids), bool)
        starts[self.offsets[1:][counts > 1] - 1] = False
        start = np.flatnonzero(starts)
        line = np.repeat(np.arange(len(counts)), counts)[start]
        segments = np.stack([start, start + (counts[line] > 1)], axis=1)
        if self.order is None:
            return segments, line
        given = np.empty_like(segments)
        given[self.order] = segments
        tubes = np.empty_like(line)
        tubes[self.order] = line
        return given, tubes if self.tube_of is None else self.tube_of


@dataclass(frozen=True, eq=False)
class SourceData:
    """All numbers and groups of the lines that something was made of, for criteria."""

    # `(n_points,)` numbers, and arrays with a row for each line
    per_point: Mapping[str, npt.NDArray[Any]] = field(default_factory=dict)
    per_line: Mapping[str, npt.NDArray[Any]] = field(default_factory=dict)
    groups: Mapping[str, npt.NDArray[Any]] = field(default_factory=dict)  # numbers of lines

    @classmethod
    def of_lines(cls, lines: Lines, source: Any, rows: Ints | None) -> SourceData:
        """Return the data of a source from which lines were gathered; `rows` are its points in their order."""
        per_point = {
            name: array.reshape(len(array)) if rows is None else array.reshape(len(array))[rows]
            for name, array in lines.point_data.items()
            if array.dtype.kind in "biuf" and array.size == len(array)
        }
        if lines.order is not None:  # line data are of segments
            return cls(per_point)
        groups = {name: np.asarray(ids, np.int64) for name, ids in (getattr(source, "groups", None) or {}).items()}
        if lines.given is not None:
            groups = {name: np.flatnonzero(np.isin(lines.given, ids)) for name, ids in groups.items()}
        return cls(per_point, lines.line_data, groups)


def gather(source: Any, noun: str = "tubes", *, keep_single: bool = False) -> Lines:
    """Take the lines out of a source, cut where a point is NaN or infinite, which is warned of."""
    if isinstance(source, Lines):
        return source
    lines, dropped = _cut(_gather(source, noun, keep_single))
    warn_of_losses(type(source).__name__, dropped, stacklevel=2)
    return lines


def _gather(source: Any, noun: str, keep_single: bool) -> Lines:
    if isinstance(source, Streamlines):
        return _from_streamlines(source, keep_single)
    if hasattr(source, "decompress") and hasattr(source, "fiblet_points"):
        return _from_streamlines(cast("FibletSet", source).decompress(), keep_single)
    if hasattr(source, "IsA"):
        return _from_vtk(lines_of_grid(source), noun, keep_single)
    if (found := streamlines_of(source)) is not None:
        return _from_streamlines(found, keep_single)
    if isinstance(source, np.ndarray) and source.dtype != object:
        if source.ndim == 3:
            return _from_arrays(list(source), keep_single)
        if source.size and (source.ndim != 2 or source.shape[1] != 3):
            raise ValueError(f"points have the shape {source.shape}, expected (n, 3): x, y, z in mm of a line's nodes")
        return _from_arrays([source], keep_single)
    if isinstance(source, tuple) and len(source) == 2 and _are_segments(source[1]):
        return _from_segments(_floats(source[0], keep_single), np.asarray(source[1], np.int64))
    if isinstance(source, (Sequence, np.ndarray)) and not isinstance(source, (str, bytes)):
        if len(source) and np.ndim(source[0]) == 1 and np.size(source[0]):
            return _gather(np.asarray(source, np.float64), noun, keep_single=False)
        return _from_arrays(list(source), keep_single)
    raise TypeError(f"{noun} cannot be made from a {type(source).__name__}; give {_EXPECTED}")


def _cut(lines: Lines) -> tuple[Lines, dict[str, int]]:
    """Return lines that end at non-finite points, and the number of dropped ones."""
    bad = ~np.isfinite(lines.points).all(axis=1)
    rows = np.flatnonzero(bad[lines.ids])
    if not len(rows):
        return lines, {}
    points = lines.points.copy()
    points[bad] = 0.0 if bad.all() else points[~bad][0]  # no line has them, and arrays still have their rows
    if lines.order is not None:
        ends, tubes = lines.segments()
        pairs = lines.ids[ends]
        good = ~bad[pairs].any(axis=1)
        found = _from_segments(points, pairs[good])
        pieces, n_lines = len(found.counts), len(lines.counts)
        if lines.tube_of is not None:
            found = replace(found, n_tubes=lines.n_tubes, tube_of=tubes[good])
        else:
            given = np.zeros(pieces, np.int64)
            given[found.segments()[1]] = tubes[good]
            found = replace(found, given=given, n_given=lines.n_tubes)
        cut = replace(found, point_data=lines.point_data, line_data=lines.line_data)
    else:
        offsets, counts = cut_offsets(lines.offsets, rows)
        given, n_lines = np.repeat(np.arange(lines.n_tubes), counts), lines.n_tubes
        data = {name: values[given] for name, values in lines.line_data.items()}
        pieces = len(given)
        cut = Lines(
            points, np.delete(lines.ids, rows), offsets, pieces, lines.point_data, data, given=given, n_given=n_lines
        )
    added = {CUT: pieces - n_lines} if pieces > n_lines else {}
    return cut, {NONFINITE: len(rows), **added}


def _floats(array: Any, keep_single: bool) -> npt.NDArray[Any]:
    """The array in its own memory or another's, as float64 or, if that is kept, as the float32 it is."""
    given = np.asarray(array)
    return given if keep_single and given.dtype == np.float32 else real_numbers(given, "points")


def _are_segments(what: Any) -> bool:
    try:
        array = np.asarray(what)
    except ValueError:  # lists of unlike lengths
        return False
    return array.dtype.kind in "iu" and array.ndim == 2 and array.shape[1] == 2


def _from_streamlines(lines: Streamlines, keep_single: bool) -> Lines:
    points = _floats(lines.points, keep_single)
    return Lines(
        points, np.arange(len(points)), lines.offsets, len(lines), dict(lines.per_point), dict(lines.per_streamline)
    )


def _from_arrays(arrays: list[Any], keep_single: bool) -> Lines:
    lines = [_floats(array, keep_single) for array in arrays]
    for i, line in enumerate(lines):
        if line.size and (line.ndim != 2 or line.shape[1] != 3):
            raise ValueError(f"line {i} has the shape {line.shape}, expected (n, 3): x, y, z in mm of its nodes")
    lines = [line.reshape(-1, 3) for line in lines]
    filled = [line for line in lines if len(line)]  # an empty list is one of float64, whatever the others are
    points = np.concatenate(filled) if filled else np.zeros((0, 3))
    offsets = offsets_from_counts([len(line) for line in lines])
    return Lines(points, np.arange(len(points)), offsets, len(lines))


def _from_vtk(mesh: Any, noun: str, keep_single: bool) -> Lines:
    from vtkmodules.util.numpy_support import vtk_to_numpy

    if not mesh.IsA("vtkPolyData"):
        if mesh.IsA("vtkMultiBlockDataSet"):
            return _from_streamlines(cast("Streamlines", streamlines_of(mesh)), keep_single)
        raise TypeError(
            f"{noun} cannot be made from a {type(mesh).__name__}; give its extract_surface() or extract_all_edges()"
        )
    cells = mesh.GetLines()
    n = cells.GetNumberOfCells()
    if mesh.GetNumberOfPoints() == 0:
        return _from_arrays([], keep_single)
    if n == 0:
        raise ValueError(
            f"the PolyData has no lines but {mesh.GetNumberOfCells()} other cells (vertices, polygons); "
            "give it lines, such as pyvista.lines_from_points(points) has, or a surface's extract_all_edges()"
        )
    n_points, first = mesh.GetNumberOfPoints(), mesh.GetVerts().GetNumberOfCells()

    def data(attributes: Any) -> dict[str, npt.NDArray[Any]]:
        arrays = [attributes.GetAbstractArray(i) for i in range(attributes.GetNumberOfArrays())]
        numbers = {a.GetName(): np.array(vtk_to_numpy(a)) for a in arrays if a.IsA("vtkDataArray") and a.GetName()}
        words = [a for a in arrays if a.IsA("vtkStringArray") and a.GetName() and a.GetNumberOfComponents() == 1]
        for a in words:
            numbers[a.GetName()] = np.array([a.GetValue(k) for k in range(a.GetNumberOfValues())], str)
        return numbers

    points = np.array(_floats(vtk_to_numpy(mesh.GetPoints().GetData()), keep_single))
    points = to_ras(points, space_of_dataset(mesh))
    ids = vtk_to_numpy(cells.GetConnectivityArray()).astype(np.int64)
    offsets = vtk_to_numpy(cells.GetOffsetsArray()).astype(np.int64)
    point_data = {k: v for k, v in data(mesh.GetPointData()).items() if len(v) == n_points}
    line_data = {k: v[first : first + n] for k, v in data(mesh.GetCellData()).items()}
    if len(ids) and (ids.min() < 0 or ids.max() >= n_points):
        raise ValueError(f"lines refer to points {ids.min()} to {ids.max()}, but the PolyData has {n_points} points")
    if np.all(np.diff(offsets) == 2):
        # Cells of two points are how many filters write whole lines: they are smooth where exactly two meet.
        chained = _from_segments(points, ids.reshape(-1, 2))
        return Lines(points, chained.ids, chained.offsets, n, point_data, line_data, chained.order, np.arange(n))
    return Lines(points, ids, offsets, n, point_data, line_data)


def _from_segments(points: npt.NDArray[Any], segments: Ints) -> Lines:
    """Chain segments that follow each other to lines."""
    if points.ndim != 2 or points.shape[1] != 3:
        raise ValueError(f"points have the shape {points.shape}, expected (n, 3): x, y, z in mm")
    n = len(segments)
    if n and (segments.min() < 0 or segments.max() >= len(points)):
        bad = int(np.argwhere((segments < 0) | (segments >= len(points)))[0, 0])
        raise ValueError(
            f"segment {bad} is {segments[bad].tolist()}, but there are {len(points)} points, counted from 0"
        )
    root, place = _chains(_before(segments, len(points)))
    heads, chain = np.unique(root, return_inverse=True)
    order = np.lexsort((place, chain))
    counts = np.bincount(chain, minlength=len(heads)) + 1
    offsets = offsets_from_counts(counts)
    ids = np.empty(int(offsets[-1]), np.int64)
    ids[offsets[:-1]] = segments[heads, 0]
    inner = np.ones(len(ids), bool)
    inner[offsets[:-1]] = False
    ids[inner] = segments[order, 1]
    return Lines(points, ids, offsets, len(heads), order=order)


def _before(segments: Ints, n_points: int) -> Ints:
    """The segment that each one goes on from, itself for none."""
    # It is the only one that ends where this one starts, if no other starts there: where more than two meet, the data
    # do not show which of them go on as one, and the order in which they are listed must not decide it.
    n = len(segments)
    own = np.arange(n)
    start, end = segments.T
    before = own.copy()
    ending = np.zeros(n_points, np.int64)
    ending[end] = own
    alone = (np.bincount(start, minlength=n_points) == 1) & (np.bincount(end, minlength=n_points) == 1)
    before[alone[start]] = ending[start[alone[start]]]
    return before


def _chains(before: Ints) -> tuple[Ints, Ints]:
    """Each segment's first one, and how many lie between; rings start at the one listed first."""
    own = np.arange(len(before))
    rounds = max(len(before), 1).bit_length()
    for _ in range(2):
        root, least = before.copy(), np.minimum(own, before)
        place = (before != own).astype(np.int64)
        for _ in range(rounds):
            place += place[root]
            least = np.minimum(least, least[root])
            root = root[root]
        ring = before[root] != root
        if not ring.any():
            break
        before = np.where(ring & (least == own), own, before)
    return root, place


def with_values(source: Any, path: str | PathLike[str]) -> tuple[Streamlines, str]:
    """Return the lines of a source with the values of a file, and what these are called."""
    from pvfiblets.formats import attachments

    if isinstance(source, Streamlines):
        lines = source[:]
    elif hasattr(source, "decompress") and hasattr(source, "fiblet_points"):
        lines = source.decompress()
    else:
        found = _gather(source, "tubes", keep_single=True)
        if found.order is not None:
            raise TypeError(f"{path}: values of a file are for whole lines, and this source lists segments; read them")
        points, columns = found.points[found.ids], {k: v[found.ids] for k, v in found.point_data.items()}
        lines = Streamlines(points, found.offsets, columns, found.line_data)
    attachments.attach(lines, path)
    return lines, attachments.name_of(path)


def _lines_of_other_libraries(source: Any) -> Any:
    """Return the Streamlines of another library's object or of a MultiBlock, with its data; all else as it is."""
    # PolyData and grids stay: their lines may share points, as at bifurcations.
    from pvfiblets.other_libraries import streamlines_of

    if hasattr(source, "IsA") and not source.IsA("vtkMultiBlockDataSet"):
        return source
    found = streamlines_of(source)
    return source if found is None else found


def read_lines(source: Any) -> Any:
    """Return the data of a file, or of an object of another library; anything else as it is."""
    if not isinstance(source, (str, PathLike)):
        return _lines_of_other_libraries(source)
    from pvfiblets.codec.files.open_lines import open_lines

    return open_lines(source)


def names_of(source: Any) -> tuple[list[str], list[str]]:
    """Names of a source's data per point, and per line."""
    if hasattr(source, "GetPointData"):
        both = (source.GetPointData(), source.GetCellData())
        arrays = [[data.GetAbstractArray(i) for i in range(data.GetNumberOfArrays())] for data in both]
        per_point, per_line = ([a.GetName() for a in some if a is not None and a.GetName()] for some in arrays)
        return per_point, per_line
    return list(getattr(source, "per_point", ())), list(getattr(source, "per_streamline", ()))


def has_name(source: Any, name: str) -> bool:
    """Whether a source has data of that name."""
    return any(name in names for names in names_of(source))


def are_words(array: npt.NDArray[Any]) -> bool:
    """Return whether an array is one of texts."""
    return array.dtype.kind in "US" or (array.dtype.kind == "O" and _all_words(array))


def _all_words(array: npt.NDArray[Any]) -> bool:
    """Return whether things are texts, and some of them missing, as columns of tables have it."""
    kinds = {type(one) for one in array.flat}
    return kinds <= {str, np.str_, type(None)} and kinds != {type(None)}


def refuse_words(array: npt.NDArray[Any], what: str, per_line: bool) -> None:
    """Refuse texts that are not of whole lines."""
    if not per_line and are_words(array):
        raise ValueError(f"{what} are words per point; words are taken per line, and numbers per point")


def flat(array: npt.NDArray[Any], what: str, *, words: bool = False) -> npt.NDArray[Any]:
    """The array with its one column as numbers, as tractograms store them; of words only where they are taken."""
    if words and array.ndim == 1 and array.size and are_words(array):
        return array
    if array.dtype.kind not in "fiub":
        raise ValueError(f"{what} has the type {array.dtype}, expected numbers")
    return array[:, 0] if array.ndim == 2 and array.shape[1] == 1 else array


def numbers_or_colours(array: npt.NDArray[Any], name: str, rgb: bool | None) -> npt.NDArray[Any]:
    """Return numbers and colours as they are, and of vectors their magnitudes, by the rules of PyVista's `add_mesh`."""
    if array.ndim != 2 or rgb:
        return array
    if rgb is None and array.shape[1] in (3, 4) and (array.dtype == np.uint8 or name.endswith(("_rgb", "_rgba"))):
        return array
    return np.asarray(np.linalg.norm(array.astype(np.float64), axis=1))


def numbers_or_rgba(
    array: npt.NDArray[Any], name: str, rgb: bool | None, row_name: Callable[[int], str] | None = None
) -> npt.NDArray[Any]:
    """Return numbers as they are, and colours as float64 RGBA of 0 to 1; errors name rows by a function."""
    if array.ndim == 1:
        if rgb:
            raise ValueError(
                f"rgb=True asks for colours, but {name!r} has one number in each row; drop rgb, or give 3 or 4 columns"
            )
        return array
    if array.ndim != 2 or array.shape[1] not in (3, 4):
        raise ValueError(
            f"{name!r} has the shape {array.shape} and type {array.dtype}, expected one number in each row, a "
            "vector, or 3 or 4 columns of colours with rgb=True"
        )
    colours = np.ones((len(array), 4))
    colours[:, : array.shape[1]] = array / (255.0 if array.dtype == np.uint8 else 1.0)
    outside = ~((colours >= 0.0) & (colours <= 1.0)).all(axis=1)
    if outside.any():
        row = int(np.argmax(outside))
        where = f"{row} of {name!r}" if row_name is None else row_name(row)
        raise ValueError(
            f"colour {where} is {array[row].tolist()}, expected 0 to 1; divide by the largest value, or give uint8 of "
            "0 to 255"
        )
    return colours


def joined(given: Any, counts: tuple[int, int | None]) -> npt.NDArray[Any]:
    """An array of the given data; a list of arrays, one for each line, becomes one."""
    arrays = isinstance(given, Sequence) and not isinstance(given, bytes) and any(np.ndim(part) for part in given)
    if not arrays:
        return np.asarray(given)
    sizes = {np.shape(part) for part in given}
    # A list with a row of three or four numbers for each point or line, rather than the arrays of lines.
    if len(given) in counts and sizes in ({(3,)}, {(4,)}) and counts[0] != sum(len(part) for part in given):
        return np.asarray(given)
    return np.concatenate([np.asarray(part) for part in given if np.size(part)] or [np.zeros(0)])


def rows_of(given: Any, counts: tuple[int, int]) -> npt.NDArray[Any]:
    """The same of a list that may hold something else: vectors of lines, for instance, whose number is the second."""
    rows = joined(given, counts)
    if rows.shape[:1] in ((counts[0],), (counts[1],)):
        return rows
    try:
        return np.asarray(given)
    except ValueError:  # of arrays of other lengths than the lines
        return rows
