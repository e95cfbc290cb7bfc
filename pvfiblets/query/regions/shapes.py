"""Shapes: what regions (:mod:`.region`) are made of.

Symbols: a shape is a unit shape placed in the world by an affine map. With ``A`` ``(3, 3)`` and ``c`` ``(3,)`` a world
position ``p`` (mm) has the unit coordinates ``u = A (p - c)``; ``c`` is kept apart because at 10^6 mm from the origin
``A p - A c`` loses what ``p - c`` keeps. The unit shapes:

========  =========================  =====================================================================
kind      shape                      holds ``u`` where
========  =========================  =====================================================================
PLANE     :class:`Plane`             ``u_z >= 0``
SLAB      :class:`Slab`              ``|u_z| <= 1``
BOX       :class:`Box`               ``max |u_i| <= 1``
SPHERE    :class:`Sphere`            ``u . u <= 1``
SURFACE   `Surface`                  winding number of the mesh about ``u`` (the surface's own mm) is not 0
LABELS    `Labels`                   the voxel nearest to ``u`` (voxel coordinates) is one of those chosen
========  =========================  =====================================================================
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from .placement import Bounds, finite_vector, frame_about, positive
from .region import AND, MAX_LEAVES, MAX_OPS, MAX_STACK, NOT, OR, Region, Shape

__all__ = [
    "AND",
    "BOX",
    "LABELS",
    "MAX_LEAVES",
    "MAX_OPS",
    "MAX_STACK",
    "NOT",
    "OR",
    "PLANE",
    "SLAB",
    "SPHERE",
    "SURFACE",
    "Box",
    "Plane",
    "Region",
    "Shape",
    "Slab",
    "Sphere",
]

Array = npt.NDArray[np.float64]
Flags = npt.NDArray[np.bool_]

PLANE, SLAB, BOX, SPHERE, SURFACE, LABELS = range(6)


class Plane(Shape):
    """The half-space on the side of a plane to which its normal points, the plane itself included.

    Parameters
    ----------
    normal : array_like
        ``(3,)``, of any length but 0.
    origin : array_like
        ``(3,)`` mm: a point of the plane.

    Raises
    ------
    ValueError
        If a number is not finite or the normal is 0.
    """

    def __init__(self, normal: npt.ArrayLike, origin: npt.ArrayLike = (0.0, 0.0, 0.0)) -> None:
        super().__init__(PLANE, frame_about(normal, "normal"), finite_vector(origin, "origin"))

    def apart(self, points: Array) -> Array:
        """Exact up to rounding, under any matrix."""
        found: Array = np.maximum(-self._unit(points)[2], 0.0) / np.linalg.norm(self._linear[2])
        return found

    def extents(self) -> tuple[Bounds, Bounds]:
        """See :meth:`Shape.extents`."""
        return Bounds.of_half_space(self._linear[2], self._centre), Bounds.of_half_space(-self._linear[2], self._centre)

    def __repr__(self) -> str:
        return f"Plane(normal={self._linear[2].tolist()}, origin={self._centre.tolist()})"


class Slab(Shape):
    """The space between two parallel planes, the planes included.

    Parameters
    ----------
    normal : array_like
        ``(3,)``, of any length but 0.
    origin : array_like
        ``(3,)`` mm: a point halfway between the planes.
    thickness : float
        mm from plane to plane.

    Raises
    ------
    ValueError
        If a number is not finite, the normal is 0, or the thickness is not above 0.
    """

    def __init__(self, normal: npt.ArrayLike, origin: npt.ArrayLike, thickness: float) -> None:
        linear = frame_about(normal, "normal")
        linear[2] *= 1.0 / (positive(thickness, "thickness") / 2.0)
        super().__init__(SLAB, linear, finite_vector(origin, "origin"))

    def apart(self, points: Array) -> Array:
        """Exact up to rounding, under any matrix."""
        found: Array = np.maximum(np.abs(self._unit(points)[2]) - 1.0, 0.0) / np.linalg.norm(self._linear[2])
        return found

    def extents(self) -> tuple[Bounds, Bounds]:
        """See :meth:`Shape.extents`."""
        normal = self._linear[2]
        half = normal / float(normal @ normal)
        low = Bounds.of_half_space(normal, self._centre - half)
        return low & Bounds.of_half_space(-normal, self._centre + half), Bounds.everything()

    def __repr__(self) -> str:
        row = self._linear[2]
        return f"Slab({row.tolist()}, {self._centre.tolist()}, {2.0 / float(np.linalg.norm(row))})"


class Box(Shape):
    """A box, its faces included.

    Parameters
    ----------
    bounds : array_like, optional
        ``(6,)`` mm: xmin, xmax, ymin, ymax, zmin, zmax.
    center : array_like, optional
        ``(3,)`` mm; instead of bounds, with `size`.
    size : float or array_like, optional
        mm along the box's own axes, one number for a cube.
    rotation : array_like, optional
        ``(3, 3)`` orthogonal: its columns are the directions of the box's own axes. About the centre.

    Raises
    ------
    ValueError
        If a number is not finite, a size is not above 0, bounds are reversed, or the rotation is invalid.
    """

    def __init__(
        self,
        bounds: npt.ArrayLike | None = None,
        *,
        center: npt.ArrayLike | None = None,
        size: npt.ArrayLike | None = None,
        rotation: npt.ArrayLike | None = None,
    ) -> None:
        if bounds is not None:
            if center is not None or size is not None:
                raise ValueError("a box has either bounds or a center and a size; leave one out")
            low, high = finite_vector(bounds, "bounds", 6).reshape(3, 2).T
            if not (low < high).all():
                raise ValueError(f"bounds are {np.ravel(bounds).tolist()}; give xmin < xmax, ymin < ymax, zmin < zmax")
            middle = low / 2 + high / 2
            # Measured from the rounded middle, so that the faces themselves are in.
            half = np.maximum(high - middle, middle - low)
            name = "bounds' half size"
        elif center is not None and size is not None:
            middle = finite_vector(center, "center")
            half = np.asarray(size, np.float64) / 2
            if half.shape not in ((), (1,), (3,)):
                raise ValueError(f"size is {np.asarray(size).tolist()}; give one number of mm, or three")
            name = "half of the size"
        else:
            raise ValueError("a box needs bounds=(xmin, xmax, ymin, ymax, zmin, zmax), or center= and size=")
        turn = np.eye(3)
        if rotation is not None:
            turn = np.array(rotation, np.float64)
            if turn.shape != (3, 3) or not np.allclose(turn.T @ turn, np.eye(3), rtol=0.0, atol=1e-6):
                raise ValueError(f"rotation is {turn.tolist()}; give an orthogonal (3, 3) matrix, axes in its columns")
        scales = np.array([1.0 / positive(n, name) for n in np.broadcast_to(half, 3)])
        super().__init__(BOX, scales[:, None] * turn.T, middle)

    def apart(self, points: Array) -> Array:
        """Exact up to rounding, of sheared boxes to 1e-9 of their size."""
        from .convex import box_distance

        return box_distance(self._linear, np.stack(self._unit(points), axis=1))

    def extents(self) -> tuple[Bounds, Bounds]:
        """See :meth:`Shape.extents`."""
        reach = np.abs(np.linalg.inv(self._linear)).sum(axis=1)
        return Bounds(self._centre - reach, self._centre + reach), Bounds.everything()

    def __repr__(self) -> str:
        return f"Box(bounds={self.bounds.tolist()})"


class Sphere(Shape):
    """A ball, its surface included; an ellipsoid once moved by a matrix that stretches.

    Parameters
    ----------
    center : array_like
        ``(3,)`` mm.
    radius : float
        mm.

    Raises
    ------
    ValueError
        If a number is not finite or the radius is not above 0.
    """

    def __init__(self, center: npt.ArrayLike, radius: float) -> None:
        linear = np.eye(3) / positive(radius, "radius")
        super().__init__(SPHERE, linear, finite_vector(center, "center"))

    def apart(self, points: Array) -> Array:
        """Exact up to rounding, of ellipsoids to 1e-9 of their size."""
        from .convex import ellipsoid_distance

        return ellipsoid_distance(self._linear, np.stack(self._unit(points), axis=1))

    def extents(self) -> tuple[Bounds, Bounds]:
        """See :meth:`Shape.extents`."""
        reach = np.linalg.norm(np.linalg.inv(self._linear), axis=1)
        return Bounds(self._centre - reach, self._centre + reach), Bounds.everything()

    def __repr__(self) -> str:
        return f"Sphere(center={self._centre.tolist()}, bounds={self.bounds.tolist()})"
