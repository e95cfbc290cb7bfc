"""Pictures of ray-cast volumes, and their errors: colours, and places of surfaces."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from pvfiblets.volumes import RaycastVolume

from ...cameras import Camera
from ..culling.pictures import directions
from . import reference
from .scene import Look, Truth, grey_of, lit, truth

if TYPE_CHECKING:
    from pvfiblets.engine.gbuffer import GBuffer

Array = npt.NDArray[np.float64]
Words = npt.NDArray[np.uint32]

EMPTY = 0xFFFFFFFF


def colours_of(gbuffer: GBuffer, look: Look, camera: Camera) -> Array:
    """Return the picture that a G-buffer means, by the lamp of meshes: ``(height, width, 3)``, row 0 at the bottom."""
    if look.mode == "composite":
        return light_of(gbuffer)[..., :3]
    width, height = gbuffer.size
    there = np.frombuffer(gbuffer.depth.read(), np.uint32).reshape(height, width) != EMPTY
    if look.mode == "mip":
        values = np.frombuffer(gbuffer.position.read(), np.float32).reshape(height, width, 2)[..., 1]
        shown = grey_of(values.astype(np.float64), look)
    else:
        assert gbuffer.across is not None  # surfaces have their normals there
        normals = directions(np.frombuffer(gbuffer.across.read(), np.uint32)).reshape(height, width, 3)
        # They face the eye already.
        shown = lit(normals, -normals, camera.backwards)
    return np.where(there[..., None], shown, 0.0)


def light_of(gbuffer: GBuffer) -> Array:
    """Return light, multiplied by its opacity, and opacity: ``(height, width, 4)``, row 0 at the bottom."""
    width, height = gbuffer.size
    there = np.frombuffer(gbuffer.depth.read(), np.uint32).reshape(height, width) != EMPTY
    assert gbuffer.colours is not None  # rays that add up have theirs there
    rgba = np.frombuffer(gbuffer.colours.read(), np.uint8).reshape(height, width, 4) / 255.0
    rgba[..., :3] *= rgba[..., 3:]
    found: Array = np.where(there[..., None], rgba, 0.0)
    return found


@dataclass(frozen=True, eq=False)
class GroundTruth:
    """What is right by one filter: colours, and of surfaces how far along their rays they are."""

    colours: Truth
    rays: list[Any]
    along: list[Array] | None  # (n,) mm for each camera, NaN where there is no surface


def ground_truth_of(volume: RaycastVolume, look: Look, cameras: list[Camera], count: int, filter: str) -> GroundTruth:  # noqa: A002
    """Return the right values in so many pixels of each camera's picture."""
    colours = truth(volume, look, cameras, count, filter)
    rays = [
        reference.rays(camera.model_view_projection, camera.size, volume)[at[:, 0], at[:, 1]]
        for camera, at in zip(cameras, colours.pixels, strict=True)
    ]
    along = None
    if look.mode == "isosurface":
        along = [reference.isosurface(volume, look.value, through, filter=filter).t for through in rays]
    return GroundTruth(colours, rays, along)


def along_of(keys: Words, rays: Any) -> Array:
    """Return the distance along each ray of a depth key of a G-buffer: ``(n,)`` mm, NaN for empty pixels."""
    depth = 2.0 * (1.0 - (0xFFFFFFFF - keys.astype(np.float64)) / 2.0**32) - 1.0
    z, w = np.moveaxis(rays.origins @ rays.matrix[2:, :3].T + rays.matrix[2:, 3], -1, 0)
    dz, dw = np.moveaxis(rays.directions @ rays.matrix[2:, :3].T, -1, 0)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(keys == EMPTY, np.nan, (depth * w - z) / (dz - depth * dw))


def places(of: GroundTruth, depths: list[Words], spacing: float) -> dict[str, Any]:
    """Return how far surfaces are off along their rays, in voxels."""
    assert of.along is not None
    keys = [depth[at[:, 0], at[:, 1]] for depth, at in zip(depths, of.colours.pixels, strict=True)]
    shown = np.concatenate([along_of(key, rays) for key, rays in zip(keys, of.rays, strict=True)])
    wanted = np.concatenate(of.along)
    there, ought = ~np.isnan(shown), ~np.isnan(wanted)
    off = np.abs(shown - wanted) / spacing
    near = there & ought & (off <= 1.0)
    either = there | ought
    far = there & ought & (off > 1.0)
    return {
        "position": float(np.where(near, off, 1.0)[either].mean()) if either.any() else 0.0,
        "median": float(np.median(off[near])) if near.any() else None,
        "p99": float(np.percentile(off[near], 99)) if near.any() else None,
        "missed": float(((ought & ~there) | (far & (shown > wanted))).sum() / max(ought.sum(), 1)),
        "false": float(((there & ~ought) | (far & (shown < wanted))).sum() / max(ought.sum(), 1)),
    }
