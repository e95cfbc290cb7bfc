"""The base of all actors of this package: colours by PyVista's rules, place, life and report."""

from __future__ import annotations

import warnings
from dataclasses import replace
from typing import TYPE_CHECKING, Any, ClassVar, Self

import pyvista as pv

from pvfiblets.mappers.frames.observers import observe, weakly
from pvfiblets.plotting.actors.linked_property import is_own_write, own_writes
from pvfiblets.plotting.actors.shading import Shades
from pvfiblets.plotting.colours.colours import ColourSettings, make_colouring, update_table
from pvfiblets.plotting.colours.linked_table import LinkedTable
from pvfiblets.plotting.fiblets.opacities import Opacities, apply_transfer
from pvfiblets.plotting.settings.places import COLOURS, PROPERTY
from pvfiblets.plotting.settings.settings import Given, Setting, Settings

if TYPE_CHECKING:
    from collections.abc import Callable

    from vtkmodules.vtkRenderingCore import vtkRenderer, vtkRenderWindow

    from pvfiblets.mappers.colouring import Colouring
    from pvfiblets.mappers.engine_mapper import EngineMapper
    from pvfiblets.plotting.colours.scalars import Scalars


class ColouredActor(Settings, pv.Actor):
    """Base of all actors: colours by PyVista's rules, opacities, effects, place and life.

    What an actor draws, and what a ``choice`` of scalars means for that, is its own.
    """

    # What to say of the property's line width, where it is not drawn.
    _WIDTH: ClassVar[str] = ""

    # Name of the property with the data.
    _DATA: ClassVar[str]

    _mapper: EngineMapper[Any]
    prop: Any
    scalars: Any
    color: Any
    cmap: Any
    clim: Any
    opacity: Any

    def __init__(self, mapper: EngineMapper[Any], choice: Any, given: Given, *, name: str | None, theme: Any) -> None:
        self._theme = pv.global_theme if theme is None else theme
        color = given["color"]
        self._settings = ColourSettings(None if color is None else pv.Color(color), **given.at(COLOURS))
        self._choice = choice
        self._scalars: Scalars | None = None
        self._table = pv.LookupTable()
        self._linked_table = LinkedTable(self._table, self._table_touched)
        self._ignore_property: Callable[[], None] = lambda: None
        self._opacity_by: Any = None
        self._opacities = Opacities()
        self._shades = Shades(mapper)
        self._hidden = False  # scalars, by the mapper's scalar_visibility
        self._bar_changed: Callable[[Any], None] | None = None
        super().__init__(prop=pv.Property(theme=self._theme), name=name)
        self._mapper = mapper  # VTK keeps the C++ half only
        mapper.attach(self)
        self._property_color = self.prop.GetDiffuseColor()  # GetColor() is mixed with that of highlights
        self._property_width = self.prop.GetLineWidth()
        with own_writes():
            for key, value in given.items():
                one = self.DECLARED[key]
                if one.where is PROPERTY and isinstance(one, Setting):
                    setattr(self, key, getattr(self._theme, one.field) if value is None else value)
        self._take_property()

    @property
    def _drawn(self) -> Any:
        """The drawn data."""
        raise NotImplementedError

    def _as_polydata(self) -> pv.PolyData:
        """Return the data as lines."""
        raise NotImplementedError

    def _draw_source(self, source: Any) -> None:  # noqa: ARG002 - for subclasses
        """Draw other data from the next picture on."""
        raise AttributeError(f"this mapper makes its dataset itself; set actor.{self._DATA} for other data")

    def _find(self, drawn: Any, choice: Any) -> Scalars | None:
        """Return the numbers or colours of a choice of scalars; ``None`` for one colour."""
        raise NotImplementedError

    def copy(self, deep: bool = True) -> Self:
        """Return a copy of the actor, with the same data, settings, colours and position.

        Parameters
        ----------
        deep : bool, default: True
            Copy the property, too; otherwise both actors share it. A mapper serves one actor,
            so each has its own in any case; the data are shared.

        Returns
        -------
        actor
            Of the same class, not in any plotter yet.
        """
        make: Any = type(self)
        twin: Self = make(**self._made_with(), settings=self._arguments_of_copy(), theme=self._theme)
        twin._be_like(self, deep)
        return twin

    def _made_with(self) -> dict[str, Any]:
        """Return the arguments that an actor of the same data is made with, beside its settings."""
        raise NotImplementedError

    def _be_like(self, other: Self, deep: bool) -> None:
        """Take over place, property and all settings that an actor is not made with."""
        self.prop = other.prop.copy() if deep else other.prop
        for name in ("position", "scale", "origin", "orientation", "user_matrix", "visibility", "pickable"):
            setattr(self, name, getattr(other, name))
        self._take_from(other)

    def __copy__(self) -> Any:
        return self.copy(deep=False)

    def __deepcopy__(self, _known: dict[int, Any]) -> Any:
        return self.copy(deep=True)

    def __reduce_ex__(self, _protocol: Any) -> Any:
        raise TypeError(
            f"a {type(self).__name__} cannot be pickled, like all VTK actors; pickle its data (actor.{self._DATA}) "
            "and add these to a plotter again"
        )

    # What a component asks ----------------------------------------------------------------------

    def entered(self, renderer: vtkRenderer) -> None:
        """Handle that a renderer draws the actor from now on."""

    def raise_pending(self) -> None:
        """Raise what drawing stored, once."""
        self._mapper.raise_pending()

    def release(self, window: vtkRenderWindow | None = None) -> None:
        """Release the actor's GPU memory in a window, or in all windows."""
        self._mapper.release(window)

    # Colours ------------------------------------------------------------------------------------

    @property
    def active_scalars(self) -> Scalars | None:
        """Resolved source of the colours; ``None`` for one colour."""
        return self._scalars

    @property
    def scalars_title(self) -> str | None:
        """Title of the scalar bar; ``None`` if the current colours need no bar."""
        return self._scalars.title if self._scalars is not None and self._scalars.mapped else None

    @property
    def legend_color(self) -> pv.Color:
        """One colour for the legend: the actor's, the middle of the colour map, or the mean."""
        if self._scalars is None:
            return self._solid_color()
        if self._scalars.mapped:
            return pv.Color(self._table.values[self._table.n_values // 2, :3].tolist())
        return pv.Color(self._mean_colour(self._scalars))

    def _mean_colour(self, scalars: Scalars) -> Any:
        """Return one colour for many; by default a grey that is visible on black and on white."""
        if scalars.values is None or not len(scalars.values):
            return "#808080"
        return [float(part) for part in scalars.values[:, :3].mean(axis=0) / 255.0]

    @property
    def shows_labels(self) -> bool:
        """Whether the colours stand for labels with names."""
        return self._scalars is not None and self._scalars.categories is not None

    @property
    def _default_color(self) -> Any:
        """Colour of an actor without scalars and color; None for the ink of its background."""
        return self._theme.color

    def _solid_color(self) -> pv.Color:
        color = self._default_color if self._settings.color is None else self._settings.color
        return pv.Color(self._mapper.ink if color is None else color)

    def _read_color(self) -> pv.Color | None:
        return None if self._settings.color is None else pv.Color(self._settings.color)

    def _write_color(self, color: Any) -> None:
        checked = None if color is None else pv.Color(color)
        self._settings.color = checked
        self.scalars = None

    @property
    def lookup_table(self) -> pv.LookupTable:
        """The look-up table of the frame and of the scalar bar."""
        return self._table

    def watch(self, bar_changed: Callable[[Any], None] | None) -> None:
        """Call ``bar_changed(actor)`` whenever the actor comes to need another scalar bar."""
        self._bar_changed = bar_changed

    # Inside -------------------------------------------------------------------------------------

    def _set(self, setting: str, value: Any) -> None:
        """Change one setting; a refused value leaves all as it was."""
        self.take_table()
        before = getattr(self._settings, setting)
        setattr(self._settings, setting, value)
        try:
            self._show(self._scalars)
        except Exception:
            setattr(self._settings, setting, before)
            raise
        self._bar()

    def _colour_by(self, choice: Any, found: Scalars | None) -> None:
        """Take other scalars, which were found already; refused, the actor keeps those it has."""
        before, self._choice = self._choice, choice
        try:
            self._show(found)
        except Exception:
            self._choice = before
            raise
        self._bar()

    def _bar(self) -> None:
        """Update the scalar bar and the legend."""
        if self._bar_changed is not None:
            self._bar_changed(self)

    def _recolour(self) -> None:
        self._show(self._find(self._drawn, self._choice))

    def _show(self, scalars: Scalars | None) -> None:
        """Hand the mapper its colours."""
        self._keep_table()
        scalars = None if self._hidden else scalars
        if scalars is not None and scalars.mapped:
            with own_writes():
                update_table(self._table, self._settings, scalars, self._theme, self._drawn)
                if self._opacities.transfer is not None:
                    apply_transfer(self._table, self._opacities.transfer)
            self._linked_table.note()
        self._mapper.colouring = self._faded(make_colouring(self._settings, scalars, self._table, self._default_color))
        self._scalars = scalars
        with own_writes():
            self.prop.color = self._solid_color() if scalars is None else "white"
        self._property_color = self.prop.GetDiffuseColor()  # GetColor() is mixed with that of highlights

    def take_table(self) -> None:
        """Take over what somebody else has written to the look-up table, before the next picture and other settings."""
        if self._keep_table():
            self._show(self._scalars)
            self._bar()

    def _keep_table(self) -> bool:
        """Read changes of the look-up table into the settings; return True if there were any."""
        found = self._linked_table.settings()
        for name, value in found.items():
            setattr(self._settings, name, value)
        return bool(found)

    def _table_touched(self) -> None:
        """Apply it at once where possible: VTK checks translucency before a frame."""
        if self._scalars is None or not self._scalars.mapped:
            return
        try:
            colouring = self._faded(make_colouring(self._settings, self._scalars, self._table, self._default_color))
        except ValueError:  # between two changes that belong together
            return
        self._mapper.colouring = colouring

    def _hide_scalars(self, hidden: bool) -> None:
        """Show one colour in place of scalars, or these again."""
        if hidden != self._hidden:
            self._hidden = hidden
            self._recolour()
            self._bar()

    # Opacities and effects ----------------------------------------------------------------------

    def _read_opacity(self) -> Any:
        return float(self.prop.opacity)

    def _read_opacity_by(self) -> Any:
        return self._opacity_by

    def _fade_by(self, choice: Any, found: Opacities, instead: str) -> None:
        """Set opacities beside the property's; invalid ones change nothing."""
        if found.transfer is not None and (self._scalars is None or not self._scalars.mapped):
            raise ValueError(
                f"opacity {choice!r} follows the numbers of a colour map, but there are none; give scalars, or one "
                f"opacity per {instead}"
            )
        before = self._opacity_by, self._opacities
        self._opacity_by, self._opacities = choice, found
        try:
            self._show(self._scalars)
        except Exception:
            self._opacity_by, self._opacities = before
            self._show(self._scalars)
            raise

    def _faded(self, colouring: Colouring) -> Colouring:
        """Return a colouring with the actor's opacities, if there are any."""
        streamlines, points = self._opacities.streamlines, self._opacities.points
        if streamlines is None and points is None:
            return colouring
        return replace(colouring, opacities=streamlines, opacity_source=points)

    def _shade(self, name: str, kind: type, wanted: Any) -> None:
        """Set one effect; a refused value leaves all as it was."""
        self._shades.change(name, kind, wanted)

    # The property -------------------------------------------------------------------------------

    def SetProperty(self, prop: Any) -> None:  # noqa: N802 - VTK's name
        """Replace the property, and apply its values."""
        super().SetProperty(prop)
        self._ignore_property()
        self._ignore_property = observe(prop, ("ModifiedEvent",), weakly(self._take_property))
        self._take_property()

    def _take_property(self) -> None:
        """Take over what a user has changed of the property, now that the actor is whole."""
        if not is_own_write() and hasattr(self, "_mapper"):
            with own_writes():
                self._property_changed()

    def _property_changed(self) -> None:
        """Take over another colour of the property; scalars that were chosen go before it."""
        width = self.prop.GetLineWidth()
        if self._WIDTH and width != self._property_width:
            self._property_width = width
            warnings.warn(f"prop.line_width changes nothing here: {self._WIDTH}", UserWarning, stacklevel=2)
        color = self.prop.GetDiffuseColor()  # GetColor() is mixed with that of highlights
        if color != self._property_color:
            self._property_color = color
            if self._hidden:
                self._settings.color = pv.Color(color)
                self._show(None)
            elif self._choice is None:
                self.color = color


# What the engine counts in each window (pvfiblets.engine.fiblets.census).
COUNTS = ("total", "in_frustum", "drawn", "visible")


def added_up(report: dict[str, Any]) -> dict[str, Any]:
    """Return one report of all windows."""
    windows = report["windows"]
    buffers = [buffer for window in windows for buffer in window["buffers"]]
    buffers += report["textures"]
    features = {feature for window in windows for feature in window["features"]}
    return {
        "passes": [item for window in windows for item in window["passes"]],
        "features": sorted(features | set(report["features"])),
        "buffers": buffers,
        "gpu_bytes": sum(buffer["bytes"] for buffer in buffers),
        "fiblets": {count: _sum(windows, count) for count in COUNTS},
        **{key: window[key] for window in windows for key in ("parts", "cluster") if key in window},
    }


def _sum(windows: list[dict[str, Any]], count: str) -> int | None:
    """Add the counts of some windows' engines; None without any."""
    counts = [window.get("fiblets", {}).get(count) for window in windows]
    known = [number for number in counts if number is not None]
    return sum(known) if known else None
