"""Streamlines as few points of equal arc length, a chunk at a time: what similarity is measured on."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ...codec.progress import Progress
from ...codec.small_sets import prefer_kernels
from ...streamlines import Streamlines
from ...support.progress_bar import progress_bar

if TYPE_CHECKING:
    from ...codec.fibletset import FibletSet

Lines = npt.NDArray[np.float32]
Ints = npt.NDArray[np.int64]
CHUNK = 1 << 20  # points decoded together: 12 MB


def check_count(n_points: int, name: str = "n_points") -> int:
    """Return the number of points of a resampled streamline, or raise a ValueError that names it."""
    if isinstance(n_points, bool) or int(n_points) != n_points or n_points < 2:
        raise ValueError(f"{name} is {n_points!r}; give a whole number of 2 or more")
    return int(n_points)


def check_distance(distance: float, name: str) -> float:
    """Return a distance, or raise a ValueError that names it."""
    found = float(distance)
    if not (np.isfinite(found) and found > 0.0):
        raise ValueError(f"{name} is {distance!r}; give a length in mm above 0")
    return found


def resampled(lines: Streamlines, n_points: int) -> Lines:
    """Resample streamlines that all have points."""
    from .similarity_kernels import resample

    out = np.empty((len(lines), n_points, 3), np.float32)
    points = np.asarray(lines.points)
    kind = np.float64 if points.dtype == np.float64 else np.float32
    # Kernels are compiled once, for arrays that can be written to: a map is copied, chunk by chunk.
    resample(np.require(points, kind, ["C", "W"]), np.require(lines.offsets, np.int64, ["C", "W"]), out)
    return out


def iter_resampled(
    data: FibletSet | Streamlines, n_points: int, ids: Ints | None = None, progress: Progress = False, what: str = ""
) -> Iterator[tuple[Ints, Lines]]:
    """Resample streamlines, in bounded memory."""
    total = len(data) if ids is None else len(ids)
    with progress_bar(progress is True, total=total, desc=what, unit="streamlines", unit_scale=True) as bar:
        for first, chunk in _chunks(data, ids):
            if callable(progress):
                progress(what, first / total)
            many = len(chunk)
            numbers = np.arange(first, first + many) if ids is None else ids[first : first + many]
            filled = chunk.counts > 0
            if not filled.all():
                chunk, numbers = chunk[filled], numbers[filled]
            if len(chunk):
                yield numbers, resampled(chunk, n_points)
            bar.update(many)


def _chunks(data: FibletSet | Streamlines, ids: Ints | None) -> Iterator[tuple[int, Streamlines]]:
    first = 0
    prefer_kernels("decoding")
    if isinstance(data, Streamlines):
        chosen: Any = data if ids is None else data[ids]
        for start, stop in chosen.blocks(CHUNK):
            yield start, Streamlines(chosen.points[chosen.offsets[start] : chosen.offsets[stop]],
                                     chosen.offsets[start : stop + 1] - chosen.offsets[start])  # fmt: skip
        return
    bare = replace(data, per_point={}, per_streamline={}, groups={}, per_group={})
    if ids is None:
        for chunk in bare.iter_chunks(CHUNK):
            yield first, chunk
            first += len(chunk)
        return
    # As many at a time as have a chunk's points on average.
    many = max(int(CHUNK * data.n_streamlines / max(data.n_points, 1)), 1)
    for first in range(0, len(ids), many):
        yield first, bare.decompress(ids[first : first + many])
