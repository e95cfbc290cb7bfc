"""``plotter.add_halo_points(...)`` and ``plotter.halo_points``, as `.component` is for lines."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
import pyvista as pv

from pvfiblets.plotting.actor_registry import ActorRegistry
from pvfiblets.plotting.call_signature import plotter_method
from pvfiblets.plotting.halos.settings import HaloPointSettings
from pvfiblets.plotting.screenshot import Printing
from pvfiblets.plotting.setting_places import OPTIONS
from pvfiblets.plotting.settings import Given

if TYPE_CHECKING:
    from os import PathLike

    from pvfiblets.halos import HaloPoints
    from pvfiblets.plotting.halos.actors import HaloPointActor
    from pvfiblets.streamlines import Streamlines

    Points: TypeAlias = pv.DataSet | Streamlines | HaloPoints | np.ndarray | list[Any]
    Source: TypeAlias = str | PathLike[str] | Points


@pv.register_plotter_component("halo_points")
class HaloPointsComponent(Printing, ActorRegistry["HaloPointActor"]):
    """The points with halos of one plotter.

    Parameters
    ----------
    plotter : pyvista.BasePlotter
        The plotter it belongs to.

    Examples
    --------
    >>> import pyvista as pv
    >>> pl = pv.Plotter(off_screen=True)
    >>> actor = pl.halo_points.add(pv.Sphere(), point_size=0.01)
    >>> list(pl.halo_points) == [actor]
    True
    """

    SETTINGS = HaloPointSettings
    NAME, ADD = "halo_points", "add_halo_points"

    def _make(
        self,
        source: Source,
        settings: Given,
        *,
        scalars: str | np.ndarray | None = None,
        filter_by: str | np.ndarray | None = None,
        rgb: bool = False,
    ) -> HaloPointActor:
        """Add points with depth-dependent halos to the scene.

        A point is a disc that faces the viewer, in a cone that leads away from him: it hides others
        close to it on the screen that are farther behind, and none beside it. So a dense cloud of a
        surface shows where one part of it is in front of another.

        Parameters
        ----------
        source : DataSet, array, Streamlines, HaloPoints or path
            Points in mm: those of any dataset, or an ``(n, 3)`` array.
        scalars : str or array, optional
            What colours the points, not their halos: the name of point data of ``source``, or an
            array with one number or one colour (3 or 4 columns; floats with ``rgb``) per point.
        filter_by : str or array, optional
            What ``threshold`` filters by: the name of numbers at points, or an array. Points without
            a number (NaN) do not show.
        cmap, clim, n_colors, log_scale, nan_color, below_color, above_color, flip_scalars, rgb
            As for lines (``plotter.add_halo_lines``).

        Returns
        -------
        HaloPointActor
            Its properties may be changed at any time.

        Raises
        ------
        KeyError
            If there are no numbers of the name given as ``scalars`` or ``filter_by``.
        TypeError
            If ``source`` is of an unknown kind.
        ValueError
            If an argument has no meaning; the message names it and its value.

        Notes
        -----
        Source: Everts, Bekker, Roerdink and Isenberg, "Depth-dependent halos" (2009), section 3.5.

        Examples
        --------
        >>> import numpy as np
        >>> import pyvista as pv
        >>> ball = np.random.default_rng(0).normal(size=(5000, 3))
        >>> ball *= 10 / np.linalg.norm(ball, axis=1)[:, None]
        >>> pl = pv.Plotter(off_screen=True)
        >>> actor = pl.add_halo_points(ball, point_size=0.15, halo_size=1.5, max_displacement=4)
        """
        from pvfiblets.mappers.halos import HaloOptions
        from pvfiblets.plotting.halos.actors import HaloPointActor
        from pvfiblets.plotting.halos.scalars import as_points

        HaloOptions(**settings.at(OPTIONS))  # what is wrong with them is said before the slow part
        held = as_points(source, scalars=scalars, rgb=rgb, filter_by=filter_by)
        return HaloPointActor(held, settings=settings, theme=self._plotter.theme)


AddHaloPoints = plotter_method(HaloPointsComponent)
