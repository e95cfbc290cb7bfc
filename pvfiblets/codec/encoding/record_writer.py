"""Fiblets that are coded, laid out as records in pages (:mod:`.layout`), chunk by chunk."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from ..capsules import capsule_ends
from ..layout import PAGE, PAGE_BITS, WORDS, pack, unpack_ends
from ..parameters import Parameters


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
class RecordWriter:
    """Lays out records, keeping count across chunks."""

    parameters: Parameters  # shared numbers of the file; `largest_radius` grows as chunks are added
    # rank, code byte and point at which each page begun so far starts
    pages: list[tuple[int, int, int]] = field(default_factory=list, kw_only=True)
    empty: list[npt.NDArray[np.int64]] = field(default_factory=list, kw_only=True)  # streamlines without points
    n_fiblets: int = field(default=0, kw_only=True)  # totals so far; ranks count the streamlines that have points
    n_ranks: int = field(default=0, kw_only=True)
    n_codes: int = field(default=0, kw_only=True)
    n_points: int = field(default=0, kw_only=True)
    n_streamlines: int = field(default=0, kw_only=True)

    @property
    def top(self) -> float:
        """Largest anchor number."""
        return 2.0**self.parameters.anchor_bits - 1.0

    def lay_out(
        self,
        points: npt.NDArray[np.floating],
        offsets: npt.NDArray[np.int64],
        rows: dict[str, npt.NDArray[Any]],
        counts: npt.NDArray[np.int64],
        point_start: npt.NDArray[np.int64],
        code_start: npt.NDArray[np.int64],
        radii: npt.NDArray[np.float64],
        ranks: npt.NDArray[np.int64],
        codes: npt.NDArray[np.uint8],
        *,
        continues: bool = False,
        following: npt.NDArray[np.floating] | None = None,
    ) -> FibletChunk:
        """Write the records of a chunk, with indices relative to their pages."""
        p = self.parameters
        empty = np.flatnonzero(np.diff(offsets) == 0)
        if empty.size:
            self.empty.append(empty + self.n_streamlines)
        total = len(counts)
        more = following is not None
        begins = np.append(not continues, ranks[1:] != ranks[:-1]) if total else np.zeros(0, bool)
        ends = np.append(begins[1:], not more) if total else begins
        absolute = np.stack([ranks + self.n_ranks, code_start + self.n_codes, point_start + self.n_points], axis=1)
        page = (np.arange(total) + self.n_fiblets) >> PAGE_BITS
        opened = np.arange(-self.n_fiblets % PAGE, total, PAGE)
        self.pages += [(int(r), int(c), int(q)) for r, c, q in absolute[opened]]
        first = self.n_fiblets >> PAGE_BITS
        if total:
            bases = np.array(self.pages[first : int(page[-1]) + 1], np.int64)
            absolute -= bases[page - first]
        scale = np.array(p.anchor_scale)
        nearest = self._grid(points[point_start])
        decoded = nearest * scale
        grid = nearest.astype(np.uint64)
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
            after = None if following is None else self._grid(following) * scale
            chords = capsule_ends(decoded, ends, unpack_ends(end_words) * p.end_scale, after) - decoded
            radius = float((0.5 * np.sqrt((chords**2).sum(1)) + reach * p.reach_scale).max())
            self.parameters = replace(p, largest_radius=max(p.largest_radius, radius * (1.0 + 1e-12)))
        self.n_fiblets += total
        self.n_ranks += int(ranks[-1]) + 1 - more if total else 0
        self.n_codes += len(codes)
        self.n_points += len(points)
        self.n_streamlines += len(offsets) - 1 - more
        return FibletChunk(anchors, low, decoding, reach.astype(np.uint16), codes, end_words)

    def _grid(self, points: npt.NDArray[np.floating]) -> npt.NDArray[np.float64]:
        """Numbers of the anchors nearest to points ``(..., 3)``, mm."""
        relative = points.astype(np.float64) - np.array(self.parameters.origin)
        scale = np.array(self.parameters.anchor_scale)
        grid = np.divide(relative, scale, out=np.zeros_like(relative), where=scale > 0.0)
        nearest: npt.NDArray[np.float64] = np.clip(np.rint(grid), 0.0, self.top)
        return nearest

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


def join(chunks: list[FibletChunk]) -> dict[str, Any]:
    """Arrays of consecutive chunks, end to end."""
    if not chunks:
        return {
            "anchors": np.empty((0, WORDS["anchors"]), np.uint32),
            "decoding": np.empty((0, WORDS["decoding"]), np.uint32),
            "reach": np.empty(0, np.uint16),
            "codes": np.empty(0, np.uint8),
            "ends": np.empty(0, np.uint32),
        }
    names = ("anchors", "decoding", "reach", "codes", "ends")
    arrays: dict[str, Any] = {name: np.concatenate([getattr(c, name) for c in chunks]) for name in names}
    if chunks[0].anchors_low is not None:
        arrays["anchors_low"] = np.concatenate([c.anchors_low for c in chunks if c.anchors_low is not None])
    return arrays
