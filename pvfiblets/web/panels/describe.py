"""Data of the page's templates, from the scene's descriptions: texts, indices, steps and charts."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from pvfiblets.web.panels.charts import histogram_chart, short, steps
from pvfiblets.web.session.document import volume_in

MOST_CHARTS = 64
WIDE = 1e3  # limits whose ends are farther apart than this, as a ratio, are for typing and not for a slider


def layer(found: Any) -> dict[str, Any]:
    """Return a line of the list of layers."""
    return {"id": found.id, "kind": found.kind, "name": found.name, "visible": found.visible}


def groups(described: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """Return properties under their headings; headings without a relevant property are left out."""
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
        found = "auto" if effective is None else f"auto: {short(effective)}"
        shown["automatic"] = found if item["optional"] else ""
        if effective is None and shown["limits"] is not None:
            shown["effective"] = shown["limits"][0]
    elif kind == "range":
        ends = effective if effective is not None else limits
        shown["effective"] = ends
        shown["ends"] = [short(end) for end in ends] if ends is not None else ["", ""]
    elif kind == "numbers":
        shown["shown"] = "" if value is None else ", ".join(map(short, value))
        shown["one"] = effective[0] if effective is not None and len(effective) == 1 else None
    elif kind == "colour":
        shown["shown"] = effective or "#808080"
    else:
        shown["shown"] = "" if value is None else str(value)
    return shown


class Charts:
    """Histograms of a scene's values, kept: they are of the data, which does not change."""

    def __init__(self, scene: Any) -> None:
        self._scene = scene  # whose layers they are of
        self._kept: dict[tuple[Any, ...], tuple[str, list[float]]] = {}

    def chart_of(self, layer_id: str, name: str) -> tuple[str, list[float]]:
        """Return the chart of a layer's values, and between which they lie."""
        found = self._scene.layer(layer_id)
        array = found.filters.images.get(name, name)
        return self._chart((found.source, found.kind, array), lambda: self._scene.queries.histogram(layer_id, array))

    def of_range(self, layer_id: str) -> str:
        """Return the chart of what colours a layer; nothing where colours stand for no numbers."""
        if not layer_id:
            return ""
        found = self._scene.layer(layer_id)
        names = [entry["name"] for entry in self._scene.queries.arrays(layer_id)]
        name = found.settings.get("scalars")
        if (volume := volume_in(name)) is not None:
            return self._chart((volume, "colours", ""), lambda: self._scene.queries.histogram(layer_id))[0]
        if found.kind in ("volume", "image") and names:
            name = names[0]
        return self.chart_of(layer_id, name)[0] if name in names else ""

    def _chart(self, key: tuple[Any, ...], count: Callable[[], dict[str, Any]]) -> tuple[str, list[float]]:
        if key not in self._kept:
            if len(self._kept) >= MOST_CHARTS:
                self._kept.pop(next(iter(self._kept)))
            counted = count()
            self._kept[key] = histogram_chart(counted["counts"]), [counted["edges"][0], counted["edges"][-1]]
        return self._kept[key]


def typed(text: str, name: str) -> float:
    """Return a number that somebody typed; a comma may stand for the point."""
    given = _number_text(text)
    try:
        value = float(given)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise ValueError(f"{name}: {given[:40]!r} is not a number")
    return value


def typed_or_none(text: str, name: str) -> float | None:
    """Return a number that somebody typed, or None where nothing is."""
    return typed(text, name) if _number_text(text) else None


def _number_text(text: str) -> str:
    return str(text).strip().replace(",", ".").removesuffix("mm").strip()
