"""`PartPictures`: what parts of a set show, put together pixel by pixel, the nearest in front.

A set's picture is, in each pixel, the nearest of its fiblets; so is the nearest of its parts' pictures. Of two at one
depth the part of the lower order is taken (`shaders/fiblets/parts/nearer.frag`). Where parts are consecutive fiblets
and their order is their number, or parts are of whole streamlines that are coded in their order and streamlines decide,
every bit is that of the whole set's picture, but for ``owner``.
"""

from __future__ import annotations

import moderngl

from ...errors import EngineError
from ...gbuffer import EMPTY, GBuffer
from ...gl.bindings import NEARER_PART
from ...gl.moderngl_extras import GLExtras
from ...gl.shaders import Programs


class PictureTarget:
    """A G-buffer and what draws into it."""

    def __init__(self, ctx: moderngl.Context, size: tuple[int, int], relief: str | None, edges: bool) -> None:
        self.picture = GBuffer(ctx, size)
        self.picture.want_relief(ctx, relief)
        self.picture.want_edges(ctx, edges)
        try:
            self.framebuffer = ctx.framebuffer(list(_textures_of(self.picture).values()))
        except moderngl.Error as error:
            self.picture.release()
            raise EngineError(f"no memory for a picture of {size[0]} x {size[1]} pixels: {error}") from error

    def release(self) -> None:
        """Give both back."""
        self.framebuffer.release()
        self.picture.release()


class PartPictures:
    """Puts pictures of parts together."""

    def __init__(self, ctx: moderngl.Context, gl: GLExtras, programs: Programs) -> None:
        self._ctx = ctx
        self._gl = gl
        self._programs = programs
        self._key: tuple[tuple[int, int], str | None, bool] | None = None
        self._kept: list[PictureTarget] = []

    def begin(self, size: tuple[int, int], relief: str | None, edges: bool) -> None:
        """Begin with nothing, in a picture of that size and kind."""
        if self._key != (size, relief, edges):
            self.release()
            for _ in range(2):
                self._kept.append(PictureTarget(self._ctx, size, relief, edges))
            self._key = size, relief, edges
        for attachment in (0, 1):  # depth and owner; the others are undefined where depth is empty
            self._gl.clear_integers(self._kept[0].framebuffer, (EMPTY,), attachment)

    @property
    def picture(self) -> GBuffer:
        """The picture so far."""
        return self._kept[0].picture

    def add(self, drawn: GBuffer, order: int, *, by_streamline: bool = False) -> None:
        """Add the picture of one part more."""
        assert self._key is not None
        _, relief, edges = self._key
        features = [*([] if relief is None else ["CROSS_LINE"]), *(["TUBES"] if relief == "normal" else [])]
        features += ["EDGES"] if edges else []
        program, array = self._programs.screen("fiblets/parts/nearer.frag", features)
        there, other = self._kept
        for of, picture in (("kept", there.picture), ("drawn", drawn)):
            for name, texture in _textures_of(picture).items():
                if (sampler := f"{of}_{name}") in program:
                    texture.use(NEARER_PART[sampler])
                    program[sampler] = NEARER_PART[sampler]
        program["order"], program["by_streamline"] = order, int(by_streamline)
        with self._gl.framebuffers_kept():
            self._ctx.enable_only(moderngl.NOTHING)
            other.framebuffer.use()
            array.render(moderngl.TRIANGLES, vertices=3)
        self._kept.reverse()

    @property
    def nbytes(self) -> int:
        """Bytes of GPU memory."""
        return sum(kept.picture.nbytes for kept in self._kept)

    def release(self) -> None:
        """Give the pictures back; twice is harmless."""
        while self._kept:
            self._kept.pop().release()
        self._key = None


def _textures_of(picture: GBuffer) -> dict[str, moderngl.Texture]:
    """Textures of a picture of fiblets, by name, as they are attached."""
    found = {"depth": picture.depth, "owner": picture.owner, "ids": picture.ids, "position": picture.position}
    if picture.across is not None:
        found["across"] = picture.across
    if picture.edges is not None:
        found["edges"] = picture.edges
    return found
