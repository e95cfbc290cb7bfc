"""`UnreadSet`: a :class:`.FibletSet` whose records stay in its shards until something asks for all of them.

Facts in the manifest and the first shard are available at once. Queries of single streamlines read
one shard after the other. Drawing takes shards as parts (:mod:`pvfiblets.engine.fiblets.parts.shard_parts`).
Records of the whole, such as ``anchors``, join all shards in memory, if they fit.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from functools import cached_property
from os import PathLike
from typing import Any

import numpy as np
import numpy.typing as npt

from ...streamlines import Streamlines
from ...support.memory import free_host_memory
from ..decompress import select_streamlines
from ..editing.extract import once
from ..editing.join import concatenate
from ..fibletset import FibletSet
from ..files.stored_parts import of_streamlines
from ..parameters import Parameters
from ..point_values import PointValues
from .sharded_set import ShardedSet, renumbered

Ints = npt.NDArray[np.int64]


class UnreadSet(FibletSet):
    """A set in shards with the interface of :class:`.FibletSet`."""

    def __new__(cls, *_: Any, **fields: Any) -> Any:
        """Make one; where `dataclasses.replace` gives records, a set in memory."""
        return FibletSet(**fields) if "parameters" in fields else object.__new__(cls)

    def __init__(self, shards: ShardedSet, numbers: Iterable[int] | None = None) -> None:
        self.shards = shards
        every = range(len(shards.shards))
        self.numbers = tuple(every if numbers is None else sorted(set(numbers)))
        self.bounds = shards.bounds
        self.n_streamlines = len(shards)
        self.dropped = dict(shards.manifest.dropped)
        self._own_order: dict[int, Ints] = {}

    @classmethod
    def open_shards(cls, place: str | PathLike[str]) -> FibletSet:
        """Open a folder of shards, or the address of one."""
        # Shards that keep every bit are put together in memory: they are coded anew for drawing, and not in the same
        # way for each alone as for all.
        shards = ShardedSet.open(place)
        found = cls(shards)
        return shards.gather() if found._first.exact is not None else found

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.shards, self.numbers)

    # ------------------------------------------------------------------------------------------ without reading records

    @property
    def n_points(self) -> int:
        """Points of all shards that count."""
        return sum(self.shards.shards[n].points for n in self.numbers)

    @property
    def n_fiblets(self) -> int:
        """Fiblets of all shards that count."""
        return sum(self.shards.shards[n].n_fiblets for n in self.numbers)

    @property
    def sizes(self) -> dict[str, int]:
        """Bytes of the shards in memory."""
        return {f"shard/{n:06}": self.shards.shards[n].nbytes for n in self.numbers}

    @property
    def n_ranks(self) -> int:
        """Streamlines that have points."""
        return sum(self.shards.shard(n).n_ranks for n in self.numbers)

    # The dataclass's stored fields are computed here on demand: checkers take that for another kind of attribute.

    exact = None  # sets that keep every bit are put together when they are opened

    @property
    def anchors_low(self) -> npt.NDArray[np.uint16] | None:  # type: ignore[override]
        """Lower halves of anchors, where there are any."""
        return None if self._first.anchors_low is None else self.gathered.anchors_low

    @cached_property
    def _first(self) -> FibletSet:
        return self.shards.shard(self.numbers[0] if self.numbers else 0)

    @cached_property
    def parameters(self) -> Parameters:  # type: ignore[override]
        """Parameters that all fiblets share."""
        return self._first.parameters

    @cached_property
    def affine(self) -> npt.NDArray[np.float64]:  # type: ignore[override]
        """Voxel to RAS mm of the source."""
        return self._first.affine

    @cached_property
    def space(self) -> dict[str, Any]:  # type: ignore[override]
        """Facts for writers of voxel-based formats."""
        return dict(self._first.space)

    @cached_property
    def per_group(self) -> dict[str, dict[str, Any]]:  # type: ignore[override]
        """Values of groups."""
        return {name: dict(values) for name, values in self._first.per_group.items()}

    @cached_property
    def groups(self) -> dict[str, npt.NDArray[Any]]:  # type: ignore[override]
        """Members of groups."""
        found: dict[str, list[Ints]] = {name: [] for name in self.shards.manifest.groups}
        for part, ids in self.parts():
            for name, members in part.groups.items():
                found.setdefault(name, []).append(ids[np.asarray(members, np.int64)])
        return {
            name: np.sort(np.concatenate(parts)) if parts else np.zeros(0, np.int64) for name, parts in found.items()
        }

    @cached_property
    def per_streamline(self) -> dict[str, npt.NDArray[Any]]:  # type: ignore[override]
        """Values of streamlines; zeros for those whose shard does not count."""
        found: dict[str, npt.NDArray[Any]] = {}
        for part, ids in self.parts():
            for name, rows in part.per_streamline.items():
                values = np.asarray(rows)
                if name not in found:
                    found[name] = np.zeros((self.n_streamlines, *values.shape[1:]), values.dtype)
                found[name][ids] = values
        return found

    @cached_property
    def per_point(self) -> dict[str, PointValues]:  # type: ignore[override]
        """Values of points, whose codes are read when somebody reads them."""
        return {
            # No array, but NumPy functions take it as one.
            name: replace(stored, codes=CodesOfShards(self, name, stored.codes.dtype))  # type: ignore[arg-type]
            for name, stored in self._first.per_point.items()
        }

    @cached_property
    def rank_to_id(self) -> Ints | None:  # type: ignore[override]
        """Streamline of each rank."""
        found = [self.ids_of_ranks(n) for n in self.numbers]
        ids = np.concatenate(found) if found else np.zeros(0, np.int64)
        plain = len(ids) == self.n_streamlines and bool((ids == np.arange(len(ids))).all())
        return None if plain else ids

    @property
    def is_here(self) -> bool:
        """Whether no shard need be fetched."""
        return all(self.shards.is_here(n) for n in self.numbers)

    def ids_of_ranks(self, number: int) -> Ints:
        """``(n_ranks,)`` number in the whole of each rank's streamline of a shard."""
        if number not in self._own_order:
            self._own_order[number] = _ranks_of(self.shards.shard(number), self.shards.ids(number))
        return self._own_order[number]

    # --------------------------------------------------------------------------------------------- shard after shard

    def parts(self) -> Iterator[tuple[FibletSet, Ints]]:
        """Yield each shard that counts, and ``(n,)`` int64: what its streamlines are called in the whole."""
        for number in self.numbers:
            yield self.shards.shard(number), self.shards.ids(number)

    def numbered(self, number: int) -> FibletSet:
        """Return a shard as a part of the whole: its streamlines have the whole's numbers, the others no points."""
        return self._as_part(self.shards.shard(number), self.ids_of_ranks(number))

    def thinned(self) -> FibletSet | None:
        """Return the even share of all streamlines as such a part, if the set has one."""
        found = self.shards.thinned()
        return None if found is None else self._as_part(found[0], _ranks_of(*found))

    def _as_part(self, part: FibletSet, names: Ints) -> FibletSet:
        return replace(
            part, n_streamlines=self.n_streamlines, rank_to_id=names, bounds=self.bounds, per_streamline={}, groups={},
            per_group={}, dropped={},
        )  # fmt: skip

    def of_shards(self, numbers: Iterable[int]) -> UnreadSet:
        """Return the part of some shards; the streamlines keep their numbers."""
        return UnreadSet(self.shards, numbers)

    def offsets(self) -> Ints:
        """``(n_streamlines + 1,)`` int64: where each streamline's points start; the last is ``n_points``."""
        counts = of_streamlines(self, lambda part: np.diff(part.offsets()), 0)
        return np.concatenate([[0], np.cumsum(counts)])

    def lengths(self) -> npt.NDArray[np.float64]:
        """Length of each streamline as decoded, ``(n_streamlines,)``, mm."""
        return of_streamlines(self, lambda part: part.lengths(), 0.0)

    def extract(self, ids: npt.ArrayLike | slice) -> FibletSet:
        """Take some streamlines as a set in memory; see :meth:`.FibletSet.extract`. Only they are read."""
        chosen = once(select_streamlines(self.n_streamlines, ids))
        order = np.argsort(chosen)
        rising = chosen[order]
        found, places = [], []
        for part, names in self.parts():
            at = np.searchsorted(names, rising)
            mine = np.flatnonzero(names[np.minimum(at, len(names) - 1)] == rising) if len(names) else at[:0]
            if len(mine):
                found.append(part.extract(at[mine]))
                places.append(order[mine])
        if not found:
            return self._first.extract(np.zeros(0, np.int64))
        return renumbered(concatenate(found), np.concatenate(places), len(chosen), self.dropped)

    def decompress(self, ids: npt.ArrayLike | None = None, *, dtype: npt.DTypeLike | None = None) -> Streamlines:
        """Decode to points; see :meth:`.FibletSet.decompress`. Only the requested streamlines are read."""
        wanted = select_streamlines(self.n_streamlines, slice(None) if ids is None else ids)
        once, again = np.unique(wanted, return_inverse=True)
        part = replace(self.extract(once), bounds=self.bounds)
        plain = len(once) == len(wanted) and bool((again == np.arange(len(again))).all())
        return part.decompress(None if plain else again, dtype=dtype or self.point_dtype())

    def iter_chunks(self, max_points: int = 2_000_000) -> Iterator[Streamlines]:
        """Decode consecutive streamlines, at most `max_points` points at a time but for a single streamline of more."""
        share = max(int(max_points * len(self) / max(self.n_points, 1)), 1)
        for start in range(0, len(self), share):
            yield from self.extract(slice(start, start + share)).iter_chunks(max_points)

    def verify(self) -> None:
        """Check every byte and record of every shard; see :meth:`.ShardedSet.verify`."""
        self.shards.verify()

    # ------------------------------------------------------------------------------------------------ all of it at once

    @cached_property
    def gathered(self) -> FibletSet:
        """The set in memory."""
        free = free_host_memory()
        if free is not None and self.nbytes > free:
            raise MemoryError(
                f"all {len(self.numbers)} shards together are {self.nbytes / 1e9:.1f} GB, and {free / 1e9:.1f} GB of "
                "memory are free; take a part, such as shards.within(box) or [a:b], draw by fit='stream', or let a "
                "cluster draw"
            )
        if len(self.numbers) == len(self.shards.shards):
            return self.shards.gather()
        if not self.numbers:
            return replace(self._first.extract(np.zeros(0, np.int64)), n_streamlines=self.n_streamlines,
                           rank_to_id=np.zeros(0, np.int64))  # fmt: skip
        joined = concatenate(self.numbered(number) for number in self.numbers)
        return replace(
            joined, n_streamlines=self.n_streamlines, rank_to_id=self.rank_to_id, bounds=self.bounds,
            per_streamline=self.per_streamline, groups=self.groups, per_group=self.per_group, dropped=self.dropped,
        )  # fmt: skip

    def save(self, path: str | PathLike[str], *, shards: int | None = None, small: bool = False) -> list[str]:
        """Write a file, or shards; see :meth:`.FibletSet.save`. All shards are put together for it."""
        return self.gathered.save(path, shards=shards, small=small)


