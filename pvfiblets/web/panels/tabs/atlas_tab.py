"""Labels of an image in the tab Slices: a list to search, and streamlines that pass a label or connect two."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets.plotting.slices.settings import MEANING
from pvfiblets.query.bundles.colours import hex_colour
from pvfiblets.slices.labels import LabelTable
from pvfiblets.web.actions import Actions
from pvfiblets.web.panels import elements as ui
from pvfiblets.web.panels.elements import fold, html, v3
from pvfiblets.web.panels.tabs.filter_regions import condition, flat
from pvfiblets.web.session.document import LINES, free_name

if TYPE_CHECKING:
    from pvfiblets.web.app import Explorer
    from pvfiblets.web.session.document import Layer

HOWS = {"passes": "pass", "ends_in": "end in"}
MOST_ROWS = 2000
SHOWN = 40  # rows of the list at once
MOST_ASKED = 2


class AtlasActions(Actions):
    """The page's actions on labels of a scene's images."""

    def __init__(self, app: Explorer) -> None:
        super().__init__(app)
        self._image = ""
        self._how = "passes"
        self._listed: tuple[Any, list[dict[str, Any]]] = (None, [])

    # What is shown

    def refresh(self) -> None:
        """Show the labels of an image, and the queried ones."""
        app = self._app
        images = self._images()
        if not images:
            app.page.atlas = {"rows": [], "images": []}
            return
        layer = self._layer()
        asked = self._asked(layer)
        app.page.atlas = {
            "image": layer.id, "name": layer.name, "how": self._how, "counted": self._counted(),
            "images": [{"title": one.name, "value": one.id} for one in images],
            "asked": [row["region"]["labels"][0] for row in asked],
            "rows": self._rows(layer),
        }  # fmt: skip

    def _images(self) -> list[Any]:
        layers = self._app.scene.layers
        return [one for one in layers if one.kind == "image" and one.settings[MEANING] == "labels"]

    def _layer(self) -> Any:
        """The image whose labels are listed: the one that was chosen here, or the highest."""
        images = self._images()
        if not images:
            raise ValueError("no image is shown as labels; open one as slices and set Numbers are to labels")
        return next((one for one in images if one.id == self._image), images[-1])

    def _rows(self, layer: Layer) -> list[dict[str, Any]]:
        data = self._app.scene.data(layer).data
        if self._listed[0] is not data:
            labels = np.unique(data.values[..., 0])
            labels = labels[np.isfinite(labels) & (labels != 0)][:MOST_ROWS].astype(np.int64)
            table = data.table or LabelTable()
            colours = table.rows(labels)[:, :3] / 255.0
            found = [
                {"label": label, "name": table.name(label), "color": hex_colour(tuple(colour))}
                for label, colour in zip(labels.tolist(), colours.tolist(), strict=True)
            ]
            self._listed = data, found
        return self._listed[1]

    def _lines(self) -> Layer:
        """The chosen tractogram, or the first."""
        scene, chosen = self._app.scene, self._app.page.chosen
        lines = [layer for layer in scene.layers if layer.kind in LINES]
        if not lines:
            raise ValueError("there are no streamlines; open a tractogram first")
        return next((layer for layer in lines if layer.id == chosen), lines[0])

    def _counted(self) -> str:
        scene = self._app.scene
        if not any(layer.kind in LINES for layer in scene.layers):
            return ""
        actor = scene.actor(self._lines().id)
        return f"{int(np.count_nonzero(actor.shown)):,} of {actor.fiblets.n_streamlines:,} streamlines are shown"

    def _asked(self, image: Any) -> list[dict[str, Any]]:
        """Return the rows of the filter that are about one label of an image each."""
        if not any(layer.kind in LINES for layer in self._app.scene.layers):
            return []
        try:
            _, rows = flat(self._lines().filters.regions)
        except ValueError:  # nested, by a session
            return []
        return [row for row in rows if _is_label(row, image.source.path)]

    # What is done

    def choose(self, layer_id: str) -> None:
        """List the labels of another image."""
        self._image = self._app.scene.layer(layer_id).id
        self._show()

    def set_how(self, how: str) -> None:
        """Ask for streamlines that pass labels, or that end in them."""
        if how not in HOWS:
            raise ValueError(f"streamlines do not {str(how)[:40]!r} here; choose one of {', '.join(HOWS)}")
        self._how = how
        image, lines = self._layer(), self._lines()
        if self._asked(image):
            join, rows = flat(lines.filters.regions)
            for row in rows:
                if _is_label(row, image.source.path):
                    row["how"] = how
            self._app.scene.filters.set_regions(lines.id, condition(join, rows))
        self._show()

    def ask(self, label: Any) -> None:
        """Ask for a label, or no longer: of two, for what connects them; a third one takes the first one's place."""
        image, lines = self._layer(), self._lines()
        found = next((row for row in self._rows(image) if row["label"] == label), None)
        if found is None:
            raise ValueError(f"{image.name} has no label {str(label)[:40]}")
        path = image.source.path
        if path is None:
            raise ValueError("labels of the demonstration have no file; open a label file")
        join, rows = flat(lines.filters.regions)
        asked = [row for row in rows if _is_label(row, path)]
        same = [row for row in asked if row["region"]["labels"] == [label]]
        gone = same or asked[: max(0, len(asked) + 1 - MOST_ASKED)]
        rows = [row for row in rows if row not in gone]
        if same:
            self._app.scene.filters.set_regions(lines.id, condition(join, rows))
            return
        region = {"kind": "labels", "path": path, "labels": [label]}
        region["name"] = free_name(
            f"{found['name']}"[:40].strip() or str(label), set(self._app.scene.regions.region_names()), kept=34
        )
        rows.append({"not": False, "how": self._how, "region": region})
        wanted = condition("and" if not asked else join, rows)
        self._app.later(
            self._app.files.with_shape(region, lambda: self._app.scene.filters.set_regions(lines.id, wanted))
        )

    def clear(self) -> None:
        """Ask for no label of the image any more."""
        image, lines = self._layer(), self._lines()
        join, rows = flat(lines.filters.regions)
        rows = [row for row in rows if not _is_label(row, image.source.path)]
        self._app.scene.filters.set_regions(lines.id, condition(join, rows))

    def ask_at(self, x: Any, y: Any) -> None:
        """Ask for the label in a place of a pane, in shares of the picture from its upper left."""
        app, image = self._app, self._layer()
        pane = app.slices.pane_at(x, y)
        if pane is None:
            return
        position = pane.position_at(*app.slices.pixel(x, y))
        app.scene.images.set_slices(position=[float(part) for part in position])
        label = app.scene.actor(image.id).value_at(position)
        if not label:
            app.say("No label there.")
            return
        self.ask(int(label))

    def go(self, label: Any) -> None:
        """Move the cross-hair into a label: to the voxel of it that is nearest to its middle."""
        app, image = self._app, self._layer()
        data = app.scene.data(image).data
        at = np.argwhere(data.values[..., 0] == label)
        if not len(at):
            raise ValueError(f"{image.name} has no label {str(label)[:40]}")
        inner = at[np.argmin(((at - at.mean(axis=0)) ** 2).sum(axis=1))]
        position = data.affine[:3, :3] @ inner + data.affine[:3, 3]
        app.scene.images.set_slices(position=[float(part) for part in position])
        app.slices.changed()

    def _show(self) -> None:
        super()._show()
        self._app.stream.request()


