"""The tab Filter."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets.web.actions import LineActions
from pvfiblets.web.panels.charts import short, steps
from pvfiblets.web.panels.describe import Charts, typed, typed_or_none
from pvfiblets.web.session.document import LINES, Layer, Source, volume_in

if TYPE_CHECKING:
    from pvfiblets.web.app import Explorer


class FilterActions(LineActions):
    """The filters of the chosen layer of an application's scene."""

    def __init__(self, app: Explorer, charts: Charts) -> None:
        super().__init__(app)
        self._charts = charts  # of the scene's values

    # What is shown

    def refresh(self) -> None:
        """Show the filters of the chosen layer."""
        page, scene = self._app.page, self._app.scene
        if not page.chosen or page.chosen_kind not in LINES:
            page.filters = {"regions": [], "criteria": []}
            return
        layer = self._layer
        arrays = scene.queries.arrays(layer.id)
        titles = {entry["name"]: entry["title"] for entry in arrays}
        actor = scene.actor(layer.id)
        filters = layer.filters
        amount = (filters.subset or {}).get("amount", 1.0)
        page.filters = {
            "layer": layer.id,
            "active": filters.active,
            "counted": self.counted(),
            "criteria": [self._criterion(layer, name, titles.get(name, name)) for name in filters.criteria],
            "more": [
                {"title": entry["title"], "value": entry["name"]}
                for entry in [*arrays, *({"title": title, "name": title} for title in self._images(layer))]
                if entry["name"] not in filters.criteria
            ],
            "groups": list(actor.fiblets.groups),
            "shown_groups": list(filters.groups or ()),
            "share": round(100.0 * amount) if amount <= 1.0 else 100,
            **self._app.regions.described(layer),
        }  # fmt: skip

    def counted(self) -> str:
        """Return how many streamlines of the chosen layer filters leave."""
        layer = self._layer
        actor = self._app.scene.actor(layer.id)
        total = actor.fiblets.n_streamlines
        left = int(np.count_nonzero(actor.shown)) if layer.filters.active else total
        return f"{left:,} of {total:,} streamlines"

    def _images(self, layer: Layer) -> dict[str, Source]:
        """Return the images that are open, by the names of criteria that compare their values."""
        named = [(title, volume_in(choice)) for choice, title in self._app.scene.volume_choices(layer)]
        return {title: source for title, source in named if source is not None}

    def _criterion(self, layer: Layer, name: str, title: str) -> dict[str, Any]:
        chart, limits = self._charts.chart_of(layer.id, name)
        low, high = layer.filters.criteria[name]
        value = [limits[0] if math.isinf(low) else low, limits[1] if math.isinf(high) else high]
        reach = [min(limits[0], value[0]), max(limits[1], value[1])]
        return {
            "name": name, "label": title, "chart": chart, "limits": reach, "value": value, "step": steps(reach),
            "shown": [short(end) for end in value],
        }  # fmt: skip

    # What is done

    def add(self, name: str) -> None:
        """Add a criterion that leaves all in that has a value."""
        app, layer = self._app, self._layer
        image = self._images(layer).get(name)
        if image is not None and name not in [entry["name"] for entry in app.scene.queries.arrays(layer.id)]:
            app.later(
                app.files.with_volume(image, lambda: app.scene.filters.set_filter(layer.id, name, image=image))
            )
            return
        low, high = self._charts.chart_of(layer.id, name)[1]
        app.scene.filters.set_filter(layer.id, name, low, high)

    def remove(self, name: str) -> None:
        """Take a criterion away."""
        self._app.scene.filters.remove_filter(self._layer.id, name)

    def clear(self) -> None:
        """Show all streamlines."""
        self._app.scene.filters.remove_filter(self._layer.id)

    def set_criterion(self, name: str, ends: Any) -> None:
        """Set the range of a criterion."""
        if not isinstance(ends, list) or len(ends) != 2:
            raise ValueError(f"{name}: expected two numbers")
        low, high = (typed(end, name) for end in ends)
        self._app.scene.filters.set_filter(self._layer.id, name, low, high)

    def set_end(self, name: str, end: int, text: str) -> None:
        """Set one end of a range to a number that was typed; nothing typed leaves it open."""
        layer = self._layer
        ends: list[float | None] = list(layer.filters.criteria[name])
        ends[1 if end else 0] = typed_or_none(text, name)
        low, high = (None if value is None or math.isinf(value) else value for value in ends)
        self._app.scene.filters.set_filter(layer.id, name, low, high)

    def set_groups(self, names: list[str]) -> None:
        """Show some groups only; none chosen shows all."""
        self._app.scene.filters.set_groups(self._layer.id, names or None)

    def set_share(self, share: float) -> None:
        """Show a random share of the streamlines, in per cent."""
        value = typed(str(share), "share")
        self._app.scene.filters.set_subset(self._layer.id, None if value is None or value >= 100 else value / 100.0)
