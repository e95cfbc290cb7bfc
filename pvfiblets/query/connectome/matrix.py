"""Connectomes: how strongly the parcels of an atlas are connected, as a matrix that knows its streamlines.

A streamline connects the parcels of its two ends. The parcel of an end is that of the nearest centre of a labelled
voxel within a radius, as MRtrix's ``tck2connectome -assignment_radial_search`` has it, or with a radius of 0 that of
the voxel in which it lies (``-assignment_end_voxels``). An end without a parcel has number 0, and its streamline no
place in the matrix.

Source: Smith, Tournier, Calamante and Connelly, "The effects of SIFT on the reproducibility and biological accuracy of
the structural connectome", NeuroImage 104 (2015), section 2.3, for the search about the ends.
"""

from __future__ import annotations

import csv
import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ...codec.progress import Progress
from ...errors import FormatError
from ...images.sources import as_image, is_image
from ...support.progress_bar import progress_bar
from ...support.real_numbers import real_numbers
from ..measures.measures import measure
from ..selection.endpoints import end_points

if TYPE_CHECKING:
    from ...codec.fibletset import FibletSet
    from ...images.image import Image
    from ...streamlines import Streamlines

STATISTICS = ("sum", "mean", "min", "max")  # statistics that turn the numbers of one pair's streamlines into one
SUFFIXES = (".csv", ".tsv", ".txt", ".npy")  # suffixes of files that a connectome is written to, and read from
MOST_VOXELS = 1 << 20  # voxels that may be looked at about an end
TOGETHER = 1 << 18  # ends that are given their parcels together

