"""Painting on slices: the tools over the picture, and the list of regions in the tab Slices."""

from __future__ import annotations

import itertools
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets.query.painting import kernels
from pvfiblets.web.actions import Actions
from pvfiblets.web.panels import elements as ui
from pvfiblets.web.panels.describe import typed
from pvfiblets.web.panels.elements import eye, html, v3
from pvfiblets.web.scene.files.confined import check_name
from pvfiblets.web.scene.slices.painted import TOOLS
from pvfiblets.web.session.document import LINES
from pvfiblets.web.session.painting import USES

if TYPE_CHECKING:
    from pvfiblets.web.app import Explorer
    from pvfiblets.web.session.document import Layer
    from pvfiblets.web.session.painting import Painting

PAINTING = f"{list(TOOLS)}.includes(tool)"  # whether a tool that paints is in hand, for the page

ICONS = (
    ("brush", "mdi-brush", "Brush (N)"),
    ("erase", "mdi-eraser", "Erase (E)"),
    ("fill", "mdi-format-color-fill", "Fill (F)"),
    ("outline", "mdi-vector-polygon", "Outline: draw around the area to fill (U)"),
    ("sphere", "mdi-circle-outline", "Ball: drag from its middle outwards (J)"),
    ("grow", "mdi-auto-fix", "Grow over voxels of like values (W)"),
)
SUFFIXES = (".nii.gz", ".nii")
AT_ONCE = ("fill", "outline", "sphere", "grow")  # tools that need one list of places


