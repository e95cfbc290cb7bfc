"""A chunk's buffers as buffer textures, for OpenGL that has no storage buffers (``FEATURE_TEXTURE_DATA``).

Buffer textures hold no copies: both ways read the same buffers. The names of the samplers stand in ``shaders/data``.

Texture units are counted from :data:`FIRST_UNIT`, so that those that VTK hands out, from 0 upwards, stay as they are.
"""

from __future__ import annotations

import moderngl

from ..opengl import BufferTexture, OpenGL
from .chunks import Chunk
from .depth_peeling import PEEL_UNITS
from .sampled_volume import VOLUME_UNIT

__all__ = ["FIRST_UNIT", "SAMPLERS", "UNITS", "DataTextures", "set_data_samplers"]

FIRST_UNIT = 16
"""First unit for data; ``culling`` and ``pipelines`` use some below."""

SAMPLERS = {
    "anchors": ("anchor_texels", "rg32ui"),
    "pages": ("page_texels", "rgba32ui"),
    "bounds": ("bound_texels", "r32ui"),
    "anchors_low": ("anchor_low_texels", "r32ui"),
    "decoding": ("decoding_texels", "r32ui"),
    "codes": ("code_texels", "r32ui"),
    "values": ("value_texels", "r32ui"),
    "starts": ("start_texels", "r32f"),
}
"""Of a chunk's buffers: sampler and format of a texel. Before OpenGL 4.0 none has three components."""

UNITS = {name: FIRST_UNIT + index for index, name in enumerate(SAMPLERS)}
"""Texture unit of each."""


class DataTextures:
    """Buffer textures of one chunk, made when first bound.

    Parameters
    ----------
    gl : OpenGL
    chunk : Chunk
        Its buffers may come and go, as those of per-point values do.
    """

    def __init__(self, gl: OpenGL, chunk: Chunk) -> None:
        self._gl = gl
        self._chunk = chunk
        self._textures: dict[str, tuple[moderngl.Buffer, BufferTexture]] = {}

    def bind(self) -> None:
        """Bind all to their units.

        Raises
        ------
        EngineError
            If a buffer has more texels than this OpenGL reads.
        """
        buffers = self._chunk.buffers
        for name, unit in UNITS.items():
            held = self._textures.get(name)
            if held is not None and held[0] is not buffers.get(name):
                self._textures.pop(name)[1].release()
                held = None
            if name in buffers:
                if held is None:
                    held = buffers[name], self._gl.texture_buffer(buffers[name], SAMPLERS[name][1])
                    self._textures[name] = held
                held[1].bind(unit)

    def release(self) -> None:
        """Give the textures back, not the buffers; twice is harmless."""
        for _, texture in self._textures.values():
            texture.release()
        self._textures.clear()


def set_data_samplers(gl: OpenGL, program: moderngl.Program) -> None:
    """Tell a program where :meth:`DataTextures.bind` puts what it reads."""
    for name, (sampler, _) in SAMPLERS.items():
        gl.set_sampler(program, sampler, UNITS[name])
    gl.set_sampler(program, "sampled_volume", VOLUME_UNIT)
    for sampler, unit in PEEL_UNITS.items():
        gl.set_sampler(program, sampler, unit)
