"""Regions over the picture: their outlines and handles, and what a region becomes when a handle is dragged.

Places in the picture are shares of its width and height from its upper left, as browsers count.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

if TYPE_CHECKING:
    from vtkmodules.vtkRenderingCore import vtkCamera

CORNERS = 32  # of a circle
THINNEST = 1e-3  # of a box: a face is not dragged nearer than this share of its side to the other
_Floats = NDArray[np.float64]


class Sight:
    """The projection of a camera."""

    def __init__(self, camera: vtkCamera, width: int, height: int) -> None:
        matrix = camera.GetCompositeProjectionTransformMatrix(width / max(height, 1), -1.0, 1.0)
        self._matrix = np.array([[matrix.GetElement(i, j) for j in range(4)] for i in range(4)])
        self._inverse = np.linalg.inv(self._matrix)
        self.eye = np.array(camera.GetPosition(), np.float64)
        self.ahead = np.array(camera.GetDirectionOfProjection(), np.float64)
        right = np.cross(self.ahead, camera.GetViewUp())
        self.right: _Floats = right / np.linalg.norm(right)
        self.parallel = bool(camera.GetParallelProjection())

    def shares(self, points: ArrayLike) -> _Floats | None:
        """Return ``(n, 2)`` places in the picture of ``(n, 3)`` points; ``None`` if one lies behind the camera."""
        given = np.asarray(points, np.float64).reshape(-1, 3)
        seen = np.column_stack([given, np.ones(len(given))]) @ self._matrix.T
        if (seen[:, 3] <= 0.0).any():
            return None
        flat = seen[:, :2] / seen[:, 3:]
        return np.column_stack([0.5 + 0.5 * flat[:, 0], 0.5 - 0.5 * flat[:, 1]])

    def beneath(self, place: Sequence[float], at: ArrayLike) -> _Floats:
        """Return the point that a place in the picture shows, as far away as another point is."""
        seen = self._matrix @ np.append(np.asarray(at, np.float64), 1.0)
        clip = np.array([2.0 * place[0] - 1.0, 1.0 - 2.0 * place[1], seen[2] / seen[3], 1.0])
        found = self._inverse @ clip
        return np.asarray(found[:3] / found[3])

    def towards(self, point: ArrayLike) -> _Floats:
        """Return the direction in which a point is seen."""
        if self.parallel:
            return self.ahead
        way = np.asarray(point, np.float64) - self.eye
        return np.asarray(way / (np.linalg.norm(way) or 1.0))


def mark(shape: Mapping[str, Any], sight: Sight) -> dict[str, Any] | None:
    """Return how a region is drawn over the picture."""
    if shape["kind"] == "sphere":
        curves, places = _sphere(shape, sight)
    elif shape["kind"] == "box":
        curves, places = _box(shape["bounds"])
    else:
        return None
    drawn = [seen for curve in curves if (seen := sight.shares(curve)) is not None]
    spots = {name: seen[0] for name, place in places.items() if (seen := sight.shares(place)) is not None}
    if not drawn or "center" not in spots:
        return None
    return {
        "lines": [" ".join(f"{x:.1f},{y:.1f}" for x, y in (1000.0 * seen).clip(-1e5, 1e5)) for seen in drawn],
        "handles": [
            {"name": name, "x": round(100.0 * float(x), 2), "y": round(100.0 * float(y), 2)}
            for name, (x, y) in spots.items()
        ],
    }


def dragged(shape: Mapping[str, Any], handle: str, place: Sequence[float], sight: Sight) -> dict[str, Any]:
    """Return what a region changes when one of its handles is dragged to a place in the picture."""
    if shape["kind"] == "sphere" and handle == "center":
        return {"center": sight.beneath(place, shape["center"]).tolist()}
    if shape["kind"] == "sphere" and handle == "radius":
        centre = np.asarray(shape["center"], np.float64)
        radius = float(np.linalg.norm(sight.beneath(place, centre) - centre))
        return {"radius": max(radius, 0.02 * shape["radius"])}
    if shape["kind"] == "box" and handle == "center":
        bounds = np.asarray(shape["bounds"], np.float64)
        middle = 0.5 * (bounds[::2] + bounds[1::2])
        return {"bounds": (bounds + np.repeat(sight.beneath(place, middle) - middle, 2)).tolist()}
    if shape["kind"] == "box" and handle in _FACES:
        return {"bounds": _stretched(shape["bounds"], _FACES.index(handle), place, sight)}
    raise ValueError(f"a {shape['kind']} has no handle {str(handle)[:40]!r}")


_FACES = ("xmin", "xmax", "ymin", "ymax", "zmin", "zmax")


def _stretched(ends: Sequence[float], face: int, place: Sequence[float], sight: Sight) -> list[float]:
    """Return the bounds of a box after a face was dragged along its axis, as far as the pointer has moved."""
    bounds = [float(end) for end in ends]
    at = _faces(bounds)[_FACES[face]]
    pointed = sight.beneath(place, at)
    axis = np.eye(3)[face // 2]
    ray = sight.towards(pointed)
    across = axis - np.dot(axis, ray) * ray  # the axis as it is seen
    if (seen := float(np.dot(across, across))) > 1e-4:  # it does not point at the eye
        bounds[face] += float(np.dot(pointed - at, across)) / seen
    low, high = face // 2 * 2, face // 2 * 2 + 1
    least = THINNEST * abs(float(ends[high]) - float(ends[low]))
    if face == low:
        bounds[low] = min(bounds[low], bounds[high] - least)
    else:
        bounds[high] = max(bounds[high], bounds[low] + least)
    return bounds


def _faces(bounds: Sequence[float]) -> dict[str, _Floats]:
    """Return the middles of a box's faces."""
    ends = np.asarray(bounds, np.float64)
    middle = 0.5 * (ends[::2] + ends[1::2])
    found = {}
    for face, name in enumerate(_FACES):
        found[name] = middle.copy()
        found[name][face // 2] = ends[face]
    return found


def _box(bounds: Sequence[float]) -> tuple[list[_Floats], dict[str, _Floats]]:
    corners = [np.array(corner) for corner in product(*(bounds[k : k + 2] for k in (0, 2, 4)))]
    edges = [
        np.array([first, last])
        for i, first in enumerate(corners)
        for last in corners[i + 1 :]
        if np.count_nonzero(first != last) == 1
    ]
    faces = _faces(bounds)
    return edges, {"center": 0.5 * (faces["xmin"] + faces["xmax"]), **faces}


def _sphere(shape: Mapping[str, Any], sight: Sight) -> tuple[list[_Floats], dict[str, _Floats]]:
    """Return the outline of a sphere as it is seen, and its equator."""
    centre, radius = np.asarray(shape["center"], np.float64), float(shape["radius"])
    angle = np.linspace(0.0, 2.0 * np.pi, CORNERS + 1)[:, None]
    ahead = sight.towards(centre)
    side = sight.right - np.dot(sight.right, ahead) * ahead
    side /= np.linalg.norm(side)
    up = np.cross(side, ahead)
    middle, seen = centre, radius
    distance = float(np.linalg.norm(centre - sight.eye))
    if not sight.parallel and distance > radius:  # the circle in which lines of sight touch it
        middle = centre - radius * (radius / distance) * ahead
        seen = radius * float(np.sqrt(1.0 - (radius / distance) ** 2))
    outline = middle + seen * (np.cos(angle) * side + np.sin(angle) * up)
    equator = centre + radius * (np.cos(angle) * np.array([1.0, 0, 0]) + np.sin(angle) * np.array([0, 1.0, 0]))
    return [outline, equator], {"center": centre, "radius": centre + radius * side}
