"""The one form of all measurements; :mod:`.report_file` keeps them."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

FRAME = "frame"  # the item of pictures


@dataclass(frozen=True)
class Figure:
    """A number with its unit; NaN where there is none."""

    value: float
    unit: str


@dataclass(frozen=True)
class Timing:
    """Seconds that one call takes, of several."""

    # Of the repeats, s; low and high are the least and the greatest
    median: float
    low: float
    high: float
    repeats: int  # Calls measured, after one that was not
    items: float  # How many of `item` one call handles
    item: str  # Such as `"point"`. Times of a `"frame"` are given in ms, of all else in ns.
    clock: str  # What was read: `"cpu"` is the processor time of this process, which other programs disturb little

    @property
    def each(self) -> float:
        """Seconds for one item; NaN where there are none."""
        return self.median / self.items if self.items else math.nan

    @property
    def scale(self) -> float:
        """Factor of seconds for one item in tables and plots."""
        return 1e3 if self.item == FRAME else 1e9

    @property
    def rate(self) -> float:
        """Items per second; NaN where there is none."""
        return self.items / self.median if self.median > 0.0 and self.items else math.nan


@dataclass
class Record:
    """One method with one setting, on one data set."""

    # Data set, and the group of sets that are drawn in one picture; an empty group is not drawn
    data: str
    group: str
    approximation: str  # What is approximated
    # Method, which gives the colour, and its setting
    method: str
    setting: str
    # Such as `{"max": Figure(0.01, "mm")}` and `{"size": Figure(1.4, "bytes/point")}`; less is better
    errors: dict[str, Figure]
    costs: dict[str, Figure] = field(default_factory=dict)
    times: dict[str, Timing] = field(default_factory=dict)  # By task
    # Whether this is the program's own method, and its default
    ours: bool = False
    default: bool = False
    machine: str = ""  # The `name` of the machine in the report's `about`: times of two machines are never compared
    # Keys of the axes on whose Pareto front this record lies among the records of its data set
    front: list[str] = field(default_factory=list)

    @property
    def label(self) -> str:
        """Variant and setting."""
        return f"{self.method} ({self.setting})" if self.setting else self.method

    def in_unit(self, path: str) -> float:
        """Return one number in the unit of tables and plots: times as :attr:`Timing.scale` has them."""
        kind, _, name = path.partition("/")
        return self.value(path) * (self.times[name].scale if kind == "times" and name in self.times else 1.0)

    def value(self, path: str) -> float:
        """Return one number."""
        kind, _, name = path.partition("/")
        if kind == "times":
            return self.times[name].each if name in self.times else math.nan
        figures = {"errors": self.errors, "costs": self.costs}.get(kind)
        if figures is None:
            raise ValueError(f"{path!r} names no figure: it must begin with errors/, costs/ or times/")
        return figures[name].value if name in figures else math.nan


@dataclass(frozen=True)
class Axes:
    """Two figures to be drawn against each other, less of both being better."""

    key: str  # Short name, part of the plots' file names
    # Paths as :meth:`Record.value` takes them
    x: str
    y: str
    # With units. Times of items are drawn in ns per item, times of pictures in ms per frame.
    x_label: str
    y_label: str
    # A line for each method instead: `y` is how the names of several errors begin, which end in the numbers that
    # they are drawn at; `x` is empty, and there is no front
    series: bool = False
    # Whether one method is taken in place of another, so that one may be better. Where each adds something else
    # there is no front, nothing beats the default, and all are drawn in rows beside it.
    alternatives: bool = True

    @property
    def has_front(self) -> bool:
        """Whether some records beat others."""
        return self.alternatives and not self.series


@dataclass(frozen=True)
class CaseResult:
    """Result of one named extreme case."""

    # Part of the program, and the case
    system: str
    name: str
    # What was done, and what must hold
    does: str
    must: str
    measured: Figure  # NaN where it ended in an error that was not expected
    limit: float  # What must hold does where `measured` is no larger
    held: bool
    note: str = ""  # What else is worth saying, such as an error's message
    seconds: float = 0.0


@dataclass(frozen=True)
class LeftOut:
    """Something that was not measured, and the reason."""

    what: str
    reason: str


@dataclass
class StudyResult:
    """All that one study found."""

    # As of the study
    name: str
    title: str
    approximates: str
    notes: list[str] = field(default_factory=list)  # Paragraphs for the reader: the figures, and the method
    axes: list[Axes] = field(default_factory=list)
    records: list[Record] = field(default_factory=list)
    left_out: list[LeftOut] = field(default_factory=list)
    unavailable: str = ""  # Why nothing could be measured; empty if it could
    seconds: float = 0.0  # How long the study took
    cases: list[CaseResult] = field(default_factory=list)  # Of a study of what holds rather than of what costs what
    # Figures, as :meth:`Record.value` takes them, that one table shows of all data sets, method beside method
    across: list[str] = field(default_factory=list)
