"""``plotter.add_fiblets(...)`` and ``plotter.fiblets``.

PyVista finds this module by two entry points and imports it when a plotter is first asked for
either name. :class:`FibletsComponent` lives as long as its plotter; its life cycle is that of
`pvfiblets.plotting.actor_registry`.
"""

from __future__ import annotations

import inspect
import weakref
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
import pyvista as pv

from pvfiblets.plotting.actor_registry import ActorRegistry, same_as
from pvfiblets.plotting.fiblets.picking import Picking
from pvfiblets.plotting.fiblets.widgets import Widgets

if TYPE_CHECKING:
    from os import PathLike

    from pvfiblets.codec.fibletset import FibletSet
    from pvfiblets.engine.capabilities import PipelineTable
    from pvfiblets.plotting.fiblets.actor import FibletActor
    from pvfiblets.streamlines import Streamlines

    Source: TypeAlias = str | PathLike[str] | FibletSet | Streamlines | pv.PolyData | list[Any]


@pv.register_plotter_component("fiblets")
class FibletsComponent(ActorRegistry["FibletActor"], Picking, Widgets):
    """The fiblet actors of one plotter.

    Parameters
    ----------
    plotter : pyvista.BasePlotter
        The plotter it belongs to.

    Examples
    --------
    >>> import pyvista as pv
    >>> pl = pv.Plotter(off_screen=True)
    >>> actor = pl.fiblets.add([[(0, 0, 0), (1, 1, 0), (2, 0, 0)]], color="red")
    >>> list(pl.fiblets) == [actor]
    True
    """

    def __init__(self, plotter: pv.BasePlotter) -> None:
        self._init_keeping(plotter)
        self._init_widgets()
        self._init_picking()

    def add(
        self,
        /,
        source: Source,
        *,
        scalars: str | np.ndarray | pv.ImageData | tuple[Any, Any] | None = None,
        color: Any = None,
        cmap: Any = None,
        clim: Any = None,
        n_colors: int = 256,
        log_scale: bool = False,
        nan_color: Any = None,
        below_color: Any = None,
        above_color: Any = None,
        flip_scalars: bool = False,
        categories: bool = False,
        opacity: float = 1.0,
        transparency: str | int | None = None,
        line_width: float | None = None,
        lighting: bool | None = True,
        name: str | None = None,
        label: str | None = None,
        show_scalar_bar: bool | None = None,
        scalar_bar_args: dict[str, Any] | None = None,
        pickable: bool = True,
        user_matrix: Any = None,
        reset_camera: bool | None = None,
        render: bool = True,
        per_point: Iterable[str] = (),
        max_error: float | None = None,
        progress: bool = False,
        pipeline: str = "auto",
        culling: str | None = "two-phase",
        fit: str | None = None,
        **options: Any,
    ) -> FibletActor:
        """Add streamlines to the scene, compressed.

        Parameters
        ----------
        source : path, FibletSet, Streamlines, pyvista.PolyData or list of (n, 3) arrays
            What to draw; anything not compressed yet is compressed first.
        scalars : str, array or volume, optional
            What colours the streamlines: ``"orientation"`` (the default: the absolute value of
            the direction as red, green, blue), a built-in array (``"length"``, ``"curvature"``,
            ``"arc_length"``, ``"n_points"``, ``"mean_curvature"``, ``"end_distance"``,
            ``"group"``), the name of per-streamline or per-point data, or an array with one
            value per streamline or per point, or one colour (3 or 4 columns) per streamline.
            ``"coding_error"`` shows how far each point is from where it was, if ``source`` is not
            compressed yet; ``regions.Distance(…)`` how far it is from a region or position.

            Or a volume, in the coordinates of the streamlines' data: a
            :class:`pyvista.ImageData`, ``(array, affine)``, or a NIfTI image or its path. It is
            sampled on the GPU at every point: floats trilinear, integers (labels) by the nearest
            voxel; ``nan_color`` shows outside of it.
        color : color-like, optional
            One colour for all. ``scalars`` go before it.
        cmap : str, list or colormap, optional
            Colour map; the theme's by default.
        clim : float or (float, float), optional
            Values of the first and the last colour; the range of the data by default.
        n_colors : int, default: 256
            Number of colours in the map.
        log_scale : bool, default: False
            Spread the colours over the logarithm of the values.
        nan_color, below_color, above_color : color-like, optional
            Colour of NaN, and of values outside ``clim``.
        flip_scalars : bool, default: False
            Reverse the colour map.
        categories : bool, default: False
            As many colours as there are different values, instead of ``n_colors``.
        opacity : float, default: 1.0
            Of all streamlines.
        transparency : {None, "layers"} or int, optional
            How many layers of lines show through each other where ``opacity`` is below 1:
            ``None``, the nearest alone; ``"layers"``, four; or a number from 2 to 64.
        line_width : float, optional
            In pixels; the theme's by default.
        lighting : bool, default: True
            Shade the lines by the scene's lights; ``None`` for the theme's.
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
        per_point : iterable of str
            Per-point arrays of ``source`` to keep besides ``scalars``.
        max_error : float, optional
            Greatest distance (mm) of a drawn from a given point; a tenth of a step by default.
        progress : bool, default: False
            Show a progress bar while reading, compressing, and copying to the GPU.
        pipeline : str, default: "auto"
            How fiblets become pixels; ``"auto"`` takes the fastest that the plotter's OpenGL has, and
            :meth:`pipelines` lists all.
        culling : {"two-phase", "coverage", None}, default: "two-phase"
            How fiblets behind others are found out. ``"two-phase"`` changes no pixel;
            ``"coverage"`` may lose some for a frame after the camera jumped; ``None`` draws all
            that the camera may see.
        fit : {None, "sample"}, optional
            Where the fiblets need more GPU memory than there is: ``None`` refuses, ``"sample"``
            draws a share of the streamlines.
        **options
            Further arguments of :func:`pvfiblets.codec.compress`, such as ``step`` or ``effort``.

        Returns
        -------
        FibletActor
            Its properties may be changed at any time.

        Raises
        ------
        KeyError
            If there is no array of the name given as ``scalars``.
        TypeError
            If ``source`` is of an unknown kind.
        ValueError
            If an argument has no meaning.

        Examples
        --------
        >>> import pyvista as pv
        >>> from pvfiblets.synthetic import brain_streamlines
        >>> pl = pv.Plotter(off_screen=True)
        >>> actor = pl.add_fiblets(brain_streamlines(1000), scalars="length", cmap="plasma")
        >>> actor.line_width = 2
        """
        from pvfiblets.mappers.engines import EngineOptions
        from pvfiblets.plotting.colours import ColourSettings
        from pvfiblets.plotting.fiblets.actor import FibletActor
        from pvfiblets.plotting.fiblets.sources import as_fiblets

        _check_options(options)
        theme = self._plotter.theme
        engine = EngineOptions(pipeline=pipeline, culling=culling, fit=fit)  # before the slow part
        fiblets, scalars = as_fiblets(
            source, scalars=scalars, per_point=per_point, max_error=max_error, progress=progress, **options
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
            categories=bool(categories),
        )
        actor = FibletActor(
            fiblets,
            scalars=scalars,
            settings=settings,
            line_width=line_width,
            opacity=opacity,
            lighting=lighting,
            theme=theme,
            options=engine,
            progress=progress,
        )
        actor.transparency = transparency
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

    def pipelines(self) -> PipelineTable:
        """Return every pipeline: whether the plotter's OpenGL has it, or why not.

        Returns
        -------
        PipelineTable
            A list, the fastest first, that prints as a table; ``auto`` is the one that
            ``pipeline="auto"`` takes. A plotter that has not been shown starts its OpenGL for it.

        Raises
        ------
        RuntimeError
            If the plotter is closed.

        Examples
        --------
        >>> import pyvista as pv
        >>> pl = pv.Plotter(off_screen=True)
        >>> [info.name for info in pl.fiblets.pipelines() if info.available]  # doctest: +SKIP
        ['compute', 'tessellation', 'geometry']
        """
        from pvfiblets.engine.capabilities import pipelines
        from pvfiblets.mappers.windows import borrowed_context

        window = self._plotter.render_window
        if window is None:
            raise RuntimeError("this plotter is closed and has no OpenGL; ask a new one")
        with borrowed_context(window) as ctx:
            return pipelines(ctx)

    def __plotter_close__(self) -> None:
        """Release everything; PyVista calls this before the render window goes."""
        self.disable_picking()
        super().__plotter_close__()


