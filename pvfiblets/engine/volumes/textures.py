"""A volume on the GPU: its voxels as a texture, its octree's nodes and its colours as short lists."""

from __future__ import annotations

from typing import Any

import moderngl
import numpy as np

from ...volumes.volume import RaycastVolume
from ..errors import EngineError
from ..passes import is_software

__all__ = ["VolumeTexture"]

_FORMATS: dict[Any, tuple[str, float, float]] = {
    np.uint8: ("f1", 255.0, 0.0),
    np.uint16: ("nu2", 65535.0, 0.0),
    np.int16: ("nu2", 65535.0, -32768.0),
    np.float32: ("f4", 1.0, 0.0),
}
"""moderngl's type, and what takes what a shader reads to values: times the first, plus the second."""


class VolumeTexture:
    """The voxels.

    Parameters
    ----------
    ctx : moderngl.Context
    volume : RaycastVolume

    Attributes
    ----------
    texture : moderngl.Texture3D
    scale, shift : float
        A value is what a shader reads times the scale, plus the shift.

    Raises
    ------
    EngineError
        If an axis has more voxels than this OpenGL's textures, or memory does not suffice.
    """

    def __init__(self, ctx: moderngl.Context, volume: RaycastVolume) -> None:
        limit = int(ctx.info["GL_MAX_3D_TEXTURE_SIZE"])
        if max(volume.shape) > limit:
            raise EngineError(
                f"a volume of {' x '.join(map(str, volume.shape))} voxels has more than {limit} along an axis, the "
                "most of this OpenGL's textures; take every second voxel, or a part of it"
            )
        voxels = volume.values
        if voxels.dtype == np.uint8 and is_software(ctx):
            # Mesa interpolates bytes to bytes: surfaces would lie on stairs.
            voxels = voxels.astype(np.uint16)
        kind, self.scale, self.shift = _FORMATS[voxels.dtype.type]
        if voxels.dtype == np.int16:
            voxels = (voxels.astype(np.int32) + 32768).astype(np.uint16)
        data = np.ascontiguousarray(voxels.transpose(2, 1, 0))
        try:
            self.texture = ctx.texture3d(volume.shape, 1, data, alignment=1, dtype=kind)
        except moderngl.Error as error:
            raise EngineError(f"no memory for a volume of {data.nbytes} bytes: {error}") from error
        self.texture.repeat_x = self.texture.repeat_y = self.texture.repeat_z = False
        self.nbytes = data.nbytes

    def filter(self, linear: bool) -> None:
        """Choose how the texture is sampled."""
        kind = moderngl.LINEAR if linear else moderngl.NEAREST
        self.texture.filter = kind, kind

    def release(self) -> None:
        """Give it back; twice is harmless."""
        self.texture.release()
