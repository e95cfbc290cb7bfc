"""The tab Slices, and how views are laid out."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets.plotting.slices.settings import MEANING
from pvfiblets.web.actions import Actions
from pvfiblets.web.panels import elements as ui
from pvfiblets.web.panels.charts import short
from pvfiblets.web.panels.describe import typed
from pvfiblets.web.panels.elements import fold, html, v3
from pvfiblets.web.panels.tabs import atlas_tab, painting_tab
from pvfiblets.web.scene.slices.glyph_layers import covers
from pvfiblets.web.scene.slices.slicing import LAYOUTS, NAMES
from pvfiblets.web.server.rpc_allowlist import number

if TYPE_CHECKING:
    from pvfiblets.web.app import Explorer
    from pvfiblets.web.session.document import Layer

__all__ = ["SliceActions", "build", "layout_menu", "over"]

ICONS = {
    "3d": "mdi-cube-outline",
    "beside": "mdi-view-split-vertical",
    "axial": "mdi-square-outline",
    "coronal": "mdi-square-outline",
    "sagittal": "mdi-square-outline",
    "grid": "mdi-view-grid-outline",
    "oblique": "mdi-square-outline",
}
TILTED = [30.0, 0.0]  # angles that an oblique slice begins with, degrees
MOST_STEP = 100  # voxels at once


class SliceActions(Actions):
    """The page's actions on images that are shown as slices."""

    # What is shown

    def refresh(self) -> None:
        """Show the settings of slices, and the values under the cross-hair."""
        app = self._app
        workspace, page = app.scene.slicing.workspace, app.page
        volumes = [layer.name for layer in app.scene.layers if layer.kind == "volume"]
        if workspace is None:
            volume = volumes[-1] if volumes else ""
            page.slicing = {"shown": False, "layout": "3d", "boxes": [], "volume": volume, "series": []}
            return
        view = app.scene.slicing.view
        values = workspace.slices.values()
        page.slicing = {
            "shown": True, "layout": view.layout, "convention": view.convention, "planes": view.planes,
            "oblique": list(view.oblique or TILTED), "tilted": view.oblique is not None,
            "cross_hair": view.cross_hair, "thickness": short(view.thickness),
            "position": [f"{part:.1f}" for part in view.position or ()],
            "voxel": [str(part) for part in workspace.voxel or ()],
            "values": [[name, _told(value)] for name, value in values.items() if value != (0, "0")],
            "boxes": app.scene.slicing.boxes(), "volume": "", "series": self._series(),
        }  # fmt: skip

    def _series(self) -> list[dict[str, Any]]:
        """Return the images of several volumes: times, directions, components."""
        scene, found = self._app.scene, []
        for layer in scene.layers:
            last = scene.data(layer).data.n_volumes - 1 if layer.kind == "image" else 0
            if last and layer.settings[MEANING] in ("scalars", "labels") and not covers(layer.settings):
                found.append({"id": layer.id, "name": layer.name, "index": layer.settings["index"], "last": last})
        return found

    # What is done

    def _set(self, **changes: Any) -> None:
        self._app.scene.images.set_slices(**changes)
        self.changed()

    def changed(self) -> None:
        """Show the changes, in the tab and in the frame."""
        self._show()
        self._app.stream.request()

    def set_layout(self, layout: str) -> None:
        """Lay views out; where there is no image yet, a volume becomes one, or a file is chosen."""
        app = self._app
        if layout not in LAYOUTS:
            raise ValueError(f"there is no layout {str(layout)[:40]!r}; choose one of {', '.join(LAYOUTS)}")
        if layout == "3d" or app.scene.slicing.workspace is not None:
            made = {"oblique": TILTED} if layout == "oblique" and app.scene.slicing.view.oblique is None else {}
            self._set(layout=layout, **made)
            app.stream.hasten()
            return
        app.scene.images.set_slices(layout=layout)
        volumes = [layer for layer in app.scene.layers if layer.kind == "volume"]
        if volumes:
            chosen = next((layer for layer in volumes if layer.id == app.page.chosen), volumes[-1])
            self.of_volume(chosen.id)
        else:
            app.files.browse("", "slices")

    def of_volume(self, layer_id: str) -> None:
        """Show the image of a volume as slices, and hide the volume."""
        self._app.later(self._of_volume(self._app.scene.layer(layer_id)))

    async def _of_volume(self, layer: Layer) -> None:
        app = self._app
        if layer.kind != "volume":
            raise ValueError(f"{layer.name!r} is of kind {layer.kind}; slices are of volumes")
        source = layer.source
        scene = app.scene
        work = lambda *_: scene.images.with_names(scene.files.load(source, "image"))  # noqa: E731
        loaded = await app.files.run_in_background(layer.name, work, "reading", cancellable=False)
        found = app.scene.add(loaded, name=layer.name)
        app.scene.show(layer.id, False)
        if not app.page.chosen or app.page.chosen == layer.id:
            app.page.chosen = found.id
        app.refresh()

    def choose_table(self, layer_id: str) -> None:
        """Let the user choose the file with the labels' names."""
        app = self._app
        app.choose(layer_id)
        app.files.browse("", "labels")

    def name_labels(self, path: str) -> None:
        """Name the chosen image's labels by a file."""
        self._app.later(self._name_labels(path))

    async def _name_labels(self, path: str) -> None:
        app = self._app
        chosen = app.page.chosen
        loaded = await app.files.run_in_background(
            Path(path).name, lambda *_: app.scene.images.load_labels(chosen, path), "reading", cancellable=False
        )
        app.scene.images.name_labels(chosen, loaded)

    def set_convention(self, convention: str) -> None:
        """Put the patient's right on the left, or on the right."""
        self._set(convention=convention)

    def set_angle(self, which: int, text: Any) -> None:
        """Tilt or turn the oblique slice, by degrees as they were typed or slid."""
        angles = list(self._app.scene.slicing.view.oblique or TILTED)
        angles[1 if which == 1 else 0] = typed(str(text), "angle")
        self._set(oblique=angles)

    def set_switch(self, name: str, on: bool) -> None:
        """Show the cross-hair, or slices in the 3-D view, or do not."""
        if name == "tilted":
            self._set(oblique=TILTED if on is True else None)
            return
        if name not in ("cross_hair", "planes"):
            raise ValueError(f"slices have no {str(name)[:40]!r}")
        self._set(**{name: on is True})

    def set_thickness(self, text: str) -> None:
        """Set how thick the slabs are whose streamlines are shown, as it was typed."""
        self._set(thickness=typed(text, "thickness"))

    def set_part(self, kind: str, axis: int, text: str) -> None:
        """Set one of three numbers of the position, as it was typed, in mm or in voxels."""
        workspace = self._workspace
        value = typed(text, "position")
        if axis not in (0, 1, 2):
            raise ValueError(f"a position has no part {axis!r}")
        if kind == "voxel":
            image = workspace.slices.layers[0].image
            at = image.inverse[:3, :3] @ workspace.position + image.inverse[:3, 3]
            at[axis] = value
            workspace.voxel = at
        else:
            place = workspace.position
            place[axis] = value
            workspace.position = place
        self.changed()

    def step_volume(self, by: Any) -> None:
        """Show the next volume of the chosen image, or of the first that has several; the one before by -1."""
        app = self._app
        series = self._series()
        found = next((one for one in series if one["id"] == app.page.chosen), series[0] if series else None)
        if found is None:
            raise ValueError("no image has several volumes")
        wanted = found["index"] + round(number(by, -MOST_STEP, MOST_STEP))
        app.scene.set(found["id"], "index", min(max(wanted, 0), found["last"]))

    def step(self, x: Any, y: Any, right: Any, up: Any, toward: Any) -> None:
        """Move the cross-hair by voxels of the pane in a place of the picture, in shares from its upper left."""
        workspace = self._workspace
        pane = self.pane_at(x, y)
        name = pane.name if pane is not None else next((one for one in NAMES if one in workspace.panes), "axial")
        steps = [round(number(part, -MOST_STEP, MOST_STEP)) for part in (right, up, toward)]
        workspace.step(name, *steps)
        self.changed()

    def go_to(self, x: Any, y: Any) -> None:
        """Move the cross-hair to the slice under a place of the 3-D view, if there is one."""
        workspace = self._workspace
        place = workspace.picked_in_view(*self.pixel(x, y))
        if place is not None:
            workspace.position = place
            self.changed()

    def pane_at(self, x: Any, y: Any) -> Any:
        """Return the pane in a place of the picture; None if it is none's."""
        return self._workspace.pane_at(*self.pixel(x, y))

    def pixel(self, x: Any, y: Any) -> tuple[float, float]:
        """Return the pixel, from the lower left, of a place in the picture as shares from its upper left."""
        width, height = self._app.plotter.window_size
        return number(x, -1.0, 2.0) * (width - 1), (1.0 - number(y, -1.0, 2.0)) * (height - 1)

    @property
    def _workspace(self) -> Any:
        found = self._app.scene.slicing.workspace
        if found is None:
            raise ValueError("there are no slices; open an image as slices first")
        return found


