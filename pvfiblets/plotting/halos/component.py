"""``plotter.add_halo_lines(...)`` and ``plotter.halo_lines``.

PyVista finds this module by two entry points and imports it when a plotter is first asked for either
name. :class:`HaloLinesComponent` lives as long as its plotter; its life cycle is that of
`pvfiblets.plotting.actor_registry`.
"""

from __future__ import annotations

import weakref
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
import pyvista as pv

from pvfiblets.plotting.actor_registry import ActorRegistry, same_as
from pvfiblets.plotting.halos.defaults import WIDTH_CUE
from pvfiblets.plotting.screenshot import Printing

if TYPE_CHECKING:
    from os import PathLike

    from pvfiblets.codec.fibletset import FibletSet
    from pvfiblets.halos import HaloLines
    from pvfiblets.halos.displacement import Displacement
    from pvfiblets.plotting.halos.actors import HaloLineActor
    from pvfiblets.plotting.halos.style import Threshold
    from pvfiblets.streamlines import Streamlines

    Lines: TypeAlias = pv.PolyData | Streamlines | FibletSet | HaloLines | np.ndarray | list[Any] | tuple[Any, Any]
    Source: TypeAlias = str | PathLike[str] | Lines


@pv.register_plotter_component("halo_lines")
class HaloLinesComponent(Printing, ActorRegistry["HaloLineActor"]):
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

    def __init__(self, plotter: pv.BasePlotter) -> None:
        self._init_keeping(plotter)

    def add(
        self,
        source: Source,
        *,
        line_width: float | None = None,
        strip_width: float | None = None,
        max_displacement: float | None = None,
        displacement: Displacement = "linear",
        tapering: bool | tuple[int, float] = True,
        width_cue: float = WIDTH_CUE,
        scalars: str | np.ndarray | None = None,
        filter_by: str | np.ndarray | None = None,
        threshold: Threshold = None,
        filter_taper: float | None = None,
        color: Any = None,
        halo_color: Any = None,
        light_on_dark: bool = False,
        cmap: Any = None,
        clim: Any = None,
        n_colors: int = 256,
        log_scale: bool = False,
        nan_color: Any = None,
        below_color: Any = None,
        above_color: Any = None,
        flip_scalars: bool = False,
        rgb: bool = False,
        opacity: float = 1.0,
        lighting: bool = False,
        smooth: bool = True,
        min_width: float = 1.0,
        name: str | None = None,
        label: str | None = None,
        show_scalar_bar: bool | None = None,
        scalar_bar_args: dict[str, Any] | None = None,
        pickable: bool = True,
        user_matrix: Any = None,
        reset_camera: bool | None = None,
        render: bool = True,
        culling: str | None = "two-phase",
    ) -> HaloLineActor:
        """Add lines with depth-dependent halos to the scene.

        A line is a strip that faces the viewer: black in the middle, white on both sides, where it
        bends away from the viewer. So a line cuts a gap into others behind it, the wider the farther
        they are behind, and none into those beside it.

        Parameters
        ----------
        source : PolyData, Streamlines, FibletSet, array, list of arrays, (points, segments), HaloLines or path
            Lines in mm. One ``(n, 3)`` array is one line.
        line_width : float, optional
            mm. By default what suits the distances between the lines, which are measured.
        strip_width : float, optional
            mm of a line with the halos on both its sides; a multiple of ``line_width`` by default.
        max_displacement : float, optional
            mm by which the edges of a strip lie behind its line: lines that are as far behind have the
            widest gaps. By default what suits ``strip_width`` and the extent of the data.
        displacement : {"linear", "square", "square root"}, table or function, default: "linear"
            How far back a strip lies from its axis to its edge: 2 to 64 shares of
            ``max_displacement`` at equally spaced places, or a function of an array of places in 0..1.
        tapering : bool or (int, float), default: True
            How ends of lines narrow: ``(n, t)``, over ``n`` vertices, which go as far as ``t`` along the
            mask, up to 0.5; it is at its widest from 0.2 on. True means (2, 0.2), False square ends.
        width_cue : float, default: 0.5
            By which share the farthest lines are thinner than the nearest, beside perspective.
        scalars : str or array, optional
            What colours the lines, not their halos: the name of data of ``source``;
            ``"orientation"`` (the absolute value of the direction as red, green, blue),
            ``"arc_length"``, ``"length"``; or an array with one number or one colour (3 or 4 columns;
            floats with ``rgb``) per point or per line.
        filter_by : str or array, optional
            What ``threshold`` filters by: the name of numbers per point or line, ``"arc_length"``,
            ``"length"``, or an array. Where there is no number (NaN), nothing shows.
        threshold : float or (float, float), optional
            The least number that shows, or the least and the greatest, ``None`` for no end.
        filter_taper : float, optional
            mm over which lines narrow where the filter ends them; two mean segments by default.
        color : color-like, optional
            One colour for all lines, black by default. ``scalars`` go before it.
        halo_color : color-like or "background", optional
            Of the halos, white by default.
        light_on_dark : bool, default: False
            White lines in black halos by default, instead of black ones in white.
        cmap : str, list or colormap, optional
            Colour map; the theme's by default.
        clim : float or (float, float), optional
            Values of the first and the last colour; the range of the values by default.
        n_colors : int, default: 256
            Number of colours in the map.
        log_scale : bool, default: False
            Spread the colours over the logarithm of the values.
        nan_color, below_color, above_color : color-like, optional
            Colour of NaN, and of values outside ``clim``.
        flip_scalars : bool, default: False
            Reverse the colour map.
        rgb : bool, default: False
            Take float ``scalars`` of three or four columns as colours. Those of uint8 always are.
        opacity : float, default: 1.0
            Of lines and halos; what of the lines lies behind the nearest does not show through.
        lighting : bool, default: False
            Shade the lines by the scene's lights.
        smooth : bool, default: True
            Whether lines turn into their halos gradually, over a pixel.
        min_width : float, default: 1.0
            Pixels that a line takes at least, however thin and far it is.
        name : str, optional
            Replaces the actor of the same name.
        label : str, optional
            For :meth:`pyvista.Plotter.add_legend`.
        show_scalar_bar : bool, optional
            The theme's by default; colours without a colour map never have one.
        scalar_bar_args : dict, optional
            For :meth:`pyvista.Plotter.add_scalar_bar`.
        pickable : bool, default: True
            Whether pickers find the actor.
        user_matrix : transform-like, optional
            From data to world coordinates.
        reset_camera : bool, optional
            As for :meth:`pyvista.Plotter.add_mesh`.
        render : bool, default: True
            Render at once if the window is shown already.
        culling : {"two-phase", None}, default: "two-phase"
            How segments behind others are found out, where there are many; the picture is the same.

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

        Only what is high, of lines that thin out below:

        >>> actor.filter_by = np.sin(3 * t)
        >>> actor.threshold = 0.0
        """
        from pvfiblets.mappers.halos import HaloOptions
        from pvfiblets.plotting.colours import ColourSettings
        from pvfiblets.plotting.halos.actors import HaloLineActor
        from pvfiblets.plotting.halos.scalars import as_lines
        from pvfiblets.plotting.halos.style import LookSettings

        options = HaloOptions(culling)  # before the slow part
        held = as_lines(source, scalars=scalars, rgb=rgb, filter_by=filter_by)
        looks = LookSettings(
            line_width=line_width,
            strip_width=strip_width,
            max_displacement=max_displacement,
            displacement=displacement,
            tapering=tapering,
            width_cue=width_cue,
            min_width=min_width,
            smooth=smooth,
            filter_by=held.filter_by,
            threshold=threshold,
            filter_taper=filter_taper,
        )
        settings = ColourSettings(
            color=None if color is None else pv.Color(color),
            cmap=cmap,
            clim=clim,
            n_colors=n_colors,
            log_scale=bool(log_scale),
            nan_color=nan_color,
            below_color=below_color,
            above_color=above_color,
            flip_scalars=flip_scalars,
        )
        actor = HaloLineActor(
            held,
            looks=looks,
            settings=settings,
            halo_color=halo_color,
            light_on_dark=light_on_dark,
            opacity=opacity,
            lighting=lighting,
            theme=self._plotter.theme,
            options=options,
        )
        return self._enter(
            actor,
            name=name,
            label=label,
            show_scalar_bar=show_scalar_bar,
            scalar_bar_args=scalar_bar_args,
            pickable=pickable,
            user_matrix=user_matrix,
            reset_camera=reset_camera,
            render=render,
        )


@pv.register_plotter_component("add_halo_lines")
class AddHaloLines:
    """What makes ``plotter.add_halo_lines`` callable; the same as ``plotter.halo_lines.add``.

    Parameters
    ----------
    plotter : pyvista.BasePlotter
        The plotter it belongs to.
    """

    def __init__(self, plotter: pv.BasePlotter) -> None:
        self._plotter: Any = weakref.proxy(plotter)

    @same_as(HaloLinesComponent.add)
    def __call__(self, source: Source, **arguments: Any) -> HaloLineActor:
        """Add lines with halos; see :meth:`HaloLinesComponent.add`."""
        return self._plotter.halo_lines.add(source, **arguments)