class PaintActions(Actions):
    """The page's actions on painted regions."""

    def __init__(self, app: Explorer) -> None:
        super().__init__(app)
        self._numbers = itertools.count(1)
        self._gesture = ""
        self._pane: Any = None
        self._last: Any = None
        self._active = ""

    # What is shown

    def refresh(self) -> None:
        """Show the regions, and how many voxels and streamlines each has."""
        page, scene = self._app.page, self._app.scene
        painting = scene.state.painting
        if painting is None:
            page.painting = {"regions": [], "active": ""}
            return
        names = [one.name for one in painting.regions]
        if self._active not in names:
            self._active = names[-1]
        page.painting = {
            "active": self._active,
            "regions": [
                {"name": one.name, "color": one.color, "visible": one.visible, "use": one.use,
                 "voxels": f"{scene.painting.voxels_of(one.name):,}", "passing": self._passing(one)}
                for one in painting.regions
            ],
            "counted": self._counted(),
        }  # fmt: skip

    def _passing(self, region: Any) -> str:
        """Return how many of the chosen tractogram's streamlines pass a region that is used."""
        fiblets = self._fiblets()
        if not region.use or fiblets is None:
            return ""
        return f"{self._app.scene.canvas.live(fiblets).count(region.name):,}"

    def _counted(self) -> str:
        layer, fiblets = self._of(), self._fiblets()
        if layer is None or fiblets is None:
            return ""
        shown = int(np.count_nonzero(self._app.scene.actor(layer.id).shown))
        return f"{shown:,} of {fiblets.n_streamlines:,} streamlines are shown"

    def _of(self) -> Layer | None:
        """The chosen tractogram, or the first."""
        scene, chosen = self._app.scene, self._app.page.chosen
        lines = [layer for layer in scene.layers if layer.kind in LINES]
        return next((layer for layer in lines if layer.id == chosen), lines[0] if lines else None)

    def _fiblets(self) -> Any:
        layer = self._of()
        return None if layer is None else self._app.scene.actor(layer.id).fiblets

    # The list

    def add(self) -> None:
        """Add a region, and take the brush in hand, unless another tool that paints is."""
        app = self._app
        chosen = app.page.chosen if app.page.chosen_kind == "image" else None
        self._active = app.scene.painting.add_painted(chosen).name
        if app.page.tool not in TOOLS:
            app.page.tool = "brush"
        app.refresh()
        if self._fiblets() is not None and not kernels.are_compiled():
            app.later(self._compile())

    async def _compile(self) -> None:
        """Compile the kernels of painted regions before the first stroke, with a message."""
        work = lambda *_: kernels.compile_all()  # noqa: E731
        await self._app.files.run_in_background("regions", work, "getting ready (first use only)", cancellable=False)

    def choose(self, name: str) -> None:
        """Paint this one from now on."""
        self._active = self._painting.region(name).name
        self._show()

    def rename(self, name: str, new: str) -> None:
        """Give a region another name."""
        was = self._active == name
        found = self._app.scene.painting.set_painted(name, name=str(new).strip())
        if was:
            self._active = found.name
        self._app.refresh()

    def set(self, name: str, what: str, value: Any) -> None:
        """Set colour, use or visibility of a region."""
        if what not in ("color", "use", "visible"):
            raise ValueError(f"a painted region has no {str(what)[:40]!r}")
        self._app.scene.painting.set_painted(name, **{what: value})

    def remove(self, name: str) -> None:
        """Take a region away."""
        self._app.scene.painting.remove_painted(name)
        if self._app.scene.state.painting is None and self._app.page.tool in TOOLS:
            self._app.page.tool = "rotate"

    def save(self, name: str) -> None:
        """Write all regions to a file of the served folder, NIfTI, with a table of their names."""
        app = self._app
        name = str(name).strip()
        stem = next((name.removesuffix(one) for one in SUFFIXES if name.lower().endswith(one)), name)
        name = check_name(stem + ".nii.gz")
        app.confined.writable(name, SUFFIXES)
        app.confined.writable(stem + ".tsv", (".tsv",))
        app.scene.painting.save_painting(name)
        app.say(f"Saved as {name}; label names are in {stem}.tsv.", "success")

    @property
    def _painting(self) -> Painting:
        found = self._app.scene.state.painting
        if found is None:
            raise ValueError("there are no painted regions; add one first")
        return found

    # Strokes

    def paint(self, tool: str, places: Any, begins: bool) -> None:
        """Take where the pointer went over the picture, of a stroke that goes on."""
        app = self._app
        if not isinstance(places, list) or not 1 <= len(places) <= 501:
            raise ValueError("a stroke needs places in the picture")
        if not all(isinstance(place, list) and len(place) == 2 for place in places):
            raise ValueError("a place in the picture is two numbers")
        self._painting  # noqa: B018 - there must be one
        if begins is True:
            self._pane = app.slices.pane_at(*places[0])
            self._last = None
            self._gesture = str(next(self._numbers))
        if self._pane is None or (tool in AT_ONCE and begins is not True):
            return
        pane = self._pane
        path = [pane.position_at(*app.slices.pixel(*place)).tolist() for place in places]
        if self._last is not None:
            path = [self._last, *path]
        self._last = path[-1]
        plane = None if app.page.brush_deep and tool != "outline" else self._across(pane)
        app.history.held = True
        app.sliders.moving = True  # the page is brought in step when the stroke ends
        try:
            share = app.page.grow_share / 100.0
            app.scene.painting.paint(tool, self._active, path, app.page.brush, plane, self._gesture, share)
        finally:
            app.sliders.moving = False
        self._show()
        app.stream.request()

    def end(self) -> None:
        """End a stroke: the next one is another step to undo."""
        self._app.history.held = False
        self._pane = self._last = None
        self._app.refresh()

    def _across(self, pane: Any) -> int:
        """Return the axis of voxels that is most nearly across a pane."""
        axes = self._painting.matrix[:3, :3]
        return int(np.argmax(abs(pane.toward @ axes) / np.linalg.norm(axes, axis=0)))

    def move(self, name: str, by: int) -> None:
        """Move a region up or down in the list."""
        self._app.scene.painting.move_painted(name, 1 if by == 1 else -1)

    def open_labels(self, path: str) -> None:
        """Take the labels of a file as regions."""
        self._app.later(self._open_labels(path))

    async def _open_labels(self, path: str) -> None:
        app = self._app
        work = lambda *_: app.scene.load(path, "image")  # noqa: E731
        loaded = await app.files.run_in_background(Path(path).name, work, "reading", cancellable=False)
        self._active = app.scene.painting.add_labels(loaded)[0].name
        app.refresh()

    def set_share(self, text: Any) -> None:
        """Set how far growing goes, in per cent of the image's window, as it was typed or slid."""
        value = typed(str(text), "range")
        if value is None or not 0.0 <= value <= 100.0:
            raise ValueError(f"range is {value}; give 0 to 100 per cent of the image's window")
        self._app.page.grow_share = value

    def set_brush(self, text: Any) -> None:
        """Set the brush's radius, mm, as it was typed or slid."""
        value = typed(str(text), "radius")
        if value is None or not 0.1 <= value <= 50.0:
            raise ValueError(f"radius is {value}; give 0.1 to 50 mm")
        self._app.page.brush = value


