"""Numbers and arrays of users as real numbers."""

from __future__ import annotations

import math
from numbers import Real

import numpy as np
import numpy.typing as npt

__all__ = ["is_number", "real_numbers"]


def real_numbers(given: npt.ArrayLike, what: str) -> npt.NDArray[np.float64]:
    """Return an array as float64; ValueError for complex numbers, texts and other things."""
    array = np.asarray(given)
    if array.dtype.kind == "O":  # such as a column of a table, whose missing values are None
        try:
            return array.astype(np.float64)
        except (TypeError, ValueError):
            pass
    if array.dtype.kind not in "fiub":
        raise ValueError(f"{what} have the type {array.dtype}, expected real numbers")
    return array.astype(np.float64, copy=False)


def is_number(value: object) -> bool:
    """Return whether a value is a finite number, of NumPy's or of Python's, and no bool."""
    return isinstance(value, Real) and not isinstance(value, bool) and math.isfinite(value)
