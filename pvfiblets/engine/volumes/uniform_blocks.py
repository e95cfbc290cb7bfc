"""The uniform block of rays through a volume, computed in float64 (symbols: ``shaders/volumes/block.glsl``)."""

from __future__ import annotations

from typing import Any

import moderngl
import numpy as np
import numpy.typing as npt

from ...volumes.raycast_options import MAX_VALUES, RaycastOptions
from ...volumes.steepness import PARTS
from ...volumes.transfer import ALLOWED, FINEST
from ...volumes.volume import RaycastVolume
from ..errors import EngineError
from ..gl.bindings import BLOCKS
from ..gl.uniform_struct import Field, UniformStruct
from ..view import MAX_CLIP_PLANES, View

MAX_LEVELS = 16  # levels of an octree: leaves of 8 voxels in a volume of up to 262,144 along an axis

MOST_LAMPS = 8  # lamps of a scene that shine on light through a volume: the first ones that are on

CONSTANTS: dict[str, Any] = {
    "adaptive_error": ALLOWED,
    "finest": FINEST,
    "parts": PARTS,
    "lamps": MOST_LAMPS,
    "surfaces": MAX_VALUES,
}
"""Of the shaders."""

MAX_PLANES = MAX_CLIP_PLANES + 2

RAYCAST_BLOCK = UniformStruct(
    "Raycast",
    Field("ray_origin", "vec3[3]", "O in the picture's middle, and what a pixel to the right and one up add to it"),
    Field("ray_direction", "vec3[3]", "D likewise, of any length"),
    Field("mm_from_voxels", "mat3", "of directions"),
    Field("gradient_from_voxels", "mat3", "to changes per mm from changes per voxel: the inverse's transpose"),
    Field("u_from_voxels", "vec4", "U is its dot product with (voxels, 1)"),
    Field("w_from_voxels", "vec4", "W likewise"),
    Field("ray_planes", f"vec4[{MAX_PLANES}]", "kept where they are not negative: near, far, the caller's"),
    Field("box_low", "vec3", "corner of the visible box, in voxels"),
    Field("ray_step", "float", "mm"),
    Field("box_high", "vec3", "the opposite corner"),
    Field("opaque_from", "float", "opacity at which a ray ends"),
    Field("volume_shape", "vec3", "voxels along each axis"),
    Field("peak_threshold", "float", "value from which on a local maximum is a peak"),
    Field("field_scale", "float", "value = what the texture holds * field_scale + field_shift"),
    Field("field_shift", "float", "value of 0 in the texture"),
    Field("value_low", "float", "least value that is seen"),
    Field("value_high", "float", "greatest value that is seen"),
    Field("transfer_low", "float", "value at the first end of the transfer function"),
    Field("transfer_high", "float", "value at its other end"),
    Field("half_picture", "vec2", "half the picture's width and height in pixels"),
    Field("ray_plane_count", "int", "of ray_planes"),
    Field("isovalue_count", "int", "of isovalues"),
    Field("refinement_steps", "int", "of a surface's place on a ray"),
    Field("top_level", "int", "of the octree"),
    Field("peak_rounding", "float", "so little below a peak, the field has not fallen"),
    Field("isovalues", f"float[{MAX_VALUES}]", "of surfaces"),
    Field("octree_shapes", f"ivec3[{MAX_LEVELS}]", "nodes along each axis, by level, leaves first"),
    Field("octree_starts", f"int[{MAX_LEVELS}]", "places of the levels' first nodes in the list"),
)
_LARGEST = float(np.finfo(np.float32).max)
_ROUNDING = 1e-6
"""Part of the largest value by which an interpolation of float32 may miss: a few units of its last digit."""
_LEAST_FALL = 1e-3
"""Part of the range of values that is a fall whatever rounds: of a field far from 0, rounding may be as large as it."""

Array = npt.NDArray[np.float64]


class RayBlock:
    """The block of one volume."""

    def __init__(self, ctx: moderngl.Context, volume: RaycastVolume, reading: tuple[float, float]) -> None:
        self._volume, self._reading = volume, reading  # scale and shift from what shaders read to values
        self.buffer = ctx.buffer(reserve=RAYCAST_BLOCK.nbytes)

    @property
    def buffers(self) -> dict[str, moderngl.Buffer]:
        """By name."""
        return {"rays": self.buffer}

    def step_mm(self, casting: RaycastOptions) -> float:
        """Return the length of a step."""
        return casting.step_mm(self._volume.spacing, self._volume.shape)

    def write(self, view: View, casting: RaycastOptions, levels: npt.NDArray[np.int64]) -> None:
        """Bring it up to date and bind it."""
        volume = self._volume
        size = np.array(volume.shape, np.float64)
        clip = view.model_view_projection @ volume.affine
        clip /= np.abs(clip).max() or 1.0
        origin, direction = _rays(clip, view.size, size)
        _, _, z, w = clip
        planes = [w + z, w - z, *(np.asarray(view.clip_planes, np.float64).reshape(-1, 4) @ volume.affine)]
        planes = [plane / (np.abs(plane[:3]).max() or 1.0) for plane in planes]
        box = np.array(casting.box if casting.box is not None else (-np.inf, np.inf) * 3).reshape(3, 2)
        low, high = np.maximum(box[:, 0], 0.0), np.minimum(box[:, 1], size - 1.0)
        if (low > high).any() or not direction.any():  # beside the volume, or there is no depth: nothing is there
            planes = [np.array([0.0, 0.0, 0.0, -1.0])]
        if len(levels) > MAX_LEVELS:
            raise EngineError(
                f"a volume of {max(volume.shape)} voxels along an axis, of whose octree this program has "
                f"{8 << (MAX_LEVELS - 1)} at most; give octree=False, or a part of it"
            )
        transfer = volume.value_range if casting.transfer is None else casting.transfer.clim
        self.buffer.write(
            RAYCAST_BLOCK.pack(
                ray_origin=origin,
                ray_direction=direction,
                mm_from_voxels=volume.affine[:3, :3],
                gradient_from_voxels=volume.inverse[:3, :3].T,
                u_from_voxels=(w - z) / 2.0,
                w_from_voxels=w,
                ray_planes=np.clip(planes, -_LARGEST, _LARGEST),
                box_low=low,
                ray_step=self.step_mm(casting),
                box_high=high,
                opaque_from=casting.stop,
                volume_shape=size,
                peak_threshold=min(max(casting.threshold, -_LARGEST), _LARGEST),
                field_scale=self._reading[0],
                field_shift=self._reading[1],
                value_low=max(casting.low, -_LARGEST),
                value_high=min(casting.high, _LARGEST),
                transfer_low=transfer[0],
                transfer_high=transfer[1],
                half_picture=np.array(view.size) / 2.0,
                ray_plane_count=len(planes),
                isovalue_count=len(casting.values),
                refinement_steps=casting.iterations,
                top_level=len(levels) - 1,
                peak_rounding=min(
                    _ROUNDING * float(np.abs(volume.value_range).max()), _LEAST_FALL * float(np.ptp(volume.value_range))
                ),
                isovalues=np.asarray(casting.values, np.float64),
                octree_shapes=levels[:, :3],
                octree_starts=levels[:, 3],
            )
        )
        self.buffer.bind_to_uniform_block(BLOCKS["Raycast"])

    def release(self) -> None:
        """Give it back; twice is harmless."""
        self.buffer.release()


def _rays(clip: Array, picture: tuple[int, int], size: Array) -> tuple[Array, Array]:
    """Return origin and direction of rays in voxels, each (3, 3): in the picture's middle, and by pixel right and up.

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
