"""How an actor's lines or tubes are shaded: each effect is off, and costs nothing, until it is set."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from typing import Any

import pyvista as pv

from pvfiblets.mappers.line_tubes import Tubes, TubeShading
from pvfiblets.mappers.shading import AmbientOcclusion, DepthCue, Halos, Illuminated, Ink

STYLES = ("surface", "halo")
"""What :attr:`Shading.style` may be."""

_BACKGROUND = "background"


class SurfaceShading:
    """The part of actors that shades what they draw, be it lines or surfaces.

    Every setting may be changed at any time and takes effect at the next render. An effect is set
    to ``True`` for its defaults, to a dict of what shall differ from them, or to ``False`` or
    ``None`` for off; read, it is the dict of all its settings, or ``False``. Lengths are mm.
    """

    _mapper: Any

    def _init_shading(self) -> None:
        self._shades: dict[str, dict[str, Any]] = {}

    @property
    def ambient_occlusion(self) -> dict[str, Any] | bool:
        """Darkness where others stand over a line or tube.

        ``radius`` (mm): what is farther does not darken; ``None``, the default, is a 20th of the
        data's diagonal. ``samples`` (16): pixels looked at around each. ``strength`` (1.0): 0 to 1.
        """
        return self._shades.get("ambient_occlusion", False)

    @ambient_occlusion.setter
    def ambient_occlusion(self, wanted: Mapping[str, Any] | bool | None) -> None:
        self._shade("ambient_occlusion", AmbientOcclusion, wanted)

    @property
    def depth_cue(self) -> dict[str, Any] | bool:
        """Fading with the distance from the viewer.

        ``strength`` (0.7): share of the colour at the far end. ``color``: ``None``, the default, is
        the background's. ``range``: distances (mm) at which fading begins and ends; ``None``, the
        default, are those of the nearest and the farthest part of the data's bounds.
        """
        return self._shades.get("depth_cue", False)

    @depth_cue.setter
    def depth_cue(self, wanted: Mapping[str, Any] | bool | None) -> None:
        self._shade("depth_cue", DepthCue, wanted)

    def _shade(self, name: str, kind: type, wanted: Any) -> None:
        """Set one effect; a refused value leaves all as it was."""
        if wanted is None or wanted is False:
            self._shades.pop(name, None)
            self._mapper.set_extra(name, None)
            return
        if wanted is not True and not isinstance(wanted, Mapping):
            raise ValueError(f"{name} is {wanted!r}; give True, False or a dict of settings")
        known = [field.name for field in fields(kind)] if is_dataclass(kind) else []
        settings = {} if wanted is True else dict(wanted)
        if unknown := sorted(set(settings) - set(known)):
            raise ValueError(f"{name} has no settings {unknown}; it has {known}")
        given = dict(settings)
        if "color" in known:
            colour = settings.setdefault("color", "white" if kind is Halos else None)
            plain = colour is None or (isinstance(colour, str) and colour == _BACKGROUND)
            given["color"] = None if plain else pv.Color(colour).float_rgb
        extra = kind(**given)
        self._mapper.set_extra(name, extra)
        self._shades[name] = {key: settings.get(key, getattr(extra, key)) for key in known}

    def _shade_surface_like(self, other: SurfaceShading) -> None:
        """Take over the settings that all actors have."""
        for name in ("ambient_occlusion", "depth_cue"):
            setattr(self, name, getattr(other, name))


class Shading(SurfaceShading):
    """The part of :class:`~pvfiblets.plotting.fiblets.actor.FibletActor` that shades."""

    def _init_shading(self) -> None:
        super()._init_shading()
        self._style = STYLES[0]

    @property
    def illuminated(self) -> bool:
        """Whether each light is reflected as by a thin cylinder, whichever side it comes from.

        Off, a line has the one normal that faces the viewer, so that only light from there counts
        fully (Zöckler et al. 1996; Mallo et al. 2005). Nothing to be seen without ``lighting``.
        """
        return "illuminated" in self._shades

    @illuminated.setter
    def illuminated(self, illuminated: bool) -> None:
        self._shade("illuminated", Illuminated, bool(illuminated))

    @property
    def tube_shading(self) -> bool:
        """Whether light falls on lines wider than a pixel as on round tubes.

        Only the light changes: their depth stays that of flat lines. ``illuminated`` goes before it.
        Nothing to be seen without ``lighting``.
        """
        return "tube_shading" in self._shades

    @tube_shading.setter
    def tube_shading(self, wanted: bool) -> None:
        self._shade("tube_shading", TubeShading, bool(wanted))

    @property
    def tube_radius(self) -> float | None:
        """Radius (mm) of tubes in place of lines of ``line_width`` pixels; ``None``, the default, for lines.

        Tubes are exact bodies: each pixel shows the point of the surface that it sees, they cut into
        each other and into meshes, and ends are round. Those thinner than a pixel are a pixel wide.
        """
        settings = self._shades.get("tubes")
        return None if settings is None else float(settings["radius"])

    @tube_radius.setter
    def tube_radius(self, radius: float | None) -> None:
        self._shade("tubes", Tubes, None if radius is None else {"radius": float(radius)})

    @property
    def halos(self) -> dict[str, Any] | bool:
        """Gaps that lines cut into what is behind them, the wider the farther it is behind.

        Depth-dependent halos of Everts et al. 2009.

        ``width`` (mm): from a line's edge to its halo's, at most 24 pixels; ``None``, the default,
        is a 250th of the data's diagonal, or 2.5 pixels if they are more. ``depth`` (mm): by how
        much the halo's edge lies behind its line; lines side by side whose depths differ by less do
        not cut each other. ``None``, the default, is a 20th of the diagonal. ``color``
        (``'white'``): ``'background'`` for the renderer's.
        """
        return self._shades.get("halos", False)

    @halos.setter
    def halos(self, wanted: Mapping[str, Any] | bool | None) -> None:
        self._shade("halos", Halos, wanted)

    @property
    def style(self) -> str:
        """``'surface'``, lines in their colours, or ``'halo'``, black lines in white halos.

        ``'halo'`` is a drawing in ink (Everts et al. 2009), best on white: it draws all
        lines black and without light, and sets default halos where none are. Colours and
        ``lighting`` stay as they are and come back with ``'surface'``, which takes halos away.
        """
        return self._style

    @style.setter
    def style(self, style: str) -> None:
        if style not in STYLES:
            raise ValueError(f"style is {style!r}; choose one of {STYLES}")
        if style == self._style:
            return
        self._style = style
        self._mapper.set_extra("ink", Ink() if style == "halo" else None)
        if style == "surface" or not self.halos:
            self.halos = style == "halo"

    def _shade_like(self, other: Shading) -> None:
        """Take over all settings of another actor."""
        self.style = other.style
        self._shade_surface_like(other)
        for name in ("illuminated", "tube_shading", "tube_radius", "halos"):
            setattr(self, name, getattr(other, name))
