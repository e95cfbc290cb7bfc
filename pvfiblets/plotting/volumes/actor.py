"""The actor that ``plotter.add_raycast_volume`` returns: an ordinary PyVista actor with a live transfer function."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import pyvista as pv

from pvfiblets.mappers.engine_options import Options
from pvfiblets.mappers.volumes import VolumeMapper
from pvfiblets.plotting.actors.coloured import added_up
from pvfiblets.plotting.actors.linked_property import is_own_write, own_writes
from pvfiblets.plotting.actors.mapper_words import NO_ATTRIBUTE, Plotted
from pvfiblets.plotting.colours.colours import make_colouring, update_table
from pvfiblets.plotting.colours.scalars import Scalars
from pvfiblets.plotting.filtering.clipping import ClippedActor
from pvfiblets.plotting.settings.settings import Given, NoSetting
from pvfiblets.plotting.volumes.blending import BLENDING, mode_of_blending
from pvfiblets.plotting.volumes.opacity import (
    along_logarithm,
    from_logarithm,
    is_number,
    number,
    opacities,
    surface_colours,
    surface_opacities,
    surface_values,
    value_limits,
)
from pvfiblets.plotting.volumes.property_attributes import PropertyAttributes
from pvfiblets.plotting.volumes.settings import CASTING, CHOSEN, LIGHT, SURFACE, VolumeSettings
from pvfiblets.volumes import RaycastVolume, Transfer, smoothed
from pvfiblets.volumes.interactive_quality import InteractiveQuality
from pvfiblets.volumes.raycast_options import RaycastOptions
from pvfiblets.volumes.transfer import LARGEST_PREINTEGRATED

if TYPE_CHECKING:
    from pvfiblets.mappers import Colouring, RayHit

OF_SURFACES = ("ambient_occlusion", "ray_occlusion")
"""Light and peaks have nothing that could stand over anything: they keep these for when a surface shows again."""


class _PlottedRaycast(Plotted[Options], VolumeMapper):
    """A mapper of a volume that rays are cast through, with scalar bars."""

    dataset = NoSetting(NO_ATTRIBUTE + "actor.volume holds values and place; actor.update(image) draws others")
    scalar_map_mode = NoSetting(NO_ATTRIBUTE + "as_raycast_volume(image, scalars=...) chooses the array")

    @property
    def blend_mode(self) -> str:
        """The actor's mode by ``add_volume``'s words, or its own where these have none."""
        mode = self._owner.mode
        return next((theirs for theirs, ours in BLENDING.items() if ours == mode), mode)

    @blend_mode.setter
    def blend_mode(self, word: str) -> None:
        self._owner.mode = mode_of_blending(word)


class VolumeActor(VolumeSettings, ClippedActor):
    """A ray-cast volume: surfaces, light, or peaks.

    Everything of :class:`pyvista.Actor` works (``visibility``, ``position``, ``user_matrix``,
    ``pickable``, ``prop`` with its ``specular`` and so on, of surfaces). The properties below may be
    set at any time and take effect at the next render.

    ``ambient_occlusion`` and ``ray_occlusion`` are of ``mode="isosurface"``: in the other modes they are kept and
    change nothing. ``depth_cue`` is of all modes: light fades by where it begins, a peak by where it is.

    Parameters
    ----------
    volume : RaycastVolume
        What to draw.
    settings : mapping, optional
        Arguments of ``plotter.add_raycast_volume`` that are settings, by name.
    given : tuple of object and dict, optional
        The volume's source and arguments, for :meth:`update`.
    name : str, optional
        Under which the plotter knows the actor.
    theme : pyvista theme, optional
        Source of defaults.

    Notes
    -----
    Source: Lesar, "Real-time ray casting of volumetric data" (2015).
    """

    _DATA = "volume"
    _mapper: _PlottedRaycast
    _words: PropertyAttributes | None = None
    _alpha_written: Any = None

    def __init__(
        self,
        volume: RaycastVolume,
        *,
        settings: Mapping[str, Any] | None = None,
        given: tuple[Any, dict[str, Any]] | None = None,
        name: str | None = None,
        theme: Any = None,
    ) -> None:
        self._given = given
        chosen = Given(VolumeSettings, settings)
        coarser = InteractiveQuality.of_quality(chosen["interactive_quality"])
        self._source, self._smooth = _checked(volume), chosen["smooth"]
        self._volume = _smoothed(volume, self._smooth)
        self._of_surfaces: dict[str, Any] = {}
        self._see_through = 1.0
        mapper = _PlottedRaycast(self._volume, RaycastOptions(SURFACE, (0.0,)))
        super().__init__(mapper, None, chosen, name=name, theme=theme)
        self._lit = self._theme.lighting if chosen["lighting"] is None else chosen["lighting"]
        self._scalars = _scalars(self._volume)
        self._choices = chosen.at(CHOSEN)
        self._casting = RaycastOptions(SURFACE, (0.0,))
        fields = {field: value for field, value in chosen.at(CASTING).items() if value is not None}
        self._casting, colouring = self._made({"mode": LIGHT, **fields})
        mapper.show(self._casting, colouring)
        self._quality, mapper.coarser = chosen["interactive_quality"], coarser
        mapper.shaded = bool(chosen["shade"])
        self._look()
        self._take(chosen)
        self._words = PropertyAttributes(self)

    def __repr__(self) -> str:
        size = " x ".join(map(str, self._volume.shape))
        return f"<{type(self).__name__} {self.name!r}: {size} voxels, {self.mode}>"

    # Data ---------------------------------------------------------------------------------------

    @property
    def volume(self) -> RaycastVolume:
        """The volume, before smoothing; can be replaced by another one."""
        return self._source

    @volume.setter
    def volume(self, volume: RaycastVolume) -> None:
        self._hold(_checked(volume), self._smooth)
        self._given = None

    def update(self, source: Any = None, **where: Any) -> None:
        """Replace the values, for instance of a time series; settings stay.

        Parameters
        ----------
        source : ImageData, array, (array, affine), nibabel image, RaycastVolume or path, optional
            As for ``plotter.add_raycast_volume``. By default the last source, read again: of an image or
            array that was written to in place.
        **where
            Of :func:`pvfiblets.volumes.as_raycast_volume`, such as ``scalars`` and ``spacing``. By default the
            earlier arguments.

        Raises
        ------
        TypeError, ValueError
            As of ``plotter.add_raycast_volume``; nothing is changed then.

        Notes
        -----
        ``clim=None`` is the range of the new values; give ``clim`` to have the same colours at all times.
        """
        from pvfiblets.volumes.sources import as_raycast_volume

        before, words = (self._source, {}) if self._given is None else self._given
        source = before if source is None else source
        words = {**words, **where}
        if isinstance(source, RaycastVolume) and not words:  # the object is the same, and its numbers may not be
            volume = replace(source) if source is self._source else source
        else:
            volume = as_raycast_volume(source, **words)
        self._hold(volume, self._smooth)
        self._given = source, words

    def _read_smooth(self) -> Any:
        return self._smooth

    def _write_smooth(self, sigma: Any) -> None:
        self._hold(self._source, sigma)

    def _read_interactive_quality(self) -> float | dict[str, Any]:
        return self._quality

    def _write_interactive_quality(self, quality: float | dict[str, Any]) -> None:
        self._mapper.coarser = InteractiveQuality.of_quality(quality)
        self._quality = quality

    def _read_lighting(self) -> bool:
        return self._lit

    def _write_lighting(self, lighting: bool) -> None:
        self._lit = lighting
        self._look()

    def _read_shade(self) -> bool:
        return bool(self._mapper.shaded)

    def _write_shade(self, shade: bool) -> None:
        self._mapper.shaded = shade
        self.Modified()

    # What a ray shows ---------------------------------------------------------------------------

    @property
    def casting(self) -> RaycastOptions:
        """All current settings of the rays."""
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
        """Title of the scalar bar; ``None`` for one colour."""
        own = self._settings.color is not None or self._volume.colours is not None
        own |= self.casting.layered and self._choices["surface_colors"] is not None
        return None if own or self._scalars is None else self._scalars.title

    # Questions ----------------------------------------------------------------------------------

    def pick_at(self, x: int, y: int) -> RayHit | None:
        """Return the position and value of the volume at a window pixel.

        Parameters
        ----------
        x, y : int
            Pixel, counted from the lower left corner.

        Returns
        -------
        RayHit or None
            ``voxel``: the nearest one; ``position``: mm, in the data's coordinates, where the ray
            meets the surface, where its first light comes from, or where its peak is; ``value``:
            of the surface or the peak, or of light that of the voxel. ``None`` where nothing of
            the volume is. What other actors hide counts too.
        """
        return self._mapper.pick_at(x, y)

    def explain(self) -> dict[str, Any]:
        """Return the active features of this actor and their cost, in all its windows.

        Returns
        -------
        dict
            ``passes``: name and milliseconds of the last redraw; ``features``: pieces of the
            shaders in use; ``buffers``: name and bytes of each GPU buffer; ``gpu_bytes``:
            their sum; ``mode``; ``voxels_total``; ``nodes`` of the octree, and ``skipped``: the
            share of its leaves with nothing to see; ``octree``: its ``bytes``, their ``share`` of
            the volume's, and ``ms`` that building it took. ``None`` before the first picture;
            ``clips``.
        """
        report = self._mapper.explain()
        total = added_up(report)
        del total["fiblets"]
        latest = report["windows"][-1] if report["windows"] else {}
        return {
            **total,
            "mode": self.mode,
            "voxels_total": self._volume.n_points,
            "nodes": latest.get("nodes"),
            "skipped": latest.get("skipped"),
            "octree": latest.get("octree"),
            "clips": list(self._clips),
        }

    def _made_with(self) -> dict[str, Any]:
        return {"volume": self._source, "given": self._given}

    # Inside -------------------------------------------------------------------------------------

    @property
    def _drawn(self) -> RaycastVolume:
        return self._volume

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
        """Draw by the present settings, with some fields of the casting changed."""
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
                    f"n_colors is {len(alpha)}, but {casting.integrator!r} takes {LARGEST_PREINTEGRATED} at most; "
                    "give fewer, or integrator='exponential'"
                )
            return casting, None
        if casting.layered:
            return casting, None
        solid = mode == SURFACE and settings.color is not None
        return casting, make_colouring(settings, None if solid else self._scalars, self._table, self._theme.color)

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

    def _hold(self, source: RaycastVolume, smooth: Any) -> None:
        """Draw another volume; a refused one leaves all as it was."""
        volume = _smoothed(source, smooth)
        before = self._source, self._volume, self._smooth, self._scalars
        self._source, self._volume, self._smooth, self._scalars = source, volume, smooth, _scalars(volume)
        try:
            made, colouring = self._made({})
        except Exception:
            self._source, self._volume, self._smooth, self._scalars = before
            self._made({})
            raise
        self._mapper.set_volume(volume)
        self._mapper.show(made, colouring)
        self._casting = made
        self._bar()

    def _shade(self, name: str, kind: type, wanted: Any) -> None:
        super()._shade(name, kind, wanted)
        if name in OF_SURFACES:
            self._of_surfaces[name] = self._mapper.effects.get(name)
            self._look()

    def _take_property(self) -> None:
        if is_own_write() and self._words is not None:
            self._words.note(self)
        super()._take_property()

    def _property_changed(self) -> None:
        """Warn of parts of the property that rays ignore; the colour is left to the volume's settings."""
        if self._words is not None:
            self._words.look(self)

    def _look(self) -> None:
        """Surfaces alone are shaded, stand over each other, and are as opaque as one number says."""
        surface = self.mode == SURFACE and not self.casting.layered
        for name, effect in self._of_surfaces.items():
            self._mapper.set_effect(name, effect if surface else None)
        self._mapper.lit_surfaces = self._lit
        opacity = float(self.opacity) if surface and is_number(self.opacity) else 1.0
        with own_writes():
            self.prop.lighting = self._lit and surface
            if opacity != self._see_through:  # an opacity set on the property itself stays
                self._see_through = self.prop.opacity = opacity
            self.prop.color = "white" if self._settings.color is None else self._settings.color


def _checked(volume: Any) -> RaycastVolume:
    if not isinstance(volume, RaycastVolume):
        raise TypeError(
            f"the volume is a {type(volume).__name__}; give a RaycastVolume, which "
            "pvfiblets.volumes.as_raycast_volume makes of images and arrays"
        )
    return volume


def _smoothed(volume: RaycastVolume, sigma: Any) -> RaycastVolume:
    return volume if sigma is None else smoothed(volume, sigma)


def _scalars(volume: RaycastVolume) -> Scalars:
    """The volume's values, whose range is not empty even if all are one; of voxels with colours all of alpha's."""
    low, high = volume.value_range if volume.colours is None else (0.0, 255.0)
    if low == high:
        high = max(low + 1.0, float(np.nextafter(low, np.inf)))
    return Scalars(volume.name, "point_scalar", None, (low, high))


def _widen(table: pv.LookupTable, count: int) -> None:
    """Give a table so many entries at least, of the same colours: opacities want more than a list of a few colours."""
    before = table.n_values
    if before < count:
        table.values = np.array(table.values)[np.arange(count) * before // count]
