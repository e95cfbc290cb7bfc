"""One more number per point for a set that is compressed already."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from .fibletset import FibletSet
from .quantised import quantise_values

__all__ = ["with_coded_values", "with_point_values"]


def with_point_values(fiblets: FibletSet, name: str, values: npt.ArrayLike, bits: int = 8) -> FibletSet:
    """Return a set that shares the arrays of another one and has one with a number per point more.

    Parameters
    ----------
    fiblets : FibletSet
        Stays as it is.
    name : str
        Of the array; one of that name is replaced.
    values : array_like
        ``(n_points,)`` numbers in the order of the streamlines.
    bits : {8, 16}
        Bits for each of them.

    Returns
    -------
    FibletSet
    """
    return with_coded_values(fiblets, name, fiblets.in_coded_order(values), bits)


def with_coded_values(fiblets: FibletSet, name: str, values: npt.ArrayLike, bits: int = 8) -> FibletSet:
    """Do the same with numbers in the order in which points are coded."""
    numbers = np.asarray(values, np.float64)
    finite = numbers[np.isfinite(numbers)]
    low, high = (float(finite.min()), float(finite.max())) if len(finite) else (0.0, 1.0)
    return replace(fiblets, per_point={**fiblets.per_point, name: quantise_values(numbers, low, high, bits)})
