"""Geometry around segments, for their fragments: rectangles or boxes, from vertex pulling or the geometry stage."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import moderngl
import numpy as np
import numpy.typing as npt

from ..gl.shaders import Programs
from ..gl.vertex_pulling import BATCH, QUAD, PulledShapes

# Outwards, counter-clockwise: corners by their bits x, y, z.
_BOX = np.array(
    [0, 2, 1, 1, 2, 3, 4, 5, 6, 6, 5, 7, 0, 1, 4, 4, 1, 5, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 5, 3, 7]
)
_SHAPES: dict[str, tuple[str, npt.NDArray[np.int64], int]] = {
    "rectangles": ("tubes/rectangles.vert", QUAD, 4),
    "pulled-boxes": ("tubes/boxes.vert", np.concatenate([_BOX, _BOX + 8]), 16),
}
_DEPTH_CLAMP = 0x864F


class ProxyGeometry:
    """Draws the segments of one set; `primitives` are triangles of one picture."""

    def __init__(self, ctx: moderngl.Context, programs: Programs, kind: str, n_segments: int) -> None:
        self._ctx, self._programs, self._n = ctx, programs, n_segments
        self._boxes = kind != "rectangles"
        self._arrays: dict[moderngl.Program, moderngl.VertexArray] = {}
        self._pulled: PulledShapes | None = None
        self.stages = {"fragment": "tubes/tube.frag"}
        if kind == "boxes":
            self.stages |= {"vertex": "tubes/pass.vert", "geometry": "tubes/boxes.geom"}
            self.primitives = 24 * n_segments
            return
        self.stages["vertex"], shape, corners = _SHAPES[kind]
        self._pulled = PulledShapes(ctx, n_segments, shape, corners, "first_segment")
        self.primitives = self._pulled.primitives

    @property
    def buffers(self) -> dict[str, moderngl.Buffer]:
        """What is kept on the GPU, by name."""
        return {} if self._pulled is None else self._pulled.buffers

    def program(self, features: list[str]) -> moderngl.Program:
        """Return the program with some features on."""
        return self._programs.render(self.stages, features)

    def draw(self, program: moderngl.Program) -> None:
        """Draw all segments; the framebuffer is in use and everything bound."""
        with self._drawing():
            if self._pulled is not None:
                self._pulled.draw(program)
                return
            array = self.whole(program)
            for first in range(0, self._n, BATCH):
                program["first_segment"] = first
                array.render(moderngl.POINTS, vertices=min(BATCH, self._n - first))

    def draw_listed(self, program: moderngl.Program, commands: moderngl.Buffer) -> None:
        """Draw rectangles of listed segments, as many as the calls in a buffer say."""
        assert self._pulled is not None
        with self._drawing():
            self._pulled.draw_listed(program, commands)

    def whole(self, program: moderngl.Program) -> moderngl.VertexArray:
        """Return what draws a program from no vertex data, such as over the whole picture."""
        if program not in self._arrays:
            self._arrays[program] = self._ctx.vertex_array(program, [])
        return self._arrays[program]

    @contextmanager
    def _drawing(self) -> Iterator[None]:
        """Set what silhouettes are drawn with, and leave nothing on that others do not expect."""
        ctx = self._ctx
        ctx.enable_only(moderngl.DEPTH_TEST | (moderngl.CULL_FACE if self._boxes else moderngl.NOTHING))
        ctx.depth_func = ">"  # depth is the other way round: see shaders/tubes/tube.frag
        ctx.wireframe = False
        ctx.provoking_vertex = moderngl.LAST_VERTEX_CONVENTION
        if self._boxes:
            # Back faces: the eye may be inside a box. Clamped, they are there even beyond the far plane.
            ctx.front_face, ctx.cull_face = "ccw", "front"
            ctx.enable_direct(_DEPTH_CLAMP)
        try:
            yield
        finally:
            if self._boxes:
                ctx.disable_direct(_DEPTH_CLAMP)
                ctx.cull_face = "back"
            ctx.depth_func = "<="

    def release(self) -> None:
        """Give everything back; twice is harmless."""
        for array in self._arrays.values():
            array.release()
        if self._pulled is not None:
            self._pulled.release()
        self._arrays.clear()
