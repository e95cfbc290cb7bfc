"""ShardedSet: a set whose shards are fetched and mapped at first use."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ...errors import FormatError
from ...streamlines import Streamlines
from ..check import check_file
from ..decompress import held_in_bounds
from ..editing.join import concatenate
from .manifest import MANIFEST, Bounds, Manifest, Shard
from .store import Cache, Folder, Remote, store_at

if TYPE_CHECKING:
    from ..fibletset import FibletSet

Ints = npt.NDArray[np.int64]


class ShardedSet:
    """A set in shards, in a folder or at an address.

    Made by :meth:`open`. Opening reads the manifest, and no shard.
    """

    def __init__(self, manifest: Manifest, store: Folder | Remote) -> None:
        self.manifest, self._store = manifest, store
        self._ids: dict[int, Ints] = {}

    @classmethod
    def open(cls, place: str | PathLike[str], *, cache: Cache | None = None, **options: Any) -> ShardedSet:
        """Read the manifest of a set.

        Parameters
        ----------
        place : str or PathLike
            A folder, or an address that fsspec reads, such as ``https://host/whole.fiblets`` or
            ``s3://bucket/whole.fiblets``.
        cache : Cache, optional
            Where fetched shards are kept: by default 10 GB in the user's cache folder.
        **options
            Of the file system, as fsspec takes them.

        Raises
        ------
        FormatError
            If there is no manifest, or it is damaged.
        OSError
            If an address cannot be reached.
        ImportError
            If fsspec, or its package for this type of address, is not installed.
        """
        store = store_at(place, cache, **options)
        try:
            text = store.read(MANIFEST)
        except (FileNotFoundError, NotADirectoryError):
            raise FormatError(
                fspath(place), None, f"no {MANIFEST}", "a folder that `pvfiblets convert --shards` made"
            ) from None
        return cls(Manifest.from_json(text, fspath(place)), store)

    def __len__(self) -> int:
        return self.manifest.streamlines

    def __repr__(self) -> str:
        m = self.manifest
        return (
            f"ShardedSet({m.streamlines} streamlines, {m.points} points, {len(m.shards)} shards, "
            f"{f'promise {m.promise_mm:g} mm' if m.promise_mm else 'exact'})"
        )

    @property
    def shards(self) -> tuple[Shard, ...]:
        """Contents of each shard, from the manifest."""
        return self.manifest.shards

    @property
    def n_points(self) -> int:
        """Points of all shards."""
        return self.manifest.points

    @property
    def bounds(self) -> Bounds:
        """True bounds ``(xmin, xmax, ymin, ymax, zmin, zmax)``, mm."""
        return self.manifest.bounds

    @property
    def nbytes(self) -> int:
        """Bytes of all shards' files, each streamline once."""
        return sum(shard.fiblets.bytes for shard in self.shards)

    def shard(self, number: int) -> FibletSet:
        """Map one shard; its streamlines are numbered from 0, and :meth:`ids` says which of the whole they are.

        Raises
        ------
        IndexError
            If there is no such shard.
        FormatError
            If its file is missing or damaged.
        """
        from ..fibletset import FibletSet

        return self._opened(self._shard(number), FibletSet)

    def thinned(self) -> tuple[FibletSet, Ints] | None:
        """Map the even share of all streamlines, if the set has one, with the numbers that they have in the whole."""
        from ..fibletset import FibletSet

        shard = self.manifest.thinned
        return None if shard is None else (self._opened(shard, FibletSet), self._numbers(shard))

    def is_here(self, number: int) -> bool:
        """Whether a shard's files are on this machine."""
        shard = self._shard(number)
        return self._store.is_here(shard.fiblets) and self._store.is_here(shard.ids)

    def fetch(self, number: int) -> None:
        """Fetch a shard's files to this machine."""
        shard = self._shard(number)
        self._store.local(shard.fiblets)
        self._store.local(shard.ids)

    @property
    def name(self) -> str:
        """Its folder, or its address."""
        return self._store.name

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_ids": {}}  # a receiver reads its own

    def _opened(self, shard: Shard, kind: type[FibletSet]) -> FibletSet:
        part = kind.open(self._store.local(shard.fiblets))
        if len(part) != shard.streamlines or part.n_points != shard.points:
            raise FormatError(
                f"{self._store.name}/{shard.fiblets.name}",
                None,
                f"{len(part)} streamlines of {part.n_points} points",
                f"the {shard.streamlines} of {shard.points} that its manifest names",
            )
        return part

    def place(self, number: int) -> Path:
        """Return the path of a shard's file on this machine, fetched if need be."""
        return self._store.local(self._shard(number).fiblets)

    def ids(self, number: int) -> Ints:
        """``(n,)`` int64: the numbers that a shard's streamlines have in the whole, rising."""
        number = self._number(number)
        if number not in self._ids:
            self._ids[number] = self._numbers(self._shard(number))
        return self._ids[number]

    def _numbers(self, shard: Shard) -> Ints:
        path = self._store.local(shard.ids)
        try:
            found: Ints = np.load(path, allow_pickle=False)
        except (ValueError, EOFError) as error:
            raise FormatError(path, None, f"no array ({error})", f"{shard.streamlines} numbers") from error
        good = found.shape == (shard.streamlines,) and found.dtype == np.int64 and bool((np.diff(found) > 0).all())
        if not good or (len(found) and not 0 <= found[0] <= found[-1] < len(self)):
            raise FormatError(path, None, f"{found.dtype}{found.shape}", f"{shard.streamlines} rising numbers")
        return found

    def within(self, bounds: npt.ArrayLike) -> FibletSet:
        """Gather the shards that meet a box ``(xmin, xmax, ymin, ymax, zmin, zmax)``, mm; see :meth:`gather`.

        Streamlines that lie in these shards are there as a whole, and need not meet the box themselves.
        """
        return self.gather(self.manifest.meeting(bounds))

    def gather(self, numbers: Iterable[int] | None = None) -> FibletSet:
        """Put shards together, in memory.

        Parameters
        ----------
        numbers : iterable of int, optional
            Which shards; all by default.

        Returns
        -------
        FibletSet
            Streamlines in the order that they have in the whole; all shards together number them as the whole does.
            Every point decodes to the same bits.

        Raises
        ------
        IndexError
            If there is no such shard.
        FormatError
            If a file is missing or damaged.
        """
        chosen = list(range(len(self.shards))) if numbers is None else sorted({self._number(n) for n in numbers})
        whole = self._joined([(self.shard(n), self.ids(n)) for n in chosen])
        if len(chosen) == len(self.shards):
            whole = replace(whole, bounds=self.bounds)
        return whole

    def __getitem__(self, ids: slice) -> FibletSet:
        """Take consecutive streamlines, ``shards[1000:2000]``, as a set in memory; only they are read."""
        if not isinstance(ids, slice):
            raise TypeError(f"{ids!r} names no streamlines; give a slice such as [1000:2000], or gather() all")
        start, stop, step = ids.indices(len(self))
        if step != 1:
            raise ValueError(f"a slice in steps of {step}; consecutive streamlines, in steps of 1, are needed")
        parts = []
        for number in range(len(self.shards)):
            found = self.ids(number)
            a, b = np.searchsorted(found, [start, max(stop, start)])
            if b > a:
                parts.append((self.shard(number).extract(slice(int(a), int(b))), found[a:b]))
        return self._joined(parts)

    def iter_chunks(self, max_points: int = 2_000_000) -> Iterator[Streamlines]:
        """Decode all streamlines in their order, at most `max_points` points at a time but for a single one of more.

        Points lie within :attr:`bounds`, as in the result of :func:`pvfiblets.read`.
        """
        share = max(int(max_points * len(self) / max(self.n_points, 1)), 1)
        for start in range(0, len(self), share):
            part = replace(self[start : start + share], bounds=self.bounds)
            yield from held_in_bounds(part, part.iter_chunks(max_points))

    def verify(self) -> None:
        """Check every byte and record of every shard, and that each streamline stands in exactly one.

        Raises
        ------
        FormatError
            If a shard is damaged; the message names it.
        """
        seen = np.zeros(len(self), bool)
        for number in range(len(self.shards)):
            check_file(self.shard(number), self.place(number))
            ids = self.ids(number)
            if seen[ids].any():
                twice = int(ids[seen[ids]][0])
                raise FormatError(self._store.name, None, f"streamline {twice} in two shards", "each in one")
            seen[ids] = True
        if (thinned := self.manifest.thinned) is not None:
            part = self._opened(thinned, type(self.shard(0)))
            check_file(part, self._store.local(thinned.fiblets))
            self._numbers(thinned)

    def _joined(self, parts: list[tuple[FibletSet, Ints]]) -> FibletSet:
        """Parts of the whole as one set, in the order of the numbers that their streamlines have."""
        if not parts:
            return self.shard(0).extract(slice(0, 0))
        numbers = np.concatenate([ids for _, ids in parts])
        places = np.empty(len(numbers), np.int64)
        places[np.argsort(numbers)] = np.arange(len(numbers))
        return renumbered(concatenate(part for part, _ in parts), places, len(places), self.manifest.dropped)

    def _number(self, number: int) -> int:
        n = len(self.shards)
        if not -n <= number < n:
            raise IndexError(f"shard {number} is not among the {n} shards (0..{n - 1})")
        return number % n

    def _shard(self, number: int) -> Shard:
        return self.shards[self._number(number)]


def renumbered(joined: FibletSet, places: Ints, count: int, dropped: Mapping[str, int]) -> FibletSet:
    """Give the streamlines of parts that stand behind each other the numbers that they have together."""
    old = np.arange(joined.n_ranks) if joined.rank_to_id is None else np.asarray(joined.rank_to_id)
    ids = places[old]
    plain = len(ids) == count and bool((ids == np.arange(count)).all())
    order = np.argsort(places)
    return replace(
        joined,
        n_streamlines=count,
        rank_to_id=None if plain else ids,
        per_streamline={name: np.asarray(rows)[order] for name, rows in joined.per_streamline.items()},
        groups={name: np.sort(places[np.asarray(members, np.int64)]) for name, members in joined.groups.items()},
        dropped=dict(dropped),
    )
