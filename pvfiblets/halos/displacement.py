"""Displacement functions: how far behind its line a halo lies, from its middle to its edge."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from .style import DISPLACEMENTS, TABLE_SIZE

Displacement: TypeAlias = str | Sequence[float] | npt.NDArray[Any] | Callable[[npt.NDArray[np.float64]], Any]
"""Types that :func:`as_displacement` takes: a name, a table, or a function."""

_ROUNDING = 1e-9
"""Greatest excess of a function beyond 0..1, as of a sine of a right angle computed in a roundabout way."""


def as_displacement(given: Displacement) -> str | tuple[float, ...]:
    """Bring a displacement function into the form that :class:`.HaloStyle` takes."""
    # Source: Everts et al. 2009, section 3.3, equation 3 and figure 17. Between its places a table is linear, so that a
    # square root given as a function has an error of 1/32 close to 0, and of less than 0.001 from 0.15 on; the three
    # that have names are exact.
    if isinstance(given, str):
        if given not in DISPLACEMENTS:
            raise ValueError(f"displacement is {given!r}; choose one of {DISPLACEMENTS}, or give a table or a function")
        return given
    if callable(given):
        return _table(given(table_places(TABLE_SIZE)), "the displacement function gives", TABLE_SIZE)
    if isinstance(given, (bytes, dict, set)) or not hasattr(given, "__len__"):
        raise TypeError(
            f"displacement is a {type(given).__name__}; give one of {DISPLACEMENTS}, a table of 2 to {TABLE_SIZE} "
            "numbers in 0..1, or a function of an array in 0..1"
        )
    return _table(given, "the table of the displacement has", None)


def displaced(x: npt.ArrayLike, displacement: Displacement) -> npt.NDArray[np.float64]:
    """Evaluate a displacement function."""
    form = as_displacement(displacement)
    places = np.clip(np.asarray(x, np.float64), 0.0, 1.0)
    if form == "linear":
        return places
    if form == "square":
        return places * places
    if form == "square root":
        return np.asarray(np.sqrt(places))
    return np.asarray(np.interp(places, table_places(len(form)), np.asarray(form, np.float64)))


def table_places(n: int) -> npt.NDArray[np.float64]:
    """``(n,)`` float64: the places of the entries of a table, from 0 to 1."""
    return np.linspace(0.0, 1.0, n)


def _table(given: Any, what: str, size: int | None) -> tuple[float, ...]:
    try:
        table = np.asarray(given, np.float64)
    except (TypeError, ValueError):
        raise ValueError(f"{what} {given!r}, expected numbers in 0..1") from None
    if size is not None and table.ndim == 0:
        table = np.full(size, table)
    if table.ndim != 1 or (len(table) != size if size is not None else not 2 <= len(table) <= TABLE_SIZE):
        expected = f"{size} numbers for an array of that length" if size is not None else f"2 to {TABLE_SIZE} numbers"
        raise ValueError(f"{what} the shape {table.shape}, expected {expected}")
    good = (table >= -_ROUNDING) & (table <= 1.0 + _ROUNDING)
    if not good.all():
        at = int(np.argmin(good))
        place = table_places(len(table))[at]
        raise ValueError(f"{what} {table[at]:g} at {place:g}, expected 0 to 1; divide by the largest, or clip it")
    return tuple(np.clip(table, 0.0, 1.0).tolist())
