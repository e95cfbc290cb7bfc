"""Measures of an even sample of streamlines, which cost the same for a billion points as for a million."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from ...streamlines import Streamlines
from ..selection.endpoints import anchor_points

if TYPE_CHECKING:
    from ...codec.fibletset import FibletSet
    from ...images.image import Image

_SAMPLE = 2000


def longest_length(fiblets: FibletSet) -> float:
    """Return the length, mm, of the longest of those streamlines that have the most points."""
    # With constant steps that is the longest of all; else it is near enough for a colour range.
    counts = np.diff(fiblets.offsets())
    if not counts.size:
        return 0.0
    most = np.argpartition(counts, -min(_SAMPLE, counts.size))[-_SAMPLE:]
    return float(fiblets.decompress(most).lengths().max())


def mean_direction(fiblets: FibletSet) -> tuple[float, float, float]:
    """Return the mean colour of an even sample of streamlines coloured by orientation: red, green, blue from 0 to 1."""
    sample = _even_sample(fiblets)
    moves = np.abs(np.diff(sample.points.astype(np.float64), axis=0))
    between = sample.offsets[1:-1]
    moves[between[(between > 0) & (between <= len(moves))] - 1] = 0.0  # from one streamline to the next
    total = moves.sum(axis=0)
    size = float(np.linalg.norm(total))
    red, green, blue = total / size if size > 0.0 else (0.5, 0.5, 0.5)
    return float(red), float(green), float(blue)


def _even_sample(fiblets: FibletSet) -> Streamlines:
    """Return streamlines at even distances in the set, `_SAMPLE` at most."""
    count = min(_SAMPLE, fiblets.n_streamlines)
    return fiblets.decompress(np.unique(np.linspace(0, fiblets.n_streamlines - 1, count).astype(np.int64)))


def meets_image(fiblets: FibletSet | Streamlines, image: Image) -> bool:
    """Return True if some point lies in an image."""
    sides = np.array(image.shape[:3])

    def meets(points: npt.NDArray[np.floating]) -> bool:
        at = points.astype(np.float64) @ image.inverse[:3, :3].T + image.inverse[:3, 3]
        return bool(((at >= -0.5) & (at <= sides - 0.5)).all(axis=1).any())

    if isinstance(fiblets, Streamlines):
        return not fiblets.n_points or meets(fiblets.points)
    # Anchors are points that need no decoding, and nearly always one of some lies inside.
    some = np.unique(np.linspace(0, max(fiblets.n_fiblets - 1, 0), _SAMPLE).astype(np.int64))
    if not fiblets.n_points or meets(anchor_points(fiblets, some)):
        return True
    return any(meets(chunk.points) for chunk in fiblets.iter_chunks())


def rounding_of(fiblets: FibletSet, name: str) -> float:
    """Return by how much equal numbers of a measure may differ, as points are float32."""
    if name == "n_points" or not fiblets.n_points:
        return 0.0
    bounds = np.asarray(fiblets.bounds)
    position = 2.0 * float(np.finfo(np.float32).eps) * float((bounds[1::2] - bounds[0::2]).max())  # mm
    return position / fiblets.step**2 if "curvature" in name and fiblets.step > 0.0 else position
