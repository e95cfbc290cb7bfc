"""Conversion of every source to a :class:`~pvfiblets.codec.FibletSet`."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from pvfiblets import formats
from pvfiblets.codec.editing.point_arrays import unit_colours, with_coded_values, with_point_colours
from pvfiblets.codec.editing.point_arrays import with_point_values as add_values
from pvfiblets.codec.fibletset import FibletSet
from pvfiblets.engine.fiblets.data.sampled_volume import VolumeSource
from pvfiblets.formats.attachments import is_values_file, name_of, values_for
from pvfiblets.images.sources import as_image, is_image
from pvfiblets.invalid_points import Invalid, valid_points
from pvfiblets.line_cells import NOT_LINES
from pvfiblets.lines import refuse_words, rows_of
from pvfiblets.other_libraries import EXPECTED, streamlines_of
from pvfiblets.plotting.colours.same_names import Preference, with_preference
from pvfiblets.plotting.colours.scalars import UNNAMED, are_colours, magnitudes
from pvfiblets.plotting.fiblets.scalars import refuse_unknown
from pvfiblets.query.measures.measures import Distance, measure
from pvfiblets.streamlines import Streamlines
from pvfiblets.support.addresses import path_of
from pvfiblets.support.summary import warn_of_losses

if TYPE_CHECKING:
    from pvfiblets.codec.encoding.compress import PerPoint

CODING_ERROR = "coding_error"
Colours: TypeAlias = str | np.ndarray | VolumeSource | Distance | None


def as_fiblets(
    source: Any,
    *,
    scalars: Any = None,
    per_point: PerPoint | Iterable[str] = "fit",
    max_error: float | None = None,
    progress: bool = False,
    rgb: bool | None = None,
    opacity: Any = None,
    preference: Preference = "point",
    **options: Any,
) -> tuple[FibletSet, Colours]:
    """Compress ``source`` unless it is compressed already."""
    volume = as_volume(scalars)
    scalars = scalars if volume is None else volume
    name = os.fspath(source) if isinstance(source, (str, os.PathLike)) else type(source).__name__
    known = source.dropped if isinstance(source, Streamlines) else {}
    if isinstance(source, (str, os.PathLike)):
        if os.fspath(source).lower().endswith(".fiblets"):
            source = FibletSet.open(source)
        else:
            source = formats.read(path_of(source), progress=progress)
    if isinstance(source, FibletSet):
        _warn_of_nothing(source)
        if max_error is not None or options:
            given = ", ".join(sorted([*options, *(["max_error"] if max_error is not None else [])]))
            raise ValueError(
                f"{given} cannot be applied: the source is compressed already. Give it where the source is compressed"
            )
        return with_point_values(with_preference(source, preference), scalars, rgb)
    streamlines = with_preference(as_streamlines(source), preference)
    _warn_of_nothing(streamlines)
    from pvfiblets.codec.encoding.compress import choose_per_point, compress  # compressed sources need no compiler

    if is_values_file(scalars, streamlines):
        formats.attach(streamlines, scalars)
        scalars = name_of(scalars)
    if isinstance(scalars, str):
        refuse_unknown(streamlines, scalars)
    arrays = per_point if isinstance(per_point, str) else tuple(per_point)
    keep = list(choose_per_point(streamlines, arrays, options.get("per_point_bits", 8)))
    if isinstance(opacity, str) and opacity in streamlines.per_point:
        keep.append(opacity)
    if isinstance(scalars, str):
        if scalars in streamlines.per_point:
            keep = _keep_named(streamlines, scalars, keep, rgb)
    elif scalars is not None and volume is None and not isinstance(scalars, Distance):
        scalars = rows_of(scalars, (streamlines.n_points, len(streamlines)))
        if scalars.shape[:1] == (streamlines.n_points,) and streamlines.n_points != len(streamlines):
            keep += _keep_unnamed(streamlines, scalars, rgb)
            scalars = UNNAMED
    chosen = options.pop("nan", None)
    nan: Invalid = "split" if chosen is None else chosen
    per_line = isinstance(scalars, np.ndarray) and len(scalars) == len(streamlines) and scalars.dtype.kind in "buif"
    if nan == "split" and per_line and not np.isfinite(streamlines.points).all():  # lines are cut, values follow
        streamlines.per_streamline = {**streamlines.per_streamline, UNNAMED: scalars}
        scalars = UNNAMED
    read_as = streamlines.dropped
    streamlines = valid_points(streamlines, nan)
    found = streamlines.dropped if chosen is None else read_as
    warn_of_losses(name, {reason: n for reason, n in found.items() if known.get(reason) != n}, stacklevel=6)
    fiblets = compress(
        streamlines,
        max_error=max_error,
        per_point=tuple(dict.fromkeys(keep)),
        nan=nan,
        progress=progress,
        **options,
    )
    if isinstance(scalars, str) and scalars == CODING_ERROR and CODING_ERROR not in fiblets.per_point:
        error = measure(fiblets, CODING_ERROR, original=streamlines)
        fiblets = with_coded_values(fiblets, CODING_ERROR, error.array())
    return with_point_values(fiblets, scalars) if isinstance(scalars, Distance) else (fiblets, scalars)


def as_volume(scalars: Any) -> VolumeSource | None:
    """Return the volume that ``scalars`` are; ``None`` if they are something else."""
    if isinstance(scalars, VolumeSource):
        return scalars
    if not is_image(scalars):
        return None
    image = as_image(scalars)
    return VolumeSource(image.single, image.affine, name=image.name or "volume")


def _keep_named(streamlines: Streamlines, name: str, keep: list[str], rgb: bool | None) -> list[str]:
    """Bring an array of points into the form that colours; return the names of all arrays to be kept."""
    vectors = np.asarray(streamlines.per_point[name])
    refuse_words(vectors, f"scalars {name!r}", per_line=False)
    if are_colours(vectors, _by_name(name, rgb)):
        return [other for other in keep if other != name] + _hold_colours(streamlines, name, vectors)
    if vectors.ndim == 1:
        return [*keep, name]
    columns = {f"{name}[{k}]": vectors[:, k] for k in range(vectors.shape[1]) if name in keep}
    streamlines.per_point = {**streamlines.per_point, **columns, name: numbers_of_points(name, vectors)}
    return [*keep, name, *columns]


def _keep_unnamed(streamlines: Streamlines, values: np.ndarray, rgb: bool | None) -> list[str]:
    """Hold rows of points under a name; return the names of arrays that they are kept as."""
    if are_colours(values, rgb):
        return _hold_colours(streamlines, UNNAMED, values)
    streamlines.per_point = {**streamlines.per_point, UNNAMED: numbers_of_points(UNNAMED, values)}
    return [UNNAMED]


def _warn_of_nothing(data: FibletSet | Streamlines) -> None:
    """Warn that an empty data set draws nothing."""
    if not data.n_points:
        what = "points" if len(data) else "streamlines"
        warnings.warn(f"the source holds no {what}: nothing is drawn", UserWarning, stacklevel=7)


def with_point_values(fiblets: FibletSet, scalars: Any, rgb: bool | None = None) -> tuple[FibletSet, Colours]:
    """Store ``scalars`` with the fiblets if they are an array per point, or a file of values."""
    volume = as_volume(scalars)
    if volume is not None:
        return fiblets, volume
    if is_values_file(scalars, fiblets):
        return with_values_of(fiblets, scalars, rgb), name_of(scalars)
    if scalars is None or isinstance(scalars, str):
        return fiblets, scalars
    if isinstance(scalars, Distance):
        if scalars.per == "streamline":
            return fiblets, scalars
        found = measure(fiblets, scalars)
        return with_coded_values(fiblets, found.name, found.array()), found.name
    values = rows_of(scalars, (fiblets.n_points, fiblets.n_streamlines))
    if values.shape[:1] != (fiblets.n_points,) or fiblets.n_points == fiblets.n_streamlines:
        return fiblets, values
    return _with_points(fiblets, UNNAMED, values, rgb), UNNAMED


def with_values_of(fiblets: FibletSet, path: str | os.PathLike[str], rgb: bool | None = None) -> FibletSet:
    """Return a set that shares the arrays of another one and has the values of a file more, under the file's name."""
    where, values = values_for(path, np.diff(fiblets.offsets()), fiblets.space)
    name = name_of(path)
    if where == "per_streamline":
        return replace(fiblets, per_streamline={**fiblets.per_streamline, name: values})
    return _with_points(fiblets, name, values, rgb)