def _is_label(row: Mapping[str, Any], path: str | None) -> bool:
    """Whether a row of a filter is about one label of a file."""
    region = row["region"]
    return region["kind"] == "labels" and region["path"] == path and len(region.get("labels") or ()) == 1


# The page -------------------------------------------------------------------------------------------


def over() -> None:
    """Build what catches clicks that ask for labels: see client/slices.js."""
    html.Div(v_if="tool === 'ask' && slicing.shown", id="pv-ask", classes="pv-over")


FOUND = "atlas.rows.filter((r) => (r.name + ' ' + r.label).toLowerCase().includes(atlas_search.trim().toLowerCase()))"


def build(app: Explorer) -> None:
    """Build the part of the tab Slices."""
    atlas = app.atlas
    fold("Labels of {{ atlas.name }}", "atlas_open", v_if="atlas.images.length", data_action="atlas")
    with html.Div(v_if="atlas.images.length && atlas_open", id="atlas"):
        with html.Div(v_if="atlas.images.length > 1", classes="px-3 pt-1"):
            ui.select(
                items=("atlas.images",), model_value=("atlas.image",), update_modelValue=(atlas.choose, "[$event]"),
                aria_label="Image of labels",
            )  # fmt: skip
        with html.Div(classes="pv-pair px-3 pt-1"):
            html.Input(
                v_model=("atlas_search",), placeholder="Search labels", classes="pv-num", style="flex: 1; width: 0",
                aria_label="Search labels", data_field="atlas-search",
            )  # fmt: skip
            with v3.VBtnToggle(
                model_value=("atlas.how",), mandatory=True, density="compact", style="height: 26px",
                update_modelValue=(atlas.set_how, "[$event]"),
            ):  # fmt: skip
                for how, title in HOWS.items():
                    v3.VBtn(title, value=how, size="x-small", classes="text-none", data_atlas_how=how)
            with v3.VBtn(
                icon=True, size="x-small", aria_label="Click labels in a slice", data_action="ask-in-slice",
                click="tool = tool === 'ask' ? 'rotate' : 'ask'", **ui.pressed("tool === 'ask'", "text"),
            ):  # fmt: skip
                v3.VIcon("mdi-cursor-default-click-outline", size=16)
                ui.tooltip("Click labels in a slice")
        with html.Div(classes="pv-pair px-3 pt-1", v_if="atlas.asked.length", data_value="atlas-asked"):
            html.Span(
                "{{ atlas.rows.filter((r) => atlas.asked.includes(r.label)).map((r) => r.name).join(' – ') }}: "
                "{{ atlas.counted }}", classes="pv-value", style="flex: 1",
            )  # fmt: skip
            ui.button("Clear", click=atlas.clear)
        html.Div("Click one label for its streamlines, two for the streamlines between them.",
                 classes="pv-small px-3 pt-1", v_if="!atlas.asked.length")  # fmt: skip
        with html.Div(style="max-height: 34vh; overflow: auto", classes="px-2 pt-1", id="atlas-rows"):
            with html.Div(
                v_for=f"r in {FOUND}.slice(0, {SHOWN})", key="r.label", classes="pv-pair pv-label-row",
                data_label=("r.label",),
            ):  # fmt: skip
                with v3.VBtn(
                    size="small", variant=("atlas.asked.includes(r.label) ? 'tonal' : 'text'",), classes="text-none",
                    style="flex: 1; min-width: 0; justify-content: start", click=(atlas.ask, "[r.label]"),
                    title=("r.name + ' (' + r.label + ')'",), aria_pressed=("atlas.asked.includes(r.label)",),
                ):  # fmt: skip
                    html.Span(classes="pv-dot mr-2", style=("{ background: r.color }",))
                    html.Span("{{ r.name }}", classes="text-truncate")
                ui.icon_button("mdi-crosshairs-gps", "Go there", 16, click=(atlas.go, "[r.label]"))
            html.Div(
                f"{{{{ {FOUND}.length - {SHOWN} }}}} more; search for a name or a number", classes="pv-small px-2 py-1",
                v_if=f"{FOUND}.length > {SHOWN}",
            )  # fmt: skip
