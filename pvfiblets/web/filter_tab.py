"""The tab Filter."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from pvfiblets.plotting.fiblets.volume_sources import SUFFIXES as LABELS
from pvfiblets.web.actions import Actions
from pvfiblets.web.charts import short, steps
from pvfiblets.web.controls import controls, moved
from pvfiblets.web.describe import Charts, typed
from pvfiblets.web.document import LINES
from pvfiblets.web.shapes import HOWS


class FilterActions(Actions):
    """The filters of the chosen layer of an application's scene.

    Parameters
    ----------
    app : Explorer
        Whose scene and page these act on.
    charts : Charts
        Of the scene's values.
    """

    def __init__(self, app: Any, charts: Charts) -> None:
        super().__init__(app)
        self._charts = charts

    @property
    def _layer(self) -> Any:
        """The chosen layer, which must be of lines."""
        page = self._app.page
        if not page.chosen or page.chosen_kind not in LINES:
            raise ValueError("choose a tractogram first")
        return self._app.scene.layer(page.chosen)

    # What is shown

    def refresh(self) -> None:
        """Show the filters of the chosen layer."""
        page, scene = self._app.page, self._app.scene
        if not page.chosen or page.chosen_kind not in LINES:
            page.filters = {"regions": [], "criteria": []}
            return
        layer = self._layer
        arrays = scene.arrays(layer.id)
        titles = {entry["name"]: entry["title"] for entry in arrays}
        actor = scene.actor(layer.id)
        filters = layer.filters
        amount = (filters.subset or {}).get("amount", 1.0)
        try:
            join, regions = _flat(filters.regions)
        except ValueError:  # nested, by a session file: they hold, and whoever edits them is told so
            join, regions = "and", []
        bounds = self._app.plotter.bounds
        page.filters = {
            "layer": layer.id,
            "active": filters.active,
            "counted": self.counted(),
            "criteria": [self._criterion(layer, name, titles.get(name, name)) for name in filters.criteria],
            "more": [
                {"title": entry["title"], "value": entry["name"]}
                for entry in arrays
                if entry["name"] not in filters.criteria
            ],
            "groups": list(actor.fiblets.groups),
            "shown_groups": list(filters.groups or ()),
            "share": round(100.0 * amount) if amount <= 1.0 else 100,
            "join": join,
            "hows": [{"title": title, "value": how} for how, title in HOWS.items()],
            "regions": [
                {
                    "not": row["not"], "how": row["how"], "kind": row["region"]["kind"],
                    "controls": controls(row["region"], bounds),
                    "file": row["region"].get("path", "").rpartition("/")[2],
                    "labels": ", ".join(map(str, row["region"].get("labels") or ())),
                }
                for row in regions
            ],
        }  # fmt: skip

    def counted(self) -> str:
        """Say how many streamlines of the chosen layer filters leave."""
        layer = self._layer
        actor = self._app.scene.actor(layer.id)
        total = actor.fiblets.n_streamlines
        left = int(np.count_nonzero(actor.shown)) if layer.filters.active else total
        return f"{left:,} of {total:,} streamlines"

    def _criterion(self, layer: Any, name: str, title: str) -> dict[str, Any]:
        chart, limits = self._charts.of(layer.id, name)
        low, high = layer.filters.criteria[name]
        value = [limits[0] if math.isinf(low) else low, limits[1] if math.isinf(high) else high]
        reach = [min(limits[0], value[0]), max(limits[1], value[1])]
        return {
            "name": name, "label": title, "chart": chart, "limits": reach, "value": value, "step": steps(reach),
            "shown": [short(end) for end in value],
        }  # fmt: skip

    # What is done

    def add(self, name: str) -> None:
        """Add a criterion that leaves all in."""
        layer = self._layer
        low, high = self._charts.of(layer.id, name)[1]
        self._app.scene.set_filter(layer.id, name, low, high)

    def remove(self, name: str) -> None:
        """Take a criterion away."""
        self._app.scene.remove_filter(self._layer.id, name)

    def clear(self) -> None:
        """Show all streamlines."""
        self._app.scene.remove_filter(self._layer.id)

    def set_criterion(self, name: str, ends: Any) -> None:
        """Set the range of a criterion."""
        if not isinstance(ends, list) or len(ends) != 2:
            raise ValueError(f"{name}: expected two numbers")
        low, high = (typed(end, name, optional=False) for end in ends)
        self._app.scene.set_filter(self._layer.id, name, low, high)

    def set_end(self, name: str, end: int, text: str) -> None:
        """Set one end of a range to a number that was typed; nothing typed leaves it open."""
        layer = self._layer
        ends: list[float | None] = list(layer.filters.criteria[name])
        ends[1 if end else 0] = typed(text, name, optional=True)
        low, high = (None if value is None or math.isinf(value) else value for value in ends)
        self._app.scene.set_filter(layer.id, name, low, high)

    def set_groups(self, names: list[str]) -> None:
        """Show some groups only; none chosen shows all."""
        self._app.scene.set_groups(self._layer.id, names or None)

    def set_share(self, share: float) -> None:
        """Show a random share of the streamlines, in per cent."""
        value = typed(str(share), "share", optional=False)
        self._app.scene.set_subset(self._layer.id, None if value is None or value >= 100 else value / 100.0)

    # Regions: a flat list, each with or without 'not', joined by one word

    def add_region(self, kind: str) -> None:
        """Add a region in the middle of what is shown."""
        if kind not in ("sphere", "box"):
            raise ValueError(f"there is no region {kind!r}; choose sphere or box")
        region = self._app.scene.usual_shape(kind)
        self._edit(lambda rows: rows.append({"not": False, "how": "passes", "region": region}))

    def add_file(self, path: str) -> None:
        """Add the region of a closed mesh, or of the labels of a volume, which is read beside everything else."""
        layer = self._layer
        kind = "labels" if path.lower().endswith(LABELS) else "mesh"
        region = {"kind": kind, "path": path} | ({"labels": None} if kind == "labels" else {})

        def add() -> None:
            self._edit(lambda rows: rows.append({"not": False, "how": "passes", "region": region}), layer)

        self._app.later(self._app.files.with_shape(kind, path, add))

    def set_labels(self, row: int, text: str) -> None:
        """Choose the labels of a region by their numbers, between commas; none chosen are all but 0."""
        parts = [part for part in str(text).replace(";", ",").replace(" ", ",").split(",") if part]
        labels = [typed(part, "labels", optional=False) for part in parts] or None

        def change(rows: list[dict[str, Any]]) -> None:
            found = rows[_index(rows, row)]
            if found["region"]["kind"] != "labels":
                raise ValueError(f"a region of the kind {found['region']['kind']} has no labels")
            found["region"] = {**found["region"], "labels": labels}

        self._edit(change)

    def drop_region(self, row: int) -> None:
        """Take a region away."""
        self._edit(lambda rows: rows.pop(_index(rows, row)))

    def set_not(self, row: int, negated: bool) -> None:
        """Ask for streamlines of which it is not so."""
        self._edit(lambda rows: rows[_index(rows, row)].update({"not": bool(negated)}))

    def set_how(self, row: int, how: str) -> None:
        """Choose what streamlines do in a region."""
        self._edit(lambda rows: rows[_index(rows, row)].update({"how": how}))

    def set_region(self, row: int, name: str, value: Any) -> None:
        """Move a region's slider."""

        def change(rows: list[dict[str, Any]]) -> None:
            found = rows[_index(rows, row)]
            found["region"] = {**found["region"], **moved(found["region"], name, value)}

        self._edit(change)

    def set_join(self, word: str) -> None:
        """Ask for all of the regions, or for any."""
        layer = self._layer
        _, rows = _flat(layer.filters.regions)
        self._app.scene.set_regions(layer.id, _condition("or" if word == "or" else "and", rows))

    def _edit(self, change: Any, layer: Any = None) -> None:
        layer = self._layer if layer is None else self._app.scene.layer(layer.id)
        join, rows = _flat(layer.filters.regions)
        change(rows)
        self._app.scene.set_regions(layer.id, _condition(join, rows))


def _index(rows: list[Any], row: Any) -> int:
    if isinstance(row, bool) or not isinstance(row, int) or not 0 <= row < len(rows):
        raise ValueError(f"there is no region {row!r}")
    return row


def _flat(condition: Any) -> tuple[str, list[dict[str, Any]]]:
    """Return a condition as the word that joins it and its rows."""
    if condition is None:
        return "and", []
    parts, join = [condition], "and"
    if condition.get("op") in ("and", "or"):
        parts, join = list(condition["of"]), condition["op"]
    rows = []
    for part in parts:
        negated = part.get("op") == "not"
        inner = part["of"][0] if negated else part
        if "op" in inner:
            raise ValueError("these regions are nested deeper than this panel shows; they stay as they are")
        rows.append({"not": negated, "how": inner["how"], "region": dict(inner["region"])})
    return join, rows


def _condition(join: str, rows: list[dict[str, Any]]) -> dict[str, Any] | None:
    parts: list[dict[str, Any]] = []
    for row in rows:
        part = {"how": row["how"], "region": row["region"]}
        parts.append({"op": "not", "of": [part]} if row["not"] else part)
    return None if not parts else {"op": join, "of": parts}