def _told(value: Any) -> str:
    """Return a value under the cross-hair for people."""
    if value is None:
        return "–"
    if isinstance(value, float):
        return f"{value:.5g}"
    if isinstance(value, tuple):
        label, name = value
        return f"{name} ({label})" if name != str(label) else str(label)
    if isinstance(value, np.ndarray):
        return " ".join(f"{part:.3g}" for part in value)
    return str(value)


# The page -------------------------------------------------------------------------------------------


def layout_menu(app: Explorer) -> None:
    """Build the button that chooses a layout."""
    with v3.VBtn(
        icon=True, size="small", density="comfortable", variant="text", aria_label="Slices and views",
        data_action="layouts", color=("slicing.layout !== '3d' ? 'primary' : ''",),
    ):  # fmt: skip
        v3.VIcon("mdi-view-split-vertical", size=20)
        ui.tooltip("Slices and views (X)")
        with v3.VMenu(activator="parent"), v3.VList(density="compact", id="layouts"):
            for name, title in LAYOUTS.items():
                v3.VListItem(
                    title=title, prepend_icon=ICONS[name], click=(app.slices.set_layout, f"['{name}']"),
                    active=(f"slicing.layout === '{name}'",), data_layout=name,
                )  # fmt: skip


def readout() -> None:
    """Build the values under the cross-hair."""
    with html.Div(v_if="slicing.shown && slicing.layout !== '3d'", classes="pv-told", id="pv-told"):
        html.Div("{{ slicing.position.join('  ') }} mm")
        html.Div("{{ row[0] }}: {{ row[1] }}", v_for="(row, i) in slicing.values.slice(0, 6)", key="i",
                 classes="text-truncate")  # fmt: skip


