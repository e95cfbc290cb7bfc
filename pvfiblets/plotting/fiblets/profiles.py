"""What selected streamlines hold: counts, lengths, values, and the profile of a value from one end to the other."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pyvista as pv

from pvfiblets.query.measures.band_plot import plot_band

if TYPE_CHECKING:
    from os import PathLike

    from pvfiblets.codec.fibletset import FibletSet
    from pvfiblets.plotting.fiblets.scalars import Scalars
    from pvfiblets.query.measures.table import Table


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


class SelectionMeasures:
    """The part of :class:`~pvfiblets.plotting.fiblets.actor.FibletActor` that measures and saves its selection."""

    fiblets: FibletSet
    selection: Any
    _scalars: Scalars | None

    def selection_table(self) -> Table:
        """Return a row for each selected streamline; see :func:`pvfiblets.table`."""
        return self.fiblets.table(self.selection)

    def selection_statistics(self, scalars: Any = None) -> dict[str, Any]:
        """Count and measure the selected streamlines.

        Parameters
        ----------
        scalars : str or array, optional
            Of what to give mean and standard deviation, per streamline or per point: a name, or an
            array with one number per streamline or per point. The numbers that colour the actor by
            default.

        Returns
        -------
        dict
            ``count``, ``points``; ``length_mean``, ``length_min``, ``length_max`` and
            ``length_total`` in mm; and, where there are numbers, their name as ``scalars``, and
            ``mean`` and ``std`` (population) over the streamlines or points that have one. NaN
            where there is nothing.

        Raises
        ------
        KeyError
            If there is no array of that name.
        ValueError
            If an array has the wrong length.
        """
        ids = self.selection
        part = self.fiblets.extract(ids)
        lengths = part.lengths()
        some = lengths if len(lengths) else np.full(1, np.nan)
        found: dict[str, Any] = {
            "count": len(ids),
            "points": part.n_points,
            "length_mean": float(some.mean()),
            "length_min": float(some.min()),
            "length_max": float(some.max()),
            "length_total": float(lengths.sum()),
        }
        if scalars is None and self._scalars is not None and self._scalars.mapped:
            scalars = self._scalars.name if self._scalars.values is None else self._scalars.values
            name = self._scalars.name
        else:
            name = scalars if isinstance(scalars, str) else "Data"
        if scalars is not None:
            values = self._values_of(scalars, part, ids)
            values = values[np.isfinite(values)]
            found |= {
                "scalars": name,
                "mean": float(values.mean()) if len(values) else float("nan"),
                "std": float(values.std()) if len(values) else float("nan"),
            }
        return found

    def _values_of(self, scalars: Any, part: FibletSet, ids: np.ndarray) -> np.ndarray:
        """Return the numbers of the selected streamlines or of their points, in some order."""
        from pvfiblets.query.measures.measures import measure

        if isinstance(scalars, str):
            return np.asarray(measure(part, scalars).array(), np.float64)
        whole = measure(self.fiblets, scalars)
        values = np.asarray(whole.array(), np.float64)
        if whole.kind == "streamline":
            return values[ids]
        from pvfiblets.codec.streamline_ranges import ranges_of

        places = ranges_of(self.fiblets, ids)
        ends = np.cumsum(places.points)
        rows = np.arange(int(places.points.sum())) + np.repeat(places.point - ends + places.points, places.points)
        return values[rows]

    def selection_profile(self, scalars: Any = None, n: int = 100) -> Profile:
        """Return the mean of a value along the selected streamlines, from end to end.

        Parameters
        ----------
        scalars : str or array, optional
            A value per point: a name or an array. What colours the actor by default.
        n : int, default: 100
            Places along each streamline, evenly spaced.

        Returns
        -------
        Profile
            Streamlines are turned so that they run the same way.

        Raises
        ------
        KeyError
            If there is no array of that name.
        ValueError
            If the values are not per point, or ``n`` is below 2.
        """
        from pvfiblets.query.measures.profile import mean_profile

        if scalars is None:
            if self._scalars is None or self._scalars.kind != "point_scalar":
                raise ValueError("scalars is None, and what colours the actor is no value per point; name one")
            scalars = self._scalars.name
        mean, std = mean_profile(self.fiblets, self.selection, scalars, n)
        name = scalars if isinstance(scalars, str) else str(getattr(scalars, "name", "Data"))
        return Profile(mean, std, np.linspace(0.0, 1.0, n), name, len(self.selection))

    def save_selection(self, path: str | PathLike[str]) -> list[str]:
        """Write the selected streamlines to a file; its suffix says in which format.

        Parameters
        ----------
        path : str or Path
            ``.fiblets`` takes them as they are; ``.trk``, ``.tck``, ``.trx``, ``.vtk`` and the
            others take them decompressed. None at all is a file too.

        Returns
        -------
        list of str
            What the format cannot hold and was left out.

        Raises
        ------
        UnknownFormatError
            If no format that can be written has such a suffix.
        """
        if Path(path).suffix.lower() != ".fiblets":
            from pvfiblets.formats import registry

            registry.module_for(path, "write")
        return self.fiblets.extract(self.selection).save(path)
