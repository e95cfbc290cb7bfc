"""Streamlines to fiblet records, chunk by chunk: cut and code; :mod:`.record_writer` lays them out in pages.

A streamline is cut every 60 points, or a little before where it bends sharply there (:mod:`.turn_reference`). Each cut
is first tried with direction bytes; where those would break the promise (steps that vary, bends beyond the cap angles)
or turn a tangent too far it is coded on the lattice instead, split further where that saves bytes. No point is ever
dropped or moved by more than the promise.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import numpy.typing as npt

from ..streamlines import Streamlines
from .parameters import DEFAULT_ANGLE
from .record_writer import FibletChunk, RecordWriter
from .small_sets import without_kernels
from .tangents import PIXELS

if TYPE_CHECKING:
    from .array_coder import ArrayCoder
    from .compiled_coder import CompiledCoder

__all__ = ["Encoder"]

Effort = Literal["fast", "high"]


@dataclass
class Encoder(RecordWriter):
    """Codes chunks of streamlines.

    Attributes
    ----------
    effort : {'fast', 'high'}
        Greedy, or looking ahead with a beam.
    max_angle : float, optional
        Largest angle between true and drawn tangents, degrees, at the ends of segments longer than a pixel of a
        full-screen view (:mod:`.turn_reference`); None leaves directions alone.
    """

    effort: Effort = "fast"
    max_angle: float | None = DEFAULT_ANGLE

    def __post_init__(self) -> None:
        if self.effort not in ("fast", "high"):
            raise ValueError(f"effort is {self.effort!r}; 'fast' or 'high' is needed")
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
            from .compiled_coder import CompiledCoder  # numba loads only for what is worth it

            return CompiledCoder(points, offsets, self.parameters, self._bound(), self.effort)
        from .array_coder import ArrayCoder

        return ArrayCoder(points, offsets, self.parameters, self._bound())

    def add(self, streamlines: Streamlines) -> FibletChunk:
        """Code the next streamlines."""
        points = np.ascontiguousarray(streamlines.points)
        offsets = np.asarray(streamlines.offsets, np.int64)
        if self.effort == "high":
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
        m = len(slots)
        ok, shape, step = np.zeros(m, np.uint8), np.zeros(m, np.uint32), np.zeros(m, np.uint16)
        cap, radius, codes = np.zeros(m, np.uint8), np.zeros(m), np.zeros(len(points), np.uint8)
        end_words = np.zeros(m, np.uint32)
        coder.code_directions(slots, end, (ok, shape, step, cap, radius, end_words, codes))

        wanted = np.flatnonzero(ok == 0)
        pieces, size = np.ones(m, np.int64), np.maximum(slots[:, 1] - 2, 0)
        if wanted.size:
            pieces[wanted], size[wanted] = coder.plan_lattices(slots, end, wanted)
        fiblet_at, code_at = np.cumsum(pieces) - pieces, np.cumsum(size) - size
        total, n_codes = int(pieces.sum()), int(size.sum())
        packed = np.empty(n_codes, np.uint8)
        coder.gather(codes, slots, np.flatnonzero(ok), code_at, packed)
        rows = {name: _spread(total, fiblet_at, a) for name, a in (("shape", shape), ("step", step), ("cap", cap))}
        rows["kind"] = np.zeros(total, np.uint8)
        rows["end_words"] = _spread(total, fiblet_at, end_words)
        counts, point_start = _spread(total, fiblet_at, slots[:, 1]), _spread(total, fiblet_at, slots[:, 0])
        code_start, radii = _spread(total, fiblet_at, code_at), _spread(total, fiblet_at, radius)
        if wanted.size:
            at = np.stack([fiblet_at[wanted], code_at[wanted]], axis=1)
            filled = (
                packed,
                rows["shape"],
                rows["step"],
                rows["cap"],
                rows["kind"],
                counts,
                code_start,
                point_start,
                radii,
                rows["end_words"],
            )
            coder.code_lattices(slots, end, wanted, at, filled)
        ranks = np.repeat(rank, pieces)
        return self.lay_out(points, offsets, rows, counts, point_start, code_start, radii, ranks, packed)


def _spread(total: int, at: npt.NDArray[np.int64], values: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Values of the slots at their first fiblet; the rows of further pieces are filled by the lattice encoder."""
    spread = np.zeros(total, values.dtype)
    spread[at] = values
    return spread
