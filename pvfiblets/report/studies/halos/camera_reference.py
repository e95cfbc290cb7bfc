"""What the float64 reference of halos knows of a camera, and the fragments that it finds.

In clip coordinates ``(X, Y, Z, W)`` a length of 1 mm beside a point takes ``k = s / W`` pixels of the picture, ``s``
the mean over its width and height of half of it times the length of the matrix's row, less what of that row is along
the view axis.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from pvfiblets.halos.style import HaloStyle

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]


class Camera:
    """A matrix, and how wide and how deep things are under it; depth cueing goes by the bounds of the data.

    ``scale`` is ``s``: pixels times W of 1 mm.
    """

    def __init__(self, matrix: Array, size: tuple[int, int], bounds: tuple[float, ...], look: HaloStyle) -> None:
        self.matrix, self.size, self._look = matrix, size, look
        x, y, z, w = matrix[:, :3]
        self._perspective = bool(w.any())
        toward = w if self._perspective else z
        length = np.linalg.norm(toward)
        self._axis = np.append(toward, matrix[3 if self._perspective else 2, 3]) / (length or 1.0)
        unit = self._axis[:3]
        rows = (row - (row @ unit) * unit for row in (x, y))
        self.scale = float(np.mean([n / 2.0 * np.linalg.norm(row) for n, row in zip(size, rows, strict=True)]))
        self._rates = float(z @ unit), float(w @ unit)
        corners = np.array(np.meshgrid(*np.reshape(bounds, (3, 2)))).reshape(3, -1).T
        along = corners @ unit + self._axis[3]
        self._first, self._last = along.min(), along.max()
        if self._perspective:
            self._first = max(self._first, 0.0)

    def clip(self, points: Array) -> Array:
        """``(n, 4)`` clip coordinates of places."""
        return points @ self.matrix[:, :3].T + self.matrix[:, 3]

    def pixels(self, clip: Array) -> Array:
        """Return clip coordinates in pixels of the window."""
        return (clip[..., :2] / clip[..., 3:] + 1.0) / 2.0 * self.size

    def motion(self, clip: Array, way: Array) -> Array:
        """Pixels that a place of the window moves per length of a way in clip coordinates, behind the eye too."""
        w = clip[..., 3:]
        return (way[..., :2] * w - clip[..., :2] * way[..., 3:]) / w**2 * self.size / 2.0

    def depth(self, clip: Array, behind: Array | float = 0.0) -> Array:
        """Window depth some mm behind a place."""
        z, w = clip[..., 2] + behind * self._rates[0], clip[..., 3] + behind * self._rates[1]
        return np.clip((z / w + 1.0) / 2.0, 0.0, 1.0)

    def cue(self, points: Array) -> Array:
        """Share of their width that depth cueing leaves lines at places in mm."""
        span = self._last - self._first
        if not span > 0.0:
            return np.ones(points.shape[:-1])
        along = points @ self._axis[:3] + self._axis[3]
        return 1.0 - self._look.width_cue * np.clip((along - self._first) / span, 0.0, 1.0)

    def widths(self, w: Array, cue: Array) -> tuple[Array, Array]:
        """Half widths of line and strip, pixels."""
        look, k = self._look, self.scale / w
        own = cue * look.line_width / 2.0 * k
        line = np.maximum(own, look.min_width / 2.0)
        return line, look.strip_width / 2.0 * k + line - own


def between(ends: Array, t: Array | float) -> Array:
    """Linear between two numbers, or rows."""
    t = np.asarray(t).reshape(np.shape(t) + (1,) * (ends.ndim - 1))
    return (1.0 - t) * ends[0] + t * ends[1]


def kept(a: Array, b: Array) -> tuple[float, float]:
    """Return the part of a segment on the kept side of everything, by the heights of its ends; 1, 0 for nowhere."""
    if (np.minimum(a, b) >= 0.0).all():
        return 0.0, 1.0
    if (np.maximum(a, b) < 0.0).any():
        return 1.0, 0.0
    with np.errstate(divide="ignore", invalid="ignore"):
        at = a / (a - b)
    return float(np.where(a < 0.0, at, 0.0).max()), float(np.where(b < 0.0, at, 1.0).min())


def box(camera: Camera, corners: Array, reach: float) -> tuple[Ints, Array]:
    """Numbers and centres of the pixels that are no farther from the corners' box."""
    low = np.maximum(np.floor(corners.min(axis=0) - reach), 0.0)
    high = np.minimum(np.ceil(corners.max(axis=0) + reach), camera.size)
    if not (low < high).all():
        return np.zeros(0, np.int64), np.zeros((0, 2))
    y, x = np.mgrid[int(low[1]) : int(high[1]), int(low[0]) : int(high[0])]
    return (y * camera.size[0] + x).ravel(), np.stack([x, y], axis=-1).reshape(-1, 2) + 0.5


@dataclass(frozen=True, eq=False)
class Fragments:
    """Fragments of one segment or point, and pixels about it that it misses; arrays of one length.

    Lengths are pixels, to first order.
    """

    pixel: Ints
    owner: Ints
    t: Array  # 0..1, of the foot on the segment
    foot: Array  # (n, 4) clip coordinates of the nearest place of the axis
    r: Array  # distance from the foot over half the strip's width
    inside: Array  # from where the strip ends; negative beyond
    at_start: Array  # the same but for the bisector at its start, if that is close by; else negative
    at_end: Array  # and at its end
    inked: Array  # across the axis, from where the line turns into halo; positive within the line
    edge: Array  # from there any way
