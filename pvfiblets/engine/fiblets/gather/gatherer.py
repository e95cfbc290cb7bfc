"""`Gatherer`: has the lines of each pixel added up (:mod:`.gathering`), and keeps the sums until something changes."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import moderngl
import numpy as np

from ...gl.bindings import GATHERING
from ...gl.delayed_read import DelayedRead
from ..pipelines.constants import GREATEST_SIDE
from .gathering import Gather, Gathered, SliceDistances
from .paint import Paint, set_uniforms

if TYPE_CHECKING:
    from ...gbuffer import GBuffer
    from ...gl.moderngl_extras import GLExtras
    from ...gl.shaders import Programs
    from ..pipelines import DrawRequest, Pipeline


class Gatherer:
    """Adds up what all lines show, and keeps it until something changes."""

    def __init__(
        self, ctx: moderngl.Context, gl: GLExtras, programs: Programs, make: Callable[[], Pipeline] | None = None
    ) -> None:
        self._ctx = ctx
        self._gl = gl
        self._programs = programs
        self._own = None if make is None else make()
        self._held: Gathered | None = None
        self._made: Any = None
        self._squares: tuple[moderngl.Texture, moderngl.Framebuffer] | None = None
        self._greatest: tuple[Any, float] | None = None
        self._asked: Any = None
        self._later = DelayedRead(ctx, gl)

    def render(
        self,
        nearest: GBuffer,
        paint: Paint,
        slices: int,
        distances: SliceDistances,
        make_job: Callable[[], DrawRequest],
        outside: Callable[[], moderngl.Texture | None] | None = None,
        state: Any = None,
    ) -> Gathered:
        """Return the sums of a picture, made unless they are there."""
        key = nearest.generation, nearest.size, paint, slices, distances, state
        if self._held is not None and self._made == key:
            return self._held
        self._made = None
        hides = None if outside is None else outside()
        request = make_job()
        held = self._begin(nearest, paint, slices, distances, self._pipeline.gathers_words(request))
        self._add(request, Gather(held, paint, nearest, hides))
        self._made = key
        return held

    def render_parts(
        self,
        nearest: GBuffer,
        paint: Paint,
        slices: int,
        distances: SliceDistances,
        words: Callable[[], bool],
        add: Callable[[Gathered], None],
        state: Any = None,
    ) -> Gathered:
        """Return the sums of a picture of several parts; each part adds its own."""
        key = None if state is None else (nearest.generation, nearest.size, paint, slices, distances, state)
        if self._held is not None and key is not None and self._made == key:
            return self._held
        self._made = None
        held = self._begin(nearest, paint, slices, distances, words())
        held.clear(self._gl)
        add(held)
        self._made = key or object()
        return held

    def add_to(
        self,
        held: Gathered,
        paint: Paint,
        nearest: GBuffer,
        own: GBuffer,
        request: DrawRequest,
        hides: moderngl.Texture | None,
    ) -> None:
        """Add what the lines of a part show to the sums of all."""
        self._add(request, Gather(held, paint, nearest, hides, own))

    def gathers_words(self, request: DrawRequest) -> bool:
        """Return whether sums for such a request are words, not floats."""
        return self._pipeline.gathers_words(request)

    def _begin(
        self, nearest: GBuffer, paint: Paint, slices: int, distances: SliceDistances, words: bool
    ) -> Gathered:
        held = self._resize(nearest.size, slices, bool(paint.features), words)
        with self._gl.framebuffers_kept():
            held.find_keys(self._ctx, self._programs, nearest, distances)
        return held

    def _add(self, request: DrawRequest, gather: Gather) -> None:
        self._pipeline.gather(replace(request, occlusion=None, gather=gather, across=(), edges=()))

    @property
    def _pipeline(self) -> Pipeline:
        assert self._own is not None
        return self._own

    def _resize(self, size: tuple[int, int], slices: int, painted: bool, words: bool) -> Gathered:
        held = self._held
        if held is None or (held.size, held.slices, held.painted, held.words) != (size, slices, painted, words):
            if held is not None:
                held.release()
                self._held = None
            self._held = held = Gathered(self._ctx, self._gl, size, slices, painted, words)
        return held

    def greatest(self, *, wait: bool = True) -> float:
        """Return the greatest weight of a pixel in the first slice of the last sums."""
        if (came := self._later.arrived()) is not None:
            self._greatest = came[0], float(came[1].max())
        known = self._greatest
        if known is not None and (known[0] == self._made or (not wait and self._asked == self._made)):
            return known[1]
        framebuffer = self._reduce()
        area = (0, 0, *framebuffer.size)
        with self._gl.framebuffers_kept():
            if known is not None and not wait:
                self._asked = self._made if self._later.start(framebuffer, area, 1, self._made) else None
                return known[1]
            found = float(np.frombuffer(framebuffer.read(area, 1, dtype="f4", alignment=1), "<f4").max())
        self._later.forget()
        self._greatest = self._made, found
        return found

    def _reduce(self) -> moderngl.Framebuffer:
        """Draw the greatest weight of each square of pixels."""
        held = self._held
        assert held is not None
        width, height = (-(-side // GREATEST_SIDE) for side in held.size)
        if self._squares is None or self._squares[0].size != (width, height):
            self._drop_squares()
            texture = self._ctx.texture((width, height), 1, dtype="f4")
            self._squares = texture, self._ctx.framebuffer([texture])
        texture, framebuffer = self._squares
        features = [*(["GATHER_WORDS"] if held.words else []), *(["PAINTED"] if held.painted else [])]
        program, array = self._programs.screen("fiblets/gather/greatest.frag", features)
        held.texture.use(GATHERING["gathered"])
        set_uniforms(program, gathered=GATHERING["gathered"], size=held.size, word_shape=held.shape)
        with self._gl.framebuffers_kept():
            self._ctx.enable_only(moderngl.NOTHING)
            framebuffer.use()
            array.render(moderngl.TRIANGLES, vertices=3)
        return framebuffer

    def _drop_squares(self) -> None:
        if self._squares is not None:
            for thing in self._squares[::-1]:
                thing.release()
        self._squares = None

    @property
    def nbytes(self) -> int:
        """Bytes of GPU memory."""
        own = 0 if self._own is None else sum(buffer.size for buffer in self._own.buffers.values())
        squares = 0 if self._squares is None else 4 * math.prod(self._squares[0].size)
        return own + squares + self._later.nbytes + (0 if self._held is None else self._held.nbytes)

    def release(self) -> None:
        """Give everything on the GPU back; twice is harmless."""
        if self._own is not None:
            self._own.release()
        self._later.release()
        self._drop_squares()
        if self._held is not None:
            self._held.release()
        self._held = self._made = self._greatest = None
