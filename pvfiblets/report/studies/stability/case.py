"""An extreme case: its input, a condition on the result, and the figure that decides whether it holds."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import moderngl


@dataclass(frozen=True)
class Setting:
    """The input of a case."""

    whole: bool = False  # Whether the largest cases are of their full size. Otherwise their text names the smaller one.
    ctx: moderngl.Context | None = None  # Current; only cases that draw need it

    @property
    def gl(self) -> moderngl.Context:
        """The context of a case that draws."""
        if self.ctx is None:
            raise ValueError("this case draws: give a current OpenGL context")
        return self.ctx


@dataclass(frozen=True)
class Outcome:
    """The result of a case."""

    # What must hold does if `measured` is no larger than `limit`; NaN is larger than any
    measured: float
    limit: float
    unit: str  # Of both
    note: str = ""  # What else is worth saying, such as the message of an error

    @property
    def held(self) -> bool:
        """Whether what must hold does."""
        return bool(self.measured <= self.limit)


@dataclass(frozen=True)
class Case:
    """One extreme case."""

    # Part of the program, and what the case is called within it
    system: str
    name: str
    # What is done, and what must hold
    does: str
    must: str
    run: Callable[[Setting], Outcome]  # Takes a :class:`Setting`, returns an :class:`Outcome`
    draws: bool = False  # Whether it needs an OpenGL context
    long: bool = False  # Whether it takes seconds: such cases come last where time is short
    # Why it does not hold, of a fault that is known and not mended yet; tests fail when it holds after all
    known: str = ""


class Cases(list[Case]):
    """The cases of one system; ``draws``: they need an OpenGL context unless they say otherwise."""

    def __init__(self, system: str, *, draws: bool = False) -> None:
        super().__init__()
        self.system = system
        self._draws = draws

    def add(
        self,
        name: str,
        does: str,
        must: str,
        *,
        draws: bool | None = None,
        long: bool = False,
        known: str = "",
    ) -> Callable[[Callable[[Setting], Outcome]], Callable[[Setting], Outcome]]:
        """Take in the function that is decorated."""
        needs = self._draws if draws is None else draws

        def register(run: Callable[[Setting], Outcome]) -> Callable[[Setting], Outcome]:
            self.append(Case(self.system, name, does, must, run, needs, long, known))
            return run

        return register


def refused(kind: type[Exception], message: str, *calls: Callable[[], object]) -> Outcome:
    """Count the calls that do not end in an error of a kind whose text holds a pattern."""
    wrong, said = 0, ""
    for call in calls:
        try:
            call()
        except Exception as error:  # noqa: BLE001 - other kinds are failures to report
            said = said or str(error)
            if not isinstance(error, kind) or re.search(message, str(error)) is None:
                wrong, said = wrong + 1, f"{type(error).__name__}: {error}"
        else:
            wrong, said = wrong + 1, "no error"
    return Outcome(float(wrong), 0.0, "calls not refused", said)


def worst(outcomes: list[Outcome]) -> Outcome:
    """Return of outcomes with one limit and unit the one that measured most, NaN before all."""
    order = [np.inf if np.isnan(outcome.measured) else outcome.measured for outcome in outcomes]
    return outcomes[int(np.argmax(order))]
