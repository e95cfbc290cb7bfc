"""Streamlines as files of any format."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pvfiblets.web.loading import Watch

if TYPE_CHECKING:
    import numpy as np

    from pvfiblets.web.loading import Cancel, Progress

__all__ = ["EXPORTS", "write"]

EXPORTS = (".trk", ".trx", ".tck", ".vtp", ".vtk", ".fiblets")
"""Suffixes of files that streamlines can be written to, everywhere on the page."""


def write(
    fiblets: Any, ids: np.ndarray, target: Path, progress: Progress | None = None, cancel: Cancel | None = None
) -> dict[str, Any]:
    """Write some streamlines of a set to a file; may run in a thread of its own.

    Parameters
    ----------
    fiblets : FibletSet
    ids : ndarray of int
    target : Path
        Its suffix says the format.
    progress, cancel : callable, optional
        See :meth:`.Files.load`. It is asked between pieces, and last when the file is written.

    Returns
    -------
    dict
        ``streamlines``, ``bytes``, and ``lost``: what the format cannot hold.

    Raises
    ------
    Cancelled
        If `cancel` said so; there is no file then.
    """
    watch = Watch(progress, cancel)
    watch("choosing", 0.0)
    part = fiblets if len(ids) == fiblets.n_streamlines else fiblets.extract(ids)
    watch("writing", 0.0)
    try:
        lost = _write_whole(part, target, watch)
        watch("writing", 1.0)
    except BaseException:
        target.unlink(missing_ok=True)
        raise
    return {"streamlines": len(ids), "bytes": target.stat().st_size, "lost": list(lost)}


def _write_whole(part: Any, target: Path, watch: Watch) -> list[str]:
    """Write a set, as its own ``save`` does; other formats' points are decoded first, which is a part of the time."""
    from pvfiblets import formats
    from pvfiblets.formats.spool import gathered

    if formats.registry.suffix_of(target) == ".fiblets" or not len(part):
        return list(part.save(target))

    def pieces() -> Iterator[Any]:
        done = 0
        for piece in part.iter_chunks():
            yield piece
            done += piece.n_points
            watch("decoding", 0.7 * done / max(part.n_points, 1))

    with gathered(pieces(), target.parent) as streamlines:
        watch("writing", 0.7)
        return formats.write(target, streamlines)
