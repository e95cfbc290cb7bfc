"""Names and colours of labels: tables of FreeSurfer, MRtrix, ITK-SNAP, BIDS and GIFTI."""

from __future__ import annotations

import csv
import os
import re
import warnings
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from pvfiblets.errors import FormatError

SUFFIXES = (".txt", ".ctab", ".label", ".lbl", ".tsv", ".gii", ".gii.gz")

_NUMBER = r"((?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)"
_ITKSNAP = re.compile(r'^\s*(\d{1,18})' + 4 * rf"\s+{_NUMBER}" + r'\s+([01])\s+([01])\s+"(.*)"\s*$')
_FREESURFER = re.compile(r"^\s*(-?\d{1,18})\s+(\S.*?)" + 3 * rf"\s+{_NUMBER}" + rf"(?:\s+{_NUMBER})?\s*$")
_WORD = r"""("[^"]*"|'[^']*'|\S+)"""
_MRTRIX = re.compile(rf"^\s*(\d{{1,18}})\s+{_WORD}\s+{_WORD}" + 4 * rf"\s+{_NUMBER}" + r"\s*$")


@dataclass
class LabelTable:
    """Names and colours of labels.

    Attributes
    ----------
    names : dict of int to str
    colours : dict of int to tuple
        Red, green, blue, opacity, from 0 to 255. Labels that are missing have colours of their own making.
    """

    names: dict[int, str] = field(default_factory=dict)
    colours: dict[int, tuple[int, int, int, int]] = field(default_factory=dict)

    def name(self, label: int) -> str:
        """Return a label's name; its number if it has none."""
        return self.names.get(label, str(label))

    def rows(self, labels: npt.NDArray[np.int64]) -> npt.NDArray[np.uint8]:
        """Return ``(n, 4)`` colours of labels; label 0 is always transparent."""
        found = distinct_colours(labels)
        for row, label in enumerate(labels.tolist()):
            if label in self.colours:
                found[row] = self.colours[label]
        found[labels == 0, 3] = 0
        return found


def distinct_colours(labels: npt.NDArray[np.int64]) -> npt.NDArray[np.uint8]:
    """Return ``(n, 4)`` colours that differ much between labels that follow each other, the same for the same label."""
    turn = (np.asarray(labels, np.float64) * 0.61803398875) % 1.0  # the golden ratio: hues far apart
    step = np.asarray(labels, np.int64) % 3
    value, saturation = np.array([1.0, 0.8, 0.95])[step], np.array([0.75, 0.85, 0.5])[step]
    wave = np.clip(abs((turn[:, None] * 6.0 + np.array([0.0, 4.0, 2.0])) % 6.0 - 3.0) - 1.0, 0.0, 1.0)
    rgb = value[:, None] * (1.0 - saturation[:, None] * (1.0 - wave))
    out = np.full((len(turn), 4), 255, np.uint8)
    out[:, :3] = np.rint(255.0 * rgb)
    return out


def as_label_table(given: Any) -> LabelTable:
    """Take a table of labels from a file, a mapping, or as it is."""
    if isinstance(given, LabelTable):
        return given
    if isinstance(given, Mapping):
        return _of_mapping(given)
    if not isinstance(given, (str, os.PathLike)):
        raise TypeError(
            f"labels is a {type(given).__name__}; give the path of a table of FreeSurfer, MRtrix, ITK-SNAP, BIDS or "
            "GIFTI, or a dict such as {17: 'hippocampus'}"
        )
    path = Path(given).expanduser()
    if path.name.lower().endswith((".gii", ".gii.gz")):
        return _of_gifti(path)
    text = path.read_text(encoding="utf-8", errors="replace")
    table = _of_bids(path, text) if path.name.lower().endswith(".tsv") else _of_lines(path, text)
    if not table.names and not table.colours:
        raise FormatError(
            path, None, "no line of a table of labels",
            "lines 'number name R G B A' (FreeSurfer), 'number abbreviation name R G B A' (MRtrix), 'number R G B A "
            "visible mesh \"name\"' (ITK-SNAP), or a .tsv with the columns index and name (BIDS)",
        )  # fmt: skip
    return table


def _of_mapping(given: Mapping[Any, Any]) -> LabelTable:
    from pyvista import Color

    table = LabelTable()
    for label, said in given.items():
        name, colour = said if isinstance(said, tuple) and len(said) == 2 else (said, None)
        if not isinstance(name, str) or (colour is None and name.startswith("#")):
            name, colour = None, said
        if name is not None:
            table.names[int(label)] = name
        if colour is not None:
            red, green, blue, alpha = Color(colour).int_rgba
            table.colours[int(label)] = red, green, blue, alpha
    return table


