"""The numbers or colours of `scalars=`, by name or as an array, for every drawable.

A name is looked up among the numbers of points, then of whole lines, then among built-in ones, which are
computed from the geometry. An array is recognised by its length. Arrays with three or four columns are colours, all
others are numbers for a colour map.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets.colour_modes import MODES

if TYPE_CHECKING:
    from pvfiblets.codec.fibletset import FibletSet
    from pvfiblets.engine.fiblets.data.sampled_volume import VolumeSource

ORIENTATION = "orientation"
DIRECTIONS = tuple(name for name, mode in MODES.items() if mode.of_directions is not None)
"""Colour modes that need a line's direction alone, and are names of scalars."""
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
NAME_ONE = "Name one of these, or give an array"


@dataclass(frozen=True)
class Scalars:
    """Numbers or colours found for an actor."""

    name: str  # for the scalar bar, and for the engine where `kind` is `"point_scalar"`
    kind: str  # one of `pvfiblets.colour_modes.MODES`: how the mapper has to use them
    values: np.ndarray | None = None  # (n_streamlines,) float64 or (n_streamlines, 3 or 4) uint8
    # least and largest finite value; of what a few outliers make large, as curvature, 0 and a percentile
    range: tuple[float, float] = (0.0, 1.0)
    positive: float = 1e-6  # least value above zero, where a logarithmic scale may begin
    volume: VolumeSource | None = None  # to be sampled at the points, where `kind` is `"point_scalar"`
    categories: dict[int, str] | None = None  # of numbers that are labels: what each stands for
    category_colours: tuple[Any, ...] | None = None  # colours that the labels have by themselves, in their order
    has_alpha: bool = False  # whether some of the colours of points have an alpha below 1
    percentile: float | None = None  # of the values, at which the range ends where it does not end at the largest
    # by how much equal values may differ; a range that is no wider is that of one value. By default that of their
    # storage.
    rounding: float = 0.0

    @property
    def colour_range(self) -> tuple[float, float]:
        """The range; widened if its values differ only by rounding, so that all have the first colour."""
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
        return MODES[self.kind].table

    @property
    def title(self) -> str:
        """Title of the scalar bar."""
        return COUNTED if self.kind == "pixel_count" else UNITS.get(self.name, self.name)

    def distinct(self, fiblets: FibletSet) -> int:
        """Return how many different numbers there are, NaN not counted; at least 1."""
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


@dataclass(frozen=True)
class Numbers:
    """The values of `scalars=` for some data."""

    whole: str  # what a row of numbers is for, where it is not a point
    count: int  # number of rows
    at_points: Callable[[str], Scalars | None]  # A name to the numbers or colours of points; None where there are none
    per_line: Mapping[str, Any]
    # each returns `Scalars`, or an array with a row for each line
    built_in: Mapping[str, Callable[[], Any]] = field(default_factory=dict)
    missing: Callable[[str], str] = repr  # A name that is not there to the text of an error


def find_scalars(numbers: Numbers, choice: Any, rgb: bool | None = None) -> Scalars:
    """Find what ``scalars`` means."""
    if not isinstance(choice, str):
        return line_scalars(UNNAMED, choice, numbers.count, rgb, whole=numbers.whole)
    if (stored := numbers.at_points(choice)) is not None:
        return stored
    if choice in numbers.per_line:
        return line_scalars(choice, numbers.per_line[choice], numbers.count, rgb, whole=numbers.whole)
    if choice not in numbers.built_in:
        raise KeyError(numbers.missing(choice))
    found = numbers.built_in[choice]()
    return found if isinstance(found, Scalars) else row_scalars(choice, found, numbers.count, whole=numbers.whole)


def direction_scalars() -> dict[str, Callable[[], Scalars]]:
    """Return the built-in scalars of all lines: colours of their directions."""
    return {name: partial(Scalars, name, name) for name in DIRECTIONS}


def name_list(names: Iterable[Any]) -> str:
    """Return names as messages have them."""
    return ", ".join(repr(str(name)) for name in names) or "none"


def refuse_numbers(title: str | None, rgb: bool | None) -> None:
    """Refuse numbers, with their scalar bar's title, where colours are expected, as `add_mesh` does."""
    if rgb and title is not None:
        raise ValueError(
            f"rgb=True asks for colours, but {title!r} has one number in each row; drop rgb, or give 3 or 4 columns"
        )


def are_colours(values: np.ndarray, rgb: bool | None) -> bool:
    """Whether rows are colours; by PyVista's rules."""
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


def line_scalars(
    name: str, values: Any, count: int, rgb: bool | None = None, *, whole: str = "streamline"
) -> Scalars:
    """Make :class:`Scalars` of numbers, colours, vectors or words, one per streamline."""
    values = np.asarray(values)
    if values.shape == (count,) and values.dtype.kind in "USO":
        return _by_word(name, values)
    wide = values.ndim == 2 and values.shape[0] == count and values.shape[1] > 1 and values.dtype.kind in "buif"
    if wide and not are_colours(values, rgb):
        values = magnitudes(values)
    return row_scalars(name, values, count, whole=whole)


def _by_word(name: str, words: np.ndarray) -> Scalars:
    """Number the words in their order; each is a category. Empty words have none."""
    texts = np.array([str(word) for word in words])
    known = np.unique(texts[texts != ""])
    numbers = np.where(texts == "", np.nan, np.searchsorted(known, texts))
    found = row_scalars(name, numbers, len(words))
    return replace(found, range=(-0.5, max(len(known), 1) - 0.5), categories=dict(enumerate(known.tolist())))


def point_scalars(name: str, values: np.ndarray) -> Scalars:
    """Make :class:`Scalars` of numbers at points, or of ``(n, 4)`` colours from 0 to 1."""
    if values.ndim == 2:
        return Scalars(name, "point_rgba", has_alpha=bool((values[:, 3] < 1.0).any()))
    return Scalars(name, "point_scalar", **_range_and_positive(values))


def _range_and_positive(values: np.ndarray) -> dict[str, Any]:
    """Return range and least positive number as `Scalars` has them."""
    finite = values[np.isfinite(values)] if values.dtype.kind == "f" else values
    if not len(finite):
        return {}
    positive = finite[finite > 0]
    least = float(positive.min()) if len(positive) else 1e-6
    return {"range": (float(finite.min()), float(finite.max())), "positive": least}


def row_scalars(name: str, values: Any, count: int, *, whole: str = "streamline") -> Scalars:
    """Make :class:`Scalars` of one number, or one colour, per streamline, or whatever the ``whole`` is called."""
    # Colours are (n, 3) or (n, 4): uint8 from 0 to 255, or floats from 0 to 1.
    values = np.asarray(values)
    if values.ndim == 2 and values.shape[1] == 1:
        values = values[:, 0]
    if values.shape[:1] != (count,) or values.ndim > 2 or values.dtype.kind not in "buif":
        raise ValueError(
            f"scalars {name!r} have shape {values.shape} and type {values.dtype}; expected "
            f"{count} numbers, one per {whole}, or {count} rows of 3 or 4 colour parts"
        )
    if values.ndim == 1:
        numbers = values.astype(np.float64)
        return Scalars(name, "streamline_scalar", numbers, **_range_and_positive(numbers))
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
