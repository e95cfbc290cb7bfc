"""The G-buffer: what the engine knows about each pixel of the viewport, for VTK's shaders to resolve.

Row 0 is at the bottom, as OpenGL has it. All textures are read with ``texelFetch`` and need no bit casts:

=============  ========  ======================================================================================
texture        format    content
=============  ========  ======================================================================================
``depth``      r32ui     window depth is ``key / 4294967295``; 0xFFFFFFFF where nothing was drawn
``ids``        rg32ui    streamline; unit tangent (data coordinates, octahedral about +x, two snorm16)
``position``   rg32f     point index within the streamline plus the fraction along the segment; per-point value
``across``     r16f      only if asked for: where across a wide line the pixel lies, its distance from the line's axis
                         over half the width, in -1..1; positive to the left of the tangent on the screen
  of tubes     r32ui     their surface's unit normal, packed as the tangent is
  of halos     r16f      1 where a line shows, 0 where its halo does, between at the edge between them
``edges``      r32ui     only if asked for: where the edges of what the pixel shows run (``shaders/frame/edges.glsl``)
``colours``    rgba8     only of spline tubes and lines with halos whose points have colours, and of volumes' light
=============  ========  ======================================================================================

Of volumes that rays are cast through ``position`` holds the place along the ray, mm, and the value there, of surfaces
``ids`` a tangent and ``across`` a normal as of tubes, and ``colours`` light that is not multiplied by its opacity.

``ids``, ``position``, ``across`` and ``edges`` are undefined where ``depth`` is empty.

A float32 has room for fractions up to point 2^23 of a streamline, and for whole points up to 2^24, which is 1.7 km at
0.1 mm. Beyond, places are rounded to every second point, from 2^25 on to every fourth, and so on.
"""

from __future__ import annotations

import moderngl

from .errors import EngineError

EMPTY = 0xFFFFFFFF

RELIEF = {"across": "f2", "ink": "f2", "normal": "u4"}  # type of the texture `across` by its contents


class GBuffer:
    """Textures of one viewport's size."""

    def __init__(self, ctx: moderngl.Context, size: tuple[int, int]) -> None:
        self.size = size  # width and height in pixels
        self.generation = 0  # counts redraws; a reader that saw this number has seen this picture
        limit = int(ctx.info["GL_MAX_TEXTURE_SIZE"])
        if max(size) > limit:
            raise EngineError(
                f"a picture of {size[0]} x {size[1]} pixels is wider or higher than this OpenGL's largest "
                f"texture, {limit}; draw it in tiles"
            )
        self._textures: list[moderngl.Texture] = []
        self.depth = self._texture(ctx, 1, "u4")
        # r32ui, the engine's own: index of the fiblet that each pixel belongs to; of volumes, of the voxel
        self.owner = self._texture(ctx, 1, "u4")
        self.ids = self._texture(ctx, 2, "u4")
        self.position = self._texture(ctx, 2, "f4")
        self.across: moderngl.Texture | None = None  # see `want_relief`, `want_edges` and `want_colours`
        self.edges: moderngl.Texture | None = None
        self.colours: moderngl.Texture | None = None
        self._relief: str | None = None

    def _texture(self, ctx: moderngl.Context, components: int, dtype: str) -> moderngl.Texture:
        try:
            texture = ctx.texture(self.size, components, dtype=dtype)
        except moderngl.Error as error:
            self.release()
            raise EngineError(f"no memory for a picture of {self.size[0]} x {self.size[1]} pixels") from error
        texture.filter = moderngl.NEAREST, moderngl.NEAREST  # integer textures are incomplete otherwise
        self._textures.append(texture)
        return texture

    def want_relief(self, ctx: moderngl.Context, relief: str | None) -> None:
        """Make the texture ``across``: ``'across'`` of lines, ``'normal'`` of tubes, ``'ink'``, or None for none."""
        if relief == self._relief:
            return
        if self.across is not None:
            self._textures.remove(self.across)
            self.across.release()
        self.across = None if relief is None else self._texture(ctx, 1, RELIEF[relief])
        self._relief = relief

    def want_edges(self, ctx: moderngl.Context, wanted: bool) -> None:
        """Make or drop the texture ``edges``."""
        if wanted and self.edges is None:
            self.edges = self._texture(ctx, 1, "u4")
        elif not wanted and self.edges is not None:
            self._textures.remove(self.edges)
            self.edges.release()
            self.edges = None

    def want_colours(self, ctx: moderngl.Context) -> None:
        """Make the texture ``colours``."""
        if self.colours is None:
            self.colours = self._texture(ctx, 4, "f1")

    @property
    def relief(self) -> str | None:
        """The last argument of :meth:`want_relief`."""
        return self._relief

    @property
    def nbytes(self) -> int:
        """Bytes of GPU memory."""
        relief = 0 if self._relief is None else int(RELIEF[self._relief][1])
        colours = 0 if self.colours is None else 4
        edges = 0 if self.edges is None else 4
        return self.size[0] * self.size[1] * (24 + relief + edges + colours)

    def release(self) -> None:
        """Give the textures back; twice is harmless."""
        for texture in self._textures:
            texture.release()
        self._textures.clear()
        self.across = self.edges = self.colours = self._relief = None
