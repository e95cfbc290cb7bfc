"""What the engines of an actor's windows said, added up."""

from __future__ import annotations

from typing import Any

# What the engine counts in each window (pvfiblets.engine.fiblets.census).
COUNTS = ("total", "in_frustum", "drawn", "visible")


def added_up(report: dict[str, Any]) -> dict[str, Any]:
    """Return one report of all windows.

    Parameters
    ----------
    report : dict
        Of :meth:`pvfiblets.mappers.FibletMapper.explain`.

    Returns
    -------
    dict
        ``passes``, ``features``, ``buffers``, ``gpu_bytes`` and ``fiblets``, as
        :meth:`FibletActor.explain` has them.
    """
    windows = report["windows"]
    buffers = [buffer for window in windows for buffer in window["buffers"]]
    buffers += report["textures"]
    features = {feature for window in windows for feature in window["features"]}
    return {
        "passes": [item for window in windows for item in window["passes"]],
        "features": sorted(features | set(report["features"])),
        "buffers": buffers,
        "gpu_bytes": sum(buffer["bytes"] for buffer in buffers),
        "fiblets": {count: _sum(windows, count) for count in COUNTS},
    }


def _sum(windows: list[dict[str, Any]], count: str) -> int | None:
    """Add what the engines of some windows counted; None where none of them knows."""
    counts = [window.get("fiblets", {}).get(count) for window in windows]
    known = [number for number in counts if number is not None]
    return sum(known) if known else None
