"""Mappers' lines with the picture's colours: for exporters, pickers and views in browsers."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from pvfiblets.codec.editing.point_arrays import colour_columns, packed_colours
from pvfiblets.colour_modes import MODES
from pvfiblets.mappers.line_data import COLOURS, RADIUS, STEPS, LineData, segment_ids

if TYPE_CHECKING:
    from pvfiblets.codec.fibletset import FibletSet
    from pvfiblets.mappers.colouring import Colouring
    from pvfiblets.streamlines import Streamlines


def thinned(counts: npt.NDArray[Any], budget: int) -> npt.NDArray[np.int64]:
    """Return which lines to keep so that they have a number of points at most: evenly every second, third ..."""
    total, step = int(counts.sum()), 1
    kept = np.arange(len(counts))
    while total > budget and step <= len(counts):
        step = max(step + 1, int(np.ceil(step * total / max(budget, 1))))
        kept = np.arange(0, len(counts), step)
        total = int(counts[kept].sum())
    return kept if total <= budget else kept[:0]


# Fiblets ---------------------------------------------------------------------------------------------


def shown_streamlines(fiblets: FibletSet, filtering: Any) -> npt.NDArray[np.int64]:
    """Return the streamlines that a filter lets through, by number."""
    mask = None if filtering is None else filtering.streamlines
    return np.arange(fiblets.n_streamlines) if mask is None else np.flatnonzero(mask)


def shown_points(fiblets: FibletSet, filtering: Any) -> int:
    """Return how many points these have."""
    if filtering is None or filtering.streamlines is None:
        return fiblets.n_points
    return int(np.diff(fiblets.offsets())[filtering.streamlines].sum())


def near_ray(fiblets: FibletSet, filtering: Any, ray: Any, budget: int) -> npt.NDArray[np.int64]:
    """Return shown streamlines that may come near to a ray, the nearest ones where their points are too many."""
    from pvfiblets.query.selection.endpoints import anchor_points

    (start, stop), reach = ray
    owners = fiblets.fiblet_streamlines()
    anchors = anchor_points(fiblets, np.arange(fiblets.n_fiblets))
    # A fiblet lies within a sphere about the middle of its chord that is no larger than the largest.
    radius = np.full(len(anchors), 2.0 * fiblets.largest_radius)
    same = np.flatnonzero(owners[1:] == owners[:-1])
    chords = np.linalg.norm(anchors[same + 1] - anchors[same], axis=1)
    radius[same] = chords + np.asarray(fiblets.reach[same]) * fiblets.reach_scale
    along = stop - start
    share = np.clip((anchors - start) @ along / max(float(along @ along), 1e-300), 0.0, 1.0)
    gaps = np.linalg.norm(start + share[:, None] * along - anchors, axis=1) - radius
    nearest = np.full(fiblets.n_streamlines, np.inf)
    np.minimum.at(nearest, owners, gaps)
    shown = shown_streamlines(fiblets, filtering)
    near = shown[nearest[shown] <= reach]
    near = near[np.argsort(nearest[near], kind="stable")]
    fits = np.cumsum(np.diff(fiblets.offsets())[near]) <= budget
    return np.sort(near[fits])


def fiblet_lines(
    fiblets: FibletSet,
    colouring: Colouring | None,
    filtering: Any,
    ids: npt.NDArray[np.int64],
    *,
    ends: bool = False,
) -> LineData:
    """Return decoded streamlines, or their ends as lines of one point."""
    decoded = fiblets.decompress(ids)
    lines = LineData(decoded.points, decoded.offsets, np.asarray(ids, np.int64))
    lines = lines.with_columns(**{name: rows for name, rows in decoded.per_point.items() if rows.ndim == 1})
    lines = _coloured(lines, colouring, partial(_fiblet_values, lines, decoded), decoded.per_point)
    flags = None if filtering is None or filtering.points is None else point_flags(fiblets, filtering.points, ids)
    if ends:
        return lines.ends(flags)
    return lines if flags is None else lines.with_points(flags)


def _fiblet_values(lines: LineData, decoded: Streamlines, source: Any, *, colours: bool) -> npt.NDArray[Any]:
    """Return numbers at points, or bytes of colours."""
    if colours:
        return packed_colours([decoded.per_point[name] for name in colour_columns(decoded.per_point, source)])
    if not isinstance(source, str):
        return np.asarray(source.at(lines.points))
    return np.asarray(decoded.per_point[source]) if source in decoded.per_point else _measured(source, lines)


def _measured(name: str, lines: LineData) -> npt.NDArray[Any]:
    """Arc length or curvature at points."""
    from pvfiblets.query.measures import measure_kernels as kernels

    found = np.empty(len(lines.points), np.float32)
    measured = kernels.arc_lengths if name == "arc_length" else kernels.curvatures
    measured(np.asarray(lines.points, np.float64), lines.offsets, found)
    return found


def point_flags(
    fiblets: FibletSet, words: npt.NDArray[np.uint32], ids: npt.NDArray[np.int64]
) -> npt.NDArray[np.bool_]:
    """Bits of the points of some streamlines, end to end."""
    from pvfiblets.codec.streamline_ranges import StreamlineRanges

    places = StreamlineRanges.from_fiblets(fiblets).at(ids)
    starts = np.cumsum(places.points) - places.points
    rows = np.arange(int(places.points.sum())) + np.repeat(places.point - starts, places.points)
    flags: npt.NDArray[np.bool_] = (words[rows >> 5] >> (rows & 31).astype(np.uint32) & 1).astype(bool)
    return flags


# Tubes -----------------------------------------------------------------------------------------------


def tube_lines(tubes: Any, colouring: Colouring | None, budget: int) -> LineData:
    """Return the middle lines of spline tubes, `STEPS` pieces a segment, with their radius."""
    from pvfiblets.tubes.curves import controls, evaluate

    begins, owners = segment_ids(tubes)
    sizes = np.diff(begins, append=tubes.n_segments)
    runs = thinned(STEPS * sizes + 1, budget)
    chosen = np.repeat(np.isin(np.arange(len(begins)), runs), sizes)
    segments, sizes = np.flatnonzero(chosen), sizes[runs]
    first_of_run = np.zeros(len(segments), bool)
    first_of_run[np.cumsum(sizes) - sizes] = True
    halves = controls(tubes, segments)
    steps = np.linspace(0.0, 1.0, STEPS // 2 + 1)
    first, second = (evaluate(halves[:, side, None], steps[None]) for side in (0, 1))
    spheres = np.concatenate([first, second[:, 1:]], axis=1)  # (segments, STEPS + 1, 4)
    # Of a segment that follows another its first point is there already; a ball is one point.
    keep = np.ones(spheres.shape[:2], bool)
    keep[~first_of_run, 0] = False
    keep[tubes.segments[segments, 0] == tubes.segments[segments, 1], 1:] = False
    counts = np.bincount(np.repeat(np.arange(len(runs)), sizes), keep.sum(axis=1), len(runs)).astype(np.int64)
    offsets = np.concatenate([np.zeros(1, np.int64), np.cumsum(counts)])
    flat = spheres[keep]
    lines = LineData(flat[:, :3], offsets, owners[runs], {RADIUS: np.ascontiguousarray(flat[:, 3])})

    def values(source: Any, *, colours: bool) -> npt.NDArray[Any]:
        found = _tube_values(tubes, source, segments)[keep]
        return _bytes(found) if colours else found

    return _coloured(lines, colouring, values)


def _tube_values(tubes: Any, name: str, segments: npt.NDArray[np.int64]) -> npt.NDArray[np.float64]:
    """``(segments, STEPS + 1, ...)``: values along segments, which are Hermite cubics as positions are."""
    held = tubes.values[name]
    start, stop = tubes.segments[segments].T
    scale = tubes.lengths()[segments] if tubes.scaled else np.ones(len(segments))
    more = [1] * (held.values.ndim - 1)
    t, scale = np.linspace(0.0, 1.0, STEPS + 1).reshape(1, -1, *more), scale.reshape(-1, 1, *more)
    rest = 1.0 - t
    (low, slope), (high, end_slope) = ((held.values[at][:, None], held.slopes[at][:, None]) for at in (start, stop))
    ends = rest**2 * (1.0 + 2.0 * t) * low + t**2 * (3.0 - 2.0 * t) * high
    return np.asarray(ends + scale * (rest**2 * t * slope - rest * t**2 * end_slope))


# Halos -----------------------------------------------------------------------------------------------


def halo_lines(
    drawn: Any, look: Any, colouring: Colouring | None, ids: npt.NDArray[np.int64], filtering: Any, ink: Any
) -> LineData:
    """Return lines with halos, or points as lines of one point, without filtered ones."""
    points = np.asarray(drawn.points)
    offsets = getattr(drawn, "offsets", np.arange(len(points) + 1))
    counts = np.diff(offsets)[ids]
    begins = np.cumsum(counts) - counts
    rows = np.arange(int(counts.sum())) + np.repeat(offsets[:-1][ids] - begins, counts)
    lines = LineData(points[rows], np.concatenate([begins, [len(rows)]]).astype(np.int64), np.asarray(ids, np.int64))

    def values(source: Any, *, colours: bool) -> npt.NDArray[Any]:
        found = np.asarray(drawn.values[source])[rows]
        return _bytes(found.astype(np.float64)) if colours else found

    lines = _coloured(lines, colouring, values, ink=ink)
    kept = np.ones(len(rows), bool)
    if look.filter_by is not None:
        values = np.asarray(drawn.values[look.filter_by])[rows]
        kept = (values >= look.low) & (values <= look.high)
    if filtering is None:
        return lines.with_points(kept)
    if not hasattr(drawn, "offsets"):
        return lines.with_points(kept & filtering[rows])
    goes_on = np.zeros(len(points), bool)
    goes_on[drawn.segment_starts[filtering]] = True
    return lines.with_segments(goes_on[rows] & kept & np.append(kept[1:], False))


# Colours ---------------------------------------------------------------------------------------------


def _coloured(
    lines: LineData,
    colouring: Colouring | None,
    values: Any,
    per_point: Mapping[str, Any] = MappingProxyType({}),
    ink: Any = None,
) -> LineData:
    """Return lines with the colours of their points; without where the property's colour is that of all."""
    if colouring is None:
        return lines
    if colouring.mode == "solid" and colouring.color is not None and not colouring.translucent():
        return lines
    colouring = colouring.with_ink(ink)
    kind, of_lines = colouring.kind, colouring.streamline_colours()
    if of_lines is not None:
        colours = of_lines[np.repeat(lines.ids, np.diff(lines.offsets))]
    elif kind.numbers == "points":
        found = values(colouring.source, colours=not kind.table)
        colours = colouring.map_values(found) if kind.table else found
    else:
        # Directions stand for the number of lines in a pixel, too.
        seen = kind.of_directions or MODES["orientation"].of_directions
        own = colouring.color if colouring.mode == "solid" or seen is None else seen(lines.tangents())
        colours = np.full((len(lines.points), 4), 255, np.uint8)
        colours[:, :3] = np.round(255.0 * np.asarray(own))
    return lines.with_columns(**{COLOURS: _faded(colours, lines, colouring, per_point)})


def _faded(colours: npt.NDArray[Any], lines: LineData, colouring: Colouring, per_point: Any) -> npt.NDArray[np.uint8]:
    """Multiply alpha by the opacities of streamlines or points."""
    share: Any = None
    if colouring.opacities is not None:
        share = colouring.streamline_opacities()[:, 3][np.repeat(lines.ids, np.diff(lines.offsets))] / 255.0
    elif colouring.opacity_source is not None and colouring.opacity_source in per_point:
        share = np.clip(np.nan_to_num(per_point[colouring.opacity_source]), 0.0, 1.0)
    colours = np.array(colours, np.float64)
    if share is not None:
        colours[:, 3] *= share
    return np.round(colours).astype(np.uint8)


def _bytes(rgba: npt.NDArray[np.float64]) -> npt.NDArray[np.uint8]:
    return np.round(255.0 * np.clip(rgba, 0.0, 1.0)).astype(np.uint8)
