"""``plotter.add_halo_points(...)`` and ``plotter.halo_points``, as `.component` is for lines."""

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

    from pvfiblets.halos import HaloPoints
    from pvfiblets.halos.displacement import Displacement
    from pvfiblets.plotting.halos.actors import HaloPointActor
    from pvfiblets.plotting.halos.style import Threshold
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

    def __init__(self, plotter: pv.BasePlotter) -> None:
        self._init_keeping(plotter)

    def add(
        self,
        source: Source,
        *,
        point_size: float | None = None,
        halo_size: float | None = None,
        max_displacement: float | None = None,
        displacement: Displacement = "linear",
        width_cue: float = WIDTH_CUE,
        scalars: str | np.ndarray | None = None,
        filter_by: str | np.ndarray | None = None,
        threshold: Threshold = None,
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
    ) -> HaloPointActor:
        """Add points with depth-dependent halos to the scene.

        A point is a disc that faces the viewer, in a cone that leads away from him: it hides others
        close to it on the screen that are farther behind, and none beside it. So a dense cloud of a
        surface shows where one part of it is in front of another.

        Parameters
        ----------
        source : DataSet, array, Streamlines, HaloPoints or path
            Points in mm: those of any dataset, or an ``(n, 3)`` array.
        point_size : float, optional
            Diameter of a point, mm. By default what suits the distances between them, which are
            measured.
        halo_size : float, optional
            Diameter of a point with its halo, mm; a multiple of ``point_size`` by default.
        max_displacement : float, optional
            mm by which the edges of halos lie behind their points. By default what suits
            ``halo_size`` and the extent of the data.
        displacement : {"linear", "square", "square root"}, table or function, default: "linear"
            How far back a halo lies from its middle to its edge, as for lines.
        width_cue : float, default: 0.5
            By which share the farthest points are smaller than the nearest, beside perspective.
        scalars : str or array, optional
            What colours the points, not their halos: the name of point data of ``source``, or an
            array with one number or one colour (3 or 4 columns; floats with ``rgb``) per point.
        filter_by : str or array, optional
            What ``threshold`` filters by: the name of numbers at points, or an array. Points without
            a number (NaN) do not show.
        threshold : float or (float, float), optional
            The least number that shows, or the least and the greatest, ``None`` for no end.
        color : color-like, optional
            One colour for all points, black by default. ``scalars`` go before it.
        halo_color : color-like or "background", optional
            Of the halos, white by default.
        light_on_dark : bool, default: False
            White points in black halos by default, instead of black ones in white.
        cmap, clim, n_colors, log_scale, nan_color, below_color, above_color, flip_scalars, rgb
            As for lines (``plotter.add_halo_lines``).
        opacity : float, default: 1.0
            Of points and halos; what of them lies behind the nearest does not show through.
        lighting : bool, default: False
            Shade the points by the scene's lights.
        smooth : bool, default: True
            Whether points turn into their halos gradually, over a pixel.
        min_width : float, default: 1.0
            Pixels that a point takes at least, however small and far it is.
        name, label, show_scalar_bar, scalar_bar_args, pickable, user_matrix, reset_camera, render
            As for lines.
        culling : {"two-phase", None}, default: "two-phase"
            How points behind others are found out, where there are many; the picture is the same.

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
        from pvfiblets.plotting.colours import ColourSettings
        from pvfiblets.plotting.halos.actors import HaloPointActor
        from pvfiblets.plotting.halos.scalars import as_points
        from pvfiblets.plotting.halos.style import LookSettings

        options = HaloOptions(culling)  # before the slow part
        held = as_points(source, scalars=scalars, rgb=rgb, filter_by=filter_by)
        looks = LookSettings(
            line_width=point_size,
            strip_width=halo_size,
            max_displacement=max_displacement,
            displacement=displacement,
            width_cue=width_cue,
            min_width=min_width,
            smooth=smooth,
            filter_by=held.filter_by,
            threshold=threshold,
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
        actor = HaloPointActor(
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


@pv.register_plotter_component("add_halo_points")
class AddHaloPoints:
    """What makes ``plotter.add_halo_points`` callable; the same as ``plotter.halo_points.add``.

    Parameters
    ----------
    plotter : pyvista.BasePlotter
        The plotter it belongs to.
    """

    def __init__(self, plotter: pv.BasePlotter) -> None:
        self._plotter: Any = weakref.proxy(plotter)

    @same_as(HaloPointsComponent.add)
    def __call__(self, source: Source, **arguments: Any) -> HaloPointActor:
        """Add points with halos; see :meth:`HaloPointsComponent.add`."""
        return self._plotter.halo_points.add(source, **arguments)
