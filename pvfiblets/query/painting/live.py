"""Which streamlines pass painted regions, told again after each stroke from the fiblets near it alone.

For each fiblet it is kept whether some position of it lies in the region and whether some does not, and for each
streamline how many such fiblets it has. A stroke changes these only where a fiblet's capsule meets changed voxels; the
index (:mod:`.fiblet_index`) finds those, and they are decoded and walked through the voxels exactly. A fiblet here is
its points, the segments between them, and the one that joins it to the next.
"""

from __future__ import annotations

import time
from collections.abc import Iterable
from typing import TYPE_CHECKING, Literal

import numpy as np
import numpy.typing as npt

from ...codec.decompress import decode_fiblets
from ...codec.layout import PAGE_BITS, unpack
from ...codec.small_sets import prefer_kernels
from ..endpoints import anchor_points
from ..point_flags import ALL
from ..point_flags import ANY as PASSES
from ..point_flags import FIRST as BEGINS
from ..point_flags import LAST as ENDS
from .fiblet_index import index_of

if TYPE_CHECKING:
    from ...codec.fibletset import FibletSet
    from ..voxel_grid import VoxelGrid
    from .painter import RegionPainter, Stroke

__all__ = ["LiveRegion", "LiveRegions"]

Ints = npt.NDArray[np.int64]
Mask = npt.NDArray[np.bool_]
BATCH = 1 << 13  # fiblets decoded together: 12 MB of points
MOST_BOXES = 64
"""Boxes of changed voxels that fiblets are compared with."""


class LiveRegion:
    """Streamlines of one region of voxels, which changes.

    Takes a byte for each fiblet and nine for each streamline.

    Parameters
    ----------
    fiblets : FibletSet
    grid : VoxelGrid
    """

    def __init__(self, fiblets: FibletSet, grid: VoxelGrid) -> None:
        from .walk_kernels import OUT

        self.fiblets, self.grid = fiblets, grid
        self.index = index_of(fiblets)
        self.mask = np.zeros(grid.n_voxels, np.uint8)
        self._states = np.full(fiblets.n_fiblets, OUT, np.uint8)
        self._any = np.zeros(fiblets.n_ranks, np.int32)
        begins = np.flatnonzero(unpack("begin", fiblets.anchors))
        self._out = np.diff(np.append(begins, fiblets.n_fiblets)).astype(np.int32)
        self._ends = np.zeros(fiblets.n_ranks, np.uint8)
        self._bases = np.ascontiguousarray(fiblets.pages[:, 0])
        self._passing = 0
        self.seconds = 0.0
        self.looked_at = 0

    @property
    def count(self) -> int:
        """Streamlines that pass the region."""
        return self._passing

    def change(self, voxels: Ints, inside: Mask) -> int:
        """Take voxels in or out.

        Parameters
        ----------
        voxels : numpy.ndarray
            ``(n,)`` int64 places in the flat grid, in C order.
        inside : numpy.ndarray
            ``(n,)`` bool: whether each is in the region from now on.

        Returns
        -------
        int
            Streamlines that pass the region now. ``seconds`` and ``looked_at`` (fiblets decoded) say what it took.
        """
        begin = time.perf_counter()
        changed = self.mask[voxels] != inside
        voxels = voxels[changed]
        self.looked_at = 0
        if len(voxels):
            self.mask[voxels] = inside[changed]
            prefer_kernels("decoding")
            which = self.index.near(self.fiblets, self.grid, _boxes(voxels, self.grid.shape))
            self.looked_at = len(which)
            for at in range(0, len(which), BATCH):
                self._look(which[at : at + BATCH])
        self.seconds = time.perf_counter() - begin
        return self._passing

    def _look(self, which: Ints) -> None:
        from . import walk_kernels as kernels

        fiblets = self.fiblets
        words = np.asarray(fiblets.anchors[which])
        begins, ends = unpack("begin", words) != 0, unpack("end", words) != 0
        joined = ~ends
        counts = unpack("last", np.asarray(fiblets.decoding[which])).astype(np.int64) + 1
        starts = np.concatenate([[0], np.cumsum(counts + joined)])
        points = np.empty((int(starts[-1]), 3))
        decode_fiblets(fiblets, which, starts[:-1], points)
        points[starts[1:][joined] - 1] = anchor_points(fiblets, which[joined] + 1)
        found = np.empty(len(which), np.uint8)
        grid = self.grid
        kernels.look(points, starts, joined, grid.linear, grid.corner, self.mask, grid.shape, found)
        ranks = unpack("rank", words).astype(np.int64) + self._bases[which >> PAGE_BITS]
        borders = begins.astype(np.uint8) + 2 * ends.astype(np.uint8)
        self._passing += kernels.apply(which, found, self._states, ranks, borders, self._any, self._out, self._ends)

    def flags(self) -> npt.NDArray[np.uint8]:
        """Return how each streamline lies to the region, as :func:`.passing.region_flags` does, between points too."""
        from . import walk_kernels as kernels

        ranked = np.where(self._any > 0, PASSES, 0).astype(np.uint8)
        ranked[self._out == 0] |= ALL
        ranked[self._ends & kernels.FIRST != 0] |= BEGINS
        ranked[self._ends & kernels.LAST != 0] |= ENDS
        if self.fiblets.rank_to_id is None:
            return ranked
        out = np.zeros(self.fiblets.n_streamlines, np.uint8)
        out[self.fiblets.rank_to_id] = ranked
        return out


