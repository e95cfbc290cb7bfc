"""Streamlines of any kind of set, some at a time."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from ...streamlines import Streamlines

if TYPE_CHECKING:
    from ...codec.fibletset import FibletSet

CHUNK = 1 << 21  # points decoded together: 50 MB

def without_groups(data: FibletSet | Streamlines) -> Any:
    """Return the same streamlines without groups, which every part would search through, and without losses."""
    if not isinstance(data, Streamlines):
        return replace(data, groups={}, per_group={})
    return Streamlines(
        data.points, data.offsets, data.per_point, data.per_streamline, affine=data.affine, space=data.space
    )


def chunks_of(data: FibletSet | Streamlines) -> Iterator[Streamlines]:
    """Consecutive streamlines; points of float64 at most a chunk at a time."""
    if isinstance(data, Streamlines):
        for start, stop in data.blocks(CHUNK):
            yield data[start:stop]
    else:
        yield from data.iter_chunks(CHUNK)
