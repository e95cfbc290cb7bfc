"""dipy's ``compress_streamlines`` (Presseau et al. 2015): points of nearly straight runs are left out.

What comes back is the line, not its points. So a point's error is its distance from the segment between the two kept
points on either side of it: the least that could be meant.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt

from . import COUNT_BYTES


@dataclass
class LinesPacked:
    """The points that were kept, of each streamline."""

    kept: list[npt.NDArray[np.floating]]

    @property
    def nbytes(self) -> int:
        """Bytes of the points kept, in float32, and of their numbers."""
        return sum(12 * len(line) + COUNT_BYTES for line in self.kept)

    def distances(self, points: npt.NDArray[np.floating], offsets: npt.NDArray[np.int64]) -> npt.NDArray[np.float64]:
        """Distance of each original point from the kept line beside it, ``(n,)`` mm."""
        apart = np.zeros(len(points))
        for s, line in enumerate(self.kept):
            a, b = int(offsets[s]), int(offsets[s + 1])
            apart[a:b] = _from_line(points[a:b].astype(np.float64), np.asarray(line, np.float64))
        return apart


def _from_line(points: npt.NDArray[np.float64], line: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    if not len(points):
        return np.zeros(0)
    at = np.zeros(len(line), np.int64)  # which of the points each kept one is
    place = 0
    for k, kept in enumerate(line):
        same = np.flatnonzero((points[place:] == kept).all(axis=1))
        if not same.size:
            raise ValueError(f"point {k} of a simplified streamline is none of its points")
        place += int(same[0])
        at[k] = place
        place += 1
    at[-1] = len(points) - 1
    segment = np.clip(np.searchsorted(at, np.arange(len(points)), side="right") - 1, 0, max(len(line) - 2, 0))
    begin, along = line[segment], line[np.minimum(segment + 1, len(line) - 1)] - line[segment]
    squares = np.maximum((along**2).sum(1), np.finfo(np.float64).tiny)
    t = np.clip(((points - begin) * along).sum(1) / squares, 0.0, 1.0)
    apart: npt.NDArray[np.float64] = np.linalg.norm(points - begin - t[:, None] * along, axis=1)
    return apart


def linearised(tolerance: float) -> Callable[[npt.NDArray[np.floating], npt.NDArray[np.int64]], LinesPacked]:
    """Leave points out within ``tolerance`` (mm) of the remaining line; segments of 10 mm at most."""
    compress: Any = import_module("dipy.tracking.streamlinespeed").compress_streamlines

    def pack(points: npt.NDArray[np.floating], offsets: npt.NDArray[np.int64]) -> LinesPacked:
        lines = [points[a:b] for a, b in pairwise(offsets)]
        longer = [i for i, line in enumerate(lines) if len(line) > 2]  # of the others nothing can be left out
        for i, line in zip(longer, compress([lines[i] for i in longer], tol_error=tolerance), strict=True):
            lines[i] = line
        return LinesPacked(lines)

    return pack
