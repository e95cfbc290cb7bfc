"""The number to subtract from an array before it becomes float32, which keeps steps of 128 s of 1.7e9 s.

Every drawable has ``value_reference(name)``. What is uploaded is ``relative(values, reference)``; ranges, thresholds
and isovalues of that array have the same reference subtracted in float64 before they become uniforms, and whatever is
read back has it added. Users see true numbers everywhere.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

_SAMPLE = 1 << 16  # values looked at
_NEAR = 16.0  # numbers at most so many spreads from 0 lose at most 2e-6 of the spread in float32


def value_reference(values: npt.NDArray[Any]) -> float:
    """Return the value to subtract from an array so that float32 holds the differences, or 0.0 if it needs none."""
    if values.dtype.kind == "b" or values.dtype.itemsize <= 2:
        return 0.0
    flat = values.ravel(order="K")[:: max(values.size // _SAMPLE, 1)]
    sample = np.sort(flat[np.isfinite(flat)]).astype(np.float64)
    if not len(sample):
        return 0.0
    typical = float(sample[len(sample) // 2])
    low, high = (float(sample[int(share * (len(sample) - 1))]) for share in (0.01, 0.99))
    with np.errstate(over="ignore"):
        exact = float(np.float32(typical)) == typical and low == high
    return 0.0 if exact or abs(typical) <= _NEAR * (high - low) else typical


def relative(values: npt.ArrayLike, reference: float) -> npt.NDArray[np.float64]:
    """Return the values less a reference, subtracted in float64; infinities and NaN stay."""
    numbers = np.asarray(values, np.float64)
    return numbers - reference if reference else numbers
