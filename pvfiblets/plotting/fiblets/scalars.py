"""Which numbers colour an actor: by name or as an array, per point or per streamline.

A name is looked up among the arrays that the fiblets carry and then among the built-in ones, which
are computed from the geometry and stored nowhere. An array is recognised by its length. Arrays
with three or four columns are colours, all others are numbers for a colour map.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets.codec.point_arrays import colour_columns
from pvfiblets.engine.fiblets.data.sampled_volume import VolumeSource
from pvfiblets.images.sources import as_image
from pvfiblets.query.bundles.bundle_list import group_colours, hidden_groups
from pvfiblets.query.bundles.colours import distinct_colours
from pvfiblets.query.measures.measures import COMPUTED, Distance, curvature_values, measure
from pvfiblets.query.selection.endpoints import anchor_points, end_points

if TYPE_CHECKING:
    from pvfiblets.codec.fibletset import FibletSet
    from pvfiblets.codec.point_values import PointValues
    from pvfiblets.images.image import Image
    from pvfiblets.streamlines import Streamlines

ORIENTATION = "orientation"
GROUP = "group"
DENSITY = "density"
ENDS, ID, RANDOM = "ends", "id", "random"
_LINES = ("length", "curvature", "arc_length", *COMPUTED["streamline"])
BUILT_IN = tuple(dict.fromkeys((ORIENTATION, ENDS, *_LINES, GROUP, DENSITY, ID, RANDOM)))
UNITS = {
    "length": "length [mm]",
    "radius": "radius [mm]",
    "curvature": "curvature [1/mm]",
    "arc_length": "arc length [mm]",
    "mean_curvature": "mean curvature [1/mm]",
    "end_distance": "distance of ends [mm]",
    "n_points": "points",
    "id": "streamline",
    "coding_error": "coding error [mm]",
    "distance": "distance [mm]",
}
COUNTED = "streamlines per pixel"
UNNAMED = "Data"

MOST = 98.0
"""Percentile at which the default range of curvature ends: one sharp bend would leave all else the first colour."""

_SAMPLE = 2000  # streamlines whose points give curvature its default range


@dataclass(frozen=True)
class Scalars:
    """Numbers or colours found for an actor.

    Parameters
    ----------
    name : str
        For the scalar bar, and for the engine where ``kind`` is ``"point_scalar"``.
    kind : {"orientation", "streamline_rgba", "streamline_scalar", "point_scalar", "point_rgba", "point_packed", \
            "pixel_count"}
        How the mapper has to use them.
    values : array, optional
        (n_streamlines,) float64 or (n_streamlines, 3 or 4) uint8.
    range : tuple of float
        Least and largest finite value; of what a few outliers make large, as curvature, 0 and a percentile.
    positive : float
        Least value above zero, where a logarithmic scale may begin.
    categories : dict, optional
        Of numbers that are labels: what each stands for.
    category_colours : tuple, optional
        Colours that the labels have by themselves, in their order.
    volume : VolumeSource, optional
        To be sampled at the points, where ``kind`` is ``"point_scalar"``.
    has_alpha : bool
        Whether some of the colours of points have an alpha below 1.
    percentile : float, optional
        Of the values, at which the range ends where it does not end at the largest.
    rounding : float
        By how much equal values may differ; a range that is no wider is that of one value. By default that of their
        storage.
    """

    name: str
    kind: str
    values: np.ndarray | None = None
    range: tuple[float, float] = (0.0, 1.0)
    positive: float = 1e-6
    volume: VolumeSource | None = None
    categories: dict[int, str] | None = None
    category_colours: tuple[Any, ...] | None = None
    has_alpha: bool = False
    percentile: float | None = None
    rounding: float = 0.0

    @property
    def colour_range(self) -> tuple[float, float]:
        """The range, or one of which equal values that differ by rounding all have the first colour."""
        low, high = self.range
        with np.errstate(over="ignore"):
            # Compared as Python floats: NumPy would round the other side to float32.
            stored_single = float(np.float32(low)) == low and float(np.float32(high)) == high
            stored_single &= not (float(low).is_integer() and float(high).is_integer())
        relative = 2.0 * float(np.finfo(np.float32).eps) if stored_single else 64.0 * float(np.finfo(np.float64).eps)
        if high - low <= max(self.rounding, relative * max(abs(low), abs(high))):
            high = low + 1000.0 * (high - low)
        return low, high

    @property
    def mapped(self) -> bool:
        """Whether a colour map turns these into colours, so that a scalar bar makes sense."""
        return self.kind in ("streamline_scalar", "point_scalar", "pixel_count")

    @property
    def title(self) -> str:
        """What the scalar bar says."""
        return COUNTED if self.kind == "pixel_count" else UNITS.get(self.name, self.name)

    def distinct(self, fiblets: FibletSet) -> int:
        """Return how many different numbers there are, NaN not counted; at least 1.

        Raises
        ------
        ValueError
            If they come of the geometry at every point, as arc length and curvature do.
        """
        if self.categories is not None:
            return max(len(self.categories), 1)
        if self.volume is not None:
            return max(self.volume.distinct, 1)
        if self.values is not None:
            return max(int(np.unique(self.values[~np.isnan(self.values)]).size), 1)
        if self.name not in fiblets.per_point:
            raise ValueError(
                f"{self.name!r} has no categories; give categories=False, or the number of colours "
                "as n_colors"
            )
        return max(fiblets.per_point[self.name].distinct(), 1)


def find_scalars(
    fiblets: FibletSet, scalars: str | np.ndarray | VolumeSource | Distance | None, rgb: bool | None = None
) -> Scalars:
    """Find what ``scalars`` means for ``fiblets``."""
    if scalars is None:
        return Scalars(ORIENTATION, "orientation")
    if isinstance(scalars, VolumeSource):
        warn_if_apart(fiblets, as_image(scalars), "all have nan_color", stacklevel=5)
        low, high = scalars.range
        return Scalars(
            scalars.name, "point_scalar", None, (low, high), positive=scalars.least_positive, volume=scalars
        )
    if isinstance(scalars, Distance):
        values = measure(fiblets, scalars)
        return per_streamline(values.name, values.array(), fiblets.n_streamlines)
    if not isinstance(scalars, str):
        return of_streamlines(UNNAMED, scalars, fiblets.n_streamlines, rgb)
    if scalars in fiblets.per_point:
        stored = fiblets.per_point[scalars]
        low, high = stored.lo, stored.hi
        return Scalars(scalars, "point_scalar", None, (low, high), positive=stored.least_positive())
    if columns := colour_columns(fiblets.per_point, scalars):
        return _of_colours(scalars, [fiblets.per_point[name] for name in columns])
    if scalars in fiblets.per_streamline:
        return of_streamlines(scalars, fiblets.per_streamline[scalars], fiblets.n_streamlines, rgb)
    if scalars == ORIENTATION:
        return Scalars(ORIENTATION, "orientation")
    if scalars == "length":
        return _measured(per_streamline("length", fiblets.lengths(), fiblets.n_streamlines), fiblets)
    if scalars == "arc_length":
        longest = _longest(fiblets)
        return Scalars("arc_length", "point_scalar", None, (0.0, longest or 1.0), positive=fiblets.step)
    if scalars == "curvature":
        most = float(np.percentile(curvature_values(fiblets), MOST)) if fiblets.n_points else 0.0
        found = Scalars("curvature", "point_scalar", None, (0.0, most or 1.0), (most or 1.0) / 1e3, percentile=MOST)
        return _measured(found, fiblets)
    if scalars in COMPUTED["streamline"]:
        found = _measured(per_streamline(scalars, measure(fiblets, scalars).array(), fiblets.n_streamlines), fiblets)
        return without_outliers(found) if scalars == "mean_curvature" else found
    if scalars == GROUP:
        return by_group(fiblets)
    if scalars == ENDS:
        return per_streamline(ENDS, _end_directions(fiblets), fiblets.n_streamlines)
    if scalars == ID:
        return per_streamline(ID, np.arange(fiblets.n_streamlines), fiblets.n_streamlines)
    if scalars == RANDOM:
        return per_streamline(RANDOM, distinct_colours(fiblets.n_streamlines), fiblets.n_streamlines)
    if scalars == DENSITY:
        return Scalars(DENSITY, "pixel_count", None, (0.0, 1.0), 1.0)
    if scalars == "coding_error":
        raise KeyError(
            "the coding error is known only while streamlines are compressed: give "
            "scalars='coding_error' to add_fiblets(streamlines), or run `pvfiblets verify`"
        )
    raise KeyError(missing_message(fiblets, scalars))


def _measured(scalars: Scalars, fiblets: FibletSet) -> Scalars:
    """Return numbers that were computed of points, with the rounding that these have as float32."""
    if scalars.name == "n_points" or not fiblets.n_points:
        return scalars
    bounds = np.asarray(fiblets.bounds)
    position = 2.0 * float(np.finfo(np.float32).eps) * float((bounds[1::2] - bounds[0::2]).max())  # mm
    curvature = scalars.name in ("curvature", "mean_curvature")
    return replace(scalars, rounding=position / fiblets.step**2 if curvature and fiblets.step > 0.0 else position)


def refuse_numbers(title: str | None, rgb: bool | None) -> None:
    """Refuse numbers, by what their scalar bar says, where colours are asked for, as `add_mesh` does."""
    if rgb and title is not None:
        raise ValueError(
            f"rgb=True asks for colours, but {title!r} has one number in each row; drop rgb, or give 3 or 4 columns"
        )


def _of_colours(name: str, columns: list[PointValues]) -> Scalars:
    """Colours of points, of which the fiblets hold each channel."""
    low, high = min(column.lo for column in columns), max(column.hi for column in columns)
    if low < 0.0 or high > 255.0:
        raise ValueError(
            f"scalars {name!r} are vectors from {low:g} to {high:g}, of which the fiblets hold each column; colour by "
            f"one ({name + '[0]'!r}), or by their magnitude, an array"
        )
    clear = len(columns) > 3 and columns[3].lo < (1.0 if high <= 1.0 else 255.0)
    return Scalars(name, "point_packed", has_alpha=clear)


def are_colours(values: np.ndarray, rgb: bool | None) -> bool:
    """Whether rows are colours; see :func:`find_scalars`."""
    if values.ndim != 2 or rgb is False or (rgb is None and values.shape[1] not in (3, 4)):
        return False
    if rgb or values.dtype == np.uint8:
        return True
    if values.dtype.kind != "f":
        return False
    return not values.size or bool(np.nanmin(values) >= 0.0 and np.nanmax(values) <= 1.0)


def magnitudes(values: np.ndarray) -> np.ndarray:
    """Return the length of each row, ``(n,)`` float64; NaN where a column is."""
    flat = np.asarray(values, np.float64).reshape(len(values), -1)
    return np.asarray(np.linalg.norm(flat, axis=1))


def of_streamlines(
    name: str, values: Any, count: int, rgb: bool | None = None, *, whole: str = "streamline"
) -> Scalars:
    """Make :class:`Scalars` of numbers, colours, vectors or words, one per streamline."""
    values = np.asarray(values)
    if values.shape == (count,) and values.dtype.kind in "USO":
        return _by_word(name, values)
    wide = values.ndim == 2 and values.shape[0] == count and values.shape[1] > 1 and values.dtype.kind in "buif"
    if wide and not are_colours(values, rgb):
        values = magnitudes(values)
    return per_streamline(name, values, count, whole=whole)


def _by_word(name: str, words: np.ndarray) -> Scalars:
    """Number the words in their order; each is a category. Empty words have none."""
    texts = np.array([str(word) for word in words])
    known = np.unique(texts[texts != ""])
    numbers = np.where(texts == "", np.nan, np.searchsorted(known, texts))
    found = per_streamline(name, numbers, len(words))
    return replace(found, range=(-0.5, max(len(known), 1) - 0.5), categories=dict(enumerate(known.tolist())))


def _end_directions(fiblets: FibletSet) -> np.ndarray:
    """Return the absolute direction from end to end as colours, (n, 3) from 0 to 1; grey where there is none."""
    ends = end_points(fiblets)
    apart = np.abs(ends[:, 1] - ends[:, 0])
    sizes = np.linalg.norm(apart, axis=1, keepdims=True)
    return np.where(sizes > 0.0, apart / np.where(sizes > 0.0, sizes, 1.0), 0.5)


def by_group(fiblets: FibletSet) -> Scalars:
    """Number the streamlines by the first of the groups that they are in; NaN for those in none.

    Groups that are hidden come last. Colours are those of the list of bundles: a group's own, or one by its place.
    """
    if not fiblets.groups:
        raise KeyError("there are no groups to colour by; formats that keep groups are .trx and .fiblets")
    numbers = np.full(fiblets.n_streamlines, np.nan)
    hidden = hidden_groups(fiblets.per_group)
    order = sorted(enumerate(fiblets.groups), key=lambda item: item[1] in hidden)
    for index, name in reversed(order):
        numbers[np.asarray(fiblets.groups[name])] = index
    found = per_streamline(GROUP, numbers, fiblets.n_streamlines)
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
    """Say that there is no array ``name``, which there are, and what to do."""
    from pvfiblets.codec.fibletset import FibletSet

    def listed(names: Any) -> str:
        return ", ".join(repr(str(n)) for n in names) or "none"

    coded = isinstance(fiblets, FibletSet)
    return (
        f"there is no array {name!r}. Per point: {listed(fiblets.per_point)}; "
        f"per streamline: {listed(fiblets.per_streamline)}; built in: {listed(BUILT_IN)}"
        + (f". Per-point arrays of a file are kept only when asked for: per_point=[{name!r}]" if coded else "")
    )


def per_streamline(name: str, values: Any, n_streamlines: int, *, whole: str = "streamline") -> Scalars:
    """Make :class:`Scalars` of one number, or one colour, per streamline, or whatever the ``whole`` is called.

    Colours are (n, 3) or (n, 4): uint8 from 0 to 255, or floats from 0 to 1.
    """
    values = np.asarray(values)
    if values.ndim == 2 and values.shape[1] == 1:
        values = values[:, 0]
    if values.shape[:1] != (n_streamlines,) or values.ndim > 2 or values.dtype.kind not in "buif":
        raise ValueError(
            f"scalars {name!r} have shape {values.shape} and type {values.dtype}; expected "
            f"{n_streamlines} numbers, one per {whole}, or as many rows of 3 or 4 colour parts"
        )
    if values.ndim == 1:
        numbers = values.astype(np.float64)
        finite = numbers[np.isfinite(numbers)]
        if not len(finite):
            return Scalars(name, "streamline_scalar", numbers)
        positive = finite[finite > 0.0]
        return Scalars(
            name,
            "streamline_scalar",
            numbers,
            (float(finite.min()), float(finite.max())),
            positive=float(positive.min()) if len(positive) else 1e-6,
        )
    if values.shape[1] not in (3, 4):
        raise ValueError(
            f"scalars {name!r} have {values.shape[1]} columns; expected 1 (numbers), or 3 or 4 "
            "(colours). Pick a column, or take a norm, first"
        )
    colours = values
    if values.dtype.kind == "f":
        if np.nanmin(colours, initial=0.0) < 0.0 or np.nanmax(colours, initial=0.0) > 1.0:
            raise ValueError(
                f"colours {name!r} lie between {np.nanmin(colours):g} and "
                f"{np.nanmax(colours):g}; floats must lie between 0 and 1, or give uint8"
            )
        colours = np.round(np.nan_to_num(colours) * 255.0)
    elif colours.size and (colours.min() < 0 or colours.max() > 255):
        raise ValueError(f"colours {name!r} must lie between 0 and 255")
    return Scalars(name, "streamline_rgba", np.ascontiguousarray(colours, dtype=np.uint8))


def _longest(fiblets: FibletSet) -> float:
    """Return the length, mm, of the longest of those streamlines that have the most points.

    With constant steps that is the longest of all; else it is near enough for a colour range, and
    costs the same for a billion points as for a million.
    """
    counts = np.diff(fiblets.offsets())
    if not counts.size:
        return 0.0
    most = np.argpartition(counts, -min(_SAMPLE, counts.size))[-_SAMPLE:]
    return float(fiblets.decompress(most).lengths().max())


def warn_if_apart(fiblets: FibletSet, image: Image, effect: str, *, stacklevel: int) -> None:
    """Warn where no point lies in an image, and say what a picture shows then."""
    sides = np.array(image.shape[:3])

    def meets(points: np.ndarray) -> bool:
        at = points.astype(np.float64) @ image.inverse[:3, :3].T + image.inverse[:3, 3]
        return bool(((at >= -0.5) & (at <= sides - 0.5)).all(axis=1).any())

    # Anchors are points that need no decoding, and nearly always one of some lies inside.
    some = np.unique(np.linspace(0, max(fiblets.n_fiblets - 1, 0), _SAMPLE).astype(np.int64))
    if not fiblets.n_points or meets(anchor_points(fiblets, some)):
        return
    if any(meets(chunk.points) for chunk in fiblets.iter_chunks()):
        return
    corners = np.stack(np.meshgrid(*[(-0.5, side - 0.5) for side in sides]), axis=-1).reshape(-1, 3)
    places = corners @ image.affine[:3, :3].T + image.affine[:3, 3]
    theirs = np.stack([places.min(axis=0), places.max(axis=0)], axis=1).ravel()
    warnings.warn(
        f"no streamline meets the image {image.name or 'image'!r}, so that {effect}: it lies in {_told(theirs)} mm, "
        f"the streamlines in {_told(fiblets.bounds)} mm. pv.read() loses where a NIfTI file lies: give its path, or "
        "pvfiblets.read_volume(path)",
        UserWarning,
        stacklevel=stacklevel,
    )


def _told(bounds: Any) -> str:
    pairs = zip("xyz", bounds[::2], bounds[1::2], strict=True)
    return ", ".join(f"{axis} {low:.4g} to {high:.4g}" for axis, low, high in pairs)


def mean_direction(fiblets: FibletSet) -> tuple[float, float, float]:
    """Return the mean colour of an even sample of streamlines coloured by orientation: red, green, blue from 0 to 1."""
    sample = _even_sample(fiblets)
    moves = np.abs(np.diff(sample.points.astype(np.float64), axis=0))
    between = sample.offsets[1:-1]
    moves[between[(between > 0) & (between <= len(moves))] - 1] = 0.0  # from one streamline to the next
    total = moves.sum(axis=0)
    size = float(np.linalg.norm(total))
    red, green, blue = total / size if size > 0.0 else (0.5, 0.5, 0.5)
    return float(red), float(green), float(blue)


def _even_sample(fiblets: FibletSet) -> Streamlines:
    """Return streamlines at even distances in the set, `_SAMPLE` at most."""
    count = min(_SAMPLE, fiblets.n_streamlines)
    return fiblets.decompress(np.unique(np.linspace(0, fiblets.n_streamlines - 1, count).astype(np.int64)))
