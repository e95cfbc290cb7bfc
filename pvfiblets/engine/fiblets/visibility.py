"""The visible part of a set: the caller's filter, and the region that cuts it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from ..frame import local_frame
from ..regions.region_cut import RegionCut
from .data.filter_textures import Filter, FilterTextures

if TYPE_CHECKING:
    import moderngl

    from ...codec.fibletset import FibletSet
    from ..gl.moderngl_extras import GLExtras
    from ..gl.shaders import Programs
    from ..regions.region_cut import Place
    from ..regions.uniform_block import RegionBlock
    from ..view import View
    from .data.chunks import Chunk


class Visibility:
    """Filter and region of a renderer; nothing of either stays on the GPU while there is none."""

    def __init__(
        self,
        ctx: moderngl.Context,
        gl: GLExtras,
        programs: Programs,
        whole: FibletSet,  # the set that filters refer to, and the set on the GPU: the same, or some of its streamlines
        drawn: FibletSet,
        chunks: Sequence[Chunk],
        place: Place,  # the lattice of the anchors, as of `RegionCut`
    ) -> None:
        self._ctx = ctx
        self._gl = gl
        self._place = place
        self._filter = FilterTextures(ctx, whole, drawn, chunks)
        self._cut = RegionCut(ctx, gl, programs, place)
        self._block: RegionBlock | None = None

    @property
    def filtering(self) -> Filter | None:
        """See :attr:`FilterTextures.filtering`."""
        return self._filter.filtering

    @filtering.setter
    def filtering(self, wanted: Filter | None) -> None:
        self._filter.filtering = wanted

    def update(self, view: View) -> None:
        """Bring what depends on the region and the camera up to date."""
        self._cut.update(view)
        if view.region is None:
            self._drop_block()
            return
        if self._block is None:
            from ..regions.uniform_block import RegionBlock

            self._block = RegionBlock(self._ctx, self._gl)
        self._block.write(view.region, local_frame(view, *self._place)[1])

    @property
    def culling(self) -> tuple[str, ...]:
        """Keys of `pvfiblets.engine.gl.shaders.FEATURES` that programs need which look for fiblets to leave out."""
        return (*self._filter.features, *self._region_features())

    @property
    def cutting(self) -> tuple[str, ...]:
        """Features of programs that draw parts of fiblets."""
        return (*self._filter.cutting, *self._cut.features)

    def _region_features(self) -> tuple[str, ...]:
        return () if self._block is None else self._block.features

    def bind(self, program: Any) -> None:
        """Bind what a program looks at whichever chunk it goes through, and tell it where everything is."""
        self._filter.bind(program)
        self._cut.bind(program)
        if self._block is not None:
            self._block.bind(program)

    def bind_chunk(self, chunk: int) -> None:
        """Bind what programs look at when they go through a chunk."""
        self._filter.bind_chunk(chunk)

    @property
    def buffers(self) -> dict[str, int]:
        """Bytes on the GPU, by name."""
        sizes = {"filter": self._filter.nbytes, **self._cut.sizes}
        if self._block is not None:
            sizes["region shapes"] = self._block.nbytes
        return {name: size for name, size in sizes.items() if size}

    def _drop_block(self) -> None:
        if self._block is not None:
            self._block.release()
            self._block = None

    def release(self) -> None:
        """Give everything on the GPU back; twice is harmless."""
        self._filter.release()
        self._cut.release()
        self._drop_block()
