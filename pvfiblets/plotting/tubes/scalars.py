"""From whatever a user holds to spline tubes, and which of their numbers colour an actor."""

from __future__ import annotations

import os
from dataclasses import replace
from typing import Any

import numpy as np

from pvfiblets.formats.attachments import is_values_file
from pvfiblets.images.sources import as_image, is_image
from pvfiblets.lines import are_words, refuse_words, rows_of, told_lines, with_values
from pvfiblets.plotting.fiblets.scalars import ORIENTATION, UNNAMED, Scalars, are_colours, magnitudes, of_streamlines
from pvfiblets.plotting.same_names import Preference, with_preference
from pvfiblets.tubes.build import as_spline_tubes
from pvfiblets.tubes.curves import controls, derivative
from pvfiblets.tubes.spline_tubes import NodeValues, SplineTubes

RADIUS, ARC_LENGTH, LENGTH = "radius", "arc_length", "length"
BUILT_IN = (ORIENTATION, RADIUS, ARC_LENGTH, LENGTH)

_GIVEN = "scalars"  # what as_spline_tubes calls an array without a name
_BLOCK = 1 << 15  # segments measured at a time
_GAUSS = ((0.5 - 0.15**0.5, 5 / 18), (0.5, 4 / 9), (0.5 + 0.15**0.5, 5 / 18))


def as_tubes(
    source: Any, *, scalars: Any = None, rgb: bool | None = None, preference: Preference = "point", **shape: Any
) -> tuple[SplineTubes, Any]:
    """Return the tubes that a source means, and what colours them."""
    if isinstance(source, SplineTubes):
        return with_node_values(as_spline_tubes(source, **shape), scalars, rgb=rgb)
    source = with_preference(_read(source), preference)
    if is_values_file(scalars, source):
        source, scalars = with_values(source, scalars)
    named = UNNAMED
    if is_image(scalars) and not (isinstance(scalars, str) and _has(source, scalars)):
        scalars = as_image(scalars)
        named = scalars.name or "volume"
    elif isinstance(scalars, str) and not _has(source, scalars):
        if scalars not in BUILT_IN:
            raise KeyError(_missing(scalars, **dict(zip(("per point", "per line"), _names(source), strict=True))))
        if shape.pop("scalar_slopes", None) is not None:
            raise ValueError(f"scalar_slopes came with {scalars!r}, which has its own; leave them out")
        return as_spline_tubes(source, **shape), scalars
    tubes = as_spline_tubes(source, scalars=scalars, rgb=rgb, **shape)
    if scalars is None or isinstance(scalars, str):
        return tubes, scalars
    if _GIVEN in tubes.values:
        return replace(tubes, values={named: tubes.values[_GIVEN]}), named
    rest = {name: values for name, values in tubes.tube_values.items() if name != _GIVEN}
    return replace(tubes, tube_values={**rest, UNNAMED: tubes.tube_values[_GIVEN]}), UNNAMED


def with_built_in(tubes: SplineTubes, scalars: Any) -> SplineTubes:
    """Return tubes that have numbers at nodes for ``"radius"`` or ``"arc_length"``, computed if that is the choice."""
    if not isinstance(scalars, str) or scalars in tubes.values or scalars in tubes.tube_values:
        return tubes
    if scalars == RADIUS:
        held = NodeValues(tubes.radius, tubes.radius_slopes)
        return replace(tubes, values={**tubes.values, RADIUS: held})
    return _with_arc_length(tubes) if scalars == ARC_LENGTH else tubes


