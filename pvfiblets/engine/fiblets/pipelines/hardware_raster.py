"""The base of pipelines that draw by OpenGL's own rasteriser: rounds, depth test and attachments.

===============  ===============================================================================================
pass             task
===============  ===============================================================================================
clear            empties depth and owners
visible          two-phase culling: draws fiblets that the last picture showed, or that probably show now
pyramid          two-phase culling: makes the pyramid of that depth, and keeps the owners of pixels
draw             draws the others; without two-phase culling, all
resolve          finds streamline, tangent, place and value of each pixel, of the fiblet and segment that it shows
visibility_bits  two-phase culling: notes, for the next picture, which fiblets own a pixel
===============  ===============================================================================================

Lines are drawn into depth, fiblet and segment, 13 bytes a fragment with a depth buffer of float32, which decides which
fragment is nearest; a full-screen pass finds all else (``shaders/fiblets/hardware_raster/varyings.glsl``). OpenGL
draws in order, fiblet by fiblet, and a fragment must be nearer than the pixel's depth: of two at the same depth the
fiblet with the smaller index stays. The second round comes later than its indices:
``shaders/fiblets/hardware_raster/between.frag`` and ``shade.glsl`` see to it that the picture is the same
as if there were but one. Depths are written as coarse as the keys that these go by.

Whatever the data, the CPU issues the same calls; nothing is read back.
"""

from __future__ import annotations

import abc
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, TypeVar

import moderngl

from ...errors import EngineError
from ...gbuffer import EMPTY, GBuffer
from ...gl.bindings import BETWEEN_ROUNDS, FIBLET_ROUNDS
from ...gl.moderngl_extras import GLExtras, depth_texture
from ...gl.shaders import Programs
from ..data.chunks import Chunk
from .draw_request import DrawRequest

Thing = TypeVar("Thing", moderngl.Texture, moderngl.Framebuffer)


@dataclass(frozen=True)
class Memory:
    """Bytes on the GPU."""

    size: int


class RasterTarget:
    """A G-buffer's textures as attachments, with segments and a depth buffer."""

    def __init__(self, ctx: moderngl.Context, gl: GLExtras, target: GBuffer, two_rounds: bool) -> None:
        self.target = target
        self._gl = gl
        self._things: list[moderngl.Texture | moderngl.Framebuffer] = []
        self.kept: moderngl.Texture | None = None  # rg32ui: depth key and owner after the first round
        self.across, self.edges = target.across, target.edges
        resolved = [target.ids, target.position]
        resolved += [texture for texture in (target.across, target.edges) if texture is not None]
        try:
            self.segment = self._keep(ctx.texture(target.size, 1, dtype="u1"))
            self.segment.filter = moderngl.NEAREST, moderngl.NEAREST
            colours = [target.depth, target.owner, self.segment]
            self.depth = self._keep(depth_texture(ctx, gl, target.size))
            # Framebuffers of the two rounds; the same without two rounds.
            self.first = self.second = self._keep(ctx.framebuffer(colours, self.depth))
            later = self.depth
            if two_rounds:
                later = self._keep(depth_texture(ctx, gl, target.size))
                self.kept = self._keep(ctx.texture(target.size, 2, dtype="u4"))
                self.kept.filter = moderngl.NEAREST, moderngl.NEAREST
                self.second = self._keep(ctx.framebuffer(colours, later))
                self.between = self._keep(ctx.framebuffer([self.kept], later))
            self.resolved = self._keep(ctx.framebuffer(resolved, later))
            self.resolved.depth_mask = False
        except moderngl.Error as error:
            self.release()
            width, height = target.size
            raise EngineError(f"no memory for a picture of {width} x {height} pixels: {error}") from error

    def _keep(self, thing: Thing) -> Thing:
        self._things.append(thing)
        return thing

    def clear(self) -> None:
        """Empty depth and owners; the others are undefined where depth is empty."""
        self._gl.clear_integers(self.first, (EMPTY,), 0)
        self._gl.clear_integers(self.first, (EMPTY,), 1)
        self._gl.clear_depth(self.first, 1.0)

    @property
    def nbytes(self) -> int:
        """Bytes of GPU memory beside the G-buffer's."""
        width, height = self.target.size
        return width * height * (5 if self.kept is None else 17)

    def release(self) -> None:
        """Give everything back, but for the G-buffer; twice is harmless."""
        for thing in reversed(self._things):
            thing.release()
        self._things.clear()


