"""From whatever a user holds to spline tubes, and which of their numbers colour an actor."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from pvfiblets.formats.attachments import is_values_file
from pvfiblets.images.sources import as_image, is_image
from pvfiblets.lines import (
    Lines,
    SourceData,
    are_words,
    gather,
    has_name,
    names_of,
    read_lines,
    refuse_words,
    rows_of,
    with_values,
)
from pvfiblets.plotting.colours.same_names import Preference, with_preference
from pvfiblets.plotting.colours.scalars import (
    DIRECTIONS,
    NAME_ONE,
    UNNAMED,
    Numbers,
    Scalars,
    are_colours,
    direction_scalars,
    find_scalars,
    magnitudes,
    point_scalars,
)
from pvfiblets.tubes.build import as_spline_tubes
from pvfiblets.tubes.measures import ARC_LENGTH, RADIUS, node_slopes, tube_lengths, with_arc_length, with_radius
from pvfiblets.tubes.spline_tubes import NodeValues, SplineTubes

LENGTH = "length"
BUILT_IN = (*DIRECTIONS, RADIUS, ARC_LENGTH, LENGTH)

_GIVEN = "scalars"  # what as_spline_tubes calls an array without a name


def as_tubes(
    source: Any, *, scalars: Any = None, rgb: bool | None = None, preference: Preference = "point", **shape: Any
) -> tuple[SplineTubes, Any, SourceData]:
    """Return the tubes that a source means, what colours them, and all data of their nodes and lines."""
    if isinstance(source, SplineTubes):
        return *with_node_values(as_spline_tubes(source, **shape), scalars, rgb=rgb), SourceData()
    source = with_preference(read_lines(source), preference)
    if is_values_file(scalars, source):
        source, scalars = with_values(source, scalars)
    lines = gather(source)
    tubes, scalars = _made(source, lines, scalars, rgb, **shape)
    at_ids = np.array_equal(tubes.points, lines.points[lines.ids])
    return tubes, scalars, SourceData.of_lines(lines, source, lines.ids if at_ids else None)


def _made(source: Any, lines: Lines, scalars: Any, rgb: bool | None, **shape: Any) -> tuple[SplineTubes, Any]:
    """Return tubes around the lines of a source, and what colours them."""
    named = UNNAMED
    if is_image(scalars) and not (isinstance(scalars, str) and has_name(source, scalars)):
        scalars = as_image(scalars)
        named = scalars.name or "volume"
    elif isinstance(scalars, str) and not has_name(source, scalars):
        if scalars not in BUILT_IN:
            raise KeyError(_missing(scalars, **dict(zip(("per point", "per line"), names_of(source), strict=True))))
        if shape.pop("scalar_slopes", None) is not None:
            raise ValueError(f"scalar_slopes came with {scalars!r}, which has its own; leave them out")
        return as_spline_tubes(lines, **shape), scalars
    tubes = as_spline_tubes(lines, scalars=scalars, rgb=rgb, **shape)
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
        return with_radius(tubes)
    return with_arc_length(tubes) if scalars == ARC_LENGTH else tubes


def with_node_values(
    tubes: SplineTubes, scalars: Any, *, rgb: bool | None = None, data: SourceData | None = None
) -> tuple[SplineTubes, Any]:
    """Store ``scalars`` with the tubes if they are an array with a row for each node, or name one of their source."""
    # The slope at a node is the mean of those of the segments that meet there.
    if is_image(scalars) and not (isinstance(scalars, str) and scalars in {**tubes.values, **tubes.tube_values}):
        image = as_image(scalars)
        return _with_rows(tubes, image.name or "volume", image.at(tubes.points))
    known = {*tubes.values, *tubes.tube_values, *BUILT_IN}  # the radius is the drawn one, not the source's array
    if isinstance(scalars, str) and data is not None and scalars not in known:
        rows = data.per_point.get(scalars)
        if rows is not None and len(rows) == tubes.n_nodes:
            return _with_rows(tubes, scalars, rows.astype(np.float64))
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
    return replace(tubes, values={**tubes.values, name: NodeValues(rows, node_slopes(tubes, rows))}), name


def find_tube_scalars(tubes: SplineTubes, scalars: Any, data: SourceData) -> Scalars:
    """Find what ``scalars`` means for tubes."""
    numbers = Numbers(
        "tube", tubes.n_tubes, lambda name: _at_nodes(name, tubes), tubes.tube_values,
        {**direction_scalars(), LENGTH: lambda: tube_lengths(tubes)},
        lambda name: _missing(name, **{"at nodes": {**tubes.values, **data.per_point}, "per tube": tubes.tube_values})
        + f". {NAME_ONE}",
    )  # fmt: skip
    return find_scalars(numbers, scalars)


def _at_nodes(name: str, tubes: SplineTubes) -> Scalars | None:
    """Numbers at nodes have the nodes' own range, whatever the curves between them do."""
    if name not in tubes.values:
        return None
    values = tubes.values[name].values
    return point_scalars(
        name, values if values.ndim == 2 else values[np.bincount(tubes.segments.ravel(), minlength=tubes.n_nodes) > 0]
    )


def _rgba(colours: np.ndarray) -> np.ndarray:
    if colours.shape[1] not in (3, 4):
        raise ValueError(
            f"scalars have the shape {colours.shape}; colours (rgb=True) have 3 or 4 columns, of uint8 or from 0 to 1"
        )
    found = np.ones((len(colours), 4))
    found[:, : colours.shape[1]] = colours / (255.0 if colours.dtype == np.uint8 else 1.0)
    return found


def _missing(name: str, **groups: Any) -> str:
    """Say that there is no array ``name``, and which there are."""
    known = {**groups, "built in": BUILT_IN}
    listed = [f"{title}: {', '.join(map(repr, names)) or 'none'}" for title, names in known.items()]
    return f"there is no array {name!r} of numbers; {'; '.join(listed)}"
