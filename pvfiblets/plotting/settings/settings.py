"""Settings of actors, each declared once.

A drawable's settings are the body of one class, a :class:`Settings`, from which the actor inherits. Each
:class:`Setting` in it is the live property of the actor, with its check and doc; the keyword argument of ``add_...``
(`pvfiblets.plotting.actors.registry`), with the same check; the argument in the type stub ``plotter.pyi``; and, where
it has a :class:`Row`, the row on the web page, the entry in saved sessions and the line of scripts
(`pvfiblets.web.scene.layer_properties`). A place (`pvfiblets.plotting.settings.places`) says what a setting changes.

The module, and the modules of settings, import nothing that draws: arguments can be read before anything is loaded.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from copy import copy
from dataclasses import dataclass
from numbers import Real
from typing import Any, ClassVar, Generic, Self, TypeVar, overload

from pvfiblets.plotting.settings.places import Place

T = TypeVar("T")

SAME: Any = object()  # default of a row: that of the setting


@dataclass(frozen=True)
class Row:
    """Appearance of a setting on the web page."""

    label: str  # for people; the help is the setting's own doc where it is empty
    help: str = ""
    group: str = "Colours"  # heading that it stands under
    # `"choice"`, `"number"`, `"range"` (two numbers, the low one first), `"numbers"` (a list of them), `"colour"`,
    # `"bool"` or `"text"`; found from the setting where it is empty
    type: str = ""
    default: Any = SAME  # what the page begins with; the setting's own by default
    optional: bool = False  # whether `None` is allowed: as the data or the program sees fit
    # (value, label): options of a choice; the setting's by default
    choices: Sequence[tuple[Any, str]] | Callable[[Any], Sequence[tuple[Any, str]]] | None = None
    # (low, high), or function of the data: limits of a number; for other types the range of a slider only. The
    # setting's by default.
    limits: tuple[float, float] | Callable[[Any], tuple[float, float]] | None = None
    whole: bool = False  # whether a number has no fraction
    read: Callable[[Any], Any] | None = None  # what `None` amounts to, or what a property is that can only be read
    span: Callable[[Any], tuple[float, float]] | None = None  # between what a range makes sense
    read_only: bool = False
    resets: tuple[str, ...] = ()  # settings that go back to their defaults when this one changes
    matters: Callable[[Mapping[str, Any]], bool] | None = None  # whether it changes anything as the others are
    scale: bool = False  # whether it is of a range of numbers, which categories such as groups lack
    volumes: bool = False  # whether the scene's volumes are choices, too


# Declarations ---------------------------------------------------------------------------------------


class Argument:
    """An argument of ``add_...`` that is no property of the actor."""

    name: str

    def __init__(
        self,
        default: Any,
        doc: str,  # for the section `Parameters`; lines are wrapped there. Paragraphs are parted by empty lines.
        *,
        kind: str = "Any",  # its type, as Python annotates it
        # its type, as numpydoc says it; found from `kind`, `choices` and `default` by default
        header: str | None = None,
        choices: tuple[Any, ...] = (),  # all that it may be, if these are few
        where: Place | None = None,  # its target
        field: str = "",  # its name there; the same by default
        # returns the value as it is kept, or raises an error that names it. A place that checks needs none.
        check: Callable[[str, Any], Any] | None = None,
    ) -> None:
        self.default, self.argument_doc, self.kind, self.choices = default, doc, kind, choices
        self.where, self.field, self._check = where, field, check
        self._header = header

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = name
        self.field = self.field or name

    @property
    def header(self) -> str:
        """Type and default, as numpydoc says them."""
        if self._header is not None:
            return self._header
        listed = ", ".join(f'"{choice}"' if isinstance(choice, str) else repr(choice) for choice in self.choices)
        kind = f"{{{listed}}}" if self.choices else self.kind.replace(" | None", "").replace(" | ", " or ")
        default = f'"{self.default}"' if isinstance(self.default, str) else repr(self.default)
        return f"{kind}, optional" if self.default is None else f"{kind}, default: {default}"

    def check(self, value: Any) -> Any:
        """Return a value as it is kept."""
        return value if self._check is None else self._check(self.name, value)

    def given(self, value: Any) -> Any:
        """Return an argument as it is kept; None stands for what the theme or the data say, if it may be given."""
        return None if value is None and (self.default is None or "None" in self.kind) else self.check(value)


class Setting(Argument, Generic[T]):
    """Something that can be set of an actor at any time, and when it is made."""

    where: Place  # its target

    def __init__(
        self,
        default: Any,  # of the argument
        doc: str,  # of the property, and of the argument if `argument` does not say more
        *,
        argument: str | bool = True,  # doc of the argument; False if there is none
        low: float | None = None,  # least and greatest number; checked where there is no `check`
        high: float | None = None,
        unit: str = "",  # of the number, for messages
        where: Place,
        read: Callable[[Any], Any] | None = None,  # value of the property, where it is not the stored one
        row: Row | None = None,  # how the web page shows it; without it, the page does not have it
        **more: Any,
    ) -> None:
        super().__init__(default, argument if isinstance(argument, str) else doc, where=where, **more)
        self.__doc__ = doc + self._choices_in_words(doc)
        self.is_argument = argument is not False
        self.low, self.high, self.unit, self._read, self.row = low, high, unit, read, row

    def but(self, **changes: Any) -> Setting[T]:
        """Return the same setting with other attributes: ``row``, ``where``, ``argument_doc``, ``__doc__``."""
        found = copy(self)
        for name, value in changes.items():
            if not hasattr(found, name):
                raise AttributeError(f"a setting has no {name}")
            setattr(found, name, value)
        return found

    def _choices_in_words(self, doc: str) -> str:
        """Return what the property may be, where its doc does not say it; arguments have that in their header."""
        if not self.choices or any(f"``{choice!r}``" in doc.replace('"', "'") for choice in self.choices):
            return ""
        *first, last = (f"``{choice!r}``" for choice in self.choices)
        return f"\n\n{', '.join(first)} or {last}."

    @overload
    def __get__(self, actor: None, kind: type | None = None) -> Self: ...
    @overload
    def __get__(self, actor: Any, kind: type | None = None) -> T: ...
    def __get__(self, actor: Any, kind: type | None = None) -> Any:
        if actor is None:
            return self
        return self.where.read(actor, self) if self._read is None else self._read(actor)

    def __set__(self, actor: Any, value: Any) -> None:
        self.where.write(actor, self, self.check(value))

    def check(self, value: Any) -> Any:
        """Return a value as it is kept; errors as of `Argument.check`."""
        if self._check is None and not (self.low is None and self.high is None):
            return number(self.name, value, self.low, self.high, self.unit)
        chosen = self._check is not None or not self.choices or self.where.checks
        if not chosen and not any(_is(value, choice) for choice in self.choices):
            raise ValueError(f"{self.name} is {value!r}; choose one of {self.choices}")
        return super().check(value)


def _is(value: Any, choice: Any) -> bool:
    return value is choice or (isinstance(value, type(choice)) and bool(value == choice))


class NoSetting:
    """A setting that other actors have; asking for it says what to use."""

    def __init__(self, why: str) -> None:
        self._why = why  # message; `{name}` in it is the setting's

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    def __get__(self, actor: Any, kind: type | None = None) -> Any:
        if actor is None:
            return self
        raise AttributeError(self._why.format(name=self._name))

    def __set__(self, actor: Any, value: Any) -> None:
        raise AttributeError(self._why.format(name=self._name))


class Settings:
    """Settings, declared in the body of a subclass, which is a base of the actor that has them."""

    # All of them by name, in their order; a class's own before inherited ones.
    DECLARED: ClassVar[dict[str, Argument]] = {}

    def __init_subclass__(cls, **more: Any) -> None:
        super().__init_subclass__(**more)
        own = {name: value for name, value in vars(cls).items() if isinstance(value, Argument)}
        cls.DECLARED = {**own, **{name: one for name, one in cls.DECLARED.items() if name not in own}}
        for name, value in own.items():
            if not isinstance(value, Setting):  # of the call alone
                delattr(cls, name)

    def _arguments_of_copy(self) -> dict[str, Any]:
        """Return the arguments that make an actor with the same settings."""
        declared = arguments(type(self)).items()
        return {name: one.where.value_for_copy(self, one) for name, one in declared if one.where is not None}

    def _take(self, values: Mapping[str, Any]) -> None:
        """Set those values that an actor is not made with, in the order of their declarations."""
        for name, one in self.DECLARED.items():
            late = isinstance(one, Setting) and not one.where.made_with and name in values
            if late and not _same(values[name], getattr(self, name)):
                setattr(self, name, values[name])

    def _take_from(self, other: Settings) -> None:
        """Set all that an actor is not made with as another one has it."""
        self._take({name: getattr(other, name) for name, one in self.DECLARED.items() if isinstance(one, Setting)})


def _same(one: Any, other: Any) -> bool:
    """Return whether two values are alike; arrays only if they are the same."""
    return one is other or (not hasattr(one, "shape") and not hasattr(other, "shape") and bool(one == other))


def arguments(settings: type[Settings]) -> dict[str, Argument]:
    """Return the settings of a drawable that ``add_...`` takes."""
    declared = settings.DECLARED.items()
    return {name: one for name, one in declared if not isinstance(one, Setting) or one.is_argument}


class Given(dict[str, Any]):
    """Settings that were given to ``add_...``, checked, and the defaults of all others."""

    def __init__(self, settings: type[Settings], given: Mapping[str, Any] | None = None) -> None:
        self._known = arguments(settings)
        given = given or {}
        said = (name for name, value in given.items() if name in self._known and value is not None)
        # the given settings that are not None
        self.named: frozenset[str] = given.named if isinstance(given, Given) else frozenset(said)
        super().__init__((name, one.given(given.get(name, one.default))) for name, one in self._known.items())

    def at(self, where: Place) -> dict[str, Any]:
        """Return the settings of one place, by their names there."""
        return {self._known[name].field: value for name, value in self.items() if self._known[name].where is where}


# Checks ---------------------------------------------------------------------------------------------


def number(name: str, value: Any, low: float | None, high: float | None, unit: str = "") -> float:
    """Return a number that lies between two others, both included."""
    # A numpy array of no dimension is a number, too.
    plain = value.item() if getattr(value, "ndim", None) == 0 else value
    found = float(plain) if isinstance(plain, Real) else math.nan
    if math.isnan(found) or (low is not None and found < low) or (high is not None and found > high):
        between = ""
        if low is not None and high is not None:
            between = f" from {low:g} to {high:g}"
        elif low is not None:
            between = f", {low:g} or more"
        elif high is not None:
            between = f" up to {high:g}"
        raise ValueError(f"{name} is {value!r}; give {unit or 'a number'}{between}")
    return found


def truth(name: str, value: Any) -> bool:
    """Return whether something is true."""
    if isinstance(value, str):
        raise ValueError(f"{name} is {value!r}; give True or False")
    return bool(value)
