"""`RayTarget`: a G-buffer that rays are cast into, and for sparse casting a mark on pixels that want rays."""

from __future__ import annotations

import moderngl

from ..errors import EngineError
from ..gbuffer import GBuffer


class RayTarget:
    """A G-buffer and its framebuffer."""

    def __init__(
        self, ctx: moderngl.Context, size: tuple[int, int], relief: str | None, *, coloured: bool, marked: bool
    ) -> None:
        self._marks: moderngl.Renderbuffer | None = None
        self.buffer = GBuffer(ctx, size)
        self.buffer.want_relief(ctx, relief)
        if coloured:
            self.buffer.want_colours(ctx)
        kept = self.buffer
        shown = [kept.depth, kept.owner, kept.ids, kept.position, kept.across, kept.colours]
        try:
            if marked:
                self._marks = ctx.depth_renderbuffer(size)
            self.framebuffer = ctx.framebuffer([texture for texture in shown if texture is not None], self._marks)
        except moderngl.Error as error:
            self.buffer.release()
            raise EngineError(f"no memory for a picture of {size[0]} x {size[1]} pixels: {error}") from error

    @property
    def nbytes(self) -> int:
        """Bytes of GPU memory."""
        width, height = self.buffer.size
        return self.buffer.nbytes + (0 if self._marks is None else 4 * width * height)

    def release(self) -> None:
        """Give everything back; twice is harmless."""
        self.framebuffer.release()
        if self._marks is not None:
            self._marks.release()
            self._marks = None
        self.buffer.release()
