"""Changes to float64 arrays by writers that hold float32 only, and a warning of them."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from os import PathLike
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pvfiblets.formats.mapped import forget

_BLOCK = 1 << 20  # rows looked at together
_POINTS = 1e-3  # mm
_VALUES = 1e-5  # of an array's range


def largest_change(array: NDArray[Any]) -> float:
    """Return by how much float32 changes a number at most; of mapped arrays nothing stays in memory."""
    return _change_and_range(array)[0]


def _change_and_range(array: NDArray[Any]) -> tuple[float, float]:
    most, low, high = 0.0, np.inf, -np.inf
    for first in range(0, len(array), _BLOCK):
        block = array[first : first + _BLOCK]
        with np.errstate(over="ignore", invalid="ignore"):
            changes = np.abs(block - block.astype(np.float32))[np.isfinite(block)]
        finite = block[np.isfinite(block)]
        if finite.size:
            most, low, high = max(most, float(changes.max())), min(low, finite.min()), max(high, finite.max())
        forget(array, 0, min(first + _BLOCK, len(array)))
    return most, float(high - low) if high >= low else 0.0


def warn_of_changes(path: str | PathLike[str], moved: float, values: Mapping[str, NDArray[Any]], fix: str) -> None:
    """Warn of points that move by more than a micrometre, and of values that change by 1e-5 of their range."""
    told = []
    if moved > _POINTS:
        told.append(f"points by up to {moved:.2g} mm")
    for name, array in values.items():
        if array.dtype == np.float64:
            change, spread = _change_and_range(array)
            if change > _VALUES * spread:
                told.append(f"{name!r} by up to {change:.2g} (its range is {spread:.3g})")
    if told:
        warnings.warn(f"{path}: float32, all that the format holds, changes {', '.join(told)}; {fix}", stacklevel=4)
