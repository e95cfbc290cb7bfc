"""A report, and the file that keeps it.

:meth:`Report.to_json` writes ``report.json``: ``format`` (a name and a version), ``about`` (machine, versions,
seed, date), and ``studies``. Each study has its ``records``, the pairs of figures to be plotted against each other
(``axes``), and ``left_out``, the skipped measurements with reasons. Numbers have six digits; null if not finite.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, is_dataclass
from os import PathLike
from pathlib import Path
from typing import Any, get_args, get_origin, get_type_hints

from pvfiblets.errors import FormatError

from .record import StudyResult

FORMAT = "pvfiblets report 1"
NAME = "report.json"
LISTED = ("records", "cases")  # one to a line; a file without cases is read as one whose studies have none
AS_WRITTEN = {"method": "way", "alternatives": "rivals"}  # fields whose names in files are older than those here
DIGITS = 6


@dataclass
class Report:
    """Measurements of one run."""

    about: dict[str, Any]  # Machine, versions, seed, date: what the numbers hold for (:mod:`.machine`)
    studies: list[StudyResult] = field(default_factory=list)

    def to_json(self) -> dict[str, Any]:
        """Return the report as what JSON can hold."""
        result: dict[str, Any] = _plain(
            {"format": FORMAT, "about": self.about, "studies": [_as_written(study) for study in self.studies]}
        )
        return result

    @classmethod
    def from_json(cls, data: Mapping[str, Any], path: str | PathLike[str] = "report") -> Report:
        """Undo :meth:`to_json`."""
        if not isinstance(data, Mapping) or data.get("format") != FORMAT:
            found = data.get("format") if isinstance(data, Mapping) else type(data).__name__
            raise FormatError(path, None, f"the format {found!r}", f"{FORMAT!r}, as `pvfiblets report` writes it")
        try:
            return cls(dict(data["about"]), _made(list[StudyResult], data["studies"]))
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
        """Read a ``report.json``, or the one in a folder."""
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


def _made(kind: Any, value: Any) -> Any:
    """Return a value of a type from its plain form in a file: a dataclass, a list or dict of some, or a number."""
    inner = get_args(kind)
    if get_origin(kind) is list:
        return [_made(inner[0], item) for item in value]
    if get_origin(kind) is dict:
        return {key: _made(inner[1], item) for key, item in value.items()}
    if isinstance(kind, type) and is_dataclass(kind):
        here, kinds = {written: name for name, written in AS_WRITTEN.items()}, get_type_hints(kind)
        fields = {here.get(name, name): item for name, item in value.items()}
        return kind(**{name: _made(kinds[name], item) for name, item in fields.items()})
    if kind is float:
        return math.nan if value is None else float(value)
    return value
