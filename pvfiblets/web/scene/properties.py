"""Properties of layers: type, allowed values, and description for a panel."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Any

from pvfiblets.plotting.settings.settings import SAME, Row, Setting
from pvfiblets.web.values import colour, number, numbers, shown, text, truth, whole

TYPES = ("choice", "number", "range", "numbers", "colour", "bool", "text")
"""``range`` is two numbers, the low one first; ``numbers`` a list of them."""

USUAL = 4  # choices of a list that stand before the scene's images

Limits = tuple[float, float]
Choices = Sequence[tuple[Any, str]]


@dataclass(frozen=True)
class Property(Row):
    """One thing that can be set, or read, of a layer: a `Row` with all that it leaves out."""

    name: str = ""  # of the setting; where an actor has the same, that of its attribute
    live: bool = False  # whether it is a setting of the actor, and not of the page alone
    usual: Any = None  # what actors do that are not told of it

    @classmethod
    def own(cls, name: str, type: str, label: str, help: str, group: str = "Colours", default: Any = None,  # noqa: A002
            **more: Any) -> Property:  # fmt: skip
        """Return a property that is the page's alone."""
        return cls(label, help, group, type, default, name=name, **more)

    @classmethod
    def from_setting(cls, setting: Setting[Any]) -> Property:
        """Return the property of a layer that a setting of actors is."""
        row, limits = setting.row, (setting.low, setting.high)
        assert row is not None
        found = {field.name: getattr(row, field.name) for field in fields(Row)}
        found["default"] = setting.default if row.default is SAME else row.default
        found["help"] = row.help or (setting.__doc__ or "").split("\n\n")[0]
        kinds = ((bool, "bool"), (str, "text"))
        plain = next((kind for of, kind in kinds if isinstance(setting.default, of)), "number")
        found["type"] = row.type or ("choice" if row.choices or setting.choices else plain)
        if found["type"] == "choice" and row.choices is None:
            found["choices"] = [(name, str(name).replace("-", " ").replace("_", " ")) for name in setting.choices]
        if row.limits is None and None not in limits:
            found["limits"] = limits
        return cls(**found, name=setting.name, live=True, usual=setting.default)

    def choices_for(self, data: Any, volumes: Choices = ()) -> Choices:
        """Return values and labels that can be chosen for some data, in a scene with some volumes."""
        found = list((self.choices(data) if callable(self.choices) else self.choices) or ())
        return [*found[:USUAL], *volumes, *found[USUAL:]] if self.volumes else found

    def limits_for(self, data: Any) -> Limits | None:
        """Return least and greatest value for some data."""
        return self.limits(data) if callable(self.limits) else self.limits

    def check(self, value: Any, data: Any, volumes: Choices = ()) -> Any:
        """Return a value in its plain form."""
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
        """Return all that a panel needs, in JSON's types."""
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
            "matters": (self.matters is None or bool(self.matters(settings)))
            and not (self.scale and getattr(actor, "shows_labels", False)),
        }