def with_node_values(tubes: SplineTubes, scalars: Any, *, rgb: bool | None = None) -> tuple[SplineTubes, Any]:
    """Store ``scalars`` with the tubes if they are an array with a row for each node.

    Notes
    -----
    The slope at a node is the mean of those of the segments that meet there.
    """
    if is_image(scalars) and not (isinstance(scalars, str) and scalars in {**tubes.values, **tubes.tube_values}):
        image = as_image(scalars)
        return _with_rows(tubes, image.name or "volume", image.at(tubes.points))
    if scalars is None or isinstance(scalars, str):
        return tubes, scalars
    given = rows_of(scalars, (tubes.n_nodes, tubes.n_tubes))
    if given.ndim == 1 and len(given) in (tubes.n_nodes, tubes.n_tubes) and are_words(given):
        refuse_words(given, "scalars", len(given) == tubes.n_tubes)
        return tubes, given
    if given.ndim == 0 or len(given) not in (tubes.n_nodes, tubes.n_tubes) or given.dtype.kind not in "buif":
        raise ValueError(
            f"scalars have the shape {given.shape} and type {given.dtype}; expected a row of numbers for each of "
            f"{tubes.n_nodes} nodes or {tubes.n_tubes} tubes"
        )
    if len(given) != tubes.n_nodes:
        return tubes, given
    if given.ndim == 2 and given.shape[1] == 1:
        given = given[:, 0]
    if given.ndim == 2:
        given = _rgba(given) if are_colours(given, rgb) else magnitudes(given)
    return _with_rows(tubes, UNNAMED, given.astype(np.float64))


def _with_rows(tubes: SplineTubes, name: str, rows: np.ndarray) -> tuple[SplineTubes, str]:
    return replace(tubes, values={**tubes.values, name: NodeValues(rows, _slopes(tubes, rows))}), name


def find_tube_scalars(tubes: SplineTubes, scalars: Any) -> Scalars:
    """Find what ``scalars`` means for tubes."""
    if not isinstance(scalars, str):
        return of_streamlines(UNNAMED, scalars, tubes.n_tubes, whole="tube")
    if scalars in tubes.values:
        return _at_nodes(scalars, tubes)
    if scalars in tubes.tube_values:
        return of_streamlines(scalars, tubes.tube_values[scalars], tubes.n_tubes, whole="tube")
    if scalars == ORIENTATION:
        return Scalars(ORIENTATION, "orientation")
    if scalars == LENGTH:
        return of_streamlines(LENGTH, tube_lengths(tubes), tubes.n_tubes, whole="tube")
    raise KeyError(
        _missing(scalars, **{"at nodes": tubes.values, "per tube": tubes.tube_values})
        + ". Only what was asked for as scalars is kept at nodes: give an array, or add the tubes with it"
    )


def tube_lengths(tubes: SplineTubes) -> np.ndarray:
    """Return the length of each tube's centre line."""
    found: np.ndarray = np.bincount(tubes.tubes, _segment_lengths(tubes), tubes.n_tubes)
    return found


def _segment_lengths(tubes: SplineTubes) -> np.ndarray:
    """Lengths of centre lines, mm, by Gauss's rule of three points for each half of a segment."""
    lengths = np.zeros(tubes.n_segments)
    for first in range(0, tubes.n_segments, _BLOCK):
        some = np.arange(first, min(first + _BLOCK, tubes.n_segments))
        halves = controls(tubes, some)[..., :3]
        for place, weight in _GAUSS:
            lengths[some] += weight * np.linalg.norm(derivative(halves, place), axis=-1).sum(axis=1)
    return lengths


def _with_arc_length(tubes: SplineTubes) -> SplineTubes:
    """Tubes whose nodes say how far they are along their tube, in the order of its segments, mm.

    A node that is at two places at once, as one that tubes share or at which one closes, becomes a node for each.
    """
    order = np.argsort(tubes.tubes, kind="stable")
    until = np.cumsum(_segment_lengths(tubes)[order])
    begin = np.concatenate([np.zeros(1), until])[: len(until)]
    first = np.searchsorted(tubes.tubes[order], tubes.tubes[order])
    places = np.empty((tubes.n_segments, 2))
    places[order] = np.stack([begin, until], axis=1) - begin[first][:, None]
    ends, flat = tubes.segments.ravel(), places.ravel()
    rank = np.lexsort((flat, ends))
    new = np.ones(len(rank), bool)
    new[1:] = (np.diff(ends[rank]) != 0) | (np.diff(flat[rank]) != 0.0)
    along = np.zeros(tubes.n_nodes)
    along[ends] = flat
    if np.count_nonzero(new) > np.count_nonzero(np.bincount(ends, minlength=tubes.n_nodes)):
        nodes, along = ends[rank[new]], flat[rank[new]]
        segments = np.empty(len(rank), np.int64)
        segments[rank] = np.cumsum(new) - 1
        tubes = replace(
            tubes,
            points=tubes.points[nodes],
            segments=segments.reshape(-1, 2),
            radius=tubes.radius[nodes],
            tangents=tubes.tangents[nodes],
            radius_slopes=tubes.radius_slopes[nodes],
            values={key: NodeValues(held.values[nodes], held.slopes[nodes]) for key, held in tubes.values.items()},
        )
    held = NodeValues(along, np.linalg.norm(tubes.tangents, axis=1))
    return replace(tubes, values={**tubes.values, ARC_LENGTH: held})


