"""`ShardParts`: shards of a set as the parts that come to the GPU one by one.

A shard above the size limit of a part is divided once more (:class:`.Stretches`). The manifest holds the bounds of
shards, so shards outside of the view are not read; shards at an address are fetched in the background while pictures
of the available data go on.
"""

from __future__ import annotations

import math
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from ....codec.editing.join import concatenate
from ....codec.editing.restrict import even_share, restrict
from ....codec.shards.unread_set import UnreadSet
from .parts import Box, Parts, Stretches

if TYPE_CHECKING:
    from ....codec.fibletset import FibletSet

FETCHED_AT_ONCE = 2  # connections; a third would take bandwidth from the parts in view


class ShardParts:
    """Parts of a set in shards."""

    by_streamline = False

    def __init__(self, fiblets: UnreadSet, part_bytes: int) -> None:
        self.whole: FibletSet = fiblets
        self._set = fiblets
        self._open: tuple[int, Stretches] | None = None
        self._pool: ThreadPoolExecutor | None = None
        self._fetching: dict[int, Future[None]] = {}
        # Shard, which of its stretches, and how many these are.
        self._places: list[tuple[int, int, int]] = []
        for number in fiblets.numbers:
            count = max(math.ceil(_gpu_bytes(fiblets, number) / part_bytes), 1)
            self._places += [(number, k, count) for k in range(count)]

    def __len__(self) -> int:
        return len(self._places)

    def box(self, number: int) -> Box | None:
        """Return bounds of a part's shard."""
        shard = self._set.shards.shards[self._places[number][0]]
        if not shard.points:
            return None
        found = np.asarray(shard.bounds, np.float64).reshape(3, 2).T.copy()
        slack = self._set.promise + 8.0 * np.spacing(np.abs(found).max())
        return found + np.array([[-slack], [slack]])

    def ids(self, number: int) -> npt.NDArray[np.int64]:
        """Return the numbers of the streamlines of a part's shard."""
        return self._set.shards.ids(self._places[number][0])

    def is_here(self, number: int) -> bool:
        """Whether a part can be had at once; if not, it is being fetched from now on, if not too many others are."""
        shard = self._places[number][0]
        # All of them: one may have arrived, been drawn and dropped before its thread has ended.
        for fetched in [one for one, future in self._fetching.items() if future.done()]:
            self._fetching.pop(fetched).result()
        if self._set.shards.is_here(shard):
            return True
        if shard not in self._fetching and len(self._fetching) < FETCHED_AT_ONCE:
            self._pool = self._pool or ThreadPoolExecutor(FETCHED_AT_ONCE, "shards")
            self._fetching[shard] = self._pool.submit(self._set.shards.fetch, shard)
        return False

    def wait(self, seconds: float) -> None:
        """Wait until another part is here, no longer than that."""
        wait(list(self._fetching.values()), seconds, FIRST_COMPLETED)

    def part(self, number: int) -> FibletSet:
        """Read a part; fetch it if need be."""
        shard, k, count = self._places[number]
        if count == 1:
            return self._set.numbered(shard)
        if self._open is None or self._open[0] != shard:
            self._open = shard, Stretches.of_count(self._set.numbered(shard), count)
        stretches = self._open[1]
        return stretches.part(k) if k < len(stretches) else restrict(stretches.whole, np.zeros(0, np.int64))

    def thinned(self, nbytes: int) -> FibletSet:
        """Return an even share of all streamlines; of sets without one, put together from all shards."""
        part = self._set.thinned()
        if part is None:
            share = min(nbytes / max(gpu_bytes_of_shards(self._set), 1), 1.0)
            numbers = self._set.numbers
            kept = [restrict(part, even_share(part, share)) for part in map(self._set.numbered, numbers)]
            names = [np.asarray(one.rank_to_id) for one in kept]
            return replace(concatenate(kept), n_streamlines=self.whole.n_streamlines, rank_to_id=np.concatenate(names))
        share = min(nbytes / max(part.nbytes * GPU_SHARE, 1.0), 1.0)
        return part if share == 1.0 else restrict(part, even_share(part, share))


GPU_SHARE = 1.3
"""Bytes on the GPU for each in memory, at most: records and codes as they are, tables of pages, marks, and values."""


def _gpu_bytes(fiblets: UnreadSet, number: int) -> int:
    return int(GPU_SHARE * fiblets.shards.shards[number].nbytes)


def gpu_bytes_of_shards(fiblets: UnreadSet) -> int:
    """Return how much GPU memory a set in shards would take, as far as its manifest tells."""
    return sum(_gpu_bytes(fiblets, number) for number in fiblets.numbers)


def in_memory(fiblets: FibletSet) -> FibletSet:
    """Return a set whose records are here: shards put together, any other set as it is."""
    return fiblets.gathered if isinstance(fiblets, UnreadSet) else fiblets


def parts_of(fiblets: FibletSet, gpu_bytes: int, part_bytes: int) -> Parts:
    """Return the parts that a set is drawn in."""
    return (
        ShardParts(fiblets, part_bytes) if isinstance(fiblets, UnreadSet) else Stretches(fiblets, gpu_bytes, part_bytes)
    )


class ShardGroups:
    """Shards of a set in runs of about the same number of fiblets, for workers that read them themselves."""

    def __init__(self, fiblets: UnreadSet, count: int) -> None:
        self._set = fiblets
        sizes = np.array([max(fiblets.shards.shards[n].n_fiblets, 1) for n in fiblets.numbers])
        count = max(min(count, len(sizes)), 1)
        middles = np.cumsum(sizes) - sizes / 2.0
        places = np.minimum((middles * count / sizes.sum()).astype(int), count - 1)
        # Each has one at least: an empty one takes its neighbour's.
        last = len(sizes) - count + np.arange(count)
        places[:count] = np.minimum(places[:count], np.arange(count))
        places[last] = np.maximum(places[last], np.arange(count))
        numbers = np.array(fiblets.numbers)
        self._groups = [[int(n) for n in numbers[places == group]] for group in range(count)]

    def __len__(self) -> int:
        return len(self._groups)

    def part(self, number: int) -> UnreadSet:
        """Return the set of a group's shards, which are not read."""
        return self._set.of_shards(self._groups[number])

    def ids(self, number: int) -> npt.NDArray[np.int64]:
        """Return the numbers of a group's streamlines that have points, in the order in which they are coded."""
        return np.concatenate([self._set.ids_of_ranks(shard) for shard in self._groups[number]])
