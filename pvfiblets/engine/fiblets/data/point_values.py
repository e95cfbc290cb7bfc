"""Per-point values on the GPU, made when a style asks for them and dropped when it no longer does.

============================  ==========================================  ==============================
value                         GPU data                                    unit
============================  ==========================================  ==============================
a name in ``per_point``       its codes and their range, or a float32     the array's own
a name of three or four       a word per point: red, green, blue, alpha   a colour, packed into a number
``'arc_length'``              a float32 per fiblet: the anchor's          mm from the first point
``'curvature'``               as of a name in ``per_point``               1/mm
a :class:`VolumeSource`       the volume                                  the volume's own
============================  ==========================================  ==============================

Curvature is that of `pvfiblets.query.measures`, in tables, criteria and colours alike.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import chain
from typing import TYPE_CHECKING

import moderngl
import numpy as np
import numpy.typing as npt

from ....codec import layout
from ....codec.editing.point_arrays import colour_columns, colours_of_points
from ....codec.point_values import PointValues, as_codes, code_values
from ....query.measures.measures import curvature_values
from ....support.value_reference import relative
from ...errors import EngineError
from .chunks import CHUNK_BLOCK, Chunk, padded, storage_buffer
from .measures import Measurer
from .sampled_volume import VolumeSource, VolumeTexture
from .upload import fill_buffer, rows_of

if TYPE_CHECKING:
    from ....codec.fibletset import FibletSet

ARC_LENGTH, CURVATURE = "arc_length", "curvature"

Floats = npt.NDArray[np.float64]

_ROWS = 1 << 20  # colours made at a time


class ValueSources:
    """Keeps the buffers of the one active per-point value."""

    def __init__(
        self,
        ctx: moderngl.Context,
        measurer: Measurer,
        fiblets: FibletSet,
        chunks: Sequence[Chunk],  # gain and lose the buffers `values` and `starts`
        prepare: Callable[[], None],  # called before fiblets are measured; binds nothing
        largest: int,  # bytes of one buffer
    ) -> None:
        self._ctx = ctx
        self._prepare, self._largest = prepare, largest
        self._measurer = measurer
        self._fiblets = fiblets
        self._chunks = chunks
        self._active: str | VolumeSource | None = None
        self._volume: VolumeTexture | None = None
        self._longest: float | None = None
        self._curvature: PointValues | None = None

    def activate(self, name: str | VolumeSource | None, features: Sequence[str]) -> tuple[str, ...]:
        """Make the buffers of a value, and drop the last value's."""
        if isinstance(name, str):
            self._check(name)
        if name != self._active:
            self._drop()
            if isinstance(name, VolumeSource):
                self._volume = VolumeTexture(self._ctx, name)
            elif name == ARC_LENGTH:
                self._make_starts(features)
            elif name is not None and (stored := self._stored(name)) is not None:
                self._copy_stored(name, stored)
            elif name is not None:
                self._copy_colours(name)
            self._active = name
        if name is None:
            return ()
        if isinstance(name, VolumeSource):
            return ("VALUES_VOLUME",)
        if name == ARC_LENGTH:
            return ("VALUES_ARC_LENGTH",)
        return ("VALUES_STORED", "VALUES_COLOUR") if self._stored(name) is None else ("VALUES_STORED",)

    def locate(self, to_data: Floats) -> None:
        """Bind the volume, if one is active, for a picture whose local coordinates lie here."""
        if self._volume is not None:
            self._volume.bind(to_data)

    @property
    def buffers(self) -> dict[str, int]:
        """Bytes on the GPU beside the chunks', by name."""
        return {} if self._volume is None else {"volume": self._volume.nbytes}

    def release(self) -> None:
        """Give back what no chunk holds; twice is harmless."""
        if self._volume is not None:
            self._volume.release()
            self._volume = None
        self._active = None

    def range(self, name: str | VolumeSource, features: Sequence[str]) -> tuple[float, float]:
        """Least and greatest value over all points; see :meth:`FibletRenderer.value_range`."""
        if isinstance(name, VolumeSource):
            return name.range
        self._check(name)
        if name == ARC_LENGTH:
            if self._longest is None:
                for _ in self._starts(features):
                    pass
            return 0.0, self._longest or 0.0
        stored = self._stored(name)
        if stored is None:
            raise EngineError(f"{name!r} are colours, which have no range")
        return float(stored.lo), float(stored.hi)

    def _stored(self, name: str) -> PointValues | None:
        """Values of points that the set holds, or that are computed once; None of colours."""
        if name != CURVATURE or name in self._fiblets.per_point:
            return self._fiblets.per_point.get(name)
        if self._curvature is None:
            values = curvature_values(self._fiblets)
            most = max((c.plan.points[1] - c.plan.points[0] + 1 for c in self._chunks), default=0)
            if 4 * most <= self._largest:
                self._curvature = code_values(values, exact=True)
            else:
                self._curvature = as_codes(values, 16 if 2 * most + (4 << 16) <= self._largest else 8)[0]
        return self._curvature

    def _check(self, name: str) -> None:
        known = name in (ARC_LENGTH, CURVATURE) or name in self._fiblets.per_point
        if not known and not colour_columns(self._fiblets.per_point, name):
            raise EngineError(
                f"the fiblets hold no per-point array {name!r}; there are "
                f"{sorted(self._fiblets.per_point)}, {ARC_LENGTH!r} and {CURVATURE!r}"
            )

    def _drop(self) -> None:
        for chunk in self._chunks:
            for key in ("values", "starts"):
                if key in chunk.buffers:
                    chunk.buffers.pop(key).release()
        self.release()

    def _copy_stored(self, name: str, stored: PointValues) -> None:
        n = len(stored.codes)
        table = np.zeros(0, "<f4") if stored.table is None else relative(stored.table, stored.reference).astype("<f4")
        for chunk in self._chunks:
            first, last = chunk.plan.points
            # One more point: the chunk's last fiblet may be joined to the next chunk's first.
            rows = rows_of(stored.codes, first, min(last + 1, n))
            if stored.table is None:
                rows = (relative(piece, stored.reference).astype("<f4") for piece in rows)
            size = padded(table.nbytes + stored.drawn_bytes * (min(last + 1, n) - first))
            chunk.buffers["values"] = fill_buffer(self._ctx, size, chain([table], rows), name)
            CHUNK_BLOCK.write(chunk.buffers["chunk"], value_bits=8 * stored.drawn_bytes, value_table=len(table))

    def _copy_colours(self, name: str) -> None:
        fiblets = self._fiblets
        clear = len(colour_columns(fiblets.per_point, name)) > 3
        for chunk in self._chunks:
            first, last = chunk.plan.points
            last = min(last + 1, fiblets.n_points)  # as of stored values
            pieces = (
                colours_of_points(fiblets, name, slice(at, min(at + _ROWS, last))) for at in range(first, last, _ROWS)
            )
            chunk.buffers["values"] = fill_buffer(self._ctx, padded(4 * (last - first)), pieces, name)
            CHUNK_BLOCK.write(chunk.buffers["chunk"], value_bits=32 if clear else 24)

    def _make_starts(self, features: Sequence[str]) -> None:
        starts = dict(enumerate(self._starts(features)))
        for index, chunk in enumerate(self._chunks):
            following = starts[index + 1][:1] if index + 1 in starts else np.zeros(1)
            values = np.concatenate([starts[index], following]).astype("<f4")
            chunk.buffers["starts"] = storage_buffer(self._ctx, values, ARC_LENGTH)

    def _starts(self, features: Sequence[str]) -> Iterator[Floats]:
        """Yield the arc length at every anchor, chunk by chunk, and note the longest."""
        run, longest = 0.0, 0.0
        self._prepare()
        for chunk in self._chunks:
            length = self._measurer.measure(chunk, features).astype(np.float64)
            words = rows_of(self._fiblets.anchors, *chunk.plan.fiblets)
            begin = np.concatenate([layout.unpack("begin", a) for a in words]).astype(bool)
            before = np.cumsum(length) - length
            streamline = np.maximum.accumulate(np.where(begin, np.arange(len(begin)), -1))
            starts = before - np.where(streamline >= 0, before[streamline], -run)
            run, longest = float(starts[-1] + length[-1]), max(longest, float((starts + length).max()))
            yield starts
        self._longest = longest
