"""`HaloActor`: what actors of lines and of points with halos have in common, live looks and colours."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, ClassVar, Self

import numpy as np
import pyvista as pv

from pvfiblets.halos import HaloLines, HaloStyle
from pvfiblets.mappers.colouring import Colouring
from pvfiblets.mappers.halos import HaloMapper, HaloOptions
from pvfiblets.plotting.coloured import Coloured
from pvfiblets.plotting.halos.scalars import Held, coloured, filtered, find_scalars
from pvfiblets.plotting.halos.style import LookSettings, Spacing
from pvfiblets.plotting.mapper import Plotted
from pvfiblets.plotting.report import added_up

if TYPE_CHECKING:
    from pvfiblets.plotting.colours import ColourSettings
    from pvfiblets.plotting.fiblets.scalars import Scalars
    from pvfiblets.plotting.halos.style import Threshold

BACKGROUND = "background"


class PlottedHalos(Plotted, HaloMapper):
    """A mapper of lines or points with halos, with scalar bars.

    Parameters
    ----------
    drawn : HaloLines or HaloPoints
        What to draw.
    look : HaloStyle
        How.
    """


class HaloActor(Coloured, pv.Actor):
    """What actors of lines and of points with halos have in common.

    Parameters
    ----------
    held : Held
        What to draw, and the numbers that colour and filter it.
    looks : LookSettings, optional
        How it looks.
    settings : ColourSettings, optional
        Colour map and colours.
    halo_color : color-like or "background", optional
        As for :attr:`halo_color`.
    light_on_dark : bool, default: False
        As for :attr:`light_on_dark`.
    opacity : float, default: 1.0
        Of lines, points and halos.
    lighting : bool, default: False
        Whether the scene's lights shade lines and points.
    name : str, optional
        Under which the plotter knows the actor.
    theme : pyvista theme, optional
        Gives what is not given.
    options : HaloOptions, optional
        How those behind others are found out.
    """

    _KIND: ClassVar[type]

    def __init__(
        self,
        held: Held,
        *,
        looks: LookSettings | None = None,
        settings: ColourSettings | None = None,
        halo_color: Any = None,
        light_on_dark: bool = False,
        opacity: float = 1.0,
        lighting: bool = False,
        name: str | None = None,
        theme: Any = None,
        options: HaloOptions | None = None,
    ) -> None:
        theme = pv.global_theme if theme is None else theme
        self._held = replace(held, drawn=self._checked(held.drawn))
        self._looks = LookSettings(filter_by=held.filter_by) if looks is None else looks
        self._spacing = Spacing(held.drawn)
        self._light_on_dark = bool(light_on_dark)
        self._halo_choice = _halo_choice(halo_color)
        self._init_colours(held.scalars, settings, theme)
        self._own_color = self._settings.color is not None
        self._settings.color = pv.Color(self._settings.color, default_color=self._ink)
        mapper = PlottedHalos(held.drawn, self._looks.look(held.drawn, self._spacing), options=options)
        super().__init__(prop=pv.Property(theme=theme), name=name)
        self._mapper = mapper  # VTK keeps the C++ half only
        mapper.attach(self)
        self._init_looks(opacity, lighting)
        self._colour_halos()
        self._recolour()

    def __repr__(self) -> str:
        colours = "one colour" if self._scalars is None else self._scalars.name
        return f"<{type(self).__name__} {self.name!r}: {self._counted}, coloured by {colours}>"

    # Colours ------------------------------------------------------------------------------------

    @property
    def color(self) -> pv.Color:
        """One colour for all; black, or white with ``light_on_dark``, where none was given.

        Setting it puts scalars out of use; ``None`` sets that default.
        """
        return pv.Color(self._settings.color)

    @color.setter
    def color(self, color: Any) -> None:
        checked = pv.Color(color, default_color=self._ink)
        self._own_color = color is not None
        self._settings.color = checked
        self.scalars = None

    @property
    def halo_color(self) -> pv.Color | str:
        """Colour of the halos: white, or black with ``light_on_dark``, where none was given.

        ``"background"``: that of the renderer, be it a gradient from below to above. ``None`` sets
        the default.
        """
        if self._halo_choice == BACKGROUND:
            return BACKGROUND
        return pv.Color(self._halo_choice, default_color=self._paper)

    @halo_color.setter
    def halo_color(self, color: Any) -> None:
        self._halo_choice = _halo_choice(color)
        self._colour_halos()

    @property
    def light_on_dark(self) -> bool:
        """White in black halos instead of black in white ones; colours that were given stay.

        The background is the plotter's: ``plotter.set_background("black")``.
        """
        return self._light_on_dark

    @light_on_dark.setter
    def light_on_dark(self, wanted: bool) -> None:
        self._light_on_dark = bool(wanted)
        if not self._own_color:
            self._settings.color = pv.Color(self._ink)
        self._colour_halos()
        self._show(self._scalars)

    @property
    def scalars(self) -> str | np.ndarray | None:
        """What colours the actor; ``None`` for one colour.

        The name of numbers or colours that it was made with, or an array with one number or one
        colour (3 or 4 columns) per point. Lines also have ``"orientation"`` (the absolute direction
        as red, green, blue), ``"arc_length"`` (mm from the line's first point) and ``"length"``
        (mm), and take arrays with a row per line.
        """
        return self._choice

    @scalars.setter
    def scalars(self, scalars: Any) -> None:
        held = coloured(self._held, scalars)
        found = find_scalars(held)
        self._hold(held)
        self._colour_by(held.scalars, found)

    # Looks --------------------------------------------------------------------------------------

    @property
    def look(self) -> HaloStyle:
        """Every setting below as it is drawn, with the numbers that were measured of the data."""
        return self._mapper.look

    @property
    def max_displacement(self) -> float:
        """By how many mm the edge of a halo lies behind its line or point; ``None`` sets what suits the data.

        Lines that cross with less between them have narrower halos, those side by side none.
        """
        return self.look.max_displacement

    @max_displacement.setter
    def max_displacement(self, mm: float | None) -> None:
        self._change(max_displacement=mm)

    @property
    def displacement(self) -> Any:
        """How far back a halo lies between its line and its edge, as shares of ``max_displacement``.

        ``"linear"``, ``"square"``, ``"square root"``; 2 to 64 numbers in 0..1 at equally spaced places
        from the axis to the edge; or a function of an array of places in 0..1.
        """
        return self._looks.displacement

    @displacement.setter
    def displacement(self, displacement: Any) -> None:
        self._change(displacement=displacement)

    @property
    def width_cue(self) -> float:
        """By which share the farthest in the data are thinner than the nearest, 0 to 1; halos keep their width."""
        return self.look.width_cue

    @width_cue.setter
    def width_cue(self, share: float) -> None:
        self._change(width_cue=share)

    @property
    def min_width(self) -> float:
        """Pixels of the window that a line or point takes at least; 0 leaves it as it is."""
        return self.look.min_width

    @min_width.setter
    def min_width(self, pixels: float) -> None:
        self._change(min_width=pixels)

    @property
    def smooth(self) -> bool:
        """Whether lines and points turn into their halos gradually, over a pixel."""
        return self.look.smooth

    @smooth.setter
    def smooth(self, smooth: bool) -> None:
        self._change(smooth=smooth)

    # Filter -------------------------------------------------------------------------------------

    @property
    def filter_by(self) -> str | None:
        """By which numbers ``threshold`` filters; ``None`` shows all, and forgets the threshold.

        Set it to a name, as for ``scalars``, or to an array of a number per point (``"filter"`` is
        then their name), or per line. Where there is no number (NaN), nothing shows.
        """
        return self._looks.filter_by

    @filter_by.setter
    def filter_by(self, filter_by: str | np.ndarray | None) -> None:
        held = filtered(self._held, filter_by)
        threshold = None if held.filter_by is None else self._looks.threshold
        looks = replace(self._looks, filter_by=held.filter_by, threshold=threshold)
        self._hold(held, looks)

    @property
    def threshold(self) -> Threshold:
        """The least number of ``filter_by`` that shows, or the least and the greatest, ``None`` for no end.

        Changing it costs a redraw, and nothing is copied to the GPU.
        """
        return self._looks.threshold

    @threshold.setter
    def threshold(self, threshold: Threshold) -> None:
        self._change(threshold=threshold)

    # How it is drawn ----------------------------------------------------------------------------

    @property
    def culling(self) -> str | None:
        """How those behind others are found out: ``"two-phase"``, or ``None``; the picture is the same."""
        return self._mapper.options.culling

    @culling.setter
    def culling(self, culling: str | None) -> None:
        self._mapper.options = HaloOptions(culling)

    def copy(self, deep: bool = True) -> Self:
        """Return another actor that draws the same with the same looks, colours and place.

        Parameters
        ----------
        deep : bool, default: True
            Give the copy a property of its own; else both share one. A mapper serves one actor,
            so each has its own in any case; the data are shared.

        Returns
        -------
        HaloLineActor or HaloPointActor
            Not in any plotter yet.
        """
        twin = type(self)(
            self._held,
            looks=self._looks,
            settings=replace(self._settings, color=self._settings.color if self._own_color else None),
            halo_color=self._halo_choice,
            light_on_dark=self._light_on_dark,
            theme=self._theme,
            options=self._mapper.options,
        )
        twin.prop = self.prop.copy() if deep else self.prop
        twin.position, twin.scale, twin.origin = self.position, self.scale, self.origin
        twin.orientation, twin.user_matrix = self.orientation, self.user_matrix
        twin.visibility, twin.pickable = self.visibility, self.pickable
        return twin

    def explain(self) -> dict[str, Any]:
        """Return what is active for this actor and what it costs, over all windows that show it.

        Returns
        -------
        dict
            ``passes``: name and milliseconds of the last redraw; ``features``: pieces of the
            shaders in use; ``buffers``: name and bytes of what lies on the GPU; ``gpu_bytes``:
            their sum; ``points_total``, and of lines ``lines_total`` and ``segments_total``;
            ``culling``: the one in use, ``None`` before the first picture.
        """
        report = self._mapper.explain()
        total = added_up(report)
        del total["fiblets"]
        latest = report["windows"][-1] if report["windows"] else {}
        return {**total, **self._totals, "culling": latest.get("culling")}

    # What a component asks ----------------------------------------------------------------------

    def entered(self, renderer: Any) -> None:
        """Be told that a renderer draws the actor from now on."""

    def raise_pending(self) -> None:
        """Raise what drawing stored, once."""
        self._mapper.raise_pending()

    def release(self, window: Any = None) -> None:
        """Give back the GPU memory that the actor has in a window, or in all."""
        self._mapper.release(window)

    # Inside -------------------------------------------------------------------------------------

    @property
    def _counted(self) -> str:
        raise NotImplementedError

    @property
    def _totals(self) -> dict[str, int]:
        raise NotImplementedError

    @property
    def _ink(self) -> str:
        return "white" if self._light_on_dark else "black"

    @property
    def _paper(self) -> str:
        return "black" if self._light_on_dark else "white"

    @property
    def _drawn(self) -> Held:
        return self._held

    def _checked(self, drawn: Any) -> Any:
        if not isinstance(drawn, self._KIND):
            what = self._KIND.__name__
            make = "as_halo_lines" if self._KIND is HaloLines else "as_halo_points"
            raise TypeError(
                f"what to draw is a {type(drawn).__name__}; give {what}, which pvfiblets.halos.build.{make} makes"
            )
        return drawn

    def _find(self, drawn: Held, choice: Any) -> Scalars | None:
        return find_scalars(replace(drawn, scalars=choice))

    def _change(self, **settings: Any) -> None:
        """Change settings of the look; refused ones leave all as it was."""
        looks = replace(self._looks, **settings)
        self._mapper.look = looks.look(self._held.drawn, self._spacing)
        self._looks = looks

    def _hold(self, held: Held, looks: LookSettings | None = None) -> None:
        """Draw something else, of the same points, or in another way."""
        looks = self._looks if looks is None else looks
        look = looks.look(held.drawn, self._spacing)
        if held.drawn is not self._held.drawn:
            self._mapper.set_drawn(held.drawn, look)
        elif look != self._mapper.look:
            self._mapper.look = look
        self._held, self._looks = held, looks

    def _draw_others(self, drawn: Any) -> None:
        """Draw other lines or points by the same settings."""
        kept = self._choice if isinstance(self._choice, str) or self._choice is None else np.asarray(self._choice)
        lines = getattr(self._checked(drawn), "n_lines", None)
        of_lines = {name: values for name, values in self._held.line_values.items() if len(values) == lines}
        held = filtered(coloured(Held(drawn, line_values=of_lines), kept), self._looks.filter_by)
        found = find_scalars(held)
        spacing = Spacing(drawn)
        look = self._looks.look(held.drawn, spacing)
        # Colours for another number of lines go first.
        self._mapper.colouring = Colouring("solid")
        self._mapper.set_drawn(held.drawn, look)
        self._held, self._spacing = held, spacing
        self._choice = held.scalars
        self._show(found)

    def _colour_halos(self) -> None:
        color = self.halo_color
        self._mapper.halo_color = color.float_rgb if isinstance(color, pv.Color) else None


def _halo_choice(color: Any) -> Any:
    """Return a colour, "background", or None for the default."""
    if color is None or (isinstance(color, str) and color == BACKGROUND):
        return color
    return pv.Color(color)
