"""The actor that ``plotter.add_raycast_volume`` returns: an ordinary PyVista actor with a live transfer function."""

from __future__ import annotations

import operator
from collections.abc import Mapping
from dataclasses import replace
from functools import reduce
from typing import TYPE_CHECKING, Any

import numpy as np
import pyvista as pv

from pvfiblets.mappers.volumes import VolumeMapper
from pvfiblets.plotting.clipping import Clipping
from pvfiblets.plotting.fiblets.scalars import Scalars
from pvfiblets.plotting.mapper import Plotted
from pvfiblets.plotting.report import added_up
from pvfiblets.plotting.volumes.opacity import is_number
from pvfiblets.plotting.volumes.settings import RAYS, SURFACE, RaySettings
from pvfiblets.plotting.volumes.shading import VolumeShading
from pvfiblets.volumes import RaycastVolume, smoothed
from pvfiblets.volumes.interactive_quality import InteractiveQuality

if TYPE_CHECKING:
    from pvfiblets.mappers import RayHit
    from pvfiblets.plotting.colours import ColourSettings
    from pvfiblets.regions import Region

__all__ = ["VolumeActor"]


class PlottedRaycast(Plotted, VolumeMapper):
    """A mapper of a volume that rays are cast through, with scalar bars.

    Parameters
    ----------
    volume : RaycastVolume
        What to draw.
    casting : RaycastOptions
        How.
    """


class VolumeActor(RaySettings, VolumeShading, Clipping, pv.Actor):
    """A volume that rays are cast through: surfaces, light, or peaks.

    Everything of :class:`pyvista.Actor` works (``visibility``, ``position``, ``user_matrix``,
    ``pickable``, ``prop`` with its ``specular`` and so on, of surfaces). The properties below may be
    set at any time and take effect at the next render.

    Parameters
    ----------
    volume : RaycastVolume
        What to draw.
    casting : dict, optional
        Fields of :class:`pvfiblets.volumes.options.RaycastOptions` that shall differ from their defaults;
        those that are ``None`` do not.
    values, thresholds, peak, opacity, opacity_unit_distance, smooth, interactive_quality
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
        interactive_quality: float | dict[str, Any] = 0.5,
        lighting: bool | None = None,
        name: str | None = None,
        theme: Any = None,
    ) -> None:
        coarser = InteractiveQuality.of_quality(interactive_quality)
        theme = pv.global_theme if theme is None else theme
        self._source = _checked(volume)
        self._volume, self._smooth = _smoothed(volume, smooth), smooth
        self._lit = theme.lighting if lighting is None else bool(lighting)
        self._init_colours(None, settings, theme)
        self._init_shading()
        self._clips: dict[str, Region] = {}
        self._see_through = 1.0
        self._scalars = _scalars(self._volume)
        made, colouring = self._init_rays(
            casting or {},
            values=values,
            thresholds=thresholds,
            peak=peak,
            opacity=opacity,
            unit=opacity_unit_distance,
        )
        mapper = PlottedRaycast(self._volume, made, colouring=colouring)
        super().__init__(prop=pv.Property(theme=theme), name=name)
        self._mapper = mapper  # VTK keeps the C++ half only
        mapper.attach(self)
        self._quality, mapper.coarser = interactive_quality, coarser
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

    @property
    def interactive_quality(self) -> float | dict[str, Any]:
        """How well the volume is drawn while the camera moves, 0 to 1, or ``{"step": factor, "sparse": pixels}``.

        1: as at rest. 0.5: steps twice as long, and a ray for every second pixel at first; light
        whose steps are integrated beforehand keeps its step. As soon as the camera rests, there is
        one more picture, with all as it is set. What counts is that the window wants the rate of
        an interactor that is being used.
        """
        return self._quality

    @interactive_quality.setter
    def interactive_quality(self, quality: float | dict[str, Any]) -> None:
        self._mapper.coarser = InteractiveQuality.of_quality(quality)
        self._quality = quality

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

    def copy(self, deep: bool = True) -> VolumeActor:
        """Return another actor that draws the same volume in the same way and place.

        Parameters
        ----------
        deep : bool, default: True
            Give the copy a property of its own; else both share one. The volume is shared.

        Returns
        -------
        VolumeActor
            Not in any plotter yet.
        """
        own = {name: getattr(self._casting, name) for name in ("mode", *RAYS)}
        twin = VolumeActor(
            self._source,
            casting=own,
            values=self._values,
            thresholds=self._thresholds,
            peak=self._peak,
            opacity=self._opacity_choice,
            opacity_unit_distance=self._unit,
            smooth=self._smooth,
            settings=replace(self._settings),
            interactive_quality=self._quality,
            lighting=self._lit,
            theme=self._theme,
        )
        twin.prop = self.prop.copy() if deep else self.prop
        twin.position, twin.scale, twin.origin = self.position, self.scale, self.origin
        twin.orientation, twin.user_matrix = self.orientation, self.user_matrix
        twin.visibility, twin.pickable = self.visibility, self.pickable
        twin._shade_surface_like(self)
        twin._cut(self._clips)
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
    def _cuts(self) -> Mapping[str, Region]:
        return self._clips

    def _cut(self, clips: dict[str, Region]) -> None:
        self._mapper.region = reduce(operator.and_, clips.values()) if clips else None
        self._clips = dict(clips)

    @property
    def _drawn(self) -> RaycastVolume:
        return self._volume

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

    def _look(self) -> None:
        """Surfaces alone are shaded, stand over each other, and are as opaque as one number says."""
        surface = self.mode == SURFACE
        self._shade_surfaces(surface)
        self.prop.lighting = self._lit and surface
        opacity = float(self._opacity_choice) if surface and is_number(self._opacity_choice) else 1.0
        if opacity != self._see_through:  # what was set of the property itself stays
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
    """The volume's values, whose range is not empty even if all are one."""
    low, high = volume.value_range
    if low == high:
        high = max(low + 1.0, float(np.nextafter(low, np.inf)))
    return Scalars(volume.name, "point_value", None, (low, high))
