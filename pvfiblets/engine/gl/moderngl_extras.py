"""OpenGL functions that moderngl lacks, by ctypes, on the context that is current.

>>> gl = GLExtras(ctx)                                            # doctest: +SKIP
>>> codes = gl.texture_buffer(buffer, "r8ui")                     # doctest: +SKIP
>>> codes.bind(3)                                                 # doctest: +SKIP
>>> gl.set_sampler(program, "codes", 3)                           # doctest: +SKIP

moderngl remembers which framebuffer is bound, but no other binding that is changed here: it makes a texture unit active
before every bind of its own. So bindings of framebuffers are restored, texture units are not.

A loader's non-null pointer proves nothing: EGL and GLX hand out stubs for any name. Only what OpenGL 3.3 has, which
is moderngl's own least version, is called without asking; all else names the version or extension that it needs.
"""

from __future__ import annotations

import ctypes
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any, NamedTuple

import moderngl

from ..errors import EngineError
from .gl_functions import FUNCTIONS, INTEGERS, RETURNS
from .gl_loader import loader
from .gl_version import version_of

__all__ = ["INTEGERS", "TEXEL_FORMATS", "BufferTexture", "GLExtras", "Uniform", "depth_texture"]

TEXEL_FORMATS: dict[str, tuple[int, int]] = {
    "r8ui": (0x8232, 1),
    "r16ui": (0x8234, 2),
    "r32ui": (0x8236, 4),
    "rg16ui": (0x823A, 4),
    "rg32ui": (0x823C, 8),
    "rgba16ui": (0x8D76, 8),
    "rgba32ui": (0x8D70, 16),
    "r32f": (0x822E, 4),
    "rg32f": (0x8230, 8),
    "rgba32f": (0x8814, 16),
}
"""Formats of buffer textures: internal format, and bytes of a texel."""

# Of a moderngl texture, by dtype and components: internal format, format, type.
_LEVEL_FORMATS: dict[tuple[str, int], tuple[int, int, int]] = {
    ("f4", 1): (0x822E, 0x1903, 0x1406),
    ("f4", 2): (0x8230, 0x8227, 0x1406),
    ("f4", 4): (0x8814, 0x1908, 0x1406),
    ("u4", 1): (0x8236, 0x8D94, 0x1405),
    ("u4", 2): (0x823C, 0x8228, 0x1405),
}

_TEXTURE_0, _TEXTURE_2D, _TEXTURE_BUFFER = 0x84C0, 0x0DE1, 0x8C2A
_TEXTURE_2D_MULTISAMPLE = 0x9100
_DEPTH_COMPONENT, _DEPTH_COMPONENT_32F, _FLOAT = 0x1902, 0x8CAC, 0x1406
_BASE_LEVEL, _MAX_LEVEL = 0x813C, 0x813D
_READ_FRAMEBUFFER, _DRAW_FRAMEBUFFER, _FRAMEBUFFER = 0x8CA8, 0x8CA9, 0x8D40
_COLOR_ATTACHMENT_0 = 0x8CE0
_COPY_WRITE_BUFFER = 0x8F37
_COLOR, _DEPTH = 0x1800, 0x1801
_COMMANDS_COMPLETE, _FLUSH = 0x9117, 0x1
_PASSED = (0x911A, 0x911C)  # already, or within the time that was given


class Uniform(NamedTuple):
    """The location of a uniform of a program that moderngl did not make."""

    location: int
    kind: int  # OpenGL's number of its type


