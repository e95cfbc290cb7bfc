"""Some streamlines of a set as a smaller set, renumbered from 0, without decompressing; and a set in another format.

Records are copied as they are (:mod:`.restrict`), so that every point decodes to the same bits as in the whole. What
changes is what goes by a streamline's number: :attr:`.FibletSet.rank_to_id`, rows of per-streamline arrays, and the
members of groups. :func:`.restrict` is the other sort of part, whose streamlines keep their numbers.
"""

from __future__ import annotations

from dataclasses import replace
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ..decompress import held_in_bounds, iter_chunks, select_streamlines
from .restrict import restrict

if TYPE_CHECKING:
    from ..fibletset import FibletSet

Ints = npt.NDArray[np.int64]
Bounds = tuple[float, float, float, float, float, float]


def extract(fiblets: FibletSet, ids: Any) -> FibletSet:
    """Take some streamlines as a set of their own."""
    chosen = once(select_streamlines(fiblets.n_streamlines, ids))
    part = restrict(fiblets, chosen)
    number = np.full(fiblets.n_streamlines, -1, np.int64)
    number[chosen] = np.arange(len(chosen))
    # `restrict` names the ranks by the whole's numbers, unless it took every streamline in its own order.
    old = np.arange(part.n_ranks) if part.rank_to_id is None else np.asarray(part.rank_to_id)
    fresh = number[old]
    plain = len(fresh) == len(chosen) and bool((fresh == np.arange(len(fresh))).all())
    groups = {}
    for name, members in fiblets.groups.items():
        kept = number[np.asarray(members, np.int64)]
        groups[name] = kept[kept >= 0]
    part = replace(
        part,
        n_streamlines=len(chosen),
        rank_to_id=None if plain else fresh,
        per_streamline={name: np.asarray(rows)[chosen] for name, rows in fiblets.per_streamline.items()},
        groups=groups,
        per_group={name: dict(values) for name, values in fiblets.per_group.items()},
        space=dict(fiblets.space),
        dropped=dict(fiblets.dropped),
    )
    return replace(part, bounds=exact_bounds(part))


def once(ids: Ints) -> Ints:
    """Return each number where it stands first."""
    if len(ids) < 2 or bool((np.diff(ids) > 0).all()):
        return ids
    first = np.unique(ids, return_index=True)[1]
    return ids[np.sort(first)]


def exact_bounds(fiblets: FibletSet) -> Bounds:
    """Bounds of the decoded points, chunk by chunk."""
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    bare = replace(fiblets, per_point={}, per_streamline={}, groups={}, per_group={})
    for chunk in held_in_bounds(bare, iter_chunks(bare, dtype=np.float64)):
        if chunk.n_points:
            low, high = np.minimum(low, chunk.points.min(axis=0)), np.maximum(high, chunk.points.max(axis=0))
    if not (low <= high).all():
        return (0.0,) * 6
    b = np.stack([low, high], axis=1).ravel().tolist()
    return (b[0], b[1], b[2], b[3], b[4], b[5])


def save_as(fiblets: FibletSet, path: str | PathLike[str]) -> list[str]:
    """Write a set to a file of any format that can be written, in bounded memory; see :meth:`.FibletSet.save`."""
    from ...formats import registry, write
    from ...formats.spool import gathered
    from ...support.whole_files import naming_target

    registry.module_for(path, "write")  # before the decoding, not after
    chunks = fiblets.iter_chunks() if len(fiblets) else iter([fiblets.decompress()])
    with naming_target(path), gathered(held_in_bounds(fiblets, chunks), Path(path).resolve().parent) as streamlines:
        return write(path, streamlines)
