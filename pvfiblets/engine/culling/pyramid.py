"""Depth pyramids of two-phase culling: the farthest depth of ever larger squares of pixels.

Level k of the texture holds the greatest depth key of squares of 2^(k+1) pixels. Sides are powers of two, so that a
square's four parts are whole; texels outside the picture are never read. Made by compute shaders, six levels at once,
or, before OpenGL 4.3 and by software, to which barriers are dear, by drawing.
"""

from __future__ import annotations

from typing import Any

import moderngl

from ..gbuffer import GBuffer
from ..gl.bindings import CULLING
from ..gl.gl_version import version_of
from ..gl.moderngl_extras import GLExtras
from ..gl.passes import is_software
from ..gl.program_uniforms import set_uniforms
from ..gl.shaders import Programs
from ..view import Style, View

SMALLEST = 8
"""Pixels of the smallest level's longer side: larger squares hide nothing that smaller ones do not."""


COMPUTE = 430
AT_ONCE, TILE = 6, 64
"""Levels that a dispatch makes, and the side of its work groups' squares."""

PREDICTION_LEVEL = 4
"""Level of the visibility prediction, squares of 32 pixels. Finer levels draw less early, but leave more to be
tested."""


class _Levels:
    """A texture of all levels, and a framebuffer for each if they are drawn."""

    def __init__(self, ctx: moderngl.Context, gl: GLExtras, size: tuple[int, int], drawn: bool) -> None:
        sides = tuple(max(1 << (n - 1).bit_length() >> 1, 1) for n in size)
        self.count = max(1, (max(sides) // SMALLEST).bit_length())
        self.texture = ctx.texture((sides[0], sides[1]), 1, dtype="u4")
        self.texture.filter = moderngl.NEAREST, moderngl.NEAREST
        gl.add_levels(self.texture, self.count)
        self.framebuffers = []
        for level in range(self.count if drawn else 0):
            framebuffer = ctx.framebuffer([self.texture])
            gl.attach_level(framebuffer, self.texture, level)
            self.framebuffers.append(framebuffer)

    @property
    def nbytes(self) -> int:
        width, height = self.texture.size
        return sum(4 * max(1, width >> level) * max(1, height >> level) for level in range(self.count))

    def release(self) -> None:
        for framebuffer in self.framebuffers:
            framebuffer.release()
        self.framebuffers.clear()
        self.texture.release()


class DepthPyramid:
    """Built of a G-buffer's depth: of this picture's so far, and of the last picture's."""

    feature = "CULL_PYRAMID"
    halfway = True

    def __init__(self, ctx: moderngl.Context, gl: GLExtras, programs: Programs) -> None:
        self._ctx = ctx
        self._gl = gl
        self._programs = programs
        self._computes = version_of(ctx) >= COMPUTE and not is_software(ctx)
        self._size = (0, 0)
        self._now: _Levels | None = None
        self._last: _Levels | None = None
        self.predicts = False  # Whether there is a last picture from which a pipeline may predict the first draws
        self.outside: moderngl.Texture | None = None  # Depth of other things in the scene, which hides too

    def _resize(self, size: tuple[int, int]) -> None:
        if size != self._size:
            self.release()
            self._now = _Levels(self._ctx, self._gl, size, not self._computes)
            self._size = size

    def before(self, target: GBuffer, view: View, style: Style) -> None:  # noqa: ARG002 - as of all kinds
        """Make the last picture's pyramid, if any of this size: fiblets that it does not hide are drawn early."""
        self._resize(target.size)
        self.predicts = target.generation > 0
        if self.predicts:
            if self._last is None:
                self._last = _Levels(self._ctx, self._gl, target.size, not self._computes)
            self._build(self._last, target)

    def forget(self) -> None:
        """Do nothing: the current picture alone decides which fiblets are hidden."""

    def after(self, target: GBuffer, view: View, style: Style) -> None:
        """Do nothing: the next picture asks for its own."""

    def build(self, target: GBuffer) -> None:
        """Make the pyramid of the depth so far."""
        self._resize(target.size)
        assert self._now is not None
        self._build(self._now, target)

    def _build(self, levels: _Levels, target: GBuffer) -> None:
        if self._computes:
            self._compute(levels, target)
        else:
            self._draw(levels, target)

    def _compute(self, levels: _Levels, target: GBuffer) -> None:
        """Make six levels by a dispatch. Leaves image units bound."""
        width, height = target.size
        for first in range(0, levels.count, AT_ONCE):
            made = min(AT_ONCE, levels.count - first)
            features = self._bind_scene(first)
            (target.depth if first == 0 else levels.texture).use(CULLING["occlusion"])
            program = self._programs.compute("culling/pyramid_reduce.comp", features)
            set_uniforms(
                program, source=CULLING["occlusion"], source_level=max(first - 1, 0), outside=CULLING["outside"],
                last=(width - 1, height - 1), levels=made,
            )  # fmt: skip
            for unit in range(made):
                levels.texture.bind_to_image(unit, read=False, write=True, level=first + unit)
            width, height = -(-width // TILE), -(-height // TILE)
            program.run(width, height)
            self._ctx.memory_barrier(moderngl.TEXTURE_FETCH_BARRIER_BIT)

    def _bind_scene(self, level: int) -> list[str]:
        """Bind the scene's depth where a level is made of it; return the features of its program."""
        if level or self.outside is None:
            return []
        self.outside.use(CULLING["outside"])
        return ["SCENE_DEPTH"]

    def _draw(self, levels: _Levels, target: GBuffer) -> None:
        """Make level after level by drawing."""
        with self._gl.framebuffers_kept():  # one of ours must not stay bound when it is released
            self._ctx.enable_only(moderngl.NOTHING)
            width, height = target.size
            for level, framebuffer in enumerate(levels.framebuffers):
                program, array = self._programs.screen("culling/pyramid_reduce.frag", self._bind_scene(level))
                set_uniforms(program, source=CULLING["occlusion"], outside=CULLING["outside"])
                if level == 0:
                    target.depth.use(CULLING["occlusion"])
                else:
                    self._gl.limit_levels(levels.texture, level - 1, level - 1, CULLING["occlusion"])
                set_uniforms(program, last=(width - 1, height - 1))
                width, height = (width + 1) // 2, (height + 1) // 2
                framebuffer.viewport = (0, 0, width, height)
                framebuffer.use()
                array.render(moderngl.TRIANGLES, vertices=3)
            self._gl.limit_levels(levels.texture, 0, levels.count - 1)

    def bind(self, program: Any) -> None:
        """Bind what a program looks at, and tell it where it is."""
        assert self._now is not None
        last = self._last if self.predicts else None
        self._now.texture.use(CULLING["occlusion"])
        (last or self._now).texture.use(CULLING["last"])
        set_uniforms(
            program, pyramid=CULLING["occlusion"], pyramid_levels=self._now.count, last_pyramid=CULLING["last"],
            prediction_level=-1 if last is None else min(PREDICTION_LEVEL, last.count - 1),
        )  # fmt: skip

    @property
    def texture(self) -> moderngl.Texture:
        """All levels of the depth so far; level k holds squares of 2^(k+1) pixels."""
        assert self._now is not None
        return self._now.texture

    @property
    def levels(self) -> int:
        """Number of levels."""
        return 0 if self._now is None else self._now.count

    @property
    def nbytes(self) -> int:
        """Bytes of GPU memory."""
        return sum(levels.nbytes for levels in (self._now, self._last) if levels is not None)

    def release(self) -> None:
        """Give everything on the GPU back; twice is harmless."""
        for levels in (self._now, self._last):
            if levels is not None:
                levels.release()
        self._now = self._last = None
        self._size = (0, 0)
