"""Closed surfaces as regions: what a triangle mesh encloses."""

from __future__ import annotations

import warnings
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from .placement import Bounds, positions
from .shapes import SURFACE, Shape

if TYPE_CHECKING:
    from .fields import Field

Array = npt.NDArray[np.float64]
Corners = npt.NDArray[np.int64]

FEW, LOSS = 50_000, 0.03
"""Of more triangles than that, a field's values may fall short of the distance by this share: of a sphere of 700,000 it
takes a quarter of the time."""

_MOST_CELLS = 2048
_SIMILAR = 1e-12


class Mesh:
    """Triangles, and what finds them fast; made when first asked for."""

    def __init__(self, points: Array, triangles: Corners) -> None:
        self.points = points  # `(n, 3)` float64 mm, finite
        self.triangles = triangles  # `(m, 3)` int64, at least one
        self.points.flags.writeable = self.triangles.flags.writeable = False
        used = points[np.unique(triangles)]
        self.low: Array = used.min(axis=0)
        self.high: Array = used.max(axis=0)

    @cached_property
    def cells(self) -> tuple[Any, ...]:
        """Triangles by cells of the projection along z: see :mod:`.surface_kernels`."""
        from .surface_kernels import build_cells

        extent = self.high - self.low
        # About two cells a triangle, square ones.
        side = np.sqrt(max(float(extent[0] * extent[1]), 1e-300) / (2.0 * len(self.triangles)))
        side = max(side, float(extent.max()) / _MOST_CELLS)
        nx, ny = (int(np.clip(n, 1, _MOST_CELLS)) for n in extent[:2] / side) if side > 0.0 else (1, 1)
        steps = np.array([n / e if e > 0.0 else 0.0 for n, e in ((nx, extent[0]), (ny, extent[1]))])
        first, members = build_cells(self.points, self.triangles, self.low, steps, nx, ny)
        return self.points, self.triangles, first, members, self.low, self.high, steps, nx, ny

    @cached_property
    def tree(self) -> tuple[Any, ...]:
        """Boxes around triangles: see :mod:`.surface_kernels`."""
        from .surface_kernels import build_tree

        return build_tree(self.points, self.triangles)

    @cached_property
    def field(self) -> Field:
        """Signed distance bounds around the mesh."""
        from .fields import Field, rounded_towards_zero, surface_grid
        from .surface_kernels import nodes_of_grid

        first, step, (nx, ny, nz) = surface_grid(self.low, self.high)
        signed = np.empty((nz, ny, nx))
        share = 1.0 if len(self.triangles) <= FEW else (1.0 - LOSS) ** 2
        nodes_of_grid(*self.cells, *self.tree, share, first, step, signed)
        # Distances are computed to within a few units of the last place of the coordinates.
        lost = 1e-14 * float(max(np.abs(self.low).max(), np.abs(self.high).max()))
        signed = np.sign(signed) * np.maximum(np.abs(signed) * (1.0 - 1e-12) - lost, 0.0)
        spacing = np.full(3, step)
        return Field(rounded_towards_zero(signed), first, spacing, spacing, False)

    def windings(self, linear: Array, centre: Array, places: Array) -> npt.NDArray[np.int32]:
        """Winding numbers about ``linear (places - centre)``."""
        from .surface_kernels import winding

        found = np.empty(len(places), np.int32)
        winding(*self.cells, linear, centre, np.ascontiguousarray(places), found)
        return found

    def distances(self, places: Array) -> Array:
        """``(n,)`` distances of places ``(n, 3)`` from the nearest triangle."""
        from .surface_kernels import distances

        found = np.empty(len(places))
        distances(self.points, self.triangles, *self.tree, np.ascontiguousarray(places), found)
        return found


