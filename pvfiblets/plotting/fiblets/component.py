"""``plotter.add_fiblets(...)`` and ``plotter.fiblets``.

PyVista finds this module by two entry points and imports it when a plotter is first asked for
either name. :class:`FibletsComponent` lives as long as its plotter; its life cycle is that of
`pvfiblets.plotting.actors.registry`.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
import pyvista as pv

from pvfiblets.plotting.actors.registry import ActorRegistry
from pvfiblets.plotting.components import register
from pvfiblets.plotting.fiblets.picking import MousePicking
from pvfiblets.plotting.fiblets.settings import FibletSettings
from pvfiblets.plotting.filtering.state import unique_name
from pvfiblets.plotting.settings.call_signature import plotter_method, refuse_unknown
from pvfiblets.plotting.settings.mesh_arguments import ThickLineCommon
from pvfiblets.plotting.settings.places import OPTIONS
from pvfiblets.plotting.settings.settings import Given, Setting
from pvfiblets.plotting.settings.unsupported_arguments import why_not

if TYPE_CHECKING:
    from os import PathLike
    from pathlib import Path

    from pvfiblets.codec.encoding.compress import PerPoint
    from pvfiblets.codec.fibletset import FibletSet
    from pvfiblets.engine.gl.capabilities import PipelineTable
    from pvfiblets.plotting.colours.same_names import Preference
    from pvfiblets.plotting.fiblets.actor import FibletActor
    from pvfiblets.plotting.fiblets.pick_result import Picked
    from pvfiblets.plotting.fiblets.slabs import FibletSlab
    from pvfiblets.plotting.notebook_view import PageView
    from pvfiblets.streamlines import Streamlines

    Source: TypeAlias = str | PathLike[str] | FibletSet | Streamlines | pv.PolyData | list[Any]


@register("fiblets")
class FibletsComponent(ActorRegistry["FibletActor"]):
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

    _SETTINGS = FibletSettings
    COMMON = ThickLineCommon
    NAME, ADD = "fiblets", "add_fiblets"

    def __init__(self, plotter: pv.BasePlotter) -> None:
        super().__init__(plotter)
        self._picking: MousePicking | None = None
        self._removals: dict[str, Callable[[], None]] = {}  # of slabs and widgets, by the names of their cuts

    def _make(
        self,
        source: Source,
        settings: Given,
        *,
        scalars: str | np.ndarray | pv.ImageData | tuple[Any, Any] | None = None,
        per_point: PerPoint | Iterable[str] = "fit",
        max_error: float | None = None,
        progress: bool = False,
        preference: Preference = "point",
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
            ``"group"``; ``"ends"``, the direction from end to end as red, green, blue; ``"id"``,
            the number of the streamline; ``"random"``, a colour for each; ``"density"``,
            streamlines per pixel), the name of per-streamline or
            per-point data, or an array with one value or one colour per streamline or per point.
            3 or 4 columns of uint8, or of floats from 0 to 1, are colours, as VTK takes bytes (such as the array
            ``colors`` that DIPY writes); other columns are vectors, mapped by their magnitude. ``rgb=True`` or
            ``rgb=False`` decides otherwise, as in ``add_mesh``. A colour per point takes 3 bytes (4 with an alpha),
            and 4 on the GPU; with an alpha it is drawn in 6 bits a channel. Words, one per streamline, are categories.
            The path of a file with a number per point or per streamline is another choice: ``.tsf``
            (MRtrix), ``.npy``, ``.txt``, ``.csv``; it is called by its name without the suffix.
            ``"coding_error"`` shows how far each point is from where it was, if ``source`` is not
            compressed yet; ``regions.Distance(…)`` how far it is from a region or position.

            Or a volume, in the coordinates of the streamlines' data: a
            :class:`pyvista.ImageData`, ``(array, affine)``, or a NIfTI image or its path. It is
            sampled on the GPU at every point: floats trilinear, integers (labels) by the nearest
            voxel; ``nan_color`` shows outside of it.
        per_point : iterable of str, or {'all', 'fit', 'none'}
            Per-point arrays of ``source`` to keep besides ``scalars``, for criteria and other colours: by default
            the arrays that fit into 16 bytes a point. They take no GPU memory until they colour.
        max_error : float, optional
            Greatest distance (mm) of a drawn from a given point; by default as :func:`pvfiblets.compress` has it.
        progress : bool, default: False
            Show a progress bar while reading, compressing, and copying to the GPU.
        preference : {'point', 'cell'}, default: 'point'
            Which array a name means that both points and lines (cells) have, here and in criteria; the other is
            called ``"NAME (line)"`` or ``"NAME (point)"``.
        **options
            Further arguments of :func:`pvfiblets.codec.encoding.compress`, such as ``step`` or ``effort``.

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
        from pvfiblets.mappers.engine_options import EngineOptions
        from pvfiblets.plotting.fiblets.actor import FibletActor
        from pvfiblets.plotting.fiblets.sources import as_fiblets

        EngineOptions(**settings.at(OPTIONS))  # errors are raised before the slow part
        fiblets, scalars = as_fiblets(
            source, scalars=scalars, per_point=per_point, max_error=max_error, progress=progress,
            rgb=settings["rgb"], opacity=settings["opacity"], preference=preference, **options,
        )  # fmt: skip
        return FibletActor(
            fiblets, scalars=scalars, settings=settings, theme=self._plotter.theme, progress=progress
        )

    def _check_known(self, own: dict[str, Any]) -> None:
        options = set(own) - self.OWN
        if not options:
            return
        from pvfiblets.codec.encoding.compress import compress
        from pvfiblets.plotting.fiblets.actor import FibletActor

        unknown = sorted(options - set(inspect.signature(compress).parameters))
        live = [name for name in unknown if isinstance(getattr(FibletActor, name, None), (property, Setting))]
        if live and why_not(self.ADD, unknown[0]) is None:
            sets = "; ".join(f"actor.{name} = ..." for name in live)
            raise TypeError(f"add_fiblets() takes no {', '.join(live)}: set it on the actor that it returns ({sets})")
        refuse_unknown(self, unknown)

    # Picking ------------------------------------------------------------------------------------

    def enable_picking(
        self,
        callback: Callable[[Picked], Any] | None = None,
        *,
        mode: str = "click",
        through: bool = False,
        button: str = "left",
        tolerance: float = 4.0,
        tooltip: bool | Callable[[Picked], str] = False,
        select: bool = True,
        start: bool = False,
        show_message: bool | str = True,
        font_size: int = 18,
        color: Any = None,
    ) -> None:
        """Pick streamlines with the mouse; this replaces earlier picking.

        Parameters
        ----------
        callback : callable, optional
            Called with a :class:`~pvfiblets.plotting.fiblets.pick_result.Picked` for each actor with
            picked streamlines.
        mode : {"click", "box", "lasso"}
            ``"click"``: the streamline nearest to the mouse; dragging still turns the camera.
            ``"box"`` and ``"lasso"``: all streamlines within the shape drawn with the left button. The ``r``
            key (PyVista's key for rectangles) starts and ends this mode. A click picks then, too.
        through : bool, default: False
            Pick all streamlines under the mouse or in the area, occluded ones too; otherwise only
            visible ones. Opaque actors occlude streamlines, translucent ones do not.
        button : {"left", "right"}
            Mouse button of a click.
        tolerance : float, default: 4.0
            Largest distance between the mouse and a streamline, pixels.
        tooltip : bool or callable, default: False
            Show index, position, value and groups of the streamline under the mouse; or the text that
            a function of a :class:`Picked` returns.
        select : bool, default: True
            Select the picked streamlines (:meth:`FibletActor.select`): Shift adds them, Control
            toggles them. A pick of nothing, without a key, clears the selection.
        start : bool, default: False
            Draw areas without pressing the ``r`` key first.
        show_message : bool or str, default: True
            Show a message that explains picking.
        font_size : int, default: 18
            Size of the message.
        color : color-like, optional
            Colour of the outline of areas and of the message; by default black or white, by contrast
            with the background.

        Raises
        ------
        TypeError
            If the callback cannot be called.
        ValueError
            If there is no such mode or button, or the tolerance is not a distance.
        RuntimeError
            If the plotter is closed.
        """
        picking = MousePicking(
            self._plotter, self, callback, mode=mode, through=through, button=button, tolerance=tolerance,
            tooltip=tooltip, select=select,
        )  # fmt: skip
        self.disable_picking()
        self._picking = picking
        picking.begin(start=start, show_message=show_message, font_size=font_size, color=color)

    def disable_picking(self) -> None:
        """Undo :meth:`enable_picking`; the selection stays. A second call has no effect."""
        if self._picking is not None:
            self._picking.stop()
            self._picking = None

    # Slabs and widgets that cut -----------------------------------------------------------------

    def add_slab(
        self,
        actor: FibletActor | Sequence[FibletActor] | None = None,
        normal: Any = "z",
        *,
        origin: Any = None,
        thickness: float = 5.0,
        volume: Any = None,
        name: str | None = None,
        render: bool = True,
        **mesh_options: Any,
    ) -> FibletSlab:
        """Cut actors to a slab, and show the slice of a volume in its middle.

        Parameters
        ----------
        actor : FibletActor or sequence of FibletActor, optional
            What is cut; all fiblet actors by default.
        normal : str or (3,) array, default: "z"
            ``"x"``, ``"y"``, ``"z"``, or a direction.
        origin : float or (3,) array, optional
            A point of the slab's middle plane, or how far along the normal it is; the actors' middle by default, mm.
        thickness : float, default: 5.0
            mm.
        volume : pyvista.DataSet, optional
            Drawn where the middle plane cuts it, in world coordinates.
        name : str, optional
            Of the cut.
        render : bool, default: True
            Render at once if the window is shown already.
        **mesh_options
            For :meth:`pyvista.Plotter.add_mesh` of the slice, such as ``cmap``, ``clim``,
            ``opacity``.

        Returns
        -------
        FibletSlab
            ``position``, ``thickness``, ``normal`` and ``origin`` are live; ``remove()`` ends it.
        """
        from pvfiblets.plotting.fiblets.slabs import FibletSlab
        from pvfiblets.plotting.fiblets.widgets import centre

        actors = self._cut_actors(actor)
        slab = FibletSlab(
            self._plotter,
            actors,
            self._new_name(name, "slab"),
            normal=normal,
            origin=centre(actors) if origin is None else origin,
            thickness=thickness,
            volume=volume,
            **mesh_options,
        )
        self._removals[slab.name] = slab.remove
        if render:
            self._plotter.render()
        return slab

    def add_clip_plane_widget(
        self,
        actor: FibletActor | Sequence[FibletActor] | None = None,
        normal: Any = "x",
        *,
        origin: Any = None,
        invert: bool = False,
        name: str | None = None,
        interaction_event: Any = "always",
        **widget_options: Any,
    ) -> Any:
        """Add a plane that cuts where it is dragged.

        Parameters
        ----------
        actor : FibletActor or sequence of FibletActor, optional
            What is cut; all fiblet actors by default.
        normal : str or (3,) array, default: "x"
            Normal of the plane; the side to which it points stays.
        origin : (3,) array, optional
            A point of the plane; the middle of the actors by default, mm.
        invert : bool, default: False
            Keep the other side.
        name : str, optional
            Of the cut.
        interaction_event : str, default: "always"
            ``"end"`` cuts only when the mouse is let go.
        **widget_options
            For :meth:`pyvista.Plotter.add_plane_widget`.

        Returns
        -------
        vtkImplicitPlaneWidget
        """
        actors, name = self._cut_actors(actor), self._new_name(name, "plane")

        def cut(normal: Any, origin: Any) -> None:
            for item in actors:
                item.clip((normal, origin), inside=not invert, name=name)

        from pvfiblets.plotting.fiblets.widgets import plane

        widget, self._removals[name] = plane(
            self._plotter, actors, name, cut, normal=normal, origin=origin, event=interaction_event, **widget_options
        )
        return widget

    def add_clip_slab_widget(
        self,
        actor: FibletActor | Sequence[FibletActor] | None = None,
        normal: Any = "z",
        *,
        origin: Any = None,
        thickness: float = 5.0,
        volume: Any = None,
        name: str | None = None,
        interaction_event: Any = "always",
        mesh_options: dict[str, Any] | None = None,
        **widget_options: Any,
    ) -> tuple[Any, FibletSlab]:
        """Add a plane that a slab follows; parameters as for :meth:`add_slab`.

        Parameters
        ----------
        actor, normal, origin, thickness, volume, name
            As for :meth:`add_slab`.
        interaction_event : str, default: "always"
            ``"end"`` cuts only when the mouse is let go.
        mesh_options : dict, optional
            For :meth:`pyvista.Plotter.add_mesh` of the slice.
        **widget_options
            For :meth:`pyvista.Plotter.add_plane_widget`.

        Returns
        -------
        widget : vtkImplicitPlaneWidget
        slab : FibletSlab
            For its thickness.
        """
        actors = self._cut_actors(actor)
        slab = self.add_slab(
            actors,
            normal,
            origin=origin,
            thickness=thickness,
            volume=volume,
            name=name,
            render=False,
            **(mesh_options or {}),
        )

        from pvfiblets.plotting.fiblets.widgets import plane

        widget, take_plane = plane(
            self._plotter, actors, slab.name, lambda normal, origin: slab.place(normal=normal, origin=origin),
            normal=normal, origin=slab.origin, event=interaction_event, **widget_options,
        )  # fmt: skip

        def remove() -> None:
            take_plane()
            slab.remove()

        self._removals[slab.name] = remove
        return widget, slab

    def add_clip_box_widget(
        self,
        actor: FibletActor | Sequence[FibletActor] | None = None,
        *,
        bounds: Any = None,
        invert: bool = False,
        name: str | None = None,
        interaction_event: Any = "always",
        **widget_options: Any,
    ) -> Any:
        """Add a box that cuts where it is dragged, turned or not.

        Parameters
        ----------
        actor : FibletActor or sequence of FibletActor, optional
            What is cut; all fiblet actors by default.
        bounds : (6,) array, optional
            Bounds of the box, mm; by default of the actors.
        invert : bool, default: False
            Keep the outside.
        name : str, optional
            Of the cut.
        interaction_event : str, default: "always"
            ``"end"`` cuts only when the mouse is let go.
        **widget_options
            For :meth:`pyvista.Plotter.add_box_widget`.

        Returns
        -------
        vtkBoxWidget
        """
        from pvfiblets.plotting.fiblets.widgets import box

        actors, name = self._cut_actors(actor), self._new_name(name, "box")
        widget, self._removals[name] = box(
            self._plotter, actors, name, bounds=bounds, inside=not invert, event=interaction_event, **widget_options
        )
        return widget

    def add_clip_mesh_widget(
        self,
        mesh: pv.PolyData,
        actor: FibletActor | Sequence[FibletActor] | None = None,
        *,
        invert: bool = False,
        name: str | None = None,
        color: Any = "white",
        opacity: float = 0.2,
        mesh_options: dict[str, Any] | None = None,
        **widget_options: Any,
    ) -> tuple[Any, pv.Actor]:
        """Add a closed mesh that cuts wherever it is dragged and turned.

        Parameters
        ----------
        mesh : pyvista.PolyData
            Closed; concave ones cut as exactly as convex ones.
        actor : FibletActor or sequence of FibletActor, optional
            What is cut; all fiblet actors by default.
        invert : bool, default: False
            Keep the outside.
        name : str, optional
            Of the cut.
        color : color-like, default: "white"
            Of the mesh.
        opacity : float, default: 0.2
            Of the mesh.
        mesh_options : dict, optional
            For :meth:`pyvista.Plotter.add_mesh`.
        **widget_options
            For :meth:`pyvista.Plotter.add_affine_transform_widget`.

        Returns
        -------
        widget : pyvista.plotting.affine_widget.AffineWidget3D
        actor : pyvista.Actor
            Draws the mesh; its ``user_matrix`` places it.

        Raises
        ------
        ValueError
            If the mesh is open, empty or inside-out.
        """
        from pvfiblets.plotting.fiblets.widgets import surface
        from pvfiblets.plotting.filtering.region_sources import as_region

        region = as_region(mesh)
        actors, name = self._cut_actors(actor), self._new_name(name, "mesh")
        look = dict(color=color, opacity=opacity, **(mesh_options or {}))
        widget, shown, self._removals[name] = surface(
            self._plotter, actors, name, mesh, region, inside=not invert, look=look, **widget_options
        )
        return widget, shown

    def clear_widgets(self) -> None:
        """Remove all slabs and cutting widgets, with their cuts."""
        for remove in list(self._removals.values()):
            remove()
        self._removals.clear()
        self._plotter.render()

    def _cut_actors(self, actor: Any) -> list[FibletActor]:
        actors = list(self) if actor is None else list(actor) if isinstance(actor, Sequence) else [actor]
        if not actors:
            raise ValueError("this plotter has no fiblets to cut; add_fiblets() first")
        return actors

    def _new_name(self, name: str | None, stem: str) -> str:
        """Return a name for a cut; a widget of the same name goes."""
        if name is None:
            return unique_name(self._removals, f"{stem} widget")
        if name in self._removals:
            self._removals.pop(name)()
        return name

    # Pipelines and pages ------------------------------------------------------------------------

    def pipelines(self) -> PipelineTable:
        """Return all pipelines, each with its availability in the plotter's OpenGL, or the missing requirement.

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
        from pvfiblets.engine.gl.capabilities import pipelines
        from pvfiblets.mappers.frames.windows import borrowed_context

        window = self._plotter.render_window
        if window is None:
            raise RuntimeError("this plotter is closed and has no OpenGL context; make a new plotter")
        with borrowed_context(window) as ctx:
            return pipelines(ctx)

    def export_page(
        self, path: str | PathLike[str], *, title: str | None = None, largest_file: int | None = None
    ) -> list[Path]:
        """Write the active renderer's scene as a page that any browser renders, without a server.

        Streamlines stay compressed in it, at 1.1 to 1.4 bytes a point (16 in sets of less than a megabyte, which are
        exact), and the reader's graphics card decodes them. Readers turn, zoom, cut and pick. Surfaces of ``add_mesh``,
        slices of images, colour bars and lights go along. Unless the plotter's camera was set, the first view is
        oblique and fits the reader's window.

        Parameters
        ----------
        path : str or PathLike
            A name ending in ``.html``, or without an ending: a folder with ``index.html``.
        title : str, optional
            Of the page; the plotter's by default.
        largest_file : int, optional
            Bytes of data above which data are written to a folder beside the page, which then needs a web server;
            64 MB by default.

        Returns
        -------
        list of pathlib.Path
            What was written, the page first.

        Raises
        ------
        ValueError
            If the plotter is empty, or the name has another ending.
        OSError
            If it cannot be written.

        Warns
        -----
        UserWarning
            If a page cannot draw parts of the scene: tubes, halos, volumes, and effects on lines other than light.

        Examples
        --------
        >>> import pyvista as pv
        >>> from pvfiblets.synthetic import brain_streamlines
        >>> pl = pv.Plotter(off_screen=True)
        >>> _ = pl.add_fiblets(brain_streamlines(1000))
        >>> pl.fiblets.export_page("figure.html")  # doctest: +SKIP
        """
        from pvfiblets.plotting.page.page_scene import export_page

        return export_page(self._plotter, path, title=title, largest_file=largest_file)

    def page_view(self, *, title: str | None = None, height: int = 480) -> PageView:
        """Return the page of `export_page` for a notebook's cell, which keeps it: it needs no kernel later.

        ``plotter.show(jupyter_backend="fiblets")`` shows it, too. While there is a kernel, and anywidget is installed
        (``pip install pvfiblets[notebook]``), page and plotter share one camera, and the view reports picks.

        Parameters
        ----------
        title : str, optional
            Of the page.
        height : int, default: 480
            Pixels, 50 to 10,000.

        Returns
        -------
        PageView
            As the last expression of a cell it is shown.

        Raises
        ------
        ValueError
            If the plotter is empty, or has more than 64 MB of data.
        """
        from pvfiblets.plotting.notebook_view import page_view

        return page_view(self._plotter, title=title, height=height)

    def __plotter_close__(self) -> None:
        """Release everything; PyVista calls this before the render window goes."""
        self.disable_picking()
        super().__plotter_close__()


AddFiblets = plotter_method(FibletsComponent)
