"""From the scene's descriptions to what the page's templates show: texts, indices, steps and charts."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from pvfiblets.web.charts import histogram_chart, short, steps

WIDE = 1e3  # limits whose ends are farther apart than this, as a ratio, are for typing and not for a slider


def layer(found: Any) -> dict[str, Any]:
    """Return a line of the list of layers."""
    return {"id": found.id, "kind": found.kind, "name": found.name, "visible": found.visible}


def groups(described: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """Return properties under their headings; headings of which nothing matters now are left out."""
    found: dict[str, list[dict[str, Any]]] = {}
    for item in described:
        found.setdefault(item["group"], []).append(control(item))
    return [
        {"title": title, "properties": items}
        for title, items in found.items()
        if any(item["matters"] for item in items)
    ]


def control(item: Mapping[str, Any]) -> dict[str, Any]:
    """Return a property with what its control needs beside the description."""
    shown = {name: item[name] for name in ("name", "type", "label", "help", "optional", "read_only", "matters")}
    value, effective, limits = item["value"], item["effective"], item["limits"]
    shown |= {"value": value, "effective": effective, "limits": limits}
    if limits is not None:
        shown["step"] = 1.0 if item["whole"] else steps(limits)
        low, high = limits
        shown["wide"] = bool(low > 0.0 and high / low > WIDE)
        if not (math.isfinite(low) and math.isfinite(high) and low < high):
            shown["limits"] = None
    kind = item["type"]
    if item["read_only"]:
        shown["shown"] = str(effective)
    elif kind == "choice":
        values = [choice["value"] for choice in item["choices"]]
        shown["items"] = [{"title": choice["title"], "value": i} for i, choice in enumerate(item["choices"])]
        shown["index"] = values.index(value) if value in values else None
    elif kind == "number":
        shown["shown"] = "" if value is None else short(value)
        if effective is None and shown["limits"] is not None:
            shown["effective"] = shown["limits"][0]
    elif kind == "range":
        ends = effective if effective is not None else limits
        shown["effective"] = ends
        shown["ends"] = [short(end) for end in ends] if ends is not None else ["", ""]
    elif kind == "numbers":
        shown["shown"] = "" if value is None else ", ".join(map(short, value))
    elif kind == "colour":
        shown["shown"] = effective or "#808080"
    else:
        shown["shown"] = "" if value is None else str(value)
    return shown


def range_chart(scene: Any, layer_id: str) -> str:
    """Return the histogram of what the chosen layer is coloured by, or nothing where it has one colour."""
    if not layer_id:
        return ""
    for item in scene.properties(layer_id):
        if item["name"] == "clim" and not item["matters"]:
            return ""
    try:
        return histogram_chart(scene.histogram(layer_id)["counts"])
    except (KeyError, ValueError, TypeError):
        return ""  # colours that stand for no numbers


def typed(text: str, name: str, *, optional: bool) -> float | None:
    """Return a number that somebody typed; a comma may stand for the point."""
    text = str(text).strip().replace(",", ".").removesuffix("mm").strip()
    if not text and optional:
        return None
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise ValueError(f"{name}: {text[:40]!r} is not a number")
    return value


def info(scene: Any, layer_id: str) -> list[dict[str, Any]]:
    """Return the sections of the tab Info."""
    if not layer_id:
        return []
    sections, plain = [], []
    for name, value in scene.info(layer_id).items():
        if isinstance(value, Mapping):
            rows = [[_title(key), _text(item)] for key, item in value.items() if item is not None]
            if rows:
                sections.append({"title": _title(name), "rows": rows})
        elif value is not None:
            plain.append([_title(name), _text(value)])
    return [{"title": "Layer", "rows": plain}, *sections] if plain else sections


def _title(name: object) -> str:
    return str(name).replace("_", " ")


def _text(value: Any) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, (int, np.integer)):
        return f"{int(value):,}"
    if isinstance(value, (float, np.floating)):
        return short(float(value))
    if isinstance(value, Mapping):
        return "; ".join(f"{_title(key)}: {_text(item)}" for key, item in list(value.items())[:40])
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if isinstance(value, (list, tuple)):
        more = ", …" if len(value) > 40 else ""
        return ", ".join(_text(item) for item in list(value)[:40]) + more
    return str(value)[:400]
