"""Streamlines to fiblet records, chunk by chunk: cut and code; :mod:`.record_writer` lays them out in pages.

A streamline is cut every 60 points, or a little before where it bends sharply there (:mod:`.tangents`). Each cut
is first tried with direction bytes; where those exceed the error bound (steps that vary, bends beyond the cap angles)
or turn a tangent too far it is coded on the lattice instead, split further where that saves bytes. No point is ever
dropped or moved by more than the error bound.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, get_args

import numpy as np
import numpy.typing as npt

from ...formats.mapped import forget
from ...formats.scratch import is_long
from ...streamlines import Streamlines
from ...support.ragged import blocks
from ..layout import MAX_POINTS, NODE_BYTES, WIDE
from ..parameters import DEFAULT_ANGLE, Effort
from ..small_sets import without_kernels
from ..tangents import PIXELS
from .record_writer import FibletChunk, RecordWriter

if TYPE_CHECKING:
    from ..arrays.array_coder import ArrayCoder
    from .compiled_coder import CompiledCoder

LONG_PART = 2_000_000  # points of a very long streamline that are coded at a time


@dataclass
class Encoder(RecordWriter):
    """Codes chunks of streamlines."""

    effort: Effort = "fast"  # greedy, or looking ahead with a beam, or by splines where these take fewer bytes
    # largest angle between true and drawn tangents, degrees, at the ends of segments longer than a pixel of a
    # full-screen view (`.tangents`); None leaves directions alone
    max_angle: float | None = DEFAULT_ANGLE

    def __post_init__(self) -> None:
        if self.effort not in get_args(Effort):
            raise ValueError(f"effort is {self.effort!r}; 'fast', 'high' or 'small' is needed")
        if self.max_angle is not None and not 0.0 < self.max_angle <= 90.0:
            raise ValueError(f"max_angle is {self.max_angle}; degrees above 0 and up to 90 are needed, or None for any")

    def _bound(self) -> tuple[float, float, float]:
        """Segments that count are longer than the first, mm; sine of the largest angle, and its chord."""
        if self.max_angle is None:
            return math.inf, math.inf, math.inf
        angle = math.radians(self.max_angle)
        diagonal = math.hypot(*self.parameters.anchor_scale) * self.top
        return diagonal / PIXELS, math.sin(angle), 2.0 * math.sin(0.5 * angle)

    def _coder(
        self, points: npt.NDArray[np.floating], offsets: npt.NDArray[np.int64], compiled: bool
    ) -> ArrayCoder | CompiledCoder:
        if compiled:
            from .compiled_coder import CompiledCoder  # numba loads only for large sets

            return CompiledCoder(points, offsets, self.parameters, self._bound(), self.effort)
        from ..arrays.array_coder import ArrayCoder

        return ArrayCoder(points, offsets, self.parameters, self._bound())

    def add(self, streamlines: Streamlines) -> FibletChunk:
        """Code the next streamlines."""
        points = np.ascontiguousarray(streamlines.points)
        offsets = np.asarray(streamlines.offsets, np.int64)
        if self.effort != "fast":
            return self._add(self._coder(points, offsets, True), points, offsets)
        with without_kernels("coding", len(points)) as small:
            return self._add(self._coder(points, offsets, not small), points, offsets)

    def _add(
        self,
        coder: ArrayCoder | CompiledCoder,
        points: npt.NDArray[np.floating],
        offsets: npt.NDArray[np.int64],
    ) -> FibletChunk:
        slots, per = coder.cut()
        rank = np.repeat(np.cumsum(per > 0) - 1, per)
        end = np.zeros(len(slots), np.uint8)
        end[np.cumsum(per)[per > 0] - 1] = 1
        rows, packed = _code(coder, len(points), slots, end)
        ranks = np.repeat(rank, rows.pop("pieces"))
        return self.lay_out(points, offsets, ranks=ranks, codes=packed, **_apart(rows))

    def parts(self, streamlines: Streamlines) -> Iterator[FibletChunk]:
        """Code the next streamlines; records of a very long one come in parts, whose sum :meth:`add` would give."""
        offsets = np.asarray(streamlines.offsets, np.int64)
        if not (len(offsets) > 1 and is_long(int(np.diff(offsets).max()))):
            yield self.add(streamlines)
            return
        for first, last in blocks(offsets, LONG_PART):
            points = streamlines.points[offsets[first] : offsets[last]]
            if last == first + 1 and is_long(len(points)):
                yield from self._long(points)
            else:
                yield self.add(Streamlines(points, offsets[first : last + 1] - offsets[first]))

    def _long(self, points: npt.NDArray[np.floating]) -> Iterator[FibletChunk]:
        """Code one streamline in parts: slots of a part are coded with those before and after at hand."""
        from .compiled_coder import CompiledCoder

        n, at = len(points), 0
        while at < n:
            lead = min(at, 1)  # a point before, which the first slot's directions depend on
            stop = n if n - at <= LONG_PART else at + LONG_PART
            part = np.array(points[at - lead : stop], np.float64)
            forget(points, 0, stop)
            around = (self.parameters, self._bound(), self.effort)
            slots, _ = CompiledCoder(part[lead:], np.array([0, stop - at]), *around).cut()
            if stop < n:
                # Where a slot ends depends on so many points. The last one that is known is there for those before.
                slots = slots[slots[:, 0] + MAX_POINTS + 2 <= stop - at]
            slots[:, 0] += lead
            if lead:
                slots = np.concatenate([[[0, 1]], slots])
            end = np.zeros(len(slots), np.uint8)
            end[-1] = 1
            coder = CompiledCoder(part, np.array([0, len(part)]), *around)
            after = int(stop < n)
            known = np.zeros(len(slots), bool)
            known[:lead], known[len(slots) - after :] = True, True
            rows, packed = _code(coder, len(part), slots, end, known)
            del rows["pieces"]
            keep = slice(lead, len(rows["kind"]) - after)
            rows = {name: values[keep] for name, values in rows.items()}
            done = int(rows["counts"].sum())
            rows["point_start"] -= lead
            if after:
                packed = packed[: len(packed) - max(int(slots[-1, 1]) - 2, 0)]
            yield self.lay_out(
                part[lead : lead + done], np.array([0, done]), ranks=np.zeros(len(rows["kind"]), np.int64),
                codes=packed, continues=at > 0, following=part[lead + done] if after else None, **_apart(rows),
            )  # fmt: skip
            at += done


def _code(
    coder: ArrayCoder | CompiledCoder,
    n_points: int,
    slots: npt.NDArray[np.int64],
    end: npt.NDArray[np.uint8],
    left_out: npt.NDArray[np.bool_] | None = None,
) -> tuple[dict[str, npt.NDArray[Any]], npt.NDArray[np.uint8]]:
    """Code slots; the slots `left_out` get a row and the bytes of direction codes, with any content."""
    m = len(slots)
    ok, kind, shape = np.zeros(m, np.uint8), np.zeros(m, np.uint8), np.zeros(m, np.uint32)
    step, cap, radius = np.zeros(m, np.uint16), np.zeros(m, np.uint8), np.zeros(m)
    codes, end_words = np.zeros(n_points, np.uint8), np.zeros(m, np.uint32)
    if left_out is not None:
        ok[left_out] = 1
    coder.code_directions(slots, end, (ok, kind, shape, step, cap, radius, end_words, codes))

    wanted, done = np.flatnonzero(ok == 0), np.flatnonzero(ok)
    pieces = np.ones(m, np.int64)
    size = np.where(kind == WIDE, (step >> 3).astype(np.int64) * NODE_BYTES, np.maximum(slots[:, 1] - 2, 0))
    if wanted.size:
        pieces[wanted], size[wanted] = coder.plan_lattices(slots, end, wanted)
    fiblet_at, code_at = np.cumsum(pieces) - pieces, np.cumsum(size) - size
    total, n_codes = int(pieces.sum()), int(size.sum())
    packed = np.empty(n_codes, np.uint8)
    # Splines that take more bytes than directions are tails, whose codes stand behind those of the slot before.
    source, tails = slots[:, 0].copy(), np.flatnonzero((kind == WIDE) & (size > slots[:, 1] - 3))
    source[tails] = source[tails - 1] + size[tails - 1]
    coder.gather(codes, source[done], size[done], code_at[done], packed)
    rows = {name: _spread(total, fiblet_at, a) for name, a in (("shape", shape), ("step", step), ("cap", cap))}
    rows["kind"] = _spread(total, fiblet_at, kind)
    rows["end_words"] = _spread(total, fiblet_at, end_words)
    rows["counts"], rows["point_start"] = (_spread(total, fiblet_at, slots[:, i]) for i in (1, 0))
    rows["code_start"], rows["radii"] = _spread(total, fiblet_at, code_at), _spread(total, fiblet_at, radius)
    if wanted.size:
        at = np.stack([fiblet_at[wanted], code_at[wanted]], axis=1)
        filled = ("shape", "step", "cap", "kind", "counts", "code_start", "point_start", "radii", "end_words")
        coder.code_lattices(slots, end, wanted, at, (packed, *(rows[name] for name in filled)))
    rows["pieces"] = pieces
    return rows, packed


def _apart(rows: dict[str, npt.NDArray[Any]]) -> dict[str, Any]:
    """Arguments of :meth:`.RecordWriter.lay_out`."""
    own = ("counts", "point_start", "code_start", "radii")
    return {"rows": {k: v for k, v in rows.items() if k not in own}, **{k: rows[k] for k in own}}


def _spread(total: int, at: npt.NDArray[np.int64], values: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Values of the slots at their first fiblet; the rows of further pieces are filled by the lattice encoder."""
    spread = np.zeros(total, values.dtype)
    spread[at] = values
    return spread
