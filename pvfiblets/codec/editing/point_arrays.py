"""One more number, or colour, per point for a set that is compressed already.

A colour is three or four numbers: of ``NAME`` they are called ``NAME[0]`` for red to ``NAME[2]`` for blue, and
``NAME[3]`` for alpha.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from ..fibletset import FibletSet
from ..point_values import code_values


def with_point_values(fiblets: FibletSet, name: str, values: npt.ArrayLike, bits: int = 8) -> FibletSet:
    """Return a set that shares the arrays of another one and has one with a number per point more."""
    return with_coded_values(fiblets, name, fiblets.in_coded_order(values), bits)


def with_coded_values(fiblets: FibletSet, name: str, values: npt.ArrayLike, bits: int = 8) -> FibletSet:
    """Do the same with numbers in the order in which points are coded."""
    coded = code_values(values, bits, exact=fiblets.exact is not None)
    return replace(fiblets, per_point={**fiblets.per_point, name: coded})


def colour_columns(per_point: Mapping[str, Any], name: str) -> tuple[str, ...]:
    """Return the names of the three or four arrays of an array of so many columns; empty where there is none."""
    names = [f"{name}[{k}]" for k in range(5)]
    count = sum(name in per_point for name in names)
    return tuple(names[:count]) if count in (3, 4) and names[count] not in per_point else ()


def unit_colours(name: str, colours: npt.ArrayLike) -> npt.NDArray[np.float32]:
    """Return colours as floats from 0 to 1; NaN is 0."""
    given = np.asarray(colours)
    if given.ndim != 2 or given.shape[1] not in (3, 4):
        raise ValueError(f"colours {name!r} have the shape {given.shape}; expected 3 or 4 columns")
    most = 1.0 if given.dtype.kind == "f" else 255.0
    low, high = float(np.nanmin(given, initial=0.0)), float(np.nanmax(given, initial=0.0))
    if low < 0.0 or high > most:
        raise ValueError(
            f"colours {name!r} lie between {low:g} and {high:g}; floats must lie between 0 and 1, integers up to 255"
        )
    return np.nan_to_num(given / np.float32(most)).astype(np.float32)


def with_point_colours(fiblets: FibletSet, name: str, colours: npt.ArrayLike) -> FibletSet:
    """Return a set that shares the arrays of another one and has a colour per point more."""
    # Each channel takes a byte a point, and is off by half of 1/255 at most.
    rows = fiblets.in_coded_order(unit_colours(name, colours))
    before = {name, *colour_columns(fiblets.per_point, name)}
    kept = {key: values for key, values in fiblets.per_point.items() if key not in before}
    columns = {f"{name}[{k}]": code_values(rows[:, k]) for k in range(rows.shape[1])}
    return replace(fiblets, per_point={**kept, **columns})


def colours_of_points(fiblets: FibletSet, name: str, index: Any = slice(None)) -> npt.NDArray[np.uint8]:
    """Return colours of points, RGBA, ``(n, 4)`` uint8."""
    columns = [fiblets.per_point[column] for column in colour_columns(fiblets.per_point, name)]
    return packed_colours([column.values(index) for column in columns], max(column.hi for column in columns))


def packed_colours(columns: Sequence[npt.NDArray[Any]], most: float | None = None) -> npt.NDArray[np.uint8]:
    """Return RGBA, ``(n, 4)`` uint8, of three or four columns from 0 to 1, or to 255 where their `most` is above 1."""
    most = max(float(np.nanmax(column, initial=0.0)) for column in columns) if most is None else most
    unit = 1.0 if most <= 1.0 else 255.0
    found = np.full((len(columns[0]), 4), 255, np.uint8)
    for k, part in enumerate(columns):
        found[:, k] = np.round(255.0 * np.clip(np.nan_to_num(part) / unit, 0.0, 1.0))
    return found
