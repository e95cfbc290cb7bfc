"""The camera of a scene, and pictures of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets.plotting.viewpoints import DIRECTIONS, point_camera
from pvfiblets.web.values import mapping, number, numbers, shown, truth

if TYPE_CHECKING:
    from pvfiblets.web.scene.scene import Scene

VIEWS = tuple(DIRECTIONS)  # names of the directions that one can look from

_LETTERS = (("R", "L"), ("A", "P"), ("S", "I"))
NEAR = 6.0  # pixels of tolerance of a click
LARGEST_PICTURE = 64_000_000  # pixels


class Cameras:
    """The camera of a scene, which is no part of the undo history, and pictures of it."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        self._fit: Callable[[], Any] = lambda: None  # shows everything, as it was last asked for
        self._fitted: dict[str, Any] | None = None  # the camera that it made

    def view(self, name: str) -> None:
        """Look at everything from one of the directions `VIEWS`; the coronal one is seen from the front."""
        if name not in VIEWS:
            raise ValueError(f"view is {shown(name)}; choose one of {', '.join(VIEWS)}")
        self._show_all(lambda: point_camera(self.scene.plotter, name))

    def refit(self) -> bool:
        """Fit the view to another shape of its place, unless the camera was moved since; return whether it was not."""
        fits = self._fitted is not None and self._fitted == self.camera()
        if fits:
            self._show_all(self._fit)
        return fits

    def reset(self) -> None:
        """Move the camera until everything is in the picture, without turning it."""
        self._show_all(lambda: self.scene.plotter.renderer.reset_camera(render=False))  # the plotter's own renders

    def _show_all(self, fit: Callable[[], Any]) -> None:
        fit()
        self._fit, self._fitted = fit, self.camera()

    @property
    def parallel(self) -> bool:
        """Whether lines of sight are parallel, so that sizes can be compared."""
        return bool(self.scene.plotter.camera.parallel_projection)

    @parallel.setter
    def parallel(self, parallel: bool) -> None:
        self.scene.plotter.camera.parallel_projection = truth(parallel, "parallel")

    def camera(self) -> dict[str, Any]:
        """Return where the camera is, in JSON's types."""
        camera = self.scene.plotter.camera
        return {
            "position": [float(part) for part in camera.position],
            "focal_point": [float(part) for part in camera.focal_point],
            "up": [float(part) for part in camera.up],
            "view_angle": float(camera.view_angle),
            "parallel": bool(camera.parallel_projection),
            "parallel_scale": float(camera.parallel_scale),
        }

    def set_camera(self, camera: Mapping[str, Any]) -> None:
        """Put the camera where :meth:`camera` said it was; ValueError if that is no place."""
        wanted = check_camera(camera)
        ours = self.scene.plotter.camera
        ours.position, ours.focal_point, ours.up = wanted["position"], wanted["focal_point"], wanted["up"]
        ours.view_angle = wanted["view_angle"]
        ours.parallel_projection, ours.parallel_scale = wanted["parallel"], wanted["parallel_scale"]
        self.scene.plotter.camera_set = True
        self.scene.plotter.renderer.reset_camera_clipping_range()

    def edges(self) -> dict[str, str]:
        """Return which way the picture's edges lie: R, L, A, P, S, I; of oblique views the one or two nearest."""
        camera = self.scene.plotter.camera
        ahead = np.subtract(camera.focal_point, camera.position)
        right = np.cross(ahead, camera.up)
        up = np.cross(right, ahead)
        return {
            "left": _letters(-right), "right": _letters(right), "top": _letters(up), "bottom": _letters(-up),
        }  # fmt: skip

    def place_at(self, x: float, y: float, *, tolerance: float = 0.0) -> list[float] | None:
        """Return where the surface or line is that a pixel of the last picture shows."""
        width, height = self.scene.plotter.window_size
        column = round(number(x, "x", 0, width - 1))
        row = round(number(y, "y", 0, height - 1))
        reach = int(number(tolerance, "tolerance", 0.0, 64.0))
        left, right = max(column - reach, 0), min(column + reach, width - 1)
        below, above = max(row - reach, 0), min(row + reach, height - 1)
        renderer = self.scene.plotter.renderer
        depths = _depths(self.scene.plotter.render_window, left, below, right, above)
        rows, columns = np.nonzero(depths < 1.0)
        if not rows.size:
            return None
        nearest = int(np.argmin(np.hypot(columns + left - column, rows + below - row)))
        depth = float(depths[rows[nearest], columns[nearest]])
        column, row = int(columns[nearest]) + left, int(rows[nearest]) + below
        renderer.SetDisplayPoint(column + 0.5, row + 0.5, depth)
        renderer.DisplayToWorld()
        *place, w = renderer.GetWorldPoint()
        return [float(part / w) for part in place]

    def screenshot(self, path: str | Path | None = None, *, scale: int = 1, transparent: bool = False) -> np.ndarray:
        """Return a picture."""
        times = int(number(scale, "scale", 1, 8))
        width, height = self.scene.plotter.window_size
        if width * height * times * times > LARGEST_PICTURE:
            raise ValueError(f"a picture of {width * times} x {height * times} is too large; give a smaller scale")
        target = None if path is None else self.scene.files.resolve(path, new=True)
        self.scene.plotter.render()  # or it would be the last picture, whatever has changed since
        picture = self.scene.plotter.screenshot(
            target, return_img=True, scale=times, transparent_background=truth(transparent, "transparent")
        )
        return np.asarray(picture)


def _depths(window: Any, left: int, below: int, right: int, above: int) -> np.ndarray:
    """Return the depths of a rectangle of the last picture, ``(rows from below, columns)``; 1 is empty."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkFloatArray

    found = vtkFloatArray()
    window.GetZbufferData(left, below, right, above, found)
    return np.asarray(vtk_to_numpy(found)).reshape(above - below + 1, right - left + 1)


def check_camera(value: Any) -> dict[str, Any]:
    """Return where a camera is, checked."""
    mapping(value, "camera", ("position", "focal_point", "up", "view_angle", "parallel", "parallel_scale"))
    found: dict[str, Any] = {
        key: numbers(value[key], f"camera's {key}", 3) for key in ("position", "focal_point", "up")
    }
    if any(abs(part) > 1e12 for key in found for part in found[key]):
        raise ValueError("the camera is more than 1e12 mm away; give a position nearer to the scene")
    ahead = np.subtract(found["focal_point"], found["position"])
    if not np.linalg.norm(np.cross(ahead, found["up"])) > 0.0:
        raise ValueError(f"the camera looks along {ahead.tolist()} and has {found['up']} up; give unlike directions")
    found["view_angle"] = number(value["view_angle"], "camera's view_angle", 1e-3, 179.0)
    found["parallel"] = truth(value["parallel"], "camera's parallel")
    found["parallel_scale"] = number(value["parallel_scale"], "camera's parallel_scale", 1e-12, 1e12)
    return found


def _letters(direction: np.ndarray) -> str:
    """Name a direction by its largest parts, down to half the largest."""
    length = np.linalg.norm(direction)
    if not length > 0.0:
        return ""
    unit = direction / length
    order = np.argsort(-np.abs(unit), kind="stable")
    return "".join(
        _LETTERS[axis][0 if unit[axis] > 0.0 else 1] for axis in order if abs(unit[axis]) >= 0.5 * abs(unit[order[0]])
    )
