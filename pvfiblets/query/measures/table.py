"""A row for each streamline: length, ends, groups and values."""

from __future__ import annotations

import csv
import html
import math
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from io import TextIOWrapper
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, TextIO

import numpy as np
import numpy.typing as npt

from ...images.image import Image
from ...images.sources import as_image
from ...streamlines import Streamlines
from ...support.whole_files import replacing
from .chunks import chunks_of, without_groups
from .measures import Curvatures
from .samples import PointWeights, along, check_weights

if TYPE_CHECKING:
    from ...codec.fibletset import FibletSet

PARQUET = (".parquet", ".pq")
_SHOWN = 10  # rows in a notebook
_MEAN = "mean_"  # of values along a streamline


class Table(dict[str, npt.NDArray[Any]]):
    """Columns of equal length by name: a dict of ``(n,)`` arrays.

    ``pandas.DataFrame(table)``, ``pyarrow.table(table)`` and ``polars.DataFrame(table)`` accept it directly.
    """

    @property
    def n_rows(self) -> int:
        """Number of rows."""
        return len(next(iter(self.values()), ()))

    def to_pandas(self) -> Any:
        """Return a ``pandas.DataFrame`` of the same columns; needs pandas."""
        import pandas as pd

        return pd.DataFrame(self)

    def to_arrow(self) -> Any:
        """Return a ``pyarrow.Table`` of the same columns; needs pyarrow."""
        import pyarrow as pa

        return pa.table(dict(self))

    def save(self, path: str | PathLike[str]) -> None:
        """Write the table to a file, in the format of its suffix.

        Parameters
        ----------
        path : str or PathLike
            ``.tsv``: separated by tabs. ``.parquet``: Apache Parquet. Any other suffix: separated by commas; ``-``
            writes this to standard output. Text files start with a line of names; missing numbers are empty.

        Raises
        ------
        ImportError
            If the suffix is ``.parquet`` and pyarrow is not installed.
        OSError
            If the file cannot be written.
        """
        target = None if str(path) == "-" else Path(path).expanduser()
        suffix = "" if target is None else target.suffix.lower()
        if suffix in PARQUET and target is not None:
            self._save_parquet(target)
            return
        columns = [_texts(column) for column in self.values()]
        with _text(target) as to:
            writer = csv.writer(to, lineterminator="\n", delimiter="\t" if suffix == ".tsv" else ",")
            writer.writerow(self)
            writer.writerows(zip(*columns, strict=True))

    def _save_parquet(self, target: Path) -> None:
        check_parquet(target)
        import pyarrow as pa
        from pyarrow import parquet

        with replacing(target) as file:
            parquet.write_table(pa.table(dict(self)), file)

    def _repr_html_(self) -> str:
        heads = "".join(f"<th>{html.escape(name)}</th>" for name in self)
        columns = [_texts(column[:_SHOWN]) for column in self.values()]
        rows = "".join(
            f"<tr>{''.join(f'<td>{html.escape(cell)}</td>' for cell in row)}</tr>" for row in zip(*columns, strict=True)
        )
        noun = "streamlines" if "streamline" in self else "rows"
        return f"<table><tr>{heads}</tr>{rows}</table><p>{self.n_rows:,} {noun}</p>"


@contextmanager
def _text(target: Path | None) -> Iterator[TextIO]:
    """A file for text, which appears when it is whole; or standard output."""
    if target is None:
        yield sys.stdout
        return
    with replacing(target) as file:
        text = TextIOWrapper(file, encoding="utf-8", newline="")
        yield text
        text.flush()
        text.detach()  # the caller closes the file


def check_parquet(path: str | PathLike[str]) -> None:
    """Raise an ImportError, before any work is done, if a file is to be Parquet and pyarrow is not installed."""
    if Path(path).suffix.lower() not in PARQUET:
        return
    try:
        import pyarrow.parquet  # noqa: F401
    except ImportError as error:
        raise ImportError(
            f"{path} needs pyarrow, which is not installed; run `pip install pyarrow`, or write a .csv or .tsv file"
        ) from error


