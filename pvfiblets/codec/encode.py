"""Streamlines to fiblet records, chunk by chunk: cut, code, and lay out in pages.

A streamline is cut every 60 points, or a little before where it bends sharply there (:mod:`.turn_reference`). Each cut
is first tried with direction bytes; where those would break the promise (steps that vary, bends beyond the cap angles)
or turn a tangent too far it is coded on the lattice instead, split further where that saves bytes. No point is ever
dropped or moved by more than the promise.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import numpy.typing as npt

from ..streamlines import Streamlines
from .capsules import capsule_ends
from .layout import PAGE, PAGE_BITS, pack, unpack_ends
from .parameters import DEFAULT_ANGLE, Parameters
from .small_sets import without_kernels
from .tangents import PIXELS

if TYPE_CHECKING:
    from .array_coder import ArrayCoder
    from .compiled_coder import CompiledCoder

__all__ = ["Encoder", "FibletChunk"]

Effort = Literal["fast", "high"]


@dataclass
class FibletChunk:
    """Records of consecutive fiblets of whole streamlines, as the arrays of :mod:`.layout`."""

    anchors: npt.NDArray[np.uint32]
    anchors_low: npt.NDArray[np.uint16] | None
    decoding: npt.NDArray[np.uint32]
    reach: npt.NDArray[np.uint16]
    codes: npt.NDArray[np.uint8]
    ends: npt.NDArray[np.uint32]


@dataclass
class Encoder:
    """Turns chunks of streamlines into chunks of records, keeping count across them.

    Attributes
    ----------
    parameters : Parameters
        Shared numbers of the file; ``largest_radius`` grows as chunks are added.
    effort : {'fast', 'high'}
        Greedy, or looking ahead with a beam.
    max_angle : float, optional
        Largest angle between true and drawn tangents, degrees, at the ends of segments longer than a pixel of a
        full-screen view (:mod:`.turn_reference`); None leaves directions alone.
    pages : list of tuple of int
        Rank, code byte and point at which each page begun so far starts.
    n_fiblets, n_ranks, n_codes, n_points, n_streamlines : int
        Totals so far; ranks count the streamlines that have points.
    """

    parameters: Parameters
    effort: Effort = "fast"
    max_angle: float | None = DEFAULT_ANGLE
    pages: list[tuple[int, int, int]] = field(default_factory=list)
    empty: list[npt.NDArray[np.int64]] = field(default_factory=list)
    n_fiblets: int = 0
    n_ranks: int = 0
    n_codes: int = 0
    n_points: int = 0
    n_streamlines: int = 0

    def __post_init__(self) -> None:
        if self.effort not in ("fast", "high"):
            raise ValueError(f"effort is {self.effort!r}; 'fast' or 'high' is needed")
        if self.max_angle is not None and not 0.0 < self.max_angle <= 90.0:
            raise ValueError(f"max_angle is {self.max_angle}; degrees above 0 and up to 90 are needed, or None for any")

    @property
    def top(self) -> float:
        """Largest anchor number."""
        return 2.0**self.parameters.anchor_bits - 1.0

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
        self._count_empty(offsets)
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
        begins = np.append(True, ranks[1:] != ranks[:-1]) if total else np.zeros(0, bool)
        ends = np.append(begins[1:], True) if total else begins
        chunk = self._lay_out(points, rows, counts, point_start, code_start, radii, ranks, begins, ends, packed)
        self.n_fiblets += total
        self.n_ranks += int(rank[-1]) + 1 if m else 0
        self.n_codes += n_codes
        self.n_points += len(points)
        self.n_streamlines += len(offsets) - 1
        return chunk

    def _count_empty(self, offsets: npt.NDArray[np.int64]) -> None:
        empty = np.flatnonzero(np.diff(offsets) == 0)
        if empty.size:
            self.empty.append(empty + self.n_streamlines)

    def _lay_out(
        self,
        points: npt.NDArray[np.floating],
        rows: dict[str, npt.NDArray[Any]],
        counts: npt.NDArray[np.int64],
        point_start: npt.NDArray[np.int64],
        code_start: npt.NDArray[np.int64],
        radii: npt.NDArray[np.float64],
        ranks: npt.NDArray[np.int64],
        begins: npt.NDArray[np.bool_],
        ends: npt.NDArray[np.bool_],
        codes: npt.NDArray[np.uint8],
    ) -> FibletChunk:
        """Write records, with indices relative to their pages."""
        p = self.parameters
        total = len(counts)
        absolute = np.stack([ranks + self.n_ranks, code_start + self.n_codes, point_start + self.n_points], axis=1)
        page = (np.arange(total) + self.n_fiblets) >> PAGE_BITS
        opened = np.arange(-self.n_fiblets % PAGE, total, PAGE)
        self.pages += [(int(r), int(c), int(q)) for r, c, q in absolute[opened]]
        first = self.n_fiblets >> PAGE_BITS
        if total:
            bases = np.array(self.pages[first : int(page[-1]) + 1], np.int64)
            absolute -= bases[page - first]
        scale = np.array(p.anchor_scale)
        relative = points[point_start].astype(np.float64) - np.array(p.origin)
        grid = np.divide(relative, scale, out=np.zeros_like(relative), where=scale > 0.0)
        grid = np.clip(np.rint(grid), 0.0, self.top)
        decoded = grid * scale
        grid = grid.astype(np.uint64)
        low = None
        if p.anchor_bits == 32:
            low = (grid & np.uint64(0xFFFF)).astype(np.uint16)
            grid >>= np.uint64(16)
        anchors = pack(
            "anchors", anchor_x=grid[:, 0], anchor_y=grid[:, 1], anchor_z=grid[:, 2],
            rank=absolute[:, 0], begin=begins, end=ends,
        )  # fmt: skip
        decoding = pack(
            "decoding", shape=rows["shape"], code=absolute[:, 1], step=rows["step"], point=absolute[:, 2],
            last=counts - 1, cap=rows["cap"], kind=rows["kind"],
        )  # fmt: skip
        reach = np.zeros(total)
        if p.reach_scale > 0.0:
            reach = np.minimum(np.ceil(radii / p.reach_scale * (1.0 + 1e-12)), 65535.0)
        end_words = rows["end_words"][ends]
        if total:
            chords = capsule_ends(decoded, ends, unpack_ends(end_words) * p.end_scale, None) - decoded
            radius = float((0.5 * np.sqrt((chords**2).sum(1)) + reach * p.reach_scale).max())
            self.parameters = replace(p, largest_radius=max(p.largest_radius, radius * (1.0 + 1e-12)))
        return FibletChunk(anchors, low, decoding, reach.astype(np.uint16), codes, end_words)

    def page_table(self) -> npt.NDArray[np.int64]:
        """``(n_pages + 1, 3)`` int64: rank, code byte and point at which each page starts; last row: the totals."""
        return np.array([*self.pages, (self.n_ranks, self.n_codes, self.n_points)], np.int64).reshape(-1, 3)

    def rank_to_id(self) -> npt.NDArray[np.int64] | None:
        """Streamline of each rank, or None where every streamline has points and the two are the same."""
        if not self.empty:
            return None
        keep = np.ones(self.n_streamlines, bool)
        keep[np.concatenate(self.empty)] = False
        return np.flatnonzero(keep)


def _spread(total: int, at: npt.NDArray[np.int64], values: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Values of the slots at their first fiblet; the rows of further pieces are filled by the lattice encoder."""
    spread = np.zeros(total, values.dtype)
    spread[at] = values
    return spread
