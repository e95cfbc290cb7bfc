"""The actor that ``plotter.add_fiblets`` returns: an ordinary PyVista actor with live colours."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import pyvista as pv

from pvfiblets.mappers.colouring import Colouring
from pvfiblets.mappers.engines import EngineOptions
from pvfiblets.mappers.fiblets import FibletMapper
from pvfiblets.plotting.coloured import Coloured
from pvfiblets.plotting.fiblets.engine_options import Engines
from pvfiblets.plotting.fiblets.filtering import Filtering
from pvfiblets.plotting.fiblets.scalars import find_scalars
from pvfiblets.plotting.fiblets.selection import Selecting
from pvfiblets.plotting.fiblets.sources import with_point_values
from pvfiblets.plotting.fiblets.transparency import Transparency
from pvfiblets.plotting.mapper import Plotted
from pvfiblets.plotting.report import added_up
from pvfiblets.plotting.shading import Shading

if TYPE_CHECKING:
    from pvfiblets.codec.fibletset import FibletSet
    from pvfiblets.engine.fiblets.sampled_volume import VolumeSource
    from pvfiblets.plotting.colours import ColourSettings
    from pvfiblets.plotting.fiblets.scalars import Scalars


class PlottedMapper(Plotted, FibletMapper):
    """A fiblet mapper with scalar bars.

    Parameters
    ----------
    fiblets : FibletSet
        What to draw.
    """


class FibletActor(Coloured, Engines, Filtering, Selecting, Shading, Transparency, pv.Actor):
    """Streamlines drawn from their compressed form.

    Everything of :class:`pyvista.Actor` works (``visibility``, ``position``, ``user_matrix``,
    ``pickable``, ``prop`` …). The properties below may be set at any time and take effect at the
    next render.

    Parameters
    ----------
    fiblets : FibletSet
        What to draw.
    scalars : str, array or VolumeSource, optional
        As for ``plotter.add_fiblets``.
    settings : ColourSettings, optional
        Colour map and colours.
    line_width : float, optional
        Pixels; the theme's by default.
    opacity : float, default: 1.0
        Of all streamlines.
    lighting : bool, optional
        Shade the lines by the scene's lights.
    name : str, optional
        Under which the plotter knows the actor.
    theme : pyvista theme, optional
        Gives what is not given.
    options : EngineOptions, optional
        Pipeline and culling.
    progress : bool, default: False
        Show a progress bar while copying to the GPU.
    """

    def __init__(
        self,
        fiblets: FibletSet,
        *,
        scalars: Any = None,
        settings: ColourSettings | None = None,
        line_width: float | None = None,
        opacity: float = 1.0,
        lighting: bool | None = None,
        name: str | None = None,
        theme: Any = None,
        options: EngineOptions | None = None,
        progress: bool = False,
    ) -> None:
        theme = pv.global_theme if theme is None else theme
        self._fiblets = fiblets
        self._init_colours(scalars, settings, theme)
        self._init_shading()
        self._init_filtering()
        self._init_selection()
        mapper = PlottedMapper(fiblets, options=options, progress=progress)
        super().__init__(prop=pv.Property(theme=theme), name=name)
        self._mapper = mapper  # VTK keeps the C++ half only
        mapper.attach(self)
        self._init_looks(opacity, lighting)
        self.line_width = theme.line_width if line_width is None else line_width
        self._recolour()

    def __repr__(self) -> str:
        colours = "one colour" if self._scalars is None else self._scalars.name
        share = "" if self.share in (None, 1.0) else f", {self.share:.1%} of the streamlines drawn"
        return f"<{type(self).__name__} {self.name!r}: {self._fiblets!r}, coloured by {colours}{share}>"

    # Data ---------------------------------------------------------------------------------------

    @property
    def fiblets(self) -> FibletSet:
        """The compressed data; another set may be put in its place."""
        return self._fiblets

    @fiblets.setter
    def fiblets(self, fiblets: FibletSet) -> None:
        scalars = self._find(fiblets, self._choice)
        choices = self._choices_for(fiblets)
        self._mapper.filtering = None  # its bits are of the fiblets before
        self._draw(fiblets)
        self._show(scalars)
        self._rechoose(choices)

    def copy(self, deep: bool = True) -> FibletActor:
        """Return another actor that draws the same fiblets with the same colours and place.

        Parameters
        ----------
        deep : bool, default: True
            Give the copy a property of its own; else both share one. A mapper serves one actor,
            so each has its own in any case; the compressed data is shared.

        Returns
        -------
        FibletActor
            Not in any plotter yet.
        """
        twin = FibletActor(
            self._fiblets,
            scalars=self._choice,
            settings=replace(self._settings),
            line_width=self.line_width,
            theme=self._theme,
            options=self._mapper.options,
        )
        twin.prop = self.prop.copy() if deep else self.prop
        twin._choose_as(self)
        twin._select_like(self)
        twin.position, twin.scale, twin.origin = self.position, self.scale, self.origin
        twin.orientation, twin.user_matrix = self.orientation, self.user_matrix
        twin.visibility, twin.pickable = self.visibility, self.pickable
        twin._shade_like(self)
        twin.transparency = self.transparency
        return twin

    def explain(self) -> dict[str, Any]:
        """Return what is active for this actor and what it costs, over all windows that show it.

        Returns
        -------
        dict
            ``passes``: name and milliseconds of the last redraw; ``features``: pieces of the
            shaders in use; ``buffers``: name and bytes of what lies on the GPU; ``gpu_bytes``:
            their sum; ``fiblets_total``; ``pipeline``; ``culling``; ``share``: how many of the
            streamlines are drawn; ``fiblets``: of the last redraw ``total``, ``in_frustum``,
            ``drawn`` and ``visible``, ``None`` where not known; ``streamlines``: ``total`` and
            ``shown``; ``criteria``, ``conditions``, ``clips``, ``groups_shown``; ``selection``:
            how many streamlines, and what drawing them apart takes.
        """
        return {
            **added_up(self._mapper.explain()),
            "selection": self._explain_selection(),
            "fiblets_total": self._fiblets.n_fiblets,
            "pipeline": self.pipeline_in_use,
            "culling": self.culling,
            "share": self.share,
            **self._explain_choices(),
        }

    def pick_at(self, x: int, y: int) -> tuple[int, float] | None:
        """Return the streamline id and the position along it (in points) at a window pixel.

        Parameters
        ----------
        x, y : int
            Pixel, counted from the lower left corner.

        Returns
        -------
        tuple of (int, float) or None
            ``None`` where no streamline of this actor was drawn.
        """
        return self._mapper.pick_at(x, y)

    # Colours ------------------------------------------------------------------------------------

    @property
    def scalars(self) -> str | np.ndarray | VolumeSource | None:
        """What colours the actor: a name, an array or a volume; ``None`` for ``color`` or orientation."""
        return self._choice

    @scalars.setter
    def scalars(self, scalars: Any) -> None:
        scalars = self._values_of_criterion(scalars)
        fiblets, scalars = with_point_values(self._fiblets, scalars)
        found = self._find(fiblets, scalars)
        if fiblets is not self._fiblets:
            self._draw(fiblets)
        self._colour_by(scalars, found)

    @property
    def categories(self) -> bool:
        """Whether there are as many colours as different values, instead of ``n_colors``."""
        return self._settings.categories

    @categories.setter
    def categories(self, categories: bool) -> None:
        self._set("categories", bool(categories))

    # Looks --------------------------------------------------------------------------------------

    @property
    def line_width(self) -> float:
        """Width in pixels."""
        return self._mapper.line_width

    @line_width.setter
    def line_width(self, width: float) -> None:
        if not 0.0 < float(width) <= 64.0:
            raise ValueError(f"line_width is {width!r}; give pixels above 0 and up to 64")
        self.prop.line_width = float(width)
        self._mapper.line_width = float(width)

    # Inside -------------------------------------------------------------------------------------

    @property
    def _drawn(self) -> FibletSet:
        return self._fiblets

    def _draw(self, fiblets: FibletSet) -> None:
        """Give the mapper other fiblets; colours for another number of streamlines go first."""
        if fiblets.n_streamlines != self._fiblets.n_streamlines:
            self._mapper.colouring = Colouring()
        self._mapper.set_fiblets(fiblets)
        self._fiblets = fiblets
        self._reselect()

    def _find(self, fiblets: FibletSet, choice: str | np.ndarray | VolumeSource | None) -> Scalars | None:
        if choice is None and self._settings.color is not None:
            return None
        return find_scalars(fiblets, choice)
