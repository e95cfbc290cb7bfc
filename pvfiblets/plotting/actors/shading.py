"""Shading of an actor's lines or tubes: each effect is off, and costs nothing, until it is set."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from typing import TYPE_CHECKING, Any

import pyvista as pv

from pvfiblets.mappers.effects.shading import Halos

if TYPE_CHECKING:
    from pvfiblets.mappers.engine_mapper import EngineMapper

BACKGROUND = "background"  # colour of halos that are not seen


class Shades(dict[str, dict[str, Any]]):
    """Settings of the effects that are on, by name, in step with a mapper's effects.

    An effect is set to ``True`` for its defaults, to a dict of what shall differ from them, or to ``False`` or
    ``None`` for off. Lengths are mm.
    """

    def __init__(self, mapper: EngineMapper[Any]) -> None:
        super().__init__()
        self._mapper = mapper

    def change(self, name: str, kind: type, wanted: Any) -> None:
        """Set one effect; a refused value leaves all as it was."""
        if wanted is None or wanted is False:
            self.pop(name, None)
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
            plain = colour is None or (isinstance(colour, str) and colour == BACKGROUND)
            given["color"] = None if plain else pv.Color(colour).float_rgb
        effect = kind(**given)
        self._mapper.set_effect(name, effect)
        self[name] = {key: settings.get(key, getattr(effect, key)) for key in known}
