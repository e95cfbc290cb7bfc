"""The actors that ``plotter.add_halo_lines`` and ``plotter.add_halo_points`` return."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any, ClassVar, cast

import numpy as np
import pyvista as pv

from pvfiblets.halos import HaloLines, HaloPoints, HaloStyle
from pvfiblets.mappers.colouring import Colouring
from pvfiblets.mappers.halos import HaloMapper, HaloOptions
from pvfiblets.plotting.actors.coloured import added_up
from pvfiblets.plotting.actors.mapper_words import PlottedLines
from pvfiblets.plotting.colours.opacities import LineActor
from pvfiblets.plotting.filtering.line_subject import LineSubject
from pvfiblets.plotting.filtering.state import Choices
from pvfiblets.plotting.halos.settings import LOOKS, HaloLineSettings, HaloPointSettings
from pvfiblets.plotting.halos.sources import Held, coloured, filtered, find_halo_scalars, halo_parts
from pvfiblets.plotting.halos.style import LookSettings, Spacing
from pvfiblets.plotting.settings.places import OPTIONS
from pvfiblets.plotting.settings.settings import Given
from pvfiblets.streamlines import Streamlines

if TYPE_CHECKING:
    from pvfiblets.plotting.colours.scalars import Scalars

BACKGROUND = "background"

# Default colours of lines and of halos, by `light_on_dark`.
_INKS = {True: "white", False: "black", None: None}
_PAPERS = {True: "black", False: "white", None: BACKGROUND}


class PlottedHalos(PlottedLines[HaloOptions], HaloMapper):
    """A mapper of lines or points with halos, with scalar bars."""


class HaloActor(LineActor):
    """What actors of lines and of points with halos have in common.

    Parameters
    ----------
    held : Held
        What to draw, and the numbers that colour and filter it.
    settings : mapping, optional
        Arguments of ``plotter.add_halo_lines`` or ``add_halo_points`` that are settings, by name.
    name : str, optional
        Under which the plotter knows the actor.
    theme : pyvista theme, optional
        Gives what is not given.
    """

    _mapper: PlottedHalos
    _KIND: ClassVar[type]

    _WIDTH = "widths of halos are in mm; see actor.line_width of lines, actor.point_size of points"

    def __init__(
        self,
        held: Held,
        *,
        settings: Mapping[str, Any] | None = None,
        name: str | None = None,
        theme: Any = None,
    ) -> None:
        given = Given(type(self), settings)
        self._held = replace(held, drawn=self._checked(held.drawn))
        self._looks = LookSettings(filter_by=held.filter_by, **given.at(LOOKS))
        self._spacing = Spacing(held.drawn)
        self._light_on_dark = given["light_on_dark"]
        self._halo_choice = _halo_choice(given["halo_color"])
        look = self._looks.look(held.drawn, self._spacing)
        mapper = PlottedHalos(held.drawn, look, options=HaloOptions(**given.at(OPTIONS)))
        self._choices = Choices()
        self._subject = self._subject_of(self._held, mapper)
        super().__init__(mapper, held.scalars, given, name=name, theme=theme)
        self._colour_halos()
        self._recolour()
        self.opacity = given["opacity"]
        self._take(given)

    def __repr__(self) -> str:
        colours = "one colour" if self._scalars is None else self._scalars.name
        drawn = self._held.drawn
        lines = f"{drawn.n_lines} lines of " if isinstance(drawn, HaloLines) else ""
        return f"<{type(self).__name__} {self.name!r}: {lines}{drawn.n_points} points, coloured by {colours}>"

    # Colours ------------------------------------------------------------------------------------

    @property
    def _default_color(self) -> str | None:
        return _INKS[self._light_on_dark]

    def _read_color(self) -> pv.Color:
        return self._solid_color()

    def _kept_color(self) -> Any:
        return self._settings.color

    def _read_halo_color(self) -> pv.Color | str:
        choice = _PAPERS[self._light_on_dark] if self._halo_choice is None else self._halo_choice
        return BACKGROUND if choice == BACKGROUND else pv.Color(choice)

    def _write_halo_color(self, color: Any) -> None:
        self._halo_choice = _halo_choice(color)
        self._colour_halos()

    def _kept_halo_color(self) -> Any:
        return self._halo_choice

    def _read_light_on_dark(self) -> bool | None:
        return self._light_on_dark

    def _write_light_on_dark(self, wanted: bool | None) -> None:
        self._light_on_dark = wanted
        self._colour_halos()
        self._show(self._scalars)

    @property
    def scalars(self) -> str | np.ndarray | None:
        """Source of the colours; ``None`` for one colour.

        The name of an array of the source, or an array with one number or one colour (3 or 4
        columns) per point. Lines also have ``"orientation"`` (the absolute direction as red, green,
        blue), ``"arc_length"`` (mm from the line's first point) and ``"length"`` (mm), and accept
        arrays with a row per line.
        """
        return self._choice

    @scalars.setter
    def scalars(self, scalars: Any) -> None:
        held = coloured(self._held, scalars)
        found = find_halo_scalars(held)
        self._hold(held)
        self._colour_by(held.scalars, found)

    # Looks --------------------------------------------------------------------------------------

    @property
    def look(self) -> HaloStyle:
        """All settings in use; automatic ones have the values that fit the data."""
        return self._mapper.look

    # Filter -------------------------------------------------------------------------------------

    @property
    def filter_by(self) -> str | None:
        """Numbers that ``threshold`` compares; ``None`` shows all and clears the threshold.

        Set it to a name, as for ``scalars``, to an array with a number per point or per line (its
        name is then ``"filter"``), or to an image. Parts without a number (NaN) are hidden.
        """
        return self._looks.filter_by

    @filter_by.setter
    def filter_by(self, filter_by: str | np.ndarray | None) -> None:
        held = filtered(self._held, filter_by)
        threshold = None if held.filter_by is None else self._looks.threshold
        looks = replace(self._looks, filter_by=held.filter_by, threshold=threshold)
        self._hold(held, looks)

    def _made_with(self) -> dict[str, Any]:
        return {"held": self._held}

    def explain(self) -> dict[str, Any]:
        """Return what is active for this actor and what it costs, over all windows that show it.

        Returns
        -------
        dict
            ``passes``: name and milliseconds of the last redraw; ``features``: pieces of the
            shaders in use; ``buffers``: name and bytes of what lies on the GPU; ``gpu_bytes``:
            their sum; ``points_total``, and of lines ``lines_total`` and ``segments_total``;
            ``culling``: the method in use, ``None`` before the first frame; ``streamlines``: lines
            or points in ``total`` and ``shown``; ``criteria``, ``conditions``, ``groups_shown``, ``clips``.
        """
        report = self._mapper.explain()
        total = added_up(report)
        del total["fiblets"]
        latest = report["windows"][-1] if report["windows"] else {}
        drawn = self._held.drawn
        if isinstance(drawn, HaloLines):
            total |= {"lines_total": drawn.n_lines, "segments_total": drawn.n_segments}
        return {
            **total,
            "points_total": drawn.n_points,
            "culling": latest.get("culling"),
            **self._explain_choices(),
        }

    # Inside -------------------------------------------------------------------------------------

    @property
    def _drawn(self) -> Held:
        return self._held

    def _as_polydata(self) -> pv.PolyData:
        drawn = self._held.drawn
        values = {name: np.asarray(rows) for name, rows in drawn.values.items()}
        if isinstance(drawn, HaloLines):
            return Streamlines(drawn.points, drawn.offsets, values).to_polydata()
        points = pv.PolyData(np.asarray(drawn.points))
        for name, rows in values.items():
            points[name] = rows
        return points

    def _checked(self, drawn: Any) -> Any:
        if not isinstance(drawn, self._KIND):
            what = self._KIND.__name__
            make = "as_halo_lines" if self._KIND is HaloLines else "as_halo_points"
            raise TypeError(
                f"what to draw is a {type(drawn).__name__}; give {what}, which pvfiblets.halos.build.{make} makes"
            )
        return drawn

    def _find(self, drawn: Held, choice: Any) -> Scalars | None:
        return find_halo_scalars(replace(drawn, scalars=choice))

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
        self._subject = self._subject_of(held, self._mapper)

    def _draw_others(self, drawn: Any) -> None:
        """Draw other lines or points by the same settings."""
        kept = self._choice if isinstance(self._choice, str) or self._choice is None else np.asarray(self._choice)
        lines = getattr(self._checked(drawn), "n_lines", None)
        of_lines = {name: values for name, values in self._held.line_values.items() if len(values) == lines}
        held = filtered(coloured(Held(drawn, line_values=of_lines), kept), self._looks.filter_by)
        found = find_halo_scalars(held)
        spacing = Spacing(drawn)
        look = self._looks.look(held.drawn, spacing)
        with self._choosing_from(self._subject_of(held, self._mapper)):
            self._mapper.colouring = Colouring("solid")  # that for another number of lines goes first
            self._mapper.set_drawn(held.drawn, look)
            self._held, self._spacing = held, spacing
            self._choice = held.scalars
            self._show(found)

    @staticmethod
    def _subject_of(held: Held, mapper: PlottedHalos) -> LineSubject:
        return LineSubject(mapper, lambda: halo_parts(held))

    def _colour_halos(self) -> None:
        color = self._read_halo_color()
        self._mapper.halo_color = color.float_rgb if isinstance(color, pv.Color) else None


class HaloLineActor(HaloLineSettings, HaloActor):
    """Lines with depth-dependent halos.

    Everything of :class:`pyvista.Actor` works (``visibility``, ``position``, ``user_matrix``,
    ``pickable``, ``prop``). The properties below may be set at any time and take effect at the next
    render. Lengths are mm of the data: a ``user_matrix`` that scales the lines scales their widths.

    Notes
    -----
    Source: Everts, Bekker, Roerdink and Isenberg, "Depth-dependent halos" (2009).
    """

    _DATA = "lines"
    _KIND = HaloLines

    @property
    def lines(self) -> HaloLines:
        """The drawn data; can be replaced.

        Automatic widths fit the new data. The new data need the arrays of the current colours and
        filter: KeyError otherwise.
        """
        return cast("HaloLines", self._held.drawn)

    @lines.setter
    def lines(self, lines: HaloLines) -> None:
        self._draw_others(lines)

    def pick_at(self, x: int, y: int) -> tuple[int, float] | None:
        """Return the line at a window pixel, and the position along it.

        Parameters
        ----------
        x, y : int
            Pixel, counted from the lower left corner.

        Returns
        -------
        tuple of (int, float) or None
            Index of the line, and position along it: the index of the point before, plus the fraction of
            the segment. ``None`` if no line of this actor is within two pixels; halos do not count.
        """
        return cast("tuple[int, float] | None", self._mapper.pick_at(x, y))


class HaloPointActor(HaloPointSettings, HaloActor):
    """Points with depth-dependent halos: discs that face the viewer, with cone-shaped halos behind them.

    Everything of :class:`pyvista.Actor` works. The properties below may be set at any time and take
    effect at the next render. Lengths are mm of the data.

    Notes
    -----
    Source: Everts, Bekker, Roerdink and Isenberg, "Depth-dependent halos" (2009), section 3.5.
    """

    _DATA = "points"
    _KIND = HaloPoints

    @property
    def points(self) -> HaloPoints:
        """The drawn data; can be replaced.

        Automatic sizes fit the new data. The new data need the arrays of the current colours and
        filter: KeyError otherwise.
        """
        return cast("HaloPoints", self._held.drawn)

    @points.setter
    def points(self, points: HaloPoints) -> None:
        self._draw_others(points)

    def pick_at(self, x: int, y: int) -> int | None:
        """Return the point at a window pixel.

        Parameters
        ----------
        x, y : int
            Pixel, counted from the lower left corner.

        Returns
        -------
        int or None
            Index of the point; ``None`` if no point of this actor is within two pixels. Halos do not count.
        """
        return cast("int | None", self._mapper.pick_at(x, y))


def _halo_choice(color: Any) -> Any:
    """Return a colour, "background", or None for the default."""
    if color is None or (isinstance(color, str) and color == BACKGROUND):
        return color
    return pv.Color(color)
