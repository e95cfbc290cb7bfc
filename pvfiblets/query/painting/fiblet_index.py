"""A spatial index over the fiblets of a set: leaves of fiblets that run alike, and each fiblet in a coarse form.

Fiblets are sorted, four million at a time, by splitting them at the median of the widest of six numbers, the two ends
of their chords, until 32 are left: a leaf. Each fiblet is kept as one, two or four chords between its own points, in
bytes that count from the leaf's mean course, and as the distance of its points from these chords. That decides for most
fiblets whether they pass a region (:mod:`.coarse_kernels`); the others are decoded.

It takes 11 to 26 bytes a fiblet, and is kept in the ``.fiblets`` file if it is there when the set is saved; programs
that do not know it pass over it.
"""

from __future__ import annotations

import time
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ...codec.decompress import decoding_arrays, fixed
from ...codec.files.fiblets_file import INDEX as KEY
from ...codec.layout import unpack
from ...codec.small_sets import prefer_kernels
from ...errors import FormatError

if TYPE_CHECKING:
    from ...codec.fibletset import FibletSet

Ints = npt.NDArray[np.int64]
CHUNK = 1 << 22  # fiblets sorted together
LEAF = 32  # fiblets of a leaf; also said where kernels are compiled
NEAR = 0.25
"""mm: three fiblets of four may have points as far as this from chords. Half a voxel would leave most to decode."""


@dataclass(frozen=True, eq=False)
class FibletIndex:
    """A spatial index of fiblets: similar fiblets in leaves, and each fiblet as `P` chords between `P` + 1 points.

    Attributes
    ----------
    order : numpy.ndarray
        ``(n_fiblets,)`` uint32: fiblets by leaf, 32 to each but the last of four million.
    leaves : numpy.ndarray
        ``(n_leaves, 4 P + 5)`` float32 mm: mean positions, x y z each; radius, for each part, of the capsule about the
        mean chord in which all fiblets' parts lie; the unit of positions, and that of distances.
    pieces : numpy.ndarray
        ``(n_fiblets, 4 P + 3)`` uint8, in that order: positions less the leaf's mean ones, signed, and the distance
        within which all points of each part, the next fiblet's first with them, lie from its chord.
    seconds : float
        Time to build the index; 0 if it was read from a file.
    """

    order: npt.NDArray[np.uint32]
    leaves: npt.NDArray[np.float32]
    pieces: npt.NDArray[np.uint8]
    seconds: float = field(default=0.0)

    @property
    def nbytes(self) -> int:
        """Bytes that it takes in a file."""
        return int(self.order.nbytes + self.leaves.nbytes + self.pieces.nbytes)

    @property
    def parts(self) -> int:
        """Parts of each fiblet."""
        return (self.pieces.shape[1] - 3) // 4

    @cached_property
    def boxes(self) -> npt.NDArray[np.float32]:
        """``(n_leaves, 6)`` mm: lower and upper corners of boxes that hold the leaves."""
        from .index_kernels import leaf_boxes

        found = np.empty((len(self.leaves), 6), np.float32)
        leaf_boxes(self.leaves, self.parts, found)
        return found

    def near(self, low: npt.ArrayLike, high: npt.ArrayLike) -> Ints:
        """Return the leaves that may meet a box, rising.

        Parameters
        ----------
        low, high : array_like
            ``(3,)`` mm.
        """
        from .index_kernels import near_leaves

        found = np.empty(len(self.leaves), np.bool_)
        near_leaves(self.boxes, np.concatenate([np.asarray(low, float), np.asarray(high, float)]), found)
        return np.flatnonzero(found)


def index_of(fiblets: FibletSet) -> FibletIndex:
    """Return a set's spatial index; the first call makes it and stores it with the set.

    Parameters
    ----------
    fiblets : FibletSet
        In memory or mapped. All of it is decoded, a leaf at a time; 32 bytes for each of four million fiblets are
        taken meanwhile.
    """
    held = fiblets.__dict__.get(KEY)
    if held is None:
        held = fiblets.__dict__[KEY] = _built(fiblets)
    elif not isinstance(held, FibletIndex):
        held = fiblets.__dict__[KEY] = _checked(fiblets, _of_file(*held))
    return held


