"""Positions of slices: three directions, the pixels of a plane, and the part of it that images cover."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import combinations
from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

ORIENTATIONS = ("axial", "coronal", "sagittal")

_AXES = {"axial": (0, 1), "coronal": (0, 2), "sagittal": (1, 2)}
"""Which directions of a frame (right, anterior, superior) run along and up the slices of an orientation."""

_EDGES = [
    (a, b)
    for a, b in combinations(range(8), 2)
    if bin(a ^ b).count("1") == 1  # corners whose numbers differ in one bit
]

MOST_PIXELS = 2048  # along a side of a slice


@dataclass(frozen=True, eq=False)
class PlaneGrid:
    """Pixels of a plane."""

    corner: Array  # `(3,)` mm: the outer corner of the first pixel
    along: Array  # `(3,)` mm from a pixel to the next
    up: Array
    shape: tuple[int, int]  # pixels along and up

    @property
    def first(self) -> Array:
        """``(3,)`` mm: the centre of the first pixel."""
        return self.corner + 0.5 * (self.along + self.up)

    def to_voxels(self, inverse: Array) -> Array:
        """Return the ``(4, 4)`` matrix from pixels ``(x, y, 0)`` to an image's voxel indices."""
        matrix = np.eye(4)
        matrix[:3, 0], matrix[:3, 1], matrix[:3, 2] = self.along, self.up, np.cross(self.along, self.up)
        matrix[:3, 3] = self.first
        return inverse @ matrix

    def positions(self) -> Array:
        """Return ``(height, width, 3)`` mm: the centres of all pixels."""
        x, y = np.arange(self.shape[0])[None, :, None], np.arange(self.shape[1])[:, None, None]
        return self.first + x * self.along + y * self.up


def plane_axes(frame: Array, orientation: str) -> tuple[Array, Array]:
    """Return the directions along and up the slices of an orientation; the columns of a frame are R, A and S."""
    along, up = _AXES[orientation]
    return frame[:, along], frame[:, up]


def nearest_frame(affine: Array) -> Array:
    """Return the right-handed directions R, A and S that come nearest to an image's axes, sheared ones, too."""
    u, _, vh = np.linalg.svd(affine[:3, :3] / np.linalg.norm(affine[:3, :3], axis=0))
    axes = u @ vh
    left = {0, 1, 2}
    order: list[int] = [0, 0, 0]
    for world, own in sorted(np.ndindex(3, 3), key=lambda at: -abs(axes[at])):  # the nearest pairs first
        if own in left and order[world] == 0:
            order[world] = own + 1
            left.discard(own)
    frame = axes[:, [own - 1 for own in order]]
    frame = frame * np.where(np.diag(frame) < 0.0, -1.0, 1.0)
    if np.linalg.det(frame) < 0.0:  # far from all of the axes of space: two signs cannot both be as wished
        frame[:, int(np.argmin(abs(np.diag(frame))))] *= -1.0
    return frame


def covered(corners: Iterable[Array], position: Array, along: Array, up: Array) -> Array | None:
    """Return what of a plane lies in any of some parallelepipeds."""
    normal = np.cross(along, up)
    found: list[Array] = []
    for one in corners:
        away = (one - position) @ normal
        flat = np.stack([(one - position) @ along, (one - position) @ up], axis=1)
        for a, b in _EDGES:
            low, high = away[a], away[b]
            if low == high:
                if low == 0.0:
                    found.extend((flat[a], flat[b]))
            elif min(low, high) <= 0.0 <= max(low, high):
                found.append(flat[a] + (flat[b] - flat[a]) * (low / (low - high)))
    if not found:
        return None
    points = np.array(found)
    low, high = points.min(axis=0), points.max(axis=0)
    return np.array([low[0], high[0], low[1], high[1]]) if (high > low).all() else None


def grid_of(bounds: Any, position: Array, along: Array, up: Array, pixel: float) -> PlaneGrid:
    """Return the pixels, of about a size in mm, of a rectangle of a plane as `covered` returns it."""
    sides = np.array([bounds[1] - bounds[0], bounds[3] - bounds[2]], np.float64)
    n = np.clip(np.ceil(sides / pixel - 1e-6), 1, MOST_PIXELS).astype(int)
    corner = position + bounds[0] * along + bounds[2] * up
    return PlaneGrid(corner, along * (sides[0] / n[0]), up * (sides[1] / n[1]), (int(n[0]), int(n[1])))


def letters(direction: Array) -> str:
    """Return R or L, A or P, S or I: to which side a direction points; two or three if it is oblique."""
    parts = [
        (abs(float(part)), pair[0] if part > 0.0 else pair[1])
        for part, pair in zip(direction, ("RL", "AP", "SI"), strict=True)
    ]
    parts.sort(key=lambda part: -part[0])
    return "".join(letter for size, letter in parts if size > 0.2 * parts[0][0])


def checked_position(name: str, given: Any) -> Array:
    """Return three finite numbers."""
    try:
        found = np.array(given, np.float64)
    except (TypeError, ValueError):
        found = np.zeros(0)
    if found.shape != (3,) or not np.isfinite(found).all():
        raise ValueError(f"{name} is {given!r}; give three finite numbers")
    return found


def checked_frame(given: Any) -> Array:
    """Return three unit directions at right angles, right-handed, as columns."""
    try:
        found = np.array(given, np.float64)
    except (TypeError, ValueError):
        found = np.zeros(0)
    good = found.shape == (3, 3) and np.isfinite(found).all()
    if not good or abs(found.T @ found - np.eye(3)).max() > 1e-4 or np.linalg.det(found) < 0.0:
        raise ValueError(
            f"axes is {given!r}; give a (3, 3) rotation whose columns point to the right, to the front and up, in mm"
        )
    return found


def turned(axes: tuple[Array, Array], normal: Any) -> tuple[Array, Array]:
    """Return two directions of a plane turned, by the least angle, until they stand at right angles to a normal."""
    n = checked_position("normal", normal)
    length = float(np.linalg.norm(n))
    if length == 0.0:
        raise ValueError("normal is (0, 0, 0); give a direction")
    n = n / length
    along, up = axes
    flat = along - n * float(n @ along)
    if np.linalg.norm(flat) < 1e-3:  # it points along the slice: its other direction decides
        flat = np.cross(up, n)
    flat = flat / np.linalg.norm(flat)
    return flat, np.cross(n, flat)
