"""Depth peeling: several layers of a picture, the nearest first, for translucent lines.

Layer 0 is the picture itself. Layer k is drawn like a picture, but of every pixel only the part behind layer k - 1
(``shaders/fiblets/segments/peel.glsl``; the method is depth peeling, Everitt 2001): so there is no order to sort lines
into, and no pixel depends on the order of streamlines. All layers together are exact as far as they
reach; lines behind the last one are missing.

Each layer is drawn from all fiblets in the view volume. What hides a fiblet of a layer is that layer's own depth so
far, by two-phase culling as of the picture itself; what the last picture's same layer showed is drawn first. So each
layer has a pipeline and a pyramid of its own. The layers are kept until the picture changes.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

import moderngl

from ...errors import EngineError
from ...gbuffer import GBuffer
from .layered_buffer import LayeredBuffer, Peel

if TYPE_CHECKING:
    from ...culling import Occlusion
    from ...gl.moderngl_extras import GLExtras
    from ...gl.shaders import Programs
    from ...view import View
    from ..pipelines import DrawRequest, Pipeline
    from ..style import FibletStyle

MOST_LAYERS = 64


class _Stage:
    """The renderer of one layer, with its last picture."""

    def __init__(self, ctx: moderngl.Context, pipeline: Pipeline, occlusion: Occlusion | None) -> None:
        self._ctx = ctx
        self.pipeline = pipeline
        self.occlusion = occlusion
        self.target: GBuffer | None = None

    def draw(self, request: DrawRequest, peel: Peel, view: View, style: FibletStyle) -> GBuffer:
        """Draw the lines behind some layers."""
        if self.target is not None and self.target.size != request.target.size:
            self.target.release()
            self.target = None
        if self.target is None:
            self.target = GBuffer(self._ctx, request.target.size)
        try:
            self.target.want_relief(self._ctx, request.target.relief)
        except EngineError:
            self.target = None  # its textures are given back
            raise
        if self.occlusion is not None:
            self.occlusion.before(self.target, view, style)
        self.pipeline.draw(replace(request, target=self.target, occlusion=self.occlusion, peel=peel))
        if self.occlusion is not None:
            self.occlusion.after(self.target, view, style)
        self.target.generation += 1
        return self.target

    @property
    def nbytes(self) -> int:
        """Bytes of GPU memory."""
        held = sum(buffer.size for buffer in self.pipeline.buffers.values())
        return held + sum(thing.nbytes for thing in (self.target, self.occlusion) if thing is not None)

    def release(self) -> None:
        """Give everything on the GPU back; twice is harmless."""
        self.pipeline.release()
        for thing in (self.target, self.occlusion):
            if thing is not None:
                thing.release()
        self.target = None


class Layers:
    """Draws layers behind a picture and keeps them."""

    def __init__(
        self,
        ctx: moderngl.Context,
        gl: GLExtras,
        programs: Programs,
        make: Callable[[], tuple[Pipeline, Occlusion | None]],  # makes a pipeline and its culling, if it has any
    ) -> None:
        self._ctx = ctx
        self._gl = gl
        self._programs = programs
        self._make = make
        self._stages: list[_Stage] = []
        self._held: LayeredBuffer | None = None
        self._drawn: tuple[int, int] | None = None

    def render(
        self, nearest: GBuffer, count: int, view: View, style: FibletStyle, make_job: Callable[[], DrawRequest]
    ) -> LayeredBuffer:
        """Return the layers of a picture, drawn unless they are there."""
        if not 2 <= count <= MOST_LAYERS:
            raise ValueError(f"{count} layers are not possible; give 2 to {MOST_LAYERS}")
        if self._held is not None and self._drawn == (nearest.generation, count):
            return self._held
        self._drawn = None
        held = self._resize(nearest, count)
        while len(self._stages) < count - 1:
            self._stages.append(_Stage(self._ctx, *self._make()))
        while len(self._stages) >= count:
            self._stages.pop().release()
        request = make_job()
        held.keep(self._ctx, self._gl, self._programs, nearest, 0)
        for layer, stage in enumerate(self._stages, 1):
            drawn = stage.draw(request, Peel(held, layer), view, style)
            held.keep(self._ctx, self._gl, self._programs, drawn, layer)
        self._drawn = nearest.generation, count
        return held

    def _resize(self, nearest: GBuffer, count: int) -> LayeredBuffer:
        """Return textures for a picture like this one."""
        held = self._held
        wanted = nearest.size, count, nearest.relief
        if held is None or (held.size, held.count, held.relief) != wanted:
            if held is not None:
                held.release()
                self._held = None
            self._held = held = LayeredBuffer(self._ctx, self._gl, nearest, count)
        return held

    @property
    def nbytes(self) -> int:
        """Bytes of GPU memory."""
        held = 0 if self._held is None else self._held.nbytes
        return held + sum(stage.nbytes for stage in self._stages)

    def release(self) -> None:
        """Give everything on the GPU back; twice is harmless."""
        for stage in self._stages:
            stage.release()
        self._stages.clear()
        if self._held is not None:
            self._held.release()
        self._held = self._drawn = None
