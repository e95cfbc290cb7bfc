"""Data of halos: `HaloLines` and `HaloPoints`, with numbers or colours at their points."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from types import MappingProxyType
from typing import Any

import numpy as np
import numpy.typing as npt

from pvfiblets.support.ragged import as_offsets
from pvfiblets.support.value_reference import value_reference

Values = Mapping[str, npt.NDArray[Any]]
_NONE: Values = MappingProxyType({})


class _AtPoints:
    """Points, and values at them."""

    points: npt.NDArray[np.floating[Any]]
    values: Values

    @property
    def n_points(self) -> int:
        """Points of all lines."""
        return len(self.points)

    @cached_property
    def _references(self) -> dict[str, float]:
        return {name: value_reference(held) for name, held in self.values.items() if held.ndim == 1}

    def value_reference(self, name: Any) -> float:
        """Return the number to subtract from values on the graphics card; see `pvfiblets.support.value_reference`."""
        return self._references.get(name, 0.0)

    @property
    def promise(self) -> float:
        """Nothing lies outside the bounds."""
        return 0.0

    @cached_property
    def bounds(self) -> tuple[float, ...]:
        """(xmin, xmax, ymin, ymax, zmin, zmax) of the points, mm; zeros without any."""
        return _bounds(self.points)


@dataclass(frozen=True, eq=False)
class HaloLines(_AtPoints):
    """Polylines with halos."""

    points: npt.NDArray[np.floating[Any]]  # ``(n_points, 3)`` float32 or float64, mm, finite. Points may repeat.
    # ``(n_lines + 1,)`` int64: line ``i`` is ``points[offsets[i]:offsets[i + 1]]``. Lines of one point show nothing.
    offsets: npt.NDArray[np.int64]
    # A row for each point: ``(n_points,)`` numbers, NaN among them, or ``(n_points, 4)`` float32 RGBA in 0..1
    values: Values = field(default_factory=lambda: _NONE)

    def __post_init__(self) -> None:
        object.__setattr__(self, "points", _checked_points(self.points, "lines"))
        object.__setattr__(self, "offsets", as_offsets(self.offsets, len(self.points)))
        object.__setattr__(self, "values", _checked_values(self.values, len(self.points)))

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.points, self.offsets, dict(self.values))  # a view of a dict cannot be pickled

    @property
    def n_lines(self) -> int:
        """Lines, those without points included."""
        return len(self.offsets) - 1

    @property
    def n_streamlines(self) -> int:
        """The same, by the name that colours ask for."""
        return self.n_lines

    @cached_property
    def n_segments(self) -> int:
        """Segments between neighbouring points of a line, those without length included."""
        return int(np.maximum(np.diff(self.offsets) - 1, 0).sum())

    @cached_property
    def segment_starts(self) -> npt.NDArray[np.int64]:
        """``(n_segments,)`` int64: the point at which each segment starts; it ends at the next."""
        inner = np.ones(self.n_points, bool)
        inner[self.offsets[1:][np.diff(self.offsets) > 0] - 1] = False
        return np.flatnonzero(inner)

    def pieces(self, kept: npt.NDArray[np.bool_]) -> npt.NDArray[np.int64]:
        """Return the offsets of the pieces that remain of the lines with some segments, ``(n_segments,)`` bool."""
        # All points are in pieces, those without a segment each in its own.
        found: npt.NDArray[np.int64] = np.union1d(self.offsets, self.segment_starts[~kept] + 1)
        return found


@dataclass(frozen=True, eq=False)
class HaloPoints(_AtPoints):
    """Points with halos."""

    points: npt.NDArray[np.floating[Any]]  # ``(n_points, 3)`` float32 or float64, mm, finite
    values: Values = field(default_factory=lambda: _NONE)  # As of `HaloLines`

    def __post_init__(self) -> None:
        object.__setattr__(self, "points", _checked_points(self.points, "points"))
        object.__setattr__(self, "values", _checked_values(self.values, len(self.points)))

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.points, dict(self.values))

    @property
    def n_streamlines(self) -> int:
        """The points: each counts as a line."""
        return self.n_points


def _checked_points(points: Any, what: str) -> npt.NDArray[np.floating[Any]]:
    array = np.asarray(points)
    if array.dtype not in (np.float32, np.float64):
        array = array.astype(np.float64)
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"{what} have points of the shape {array.shape}, expected (n, 3): x, y, z in mm")
    finite = np.isfinite(array).all(axis=1)
    if not finite.all():
        row = int(np.argmin(finite))
        raise ValueError(f"point {row} of {what} is {array[row].tolist()}; coordinates must be finite: leave it out")
    return array


def _checked_values(values: Values, n_points: int) -> Values:
    checked: dict[str, npt.NDArray[Any]] = {}
    for name, given in values.items():
        array = np.asarray(given)
        if len(array) != n_points or array.shape[1:] not in ((), (4,)) or array.dtype.kind not in "buif":
            raise ValueError(
                f"values {name!r} have the shape {array.shape} and type {array.dtype}; expected ({n_points},) "
                f"numbers or ({n_points}, 4) colours from 0 to 1"
            )
        checked[name] = array.astype(np.float32) if array.ndim == 2 else array
    return MappingProxyType(checked)


def _bounds(points: npt.NDArray[np.floating[Any]]) -> tuple[float, ...]:
    if not len(points):
        return (0.0,) * 6
    return tuple(np.stack([points.min(axis=0), points.max(axis=0)], axis=1).astype(np.float64).ravel().tolist())
