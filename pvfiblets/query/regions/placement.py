"""Placement of shapes: checked vectors and frames, and bounds that may be infinite."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]


def finite_vector(value: npt.ArrayLike, name: str, length: int = 3) -> Array:
    """Return `value` as ``(length,)`` float64; a ValueError that names it unless it is that many finite numbers."""
    found = np.array(value, np.float64)
    if found.shape != (length,) or not np.isfinite(found).all():
        raise ValueError(f"{name} is {np.asarray(value).tolist()}; give {length} finite numbers")
    return found


def positions(points: npt.ArrayLike) -> Array:
    """Return `points` as ``(n, 3)`` float64; a ValueError unless they are three numbers each."""
    found = np.asarray(points, np.float64)
    if found.ndim == 1 and found.size == 3:
        found = found[None]
    if found.size == 0:
        found = found.reshape(0, 3)
    if found.ndim != 2 or found.shape[1] != 3:
        raise ValueError(f"points have shape {found.shape}; give (n, 3): x, y, z in mm")
    return found


def positive(value: Any, name: str) -> float:
    """Return `value`, a finite number above 0, or raise a ValueError that names it."""
    found = float(value)
    if not (np.isfinite(found) and found > 0.0 and np.isfinite(2.0 / found)):
        raise ValueError(f"{name} is {found}; give a finite number of mm above 0")
    return found


def frame_about(normal: npt.ArrayLike, name: str) -> Array:
    """Return ``(3, 3)``: a right-handed orthonormal frame in rows, the last along `normal`."""
    given = finite_vector(normal, name)
    largest = np.abs(given).max()
    if largest == 0.0:
        raise ValueError(f"{name} is {given.tolist()}; give a direction that is not 0")
    given = given / largest
    z = given / np.linalg.norm(given)
    x = np.cross(np.eye(3)[np.abs(z).argmin()], z)
    x /= np.linalg.norm(x)
    return np.stack([x, np.cross(z, x), z])


@dataclass(frozen=True, eq=False)
class Bounds:
    """Corners ``(3,)`` in mm, infinite where unbounded; empty if a low one exceeds its high one."""

    low: Array
    high: Array

    @staticmethod
    def everything() -> Bounds:
        """Return bounds without an end."""
        return Bounds(np.full(3, -np.inf), np.full(3, np.inf))

    @staticmethod
    def of_half_space(normal: Array, origin: Array) -> Bounds:
        """Return the bounds of ``(p - origin) . normal >= 0``: an end at most, where the normal is along an axis."""
        found = Bounds.everything()
        (axes,) = np.nonzero(normal)
        if len(axes) == 1:
            side = found.low if normal[axes[0]] > 0.0 else found.high
            side[axes[0]] = origin[axes[0]]
        return found

    @property
    def empty(self) -> bool:
        """Whether the region is empty."""
        return not bool((self.low <= self.high).all())

    def __and__(self, other: Bounds) -> Bounds:
        return Bounds(np.maximum(self.low, other.low), np.minimum(self.high, other.high))

    def __or__(self, other: Bounds) -> Bounds:
        if self.empty or other.empty:
            return other if self.empty else self
        return Bounds(np.minimum(self.low, other.low), np.maximum(self.high, other.high))

    def flat(self) -> Array:
        """Return ``(6,)``: xmin, xmax, …; 1, -1, … if empty."""
        if self.empty:
            return np.array([1.0, -1.0] * 3)
        return np.stack([self.low, self.high], axis=1).ravel()
