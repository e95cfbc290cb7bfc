"""A value along a bundle as a line in its band, by matplotlib."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]


def runs(known: npt.NDArray[np.bool_]) -> list[npt.NDArray[np.int64]]:
    """Return the numbers of places that are known, one array for each run between gaps."""
    found = np.flatnonzero(known)
    return [run for run in np.split(found, np.flatnonzero(np.diff(found) > 1) + 1) if len(run)]


def plot_band(
    position: Floats, mean: Floats, low: Floats, high: Floats, name: str, ax: Any = None, *, label: str = "",
    color: Any = None,
) -> Any:  # fmt: skip
    """Draw a mean between the ends of its band; missing values leave a gap."""
    if ax is None:
        import matplotlib.pyplot as plt

        ax = plt.subplots()[1]
    (line,) = ax.plot(position, mean, color=color, label=label or None)
    lone = np.array([k for k, *more in runs(np.isfinite(mean)) if not more], int)  # a line draws nothing there
    if len(lone):
        ax.plot(position[lone], mean[lone], ".", color=line.get_color())
    ax.fill_between(position, low, high, color=line.get_color(), alpha=0.25, linewidth=0.0)
    ax.set_xlabel("position along the bundle")
    ax.set_ylabel(name)
    ax.set_xlim(0.0, 1.0)
    return ax
