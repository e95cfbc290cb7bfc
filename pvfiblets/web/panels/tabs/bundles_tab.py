"""The tab Bundles: groups, saved selections and results of filters, as one list to edit."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets.web.actions import LineActions
from pvfiblets.web.panels import elements as ui
from pvfiblets.web.panels.elements import eye, html, v3
from pvfiblets.web.panels.files.writing import EXPORTS
from pvfiblets.web.panels.tabs import bundle_finding, bundle_measures
from pvfiblets.web.session.document import LINES

if TYPE_CHECKING:
    from pvfiblets.web.app import Explorer
    from pvfiblets.web.session.document import Bundle, Layer

LISTED = 300  # rows of the list; more are counted, and found by their names

MANY = 20  # bundles beyond which one looks for them by name


class BundleActions(LineActions):
    """The page's actions on bundles of the chosen tractogram."""

    def __init__(self, app: Explorer) -> None:
        super().__init__(app)
        self._along: tuple[Any, bundle_measures.Curves] = ((), {})  # which values of a layer, and these
        self._checked: list[str] = []
        self._sought = ""

    def refresh(self) -> None:
        """Show the bundles of the chosen tractogram."""
        page, scene = self._app.page, self._app.scene
        if not page.chosen or page.chosen_kind not in LINES:
            page.bundles, self._sought = {"layer": "", "rows": [], "count": 0, "along": {}}, ""
            return
        bundles = scene.bundles.of_layer(page.chosen)
        known = {one.name for one in bundles}
        self._checked = [name for name in self._checked if name in known]
        layer = self._layer
        if page.bundles["layer"] != layer.id or len(bundles) <= MANY:
            self._sought = ""
        selected = 0 if layer.selected is None else len(layer.selected)
        order = {name: place for place, name in enumerate(self._checked, 1)}
        found = [one for one in bundles if self._sought in one.name.casefold()]
        page.bundles = {
            "layer": layer.id,
            "rows": [
                {"name": one.name, "color": one.color, "visible": one.visible, "count": f"{len(one.ids):,}",
                 "order": order.get(one.name, 0)}
                for one in found[:LISTED]
            ],
            "count": len(bundles), "sought": self._sought,
            "more": f"and {len(found) - LISTED:,} more" if len(found) > LISTED else "",
            "checked": len(self._checked), "selected": selected, "all": all(one.visible for one in bundles),
            "coloured": layer.settings["scalars"] == "group",
            "along": self._plot_along(layer, bundles),
        }  # fmt: skip

    def _plot_along(self, layer: Layer, bundles: tuple[Bundle, ...]) -> dict[str, Any]:
        """Return a chart of the values along the visible bundles that colour them, from a file; nothing of others."""
        key = layer.id, layer.source, layer.settings["scalars"]
        if self._along[0] != key:
            self._along = key, bundle_measures.curves_along(self._app.scene, layer)
        return bundle_measures.along_chart(layer, bundles, self._along[1])

    def check(self, name: str, on: bool) -> None:
        """Check or uncheck a bundle for actions on several."""
        known = [one.name for one in self._app.scene.bundles.of_layer(self._layer.id)]
        self._checked = [one for one in self._checked if one != name]
        if on is True and name in known:
            self._checked.append(name)
        self._show()

    def seek(self, text: str) -> None:
        """List the bundles with a text in their names only."""
        self._sought = str(text or "").casefold()
        self._show()

    def add(self, what: str) -> None:
        """Make a bundle of the selection or of the visible streamlines."""
        if what not in ("selected", "shown"):
            raise ValueError(f"choose selected or shown, not {str(what)[:40]!r}")
        self._app.scene.bundles.add_bundle(self._layer.id, what)

    def chosen(self) -> list[str]:
        """Names of the bundles chosen by their boxes, in the order in which they were."""
        return list(self._checked)

    def chosen_ids(self) -> Any:
        """Streamlines of the bundles chosen, each once."""
        parts = [
            one.ids.array() for one in self._app.scene.bundles.of_layer(self._layer.id) if one.name in self._checked
        ]
        return np.unique(np.concatenate(parts)) if parts else np.zeros(0, np.int64)

    def move(self, by: int) -> None:
        """Move the bundles chosen up or down the list."""
        layer, names = self._layer, self._checked
        if not names:
            raise ValueError("choose bundles by their boxes first")
        listed = [one.name for one in self._app.scene.bundles.of_layer(layer.id)]
        places = [listed.index(name) for name in names]
        to = min(places) - 1 if by < 0 else max(places) - len(places) + 2
        self._app.scene.bundles.move_bundles(layer.id, names, to)

    def drop(self, name: str, on: str) -> None:
        """Put a bundle to where another is, as it was dragged."""
        layer = self._layer
        listed = [one.name for one in self._app.scene.bundles.of_layer(layer.id)]
        if name in listed and on in listed and name != on:
            self._app.scene.bundles.move_bundles(layer.id, [name], listed.index(on))

    def set(self, name: str, what: str, value: Any) -> None:
        """Set name, colour or visibility of a bundle."""
        if what not in ("name", "color", "visible"):
            raise ValueError(f"a bundle has no {str(what)[:40]!r}")
        value = str(value).strip() if what == "name" else value
        before = list(self._checked)
        if what == "name":  # it stays chosen
            self._checked = [value if one == name else one for one in self._checked]
        try:
            self._app.scene.bundles.set_bundle(self._layer.id, name, **{what: value})
        except Exception:
            self._checked = before
            self._app.refresh()
            raise

    def show_all(self, on: bool) -> None:
        """Show all bundles, or none."""
        self._app.scene.bundles.show_bundles(self._layer.id, None if on is True else [])

    def colour(self, on: bool) -> None:
        """Colour streamlines by their bundles, or by orientation."""
        scene, layer = self._app.scene, self._layer
        if on is True and scene.state.bundles_of(layer.source) is None:
            there = scene.bundles.of_layer(layer.id)
            scene.bundles.show_bundles(
                layer.id, [one.name for one in there if one.visible]
            )  # in the colours of the list
        scene.set(layer.id, "scalars", "group" if on is True else "orientation")

    def act(self, what: str) -> None:
        """Merge, subtract, remove, select or show alone the bundles that are chosen."""
        scene, layer, names = self._app.scene, self._layer.id, list(self._checked)
        if not names:
            raise ValueError("choose bundles by their boxes first")
        act = {
            "merge": scene.bundles.merge_bundles,
            "subtract": scene.bundles.subtract_bundles,
            "remove": scene.bundles.remove_bundles,
            "select": scene.bundles.select_bundles,
            "only": scene.bundles.show_bundles,
        }.get(what if isinstance(what, str) else "")
        if act is None:
            raise ValueError(f"bundles cannot be {str(what)[:40]!r}")
        act(layer, names)
        self._app.refresh()

    def export(self, suffix: str) -> None:
        """Write the streamlines of the chosen bundles to a file, where the tab Selection says."""
        layer = self._layer
        if not self._checked:
            raise ValueError("choose bundles by their boxes first")
        self._app.exports.export_ids(layer.id, self.chosen_ids(), suffix, self._checked[0])


