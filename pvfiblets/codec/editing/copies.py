"""Many copies of compressed streamlines, each moved by whole units of the anchor grid: tractograms of any size.

A fiblet's points follow from its anchor by what its other words and codes say. Anchors are whole numbers, so that a
copy whose anchors all moved by the same whole numbers decodes to the same points, moved: nothing is rounded again, the
pieces of a streamline meet as before, and codes, first directions, capsules and end vectors equal the original's.

(A *turned* copy cannot share codes. A record holds the first direction, and the frame about it follows from that: the
smallest rotation from X. Turning a direction does not turn that frame along with it but rolls it, for each fiblet of a
streamline by another angle, and pieces that met would come apart. What is to be turned is coded again.)

Arrays are made chunk by chunk, each by itself: writing a file needs the memory of one chunk, whatever its size.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from os import PathLike
from typing import Any

import numpy as np
import numpy.typing as npt

from ...support.progress_bar import progress_bar
from ..fibletset import FibletSet
from ..files.archive import Member, array_member, write_archive
from ..files.fiblets_file import make_header
from ..kernels import copy_kernels
from ..layout import PAGE, WORDS, unpack

CHUNK = 4096  # streamlines made at a time
Ints = npt.NDArray[np.int64]
Show = Callable[[int], object]


@dataclass(frozen=True)
class _Stretch:
    """Consecutive copies: which streamline of the pool each one is of, and where they stand in the result."""

    first: int
    which: Ints  # (n,)
    shift: Ints  # (n, 3) units of the anchor grid
    fiblets: Ints  # (n + 1,) where the copies begin
    codes: Ints
    points: Ints


@dataclass(frozen=True)
class Copies:
    """``n_streamlines`` copies of the streamlines of a pool; the first of each is not moved.

    Copy ``i`` is of streamline ``i % n_pool``. They stand in that order, or, with ``sequence``, all copies of one
    streamline before the next one's: the same copies, in an order that is compact in space where the sequence is.
    """

    # streamlines with points, in memory. Its grid must leave room: anchors moved by `spread` stay on it.
    pool: FibletSet
    # `(n_pool, 6)` float64: least x, y, z and greatest x, y, z of each streamline's original points, mm
    boxes: npt.NDArray[np.float64]
    n_streamlines: int  # number of copies, at least 1
    spread: float  # largest move along an axis, mm; moves are distributed as a triangle around 0
    seed: int = 0  # the same seed gives the same moves
    sequence: Ints | None = None  # `(n_pool,)` int64: the pool's streamlines, each once

    def __post_init__(self) -> None:
        if self.pool.rank_to_id is not None or not self.pool.n_streamlines:
            raise ValueError("copies are made of streamlines that have points; leave out those without")
        if self.n_streamlines < 1:
            raise ValueError(f"n_streamlines is {self.n_streamlines}; at least 1 is needed")
        anchors = self._anchors()
        top = 2**self.pool.parameters.anchor_bits - 1
        if (anchors.min(axis=0) < self._most).any() or (anchors.max(axis=0) + self._most > top).any():
            raise ValueError(f"the pool's grid leaves no room for moves of {self.spread} mm; make it larger")

    # ------------------------------------------------------------------------------------------------- what there is

    @cached_property
    def _first(self) -> Ints:
        return np.append(np.flatnonzero(unpack("begin", self.pool.anchors)), self.pool.n_fiblets)

    @cached_property
    def _code(self) -> Ints:
        """``(n_pool + 1,)`` where the pool's streamlines begin among its codes."""
        starts = (
            unpack("code", self.pool.decoding).astype(np.int64)
            + self.pool.pages[:-1, 1].repeat(PAGE)[: self.pool.n_fiblets]
        )
        return np.append(starts, len(self.pool.codes))[self._first]

    @cached_property
    def _point(self) -> Ints:
        return np.append(self.pool.fiblet_points(), self.pool.n_points)[self._first]

    @cached_property
    def _within(self) -> Ints:
        """``(n_fiblets, 2)``: first code and first point of each fiblet, counted from its streamline's."""
        pool, ranks = self.pool, self.pool.fiblet_ranks()
        codes = unpack("code", pool.decoding).astype(np.int64) + pool.pages[:-1, 1].repeat(PAGE)[: pool.n_fiblets]
        return np.stack([codes - self._code[ranks], pool.fiblet_points() - self._point[ranks]], axis=1)

    @cached_property
    def _most(self) -> Ints:
        """``(3,)`` largest move, in units of the grid."""
        return np.floor(self.spread / np.maximum(self.pool.anchor_scale, 1e-300)).astype(np.int64)

    def _anchors(self) -> Ints:
        grid = np.stack([unpack(f"anchor_{axis}", self.pool.anchors) for axis in "xyz"], axis=1).astype(np.int64)
        low = self.pool.anchors_low
        return grid if low is None else grid << 16 | low

    @cached_property
    def _starts(self) -> Ints:
        """``(n_pool + 1,)``: where the copies of each streamline of the sequence begin."""
        assert self.sequence is not None
        n = self.pool.n_streamlines
        counts = self.n_streamlines // n + (self.sequence < self.n_streamlines % n)
        return np.concatenate([[0], np.cumsum(counts)])

    def copies_at(self, first: int, last: int) -> Ints:
        """Return the copies at places ``first`` to ``last``: ``(last - first,)`` int64."""
        places = np.arange(first, last)
        if self.sequence is None:
            return places
        turn = np.searchsorted(self._starts, places, side="right") - 1
        return self.sequence[turn] + self.pool.n_streamlines * (places - self._starts[turn])

    def shifts(self, copies: Ints) -> Ints:
        """Moves of some copies, ``(n, 3)`` int64 in units of the anchor grid."""
        start = np.uint64(self.seed * 0x9E3779B97F4A7C15 % 2**64)
        keys = (6 * copies[:, None] + np.arange(6)).astype(np.uint64) + start
        uniform = (_mixed(keys) >> np.uint64(11)).astype(np.float64) * 2.0**-53
        moves = np.rint((uniform[:, :3] + uniform[:, 3:] - 1.0) * self._most).astype(np.int64)
        moves[copies < self.pool.n_streamlines] = 0
        return moves

    def _stretches(self) -> Iterator[_Stretch]:
        bases = np.zeros(3, np.int64)
        tables = [np.diff(a) for a in (self._first, self._code, self._point)]
        for first in range(0, self.n_streamlines, CHUNK):
            last = min(first + CHUNK, self.n_streamlines)
            copies = self.copies_at(first, last)
            which = copies % self.pool.n_streamlines
            ends = [
                base + np.concatenate([[0], np.cumsum(sizes[which])]) for base, sizes in zip(bases, tables, strict=True)
            ]
            yield _Stretch(first, which, self.shifts(copies), *ends)
            bases = np.array([e[-1] for e in ends])

    @cached_property
    def _plan(self) -> tuple[Ints, npt.NDArray[np.float64]]:
        """Page table, and the bounds ``(2, 3)`` of all copies."""
        rows = []
        bounds = np.array([np.full(3, np.inf), np.full(3, -np.inf)])
        stretch = None
        for stretch in self._stretches():
            fiblets = stretch.fiblets
            opened = np.arange(-(-fiblets[0] // PAGE) * PAGE, fiblets[-1], PAGE)
            m = np.searchsorted(fiblets, opened, side="right") - 1
            within = self._within[self._first[stretch.which[m]] + opened - fiblets[m]]
            rows.append(
                np.stack([stretch.first + m, stretch.codes[m] + within[:, 0], stretch.points[m] + within[:, 1]], axis=1)
            )
            moves = stretch.shift * self.pool.anchor_scale
            bounds[0] = np.minimum(bounds[0], (self.boxes[stretch.which, :3] + moves).min(axis=0))
            bounds[1] = np.maximum(bounds[1], (self.boxes[stretch.which, 3:] + moves).max(axis=0))
        assert stretch is not None
        rows.append(np.array([[self.n_streamlines, stretch.codes[-1], stretch.points[-1]]]))
        return np.concatenate(rows), bounds

    @property
    def n_points(self) -> int:
        """Points of all copies."""
        return int(self._plan[0][-1, 2])

    # --------------------------------------------------------------------------------------------------- their arrays

    def _pieces(self, name: str) -> Iterator[npt.NDArray[Any]]:
        """One array of the result, chunk by chunk."""
        pool, pages = self.pool, self._plan[0]
        low = np.empty((0, 3), np.uint16) if pool.anchors_low is None else pool.anchors_low
        for s in self._stretches():
            n = int(s.fiblets[-1] - s.fiblets[0])
            out: npt.NDArray[Any]
            if name == "anchors":
                out, fine = np.empty((n, WORDS[name]), np.uint32), pool.anchors_low is not None
                copy_kernels.copy_anchors(
                    pool.anchors, low, fine, self._first, s.which, s.shift, s.fiblets, s.first, pages, out
                )
            elif name == "anchors_low":
                out = np.empty((n, 3), np.uint16)
                copy_kernels.copy_anchors_low(low, self._first, s.which, s.shift, s.fiblets, out)
            elif name == "decoding":
                out = np.empty((n, WORDS[name]), np.uint32)
                copy_kernels.copy_decoding(
                    pool.decoding, self._within, self._first, s.which, s.fiblets, s.codes, s.points, pages, out
                )
            elif name == "reach":
                out = np.empty(n, np.uint16)
                copy_kernels.copy_reach(pool.reach, self._first, s.which, s.fiblets, out)
            elif name == "codes":
                out = np.empty(int(s.codes[-1] - s.codes[0]), np.uint8)
                copy_kernels.copy_codes(pool.codes, self._code, s.which, s.codes, out)
            else:
                out = pool.ends[s.which]
            yield out

    def _members(self, show: Show) -> dict[str, Member]:
        pool, pages = self.pool, self._plan[0]
        n = sum(int(s.fiblets[-1] - s.fiblets[0]) for s in self._stretches())
        shapes: dict[str, tuple[Any, tuple[int, ...]]] = {
            "anchors": (np.uint32, (n, WORDS["anchors"])),
            "decoding": (np.uint32, (n, WORDS["decoding"])),
            "reach": (np.uint16, (n,)),
            "codes": (np.uint8, (int(pages[-1, 1]),)),
            "ends": (np.uint32, (self.n_streamlines,)),
        }
        if pool.anchors_low is not None:
            shapes["anchors_low"] = (np.uint16, (n, 3))

        def member(name: str, dtype: Any, shape: tuple[int, ...]) -> Member:
            def pieces() -> Iterator[memoryview]:
                for piece in self._pieces(name):
                    yield piece.reshape(-1).view(np.uint8).data
                    show(piece.nbytes)

            return Member(np.dtype(dtype), shape, pieces)

        return {name: member(name, dtype, shape) for name, (dtype, shape) in shapes.items()}

    def make(
        self,
        per_streamline: dict[str, npt.NDArray[Any]] | None = None,
        groups: dict[str, npt.NDArray[Any]] | None = None,
        path: str | PathLike[str] | None = None,
        progress: bool = False,
    ) -> FibletSet:
        """Make all copies, in memory or in a file."""
        pages, bounds = self._plan
        b = bounds.T.ravel().tolist()
        whole = replace(
            self.pool,
            pages=pages,
            bounds=(b[0], b[1], b[2], b[3], b[4], b[5]),
            n_streamlines=self.n_streamlines,
            per_point={},
            per_streamline=per_streamline or {},
            groups=groups or {},
            per_group={},
        )
        with progress_bar(progress, desc="copying", unit="B", unit_scale=True) as bar:
            members = self._members(bar.update)
            bar.total = sum(int(np.prod(m.shape)) * m.dtype.itemsize for m in members.values())
            if path is None:
                arrays: dict[str, Any] = {name: _filled(member) for name, member in members.items()}
                return replace(whole, **arrays)
            n = members["reach"].shape[0]
            header, more = make_header(replace(whole, anchors=np.empty((n, 0), np.uint32)), {})
            files = {f"{name}.npy": member for name, member in members.items()}
            write_archive(path, header, files | {"pages.npy": array_member(pages)} | more)
        return FibletSet.open(path)


def _filled(member: Member) -> npt.NDArray[Any]:
    array = np.empty(member.shape, member.dtype)
    flat, at = array.reshape(-1).view(np.uint8), 0
    for piece in member.pieces():
        flat[at : at + len(piece)] = np.frombuffer(piece, np.uint8)
        at += len(piece)
    return array


def _mixed(keys: npt.NDArray[np.uint64]) -> npt.NDArray[np.uint64]:
    """A random-looking word for each key: the finaliser of splitmix64 (Steele, Lea and Flood 2014)."""
    z = keys * np.uint64(0x9E3779B97F4A7C15)
    z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    mixed: npt.NDArray[np.uint64] = z ^ (z >> np.uint64(31))
    return mixed
