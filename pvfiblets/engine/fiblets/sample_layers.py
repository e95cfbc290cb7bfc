"""`SampleLayers`: sixteen samples of every pixel, drawn at once, as layers of the lines that they show.

Fiblets are decoded once for all samples of a pixel, which lie side by side in a picture four times as wide and high
(``FEATURE_SUBSAMPLES``): each has a depth test of its own. The samples of a pixel that show the same fiblet are lit
once: layer k holds each pixel's line with the k-th most samples, and their share of the pixel. Several sets, and the
parts of a set that is drawn in parts, are drawn one after the other into the same samples.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import ExitStack
from copy import copy
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING

import moderngl
import numpy as np

from ..drawable import AnyResource
from ..errors import EngineError
from ..gbuffer import EMPTY, GBuffer
from ..gl.bindings import SAMPLE_LAYER
from ..gl.moderngl_extras import GLExtras
from ..gl.queries import Query
from ..gl.shaders import Programs
from ..view import View
from .parts.part_pictures import PictureTarget, textures_of
from .style import FibletStyle

if TYPE_CHECKING:
    from .pipelines import ComputePipeline, DrawRequest

__all__ = ["LAYERS", "SAMPLES", "Layer", "SampleLayers", "SampledLines", "draw_samples"]

SIDE = 4
SAMPLES = SIDE * SIDE
LAYERS = 4
"""Lines that a pixel may show; samples of others count in proportion to these. Each is lit in a frame of its own."""

WHOLE = 2**16
"""Share of a layer that is alone in a pixel."""

MOST_TEXELS = 2**23
"""Samples that are kept at a time: 24 bytes each, of several sets twice."""

MOST_SETS = 2**15

Rectangle = tuple[int, int, int, int]


@dataclass(frozen=True)
class SampledLines:
    """Lines of a set, or of a part of it, as a picture shows them.

    Attributes
    ----------
    view : View
    style : FibletStyle
    rectangle : tuple of 4 ints
        x, y, width, height of the part of the picture in which any of them can be.
    draw : callable
        Draws the samples of a part of the picture, whose view, style and G-buffer it is given, and yields where it
        waits.
    """

    view: View
    style: FibletStyle
    rectangle: Rectangle
    draw: Callable[[View, FibletStyle, GBuffer], Iterator[None]]


@dataclass(frozen=True)
class Layer:
    """A line of each pixel.

    Attributes
    ----------
    shares : moderngl.Texture
        Of each pixel, in parts of `WHOLE`, in 17 bits; 0 where the layer has none.
    of : callable
        Returns the picture of what it shows of a set, by number. It holds until that of another set is asked for.
    """

    shares: moderngl.Texture
    of: Callable[[int], GBuffer]


class _Buffers:
    """A picture of samples, made anew for another size."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx
        self._made: GBuffer | None = None

    def of(self, size: tuple[int, int]) -> GBuffer:
        """Return one for pixels of a size."""
        if self._made is None or self._made.size != _times(SIDE, size):
            self.release()
            self._made = GBuffer(self._ctx, _times(SIDE, size))
        return self._made

    def release(self) -> None:
        """Give it back; twice is harmless."""
        if self._made is not None:
            self._made.release()
            self._made = None


class _Together:
    """Samples of several sets or parts in one picture, and what draws into it."""

    def __init__(self, ctx: moderngl.Context, gl: GLExtras, size: tuple[int, int]) -> None:
        self._gl = gl
        with ExitStack() as held:
            self.picture = GBuffer(ctx, size)
            held.callback(self.picture.release)
            try:
                depths = ctx.depth_renderbuffer(size)
                held.callback(depths.release)
                self.framebuffer = ctx.framebuffer(list(textures_of(self.picture).values()), depths)
                held.callback(self.framebuffer.release)
                self._depths = ctx.framebuffer(depth_attachment=depths)
                held.callback(self._depths.release)
            except moderngl.Error as error:
                raise EngineError(f"no memory for samples of {size[0]} x {size[1]} pixels") from error
            self.release = held.pop_all().close

    def clear(self) -> None:
        """Begin with nothing."""
        with self._gl.framebuffers_kept():
            self._depths.clear(depth=1.0)
        for attachment in (0, 1):
            self._gl.clear_integers(self.framebuffer, (EMPTY,), attachment)


