"""Per-point values on the GPU, made when a style asks for them and dropped when it no longer does.

============================  ==========================================  ==============================
value                         what the GPU holds for it                   unit
============================  ==========================================  ==============================
a name in ``per_point``       its codes and what they mean, or a float32   the array's own
a name of three or four       a word per point: red, green, blue, alpha   a colour, packed into a number
``'arc_length'``              a float32 per fiblet: the anchor's          mm from the first point
``'curvature'``               a float32 per fiblet: the anchor's          1/mm
a :class:`VolumeSource`       the volume                                  the volume's own
============================  ==========================================  ==============================

Curvature at a point is the angle between the segments before and after it over half their joint length; the ends of a
streamline take their neighbour's. It is that of the decoded points, so that it carries the codec's error: a tenth of a
step is a tenth of a radian per step.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import chain
from typing import TYPE_CHECKING, Any

import moderngl
import numpy as np
import numpy.typing as npt

from ....codec import layout
from ....codec.point_arrays import colour_columns, colours_of_points
from ....support.value_reference import relative
from ...errors import EngineError
from .chunks import CHUNK_BLOCK, Chunk, padded, storage_buffer
from .measures import Measurer
from .sampled_volume import VolumeSource, VolumeTexture
from .upload import fill_buffer, rows_of

if TYPE_CHECKING:
    from ....codec.fibletset import FibletSet

__all__ = ["ValueSources"]

ARC_LENGTH, CURVATURE = "arc_length", "curvature"

Floats = npt.NDArray[np.float64]

_ROWS = 1 << 20  # colours made at a time


@dataclass
class _Measures:
    """What ``fiblets/attributes/measure.glsl`` says of some consecutive fiblets, in float64."""

    begin: npt.NDArray[np.bool_]
    end: npt.NDArray[np.bool_]
    single: npt.NDArray[np.bool_]  # fiblets of one point
    first: Floats
    joint: Floats
    length: Floats
    last_turn: Floats
    least: Floats
    greatest: Floats
    first_turn: Floats


class ValueSources:
    """Keeps the buffers of the one active per-point value.

    Parameters
    ----------
    ctx : moderngl.Context
    measurer : Measurer
    fiblets : FibletSet
    chunks : sequence of Chunk
        Gain and lose the buffers ``values`` and ``starts``.
    prepare : callable
        Called before fiblets are measured; binds nothing.
    """

    def __init__(
        self,
        ctx: moderngl.Context,
        measurer: Measurer,
        fiblets: FibletSet,
        chunks: Sequence[Chunk],
        prepare: Callable[[], None],
    ) -> None:
        self._ctx = ctx
        self._prepare = prepare
        self._measurer = measurer
        self._fiblets = fiblets
        self._chunks = chunks
        self._active: str | VolumeSource | None = None
        self._volume: VolumeTexture | None = None
        self._ranges: dict[str, tuple[float, float]] = {}

    def activate(self, name: str | VolumeSource | None, features: Sequence[str]) -> tuple[str, ...]:
        """Make the buffers of a value, and drop those of the last one."""
        if isinstance(name, str):
            self._check(name)
        if name != self._active:
            self._drop()
            if isinstance(name, VolumeSource):
                self._volume = VolumeTexture(self._ctx, name)
            elif name in (ARC_LENGTH, CURVATURE):
                self._make_starts(name, features)
            elif name is not None and name in self._fiblets.per_point:
                self._copy_stored(name)
            elif name is not None:
                self._copy_colours(name)
            self._active = name
        if name is None:
            return ()
        if isinstance(name, VolumeSource):
            return ("VALUES_VOLUME",)
        if name in (ARC_LENGTH, CURVATURE):
            return ("VALUES_ARC_LENGTH" if name == ARC_LENGTH else "VALUES_CURVATURE",)
        return ("VALUES_STORED",) if name in self._fiblets.per_point else ("VALUES_STORED", "VALUES_COLOUR")

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
        if name not in (ARC_LENGTH, CURVATURE):
            if name not in self._fiblets.per_point:
                raise EngineError(f"{name!r} are colours, which have no range")
            stored = self._fiblets.per_point[name]
            return float(stored.lo), float(stored.hi)
        if name not in self._ranges:
            for _ in self._starts(name, features):
                pass
        return self._ranges[name]

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

    def _copy_stored(self, name: str) -> None:
        stored = self._fiblets.per_point[name]
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

    def _make_starts(self, name: str, features: Sequence[str]) -> None:
        starts = dict(enumerate(self._starts(name, features)))
        for index, chunk in enumerate(self._chunks):
            following = starts[index + 1][:1] if index + 1 in starts else np.zeros(1)
            values = np.concatenate([starts[index], following]).astype("<f4")
            chunk.buffers["starts"] = storage_buffer(self._ctx, values, name)

    def _starts(self, name: str, features: Sequence[str]) -> Iterator[Floats]:
        """Yield the value at every anchor, chunk by chunk, and note its range."""
        make = _arc_lengths if name == ARC_LENGTH else _curvatures
        carry: Any = None
        low, high = np.inf, -np.inf
        self._prepare()
        for chunk in self._chunks:
            values, carry, extremes = make(self._measure(chunk, features), carry)
            low, high = min(low, extremes[0]), max(high, extremes[1])
            yield values
        self._ranges[name] = (float(low), float(high)) if low <= high else (0.0, 0.0)

    def _measure(self, chunk: Chunk, features: Sequence[str]) -> _Measures:
        rows = self._measurer.measure(chunk, features)
        begin, end = chunk.plan.fiblets
        fiblets, m = self._fiblets, rows.astype(np.float64)
        anchors, decoding = rows_of(fiblets.anchors, begin, end), rows_of(fiblets.decoding, begin, end)
        words = np.concatenate([layout.unpack("begin", a) | layout.unpack("end", a) << 1 for a in anchors])
        return _Measures(
            begin=words & 1 == 1,
            end=words & 2 == 2,
            single=np.concatenate([layout.unpack("last", d) == 0 for d in decoding]),
            first=m[:, 0:3],
            length=m[:, 3],
            joint=m[:, 4:7],
            last_turn=m[:, 7],
            least=m[:, 8],
            greatest=m[:, 9],
            first_turn=m[:, 10],
        )


def _arc_lengths(m: _Measures, carry: float | None) -> tuple[Floats, float, tuple[float, float]]:
    """Arc length at every anchor; ``carry`` is that at the chunk's first, if a streamline runs into it."""
    before = np.cumsum(m.length) - m.length
    streamline = np.maximum.accumulate(np.where(m.begin, np.arange(len(m.begin)), -1))
    starts = before - np.where(streamline >= 0, before[streamline], -(carry or 0.0))
    ends = starts + m.length
    return starts, float(ends[-1]), (0.0, float(ends.max()))


