"""Which streamlines pass painted regions, updated after each stroke from the fiblets near it alone.

The state is, for each fiblet, whether some position of it lies in the region, and for each streamline the number of
its fiblets inside. A stroke changes these only where a fiblet comes near changed voxels, and where voxels are added,
only for fiblets outside so far. The index (:mod:`.fiblet_index`) finds these and settles most; others are decoded and
walked through the voxels, so that the answer is exact. A fiblet here is its points, the segments between them, and the
one that joins it to the next.

Whether streamlines end in the region or never leave it is computed from its first use on.
"""

from __future__ import annotations

import time
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import numpy.typing as npt

from ...codec.decompress import decoding_arrays
from ...codec.small_sets import prefer_kernels
from ...errors import FormatError
from ..selection.point_flags import ALL
from ..selection.point_flags import ANY as PASSES
from ..selection.point_flags import FIRST as BEGINS
from ..selection.point_flags import LAST as ENDS
from .fiblet_index import CHUNK, LEAF, fiblets_of_streamlines, index_of
from .free_space import FreeSpace

if TYPE_CHECKING:
    from ...codec.fibletset import FibletSet
    from ..density.voxel_grid import VoxelGrid
    from .painter import RegionPainter, Stroke

Ints = npt.NDArray[np.int64]
Mask = npt.NDArray[np.bool_]


