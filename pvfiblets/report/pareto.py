"""Methods that no other method beats."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

from .record import Axes, Record


def pareto(points: Sequence[tuple[float, float]]) -> list[bool]:
    """Return whether each point lies on the Pareto front, less being better."""
    on = [False] * len(points)
    finite = [i for i, point in enumerate(points) if all(map(math.isfinite, point))]
    least, before = math.inf, math.inf  # the least y so far, and where it was first reached
    for i in sorted(finite, key=lambda i: points[i]):
        x, y = points[i]
        if y < least:
            least, before = y, x
            on[i] = True
        elif y == least and x == before:
            on[i] = True
    return on


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