def over() -> None:
    """Build the lines between views."""
    with html.Div(v_if="slicing.boxes.length > 1", classes="pv-seams", id="pv-seams"):
        html.Div(
            v_for="b in slicing.boxes", key="b.name", data_view_box=("b.name",),
            style=("{ left: 100 * b.x + '%', top: 100 * b.y + '%', width: 100 * b.w + '%', height: 100 * b.h + '%' }",),
        )  # fmt: skip


def build(app: Explorer) -> None:
    """Build the tab."""
    slices = app.slices
    with html.Div(v_if="!slicing.shown"):
        html.Div(
            "Slices show an image, such as a T1, in planes: axial, coronal and sagittal, linked by a cross-hair.",
            classes="pv-small px-3 pt-3",
        )
        with html.Div(classes="pa-3", style="display: flex; flex-wrap: wrap; gap: 6px"):
            ui.button("Open an image", size="small", prepend_icon="mdi-plus",
                      click=(app.files.browse, "['', 'slices']"), data_action="open-slices")  # fmt: skip
            ui.button("Slices of {{ slicing.volume }}", v_if="slicing.volume", size="small", style="max-width: 100%",
                      click=(slices.set_layout, "['beside']"), data_action="slices-of-volume")  # fmt: skip
    with html.Div(v_if="slicing.shown"):
        with html.Div(classes="px-3 pt-2", style="display: flex; flex-wrap: wrap; gap: 4px"):
            for name, title in LAYOUTS.items():
                v3.VBtn(
                    title.split(",")[0].replace("three slices", "slices"), size="x-small", classes="text-none px-2",
                    title=title, click=(slices.set_layout, f"['{name}']"), data_layout_button=name,
                    **ui.pressed(f"slicing.layout === '{name}'"),
                )  # fmt: skip
        with html.Div(classes="pv-pair pr-2"):
            html.Div("Cross-hair", classes="pv-head", style="flex: 1")
            ui.button("Image", variant="text", prepend_icon="mdi-plus", click=(app.files.browse, "['', 'slices']"),
                      data_action="open-slices", title="Overlay another image")  # fmt: skip
        for kind, label in (("position", "mm"), ("voxel", "Voxel")):
            with ui.labelled(label, data_place=kind), html.Div(classes="pv-pair"):
                for axis, name in enumerate("xyz" if kind == "position" else "ijk"):
                    ui.number_field(
                        style="flex: 1; width: 0", value=(f"slicing.{kind}[{axis}] ?? ''",),
                        aria_label=f"{label} {name}",
                        change=(slices.set_part, f"['{kind}', {axis}, $event.target.value]"),
                    )  # fmt: skip
        with html.Div(v_for="(row, i) in slicing.values", key="i", classes="pv-row", data_under=("row[0]",)):
            html.Label("{{ row[0] }}", classes="text-truncate", title=("row[0]",))
            html.Div("{{ row[1] }}", classes="pv-value")
        with html.Div(v_for="s in slicing.series", key="s.id", classes="pv-row", data_series=("s.name",)):
            html.Label(
                "{{ slicing.series.length > 1 ? s.name : 'Volume' }}",
                classes="text-truncate",
                title=("s.name + ': which of its volumes is shown (comma, full stop)'",),
            )
            with html.Div(classes="pv-pair"):
                ui.slider(
                    model_value=("s.index",), min=0, max=("s.last",), step=1, aria_label=("'Volume of ' + s.name",),
                    end=(app.set_property, "[s.id, 'index', $event]"),
                    data_live=("JSON.stringify(['property', s.id, 'index'])",),
                )  # fmt: skip
                held = "held.at === 'property ' + s.id + ' index'"
                html.Input(
                    classes="pv-num", style="width: 46px", inputmode="numeric", aria_label=("s.name + ', volume'",),
                    value=(f"{held} ? held.shown[0] : s.index",), data_field="volume",
                    change=(app.set_number, "[s.id, 'index', $event.target.value]"),
                )  # fmt: skip
                html.Span("of {{ s.last }}", classes="pv-small", style="white-space: nowrap")
        atlas_tab.build(app)
        painting_tab.build(app)
        _panes(app)


