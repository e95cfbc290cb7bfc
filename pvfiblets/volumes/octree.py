"""Full octrees of volumes, from level 3 up: what rays may skip or take as one (Lesar 2015, sections III-C and III-E).

A leaf covers ``8 x 8 x 8`` cells, a cell being the space between eight voxel centres; each node above covers eight
nodes, up to one that covers all. Sides are rounded up to whole nodes level by level and not to a power of two, so that
no node is without cells. Per node there are bounds of the field in it, and its mean.

Memory, of volumes with more than 10 voxels along each axis (below that the few nodes count for more):

=============  ==========================  ==========================
voxels         trilinear (`margin` 1)      tricubic (`margin` 2)
=============  ==========================  ==========================
8 bits         6 bytes a node, <= 5 %      8 bytes, <= 6 %
16 bits        8 bytes, <= 4 %             12 bytes, <= 5 %
float32        12 bytes, <= 3 %            12 bytes, <= 3 %
=============  ==========================  ==========================

Of a large volume with few cells beyond a multiple of eight, 8/7 of 1/512 nodes per voxel remain: 1.3 % at 8 bits.

Catmull-Rom's cubic leaves the range of the voxels that it goes through. Along one axis, at t from 0 to 1 between two
voxels, its outer two weights are -t (1 - t)^2 / 2 and -t^2 (1 - t) / 2: together -N, N = t (1 - t) / 2 <= 1/8, and the
inner two sum to 1 + N. The weights' sizes sum to 1 + 2 N <= 5/4, for the product along three axes to at most
125/64, and as the weights themselves sum to 1, the negative ones sum to at least -(125/64 - 1) / 2 = -61/128. Of voxels
from m to M the field is thus within m - 61/128 (M - m) and M + 61/128 (M - m), and both are reached.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from .volume import RaycastVolume

LEAF = 8  # cells along each side of a leaf: level 3

AT_ONCE = 1 << 22
"""Numbers of a volume's leaves that are brought together along one axis at a time: six bytes each, more or less."""

SKIP, VISIT, HOMOGENEOUS = 0, 1, 2  # actions of rays at a node: nothing, look into it, or take it as its mean

OVERSHOOT = 61 / 128  # greatest excess of the tricubic field over the range of its voxels, as a part of that range

Flags = list[npt.NDArray[np.uint8]]


@dataclass(frozen=True, eq=False)
class Level:
    """All nodes of one level: three arrays ``(bx, by, bz)``."""

    least: npt.NDArray[Any]  # bounds of the field in each node
    greatest: npt.NDArray[Any]
    mean: npt.NDArray[np.float32]  # float32, of the trilinear field over the node's cells

    @property
    def shape(self) -> tuple[int, int, int]:
        """Nodes along each axis."""
        bx, by, bz = self.mean.shape
        return bx, by, bz


@dataclass(frozen=True, eq=False)
class Octree:
    """A full octree."""

    # the leaves first; node `(i, j, k)` of level `l` covers the cells from `leaf * 2^l * (i, j, k)` on. The last level
    # has one node.
    levels: tuple[Level, ...]
    leaf: int = LEAF  # cells along each side of a leaf
    margin: int = 1  # 1: bounds hold of the nearest and the trilinear field. 2: of the tricubic field too.

    @cached_property
    def nbytes(self) -> int:
        """Bytes of all nodes."""
        return sum(level.least.nbytes + level.greatest.nbytes + level.mean.nbytes for level in self.levels)

    @cached_property
    def n_nodes(self) -> int:
        """Nodes of all levels."""
        return sum(level.mean.size for level in self.levels)