class LiveRegion:
    """The streamlines that pass a changing region of voxels.

    Takes a byte for each fiblet and four for each streamline; nine after the first call of :meth:`flags`.

    Parameters
    ----------
    fiblets : FibletSet
    grid : VoxelGrid

    Attributes
    ----------
    seconds : float
        Duration of the last change.
    looked_at, decoded : int
        Number of fiblets near the last change, and of decoded ones among them.
    """

    def __init__(self, fiblets: FibletSet, grid: VoxelGrid) -> None:
        self.fiblets, self.grid = fiblets, grid
        self.index = index_of(fiblets)
        self.mask = np.zeros(grid.n_voxels, np.uint8)
        self._states = np.zeros(fiblets.n_fiblets, np.uint8)  # in the order of the index
        self._any = np.zeros(fiblets.n_streamlines, np.int32)
        self._out, self._ends = np.empty(0, np.int32), np.empty(0, np.uint8)  # with computed flags
        self._bases = np.ascontiguousarray(fiblets.pages[:, 0])
        ids = fiblets.rank_to_id
        self._ids = np.empty(0, np.int64) if ids is None else np.array(ids, np.int64)
        self._arrays = decoding_arrays(fiblets)
        self._passing = 0
        self.seconds = 0.0
        self.looked_at = self.decoded = 0

    @property
    def count(self) -> int:
        """Number of streamlines that pass the region."""
        return self._passing

    def change(self, voxels: Ints, inside: Mask) -> int:
        """Add voxels to the region, or remove them.

        Parameters
        ----------
        voxels : numpy.ndarray
            ``(n,)`` int64 places in the flat grid, in C order.
        inside : numpy.ndarray
            ``(n,)`` bool: True adds the voxel, False removes it.

        Returns
        -------
        int
            Number of streamlines that now pass the region.
        """
        from . import coarse_kernels as coarse

        begin = time.perf_counter()
        changed = self.mask[voxels] != inside
        voxels, inside = voxels[changed], inside[changed]
        self.looked_at = self.decoded = 0
        if len(self._out):
            self._take(voxels, inside, coarse.ALL_FLAGS)
        else:
            self._take(voxels[~inside], False, coarse.REMOVED)
            self._take(voxels[inside], True, coarse.ADDED)
        self.seconds = time.perf_counter() - begin
        return self._passing

    def _take(self, voxels: Ints, inside: Any, asked: int) -> None:
        from . import coarse_kernels as coarse
        from . import walk_kernels as kernels

        if not len(voxels):
            return
        grid, mask, index = self.grid, self.mask, self.index
        prefer_kernels("decoding")
        mask[voxels] = np.where(inside, kernels.HERE, 0) | kernels.CHANGED
        changed, volume = _box(voxels, grid.shape), mask.reshape(grid.shape)
        in_mm = _in_mm(changed, grid)
        near = index.near(*in_mm)
        whole = self._region_about(near, volume) if asked == coarse.REMOVED else changed
        within = about_changed = about_whole = FreeSpace.from_bits(volume, kernels.CHANGED, changed)
        if asked == coarse.REMOVED:
            about_whole = FreeSpace.from_bits(volume, kernels.HERE, whole)
        elif asked == coarse.ADDED:
            within = FreeSpace.from_bits(volume, kernels.HERE, changed, beyond=True)
        per, rows, bits = CHUNK // LEAF, np.linalg.norm(grid.linear, axis=1), np.empty(len(near), np.uint8)
        coarse.close_parts(near, index.leaves, index.parts, grid.linear, grid.corner, rows, changed, about_changed,
                           bits)  # fmt: skip
        near, bits = near[bits > 0], bits[bits > 0]
        found = np.empty((len(near), LEAF), np.uint8)
        coarse.settle(near, bits, index.leaves, index.pieces, index.parts, per, CHUNK, self._states, asked, grid.linear,
                      grid.corner, rows, mask, grid.shape, changed, whole, in_mm, about_changed, about_whole,
                      within, found)  # fmt: skip
        which = np.flatnonzero(found)
        fates, leaf = found.ravel()[which], near[which // LEAF]
        places = leaf // per * CHUNK + leaf % per * LEAF + which % LEAF
        open_ = places[fates == coarse.OPEN]
        self.looked_at += len(places)
        self.decoded += len(open_)
        flags = np.empty(len(open_), np.uint8)
        if asked == coarse.ALL_FLAGS:
            kernels.look(open_, index.order, *self._arrays, grid.linear, grid.corner, mask, grid.shape, flags)
        else:
            bit, box = (kernels.CHANGED, changed) if asked == coarse.ADDED else (kernels.HERE, whole)
            kernels.passes(open_, index.order, *self._arrays, grid.linear, grid.corner, mask, bit, box, grid.shape,
                           flags)  # fmt: skip
        mask[voxels] &= kernels.HERE
        if (flags == kernels.BAD).any():
            raise _damaged()
        if asked != coarse.ALL_FLAGS:
            flipped = flags != self._states[open_]
            settled = fates != coarse.OPEN
            open_ = np.concatenate([open_[flipped], places[settled]])
            flags = np.concatenate([flags[flipped], (fates[settled] == coarse.SURE).astype(np.uint8)])
        self._apply(open_, flags)

    def _region_about(self, leaves: Ints, volume: npt.NDArray[np.uint8]) -> npt.NDArray[np.float64]:
        """Box of the region's voxels, and of changed ones, as far as fiblets of some leaves may meet them."""
        if not len(leaves):
            return _box(np.empty(0, np.int64), self.grid.shape)
        boxes = self.index.boxes[leaves]
        ends = np.stack([boxes[:, :3].min(axis=0), boxes[:, 3:].max(axis=0)]).astype(np.float64)
        corners = np.stack(np.meshgrid(*ends.T, indexing="ij"), axis=-1).reshape(-1, 3)
        at = (corners - self.grid.corner) @ self.grid.linear.T
        low = np.clip(np.floor(at.min(axis=0)) - 1.0, 0, volume.shape).astype(np.int64)
        high = np.clip(np.ceil(at.max(axis=0)) + 1.0, 0, volume.shape).astype(np.int64)
        part = volume[tuple(slice(a, b) for a, b in zip(low, high, strict=True))]
        found = _box(np.flatnonzero(part), part.shape)
        return found + np.concatenate([low, low])

    def _apply(self, places: Ints, flags: npt.NDArray[np.uint8]) -> None:
        from . import walk_kernels as kernels

        order, anchors, lines = self.index.order, self._arrays[0][0], np.empty(len(places), np.int64)
        kernels.lines_of(places, order, anchors, self._bases, self._ids, lines)
        more = kernels.apply(places, lines, flags, order, anchors, self._states, self._any, self._out,
                             self._ends)  # fmt: skip
        if more == kernels.DAMAGED:
            raise _damaged()
        self._passing += more

    def passes(self) -> Mask:
        """Return which streamlines pass the region, ``(n_streamlines,)`` bool."""
        return self._any > 0

    def flags(self) -> npt.NDArray[np.uint8]:
        """Return how each streamline lies to the region, as :func:`.passing.region_flags` does, between points too.

        From the first time on, all of it is kept up after each change, which takes longer.
        """
        from . import walk_kernels as kernels

        if not len(self._out):
            self._know_all()
        out = np.where(self._any > 0, PASSES, 0).astype(np.uint8)
        out[self._out == 0] |= ALL
        out[self._ends & kernels.FIRST != 0] |= BEGINS
        out[self._ends & kernels.LAST != 0] |= ENDS
        return out

    def _know_all(self) -> None:
        """Begin to keep which fiblets leave the region, and where streamlines end."""
        from . import coarse_kernels as coarse
        from . import walk_kernels as kernels

        counts = fiblets_of_streamlines(self.fiblets)
        self._out = np.maximum(counts, 1)  # streamlines without points stay nowhere
        self._ends = np.zeros(len(counts), np.uint8)
        self._any[:] = 0
        self._states[:] = kernels.OUT
        self._passing = 0
        there = np.flatnonzero(self.mask)
        self._take(there, np.ones(len(there), bool), coarse.ALL_FLAGS)


class LiveRegions:
    """The regions of a painter, and the streamlines of a set that pass them.

    Parameters
    ----------
    fiblets : FibletSet
    painter : RegionPainter
        Its strokes update the regions until :meth:`close`.
    """

    def __init__(self, fiblets: FibletSet, painter: RegionPainter) -> None:
        self.fiblets, self.painter = fiblets, painter
        self._held: dict[int, LiveRegion] = {}
        painter.listeners.append(self._stroke)

    def close(self) -> None:
        """Stop following the painter's strokes."""
        if self._stroke in self.painter.listeners:
            self.painter.listeners.remove(self._stroke)

    def _stroke(self, stroke: Stroke) -> None:
        for label, held in self._held.items():
            held.change(stroke.voxels, stroke.after == label)

    def region(self, name: str) -> LiveRegion:
        """Return the state of one region; the first call computes it."""
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
        """Return the streamlines that satisfy conditions on regions; segments count, not only points.

        Parameters
        ----------
        include, exclude : iterable of str
            Regions that streamlines must pass, and regions that they must miss.
        ends_in : iterable of str
            Regions that must each contain an end.
        stays_in : str, optional
            Region that must contain the whole streamline.
        in_order : iterable of str
            Regions that must be passed in this order.
        direction : {'either', 'forward'}
            Whether the reverse order is accepted; the direction of stored streamlines is arbitrary.

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
            chosen &= self.region(name).passes()
        for name in exclude:
            chosen &= ~self.region(name).passes()
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


def _box(voxels: Ints, shape: tuple[int, int, int]) -> npt.NDArray[np.float64]:
    """Box that holds voxels, ``(6,)``: lower and upper corner in voxels, whose faces are at whole numbers."""
    if not len(voxels):
        return np.array([np.inf] * 3 + [-np.inf] * 3)
    at = np.unravel_index(voxels, shape)
    return np.array([float(k.min()) for k in at] + [float(k.max() + 1) for k in at])


def _in_mm(box: npt.NDArray[np.float64], grid: VoxelGrid) -> npt.NDArray[np.float64]:
    """Lower and upper corner, ``(2, 3)`` mm, of what holds a box of voxels."""
    ends = np.stack([box[:3], box[3:]])
    corners = np.stack(np.meshgrid(*ends.T, indexing="ij"), axis=-1).reshape(-1, 3) - 0.5
    mm = corners @ grid.affine[:3, :3].T + grid.affine[:3, 3]
    slack = 1e-9 * (1.0 + np.abs(mm).max(axis=0))
    return np.stack([mm.min(axis=0) - slack, mm.max(axis=0) + slack])


def _damaged() -> FormatError:
    return FormatError("the set of fiblets", None, "records that point beyond its arrays", "an undamaged file")