def table(
    data: FibletSet | Streamlines,
    ids: npt.ArrayLike | slice | None = None,
    *,
    images: Mapping[str, Any] | None = None,
    weights: PointWeights = "length",
) -> Table:
    """Return a table with a row for each streamline.

    Parameters
    ----------
    data : FibletSet or Streamlines
    ids : array_like or slice, optional
        Streamlines, as for :meth:`.FibletSet.decompress`; all by default. A repeated index has one row.
    images : mapping of str to image, optional
        Images whose mean along each streamline is a column ``mean_NAME``: paths, ``(array, affine)``, of nibabel, or
        ImageData.
    weights : {'length', 'points'}
        Weights of points in means along streamlines; see :func:`pvfiblets.sample`.

    Returns
    -------
    Table
        Columns ``streamline`` (its number), ``n_points``, ``length``, ``end_distance`` (mm) and ``mean_curvature``
        (1/mm) as `pvfiblets.query.measures.measures` has them; ``start_x`` to ``end_z``, its first and last point
        (mm; NaN
        without points); ``groups``, the names of its groups, with a semicolon between, if there are any
        groups; every per-streamline array; and the mean along the streamline of every per-point array and image,
        ``mean_NAME``, NaN where no point has a value. Arrays of several columns are ``NAME[0]``, ``NAME[1]`` and so on.

    Raises
    ------
    IndexError
        If a number is out of range or a mask has the wrong length.
    TypeError, ValueError
        If an image is none or has several numbers per voxel, or `weights` is unknown.
    """
    from ...codec.decompress import select_streamlines

    check_weights(weights)
    known = {name: as_image(image, f"the image {name!r}") for name, image in (images or {}).items()}
    curvatures, numbers = Curvatures(data), np.arange(len(data))
    if ids is not None:
        chosen = select_streamlines(len(data), ids)
        numbers = chosen[np.sort(np.unique(chosen, return_index=True)[1])]
        data = data[numbers]
    bare = without_groups(data)
    with curvatures:
        parts = [_measured(chunk, curvatures, known, weights) for chunk in chunks_of(bare)]
        parts = parts or [_measured(_decoded(bare), curvatures, known, weights)]
    found = Table(streamline=numbers, **{name: np.concatenate([part[name] for part in parts]) for name in parts[0]})
    if data.groups:
        found["groups"] = _groups(data)
    for name, rows in data.per_streamline.items():
        found |= _columns(name, np.asarray(rows).reshape(len(data), *_width(rows)))
    means = [name for name in found if name.startswith(_MEAN) and name != "mean_curvature"]
    return Table(found | {name: found.pop(name) for name in means})


def _decoded(data: FibletSet | Streamlines) -> Streamlines:
    return data if isinstance(data, Streamlines) else data.decompress()


def _measured(
    chunk: Streamlines, curvatures: Curvatures, images: Mapping[str, Image], weights: PointWeights
) -> dict[str, npt.NDArray[Any]]:
    """All columns that come from points."""
    points = np.asarray(chunk.points, np.float64)
    there, curvature = np.flatnonzero(chunk.counts), np.full(len(chunk), np.nan)
    ends = np.full((len(chunk), 2, 3), np.nan)
    if len(there):
        ends[there, 0], ends[there, 1] = points[chunk.offsets[:-1][there]], points[chunk.offsets[1:][there] - 1]
        curvature[there] = curvatures.means(points, chunk.offsets)[there]
    found = {
        "n_points": chunk.counts,
        "length": chunk.lengths(),
        "end_distance": np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1),
        "mean_curvature": curvature,
    }
    for place, corner in enumerate(("start", "end")):
        found |= {f"{corner}_{axis}": ends[:, place, i] for i, axis in enumerate("xyz")}
    sampled = {name: image.at(points, nearest=image.is_labels) for name, image in images.items()}
    for name, values in (chunk.per_point | sampled).items():
        rows = np.asarray(values, np.float64).reshape(len(points), *_width(values))
        means = [along(column, chunk, "mean", weights) for column in rows.T]
        found |= _columns(_MEAN + name, np.stack(means, axis=1))
    return found


def _width(rows: Any) -> tuple[int]:
    """Return the number of columns of an array with a row for each thing, which may be none."""
    return (math.prod(np.shape(rows)[1:]),)


def _columns(name: str, rows: npt.NDArray[Any]) -> dict[str, npt.NDArray[Any]]:
    one = rows.shape[1] == 1
    return {name if one else f"{name}[{k}]": rows[:, k] for k in range(rows.shape[1])}


def _groups(data: FibletSet | Streamlines) -> npt.NDArray[Any]:
    names: list[list[str]] = [[] for _ in range(len(data))]
    for name, members in data.groups.items():
        for row in np.unique(np.asarray(members, np.int64)).tolist():
            names[row].append(name)
    return np.array([";".join(row) for row in names], dtype=str)


def _texts(column: npt.NDArray[Any]) -> list[str]:
    """Cells as text: the fewest digits that give the same number again, nothing for NaN."""
    return ["" if isinstance(value, float) and math.isnan(value) else str(value) for value in column.tolist()]
