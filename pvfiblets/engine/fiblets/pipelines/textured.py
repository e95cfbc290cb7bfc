"""The base of `tessellation` and `geometry`: data from buffer textures, one or several vertices for a fiblet."""

from __future__ import annotations

import abc
from collections.abc import Sequence

import moderngl

from ...gl.moderngl_extras import GLExtras
from ...gl.passes import is_software
from ...gl.shaders import Programs
from ..data.chunks import Chunk
from ..data.data_textures import DataTextures, set_data_samplers
from .draw_request import DrawRequest
from .hardware_raster import RasterPipeline


class TexturedPipeline(RasterPipeline):
    """Draws by stages with data from buffer textures, and fiblets from ``fiblets/hardware_raster/survivors.vert``."""

    mode: int
    """OpenGL's primitive for a vertex."""
    software_batch: int | None = None
    """Vertices of one call, where Mesa's software OpenGL draws."""

    def __init__(self, ctx: moderngl.Context, gl: GLExtras, programs: Programs, n_fiblets: int) -> None:
        super().__init__(ctx, gl, programs, n_fiblets)
        self._batch = self.software_batch if is_software(ctx) else None
        self._data: dict[int, DataTextures] = {}

    @abc.abstractmethod
    def _shares(self, request: DrawRequest) -> int:
        """Return the number of vertices for a fiblet."""

    def _prepare(self, program: moderngl.Program) -> None:
        set_data_samplers(self._gl, program)

    def _bind(self, program: moderngl.Program, request: DrawRequest, features: Sequence[str]) -> None:
        super()._bind(program, request, features)
        program["shares"] = self._shares(request)

    def _bind_data(self, chunk: Chunk) -> None:
        if id(chunk) not in self._data:  # they keep the chunk, so that no other can have its id
            self._data[id(chunk)] = DataTextures(self._gl, chunk)
        self._data[id(chunk)].bind()

    def _draw(
        self,
        array: moderngl.VertexArray,
        program: moderngl.Program,  # noqa: ARG002
        chunk: Chunk,
        request: DrawRequest,
    ) -> None:
        count = chunk.n_fiblets * self._shares(request)
        batch = self._batch or count
        for first in range(0, count, batch):
            array.render(self.mode, vertices=min(batch, count - first), first=first)

    def release(self) -> None:
        """Give everything on the GPU back; twice is harmless."""
        for data in self._data.values():
            data.release()
        self._data.clear()
        super().release()
