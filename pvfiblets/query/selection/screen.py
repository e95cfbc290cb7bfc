"""Streamlines under an area of the screen, visible or hidden, from the compressed data alone.

A fiblet's capsule (:mod:`pvfiblets.codec.capsules`) is tried first against the half spaces that bound the view through
the area's rectangle; fiblets that reach into it are decoded, and their segments, cut at the near and the far plane, are
tried against the area itself. All in float64 and without OpenGL, so that the answer is the same on every machine.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ...codec.decompress import decode_fiblets, fixed
from ...codec.files.stored_parts import in_parts, stored_parts
from ...codec.layout import PAGE_BITS, unpack
from ...codec.streamline_ranges import ranges_of
from . import screen_kernels
from .bits import stretch
from .endpoints import end_points

if TYPE_CHECKING:
    from ...codec.fibletset import FibletSet
    from ..regions.shapes import Region

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

FIBLETS = 1 << 20  # whose capsules are tried together
DECODED = 1 << 14  # that are decoded together
SAMPLES = 17  # tested places on a segment


@dataclass(frozen=True, eq=False)
class Under:
    """Streamlines under an area of the screen, the nearest first."""

    ids: Ints  # `(n,)` int64, each once
    # `(n,)` float64: of each streamline's places under the area the one nearest to the viewer, as the index of the
    # point before plus the fraction of the segment
    places: Array
    depths: Array  # `(n,)` float64: window depth there, 0 at the near plane and 1 at the far


def checked_polygon(polygon: npt.ArrayLike) -> Array:
    """Return corners as ``(k, 2)`` float64."""
    corners = np.array(polygon, np.float64)
    if corners.ndim != 2 or corners.shape[1] != 2 or not len(corners) or not np.isfinite(corners).all():
        raise ValueError(f"a polygon is (k, 2) finite pixels, k >= 1; got {np.asarray(polygon)!r:.200}")
    return np.ascontiguousarray(corners)


def area_distances(polygon: npt.ArrayLike, pixels: npt.ArrayLike) -> Array:
    """Distances of places on the screen from the area of a polygon."""
    places = np.ascontiguousarray(np.asarray(pixels, np.float64).reshape(-1, 2))
    found: Array = screen_kernels.distances(checked_polygon(polygon), places)
    return found


def under_polygon(
    fiblets: FibletSet,
    matrix: npt.ArrayLike,
    size: tuple[float, float],
    polygon: npt.ArrayLike,
    tolerance: float = 0.0,
    *,
    streamlines: npt.NDArray[np.bool_] | None = None,
    points: npt.NDArray[np.uint32] | None = None,
    planes: npt.ArrayLike | None = None,
    region: Region | None = None,
) -> Under:
    """Find the streamlines under an area of the screen, occluded ones too."""
    corners, transform = checked_polygon(polygon), np.array(matrix, np.float64)
    width, height = (float(n) for n in size)
    if transform.shape != (4, 4) or not np.isfinite(transform).all():
        raise ValueError(f"matrix must be a finite (4, 4) matrix, got {transform.tolist()}")
    if not (width > 0.0 and height > 0.0):
        raise ValueError(f"size is {size}; give a width and a height above 0 pixels")
    if not (np.isfinite(tolerance) and tolerance >= 0.0):
        raise ValueError(f"tolerance is {tolerance}; give a finite number of pixels, 0 or more")
    if streamlines is not None and streamlines.shape != (fiblets.n_streamlines,):
        raise ValueError(f"streamlines has shape {streamlines.shape}; expected ({fiblets.n_streamlines},)")
    if points is not None and 32 * len(points) < fiblets.n_points:
        raise ValueError(f"points has {len(points)} words; {(fiblets.n_points + 31) // 32} are needed")
    if in_parts(fiblets):
        return _under_in_parts(
            fiblets, transform, size, corners, tolerance, streamlines, points, planes=planes, region=region
        )
    cuts = _cuts(transform, planes)
    screen = transform, cuts, np.array([width, height]), corners, float(tolerance)
    spaces = np.concatenate([_sides(transform, (width, height), corners, tolerance), cuts])
    words = np.zeros(0, np.uint32) if points is None else np.ascontiguousarray(points, np.uint32)
    try:
        parts = [
            _hit(fiblets, which, screen, words, here)
            for which, here in _candidates(fiblets, _unit(spaces), streamlines, region)
        ]
        if not parts:
            return Under(np.zeros(0, np.int64), np.zeros(0), np.zeros(0))
        ranks, depths, places = (np.concatenate(columns) for columns in zip(*parts, strict=True))
        return _nearest(fiblets, ranks, depths, places)
    except IndexError:
        fiblets.verify()  # raises for a damaged file; other errors pass
        raise


def ends_under_polygon(
    fiblets: FibletSet,
    matrix: npt.ArrayLike,
    size: tuple[float, float],
    polygon: npt.ArrayLike,
    tolerance: float = 0.0,
    *,
    streamlines: npt.NDArray[np.bool_] | None = None,
    points: npt.NDArray[np.uint32] | None = None,
    planes: npt.ArrayLike | None = None,
    region: Region | None = None,
) -> Under:
    """Find the streamlines with an end under an area of the screen, occluded ones too."""
    transform, where = np.array(matrix, np.float64), ranges_of(fiblets, np.arange(fiblets.n_streamlines))
    at, counts = end_points(fiblets).reshape(-1, 3), where.points
    rows = np.flatnonzero(np.isfinite(at).all(axis=1))
    if streamlines is not None:
        rows = rows[streamlines[rows // 2]]
    if points is not None:
        last = where.point + np.maximum(counts - 1, 0)
        beside = [np.minimum(where.point + 1, last), np.maximum(last - 1, where.point)]
        for pair in ([where.point, last], beside):
            number = np.stack(pair, axis=1).ravel()[rows]
            rows = rows[(points[number >> 5] >> (number & 31).astype(np.uint32) & 1) != 0]
    whole = np.column_stack([at[rows], np.ones(len(rows))])
    rows = rows[(whole @ _cuts(transform, planes).T >= 0.0).all(axis=1)]
    if region is not None:
        rows = rows[region.contains(at[rows])]
    clip = np.column_stack([at[rows], np.ones(len(rows))]) @ transform.T
    inside = area_distances(polygon, (clip[:, :2] / clip[:, 3:] + 1.0) * 0.5 * np.array(size)) <= tolerance
    rows, depths = rows[inside], (0.5 * clip[:, 2] / clip[:, 3] + 0.5)[inside]
    order = np.argsort(depths, kind="stable")
    rows, depths = rows[order], depths[order]
    _, first = np.unique(rows // 2, return_index=True)
    first.sort()
    ids = rows[first] // 2
    places = np.where(rows[first] % 2 == 1, np.maximum(counts[ids] - 1, 0), 0).astype(np.float64)
    return Under(ids, places, depths[first])


def _under_in_parts(
    fiblets: FibletSet,
    matrix: Array,
    size: tuple[float, float],
    corners: Array,
    tolerance: float,
    streamlines: npt.NDArray[np.bool_] | None,
    points: npt.NDArray[np.uint32] | None,
    **cuts: Any,
) -> Under:
    """Find them shard after shard."""
    found, point = [], 0
    for part, ids in stored_parts(fiblets):
        assert ids is not None
        there = None if streamlines is None else streamlines[ids]
        words = None if points is None else stretch(points, point, point + part.n_points)
        one = under_polygon(part, matrix, size, corners, tolerance, streamlines=there, points=words, **cuts)
        found.append(Under(ids[one.ids], one.places, one.depths))
        point += part.n_points
    if not found:
        return Under(np.zeros(0, np.int64), np.zeros(0), np.zeros(0))
    depths = np.concatenate([one.depths for one in found])
    order = np.argsort(depths, kind="stable")
    ids, places = (np.concatenate([getattr(one, name) for one in found]) for name in ("ids", "places"))
    return Under(ids[order], places[order], depths[order])


def _nearest(fiblets: FibletSet, ranks: Ints, depths: Array, places: Array) -> Under:
    """Each streamline's nearest place, sorted by depth; ``places`` count from the set's first point."""
    order = np.lexsort((depths, ranks))
    chosen, first = np.unique(ranks[order], return_index=True)
    best = order[first]
    best = best[np.argsort(depths[best], kind="stable")]
    chosen = ranks[best]
    ids = chosen if fiblets.rank_to_id is None else np.asarray(fiblets.rank_to_id)[chosen].astype(np.int64)
    within = places[best] - ranges_of(fiblets, ids).point
    return Under(ids, within, np.clip(0.5 * depths[best] + 0.5, 0.0, 1.0))


def _cuts(matrix: Array, planes: Any) -> Array:
    """Planes in data coordinates at which segments are cut: near, far, and the given ones."""
    given = np.zeros((0, 4)) if planes is None else np.array(planes, np.float64).reshape(-1, 4)
    return np.ascontiguousarray(np.concatenate([[matrix[3] + matrix[2], matrix[3] - matrix[2]], given]))


def _sides(matrix: Array, size: tuple[float, float], corners: Array, tolerance: float) -> Array:
    """Half spaces whose intersection is the view through the rectangle about the area."""
    sides = []
    for axis in range(2):
        # A hundredth of a pixel more, for the rounding of projections.
        low = 2.0 * (corners[:, axis].min() - tolerance - 0.01) / size[axis] - 1.0
        high = 2.0 * (corners[:, axis].max() + tolerance + 0.01) / size[axis] - 1.0
        sides += [matrix[axis] - low * matrix[3], high * matrix[3] - matrix[axis]]
    return np.array(sides)


def _unit(spaces: Array) -> Array:
    """The same half spaces with normals of length 1; those without a normal (a far plane at infinity) left out."""
    lengths = np.linalg.norm(spaces[:, :3], axis=1)
    kept = lengths > 1e-300
    return np.ascontiguousarray(spaces[kept] / lengths[kept, None])


def _candidates(
    fiblets: FibletSet, spaces: Array, streamlines: npt.NDArray[np.bool_] | None, region: Region | None
) -> Iterator[tuple[Ints, Region | None]]:
    """Fiblets that may be hit, and the region if each of their places must be tested."""
    p, low = fiblets.parameters, fiblets.anchors_low
    lower = np.zeros((1, 3), np.uint16) if low is None else low
    held = fiblets.anchors, lower, fiblets.reach, fiblets.ends, fiblets.pages[:, 0]
    arrays = tuple(fixed(array) for array in held)
    largest = max(float(np.abs(fiblets.origin).max(initial=0.0)), float(np.abs(fiblets.bounds).max(initial=0.0)))
    slack = 64.0 * float(np.spacing(largest)) if np.isfinite(largest) else 0.0
    scale = np.array(p.anchor_scale, np.float64)
    grid = (np.array(p.origin, np.float64), scale, low is not None, p.reach_scale, p.end_scale, slack)
    ranks = np.zeros(0, np.bool_)
    if streamlines is not None:
        ids = fiblets.rank_to_id
        ranks = np.ascontiguousarray(streamlines if ids is None else streamlines[np.asarray(ids)], np.bool_)
        if not ranks.any():
            return
    for first in range(0, fiblets.n_fiblets, FIBLETS):
        count = min(FIBLETS, fiblets.n_fiblets - first)
        found, balls = np.empty(count, np.bool_), np.empty((count, 4))
        if not screen_kernels.candidates(first, count, arrays, grid, spaces, ranks, found, balls):
            continue
        which = np.flatnonzero(found)
        side = np.ones(len(which), np.int8)
        if region is not None:
            from ..regions.classify import classify

            side = classify(region, balls[which, :3], balls[which, 3])
        for here, chosen in ((None, which[side > 0]), (region, which[side == 0])):
            for at in range(0, len(chosen), DECODED):
                yield first + chosen[at : at + DECODED], here


def _hit(
    fiblets: FibletSet, which: Ints, screen: Any, words: npt.NDArray[np.uint32], region: Region | None
) -> tuple[Ints, Array, Array]:
    """Rank, depth (-1 to 1) and place among all points of each fiblet that is hit."""
    records, anchors = fiblets.decoding[which], fiblets.anchors[which]
    own = unpack("last", records).astype(np.int64) + 1
    goes_on = unpack("end", anchors) == 0
    counts = own + goes_on
    starts = np.cumsum(counts) - counts
    points = np.empty((int(counts.sum()), 3))
    decode_fiblets(fiblets, which, starts, points)
    points[(starts + own)[goes_on]] = _anchors(fiblets, which[goes_on] + 1)
    first = unpack("point", records).astype(np.int64) + fiblets.pages[which >> PAGE_BITS, 2]
    if len(words) and not 0 <= int(first.min()) <= int((first + counts).max()) <= 32 * len(words):
        raise IndexError(f"points up to {(first + counts).max()} of {fiblets.n_points}")  # kernels do not look
    # What is cut off at its begin comes from the fiblet before; its first point alone is no line of its own.
    lonely = (counts == 1) & (unpack("begin", anchors) == 0)
    if region is None:
        depths, places = np.empty(len(which)), np.empty(len(which))
        screen_kernels.hits(points, starts, counts, first, screen, words, depths, places)
    else:
        depths, places = _in_region(points, starts, counts, first, screen, words, region)
    kept = np.isfinite(depths) & ~lonely
    ranks = unpack("rank", anchors).astype(np.int64) + fiblets.pages[which >> PAGE_BITS, 0]
    return ranks[kept], depths[kept], (first + places)[kept]


def _in_region(
    points: Array, starts: Ints, counts: Ints, first: Ints, screen: Any, words: Any, region: Region
) -> tuple[Array, Array]:
    """Depth and place of each fiblet's nearest place under the area that lies in a region."""
    matrix, _, size, polygon, tolerance = screen
    found = np.empty((len(points), 2))
    screen_kernels.spans(points, starts, counts, first, screen, words, found)
    depths, places = np.full(len(starts), np.inf), np.zeros(len(starts))
    rows = np.flatnonzero(~np.isnan(found[:, 0]))
    if not len(rows):
        return depths, places
    owner = np.searchsorted(starts, rows, side="right") - 1
    following = np.minimum(rows + 1, (starts + counts)[owner] - 1)
    share = np.linspace(0.0, 1.0, SAMPLES)
    t = found[rows, :1] + share * (found[rows, 1:] - found[rows, :1])
    at = points[rows, None] + t[..., None] * (points[following] - points[rows])[:, None]
    at = at.reshape(-1, 3)
    clip = np.column_stack([at, np.ones(len(at))]) @ matrix.T
    pixels = (clip[:, :2] / clip[:, 3:] + 1.0) * 0.5 * size
    inside = area_distances(polygon, pixels) <= tolerance + 1e-6
    inside[inside] = region.contains(at[inside])
    depth = np.where(inside, clip[:, 2] / clip[:, 3], np.inf).reshape(len(rows), SAMPLES)
    best = depth.argmin(axis=1)
    nearest = depth[np.arange(len(rows)), best]
    order = np.lexsort((nearest, owner))
    owners, leading = np.unique(owner[order], return_index=True)
    chosen = order[leading]
    depths[owners] = nearest[chosen]
    places[owners] = rows[chosen] - starts[owners] + t[chosen, best[chosen]]
    return depths, places


def _anchors(fiblets: FibletSet, which: Ints) -> Array:
    """First points of fiblets, in the arithmetic of decoding."""
    words = fiblets.anchors[which]
    grid = np.column_stack([unpack(f"anchor_{axis}", words) for axis in "xyz"]).astype(np.float64)
    if fiblets.anchors_low is not None:
        grid = grid * 65536.0 + fiblets.anchors_low[which]
    found: Array = np.array(fiblets.parameters.anchor_scale) * grid + np.array(fiblets.parameters.origin)
    return found