def _of_lines(path: Path, text: str) -> LabelTable:
    """Return a table of FreeSurfer, MRtrix or ITK-SNAP, whichever its lines are."""
    lines = [(n, line) for n, line in enumerate(text.splitlines(), 1) if line.strip() and line.lstrip()[0] != "#"]
    with_abbreviation = _have_abbreviations([line for _, line in lines])
    table, unread = LabelTable(), []
    colours: dict[int, Sequence[str]] = {}
    opacities: dict[int, float] = {}
    for number, line in lines:
        if found := _ITKSNAP.match(line):
            label, name, colour = int(found[1]), found[8], found.group(2, 3, 4)
            opacities[label] = 255.0 * float(found[5]) if found[6] == "1" else 0.0
        elif with_abbreviation and (found := _MRTRIX.match(line)):
            label, name, colour = int(found[1]), found[3].strip("\"'"), found.group(4, 5, 6)
            opacities[label] = float(found[7]) * (255.0 if _are_shares([found.group(4, 5, 6, 7)]) else 1.0)
        elif found := _FREESURFER.match(line):
            # Its last column is 255 less the opacity in some versions and 0 for opaque in all that are used.
            label, name, colour = int(found[1]), found[2], found.group(3, 4, 5)
            opacities[label] = 255.0
        else:
            unread.append(number)
            continue
        table.names[label], colours[label] = name, colour
    all_shares = _are_shares(colours.values())  # a row such as 1 0 0 alone is ambiguous
    for label, parts in colours.items():
        full = 255.0 if all_shares or _are_shares([parts]) else 1.0
        red, green, blue = (float(part) * full for part in parts)
        table.colours[label] = _bytes(red, green, blue, opacities[label])
    if unread and table.names:
        which = ", ".join(map(str, unread[:5])) + (f" and {len(unread) - 5} more" if len(unread) > 5 else "")
        first = text.splitlines()[unread[0] - 1].strip()
        warnings.warn(
            f"{path}: left out line {which}, which names no label: {first[:60]!r}; give 'number name R G B A'",
            UserWarning,
            stacklevel=3,
        )
    return table


def _have_abbreviations(lines: list[str]) -> bool:
    """Return True for a table of MRtrix, by MRtrix's rule: two names in each line, the first ones shorter."""
    found = [match for line in lines if (match := _MRTRIX.match(line))]
    opaque = any(float(match[7]) > 0.0 for match in found)  # FreeSurfer has 0 there, and names of two words
    return opaque and 2 * len(found) > len(lines) and sum(len(m[2]) - len(m[3]) for m in found) < 0


def _are_shares(colours: Iterable[Sequence[str]]) -> bool:
    """Return True for colours in fractions of 1, not numbers up to 255."""
    parts = [part for colour in colours for part in colour]
    return any("." in part for part in parts) and all(float(part) <= 1.0 for part in parts)


def _bytes(*parts: float) -> tuple[int, int, int, int]:
    red, green, blue, alpha = (min(max(round(part), 0), 255) for part in parts)
    return red, green, blue, alpha


def _of_bids(path: Path, text: str) -> LabelTable:
    try:
        rows = list(csv.DictReader(text.splitlines(), delimiter="\t"))
    except csv.Error as error:
        raise FormatError(path, None, f"no table ({error})", "lines whose columns are separated by tabs") from None
    columns = {str(name).strip().lower(): name for name in (rows[0] if rows else {})}
    index, name = (next((columns[one] for one in many if one in columns), None) for many in (
        ("index", "label", "id", "value"), ("name", "abbreviation", "region", "mapping"),
    ))  # fmt: skip
    if index is None or name is None:
        found = ", ".join(columns) or "none"
        raise FormatError(path, None, f"the columns {found}", "the columns index and name, as of BIDS")
    colour = next((columns[one] for one in ("color", "colour") if one in columns), None)
    table = LabelTable()
    for row in rows:
        word = str(row[index]).strip()
        if not re.fullmatch(r"-?\d{1,18}(\.0*)?", word):
            raise FormatError(path, None, f"index {word!r}", "a whole number")
        label = int(word.partition(".")[0])
        table.names[label] = str(row[name]).strip()
        if colour is not None and (hexes := re.fullmatch(r"#?([0-9a-fA-F]{6})", str(row[colour]).strip())):
            red, green, blue = bytes.fromhex(hexes[1])
            table.colours[label] = red, green, blue, 255
    return table


def _of_gifti(path: Path) -> LabelTable:
    from pvfiblets.volumes.gifti_files import read_gifti

    return table_of_gifti(path, read_gifti(path))


def table_of_gifti(path: Path, image: Any) -> LabelTable:
    """Return the table of labels of a file of GIFTI that was read; FormatError if it has none."""
    table = LabelTable()
    for one in getattr(getattr(image, "labeltable", None), "labels", ()):
        table.names[int(one.key)] = str(one.label)
        if None not in (one.red, one.green, one.blue):
            parts = (one.red, one.green, one.blue, 1.0 if one.alpha is None else one.alpha)
            red, green, blue, alpha = (round(255 * min(max(float(part), 0.0), 1.0)) for part in parts)
            table.colours[int(one.key)] = red, green, blue, alpha
    if not table.names:
        raise FormatError(path, None, "no table of labels", "a GIFTI file with one, such as .label.gii")
    return table
