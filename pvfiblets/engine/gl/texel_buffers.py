"""Arrays that shaders read as buffer textures, by the names of their samplers."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import moderngl
import numpy as np
import numpy.typing as npt

from ..errors import EngineError
from .moderngl_extras import TEXEL_FORMATS, BufferTexture, GLExtras

LARGEST = float(np.finfo(np.float32).max)


class TexelBuffers:
    """Buffers and their textures; the buffer of ``node_texels`` is called ``nodes``."""

    def __init__(self, ctx: moderngl.Context, gl: GLExtras, units: Mapping[str, int]) -> None:
        self._ctx, self._gl, self._units = ctx, gl, units
        self._textures: dict[str, BufferTexture] = {}
        self.buffers: dict[str, moderngl.Buffer] = {}

    def put(self, sampler: str, texel: str, data: npt.NDArray[Any], what: str) -> None:
        """Store an array in place of the one there is; errors name `what` it is."""
        self.drop(sampler)
        limit = self._gl.get_integer("GL_MAX_TEXTURE_BUFFER_SIZE") * TEXEL_FORMATS[texel][1]
        if data.nbytes > limit:
            raise EngineError(
                f"{what} take {data.nbytes} bytes, more than the {limit} that this OpenGL reads from one buffer; draw "
                "them as several actors"
            )
        name = _name(sampler)
        try:
            self.buffers[name] = self._ctx.buffer(np.ascontiguousarray(data))
        except moderngl.Error as error:
            raise EngineError(f"no memory for {what} ({data.nbytes} bytes)") from error
        self._textures[sampler] = self._gl.texture_buffer(self.buffers[name], texel)

    def drop(self, sampler: str) -> None:
        """Give an array back, if there is one."""
        if sampler in self._textures:
            self._textures.pop(sampler).release()
            self.buffers.pop(_name(sampler)).release()

    def bind(self) -> None:
        """Bind all to their units."""
        for sampler, texture in self._textures.items():
            texture.bind(self._units[sampler])

    def release(self) -> None:
        """Give everything back; twice is harmless."""
        for sampler in list(self._textures):
            self.drop(sampler)


def as_singles(numbers: npt.NDArray[Any], most: float = np.inf) -> npt.NDArray[np.float32]:
    """As float32, within +-most; finite numbers stay finite, others none."""
    wide = np.clip(numbers, -most, most)
    return np.where(np.isfinite(wide), np.clip(wide, -LARGEST, LARGEST), wide).astype("<f4")


def _name(sampler: str) -> str:
    return sampler.removesuffix("_texels") + "s"
