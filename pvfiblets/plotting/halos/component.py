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
    Points: TypeAlias = pv.DataSet | Streamlines | FibletSet | HaloPoints | np.ndarray | list[Any]
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

        Each line is a strip that faces the viewer: black in the middle, with a white halo on both
        sides. The halo bends away from the viewer. It hides lines behind its line, and the gap is
        wider the farther behind they lie; lines beside it stay whole.

        Parameters
        ----------
        source : PolyData, Streamlines, FibletSet, array, list of arrays, (points, segments), HaloLines or path
            Lines in mm. One ``(n, 3)`` array is one line.
        scalars : str, array or image, optional
            Colours of the lines; halos have ``halo_color``. The name of an array of ``source``;
            ``"orientation"`` (the absolute direction as red, green, blue), ``"arc_length"`` or
            ``"length"`` (mm); an array with one number or one colour (3 or 4 columns; floats with
            ``rgb``) per point or per line; a file of numbers (``.tsf``, ``.npy``, ``.txt``,
            ``.csv``); or an image, sampled at the points. By default the active scalars of a VTK
            data set, unless ``color`` is given.
        filter_by : str, array or image, optional
            Numbers that ``threshold`` compares: the name of an array per point or line,
            ``"arc_length"``, ``"length"``, an array, or an image. Parts without a number (NaN) are
            hidden.
        rgb : bool, optional
            True: ``scalars`` of three or four columns are colours. False: they are vectors, coloured by
            magnitude. By default uint8 columns are colours, and so are arrays whose names end in
            ``"_rgb"`` or ``"_rgba"``.
        preference : {'point', 'cell'}, default: 'point'
            Meaning of a name that points and lines (cells) share. The other array is then called
            ``"NAME (line)"`` or ``"NAME (point)"``.

        Returns
        -------
        HaloLineActor
            Its properties may be changed at any time.

        Raises
        ------
        KeyError
            If no array has the name given as ``scalars`` or ``filter_by``.
        TypeError
            If ``source`` has an unsupported type.
        ValueError
            If an argument is invalid; the message names it and its value.

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

        Hide values below 0; lines taper there:

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

        Each point is a disc that faces the viewer, with a cone-shaped halo that leads away from the
        viewer. The halo hides points farther behind and leaves those beside it. So a dense cloud of
        surface points shows which part of the surface is in front.

        Parameters
        ----------
        source : DataSet, array, Streamlines, FibletSet, HaloPoints or path
            Points in mm: those of a data set or tractogram, or an ``(n, 3)`` array.
        scalars : str, array or image, optional
            Colours of the points; halos have ``halo_color``. The name of an array of ``source``; an
            array with one number or one colour (3 or 4 columns; floats with ``rgb``) per point; or an
            image, sampled at the points. By default the active scalars of a VTK data set, unless
            ``color`` is given.
        filter_by : str, array or image, optional
            Numbers that ``threshold`` compares: the name of an array, an array, or an image. Points
            without a number (NaN) are hidden.
        rgb : bool, optional
            True: ``scalars`` of three or four columns are colours. False: they are vectors, coloured by
            magnitude. By default uint8 columns are colours, and so are arrays whose names end in
            ``"_rgb"`` or ``"_rgba"``.

        Returns
        -------
        HaloPointActor
            Its properties may be changed at any time.

        Raises
        ------
        KeyError
            If no array has the name given as ``scalars`` or ``filter_by``.
        TypeError
            If ``source`` has an unsupported type.
        ValueError
            If an argument is invalid; the message names it and its value.

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
