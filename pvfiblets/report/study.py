"""The interface of a study, and its input: options, and a budget of time that it keeps to.

A study skips impossible measurements with a reason (:meth:`Options.leave_out`); if it cannot measure anything (no GPU,
no data, a package that is missing) it raises :class:`Unavailable`, and the report names it with that reason.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from .record import Axes, CaseResult, LeftOut, Record

LATE = "the time given was used up"  # why something was left out


class Unavailable(Exception):  # noqa: N818 - it is a state to be reported, not an error
    """A study that cannot be done here; the message is the reason, for the reader of the report."""


class Budget:
    """Seconds that may be spent, ``inf`` for no limit.

    :meth:`allows` is called before each measurement. It takes the longest measurement so far as the next one's
    cost, so that a budget is overrun by no more than one measurement that is longer than all before it.
    """

    def __init__(self, seconds: float, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._seconds = seconds
        self._begun = self._last = clock()
        self._longest = 0.0

    @property
    def spent(self) -> float:
        """Seconds since it was made."""
        return self._clock() - self._begun

    @property
    def left(self) -> float:
        """Seconds that are left, 0 at least."""
        return max(self._seconds - self.spent, 0.0)

    def share(self, part: float = 1.0) -> Budget:
        """Return a budget of a part of the remaining time, without earlier measurements."""
        return Budget(self.left * part, self._clock)

    def allows(self, factor: float = 1.0) -> bool:
        """Return whether another measurement fits, ``factor`` times as long as the longest so far."""
        now = self._clock()
        self._longest = max(self._longest, now - self._last)
        self._last = now
        return self.left > 0.0 and self._longest * factor <= self.left


@dataclass
class Options:
    """Options of a study's run."""

    quick: bool = False  # A little of each
    budget: Budget = field(default_factory=lambda: Budget(float("inf")))  # This study's share of time
    files: tuple[Path, ...] = ()  # Real data: files, and folders whose files are taken
    seed: int = 0  # Of all synthetic data
    repeats: int = 5  # Timed calls of each method, after one that is not timed
    points: int = 100_000  # To which data sets are cut
    machine: str = ""  # Name of the machine for the records
    driver: str = ""  # OpenGL renderer and version; a study that draws writes them here
    # Takes lines that say how far the study is
    log: Callable[[str], None] = lambda line: print(line, file=sys.stderr, flush=True)
    left_out: list[LeftOut] = field(default_factory=list)  # What was not measured, and why

    def share(self, part: float = 1.0) -> Options:
        """Return the same with such a part of the time that is left."""
        return replace(self, budget=self.budget.share(part))

    def leave_out(self, what: str, reason: object) -> None:
        """Note a skipped measurement, and the reason."""
        self.left_out.append(LeftOut(what, str(reason)))

    def allows(self, what: str) -> bool:
        """Return whether another measurement fits; if not, it is left out."""
        return self.budget.allows() or self._late(what)

    def lasts(self, what: str) -> bool:
        """Return whether any time is left; if not, something is left out."""
        return self.budget.left > 0.0 or self._late(what)

    def _late(self, what: str) -> bool:
        self.leave_out(what, LATE)
        return False


@dataclass(frozen=True)
class Study:
    """One approximation, measured beside its baselines."""

    name: str
    title: str
    approximates: str  # One sentence: the approximation and its reference
    axes: Sequence[Axes]  # Pairs of figures to plot
    notes: Sequence[str]  # Paragraphs for the reader
    run: Callable[[Options], Iterator[Record | CaseResult]]  # Yields records and results of cases as they are measured
    across: Sequence[str] = ()  # Paths of figures that one table shows of all data sets