class SampleLayers:
    """The layers of one picture, drawn once.

    Parameters
    ----------
    ctx : moderngl.Context
    gl : GLExtras
    programs : Programs
    """

    def __init__(self, ctx: moderngl.Context, gl: GLExtras, programs: Programs) -> None:
        self._ctx = ctx
        self._gl = gl
        self._programs = programs
        self._targets: list[PictureTarget] = []
        self._sets = 1
        self._depths: tuple[moderngl.Texture, moderngl.Framebuffer] | None = None
        self._shown = Query(gl, "samples")
        self._held = ExitStack()  # until all is drawn; a generator may be closed when the context is gone

    def draw(self, sets: Sequence[Sequence[SampledLines]]) -> Iterator[float | Layer]:
        """Draw once, part by part; yield the share of the work that is done after each, at last the layers.

        Parameters
        ----------
        sets : sequence of sequence of SampledLines
            The parts of each set. Of two lines at one depth the one of the later set or part shows.

        Raises
        ------
        EngineError
            If memory does not suffice, or there are more than `MOST_SETS` sets.
        """
        self._sets = len(sets)
        if len(sets) > MOST_SETS:
            raise EngineError(f"{len(sets)} sets are more than samples at once can tell apart; hide some")
        lines = [(number, part) for number, parts in enumerate(sets) for part in parts]
        whole = lines[0][1].view.size
        size, corners = _parts(_union([one.rectangle for _, one in lines]), MOST_TEXELS // min(len(lines), 2))
        drawn = self._keep(_Buffers(self._ctx))
        entries, listed = _target(self._ctx, size, 4)
        self._keep(entries)
        self._keep(listed)
        kept = self._keep(_Together(self._ctx, self._gl, _times(SIDE, size))) if len(lines) > 1 else None
        steps = len(corners) * len(lines)
        for part, corner in enumerate(corners):
            self._ctx.scissor = None
            if kept is not None:
                kept.clear()
            for step, (number, one) in enumerate(lines, part * len(lines)):
                place = _common(one.rectangle, (*corner, *size)) if kept is not None else (*corner, *size)
                if place is not None:
                    picture = drawn.of(place[2:])
                    for _ in one.draw(*_subsampled(one, place[:2], picture.size), picture):
                        yield step / steps
                    if kept is not None:
                        begin = place[0] - corner[0], place[1] - corner[1]
                        self._merge(picture, kept, _times(SIDE, begin), number)
                if step + 1 < (part + 1) * len(lines):
                    yield (step + 1) / steps
            with self._gl.framebuffers_kept():
                self._sort(whole, drawn.of(size) if kept is None else kept.picture, entries, listed, corner)
            yield (part + 1) / len(corners)
        self._held.close()
        for target in self._targets:
            yield Layer(target.picture.owner, partial(self._of_set, target.picture))

    def _keep(self, kept: AnyResource) -> AnyResource:
        self._held.callback(kept.release)
        return kept

    def _merge(self, drawn: GBuffer, kept: _Together, corner: tuple[int, int], number: int) -> None:
        """Put samples of a set to those before, where they are nearer."""
        program, array = self._programs.screen("fiblets/samples/merge.frag", [])
        _use(program, {f"drawn_{name}": getattr(drawn, name) for name in ("depth", "ids", "position")})
        program["corner"], program["set"] = corner, number
        self._ctx.scissor = None
        self._ctx.enable_only(moderngl.DEPTH_TEST)
        self._ctx.depth_func = "<="
        with self._gl.framebuffers_kept():
            kept.framebuffer.use()
            kept.framebuffer.viewport = (*corner, *drawn.size)
            array.render(moderngl.TRIANGLES, vertices=3)

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
        _use(program, {f"drawn_{name}": getattr(samples, name) for name in ("depth", "owner", "ids")})
        program["several"] = int(self._sets > 1)
        listed.use()
        array.render(moderngl.TRIANGLES, vertices=3)
        program, array = self._programs.screen("fiblets/samples/layer.frag", [])
        drawn = {f"drawn_{name}": getattr(samples, name) for name in ("depth", "owner", "ids", "position")}
        _use(program, {"entries": entries, **drawn})
        program["corner"], program["several"] = corner, int(self._sets > 1)
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

    def _of_set(self, layer: GBuffer, number: int) -> GBuffer:
        """Return what a layer shows of a set: all of it if there is no other."""
        if self._sets == 1:
            return layer
        if self._depths is None:
            self._depths = _target(self._ctx, layer.size, 1)
        of_set = copy(layer)
        of_set.depth, framebuffer = self._depths
        program, array = self._programs.screen("fiblets/samples/of_set.frag", [])
        _use(program, {"drawn_depth": layer.depth, "shares": layer.owner})
        program["set"] = number
        self._ctx.scissor = None
        self._ctx.enable_only(moderngl.NOTHING)
        with self._gl.framebuffers_kept():
            framebuffer.use()
            array.render(moderngl.TRIANGLES, vertices=3)
        return of_set

    def _made(self, size: tuple[int, int]) -> PictureTarget:
        target = PictureTarget(self._ctx, size, None, edges=False)
        # Around what is drawn, all samples of a pixel show nothing.
        for attachment, value in enumerate((EMPTY, 0 if self._targets else WHOLE)):
            self._gl.clear_integers(target.framebuffer, (value,), attachment)
        return target

    @property
    def nbytes(self) -> int:
        """Bytes of GPU memory."""
        depths = 0 if self._depths is None else 4 * self._depths[0].size[0] * self._depths[0].size[1]
        return sum(target.picture.nbytes for target in self._targets) + depths

    def release(self) -> None:
        """Give everything on the GPU back; twice is harmless."""
        self._held.close()
        self._shown.release()
        while self._targets:
            self._targets.pop().release()
        for texture in self._depths or ():
            texture.release()
        self._depths = None


def draw_samples(ctx: moderngl.Context, pipeline: ComputePipeline, wanted: DrawRequest) -> None:
    """Draw samples (``FEATURE_SUBSAMPLES``), and leave alone what marks those fiblets that the last picture shows."""
    marks = pipeline.buffers["visibility_bits"]
    kept = ctx.buffer(reserve=marks.size)
    _copy(ctx, kept, marks)
    try:
        pipeline.draw(replace(wanted, samples=("SUBSAMPLES",)))
    finally:
        _copy(ctx, marks, kept)
        kept.release()


def _copy(ctx: moderngl.Context, target: moderngl.Buffer, source: moderngl.Buffer) -> None:
    ctx.memory_barrier(moderngl.BUFFER_UPDATE_BARRIER_BIT)
    ctx.copy_buffer(target, source)
    ctx.memory_barrier(moderngl.SHADER_STORAGE_BARRIER_BIT | moderngl.COMMAND_BARRIER_BIT)


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


def _union(rectangles: Iterable[Rectangle]) -> Rectangle:
    """Return the least rectangle that holds all."""
    left, low, right, top = zip(*((x, y, x + width, y + height) for x, y, width, height in rectangles), strict=True)
    return min(left), min(low), max(right) - min(left), max(top) - min(low)


def _common(one: Rectangle, other: Rectangle) -> Rectangle | None:
    """Return what two rectangles share."""
    x, y = (max(one[axis], other[axis]) for axis in (0, 1))
    width, height = (min(r[axis] + r[axis + 2] for r in (one, other)) - low for axis, low in enumerate((x, y)))
    return (x, y, width, height) if width > 0 and height > 0 else None


def _times(factor: int, pair: tuple[int, int]) -> tuple[int, int]:
    return factor * pair[0], factor * pair[1]


def _parts(rectangle: Rectangle, most: int) -> tuple[tuple[int, int], list[tuple[int, int]]]:
    """Return the size of parts that hold a rectangle, and where each begins."""
    x, y = rectangle[:2]
    width, height = (max(side, 1) for side in rectangle[2:])  # beside the picture there is none
    parts = math.ceil(SAMPLES * width * height / most)
    rows = min(math.ceil(math.sqrt(parts * height / width)), height)
    columns = min(math.ceil(parts / rows), width)
    size = -(-width // columns), -(-height // rows)
    return size, [(x + size[0] * i, y + size[1] * j) for j in range(rows) for i in range(columns)]


def _subsampled(lines: SampledLines, corner: tuple[int, int], size: tuple[int, int]) -> tuple[View, FibletStyle]:
    """Return view and style of the part of a picture from a pixel on, of `size` samples that are drawn as pixels."""
    view, style = lines.view, lines.style
    width, tolerance = SIDE * style.line_width, SIDE * style.tolerance
    matrix = np.eye(4)
    for axis in (0, 1):
        scale = SIDE * view.size[axis] / size[axis]
        matrix[axis, axis] = scale
        matrix[axis, 3] = scale * (1.0 - 2.0 * corner[axis] / view.size[axis]) - 1.0
    part = replace(view, size=size, model_view_projection=matrix @ view.model_view_projection)
    return part, replace(style, line_width=width, edges=False, exact=True, tolerance=tolerance)
