"""Two-finger gestures on the camera, or on a slice: zoom as the fingers part, and move with them.

VTK's trackball style knows no gestures, and its style for several fingers does not move the scene. Pages report which
gesture they take a touch for; fingers seldom do one thing only, so zoom and shift are always taken from where the
fingers are, and only a turn must have been meant.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

if TYPE_CHECKING:
    import pyvista as pv


GESTURES = ("Pinch", "Pan", "Rotate")
LEAST = 8.0  # pixels between fingers: nearer ones have neither a sure distance nor a sure direction
MOST = 8.0  # times that one event may zoom


class _Pair(NamedTuple):
    """Two fingers: the middle between them, pixels from the lower left, their distance and their direction."""

    x: float
    y: float
    distance: float
    angle: float  # degrees


class Fingers:
    """Two fingers that steer a plotter's camera."""

    def __init__(self, plotter: pv.BasePlotter, pane_at: Callable[[float, float], Any] = lambda _x, _y: None) -> None:
        self._plotter = plotter
        self._pane_at = pane_at  # from a pixel to the pane of slices that it is in; None for the plotter's camera
        self._pane: Any = None
        self._last: _Pair | None = None

    def take(self, event: Mapping[str, Any]) -> bool:
        """Follow an event of the pointer, in the picture's pixels; ``False`` if it is none of two fingers."""
        kind = str(event["type"])
        gesture = kind.removeprefix("Start").removeprefix("End")
        if gesture not in GESTURES:
            return False
        pair = _pair(event.get("positions") or {})
        if self._last is None and pair is not None:
            self._pane = self._pane_at(pair.x, pair.y)
        if kind == gesture and pair is not None and self._last is not None:
            self._follow(self._last, pair, turn=gesture == "Rotate")
        self._last = None if kind.startswith("End") else pair
        return True

    def resize(self, times: float) -> None:
        """Take the picture to have so many times the pixels along each side from now on."""
        if self._last is not None:
            x, y, distance, angle = self._last
            self._last = _Pair(x * times, y * times, distance * times, angle)

    def _follow(self, before: _Pair, now: _Pair, *, turn: bool) -> None:
        if self._pane is not None:
            _follow_in(self._pane, before, now)
            return
        camera = self._plotter.camera
        if min(before.distance, now.distance) >= LEAST:
            _zoom(camera, min(max(now.distance / before.distance, 1.0 / MOST), MOST))
            if turn:
                camera.Roll((now.angle - before.angle + 180.0) % 360.0 - 180.0)
        _shift(camera, now.x - before.x, now.y - before.y, self._plotter.window_size[1])
        self._plotter.renderer.reset_camera_clipping_range()


def _pair(positions: Mapping[str, Mapping[str, float]]) -> _Pair | None:
    if len(positions) != 2:
        return None
    (x0, y0), (x1, y1) = (
        (float(positions[finger].get("x", 0.0)), float(positions[finger].get("y", 0.0))) for finger in sorted(positions)
    )
    across, up = x1 - x0, y1 - y0
    return _Pair((x0 + x1) / 2, (y0 + y1) / 2, math.hypot(across, up), math.degrees(math.atan2(up, across)))


def _follow_in(pane: Any, before: _Pair, now: _Pair) -> None:
    """Zoom and move a slice so that the point between the fingers stays there."""
    place = pane.position_at(before.x, before.y)
    if min(before.distance, now.distance) >= LEAST:
        pane.zoom *= min(max(now.distance / before.distance, 1.0 / MOST), MOST)
    x, y = pane.pixel_of(place)
    pane.pan_by(now.x - x, now.y - y)


def _zoom(camera: pv.Camera, times: float) -> None:
    if camera.parallel_projection:
        camera.parallel_scale /= times
    else:
        camera.Dolly(times)


def _shift(camera: pv.Camera, across: float, up: float, height: int) -> None:
    """Move the camera so that the focal plane follows the fingers."""
    ahead = np.subtract(camera.focal_point, camera.position)
    distance = float(np.linalg.norm(ahead))
    half = math.tan(math.radians(camera.view_angle) / 2.0) * distance
    per_pixel = 2.0 * (camera.parallel_scale if camera.parallel_projection else half) / max(height, 1)
    right = np.cross(ahead, camera.up)
    above = np.cross(right, ahead)
    move = -per_pixel * (across * right / np.linalg.norm(right) + up * above / np.linalg.norm(above))
    camera.position = tuple(np.add(camera.position, move))
    camera.focal_point = tuple(np.add(camera.focal_point, move))
