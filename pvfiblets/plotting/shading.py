"""How an actor's lines or tubes are shaded: each effect is off, and costs nothing, until it is set."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from typing import Any

import pyvista as pv

from pvfiblets.mappers.line_light import LegendColours, LineLight
from pvfiblets.mappers.line_tubes import Tubes, TubeShading
from pvfiblets.mappers.shading import Halos, Ink
from pvfiblets.plotting.fiblets.settings import STYLES
from pvfiblets.plotting.linked_property import own_writes

_BACKGROUND = "background"
_LIGHT = "light"
_ROUND = "tube_shading"
DENSITY = "density"


class SurfaceShading:
    """The part of actors that shades what they draw, be it lines or surfaces.

    Every setting may be changed at any time and takes effect at the next render. An effect is set
    to ``True`` for its defaults, to a dict of what shall differ from them, or to ``False`` or
    ``None`` for off; read, it is the dict of all its settings, or ``False``. Lengths are mm.
    """

    _mapper: Any

    def _init_shading(self) -> None:
        self._shades: dict[str, dict[str, Any]] = {}

    def _shade(self, name: str, kind: type, wanted: Any) -> None:
        """Set one effect; a refused value leaves all as it was."""
        if wanted is None or wanted is False:
            self._shades.pop(name, None)
            self._mapper.set_effect(name, None)
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
        effect = kind(**given)
        self._mapper.set_effect(name, effect)
        self._shades[name] = {key: settings.get(key, getattr(effect, key)) for key in known}


class Shading(SurfaceShading):
    """The part of :class:`~pvfiblets.plotting.fiblets.actor.FibletActor` that shades."""

    halos: Any
    prop: Any
    _scalars: Any

    def _init_shading(self) -> None:
        super()._init_shading()
        self._style = STYLES[0]

    def _shade(self, name: str, kind: type, wanted: Any) -> None:
        super()._shade(name, kind, wanted)
        self._relight()

    def _relight(self) -> None:
        """Bring the light in step that lines have where nothing else says which."""
        kind = self._usual_light()
        present = self._mapper.effects.get(_LIGHT)
        if kind is not (None if present is None else type(present)):
            self._mapper.set_effect(_LIGHT, None if kind is None else kind())

    def _usual_light(self) -> type | None:
        bodies = "tubes" in self._shades or (self._read_tube_shading() and self._mapper.line_width > 1.0)
        if self._style == DENSITY:
            return LegendColours if self.prop.GetLighting() else None
        if bodies or "illuminated" in self._shades or self._style != STYLES[0] or not self.prop.GetLighting():
            return None
        return LegendColours if self._scalars is not None and self._scalars.mapped else LineLight

    def _read_tube_shading(self) -> bool:
        return bool(self.prop.GetRenderLinesAsTubes())

    def _write_tube_shading(self, wanted: bool) -> None:
        with own_writes():
            self.prop.SetRenderLinesAsTubes(wanted)
        self._take_tube_shading()
        self._relight()

    def _take_tube_shading(self) -> None:
        wanted = self._read_tube_shading()
        if wanted != (_ROUND in self._mapper.effects):
            self._mapper.set_effect(_ROUND, TubeShading() if wanted else None)

    def _read_tube_radius(self) -> float | None:
        settings = self._shades.get("tubes")
        return None if settings is None else float(settings["radius"])

    def _write_tube_radius(self, radius: float | None) -> None:
        self._shade("tubes", Tubes, None if radius is None else {"radius": float(radius)})

    def _read_style(self) -> str:
        return self._style

    def _write_style(self, style: str) -> None:
        if style == self._style:
            return
        self._style = style
        inks = {"halo": Ink(), "ink": Ink(None)}
        self._mapper.set_effect("ink", inks.get(style))
        self._relight()
        self._count_lines()
        if style == "ink":
            self.halos = {"color": _BACKGROUND}
        elif style != "halo" or not self.halos:
            self.halos = style == "halo"

    def _count_lines(self) -> None:
        """Bring in step what shows all lines of a pixel."""
