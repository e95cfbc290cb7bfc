"""Values of points that the engine computes while it draws, stored with a set for a page, which computes none."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from pvfiblets.codec.editing.point_arrays import colours_of_points
from pvfiblets.codec.point_values import as_codes
from pvfiblets.support.value_reference import relative

if TYPE_CHECKING:
    from pvfiblets.codec.fibletset import FibletSet


def with_values(fiblets: FibletSet, source: Any, log_scale: bool) -> tuple[FibletSet, str]:
    """Return a set that has some values for its points as codes of what float32 holds, and their name."""
    name, values = (source, None) if isinstance(source, str) else (source.name, _sampled(fiblets, source))
    stored = fiblets.per_point.get(name) if values is None else None
    table = None if stored is None else stored.table
    if stored is None or table is None:
        if values is None:
            from pvfiblets.query.measures.measures import measure

            values = measure(fiblets, name).array() if stored is None else stored.values()
        stored, table = as_codes(values)
    reference = 0.0 if log_scale else stored.reference
    table = relative(table, reference).astype("<f4")
    return replace(fiblets, per_point={name: replace(stored, table=table, reference=reference)}), name


def _sampled(fiblets: FibletSet, source: Any) -> npt.NDArray[Any]:
    """Values of a volume at points in coded order."""
    return fiblets.in_coded_order(source.at(fiblets.decompress().points))


def colours(fiblets: FibletSet, name: str) -> npt.NDArray[np.uint8]:
    """Return ``(n_points, 4)`` uint8: the colours of points in coded order."""
    found = colours_of_points(fiblets, name)
    full = np.full((len(found), 4), 255, np.uint8)
    full[:, : found.shape[1]] = found
    return full
