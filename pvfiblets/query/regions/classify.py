"""Whether whole balls lie in a region: surely (+1), surely not (-1), or undecided (0).

Each shape is classified by itself, never wrongly, and the expression evaluated in Kleene's logic (1952, "Introduction
to metamathematics", section 64): of "and" the least, of "or" the greatest, of "not" the negative. Where the answer is
not 0, `Region.contains` says the same of every position in the ball, its rounding included.

A region as arrays (:class:`Packed`), for kernels and for tests of shaders. Columns of ``rows`` ``(n_leaves, 20)``:

=======  ===============================================================================================
0        kind (:mod:`.shapes`)
1 … 9    ``A`` row by row: ``u = A (p - c)``
10 … 12  ``c``, mm
13       scale: how far, at most, ``u`` moves per mm (the largest singular value); for surfaces and labels
         in mm of the field
14 … 16  lengths of the rows of ``A``: how far each coordinate of ``u`` moves per mm
17       number of the field, -1 if there is none
18       1 if the sign of the field's nearest point says where a position is (`Field.whole`)
19       0
=======  ===============================================================================================

Columns of ``grids`` ``(n_fields, 16)``: 0 … 2 origin, 3 … 5 spacing (unit coordinates), 6 … 8 steps (mm), 9 … 11 points
along x, y, z, 12 where the field's values start in ``values`` (x runs fastest), 13 … 15 zero.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numba
import numpy as np
import numpy.typing as npt

from ...codec.decompress import fixed
from ...codec.jit import kernel, parallel_kernel
from ...support.array_types import Float32s, Float64s, Int8s, Int32s
from .placement import positions
from .region import largest_stretch, pack_rows
from .shape_kernels import unit

if TYPE_CHECKING:
    from .fields import Field
    from .region import Region

Array = npt.NDArray[np.float64]

_PLANE, _SLAB, _BOX, _SPHERE, _SURFACE, _LABELS = range(6)
_AND, _OR, _NOT = -1, -2, -3
_EPS = 16.0 * 2.0**-52  # relative float64 error of a ball's centre, a position in it, and their distance


@dataclass(frozen=True, eq=False)
class Packed:
    """A region as arrays; see the module for their columns."""

    ops: npt.NDArray[np.int32]  # `(n,)` int32: the program
    rows: Array  # `(n_leaves, 20)` float64
    grids: Array  # `(n_fields, 16)` float64
    values: npt.NDArray[np.float32]  # float32: all fields' values
    fields: tuple[Field, ...]  # each once

    @property
    def arrays(self) -> tuple[Any, ...]:
        """First arguments of :func:`classify_ball`: ops, rows, grids, values."""
        return self.ops, self.rows, self.grids, self.values


@lru_cache(maxsize=4)
def pack(region: Region) -> Packed:
    """Return a region as arrays, for kernels; the last few are kept. Makes the fields that are not there yet."""
    ops, rows = pack_rows(region)
    fields: dict[int, Field] = {}
    grids = []
    start = 0
    for row, leaf in zip(rows, region.leaves, strict=True):
        field = leaf.field
        if field is None:
            continue
        if id(field) not in fields:
            fields[id(field)] = field
            sizes = field.values.shape[::-1]
            grids.append([*field.origin, *field.spacing, *field.steps, *sizes, start, 0.0, 0.0, 0.0])
            start += field.values.size
        row[13] = largest_stretch(leaf.linear * (field.steps / field.spacing)[:, None])
        row[17] = list(fields).index(id(field))
        row[18] = float(field.whole)
    values = [field.values.ravel() for field in fields.values()]
    flat = values[0] if len(values) == 1 else np.concatenate([*values, np.zeros(1, np.float32)])
    return Packed(ops, rows, np.array(grids).reshape(-1, 16), fixed(flat), tuple(fields.values()))


def classify(region: Region, centres: npt.ArrayLike, radii: npt.ArrayLike) -> npt.NDArray[np.int8]:
    """Classify balls as inside, outside or undecided.

    Parameters
    ----------
    region : Region
        Region in mm.
    centres : array_like
        ``(n, 3)`` mm.
    radii : array_like
        ``(n,)`` mm, or one for all; 0 for single positions.

    Returns
    -------
    numpy.ndarray
        ``(n,)`` int8: 1 if the whole ball is inside, -1 if it is outside, 0 if undecided: near the region's boundary,
        or if a number is not finite.

    Raises
    ------
    ValueError
        If the numbers of radii and centres differ, or a radius is below 0.
    """
    places = np.ascontiguousarray(positions(centres))
    given = np.asarray(radii, np.float64)
    if given.shape not in ((), (len(places),)):
        raise ValueError(f"radii have shape {given.shape}; give one, or as many as there are centres, {len(places)}")
    if (given < 0.0).any():
        raise ValueError(f"a radius is {given.min()}; give mm, 0 or more")
    found = np.empty(len(places), np.int8)
    _classify(*pack(region).arrays, places, np.ascontiguousarray(np.broadcast_to(given, len(places))), found)
    return found


@parallel_kernel
def _classify(
    ops: Int32s, rows: Float64s, grids: Float64s, values: Float32s, centres: Float64s, radii: Float64s, out: Int8s
) -> None:
    for i in numba.prange(len(centres)):
        out[i] = classify_ball(ops, rows, grids, values, centres[i, 0], centres[i, 1], centres[i, 2], radii[i])


@kernel
def _side(inside: bool, outside: bool) -> int:
    return 1 if inside else -1 if outside else 0


@kernel
def _field_side(row: Float64s, grid: Float64s, values: Float32s, u: tuple[float, float, float],
                slack: tuple[float, float, float], r: float) -> int:  # fmt: skip
    """Side of a ball by a field; ``u`` are the centre's unit coordinates, off by ``slack`` at most."""
    q0, q1, q2 = (u[0] - grid[0]) / grid[3], (u[1] - grid[1]) / grid[4], (u[2] - grid[2]) / grid[5]
    nx, ny, nz = grid[9], grid[10], grid[11]
    s0 = (slack[0] + _EPS * abs(grid[0])) / grid[3]
    s1 = (slack[1] + _EPS * abs(grid[1])) / grid[4]
    s2 = (slack[2] + _EPS * abs(grid[2])) / grid[5]
    margin = r * row[13] * (1.0 + _EPS) + s0 * grid[6] + s1 * grid[7] + s2 * grid[8]
    # The grid's outermost points reach half a step beyond it.
    b0 = max(-0.5 - q0, q0 - (nx - 0.5), 0.0) * grid[6]
    b1 = max(-0.5 - q1, q1 - (ny - 0.5), 0.0) * grid[7]
    b2 = max(-0.5 - q2, q2 - (nz - 0.5), 0.0) * grid[8]
    beyond = b0 * b0 + b1 * b1 + b2 * b2
    if math.sqrt(beyond) * (1.0 - _EPS) > margin:
        return -1
    # Comparisons with NaN are false, so that NaN ends at grid point 0 and is undecided.
    g0 = min(max(math.floor(q0 + 0.5), 0.0), nx - 1.0) if q0 == q0 else 0.0
    g1 = min(max(math.floor(q1 + 0.5), 0.0), ny - 1.0) if q1 == q1 else 0.0
    g2 = min(max(math.floor(q2 + 0.5), 0.0), nz - 1.0) if q2 == q2 else 0.0
    d = values[int(grid[12] + (g2 * ny + g1) * nx + g0)]
    side = 1 if d > 0.0 else -1
    o0, o1, o2 = abs(q0 - g0), abs(q1 - g1), abs(q2 - g2)
    p0, p1, p2 = o0 * grid[6] - b0, o1 * grid[7] - b1, o2 * grid[8] - b2
    sure = abs(d) - math.sqrt(p0 * p0 + p1 * p1 + p2 * p2) * (1.0 + _EPS)
    if beyond == 0.0 and sure > margin:
        return side
    # From beyond the grid, everything in it is as far as from the nearest place of the grid's box, or farther by
    # Pythagoras: the box is convex.
    if side < 0 and sure > 0.0 and math.sqrt(beyond + sure * sure) * (1.0 - _EPS) > margin:
        return -1
    if row[18] == 1.0:
        # Within one voxel all is as the voxel is.
        h0, h1, h2 = o0 + s0 + r * row[14], o1 + s1 + r * row[15], o2 + s2 + r * row[16]
        if h0 < 0.5 and h1 < 0.5 and h2 < 0.5:
            return side
    return 0


