"""The planes of a region: a plane, a slab or a box that holds all else needs no boundaries for each pixel.

A region that is the intersection of its parts, as several cuts of a user are, is cut by part after part.
Planes, slabs and boxes among them are half spaces, which a view takes as clip planes (:mod:`.clipping`): 16 bytes
each, and not 16 a pixel. The rest stays a region (:mod:`.cutting`).
"""

from __future__ import annotations

import operator
from dataclasses import dataclass
from functools import reduce
from typing import TYPE_CHECKING

import numpy as np

from ...query.regions.shapes import AND, BOX, LABELS, NOT, PLANE, SLAB, Shape

if TYPE_CHECKING:
    from ...query.regions.region import Region
    from ..frame import Array

SIDES = {
    PLANE: np.array([[0.0, 0, 1, 0]]),
    SLAB: np.array([[0.0, 0, 1, 1], [0, 0, -1, 1]]),
    BOX: np.array([[1.0, 0, 0, 1], [-1, 0, 0, 1], [0, 1, 0, 1], [0, -1, 0, 1], [0, 0, 1, 1], [0, 0, -1, 1]]),
}
"""Planes around each kind of shape, as rows over homogeneous unit coordinates (u, v, w, weight)."""


def check_region(region: Region) -> None:
    """Raise for regions without crossings along a ray."""
    if any(leaf.kind == LABELS for leaf in region.leaves):
        raise ValueError(
            "a label volume cannot cut, as it has no surface to cut at: use it to filter streamlines, or cut by a "
            "closed surface around the labels, e.g. pyvista's contour_labels()"
        )


def planes_of(region: Region | None, room: int) -> tuple[Array, Region | None]:
    """Take those parts out of a region that are planes."""
    planes, rest = [np.zeros((0, 4))], []
    for part in () if region is None else _parts(region).all_of:
        found = _half_spaces(part)
        if found is not None and len(found) <= room:
            planes.append(found)
            room -= len(found)
        else:
            rest.append(part)
    return np.concatenate(planes), reduce(operator.and_, rest) if rest else None


def _half_spaces(part: Region) -> Array | None:
    """Return ``(k, 4)`` planes that all of a part lies within and nothing else; None if there are none."""
    leaf = part.leaves[0]
    if part.program == (0,) and leaf.kind in SIDES:
        return placed_sides(leaf)
    if part.program == (0, NOT) and leaf.kind == PLANE:
        return _placed(leaf, -SIDES[PLANE])
    return None


def placed_sides(leaf: Shape) -> Array:
    """Return ``(k, 4)`` rows over mm of the planes around a plane, a slab or a box."""
    return _placed(leaf, SIDES[leaf.kind])


def _placed(leaf: Shape, sides: Array) -> Array:
    """Return rows over unit coordinates of a shape as rows over mm."""
    rows = sides[:, :3] @ leaf.linear
    placed: Array = np.column_stack([rows, sides[:, 3] - rows @ leaf.centre])
    return placed


@dataclass(frozen=True)
class _Parts:
    """An expression in two ways: what all of some regions hold, or what any of some holds."""

    all_of: tuple[Region, ...]
    any_of: tuple[Region, ...]


def _parts(region: Region) -> _Parts:
    stack: list[_Parts] = []
    for word in region.program:
        if word >= 0:
            leaf = (region.leaves[word],)
            stack.append(_Parts(leaf, leaf))
        elif word == NOT:
            top = stack.pop()
            stack.append(_Parts(tuple(~part for part in top.any_of), tuple(~part for part in top.all_of)))
        else:
            top, below = stack.pop(), stack.pop()
            if word == AND:
                both = below.all_of + top.all_of
                stack.append(_Parts(both, (reduce(operator.and_, both),)))
            else:
                either = below.any_of + top.any_of
                stack.append(_Parts((reduce(operator.or_, either),), either))
    return stack[0]
