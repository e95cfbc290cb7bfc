"""Affine matrices: checked, and inverted where their inverse is worth the name."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

_WORST_CONDITION = 1e12  # beyond, a float64 inverse has fewer than four digits left


def affine(matrix: npt.ArrayLike, name: str) -> Array:
    """Return `matrix` as ``(4, 4)`` float64; a ValueError unless it is finite and ends in 0, 0, 0, w."""
    try:
        found = np.array(matrix, np.float64)
    except (TypeError, ValueError):
        found = np.zeros(0)
    if found.shape == (4, 4) and found[3, 3] not in (0.0, 1.0):
        found = found / found[3, 3]
    if found.shape != (4, 4) or not np.isfinite(found).all() or found[3].tolist() != [0.0, 0.0, 0.0, 1.0]:
        given = found.tolist() if found.size else matrix
        raise ValueError(f"{name} is {given}; give a finite (4, 4) matrix whose last row is 0, 0, 0, 1")
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