# The page -------------------------------------------------------------------------------------------


def over(app: Explorer) -> None:
    """Build what catches the pointer while a tool that paints is in hand: see client/painting.js."""
    _at_hand(app)
    html.Div(
        v_if=f"{PAINTING} && slicing.shown", id="pv-paint", classes="pv-over", data_tool=("tool",),
        data_radius=("brush",), data_color=(
            "tool === 'erase' ? '#ffffff' : (painting.regions.find((r) => r.name === painting.active) || {}).color",),
        data_boxes=("JSON.stringify(slicing.boxes)",),
    )  # fmt: skip


def _at_hand(app: Explorer) -> None:
    """Build the tools over the picture, for when the panel that has them is closed."""
    del app
    with html.Div(
        v_if="slicing.shown && painting.regions.length && (!right_open || tab !== 'slices')", classes="pv-paint-tools",
        id="paint-tools", style=(
            "((view) => view ? {left: `calc(${100 * view.x}% + 60px)`, top: `calc(${100 * view.y}% + 8px)`, "
            "maxWidth: `calc(${100 * view.w}% - 68px)`} : {})(slicing.boxes.find((box) => box.name === '3d'))",),
    ):  # fmt: skip
        html.Span(classes="pv-dot", title=("painting.active",), style=(
            "{ background: (painting.regions.find((r) => r.name === painting.active) || {}).color }",))  # fmt: skip
        for name, icon, hint in ICONS:
            ui.icon_button(
                icon, hint, variant=(f"tool === '{name}' ? 'flat' : 'text'",),
                color=(f"tool === '{name}' ? 'primary' : 'white'",), data_paint_at_hand=name,
                click=f"tool = tool === '{name}' ? 'rotate' : '{name}'",
            )  # fmt: skip
        for step, icon, hint in ((1, "mdi-chevron-up", "Next slice"), (-1, "mdi-chevron-down", "Slice before")):
            v3.VBtn(icon=icon, size="x-small", variant="text", color="white", aria_label=hint,
                    data_slice_step=str(step))  # fmt: skip


