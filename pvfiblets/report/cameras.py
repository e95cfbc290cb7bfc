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

VERTICAL_ANGLE = 45.0  # degrees; this and the distances follow Russig et al. 2020, section 4
VIEWS = {"far": 1.0, "close": 1.0 / 3.0}
ELEVATION = 15.0  # degrees above the plane of the orbit

Array = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Camera:
    """A camera that looks at a place: what VTK and bare OpenGL need to show the same picture."""

    size: tuple[int, int]
    eye: Array
    centre: Array
    near: float
    far: float

    @property
    def pixels(self) -> float:
        """Pixels of 1 mm at a distance of 1 mm."""
        return 0.5 * self.size[1] / math.tan(math.radians(VERTICAL_ANGLE / 2))

    @property
    def backwards(self) -> Array:
        """Unit vector from the centre to the eye."""
        away = self.eye - self.centre
        return away / np.linalg.norm(away)

    @property
    def world_to_camera(self) -> Array:
        """(4, 4): x to the right, y up, z towards the viewer, the eye at 0."""
        return Lens.from_camera(self).world_to_camera

    @property
    def model_view_projection(self) -> Array:
        """(4, 4) data coordinates to OpenGL clip coordinates."""
        return Lens.from_camera(self).model_view_projection

    def aim(self, plotter: pv.BasePlotter) -> None:
        """Make a plotter look through this camera."""
        camera = plotter.camera
        camera.position, camera.focal_point, camera.up = self.eye, self.centre, (0.0, 0.0, 1.0)
        camera.view_angle = VERTICAL_ANGLE
        camera.clipping_range = self.near, self.far


def orbit(tubes: Any, view: str, frames: int, size: tuple[int, int]) -> list[Camera]:
    """Return cameras all around a set: *far*, where all of it fits into the picture, or *close*, at a third of that."""
    box = np.array(tubes.bounds).reshape(3, 2)
    centre = box.mean(axis=1)
    radius = float((np.linalg.norm(tubes.points - centre, axis=1) + tubes.radius).max())
    narrow = min(1.0, size[0] / size[1]) * math.tan(math.radians(VERTICAL_ANGLE / 2))
    distance = VIEWS[view] * radius / math.sin(math.atan(narrow))
    near, far = max(distance - 1.02 * radius, 2e-3 * radius), distance + 1.02 * radius
    up = math.radians(ELEVATION)
    cameras = []
    for turn in 2.0 * np.pi * np.arange(frames) / frames + 0.3:
        direction = np.array([math.cos(up) * math.cos(turn), math.cos(up) * math.sin(turn), math.sin(up)])
        cameras.append(Camera((size[0], size[1]), centre + distance * direction, centre, near, far))
    return cameras


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


@dataclass(frozen=True, eq=False)
class Lens:
    """A camera of any angle, and its pixels' rays in float64."""

    size: tuple[int, int]
    eye: Array  # (3,) mm
    backwards: Array  # (3,) unit vector from the target to the eye; not upright
    slant: float  # Tangent of half the angle from top to bottom
    # mm from the eye's plane
    near: float
    far: float

    @classmethod
    def from_camera(cls, camera: Camera) -> Lens:
        """Return the lens of an orbit's camera."""
        slant = float(np.tan(np.radians(VERTICAL_ANGLE / 2)))
        return cls(camera.size, camera.eye, camera.backwards, slant, camera.near, camera.far)

    @property
    def axes(self) -> Array:
        """(3, 3): rows to the right, up, backwards."""
        right = unit(np.cross([0.0, 0.0, 1.0], self.backwards))
        return np.array([right, np.cross(self.backwards, right), self.backwards])

    @property
    def pixel(self) -> float:
        """Size of a pixel at 1 mm from the eye, mm."""
        return 2.0 * self.slant / self.size[1]

    @property
    def world_to_camera(self) -> Array:
        """(4, 4): x to the right, y up, z towards the viewer, the eye at 0."""
        matrix = np.eye(4)
        matrix[:3, :3] = self.axes
        matrix[:3, 3] = -self.axes @ self.eye
        return matrix

    @property
    def model_view_projection(self) -> Array:
        """(4, 4) data coordinates to OpenGL clip coordinates."""
        projection = np.zeros((4, 4))
        projection[0, 0], projection[1, 1] = self.size[1] / self.size[0] / self.slant, 1.0 / self.slant
        depth = self.far - self.near
        projection[2, 2:] = -(self.far + self.near) / depth, -2.0 * self.far * self.near / depth
        projection[3, 2] = -1.0
        return projection @ self.world_to_camera

    def project(self, points: Array) -> Array:
        """Return (n, 3): tangents to the right and up, and distance in front of the eye."""
        local = (points - self.eye) @ self.axes.T
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.column_stack([local[:, :2] / -local[:, 2:], -local[:, 2]])

    def rays(self, pixels: npt.NDArray[np.int64]) -> tuple[Array, Array]:
        """Return unit directions (n, 3) of pixels, numbered row by row from below, and mm forwards by mm of ray."""
        width, height = self.size
        x, y = pixels % width + 0.5, pixels // width + 0.5
        local = np.stack([self.pixel * (x - width / 2), self.pixel * (y - height / 2), -np.ones(len(pixels))], axis=1)
        forwards = 1.0 / np.linalg.norm(local, axis=1)
        return unit(local @ self.axes), forwards

    def depth(self, w: Array) -> Array:
        """Return window depth, 0 to 1, at w in front of the eye."""
        return self.far / (self.far - self.near) * (1.0 - self.near / w)

    def distance(self, reversed_depth: Array) -> Array:
        """Return the mm in front of the eye of 1 less a window depth."""
        return self.far * self.near / (reversed_depth * (self.far - self.near) + self.near)
