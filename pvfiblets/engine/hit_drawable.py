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
from .hit_target import HitTarget

if TYPE_CHECKING:
    from .regions.region_cut import RegionCut


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
