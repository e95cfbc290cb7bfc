"""Colours that an actor shows by PyVista's rules: look-up table, scalar bar and theme, live."""

from __future__ import annotations

from numbers import Real
from typing import TYPE_CHECKING, Any

import numpy as np
import pyvista as pv

from pvfiblets.plotting.colours import ColourSettings, make_colouring, update_table

if TYPE_CHECKING:
    from collections.abc import Callable

    from pvfiblets.plotting.fiblets.scalars import Scalars


class Coloured:
    """The part of actors that has colours; see :class:`~pvfiblets.plotting.fiblets.actor.FibletActor`.

    What an actor draws, and what ``scalars`` mean for that, is its own: it brings ``scalars`` and
    overrides the two members that raise here.
    """

    _mapper: Any
    prop: Any
    scalars: Any

    def _init_colours(self, choice: Any, settings: ColourSettings | None, theme: Any) -> None:
        self._theme = theme
        self._settings = settings if settings is not None else ColourSettings()
        self._choice = choice
        self._scalars: Scalars | None = None
        self._table = pv.LookupTable()
        self._bar_changed: Callable[[Any], None] | None = None

    def _init_looks(self, opacity: float, lighting: bool | None) -> None:
        """Set what the property knows, which a mapper must be attached for."""
        self.opacity = opacity
        self.lighting = self._theme.lighting if lighting is None else lighting

    @property
    def _drawn(self) -> Any:
        """What is drawn."""
        raise NotImplementedError

    def _find(self, drawn: Any, choice: Any) -> Scalars | None:
        """Return the numbers or colours that a choice means for what is drawn; ``None`` for one colour."""
        raise NotImplementedError

    # Colours ------------------------------------------------------------------------------------

    @property
    def scalars_title(self) -> str | None:
        """What a scalar bar says; ``None`` if the present colours need none."""
        return self._scalars.title if self._scalars is not None and self._scalars.mapped else None

    @property
    def shows_labels(self) -> bool:
        """Whether the numbers that colour the actor are labels, each with a name."""
        return self._scalars is not None and self._scalars.categories is not None

    @property
    def color(self) -> pv.Color | None:
        """One colour for all; setting it puts scalars out of use."""
        return None if self._settings.color is None else pv.Color(self._settings.color)

    @color.setter
    def color(self, color: Any) -> None:
        checked = None if color is None else pv.Color(color)
        self._settings.color = checked
        self.scalars = None

    @property
    def lookup_table(self) -> pv.LookupTable:
        """The table that colours both the picture and the scalar bar."""
        return self._table

    @property
    def clim(self) -> tuple[float, float]:
        """Values of the first and the last colour; ``None`` sets the range of the data.

        Once set it stays, other scalars or not.
        """
        low, high = self._table.scalar_range
        return low, high

    @clim.setter
    def clim(self, clim: Any) -> None:
        self._set("clim", clim)

    @property
    def cmap(self) -> Any:
        """Colour map, as for :meth:`pyvista.Plotter.add_mesh`."""
        return self._theme.cmap if self._settings.cmap is None else self._settings.cmap

    @cmap.setter
    def cmap(self, cmap: Any) -> None:
        self._set("cmap", cmap)

    @property
    def n_colors(self) -> int:
        """Entries of the look-up table."""
        return self._settings.n_colors

    @n_colors.setter
    def n_colors(self, n_colors: int) -> None:
        self._set("n_colors", n_colors)

    @property
    def log_scale(self) -> bool:
        """Whether the colours spread over the logarithm of the values."""
        return self._settings.log_scale

    @log_scale.setter
    def log_scale(self, log_scale: bool) -> None:
        self._set("log_scale", bool(log_scale))

    @property
    def nan_color(self) -> pv.Color:
        """Colour of NaN."""
        return pv.Color(self._table.nan_color)

    @nan_color.setter
    def nan_color(self, color: Any) -> None:
        self._set("nan_color", color)

    @property
    def below_color(self) -> Any:
        """Colour of values below ``clim``; ``None`` uses the first of the map."""
        return self._settings.below_color

    @below_color.setter
    def below_color(self, color: Any) -> None:
        self._set("below_color", color)

    @property
    def above_color(self) -> Any:
        """Colour of values above ``clim``; ``None`` uses the last of the map."""
        return self._settings.above_color

    @above_color.setter
    def above_color(self, color: Any) -> None:
        self._set("above_color", color)

    # Looks --------------------------------------------------------------------------------------

    @property
    def opacity(self) -> float:
        """From 0, not to be seen, to 1."""
        return self.prop.opacity

    @opacity.setter
    def opacity(self, opacity: float) -> None:
        self.prop.opacity = _fraction(opacity)

    @property
    def lighting(self) -> bool:
        """Whether the scene's lights shade what is drawn."""
        return self.prop.lighting

    @lighting.setter
    def lighting(self, lighting: bool) -> None:
        self.prop.lighting = bool(lighting)

    def watch(self, bar_changed: Callable[[Any], None] | None) -> None:
        """Call ``bar_changed(actor)`` whenever the actor comes to need another scalar bar."""
        self._bar_changed = bar_changed

    # Inside -------------------------------------------------------------------------------------

    def _set(self, setting: str, value: Any) -> None:
        """Change one setting; a refused value leaves all as it was."""
        before = getattr(self._settings, setting)
        setattr(self._settings, setting, value)
        try:
            self._show(self._scalars)
        except Exception:
            setattr(self._settings, setting, before)
            raise

    def _colour_by(self, choice: Any, found: Scalars | None) -> None:
        """Take other scalars, which were found already; refused, the actor keeps those it has."""
        before, self._choice = self._choice, choice
        try:
            self._show(found)
        except Exception:
            self._choice = before
            raise
        if self._bar_changed is not None:
            self._bar_changed(self)

    def _recolour(self) -> None:
        self._show(self._find(self._drawn, self._choice))

    def _show(self, scalars: Scalars | None) -> None:
        """Hand the mapper its colours."""
        if scalars is not None and scalars.mapped:
            update_table(self._table, self._settings, scalars, self._theme, self._drawn)
        self._mapper.colouring = make_colouring(self._settings, scalars, self._table, self._theme)
        self._scalars = scalars
        colour = pv.Color(self._settings.color, default_color=self._theme.color)
        self.prop.color = colour if scalars is None else "white"


def _fraction(opacity: Any) -> float:
    number = isinstance(opacity, Real) or (isinstance(opacity, np.ndarray) and opacity.ndim == 0)
    if not number or not 0.0 <= float(opacity) <= 1.0:
        raise ValueError(f"opacity is {opacity!r}; give a number from 0 to 1")
    return float(opacity)
