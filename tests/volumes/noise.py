"""Noise, cameras on it, and the three filters in plain NumPy: what the float64 reference of rays is held to."""

from __future__ import annotations

import numpy as np

from pvfiblets.report.studies.volumes.reference import Rays
from pvfiblets.volumes.transfer import Transfer
from pvfiblets.volumes.volume import RaycastVolume

from .analytic import camera, middle

SIZE = (32, 24)
SHAPE = (20, 18, 16)
VIEWS = {"perspective": {}, "parallel": {"height": 24.0}}


def view(affine, shape=SHAPE, *, away=(30, 20, 10), **choices):
    at = middle(shape, affine)
    return camera(at + away, at, **choices)


def noise(shape=(7, 6, 8), seed=0, affine=None, dtype=np.float32):
    values = np.random.default_rng(seed).random(shape)
    if np.dtype(dtype).kind in "ui":
        values *= 255
    return RaycastVolume(values.astype(dtype), affine)


def straight(origin, direction, far, *, near=0.0):
    """One ray."""
    direction = np.array(direction, float)
    return Rays(
        np.array([origin], float), direction[None] / np.linalg.norm(direction), np.full(1, near), np.full(1, far),
        np.eye(4),
    )  # fmt: skip


def trilinear(values, places):
    """By the eight corners."""
    values = values.astype(float)
    low = np.clip(np.floor(places).astype(int), 0, np.array(values.shape) - 2)
    u = places - low
    found = 0.0
    for corner in np.ndindex(2, 2, 2):
        weight = np.prod(np.where(corner, u, 1 - u), axis=-1)
        found = found + weight * values[tuple(np.moveaxis(low + corner, -1, 0))]
    return found


def tricubic(values, places):
    """By Catmull-Rom's weights of 4 x 4 x 4 voxels; the last one repeats."""
    low = np.clip(np.floor(places).astype(int), 0, np.array(values.shape) - 2)
    u = places - low
    weights = np.stack([
        -u**3 / 2 + u**2 - u / 2, 1.5 * u**3 - 2.5 * u**2 + 1, -1.5 * u**3 + 2 * u**2 + u / 2, u**3 / 2 - u**2 / 2
    ], axis=-1)  # fmt: skip
    found = 0.0
    for i, j, k in np.ndindex(4, 4, 4):
        at = np.clip(low + np.array([i, j, k]) - 1, 0, np.array(values.shape) - 1)
        weight = weights[..., 0, i] * weights[..., 1, j] * weights[..., 2, k]
        found = found + weight * values[tuple(np.moveaxis(at, -1, 0))]
    return found


def nearest(values, places):
    return values[tuple(np.moveaxis(np.floor(places + 0.5).astype(int), -1, 0))].astype(float)


PLAIN = {"nearest": nearest, "trilinear": trilinear, "tricubic": tricubic}


def along(volume, through, how, n):
    """t and plain samples along those of the rays that are in the volume, n + 1 each."""
    some = through[~np.isnan(through.near)]
    t = some.near[:, None] + (some.far - some.near)[:, None] * np.linspace(0, 1, n + 1)
    places = some.origins[:, None] + t[..., None] * some.directions[:, None]
    voxels = places @ volume.inverse[:3, :3].T + volume.inverse[:3, 3]
    voxels = np.clip(voxels, 0, np.array(volume.shape) - 1.0)
    return some, t, PLAIN[how](volume.values, voxels)


def haze(unit=1.0):
    return Transfer([[1, 0, 0, 0], [0, 1, 0, 0.2], [0, 0, 1, 0.9]], (0, 1), unit)
