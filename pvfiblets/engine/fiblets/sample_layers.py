"""`SampleLayers`: sixteen samples of every pixel, drawn at once, as layers of the lines that they show.

Fiblets are decoded once for all samples of a pixel, which lie side by side in a picture four times as wide and high
(``FEATURE_SUBSAMPLES``): each has a depth test of its own. The samples of a pixel that show the same fiblet are lit
once: layer k holds each pixel's line with the k-th most samples, and their share of the pixel. Several sets, and the
parts of a set that is drawn in parts, are drawn one after the other into the same samples: what earlier ones hide of
later ones is culled. All else in the scene, such as meshes, is drawn before, sample by sample (`OtherSamples`):
it hides lines by its depths, and its colours are added up where no line shows.
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

from ..errors import EngineError
from ..gbuffer import EMPTY, GBuffer
from ..gl.bindings import SAMPLE_LAYER
from ..gl.moderngl_extras import GLExtras
from ..gl.queries import Query
from ..gl.shaders import Programs
from ..view import View
from .parts.part_pictures import PictureTarget
from .style import FibletStyle

if TYPE_CHECKING:
    from .pipelines import ComputePipeline, DrawRequest

__all__ = ["LAYERS", "SAMPLES", "Layer", "OtherSamples", "SampleLayers", "SampledLines", "draw_samples"]

SIDE = 4
SAMPLES = SIDE * SIDE
LAYERS = 4
"""Lines that a pixel may show; samples of others count in proportion to these. Each is lit in a frame of its own."""

WHOLE = 2**16
"""Share of a layer that is alone in a pixel."""

MOST_TEXELS = 2**23
"""Samples that are kept at a time: 24 bytes each, 28 of several sets."""

MOST_SETS = 2**15 - 1

NO_SET = MOST_SETS  # number of a sample without a line

Rectangle = tuple[int, int, int, int]


@dataclass(frozen=True)
class SampledLines:
    """Lines of a set, or of a part of it, as a picture shows them."""

    view: View
    style: FibletStyle
    rectangle: Rectangle  # x, y, width, height of the part of the picture in which any of them can be
    # Draws the samples of a part of the picture, whose view, style and G-buffer it is given, and yields where it waits.
    # The fourth argument says whether nearer samples in the G-buffer stay; otherwise it begins with none. Then the
    # owner is `EMPTY` where these lines do not show.
    draw: Callable[[View, FibletStyle, GBuffer, bool], Iterator[None]]


@dataclass(frozen=True)
class OtherSamples:
    """Samples of all in a scene but the lines: 4 x 4 pictures side by side, each of one sample of every pixel."""

    colours: moderngl.Texture
    depths: moderngl.Texture  # window depths, float32


@dataclass(frozen=True)
class Layer:
    """A line of each pixel."""

    shares: moderngl.Texture  # of each pixel, in parts of `WHOLE`, in 17 bits; 0 where the layer has none
    # Returns the picture of what it shows of a set, by number. It holds until that of another set is asked for.
    of: Callable[[int], GBuffer]
    # What `OtherSamples` add to each pixel where no line shows. Without, samples that show no line have a share of the
    # first layer.
    others: moderngl.Texture | None = None


class SampleLayers:
    """The layers of one picture, drawn once."""

    def __init__(self, ctx: moderngl.Context, gl: GLExtras, programs: Programs) -> None:
        self._ctx = ctx
        self._gl = gl
        self._programs = programs
        self._targets: list[PictureTarget] = []
        self._sets = 1
        self._depths: tuple[moderngl.Texture, moderngl.Framebuffer] | None = None
        self._rest: tuple[moderngl.Texture, moderngl.Framebuffer] | None = None  # of others
        self._shown = Query(gl, "samples")
        self._held = ExitStack()  # until all is drawn; a generator may be closed when the context is gone

    def draw(
        self, sets: Sequence[Sequence[SampledLines]], others: OtherSamples | None = None
    ) -> Iterator[float | Layer]:
        """Draw once, part by part; yield the share of the work that is done after each, at last the layers."""
        # Of two lines at one depth the one of the later set or part shows.
        self._sets = len(sets)
        if len(sets) > MOST_SETS:
            raise EngineError(f"{len(sets)} sets are more than samples at once can tell apart; hide some")
        lines = [(number, part) for number, parts in enumerate(sets) for part in parts]
        whole = lines[0][1].view.size
        size, corners = _parts(_union([one.rectangle for _, one in lines]), MOST_TEXELS)
        samples = GBuffer(self._ctx, _times(SIDE, size))
        self._held.callback(samples.release)
        entries, listed = self._target(size, 4)
        claims = len(sets) > 1 or others is not None
        of_sets, claimed = self._target(samples.size, 1) if claims else (samples.owner, None)
        if others is not None:
            depths = self._ctx.framebuffer([samples.depth])
            self._held.callback(depths.release)
            self._rest = _target(self._ctx, whole, 4, "f4")
            self._add_others(others, None, (0, 0), whole)
        steps = len(corners) * len(lines)
        for part, corner in enumerate(corners):
            if claimed is not None:
                self._gl.clear_integers(claimed, (NO_SET,))
            if others is not None:
                self._begin_with(others, depths, corner, whole)
            adds = others is not None
            for step, (number, one) in enumerate(lines, part * len(lines)):
                last = step + 1 == (part + 1) * len(lines)
                if _meet(one.rectangle, (*corner, *size)) or (last and not adds):
                    self._ctx.scissor = None
                    for _ in one.draw(*_subsampled(one, corner, samples.size), samples, adds):
                        yield step / steps
                    adds = True
                    if claimed is not None:
                        self._claim(samples, claimed, number)
                if not last:
                    yield (step + 1) / steps
            with self._gl.framebuffers_kept():
                self._sort(whole, samples, of_sets, entries, listed, corner)
            if others is not None:
                self._add_others(others, of_sets, corner, whole)
            yield (part + 1) / len(corners)
        self._held.close()
        rest = None if self._rest is None else self._rest[0]
        for target in self._targets:
            yield Layer(target.picture.owner, partial(self._of_set, target.picture), rest)
            rest = None

    def _begin_with(
        self, others: OtherSamples, depths: moderngl.Framebuffer, corner: tuple[int, int], whole: tuple[int, int]
    ) -> None:
        """Have samples of a part of the picture begin with the depths of others."""
        program, array = self._programs.screen("fiblets/samples/begin.frag", [])
        _use(program, {"other_depths": others.depths})
        program["corner"], program["picture"] = corner, whole
        self._ctx.scissor = None
        self._ctx.enable_only(moderngl.NOTHING)
        with self._gl.framebuffers_kept():
            depths.use()
            array.render(moderngl.TRIANGLES, vertices=3)

    def _add_others(
        self, others: OtherSamples, of_sets: moderngl.Texture | None, corner: tuple[int, int], whole: tuple[int, int]
    ) -> None:
        """Add up others' colours where no line shows: in a part of the picture, or in one without lines."""
        assert self._rest is not None
        program, array = self._programs.screen("fiblets/samples/others.frag", [])
        _use(program, {"other_colours": others.colours} | ({} if of_sets is None else {"drawn_set": of_sets}))
        program["picture"], program["corner"], program["lines"] = whole, corner, int(of_sets is not None)
        size = whole if of_sets is None else (of_sets.width // SIDE, of_sets.height // SIDE)
        self._ctx.scissor = None
        self._ctx.enable_only(moderngl.NOTHING)
        with self._gl.framebuffers_kept():
            target = self._rest[1]
            target.use()
            target.viewport = (*corner, *size)
            array.render(moderngl.TRIANGLES, vertices=3)

    def _target(self, size: tuple[int, int], components: int) -> tuple[moderngl.Texture, moderngl.Framebuffer]:
        """Return a texture that is held until all is drawn, and what draws into it."""
        target = _target(self._ctx, size, components)
        for one in target:
            self._held.callback(one.release)
        return target

    def _claim(self, samples: GBuffer, claimed: moderngl.Framebuffer, number: int) -> None:
        """Write a set's number to the samples that it has just taken."""
        program, array = self._programs.screen("fiblets/samples/claim.frag", [])
        _use(program, {"drawn_owner": samples.owner})
        program["set"] = number
        self._ctx.scissor = None
        self._ctx.enable_only(moderngl.NOTHING)
        with self._gl.framebuffers_kept():
            claimed.use()
            array.render(moderngl.TRIANGLES, vertices=3)

    def _sort(
        self,
        size: tuple[int, int],
        samples: GBuffer,
        sets: moderngl.Texture,
        entries: moderngl.Texture,
        listed: moderngl.Framebuffer,
        corner: tuple[int, int],
    ) -> None:
        """Put the samples of one part of the picture into layers."""
        self._ctx.enable_only(moderngl.NOTHING)
        self._ctx.scissor = None
        program, array = self._programs.screen("fiblets/samples/entries.frag", [])
        drawn = {"drawn_depth": samples.depth, "drawn_ids": samples.ids, "drawn_set": sets}
        _use(program, drawn)
        claimed, others = int(self._sets > 1 or self._rest is not None), int(self._rest is not None)
        program["claimed"] = claimed
        listed.use()
        array.render(moderngl.TRIANGLES, vertices=3)
        program, array = self._programs.screen("fiblets/samples/layer.frag", [])
        _use(program, {"entries": entries, "drawn_position": samples.position, **drawn})
        program["corner"], program["claimed"], program["others"] = corner, claimed, others
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
        # Samples around the lines show nothing, or others, which have no share of a layer.
        for attachment, value in enumerate((EMPTY, 0 if self._targets or self._rest else WHOLE)):
            self._gl.clear_integers(target.framebuffer, (value,), attachment)
        return target

    @property
    def nbytes(self) -> int:
        """Bytes of GPU memory."""
        kept = [(4, self._depths), (16, self._rest)]
        more = sum(texel * held[0].width * held[0].height for texel, held in kept if held is not None)
        return sum(target.picture.nbytes for target in self._targets) + more

    def release(self) -> None:
        """Give everything on the GPU back; twice is harmless."""
        self._held.close()
        self._shown.release()
        while self._targets:
            self._targets.pop().release()
        for thing in (*(self._depths or ()), *(self._rest or ())):
            thing.release()
        self._depths = self._rest = None


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
    ctx: moderngl.Context, size: tuple[int, int], components: int, dtype: str = "u4"
) -> tuple[moderngl.Texture, moderngl.Framebuffer]:
    """Return a texture, and what draws into it."""
    try:
        texture = ctx.texture(size, components, dtype=dtype)
        texture.filter = moderngl.NEAREST, moderngl.NEAREST
        return texture, ctx.framebuffer([texture])
    except moderngl.Error as error:
        raise EngineError(f"no memory for {SAMPLES} samples of {size[0]} x {size[1]} pixels") from error


def _union(rectangles: Iterable[Rectangle]) -> Rectangle:
    """Return the least rectangle that holds all."""
    left, low, right, top = zip(*((x, y, x + width, y + height) for x, y, width, height in rectangles), strict=True)
    return min(left), min(low), max(right) - min(left), max(top) - min(low)


def _meet(one: Rectangle, other: Rectangle) -> bool:
    """Say whether two rectangles have a pixel in common."""
    return all(
        max(one[axis], other[axis]) < min(one[axis] + one[axis + 2], other[axis] + other[axis + 2]) for axis in (0, 1)
    )


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
