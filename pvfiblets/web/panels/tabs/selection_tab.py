"""The tools over the picture and the tab Selection."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from pvfiblets.plotting.colours.scalars import UNITS
from pvfiblets.web.actions import Actions
from pvfiblets.web.panels.charts import profile_chart, short
from pvfiblets.web.panels.csv_tables import profile_csv
from pvfiblets.web.server.rpc_allowlist import number

if TYPE_CHECKING:
    from pvfiblets.web.app import Explorer
    from pvfiblets.web.session.document import Layer

ROWS = 200
CLICK = 3.0  # pixels: a shorter drag is a click


class SelectionActions(Actions):
    """Picking and the selection of an application's scene."""

    def __init__(self, app: Explorer) -> None:
        super().__init__(app)
        self._profile: str | None = None
        self._begin: list[float] | None = None  # the first of two clicks of the tool that measures, mm
        self._shown: Any = None

    # Tools

    def point(self, tool: str, places: Any, add: bool) -> bool:
        """Apply a tool over the picture; return True if the tool needs another click."""
        if not isinstance(places, list) or not 1 <= len(places) <= 501:
            raise ValueError("a tool needs places in the picture")
        width, height = self._app.stream.settle()
        pixels = []
        for place in places:
            if not isinstance(place, list) or len(place) != 2:
                raise ValueError("a place in the picture is two numbers")
            x, y = (number(part, 0.0, 1.0) for part in place)
            pixels.append((x * (width - 1), (1.0 - y) * (height - 1)))
        mode = "add" if add is True else "replace"
        scene = self._app.scene
        if tool == "measure":
            far = max(abs(end - begin) for begin, end in zip(pixels[0], pixels[-1], strict=True))
            return self._measure(pixels[-1:] if far < CLICK else [pixels[0], pixels[-1]])
        if tool == "place":
            self._app.regions.place(*pixels[-1])
            return False
        far = max(abs(pixels[-1][0] - pixels[0][0]), abs(pixels[-1][1] - pixels[0][1]))
        if tool == "pick" or (tool == "box" and far < CLICK) or (tool == "lasso" and len(pixels) < 3):
            if self._app.matrix.pick(*pixels[-1]):
                return False
            found = scene.selection.pick_at(*pixels[-1], mode=mode, tolerance=6.0)
            if found is None and mode == "replace":
                self._app.say("No streamline there.")
        elif tool == "box":
            scene.selection.select_box(*pixels[0], *pixels[-1], mode=mode)
        elif tool == "lasso":
            scene.selection.select_polygon([list(pixel) for pixel in pixels], mode=mode)
        else:
            raise ValueError(f"there is no tool {str(tool)[:40]!r}")
        with self._app.state:
            if scene.selection.count():
                self._app.page.tab = "selection"
                self._app.page.right_open = True
        self._app.refresh()
        return False

    def _measure(self, pixels: list[tuple[float, float]]) -> bool:
        """Take both ends of a distance, or one end of two clicks."""
        app, measurements = self._app, self._app.scene.measurements
        places = [measurements.place_at(*pixel) for pixel in pixels]
        if None in places:
            app.say("Nothing to measure there; click a line, a surface or a slice.")
            return self._begin is not None
        if len(places) == 1 and self._begin is not None:
            places.insert(0, self._begin)
        if len(places) == 2:
            self.end_measuring()
            measurements.add_measurement(*places)
            app.stream.request()
        else:
            self._begin = places[0]
            app.page.measuring = True
        return self._begin is not None

    def end_measuring(self) -> None:
        """Forget the first of two clicks."""
        self._begin, self._app.page.measuring = None, False

    def remove_distance(self, row: int) -> None:
        """Take one measured distance away."""
        self._app.scene.measurements.remove_measurement(row)

    def clear_distances(self) -> None:
        """Take all measured distances away."""
        self._app.scene.measurements.clear_measurements()

    # The tab

    def refresh(self) -> None:
        """Show the selection."""
        scene, page = self._app.scene, self._app.page
        page.measured = [one.text for one in scene.state.measurements]
        count = scene.selection.count()
        if not count:
            page.selection, self._shown = {"count": 0}, None
            return
        # Tables and profiles of many streamlines take long, and most changes of a scene are none of theirs.
        having = [
            (layer.id, layer.name, layer.source, layer.selected, layer.settings["scalars"])
            for layer in scene.layers
            if layer.selected is not None
        ]
        shown = (having, page.chosen, self._profile)
        if shown == self._shown:
            return
        table = scene.selection.table(limit=ROWS)
        rows = table["rows"]
        layers = {row["layer"] for row in rows}
        of = next((row["of"] for row in rows if row["of"]), None)
        columns = ["streamline", "points", "mm"] + ([of] if of else []) + (["layer"] if len(layers) > 1 else [])
        cells = []
        for row in rows:
            line = [f"{row['streamline']:,}", f"{row['points']:,}", short(row["length"])]
            if of:
                line.append("–" if row["value"] is None else short(row["value"]))
            if len(layers) > 1:
                line.append(row["name"])
            cells.append(line)
        page.selection = {
            "count": count,
            "title": f"{count:,} streamline{'' if count == 1 else 's'}",
            "columns": columns,
            "rows": cells,
            "more": f"and {table['total'] - len(rows):,} more" if table["total"] > len(rows) else "",
            **self._plot(),
        }
        self._shown = shown

    def _owner(self) -> Layer:
        """The layer whose selection is profiled: the chosen one, or the first that has one."""
        scene = self._app.scene
        having = [layer for layer in scene.layers if layer.selected is not None]
        if not having:
            raise ValueError("nothing is selected; pick streamlines first")
        return next((layer for layer in having if layer.id == self._app.page.chosen), having[0])

    def _profiled(self) -> tuple[list[str], dict[str, Any]]:
        """Return what there can be a profile of, and the one that is shown."""
        scene = self._app.scene
        layer = self._owner()
        actor = scene.actor(layer.id)
        volume = actor.active_scalars.volume if actor.active_scalars is not None else None
        names = ["curvature", *actor.fiblets.per_point, *([] if volume is None else [volume.name])]
        name = self._profile if self._profile in names else None
        return names, scene.selection.profile(layer.id, name)

    def profile_csv(self) -> str:
        """Return the profile that is shown as CSV."""
        _, found = self._profiled()
        return profile_csv(found, UNITS.get(found["name"], found["name"]))

    def _plot(self) -> dict[str, Any]:
        names, found = self._profiled()
        mean, spread = ([float("nan") if part is None else part for part in found[key]] for key in ("mean", "std"))
        low = [a - b for a, b in zip(mean, spread, strict=True)]
        high = [a + b for a, b in zip(mean, spread, strict=True)]
        chart = profile_chart(found["position"], mean, low, high, UNITS.get(found["name"], found["name"]))
        return {"profiles": names, "profile": found["name"], "chart": chart}

    def set_profile(self, name: str) -> None:
        """Choose what the profile is of."""
        self._profile = str(name)
        self._app.refresh()

    def clear(self) -> None:
        """Select nothing."""
        self._app.scene.selection.deselect()

    def as_layer(self) -> None:
        """Add a layer of the selection."""
        self._app.page.chosen = self._app.scene.keep_selection(self._owner().id).id
        self._app.refresh()
