"""The one form of all measurements, and the file that keeps them.

``report.json`` is what :meth:`Report.to_json` writes: ``format`` (a name and a version), ``about`` (machine, versions,
seed, date), and ``studies``. Each study has its ``records``, the pairs of figures to be plotted against each other
(``axes``), and what was ``left_out`` and why. Numbers are written with six digits, those that are not finite as null.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from os import PathLike
from pathlib import Path
from typing import Any

from pvfiblets.errors import FormatError

__all__ = ["FORMAT", "FRAME", "Axes", "CaseResult", "Figure", "LeftOut", "Record", "Report", "StudyResult", "Timing"]

FORMAT = "pvfiblets report 1"
NAME = "report.json"
LISTED = ("records", "cases")  # one to a line; a file without cases is read as one whose studies have none
FRAME = "frame"  # the item of pictures
AS_WRITTEN = {"method": "way", "alternatives": "rivals"}  # fields whose names in files are older than those here
DIGITS = 6


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
        Such as ``"point"``. Times of a ``"frame"`` are told in ms, of all else in ns.
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
        """What seconds for one item are multiplied by to be told."""
        return 1e3 if self.item == FRAME else 1e9

    @property
    def rate(self) -> float:
        """Items per second; NaN where none can be told."""
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
        """Return one number.

        Parameters
        ----------
        path : str
            ``"errors/NAME"``, ``"costs/NAME"``, or ``"times/NAME"`` for the seconds that one item takes.

        Returns
        -------
        float
            NaN where this record has no such figure.
        """
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


@dataclass
class Report:
    """Measurements of one run.

    Attributes
    ----------
    about : dict
        Machine, versions, seed, date: what the numbers hold for (:mod:`.machine`).
    studies : list of StudyResult
    """

    about: dict[str, Any]
    studies: list[StudyResult] = field(default_factory=list)

    def to_json(self) -> dict[str, Any]:
        """Return the report as what JSON can hold."""
        result: dict[str, Any] = _plain(
            {"format": FORMAT, "about": self.about, "studies": [_as_written(study) for study in self.studies]}
        )
        return result

    @classmethod
    def from_json(cls, data: Mapping[str, Any], path: str | PathLike[str] = "report") -> Report:
        """Undo :meth:`to_json`.

        Raises
        ------
        FormatError
            If this is no report, or one of another version; the error names ``path``.
        """
        if not isinstance(data, Mapping) or data.get("format") != FORMAT:
            found = data.get("format") if isinstance(data, Mapping) else type(data).__name__
            raise FormatError(path, None, f"the format {found!r}", f"{FORMAT!r}, as `pvfiblets report` writes it")
        try:
            return cls(dict(data["about"]), [_study(study) for study in data["studies"]])
        except (KeyError, TypeError, AttributeError) as error:
            raise FormatError(
                path, None, f"a report that lacks or adds something ({error})", "one as written"
            ) from error

    def save(self, folder: str | PathLike[str]) -> Path:
        """Write ``report.json`` into a folder, which is made if there is none, and return its path."""
        path = Path(folder) / NAME
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(_text(self.to_json()), encoding="utf-8")
        return path

    @classmethod
    def load(cls, path: str | PathLike[str]) -> Report:
        """Read a ``report.json``, or the one in a folder.

        Raises
        ------
        FormatError
            If it is not one.
        """
        file = Path(path)
        if file.is_dir():
            file = file / NAME
        try:
            data = json.loads(file.read_text(encoding="utf-8"))
        except ValueError as error:
            raise FormatError(file, None, f"text that is not JSON ({error})", "a report.json") from error
        return cls.from_json(data, file)


def _text(plain: dict[str, Any]) -> str:
    """JSON with a line for each record: small, and what a new run changed can be seen."""

    def one(value: Any, **rest: Any) -> str:
        return json.dumps(value, allow_nan=False, ensure_ascii=False, **rest)

    parts = []
    for study in plain["studies"]:
        rest = one({name: value for name, value in study.items() if name not in LISTED})
        for name in LISTED:
            rows = ",\n".join(one(row) for row in study[name])
            rest = f'{rest[:-1]}, "{name}": [\n{rows}\n]}}' if rows or name == "records" else rest
        parts.append(rest)
    studies = ",\n".join(parts)
    about = one(plain["about"], indent=1)
    return f'{{"format": {one(plain["format"])},\n"about": {about},\n"studies": [\n{studies}\n]}}\n'


def _plain(value: Any) -> Any:
    if isinstance(value, dict):
        return {str(key): _plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    if isinstance(value, float):  # NumPy's float64 as well
        return float(f"{value:.{DIGITS}g}") if math.isfinite(value) else None
    return value


def _as_written(study: StudyResult) -> dict[str, Any]:
    """Return a study under the names that files have."""
    plain = asdict(study)
    for key in ("axes", "records"):
        plain[key] = [{AS_WRITTEN.get(name, name): value for name, value in row.items()} for row in plain[key]]
    return plain


def _as_named(data: Mapping[str, Any]) -> dict[str, Any]:
    """Undo the names of a file."""
    here = {written: name for name, written in AS_WRITTEN.items()}
    return {here.get(name, name): value for name, value in data.items()}


def _number(value: float | None) -> float:
    return math.nan if value is None else float(value)


def _figures(data: Mapping[str, Any]) -> dict[str, Figure]:
    return {name: Figure(_number(figure["value"]), figure["unit"]) for name, figure in data.items()}


def _timing(data: Mapping[str, Any]) -> Timing:
    numbers = {name: _number(data[name]) for name in ("median", "low", "high", "items")}
    return Timing(repeats=int(data["repeats"]), item=data["item"], clock=data["clock"], **numbers)


def _record(data: Mapping[str, Any]) -> Record:
    inner: dict[str, Any] = {
        "errors": _figures(data["errors"]),
        "costs": _figures(data["costs"]),
        "times": {name: _timing(timing) for name, timing in data["times"].items()},
    }
    return Record(**{**_as_named(data), **inner})


def _case(data: Mapping[str, Any]) -> CaseResult:
    measured = Figure(_number(data["measured"]["value"]), data["measured"]["unit"])
    return CaseResult(**{**data, "measured": measured, "limit": _number(data["limit"])})


def _study(data: Mapping[str, Any]) -> StudyResult:
    lists: dict[str, Any] = {
        "axes": [Axes(**_as_named(axes)) for axes in data["axes"]],
        "records": [_record(record) for record in data["records"]],
        "left_out": [LeftOut(**item) for item in data["left_out"]],
        "cases": [_case(item) for item in data.get("cases", [])],
    }
    return StudyResult(**{**data, **lists})