@pv.register_plotter_component("add_fiblets")
class AddFiblets:
    """What makes ``plotter.add_fiblets`` callable; the same as ``plotter.fiblets.add``.

    Parameters
    ----------
    plotter : pyvista.BasePlotter
        The plotter it belongs to.
    """

    def __init__(self, plotter: pv.BasePlotter) -> None:
        self._plotter: Any = weakref.proxy(plotter)

    @same_as(FibletsComponent.add)
    def __call__(self, source: Source, **arguments: Any) -> FibletActor:
        """Add streamlines; see :meth:`FibletsComponent.add`."""
        return self._plotter.fiblets.add(source, **arguments)


def _check_options(options: dict[str, Any]) -> None:
    """Refuse what compressing does not know, before it is said of a function that nobody called."""
    if not options:
        return
    from pvfiblets.codec.compress import compress
    from pvfiblets.plotting.fiblets.actor import FibletActor

    unknown = sorted(set(options) - set(inspect.signature(compress).parameters))
    live = [name for name in unknown if isinstance(getattr(FibletActor, name, None), property)]
    if live:
        sets = "; ".join(f"actor.{name} = ..." for name in live)
        raise TypeError(f"add_fiblets() takes no {', '.join(live)}: set it on the actor that it returns ({sets})")
    if unknown:
        raise TypeError(f"add_fiblets() got an unexpected keyword argument {unknown[0]!r}")