def _with_points(fiblets: FibletSet, name: str, values: np.ndarray, rgb: bool | None) -> FibletSet:
    """Store numbers, vectors or colours of points."""
    if are_colours(values, _by_name(name, rgb)):
        return with_point_colours(fiblets, name, values)
    return add_values(fiblets, name, numbers_of_points(name, values))


def _hold_colours(streamlines: Streamlines, name: str, colours: np.ndarray) -> list[str]:
    """Store colours of points by their channels, and return the channels' names."""
    rows = unit_colours(name, colours)
    columns = {f"{name}[{k}]": rows[:, k] for k in range(rows.shape[1])}
    streamlines.per_point = {key: held for key, held in streamlines.per_point.items() if key != name} | columns
    return list(columns)


def _by_name(name: str, rgb: bool | None) -> bool | None:
    """Take what ends so for colours, as `add_mesh` does."""
    return True if rgb is None and name.endswith(("_rgb", "_rgba")) else rgb


def numbers_of_points(name: str, values: np.ndarray) -> np.ndarray:
    """Return one number per point: the values themselves, or the magnitude of vectors."""
    refuse_words(values, f"scalars {name!r}", per_line=False)
    return values if values.ndim == 1 else magnitudes(values)


def as_streamlines(source: Any) -> Streamlines:
    """Return streamlines from anything uncompressed that a user may hold."""
    if isinstance(source, Streamlines):
        return source[:]
    found = streamlines_of(source)
    if found is not None:
        cells = found.dropped.get(NOT_LINES, 0)
        if not len(found) and cells:
            raise ValueError(
                f"source is a {type(source).__name__} without lines, but with {cells:,} other cells (vertices, "
                "polygons); give it lines, such as extract_all_edges() makes, or draw it by add_mesh()"
            )
        return found
    if isinstance(source, np.ndarray) and source.ndim == 2:
        source = [source]
    if isinstance(source, Mapping):
        raise TypeError(f"source is a {type(source).__name__}; give its values as a list, one line each")
    if isinstance(source, (Sequence, Iterable)) and not isinstance(source, (str, bytes)):
        arrays = [np.asarray(line) for line in source]
        if arrays and all(line.shape == (3,) for line in arrays):  # the points of one line, as an array of them is
            arrays = [np.stack(arrays)]
        for index, line in enumerate(arrays):
            if line.ndim != 2 or line.shape[1] != 3:
                raise TypeError(f"item {index} of source has shape {line.shape}; expected (n, 3) points")
        return Streamlines.from_list(arrays)
    raise TypeError(f"source is a {type(source).__name__}; expected {EXPECTED}")