class BufferTexture:
    """A buffer that shaders read with ``texelFetch`` on a ``(u)samplerBuffer``.

    Made by :meth:`GLExtras.texture_buffer`. It holds no copy: shaders read the buffer itself.
    Release it before the buffer.
    """

    def __init__(self, gl: GLExtras, glo: int, buffer: moderngl.Buffer, internal_format: str) -> None:
        self._gl = gl
        self._glo = glo
        self._buffer: moderngl.Buffer | None = buffer  # must outlive the texture
        self.internal_format = internal_format  # of `TEXEL_FORMATS`
        self.texels = buffer.size // TEXEL_FORMATS[internal_format][1]
        self.nbytes = self.texels * TEXEL_FORMATS[internal_format][1]  # bytes that can be read: whole texels only

    @property
    def glo(self) -> int:
        """OpenGL's name of the texture; 0 once released."""
        return self._glo

    def bind(self, unit: int) -> None:
        """Bind it to a texture unit, for a sampler whose value is that number."""
        if not self._glo:
            raise EngineError("this buffer texture has been released; make a new one")
        self._gl.function("glActiveTexture")(_TEXTURE_0 + unit)
        self._gl.function("glBindTexture")(_TEXTURE_BUFFER, self._glo)

    def release(self) -> None:
        """Delete the texture, not the buffer; twice is harmless. The context must be current."""
        if self._glo:
            self._gl.function("glDeleteTextures")(1, ctypes.byref(ctypes.c_uint(self._glo)))
            self._glo = 0
            self._buffer = None