class SeenTexture:
    """Which fiblets own a pixel of the last picture: r8ui, a texel for each fiblet, in rows of a power of two."""

    def __init__(self, ctx: moderngl.Context, gl: GLExtras, programs: Programs, n_fiblets: int) -> None:
        self._ctx = ctx
        self._gl = gl
        self._programs = programs
        limit = int(ctx.info["GL_MAX_TEXTURE_SIZE"])
        self.bits = 10
        while -(-n_fiblets >> self.bits) > limit and 2 << self.bits <= limit:
            self.bits += 1
        rows = max(-(-n_fiblets >> self.bits), 1)
        if rows > limit:
            raise EngineError(
                f"{n_fiblets} fiblets are more than the {limit << self.bits} texels of this OpenGL's largest texture; "
                "draw fewer streamlines"
            )
        self.size = 1 << self.bits, rows
        try:
            self.texture = ctx.texture(self.size, 1, dtype="u1")
        except moderngl.Error as error:
            raise EngineError(f"no GPU memory for {self.nbytes} bytes of marks: {error}") from error
        self.texture.filter = moderngl.NEAREST, moderngl.NEAREST
        self._framebuffer = ctx.framebuffer([self.texture])
        self._array: moderngl.VertexArray | None = None
        gl.clear_integers(self._framebuffer, (0,))

    @property
    def nbytes(self) -> int:
        """Bytes of GPU memory."""
        return self.size[0] * self.size[1]

    def update(self, target: GBuffer) -> None:
        """Mark the owners of a picture, and no others. Leaves its framebuffer bound."""
        self._gl.clear_integers(self._framebuffer, (0,))
        program = self._programs.render(
            {"vertex": "fiblets/hardware_raster/visible.vert", "fragment": "fiblets/hardware_raster/visible.frag"}
        )
        if self._array is None:
            self._array = self._ctx.vertex_array(program, [])
        width, height = target.size
        target.owner.use(FIBLET_ROUNDS["owner"])
        program["owner"] = FIBLET_ROUNDS["owner"]
        program["width"], program["seen_bits"], program["seen_size"] = width, self.bits, self.size
        self._framebuffer.use()
        self._ctx.enable_only(moderngl.NOTHING)
        self._ctx.point_size = 1.0
        self._array.render(moderngl.POINTS, vertices=width * height)

    def release(self) -> None:
        """Give everything on the GPU back; twice is harmless."""
        if self._array is not None:
            self._array.release()
            self._array = None
        self._framebuffer.release()
        self.texture.release()