class Surface(Shape):
    """The inside of a closed triangle mesh: positions with a winding number other than 0.

    A mesh may have several components; each encloses its own inside. An inner component is a hole if its triangles face
    inwards; if they face outwards it changes nothing.

    Parameters
    ----------
    points : array_like
        ``(n, 3)`` mm; equal positions are merged.
    triangles : array_like
        ``(m, 3)`` indices of points.

    Raises
    ------
    ValueError
        If there is no triangle, a position is not finite, an index is out of range, or the mesh is not closed: each
        edge needs as many triangles in one direction as in the other.

    Warns
    -----
    UserWarning
        If the mesh as a whole faces inwards; its triangles are then flipped.

    Notes
    -----
    Triangles with two equal corners are dropped. ``contains`` is exact up to the rounding of positions: on the surface
    itself the result may be either.
    """

    def __init__(self, points: npt.ArrayLike, triangles: npt.ArrayLike) -> None:
        self._mesh = Mesh(*_closed(points, triangles))
        self._baked: Mesh | None = None
        super().__init__(SURFACE, np.eye(3), np.zeros(3))

    @property
    def mesh(self) -> Mesh:
        """The triangles in the surface's own mm, which moved copies share."""
        return self._mesh

    @property
    def points(self) -> Array:
        """``(n, 3)`` float64 mm, as moved, without repeated positions."""
        return self._world.points

    @property
    def triangles(self) -> Corners:
        """``(m, 3)`` int64."""
        return self._mesh.triangles

    @property
    def field(self) -> Field:
        """Signed distance bounds in the surface's own mm, made when first asked for and shared by moved copies."""
        return self._mesh.field

    def distance(self, points: npt.ArrayLike) -> Array:
        """Distances of positions from the surface, inside as well as outside.

        Parameters
        ----------
        points : array_like
            ``(n, 3)`` mm, or one position ``(3,)``.

        Returns
        -------
        numpy.ndarray
            ``(n,)`` float64 mm, exact up to rounding under any matrix; NaN where a coordinate is not finite. As part of
            an expression made with ``|`` a surface counts as its enclosed volume, with distance 0 inside.
        """
        places = positions(points)
        finite = np.isfinite(places).all(axis=1)
        found = np.full(len(places), np.nan)
        found[finite] = self._unsigned(places[finite])
        return found

    def signed_distance(self, points: npt.ArrayLike) -> Array:
        """Return signed distances: as :meth:`distance`, negative outside."""
        return np.where(self.contains(points), 1.0, -1.0) * self.distance(points)

    def _unsigned(self, places: Array) -> Array:
        scale = self._similarity
        if scale is None:
            return self._world.distances(places)
        return self._mesh.distances(np.stack(self._unit(places), axis=1)) / scale

    @property
    def _similarity(self) -> float | None:
        """Own mm per mm if they differ by one scale only."""
        values = np.linalg.svd(self._linear, compute_uv=False)
        return float(values[0]) if values[0] - values[2] <= _SIMILAR * values[0] else None

    @property
    def _world(self) -> Mesh:
        """The mesh as moved."""
        if self._baked is None:
            still = (self._linear == np.eye(3)).all() and not self._centre.any()
            moved = self._mesh.points @ np.linalg.inv(self._linear).T + self._centre
            self._baked = self._mesh if still else Mesh(moved, self._mesh.triangles)
        return self._baked

    @property
    def _data(self) -> object:
        return self._mesh

    def _shared(self) -> dict[str, Any]:
        return {"_mesh": self._mesh, "_baked": None}

    def holds(self, points: Array) -> npt.NDArray[np.bool_]:
        """See :meth:`.Shape.holds`."""
        found: npt.NDArray[np.bool_] = self._mesh.windings(self._linear, self._centre, points) != 0
        return found

    def spans(self, a: Array, b: Array) -> tuple[npt.NDArray[np.int64], Array]:
        """See :meth:`.Shape.spans`."""
        from .segment_kernels import surface_spans
        from .segments import counted_spans

        mesh = self._mesh
        return counted_spans(surface_spans, (mesh.cells, mesh.tree, self._linear, self._centre), a, b)

    def apart(self, points: Array) -> Array:
        """See :meth:`.Shape.apart`."""
        found = np.zeros(len(points))
        outside = ~self.holds(points)
        found[outside] = self._unsigned(points[outside])
        return found

    def extents(self) -> tuple[Bounds, Bounds]:
        """See :meth:`.Shape.extents`."""
        return Bounds(self._world.low, self._world.high), Bounds.everything()

    def __repr__(self) -> str:
        return f"Surface(<{len(self._mesh.points)} points>, <{len(self.triangles)} triangles>)"


def _closed(points: npt.ArrayLike, triangles: npt.ArrayLike) -> tuple[Array, Corners]:
    """Return a mesh whose places are each one point, closed and turned outwards."""
    places = positions(points)
    corners = np.asarray(triangles)
    if corners.size == 0:
        raise ValueError("a surface of no triangles encloses nothing; give at least four, e.g. polydata.triangulate()")
    if corners.ndim != 2 or corners.shape[1] != 3 or corners.dtype.kind not in "iu":
        raise ValueError(
            f"triangles have shape {corners.shape} and type {corners.dtype}; give (m, 3) integers, "
            "e.g. polydata.triangulate().regular_faces"
        )
    if corners.min() < 0 or corners.max() >= len(places):
        raise ValueError(
            f"triangles name the points {corners.min()} to {corners.max()}; there are {len(places)}, from 0 on"
        )
    if not np.isfinite(places[corners]).all():
        bad = int(np.nonzero(~np.isfinite(places).all(axis=1))[0][0])
        raise ValueError(f"point {bad} of the surface is {places[bad].tolist()}; give finite coordinates in mm")
    # A point that no triangle uses may be anything: it is left out here.
    used, renumbered = np.unique(corners, return_inverse=True)
    merged, same = np.unique(places[used] + 0.0, axis=0, return_inverse=True)
    found = same.reshape(-1)[renumbered.reshape(corners.shape)].astype(np.int64)
    a, b, c = found.T
    found = found[(a != b) & (b != c) & (c != a)]
    if not len(found):
        raise ValueError(f"all {len(corners)} triangles have two corners at one place; give a surface with an inside")
    _check_edges(found, len(merged))
    p, q, r = (merged[found[:, i]] - merged.mean(axis=0) for i in range(3))
    if float(np.einsum("ij,ij->", p, np.cross(q, r))) < 0.0:
        warnings.warn(
            "the surface is inside out; its triangles are turned round here "
            "(polydata.flip_faces() does so for good)",
            UserWarning,
            stacklevel=3,
        )
        found = np.ascontiguousarray(found[:, ::-1])
    return np.ascontiguousarray(merged), found


def _check_edges(triangles: Corners, n_points: int) -> None:
    start, end = triangles.ravel(), np.roll(triangles, -1, axis=1).ravel()
    # Each edge once, and how often it is run through one way and the other.
    keys, place = np.unique(np.minimum(start, end) * n_points + np.maximum(start, end), return_inverse=True)
    forth = np.bincount(place.reshape(-1), weights=start < end, minlength=len(keys))
    back = np.bincount(place.reshape(-1), weights=start > end, minlength=len(keys))
    odd = int(((forth + back) % 2 == 1).sum())
    if odd:
        raise ValueError(
            f"the surface is open: {odd} edges have one triangle (or an odd number) instead of two; close the mesh, "
            "e.g. polydata.fill_holes(hole_size), or clean it with polydata.clean() first"
        )
    turned = int((forth != back).sum())
    if turned:
        raise ValueError(
            f"the surface's triangles are not turned the same way: {turned} edges are run through twice in one "
            "direction; use polydata.compute_normals(consistent_normals=True, auto_orient_normals=True)"
        )
