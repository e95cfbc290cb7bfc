"""Cameras of the studies that draw: orbits around data, and the rays of their pixels in float64."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    import pyvista as pv

SLANT = math.tan(math.radians(45.0 / 2))  # 45 degrees; this and the distances follow Russig et al. 2020, section 4
VIEWS = {"far": 1.0, "close": 1.0 / 3.0}
ELEVATION = 15.0  # degrees above the plane of the orbit

Array = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Camera:
    """A camera that looks at a place: what VTK, bare OpenGL and rays in float64 need to show the same picture."""

    size: tuple[int, int]
    eye: Array  # (3,) mm
    centre: Array
    # mm from the eye's plane
    near: float
    far: float
    slant: float = SLANT  # Tangent of half the angle from top to bottom

    @property
    def pixels(self) -> float:
        """Pixels of 1 mm at a distance of 1 mm."""
        return 0.5 * self.size[1] / self.slant

    @property
    def backwards(self) -> Array:
        """Unit vector from the centre to the eye."""
        return unit(self.eye - self.centre)

    @property
    def axes(self) -> Array:
        """(3, 3): rows to the right, up, backwards."""
        right = unit(np.cross([0.0, 0.0, 1.0], self.backwards))
        return np.array([right, np.cross(self.backwards, right), self.backwards])

    @property
    def world_to_camera(self) -> Array:
        """(4, 4): x to the right, y up, z towards the viewer, the eye at 0."""
        matrix = np.eye(4)
        matrix[:3, :3] = self.axes
        matrix[:3, 3] = -self.axes @ self.eye
        return matrix

    @property
    def camera_to_clip(self) -> Array:
        """(4, 4) to OpenGL clip coordinates."""
        projection = np.zeros((4, 4))
        projection[0, 0], projection[1, 1] = self.size[1] / self.size[0] / self.slant, 1.0 / self.slant
        depth = self.far - self.near
        projection[2, 2:] = -(self.far + self.near) / depth, -2.0 * self.far * self.near / depth
        projection[3, 2] = -1.0
        return projection

    @property
    def model_view_projection(self) -> Array:
        """(4, 4) data coordinates to OpenGL clip coordinates."""
        return self.camera_to_clip @ self.world_to_camera

    def aim(self, plotter: pv.BasePlotter) -> None:
        """Make a plotter look through this camera."""
        camera = plotter.camera
        camera.position, camera.focal_point, camera.up = self.eye, self.centre, (0.0, 0.0, 1.0)
        camera.view_angle = math.degrees(2.0 * math.atan(self.slant))
        camera.clipping_range = self.near, self.far

    def project(self, points: Array) -> Array:
        """Return (n, 3): tangents to the right and up, and distance in front of the eye."""
        local = (points - self.eye) @ self.axes.T
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.column_stack([local[:, :2] / -local[:, 2:], -local[:, 2]])

    def rays(self, pixels: npt.NDArray[np.int64]) -> tuple[Array, Array]:
        """Return unit directions (n, 3) of pixels, numbered row by row from below, and mm forwards by mm of ray."""
        width, height = self.size
        x, y = pixels % width + 0.5, pixels // width + 0.5
        local = np.stack([(x - width / 2) / self.pixels, (y - height / 2) / self.pixels, -np.ones(len(pixels))], axis=1)
        forwards = 1.0 / np.linalg.norm(local, axis=1)
        return unit(local @ self.axes), forwards

    def depth(self, w: Array) -> Array:
        """Return window depth, 0 to 1, at w in front of the eye."""
        return self.far / (self.far - self.near) * (1.0 - self.near / w)

    def distance(self, reversed_depth: Array) -> Array:
        """Return the mm in front of the eye of 1 less a window depth."""
        return self.far * self.near / (reversed_depth * (self.far - self.near) + self.near)


def orbit(tubes: Any, view: str, frames: int, size: tuple[int, int]) -> list[Camera]:
    """Return cameras all around a set: *far*, where all of it fits into the picture, or *close*, at a third of that."""
    centre = np.array(tubes.bounds).reshape(3, 2).mean(axis=1)
    radius = float((np.linalg.norm(tubes.points - centre, axis=1) + tubes.radius).max())
    distance = VIEWS[view] * fitting(radius, size)
    near, far = max(distance - 1.02 * radius, 2e-3 * radius), distance + 1.02 * radius
    return circling(centre, distance, 2.0 * np.pi * np.arange(frames) / frames + 0.3, size, near, far)


def fitting(radius: float, size: tuple[int, int]) -> float:
    """Return the distance from which a ball just fits into a picture."""
    return radius / math.sin(math.atan(min(1.0, size[0] / size[1]) * SLANT))


def circling(
    centre: Array, distance: float, turns: Array, size: tuple[int, int], near: float, far: float
) -> list[Camera]:
    """Return cameras at one distance from a place, by turns in radians."""
    flat, up = math.cos(math.radians(ELEVATION)), math.sin(math.radians(ELEVATION))
    ways = np.stack([flat * np.cos(turns), flat * np.sin(turns), np.full(len(turns), up)], axis=1)
    return [Camera((size[0], size[1]), centre + distance * way, centre, near, far) for way in ways]


def by_turns(draw: Callable[[Camera], object], cameras: Sequence[Camera]) -> Callable[[], None]:
    """Return what draws all cameras, each a little other than the time before: renderers draw nothing twice."""
    wider = [replace(camera, far=camera.far * (1.0 + 1e-7)) for camera in cameras]
    turn = itertools.cycle([wider, cameras])

    def drawn() -> None:
        for camera in next(turn):
            draw(camera)

    return drawn


def unit(vectors: Array) -> Array:
    """Return vectors, (..., 3), at length 1."""
    found: Array = vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)
    return found
