"""The tab Info: facts of a layer as tables, with units, largest sections first."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from pvfiblets.web.panels.charts import short

__all__ = ["tables"]

Table = dict[str, Any]
KINDS = {
    "tractogram": "tractogram", "selection": "part of a tractogram", "tubes": "tubes", "volume": "volume",
    "mesh": "surface",
}  # fmt: skip
TITLES = {
    "dtype": "Numbers", "n_points": "Points", "per_point": "Values per point", "spacing_mm": "Voxels, mm",
    "voxel_sizes": "Voxels, mm", "per_streamline": "Values per streamline", "groups": "Groups", "values": "Values",
    "missing": "Missing voxels", "gpu_bytes": "GPU memory", "milliseconds": "Last redraw, ms", "bytes": "In memory",
}  # fmt: skip
ERRORS = (("error_mm", "mm"), ("error_steps", "steps"), ("error_degrees", "degrees"))
SHARES = (("mean", "mean"), ("p99", "99 % below"), ("p999", "99.9 % below"), ("max", "largest"))
AXES = ("left – right", "back – front", "down – up")
MOST = 40  # parts of a value that are shown
_FOUR = 4


def tables(facts: Mapping[str, Any]) -> list[Table]:
    """Return the tables of a layer."""
    if not facts:
        return []
    of_file = dict(facts.get("facts") or {})
    affine = of_file.pop("affine", None)
    explained = dict(facts.get("explain") or {})
    found = [
        _pairs("Layer", _layer(facts)),
        _bounds(facts.get("bounds")),
        _errors(facts),
        _pairs("File", {_title(key): _text(value) for key, value in of_file.items() if _says(value) and key != "path"}),
        _affine(affine),
        _pairs("Groups", {name: _text(count) for name, count in list((facts.get("groups") or {}).items())[:MOST]}),
        _passes(explained.pop("passes", None)),
        _buffers(explained.pop("buffers", None)),
        _pairs("Drawing", {_title(key): _text(value) for key, value in explained.items() if _says(value)}, folded=True),
    ]
    return [table for table in found if table["rows"]]


def size_of(count: float) -> str:
    """Return a number of bytes, for people."""
    for unit in ("bytes", "kB", "MB"):
        if count < 1000.0:
            return f"{count:.4g} {unit}"
        count /= 1000.0
    return f"{count:.4g} GB"


def _layer(facts: Mapping[str, Any]) -> dict[str, str]:
    found = {"Name": str(facts["name"]), "Kind": KINDS.get(str(facts["kind"]), str(facts["kind"]))}
    if facts.get("path"):
        found["File"] = str(facts["path"])
    if (lines := facts.get("streamlines")) is not None:
        found["Streamlines"] = f"{lines['shown']:,} of {lines['total']:,} shown"
    if "points" in facts:
        found["Points"] = f"{facts['points']:,}"
    if (fiblets := facts.get("fiblets")) is not None:
        drawn = fiblets["drawn"]
        found["Fiblets"] = f"{fiblets['total']:,}" if drawn is None else f"{drawn:,} of {fiblets['total']:,} drawn"
    if "promise_mm" in facts:
        found["Points are within"] = f"{short(facts['promise_mm'])} mm of the file's"
    for key in ("bytes", "gpu_bytes"):
        if facts.get(key):
            found[_title(key)] = size_of(facts[key])
    if facts.get("milliseconds") is not None:
        found[_title("milliseconds")] = short(facts["milliseconds"])
    return found


def _bounds(bounds: Sequence[float] | None) -> Table:
    rows = []
    if bounds is not None and len(bounds) == 2 * len(AXES) and all(np.isfinite(bounds)):
        for axis, low, high in zip(AXES, bounds[::2], bounds[1::2], strict=True):
            rows.append([axis, short(low), short(high), short(high - low)])
    return _table("Extent", ("mm", "from", "to", "size"), rows)


def _errors(facts: Mapping[str, Any]) -> Table:
    """Return the error that was measured when the file was coded: a column for each unit."""
    units = [(key, unit) for key, unit in ERRORS if isinstance(facts.get(key), Mapping)]
    rows = []
    for share, title in SHARES:
        cells = [facts[key].get(share) for key, _ in units]
        if any(cell is not None for cell in cells):
            rows.append([title, *("–" if cell is None else short(cell) for cell in cells)])
    return _table("Measured error", ("", *(unit for _, unit in units)), rows)


def _affine(affine: Any) -> Table:
    rows: list[list[str]] = []
    matrix = None if affine is None else np.asarray(affine, np.float64)
    if matrix is not None and matrix.size == _FOUR * _FOUR:
        rows = [[short(float(value)) for value in row] for row in matrix.reshape(_FOUR, _FOUR)]
    return _table("Voxels to mm", ("i", "j", "k", "origin"), rows)


def _passes(passes: Any) -> Table:
    rows = [[str(one.get("name", "")).replace("_", " "), short(one.get("ms") or 0.0)] for one in passes or ()]
    return _table("Passes of the last redraw", ("Pass", "ms"), rows, folded=True)


def _buffers(buffers: Any) -> Table:
    rows = [[str(one.get("name", "")).replace("_", " "), size_of(one.get("bytes") or 0)] for one in buffers or ()]
    return _table("Buffers", (), rows, folded=True)


def _pairs(title: str, rows: Mapping[str, str], *, folded: bool = False) -> Table:
    return _table(title, (), [[name, value] for name, value in rows.items()], folded=folded)


def _table(title: str, columns: Sequence[str], rows: list[list[str]], *, folded: bool = False) -> Table:
    return {"title": title, "columns": list(columns), "rows": rows, "folded": folded}


def _says(value: Any) -> bool:
    return value is not None and not (isinstance(value, (str, Mapping, list, tuple)) and not value)


def _title(name: str) -> str:
    text = TITLES.get(name, name.replace("_", " "))
    return text[:1].upper() + text[1:]


def _text(value: Any) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, (int, np.integer)):
        return f"{int(value):,}"
    if isinstance(value, (float, np.floating)):
        return short(float(value))
    if isinstance(value, Mapping):
        return "; ".join(f"{str(key).replace('_', ' ')}: {_text(item)}" for key, item in list(value.items())[:MOST])
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if isinstance(value, (list, tuple)):
        more = ", …" if len(value) > MOST else ""
        return ", ".join(_text(item) for item in list(value)[:MOST]) + more
    return str(value)[:400]
