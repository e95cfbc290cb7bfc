"""Distances of a box's voxels from a set of voxels, so that kernels can skip the space between.

Distances count steps to the 26 voxels about one: a box that reaches fewer voxels from its middle meets none of the set.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

FAR = 16  # greatest stored distance; larger ones are stored as this
LARGE = 1 << 18  # voxels of a box from which distances are stored more coarsely


class FreeSpace(NamedTuple):
    """A lower bound of the distance to a set, for each voxel of a box."""

    steps: npt.NDArray[np.uint8]  # `(i, j, k)` uint8 voxels to the nearest of the set: 0 in the set, `FAR` at most
    first: npt.NDArray[np.int64]  # `(3,)` int64: the box's first voxel

    @classmethod
    def from_bits(cls, bits: npt.NDArray[np.uint8], bit: int, box: npt.ArrayLike, *, beyond: bool = False) -> FreeSpace:
        """Return it of the voxels within a box that have a bit, or of all others."""
        low, high = np.asarray(box, float).reshape(2, 3)
        if not (low < high).all():
            return cls(np.full((1, 1, 1), FAR, np.uint8), np.zeros(3, np.int64))
        first, stop = low.astype(np.int64), high.astype(np.int64)
        near = bits[tuple(slice(a, b) for a, b in zip(first, stop, strict=True))] & bit != 0
        if beyond:
            near = np.pad(~near, 1, constant_values=True)
        steps = np.where(near, 0, 1).astype(np.uint8)
        reach = 0
        while reach + 1 < FAR:
            more = 1 if near.size < LARGE else reach + 1
            for axis in range(3):
                _widen(near, axis, more)
            reach += more
            steps[~near] = reach + 1
        return cls(np.ascontiguousarray(steps[1:-1, 1:-1, 1:-1]) if beyond else steps, first)


def _widen(near: npt.NDArray[np.bool_], axis: int, by: int) -> None:
    """Grow a set along an axis, both ways, in place."""
    lines: Any = np.moveaxis(near, axis, 0)
    for one in (lines, lines[::-1]):
        covered = 0
        while covered < by:
            more = min(covered + 1, by - covered)
            one[more:] |= one[:-more].copy()
            covered += more