class LiveRegions:
    """The regions that a painter paints, and the streamlines of a set that pass them.

    Parameters
    ----------
    fiblets : FibletSet
    painter : RegionPainter
        It is listened to until :meth:`close`.
    """

    def __init__(self, fiblets: FibletSet, painter: RegionPainter) -> None:
        self.fiblets, self.painter = fiblets, painter
        self._held: dict[int, LiveRegion] = {}
        painter.listeners.append(self._stroke)

    def close(self) -> None:
        """Listen no more."""
        if self._stroke in self.painter.listeners:
            self.painter.listeners.remove(self._stroke)

    def _stroke(self, stroke: Stroke) -> None:
        for label, held in self._held.items():
            held.change(stroke.voxels, stroke.after == label)

    def region(self, name: str) -> LiveRegion:
        """Return what is known of one region; the first time, all of it is looked at."""
        label = self.painter.label(name)
        if label not in self._held:
            held = self._held[label] = LiveRegion(self.fiblets, self.painter.grid)
            there = np.flatnonzero(self.painter.labels.ravel() == label)
            held.change(there, np.ones(len(there), bool))
        return self._held[label]

    def count(self, name: str) -> int:
        """Return how many streamlines pass a region."""
        return self.region(name).count

    def select(
        self,
        *,
        include: Iterable[str] = (),
        exclude: Iterable[str] = (),
        ends_in: Iterable[str] = (),
        stays_in: str | None = None,
        in_order: Iterable[str] = (),
        direction: Literal["either", "forward"] = "either",
    ) -> Mask:
        """Choose streamlines by regions, between their points too.

        Parameters
        ----------
        include, exclude : iterable of str
            Regions that are all passed, and of which none is.
        ends_in : iterable of str
            Regions in each of which an end lies.
        stays_in : str, optional
            Region that is never left.
        in_order : iterable of str
            Regions that are passed one after the other, whatever lies between.
        direction : {'either', 'forward'}
            Whether the order may be the reverse one, as streamlines are stored in either.

        Returns
        -------
        numpy.ndarray
            ``(n_streamlines,)`` bool.
        """
        include, exclude, ends_in, in_order = ([n] if isinstance(n, str) else list(n)
                                               for n in (include, exclude, ends_in, in_order))  # fmt: skip
        if direction not in ("either", "forward"):
            raise ValueError(f"direction is {direction!r}; give 'either' or 'forward'")
        chosen = np.ones(self.fiblets.n_streamlines, bool)
        for name in {*include, *in_order}:
            chosen &= self.region(name).flags() & PASSES != 0
        for name in exclude:
            chosen &= self.region(name).flags() & PASSES == 0
        for name in ends_in:
            chosen &= self.region(name).flags() & (BEGINS | ENDS) != 0
        if stays_in is not None:
            chosen &= self.region(stays_in).flags() & ALL != 0
        if len(in_order) > 1:
            self._order(chosen, [self.painter.label(name) for name in in_order], direction == "either")
        return chosen

    def _order(self, chosen: Mask, labels: list[int], either: bool) -> None:
        from ..bundles.resampled import _chunks
        from .walk_kernels import in_order

        ids, grid = np.flatnonzero(chosen), self.painter.grid
        wanted, flat = np.array(labels, np.int64), self.painter.labels.ravel()
        for first, chunk in _chunks(self.fiblets, ids):
            found = np.zeros(len(chunk), np.bool_)
            in_order(np.require(chunk.points, np.float64, ["C", "W"]), np.asarray(chunk.offsets), grid.linear,
                     grid.corner, flat, grid.shape, wanted, either, found)  # fmt: skip
            chosen[ids[first : first + len(chunk)][~found]] = False


def _boxes(voxels: Ints, shape: tuple[int, int, int]) -> npt.NDArray[np.float64]:
    """Boxes ``(n, 6)`` that hold voxels: few, and tight about each cell of them."""
    at = np.stack(np.unravel_index(voxels, shape), axis=1)
    size = 4
    while True:
        cells, inverse = np.unique(at // size, axis=0, return_inverse=True)
        if len(cells) <= MOST_BOXES:
            break
        size *= 2
    inverse = inverse.ravel()
    low, high = np.full((len(cells), 3), 1 << 40), np.full((len(cells), 3), -1)
    np.minimum.at(low, inverse, at)
    np.maximum.at(high, inverse, at)
    return np.concatenate([low, high + 1], axis=1).astype(np.float64)
