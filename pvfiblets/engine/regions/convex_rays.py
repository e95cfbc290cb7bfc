"""Intersections of rays with convex shapes, and their expression: the block of ``shaders/regions/rays.glsl``.

All matrices are composed in float64, and expanded about a leaf's own centre in the picture, so that float32 holds the
remainder to the last digits.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ...query.regions.region import MAX_LEAVES
from ...query.regions.shapes import AND, BOX, NOT, SPHERE, SURFACE
from ..frame import Array
from ..gl.uniform_struct import Field, UniformStruct
from .clip_planes import SIDES

if TYPE_CHECKING:
    from ...query.regions.shapes import Region, Shape

_ROWS = 6
_PLANES, _SPHERE, _SURFACE = range(3)

RAYS_BLOCK = UniformStruct(
    "Rays",
    Field("rays_rows", f"vec4[{_ROWS * MAX_LEAVES}]", f"{_ROWS} a leaf: of planes, or of a sphere"),
    Field("rays_centres", f"vec3[{MAX_LEAVES}]", "c of each leaf"),
    Field("rays_rectangles", f"ivec4[{MAX_LEAVES}]", "of a surface: left, lower, right, upper pixel that it may touch"),
    Field("rays_first_layers", f"int[{MAX_LEAVES}]", "of a surface, among all surfaces' layers"),
    Field("rays_layer_counts", f"int[{MAX_LEAVES}]", "of a surface"),
    Field("rays_first_tallies", f"int[{MAX_LEAVES}]", "of a surface, among all surfaces' tallies; -1: it has none"),
)


def to_unit(leaf: Shape, offset: Array) -> Array:
    """Return (4, 4): local mm, with 0 at `offset` (data mm), to a shape's unit coordinates."""
    found = np.eye(4)
    found[:3, :3] = leaf.linear
    found[:3, 3] = leaf.linear @ (offset - leaf.centre)
    return found


def window_matrix(to_clip: Array, size: tuple[int, int]) -> Array:
    """Return (4, 4): local mm to homogeneous window coordinates, as in ``shaders/frame/blocks.glsl``."""
    x, y, z, w = to_clip
    return np.array([size[0] / 2 * (x + w), size[1] / 2 * (y + w), (z + w) / 2, w])


def _expanded(rows: Array, about: Array) -> Array:
    """Rewrite rows over (q, 1) as rows over (q - about, 1)."""
    rows = rows.copy()
    rows[:, 3] += rows[:, :3] @ about
    return rows


def _scaled(values: Array, size: tuple[int, int]) -> Array:
    """Scale rows over (d, 1), one by one, to what float32 holds; numbers too small to matter become 0."""
    span = np.array([*size, 1.0, 1.0])
    largest = np.abs(values * span).max(axis=1, keepdims=True)
    values = values / np.where(largest > 0.0, largest, 1.0)
    return np.where(np.abs(values * span) < 1e-30, 0.0, values)


def _centre(window: Array, place: Array, size: tuple[int, int]) -> Array:
    """Return (3,): window coordinates of a leaf's centre, or what of the picture comes nearest to them."""
    q = window @ place
    if q[3] <= 0.0 or not np.isfinite(q / q[3]).all():
        return np.array([size[0] / 2, size[1] / 2, 0.0])
    return np.clip(q[:3] / q[3], 0.0, [*size, 1.0])


@dataclass(frozen=True)
class RegionSignature:
    """The structure that a program is written for: the kinds of leaves, and the expression that joins them."""

    kinds: tuple[int, ...]  # of each leaf, `pvfiblets.query.regions.shapes.PLANE` and so on
    program: tuple[int, ...]  # as `pvfiblets.query.regions.shapes.Region.program`

    @classmethod
    def from_region(cls, region: Region) -> RegionSignature:
        """Return that of a region."""
        return cls(tuple(leaf.kind for leaf in region.leaves), region.program)

    @property
    def constants(self) -> dict[str, object]:
        """Values of ``{{ name }}`` in ``shaders/regions/combine.frag``."""
        kinds = [_SURFACE if kind == SURFACE else _SPHERE if kind == SPHERE else _PLANES for kind in self.kinds]
        return {
            "leaves": len(kinds),
            "kinds": ", ".join(map(str, kinds)),
            "planes": ", ".join(str(len(SIDES.get(kind, ()))) for kind in self.kinds),
            "expression": self.expression,
        }

    @property
    def bounded(self) -> bool:
        """Whether each leaf is of a kind that has an end in all directions."""
        return all(kind in (BOX, SPHERE, SURFACE) for kind in self.kinds)

    @property
    def far(self) -> bool:
        """Whether the region contains the outside of all leaves."""
        stack: list[bool] = []
        for word in self.program:
            if word >= 0:
                stack.append(False)
            elif word == NOT:
                stack.append(not stack.pop())
            else:
                top, below = stack.pop(), stack.pop()
                stack.append(top and below if word == AND else top or below)
        return stack[0]

    @property
    def expression(self) -> str:
        """The region in GLSL, of ``LEAF(k)``."""
        stack: list[str] = []
        for word in self.program:
            if word >= 0:
                stack.append(f"LEAF({word})")
            elif word == NOT:
                stack.append(f"!{stack.pop()}")
            else:
                top = stack.pop()
                stack.append(f"({stack.pop()} {'&&' if word == AND else '||'} {top})")
        return stack[0]


def rays_block(region: Region, window: Array, offset: Array, size: tuple[int, int]) -> npt.NDArray[Any]:
    """Pack the ``Rays`` uniform block (std140), but for surfaces."""
    block: npt.NDArray[Any] = np.zeros((), RAYS_BLOCK.dtype)
    inverse = np.linalg.inv(window)
    if not np.isfinite(inverse).all():
        raise np.linalg.LinAlgError("a view without depth")
    for k, leaf in enumerate(region.leaves):
        if leaf.kind == SURFACE:
            continue
        about = _centre(window, np.append(leaf.centre - offset, 1.0), size)
        unit = _expanded(to_unit(leaf, offset) @ inverse, about)
        rows = _quadric(unit, size) if leaf.kind == SPHERE else _scaled(SIDES[leaf.kind] @ unit, size)
        block["rays_rows"][_ROWS * k : _ROWS * k + len(rows)] = rows
        block["rays_centres"][k, :3] = about
    return block


def _quadric(unit: Array, size: tuple[int, int]) -> Array:
    """Return (3, 4): the rows of a sphere, from the map (d, 1) to homogeneous unit coordinates."""
    q = unit.T @ np.diag([1.0, 1.0, 1.0, -1.0]) @ unit
    span = np.array([*size, 1.0, 1.0])
    q /= np.abs(q * span * span[:, None]).max() or 1.0
    return np.array(
        [
            [q[0, 0], q[1, 1], 2 * q[0, 1], q[3, 3]],
            [2 * q[0, 3], 2 * q[1, 3], q[0, 2], q[1, 2]],
            [q[2, 2], q[2, 3], 0.0, 0.0],
        ]
    )
