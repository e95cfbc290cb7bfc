"""Encoding in plain NumPy and float64: the codes that the compiled kernels must give bit for bit.

Points are millimetres relative to the set's origin throughout. Encoding is closed loop: every code aims from the
*decoded* previous point, in the decoded frame, at the true next point, so that errors do not add up; the code taken is
the nearest of all 256, not a rounded u and v (paper: Schertzer et al. 2022, appendix A).

Fiblets whose steps vary, or bend too sharply, are coded as steps between the points of an integer lattice of edge
``h``: rounding to it errs by at most ``h sqrt(3) / 2`` whatever the steps, and adding integers does not drift.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from pvfiblets.codec.direction_codebook import cap_ratios, directions, quaternions
from pvfiblets.codec.layout import DIRECTION_SCALE, STEP_LEVELS, WIDE_HEADER, Kind
from pvfiblets.report.studies.decode.reference import first_frame, product, rotate_x

from .turn_reference import Turns

Array = npt.NDArray[np.float64]
RECORD_BYTES = 22
LATTICE_LIMIT = 2**30  # lattice coordinates stay clear of int32's end, on the GPU too
MAX_HALVINGS = 15
TURNED_TOO_FAR = 2**16  # bytes: any split that turns fewer segments too far is better
TREE_DEPTH = 6  # halving 60 points six times leaves single points


# ------------------------------------------------------------------------------------------------- first direction


def pack_direction(d: Array) -> int:
    """Quantise a unit vector to two snorm16 on the octahedron about +x."""
    x, y, z = d
    norm = abs(x) + abs(y) + abs(z)
    u, v = y / norm, z / norm
    if x < 0.0:
        u, v = (1.0 - abs(v)) * np.copysign(1.0, u), (1.0 - abs(u)) * np.copysign(1.0, v)
    iu, iv = int(np.rint(u * DIRECTION_SCALE)), int(np.rint(v * DIRECTION_SCALE))
    return (iu & 0xFFFF) | ((iv & 0xFFFF) << 16)


# ------------------------------------------------------------------------------------------------- direction codes


@dataclass(frozen=True)
class DirectionPiece:
    """A fiblet of kind DIRECTION: its words, its codes, and their decoded points."""

    shape: int
    step: int
    cap: int
    codes: npt.NDArray[np.uint8]
    points: Array
    error: float


def choose_step(points: Array, lo: float, hi: float) -> tuple[int, float]:
    """Index of a fiblet's step between the file's least and greatest, and its length (mm)."""
    arc = 0.0
    for i in range(1, len(points)):
        arc += _distance(points[i], points[i - 1])
    if hi <= lo:
        return 0, lo
    index = int(np.rint((arc / (len(points) - 1) - lo) / (hi - lo) * STEP_LEVELS))
    index = min(max(index, 0), STEP_LEVELS)
    return index, lo + index * (hi - lo) / STEP_LEVELS


def choose_cap(points: Array) -> int:
    """Index of the smallest cap angle that holds every turn of the points."""
    least = 1.0  # cosine of the sharpest turn
    for i in range(2, len(points)):
        a, b = points[i - 1] - points[i - 2], points[i] - points[i - 1]
        norm = np.sqrt((a[0] * a[0] + a[1] * a[1] + a[2] * a[2]) * (b[0] * b[0] + b[1] * b[1] + b[2] * b[2]))
        if norm > 0.0:
            least = min(least, (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) / norm)
    for cap, ratio in enumerate(cap_ratios()):
        if 1.0 - ratio <= least:
            return cap
    return len(cap_ratios()) - 1


def encode_direction(points: Array, anchor: Array, step: int, length: float, cap: int) -> DirectionPiece:
    """Code points with one direction byte each, greedily and in closed loop."""
    table, reach = quaternions()[cap].astype(np.float64), directions()[cap]
    aim = points[1] - anchor
    shape = pack_direction(aim if np.any(aim != 0.0) else np.array([1.0, 0.0, 0.0]))
    d, q = first_frame(shape)
    decoded = np.empty_like(points)
    decoded[0] = anchor
    decoded[1] = p = anchor + length * d
    codes = np.empty(len(points) - 2, np.uint8)
    for i in range(2, len(points)):
        aim = points[i] - p
        local = _unrotate(q, aim)
        score = local[0] * reach[:, 0] + local[1] * reach[:, 1] + local[2] * reach[:, 2]
        code = int(np.argmax(score))
        codes[i - 2] = code
        q = product(q, table[code])
        decoded[i] = p = p + length * rotate_x(q)
    error = max(_distance(a, b) for a, b in zip(points, decoded, strict=True))
    return DirectionPiece(shape, step, cap, codes, decoded, error)


# --------------------------------------------------------------------------------------------------- lattice codes


@dataclass(frozen=True)
class LatticePiece:
    """A fiblet of a lattice kind."""

    kind: int
    shape: int
    step: int
    cap: int
    codes: npt.NDArray[np.uint8]
    points: Array


@dataclass(frozen=True)
class _Box:
    """Least lattice step, numbers of values by axis, bytes per code, and the kind that holds them."""

    lo: npt.NDArray[np.int64]
    n: npt.NDArray[np.int64]
    width: int
    kind: int

    def size(self, count: int) -> int:
        return RECORD_BYTES + (WIDE_HEADER if self.kind == Kind.WIDE else 0) + (count - 1) * self.width


def _lattice(points: Array, anchor: Array, h: float) -> npt.NDArray[np.float64]:
    return np.rint((points - anchor) / h)


def _box(points: Array, anchor: Array, h: float) -> _Box | None:
    """The box of lattice steps between the points, or None if no kind holds it."""
    k = _lattice(points, anchor, h)
    k[0] = 0.0
    if np.abs(k).max() > LATTICE_LIMIT:
        return None
    delta = np.diff(k.astype(np.int64), axis=0)
    if len(delta) == 0:
        return _Box(np.zeros(3, np.int64), np.ones(3, np.int64), 1, Kind.LATTICE8)
    lo = delta.min(0)
    n = delta.max(0) - lo + 1
    cells = float(n[0]) * float(n[1]) * float(n[2])
    if cells > 2.0**32:
        return None
    width = 1 if cells <= 2**8 else 2 if cells <= 2**16 else 3 if cells <= 2**24 else 4
    narrow = width <= 2 and lo.min() >= -128 and lo.max() <= 127 and n[0] <= 256 and n[1] <= 256
    return _Box(lo, n, width, width if narrow else Kind.WIDE)


def _turned(points: Array, anchor: Array, edge: float, turns: Turns, following: Array | None) -> float:
    """Return by how many times the lattice turns a segment too far; see :meth:`.turn_reference.Turns.excess`."""
    decoded = anchor + edge * _lattice(points, anchor, edge)
    decoded[0] = anchor
    return turns.excess(decoded, following)


def _halvings(
    points: Array, anchor: Array, h: float, turns: Turns | None, following: Array | None
) -> tuple[int, float]:
    """Least halvings of the edge that turn no segment too far, or of least excess, and the excess."""
    if turns is None:
        return 0, 0.0
    found, least = 0, np.inf
    for halvings in range(MAX_HALVINGS + 1):
        over = _turned(points, anchor, h * 0.5**halvings, turns, following)
        if over < least:
            found, least = halvings, over
        if over <= 1.0 or len(points) < 2:
            break
    return found, least


def plan_lattice(points: Array, anchors: Array, h: float, turns: Turns | None = None) -> list[int]:
    """Split points into lattice fiblets so that their bytes are fewest among all splits by repeated halving."""
    # Fewer fiblets that turn a segment too far come before fewer bytes.

    def best(a: int, b: int, depth: int) -> tuple[int, list[int]]:
        count = b - a
        if count == 0:
            return 0, []
        following = anchors[b] if b < len(anchors) else None
        halvings, over = _halvings(points[a:b], anchors[a], h, None if turns is None else turns[a:b], following)
        box = _box(points[a:b], anchors[a], h * 0.5**halvings)
        whole = box.size(count) if box is not None else 2**30
        whole += TURNED_TOO_FAR if over > 1.0 else 0
        whole += TURNED_TOO_FAR if turns is not None and a > 0 and turns.first[a : a + 1].min(initial=0.0) < 0.0 else 0
        if (box is not None and box.kind == Kind.LATTICE8 and over <= 1.0) or depth == TREE_DEPTH:
            return whole, [count]
        middle = a + count // 2
        left, cuts_left = best(a, middle, depth + 1)
        right, cuts_right = best(middle, b, depth + 1)
        return (whole, [count]) if whole <= left + right else (left + right, cuts_left + cuts_right)

    return best(0, len(points), 0)[1]


def encode_lattice(
    points: Array, anchor: Array, h: float, turns: Turns | None = None, following: Array | None = None
) -> LatticePiece:
    """Code points as lattice steps; the edge is halved until no segment turns too far, and on while that costs no byte.

    ``following`` is the anchor of the point that follows in the streamline.
    """
    if len(points) == 1:
        return LatticePiece(Kind.DIRECTION, 0, 0, 0, np.empty(0, np.uint8), anchor[None])
    halvings, least = _halvings(points, anchor, h, turns, following)
    box = _box(points, anchor, h * 0.5**halvings)
    if box is None:
        raise ValueError("the steps between these points need more than 4 bytes each")
    for more in range(halvings + 1, MAX_HALVINGS + 1):
        finer = _box(points, anchor, h * 0.5**more)
        if finer is None or finer.width != box.width or finer.kind != box.kind:
            break
        if turns is None or _turned(points, anchor, h * 0.5**more, turns, following) <= max(1.0, least):
            box, halvings = finer, more
    edge = h * 0.5**halvings
    k = _lattice(points, anchor, edge)
    k[0] = 0.0
    cell = np.diff(k.astype(np.int64), axis=0) - box.lo
    value = cell[:, 0] + box.n[0] * (cell[:, 1] + box.n[1] * cell[:, 2])
    codes = value.astype("<u4").view(np.uint8).reshape(-1, 4)[:, : box.width].ravel()
    if box.kind == Kind.WIDE:
        header = np.concatenate([box.lo.astype("<i4").view(np.uint8), box.n[:2].astype("<u4").view(np.uint8)])
        shape, step, codes = 0, box.width, np.concatenate([header, codes])
    else:
        low = [int(v) & 0xFF for v in box.lo]
        shape = low[0] | low[1] << 8 | low[2] << 16 | (int(box.n[0]) - 1) << 24
        step = int(box.n[1]) - 1
    return LatticePiece(box.kind, shape, step, halvings, codes, anchor + edge * k)


# --------------------------------------------------------------------------------------------------------- helpers


def _unrotate(q: Array, v: Array) -> Array:
    """Express a vector in a frame: the transposed rotation."""
    w, x, y, z = q
    return np.array(
        [
            v[0] * (1.0 - 2.0 * (y * y + z * z)) + v[1] * (2.0 * (x * y + w * z)) + v[2] * (2.0 * (x * z - w * y)),
            v[0] * (2.0 * (x * y - w * z)) + v[1] * (1.0 - 2.0 * (x * x + z * z)) + v[2] * (2.0 * (y * z + w * x)),
            v[0] * (2.0 * (x * z + w * y)) + v[1] * (2.0 * (y * z - w * x)) + v[2] * (1.0 - 2.0 * (x * x + y * y)),
        ]
    )


def _distance(a: Array, b: Array) -> float:
    d = a - b
    return float(np.sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]))
