"""A spatial index over the fiblets of a set: leaves of fiblets that lie alike, each with a capsule that holds them.

Fiblets are sorted, four million at a time, by splitting them at the median of the widest of six numbers, the two ends
of their chords, until 32 are left. That takes 4.9 bytes a fiblet, and is kept in the ``.fiblets`` file if it is there
when the set is saved; programs that do not know it pass over it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ...codec.fiblets_file import INDEX as KEY
from ...errors import FormatError

if TYPE_CHECKING:
    from ...codec.fibletset import FibletSet
    from ..voxel_grid import VoxelGrid

__all__ = ["FibletIndex", "index_of"]

Ints = npt.NDArray[np.int64]
CHUNK = 1 << 22  # fiblets sorted together
LEAF = 32  # fiblets of a leaf; also said where kernels are compiled


@dataclass(frozen=True, eq=False)
class FibletIndex:
    """See the module.

    Attributes
    ----------
    order : numpy.ndarray
        ``(n_fiblets,)`` uint32: fiblets by leaf, 32 to each but the last of four million.
    capsules : numpy.ndarray
        ``(n_leaves, 7)`` float32 mm: both ends and the radius.
    """

    order: npt.NDArray[np.uint32]
    capsules: npt.NDArray[np.float32]

    @property
    def nbytes(self) -> int:
        """Bytes that it takes."""
        return int(self.order.nbytes + self.capsules.nbytes)

    def near(self, fiblets: FibletSet, grid: VoxelGrid, boxes: npt.NDArray[np.float64]) -> Ints:
        """Return the fiblets that may meet boxes of voxels, rising.

        Parameters
        ----------
        fiblets : FibletSet
        grid : VoxelGrid
        boxes : numpy.ndarray
            ``(n, 6)``: lower and upper corners in voxels, whose faces are at whole numbers.

        Returns
        -------
        numpy.ndarray
            ``(m,)`` int64: all that do, and few that do not.
        """
        from . import index_kernels as kernels

        whole = np.concatenate([boxes[:, :3].min(axis=0), boxes[:, 3:].max(axis=0)])
        boxes = np.concatenate([whole[None], boxes]) if len(boxes) > 1 else boxes
        rows = np.linalg.norm(grid.linear, axis=1)
        hit = np.zeros(len(self.capsules), np.bool_)
        kernels.near_leaves(self.capsules, grid.linear, grid.corner, rows, boxes, hit)
        leaf = np.flatnonzero(hit)
        # Each stretch of CHUNK fiblets has leaves of its own, all full but its last.
        per = CHUNK // kernels.LEAF
        at = leaf // per * CHUNK + leaf % per * kernels.LEAF
        stop = np.minimum(np.minimum(at + kernels.LEAF, (leaf // per + 1) * CHUNK), fiblets.n_fiblets)
        count = stop - at
        where = np.arange(int(count.sum())) + np.repeat(at - (np.cumsum(count) - count), count)
        which = np.sort(self.order[where].astype(np.int64))
        found = np.zeros(len(which), np.bool_)
        kernels.near_fiblets(
            which, *_arrays(fiblets)[:4], fiblets.reach, *_arrays(fiblets)[4:], _units(fiblets), grid.linear,
            grid.corner, rows, boxes, found,
        )  # fmt: skip
        return which[found]


def _arrays(fiblets: FibletSet) -> tuple[Any, ...]:
    low = fiblets.anchors_low
    return (
        fiblets.anchors, np.zeros((1, 3), np.uint16) if low is None else low, low is not None, fiblets.ends,
        np.ascontiguousarray(fiblets.pages[:, 0]), fiblets.origin, fiblets.anchor_scale,
    )  # fmt: skip


def _units(fiblets: FibletSet) -> tuple[float, float, float]:
    top = np.abs(fiblets.origin) + fiblets.anchor_scale * 2.0**fiblets.parameters.anchor_bits
    return fiblets.reach_scale, fiblets.end_scale, 16.0 * float(np.spacing(top.max()))


def index_of(fiblets: FibletSet) -> FibletIndex:
    """Return a set's spatial index; made when first asked for, and kept with the set.

    Parameters
    ----------
    fiblets : FibletSet
        In memory or mapped. Of those in memory, 24 bytes for each of four million fiblets are taken meanwhile.
    """
    held = fiblets.__dict__.get(KEY)
    if held is None:
        held = fiblets.__dict__[KEY] = _built(fiblets)
    elif not isinstance(held, FibletIndex):
        held = fiblets.__dict__[KEY] = _checked(fiblets, FibletIndex(*held))
    return held


def _checked(fiblets: FibletSet, index: FibletIndex) -> FibletIndex:
    """What a file holds, so that no kernel reads beyond its arrays."""
    n = fiblets.n_fiblets
    whole, rest = divmod(n, CHUNK)
    leaves = whole * (CHUNK // LEAF) + -(-rest // LEAF)
    fits = index.order.shape == (n,) and index.order.dtype == np.uint32
    fits = fits and index.capsules.shape == (leaves, 7) and index.capsules.dtype == np.float32
    if not fits or (n and int(index.order.max()) >= n):
        raise FormatError("the set of fiblets", None, "a spatial index that is not of its fiblets",
                          "an undamaged file: make the set anew")  # fmt: skip
    return index


def _built(fiblets: FibletSet) -> FibletIndex:
    from . import index_kernels as kernels

    n = fiblets.n_fiblets
    orders, held = [np.empty(0, np.uint32)], [np.empty((0, 7), np.float32)]
    arrays, (unit, end_scale, slack) = _arrays(fiblets), _units(fiblets)
    top = float(np.spacing(np.float32(np.abs(np.array(fiblets.bounds)).max(initial=0.0) + fiblets.largest_radius)))
    for first in range(0, n, CHUNK):
        m = min(CHUNK, n - first)
        keys, order = np.empty((m, 6), np.float32), np.arange(m)
        kernels.capsules(first, *arrays, end_scale, keys)
        parts = np.array([[0, m]])
        for _ in range(6):
            middles = np.empty(len(parts), np.int64)
            kernels.sort_once(keys, order, parts, middles)
            parts = np.concatenate([np.stack([parts[:, 0], middles], 1), np.stack([middles, parts[:, 1]], 1)])
            parts = parts[parts[:, 1] > parts[:, 0]]
        kernels.sort_parts(keys, order, parts)
        found = np.empty((-(-m // kernels.LEAF), 7), np.float32)
        kernels.leaves(keys, order, fiblets.reach, first, unit, slack + 8.0 * top, found)
        orders.append((order + first).astype(np.uint32))
        held.append(found)
    return FibletIndex(np.concatenate(orders), np.concatenate(held))