@kernel
def _leaf_side(row: Float64s, grids: Float64s, values: Float32s, x: float, y: float, z: float, r: float) -> int:
    u = unit(row, x, y, z)
    dx, dy, dz = abs(x - row[10]) + r, abs(y - row[11]) + r, abs(z - row[12]) + r
    # The differences were rounded relative to themselves, the products and sums relative to these.
    slack = (
        _EPS * (abs(row[1]) * dx + abs(row[2]) * dy + abs(row[3]) * dz),
        _EPS * (abs(row[4]) * dx + abs(row[5]) * dy + abs(row[6]) * dz),
        _EPS * (abs(row[7]) * dx + abs(row[8]) * dy + abs(row[9]) * dz),
    )
    kind = int(row[0])
    if kind >= _SURFACE:
        return _field_side(row, grids[int(row[17])], values, u, slack, r)
    reach = slack[2] + r * row[16]
    if kind == _PLANE:
        return _side(u[2] > reach, u[2] < -reach)
    if kind == _SLAB:
        reach += _EPS
        return _side(abs(u[2]) + reach < 1.0, abs(u[2]) - reach > 1.0)
    a, b, c = abs(u[0]), abs(u[1]), abs(u[2])
    if kind == _BOX:
        ra, rb, rc = slack[0] + r * row[14] + _EPS, slack[1] + r * row[15] + _EPS, reach + _EPS
        if a + ra < 1.0 and b + rb < 1.0 and c + rc < 1.0:
            return 1
        if a - ra > 1.0 or b - rb > 1.0 or c - rc > 1.0:
            return -1
        # Past an edge or a corner a ball may miss the box although it meets the planes of its faces.
        a, b, c = max(a - 1.0, 0.0), max(b - 1.0, 0.0), max(c - 1.0, 0.0)
        far = slack[0] + slack[1] + slack[2] + r * row[13] + _EPS
        return -1 if math.sqrt(a * a + b * b + c * c) * (1.0 - _EPS) > far else 0
    length = math.sqrt(a * a + b * b + c * c)
    far = slack[0] + slack[1] + slack[2] + r * row[13] + _EPS * (1.0 + length)
    return _side(length + far < 1.0, length - far > 1.0)


@kernel
def classify_ball(
    ops: Int32s, rows: Float64s, grids: Float64s, values: Float32s, x: float, y: float, z: float, r: float
) -> int:
    """Side of one ball: +1, -1 or 0; the arrays are as in :class:`Packed`."""
    if not (math.isfinite(x) and math.isfinite(y) and math.isfinite(z) and math.isfinite(r)):
        return 0
    inside, outside = 0, 0  # two stacks of bits, the top in bit 0
    for word in ops:
        i, o = inside & 1, outside & 1
        if word >= 0:
            side = _leaf_side(rows[word], grids, values, x, y, z, r)
            inside = inside << 1 | (1 if side > 0 else 0)
            outside = outside << 1 | (1 if side < 0 else 0)
        elif word == _NOT:
            inside ^= i ^ o
            outside ^= i ^ o
        else:
            inside >>= 1
            outside >>= 1
            if word == _AND:
                inside &= i | ~1
                outside |= o
            else:
                inside |= i
                outside &= o | ~1
    return (inside & 1) - (outside & 1)
