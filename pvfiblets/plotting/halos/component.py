"""``plotter.add_halo_lines(...)``, ``plotter.halo_lines``, and the same of points.

PyVista finds this module by four entry points and imports it when a plotter is first asked for one of the names. A
component lives as long as its plotter; its life cycle is that of `pvfiblets.plotting.actors.registry`.
"""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
import pyvista as pv

from pvfiblets.plotting.components import register
from pvfiblets.plotting.halos.settings import HaloLineSettings, HaloPointSettings
from pvfiblets.plotting.plotter_methods.screenshot import PrintableComponent
from pvfiblets.plotting.settings.call_signature import plotter_method
from pvfiblets.plotting.settings.mesh_arguments import LineCommon
from pvfiblets.plotting.settings.places import OPTIONS
from pvfiblets.plotting.settings.settings import Given

if TYPE_CHECKING:
    from os import PathLike

    from pvfiblets.codec.fibletset import FibletSet
    from pvfiblets.halos import HaloLines, HaloPoints
    from pvfiblets.plotting.colours.same_names import Preference
    from pvfiblets.plotting.halos.actors import HaloLineActor, HaloPointActor
    from pvfiblets.streamlines import Streamlines

    Lines: TypeAlias = pv.PolyData | Streamlines | FibletSet | HaloLines | np.ndarray | list[Any] | tuple[Any, Any]
    LineSource: TypeAlias = str | PathLike[str] | Lines
    Points: TypeAlias = pv.DataSet | Streamlines | HaloPoints | np.ndarray | list[Any]
    PointSource: TypeAlias = str | PathLike[str] | Points


@register("halo_lines")
class HaloLinesComponent(PrintableComponent["HaloLineActor"]):
    """The lines with halos of one plotter.

    Parameters
    ----------
    plotter : pyvista.BasePlotter
        The plotter it belongs to.

    Examples
    --------
    >>> import pyvista as pv
    >>> pl = pv.Plotter(off_screen=True)
    >>> actor = pl.halo_lines.add([[(0, 0, 0), (1, 1, 0), (2, 0, 0)]], line_width=0.05)
    >>> list(pl.halo_lines) == [actor]
    True
    """

    _SETTINGS = HaloLineSettings
    COMMON = LineCommon
    NAME, ADD = "halo_lines", "add_halo_lines"

    def _make(
        self,
        source: LineSource,
        settings: Given,
        *,
        scalars: str | np.ndarray | None = None,
        filter_by: str | np.ndarray | None = None,
        rgb: bool | None = None,
        preference: Preference = "point",
    ) -> HaloLineActor:
        """Add lines with depth-dependent halos to the scene.

        A line is a strip that faces the viewer: black in the middle, white on both sides, where it
        bends away from the viewer. So a line cuts a gap into others behind it, the wider the farther
        they are behind, and none into those beside it.

        Parameters
        ----------
        source : PolyData, Streamlines, FibletSet, array, list of arrays, (points, segments), HaloLines or path
            Lines in mm. One ``(n, 3)`` array is one line.
        scalars : str, array or image, optional
            What colours the lines, not their halos: the name of data of ``source``, the active scalars of a data set
            of VTK's by default unless there is a ``color``;
            ``"orientation"`` (the absolute value of the direction as red, green, blue),
            ``"arc_length"``, ``"length"``; an array with one number or one colour (3 or 4 columns;
            floats with ``rgb``) per point or per line; a file of numbers: ``.tsf``, ``.npy``,
            ``.txt``, ``.csv``; or an image, whose values at the points count.
        filter_by : str, array or image, optional
            What ``threshold`` filters by: the name of numbers per point or line, ``"arc_length"``,
            ``"length"``, an array, or an image. Where there is no number (NaN), nothing shows.
        rgb : bool, optional
            Whether ``scalars`` of three or four columns are colours, or vectors to be mapped by their magnitude. By
            default uint8 columns are, and arrays with names that end in ``"_rgb"`` or ``"_rgba"``.
        preference : {'point', 'cell'}, default: 'point'
            Which array a name means that both points and lines (cells) have; the other is called ``"NAME (line)"`` or
            ``"NAME (point)"``.

        Returns
        -------
        HaloLineActor
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
        Source: Everts, Bekker, Roerdink and Isenberg, "Depth-dependent halos" (2009).

        Examples
        --------
        A knot in ink:

        >>> import numpy as np
        >>> import pyvista as pv
        >>> t = np.linspace(0, 2 * np.pi, 400)
        >>> knot = [(2 + np.cos(3 * t)) * np.cos(2 * t), (2 + np.cos(3 * t)) * np.sin(2 * t), np.sin(3 * t)]
        >>> pl = pv.Plotter(off_screen=True)
        >>> actor = pl.add_halo_lines(np.transpose(knot), line_width=0.05, strip_width=0.4, tapering=False)
        >>> actor.max_displacement = 1.0

        Only high values; lines taper below:

        >>> actor.filter_by = np.sin(3 * t)
        >>> actor.threshold = 0.0
        """
        from pvfiblets.mappers.halos import HaloOptions
        from pvfiblets.plotting.colours.colours import active_scalars
        from pvfiblets.plotting.colours.scalars import refuse_numbers
        from pvfiblets.plotting.halos.actors import HaloLineActor
        from pvfiblets.plotting.halos.sources import as_lines

        HaloOptions(**settings.at(OPTIONS))  # errors are raised before the slow part
        if scalars is None:
            scalars = active_scalars(source, settings["color"], rgb)
        held = as_lines(source, scalars=scalars, rgb=rgb, filter_by=filter_by, preference=preference)
        if not getattr(held.drawn, "n_segments", 0):
            warnings.warn("the source holds no lines: nothing is drawn", UserWarning, stacklevel=5)
        actor = HaloLineActor(held, settings=settings, theme=self._plotter.theme)
        refuse_numbers(actor.scalars_title, rgb)
        return actor


