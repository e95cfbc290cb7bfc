"""``plotter.add_fiblets(...)`` and ``plotter.fiblets``.

PyVista finds this module by two entry points and imports it when a plotter is first asked for
either name. :class:`FibletsComponent` lives as long as its plotter; its life cycle is that of
`pvfiblets.plotting.actor_registry`.
"""

from __future__ import annotations

import inspect
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
import pyvista as pv

from pvfiblets.plotting.actor_registry import ActorRegistry
from pvfiblets.plotting.call_signature import plotter_method
from pvfiblets.plotting.fiblets.picking import Picking
from pvfiblets.plotting.fiblets.settings import FibletSettings
from pvfiblets.plotting.fiblets.widgets import Widgets
from pvfiblets.plotting.setting_places import OPTIONS
from pvfiblets.plotting.settings import Given, Setting
from pvfiblets.plotting.words_of_add_mesh import why_not

if TYPE_CHECKING:
    from os import PathLike
    from pathlib import Path

    from pvfiblets.codec.compress import PerPoint
    from pvfiblets.codec.fibletset import FibletSet
    from pvfiblets.engine.gl.capabilities import PipelineTable
    from pvfiblets.plotting.fiblets.actor import FibletActor
    from pvfiblets.plotting.notebook_view import PageView
    from pvfiblets.plotting.same_names import Preference
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

    _SETTINGS = FibletSettings
    NAME, ADD = "fiblets", "add_fiblets"

    def __init__(self, plotter: pv.BasePlotter) -> None:
        super().__init__(plotter)
        self._init_widgets()
        self._init_picking()

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
            those that fit into 16 bytes a point. They take no GPU memory until they colour.
        max_error : float, optional
            Greatest distance (mm) of a drawn from a given point; by default as :func:`pvfiblets.compress` has it.
        progress : bool, default: False
            Show a progress bar while reading, compressing, and copying to the GPU.
        preference : {'point', 'cell'}, default: 'point'
            Which array a name means that both points and lines (cells) have, here and in criteria; the other is
            called ``"NAME (line)"`` or ``"NAME (point)"``.
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
        from pvfiblets.mappers.engine_options import EngineOptions
        from pvfiblets.plotting.fiblets.actor import FibletActor
        from pvfiblets.plotting.fiblets.sources import as_fiblets

        EngineOptions(**settings.at(OPTIONS))  # what is wrong with them is said before the slow part
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
        from pvfiblets.codec.compress import compress
        from pvfiblets.plotting.fiblets.actor import FibletActor

        unknown = sorted(options - set(inspect.signature(compress).parameters))
        live = [name for name in unknown if isinstance(getattr(FibletActor, name, None), (property, Setting))]
        if live and why_not(self.ADD, unknown[0]) is None:
            sets = "; ".join(f"actor.{name} = ..." for name in live)
            raise TypeError(f"add_fiblets() takes no {', '.join(live)}: set it on the actor that it returns ({sets})")
        self._refuse(unknown)

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
        from pvfiblets.engine.gl.capabilities import pipelines
        from pvfiblets.mappers.windows import borrowed_context

        window = self._plotter.render_window
        if window is None:
            raise RuntimeError("this plotter is closed and has no OpenGL; ask a new one")
        with borrowed_context(window) as ctx:
            return pipelines(ctx)

    def export_page(
        self, path: str | PathLike[str], *, title: str | None = None, largest_file: int | None = None
    ) -> list[Path]:
        """Write what the active renderer shows as a page that any browser draws by itself, without a server.

        Streamlines stay compressed in it, 1.9 bytes a point, and the reader's graphics card decodes them: the picture
        can be turned, zoomed, cut and picked in. Surfaces of ``add_mesh``, slices of images, colour bars and lights go
        along.

        Parameters
        ----------
        path : str or PathLike
            A name ending in ``.html``, or without an ending: a folder with ``index.html``.
        title : str, optional
            Of the page; the plotter's by default.
        largest_file : int, optional
            Bytes of data above which they lie in a folder beside the page, which then needs a web server; 64 MB by
            default.

        Returns
        -------
        list of pathlib.Path
            What was written, the page first.

        Raises
        ------
        ValueError
            If there is nothing to show, or the name has another ending.
        OSError
            If it cannot be written.

        Warns
        -----
        UserWarning
            Naming what a page cannot draw: tubes, halos, volumes, and effects on lines other than light.

        Examples
        --------
        >>> import pyvista as pv
        >>> from pvfiblets.synthetic import brain_streamlines
        >>> pl = pv.Plotter(off_screen=True)
        >>> _ = pl.add_fiblets(brain_streamlines(1000))
        >>> pl.fiblets.export_page("figure.html")  # doctest: +SKIP
        """
        from pvfiblets.plotting.page_scene import export_page

        return export_page(self._plotter, path, title=title, largest_file=largest_file)

    def page_view(self, *, title: str | None = None, height: int = 480) -> PageView:
        """Return the page of `export_page` for a notebook's cell, which keeps it: it needs no kernel later.

        ``plotter.show(jupyter_backend="fiblets")`` shows it, too. While there is a kernel, and anywidget is installed
        (``pip install pvfiblets[notebook]``), page and plotter have one camera, and the view tells what was picked.

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
            If there is nothing to show, or more than 64 MB of data.
        """
        from pvfiblets.plotting.notebook_view import page_view

        return page_view(self._plotter, title=title, height=height)

    def __plotter_close__(self) -> None:
        """Release everything; PyVista calls this before the render window goes."""
        self.disable_picking()
        super().__plotter_close__()


AddFiblets = plotter_method(FibletsComponent)