def _of_file(order: Any, leaves: Any, pieces: Any) -> FibletIndex:
    return FibletIndex(fixed(order), fixed(leaves), fixed(pieces))


def _checked(fiblets: FibletSet, index: FibletIndex) -> FibletIndex:
    """Check the contents of a file, so that no kernel reads beyond its arrays."""
    n, parts = fiblets.n_fiblets, index.parts if index.pieces.ndim == 2 else 0
    whole, rest = divmod(n, CHUNK)
    n_leaves = whole * (CHUNK // LEAF) + -(-rest // LEAF)
    fits = parts >= 1 and index.pieces.shape == (n, 4 * parts + 3) and index.pieces.dtype == np.uint8
    fits = fits and index.leaves.shape == (n_leaves, 4 * parts + 5) and index.leaves.dtype == np.float32
    fits = fits and index.order.shape == (n,) and index.order.dtype == np.uint32
    if not fits or (n and int(index.order.max()) >= n):
        raise FormatError("the set of fiblets", None, "a spatial index that is not of its fiblets",
                          "an undamaged file: make the set anew")  # fmt: skip
    return index


def _parts(fiblets: FibletSet) -> int:
    """Into how many parts fiblets are cut: as many as bring most points near their chords."""
    every = max(fiblets.n_fiblets // 100_000, 1)
    reach = np.asarray(fiblets.reach[::every]) * fiblets.reach_scale
    bend = float(np.percentile(reach, 75)) if len(reach) else 0.0
    # The sagitta of an arc falls by the square of its length.
    return next((parts for parts in (1, 2) if bend / parts**2 <= NEAR), 4)


def _built(fiblets: FibletSet) -> FibletIndex:
    from . import index_kernels as kernels

    begin = time.perf_counter()
    prefer_kernels("decoding")
    n, parts = fiblets.n_fiblets, _parts(fiblets)
    arrays = decoding_arrays(fiblets)
    low, fine, origin, scale = arrays[1:5]
    anchors, ends, bases, end_scale = arrays[0][0], fixed(fiblets.ends), fixed(fiblets.pages[:, 0]), fiblets.end_scale
    order, pieces = np.empty(n, np.uint32), np.empty((n, 4 * parts + 3), np.uint8)
    held = [np.empty((0, 4 * parts + 5), np.float32)]
    for first in range(0, n, CHUNK):
        m = min(CHUNK, n - first)
        keys, places = np.empty((m, 6), np.float32), np.arange(m)
        kernels.chords(first, anchors, low, fine, ends, bases, origin, scale, end_scale, keys)
        ranges = np.array([[0, m]])
        for _ in range(6):
            middles = np.empty(len(ranges), np.int64)
            kernels.sort_once(keys, places, ranges, middles)
            ranges = np.concatenate([np.stack([ranges[:, 0], middles], 1), np.stack([middles, ranges[:, 1]], 1)])
            ranges = ranges[ranges[:, 1] > ranges[:, 0]]
        kernels.sort_parts(keys, places, ranges)
        del keys
        order[first : first + m] = places + first
        found = np.zeros((-(-m // LEAF), 4 * parts + 5), np.float32)
        damaged = np.zeros(len(found), np.bool_)
        kernels.leaf_pieces(fixed(order[first : first + m]), *arrays, parts, found, pieces[first : first + m], damaged)
        if damaged.any():
            raise FormatError("the set of fiblets", None, "records that point beyond its arrays", "an undamaged file")
        held.append(found)
    return FibletIndex(fixed(order), fixed(np.concatenate(held)), fixed(pieces), time.perf_counter() - begin)


def fiblets_of_streamlines(fiblets: FibletSet) -> npt.NDArray[np.int32]:
    """Return how many fiblets each streamline has, ``(n_streamlines,)``."""
    begins = np.flatnonzero(unpack("begin", fiblets.anchors))
    counts = np.diff(np.append(begins, fiblets.n_fiblets)).astype(np.int32)
    if fiblets.rank_to_id is None:
        return counts
    out = np.zeros(fiblets.n_streamlines, np.int32)
    out[fiblets.rank_to_id] = counts
    return out