Ints = npt.NDArray[np.int64]
Floats = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Connectome:
    """A matrix of parcels by parcels, and the streamlines behind it.

    Attributes
    ----------
    matrix : numpy.ndarray
        ``(n, n)`` float64, symmetric: row and column ``p`` belong to parcel ``labels[p]``. The diagonal holds
        streamlines with both ends in one parcel. Means, minima and maxima are NaN for pairs without streamlines.
    counts : numpy.ndarray
        ``(n, n)`` int64: number of streamlines of each pair.
    labels : numpy.ndarray
        ``(n,)`` int64, the labels of the atlas, rising.
    names : list of str
        Names of the parcels.
    ends : numpy.ndarray
        ``(n_streamlines, 2)`` int64: labels of the first and last point, 0 for none.
    contrast, statistic : str
        The value of each streamline, and how the values of a pair were combined.
    radius : float
        Search radius of the ends, mm.
    """

    matrix: Floats
    counts: Ints
    labels: Ints
    names: list[str]
    ends: Ints
    contrast: str
    statistic: str
    radius: float

    def __repr__(self) -> str:
        n = len(self.labels)
        return (
            f"Connectome({self.contrast}, {self.statistic}: {n} x {n} parcels, {self.n_connecting:,} of "
            f"{len(self.ends):,} streamlines connect two)"
        )

    @property
    def n_connecting(self) -> int:
        """Streamlines both of whose ends have a parcel."""
        return int((self.ends != 0).all(axis=1).sum())

    def index(self, parcel: int | str) -> int:
        """Return the row of a parcel.

        Parameters
        ----------
        parcel : int or str
            Its label, or its name.

        Raises
        ------
        KeyError
            If no parcel, or more than one, has that name or label.
        """
        if isinstance(parcel, str):
            rows = [row for row, name in enumerate(self.names) if name == parcel]
        else:
            rows = np.flatnonzero(self.labels == int(parcel)).tolist()
        if len(rows) != 1:
            many = f"{len(rows)} parcels are" if rows else "no parcel is"
            raise KeyError(f"{many} called {parcel!r}; there are {', '.join(self.names[:12])}"
                           + (", ..." if len(self.names) > 12 else ""))  # fmt: skip
        return int(rows[0])

    def streamlines(self, first: int | str, second: int | str | None = None) -> Ints:
        """Return the streamlines that connect two parcels, or one with any.

        Parameters
        ----------
        first, second : int or str
            Labels or names, in any order. Without `second`, all streamlines with an end in the first.

        Returns
        -------
        numpy.ndarray
            ``(m,)`` int64 numbers of streamlines, for ``fiblets[ids]`` or ``actor.select``.

        Raises
        ------
        KeyError
            If there is no such parcel.
        """
        one = self.labels[self.index(first)]
        if second is None:
            return np.flatnonzero((self.ends == one).any(axis=1))
        pair = np.sort([one, self.labels[self.index(second)]])
        return np.flatnonzero((np.sort(self.ends, axis=1) == pair).all(axis=1))

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the matrix.

        Parameters
        ----------
        path : str or PathLike
            ``.csv`` or ``.tsv``: names in the first row and column, missing numbers empty. ``.txt``: numbers separated
            by spaces, as for MRtrix. ``.npy``. The last two hold missing numbers as NaN.

        Raises
        ------
        ValueError
            If the suffix is unknown.
        OSError
            If the file cannot be written.
        """
        from ...support.whole_files import replacing

        target = Path(path).expanduser()
        suffix = check_target(target)
        with replacing(target) as file:
            if suffix == ".npy":
                np.save(file, self.matrix)
            elif suffix == ".txt":
                np.savetxt(file, self.matrix, fmt="%.10g")
            else:
                import io

                text = io.StringIO(newline="")
                writer = csv.writer(text, delimiter="," if suffix == ".csv" else "\t", lineterminator="\n")
                writer.writerow(["", *self.names])
                for name, row in zip(self.names, self.matrix.tolist(), strict=True):
                    writer.writerow([name, *("" if np.isnan(value) else f"{value:.10g}" for value in row)])
                file.write(text.getvalue().encode())


def read_matrix(path: str | os.PathLike[str]) -> tuple[Floats, list[str] | None]:
    """Return the numbers of a matrix's file, of :meth:`Connectome.save` or MRtrix, and names that it has of parcels."""
    source = Path(path).expanduser()
    suffix = check_target(source)
    if suffix == ".npy":
        from ...formats.attachments import read_rows

        return np.asarray(read_rows(str(source), suffix), np.float64), None
    text = source.read_text(encoding="utf-8", errors="replace")
    lines = [line for line in text.splitlines() if line.strip() and line.lstrip()[0] != "#"]
    marks = "\t" if suffix == ".tsv" else ",;\t"
    mark = next((mark for mark in marks if lines and mark in lines[0]), None)
    rows = [line.split() for line in lines] if mark is None else list(csv.reader(lines, delimiter=mark))
    names = None
    if rows and (not rows[0][0].strip() or not all(map(_is_number, rows[0]))):
        names, *rows = rows
        if rows and len(rows[0]) == len(rows) + 1:  # their first column has the names again
            names, rows = names[len(names) - len(rows) :], [row[1:] for row in rows]
    if not rows or {len(row) for row in rows} != {len(rows[0])}:
        widths = sorted({len(row) for row in rows})
        raise FormatError(source, None, f"rows of {widths} numbers", "a matrix, all rows of the same length")
    bad = next((cell for row in rows for cell in row if not _is_number(cell)), None)
    if bad is not None:
        raise FormatError(source, None, repr(bad), "a number, or an empty cell")
    return np.array([[float(cell) if cell.strip() else np.nan for cell in row] for row in rows]), names


def _is_number(cell: str) -> bool:
    try:
        float(cell.strip() or "nan")
    except ValueError:
        return False
    return True


def check_target(path: str | os.PathLike[str]) -> str:
    """Return the suffix of a file to be written."""
    suffix = Path(path).suffix.lower()
    if suffix not in SUFFIXES:
        raise ValueError(f"{path} has no suffix of a matrix; use one of {', '.join(SUFFIXES)}")
    return suffix


