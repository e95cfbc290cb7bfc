"""Lengths of fiblets measured on the GPU, by compute or, before OpenGL 4.3, by transform feedback.

Both run ``shaders/fiblets/attributes/measure.glsl``, and decode with the shaders that draw: arc length is that of the
points that are seen.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Protocol

import moderngl
import numpy as np
import numpy.typing as npt

from ...gl.bindings import BLOCKS, MEASURE_STORAGE
from ...gl.moderngl_extras import GLExtras
from ...gl.passes import GROUP_SIZE, dispatch, nowhere
from ...gl.shaders import Programs
from .chunks import Chunk, storage_buffer
from .data_textures import DataTextures, set_data_samplers

BATCH = 1 << 16  # fiblets measured at a time


class Measurer(Protocol):
    """Measures the fiblets of a chunk."""

    def measure(self, chunk: Chunk, features: Sequence[str]) -> npt.NDArray[np.float32]:
        """Return the length of each, ``(n_fiblets,)`` mm; the blocks 0, 1 and 4 are bound already."""
        ...


@contextmanager
def _batches(ctx: moderngl.Context, n: int) -> Iterator[tuple[moderngl.Buffer, range]]:
    """Scratch for a batch, and where batches start."""
    scratch = storage_buffer(ctx, bytes(min(BATCH, n) * 4), "measures")
    try:
        yield scratch, range(0, n, BATCH)
    finally:
        scratch.release()


def _rows(scratch: moderngl.Buffer, size: int) -> npt.NDArray[np.float32]:
    return np.frombuffer(scratch.read(size * 4), "<f4")


class ComputeMeasurer:
    """Measures by a compute shader (OpenGL 4.3)."""

    def __init__(self, ctx: moderngl.Context, programs: Programs, max_groups: int) -> None:
        self._ctx = ctx
        self._programs = programs
        self._max_groups = max_groups  # work groups per axis of a dispatch

    def measure(self, chunk: Chunk, features: Sequence[str]) -> npt.NDArray[np.float32]:
        """See :meth:`Measurer.measure`."""
        program = self._programs.compute("fiblets/compute/measure.comp", features)
        chunk.bind_storage()
        rows = np.empty(chunk.n_fiblets, "<f4")
        with _batches(self._ctx, chunk.n_fiblets) as (scratch, starts):
            scratch.bind_to_storage_buffer(MEASURE_STORAGE["measures"])
            for first in starts:
                size = min(BATCH, chunk.n_fiblets - first)
                program["batch_first"], program["batch_size"] = first, size
                dispatch(program, -(-size // GROUP_SIZE), self._max_groups)
                self._ctx.memory_barrier(moderngl.ALL_BARRIER_BITS)
                rows[first : first + size] = _rows(scratch, size)
        return rows


class FeedbackMeasurer:
    """Measures by transform feedback (OpenGL 3.3), with data from buffer textures."""

    def __init__(self, ctx: moderngl.Context, gl: GLExtras, programs: Programs) -> None:
        self._ctx = ctx
        self._gl = gl
        self._programs = programs

    def measure(self, chunk: Chunk, features: Sequence[str]) -> npt.NDArray[np.float32]:
        """See :meth:`Measurer.measure`."""
        stages = {"vertex": "fiblets/hardware_raster/measure.vert"}
        program = self._programs.render(stages, [*features, "TEXTURE_DATA"], varyings=("fiblet_length",))
        set_data_samplers(self._gl, program)
        data = DataTextures(self._gl, chunk)
        array = self._ctx.vertex_array(program, [])
        rows = np.empty(chunk.n_fiblets, "<f4")
        try:
            with nowhere(self._ctx, self._gl), _batches(self._ctx, chunk.n_fiblets) as (scratch, starts):
                chunk.buffers["chunk"].bind_to_uniform_block(BLOCKS["Chunk"])
                data.bind()
                for first in starts:
                    size = min(BATCH, chunk.n_fiblets - first)
                    program["batch_first"] = first
                    array.transform(scratch, moderngl.POINTS, vertices=size)
                    rows[first : first + size] = _rows(scratch, size)
        finally:
            array.release()
            data.release()
        return rows