def _at_nodes(name: str, tubes: SplineTubes) -> Scalars:
    """Numbers at nodes have the nodes' own range, whatever the curves between them do."""
    values = tubes.values[name].values
    if values.ndim == 2:
        return Scalars(name, "point_rgba", has_alpha=bool((values[:, 3] < 1.0).any()))
    values = values[np.bincount(tubes.segments.ravel(), minlength=tubes.n_nodes) > 0]
    finite = values[np.isfinite(values)]
    if not len(finite):
        return Scalars(name, "point_scalar")
    positive = finite[finite > 0.0]
    least = float(positive.min()) if len(positive) else 1e-6
    return Scalars(name, "point_scalar", None, (float(finite.min()), float(finite.max())), least)


def _rgba(colours: np.ndarray) -> np.ndarray:
    if colours.shape[1] not in (3, 4):
        raise ValueError(
            f"scalars have the shape {colours.shape}; colours (rgb=True) have 3 or 4 columns, of uint8 or from 0 to 1"
        )
    found = np.ones((len(colours), 4))
    found[:, : colours.shape[1]] = colours / (255.0 if colours.dtype == np.uint8 else 1.0)
    return found


def _slopes(tubes: SplineTubes, rows: np.ndarray) -> np.ndarray:
    """Slopes at nodes, by length or by segment as the tubes' tangents are; 0 where a value is none."""
    start, end = tubes.segments.T
    chords = tubes.lengths() if tubes.scaled else np.ones(tubes.n_segments)
    moving = (start != end) & (chords > 0.0)
    start, end, chords = start[moving], end[moving], chords[moving]
    flat = rows.reshape(len(rows), -1)
    with np.errstate(invalid="ignore", over="ignore"):
        steps = (flat[end] - flat[start]) / chords[:, None]
    steps[~np.isfinite(steps)] = 0.0
    ends = np.concatenate([start, end])
    count = np.maximum(np.bincount(ends, minlength=tubes.n_nodes), 1)
    found = [np.bincount(ends, np.tile(column, 2), tubes.n_nodes) / count for column in steps.T]
    return np.stack(found, axis=1).reshape(rows.shape)


def _read(source: Any) -> Any:
    """Return the data of a file, or of an object of another library; anything else as it is."""
    if not isinstance(source, (str, os.PathLike)):
        return told_lines(source)
    from pvfiblets.codec.files.open_lines import open_lines

    return open_lines(source)


def _names(source: Any) -> tuple[list[str], list[str]]:
    """Names of a source's data per point, and per line."""
    if hasattr(source, "GetPointData"):
        both = (source.GetPointData(), source.GetCellData())
        arrays = [[data.GetAbstractArray(i) for i in range(data.GetNumberOfArrays())] for data in both]
        per_point, per_line = ([a.GetName() for a in some if a is not None and a.GetName()] for some in arrays)
        return per_point, per_line
    return list(getattr(source, "per_point", ())), list(getattr(source, "per_streamline", ()))


def _has(source: Any, name: str) -> bool:
    """Whether a source has data of that name."""
    return any(name in names for names in _names(source))


def _missing(name: str, **groups: Any) -> str:
    """Say that there is no array ``name``, and which there are."""
    known = {**groups, "built in": BUILT_IN}
    listed = [f"{title}: {', '.join(map(repr, names)) or 'none'}" for title, names in known.items()]
    return f"there is no array {name!r} of numbers; {'; '.join(listed)}"
