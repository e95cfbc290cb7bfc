"""The one form of all measurements; :mod:`.report_file` keeps them."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

__all__ = ["FRAME", "Axes", "CaseResult", "Figure", "LeftOut", "Record", "StudyResult", "Timing"]

FRAME = "frame"  # the item of pictures


@dataclass(frozen=True)
class Figure:
    """A number with its unit; NaN where there is none."""

    value: float
    unit: str


@dataclass(frozen=True)
class Timing:
    """Seconds that one call takes, of several.

    Attributes
    ----------
    median, low, high : float
        Of the repeats, s; low and high are the least and the greatest.
    repeats : int
        Calls measured, after one that was not.
    items : float
        How many of ``item`` one call handles.
    item : str
        Such as ``"point"``. Times of a ``"frame"`` are given in ms, of all else in ns.
    clock : str
        What was read: ``"cpu"`` is the processor time of this process, which other programs disturb little.
    """

    median: float
    low: float
    high: float
    repeats: int
    items: float
    item: str
    clock: str

    @property
    def each(self) -> float:
        """Seconds for one item; NaN where there are none."""
        return self.median / self.items if self.items else math.nan

    @property
    def scale(self) -> float:
        """What seconds for one item are multiplied by in tables and plots."""
        return 1e3 if self.item == FRAME else 1e9

    @property
    def rate(self) -> float:
        """Items per second; NaN where there is none."""
        return self.items / self.median if self.median > 0.0 and self.items else math.nan


@dataclass
class Record:
    """One method with one setting, on one data set.

    Attributes
    ----------
    data, group : str
        Data set, and the group of sets that are drawn in one picture; an empty group is not drawn.
    approximation : str
        What is approximated.
    method, setting : str
        Method, which gives the colour, and its setting.
    errors, costs : dict of str to Figure
        Such as ``{"max": Figure(0.01, "mm")}`` and ``{"size": Figure(1.4, "bytes/point")}``; less is better.
    times : dict of str to Timing
        By what is done.
    ours, default : bool
        Whether this is the program's own method, and its default.
    machine : str
        The ``name`` of the machine in the report's ``about``: times of two machines are never compared.
    front : list of str
        Keys of the axes on whose Pareto front this record lies among the records of its data set.
    """

    data: str
    group: str
    approximation: str
    method: str
    setting: str
    errors: dict[str, Figure]
    costs: dict[str, Figure] = field(default_factory=dict)
    times: dict[str, Timing] = field(default_factory=dict)
    ours: bool = False
    default: bool = False
    machine: str = ""
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
    """Two figures to be drawn against each other, less of both being better.

    Attributes
    ----------
    key : str
        Short name, part of the plots' file names.
    x, y : str
        Paths as :meth:`Record.value` takes them.
    x_label, y_label : str
        With units. Times are drawn in ns per item, those of pictures in ms per frame.
    series : bool
        A line for each method instead: ``y`` is how the names of several errors begin, which end in the numbers that
        they are drawn at; ``x`` is empty, and there is no front.
    alternatives : bool
        Whether one method is taken in place of another, so that one may be better. Where each adds something else there
        is no front, nothing beats the default, and all are drawn in rows beside it.
    """

    key: str
    x: str
    y: str
    x_label: str
    y_label: str
    series: bool = False
    alternatives: bool = True

    @property
    def has_front(self) -> bool:
        """Whether some records beat others."""
        return self.alternatives and not self.series


@dataclass(frozen=True)
class CaseResult:
    """What one named extreme case found.

    Attributes
    ----------
    system, name : str
        Part of the program, and the case.
    does, must : str
        What was done, and what must hold.
    measured : Figure
        NaN where it ended in an error that was not expected.
    limit : float
        What must hold does where ``measured`` is no larger.
    held : bool
    note : str
        What else is worth saying, such as an error's message.
    seconds : float
    """

    system: str
    name: str
    does: str
    must: str
    measured: Figure
    limit: float
    held: bool
    note: str = ""
    seconds: float = 0.0


@dataclass(frozen=True)
class LeftOut:
    """Something that was not measured, and the reason."""

    what: str
    reason: str


@dataclass
class StudyResult:
    """All that one study found.

    Attributes
    ----------
    name, title, approximates : str
        As of the study.
    notes : list of str
        Paragraphs that a reader needs: what was measured and how.
    axes : list of Axes
    records : list of Record
    left_out : list of LeftOut
    unavailable : str
        Why nothing could be measured; empty if it could.
    seconds : float
        How long the study took.
    cases : list of CaseResult
        Of a study of what holds rather than of what costs what.
    across : list of str
        Figures, as :meth:`Record.value` takes them, that one table shows of all data sets, method beside method.
    """

    name: str
    title: str
    approximates: str
    notes: list[str] = field(default_factory=list)
    axes: list[Axes] = field(default_factory=list)
    records: list[Record] = field(default_factory=list)
    left_out: list[LeftOut] = field(default_factory=list)
    unavailable: str = ""
    seconds: float = 0.0
    cases: list[CaseResult] = field(default_factory=list)
    across: list[str] = field(default_factory=list)
