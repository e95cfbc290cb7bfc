"""What each ray through a volume meets, in float64 and with no thought for the GPU: what shaders are held to.

Source: Lesar, "Real-time ray casting of volumetric data" (2015), sections III-B, III-E and III-F, equations 2 and 6
to 9; local maxima: Sato et al., "Local maximum intensity projection (LMIP)" (1998).

No ray is sampled. Between voxel centres the field is a polynomial in each coordinate, and so one along a ray within a
cell, which is found exactly (:mod:`.reference_cells`), and taken apart where it turns. Crossings are roots between two
such places, maxima lie at them, and the integral of equation 7 is smooth between them and the entries of the transfer
function's table. No answer depends on a step, and none misses a feature thinner than one.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from pvfiblets.volumes.transfer import LARGEST_DEPTH, Transfer
from pvfiblets.volumes.volume import FILTERS, RaycastVolume

from .reference_rays import Rays, rays

__all__ = ["Crossings", "Maxima", "Rays", "composite", "gradient", "isosurface", "mip", "rays", "sample"]

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

ORDER = 8  # nodes of the Gauss rule: exact for polynomials of degree 15

ROUNDING = 1e-14
"""Part of the largest value that may be rounding's: so near to a value, the field is at it; so little behind a local
maximum, it has not fallen."""


@dataclass(frozen=True, eq=False)
class Crossings:
    """Where rays cross an isosurface; all are ``(...)`` as the rays are."""

    t: Array  # float64 mm along the ray; NaN where it crosses none
    value: Ints  # int64 index of the isosurface's value; -1 where it crosses none
    gradient: Array  # `(..., 3)` float64 per mm, by central differences (:func:`gradient`); NaN where it crosses none
    depth: Array  # float64 window depth; 1 where it crosses none
    # float64 mm from there to where the ray crosses that isosurface again, or else to its far end: what looks at
    # places farther apart may not see it. NaN where it crosses none.
    chord: Array


@dataclass(frozen=True, eq=False)
class Maxima:
    """Greatest values along rays; both are ``(...)`` as the rays are."""

    value: Array  # float64; NaN where there is none
    t: Array  # float64 mm along the ray, of the first place that has it; NaN where there is none


@dataclass(frozen=True, eq=False)
class _Walked:
    """A volume and rays in the form that the kernels take."""

    field: npt.NDArray[np.float32]
    how: int
    origins: Array
    directions: Array
    near: Array
    far: Array


def _field(volume: RaycastVolume, filter: str) -> tuple[npt.NDArray[np.float32], int]:  # noqa: A002
    if filter not in FILTERS:
        raise ValueError(f"filter is {filter!r}; choose one of {', '.join(map(repr, FILTERS))}")
    # All that volumes hold is exact in float32; one type means one compilation.
    return np.ascontiguousarray(volume.values, np.float32), FILTERS.index(filter)


def _walked(volume: RaycastVolume, through: Rays, filter: str) -> _Walked:  # noqa: A002
    field, how = _field(volume, filter)
    turn, move = volume.inverse[:3, :3], volume.inverse[:3, 3]
    # The nearest voxel's cells begin half a voxel before it.
    origins = through.origins.reshape(-1, 3) @ turn.T + move + (0.5 if filter == "nearest" else 0.0)
    directions = through.directions.reshape(-1, 3) @ turn.T
    return _Walked(field, how, origins, directions, through.near.ravel(), through.far.ravel())


def _rounding(volume: RaycastVolume) -> float:
    return ROUNDING * max(map(abs, volume.value_range))


# -------------------------------------------------------------------------------------------------------------- modes


def isosurface(
    volume: RaycastVolume,
    values: npt.ArrayLike,
    through: Rays,
    *,
    filter: str = "trilinear",  # noqa: A002
) -> Crossings:
    """Where rays first pass through an isosurface, from either side (section III-B, equation 2)."""
    # A value is crossed where the field gets to it from below, or falls below it. Where it only touches a value nothing
    # is crossed, nor where a ray begins.
    from . import reference_kernels as kernels

    levels = np.atleast_1d(np.array(values, np.float64))
    if levels.ndim != 1 or levels.size == 0 or not np.isfinite(levels).all():
        raise ValueError(f"values of isosurfaces are {levels.tolist()}; give one or several finite numbers")
    walk = _walked(volume, through, filter)
    n, shape = len(walk.near), through.near.shape
    hits, chord, level = np.full(n, np.nan), np.full(n, np.nan), np.full(n, -1)
    voxels = np.zeros((n, 3), np.int64)
    kernels.first_crossings(
        walk.field, walk.how, walk.origins, walk.directions, walk.near, walk.far, levels, _rounding(volume), hits,
        level, chord, voxels,
    )  # fmt: skip
    places = voxels.astype(np.float64) if filter == "nearest" else walk.origins + hits[:, None] * walk.directions
    places[level < 0] = np.nan
    gradients = _gradients(volume, places, filter).reshape(*shape, 3)
    t = hits.reshape(shape)
    return Crossings(t, level.reshape(shape), gradients, through.depth(t), chord.reshape(shape))


def mip(
    volume: RaycastVolume,
    through: Rays,
    *,
    filter: str = "trilinear",  # noqa: A002
    low: float = -math.inf,
    high: float = math.inf,
    threshold: float | None = None,
) -> Maxima:
    """Greatest value along rays (section III-F, equation 9), or the first local maximum above a threshold."""
    from . import reference_kernels as kernels

    if not low <= high:
        raise ValueError(f"the thresholds are {low} and {high}; give the lower one first")
    if threshold is not None and math.isnan(threshold):
        raise ValueError("threshold is nan; give a number, or None for the greatest value")
    walk = _walked(volume, through, filter)
    shape = through.near.shape
    value, t = np.full(shape, np.nan), np.full(shape, np.nan)
    kernels.greatest(
        walk.field, walk.how, walk.origins, walk.directions, walk.near, walk.far, float(low), float(high),
        math.inf if threshold is None else float(threshold), _rounding(volume), value.ravel(), t.ravel(),
    )  # fmt: skip
    return Maxima(value, t)


def composite(
    volume: RaycastVolume,
    transfer: Transfer,
    through: Rays,
    tolerance: float = 1e-8,
    *,
    filter: str = "trilinear",  # noqa: A002
    low: float = -math.inf,
    high: float = math.inf,
) -> Array:
    """What rays show of a volume that emits and absorbs light (section III-E, equations 6 to 8)."""
    from . import reference_light as light

    if not 0.0 < tolerance < 1.0:
        raise ValueError(f"tolerance is {tolerance}; give a number above 0 and below 1")
    if not low <= high:
        raise ValueError(f"the thresholds are {low} and {high}; give the lower one first")
    walk = _walked(volume, through, filter)
    knots, pieces = _pieces(transfer, float(low), float(high))
    found = np.zeros((len(walk.near), 4))
    found[:, 3] = 1.0
    light.integrals(
        walk.field, walk.how, walk.origins, walk.directions, walk.near, walk.far, knots, pieces, transfer.unit,
        *_gauss(ORDER), LARGEST_DEPTH, float(tolerance), found,
    )  # fmt: skip
    found[:, 3] = 1.0 - found[:, 3]
    return found.reshape(*through.near.shape, 4)


def _pieces(transfer: Transfer, low: float, high: float) -> tuple[Array, Array]:
    """Values where a transfer function has kinks, and the pieces before, between and after them."""
    # `(m,)` and `(m + 1, 10)`: values at a piece's ends, RGBA at the one and at the other.
    table = transfer.table.astype(np.float64)
    entries = np.linspace(*transfer.clim, len(table))
    # The highest value that is there belongs to the piece below it.
    edges = [edge for edge in (low, np.nextafter(high, np.inf)) if np.isfinite(edge)]
    knots = np.unique(np.concatenate([entries, edges]))
    colours = np.stack([np.interp(knots, entries, column) for column in table.T], axis=-1)
    pieces = np.zeros((len(knots) + 1, 10))
    pieces[1:-1] = np.concatenate([knots[:-1, None], knots[1:, None], colours[:-1], colours[1:]], axis=1)
    pieces[0] = knots[0], knots[0], *colours[0], *colours[0]
    pieces[-1] = knots[-1], knots[-1], *colours[-1], *colours[-1]
    starts, ends = np.append(-np.inf, knots), np.append(knots, np.inf)
    pieces[(starts < low) | (ends > np.nextafter(high, np.inf)), 2:] = 0.0
    return knots, pieces


def _gauss(order: int) -> tuple[Array, Array, Array]:
    """Nodes and weights of Gauss' rule on 0 to 1, and ``(order, order)`` weights of integrals from 0 to each node."""
    nodes, weights = np.polynomial.legendre.leggauss(order)
    nodes = (nodes + 1.0) / 2.0
    powers = np.arange(order)
    moments = nodes[:, None] ** (powers + 1) / (powers + 1)
    return nodes, weights / 2.0, moments @ np.linalg.inv(nodes[:, None] ** powers)


