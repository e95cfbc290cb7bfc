"""What a property of a layer is: its type, what it may be, and how it is described to whoever draws a panel of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from pvfiblets.web.values import colour, number, numbers, shown, text, truth, whole

__all__ = ["TYPES", "Property"]

TYPES = ("choice", "number", "range", "numbers", "colour", "bool", "text")
"""``range`` is two numbers, the low one first; ``numbers`` a list of them."""

Limits = tuple[float, float]
Choices = Sequence[tuple[Any, str]]


@dataclass(frozen=True)
class Property:
    """One thing that can be set, or read, of a layer.

    Attributes
    ----------
    name : str
        Of the setting; where an actor has the same, that of its attribute.
    type : str
        Of `TYPES`.
    label, help : str
        For people.
    group : str
        Heading that it stands under.
    default : JSON value
        What an actor does if nothing is set.
    optional : bool
        Whether ``None`` is allowed: as the data or the program sees fit.
    choices : sequence of (value, label), or function of the data
        Of a choice.
    limits : (low, high), or function of the data
        Of a number; of the others what a slider should offer, and no limit.
    whole : bool
        Whether a number has no fraction.
    read : function of the actor, optional
        What ``None`` amounts to, or what a property is that can only be read.
    span : function of the actor, optional
        Between what a range makes sense.
    read_only : bool
    resets : tuple of str
        Settings that go back to their defaults when this one changes.
    matters : function of the settings, optional
        Whether it changes anything as the others are.
    volumes : bool
        Whether the scene's volumes are choices, too.
    """

    name: str
    type: str
    label: str
    help: str
    group: str = "Colours"
    default: Any = None
    optional: bool = False
    choices: Choices | Callable[[Any], Choices] | None = None
    limits: Limits | Callable[[Any], Limits] | None = None
    whole: bool = False
    read: Callable[[Any], Any] | None = None
    span: Callable[[Any], Limits] | None = None
    read_only: bool = False
    resets: tuple[str, ...] = ()
    matters: Callable[[Mapping[str, Any]], bool] | None = None
    volumes: bool = False

    def choices_for(self, data: Any, volumes: Choices = ()) -> Choices:
        """Return values and labels that can be chosen for some data, in a scene with some volumes."""
        found = self.choices(data) if callable(self.choices) else self.choices
        return [*(found or ()), *(volumes if self.volumes else ())]

    def limits_for(self, data: Any) -> Limits | None:
        """Return least and greatest value for some data."""
        return self.limits(data) if callable(self.limits) else self.limits

    def check(self, value: Any, data: Any, volumes: Choices = ()) -> Any:
        """Return a value in its plain form.

        Raises
        ------
        ValueError
            If it is of another type, out of range, none of the choices, or cannot be set.
        """
        if self.read_only:
            raise ValueError(f"{self.name} can only be read; it was to become {shown(value)}")
        if self.type == "choice":
            known = [choice for choice, _ in self.choices_for(data, volumes)]
            # By type, too: True is no choice where 1 is one.
            if not any(value == choice and type(value) is type(choice) for choice in known):
                listed = ", ".join(map(repr, known[:40])) + (", …" if len(known) > 40 else "")
                raise ValueError(f"{self.name} is {shown(value)}; choose one of {listed}")
            return value
        if value is None and self.optional:
            return None
        if self.type == "bool":
            return truth(value, self.name)
        if self.type == "colour":
            return colour(value, self.name)
        if self.type == "text":
            return text(value, self.name)
        if self.type == "numbers":
            return numbers(value if isinstance(value, (list, tuple)) else [value], self.name, most=8)
        if self.type == "range":
            low, high = numbers(value, self.name, 2)
            if low > high:
                raise ValueError(f"{self.name} is [{low:g}, {high:g}]; give the low end first")
            return [low, high]
        low, high = self.limits_for(data) or (-1e30, 1e30)
        if self.whole:
            return whole(value, self.name, int(low), int(high))
        return number(value, self.name, low, high)

    def describe(self, actor: Any, data: Any, settings: Mapping[str, Any], volumes: Choices = ()) -> dict[str, Any]:
        """Return all that a panel needs, in JSON's types.

        Returns
        -------
        dict
            ``name, type, label, help, group, optional, read_only, whole, default``; ``value`` as set; ``effective``:
            what is in force, also where the value is ``None``; ``choices``: list of ``{"value", "title"}``;
            ``limits``: two numbers or ``None``; ``matters``: whether it changes anything now.
        """
        value = settings.get(self.name, self.default)
        effective = value
        if self.read is not None and (value is None or self.read_only):
            effective = self.read(actor)
        span = self.span(actor) if self.span is not None else self.limits_for(data)
        return {
            "name": self.name,
            "type": self.type,
            "label": self.label,
            "help": self.help,
            "group": self.group,
            "optional": self.optional,
            "read_only": self.read_only,
            "whole": self.whole,
            "default": self.default,
            "value": effective if self.read_only else value,
            "effective": effective,
            "choices": [{"value": choice, "title": title} for choice, title in self.choices_for(data, volumes)],
            "limits": None if span is None else [float(end) for end in span],
            "matters": True if self.matters is None else bool(self.matters(settings)),
        }
