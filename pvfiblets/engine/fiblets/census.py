"""Counts of a picture's fiblets, made on demand.

=============  ==================================================================================================
count          meaning
=============  ==================================================================================================
``total``      fiblets on the GPU
``in_frustum`` those whose capsules reach into the view volume, on the kept side of the caller's planes
``drawn``      fiblets of these that culling kept; None where a pipeline does not remember them
``visible``    fiblets that own a pixel
=============  ==================================================================================================
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import moderngl
import numpy as np

from ..gbuffer import EMPTY, GBuffer
from ..gl.bindings import BLOCKS, COUNT_STORAGE
from ..gl.moderngl_extras import GLExtras
from ..gl.passes import GROUP_SIZE, dispatch, nowhere
from ..gl.queries import Query
from ..gl.shaders import Programs
from .data.chunks import Chunk, storage_buffer
from .data.data_textures import DataTextures, set_data_samplers
from .pipelines import ComputePipeline

if TYPE_CHECKING:
    from .pipelines import Pipeline
    from .visibility import Visibility


class Census:
    """Counts fiblets on one context."""

    def __init__(self, ctx: moderngl.Context, gl: GLExtras, programs: Programs, max_groups: int) -> None:
        self._ctx = ctx
        self._gl = gl
        self._programs = programs
        self._max_groups = max_groups  # work groups per axis of a dispatch; 0 where there are no compute shaders

    def count(
        self, chunks: Sequence[Chunk], features: Sequence[str], marked: ComputePipeline | None, kept: Visibility
    ) -> tuple[int, int | None]:
        """Count fiblets in the view volume, and those drawn; the uniform blocks are bound already."""
        if self._max_groups:
            return self._by_compute(chunks, features, marked, kept)
        return self._by_query(chunks, features, kept), None

    def _by_compute(
        self, chunks: Sequence[Chunk], features: Sequence[str], marked: ComputePipeline | None, kept: Visibility
    ) -> tuple[int, int | None]:
        program = self._programs.compute("fiblets/compute/count.comp", features)
        counts = storage_buffer(self._ctx, np.zeros(2, np.uint32), "counts")
        program["marked"] = int(marked is not None)
        kept.bind(program)
        for index, chunk in enumerate(chunks):
            chunk.bind_storage()
            kept.bind_chunk(index)
            if marked is not None:
                marked.bind_marks(index)
            counts.bind_to_storage_buffer(COUNT_STORAGE["fiblet_counts"])  # in the place of per-point values
            dispatch(program, -(-chunk.n_fiblets // (32 * GROUP_SIZE)), self._max_groups)
        self._ctx.memory_barrier(moderngl.ALL_BARRIER_BITS)
        in_view, drawn = np.frombuffer(counts.read(8), "<u4").tolist()
        counts.release()
        return in_view, drawn if marked is not None else None

    def _by_query(self, chunks: Sequence[Chunk], features: Sequence[str], kept: Visibility) -> int:
        program = self._programs.render(
            {"vertex": "fiblets/hardware_raster/count.vert", "fragment": "fiblets/hardware_raster/count.frag"},
            [*features, "TEXTURE_DATA"],
        )
        set_data_samplers(self._gl, program)
        array = self._ctx.vertex_array(program, [])
        total = 0
        with nowhere(self._ctx, self._gl):
            self._ctx.enable_only(moderngl.NOTHING)
            self._ctx.point_size = 1.0
            kept.bind(program)
            for index, chunk in enumerate(chunks):
                kept.bind_chunk(index)
                data, query = DataTextures(self._gl, chunk), Query(self._gl, "samples")
                data.bind()
                chunk.buffers["chunk"].bind_to_uniform_block(BLOCKS["Chunk"])
                with query:
                    array.render(moderngl.POINTS, vertices=chunk.n_fiblets)
                total += query.value()
                query.release()
                data.release()
        array.release()
        return total

    @staticmethod
    def visible(target: GBuffer) -> int:
        """Count fiblets that own a pixel of a picture, by reading it back."""
        owners = np.unique(np.frombuffer(target.owner.read(), "<u4"))
        return int((owners != EMPTY).sum())


def no_counts(
    total: int, in_frustum: int | None = None, drawn: int | None = None, visible: int | None = None
) -> dict[str, int | None]:
    """Return the number of fiblets, and the counts known without rendering."""
    return {"total": total, "in_frustum": in_frustum, "drawn": drawn, "visible": visible}


def count_fiblets(
    census: Census,
    total: int,
    chunks: Sequence[Chunk],
    features: Sequence[str],
    pipeline: Pipeline,
    target: GBuffer,
    kept: Visibility,
    culled: bool,
) -> dict[str, int | None]:
    """Count fiblets of the last picture, with its uniform blocks and camera."""
    marked = pipeline if isinstance(pipeline, ComputePipeline) and pipeline.planned else None
    in_frustum, drawn = census.count(chunks, [*features, *kept.culling], marked, kept)
    return no_counts(total, in_frustum, drawn if culled else in_frustum, census.visible(target))