def build(app: Explorer) -> None:
    """Build the part of the tab Slices."""
    paint = app.painting
    with html.Div(classes="pv-pair pr-2"):
        html.Div("Painted regions", classes="pv-head", style="flex: 1")
        ui.button("Labels", variant="text", prepend_icon="mdi-folder-open-outline",
                  click=(app.files.browse, "['', 'painted']"), data_action="open-labels",
                  title="Open labels as regions")  # fmt: skip
        ui.button("Region", prepend_icon="mdi-plus", click=paint.add, data_action="add-painted")
    html.Div(
        "Add a region and paint it on a slice; streamlines that pass it, miss it, end or stay in it are shown alone.",
        v_if="!painting.regions.length", classes="pv-small px-3",
    )  # fmt: skip
    with html.Div(v_if="painting.regions.length"):
        with html.Div(classes="pv-pair px-3 pt-1"):
            for name, icon, hint in ICONS:
                with v3.VBtn(
                    icon=True, size="small", density="comfortable", aria_label=hint, data_paint_tool=name,
                    click=f"tool = tool === '{name}' ? 'rotate' : '{name}'", **ui.pressed(f"tool === '{name}'"),
                ):  # fmt: skip
                    v3.VIcon(icon, size=18)
                    ui.tooltip(hint)
        with html.Div(classes="pv-pair px-3 pt-1", v_if="!['outline', 'sphere'].includes(tool)"), v3.VBtnToggle(
            model_value=("brush_deep ? '3-D' : '2-D'",), update_modelValue="brush_deep = $event === '3-D'",
            mandatory=True, density="compact", style="height: 28px",
        ):  # fmt: skip
            v3.VBtn("2-D", value="2-D", size="x-small", classes="text-none", title="In this slice only")
            v3.VBtn("3-D", value="3-D", size="x-small", classes="text-none", title="In neighbouring slices too",
                    data_action="deep")  # fmt: skip
        with ui.labelled(
            "Range ±", "How far values may be from the one that is clicked, of the image's window",
            v_if="tool === 'grow'",
        ):  # fmt: skip
            with html.Div(classes="pv-pair"):
                ui.slider(
                    model_value=("grow_share",), min=0, max=50, step=1, end=(paint.set_share, "[$event]"),
                    aria_label="Range of values, per cent of the image's window",
                )  # fmt: skip
                ui.number_field(style="width: 52px", value=("grow_share",),
                                change=(paint.set_share, "[$event.target.value]"),
                                aria_label="Range, per cent")  # fmt: skip
                html.Span("%", classes="pv-small")
        with ui.labelled("Brush", v_if="!['fill', 'outline', 'grow'].includes(tool)"):
            with html.Div(classes="pv-pair"):
                ui.slider(
                    model_value=("brush",), min=0.5, max=20, step=0.5, end=(paint.set_brush, "[$event]"),
                    aria_label="Radius of the brush, mm",
                )  # fmt: skip
                ui.number_field(style="width: 52px", value=("brush",),
                                change=(paint.set_brush, "[$event.target.value]"), aria_label="Radius, mm")  # fmt: skip
                html.Span("mm", classes="pv-small")
        html.Div(
            "The list under each region chooses which streamlines stay visible.", classes="pv-small px-3 pt-1",
            data_value="painted-use",
        )  # fmt: skip
        with html.Div(v_for="r in painting.regions", key="r.name", data_painted=("r.name",), classes="pv-region"):
            with html.Div(classes="pv-pair px-3 pt-1"):
                eye("r.visible", click=(paint.set, "[r.name, 'visible', !r.visible]"))
                html.Input(
                    type="color", classes="pv-colour", style="width: 26px", value=("r.color",),
                    aria_label="Colour", change=(paint.set, "[r.name, 'color', $event.target.value]"),
                )  # fmt: skip
                html.Input(
                    classes="pv-num", style="flex: 1; width: auto", value=("r.name",), maxlength=60, data_field="name",
                    change=(paint.rename, "[r.name, $event.target.value]"), aria_label="Name of the painted region",
                )  # fmt: skip
                ui.icon_button(
                    "mdi-brush", "Paint this one", 16, click=(paint.choose, "[r.name]"), data_action="paint-this",
                    **ui.pressed("painting.active === r.name", "text"),
                )  # fmt: skip
                ui.icon_button("mdi-delete-outline", "Remove", click=(paint.remove, "[r.name]"))
            with html.Div(classes="pv-pair px-3 pt-1"):
                ui.select(
                    items=(repr([{"title": title, "value": use} for use, title in USES.items()]),),
                    model_value=("r.use",), update_modelValue=(paint.set, "[r.name, 'use', $event]"),
                    aria_label="What streamlines do there", data_select="use",
                )  # fmt: skip
                for by, icon, hint in ((-1, "mdi-arrow-up", "Earlier"), (1, "mdi-arrow-down", "Later")):
                    v3.VBtn(
                        icon=icon, size="x-small", variant="text", v_if="r.use === 'in_order'", aria_label=hint,
                        click=(paint.move, f"[r.name, {by}]"), data_order=str(by),
                    )  # fmt: skip
                html.Span(
                    "{{ r.voxels }} voxels{{ r.passing === '' ? '' : ', ' + r.passing + ' pass' }}",
                    classes="pv-small", style="flex: none; min-width: 96px; text-align: right", data_value="painted",
                )  # fmt: skip
        html.Div("{{ painting.counted }}", v_if="painting.counted", classes="pv-value px-3 pt-2",
                 data_value="painted-counted")  # fmt: skip
        with html.Div(classes="pv-pair px-3 py-2"):
            html.Input(classes="pv-num", style="flex: 1; width: auto", placeholder="regions.nii.gz", id="painting-name",
                       v_model=("painting_name",), aria_label="Name of the file")  # fmt: skip
            ui.button("Save", size="small", prepend_icon="mdi-content-save-outline",
                      click=(paint.save, "[painting_name || 'regions']"), data_action="save-painted")  # fmt: skip
