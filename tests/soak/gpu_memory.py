"""How much the current OpenGL context holds, whoever made it: every texture, buffer and renderbuffer is asked.

Names of objects are small numbers, given one after the other, as drivers do it though OpenGL does not demand it.
"""

from __future__ import annotations

import ctypes

from pvfiblets.engine.gl.gl_loader import loader

MOST_NAMES = 8192
MOST_LEVELS = 16

# Width, height, depth, samples, and bits of red, green, blue, alpha, depth and stencil.
_OF_TEXTURE = (0x1000, 0x1001, 0x8071, 0x9106, 0x805C, 0x805D, 0x805E, 0x805F, 0x884A, 0x88F1)
_OF_RENDERBUFFER = (0x8D42, 0x8D43, 0x8CAB, *range(0x8D50, 0x8D56))  # without depth
_READS_BUFFER, _BUFFER_SIZE = 0x8C2D, 0x8764


def allocated() -> int | None:
    """Return bytes of all that the current context holds, None where it cannot be asked (before OpenGL 4.5)."""
    try:
        asked = _Asked()
    except AttributeError:
        return None
    return sum(asked.texture(name) + asked.buffer(name) + asked.renderbuffer(name) for name in range(1, MOST_NAMES))


class _Asked:
    """The functions of OpenGL that are needed."""

    def __init__(self) -> None:
        address_of = loader()

        def function(name: str, result: object, *types: object) -> object:
            address = address_of(name)
            if not address:
                raise AttributeError(name)
            return ctypes.CFUNCTYPE(result, *types)(address)

        integer, pointer = ctypes.c_uint, ctypes.POINTER(ctypes.c_int)
        kinds = ("Texture", "Buffer", "Renderbuffer")
        self._is = {kind: function(f"glIs{kind}", ctypes.c_ubyte, integer) for kind in kinds}
        self._level = function("glGetTextureLevelParameteriv", None, integer, ctypes.c_int, integer, pointer)
        self._buffer = function("glGetNamedBufferParameteriv", None, integer, integer, pointer)
        self._renderbuffer = function("glGetNamedRenderbufferParameteriv", None, integer, integer, pointer)

    def _get(self, call: object, *arguments: int) -> int:
        value = ctypes.c_int(0)
        call(*arguments, ctypes.byref(value))
        return value.value

    def texture(self, name: int) -> int:
        if not self._is["Texture"](name) or self._get(self._level, name, 0, _READS_BUFFER):
            return 0  # of textures that read a buffer, the buffer counts
        total = 0
        for level in range(MOST_LEVELS):
            width, height, depth, samples, *bits = (self._get(self._level, name, level, key) for key in _OF_TEXTURE)
            if width == 0:
                break
            total += max(width, 1) * max(height, 1) * max(depth, 1) * max(samples, 1) * sum(bits) // 8
        return total

    def buffer(self, name: int) -> int:
        return self._get(self._buffer, name, _BUFFER_SIZE) if self._is["Buffer"](name) else 0

    def renderbuffer(self, name: int) -> int:
        if not self._is["Renderbuffer"](name):
            return 0
        width, height, samples, *bits = (self._get(self._renderbuffer, name, key) for key in _OF_RENDERBUFFER)
        return width * height * max(samples, 1) * sum(bits) // 8
