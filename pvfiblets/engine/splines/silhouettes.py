"""Geometry around segments, for their fragments: rectangles or boxes, from vertex pulling or the geometry stage.

Vertex pulling draws a few thousand segments a call with one short index buffer for all calls, so that each vertex of a
shape is computed once and an index takes two bytes. Instances would do without it, but software OpenGL and several
drivers begin anew with each of them.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import moderngl
import numpy as np
import numpy.typing as npt

from ..shaders import Programs

__all__ = ["BATCH", "Silhouettes"]

_RECTANGLE = np.array([0, 1, 2, 2, 1, 3])
# Outwards, counter-clockwise: corners by their bits x, y, z.
_BOX = np.array(
    [0, 2, 1, 1, 2, 3, 4, 5, 6, 6, 5, 7, 0, 1, 4, 4, 1, 5, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 5, 3, 7]
)
_SHAPES: dict[str, tuple[str, npt.NDArray[np.int64], int]] = {
    "rectangles": ("splines/rectangles.vert", _RECTANGLE, 4),
    "pulled-boxes": ("splines/boxes.vert", np.concatenate([_BOX, _BOX + 8]), 16),
}
_DEPTH_CLAMP = 0x864F
BATCH = 65536
"""Vertices of a call: what an index of 16 bits reaches."""


class Silhouettes:
    """Draws the segments of one set.

    Parameters
    ----------
    ctx : moderngl.Context
    programs : Programs
    kind : str
        Of :data:`pvfiblets.engine.splines.choices.SILHOUETTES`.
    n_segments : int

    Attributes
    ----------
    primitives : int
        Triangles of one picture.
    """

    def __init__(self, ctx: moderngl.Context, programs: Programs, kind: str, n_segments: int) -> None:
        self._ctx, self._programs, self._n = ctx, programs, n_segments
        self._boxes = kind != "rectangles"
        self._arrays: dict[moderngl.Program, moderngl.VertexArray] = {}
        self.buffers: dict[str, moderngl.Buffer] = {}
        self.stages = {"fragment": "splines/tube.frag"}
        if kind == "boxes":
            self.stages |= {"vertex": "splines/pass.vert", "geometry": "splines/boxes.geom"}
            self._step, self.primitives = n_segments, 24 * n_segments
            return
        stage, shape, corners = _SHAPES[kind]
        self.stages["vertex"] = stage
        self._step, self._per_segment = BATCH // corners, len(shape)
        self.primitives = len(shape) // 3 * n_segments
        count = min(self._step, max(n_segments, 1))
        indices = (np.arange(count)[:, None] * corners + shape).astype("<u2")
        self.buffers["indices"] = ctx.buffer(indices.tobytes())

    def program(self, features: list[str]) -> moderngl.Program:
        """Return the program with some features on."""
        return self._programs.render(self.stages, features)

    def draw(self, program: moderngl.Program) -> None:
        """Draw all segments; the framebuffer is in use and everything bound."""
        array = self._array(program)
        with self._drawing():
            for first in range(0, self._n, self._step):
                program["first_segment"] = first
                count = min(self._step, self._n - first)
                if "indices" in self.buffers:
                    array.render(moderngl.TRIANGLES, vertices=count * self._per_segment)
                else:
                    array.render(moderngl.POINTS, vertices=count)

    def draw_listed(self, program: moderngl.Program, commands: moderngl.Buffer) -> None:
        """Draw rectangles of listed segments, as many as the calls in a buffer say."""
        array = self._array(program)
        with self._drawing():
            program["first_segment"] = 0
            array.render_indirect(commands, moderngl.TRIANGLES)

    def _array(self, program: moderngl.Program) -> moderngl.VertexArray:
        if program not in self._arrays:
            index = self.buffers.get("indices")
            self._arrays[program] = self._ctx.vertex_array(program, [], index, index_element_size=2)
        return self._arrays[program]

    def whole(self, program: moderngl.Program) -> moderngl.VertexArray:
        """Return what draws a program over the whole picture, from no vertex data."""
        if program not in self._arrays:
            self._arrays[program] = self._ctx.vertex_array(program, [])
        return self._arrays[program]

    @contextmanager
    def _drawing(self) -> Iterator[None]:
        """Set what silhouettes are drawn with, and leave nothing on that others do not expect."""
        ctx = self._ctx
        ctx.enable_only(moderngl.DEPTH_TEST | (moderngl.CULL_FACE if self._boxes else moderngl.NOTHING))
        ctx.depth_func = ">"  # depth is the other way round: see shaders/splines/tube.frag
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
        for buffer in self.buffers.values():
            buffer.release()
        self._arrays.clear()
        self.buffers.clear()