def _curvatures(m: _Measures, carry: Any) -> tuple[Floats, Any, tuple[float, float]]:
    """Curvature at every anchor; ``carry`` is the joint, last turn, curvature and singleness of the fiblet before."""
    n = len(m.begin)
    joint0, turn0, start0, single0 = carry or (np.zeros(3), 0.0, 0.0, False)
    joint = np.concatenate([[joint0], m.joint[:-1]])
    starts = _turns(joint, m.first)
    # A streamline's first point takes the turn at its second.
    starts[m.begin] = m.first_turn[m.begin]
    alone = np.flatnonzero(m.begin & m.single & ~m.end)  # its second point is the next fiblet's anchor
    alone = alone[alone + 1 < n]
    starts[alone] = np.where(m.end[alone + 1] & m.single[alone + 1], 0.0, starts[np.minimum(alone + 1, n - 1)])
    # A last point that is an anchor takes the turn at the point before it.
    tail = np.flatnonzero(m.end & m.single & ~m.begin)
    turns = np.concatenate([[turn0], m.last_turn[:-1]])
    singles = np.concatenate([[single0], m.single[:-1]])
    anchors_before = np.concatenate([[start0], starts[:-1]])
    starts[tail] = np.where(singles[tail], anchors_before[tail], turns[tail])
    turned = m.greatest >= m.least
    low = min(float(starts.min()), float(m.least[turned].min(initial=np.inf)))
    high = max(float(starts.max()), float(m.greatest[turned].max(initial=-np.inf)))
    return starts, (m.joint[-1], m.last_turn[-1], starts[-1], bool(m.single[-1])), (low, high)


def _turns(a: Floats, b: Floats) -> Floats:
    """``turn()`` of ``shaders/fiblets/attributes/turn.glsl`` on rows."""
    la, lb = np.linalg.norm(a, axis=1), np.linalg.norm(b, axis=1)
    good = (la > 0.0) & (lb > 0.0)
    a = a / np.where(good, la, 1.0)[:, None]
    b = b / np.where(good, lb, 1.0)[:, None]
    angle = 2.0 * np.arctan2(np.linalg.norm(a - b, axis=1), np.linalg.norm(a + b, axis=1))
    return np.where(good, 2.0 * angle / np.where(good, la + lb, 1.0), 0.0)
