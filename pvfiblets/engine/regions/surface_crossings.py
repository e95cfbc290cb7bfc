"""Closed surfaces as layers of crossings along each pixel's ray, in the format of ``shaders/regions/layers.glsl``.

This work is based on: Bavoil and Myers 2008, "Order independent transparency with dual depth peeling". A layer holds
the nearest and the farthest crossing of front and of back faces each: a convex mesh takes one, and so does a torus.
They are made by blending with MAX, which OpenGL 3.3 has, with the fragments' count added up beside them: the first
layer's count says how many layers there must be, and, at pixels where it exceeds the depths found, that faces coincide
there. Only then is each depth counted by another drawing (``shaders/regions/tally.frag``), as a winding number needs.

Where front and back faces cancel, at silhouettes and shared edges, both are there and the winding number is right.

Budget: 20 bytes a pixel and layer, 16 more where faces coincide. A surface is drawn once a layer, inside the rectangle
of its bounds.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

import moderngl
import numpy as np
import numpy.typing as npt

from ..errors import EngineError, GPUMemoryError
from ..frame import Array
from ..gl.bindings import CROSSINGS
from ..gl.delayed_read import DelayedRead
from ..gl.moderngl_extras import GLExtras
from ..gl.shaders import Programs
from .layer_stack import LayerStack, Rectangle, Squares

if TYPE_CHECKING:
    from ...query.regions.surfaces import Surface

MOST = 4095  # fragments of front or of back faces that a count holds

IN_A_LAYER = 4  # crossings that a layer holds

_INSPECT = "regions/inspect.frag"
_NONE = -3.0
_DEPTH_CLAMP, _CLIP_DISTANCE_0 = 0x864F, 0x3000


@dataclass(frozen=True)
class Peeled:
    """Textures of a surface's layers."""

    rectangle: Rectangle  # pixels that the surface may touch: left, lower, right, upper
    first: int  # numbers of the first, and how many
    layers: int
    tallies: int  # first of its tallies, or -1
    crossings: int


