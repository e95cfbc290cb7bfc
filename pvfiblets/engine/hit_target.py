"""Drawables of two passes: hits with their depth first, then the G-buffer made of them.

Spline tubes and lines with halos are drawn into it; `HitDrawable` is what their renderers share.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, ClassVar

import moderngl
import numpy as np
import numpy.typing as npt

from .culling.two_phase_items import LEAST_SEGMENTS, Listing, supports_listing
from .drawable import AnyStyle, Drawable
from .errors import EngineError
from .gbuffer import EMPTY, GBuffer
from .gl.bindings import HIT_KEYS
from .gl.moderngl_extras import GLExtras, depth_texture
from .gl.shaders import Programs

if TYPE_CHECKING:
    from .regions.region_cut import RegionCut


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


class HitDrawable(Drawable[AnyStyle]):
    """A `Drawable` that finds hits and their depths first, and all else in one pass over the picture."""

    CULLING: ClassVar[tuple[str | None, ...]] = ("two-phase", None)  # methods of occlusion culling

    RELIEF: ClassVar[str] = "normal"  # contents of `GBuffer.across`

    EDGES: ClassVar[str] = "attributes"  # pass that writes `GBuffer.edges`, if requested: `'hits'` or `'attributes'`

    SAMPLERS: ClassVar[Mapping[str, int]]  # texture units of the data, by the names of their samplers

    _listing: Listing | None = None
    _listed = False  # whether the last picture was drawn from lists
    _filtering: npt.NDArray[np.bool_] | None = None
    _region: RegionCut

    @property
    def filtering(self) -> npt.NDArray[np.bool_] | None:
        """Which segments or points are drawn, ``(n,)``; None for all."""
        return self._filtering

    @filtering.setter
    def filtering(self, wanted: npt.NDArray[np.bool_] | None) -> None:
        self._filtering = wanted
        self._outdate()

    @classmethod
    def _check_culling(cls, culling: str | None) -> None:
        if culling not in cls.CULLING:
            raise ValueError(f"culling is {culling!r}; choose one of {cls.CULLING}")

    def _make_listing(self, culling: str | None, n: int, n_items: int, **how: Any) -> None:
        """Set up occlusion culling, where it is requested, possible, and worth it for ``n`` segments."""
        if culling is not None and n >= LEAST_SEGMENTS and supports_listing(self._ctx):
            self._listing = self._keep(Listing(self._ctx, self._gl, self._programs, n_items, **how))

    def _hit_target(self, size: tuple[int, int], *, coloured: bool, edges: bool) -> HitTarget:
        """Return what the next picture is drawn into."""
        writer = self.EDGES if edges else None
        key = size, coloured, writer
        ctx, gl = self._ctx, self._gl
        return self._fitting("gbuffer", key, lambda: HitTarget(ctx, gl, size, coloured, self.RELIEF, writer))

    def _draw_hits(
        self,
        target: HitTarget,
        render: Callable[[moderngl.Buffer | None], None],
        *,
        name: str,
        n_items: int,
        shown: moderngl.Texture,
        listing: Listing | None,
        cleared: Sequence[int] = (),
    ) -> None:
        """Draw what the depth buffer keeps."""
        self._listed = listing is not None
        if listing is not None:
            with self._passes.timed("last picture"):
                listing.before(target, shown)
        with self._passes.timed("clear"):
            target.clear()
            if cleared:
                self._gl.clear_integers(target.hits_buffer, tuple(cleared), 0)
        if listing is not None:
            listing.draw(target, self._passes, self._prepare_listing, render)
        elif n_items:
            with self._passes.timed(name):
                render(None)

    def _find_attributes(
        self,
        target: HitTarget,
        fragment: str,
        features: Sequence[str],
        whole: Callable[[moderngl.Program], moderngl.VertexArray],
        textures: Sequence[tuple[str, moderngl.Texture, int]],
        **uniforms: Any,
    ) -> None:
        """Find all else of the pixels that show something."""
        with self._passes.timed("attributes"):
            program = self._programs.render({"vertex": "screen/near.vert", "fragment": fragment}, features)
            self._prepare(program)
            for name, texture, unit in textures:
                texture.use(unit)
                program[name] = unit
            for name, value in uniforms.items():
                if name in program:
                    program[name] = value
            target.attributes.use()
            self._ctx.enable_only(moderngl.DEPTH_TEST)
            self._ctx.depth_func = "<"
            whole(program).render(moderngl.TRIANGLES, vertices=3)
            self._ctx.depth_func = "<="

    def _prepare(self, program: moderngl.Program | moderngl.ComputeShader) -> None:
        """Set the data's texture units in a program."""
        for sampler, unit in self.SAMPLERS.items():
            self._gl.set_sampler(program, sampler, unit)
        self._region.bind(program)

    def _prepare_listing(self, program: moderngl.ComputeShader) -> None:
        """Set everything that a program that lists items needs of them."""
        self._prepare(program)