def build_octree(volume: RaycastVolume, margin: int = 1) -> Octree:
    """Build a volume's octree for a reconstruction that reads `margin` voxels on each side of a cell."""
    # A margin of 2 is the tricubic one: bounds are widened by how far cubics overshoot, beyond the volume's type.
    if margin not in (1, 2):
        raise ValueError(f"margin={margin!r}; expected 1 (nearest, trilinear) or 2 (tricubic)")
    # Slices across the axis along which neighbours lie farthest apart in memory are read as they lie.
    order = np.argsort([-abs(stride) for stride in volume.values.strides], kind="stable")
    values = volume.values.transpose(order)
    at_once = max(1, AT_ONCE // (values.shape[1] * values.shape[2]))
    found = []
    for first in range(0, len(_cells(values.shape[0])), at_once):
        least = greatest = values
        mean: npt.NDArray[Any] = values
        for axis in range(3):
            rows = slice(first, first + at_once) if axis == 0 else slice(None)
            least, greatest, mean = _leaves_along(axis, least, greatest, mean, margin, rows)
        found.append((least, greatest, mean))
    least, greatest, mean = (np.concatenate(parts) for parts in zip(*found, strict=True))
    back = np.argsort(order)
    least, greatest, mean = (np.ascontiguousarray(array.transpose(back)) for array in (least, greatest, mean))
    if margin == 2:
        least, greatest = _widened(least, greatest)
    levels = [Level(least, greatest, mean)]
    cells = [_cells(n) for n in volume.shape]
    while max(levels[-1].shape) > 1:
        above, cells = _parents(levels[-1], cells)
        levels.append(above)
    return Octree(tuple(levels), LEAF, margin)


def flags(octree: Octree, visible: Callable[[npt.NDArray[Any], npt.NDArray[Any]], npt.NDArray[np.bool_]]) -> Flags:
    """Return which nodes rays must look into."""
    leaves = octree.levels[0]
    seen = [np.where(visible(leaves.least, leaves.greatest), VISIT, SKIP).astype(np.uint8)]
    while len(seen) < len(octree.levels):
        seen.append(_pooled(seen[-1], np.maximum))
    return seen


def homogeneous(octree: Octree, threshold: float, seen: Flags | None = None) -> Flags:
    """Mark nodes whose field is about the same everywhere."""
    if not 0.0 <= threshold < np.inf:
        raise ValueError(f"the threshold of homogeneous nodes is {threshold!r}; expected a finite number, 0 or above")
    marked = []
    for level, node in enumerate(octree.levels):
        before = np.full(node.shape, VISIT, np.uint8) if seen is None else seen[level]
        even = np.subtract(node.greatest, node.least, dtype=np.float64) <= threshold
        marked.append(np.where(even & (before != SKIP), HOMOGENEOUS, before).astype(np.uint8))
    return marked


def _cells(n: int) -> npt.NDArray[np.int64]:
    """Cells along an axis of n voxels in each of its leaves."""
    starts = np.arange(0, n - 1, LEAF)
    return np.minimum(n - 1 - starts, LEAF)


def _leaves_along(
    axis: int,
    least: npt.NDArray[Any],
    greatest: npt.NDArray[Any],
    mean: npt.NDArray[Any],
    margin: int,
    rows: slice,
) -> tuple[npt.NDArray[Any], npt.NDArray[Any], npt.NDArray[np.float32]]:
    """Bring voxels along one axis together to some of its leaves, a slice at a time: such slices lie well in memory."""
    n = mean.shape[axis]
    cells = _cells(n)
    starts = (LEAF * np.arange(len(cells)))[rows]
    cells = cells[rows]
    shape = [-1 if i == axis else 1 for i in range(3)]
    low, high = np.take(least, starts, axis), np.take(greatest, starts, axis)
    total = np.zeros(low.shape, np.float32)
    for k in range(1 - margin, LEAF + margin):
        at = np.clip(starts + k, 0, n - 1)
        lower = np.take(least, at, axis)
        upper = lower if greatest is least else np.take(greatest, at, axis)
        np.minimum(low, lower, out=low)
        np.maximum(high, upper, out=high)
        if 0 <= k <= LEAF:
            # The mean of linear pieces: the ends count half.
            inside = (np.where((k > 0) & (k < cells), 1.0, 0.5) * (k <= cells) / cells).astype(np.float32)
            part = lower if mean is least else np.take(mean, at, axis)
            total += part * inside.reshape(shape)
    return low, high, total


def _widened(least: npt.NDArray[Any], greatest: npt.NDArray[Any]) -> tuple[npt.NDArray[Any], npt.NDArray[Any]]:
    """Bounds of the cubic through voxels within these."""
    low, high = least.astype(np.float64), greatest.astype(np.float64)
    room = OVERSHOOT * (high - low)
    low, high = low - room, high + room
    if least.dtype.kind in "ui":
        wide = np.int16 if least.dtype.itemsize == 1 else np.int32
        return np.floor(low).astype(wide), np.ceil(high).astype(wide)
    limit = np.finfo(np.float32).max
    low, high = np.clip(low, -limit, limit).astype(np.float32), np.clip(high, -limit, limit).astype(np.float32)
    # A constant node stays constant: nothing was added that could have been rounded.
    moved = room > 0
    return (
        np.where(moved, np.nextafter(low, np.float32(-limit)), low),
        np.where(moved, np.nextafter(high, np.float32(limit)), high),
    )


def _parents(level: Level, cells: list[npt.NDArray[np.int64]]) -> tuple[Level, list[npt.NDArray[np.int64]]]:
    """The level above, and the cells along each axis of its nodes."""
    above = [np.add.reduceat(n, np.arange(0, len(n), 2)) for n in cells]
    mean = level.mean.astype(np.float64)
    for axis in range(3):
        shape = [-1 if i == axis else 1 for i in range(3)]
        total = np.add.reduceat(mean * cells[axis].reshape(shape), np.arange(0, mean.shape[axis], 2), axis)
        mean = total / above[axis].reshape(shape)
    least, greatest = _pooled(level.least, np.minimum), _pooled(level.greatest, np.maximum)
    return Level(least, greatest, mean.astype(np.float32)), above


def _pooled(nodes: npt.NDArray[Any], of: np.ufunc) -> npt.NDArray[Any]:
    """One number for each two nodes along every axis."""
    for axis in range(3):
        nodes = of.reduceat(nodes, np.arange(0, nodes.shape[axis], 2), axis)
    return nodes