class _Found(NamedTuple):
    """The number of layers needed, the most crossings at a pixel, and whether layers miss any."""

    layers: int
    crossings: int
    shared: bool

    @classmethod
    def from_squares(cls, said: npt.NDArray[np.float32]) -> _Found:
        """Read it from what the squares say, ``(2, n)``."""
        faces, crossings = said
        if faces.max() > MOST:
            raise EngineError(
                f"a ray crosses more than {MOST} faces of a surface, the limit; cut by a simpler surface"
            )
        return cls(int(faces.max() + 1) // 2, int(np.abs(crossings).max()), bool((crossings < 0.0).any()))


def rectangle_of(clip: Array, low: Array, high: Array, size: tuple[int, int]) -> Rectangle:
    """Return the pixels that a box may touch: left, lower, right, upper; all if it reaches behind the eye."""
    corners = np.array(list(np.ndindex(2, 2, 2)), np.float64) * (high - low) + low
    places = corners @ clip[:, :3].T + clip[:, 3]
    if not (places[:, 3] > 1e-6 * np.abs(places[:, 3]).max()).all():
        return 0, 0, *size
    pixels = (places[:, :2] / places[:, 3:] + 1.0) * np.array(size) / 2.0
    if not np.isfinite(pixels).all():
        return 0, 0, *size
    left, lower = np.clip(np.floor(pixels.min(axis=0)) - 1, 0, size).astype(int).tolist()
    right, upper = np.clip(np.ceil(pixels.max(axis=0)) + 1, 0, size).astype(int).tolist()
    return left, lower, max(left, right), max(lower, upper)


class _Mesh:
    """A surface's triangles on the GPU, about the middle of its bounds."""

    def __init__(self, ctx: moderngl.Context, surface: Surface) -> None:
        points = surface.mesh.points
        self.low, self.high = surface.mesh.low, surface.mesh.high
        self.middle = self.low / 2 + self.high / 2
        try:
            self.vertices = ctx.buffer((points - self.middle).astype("<f4").tobytes())
            self.indices = ctx.buffer(np.ascontiguousarray(surface.triangles, "<u4").tobytes())
        except moderngl.Error as error:
            raise GPUMemoryError(f"no memory for a surface of {len(points)} points: {error}") from error
        self.arrays: dict[moderngl.Program, moderngl.VertexArray] = {}

    def array(self, ctx: moderngl.Context, program: moderngl.Program) -> moderngl.VertexArray:
        if program not in self.arrays:
            self.arrays[program] = ctx.vertex_array(program, [(self.vertices, "3f", "position")], self.indices)
        return self.arrays[program]

    @property
    def nbytes(self) -> int:
        return self.vertices.size + self.indices.size

    def release(self) -> None:
        for array in self.arrays.values():
            array.release()
        self.arrays.clear()
        self.vertices.release()
        self.indices.release()


class SurfaceLayers:
    """Draws the layers of a region's surfaces."""

    def __init__(self, ctx: moderngl.Context, gl: GLExtras, programs: Programs) -> None:
        self._ctx = ctx
        self._gl = gl
        self._programs = programs
        self._meshes: dict[int, tuple[object, _Mesh]] = {}
        self._drawn: list[int] = []  # meshes
        self._counts: list[int] = []  # layers of the last picture
        self._room: list[int] = []  # layers that there is room for
        self._known: list[_Found | None] = []  # the most that pictures have had, until one waited
        self._reads: list[DelayedRead] = []
        self._stacks: list[LayerStack] = []  # even layers, odd layers
        self._tallies: LayerStack | None = None
        self._squares = Squares(ctx, gl, programs)

    def draw(
        self,
        surfaces: Sequence[Surface],
        to_clip: Array,
        offset: Array,
        size: tuple[int, int],
        *,
        waits: bool = True,
    ) -> list[Peeled]:
        """Draw all layers of some surfaces. Leaves no framebuffer of the caller's bound, and blending off."""
        self._keep_meshes(surfaces)
        matrices, rectangles = [], []
        for surface in surfaces:
            mesh = self._mesh(surface)
            matrix = to_clip @ _placement(surface, mesh.middle, offset)
            matrices.append(matrix / (np.abs(matrix).max() or 1.0))
            rectangles.append(rectangle_of(matrix, mesh.low - mesh.middle, mesh.high - mesh.middle, size))
        meshes = [id(surface.mesh) for surface in surfaces]
        if meshes != self._drawn:
            self._drawn, self._counts, self._room = meshes, [1] * len(meshes), [1] * len(meshes)
            self._known = [None] * len(meshes)
            self._drop_reads()
            self._reads = [DelayedRead(self._ctx, self._gl) for _ in meshes]
            self._drop_stacks()
        try:
            for k in range(len(meshes)):
                self._learn(k)
            firsts, found = self._draw_all(surfaces, matrices, rectangles, size, waits)
        except BaseException:
            # What was tried must not be where the next picture begins.
            self._drawn = []
            self._drop_stacks()
            raise
        peeled = [
            Peeled(rectangle, first, some.layers, -1, some.crossings)
            for rectangle, first, some in zip(rectangles, firsts, found, strict=False)
        ]
        return self._tally(surfaces, matrices, peeled, [some.shared for some in found])

    def _draw_all(
        self,
        surfaces: Sequence[Surface],
        matrices: list[Array],
        rectangles: list[Rectangle],
        size: tuple[int, int],
        waits: bool,
    ) -> tuple[list[int], list[_Found]]:
        """Draw until there is room for all; return each surface's first layer, and what :meth:`_inspect` says of it."""
        while True:
            firsts = np.cumsum([0, *[(room + 1) // 2 * 2 for room in self._room]]).tolist()
            self._make_room(size, firsts[-1])
            found = [
                self._draw_one(k, self._mesh(surface), matrices[k], rectangles[k], firsts[k], waits)
                for k, surface in enumerate(surfaces)
            ]
            needed = [some.layers for some in found]
            self._counts = [max(layers, 1) for layers in needed]
            if all(layers <= room for layers, room in zip(needed, self._room, strict=True)):
                return firsts, found
            self._room = [max(pair) for pair in zip(needed, self._room, strict=True)]

    def _draw_one(
        self, k: int, mesh: _Mesh, matrix: Array, rectangle: Rectangle, first: int, waits: bool
    ) -> _Found:
        """Draw the number of layers of the last picture, and then the missing ones, as far as there is room."""
        # Returns what `_inspect` does; of earlier pictures, if it must not wait.
        if rectangle[0] == rectangle[2] or rectangle[1] == rectangle[3]:
            return _Found(0, 0, False)
        known = self._known[k]
        if known is not None and not waits:
            if known.layers == 0:  # of none there would be nothing to learn
                known = _Found(1, IN_A_LAYER, known.shared)
            if known.layers <= self._room[k]:  # else there is another call, with more room
                self._peel(mesh, matrix, rectangle, first, range(known.layers))
                self._ask(rectangle, first, known.layers)
                self._squares.ask_later(_INSPECT, rectangle, self._reads[k])
            return known
        count = self._counts[k]
        self._peel(mesh, matrix, rectangle, first, range(count))
        found = self._inspect(rectangle, first, count)
        if count < found.layers <= self._room[k]:
            self._peel(mesh, matrix, rectangle, first, range(count, found.layers))
            found = self._inspect(rectangle, first, found.layers)
        self._known[k] = found
        self._reads[k].forget()
        return found

    def _learn(self, k: int) -> None:
        """Read the results of earlier frames."""
        arrived, known = self._reads[k].arrived(), self._known[k]
        if arrived is not None and known is not None:
            found = _Found.from_squares(arrived[1].reshape(-1, 2).T)
            layers, crossings = max(known.layers, found.layers), max(known.crossings, found.crossings)
            self._known[k] = _Found(layers, crossings, known.shared or found.shared)

    def _mesh(self, surface: Surface) -> _Mesh:
        return self._meshes[id(surface.mesh)][1]

    def _keep_meshes(self, surfaces: Sequence[Surface]) -> None:
        """Keep the meshes of these surfaces, and no others, on the GPU."""
        wanted = {id(surface.mesh): surface for surface in surfaces}
        for key in [key for key in self._meshes if key not in wanted]:
            self._meshes.pop(key)[1].release()
        for key, surface in wanted.items():
            if key not in self._meshes:
                self._meshes[key] = surface.mesh, _Mesh(self._ctx, surface)

    def _make_room(self, size: tuple[int, int], layers: int) -> None:
        held = self._stacks
        if held and held[0].size == size and held[0].layers >= layers // 2:
            return
        self._drop_stacks()
        for _ in range(2):
            held.append(LayerStack(self._ctx, self._gl, size, max(layers // 2, 1), (4, 1)))

    def _program(self, fragment: str, features: Sequence[str], matrix: Array) -> moderngl.Program:
        program = self._programs.render({"vertex": "regions/surface.vert", "fragment": fragment}, features)
        program["clip_from_surface"] = tuple(matrix.T.ravel())
        return program

    def _peel(self, mesh: _Mesh, matrix: Array, rectangle: Rectangle, first: int, wanted: range) -> None:
        """Draw some layers of one surface, whose first is number `first`."""
        ctx = self._ctx
        for layer in range(first + wanted.start, first + wanted.stop):
            program = self._program("regions/peel.frag", ["PEEL"] if layer > first else [], matrix)
            if layer > first:
                before = self._stacks[(layer - 1) & 1]
                for texture, name in zip(before.textures, ("before", "before_end"), strict=True):
                    texture.use(CROSSINGS["layers_even"] + (name == "before_end"))
                    program[name] = CROSSINGS["layers_even"] + (name == "before_end")
                program["layer"] = (layer - 1) >> 1
            framebuffer = self._stacks[layer & 1].framebuffers[layer >> 1]
            self._clear(framebuffer, rectangle, ((_NONE, _NONE, _NONE, 0.0), (_NONE,)))
            with self._drawing((moderngl.MAX, moderngl.FUNC_ADD)):
                mesh.array(ctx, program).render(moderngl.TRIANGLES)

    def _clear(
        self, framebuffer: moderngl.Framebuffer, rectangle: Rectangle, values: Sequence[Sequence[float]]
    ) -> None:
        """Use a framebuffer inside a rectangle and fill its attachments."""
        left, lower, right, upper = rectangle
        framebuffer.scissor = left, lower, right - left, upper - lower
        for attachment, value in enumerate(values):
            self._gl.fill(framebuffer, attachment, value)

    @contextmanager
    def _drawing(self, equations: tuple[int, int]) -> Iterator[None]:
        """Blend; cut at the near plane; clamp beyond the far one."""
        ctx = self._ctx
        ctx.enable_only(moderngl.BLEND)
        ctx.blend_func = moderngl.ONE, moderngl.ONE
        ctx.blend_equation = equations
        ctx.front_face = "ccw"
        ctx.enable_direct(_DEPTH_CLAMP)
        ctx.enable_direct(_CLIP_DISTANCE_0)
        try:
            yield
        finally:
            ctx.disable_direct(_CLIP_DISTANCE_0)
            ctx.disable_direct(_DEPTH_CLAMP)
            ctx.blend_equation = moderngl.FUNC_ADD, moderngl.FUNC_ADD
            ctx.blend_func = moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA
            ctx.enable_only(moderngl.NOTHING)

    def bind(self, program: moderngl.Program) -> None:
        """Bind the layers and tell a program of this module's kind where they are."""
        even, odd = self._stacks
        textures = [*even.textures, *odd.textures, (self._tallies or even).textures[0]]
        for (name, unit), texture in zip(CROSSINGS.items(), textures, strict=True):
            texture.use(unit)
            if name in program:
                program[name] = unit

    def _inspect(self, rectangle: Rectangle, first: int, count: int) -> _Found:
        """Return what a picture's layers hold."""
        self._ask(rectangle, first, count)
        return _Found.from_squares(self._squares.ask(_INSPECT, rectangle).T)

    def _ask(self, rectangle: Rectangle, first: int, count: int) -> None:
        """Get ready to ask that."""
        program = self._squares.program(_INSPECT, rectangle)
        self.bind(program)
        program["base"], program["count"] = first, count

    def _tally(
        self,
        surfaces: Sequence[Surface],
        matrices: Sequence[Array],
        peeled: Sequence[Peeled],
        shared: Sequence[bool],
    ) -> list[Peeled]:
        """Count the fragments of each depth of those surfaces whose faces share some."""
        layers = sum(place.layers for place, some in zip(peeled, shared, strict=True) if some)
        size = self._stacks[0].size
        held = self._tallies
        if held is not None and (layers == 0 or held.size != size or held.layers < layers):
            held.release()
            self._tallies = held = None
        if layers == 0:
            return list(peeled)
        if held is None:
            self._tallies = held = LayerStack(self._ctx, self._gl, size, layers, (4,))
        counted, used = [], 0
        for k, place in enumerate(peeled):
            if not shared[k]:
                counted.append(place)
                continue
            counted.append(replace(place, tallies=used))
            program = self._program("regions/tally.frag", ["PEEL"], matrices[k])
            for layer in range(place.layers):
                self.bind(program)
                program["layer"] = place.first + layer
                self._clear(held.framebuffers[used], place.rectangle, ((0.0, 0.0, 0.0, 0.0),))
                with self._drawing((moderngl.FUNC_ADD, moderngl.FUNC_ADD)):
                    self._mesh(surfaces[k]).array(self._ctx, program).render(moderngl.TRIANGLES)
                used += 1
        return counted

    @property
    def nbytes(self) -> int:
        """Bytes of GPU memory."""
        stacks = [*self._stacks, self._tallies, self._squares, *self._reads]
        meshes = [mesh for _, mesh in self._meshes.values()]
        return sum(thing.nbytes for thing in (*stacks, *meshes) if thing is not None)

    def _drop_stacks(self) -> None:
        for stack in self._stacks:
            stack.release()
        self._stacks.clear()

    def _drop_reads(self) -> None:
        for reads in self._reads:
            reads.release()
        self._reads.clear()

    def release(self) -> None:
        """Give everything on the GPU back; twice is harmless."""
        for _, mesh in self._meshes.values():
            mesh.release()
        self._meshes.clear()
        self._drop_reads()
        self._drop_stacks()
        self._squares.release()
        if self._tallies is not None:
            self._tallies.release()
            self._tallies = None
        self._drawn.clear()


def _placement(surface: Surface, middle: Array, offset: Array) -> Array:
    """Return (4, 4): a mesh's mm about its middle to local mm."""
    inverse = np.linalg.inv(surface.linear)
    placed = np.eye(4)
    placed[:3, :3] = inverse
    placed[:3, 3] = inverse @ middle + (surface.centre - offset)
    return placed