def connectome(
    data: FibletSet | Streamlines | str | os.PathLike[str],
    labels: Any,
    *,
    weights: str | npt.ArrayLike | None = None,
    contrast: Any = "count",
    radius: float = 4.0,
    statistic: str | None = None,
    names: Mapping[int, str] | None = None,
    ends: npt.ArrayLike | None = None,
    progress: Progress = False,
) -> Connectome:
    """Compute a connectivity matrix: one number for each pair of parcels.

    Parameters
    ----------
    data : FibletSet, Streamlines, str or PathLike
        The tractogram. Only the last fiblet of each streamline is decoded, unless `contrast` needs more.
    labels : image
        Whole numbers ``(i, j, k)``, 0 for no parcel: a path, an image of nibabel, ``(array, affine)`` or an ImageData.
    weights : str or array_like, optional
        ``(n_streamlines,)`` finite numbers of 0 or more, such as SIFT2's, or the name of a per-streamline array.
    contrast : str, array_like or image, default: 'count'
        Value of each streamline. ``'count'``: 1. ``'length'`` (mm), another measure or a stored array by name, an
        image, or ``(n_streamlines,)`` numbers. Images and arrays per point are averaged along the streamline, as by
        :func:`pvfiblets.sample`. Streamlines with the value NaN are skipped.
    radius : float, default: 4.0
        Search radius around each end for a parcel, mm; 0 for the end's own voxel.
    statistic : {'sum', 'mean', 'min', 'max'}, optional
        Combines the values of a pair; by default ``'sum'`` for ``'count'`` and ``'mean'`` for others. Sums and means
        are weighted.
    names : mapping of int to str, optional
        Names of the parcels; others are named by their number.
    ends : array_like, optional
        ``(n_streamlines, 2)`` labels of the ends, such as the ``ends`` of another matrix of these labels and this
        radius; computed by default.
    progress : bool or callable
        Show a progress bar; or call this with the name of the step and its finished share, from 0 to 1.

    Returns
    -------
    Connectome

    Raises
    ------
    FormatError
        If a file is damaged.
    KeyError
        If there is no array of that name.
    TypeError
        If the labels are not an image.
    ValueError
        If the labels hold no parcel or fractions, the radius is no length or so large that more than a million voxels
        lie within it, there is no such statistic, or weights or numbers do not fit.
    """
    source = opened(data)
    atlas = as_image(labels, "the atlas")
    how = _statistic(statistic, counts=isinstance(contrast, str) and contrast == "count")
    ends = _given_ends(ends, source, atlas, radius, progress)
    found = np.unique(atlas.labels)
    known = found[found != 0].astype(np.int64)
    if not len(known):
        raise ValueError("the labels hold no parcel: every voxel is 0")
    n = len(ends)
    weight = np.ones(n) if weights is None else _numbers(source, weights, n, "weights")
    if not (np.isfinite(weight) & (weight >= 0.0)).all():
        raise ValueError("weights must be finite numbers of 0 or more")
    counting = isinstance(contrast, str) and contrast == "count"
    value = np.ones(n) if counting else _numbers(source, contrast, n, "contrast")
    used = (ends != 0).all(axis=1) & ~np.isnan(value)
    pair = np.sort(np.searchsorted(known, ends[used]), axis=1)
    matrix, counts = _put_together(pair, value[used], weight[used], len(known), how)
    called = {int(number): str(name) for number, name in (names or {}).items()}
    return Connectome(
        matrix, counts, known, [called.get(number, str(number)) for number in known.tolist()], ends,
        contrast if isinstance(contrast, str) else "own numbers", how, float(radius),
    )  # fmt: skip


def end_labels(data: FibletSet | Streamlines, labels: Any, radius: float = 4.0, *, progress: Progress = False) -> Ints:
    """Return the parcel of each end of each streamline."""
    from .connectome_kernels import nearest_labels

    atlas = as_image(labels, "the atlas")
    reach = float(radius)
    if not (np.isfinite(reach) and reach >= 0.0):
        raise ValueError(f"radius is {radius}; give mm, 0 or more")
    linear = np.ascontiguousarray(atlas.affine[:3, :3])
    slack = 0.5 * float(np.abs(linear).sum(axis=1) @ np.abs(linear).sum(axis=1)) ** 0.5  # of a voxel, at most
    offsets, distances = _offsets(linear, reach + slack if reach > 0.0 else 0.0)
    if callable(progress):
        progress("finding ends", 0.0)
    points = np.ascontiguousarray(end_points(data).reshape(-1, 3))
    found, voxels = np.zeros(len(points), np.int64), np.ascontiguousarray(atlas.labels, np.int64)
    with progress_bar(progress is True, total=len(points), desc="looking for parcels", unit="ends") as bar:
        for first in range(0, len(points), TOGETHER):
            if callable(progress):
                progress("looking for parcels", first / len(points))
            part = slice(first, first + TOGETHER)
            nearest_labels(
                points[part], voxels, atlas.inverse, linear, offsets, distances, slack, reach, found[part]
            )  # fmt: skip
            bar.update(len(points[part]))
    return found.reshape(-1, 2)