def build(app: Explorer) -> None:
    """Build the tab."""
    bundles = app.bundles
    html.Div("Choose a tractogram on the left to see its bundles.", v_if="!bundles.layer", classes="pv-small pa-3")
    with html.Div(v_if="bundles.layer"):
        with html.Div(classes="px-3 pt-2", style="display: flex; flex-wrap: wrap; gap: 6px"):
            for what, title, hint in (
                ("selected", "Selected", "Make a bundle of the selection"),
                ("shown", "Shown", "Make a bundle of the visible streamlines"),
            ):
                ui.button(
                    title, size="small", prepend_icon="mdi-plus", title=hint, click=(bundles.add, f"['{what}']"),
                    data_bundle=what, disabled=("!bundles.selected",) if what == "selected" else False,
                )  # fmt: skip
        html.Div(
            "No bundles yet. Make one of the selection, or of the visible streamlines.",
            v_if="!bundles.count", classes="pv-small px-3 pt-2",
        )  # fmt: skip
        with html.Div(v_if="bundles.count"):
            with html.Div(classes="pv-pair px-2 pt-1"):
                eye("bundles.all", "Hide all", "Show all", click=(bundles.show_all, "[!bundles.all]"),
                    data_action="all-bundles")  # fmt: skip
                html.Span("{{ bundles.count }} bundle{{ bundles.count === 1 ? '' : 's' }}", classes="pv-small",
                          style="flex: 1")  # fmt: skip
                ui.button(
                    "Colour by bundle", data_action="colour-by-bundle", click=(bundles.colour, "[!bundles.coloured]"),
                    **ui.pressed("bundles.coloured"),
                )  # fmt: skip
            html.Input(
                v_if=f"bundles.count > {MANY}", type="search", placeholder="Find by name", aria_label="Find bundles",
                classes="pv-num mx-2", style="width: calc(100% - 16px)", maxlength=120, data_field="find-bundles",
                value=("bundles.sought",), input=(bundles.seek, "[$event.target.value]"),
            )  # fmt: skip
            with html.Div(style="max-height: 42vh; overflow: hidden auto", id="bundle-list"):
                _rows(bundles)
            html.Div("{{ bundles.more }}", v_if="bundles.more", classes="pv-small px-3")
            with html.Div(
                v_if="bundles.checked", classes="px-3 pt-2", style="display: flex; flex-wrap: wrap; gap: 4px",
            ):  # fmt: skip
                for what, title, hint, least in (
                    ("only", "Show only", "Hide all others", 1),
                    ("select", "Select", "Select their streamlines", 1),
                    ("merge", "Merge", "Merge them into the first chosen", 2),
                    ("subtract", "Subtract", "Remove the others' streamlines from the first chosen", 2),
                    ("remove", "Remove", "Remove from the list; streamlines stay", 1),
                ):
                    ui.button(
                        title, title=hint, data_bundle_act=what, click=(bundles.act, f"['{what}']"),
                        disabled=(f"bundles.checked < {least}",),
                    )  # fmt: skip
                ui.button("Export…", id="export-bundles", data_bundle_act="export")
                for by, icon, hint in ((-1, "mdi-arrow-up", "Up the list"), (1, "mdi-arrow-down", "Down the list")):
                    ui.icon_button(icon, hint, 16, variant="tonal", title=hint, click=(bundles.move, f"[{by}]"),
                                   data_bundle_move=by)  # fmt: skip
                with v3.VMenu(activator="#export-bundles"), v3.VList(density="compact"):
                    for suffix in EXPORTS:
                        v3.VListItem(title=suffix, click=(bundles.export, f"['{suffix}']"),
                                     data_bundle_export=suffix)  # fmt: skip
        with html.Div(v_if="bundles.along && bundles.along.chart", id="values-along"):
            html.Div("Values along bundles", classes="pv-head")
            bundle_measures.build_chart("bundles.along")
        bundle_finding.build(app)
        bundle_measures.build(app)


