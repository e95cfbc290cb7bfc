"""Scalars of fiblets by name: arrays, images, and values computed from the geometry."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets.codec.editing.point_arrays import colour_columns
from pvfiblets.engine.fiblets.data.sampled_volume import VolumeSource
from pvfiblets.images.sources import as_image
from pvfiblets.plotting.colours.scalars import (
    DIRECTIONS,
    ORIENTATION,
    Numbers,
    Scalars,
    direction_scalars,
    find_scalars,
    name_list,
    row_scalars,
)
from pvfiblets.query.measures.even_sample import longest_length, meets_image, rounding_of
from pvfiblets.query.measures.measures import COMPUTED, Distance, curvature_values, measure
from pvfiblets.query.selection.endpoints import end_directions

if TYPE_CHECKING:
    from pvfiblets.codec.fibletset import FibletSet
    from pvfiblets.codec.point_values import PointValues
    from pvfiblets.images.image import Image
    from pvfiblets.streamlines import Streamlines

GROUP = "group"
DENSITY = "density"
ENDS, ID, RANDOM = "ends", "id", "random"
_LINES = ("length", "curvature", "arc_length", *COMPUTED["streamline"])
BUILT_IN = tuple(dict.fromkeys((*DIRECTIONS, ENDS, *_LINES, GROUP, DENSITY, ID, RANDOM)))

MOST = 98.0
"""Percentile at which the default range of curvature ends: one sharp bend would leave all else the first colour."""


def find_fiblet_scalars(
    fiblets: FibletSet, scalars: str | np.ndarray | VolumeSource | Distance | None, rgb: bool | None = None
) -> Scalars:
    """Find what ``scalars`` means for ``fiblets``."""
    if scalars is None:
        return Scalars(ORIENTATION, ORIENTATION)
    if isinstance(scalars, VolumeSource):
        warn_if_apart(fiblets, as_image(scalars), "all have nan_color", stacklevel=5)
        low, high = scalars.range
        return Scalars(
            scalars.name, "point_scalar", None, (low, high), positive=scalars.least_positive, volume=scalars
        )
    if isinstance(scalars, Distance):
        values = measure(fiblets, scalars)
        return row_scalars(values.name, values.array(), fiblets.n_streamlines)
    numbers = Numbers(
        "streamline", fiblets.n_streamlines, lambda name: _at_points(fiblets, name), fiblets.per_streamline,
        {**direction_scalars(), **_built_in(fiblets)}, lambda name: missing_message(fiblets, name),
    )  # fmt: skip
    return find_scalars(numbers, scalars, rgb)


def _at_points(fiblets: FibletSet, name: str) -> Scalars | None:
    if name in fiblets.per_point:
        stored = fiblets.per_point[name]
        return Scalars(name, "point_scalar", None, (stored.lo, stored.hi), positive=stored.least_positive())
    columns = colour_columns(fiblets.per_point, name)
    return _of_colours(name, [fiblets.per_point[column] for column in columns]) if columns else None


def _built_in(fiblets: FibletSet) -> dict[str, Callable[[], Any]]:
    """Return what each name that is built in computes, beside directions."""
    count = fiblets.n_streamlines

    def measured(name: str) -> Scalars:
        values = fiblets.lengths() if name == "length" else measure(fiblets, name).array()
        found = replace(row_scalars(name, values, count), rounding=rounding_of(fiblets, name))
        return without_outliers(found) if name == "mean_curvature" else found

    def arc_length() -> Scalars:
        return Scalars("arc_length", "point_scalar", None, (0.0, longest_length(fiblets) or 1.0), positive=fiblets.step)

    def curvature() -> Scalars:
        most = float(np.percentile(curvature_values(fiblets), MOST)) if fiblets.n_points else 0.0
        most, rounding = most or 1.0, rounding_of(fiblets, "curvature")
        return Scalars(
            "curvature", "point_scalar", None, (0.0, most), most / 1e3, percentile=MOST, rounding=rounding
        )

    def coding_error() -> Scalars:
        raise KeyError(
            "the coding error is known only while streamlines are compressed: give "
            "scalars='coding_error' to add_fiblets(streamlines), or run `pvfiblets verify`"
        )

    def random_colours() -> Any:
        from pvfiblets.query.bundles.colours import distinct_colours

        return distinct_colours(count)

    return {
        "coding_error": coding_error,
        **{name: partial(measured, name) for name in COMPUTED["streamline"]},
        "length": lambda: measured("length"),
        "arc_length": arc_length,
        "curvature": curvature,
        GROUP: lambda: by_group(fiblets),
        ENDS: lambda: end_directions(fiblets),
        ID: lambda: np.arange(count),
        RANDOM: random_colours,
        DENSITY: lambda: Scalars(DENSITY, "pixel_count", None, (0.0, 1.0), 1.0),
    }


def _of_colours(name: str, columns: list[PointValues]) -> Scalars:
    """Colours of points; the fiblets hold each channel as an array."""
    low, high = min(column.lo for column in columns), max(column.hi for column in columns)
    if low < 0.0 or high > 255.0:
        raise ValueError(
            f"scalars {name!r} are vectors from {low:g} to {high:g}, stored as one array per column; colour by "
            f"one ({name + '[0]'!r}), or by their magnitude, an array"
        )
    clear = len(columns) > 3 and columns[3].lo < (1.0 if high <= 1.0 else 255.0)
    return Scalars(name, "point_packed", has_alpha=clear)


def by_group(fiblets: FibletSet) -> Scalars:
    """Number the streamlines by the first of their groups; NaN for those without a group."""
    # Hidden groups come last. Colours are as in the list of bundles: a group's own, or one by its place.
    from pvfiblets.query.bundles.bundle_list import first_groups, group_colours

    if not fiblets.groups:
        raise KeyError("there are no groups to colour by; formats that keep groups are .trx and .fiblets")
    found = row_scalars(GROUP, first_groups(fiblets), fiblets.n_streamlines)
    names = dict(enumerate(fiblets.groups))
    palette = tuple(group_colours(fiblets.groups, fiblets.per_group).values())
    return replace(found, range=(-0.5, len(names) - 0.5), categories=names, category_colours=palette)


def without_outliers(scalars: Scalars) -> Scalars:
    """Return numbers that are 0 or more, with a range from 0 to their percentile `MOST`."""
    values = scalars.values
    finite = np.zeros(0) if values is None else values[np.isfinite(values)]
    most = float(np.percentile(finite, MOST)) if finite.size else 0.0
    return replace(scalars, range=(0.0, most), percentile=MOST) if most > 0.0 else scalars


def refuse_unknown(streamlines: Streamlines, name: str) -> None:
    """Refuse a name that neither streamlines have, which are to be compressed, nor is built in."""
    known = (streamlines.per_point, streamlines.per_streamline, BUILT_IN, ("coding_error",))
    if not any(name in names for names in known) and not colour_columns(streamlines.per_point, name):
        raise KeyError(missing_message(streamlines, name))


def missing_message(fiblets: FibletSet | Streamlines, name: str) -> str:
    """Return the message that there is no array ``name``, with the existing ones and the fix."""
    from pvfiblets.codec.fibletset import FibletSet

    coded = isinstance(fiblets, FibletSet)
    return (
        f"there is no array {name!r}. Per point: {name_list(fiblets.per_point)}; "
        f"per streamline: {name_list(fiblets.per_streamline)}; built in: {name_list(BUILT_IN)}"
        + (f". Per-point arrays of a file are kept only when asked for: per_point=[{name!r}]" if coded else "")
    )


def warn_if_apart(fiblets: FibletSet | Streamlines, image: Image, effect: str, *, stacklevel: int) -> None:
    """Warn where no point lies in an image, and say what a picture shows then."""
    if meets_image(fiblets, image):
        return
    sides = np.array(image.shape[:3])
    corners = np.stack(np.meshgrid(*[(-0.5, side - 0.5) for side in sides]), axis=-1).reshape(-1, 3)
    places = corners @ image.affine[:3, :3].T + image.affine[:3, 3]
    theirs = np.stack([places.min(axis=0), places.max(axis=0)], axis=1).ravel()
    warnings.warn(
        f"no streamline meets the image {image.name or 'image'!r}, so that {effect}: it lies in {_extent(theirs)} mm, "
        f"the streamlines in {_extent(fiblets.bounds)} mm. pv.read() loses where a NIfTI file lies: give its path, or "
        "pvfiblets.read_volume(path)",
        UserWarning,
        stacklevel=stacklevel,
    )


def _extent(bounds: Any) -> str:
    pairs = zip("xyz", bounds[::2], bounds[1::2], strict=True)
    return ", ".join(f"{axis} {low:.4g} to {high:.4g}" for axis, low, high in pairs)


def point_values(fiblets: FibletSet, ids: np.ndarray, name: str) -> tuple[np.ndarray, np.ndarray] | None:
    """Return one number per point of some streamlines, one after another, and their offsets."""
    if name in fiblets.per_point:
        lines = fiblets.decompress(ids)
        return np.asarray(lines.per_point[name], np.float64).reshape(len(lines.points), -1)[:, 0], lines.offsets
    from pvfiblets.codec.streamline_ranges import StreamlineRanges

    part = fiblets.extract(ids)
    try:
        measured = measure(part, name)
    except KeyError:
        return None
    if measured.kind != "point":
        return None
    where = StreamlineRanges.from_fiblets(part)
    offsets = np.concatenate([[0], np.cumsum(where.points)])
    rows = np.arange(offsets[-1]) + np.repeat(where.point - offsets[:-1], where.points)
    return np.asarray(measured.array(), np.float64)[rows], offsets
