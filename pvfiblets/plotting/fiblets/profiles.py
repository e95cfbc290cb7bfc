"""Statistics of selected streamlines: counts, lengths, values, and the profile of a value along them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import pyvista as pv

from pvfiblets.query.measures.band_plot import plot_band

if TYPE_CHECKING:
    from pvfiblets.codec.fibletset import FibletSet


@dataclass(frozen=True, eq=False)
class Profile:
    """Mean and spread of a value at places along a bundle's streamlines.

    Attributes
    ----------
    mean, std : numpy.ndarray
        ``(n,)`` float64 over the streamlines; NaN where none has a value.
    position : numpy.ndarray
        ``(n,)`` float64 from 0, where the streamlines begin, to 1: fractions of their lengths.
    name : str
        Of the value.
    count : int
        Streamlines that were averaged.
    """

    mean: np.ndarray
    std: np.ndarray
    position: np.ndarray
    name: str = ""
    count: int = 0

    def __len__(self) -> int:
        return len(self.mean)

    def plot(self, ax: Any = None, *, color: Any = None) -> Any:
        """Draw the mean as a line in a band of one standard deviation to either side.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Drawn into; a new figure's by default.
        color : optional
            Anything matplotlib takes.

        Returns
        -------
        matplotlib.axes.Axes
            For labels and :meth:`matplotlib.figure.Figure.savefig` of its ``figure``.
        """
        low, high = self.mean - self.std, self.mean + self.std
        return plot_band(self.position, self.mean, low, high, self.name, ax, label=self.name, color=color)

    def chart(self, *, color: Any = "b") -> pv.Chart2D:
        """Return the same as a chart for :meth:`pyvista.Plotter.add_chart`.

        Parameters
        ----------
        color : color-like, default: "b"
            Of the line, and more lightly of the band.

        Returns
        -------
        pyvista.Chart2D
            Places without a value are left out.
        """
        chart = pv.Chart2D(x_label="position along the bundle", y_label=self.name)
        known = np.isfinite(self.mean)
        if known.any():
            x, mean, std = self.position[known], self.mean[known], self.std[known]
            light = pv.Color(color).float_rgb
            chart.area(x, mean - std, mean + std, color=(*light, 0.25))
            chart.line(x, mean, color=color, width=2.0)
        return chart


def values_of(fiblets: FibletSet, scalars: Any, part: FibletSet, ids: np.ndarray) -> np.ndarray:
    """Return the numbers of some streamlines, or of their points, in some order; ``part`` holds these streamlines."""
    from pvfiblets.query.measures.measures import measure

    if isinstance(scalars, str):
        return np.asarray(measure(part, scalars).array(), np.float64)
    whole = measure(fiblets, scalars)
    values = np.asarray(whole.array(), np.float64)
    if whole.kind == "streamline":
        return values[ids]
    from pvfiblets.codec.streamline_ranges import ranges_of

    places = ranges_of(fiblets, ids)
    ends = np.cumsum(places.points)
    rows = np.arange(int(places.points.sum())) + np.repeat(places.point - ends + places.points, places.points)
    return values[rows]
