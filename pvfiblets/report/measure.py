"""Errors and times, measured alike for every way; independent of what is measured."""

from __future__ import annotations

import gc
import time
from collections.abc import Callable
from typing import TypeVar

import numpy as np
import numpy.typing as npt

from .record import Figure, Timing

__all__ = ["distances", "error_figures", "median_step", "timed"]

Floats = npt.NDArray[np.floating]
Result = TypeVar("Result")


def distances(original: Floats, decoded: Floats) -> npt.NDArray[np.float64]:
    """Distance of each decoded point from its original, ``(n,)`` float64, in their unit.

    Parameters
    ----------
    original, decoded : numpy.ndarray
        ``(n, 3)``.

    Raises
    ------
    ValueError
        If there are not as many decoded points as originals, or one is not finite: a way that loses points has no
        error that could be averaged.
    """
    if original.shape != decoded.shape:
        raise ValueError(f"{len(original)} points were coded and {len(decoded)} came back")
    apart = np.linalg.norm(np.asarray(decoded, np.float64) - np.asarray(original, np.float64), axis=1)
    if not np.isfinite(apart).all():
        raise ValueError(f"{int((~np.isfinite(apart)).sum())} of {len(apart)} decoded points are not finite")
    return apart


def median_step(points: Floats, offsets: npt.NDArray[np.int64]) -> float:
    """Median distance between consecutive points of a streamline, those at one place left out; NaN without any."""
    points = np.asarray(points, np.float64)
    lengths = np.linalg.norm(np.diff(points, axis=0), axis=1)
    inside = np.ones(len(lengths), bool)
    joins = offsets[1:-1] - 1
    inside[joins[(joins >= 0) & (joins < len(lengths))]] = False
    lengths = lengths[inside & (lengths > 0.0)]
    return float(np.median(lengths)) if lengths.size else float("nan")


def error_figures(apart: npt.NDArray[np.float64], step: float, unit: str = "mm") -> dict[str, Figure]:
    """Return the largest, mean and 99.9th percentile of distances, in their unit and in steps."""
    if not len(apart):
        return {}
    numbers = {
        "max": float(apart.max()),
        "mean": float(apart.mean()),
        "p99.9": float(np.quantile(apart, 0.999)),
    }
    figures = {name: Figure(value, unit) for name, value in numbers.items()}
    scale = 1.0 / step if step > 0.0 else float("nan")
    return figures | {f"{name} in steps": Figure(value * scale, "steps") for name, value in numbers.items()}


def timed(
    function: Callable[[], Result],
    repeats: int,
    items: float,
    item: str = "point",
    clock: Callable[[], float] = time.process_time,
    clock_name: str = "cpu",
) -> tuple[Result, Timing]:
    """Call a function some times, and return its first result and how long the calls after that took.

    Calls that are much shorter than the clock's grain are put together; of calls longer than half a second three are
    enough.
    """
    result = function()
    collecting = gc.isenabled()
    gc.disable()  # a collection that falls into one call is not that call's cost
    try:
        begun = clock()
        function()
        once = clock() - begun
        inner = 1 if once >= _GRAIN else int(min(np.ceil(_GRAIN / max(once, 1e-6)), 1000))
        wanted = max(repeats, 1) if once < _LONG else min(max(repeats, 1), 3)
        seconds = [once] if inner == 1 else []
        while len(seconds) < wanted:
            begun = clock()
            for _ in range(inner):
                function()
            seconds.append((clock() - begun) / inner)
    finally:
        if collecting:
            gc.enable()
    timing = Timing(float(np.median(seconds)), min(seconds), max(seconds), len(seconds), items, item, clock_name)
    return result, timing


_GRAIN = 2e-3  # s: shorter calls are put together until they take about as long
_LONG = 0.5  # s
