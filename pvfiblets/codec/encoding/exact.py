"""Sets that keep every bit of their points, and are drawn from whole numbers that need no encoder.

Coding pays by many points to a fiblet. Small sets are small in any case, and lines of one or two points take more
bytes as fiblets than as numbers. Such sets hold their points as they came (:attr:`.FibletSet.exact`). What is drawn and
culled by is made of the points when the set is made or opened, by NumPy alone: fiblets on a lattice so fine that a view
cannot tell, 12 bytes a point (:data:`.layout.PLAIN_BYTES`). A file has the points only (`exact_file`).

A kind of fiblet for single lines within a coded set would save nothing: the record of a fiblet alone takes 22 bytes, as
much as the coordinates of two points, so that no line is smaller as 12 bytes a point with a record than on a lattice.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from ...streamlines import Streamlines
from ..capsules import MARGIN, capsule_ends
from ..layout import END_LEVELS, PLAIN_BYTES, PLAIN_POINTS, WIDE, pack_ends, unpack_ends
from ..parameters import Parameters
from .record_writer import FibletChunk, RecordWriter, join

BLOCK_POINTS = 1 << 20  # points per block of records

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]


def raw_bytes(streamlines: Streamlines) -> int:
    """Bytes of streamlines as they are: their coordinates, and 4 for the number of each one's points."""
    return streamlines.n_points * 3 * streamlines.points.dtype.itemsize + 4 * len(streamlines)


def plain_records(streamlines: Streamlines, parameters: Parameters) -> dict[str, Any]:
    """Make the records that draw exact points."""
    writer = PlainWriter(parameters)
    offsets = np.asarray(streamlines.offsets)
    chunks = []
    for first, last in streamlines.blocks(BLOCK_POINTS):
        a, b = int(offsets[first]), int(offsets[last])
        chunks.append(writer.add(Streamlines(streamlines.points[a:b], offsets[first : last + 1] - a)))
    return {
        "parameters": writer.parameters,
        "pages": writer.page_table(),
        "rank_to_id": writer.rank_to_id(),
        "exact": np.array(streamlines.points),
        **join(chunks),
    }


class PlainWriter(RecordWriter):
    """Makes records whose points lie on a lattice as fine as int32 can count; no line is split but by its length."""

    def add(self, streamlines: Streamlines) -> FibletChunk:
        """Make the records of the next streamlines."""
        p = self.parameters
        offsets = np.asarray(streamlines.offsets, np.int64)
        true = np.asarray(streamlines.points, np.float64) - np.array(p.origin)
        starts, ranks = _cut(offsets)
        n, total = len(true), len(starts)
        counts = np.diff(np.append(starts, n))
        ends = np.append(ranks[1:] != ranks[:-1], True) if total else np.zeros(0, bool)
        anchors = self._anchors(true[starts])
        owner = np.repeat(np.arange(total), counts)
        k = np.rint((true - anchors[owner]) / p.lattice)
        k[starts] = 0.0
        drawn = anchors[owner] + p.lattice * k
        inner = np.ones(n, bool)
        inner[starts] = False
        steps = np.diff(k, axis=0, prepend=0.0)[inner]
        end_words = np.zeros(total, np.uint32)
        lasts = starts + counts - 1
        vectors = np.rint((drawn[lasts] - anchors)[ends] / p.end_scale)
        end_words[ends] = pack_ends(np.clip(vectors, -END_LEVELS, END_LEVELS).astype(np.int64))
        chords = capsule_ends(anchors, ends, unpack_ends(end_words[ends]) * p.end_scale, None)
        zeros = np.zeros(total, np.uint8)
        rows: dict[str, Any] = {"shape": zeros, "step": zeros, "cap": zeros, "end_words": end_words}
        rows["kind"] = np.full(total, WIDE, np.uint8)
        codes = steps.astype("<i4").view(np.uint8).ravel()
        code_start = PLAIN_BYTES * (starts - np.arange(total))
        radii = _radii(drawn, starts, lasts, owner, chords)
        return self.lay_out(streamlines.points, offsets, rows, counts, starts, code_start, radii, ranks, codes)

    def _anchors(self, points: Floats) -> Floats:
        """Points as anchors hold them, from the origin."""
        scale = np.array(self.parameters.anchor_scale)
        grid = np.divide(points, scale, out=np.zeros_like(points), where=scale > 0.0)
        anchors: Floats = np.clip(np.rint(grid), 0.0, self.top) * scale
        return anchors


def _cut(offsets: Ints) -> tuple[Ints, Ints]:
    """First points of fiblets of at most ``PLAIN_POINTS`` points, about equal in length; and their streamlines."""
    lengths = np.diff(offsets)
    lengths = lengths[lengths > 0]
    pieces = -(-lengths // PLAIN_POINTS)
    of = np.repeat(np.arange(len(lengths)), pieces)
    begins, firsts = np.cumsum(lengths) - lengths, np.cumsum(pieces) - pieces
    number = np.arange(len(of)) - firsts[of]  # of a piece in its line
    return begins[of] + number * lengths[of] // pieces[of], of


def _radii(drawn: Floats, starts: Ints, lasts: Ints, owner: Ints, chords: Floats) -> Floats:
    """See :func:`.capsules.capsule_radius`; of all fiblets, whose chords end at ``chords``."""
    if not len(starts):
        return np.zeros(0)
    first = drawn[starts]
    v = chords - first
    squares = (v**2).sum(1)
    d = drawn - first[owner]
    along, whole = (d * v[owner]).sum(1), squares[owner]
    with np.errstate(over="ignore"):  # a chord far shorter than the line
        t = np.clip(np.divide(along, whole, out=np.zeros_like(along), where=whole > 0.0), 0.0, 1.0)
    away = np.sqrt(((d - t[:, None] * v[owner]) ** 2).sum(1))
    to_next = np.append(drawn[1:], chords[-1:], axis=0)
    to_next[lasts] = chords
    arcs = np.sqrt(((to_next - drawn) ** 2).sum(1))
    radii: Floats = np.maximum.reduceat(away, starts) + MARGIN * np.add.reduceat(arcs, starts)
    return radii
