"""Distance fields: how far, at the points of a grid, the nearest place is where inside and outside change.

A value ``d`` at a grid point ``g`` is a lower bound of that distance, positive inside, negative outside. The distance
changes no faster than one goes, so that a ball of radius ``r`` about ``p`` lies on one side for sure where ``|d| -
|p - g| > r``: of any grid point, but the nearest says most. Beyond the grid, by half a step from its outermost points
and more, all is outside.

Of a surface the grid has about :data:`CELLS` cells along the longest axis. Of a label volume it has a point for each
voxel from the first to the last chosen one, or for each block of them where they are more than `MOST_VALUES`; a block
that is both in and out has 0.

Distances between voxels come from an exact Euclidean distance transform (Felzenszwalb and Huttenlocher 2012,
"Distance transforms of sampled functions", section 2) from centre to centre, less half a voxel's diagonal: what
changes, changes at a voxel's face. In a sheared volume all voxels count as cubes of the affine matrix' smallest
singular value, which no true distance falls short of.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from .field_kernels import block_states, squared_distances

Array = npt.NDArray[np.float64]

CELLS = 64
MARGIN = 2  # cells beyond a surface's bounds on each side

MOST_VALUES = 256**3  # 64 MiB of float32


@dataclass(frozen=True, eq=False)
class Field:
    """Signed lower bounds of distances on a grid."""

    # `(nz, ny, nx)` float32 mm of the shape itself, that is before it was moved; positive inside
    values: npt.NDArray[np.float32]
    origin: Array  # `(3,)` float64: grid point 0, 0, 0 in the shape's own unit coordinates (`.Shape.matrix`)
    spacing: Array  # `(3,)` float64: from grid point to grid point, in the same
    # `(3,)` float64: the same in mm. A surface's unit coordinates are its mm, so that both are equal; a label volume's
    # count voxels.
    steps: Array
    # whether the nearest grid point's sign alone says where a position is, which it does in a label volume that was not
    # reduced to blocks
    whole: bool

    def __post_init__(self) -> None:
        for array in (self.values, self.origin, self.spacing, self.steps):
            array.flags.writeable = False


def surface_grid(low: Array, high: Array) -> tuple[Array, float, tuple[int, int, int]]:
    """Return first point, step and sizes (x, y, z) of a grid around bounds ``(3,)``, ``(3,)`` that are not a point."""
    step = float((high - low).max()) / CELLS
    cells = np.ceil((high - low) / step * (1.0 - 1e-9)).astype(np.int64) + 2 * MARGIN
    first = (low + high) / 2 - step * cells / 2
    nx, ny, nz = (int(n) + 1 for n in cells)
    return first, step, (nx, ny, nz)


def rounded_towards_zero(values: Array) -> npt.NDArray[np.float32]:
    """Return float32 no farther from 0 than the values."""
    found = values.astype(np.float32)
    too_far = np.abs(found.astype(np.float64)) > np.abs(values)
    found[too_far] = np.nextafter(found[too_far], np.float32(0.0))
    return found


def label_field(mask: npt.NDArray[np.bool_], affine: Array) -> Field:
    """Return the field of a label volume."""
    chosen_ones = [np.nonzero(mask.any(axis=tuple({0, 1, 2} - {axis})))[0] for axis in range(3)]
    first = np.array([n[0] for n in chosen_ones])
    mask = mask[tuple(slice(n[0], n[-1] + 1) for n in chosen_ones)]  # all else is out, as beyond any grid
    block = 1
    while np.prod([-(-n // block) for n in mask.shape]) > MOST_VALUES:
        block += 1
    steps = voxel_sizes(affine) * block
    unit = float(steps.max())  # so that squares of sizes stay within float32
    sizes = steps / unit
    states = mask.T.astype(np.uint8) if block == 1 else block_states(mask, block)  # 0 out, 1 in, 2 both; (z, y, x)
    half_diagonal = float(np.linalg.norm(sizes)) / 2
    signed = np.zeros(states.shape, np.float32)
    for state, sign in ((1, 1.0), (0, -1.0)):
        chosen = states == state
        if not chosen.any():
            continue
        # Float32 squares and roots err by less than a millionth. A voxel's own faces are half a voxel away; so far no
        # other voxel reaches.
        far = np.sqrt(squared_distances(states != state, sizes))
        bound = np.maximum(far * (1.0 - 1e-6) - half_diagonal, sizes.min() / 2 * (1.0 - 1e-6))
        if state == 1:  # beyond the grid all is out
            for axis, (n, size) in enumerate(zip(states.shape, sizes[::-1], strict=True)):
                rim = np.minimum(np.arange(n), np.arange(n)[::-1]) + 0.5
                shape = [1, 1, 1]
                shape[axis] = n
                np.minimum(bound, (size * rim).reshape(shape).astype(np.float32), out=bound)
        signed[chosen] = (sign * unit * (1.0 - 1e-6)) * bound[chosen]
        del far, bound
    return Field(signed, first + (block - 1) / 2, np.full(3, float(block)), steps, block == 1)


def voxel_sizes(affine: Array) -> Array:
    """Return ``(3,)`` mm: sizes such that no two voxels are nearer to each other than those say."""
    lengths = np.linalg.norm(affine, axis=0)
    axes = affine / lengths
    if np.abs(axes.T @ axes - np.eye(3)).max() < 1e-12:
        return lengths
    return np.full(3, np.linalg.svd(affine, compute_uv=False)[2] * (1.0 - 1e-9))
