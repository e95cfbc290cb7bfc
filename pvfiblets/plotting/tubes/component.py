"""``plotter.add_spline_tubes(...)`` and ``plotter.spline_tubes``.

PyVista finds this module by two entry points and imports it when a plotter is first asked for
either name. :class:`SplineTubesComponent` lives as long as its plotter; its life cycle is that of
`pvfiblets.plotting.actor_registry`.
"""

from __future__ import annotations

import weakref
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
import pyvista as pv

from pvfiblets.plotting.actor_registry import ActorRegistry, same_as

if TYPE_CHECKING:
    from os import PathLike

    from pvfiblets.codec.fibletset import FibletSet
    from pvfiblets.plotting.tubes.actor import TubeActor
    from pvfiblets.streamlines import Streamlines
    from pvfiblets.tubes.spline_tubes import SplineTubes

    Lines: TypeAlias = pv.PolyData | Streamlines | FibletSet | np.ndarray | list[Any] | tuple[Any, Any]
    Source: TypeAlias = str | PathLike[str] | SplineTubes | Lines


@pv.register_plotter_component("spline_tubes")
class SplineTubesComponent(ActorRegistry["TubeActor"]):
    """The spline tubes of one plotter.

    Parameters
    ----------
    plotter : pyvista.BasePlotter
        The plotter it belongs to.

    Examples
    --------
    >>> import pyvista as pv
    >>> pl = pv.Plotter(off_screen=True)
    >>> actor = pl.spline_tubes.add([[(0, 0, 0), (1, 1, 0), (2, 0, 0)]], radius=0.1, color="red")
    >>> list(pl.spline_tubes) == [actor]
    True
    """

    def __init__(self, plotter: pv.BasePlotter) -> None:
        self._init_keeping(plotter)

    def add(
        self,
        source: Source,
        *,
        radius: float | str | np.ndarray | None = None,
        scalars: str | np.ndarray | None = None,
        tangents: str | np.ndarray | None = None,
        method: str = "finite",
        radius_slopes: float | str | np.ndarray | None = None,
        scalar_slopes: str | np.ndarray | None = None,
        scaled: bool | None = None,
        color: Any = None,
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
        lighting: bool | None = None,
        name: str | None = None,
        label: str | None = None,
        show_scalar_bar: bool | None = None,
        scalar_bar_args: dict[str, Any] | None = None,
        pickable: bool = True,
        user_matrix: Any = None,
        reset_camera: bool | None = None,
        render: bool = True,
        silhouettes: str = "auto",
        solver: str = "auto",
        iterations: int | None = None,
        min_width: float = 1.0,
        culling: str | None = "two-phase",
    ) -> TubeActor:
        """Add tubes of varying radius around Hermite splines to the scene.

        Each pixel shows the point at which its ray enters the tube: there is no mesh, and so no
        facets however near the camera comes. Tubes cut into each other and into meshes.

        Parameters
        ----------
        source : PolyData, Streamlines, array, list of arrays, (points, segments), SplineTubes, FibletSet or path
            Lines whose points are the nodes of splines, in mm. One ``(n, 3)`` array is one tube; a
            line of one point is a ball.
        radius : float, str or array, optional
            Radius in mm: one for all, the name of data of ``source``, or a number per point or
            per line. By default the point data ``"radius"`` if there is such, else half a percent
            of the diagonal of the bounds.
        scalars : str or array, optional
            What colours the tubes: the name of data of ``source``; ``"radius"``, ``"arc_length"``,
            ``"length"``, or ``"orientation"`` (the absolute value of the direction as red, green,
            blue); or an array with one number or one colour (3 or 4 columns; floats with ``rgb``)
            per point or per line.
        tangents : str or array, optional
            ``(n_points, 3)`` derivatives of the positions, or the name of such point data. By
            default they are found from the points.
        method : {"finite", "catmull-rom", "natural"}, default: "finite"
            How derivatives that are not given are found: by differences with regard to length,
            by differences of the neighbours, or as natural cubic splines, which also bend smoothly.
        radius_slopes, scalar_slopes : str or array, optional
            Derivatives of radius and scalars at the points; found like the tangents by default.
        scaled : bool, optional
            Whether derivatives are by length (mm/mm), instead of by each segment's parameter
            from 0 to 1. By default by parameter where ``tangents`` are given, else by length.
        color : color-like, optional
            One colour for all, the theme's by default. ``scalars`` go before it.
        cmap : str, list or colormap, optional
            Colour map; the theme's by default.
        clim : float or (float, float), optional
            Values of the first and the last colour; the range of the nodes' values by default.
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
            Of all tubes; what lies behind the nearest surface of the tubes does not show through.
        lighting : bool, optional
            Shade the tubes by the scene's lights; the theme's by default.
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
        silhouettes : {"auto", "rectangles", "boxes", "pulled-boxes"}, default: "auto"
            What covers the pixels whose rays are tried; the picture is the same.
        solver : {"auto", "bisection", "illinois", "itp", "newton"}, default: "auto"
            How the first point on a ray is searched. ``"bisection"`` is the paper's.
        iterations : int, optional
            Steps of one search at most; the solver's own number by default.
        min_width : float, default: 1.0
            Pixels that a tube takes at least, however thin and far it is.
        culling : {"two-phase", None}, default: "two-phase"
            How segments behind others are found out, where there are many; the picture is the same.

        Returns
        -------
        TubeActor
            Its properties may be changed at any time.

        Raises
        ------
        KeyError
            If there is no array of the name given as ``scalars``.
        TypeError
            If ``source`` is of an unknown kind.
        ValueError
            If an argument has no meaning; the message names the array, the row and the value.

        Notes
        -----
        Source: Russig, Gumhold and Salm, "GPU-based raycasting of Hermite spline tubes" (2020).

        Examples
        --------
        A spring whose wire thickens, coloured by how thick it is:

        >>> import numpy as np
        >>> import pyvista as pv
        >>> t = np.linspace(0, 20, 60)
        >>> spring = np.stack([10 * np.cos(t), 10 * np.sin(t), 2 * t], axis=1)
        >>> pl = pv.Plotter(off_screen=True)
        >>> actor = pl.add_spline_tubes(spring, radius=0.5 + 0.05 * t, scalars="radius", cmap="plasma")
        >>> actor.prop.specular = 0.5
        >>> actor.tubes.n_segments
        59

        Few points make a smooth tube; with derivatives of your own it goes where you say:

        >>> nodes, slopes = np.array([(0, 0, 0), (10, 0, 0)]), np.array([(0, 20, 0), (0, 20, 0)])
        >>> actor = pl.add_spline_tubes(nodes, tangents=slopes, radius=[1, 2], color="tomato")
        """
        from pvfiblets.mappers.tubes import TubeOptions
        from pvfiblets.plotting.colours import ColourSettings
        from pvfiblets.plotting.tubes.actor import TubeActor
        from pvfiblets.plotting.tubes.scalars import as_tubes

        theme = self._plotter.theme
        options = TubeOptions(silhouettes, solver, iterations, min_width, culling)  # before the slow part
        tubes, choice = as_tubes(
            source,
            scalars=scalars,
            rgb=rgb,
            radius=radius,
            tangents=tangents,
            method=method,
            radius_slopes=radius_slopes,
            scalar_slopes=scalar_slopes,
            scaled=scaled,
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
        actor = TubeActor(
            tubes,
            scalars=choice,
            settings=settings,
            opacity=opacity,
            lighting=lighting,
            theme=theme,
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


@pv.register_plotter_component("add_spline_tubes")
class AddSplineTubes:
    """What makes ``plotter.add_spline_tubes`` callable; the same as ``plotter.spline_tubes.add``.

    Parameters
    ----------
    plotter : pyvista.BasePlotter
        The plotter it belongs to.
    """

    def __init__(self, plotter: pv.BasePlotter) -> None:
        self._plotter: Any = weakref.proxy(plotter)

    @same_as(SplineTubesComponent.add)
    def __call__(self, source: Source, **arguments: Any) -> TubeActor:
        """Add spline tubes; see :meth:`SplineTubesComponent.add`."""
        return self._plotter.spline_tubes.add(source, **arguments)
