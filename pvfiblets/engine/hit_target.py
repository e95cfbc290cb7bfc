"""What is drawn in two passes: hits with their depth first, then the G-buffer that is made of them.

Spline tubes and lines with halos are drawn into it.
"""

from __future__ import annotations

import moderngl

from .depth_texture import depth_texture
from .errors import EngineError
from .gbuffer import EMPTY, GBuffer
from .opengl import OpenGL
from .shaders import Programs

__all__ = ["KEYS_UNIT", "HitTarget"]

KEYS_UNIT = 12


class HitTarget:
    """Textures of one picture.

    Parameters
    ----------
    ctx : moderngl.Context
    gl : OpenGL
    size : tuple of int
        Pixels.
    coloured : bool
        Whether the G-buffer has colours.
    relief : str
        What its ``across`` holds.

    Attributes
    ----------
    size : tuple of int
    coloured : bool
    buffer : GBuffer
    hits, depths : moderngl.Texture
        Two words that the first pass says of each pixel, undefined where nothing is; depths are 1 at the near plane and
        0 at the far one and where nothing is.
    hits_buffer, attributes, keys : moderngl.Framebuffer
        For the two passes, and for the depth alone.

    Raises
    ------
    EngineError
        If a side is longer than the driver's largest texture, or memory does not suffice.
    """

    def __init__(
        self, ctx: moderngl.Context, gl: OpenGL, size: tuple[int, int], coloured: bool, relief: str = "normal"
    ) -> None:
        self.size, self.coloured = size, coloured
        self._ctx, self._gl = ctx, gl
        self._things: list[moderngl.Texture | moderngl.Framebuffer] = []
        self.buffer = GBuffer(ctx, size)
        try:
            self.buffer.want_relief(ctx, relief)
            if coloured:
                self.buffer.want_colours(ctx)
            self.hits = ctx.texture(size, 2, dtype="u4")
            self._things.append(self.hits)
            self.hits.filter = moderngl.NEAREST, moderngl.NEAREST
            self.depths = depth_texture(ctx, gl, size)
            self._things.append(self.depths)
            self.hits_buffer = ctx.framebuffer([self.hits], self.depths)
            self._things.append(self.hits_buffer)
            kept = self.buffer
            self.keys = ctx.framebuffer([kept.depth])
            self._things.append(self.keys)
            shown = [kept.depth, kept.owner, kept.ids, kept.position, kept.across, kept.colours]
            self.attributes = ctx.framebuffer([texture for texture in shown if texture is not None], self.depths)
            self._things.append(self.attributes)
            self.attributes.depth_mask = False
        except moderngl.Error as error:
            self.release()
            raise EngineError(f"no memory for a picture of {size[0]} x {size[1]} pixels: {error}") from error

    def clear(self) -> None:
        """Empty depths and owners; the others are undefined where depth is empty."""
        self._gl.clear_depth(self.hits_buffer, 0.0)
        self._gl.clear_integers(self.attributes, (EMPTY,), 0)
        self._gl.clear_integers(self.attributes, (EMPTY,), 1)

    def write_keys(self, programs: Programs) -> None:
        """Write the depth so far into the G-buffer."""
        program, array = programs.screen("screen/keys.frag")
        self.depths.use(KEYS_UNIT)
        program["depths"] = KEYS_UNIT
        self.keys.use()
        self._ctx.enable_only(moderngl.NOTHING)
        array.render(moderngl.TRIANGLES, vertices=3)

    @property
    def nbytes(self) -> int:
        """Bytes of GPU memory."""
        return self.buffer.nbytes + 12 * self.size[0] * self.size[1]

    def release(self) -> None:
        """Give everything back; twice is harmless."""
        for thing in reversed(self._things):
            thing.release()
        self._things.clear()
        self.buffer.release()
