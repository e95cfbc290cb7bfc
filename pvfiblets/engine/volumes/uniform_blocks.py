"""The uniform block of rays through a volume (``shaders/volumes/block.glsl``), computed in float64."""

from __future__ import annotations

from typing import Any

import moderngl
import numpy as np
import numpy.typing as npt

from ...volumes.options import MAX_VALUES, RaycastOptions
from ...volumes.steepness import PARTS
from ...volumes.transfer import ALLOWED, FINEST
from ...volumes.volume import RaycastVolume
from ..bindings import BLOCKS
from ..errors import EngineError
from ..view import MAX_CLIP_PLANES, View

__all__ = ["CONSTANTS", "MAX_LEVELS", "RayBlock"]

MAX_LEVELS = 12
"""Levels of an octree: leaves of 8 voxels in a volume of up to 16,384 along an axis."""

CONSTANTS: dict[str, Any] = {
    "max_planes": MAX_CLIP_PLANES + 2,
    "max_levels": MAX_LEVELS,
    "adaptive_error": ALLOWED,
    "finest": FINEST,
    "parts": PARTS,
}
"""Of the shaders."""

_LAYOUT: list[Any] = [
    ("start", "<f4", (3, 4)),
    ("way", "<f4", (3, 4)),
    ("to_mm", "<f4", (3, 4)),
    ("to_voxels", "<f4", (3, 4)),
    ("depth", "<f4", (2, 4)),
    ("planes", "<f4", (CONSTANTS["max_planes"], 4)),
    ("low", "<f4", 4),
    ("high", "<f4", 4),
    ("size", "<f4", 4),
    ("values", "<f4", 4),
    ("table", "<f4", 4),
    ("surfaces", "<f4", MAX_VALUES),
    ("counts", "<i4", 4),
    ("levels", "<i4", (MAX_LEVELS, 4)),
]
_LARGEST = float(np.finfo(np.float32).max)

Array = npt.NDArray[np.float64]


class RayBlock:
    """The block of one volume.

    Parameters
    ----------
    ctx : moderngl.Context
    volume : RaycastVolume
    reading : tuple of 2 floats
        Scale and shift from what shaders read to values.
    """

    def __init__(self, ctx: moderngl.Context, volume: RaycastVolume, reading: tuple[float, float]) -> None:
        self._volume, self._reading = volume, reading
        self.buffer = ctx.buffer(reserve=np.dtype(_LAYOUT).itemsize)

    @property
    def buffers(self) -> dict[str, moderngl.Buffer]:
        """By name."""
        return {"rays": self.buffer}

    def step_mm(self, casting: RaycastOptions) -> float:
        """Return the length of a step."""
        return casting.step_mm(self._volume.spacing, self._volume.shape)

    def write(self, view: View, casting: RaycastOptions, levels: npt.NDArray[np.int64]) -> None:
        """Bring it up to date and bind it.

        Parameters
        ----------
        view : View
        casting : RaycastOptions
        levels : numpy.ndarray
            (n_levels, 4) nodes along each axis and place of the first, leaves first.
        """
        volume = self._volume
        size = np.array(volume.shape, np.float64)
        clip = view.model_view_projection @ volume.affine
        clip /= np.abs(clip).max() or 1.0
        block: npt.NDArray[Any] = np.zeros((), _LAYOUT)
        start, way = _rays(clip, view.size, size)
        block["start"][:, :3], block["way"][:, :3] = start, way
        block["to_mm"][:, :3] = volume.affine[:3, :3].T
        block["to_voxels"][:, :3] = volume.inverse[:3, :3]
        _, _, z, w = clip
        block["depth"] = (w - z) / 2.0, w
        planes = [w + z, w - z, *(np.asarray(view.clip_planes, np.float64).reshape(-1, 4) @ volume.affine)]
        planes = [plane / (np.abs(plane[:3]).max() or 1.0) for plane in planes]
        box = np.array(casting.box if casting.box is not None else (-np.inf, np.inf) * 3).reshape(3, 2)
        low, high = np.maximum(box[:, 0], 0.0), np.minimum(box[:, 1], size - 1.0)
        if (low > high).any() or not way.any():  # the box is beside the volume, or there is no depth: nothing is there
            planes = [np.array([0.0, 0.0, 0.0, -1.0])]
        block["planes"][: len(planes)] = np.clip(planes, -_LARGEST, _LARGEST)
        block["low"][:3], block["high"][:3] = low, high
        block["low"][3], block["high"][3] = self.step_mm(casting), casting.stop
        block["size"] = *size, view.size[0] / 2.0
        least, greatest = max(casting.low, -_LARGEST), min(casting.high, _LARGEST)
        block["values"] = *self._reading, least, greatest
        ends = volume.value_range if casting.transfer is None else casting.transfer.clim
        block["table"] = *ends, view.size[1] / 2.0, min(max(casting.threshold, -_LARGEST), _LARGEST)
        block["surfaces"][: len(casting.values)] = casting.values
        if len(levels) > MAX_LEVELS:
            raise EngineError(f"an octree of {len(levels)} levels; this program has {MAX_LEVELS} at most")
        block["counts"] = len(planes), len(casting.values), casting.iterations, len(levels) - 1
        block["levels"][: len(levels)] = levels
        self.buffer.write(block.tobytes())
        self.buffer.bind_to_uniform_block(BLOCKS["Raycast"])

    def release(self) -> None:
        """Give it back; twice is harmless."""
        self.buffer.release()


def _rays(clip: Array, picture: tuple[int, int], size: Array) -> tuple[Array, Array]:
    """Return start and direction of rays in voxels, each (3, 3): in the picture's middle, and by pixel right and up.

    Starts lie where the volume begins to be near, so that float32 has its digits there. A matrix that shows no depth
    gets rays of no length, which meet nothing.
    """
    x, y, z, w = clip
    half = np.array(picture) / 2.0
    slope = float(np.abs(w[:3]).max())
    corners = np.array(list(np.ndindex(2, 2, 2))) * (size - 1.0)
    along = w if slope > 0.0 else z
    rows = np.array([half[0] * x, half[1] * y, along])
    try:
        inverse = np.linalg.inv(rows[:, :3])
    except np.linalg.LinAlgError:
        return np.zeros((3, 3)), np.zeros((3, 3))
    if not np.isfinite(inverse).all():
        return np.zeros((3, 3)), np.zeros((3, 3))
    nearest = float((corners @ along[:3] + along[3]).min())
    if slope > 0.0:
        way = inverse.T[[2, 0, 1]]  # W of a place times this, at the pixel, leads to it from the eye
        start = max(nearest, 0.0) * way
        start[0] -= inverse @ rows[:, 3]
        return start, way
    start = inverse.T[[2, 0, 1]] * np.array([[0.0], [w[3]], [w[3]]])
    start[0] = inverse @ (np.array([0.0, 0.0, nearest]) - rows[:, 3])
    return start, np.array([inverse[:, 2], np.zeros(3), np.zeros(3)])
