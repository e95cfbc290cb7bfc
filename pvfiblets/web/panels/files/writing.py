"""Streamlines as files of any format."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pvfiblets.web.scene.files.loading import Watch

if TYPE_CHECKING:
    import numpy as np

    from pvfiblets.codec.fibletset import FibletSet
    from pvfiblets.web.scene.files.loading import Cancel, Progress
    from pvfiblets.web.scene.files.originals import Original

EXPORTS = (".trk", ".trx", ".tck", ".vtp", ".vtk", ".fiblets")
"""Suffixes of files that streamlines can be written to, everywhere on the page."""


def write(
    fiblets: FibletSet,
    ids: np.ndarray,
    target: Path,
    progress: Progress | None = None,
    cancel: Cancel | None = None,
    original: Original | None = None,
) -> dict[str, Any]:
    """Write some streamlines of a set to a file; may run in a thread of its own."""
    # A `.fiblets` file gets the records as they are. Other formats get the points of the file that the set was made
    # from, where that is given.
    watch = Watch(progress, cancel)
    watch("choosing", 0.0)
    part = fiblets if len(ids) == fiblets.n_streamlines else fiblets.extract(ids)
    watch("writing", 0.0)
    try:
        lost = _write_whole(part, target, watch, original)
        watch("writing", 1.0)
    except BaseException:
        target.unlink(missing_ok=True)
        raise
    exact = part.exact is not None or (original is not None and not _is_coded(target))
    error = 0.0 if exact else float(fiblets.promise)
    return {"streamlines": len(ids), "bytes": target.stat().st_size, "lost": list(lost), "error_mm": error}


def _is_coded(target: Path) -> bool:
    from pvfiblets.formats.registry import suffix_of

    return suffix_of(target) == ".fiblets"


def _write_whole(part: Any, target: Path, watch: Watch, original: Original | None) -> list[str]:
    """Write a set, as its own ``save`` does; other formats' points are decoded first, which is a part of the time."""
    from pvfiblets import formats
    from pvfiblets.formats.spool import gathered

    if _is_coded(target):
        return list(part.save(target))
    if original is not None:
        with gathered(original.chunks(watch), target.parent) as streamlines:
            watch("writing", 0.7)
            return formats.write(target, streamlines)
    if not len(part):
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
