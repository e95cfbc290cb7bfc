"""From whatever a user holds to lines and points with halos, and which of their numbers colour and filter them."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any, TypeAlias

import numpy as np

from pvfiblets.formats.attachments import is_values_file
from pvfiblets.halos import HaloLines, HaloPoints
from pvfiblets.halos.build import FILTER, SCALARS, as_halo_lines, as_halo_points
from pvfiblets.halos.measures import arc_lengths, line_lengths
from pvfiblets.images.sources import as_image, is_image
from pvfiblets.lines import SourceData, gather, has_name, read_lines, with_values
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
    point_scalars,
)
from pvfiblets.plotting.filtering.line_subject import Parts
from pvfiblets.plotting.filtering.state import unique_name
from pvfiblets.streamlines import Streamlines

ARC_LENGTH, LENGTH = "arc_length", "length"
BUILT_IN = (*DIRECTIONS, ARC_LENGTH, LENGTH)  # of lines. Points have nothing but what they were given.

Drawn: TypeAlias = HaloLines | HaloPoints


@dataclass(frozen=True)
class Held:
    """What an actor draws, with the numbers that colour and filter it; `source` has all that may be named besides."""

    drawn: Drawn
    scalars: Any = None
    filter_by: str | None = None
    line_values: Mapping[str, Any] = field(default_factory=dict)
    source: SourceData = field(default_factory=SourceData)


def as_lines(
    source: Any,
    *,
    scalars: Any = None,
    rgb: bool | None = None,
    filter_by: Any = None,
    preference: Preference = "point",
) -> Held:
    """Return the lines that a source means, and what colours and filters them."""
    if isinstance(source, HaloLines):
        return filtered(coloured(Held(source), scalars, rgb=rgb), filter_by)
    source = with_preference(read_lines(source), preference)
    if is_values_file(scalars, source):
        source, scalars = with_values(source, scalars)
    if is_values_file(filter_by, source):
        source, filter_by = with_values(source, filter_by)
    stored, filters = (None if _later(source, what) else what for what in (scalars, filter_by))
    gathered = gather(source, "lines with halos", keep_single=True)
    try:
        lines, line_values = as_halo_lines(gathered, scalars=stored, rgb=rgb, filter_by=filters)
    except ValueError as error:
        raise _unknown(source, (stored, filters), error) from None
    data = SourceData.of_lines(gathered, source, gathered.ids)
    held = _named(Held(lines, stored, _filter_name(filters), line_values, data))
    if stored is not scalars:
        held = coloured(held, scalars)
    return held if filters is filter_by else filtered(held, filter_by)


def as_points(source: Any, *, scalars: Any = None, rgb: bool | None = None, filter_by: Any = None) -> Held:
    """Return the points that a source means, and what colours and filters them."""
    if isinstance(source, HaloPoints):
        return filtered(coloured(Held(source), scalars, rgb=rgb), filter_by)
    source = read_points(source)
    stored, filters = (None if _is_image(source, what) else what for what in (scalars, filter_by))
    try:
        points = as_halo_points(source, scalars=stored, rgb=rgb, filter_by=filters)
    except ValueError as error:
        raise _unknown(source, (stored, filters), error) from None
    held = _named(Held(points, stored, _filter_name(filters)))
    held = held if stored is scalars else coloured(held, scalars)
    return held if filters is filter_by else filtered(held, filter_by)


def read_points(source: Any) -> Any:
    """Return the data of a file of PyVista's; anything else as it is."""
    if not isinstance(source, (str, os.PathLike)):
        return source
    from pvfiblets.plotting.meshes import read_mesh

    return read_mesh(source)


