"""What shapes are placed by: checked vectors, frames and affine matrices, and bounds that may be infinite."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

__all__ = ["Bounds", "affine", "finite_vector", "frame_about", "invert_affine", "positions", "positive"]

Array = npt.NDArray[np.float64]

_WORST_CONDITION = 1e12
"""Beyond, a float64 inverse has fewer than four digits left."""


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


def affine(matrix: npt.ArrayLike, name: str) -> Array:
    """Return `matrix` as ``(4, 4)`` float64; a ValueError unless it is finite and ends in 0, 0, 0, w."""
    found = np.array(matrix, np.float64)
    if found.shape == (4, 4) and found[3, 3] not in (0.0, 1.0):
        found = found / found[3, 3]
    if found.shape != (4, 4) or not np.isfinite(found).all() or found[3].tolist() != [0.0, 0.0, 0.0, 1.0]:
        raise ValueError(f"{name} is {found.tolist()}; give a finite (4, 4) matrix whose last row is 0, 0, 0, 1")
    return found


def invert_affine(matrix: Array, name: str) -> Array:
    """Return the inverse of an affine ``(4, 4)`` matrix; a ValueError where it has none worth the name."""
    values = np.linalg.svd(matrix[:3, :3], compute_uv=False)
    if not values[2] * _WORST_CONDITION > values[0]:
        raise ValueError(f"{name} is {matrix.tolist()}, which flattens space; give one that can be inverted")
    inverse = np.eye(4)
    inverse[:3, :3] = np.linalg.inv(matrix[:3, :3])
    inverse[:3, 3] = -(inverse[:3, :3] @ matrix[:3, 3])
    if not np.isfinite(inverse).all():
        raise ValueError(f"{name} is {matrix.tolist()}, whose inverse is not finite; give one nearer to 1 in scale")
    return inverse


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
        """Whether there is nothing within."""
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
