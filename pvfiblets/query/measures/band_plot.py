"""A value along a bundle as a line in its band, by matplotlib."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]


def plot_band(
    position: Floats, mean: Floats, low: Floats, high: Floats, name: str, ax: Any = None, *, label: str = "",
    color: Any = None,
) -> Any:  # fmt: skip
    """Draw a mean between the ends of its band."""
    if ax is None:
        import matplotlib.pyplot as plt

        ax = plt.subplots()[1]
    (line,) = ax.plot(position, mean, color=color, label=label or None)
    ax.fill_between(position, low, high, color=line.get_color(), alpha=0.25, linewidth=0.0)
    ax.set_xlabel("position along the bundle")
    ax.set_ylabel(name)
    ax.set_xlim(0.0, 1.0)
    return ax
