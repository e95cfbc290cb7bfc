"""A tractogram from one format to another, in pieces."""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from pvfiblets import formats
from pvfiblets.formats.spool import gathered
from pvfiblets.streamlines import Streamlines
from pvfiblets.support.unfinished import remove_unfinished
from pvfiblets.support.whole_files import naming_target

PIECE = 1 << 20  # points; larger pieces are no faster


def rewrite(source: str, target: str, max_points: int = PIECE, *, double: bool = False) -> dict[str, Any]:
    """Write a tractogram in another format, holding `max_points` at a time; return the keys of ``convert --json``."""
    begin = time.perf_counter()
    folder = Path(target).resolve().parent
    remove_unfinished(folder)
    gone = [0]

    def counted() -> Iterator[Streamlines]:
        for chunk in formats.iter_chunks(source, max_points):
            gone[0] += chunk.points.nbytes + sum(values.nbytes for values in chunk.per_point.values())
            yield chunk

    # Once in parts, once put together.
    with naming_target(target, lambda: 2 * gone[0]), gathered(counted(), folder) as streamlines:
        lost = formats.write(target, streamlines, double=double)
        n_streamlines, n_points = len(streamlines), streamlines.n_points
        dropped = dict(streamlines.dropped)
        for part in lost:
            dropped[f"{part}: {Path(target).suffix} cannot hold it"] = len(getattr(streamlines, part))
    seconds = time.perf_counter() - begin
    size = Path(target).stat().st_size
    return {
        "streamlines": n_streamlines,
        "points": n_points,
        "fiblets": None,
        "bytes": size,
        "bytes_per_point": size / max(n_points, 1),
        "error_mm": None,
        "error_steps": None,
        "error_degrees": None,
        "seconds": seconds,
        "points_per_second": n_points / max(seconds, 1e-9),
        "dropped": dropped,
    }
