"""Textures of a picture of two passes: hits with their depth, and the G-buffer made of them."""

from __future__ import annotations

import moderngl

from .errors import EngineError
from .gbuffer import EMPTY, GBuffer
from .gl.bindings import HIT_KEYS
from .gl.moderngl_extras import GLExtras, depth_texture
from .gl.shaders import Programs


class HitTarget:
    """Textures of one picture.

    ``hits`` and ``depths`` are two words of each pixel from the first pass, undefined where nothing is; depths are 1 at
    the near plane and 0 at the far one and where nothing is.
    """

    def __init__(
        self,
        ctx: moderngl.Context,
        gl: GLExtras,
        size: tuple[int, int],  # pixels
        coloured: bool,  # whether the G-buffer has colours
        relief: str = "normal",  # what its `across` holds
        edges: str | None = None,  # whether it has `edges`, and which pass writes them
    ) -> None:
        self.size, self.coloured = size, coloured
        self._ctx, self._gl = ctx, gl
        self._things: list[moderngl.Texture | moderngl.Framebuffer] = []
        self.buffer = GBuffer(ctx, size)
        try:
            self.buffer.want_relief(ctx, relief)
            if coloured:
                self.buffer.want_colours(ctx)
            self.buffer.want_edges(ctx, edges is not None)
            written = [] if self.buffer.edges is None else [self.buffer.edges]
            self.hits = ctx.texture(size, 2, dtype="u4")
            self._things.append(self.hits)
            self.hits.filter = moderngl.NEAREST, moderngl.NEAREST
            self.depths = depth_texture(ctx, gl, size)
            self._things.append(self.depths)
            self.hits_buffer = ctx.framebuffer([self.hits, *(written if edges == "hits" else [])], self.depths)
            self._things.append(self.hits_buffer)
            kept = self.buffer
            self.keys = ctx.framebuffer([kept.depth])
            self._things.append(self.keys)
            shown = [kept.depth, kept.owner, kept.ids, kept.position, kept.across, kept.colours]
            shown += written if edges == "attributes" else []
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
        self.depths.use(HIT_KEYS["depths"])
        program["depths"] = HIT_KEYS["depths"]
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
