"""Spline tubes as criteria and conditions find them: nodes along each tube, and its curve in space."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets.plotting.filtering.line_subject import Parts
from pvfiblets.query.selection.point_flags import ALL, ANY
from pvfiblets.streamlines import Streamlines
from pvfiblets.support.ragged import offsets_from_counts
from pvfiblets.tubes.measures import ARC_LENGTH, RADIUS, segment_lengths

if TYPE_CHECKING:
    from pvfiblets.lines import SourceData
    from pvfiblets.mappers.line_data import LineData
    from pvfiblets.query.measures.measures import Values
    from pvfiblets.query.selection.point_flags import Sampling
    from pvfiblets.regions import Region
    from pvfiblets.tubes.spline_tubes import SplineTubes

_ALL_OF_THEM = 1 << 60


def tube_parts(tubes: SplineTubes, data: SourceData) -> Parts:
    """Return the lines through the nodes of tubes, each tube's one run of segments after the other."""
    order = np.argsort(tubes.tubes, kind="stable")
    (start, stop), owners = tubes.segments[order].T, tubes.tubes[order]
    begins = np.ones(len(order), bool)
    begins[1:] = (start[1:] != stop[:-1]) | (owners[1:] != owners[:-1])
    counts = begins + (start != stop).astype(np.int64)  # a ball has one point
    last = np.cumsum(counts) - 1
    first = last - (start != stop)
    rows = np.empty(int(counts.sum()), np.int64)
    rows[first], rows[last] = start, stop
    ends = np.empty((len(order), 2), np.int64)
    ends[order] = np.stack([first, last], axis=1)
    points_of_tubes = np.bincount(owners, counts, tubes.n_tubes).astype(np.int64)
    numbers = {name: held.values for name, held in tubes.values.items() if not held.is_colour}
    per_point = {**_fitting(data.per_point, tubes.n_nodes), RADIUS: tubes.radius, **numbers}
    lines = Streamlines(
        tubes.points[rows],
        offsets_from_counts(points_of_tubes),
        {name: values[rows] for name, values in per_point.items()},
        {**_fitting(data.per_line, tubes.n_tubes), **tubes.tube_values},
        data.groups if all(np.max(ids, initial=-1) < tubes.n_tubes for ids in data.groups.values()) else {},
    )

    def measured(kind: Any, name: str) -> Values:
        from pvfiblets.query.measures.measures import Values

        lengths = segment_lengths(tubes)
        if kind == "streamline":
            return Values(kind, np.bincount(tubes.tubes, lengths, tubes.n_tubes), name, "mm")
        until = np.cumsum(lengths[order])
        before = until - lengths[order]
        base = before[np.searchsorted(owners, owners)]
        along = np.empty(len(rows))
        along[last], along[first] = until - base, before - base
        return Values(kind, along, name, "mm")

    return Parts(
        lines, ends, tubes.tubes, rows, tubes.n_nodes, _Flags(tubes, lines),
        {"length": lambda: measured("streamline", "length"), ARC_LENGTH: lambda: measured("point", ARC_LENGTH)},
    )  # fmt: skip


class _Flags:
    """How tubes lie to regions: by their curves in space, whatever their radius."""

    def __init__(self, tubes: SplineTubes, lines: Streamlines) -> None:
        self._tubes, self._lines = tubes, lines
        self._curves = cache(self._sampled)

    def __call__(self, region: Region, sampling: Sampling) -> np.ndarray:
        from pvfiblets.query.selection.line_flags import line_flags

        flags = line_flags(self._lines.points, self._lines.offsets, region, "points")
        if sampling == "points":
            return flags
        curves = self._curves()
        found, n = line_flags(curves.points, curves.offsets, region), self._tubes.n_tubes
        some = np.bincount(curves.ids, found & ANY != 0, n) > 0
        left_out = np.bincount(curves.ids, found & ALL == 0, n) > 0
        flags[some] |= ANY
        flags[left_out] &= np.uint8(~ALL & 0xFF)
        return flags

    def _sampled(self) -> LineData:
        from pvfiblets.mappers.drawn_lines import tube_lines

        return tube_lines(self._tubes, None, _ALL_OF_THEM)


def _fitting(arrays: Any, count: int) -> dict[str, Any]:
    return {name: array for name, array in arrays.items() if len(array) == count}
