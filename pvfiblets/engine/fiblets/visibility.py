"""The visible part of a set: the caller's filter, and the region that cuts it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ..frame import local_frame
from .data.filter_textures import Filter, FilterTextures

if TYPE_CHECKING:
    import moderngl

    from ...codec.fibletset import FibletSet
    from ..gl.moderngl_extras import GLExtras
    from ..gl.shaders import Programs
    from ..regions.ray_intervals import RegionIntervals
    from ..regions.uniform_block import RegionBlock
    from ..view import View
    from .data.chunks import Chunk

__all__ = ["Visibility"]


class Visibility:
    """Filter and region of a renderer; nothing of either stays on the GPU while there is none.

    Parameters
    ----------
    ctx : moderngl.Context
    gl : GLExtras
    programs : Programs
    whole, drawn : FibletSet
        The set that filters refer to, and the set on the GPU: the same, or some of its streamlines.
    chunks : sequence of Chunk
    """

    def __init__(
        self,
        ctx: moderngl.Context,
        gl: GLExtras,
        programs: Programs,
        whole: FibletSet,
        drawn: FibletSet,
        chunks: Sequence[Chunk],
    ) -> None:
        self._ctx = ctx
        self._gl = gl
        self._programs = programs
        self._filter = FilterTextures(ctx, whole, drawn, chunks)
        self._cutter: RegionIntervals | None = None
        self._block: RegionBlock | None = None

    @property
    def filtering(self) -> Filter | None:
        """See :attr:`FilterTextures.filtering`."""
        return self._filter.filtering

    @filtering.setter
    def filtering(self, wanted: Filter | None) -> None:
        self._filter.filtering = wanted

    def update(
        self, view: View, origin: npt.NDArray[np.float64], scale: npt.NDArray[np.float64], top: int
    ) -> None:
        """Bring what depends on the region and the camera up to date."""
        if view.region is None:
            self._drop_region()
            return
        if self._cutter is None:
            from ..regions.ray_intervals import RegionIntervals
            from ..regions.uniform_block import RegionBlock

            self._cutter = RegionIntervals(self._ctx, self._gl, self._programs)
            self._block = RegionBlock(self._ctx, self._gl)
        assert self._block is not None
        self._cutter.prepare(view, origin, scale, top)
        self._block.write(view.region, local_frame(view, origin, scale, top)[1])

    @property
    def culling(self) -> tuple[str, ...]:
        """Keys of `pvfiblets.engine.gl.shaders.FEATURES` that programs need which look for fiblets to leave out."""
        return (*self._filter.features, *self._region_features())

    @property
    def cutting(self) -> tuple[str, ...]:
        """Features of programs that draw parts of fiblets."""
        return (*self._filter.cutting, *(("CLIP_REGION",) if self._cutter is not None else ()))

    def _region_features(self) -> tuple[str, ...]:
        return () if self._block is None else self._block.features

    def bind(self, program: Any) -> None:
        """Bind what a program looks at whichever chunk it goes through, and tell it where everything is."""
        self._filter.bind(program)
        if self._cutter is not None and self._block is not None:
            self._cutter.bind(program)
            self._block.bind(program)

    def bind_chunk(self, chunk: int) -> None:
        """Bind what programs look at when they go through a chunk."""
        self._filter.bind_chunk(chunk)

    @property
    def buffers(self) -> dict[str, int]:
        """Bytes on the GPU, by name."""
        sizes = {"filter": self._filter.nbytes}
        if self._cutter is not None:
            sizes["region"] = self._cutter.nbytes
        if self._block is not None:
            sizes["region shapes"] = self._block.nbytes
        return {name: size for name, size in sizes.items() if size}

    def _drop_region(self) -> None:
        for thing in (self._cutter, self._block):
            if thing is not None:
                thing.release()
        self._cutter = self._block = None

    def release(self) -> None:
        """Give everything on the GPU back; twice is harmless."""
        self._filter.release()
        self._drop_region()
