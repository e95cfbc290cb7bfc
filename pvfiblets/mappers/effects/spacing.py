"""Distance between lines, the default scale of halos, occlusion and tubes."""

from __future__ import annotations

import weakref
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from pvfiblets.codec.fibletset import FibletSet

MOST_STREAMLINES = 1000
SAMPLES = 400

_found: dict[int, tuple[weakref.ref[Any], float | None]] = {}


def line_spacing_of(drawn: Any) -> float | None:
    """Return the distance from a streamline to the next one, in the middle of all places; None where it is not known.

    The median of `pvfiblets.halos.spacing.line_spacing` on an even sample of 1,000 streamlines, times the square root
    of their share: where lines are spread evenly over space, n times the lines are sqrt(n) times as near. On a whole
    brain of 20,505 streamlines that gives 0.24 mm instead of 0.20, in a fifth of a second; it is done once for a set.
    """
    if not hasattr(drawn, "decompress"):
        return None
    known = _found.get(id(drawn))
    if known is not None and known[0]() is drawn:
        return known[1]
    key, spacing = id(drawn), _measured(drawn)
    _found[key] = weakref.ref(drawn, lambda _: _found.pop(key, None)), spacing
    return spacing


def _measured(fiblets: FibletSet) -> float | None:
    from pvfiblets.halos import HaloLines
    from pvfiblets.halos.spacing import line_spacing

    n = fiblets.n_streamlines
    if n < 2:
        return None
    ids = np.unique(np.linspace(0, n - 1, min(n, MOST_STREAMLINES)).astype(np.int64))
    some = fiblets.decompress(ids)
    points = np.asarray(some.points, np.float64)
    if not len(points) or not np.isfinite(points).all() or not np.ptp(points, axis=0).any():
        return None
    spacing = line_spacing(HaloLines(points, some.offsets), samples=SAMPLES) * (len(ids) / n) ** 0.5
    return float(spacing) if np.isfinite(spacing) and spacing > 0.0 else None
