"""Regions of the tab Filter: a flat list of the chosen layer's, each with or without 'not', joined by one word.

A region has a name; layers with a region of the same name share it: a change to it applies to all of them.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from pvfiblets.images.files import SUFFIXES as LABELS
from pvfiblets.web.actions import LineActions
from pvfiblets.web.panels.controls import controls, moved, typed_value
from pvfiblets.web.panels.describe import typed
from pvfiblets.web.scene.cameras import NEAR
from pvfiblets.web.scene.distance_label import hidden_distances
from pvfiblets.web.server.rpc_allowlist import number
from pvfiblets.web.session.document import LINES
from pvfiblets.web.session.shapes import HOWS, SAMPLED
from pvfiblets.web.values import text
from pvfiblets.web.view.region_marks import Sight, dragged, mark

if TYPE_CHECKING:
    from pvfiblets.web.session.document import Layer

Row = dict[str, Any]
PLACED = ("sphere", "box")


class RegionActions(LineActions):
    """The regions of the chosen layer of an application's scene."""

    # What is shown

    def described(self, layer: Layer) -> dict[str, Any]:
        """Return a layer's regions for the panel."""
        try:
            join, rows = flat(layer.filters.regions)
        except ValueError:  # nested, from a session file: they apply, and editing them raises an error
            join, rows = "and", []
        bounds = self._app.plotter.bounds
        scene = self._app.scene
        lines = [{"title": other.name, "value": other.id} for other in scene.layers if other.kind in LINES]
        return {
            "join": join,
            "sentence": sentence(join, rows),
            "hows": [{"title": title, "value": how} for how, title in HOWS.items()],
            "lines": lines,
            "regions": [
                {
                    "not": row["not"], "how": row["how"], "kind": row["region"]["kind"],
                    "name": title(row["region"]), "named": "name" in row["region"],
                    "controls": controls(row["region"], bounds),
                    "file": row["region"].get("path", "").rpartition("/")[2],
                    "labels": ", ".join(map(str, row["region"].get("labels") or ())),
                    "layers": scene.regions.sharing(row["region"].get("name")) or [layer.id],
                }
                for row in rows
            ],
        }  # fmt: skip

    def refresh_marks(self) -> None:
        """Show the regions over the picture, as the camera sees them now."""
        page, scene = self._app.page, self._app.scene
        layer = scene.layer(page.chosen) if page.chosen and page.chosen_kind in LINES else None
        if layer is None or layer.filters.regions is None:
            page.marks = []
            return
        try:
            _, rows = flat(layer.filters.regions)
        except ValueError:
            rows = []
        sight = self._sight()
        marks = []
        for k, row in enumerate(rows):
            if (found := mark(row["region"], sight)) is not None:
                marks.append({"row": k, "name": title(row["region"]), "not": row["not"], **found})
        page.marks = marks

    def _sight(self) -> Sight:
        """How the 3-D view is seen, which slices may leave a part of the picture to."""
        plotter = self._app.plotter
        (width, height), (left, bottom, right, top) = plotter.window_size, plotter.renderer.GetViewport()
        return Sight(plotter.camera, round(width * (right - left)), round(height * (top - bottom)))

    # What is done

    def add(self, kind: str) -> None:
        """Add a region in the middle of the scene, or beside the last one."""
        if kind not in PLACED:
            raise ValueError(f"there is no region {kind!r}; choose sphere or box")
        layer, scene = self._layer, self._app.scene
        _, rows = flat(layer.filters.regions)
        last = next((row["region"] for row in reversed(rows) if row["region"]["kind"] in PLACED), None)
        beside = None if last is None else self._sight().right
        region = {**scene.regions.usual_region(kind, last, beside), "name": scene.regions.free_region_name()}
        self._edit(lambda rows: rows.append({"not": False, "how": "passes", "region": region}))

    def add_file(self, place: Mapping[str, Any]) -> None:
        """Add the region of a closed mesh, or of the labels of a volume, which is read beside everything else."""
        layer = self._layer
        labelled = place["path"].lower().endswith(LABELS)
        region = {"kind": "labels", **place, "labels": None} if labelled else {"kind": "mesh", **place}

        def add() -> None:
            named = {**region, "name": self._app.scene.regions.free_region_name()}
            self._edit(lambda rows: rows.append({"not": False, "how": "passes", "region": named}), layer)

        self._app.later(self._app.files.with_shape(region, add))

    def set_labels(self, row: int, text: str) -> None:
        """Choose the labels of a region by their numbers, between commas; none chosen are all but 0."""
        parts = [part for part in str(text).replace(";", ",").replace(" ", ",").split(",") if part]
        labels = [typed(part, "labels") for part in parts] or None

        def change(region: Row) -> Row:
            if region["kind"] != "labels":
                raise ValueError(f"a region of the kind {region['kind']} has no labels")
            return {"labels": labels}

        self._change(row, change)

    def drop(self, row: int) -> None:
        """Take a region away."""
        self._edit(lambda rows: rows.pop(_index(rows, row)))

    def set_not(self, row: int, negated: bool) -> None:
        """Invert a region's condition."""
        self._edit(lambda rows: rows[_index(rows, row)].update({"not": bool(negated)}))

    def set_how(self, row: int, how: str) -> None:
        """Choose what streamlines do in a region."""
        self._edit(lambda rows: rows[_index(rows, row)].update({"how": how}))

    def set_join(self, word: str) -> None:
        """Ask for all of the regions, or for any."""
        layer = self._layer
        _, rows = flat(layer.filters.regions)
        self._app.scene.filters.set_regions(layer.id, condition("or" if word == "or" else "and", rows))

    def rename(self, row: int, name: str) -> None:
        """Give a region another name."""
        wanted = text(str(name).strip(), "the name of a region", 40)
        taken = self._app.scene.regions.region_names()
        region = self._region(row)
        if wanted != region.get("name") and wanted in taken:
            raise ValueError(f"there is a region {wanted!r} already; give another name")
        self._change(row, lambda _: {"name": wanted})

    def set_layers(self, row: int, chosen: Any) -> None:
        """Choose the layers that a region is used for."""
        region = self._region(row)
        if not isinstance(chosen, list) or not chosen:
            raise ValueError("a region needs at least one layer; remove it instead")
        _, rows = flat(self._layer.filters.regions)
        self._app.scene.regions.share_region(region, rows[row]["how"], rows[row]["not"], chosen)

    def set_value(self, row: int, name: str, value: Any) -> None:
        """Move a region's slider."""
        self._change(row, lambda region: moved(region, name, value))

    def set_end(self, row: int, name: str, end: int, text: str) -> None:
        """Set a number of a region, or one end of a range, to mm that were typed."""
        region = self._region(row)
        self.set_value(row, name, typed_value(region, self._app.plotter.bounds, name, end, text))

    def drag(self, row: int, handle: str, place: Any) -> None:
        """Drag a handle to a place in the picture: shares from its upper left."""
        if not isinstance(place, list) or len(place) != 2:
            raise ValueError("a position in the frame needs two numbers")
        where = [number(part, -1.0, 2.0) for part in place]
        self._change(row, lambda region: dragged(region, handle, where, self._sight()))

    def begin_placing(self, row: int) -> None:
        """Place a region at the next click on the picture."""
        region = self._region(row)
        if region["kind"] not in PLACED:
            raise ValueError("a region of a file cannot be moved")
        page = self._app.page
        page.placing, page.placing_name, page.tool = row, title(region), "place"

    def place(self, x: float, y: float) -> None:
        """Move the region that is being placed to what a pixel of the picture shows: a line, a slice or a surface."""
        app = self._app
        with hidden_distances(app.plotter):
            found = app.scene.cameras.place_at(x, y, tolerance=NEAR)
        if found is None:
            app.say("Nothing there; click a streamline, a slice or a surface.")
            return

        def change(region: Row) -> Row:
            if region["kind"] == "sphere":
                return {"center": found}
            bounds = region["bounds"]
            shift = [found[k] - 0.5 * (bounds[2 * k] + bounds[2 * k + 1]) for k in range(3)]
            return {"bounds": [bounds[k] + shift[k // 2] for k in range(6)]}

        self._change(app.page.placing, change)
        app.page.tool = "rotate"

    def _region(self, row: int) -> Row:
        _, rows = flat(self._layer.filters.regions)
        return dict(rows[_index(rows, row)]["region"])

    def _change(self, row: int, change: Callable[[Row], Row]) -> None:
        """Change a region, for all layers that share it."""
        region = self._region(row)
        new = {**region, **change(region)}
        if "name" in region:
            self._app.scene.regions.change_region(region["name"], new)
        else:
            self._edit(lambda rows: rows[row].update({"region": new}))

    def _edit(self, change: Callable[[list[Row]], Any], layer: Layer | None = None) -> None:
        layer = self._layer if layer is None else self._app.scene.layer(layer.id)
        join, rows = flat(layer.filters.regions)
        change(rows)
        self._app.scene.filters.set_regions(layer.id, condition(join, rows))


def title(region: Mapping[str, Any]) -> str:
    """Return what a region is called."""
    return str(region.get("name") or region.get("path", "").rpartition("/")[2] or region["kind"])


def sentence(join: str, rows: list[Row]) -> str:
    """Return a sentence on the streamlines that regions leave."""
    word = {"and": " and ", "or": " or "}[join]
    return word.join(f"{'not ' if row['not'] else ''}{_WORDS[row['how']]} {title(row['region'])}" for row in rows)


_WORDS = {"passes": "through", "ends_in": "ending in", "both_ends_in": "with both ends in", "stays_in": "within"}


def _index(rows: list[Any], row: Any) -> int:
    if isinstance(row, bool) or not isinstance(row, int) or not 0 <= row < len(rows):
        raise ValueError(f"there is no region {row!r}")
    return row


def flat(condition: Any) -> tuple[str, list[Row]]:
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
            raise ValueError("these regions are nested too deeply for this panel; they stay unchanged")
        rows.append({**inner, "not": negated, "region": dict(inner["region"])})
    return join, rows


def condition(join: str, rows: list[Row]) -> dict[str, Any] | None:
    """Return the condition of some rows; ``None`` for none."""
    parts: list[dict[str, Any]] = []
    for row in rows:
        part = {"how": row["how"], "region": row["region"]}
        if "sampling" in row and row["how"] in SAMPLED:
            part["sampling"] = row["sampling"]
        parts.append({"op": "not", "of": [part]} if row["not"] else part)
    return None if not parts else {"op": join, "of": parts}
