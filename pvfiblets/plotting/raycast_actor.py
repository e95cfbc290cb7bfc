"""The actor that ``plotter.add_raycast_volume`` returns: an ordinary PyVista actor with a live transfer function."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np
import pyvista as pv

from pvfiblets.mappers import Colouring
from pvfiblets.mappers.raycast import RayHit
from pvfiblets.plotting.coloured import Coloured
from pvfiblets.plotting.colours import ColourSettings, make_colouring, update_table
from pvfiblets.plotting.mapper import PlottedRaycast
from pvfiblets.plotting.raycast_opacity import is_number, opacities, surface_values, value_limits
from pvfiblets.plotting.report import added_up
from pvfiblets.plotting.scalars import Scalars
from pvfiblets.plotting.shading import SurfaceShading
from pvfiblets.raycast import RaycastVolume, Transfer, smoothed
from pvfiblets.raycast.casting import Casting
from pvfiblets.raycast.transfer import LARGEST_PREINTEGRATED

if TYPE_CHECKING:
    from pyvista import Color

__all__ = ["RaycastActor"]

SURFACE, LIGHT = "isosurface", "composite"


class _Setting:
    """How rays are cast, as far as it is a field of `Casting` and nothing else."""

    def __init__(self, doc: str) -> None:
        self.__doc__ = doc

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    def __get__(self, actor: Any, kind: type | None = None) -> Any:
        return self if actor is None else getattr(actor.casting, self._name)

    def __set__(self, actor: Any, value: Any) -> None:
        actor._cast({self._name: value})  # noqa: SLF001 - of the class that it is part of


class _OfOthers:
    """A setting that colours of volumes do not have."""

    def __init__(self, why: str) -> None:
        self._why = why

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    def __get__(self, actor: Any, kind: type | None = None) -> Any:
        return self if actor is None else self._refuse()

    def __set__(self, actor: Any, value: Any) -> None:
        self._refuse()

    def _refuse(self) -> NoReturn:
        raise AttributeError(f"volumes that rays are cast through have no {self._name}: {self._why}")


class RaycastActor(Coloured, SurfaceShading, pv.Actor):
    """A volume that rays are cast through: surfaces, light, or peaks.

    Everything of :class:`pyvista.Actor` works (``visibility``, ``position``, ``user_matrix``,
    ``pickable``, ``prop`` with its ``specular`` and so on, of surfaces). The properties below may be
    set at any time and take effect at the next render.

    Parameters
    ----------
    volume : RaycastVolume
        What to draw.
    casting : dict, optional
        Fields of :class:`pvfiblets.raycast.casting.Casting` that shall differ from their defaults;
        those that are ``None`` do not.
    values, thresholds, peak, opacity, opacity_unit_distance, smooth
        As for the properties.
    settings : ColourSettings, optional
        Colour map and colours.
    lighting : bool, optional
        Shade surfaces by the scene's lights; the theme's by default.
    name : str, optional
        Under which the plotter knows the actor.
    theme : pyvista theme, optional
        Gives what is not given.

    Notes
    -----
    Source: Lesar, "Real-time ray casting of volumetric data" (2015).
    """

    log_scale = _OfOthers("colours lie evenly; take the logarithm of the values first")
    nan_color = _OfOthers("missing voxels count as the least value")
    below_color = _OfOthers("opacity=[0, ...] or thresholds hide values below others")
    above_color = _OfOthers("opacity=[..., 0] or thresholds hide values above others")

    step = _Setting("Between two looks at the volume on a ray, in mean voxel spacings; opacity does not depend on it.")
    filter = _Setting("Reconstruction between voxels: ``'nearest'``, ``'trilinear'`` or ``'tricubic'``.")
    refine = _Setting("How a surface is refined: ``'regula-falsi'``, ``'newton'`` or ``'none'``.")
    iterations = _Setting("Steps of that refinement, 1 to 64.")
    integrator = _Setting(
        "How light is added up: ``'preintegrated'``, ``'exponential'``, ``'riemann'``, ``'simpson'`` or ``'rk4'``."
    )
    jitter = _Setting("Whether each ray starts at a place of its own in its first step: noise instead of rings.")
    octree = _Setting("Whether parts with nothing to see are skipped; the picture is the same.")
    homogeneous = _Setting("Difference of values up to which parts of the volume are taken as their mean; 0 for none.")
    stop = _Setting("Opacity at which a ray ends, up to 1.")
    box = _Setting("(xmin, xmax, ymin, ymax, zmin, zmax) in voxels of what is there; ``None`` for all.")

    def __init__(
        self,
        volume: RaycastVolume,
        *,
        casting: dict[str, Any] | None = None,
        values: Any = None,
        thresholds: Any = None,
        peak: float | None = None,
        opacity: Any = "linear",
        opacity_unit_distance: float | None = None,
        smooth: Any = None,
        settings: ColourSettings | None = None,
        lighting: bool | None = None,
        name: str | None = None,
        theme: Any = None,
    ) -> None:
        theme = pv.global_theme if theme is None else theme
        self._source = _checked(volume)
        self._volume, self._smooth = _smoothed(volume, smooth), smooth
        self._values, self._thresholds, self._peak = values, thresholds, peak
        self._opacity_choice, self._unit = opacity, opacity_unit_distance
        self._lit = theme.lighting if lighting is None else bool(lighting)
        self._init_colours(None, settings, theme)
        self._init_shading()
        self._casting = Casting(SURFACE, (0.0,))
        given = {field: value for field, value in (casting or {}).items() if value is not None}
        wanted = {"mode": LIGHT, **given}
        self._scalars = _scalars(self._volume)
        made, colouring = self._made(wanted)
        mapper = PlottedRaycast(self._volume, made, colouring=colouring)
        super().__init__(prop=pv.Property(theme=theme), name=name)
        self._mapper = mapper  # VTK keeps the C++ half only
        mapper.attach(self)
        self._casting = made
        self._look()

    def __repr__(self) -> str:
        size = " x ".join(map(str, self._volume.shape))
        return f"<{type(self).__name__} {self.name!r}: {size} voxels, {self.mode}>"

    # Data ---------------------------------------------------------------------------------------

    @property
    def volume(self) -> RaycastVolume:
        """What is drawn, not smoothed; another may be put in its place."""
        return self._source

    @volume.setter
    def volume(self, volume: RaycastVolume) -> None:
        self._hold(_checked(volume), self._smooth)

    @property
    def smooth(self) -> Any:
        """Standard deviation of a Gaussian that the volume is smoothed with first, voxels; ``None`` for none."""
        return self._smooth

    @smooth.setter
    def smooth(self, sigma: Any) -> None:
        self._hold(self._source, sigma)

    # What a ray shows ---------------------------------------------------------------------------

    @property
    def casting(self) -> Casting:
        """All settings of the rays as they are drawn."""
        return self._casting

    @property
    def mode(self) -> str:
        """What a ray shows.

        ``"isosurface"``: the first of the surfaces of ``values``. ``"composite"``: the light of all
        that it passes through. ``"mip"``: the greatest value. ``"local-mip"``: the first peak of at
        least ``peak``, or the greatest value where there is none.
        """
        return self._casting.mode

    @mode.setter
    def mode(self, mode: str) -> None:
        self._cast({"mode": mode})

    @property
    def values(self) -> tuple[float, ...]:
        """Where surfaces are, up to eight; ``None`` sets the middle of the volume's values."""
        return surface_values(self._values, self._volume.value_range)

    @values.setter
    def values(self, values: Any) -> None:
        self._set_own("_values", values)

    @property
    def thresholds(self) -> Any:
        """(low, high): values that are there, in all modes but ``"isosurface"``; either may be ``None``."""
        return self._thresholds

    @thresholds.setter
    def thresholds(self, thresholds: Any) -> None:
        self._set_own("_thresholds", thresholds)

    @property
    def peak(self) -> float:
        """The least value of a peak, for ``"local-mip"``; ``None`` sets the middle of the volume's values."""
        return surface_values(None, self._volume.value_range)[0] if self._peak is None else float(self._peak)

    @peak.setter
    def peak(self, peak: float | None) -> None:
        self._set_own("_peak", peak)

    # Colours ------------------------------------------------------------------------------------

    @property
    def opacity(self) -> Any:
        """How opaque values are, from the low end of ``clim`` to the high one.

        A name as for :meth:`pyvista.Plotter.add_volume` (``"linear"``, ``"sigmoid"``, ...), numbers
        from 0 to 1, or one number for all. Of light it is the opacity of ``opacity_unit_distance``
        mm; of peaks, that of the pixel. One number makes surfaces translucent, all else does not
        touch them.
        """
        return self._opacity_choice

    @opacity.setter
    def opacity(self, opacity: Any) -> None:
        self._set_own("_opacity_choice", opacity)

    @property
    def opacity_unit_distance(self) -> float:
        """Length, mm, of which ``opacity`` says how opaque it is; ``None`` sets the volume's mean spacing."""
        return float(self._volume.spacing.mean()) if self._unit is None else float(self._unit)

    @opacity_unit_distance.setter
    def opacity_unit_distance(self, mm: float | None) -> None:
        self._set_own("_unit", mm)

    @property
    def color(self) -> Color | None:
        """One colour for all in place of the map; ``None`` for the map."""
        return None if self._settings.color is None else pv.Color(self._settings.color)

    @color.setter
    def color(self, color: Any) -> None:
        self._set("color", None if color is None else pv.Color(color))
        self._bar()

    @property
    def scalars_title(self) -> str | None:
        """What a scalar bar says; ``None`` where there is one colour."""
        return None if self._settings.color is not None or self._scalars is None else self._scalars.title

    @property
    def lighting(self) -> bool:
        """Whether the scene's lights shade surfaces; light and peaks are not shaded."""
        return self._lit

    @lighting.setter
    def lighting(self, lighting: bool) -> None:
        self._lit = bool(lighting)
        self._look()

    # Questions ----------------------------------------------------------------------------------

    def pick_at(self, x: int, y: int) -> RayHit | None:
        """Return what a window pixel shows of the volume.

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
        """Return what is active for this actor and what it costs, over all windows that show it.

        Returns
        -------
        dict
            ``passes``: name and milliseconds of the last redraw; ``features``: pieces of the
            shaders in use; ``buffers``: name and bytes of what lies on the GPU; ``gpu_bytes``:
            their sum; ``mode``; ``voxels_total``; ``nodes`` of the octree, and ``skipped``: the
            share of its leaves with nothing to see, ``None`` before the first picture.
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
        }

    def copy(self, deep: bool = True) -> RaycastActor:
        """Return another actor that draws the same volume in the same way and place.

        Parameters
        ----------
        deep : bool, default: True
            Give the copy a property of its own; else both share one. The volume is shared.

        Returns
        -------
        RaycastActor
            Not in any plotter yet.
        """
        own = {name: getattr(self._casting, name) for name in ("mode", *_RAYS)}
        twin = RaycastActor(
            self._source,
            casting=own,
            values=self._values,
            thresholds=self._thresholds,
            peak=self._peak,
            opacity=self._opacity_choice,
            opacity_unit_distance=self._unit,
            smooth=self._smooth,
            settings=replace(self._settings),
            lighting=self._lit,
            theme=self._theme,
        )
        twin.prop = self.prop.copy() if deep else self.prop
        twin.position, twin.scale, twin.origin = self.position, self.scale, self.origin
        twin.orientation, twin.user_matrix = self.orientation, self.user_matrix
        twin.visibility, twin.pickable = self.visibility, self.pickable
        twin._shade_surface_like(self)
        return twin

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
        self._set_own(setting, value, self._settings)

    def _set_own(self, name: str, value: Any, owner: Any = None) -> None:
        """Change what the casting is made from; a refused value leaves all as it was."""
        owner = self if owner is None else owner
        before = getattr(owner, name)
        setattr(owner, name, value)
        try:
            self._apply({})
        except Exception:
            setattr(owner, name, before)
            self._made({})
            raise

    def _apply(self, wanted: dict[str, Any]) -> None:
        """Have the mapper draw by the present settings, with some fields of the casting changed."""
        made, colouring = self._made(wanted)
        self._mapper.show(made, colouring)
        self._casting = made
        self._look()

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

    def _show(self, scalars: Scalars | None) -> None:
        """Hand the mapper its colours."""
        self._scalars = scalars
        self._cast({})

    def _made(self, wanted: dict[str, Any]) -> tuple[Casting, Colouring | None]:
        """Return casting and colours of the present settings with some fields changed, and bring the table in step."""
        assert self._scalars is not None
        settings, mode = self._settings, wanted.get("mode", self._casting.mode)
        low, high = value_limits(self._thresholds)
        own = {"values": self.values, "threshold": self.peak, "low": low, "high": high, **wanted}
        update_table(self._table, settings, self._scalars, self._theme, None)
        if mode != SURFACE:
            _widen(self._table, max(int(settings.n_colors), 2))
        alpha = opacities(self._opacity_choice, self._table.n_values)
        if settings.color is not None:
            self._table.values[:, :3] = pv.Color(settings.color).int_rgb
        self._table.values[:, 3] = 255 if mode == SURFACE else np.round(255.0 * alpha)
        if mode == LIGHT:
            own["transfer"] = self._transfer(alpha)
        casting = replace(self._casting, **own)
        if mode == LIGHT:
            if casting.integrator == "preintegrated" and len(alpha) > LARGEST_PREINTEGRATED:
                raise ValueError(
                    f"n_colors is {len(alpha)}; light that is integrated beforehand has {LARGEST_PREINTEGRATED} "
                    "colours at most: give fewer, or integrator='exponential'"
                )
            return casting, None
        solid = mode == SURFACE and settings.color is not None
        return casting, make_colouring(settings, None if solid else self._scalars, self._table, self._theme)

    def _transfer(self, alpha: np.ndarray) -> Transfer:
        """Return the table as a transfer function, the one that there is if it says the same."""
        table = np.column_stack([np.asarray(self._table.values, np.float32)[:, :3] / 255.0, alpha]).astype(np.float32)
        clim, unit = tuple(self._table.scalar_range), self.opacity_unit_distance
        held = self._casting.transfer
        if held is not None and (held.clim, held.unit) == (clim, unit) and np.array_equal(held.table, table):
            return held
        return Transfer(table, clim, unit)

    def _look(self) -> None:
        """Set what the property knows: surfaces alone are shaded, and as opaque as they are told."""
        surface = self.mode == SURFACE
        self.prop.lighting = self._lit and surface
        self.prop.opacity = float(self._opacity_choice) if surface and is_number(self._opacity_choice) else 1.0
        self.prop.color = "white" if self._settings.color is None else self._settings.color

    def _bar(self) -> None:
        if self._bar_changed is not None:
            self._bar_changed(self)


_RAYS = tuple(name for name, value in vars(RaycastActor).items() if isinstance(value, _Setting))
"""Fields of `Casting` that are the actor's settings as they are."""


def _checked(volume: Any) -> RaycastVolume:
    if not isinstance(volume, RaycastVolume):
        raise TypeError(
            f"the volume is a {type(volume).__name__}; give a RaycastVolume, which "
            "pvfiblets.raycast.as_raycast_volume makes of images and arrays"
        )
    return volume


def _smoothed(volume: RaycastVolume, sigma: Any) -> RaycastVolume:
    return volume if sigma is None else smoothed(volume, sigma)


def _widen(table: pv.LookupTable, count: int) -> None:
    """Give a table so many entries at least, of the same colours: opacities want more than a list of a few colours."""
    before = table.n_values
    if before < count:
        table.values = np.array(table.values)[np.arange(count) * before // count]


def _scalars(volume: RaycastVolume) -> Scalars:
    """The volume's values, whose range is not empty even if all are one."""
    low, high = volume.value_range
    if low == high:
        high = max(low + 1.0, float(np.nextafter(low, np.inf)))
    return Scalars(volume.name, "point_value", None, (low, high))
