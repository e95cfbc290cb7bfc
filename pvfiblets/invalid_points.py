"""Points whose coordinates are no numbers (NaN, infinite): refused, left out, or places where lines end.

And those so far away that float32, which is what graphics cards compute with, ends before.
"""

from __future__ import annotations

from typing import Any, Literal, get_args

import numpy as np

from .streamlines import Streamlines

__all__ = ["LARGEST", "Invalid", "refuse_beyond", "valid_points"]

Invalid = Literal["error", "drop", "split"]

COUNTED = "non-finite points"
LARGEST = 1e35  # mm


def refuse_beyond(reach: float) -> None:
    """Refuse coordinates that float32 does not hold.

    Parameters
    ----------
    reach : float
        The largest magnitude of all finite coordinates, mm.

    Raises
    ------
    ValueError
        If it is beyond `LARGEST`.
    """
    if reach > LARGEST:
        raise ValueError(
            f"a coordinate of {reach:g} mm is beyond {LARGEST:g} mm, where float32 ends: check the units"
        )


def valid_points(streamlines: Streamlines, nan: Invalid) -> Streamlines:
    """Return streamlines of finite points.

    Parameters
    ----------
    streamlines : Streamlines
        Stay as they are.
    nan : {'error', 'drop', 'split'}
        ``'error'`` returns them as they are: what looks at points refuses them. ``'drop'`` leaves points out with their
        data, so that the line goes on from the point before to the point after. ``'split'`` ends the line there: each
        piece is a streamline, with the data and the groups of the whole.

    Returns
    -------
    Streamlines
        ``dropped`` counts the points. A streamline of which none is left stays as one without points.

    Raises
    ------
    ValueError
        If `nan` is another word.
    """
    if nan not in get_args(Invalid):
        raise ValueError(f"nan is {nan!r}; choose one of {get_args(Invalid)}")
    if nan == "error":
        return streamlines
    good: Any = np.isfinite(streamlines.points).all(axis=1)
    if good.all():
        return streamlines
    offsets = np.asarray(streamlines.offsets)
    owners = np.repeat(np.arange(len(streamlines)), np.diff(offsets))
    if nan == "drop":
        pieces = np.arange(len(streamlines))
        counts = np.bincount(owners[good], minlength=len(streamlines))
    else:
        begins = good.copy()
        begins[1:] &= ~(good[:-1] & (owners[1:] == owners[:-1]))
        of_points = owners[begins]
        counts = np.diff(np.flatnonzero(begins[good]), append=int(good.sum()))
        gone = np.setdiff1d(np.arange(len(streamlines)), of_points)
        pieces = np.concatenate([of_points, gone])
        order = np.argsort(pieces, kind="stable")
        pieces, counts = pieces[order], np.concatenate([counts, np.zeros(len(gone), np.int64)])[order]
    first = np.searchsorted(pieces, np.arange(len(streamlines) + 1))
    groups = {name: _of_pieces(np.asarray(members), first) for name, members in streamlines.groups.items()}
    dropped = {**streamlines.dropped}
    dropped[COUNTED] = dropped.get(COUNTED, 0) + int(np.count_nonzero(~good))
    return Streamlines(
        np.asarray(streamlines.points)[good],
        np.concatenate([[0], np.cumsum(counts)]).astype(np.int64),
        {name: np.asarray(rows)[good] for name, rows in streamlines.per_point.items()},
        {name: np.asarray(rows)[pieces] for name, rows in streamlines.per_streamline.items()},
        groups,
        streamlines.per_group,
        streamlines.affine,
        streamlines.space,
        dropped,
    )


def _of_pieces(members: Any, first: Any) -> Any:
    """Return the numbers of the pieces of some streamlines, which follow each other."""
    counts = first[members + 1] - first[members]
    begins = np.cumsum(counts) - counts
    return np.arange(int(counts.sum())) + np.repeat(first[members] - begins, counts)
