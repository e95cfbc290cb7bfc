"""A chunk's buffers as buffer textures, for OpenGL that has no storage buffers (``FEATURE_TEXTURE_DATA``).

Buffer textures hold no copies: both ways read the same buffers. The names of the samplers stand in
``shaders/fiblets/data``.

"""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Sequence
from functools import partial

import moderngl

from ...gl.bindings import FIBLET_DATA, PEELING, SAMPLED
from ...gl.moderngl_extras import BufferTexture, GLExtras
from .chunks import Chunk

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


class DataTextures:
    """Buffer textures of one chunk, made when first bound."""

    def __init__(self, gl: GLExtras, chunk: Chunk) -> None:
        self._gl = gl
        self._chunk = chunk  # buffers of per-point values may come and go
        self._textures: dict[str, tuple[moderngl.Buffer, BufferTexture]] = {}
        self._bound: dict[str, moderngl.Buffer] = {}
        self._binding: Callable[[], None] = _nothing

    def bind(self) -> None:
        """Bind all to their units."""
        if self._bound != self._chunk.buffers:
            self._look()
        self._binding()

    def _look(self) -> None:
        """Make textures of new buffers, and find out how to bind them all."""
        buffers = dict(self._chunk.buffers)
        for name in FIBLET_DATA:
            held = self._textures.get(name)
            if held is not None and held[0] is not buffers.get(name):
                self._textures.pop(name)[1].release()
                held = None
            if name in buffers and held is None:
                self._textures[name] = buffers[name], self._gl.texture_buffer(buffers[name], SAMPLERS[name][1])
        first = next(iter(self._textures.values()))[1]
        last = max(number for number, name in enumerate(FIBLET_DATA) if name in self._textures)
        # Programs never read the missing ones in between: any texture may be there.
        names = tuple(FIBLET_DATA)[: last + 1]
        every = [self._textures[name][1] if name in self._textures else first for name in names]
        self._binding = _binder(self._gl, min(FIBLET_DATA.values()), every)
        self._bound = buffers

    def release(self) -> None:
        """Give the textures back, not the buffers; twice is harmless."""
        for _, texture in self._textures.values():
            texture.release()
        self._textures.clear()
        self._bound, self._binding = {}, _nothing


def _binder(gl: GLExtras, unit: int, textures: Sequence[BufferTexture]) -> Callable[[], None]:
    """Return what binds textures to units from one on: one call, or two for each before OpenGL 4.4."""
    if gl.has("glBindTextures"):
        names = (ctypes.c_uint * len(textures))(*(texture.glo for texture in textures))
        return partial(gl.function("glBindTextures"), unit, len(textures), names)

    def bind() -> None:
        for index, texture in enumerate(textures):
            texture.bind(unit + index)

    return bind


def _nothing() -> None:
    """Bind nothing: no buffers were there yet."""


def set_data_samplers(gl: GLExtras, program: moderngl.Program) -> None:
    """Set a program's samplers to the units of :meth:`DataTextures.bind`."""
    for name, (sampler, _) in SAMPLERS.items():
        gl.set_sampler(program, sampler, FIBLET_DATA[name])
    gl.set_sampler(program, "sampled_volume", SAMPLED["sampled_volume"])
    for sampler, unit in PEELING.items():
        gl.set_sampler(program, sampler, unit)
