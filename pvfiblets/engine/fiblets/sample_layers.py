"""`SampleLayers`: sixteen samples of every pixel, drawn at once, as layers of the lines that they show.

Fiblets are decoded once for all samples of a pixel, which lie side by side in a picture four times as wide and high
(``FEATURE_SUBSAMPLES``): each has a depth test of its own. The samples of a pixel that show the same fiblet are lit
once: layer k holds each pixel's fiblet with the k-th most samples, and how many these are.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from typing import TYPE_CHECKING

import moderngl
import numpy as np

from ..errors import EngineError
from ..gbuffer import EMPTY, GBuffer
from ..gl.bindings import SAMPLE_LAYER
from ..gl.moderngl_extras import GLExtras
from ..gl.queries import Query
from ..gl.shaders import Programs
from ..view import View
from .parts.part_pictures import PictureTarget
from .pipelines import ComputePipeline, DrawRequest
from .style import FibletStyle

if TYPE_CHECKING:
    from collections.abc import Sequence

__all__ = ["LAYERS", "SAMPLES", "SampleLayers"]

SIDE = 4
SAMPLES = SIDE * SIDE
LAYERS = 4
"""Lines that a pixel may show; samples of others count in proportion to these. Each is lit in a frame of its own."""

WHOLE = 2**16
"""Share of a layer that is alone in a pixel."""

MOST_TEXELS = 2**23
"""Samples that are drawn at a time: 24 bytes each."""

Rectangle = tuple[int, int, int, int]


class SampleLayers:
    """The layers of one picture.

    Parameters
    ----------
    ctx : moderngl.Context
    gl : GLExtras
    programs : Programs

    Attributes
    ----------
    layers : list of GBuffer
        Their ``owner`` is the layer's share of a pixel, in parts of `WHOLE`; 0 where it has none.
    """

    def __init__(self, ctx: moderngl.Context, gl: GLExtras, programs: Programs) -> None:
        self._ctx = ctx
        self._gl = gl
        self._programs = programs
        self._targets: list[PictureTarget] = []
        self._shown = Query(gl, "samples")

    @property
    def layers(self) -> Sequence[GBuffer]:
        """The pictures of the layers."""
        return [target.picture for target in self._targets]

    def draw(
        self,
        view: View,
        style: FibletStyle,
        rectangle: Rectangle,
        request: Callable[[View, FibletStyle, GBuffer], DrawRequest],
        pipeline: ComputePipeline,
    ) -> Iterator[float]:
        """Draw anew, part by part; yield the share of the work that is done after each."""
        self._drop_layers()
        size, tiles = _tiles(rectangle)
        sub = replace(style, line_width=SIDE * style.line_width, exact=True, tolerance=SIDE * style.tolerance)
        with ExitStack() as held:
            samples = GBuffer(self._ctx, (SIDE * size[0], SIDE * size[1]))
            held.callback(samples.release)
            entries, listed = _target(self._ctx, size, 4)
            held.callback(entries.release)
            held.callback(listed.release)
            undo = held.enter_context(ExitStack())
            undo.callback(self._drop_layers)
            for done, corner in enumerate(tiles, start=1):
                wanted = request(_part(view, corner, size), sub, samples)
                with self._marks_kept(pipeline):
                    pipeline.draw(replace(wanted, occlusion=None, samples=("SUBSAMPLES",)))
                with self._gl.framebuffers_kept():
                    self._sort(view.size, samples, entries, listed, corner)
                yield done / len(tiles)
            undo.pop_all()

    @contextmanager
    def _marks_kept(self, pipeline: ComputePipeline) -> Iterator[None]:
        """Lend what marks those fiblets as seen that the last picture shows, which are also so in the end."""
        marks = pipeline.buffers["visibility_bits"]
        kept = self._ctx.buffer(reserve=marks.size)
        self._copy(kept, marks)
        try:
            yield
        finally:
            self._copy(marks, kept)
            kept.release()

    def _copy(self, target: moderngl.Buffer, source: moderngl.Buffer) -> None:
        self._ctx.memory_barrier(moderngl.BUFFER_UPDATE_BARRIER_BIT)
        self._ctx.copy_buffer(target, source)
        self._ctx.memory_barrier(moderngl.SHADER_STORAGE_BARRIER_BIT | moderngl.COMMAND_BARRIER_BIT)

    def _sort(
        self,
        size: tuple[int, int],
        samples: GBuffer,
        entries: moderngl.Texture,
        listed: moderngl.Framebuffer,
        corner: tuple[int, int],
    ) -> None:
        """Put the samples of one part of the picture into layers."""
        self._ctx.enable_only(moderngl.NOTHING)
        self._ctx.scissor = None
        program, array = self._programs.screen("fiblets/samples/entries.frag", [])
        _use(program, {"owner": samples.owner, "drawn_ids": samples.ids})
        listed.use()
        array.render(moderngl.TRIANGLES, vertices=3)
        program, array = self._programs.screen("fiblets/samples/layer.frag", [])
        drawn = {"drawn_depth": samples.depth, "drawn_ids": samples.ids, "drawn_position": samples.position}
        _use(program, {"entries": entries, **drawn})
        program["corner"] = corner
        for number in range(LAYERS):
            if number == len(self._targets):
                self._targets.append(self._made(size))
            program["layer"], program["layers"] = number, LAYERS
            target = self._targets[number].framebuffer
            target.use()
            target.viewport = (*corner, *entries.size)
            with self._shown:
                array.render(moderngl.TRIANGLES, vertices=3)
            if not self._shown.value():
                break

    def _made(self, size: tuple[int, int]) -> PictureTarget:
        target = PictureTarget(self._ctx, size, None, edges=False)
        # Around what is drawn, all samples of a pixel show nothing.
        for attachment, value in enumerate((EMPTY, 0 if self._targets else WHOLE)):
            self._gl.clear_integers(target.framebuffer, (value,), attachment)
        return target

    @property
    def nbytes(self) -> int:
        """Bytes of GPU memory."""
        return sum(layer.nbytes for layer in self.layers)

    def release(self) -> None:
        """Give everything on the GPU back; twice is harmless."""
        self._drop_layers()
        self._shown.release()

    def _drop_layers(self) -> None:
        while self._targets:
            self._targets.pop().release()


def _use(program: moderngl.Program, textures: dict[str, moderngl.Texture]) -> None:
    for name, texture in textures.items():
        texture.use(SAMPLE_LAYER[name])
        program[name] = SAMPLE_LAYER[name]


def _target(
    ctx: moderngl.Context, size: tuple[int, int], components: int
) -> tuple[moderngl.Texture, moderngl.Framebuffer]:
    """Return a texture of words, and what draws into it."""
    try:
        texture = ctx.texture(size, components, dtype="u4")
        texture.filter = moderngl.NEAREST, moderngl.NEAREST
        return texture, ctx.framebuffer([texture])
    except moderngl.Error as error:
        raise EngineError(f"no memory for {SAMPLES} samples of {size[0]} x {size[1]} pixels") from error


def _tiles(rectangle: Rectangle) -> tuple[tuple[int, int], list[tuple[int, int]]]:
    """Return the size of parts that hold a rectangle, and where each begins."""
    x, y, width, height = rectangle
    parts = math.ceil(SAMPLES * width * height / MOST_TEXELS)
    rows = min(math.ceil(math.sqrt(parts * height / width)), height)
    columns = min(math.ceil(parts / rows), width)
    size = -(-width // columns), -(-height // rows)
    return size, [(x + size[0] * i, y + size[1] * j) for j in range(rows) for i in range(columns)]


def _part(view: View, corner: tuple[int, int], size: tuple[int, int]) -> View:
    """Return the view of a part of a picture, whose samples are its pixels."""
    matrix = np.eye(4)
    for axis in (0, 1):
        scale = view.size[axis] / size[axis]
        matrix[axis, axis] = scale
        matrix[axis, 3] = scale * (1.0 - 2.0 * corner[axis] / view.size[axis]) - 1.0
    return replace(
        view, size=(SIDE * size[0], SIDE * size[1]), model_view_projection=matrix @ view.model_view_projection
    )
