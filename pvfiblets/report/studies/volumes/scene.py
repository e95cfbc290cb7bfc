"""Scenes of the studies of ray-cast volumes: transfer functions, cameras, and the right values.

Everything that shows a volume here shows the same: light by one transfer function, greatest values in grey, one surface
in white that a lamp at the eye lights, on black. The right values are computed ray by ray in float64, without steps
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from pvfiblets.volumes import RaycastVolume, Transfer
from pvfiblets.volumes.raycast_options import RaycastOptions

from ...cameras import Camera, circling, fitting
from . import reference

GOLDEN = 360.0 * (1.0 - 2.0 / (1.0 + math.sqrt(5.0)))  # degrees: however few frames are drawn, they lie all around
NEARER = 0.65  # of the distance from which all of the box is seen however it is turned
TOLERANCE = 1e-5  # of the reference's light
UNIT = 1.0  # mm that opacities are for
ENTRIES = 256

Array = npt.NDArray[np.float64]
Pixels = npt.NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Look:
    """What is shown of a volume."""

    mode: str
    clim: tuple[float, float]  # Values of the first and the last colour
    transfer: Transfer  # Of light; its colours are multiples of 1/255, so that tables of bytes hold them
    value: float  # Of the surface

    def casting(self, **more: Any) -> RaycastOptions:
        """Return how the engine casts it."""
        if self.mode == "composite":
            more["transfer"] = self.transfer
        if self.mode == "isosurface":
            more["values"] = (self.value,)
        return RaycastOptions(self.mode, **more)


def look_of(volume: RaycastVolume, mode: str) -> Look:
    """Return the appearance of a volume: dim voxels are transparent, bright ones opaque within some mm."""
    low, high = volume.value_range
    x = np.linspace(0.0, 1.0, ENTRIES)
    table = np.zeros((ENTRIES, 4))
    table[:, :3] = np.round(255.0 * np.stack([x**0.6, x**1.1, x**2.0], axis=1)) / 255.0
    table[:, 3] = 0.5 * np.clip((x - 0.1) / 0.9, 0.0, 1.0)
    return Look(mode, (low, high), Transfer(table.astype(np.float32), (low, high), UNIT), low + 0.35 * (high - low))


def circle(volume: RaycastVolume, frames: int, size: tuple[int, int]) -> list[Camera]:
    """Return cameras all around a volume; successive ones lie far apart, so that any few are fair."""
    # A face of the volume's box fills three quarters of the picture; its corners may lie outside.
    box = np.array(volume.bounds).reshape(3, 2)
    centre, radius = box.mean(axis=1), 0.5 * float(np.linalg.norm(np.ptp(box, axis=1)))
    distance = NEARER * fitting(radius, size)
    turns = np.radians(20.0 + GOLDEN * np.arange(frames))
    return circling(centre, distance, turns, size, distance - 1.02 * radius, distance + 1.02 * radius)


@dataclass(frozen=True, eq=False)
class Truth:
    """What some pixels of pictures should show."""

    cameras: list[Camera]
    pixels: list[Pixels]  # For each camera, `(n, 2)` rows and columns, row 0 at the bottom
    # For each camera, `(2, n, 3)` RGB on black: with a lamp that shines along the camera's direction, as VTK has it
    # for meshes, and with one that shines from the eye along each ray, as VTK has it for volumes; the same but for
    # surfaces
    colours: list[Array]

    def error(self, pictures: list[Array], lamp: int = 0) -> float:
        """Return the root mean square difference of pictures, ``(height, width, 3)`` from 0 to 1, from this."""
        off = [
            picture[pixels[:, 0], pixels[:, 1]] - colours[lamp]
            for picture, pixels, colours in zip(pictures, self.pixels, self.colours, strict=True)
        ]
        return float(np.sqrt(np.mean(np.concatenate(off) ** 2)))


def truth(volume: RaycastVolume, look: Look, cameras: list[Camera], count: int, filter: str = "trilinear") -> Truth:  # noqa: A002
    """Return the right values in so many pixels at most of each camera's picture."""
    rng = np.random.default_rng(0)
    pixels, colours = [], []
    for camera in cameras:
        through = reference.rays(camera.model_view_projection, camera.size, volume)
        rows, columns = np.nonzero(~np.isnan(through.near))
        chosen = rng.permutation(len(rows))[:count]
        at = np.stack([rows[chosen], columns[chosen]], axis=1)
        pixels.append(at)
        colours.append(ground_truth(volume, look, through[at[:, 0], at[:, 1]], camera, filter))
    return Truth(cameras, pixels, colours)


def ground_truth(volume: RaycastVolume, look: Look, through: Any, camera: Camera, filter: str = "trilinear") -> Array:  # noqa: A002
    """Return ``(2, n, 3)`` colours of rays, by either lamp."""
    if look.mode == "composite":
        rgb = np.nan_to_num(reference.composite(volume, look.transfer, through, TOLERANCE, filter=filter)[..., :3])
        return np.stack([rgb, rgb])
    if look.mode == "mip":
        grey = grey_of(np.nan_to_num(reference.mip(volume, through, filter=filter).value, nan=look.clim[0]), look)
        return np.stack([grey, grey])
    met = reference.isosurface(volume, look.value, through, filter=filter)
    return np.stack([lit(met.gradient, through.directions, lamp) for lamp in (camera.backwards, -through.directions)])


def grey_of(values: Array, look: Look) -> Array:
    """Return ``(..., 3)`` grey of values."""
    grey = np.clip((values - look.clim[0]) / (look.clim[1] - look.clim[0]), 0.0, 1.0)
    return np.repeat(grey[..., None], 3, axis=-1)


def lit(normals: Array, directions: Array, lamp: Array) -> Array:
    """Return ``(n, 3)`` white of surfaces by the cosine of lamp and normal, turned towards the eye; black where NaN."""
    with np.errstate(invalid="ignore", divide="ignore"):
        unit = normals / np.linalg.norm(normals, axis=-1, keepdims=True)
    facing = np.where(np.einsum("...i,...i->...", unit, directions)[..., None] > 0.0, -unit, unit)
    shine = np.einsum("...i,...i->...", facing, np.broadcast_to(lamp, facing.shape))
    return np.repeat(np.nan_to_num(np.clip(shine, 0.0, 1.0))[..., None], 3, axis=-1)
