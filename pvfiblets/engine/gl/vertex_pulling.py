"""Vertex pulling: shapes whose vertices a shader makes from their numbers, without vertex data.

A few thousand shapes are drawn a call with one short index buffer for all calls, so that each vertex of a shape is
computed once and an index takes two bytes. Instances would do without it, but software OpenGL and several drivers begin
anew with each of them. Where OpenGL takes calls from a buffer (4.3), the CPU makes one for all.
"""

from __future__ import annotations

import moderngl
import numpy as np
import numpy.typing as npt

from .gl_version import version_of

BATCH = 65536  # vertices of a call: what an index of 16 bits reaches

INDIRECT = 430  # OpenGL from which on one call makes all others

QUAD = np.array([0, 1, 2, 2, 1, 3])  # indices of two triangles between four corners


class PulledShapes:
    """Draws many shapes of one kind."""

    def __init__(
        self,
        ctx: moderngl.Context,
        n_shapes: int,
        shape: npt.NDArray[np.int64] = QUAD,  # (n_indices,) the triangles of one shape
        corners: int = 4,  # vertices of one shape
        first: str = "first_shape",  # the uniform with the number of a call's first shape
    ) -> None:
        self._ctx, self._n, self._first = ctx, n_shapes, first
        self._step, self._indices = BATCH // corners, len(shape)
        self._arrays: dict[moderngl.Program, moderngl.VertexArray] = {}
        count = min(self._step, max(n_shapes, 1))
        indices = (np.arange(count)[:, None] * corners + shape).astype("<u2")
        self.buffers: dict[str, moderngl.Buffer] = {"indices": ctx.buffer(indices.tobytes())}
        if version_of(ctx) >= INDIRECT and n_shapes > self._step:
            self.buffers["commands"] = ctx.buffer(_commands(n_shapes, self._step, len(shape), corners))

    @property
    def primitives(self) -> int:
        """Triangles of all."""
        return self._indices // 3 * self._n

    def draw(self, program: moderngl.Program) -> None:
        """Draw all; the framebuffer is in use, everything bound and the state set."""
        if "commands" in self.buffers:
            self.draw_listed(program, self.buffers["commands"])
            return
        array = self._array(program)
        for first in range(0, self._n, self._step):
            program[self._first] = first
            array.render(moderngl.TRIANGLES, vertices=min(self._step, self._n - first) * self._indices)

    def draw_listed(self, program: moderngl.Program, commands: moderngl.Buffer) -> None:
        """Draw as many as the calls in a buffer say."""
        array = self._array(program)
        program[self._first] = 0
        array.render_indirect(commands, moderngl.TRIANGLES)

    def whole(self, program: moderngl.Program) -> moderngl.VertexArray:
        """Return what draws a program from no vertex data at all, such as over the whole picture."""
        if program not in self._arrays:
            self._arrays[program] = self._ctx.vertex_array(program, [])
        return self._arrays[program]

    def _array(self, program: moderngl.Program) -> moderngl.VertexArray:
        if program not in self._arrays:
            index = self.buffers["indices"]
            self._arrays[program] = self._ctx.vertex_array(program, [], index, index_element_size=2)
        return self._arrays[program]

    def release(self) -> None:
        """Give everything back; twice is harmless."""
        for array in self._arrays.values():
            array.release()
        for buffer in self.buffers.values():
            buffer.release()
        self._arrays.clear()
        self.buffers.clear()


def _commands(n_shapes: int, step: int, indices: int, corners: int) -> bytes:
    """Return the words of all calls as OpenGL has them: indices, instances, first index, first vertex, first instance.

    A vertex's number counts on from a call's first.
    """
    firsts = np.arange(0, n_shapes, step)
    words = np.zeros((len(firsts), 5), "<u4")
    words[:, 0] = np.minimum(n_shapes - firsts, step) * indices
    words[:, 1] = 1
    words[:, 3] = firsts * corners
    return words.tobytes()
