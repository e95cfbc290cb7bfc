"""A depth buffer of float32 that shaders can read; moderngl's own have 24 bits."""

from __future__ import annotations

import moderngl

from .moderngl_extras import GLExtras

_TEXTURE_2D = 0x0DE1
_DEPTH_COMPONENT, _DEPTH_COMPONENT_32F, _FLOAT = 0x1902, 0x8CAC, 0x1406


def depth_texture(ctx: moderngl.Context, gl: GLExtras, size: tuple[int, int]) -> moderngl.Texture:
    """Make it; its values are read as they are, by ``texelFetch``."""
    texture = ctx.depth_texture(size)
    texture.compare_func = ""
    texture.filter = moderngl.NEAREST, moderngl.NEAREST
    texture.use(ctx.default_texture_unit)
    gl.function("glTexImage2D")(_TEXTURE_2D, 0, _DEPTH_COMPONENT_32F, *size, 0, _DEPTH_COMPONENT, _FLOAT, None)
    return texture