def _panes(app: Explorer) -> None:
    """Build how panes are looked at, folded."""
    slices = app.slices
    fold("Panes", "panes_open", data_action="panes")
    with html.Div(v_if="panes_open", id="panes"):
        with ui.labelled("Left is", "Whether the patient's right or left is on the left of a pane"):
            with v3.VBtnToggle(
                model_value=("slicing.convention",), mandatory=True, density="compact", style="height: 26px",
                update_modelValue=(slices.set_convention, "[$event]"),
            ):  # fmt: skip
                v3.VBtn("R", value="radiological", size="x-small", title="Radiological: the patient's right")
                v3.VBtn("L", value="neurological", size="x-small", title="Neurological: the patient's left")
        with ui.labelled("Slab", "How thick the slab is whose streamlines are shown over a slice"):
            with html.Div(classes="pv-pair"):
                ui.number_field(
                    value=("slicing.thickness",), aria_label="Slab, mm",
                    change=(slices.set_thickness, "[$event.target.value]"),
                )  # fmt: skip
                html.Span("mm", classes="pv-small")
        for name, label in (
            ("cross_hair", "Cross-hair"), ("planes", "Slices in 3-D"), ("tilted", "Oblique slice"),
        ):  # fmt: skip
            with ui.labelled(label):
                ui.switch(
                    model_value=(f"slicing.{name}",), update_modelValue=(slices.set_switch, f"['{name}', !!$event]"),
                    aria_label=label,
                )  # fmt: skip
        with html.Div(v_if="slicing.tilted"):
            for which, label in enumerate(("Tilt", "Turn")):
                with ui.labelled(label, "Degrees, about the cross-hair; or drag a handle of its line in a pane"):
                    with html.Div(classes="pv-pair"):
                        ui.slider(
                            model_value=(f"slicing.oblique[{which}]",), min=-90, max=90, step=1, aria_label=label,
                            end=(slices.set_angle, f"[{which}, $event]"),
                            data_live=(f"JSON.stringify(['oblique', '', '{which}'])",),
                        )  # fmt: skip
                        held = f"held.at === 'oblique  {which}'"
                        ui.number_field(
                            style="width: 52px", aria_label=f"{label}, degrees",
                            value=(f"{held} ? held.shown[0] : slicing.oblique[{which}]",),
                            change=(slices.set_angle, f"[{which}, $event.target.value]"),
                        )  # fmt: skip
                        html.Span("°", classes="pv-small")