class RasterPipeline(abc.ABC):
    """Draws chunks into a G-buffer through OpenGL's rasteriser."""

    name: str
    features: tuple[str, ...] = ("TEXTURE_DATA",)
    """Features of all its programs."""

    def __init__(self, ctx: moderngl.Context, gl: GLExtras, programs: Programs, n_fiblets: int) -> None:
        self._ctx = ctx
        self._gl = gl
        self._programs = programs
        self._n_fiblets = n_fiblets
        self._target: RasterTarget | None = None
        self._seen: SeenTexture | None = None
        self._arrays: dict[moderngl.Program, moderngl.VertexArray | None] = {}
        self._resolving: dict[moderngl.Program, moderngl.VertexArray] = {}

    @property
    def buffers(self) -> dict[str, Memory]:
        """Bytes of the depth buffers, and of what two-phase culling keeps."""
        held = {"depth": self._target, "visibility_bits": self._seen}
        return {name: Memory(thing.nbytes) for name, thing in held.items() if thing is not None}

    @abc.abstractmethod
    def _stages(self, request: DrawRequest) -> Mapping[str, str]:
        """Files of the program's stages."""

    def _prepare(self, program: moderngl.Program) -> None:  # noqa: B027 - nothing where bindings stand in the sources
        """Set the samplers of a new program for :meth:`_bind_data`."""

    @abc.abstractmethod
    def _bind_data(self, chunk: Chunk) -> None:
        """Bind a chunk's data."""

    def _array(self, program: moderngl.Program) -> moderngl.VertexArray | None:
        """Return what a program draws with, none where it needs none."""
        return self._ctx.vertex_array(program, [])

    @abc.abstractmethod
    def _draw(self, array: Any, program: Any, chunk: Chunk, request: DrawRequest) -> None:
        """Draw one chunk with a program; its uniform block is bound."""

    def draw(self, request: DrawRequest) -> None:
        """Draw all chunks; the uniform blocks are bound already."""
        passes, culling = request.passes, request.occlusion
        two_rounds = culling is not None and culling.halfway
        target = self._attach(request.target, two_rounds)
        with self._gl.framebuffers_kept(), self._drawing():
            with passes.timed("clear"):
                target.clear()
            if culling is not None and two_rounds:
                if self._seen is None:
                    self._seen = SeenTexture(self._ctx, self._gl, self._programs, self._n_fiblets)
                with passes.timed("visible"):
                    target.first.use()
                    self._round(request, ())
                with passes.timed("pyramid"):
                    culling.build(request.target)
                    self._keep_first_round(target)
            with passes.timed("draw"):
                target.second.use()
                self._round(request, ("SECOND_ROUND",) if two_rounds else ())
            with passes.timed("resolve"):
                target.resolved.use()
                self._resolve(request, target)
                target.second.use()  # which writes depth again
            if self._seen is not None and two_rounds:
                with passes.timed("visibility_bits"):
                    self._seen.update(request.target)

    def gathers_words(self, request: DrawRequest) -> bool:  # noqa: ARG002 - of all pipelines
        """Return False: sums are floats, as OpenGL blends no words."""
        return False

    def gather(self, request: DrawRequest) -> None:
        """Add up what all lines show; the uniform blocks are bound already."""
        assert request.gather is not None
        with request.passes.timed("gather"), self._gl.framebuffers_kept(), self._drawing():
            if request.gather.own is None:
                request.gather.target.clear(self._gl)
            request.gather.target.framebuffer.use()
            self._ctx.blend_equation = moderngl.FUNC_ADD, moderngl.FUNC_ADD
            self._ctx.blend_func = moderngl.ONE, moderngl.ONE
            try:
                self._round(request, ())
            finally:
                self._ctx.blend_func = moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA

    def _attach(self, target: GBuffer, two_rounds: bool) -> RasterTarget:
        held = self._target
        same = held is not None and held.target is target and held.across is target.across
        same = same and held is not None and held.edges is target.edges
        if held is None or not same or (held.kept is not None) != two_rounds:
            if held is not None:
                held.release()
                self._target = None
            self._target = held = RasterTarget(self._ctx, self._gl, target, two_rounds)
        return held

    @contextmanager
    def _drawing(self) -> Iterator[None]:
        """Set what lines and brushes are drawn with, and leave nothing on that others do not expect."""
        ctx = self._ctx
        ctx.line_width = 1.0
        ctx.wireframe = False
        ctx.provoking_vertex = moderngl.LAST_VERTEX_CONVENTION
        try:
            yield
        finally:
            ctx.depth_func = "<="

    def _round(self, request: DrawRequest, features: Sequence[str]) -> None:
        """Draw all chunks with one program."""
        ctx = self._ctx
        program = self._program(request, features)
        if program not in self._arrays:
            self._arrays[program] = self._array(program)
            self._prepare(program)
        array = self._arrays[program]
        self._bind(program, request, features)
        ctx.enable_only(moderngl.DEPTH_TEST if request.gather is None else moderngl.BLEND)
        ctx.depth_func = "<"
        request.kept.bind(program)
        for index, chunk in enumerate(request.chunks):
            chunk.bind_block()
            request.kept.bind_chunk(index)
            self._bind_data(chunk)
            self._draw(array, program, chunk, request)

    def _resolve(self, request: DrawRequest, target: RasterTarget) -> None:
        """Find what pixels show beside their depth, chunk by chunk."""
        data = [feature for feature in self.features if feature == "TEXTURE_DATA"]
        clipping = ("CLIPPING", "CLIPPING_DEPTH") if request.clipping else ()
        drawn = *request.wide, *request.extra, *request.detail, *clipping, *request.cutting
        features = [*data, *request.decoding, *request.values, *drawn]
        stages = {stage: f"fiblets/hardware_raster/resolve.{stage[:4]}" for stage in ("vertex", "fragment")}
        program = self._programs.render(stages, features)
        if program not in self._resolving:
            self._resolving[program] = self._ctx.vertex_array(program, [])
            self._prepare(program)
        array = self._resolving[program]
        for name, texture in (("owner", target.target.owner), ("segment", target.segment)):
            texture.use(FIBLET_ROUNDS[name])
            program[f"shown_{name}"] = FIBLET_ROUNDS[name]
        request.kept.bind(program)
        self._ctx.enable_only(moderngl.DEPTH_TEST)
        self._ctx.depth_func = ">"  # the far plane, where a line lies before it
        for index, chunk in enumerate(request.chunks):
            chunk.bind_block()
            request.kept.bind_chunk(index)
            self._bind_data(chunk)
            array.render(moderngl.TRIANGLES, vertices=3)

    def _program(self, request: DrawRequest, features: Sequence[str]) -> moderngl.Program:
        """Return a round's program."""
        return self._programs.render(self._stages(request), [*self._features(request), *features])

    def _features(self, request: DrawRequest) -> list[str]:
        """Features of the programs that draw lines; values, edges and places across are found by :meth:`_resolve`."""
        culling = (request.occlusion.feature,) if request.occlusion is not None else ()
        clipping = ("CLIPPING", "CLIPPING_DEPTH") if request.clipping else ()
        values = request.values if "PAINTED" in request.gathering else ()
        every = *request.decoding, *values, *request.brush, *request.detail, *clipping, *request.planes
        return [*self.features, *every, *request.culling, *request.peeling, *request.gathering, *culling]

    def _bind(self, program: moderngl.Program, request: DrawRequest, features: Sequence[str]) -> None:
        """Bind what a round's program looks at, and tell it where."""
        if request.occlusion is not None:
            request.occlusion.bind(program)
        if request.peel is not None:
            request.peel.bind(program)
        if request.gather is not None:
            request.gather.bind(program)
        if self._seen is not None and "seen" in program:
            self._seen.texture.use(FIBLET_ROUNDS["seen"])
            program["seen"], program["seen_bits"] = FIBLET_ROUNDS["seen"], self._seen.bits
            program["second_round"] = int("SECOND_ROUND" in features)
        if self._target is not None and self._target.kept is not None and "first_round" in program:
            self._target.kept.use(FIBLET_ROUNDS["first_round"])
            program["first_round"] = FIBLET_ROUNDS["first_round"]

    def _keep_first_round(self, target: RasterTarget) -> None:
        """Keep depth and owner after the first round, and make the depth that the second begins with."""
        ctx = self._ctx
        program, array = self._programs.screen("fiblets/hardware_raster/between.frag")
        for name, texture, unit in (
            ("depth", target.depth, BETWEEN_ROUNDS["depth"]),
            ("depth_key", target.target.depth, BETWEEN_ROUNDS["depth_key"]),
            ("owner", target.target.owner, BETWEEN_ROUNDS["owner"]),
        ):
            texture.use(unit)
            program[name] = unit
        target.between.use()
        ctx.enable_only(moderngl.DEPTH_TEST)
        ctx.depth_func = "1"
        array.render(moderngl.TRIANGLES, vertices=3)

    def release(self) -> None:
        """Give everything on the GPU back; twice is harmless."""
        for array in (*self._arrays.values(), *self._resolving.values()):
            if array is not None:
                array.release()
        self._arrays.clear()
        self._resolving.clear()
        if self._target is not None:
            self._target.release()
            self._target = None
        if self._seen is not None:
            self._seen.release()
            self._seen = None
