"""Methods that no other method beats."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from .record import Axes, Record


def pareto(points: Sequence[tuple[float, float]]) -> list[bool]:
    """Return whether each point lies on the Pareto front, less being better."""
    values = np.array(points, np.float64).reshape(-1, 2)
    finite = np.isfinite(values).all(axis=1)
    others, each = values[finite], values[:, None]
    worse = np.all(others <= each, axis=2) & np.any(others < each, axis=2)
    found: list[bool] = (finite & ~worse.any(axis=1)).tolist()
    return found


def mark_fronts(records: Iterable[Record], axes: Iterable[Axes]) -> None:
    """Write into each record on which axes' fronts it lies, among the records of the same data set and machine."""
    sets: dict[tuple[str, str], list[Record]] = {}
    for record in records:
        record.front = []
        sets.setdefault((record.data, record.machine), []).append(record)
    chosen = [pair for pair in axes if pair.has_front]
    for members in sets.values():
        for pair in chosen:
            on = pareto([(record.value(pair.x), record.value(pair.y)) for record in members])
            for record, lies in zip(members, on, strict=True):
                if lies:
                    record.front.append(pair.key)
