"""Mapper attributes of PyVista scripts: they are forwarded to the actor, or a warning names its property.

This package's mappers keep them in their actors. A VTK mapper takes any attribute that Python sets, and never reads it.
"""

from __future__ import annotations

import warnings
from typing import Any, cast

import pyvista as pv

from pvfiblets.mappers.engine_mapper import AnyOptions, EngineMapper
from pvfiblets.plotting.actors.coloured import ColouredActor
from pvfiblets.plotting.colours.colours import shared_limits
from pvfiblets.plotting.settings.settings import NoSetting

NO_ATTRIBUTE = "this mapper has no {name}: "


class Plotted(EngineMapper[AnyOptions]):
    """Mapper that shows PyVista's scalar bars the actor's own look-up table."""

    copy = NoSetting(NO_ATTRIBUTE + "actor.copy() makes an actor with a mapper of its own")
    interpolate_before_map = NoSetting(NO_ATTRIBUTE + "values are interpolated before they are mapped, always")
    emissive = NoSetting(NO_ATTRIBUTE + "it is of points drawn as gaussians")

    @property
    def _owner(self) -> ColouredActor:
        return cast("ColouredActor", self.actor)

    @property
    def lookup_table(self) -> pv.LookupTable:
        """The look-up table of the frame and of the scalar bar."""
        return self._owner.lookup_table

    @lookup_table.setter
    def lookup_table(self, table: pv.LookupTable) -> None:
        actor = self._owner
        clim = actor.clim  # as a mapper's own, which its table takes on
        actor.cmap = table
        actor.clim = clim

    def SetLookupTable(self, table: Any) -> None:  # noqa: N802 - VTK's name
        """Colour by another look-up table, whose range becomes the mapper's."""
        if not isinstance(table, pv.LookupTable):
            copy = pv.LookupTable()
            copy.DeepCopy(table)
            table = copy
        self.lookup_table = table

    def GetLookupTable(self) -> pv.LookupTable:  # noqa: N802 - VTK's name
        """Return the actor's look-up table."""
        return self.lookup_table

    def SetScalarRange(self, *limits: Any) -> None:  # noqa: N802 - VTK's name
        """Set the values of the first and last colour, two numbers or a pair."""
        self.scalar_range = limits[0] if len(limits) == 1 else limits

    def GetScalarRange(self) -> tuple[float, float]:  # noqa: N802 - VTK's name
        """Return the values of the first and last colour."""
        return self.scalar_range

    @property
    def scalar_range(self) -> tuple[float, float]:
        """Values of the first and last colour; bars that several actors share set it."""
        return self._owner.clim

    @scalar_range.setter
    def scalar_range(self, clim: tuple[float, float]) -> None:
        actor = self._owner
        actor.clim = shared_limits(clim, actor._settings, actor._scalars)  # noqa: SLF001
        if actor._scalars is None and not actor._hidden:  # noqa: SLF001
            warnings.warn(
                f"the range {tuple(clim)} has no effect yet: the actor has one colour and no scalars",
                UserWarning,
                stacklevel=3,
            )

    def _begin(self) -> None:
        actor: Any = self.actor
        if isinstance(actor, ColouredActor):
            try:
                actor.take_table()
            except Exception as error:  # noqa: BLE001  VTK would swallow it; see raise_pending
                self._error = error
        super()._begin()


class PlottedLines(Plotted[AnyOptions]):
    """Mapper of lines or points that gives PyVista's scripts its data."""

    as_rgba = NoSetting(NO_ATTRIBUTE + "give colours of points or lines as actor.scalars")
    clear_active_scalars = NoSetting(NO_ATTRIBUTE + "set actor.scalars = None")
    cmap = NoSetting(NO_ATTRIBUTE + "set actor.cmap")
    scalar_map_mode = NoSetting(NO_ATTRIBUTE + "actor.scalars may be of points or of lines")
    set_active_scalars = NoSetting(NO_ATTRIBUTE + "set actor.scalars to the name")
    set_custom_opacity = NoSetting(NO_ATTRIBUTE + "set actor.opacity_by")
    set_scalars = NoSetting(NO_ATTRIBUTE + "set actor.scalars, and actor.cmap, clim and n_colors")

    @property
    def array_name(self) -> str:
        """Name of the colouring array; empty without scalars. Set it to colour by another array of the data."""
        found = self._owner._scalars  # noqa: SLF001
        return "" if found is None else str(found.name)

    @array_name.setter
    def array_name(self, name: str) -> None:
        self._owner.scalars = name

    @property
    def dataset(self) -> pv.PolyData:
        """The lines as PyVista's own lines or points, made anew each time: of a large set ask for a part."""
        if self.is_readable:
            return cast("pv.PolyData", pv.wrap(self.GetDataSetInput()))
        return self._owner._as_polydata()  # noqa: SLF001

    @dataset.setter
    def dataset(self, source: Any) -> None:
        self._owner._draw_source(source)  # noqa: SLF001

    @property
    def scalar_visibility(self) -> bool:
        """Whether scalars colour, if there are any; else the colour of the actor's property."""
        actor = self._owner
        return not actor._hidden and actor._scalars is not None  # noqa: SLF001

    @scalar_visibility.setter
    def scalar_visibility(self, shown: bool) -> None:
        self._owner._hide_scalars(not shown)  # noqa: SLF001

    def SetScalarVisibility(self, shown: Any) -> None:  # noqa: N802 - VTK's name
        """Switch colouring by scalars on or off."""
        if self.actor is None:  # as it is made
            super().SetScalarVisibility(shown)
        else:
            self.scalar_visibility = bool(shown)

    def ScalarVisibilityOn(self) -> None:  # noqa: N802 - VTK's name
        """Colour by scalars."""
        self.scalar_visibility = True

    def ScalarVisibilityOff(self) -> None:  # noqa: N802 - VTK's name
        """Colour by the actor's property."""
        self.scalar_visibility = False

    def _wrapped(self, data: Any) -> Any:
        return pv.wrap(data)