def _rows(bundles: BundleActions) -> None:
    """Build a row for each bundle."""
    with html.Div(
        v_for="b in bundles.rows", key="b.name", classes="pv-pair px-2", data_bundle_row=("b.name",),
        v_on_dragover_prevent="", v_on_drop_prevent=(
            bundles.drop, "[$event.dataTransfer.getData('text/plain'), b.name]"),
    ):  # fmt: skip
        html.Span(
            "⠿", draggable="true", classes="pv-grip", title="Drag to another place of the list",
            v_on_dragstart="$event.dataTransfer.setData('text/plain', b.name)", data_action="grip",
        )  # fmt: skip
        eye("b.visible", click=(bundles.set, "[b.name, 'visible', !b.visible]"), data_action="eye")
        html.Input(
            type="color", classes="pv-colour", style="width: 22px; height: 22px", value=("b.color",),
            aria_label="Colour", change=(bundles.set, "[b.name, 'color', $event.target.value]"),
        )  # fmt: skip
        html.Input(
            classes="pv-num", style="flex: 1; width: auto; border-color: transparent", value=("b.name",),
            maxlength=120, change=(bundles.set, "[b.name, 'name', $event.target.value]"),
            aria_label="Name of the bundle", data_field="name", title=("b.name",),
        )  # fmt: skip
        html.Span("{{ b.count }}", classes="pv-small", data_value="count")
        v3.VCheckbox(
            model_value=("b.order > 0",), density="compact", hide_details=True, style="flex: none",
            update_modelValue=(bundles.check, "[b.name, !!$event]"), aria_label=("'Choose ' + b.name",),
        )  # fmt: skip