# -------------------------------------------------------------------------------------------------------------- places


def sample(volume: RaycastVolume, points: npt.ArrayLike, filter: str = "trilinear") -> Array:  # noqa: A002
    """The field at places."""
    from . import reference_kernels as kernels

    field, how = _field(volume, filter)
    points = np.asarray(points, np.float64)
    values = np.empty(points.shape[:-1])
    kernels.samples(field, how, _in_voxels(volume, points), values.reshape(-1))
    return values


def gradient(volume: RaycastVolume, points: npt.ArrayLike, filter: str = "trilinear") -> Array:  # noqa: A002
    """The field's gradient at places, by central differences (section III-A)."""
    # Differences are of the field one voxel to either side along each axis of the grid, or at the edge of the box of
    # the voxels' centres where that is nearer, over the distance between the two.
    points = np.asarray(points, np.float64)
    return _gradients(volume, _in_voxels(volume, points), filter).reshape(points.shape)


def _in_voxels(volume: RaycastVolume, points: Array) -> Array:
    return np.ascontiguousarray(points.reshape(-1, 3) @ volume.inverse[:3, :3].T + volume.inverse[:3, 3])


def _gradients(volume: RaycastVolume, places: Array, filter: str) -> Array:  # noqa: A002
    """Gradients per mm at places in voxels, NaN at NaN."""
    from . import reference_kernels as kernels

    field, how = _field(volume, filter)
    found = np.full(places.shape, np.nan)
    kernels.gradients(field, how, places, found)
    # Per voxel along the grid's axes; these are rows of the inverse affine.
    return found @ volume.inverse[:3, :3]
