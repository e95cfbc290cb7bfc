"""Volumes, cameras, and what rays show of them in closed form, for tests of how VTK draws them."""

from __future__ import annotations

import numpy as np
import pyvista as pv
from vtkmodules.vtkRenderingCore import vtkActor

from pvfiblets.mappers import Colouring, VolumeMapper
from pvfiblets.volumes import RaycastVolume, Transfer
from pvfiblets.volumes.raycast_options import RaycastOptions

HALF = 16.0  # the volumes' boxes reach from -16 to 16 mm
KAPPA = 0.05
ORANGE = np.array([1.0, 0.5, 0.0])
GREYS = np.repeat(np.arange(256, dtype=np.uint8)[:, None], 4, axis=1) | np.array([0, 0, 0, 255], np.uint8)
SIZE = (240, 200)


def volume(field, n=33):
    """The numbers of a function of (n, n, n, 3) mm."""
    spacing = 2 * HALF / (n - 1)
    places = np.stack(np.meshgrid(*[np.linspace(-HALF, HALF, n)] * 3, indexing="ij"), axis=-1)
    affine = np.diag([spacing, spacing, spacing, 1.0])
    affine[:3, 3] = -HALF
    return RaycastVolume(np.ascontiguousarray(field(places), np.float32), affine)


def fog(n=5):
    return volume(lambda p: np.ones(p.shape[:3]), n)


def light(colour=ORANGE, kappa=KAPPA):
    """Everything shines and absorbs alike."""
    rgba = [*colour, 1.0 - np.exp(-kappa)]
    return RaycastOptions("composite", transfer=Transfer([rgba, rgba], (0.0, 2.0)), stop=1.0)


def blob(p):
    return 16.0 - np.linalg.norm(p, axis=-1) + 2.0 * np.sin(p[..., 0] / 3.0) * np.cos(p[..., 2] / 4.0)


def made(drawn, casting, *, lighting=False, **options):
    mapper, actor = VolumeMapper(drawn, casting, **options), vtkActor()
    mapper.attach(actor)
    actor.GetProperty().SetLighting(lighting)
    actor.GetProperty().SetAmbient(0.1)
    actor.GetProperty().SetDiffuse(0.9)
    return mapper, actor


def through_table(ends):
    return Colouring("point_scalar", source="values", lut=GREYS, clim=ends)


def look(plotter, eye=(0.0, -100.0, 0.0), parallel=True):
    """Towards the origin; parallel, 200 pixels are 40 mm."""
    plotter.camera_position = [eye, (0, 0, 0), (0, 0, 1)]
    plotter.camera.view_angle = 40.0
    if parallel:
        plotter.enable_parallel_projection()
        plotter.camera.parallel_scale = 20.0
    plotter.camera.clipping_range = 0.02 if np.linalg.norm(eye) < 20 else 20, 200
    return plotter


def rays(eye=(0.0, -100.0, 0.0), parallel=True):
    """Starts and unit directions of all pixels' rays, (height, width, 3), rows from above."""
    width, height = SIZE
    x, y = np.meshgrid((np.arange(width) + 0.5) / width * 2 - 1, 1 - (np.arange(height) + 0.5) / height * 2)
    forward = -np.array(eye) / np.linalg.norm(eye)
    right = np.cross(forward, (0, 0, 1))
    right /= np.linalg.norm(right)
    up = np.cross(right, forward)
    half = 20.0 if parallel else np.tan(np.radians(20.0))
    across = half * (x[..., None] * width / height * right + y[..., None] * up)
    if parallel:
        return eye + across, np.broadcast_to(forward, across.shape)
    ways = forward + across
    return np.broadcast_to(np.array(eye), ways.shape), ways / np.linalg.norm(ways, axis=-1, keepdims=True)


def in_box(starts, ways):
    """Where rays enter and leave the box, mm; not behind their start."""
    with np.errstate(divide="ignore", invalid="ignore"):
        ends = np.sort([(-HALF - starts) / ways, (HALF - starts) / ways], axis=0)
    return np.maximum(np.nanmax(ends[0], axis=-1), 0.0), np.nanmin(ends[1], axis=-1)


def into_ball(starts, ways, radius):
    """Where rays enter a ball around the origin; infinity where they miss."""
    b = np.einsum("ijk,ijk->ij", starts, ways)
    inside = b**2 - np.einsum("ijk,ijk->ij", starts, starts) + radius**2
    return np.where(inside > 0, -b - np.sqrt(np.maximum(inside, 0.0)), np.inf)


def over(length, behind, colour=ORANGE, kappa=KAPPA):
    """8-bit colours of that much fog over what is behind."""
    left = np.exp(-kappa * np.maximum(length, 0.0))[..., None]
    return 255.0 * ((1.0 - left) * colour + left * behind)


def inner(mask, reach=1):
    """Pixels all of whose neighbours are of one kind: edges are a matter of half a pixel."""
    padded, across = np.pad(mask, reach, mode="edge"), range(2 * reach + 1)
    around = [padded[y : y + mask.shape[0], x : x + mask.shape[1]] for y in across for x in across]
    return np.all(around, axis=0) | ~np.any(around, axis=0)


def middle(image):
    return image[SIZE[1] // 2, SIZE[0] // 2].astype(float)


def ramp(p):
    return p[..., 1]


def wall(y):
    return pv.Plane(center=(0, y, 0), direction=(0, 1, 0), i_size=100, j_size=100)
