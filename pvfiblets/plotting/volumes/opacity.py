"""Conversion of a volume's arguments: opacities, as for ``Plotter.add_volume``, surfaces and limits."""

from __future__ import annotations

import math
from collections.abc import Sequence
from numbers import Real
from typing import Any

import numpy as np
import pyvista as pv
from pyvista.plotting.tools import opacity_transfer_function


def is_number(given: Any) -> bool:
    """Whether something is one number."""
    return isinstance(given, Real) or (isinstance(given, np.ndarray) and given.ndim == 0 and given.dtype.kind in "iuf")


def number(name: str, given: Any, expected: str) -> float:
    """Return a value as one number, or raise an error that names it."""
    if not is_number(given):
        raise ValueError(f"{name} is {given!r}; give {expected}")
    return float(given)


def opacities(given: Any, n_colors: int) -> np.ndarray:
    """Return an opacity for each entry of a table of colours."""
    if isinstance(given, str):
        named = opacity_transfer_function(given, n_colors)
        return np.asarray(named, np.float64) / 255.0
    table = np.asarray(given)
    if table.dtype.kind not in "buif":
        raise TypeError(f"opacity is a {type(given).__name__}; give a name, a number from 0 to 1, or a list of them")
    if table.ndim > 1 or table.size == 0:
        raise ValueError(f"opacity has the shape {table.shape}; give one number from 0 to 1, or a list of them")
    bytes_ = table.ndim == 1 and (table.dtype == np.uint8 or (len(table) == n_colors and table.max() > 1))
    table = table.astype(np.float64).ravel() / (255.0 if bytes_ else 1.0)
    wrong = np.flatnonzero(~((table >= 0.0) & (table <= 1.0)))  # and not of NaN
    if len(wrong):
        where = "" if table.size == 1 else f" at place {wrong[0]}"
        raise ValueError(f"opacity is {table[wrong[0]]:g}{where}; give numbers from 0 to 1")
    if len(table) > n_colors:
        raise ValueError(f"opacity has {len(table)} entries for n_colors={n_colors}; give fewer, or more colours")
    return np.interp(np.linspace(0.0, 1.0, n_colors), np.linspace(0.0, 1.0, len(table)), table)


def surface_values(given: Any, bounds: tuple[float, float]) -> tuple[float, ...]:
    """Return the values of surfaces: those given, or one in the middle of the volume's."""
    if given is None:
        return (0.5 * bounds[0] + 0.5 * bounds[1],)
    values = np.asarray(given)
    if values.dtype.kind not in "buif" or values.ndim > 1:
        raise ValueError(f"values is {given!r}; give the value of a surface, or a list of values")
    return tuple(values.astype(np.float64).ravel().tolist())


def surface_opacities(given: Any, count: int) -> tuple[float, ...] | None:
    """Return an opacity for each of some surfaces, or None where none is given."""
    if given is None:
        return None
    numbers = np.asarray([given] * count if is_number(given) else given)
    fine = numbers.dtype.kind in "buif" and numbers.shape == (count,) and bool(((numbers >= 0) & (numbers <= 1)).all())
    if not fine:
        raise ValueError(
            f"surface_opacities is {given!r}; give a number from 0 to 1, or one for each of the {count} values"
        )
    return tuple(numbers.astype(np.float64).tolist())


def surface_colours(given: Any, count: int) -> list[pv.Color] | None:
    """Return a colour for each of some surfaces, or None where none is given."""
    if given is None:
        return None
    if isinstance(given, str) or not isinstance(given, (Sequence, np.ndarray)) or len(given) != count:
        raise ValueError(f"surface_colors is {given!r}; give a list of a colour for each of the {count} values")
    return [pv.Color(colour) for colour in given]


def along_logarithm(entries: np.ndarray, clim: tuple[float, ...]) -> np.ndarray:
    """Return entries that lie evenly by value at places that lie evenly by its logarithm."""
    low, high = clim
    places = np.arange(len(entries)) / (len(entries) - 1.0)
    values = low * np.exp(places * np.log(high / low))
    return np.interp((values - low) / (high - low), places, entries)


def from_logarithm(rows: np.ndarray, clim: tuple[float, ...]) -> np.ndarray:
    """Return rows that lie evenly by the values' logarithm at places that lie evenly by value."""
    low, high = clim
    places = np.arange(len(rows)) / (len(rows) - 1.0)
    wanted = np.log1p(places * (high - low) / low) / np.log(high / low)
    return np.column_stack([np.interp(wanted, places, column) for column in rows.T])


def value_limits(given: Any) -> tuple[float, float]:
    """Return the least and the greatest value that is there."""
    if given is None:
        return -math.inf, math.inf
    ends = (given, None) if is_number(given) else given
    fine = isinstance(ends, (Sequence, np.ndarray)) and not isinstance(ends, str) and len(ends) == 2
    if not fine or not all(end is None or is_number(end) for end in ends):
        raise ValueError(f"thresholds is {given!r}; give (low, high); one may be None")
    low, high = ends
    return -math.inf if low is None else float(low), math.inf if high is None else float(high)