AddHaloLines = plotter_method(HaloLinesComponent)


@register("halo_points")
class HaloPointsComponent(PrintableComponent["HaloPointActor"]):
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

    _SETTINGS = HaloPointSettings
    NAME, ADD = "halo_points", "add_halo_points"

    def _make(
        self,
        source: PointSource,
        settings: Given,
        *,
        scalars: str | np.ndarray | None = None,
        filter_by: str | np.ndarray | None = None,
        rgb: bool | None = None,
    ) -> HaloPointActor:
        """Add points with depth-dependent halos to the scene.

        A point is a disc that faces the viewer, in a cone that leads away from him: it hides others
        close to it on the screen that are farther behind, and none beside it. So a dense cloud of a
        surface shows where one part of it is in front of another.

        Parameters
        ----------
        source : DataSet, array, Streamlines, HaloPoints or path
            Points in mm: of any dataset, or an ``(n, 3)`` array.
        scalars : str, array or image, optional
            What colours the points, not their halos: the name of point data of ``source``, the active scalars of a
            data set of VTK's by default unless there is a ``color``; or an array with one number or one colour (3 or 4
            columns; floats with ``rgb``) per point; or an image.
        filter_by : str, array or image, optional
            What ``threshold`` filters by: the name of numbers at points, an array, or an image. Points without
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
        from pvfiblets.plotting.colours.colours import active_scalars
        from pvfiblets.plotting.halos.actors import HaloPointActor
        from pvfiblets.plotting.halos.sources import as_points, read_points

        HaloOptions(**settings.at(OPTIONS))  # errors are raised before the slow part
        source = read_points(source)
        if scalars is None:
            scalars = active_scalars(source, settings["color"], rgb, points=True)
        held = as_points(source, scalars=scalars, rgb=rgb, filter_by=filter_by)
        if not held.drawn.n_points:
            warnings.warn("the source holds no points: nothing is drawn", UserWarning, stacklevel=5)
        return HaloPointActor(held, settings=settings, theme=self._plotter.theme)


AddHaloPoints = plotter_method(HaloPointsComponent)
