"""Sense checks of fiblet records, so that a damaged file ends in an error and not in foreign memory."""

from __future__ import annotations

from os import PathLike
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from ..errors import FormatError
from .layout import DIRECTION, LATTICE8, MAX_POINTS, PAGE, WIDE, WIDE_HEADER, unpack

if TYPE_CHECKING:
    from .fibletset import FibletSet

__all__ = ["check_records", "code_bytes"]


def code_bytes(decoding: npt.NDArray[np.uint32]) -> npt.NDArray[np.int64]:
    """Bytes of codes of each fiblet, ``(n,)``, from its ``decoding`` words ``(n, 3)``."""
    kind = unpack("kind", decoding)
    last = unpack("last", decoding).astype(np.int64)
    width = np.where(kind == WIDE, unpack("step", decoding) & 7, np.where(kind == LATTICE8, 1, 2)).astype(np.int64)
    size = last * width + np.where(kind == WIDE, WIDE_HEADER, 0)
    return np.where(kind == DIRECTION, np.maximum(last - 1, 0), size)


def check_records(fiblets: FibletSet, path: str | PathLike[str] = "fiblets in memory") -> None:
    """Check that records and pages agree with each other.

    Parameters
    ----------
    fiblets : FibletSet
        The set.
    path : str or PathLike
        What errors call it.

    Raises
    ------
    FormatError
        Naming the first fiblet that is damaged and how.
    """
    table = fiblets.pages
    point, rank = 0, -1
    for page in range(len(table) - 1):
        rows = slice(page * PAGE, min((page + 1) * PAGE, fiblets.n_fiblets))
        decoding, anchors = fiblets.decoding[rows], fiblets.anchors[rows]
        counts = unpack("last", decoding).astype(np.int64) + 1
        sizes = code_bytes(decoding)
        starts = unpack("code", decoding) + table[page, 1]
        points = unpack("point", decoding) + table[page, 2]
        ranks = unpack("rank", anchors) + table[page, 0]
        begins, ends = unpack("begin", anchors).astype(bool), unpack("end", anchors).astype(bool)
        width = unpack("step", decoding) & 7
        expected_points = point + np.concatenate([[0], np.cumsum(counts[:-1])])
        expected_ranks = rank + np.cumsum(begins)
        for bad, what in (
            (counts > MAX_POINTS, "more than 60 points"),
            (starts + sizes > len(fiblets.codes), "codes beyond the end"),
            (starts != table[page, 1] + np.concatenate([[0], np.cumsum(sizes[:-1])]), "codes that do not follow on"),
            (points != expected_points, "points that do not follow on"),
            (ranks != expected_ranks, "a streamline that does not follow on"),
            ((unpack("kind", decoding) == WIDE) & ((width < 1) | (width > 4)), "codes of impossible width"),
            (np.append(False, begins[1:] != ends[:-1]), "begin and end marks that do not alternate"),
        ):
            if bad.any():
                fiblet = rows.start + int(np.flatnonzero(bad)[0])
                raise FormatError(path, None, f"fiblet {fiblet} with {what}", "records as written: make the file again")
        point, rank = int(points[-1] + counts[-1]), int(ranks[-1])
    ids = fiblets.rank_to_id
    if ids is not None and len(ids) and (ids[0] < 0 or ids[-1] >= fiblets.n_streamlines or (np.diff(ids) <= 0).any()):
        raise FormatError(
            path, None, "a rank_to_id that does not rise", f"streamlines 0..{fiblets.n_streamlines - 1} in order"
        )
    for name, members in fiblets.groups.items():
        if len(members) and not 0 <= int(np.min(members)) <= int(np.max(members)) < fiblets.n_streamlines:
            raise FormatError(path, None, f"group {name!r} with foreign streamlines", f"0..{fiblets.n_streamlines - 1}")
    if point != fiblets.n_points or rank + 1 != fiblets.n_ranks:
        raise FormatError(
            path, None, f"records of {point} points, {rank + 1} streamlines", f"{fiblets.n_points}, {fiblets.n_ranks}"
        )