def _given_ends(given: Any, source: Any, atlas: Image, radius: float, progress: Progress) -> Ints:
    if given is None:
        return end_labels(source, atlas, radius, progress=progress)
    ends = np.asarray(given, np.int64)
    if ends.shape != (len(source), 2):
        raise ValueError(f"ends have the shape {ends.shape}; give two labels for each of {len(source):,} streamlines")
    if not np.isin(ends[ends != 0], atlas.labels).all():
        raise ValueError("ends have labels that the volume lacks; pass end_labels() of this volume")
    return ends


def _offsets(linear: Floats, reach: float) -> tuple[Ints, Floats]:
    """Return voxels about one by distance, and the distances, as far as some mm."""
    # Along an axis of the voxels a ball reaches as far as the rows of the inverse are long.
    most = np.floor(reach * np.linalg.norm(np.linalg.inv(linear), axis=1)).astype(np.int64)
    if np.prod(2.0 * most + 1.0) > MOST_VOXELS:
        raise ValueError(f"{np.prod(2.0 * most + 1.0):,.0f} voxels lie about an end; give a smaller radius")
    grid = np.stack(np.meshgrid(*(np.arange(-m, m + 1) for m in most), indexing="ij"), axis=-1).reshape(-1, 3)
    away = np.linalg.norm(grid @ linear.T, axis=1)
    order = np.argsort(away, kind="stable")
    order = order[away[order] <= reach]
    return np.ascontiguousarray(grid[order]), np.ascontiguousarray(away[order])


def opened(data: Any) -> Any:
    """Return data, or what a path of them leads to."""
    if not isinstance(data, (str, os.PathLike)):
        return data
    from ...codec.files.open_lines import open_lines

    return open_lines(Path(data).expanduser())


def _numbers(data: Any, given: Any, n: int, name: str) -> Floats:
    """Return a number for each streamline."""
    from ...streamlines import Streamlines
    from ..measures.samples import means_along, sample

    if is_image(given) and not (isinstance(given, str) and given in {**data.per_streamline, **data.per_point}):
        return sample(data, given, "mean")
    if not isinstance(given, str):
        values = real_numbers(given, name)
        if values.shape != (n,):
            raise ValueError(f"{name} have the shape {values.shape}; give one for each of {n:,} streamlines")
        return values
    if isinstance(data, Streamlines):
        from ..measures.table import table

        columns = table(data)
        for key in (given, f"mean_{given}"):
            if key in columns:
                return np.asarray(columns[key], np.float64)
        raise KeyError(f"there are no values {given!r}; there are {', '.join(columns)}")
    found = measure(data, given)
    values = np.asarray(found.array(), np.float64)
    return values if found.kind == "streamline" else means_along(data, values)


def _statistic(given: str | None, *, counts: bool) -> str:
    if given is None:
        return "sum" if counts else "mean"
    if given not in STATISTICS:
        raise ValueError(f"statistic is {given!r}; expected one of {', '.join(map(repr, STATISTICS))}")
    return given


def _put_together(pair: Ints, value: Floats, weight: Floats, n: int, how: str) -> tuple[Floats, Ints]:
    """Return the symmetric matrix and how many streamlines are behind each of its numbers."""
    cell = pair[:, 0] * n + pair[:, 1]
    counts = np.bincount(cell, minlength=n * n)
    if how == "sum":
        flat = np.bincount(cell, value * weight, n * n)
    elif how == "mean":
        weights = np.bincount(cell, weight, n * n)
        with np.errstate(invalid="ignore", divide="ignore"):
            flat = np.where(weights > 0.0, np.bincount(cell, value * weight, n * n) / weights, np.nan)
    else:
        flat = np.full(n * n, np.inf if how == "min" else -np.inf)
        (np.minimum if how == "min" else np.maximum).at(flat, cell, value)
        flat[counts == 0] = np.nan
    upper, many = flat.reshape(n, n), counts.reshape(n, n)
    return np.where(np.tri(n, k=-1, dtype=bool), upper.T, upper), np.where(np.tri(n, k=-1, dtype=bool), many.T, many)
