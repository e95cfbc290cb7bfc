"""How rays through a volume are cast and coloured: an actor's settings, live, and what they make together."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import pyvista as pv

from pvfiblets.plotting.clipping import ClippedActor
from pvfiblets.plotting.colours import make_colouring, update_table
from pvfiblets.plotting.linked_property import own_writes
from pvfiblets.plotting.volumes.opacity import (
    along_logarithm,
    from_logarithm,
    number,
    opacities,
    surface_colours,
    surface_opacities,
    surface_values,
    value_limits,
)
from pvfiblets.plotting.volumes.settings import CASTING, CHOSEN, VolumeSettings
from pvfiblets.volumes import Transfer
from pvfiblets.volumes.raycast_options import RaycastOptions
from pvfiblets.volumes.transfer import LARGEST_PREINTEGRATED

if TYPE_CHECKING:
    from pvfiblets.mappers import Colouring
    from pvfiblets.plotting.fiblets.scalars import Scalars
    from pvfiblets.plotting.settings import Given
    from pvfiblets.volumes import RaycastVolume

__all__ = ["SURFACE", "RaySettings"]

SURFACE, LIGHT = "isosurface", "composite"


class RaySettings(VolumeSettings, ClippedActor):
    """The part of :class:`~pvfiblets.plotting.volumes.actor.VolumeActor` that says what a ray shows.

    Every setting may be changed at any time; a value that is refused leaves all as it was. The actor
    brings ``_volume`` and `_look`.
    """

    _volume: RaycastVolume
    _alpha_written: Any = None

    def _init_rays(self, given: Given) -> tuple[RaycastOptions, Colouring | None]:
        """Take the settings, and return what they make of the volume; fields that are None have their defaults."""
        self._choices = given.at(CHOSEN)
        self._casting = RaycastOptions(SURFACE, (0.0,))
        fields = {field: value for field, value in given.at(CASTING).items() if value is not None}
        made = self._made({"mode": LIGHT, **fields})
        self._casting = made[0]
        return made

    def _look(self) -> None:
        """Set what the actor's property knows."""
        raise NotImplementedError

    # What a ray shows ---------------------------------------------------------------------------

    @property
    def casting(self) -> RaycastOptions:
        """All settings of the rays as they are drawn."""
        return self._casting

    def _read_values(self) -> tuple[float, ...]:
        return surface_values(self._choices["values"], self._volume.value_range)

    def _read_surface_opacities(self) -> tuple[float, ...] | None:
        return surface_opacities(self._choices["surface_opacities"], len(self.values))

    def _read_surface_colors(self) -> list[pv.Color] | None:
        return surface_colours(self._choices["surface_colors"], len(self.values))

    def _read_thresholds(self) -> Any:
        return self._choices["thresholds"]

    def _read_peak(self) -> float:
        if self._choices["peak"] is None:
            return surface_values(None, self._volume.value_range)[0]
        return number("peak", self._choices["peak"], "the least value of a peak")

    def _read_opacity(self) -> Any:
        return self._choices["opacity"]

    def _read_opacity_unit_distance(self) -> float:
        unit = self._choices["opacity_unit_distance"]
        if unit is None:
            return float(self._volume.spacing.mean())
        return number("opacity_unit_distance", unit, "a length above 0, mm")

    # Colours ------------------------------------------------------------------------------------

    def _write_color(self, color: Any) -> None:
        self._set("color", None if color is None else pv.Color(color))

    @property
    def scalars_title(self) -> str | None:
        """What a scalar bar says; ``None`` where there is one colour."""
        own = self._settings.color is not None or self._volume.colours is not None
        own |= self.casting.layered and self._choices["surface_colors"] is not None
        return None if own or self._scalars is None else self._scalars.title

    # Inside -------------------------------------------------------------------------------------

    def _cast(self, wanted: dict[str, Any]) -> None:
        """Change fields of the casting; a refused one leaves all as it was."""
        try:
            self._apply(wanted)
        except Exception:
            self._made({})  # brings the table back
            raise

    def _set(self, setting: str, value: Any) -> None:
        """Change one setting of the colours; a refused value leaves all as it was."""
        self.take_table()
        before = self._settings
        self._settings = replace(before, **{setting: value})
        try:
            self._apply({})
        except Exception:
            self._settings = before
            self._made({})
            raise
        self._bar()

    def _choose(self, name: str, value: Any) -> None:
        """Change what the casting is made from; a refused value leaves all as it was."""
        before = self._choices
        self._choices = {**before, name: value}
        try:
            self._apply({})
        except Exception:
            self._choices = before
            self._made({})
            raise

    def _apply(self, wanted: dict[str, Any]) -> None:
        """Have the mapper draw by the present settings, with some fields of the casting changed."""
        made, colouring = self._made(wanted)
        self._mapper.show(made, colouring)
        self._casting = made
        self._look()

    def _show(self, scalars: Scalars | None) -> None:
        """Hand the mapper its colours."""
        self._scalars = scalars
        self._cast({})

    def _made(self, wanted: dict[str, Any]) -> tuple[RaycastOptions, Colouring | None]:
        """Return casting and colours of the present settings with some fields changed, and bring the table in step."""
        self._keep_table()
        with own_writes():
            made = self._made_anew(wanted)
        self._linked_table.note()
        return made

    def _keep_table(self) -> bool:
        found = self._linked_table.settings()
        if "cmap" in found and isinstance(found["cmap"], pv.LookupTable):
            values = np.asarray(found["cmap"].values, np.float64)
            if not np.array_equal(values[:, 3], self._alpha_written):
                self._choices = {**self._choices, "opacity": values[:, 3] / 255.0}
        if found:
            self._settings = replace(self._settings, **found)
        return bool(found)

    def _table_touched(self) -> None:
        """Wait for the next picture: the table's opacities go into integrals."""

    def _made_anew(self, wanted: dict[str, Any]) -> tuple[RaycastOptions, Colouring | None]:
        assert self._scalars is not None
        settings, mode = self._settings, wanted.get("mode", self._casting.mode)
        low, high = value_limits(self.thresholds)
        own = {"values": self.values, "threshold": self.peak, "low": low, "high": high, **wanted}
        scalars = self._scalars
        if settings.log_scale and scalars.range[0] <= 0.0:
            scalars = replace(scalars, positive=self._volume.least_positive)
        update_table(self._table, settings, scalars, self._theme, None)
        if mode != SURFACE:
            _widen(self._table, max(int(settings.n_colors), 2))
        self._check_colours(mode)
        alpha = self._table_opacities()
        if settings.color is not None:
            self._table.values[:, :3] = pv.Color(settings.color).int_rgb
        clim = tuple(self._table.scalar_range)
        seen = along_logarithm(alpha, clim) if settings.log_scale else alpha
        self._table.values[:, 3] = 255 if mode == SURFACE else np.round(255.0 * seen)
        self._alpha_written = np.array(self._table.values[:, 3])
        own["surfaces"] = self._surfaces() if mode == SURFACE else None
        if mode == LIGHT:
            own["transfer"] = self._transfer(alpha)
        casting = replace(self._casting, **own)
        if mode == LIGHT:
            if casting.integrator in ("adaptive", "preintegrated") and len(alpha) > LARGEST_PREINTEGRATED:
                raise ValueError(
                    f"n_colors is {len(alpha)}; light that is integrated beforehand has {LARGEST_PREINTEGRATED} "
                    "colours at most: give fewer, or integrator='exponential'"
                )
            return casting, None
        if casting.layered:
            return casting, None
        solid = mode == SURFACE and settings.color is not None
        return casting, make_colouring(settings, None if solid else self._scalars, self._table, self._theme)

    def _transfer(self, alpha: np.ndarray) -> Transfer:
        """Return the table as a transfer function, the one that there is if it says the same."""
        clim, unit = tuple(self._table.scalar_range), self.opacity_unit_distance
        colours = np.asarray(self._table.values, np.float32)[:, :3] / 255.0
        if self._volume.colours is not None:
            colours = np.ones_like(colours)
        elif self._settings.log_scale:
            colours = from_logarithm(colours, clim)
        table = np.column_stack([colours, alpha]).astype(np.float32)
        held = self._casting.transfer
        if held is not None and (held.clim, held.unit) == (clim, unit) and np.array_equal(held.table, table):
            return held
        return Transfer(table, clim, unit)

    def _table_opacities(self) -> np.ndarray:
        """Return an opacity for each entry of the table: of a table of the user's own, where it has any, its own."""
        cmap = self._settings.cmap
        if isinstance(cmap, pv.LookupTable) and isinstance(self.opacity, str) and self.opacity == "linear":
            own = np.asarray(cmap.values, np.float64)[:, 3] / 255.0
            if (own < 1.0).any():
                return np.interp(np.linspace(0.0, 1.0, self._table.n_values), np.linspace(0.0, 1.0, len(own)), own)
        return opacities(self.opacity, self._table.n_values)

    def _surfaces(self) -> tuple[tuple[float, ...], ...] | None:
        """Return RGBA of each surface where there is to be seen more than the first of a ray."""
        opacity, colours = self.surface_opacities, self.surface_colors
        if opacity is None and colours is None:
            return None
        values = self.values
        if colours is None:
            one = self._settings.color
            of_map = [self._table.map_value(value, opacity=False) for value in values]
            rgb = of_map if one is None else [one.float_rgb] * len(values)
        else:
            rgb = [colour.float_rgb for colour in colours]
        return tuple((*own, alpha) for own, alpha in zip(rgb, opacity or (1.0,) * len(values), strict=True))

    def _check_colours(self, mode: str) -> None:
        if self._volume.colours is not None and mode != LIGHT:
            raise ValueError(
                f"mode is {mode!r}, and the voxels are RGBA: show them as mode 'composite', in their own colours, or "
                "give one number for each voxel"
            )


def _widen(table: pv.LookupTable, count: int) -> None:
    """Give a table so many entries at least, of the same colours: opacities want more than a list of a few colours."""
    before = table.n_values
    if before < count:
        table.values = np.array(table.values)[np.arange(count) * before // count]