def coloured(held: Held, scalars: Any, *, rgb: bool | None = None) -> Held:
    """Have something else colour what is held; numbers at points are stored with it."""
    held, scalars = _sampled(held, scalars)
    drawn = held.drawn
    if scalars is None or isinstance(scalars, str):
        if isinstance(scalars, str) and scalars == ARC_LENGTH and isinstance(drawn, HaloLines):
            drawn = _with_arc_length(drawn)
        return replace(held, drawn=drawn, scalars=scalars)
    if rgb is None and _columns(scalars) > 1:
        rgb = are_colours(np.concatenate([np.reshape(part, (-1, _columns(scalars))) for part in scalars]), None)
    if isinstance(drawn, HaloPoints):
        return _named(replace(held, drawn=as_halo_points(drawn, scalars=scalars, rgb=rgb), scalars=scalars))
    lines, line_values = as_halo_lines(drawn, scalars=scalars, rgb=rgb)
    return _named(replace(held, drawn=lines, scalars=scalars, line_values={**held.line_values, **line_values}))


def filtered(held: Held, filter_by: Any) -> Held:
    """Have something else filter what is held; its numbers are stored with it, a row for each point."""
    held, filter_by = _sampled(held, filter_by)
    drawn = held.drawn
    if filter_by is None:
        return replace(held, filter_by=None)
    if not isinstance(filter_by, str):
        if isinstance(drawn, HaloPoints):
            return replace(held, drawn=as_halo_points(drawn, filter_by=filter_by), filter_by=FILTER)
        return replace(held, drawn=as_halo_lines(drawn, filter_by=filter_by).lines, filter_by=FILTER)
    if filter_by in drawn.values:
        if drawn.values[filter_by].ndim > 1:
            raise ValueError(f"filter_by is {filter_by!r}, which are colours; name numbers, or give an array of them")
        return replace(held, filter_by=filter_by)
    if isinstance(drawn, HaloLines) and filter_by in held.line_values:
        return replace(held, drawn=_with(drawn, filter_by, held.line_values[filter_by]), filter_by=filter_by)
    if isinstance(drawn, HaloLines) and filter_by == ARC_LENGTH:
        return replace(held, drawn=_with_arc_length(drawn), filter_by=filter_by)
    if isinstance(drawn, HaloLines) and filter_by == LENGTH:
        return replace(held, drawn=_with(drawn, LENGTH, line_lengths(drawn)), filter_by=filter_by)
    raise KeyError(_missing("filter_by", filter_by, held))


def halo_parts(held: Held) -> Parts:
    """Return lines as criteria and conditions find them; points are lines of one point each."""
    drawn = held.drawn
    if isinstance(drawn, HaloPoints):
        ids = np.arange(drawn.n_points)
        points = Streamlines(drawn.points, np.arange(drawn.n_points + 1), drawn.values)
        return Parts(points, np.stack([ids, ids], axis=1), ids)
    starts = drawn.segment_starts
    lines = Streamlines(
        drawn.points,
        drawn.offsets,
        {**held.source.per_point, **drawn.values},
        {**held.source.per_line, **held.line_values},
        held.source.groups,
    )
    owners = np.repeat(np.arange(drawn.n_lines), np.diff(drawn.offsets))[starts]
    return Parts(lines, np.stack([starts, starts + 1], axis=1), owners)


def find_halo_scalars(held: Held) -> Scalars | None:
    """Find the numbers or colours by which something is coloured."""
    choice, drawn = held.scalars, held.drawn
    if choice is None:
        return None
    built_in: dict[str, Any] = {}
    if isinstance(drawn, HaloLines):
        built_in = {**direction_scalars(), LENGTH: lambda: line_lengths(drawn)}

    def at_points(name: str) -> Scalars | None:
        return point_scalars(name, drawn.values[name]) if name in drawn.values else None

    count, missing = drawn.n_streamlines, partial(_missing, "scalars", held=held)
    return find_scalars(Numbers("line", count, at_points, held.line_values, built_in, missing), choice)


def _with_arc_length(lines: HaloLines) -> HaloLines:
    if ARC_LENGTH in lines.values:
        return lines
    return replace(lines, values={**lines.values, ARC_LENGTH: arc_lengths(lines)})


