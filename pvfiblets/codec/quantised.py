"""Values stored per point in one or two bytes, with the error that costs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

__all__ = ["QuantisedPoints", "quantise_values"]


@dataclass(frozen=True)
class QuantisedPoints:
    """One value per point, evenly quantised over its range.

    Attributes
    ----------
    codes : numpy.ndarray
        ``(n_points,)`` uint8 or uint16; the largest code means NaN.
    lo, hi : float
        Values of code 0 and of the largest code but one.
    max_error : float
        Largest difference to the original values, in their unit (measured, not estimated).
    """

    codes: npt.NDArray[Any]
    lo: float
    hi: float
    max_error: float

    @property
    def levels(self) -> int:
        """Number of codes that mean a value."""
        return int(np.iinfo(self.codes.dtype).max)

    def values(self, index: Any = slice(None)) -> npt.NDArray[np.float32]:
        """Decode.

        Parameters
        ----------
        index : slice or array_like, optional
            Which points; all by default.

        Returns
        -------
        numpy.ndarray
            float32; NaN where the original was not finite.
        """
        codes = self.codes[index]
        values = self.lo + (self.hi - self.lo) * codes.astype(np.float64) / (self.levels - 1)
        values[codes == self.levels] = np.nan
        return values.astype(np.float32)


def quantise_values(values: npt.ArrayLike, lo: float, hi: float, bits: int = 8) -> QuantisedPoints:
    """Quantise one value per point."""
    if bits not in (8, 16):
        raise ValueError(f"per_point_bits is {bits}; 8 or 16 is needed")
    column = np.asarray(values, np.float64)
    if column.ndim != 1:
        raise ValueError(f"per-point values of shape {column.shape} cannot be stored; one number per point is needed")
    dtype = np.uint8 if bits == 8 else np.uint16
    levels = int(np.iinfo(dtype).max)
    finite = np.isfinite(column)
    scaled = np.zeros_like(column)
    if hi > lo:
        np.divide(column - lo, hi - lo, out=scaled, where=finite)
    codes = np.full(len(column), levels, dtype)
    codes[finite] = np.rint(np.clip(scaled[finite], 0.0, 1.0) * (levels - 1)).astype(dtype)
    coded = QuantisedPoints(codes, float(lo), float(hi), 0.0)
    error = 0.0
    if finite.any():
        error = float(np.abs(coded.values()[finite].astype(np.float64) - column[finite]).max())
    return QuantisedPoints(codes, float(lo), float(hi), error)