class GLExtras:
    """Functions of the context that is current, looked up when first needed."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx
        self._functions: dict[str, Callable[..., Any]] = {}

    def has(self, name: str) -> bool:
        """Whether this OpenGL is new enough for a function, or has the extension that it is of."""
        needs = FUNCTIONS[name][1]
        return version_of(self._ctx) >= needs if isinstance(needs, int) else needs in self._ctx.extensions

    def function(self, name: str) -> Callable[..., Any]:
        """Return an OpenGL function."""
        found = self._functions.get(name)
        if found is None:
            types, needs = FUNCTIONS[name]
            self._require(name, needs)
            address = loader()(name)
            if not address:
                raise EngineError(f"this OpenGL ({self._ctx.info['GL_RENDERER']}) has no function {name}")
            prototype = ctypes.CFUNCTYPE
            if sys.platform == "win32":
                prototype = ctypes.WINFUNCTYPE
            found = self._functions[name] = prototype(RETURNS.get(name), *types)(address)
        return found

    def _require(self, what: str, needs: int | str) -> None:
        code = version_of(self._ctx)
        if isinstance(needs, int) and code < needs:
            raise EngineError(
                f"{what} needs OpenGL {needs // 100}.{needs % 100 // 10}, found {code // 100}.{code % 100 // 10}"
            )
        if isinstance(needs, str) and needs not in self._ctx.extensions:
            raise EngineError(f"{what} needs {needs}, which this OpenGL ({self._ctx.info['GL_RENDERER']}) lacks")

    def get_integer(self, name: str) -> int:
        """Return a limit or a state that ``ctx.info`` lacks."""
        if name not in INTEGERS:
            raise EngineError(f"{name} is not a known integer of OpenGL; known are {', '.join(sorted(INTEGERS))}")
        enum, needs = INTEGERS[name]
        self._require(name, needs)
        values = (ctypes.c_int64 * 4)()  # GL_ATI_meminfo returns four; the first is the sum
        self.function("glGetInteger64v")(enum, values)
        return values[0]

    def fence(self) -> int:
        """Put a fence behind all commands so far; ask it by :meth:`passed`."""
        return int(self.function("glFenceSync")(_COMMANDS_COMPLETE, 0) or 0)

    def passed(self, fence: int) -> bool:
        """Return whether the GPU is through with everything before a fence, without waiting; if so, drop the fence."""
        if self.function("glClientWaitSync")(fence, _FLUSH, 0) not in _PASSED:
            return False
        self.drop_fence(fence)
        return True

    def drop_fence(self, fence: int) -> None:
        """Give a fence back."""
        self.function("glDeleteSync")(fence)

    def texture_buffer(self, buffer: moderngl.Buffer, internal_format: str) -> BufferTexture:
        """Make a buffer readable through a texture, which OpenGL 3.3 can and storage blocks (4.3) need not be there."""
        if internal_format not in TEXEL_FORMATS:
            raise EngineError(f"{internal_format!r} is no format of buffer textures; use one of {list(TEXEL_FORMATS)}")
        enum, size = TEXEL_FORMATS[internal_format]
        texels, limit = buffer.size // size, self.get_integer("GL_MAX_TEXTURE_BUFFER_SIZE")
        if not 0 < texels <= limit:
            raise EngineError(
                f"a buffer of {buffer.size} bytes holds {texels} texels of {internal_format}; this OpenGL reads "
                f"1 to {limit} through a texture: split the data into smaller buffers"
            )
        name = ctypes.c_uint(0)
        self.function("glGenTextures")(1, ctypes.byref(name))
        texture = BufferTexture(self, name.value, buffer, internal_format)
        texture.bind(self._ctx.default_texture_unit)
        self.function("glTexBuffer")(_TEXTURE_BUFFER, enum, buffer.glo)
        return texture

    def set_sampler(self, program: Any, name: str, unit: int) -> None:
        """Set the texture unit that a sampler of a program reads, once and for all draws."""
        # moderngl does not know samplers of buffer textures: setting their `value` does nothing.
        uniform = program.get(name, None)
        if isinstance(uniform, (moderngl.Uniform, Uniform)):
            self.function("glUseProgram")(program.glo)
            self.function("glUniform1i")(uniform.location, unit)

    def add_levels(self, texture: moderngl.Texture, levels: int) -> None:
        """Give a texture storage for smaller levels, each half as wide and high (rounded down) as the one before."""
        # moderngl makes them only by filtering, which integers do not allow. Contents are undefined. Allowed levels
        # become 0 to `levels - 1`.
        kind = (texture.dtype, texture.components)
        if kind not in _LEVEL_FORMATS:
            raise EngineError(f"no levels for a texture of {kind}; use one of {list(_LEVEL_FORMATS)}")
        texture.use(self._ctx.default_texture_unit)
        for level in range(1, levels):
            width, height = (max(1, side >> level) for side in texture.size)
            internal, pixels, number = _LEVEL_FORMATS[kind]
            self.function("glTexImage2D")(_TEXTURE_2D, level, internal, width, height, 0, pixels, number, None)
        self.limit_levels(texture, 0, levels - 1)

    def limit_levels(self, texture: moderngl.Texture, first: int, last: int, unit: int | None = None) -> None:
        """Limit the levels of a texture that shaders may read; ``texelFetch`` counts them from ``first``."""
        # The texture stays bound to the unit, moderngl's own by default.
        #
        # Reading one level while drawing into another of the same texture is defined only if the one drawn is left out.
        texture.use(self._ctx.default_texture_unit if unit is None else unit)
        limit = self.function("glTexParameteri")
        limit(_TEXTURE_2D, _BASE_LEVEL, first)
        limit(_TEXTURE_2D, _MAX_LEVEL, last)

    @contextmanager
    def framebuffers_kept(self) -> Iterator[None]:
        """Bind again, at the end, the framebuffers that were bound, and have moderngl remember the one it did."""
        # moderngl binds the one that it remembers whenever it has made another, so a released one must not stay there.
        # `ctx.detect_framebuffer` cannot find the bound one: on VTK's framebuffers it leaves an OpenGL error.
        draw = self.get_integer("GL_DRAW_FRAMEBUFFER_BINDING")
        read = self.get_integer("GL_READ_FRAMEBUFFER_BINDING")
        remembered = self._ctx.fbo, self._ctx.mglo.fbo
        try:
            yield
        finally:
            self._ctx.fbo, self._ctx.mglo.fbo = remembered
            self.function("glBindFramebuffer")(_DRAW_FRAMEBUFFER, draw)
            self.function("glBindFramebuffer")(_READ_FRAMEBUFFER, read)

    def attach_outside(self, framebuffer: moderngl.Framebuffer, name: int, samples: int = 0) -> None:
        """Make a framebuffer draw into somebody else's texture, or none; it stays bound."""
        self.function("glBindFramebuffer")(_DRAW_FRAMEBUFFER, framebuffer.glo)
        target = _TEXTURE_2D_MULTISAMPLE if samples else _TEXTURE_2D
        self.function("glFramebufferTexture2D")(_DRAW_FRAMEBUFFER, _COLOR_ATTACHMENT_0, target, name, 0)

    def attach_level(self, framebuffer: moderngl.Framebuffer, texture: moderngl.Texture, level: int) -> None:
        """Make a framebuffer draw into one level of a texture, and set its viewport to that level's size."""
        # One framebuffer per level, attached when the texture is made, spares the frame these calls.
        with self.framebuffers_kept():
            self.function("glBindFramebuffer")(_FRAMEBUFFER, framebuffer.glo)
            self.function("glFramebufferTexture2D")(_FRAMEBUFFER, _COLOR_ATTACHMENT_0, _TEXTURE_2D, texture.glo, level)
        width, height = (max(1, side >> level) for side in texture.size)
        framebuffer.viewport = (0, 0, width, height)

    def attach_layer(
        self, framebuffer: moderngl.Framebuffer, texture: moderngl.TextureArray, layer: int, attachment: int = 0
    ) -> None:
        """Make a framebuffer draw into one layer of a texture, and set its viewport to the texture's size."""
        with self.framebuffers_kept():
            self.function("glBindFramebuffer")(_FRAMEBUFFER, framebuffer.glo)
            self.function("glFramebufferTextureLayer")(
                _FRAMEBUFFER, _COLOR_ATTACHMENT_0 + attachment, texture.glo, 0, layer
            )
        framebuffer.viewport = (0, 0, texture.width, texture.height)

    def clear_integers(self, framebuffer: moderngl.Framebuffer, values: Sequence[int], attachment: int = 0) -> None:
        """Fill an unsigned integer attachment; moderngl's ``clear`` is for floats."""
        padded = (ctypes.c_uint * 4)(*values)
        with self.framebuffers_kept():
            framebuffer.use()  # with its draw buffers, colour mask and scissor, whatever was in force
            self.function("glClearBufferuiv")(_COLOR, attachment, padded)

    def clear_words(self, buffer: moderngl.Buffer, offset: int = 0, size: int | None = None) -> None:
        """Fill a buffer, or a part of it, with zeros on the GPU (OpenGL 4.3)."""
        # moderngl's `clear` maps the buffer, and so waits for draws that use it.
        size = buffer.size - offset if size is None else size
        internal, pixels, number = _LEVEL_FORMATS["u4", 1]
        self.function("glBindBuffer")(_COPY_WRITE_BUFFER, buffer.glo)
        self.function("glClearBufferSubData")(_COPY_WRITE_BUFFER, internal, offset, size, pixels, number, None)

    def fill(self, framebuffer: moderngl.Framebuffer, attachment: int, values: Sequence[float]) -> None:
        """Fill one attachment of floats, inside the framebuffer's scissor, and leave it in use."""
        padded = (ctypes.c_float * 4)(*values)
        framebuffer.use()
        self.function("glClearBufferfv")(_COLOR, attachment, padded)

    def clear_depth(self, framebuffer: moderngl.Framebuffer, depth: float = 1.0) -> None:
        """Fill the depth attachment and nothing else; moderngl's ``clear`` takes the colours along."""
        with self.framebuffers_kept():
            framebuffer.use()
            self.function("glClearBufferfv")(_DEPTH, 0, ctypes.byref(ctypes.c_float(depth)))


def depth_texture(ctx: moderngl.Context, gl: GLExtras, size: tuple[int, int]) -> moderngl.Texture:
    """Make a depth buffer of float32 that shaders read by ``texelFetch``; moderngl's own have 24 bits."""
    texture = ctx.depth_texture(size)
    texture.compare_func = ""
    texture.filter = moderngl.NEAREST, moderngl.NEAREST
    texture.use(ctx.default_texture_unit)
    gl.function("glTexImage2D")(_TEXTURE_2D, 0, _DEPTH_COMPONENT_32F, *size, 0, _DEPTH_COMPONENT, _FLOAT, None)
    return texture
