"""Storage of settings in actors: how a setting is read, and which object changes when it is written."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import replace
from importlib import import_module
from typing import Any, ClassVar, Protocol


class Stored(Protocol):
    """What a place reads of a setting or an argument."""

    name: str
    field: str  # its name in the place
    default: Any


class Place(ABC):
    """A place where an actor keeps a setting: it reads the setting, and applies its changes."""

    checks: ClassVar[bool] = False  # whether choices are looked at there, not before

    @abstractmethod
    def read(self, actor: Any, setting: Stored) -> Any:
        """Return the present value."""

    @abstractmethod
    def write(self, actor: Any, setting: Stored, value: Any) -> None:
        """Change it; a refused value leaves all as it was."""

    def value_for_copy(self, actor: Any, one: Stored) -> Any:
        """Return the value to pass to a copy."""
        return getattr(actor, one.name)

    made_with: ClassVar[bool] = True
    """Whether an actor is made with it. What is not is set of an actor that is there already."""


class _Options(Place):
    """A field of the mapper's options, which check it."""

    checks = True

    def read(self, actor: Any, setting: Stored) -> Any:
        return getattr(actor.mapper.options, setting.field)

    def write(self, actor: Any, setting: Stored, value: Any) -> None:
        actor.mapper.options = replace(actor.mapper.options, **{setting.field: value})


class _Colours(Place):
    """A field of the actor's ``ColourSettings``, which the look-up table is made from and checked by."""

    def read(self, actor: Any, setting: Stored) -> Any:
        return getattr(actor._settings, setting.field)  # noqa: SLF001 - of the class that it is part of

    def write(self, actor: Any, setting: Stored, value: Any) -> None:
        actor._set(setting.field, value)  # noqa: SLF001

    def value_for_copy(self, actor: Any, one: Stored) -> Any:
        return getattr(actor._settings, one.field)  # noqa: SLF001


class _Property(Place):
    """A field of the actor's ``prop``."""

    def read(self, actor: Any, setting: Stored) -> Any:
        return getattr(actor.prop, setting.field)

    def write(self, actor: Any, setting: Stored, value: Any) -> None:
        setattr(actor.prop, setting.field, value)


class _Mapper(Place):
    """A property of the mapper's, which checks it; of actors that are there already."""

    made_with = False

    def read(self, actor: Any, setting: Stored) -> Any:
        return getattr(actor._mapper, setting.field)  # noqa: SLF001 - of the class that it is part of

    def write(self, actor: Any, setting: Stored, value: Any) -> None:
        setattr(actor._mapper, setting.field, value)  # noqa: SLF001


class Own(Place):
    """Methods of the actor's own, ``_read_NAME`` and ``_write_NAME``: for what does more than change one value."""

    def read(self, actor: Any, setting: Stored) -> Any:
        """Ask the actor."""
        return getattr(actor, f"_read_{setting.field}")()

    def write(self, actor: Any, setting: Stored, value: Any) -> None:
        """Call the actor's method."""
        getattr(actor, f"_write_{setting.field}")(value)

    def value_for_copy(self, actor: Any, one: Stored) -> Any:
        """Ask the actor's ``_kept_NAME``, if it has such."""
        ask = getattr(actor, f"_kept_{one.field}", None)
        return super().value_for_copy(actor, one) if ask is None else ask()


class _Later(Own):
    """As `Own`, of actors that are there already."""

    made_with = False


class Effect(Place):
    """An effect of the resolve: ``True`` for its defaults, a dict of what shall differ, ``False`` for off."""

    made_with = False

    def __init__(self, kind: str) -> None:
        # `"module:class"` of an effect (`pvfiblets.mappers.effects.shader_effects`), whose fields are the settings
        self._kind = kind

    @property
    def kind(self) -> Any:
        """The class of the effect, imported when it is first needed."""
        module, _, name = self._kind.partition(":")
        return getattr(import_module(module), name)

    def read(self, actor: Any, setting: Stored) -> Any:
        """Return all its settings, or False."""
        return actor._shades.get(setting.field, False)  # noqa: SLF001

    def write(self, actor: Any, setting: Stored, value: Any) -> None:
        """Turn it on or off."""
        actor._shade(setting.field, self.kind, value)  # noqa: SLF001


class Switch(Effect):
    """An effect that is on or off and has no settings."""

    def read(self, actor: Any, setting: Stored) -> bool:
        """Return whether it is on."""
        return setting.field in actor._shades  # noqa: SLF001

    def write(self, actor: Any, setting: Stored, value: Any) -> None:
        """Turn it on or off."""
        super().write(actor, setting, bool(value))


class Uniform(Place):
    """A number in a piece of the resolve, ``shaders/resolve/PIECE.glsl``; which is there unless at its default."""

    made_with = False

    def __init__(self, piece: str, uniform: str) -> None:
        # its `uniform float`
        self.piece, self.uniform = piece, uniform  # of `shaders/resolve`

    def read(self, actor: Any, setting: Stored) -> Any:
        """Return the number."""
        effect = actor.mapper.effects.get(setting.field)
        return setting.default if effect is None else effect.value

    def write(self, actor: Any, setting: Stored, value: Any) -> None:
        """Set the number."""
        from pvfiblets.mappers.effects.uniform_effect import UniformEffect

        off = value == setting.default
        effect = None if off else UniformEffect(self.piece, self.uniform, float(value))
        actor.mapper.set_effect(setting.field, effect)


OPTIONS, COLOURS, PROPERTY, OWN, LATER, MAPPER = _Options(), _Colours(), _Property(), Own(), _Later(), _Mapper()