def _with(lines: HaloLines, name: str, numbers: np.ndarray) -> HaloLines:
    """Lines with one more number for each of their points, the same all along a line."""
    if numbers.ndim > 1:
        raise ValueError(f"filter_by is {name!r}, which are colours; name numbers, or give an array of them")
    return replace(lines, values={**lines.values, name: np.repeat(numbers, np.diff(lines.offsets))})


def _columns(scalars: Any) -> int:
    """Numbers in a row of an array, or of the first of several arrays."""
    if isinstance(scalars, (list, tuple)) and len(scalars) and np.ndim(scalars[0]) == 2:
        return np.shape(scalars[0])[1]
    try:
        shape = np.shape(scalars)
    except ValueError:  # arrays of unlike lengths, each with a number in each row
        return 1
    return shape[1] if len(shape) == 2 else 1


def _named(held: Held) -> Held:
    """Call numbers that came without a name what scalar bars call such; those of lines stay the array that they are."""
    if held.scalars is None or isinstance(held.scalars, str):
        return held
    line_values = dict(held.line_values)
    if SCALARS in line_values:
        return replace(held, scalars=line_values.pop(SCALARS), line_values=line_values)
    values = dict(held.drawn.values)
    values[UNNAMED] = values.pop(SCALARS)
    return replace(held, drawn=replace(held.drawn, values=values), scalars=UNNAMED)


def _filter_name(filter_by: Any) -> str | None:
    return filter_by if filter_by is None or isinstance(filter_by, str) else FILTER


def _later(source: Any, what: Any) -> bool:
    """Whether numbers are computed of lines once these are there: by a name that no data has, or of an image."""
    return _is_image(source, what) or (isinstance(what, str) and what in BUILT_IN and not has_name(source, what))


def _is_image(source: Any, what: Any) -> bool:
    return is_image(what) and not (isinstance(what, str) and has_name(source, what))


def _sampled(held: Held, what: Any) -> tuple[Held, Any]:
    """Store numbers of the source, or of an image at the points, and return their name; all else stays as it is."""
    drawn, source = held.drawn, held.source
    if isinstance(what, str):
        if what in drawn.values or what in held.line_values:
            return held, what
        if what in source.per_point:
            return replace(held, drawn=replace(drawn, values={**drawn.values, what: source.per_point[what]})), what
        if what in source.per_line:
            return replace(held, line_values={**held.line_values, what: source.per_line[what]}), what
    if not is_image(what):
        return held, what
    image = as_image(what)
    values, name = image.at(drawn.points), image.name or "volume"
    there = drawn.values.get(name)
    if there is not None and not np.array_equal(there, values, equal_nan=there.dtype.kind == "f"):
        name = unique_name(drawn.values, name)
    return replace(held, drawn=replace(drawn, values={**drawn.values, name: values})), name


def _unknown(source: Any, names: tuple[Any, Any], error: ValueError) -> Exception:
    """Return the error of a name that is not there as PyVista has it; any other as it is."""
    if any(isinstance(name, str) and not has_name(source, name) for name in names):
        return KeyError(str(error))
    return error


def _missing(what: str, name: str, held: Held) -> str:
    """Say that there are no numbers ``name``, and which there are."""
    known: dict[str, Any] = {"at points": {**held.drawn.values, **held.source.per_point}}
    if isinstance(held.drawn, HaloLines):
        per_line = {**held.line_values, **held.source.per_line}
        known |= {"per line": per_line, "built in": BUILT_IN if what == "scalars" else (ARC_LENGTH, LENGTH)}
    listed = [f"{title}: {', '.join(map(repr, names)) or 'none'}" for title, names in known.items()]
    return f"{what} is {name!r}, and there are no such numbers; {'; '.join(listed)}. {NAME_ONE}"
