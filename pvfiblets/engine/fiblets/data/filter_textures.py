"""Filters: the streamlines and points that the caller kept. The rest is culled, not only hidden.

A streamline takes a bit, by rank; a point takes a bit, in the order of the coded points. The culling stage of every
pipeline (``shaders/culling/criteria.glsl``) reads both, so that removed lines cost no decoding. A segment is drawn
where both of its points are kept, a streamline of one point where that point is kept; a fiblet with some segments kept
is drawn by the programs that can cut.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import moderngl
import numpy as np
import numpy.typing as npt

from ....codec.streamline_ranges import StreamlineRanges
from ....query.selection.bits import rank_words, stretch
from ...errors import EngineError, GPUMemoryError
from ...gl.bindings import MASKS

if TYPE_CHECKING:
    from ....codec.fibletset import FibletSet
    from .chunks import Chunk


MASK_BITS = 12  # A row of a mask holds two to the power of this many words of 32 bits; the sources know it, too

AHEAD = 2  # points of the next chunk that shaders of this one ask about

Words = npt.NDArray[np.uint32]


@dataclass(frozen=True, eq=False)
class Filter:
    """Streamlines and points to draw. The arrays must not be changed afterwards."""

    streamlines: npt.NDArray[np.bool_] | None = None  # `(n_streamlines,)` bool; all by default
    # `(n_words,)` uint32, a bit for each point in the order of the coded points (streamline of rank 0 first), the
    # lowest bit of a word first; `32 * n_words >= n_points`. All by default.
    points: Words | None = None

    def __post_init__(self) -> None:
        for name, dtype in (("streamlines", np.bool_), ("points", np.uint32)):
            array = getattr(self, name)
            if array is not None and (array.ndim != 1 or array.dtype != dtype):
                raise TypeError(f"{name} is {array.dtype} of shape {array.shape}; give one row of {np.dtype(dtype)}")

    def check(self, fiblets: FibletSet) -> None:
        """Raise a ValueError if the set has another number of streamlines, or too few points."""
        if self.streamlines is not None and len(self.streamlines) != fiblets.n_streamlines:
            count = len(self.streamlines)
            raise ValueError(f"{count} streamlines are kept or not; the set has {fiblets.n_streamlines}")
        if self.points is not None and 32 * len(self.points) < fiblets.n_points:
            raise ValueError(f"{32 * len(self.points)} points are kept or not; the set has {fiblets.n_points}")


class FilterTextures:
    """A filter on the GPU.

    Filters speak of the set ``whole``; on the GPU lies ``drawn``, the same or some of its streamlines
    (:mod:`pvfiblets.codec.editing.restrict`).
    """

    def __init__(self, ctx: moderngl.Context, whole: FibletSet, drawn: FibletSet, chunks: Sequence[Chunk]) -> None:
        self._ctx = ctx
        self._whole = whole
        self._drawn = drawn
        self._chunks = chunks
        self._filter: Filter | None = None
        self._streamlines: moderngl.Texture | None = None
        self._points: list[moderngl.Texture] = []

    @property
    def features(self) -> tuple[str, ...]:
        """Keys of :data:`pvfiblets.engine.gl.shaders.FEATURES` that culling needs."""
        streamlines = ("STREAMLINE_MASK",) if self._streamlines is not None else ()
        return (*streamlines, *self.cutting)

    @property
    def cutting(self) -> tuple[str, ...]:
        """Features for drawing, where fiblets may be drawn in part."""
        return ("POINT_MASK",) if self._points else ()

    @property
    def filtering(self) -> Filter | None:
        """The current filter; None for everything."""
        return self._filter

    @filtering.setter
    def filtering(self, wanted: Filter | None) -> None:
        if wanted is not None:
            wanted.check(self._whole)
        before, self._filter = self._filter, wanted
        streamlines = None if wanted is None else wanted.streamlines
        points = None if wanted is None else wanted.points
        try:
            if before is None or before.streamlines is not streamlines:
                self._set_streamlines(streamlines)
            if before is None or before.points is not points:
                self._set_points(points)
        except BaseException:
            self.release()
            raise

    def _set_streamlines(self, mask: npt.NDArray[np.bool_] | None) -> None:
        if mask is None:
            if self._streamlines is not None:
                self._streamlines.release()
                self._streamlines = None
            return
        self._streamlines = self._texture(self._streamlines, rank_words(self._drawn, mask))

    def _set_points(self, words: Words | None) -> None:
        if words is None:
            for texture in self._points:
                texture.release()
            self._points = []
            return
        if self._drawn is not self._whole:
            part = self._drawn
            ids = np.arange(part.n_streamlines) if part.rank_to_id is None else np.asarray(part.rank_to_id)
            words = points_of_part(words, self._whole, ids)
        for index, chunk in enumerate(self._chunks):
            first, last = chunk.plan.points
            there = self._points[index] if index < len(self._points) else None
            # Each is in its place as soon as it is made, so that all are given back if the next one fails.
            self._points[index : index + 1] = [self._texture(there, stretch(words, first, last + AHEAD))]

    def _texture(self, held: moderngl.Texture | None, words: Words) -> moderngl.Texture:
        """Words in rows, in the texture that is there if it is as large."""
        width = 1 << MASK_BITS
        # A shader reads up to two words behind the last bit.
        size = width, max(-(-(len(words) + 2) // width), 1)
        limit = int(self._ctx.info["GL_MAX_TEXTURE_SIZE"])
        if size[1] > limit:
            raise EngineError(f"{32 * len(words)} bits are more than this OpenGL's largest texture holds")
        if held is not None and held.size != size:
            held.release()
            held = None
        if held is None:
            try:
                held = self._ctx.texture(size, 1, dtype="u4")
            except moderngl.Error as error:
                raise GPUMemoryError(f"no GPU memory for {4 * size[0] * size[1]} bytes of a filter") from error
            held.filter = moderngl.NEAREST, moderngl.NEAREST
        rows = np.zeros(size[0] * size[1], "<u4")
        rows[: len(words)] = words
        held.write(rows.tobytes())
        return held

    def bind(self, program: Any) -> None:
        """Bind what a program looks at whichever chunk it goes through, and tell it where everything is."""
        if self._streamlines is not None and "streamline_mask" in program:
            self._streamlines.use(MASKS["streamline_mask"])
            program["streamline_mask"] = MASKS["streamline_mask"]
        if self._points and "point_mask" in program:
            program["point_mask"] = MASKS["point_mask"]

    def bind_chunk(self, chunk: int) -> None:
        """Bind what programs look at when they go through a chunk."""
        if self._points:
            self._points[chunk].use(MASKS["point_mask"])

    @property
    def nbytes(self) -> int:
        """Bytes of GPU memory."""
        textures = [*self._points, *([] if self._streamlines is None else [self._streamlines])]
        return sum(4 * texture.width * texture.height for texture in textures)

    def release(self) -> None:
        """Give the textures back, and draw everything; twice is harmless."""
        self._filter = None
        self._set_streamlines(None)
        self._set_points(None)


def _packed(mask: npt.NDArray[np.bool_]) -> Words:
    """32 to a word, the first in the lowest bit."""
    data = np.packbits(mask, bitorder="little")
    return np.concatenate([data, np.zeros(-len(data) % 4, np.uint8)]).view("<u4")


def points_of_part(words: Words, whole: FibletSet, ids: npt.NDArray[np.int64]) -> Words:
    """Return the bits of the points of some streamlines, one after another in that order."""
    bits = np.unpackbits(words.view(np.uint8), bitorder="little")
    places = StreamlineRanges.from_fiblets(whole).at(ids)
    ends = np.cumsum(places.points)
    rows = np.repeat(places.point - (ends - places.points), places.points) + np.arange(ends[-1] if len(ends) else 0)
    return _packed(bits[rows].astype(np.bool_))