def _ranks_of(part: FibletSet, ids: Ints) -> Ints:
    """Return the numbers that streamlines of a part's ranks have in the whole."""
    return ids if part.rank_to_id is None else ids[np.asarray(part.rank_to_id)]


def _of_gathered(name: str) -> property:
    return property(lambda self: getattr(self.gathered, name), doc=f"``{name}`` of all shards, put together.")


for _name in ("anchors", "decoding", "reach", "codes", "ends", "pages"):
    setattr(UnreadSet, _name, _of_gathered(_name))


class CodesOfShards:
    """Codes of one per-point array, in the order in which points are coded; an array for NumPy, read when it is."""

    ndim = 1

    def __init__(self, whole: UnreadSet, name: str, dtype: np.dtype[Any]) -> None:
        self._whole, self._name, self.dtype = whole, name, dtype
        self.shape = (whole.n_points,)

    def __len__(self) -> int:
        return self.shape[0]

    @property
    def nbytes(self) -> int:
        """Bytes of all codes."""
        return self.shape[0] * self.dtype.itemsize

    @cached_property
    def _read(self) -> npt.NDArray[Any]:
        parts = [np.asarray(part.per_point[self._name].codes) for part, _ in self._whole.parts()]
        return np.concatenate(parts) if parts else np.zeros(0, self.dtype)

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> npt.NDArray[Any]:
        return np.array(self._read, dtype, copy=True) if copy else np.asarray(self._read, dtype)

    def __getitem__(self, index: Any) -> Any:
        return self._read[index]

    def astype(self, *given: Any, **options: Any) -> npt.NDArray[Any]:
        """Return the codes as another type."""
        return self._read.astype(*given, **options)
