"""Volumes whose pictures are known in closed form: planes, balls, Gaussians, layers and blocks, and cameras on them.

Each field is a function of space, in mm. Its volume samples it at the voxel centres; how well a filter brings the field
back is said with each. Answers along rays are `(...)` as the rays are, NaN where there is none.

Numbers are kept such that float32 holds the samples exactly: coordinates are multiples of an eighth of a mm.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from pvfiblets.volumes.transfer import Transfer
from pvfiblets.volumes.volume import RaycastVolume

from .profiles import Profile

GRIDS = {
    "even": np.eye(4),
    "flat voxels": np.array([[0.5, 0, 0, 2], [0, -1, 0, 3], [0, 0, 1.5, -4], [0, 0, 0, 1.0]]),
    "oblique": np.array([[1, 0.25, 0, 0], [-0.25, 1, 0.125, 1], [0, -0.125, 1.25, 0], [0, 0, 0, 1.0]]),
}
"""Affines of volumes."""


def camera(eye, target=(0, 0, 0), *, size=(32, 24), angle=40.0, height=None, near=1.0, far=200.0, up=(0.1, 0.2, 1.0)):
    """Matrix of a camera, as OpenGL has it: perspective of an angle in degrees, or parallel of a height in mm."""
    eye, target = np.array(eye, float), np.array(target, float)
    back = (eye - target) / np.linalg.norm(eye - target)
    right = np.cross(up, back)
    right /= np.linalg.norm(right)
    view = np.eye(4)
    view[:3, :3] = right, np.cross(back, right), back
    view[:3, 3] = -view[:3, :3] @ eye
    ratio, depth = size[0] / size[1], far - near
    if height is not None:
        frustum = np.diag([2 / (height * ratio), 2 / height, -2 / depth, 1.0])
        frustum[2, 3] = -(far + near) / depth
    else:
        focal = 1 / math.tan(math.radians(angle) / 2)
        frustum = np.diag([focal / ratio, focal, -(far + near) / depth, 0.0])
        frustum[2, 3], frustum[3, 2] = -2 * far * near / depth, -1.0
    return frustum @ view


def centres(shape, affine):
    """``(nx, ny, nz, 3)`` mm of voxel centres."""
    index = np.stack(np.meshgrid(*map(np.arange, shape), indexing="ij"), axis=-1)
    return index @ affine[:3, :3].T + affine[:3, 3]


def middle(shape, affine):
    """mm of the middle of a grid, to an eighth."""
    return np.round(8 * (affine[:3, :3] @ (np.array(shape) - 1) / 2 + affine[:3, 3])) / 8


def within(t, rays):
    """Places that are on the rays."""
    with np.errstate(invalid="ignore"):
        return np.where((t > rays.near) & (t < rays.far), t, np.nan)


class Field:
    """A function of space."""

    def at(self, points):
        raise NotImplementedError

    def volume(self, shape, affine=None, dtype=np.float32):
        affine = np.eye(4) if affine is None else affine
        return RaycastVolume(self.at(centres(shape, affine)).astype(dtype), affine)


@dataclass
class Plane(Field):
    """``normal . p + offset``: what trilinear filters are exact for, and tricubic ones but in the outermost cells."""

    normal: tuple
    offset: float = 0.0

    def at(self, points):
        return points @ np.array(self.normal, float) + self.offset

    def gradient(self, points):
        return np.broadcast_to(np.array(self.normal, float), np.shape(points))

    def crossing(self, rays, value=0.0):
        return within((value - self.at(rays.origins)) / (rays.directions @ self.normal), rays)


@dataclass
class Ball(Field):
    """``radius^2 - |p - centre|^2``, 0 on the sphere: what tricubic filters are exact for but in the outermost cells.

    Trilinear ones come short of it by up to ``sum spacing^2 / 4``.
    """

    centre: tuple
    radius: float

    def at(self, points):
        return self.radius**2 - ((points - np.array(self.centre, float)) ** 2).sum(-1)

    def gradient(self, points):
        return -2.0 * (points - np.array(self.centre, float))

    def _nearest(self, rays):
        """t of where rays are nearest to the centre, and how far it then is."""
        to = np.array(self.centre, float) - rays.origins
        t = (to * rays.directions).sum(-1)
        return t, np.linalg.norm(to - t[..., None] * rays.directions, axis=-1)

    def crossings(self, rays, value=0.0):
        """Both, or NaN."""
        t, away = self._nearest(rays)
        with np.errstate(invalid="ignore"):
            half = np.sqrt(self.radius**2 - value - away**2)
        return within(t - half, rays), within(t + half, rays)

    def crossing(self, rays, value=0.0):
        first, second = self.crossings(rays, value)
        return np.where(np.isnan(first), second, first)

    def chord(self, rays, value=0.0):
        """From the first crossing to the second, or to where the ray ends."""
        first, second = self.crossings(rays, value)
        end = np.where(np.isnan(second), rays.far, second)
        return np.where(np.isnan(first), rays.far - second, end - first)

    def greatest(self, rays):
        """t and the greatest value."""
        t = np.clip(self._nearest(rays)[0], rays.near, rays.far)
        return t, self.at(rays.points(t))


@dataclass
class Gaussian(Ball):
    """``exp(-|p - centre|^2 / (2 radius^2))``, for which all filters are of their order."""

    def at(self, points):
        return np.exp(-((points - np.array(self.centre, float)) ** 2).sum(-1) / (2 * self.radius**2))

    def gradient(self, points):
        return -(points - np.array(self.centre, float)) / self.radius**2 * self.at(points)[..., None]

    def crossings(self, rays, value=0.5):
        return Ball(self.centre, self.radius * math.sqrt(-2 * math.log(value))).crossings(rays)

    def transfer(self, alpha, colour, unit=1.0):
        """Opacity is `alpha` times the field."""
        return Transfer([[*colour, 0.0], [*colour, alpha]], (0.0, 1.0), unit)

    def light(self, rays, transfer):
        """RGBA of that transfer function: of ``-ln(1 - alpha x)`` each power of x is a Gaussian again."""
        t, away = self._nearest(rays)
        colour, alpha = transfer.table[1, :3].astype(float), float(transfer.table[1, 3])
        erf, depth = np.vectorize(math.erf), np.zeros(t.shape)
        for n in range(1, 400):
            width = self.radius / math.sqrt(n)
            part = erf((rays.far - t) / (width * math.sqrt(2))) - erf((rays.near - t) / (width * math.sqrt(2)))
            depth += alpha**n / n * np.exp(-((away / width) ** 2) / 2) * width * math.sqrt(math.pi / 2) * part
        opacity = np.nan_to_num(-np.expm1(-depth / transfer.unit))
        return np.concatenate([opacity[..., None] * colour, opacity[..., None]], axis=-1)


@dataclass
class Layers(Field):
    """Values at whole mm along the third axis: constant from half to half by the nearest voxel, else a polyline."""

    values: tuple

    def volume(self, shape=(9, 9), affine=None, dtype=np.float32):
        values = np.broadcast_to(np.array(self.values), (*shape[:2], len(self.values)))
        return RaycastVolume(values.astype(dtype), affine)

    def light(self, rays, transfer, how="trilinear"):
        """RGBA; for polylines of those profiles that have a closed form."""
        found = np.zeros((*rays.near.shape, 4))
        for index in np.argwhere(rays.near < rays.far):
            ray = rays[tuple(index)]
            steep = abs(float(ray.directions[2]))
            ends = np.sort(ray.points([ray.near])[0, 2:].tolist() + ray.points([ray.far])[0, 2:].tolist())
            values = np.array(self.values, float)
            last = len(values) - 1
            if ray.directions[2] < 0:
                values, ends = values[::-1], last - ends[::-1]
            if how == "nearest":
                found[tuple(index)] = self._steps(values, ends, steep, transfer)
            else:
                slower = Transfer(transfer.table, transfer.clim, transfer.unit * steep)
                found[tuple(index)] = Profile("layers", values, last, slower).light(*ends)
        return found

    def _steps(self, values, ends, steep, transfer):
        breaks = np.unique(np.clip(np.append(np.arange(len(values)) + 0.5, ends), *ends))
        rgb, through = np.zeros(3), 1.0
        for a, b in pairwise(breaks):
            *colour, alpha = transfer.lookup(values[int((a + b) / 2 + 0.5)])
            passed = (1 - alpha) ** ((b - a) / steep / transfer.unit)
            rgb, through = rgb + through * (1 - passed) * np.array(colour), through * passed
        return np.append(rgb, 1 - through)
