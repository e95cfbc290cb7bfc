"""The page: bar above, layers and their properties left, tabs right, the picture between them."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from trame.ui.vuetify3 import VAppLayout
from trame.widgets import client, rca

from pvfiblets.web.panels import dialogs, matrix_panel
from pvfiblets.web.panels import elements as ui
from pvfiblets.web.panels import layers as panels
from pvfiblets.web.panels.elements import html, v3
from pvfiblets.web.panels.tabs import atlas_tab, painting_tab, slices_tab, tabs
from pvfiblets.web.panels.tabs.painting_tab import PAINTING

if TYPE_CHECKING:
    from pvfiblets.web.app import Explorer

VIEW = "view"
VIEWS = (
    ("axial", "Axial", "from above (1)"),
    ("coronal", "Coronal", "from the front (2)"),
    ("sagittal", "Sagittal", "from the left (3)"),
    ("oblique", "Oblique", "from the left, front and above (4)"),
)
TOOLS = (
    ("rotate", "mdi-rotate-orbit", "Turn, move and zoom (Esc)"),
    ("pick", "mdi-cursor-default-click-outline", "Pick a streamline (P)"),
    ("box", "mdi-selection", "Select in a box (B)"),
    ("lasso", "mdi-lasso", "Select in a lasso (L)"),
    ("measure", "mdi-ruler", "Measure between two points (M)"),
)
STYLE = """
html, body { overflow: hidden !important; overscroll-behavior: none }
.pv-view { position: absolute; top: var(--v-layout-top); bottom: 0; left: var(--v-layout-left);
  right: var(--v-layout-right); touch-action: none; background: #000 }
.pv-view.pv-less { right: calc(var(--v-layout-right) + min(340px, 50%)) }
.pv-matrix { position: absolute; top: var(--v-layout-top); bottom: 0; right: var(--v-layout-right);
  width: min(340px, 50%); overflow: hidden auto; background: rgb(var(--v-theme-surface)); z-index: 2;
  border-left: 1px solid rgba(128,128,128,.3) }
@media (max-width: 759.9px) {
  .pv-view.pv-less { right: var(--v-layout-right); bottom: 55% }
  .pv-matrix { left: var(--v-layout-left); width: auto; top: auto; height: 55%;
    border-top: 1px solid rgba(128,128,128,.3) }
}
.pv-matrix.pv-alone { left: var(--v-layout-left); top: var(--v-layout-top); width: auto; height: auto }
.pv-alone .pv-cells { max-width: min(100%, 100dvh - 230px) } /* its text stays in view */
.pv-cells { position: relative; aspect-ratio: 1; max-width: 460px; cursor: crosshair; touch-action: pan-y;
  margin: var(--names) 0 0 var(--names) }
.pv-matrix { --names: 76px } .pv-matrix.pv-alone { --names: 140px }
.pv-rows, .pv-columns { position: absolute; pointer-events: none; font-size: 10px; line-height: 12px; opacity: .8 }
.pv-rows { right: 100%; top: 0; bottom: 0; width: var(--names) }
.pv-columns { bottom: 100%; left: 0; right: 0; height: var(--names) }
.pv-rows span, .pv-columns span { position: absolute; overflow: hidden; white-space: nowrap; text-overflow: ellipsis }
.pv-rows span { right: 4px; max-width: calc(100% - 4px); transform: translateY(-50%) }
.pv-columns span { bottom: 4px; max-height: calc(100% - 4px); writing-mode: vertical-rl;
  transform: translateX(-50%) rotate(180deg) }
.pv-cells img { width: 100%; height: 100%; display: block; image-rendering: pixelated; user-select: none }
@media (max-width: 759.9px) { .pv-cells { max-width: min(460px, 33vh) } } /* its text stays in view */
@media (pointer: coarse) {
  :is(#left, #right, .pv-matrix, .v-overlay) :is(.v-btn, .v-list-item, .pv-colour, .pv-num) {
    min-height: 44px !important }
  :is(#left, #right, .pv-matrix, .v-overlay) :is(.v-btn, .pv-colour) { min-width: 44px !important }
  .v-btn-group { height: auto !important }
  #right .v-tabs { --v-tabs-height: 44px }
  .pv-grip { display: none } /* fingers scroll: there are buttons */
}
.pv-cross, .pv-chosen-cell { position: absolute; pointer-events: none; box-shadow: 0 0 0 1.5px #fff, 0 0 0 3px #000 }
.pv-chosen-cell { box-shadow: 0 0 0 2px #3df, 0 0 0 3.5px #000 }
.pv-view img { width: 100%; height: 100%; object-fit: contain; display: block;
  user-select: none; -webkit-user-drag: none }
.pv-there-place { position: absolute; pointer-events: none }
.pv-there { position: absolute; inset: 0; width: 100%; height: 100%; display: block; touch-action: none; outline: none;
  pointer-events: auto }
.pv-there-bars { position: absolute; right: 16px; bottom: 32px; display: flex; flex-direction: row-reverse; gap: 14px;
  align-items: flex-end;
  pointer-events: none; color: #fff; font: 12px/1.3 Roboto, sans-serif; font-variant-numeric: tabular-nums }
.pv-view[data-ground=light] .pv-there-bars { color: #000 }
#pv-there-progress { position: absolute; left: 50%; top: 50%; transform: translate(-50%, -50%); padding: 8px 12px;
  border-radius: 6px; background: #000c; color: #fff; font: 13px Roboto, sans-serif }
.pv-there-distances, .pv-there-distances svg { position: absolute; inset: 0; width: 100%; height: 100%;
  overflow: hidden; pointer-events: none; stroke: #fc0; stroke-width: 2 }
.pv-there-distances text { font: 14px Roboto, sans-serif; fill: #fc0; stroke: none; text-shadow: 1px 1px 1px #000 }
.pv-there-bar div { display: flex; gap: 6px } .pv-there-bar { margin: 0 }
.pv-there-bar canvas { width: 14px; height: min(220px, 30vh); border: .5px solid #8888; image-rendering: pixelated }
.pv-there-bar ol { list-style: none; margin: 0; padding: 0; display: flex; flex-direction: column;
  justify-content: space-between }
.pv-there-bar .pv-named { justify-content: space-around }
.pv-edge { position: absolute; color: #fff; font: 600 16px Roboto, sans-serif; pointer-events: none;
  text-shadow: 0 0 3px #000, 0 0 3px #000 }
.pv-view[data-ground=light] :is(.pv-edge, .pv-status, .pv-notes) { color: #000;
  text-shadow: 0 0 3px #fff, 0 0 3px #fff }
.pv-brush { position: absolute; border: 1.5px solid; border-radius: 50%; pointer-events: none;
  box-shadow: 0 0 0 1px #0008, inset 0 0 0 1px #0008 }
.pv-seams { position: absolute; inset: 0; z-index: 1; pointer-events: none }
.pv-seams div { position: absolute; box-shadow: 0 0 0 .5px #8888; }
.pv-told, .pv-status { position: absolute; bottom: 6px; max-width: calc(50% - 24px); font: 12px Roboto, sans-serif;
  text-shadow: 0 0 3px #000, 0 0 2px #000; font-variant-numeric: tabular-nums } /* beside the letter below */
.pv-told { left: 8px; color: #ffd040 }
.pv-tools { position: absolute; left: 8px; top: 8px; z-index: 3; display: flex; flex-direction: column; gap: 4px }
.pv-paint-tools { position: absolute; left: 60px; top: 8px; z-index: 4; display: flex; flex-wrap: wrap; gap: 2px;
  max-width: calc(100% - 68px); padding: 2px; border-radius: 8px; background: #000b }
.pv-paint-tools .pv-dot { align-self: center; width: 14px; height: 14px; margin: 0 4px }
@media (pointer: coarse) {
  .pv-tools .v-btn, [data-paint-tool], .pv-paint-tools .v-btn { width: 44px !important; height: 44px !important }
  header .v-btn--icon { width: min(44px, 12vw) !important } /* eight of them */
  header :is(.v-btn, .pv-colour) { min-height: 44px } header .pv-colour { min-width: 44px }
  .pv-num { font-size: 16px; padding: 6px }
}
.pv-over { position: absolute; inset: 0; z-index: 2; cursor: crosshair; touch-action: none }
.pv-over svg { width: 100%; height: 100% }
.pv-marks { position: absolute; inset: 0; z-index: 2; overflow: hidden; pointer-events: none }
.pv-marks svg { position: absolute; width: 100%; height: 100% }
.pv-marks polyline { fill: none; stroke: #7ad97a; stroke-width: 2; vector-effect: non-scaling-stroke }
.pv-marks .pv-not polyline { stroke: #ff7a7a; stroke-dasharray: 6 4 }
.pv-handle { position: absolute; width: 14px; height: 14px; margin: -7px 0 0 -7px; border-radius: 50%; z-index: 3;
  background: #7ad97a; border: 2px solid #000; box-shadow: 0 0 0 1px #fff8; cursor: grab; touch-action: none;
  pointer-events: auto }
.pv-handle::after { content: ""; position: absolute; inset: -10px } /* fingers are wider */
.pv-handle:active { cursor: grabbing }
.pv-handle[data-handle=center] { border-radius: 3px; cursor: move }
.pv-handle.pv-not { background: #ff7a7a }
.pv-mark-name { position: absolute; transform: translate(12px, -130%); color: #fff; font: 600 14px Roboto, sans-serif;
  text-shadow: 0 0 3px #000, 0 0 3px #000; white-space: nowrap }
.pv-label-row .v-btn__content { min-width: 0; overflow: hidden }
.pv-dot { width: 10px; height: 10px; border-radius: 50%; flex: none }
.pv-status { right: 8px; text-align: right; color: #fff; opacity: .85 }
.pv-notes { position: absolute; right: 8px; top: 8px; z-index: 3; max-width: calc(50% - 40px); display: flex;
  flex-direction: column; align-items: end; gap: 4px; text-align: right; font: 12px Roboto, sans-serif; color: #fff;
  text-shadow: 0 0 3px #000, 0 0 2px #000; pointer-events: none }
.pv-notes .v-btn { pointer-events: auto }
.pv-measured { display: flex; flex-direction: column; align-items: end; gap: 4px; max-height: 40vh; overflow-y: auto;
  pointer-events: auto }
.pv-measured .v-btn { flex: none }
.pv-bar { flex: 1 1 auto; min-width: 0; display: flex; align-items: center }
.pv-bar > *, .pv-wide > * { flex: none } .pv-bar > .v-spacer, .pv-wide > .v-spacer { flex: 1 0 0 }
.pv-wide { flex: 1 1 auto !important; display: flex; align-items: center; min-width: 0 }
@media (max-width: 759.9px), (max-width: 1059.9px) and (pointer: coarse) { .pv-wide { display: none } }
@media (min-width: 1060px), (min-width: 760px) and (not (pointer: coarse)) { .pv-narrow { display: none !important } }
.pv-progress { position: fixed !important; left: 50%; bottom: 24px; transform: translateX(-50%); z-index: 2400;
  max-width: calc(100vw - 16px) }
.pv-bar .v-btn { margin-inline: 0 !important }
.v-layout { overflow: clip !important } /* not even the focus moves it */
.v-snackbar__wrapper { min-width: 0 !important; max-width: min(672px, calc(100vw - 16px)) !important }
.v-snackbar__content { overflow-wrap: anywhere }
.pv-rail { display: flex; flex-direction: column; align-items: center; gap: 4px; padding: 6px 0 }
/* On a phone a panel takes the lower half, and the picture stays above it. */
@media (max-width: 759.9px) {
  :is(#left, #right) { inset: auto 0 0 0 !important; width: auto !important; height: 50dvh !important;
    border-width: 1px 0 0 }
  :is(#left, #right):not(.v-navigation-drawer--active) { transform: translateY(110%) !important }
  .v-navigation-drawer__scrim { display: none }
  .pv-view.pv-above { bottom: 50dvh }
  .pv-above .pv-told { left: 60px; max-width: calc(50% - 76px) } /* beside the tools */
}
.pv-scroll { overflow: hidden auto; min-height: 0 }
.pv-row { display: grid; grid-template-columns: 104px 1fr; align-items: center; gap: 8px; padding: 3px 12px }
.pv-row > label, .pv-row > .pv-label { font-size: 13px; line-height: 1.2; opacity: .85 }
.pv-value { font-size: 13px; font-variant-numeric: tabular-nums; overflow-wrap: anywhere }
.pv-head { font-size: 11px; letter-spacing: .08em; text-transform: uppercase; opacity: .6; padding: 10px 12px 2px }
.pv-fold { justify-content: space-between !important; margin-top: 6px; padding-inline: 12px !important; opacity: .8 }
.pv-name { font-size: 13px; font-weight: 600; padding: 10px 12px 0 }
.pv-num { width: 78px; flex: none; font: inherit; font-size: 13px; min-width: 0; color: inherit;
  background: transparent;
  border: 1px solid rgba(128,128,128,.5); border-radius: 4px; padding: 3px 6px }
.pv-num:focus { outline: 2px solid rgb(var(--v-theme-primary)); outline-offset: -1px }
.pv-colour { width: 44px; height: 26px; padding: 0; border: 1px solid rgba(128,128,128,.5); border-radius: 4px;
  background: none }
.pv-grip { cursor: grab; opacity: .45; font-size: 13px; user-select: none }
.pv-pair { display: flex; gap: 6px; align-items: center; min-width: 0 }
.pv-chart { margin: 0 6px } /* as wide as the slider below, so that its thumbs point at bars */
.pv-chart svg { width: 100%; height: 36px; display: block }
.pv-small { font-size: 12px; opacity: .75 }
.pv-code { white-space: pre; overflow: auto;
  font: 12px/1.45 "DejaVu Sans Mono", monospace; max-height: 60vh; padding: 12px;
  background: rgba(128,128,128,.12); border-radius: 6px; user-select: text }
.pv-table { width: 100%; border-collapse: collapse; font-size: 12.5px; font-variant-numeric: tabular-nums }
.pv-table th { text-align: right; font-weight: 500; opacity: .7; padding: 3px 6px; position: sticky; top: 0 }
.pv-table td { text-align: right; padding: 3px 6px; border-top: 1px solid rgba(128,128,128,.2) }
.pv-table td:first-child, .pv-table th:first-child { text-align: left }
[data-info] .pv-table td { vertical-align: top; overflow-wrap: anywhere }
[data-info] .pv-table td:first-child { overflow-wrap: normal; opacity: .8; padding-left: 0 }
[data-info] .pv-table th { position: static }
[data-info] .pv-table th:first-child { padding-left: 0 }
.pv-layer { min-height: 34px !important; padding-inline: 6px !important }
.pv-layer .v-list-item__spacer { width: 4px !important }
.v-switch .v-selection-control { min-height: 28px !important }
.v-switch__thumb { height: 16px !important; width: 16px !important; background: #fff !important }
.v-switch .v-selection-control--dirty .v-switch__thumb { background: rgb(var(--v-theme-primary)) !important }
.v-overlay .v-list-item { min-height: 34px !important }
.v-overlay .v-list-item-title { font-size: 13px }
.v-toolbar__content > .v-btn { margin-inline: 0 !important }
.v-slider { touch-action: pan-y }
.v-slider.v-input--horizontal { margin-inline: 6px }
.v-field-label { font-size: 13px !important }
.v-field__input { font-size: 13px !important; min-height: 30px !important; padding-top: 3px !important;
  padding-bottom: 3px !important }
"""

OVER_3D = (
    "((b) => ({ left: 100 * b.x + '%', top: 100 * b.y + '%', right: 'auto', bottom: 'auto', width: 100 * b.w + '%', "
    "height: 100 * b.h + '%' }))(slicing.boxes.find((b) => b.name === '3d') || { x: 0, y: 0, w: 1, h: 1 })"
)
"""Position of the 3-D view in the picture, as CSS."""

# Names are put in as text, by Vue.
MARKS = """
<svg viewBox="0 0 1000 1000" preserveAspectRatio="none">
  <g v-for="m in marks" :key="m.row" :class="m.not ? 'pv-not' : ''" :data-mark="m.name">
    <polyline v-for="(points, k) in m.lines" :key="k" :points="points"/>
  </g>
</svg>
<template v-for="m in marks" :key="'name' + m.row">
  <div class="pv-mark-name" :style="{ left: m.handles[0].x + '%', top: m.handles[0].y + '%' }">{{ m.name }}</div>
</template>
"""


def build(app: Explorer) -> Any:
    """Build the page of an application, and return its layout."""
    with VAppLayout(app.server, theme=("dark ? 'dark' : 'light'",)) as layout:
        client.Style(STYLE)
        with v3.VLayout(style="height: 100vh; height: 100dvh"):
            html.H1("pvfiblets", classes="d-sr-only")
            _bar(app)
            with v3.VNavigationDrawer(
                v_model=("left_open", True), width=312, location="left", mobile_breakpoint=("900",), id="left",
                aria_label="Layers and properties",
            ):
                with html.Div(style="display: flex; flex-direction: column; height: 100%"):
                    panels.layers(app)
                    panels.properties(app)
            with v3.VNavigationDrawer(
                v_model=("right_open", True), width=328, location="right", mobile_breakpoint=("1100",), id="right",
                aria_label="Tools",
            ):
                tabs.build(app)
            _rail("left", 900, "Layers", _layer_icons, app)
            _rail("right", 1100, "Tools", _tab_icons, app)
            with v3.VMain(style="position: relative; height: 100%"):
                _view(app)
                matrix_panel.build(app)
            dialogs.build(app)
    return layout


def _rail(side: str, least: int, label: str, icons: Callable[[Any], None], app: Explorer) -> None:
    """Build the icons that a folded panel leaves behind where a page is not too narrow for them."""
    with v3.VNavigationDrawer(
        v_if=f"!{side}_open && $vuetify.display.width >= {least}", permanent=True, width=48, location=side,
        id=f"{side}-rail", aria_label=f"{label}, folded",
    ):  # fmt: skip
        with html.Div(classes="pv-rail", click=f"{side}_open = true"):
            icons(app)


def _layer_icons(app: Explorer) -> None:
    with v3.VBtn(
        v_for="layer in layers", key="layer.id", icon=True, size="small", variant="text", aria_label=("layer.name",),
        click=(app.choose, "[layer.id]"), color=("layer.id === chosen ? 'primary' : undefined",),
    ):  # fmt: skip
        v3.VIcon(icon=(f"({panels.ICONS!r})[layer.kind]",), size=20)
        ui.tooltip("{{ layer.name }}", "right", label=("layer.name",))


def _tab_icons(_: Any) -> None:
    for name, title, icon in tabs.TABS:
        with v3.VBtn(
            icon=True, size="small", variant="text", aria_label=title, data_tab=name,
            click=f"tab = '{name}'", color=(f"tab === '{name}' ? 'primary' : undefined",),
        ):  # fmt: skip
            v3.VIcon(icon, size=20)
            ui.tooltip(title, "left")


SAVE = "utils.download('picture.png', trigger('picture'), 'image/png')"


def _bar(app: Explorer) -> None:
    with v3.VAppBar(density="compact", height=44, flat=True, border="b"):
        _icon("mdi-dock-left", "Layers and properties ([)", click="left_open = !left_open")
        with html.Div(classes="pv-bar"):
            _icon("mdi-folder-open-outline", "Open a file (O)", click=(app.files.browse, "['']"), name="open")
            _icon("mdi-content-save-outline", "Save or load a session (S)", click="dialog = 'session'", name="session")
            _icon("mdi-undo", "Undo {{ undo_label }} (Ctrl+Z)", click=app.undo, disabled=("!undo_label",), name="undo")
            _icon("mdi-redo", "Redo {{ redo_label }} (Ctrl+Y)", click=app.redo, disabled=("!redo_label",), name="redo")
            slices_tab.layout_menu(app)
            html.Button(hidden=True, data_action="screenshot", click=SAVE)  # of the key
            with html.Div(classes="pv-wide"):
                _wide(app)
            v3.VSpacer(classes="pv-narrow")
            _folded(app)
        _icon("mdi-dock-right", "Clip, filter, selection, information (])", click="right_open = !right_open")


def _wide(app: Explorer) -> None:
    """Build what a narrow page folds into a menu."""
    v3.VDivider(vertical=True, classes="mx-1")
    for name, title, hint in VIEWS:
        with v3.VBtn(
            title, size="small", variant="text", classes="px-2 text-none", data_view=name,
            click=(app.camera.view, f"['{name}']"),
        ):  # fmt: skip
            ui.tooltip(f"Look {hint}")
    _icon("mdi-swap-horizontal", "The other side (0)", click=app.camera.flip, name="flip")
    _icon("mdi-fit-to-screen-outline", "Show everything (R)", click=app.camera.reset, name="reset")
    _icon(
        "mdi-perspective-less", "Parallel or perspective (5)", name="parallel",
        click=app.camera.toggle_parallel, color=("parallel ? 'primary' : ''",),
    )  # fmt: skip
    with html.Label(classes="px-1", title="Background"):
        html.Input(
            type="color", classes="pv-colour", value=("background",), aria_label="Background",
            change=(app.camera.set_background, "[$event.target.value]"), style="width: 26px",
        )  # fmt: skip
    _icon("mdi-grid", "Matrix of connections", name="matrix", click=(app.matrix.open, "[!matrix.open]"),
          color=("matrix.open ? 'primary' : ''",))  # fmt: skip
    _icon("mdi-camera-outline", "Save the picture (C: as it is)", name="picture", click=app.camera.ask_picture)
    v3.VSpacer()
    _icon("mdi-language-python", "The same as a Python script", click=app.files.show_script, name="script")
    _icon("mdi-keyboard-outline", "Keys (?)", click="dialog = 'help'", name="help")
    _icon("mdi-theme-light-dark", "Light or dark (T)", click="dark = !dark", name="theme")
    _icon("mdi-close-circle-outline", "Close this session", click="dialog = 'end'", name="end", v_if="!shared")


def _folded(app: Explorer) -> None:
    """Build the same as a menu, which a narrow page shows."""
    items: list[tuple[str, str, Any]] = [
        *((f"{title} view", f"view-{name}", (app.camera.view, f"['{name}']")) for name, title, _ in VIEWS),
        ("The other side", "flip", app.camera.flip),
        ("Show everything", "reset", app.camera.reset),
        ("Parallel or perspective", "parallel", app.camera.toggle_parallel),
        ("Matrix of connections", "matrix", (app.matrix.open, "[!matrix.open]")),
        ("Save the picture…", "picture", app.camera.ask_picture),
        ("The same as a Python script", "script", app.files.show_script),
        ("Keys and pointer", "help", "dialog = 'help'"),
        ("Light or dark", "theme", "dark = !dark"),
    ]
    with v3.VBtn(
        icon=True, size="small", density="comfortable", variant="text", classes="pv-narrow", aria_label="More",
        data_action="more-of-bar",
    ):  # fmt: skip
        v3.VIcon("mdi-dots-vertical", size=20)
        with v3.VMenu(activator="parent", max_height="calc(100dvh - 60px)"), v3.VList(density="compact"):
            for title, name, click in items:
                v3.VListItem(title=title, click=click, data_menu=name)
            with v3.VListItem(title="Background"), v3.Template(v_slot_append=True):
                html.Input(
                    type="color", classes="pv-colour", value=("background",), aria_label="Background of the picture",
                    change=(app.camera.set_background, "[$event.target.value]"), v_on_click_stop="", data_menu="colour",
                )  # fmt: skip
            v3.VListItem(title="Close this session", click="dialog = 'end'", v_if="!shared", data_menu="end")


def _icon(icon: str, hint: str, *, name: str | None = None, **rest: Any) -> None:
    if name is not None:
        rest["data_action"] = name
    label = hint.replace("{{ undo_label }} ", "").replace("{{ redo_label }} ", "")
    with v3.VBtn(
        icon=True,
        size="small",
        density="comfortable",
        variant="text",
        aria_label=label,
        **rest,
    ):
        v3.VIcon(icon, size=20)
        ui.tooltip(hint, label=label)


def _view(app: Explorer) -> None:
    # A bright background needs dark letters, whatever the theme of the panels is.
    bright = "[1, 3, 5].reduce((sum, k) => sum + parseInt(background.slice(k, k + 2), 16), 0) > 382"
    with html.Div(
        classes=("['pv-view', matrix.open ? 'pv-less' : '', left_open || right_open ? 'pv-above' : '']",),
        id="pv-view",
        data_ground=(f"{bright} ? 'light' : 'dark'",),
    ):
        area = rca.RemoteControlledArea(
            name=VIEW,
            display="image",
            event_throttle_ms=20,
            image_style=("({width: '100%', height: '100%'})",),
            style="position: absolute; inset: 0; width: 100%; height: 100%",
        )
        area.add_view_handler(app.stream)
        with html.Div(classes="pv-there-place", style=(f"({OVER_3D})",)):
            html.Canvas(  # of client/browser_renderer.js
                id="pv-there", classes="pv-there", tabindex="0", role="img", style="visibility: hidden",
                aria_label="The scene. Arrow keys turn it, plus and minus zoom, Shift with arrows moves it.",
            )  # fmt: skip
            html.Div(id="pv-there-distances", classes="pv-there-distances")
            html.Div(id="pv-there-bars", classes="pv-there-bars")
            with html.Div(id="pv-there-progress", role="status", hidden=True):
                html.Span("Drawing the scene…")
                v3.VProgressLinear(indeterminate=True, color="primary", aria_label="Drawing the scene")
        with html.Div(  # over the 3-D view, wherever that is
            v_if="show_regions && marks.length && slicing.boxes.every((b) => b.name !== '3d') === !slicing.shown",
            classes="pv-marks", id="pv-marks", style=(f"({OVER_3D})",),
        ):  # fmt: skip
            html.Div(MARKS)
            with html.Div(v_if="tool === 'rotate' && tab === 'filter'"):  # dragged by client/regions.js
                with v3.Template(v_for="m in marks", key="m.row"):
                    html.Div(
                        v_for="h in m.handles", key="m.row + h.name", classes=("['pv-handle', m.not ? 'pv-not' : '']",),
                        style=("{ left: h.x + '%', top: h.y + '%' }",), data_row=("m.row",), data_handle=("h.name",),
                        title=("h.name === 'center' ? 'Move ' + m.name : 'Size of ' + m.name",),
                    )  # fmt: skip
        # Drawn by client/pvfiblets.js, which reads the tool from the attribute.
        drawn = f"!['rotate', 'ask'].includes(tool) && !{PAINTING}"
        html.Div(v_if=drawn, classes="pv-over", id="pv-over", data_tool=("tool",))
        painting_tab.over(app)
        slices_tab.over()
        atlas_tab.over()
        with html.Div(
            v_if="['3d', 'beside'].includes(slicing.layout)", style=(
                f"({{ position: 'absolute', pointerEvents: 'none', ...{OVER_3D} }})",),
        ):  # fmt: skip
            for edge, place in (
                ("left", "left: 52px; top: 50%"),
                ("right", "right: 8px; top: 50%"),
                ("top", "top: 4px; left: 50%"),
                ("bottom", "bottom: 4px; left: 50%"),
            ):
                html.Div(
                    f"{{{{ edges.{edge} }}}}", v_if=f"edges.{edge}", classes="pv-edge", style=place, data_edge=edge
                )
        with html.Div(classes="pv-tools"):
            for name, icon, hint in TOOLS:
                with v3.VBtn(
                    icon=True, size="small", density="comfortable", aria_label=hint, click=f"tool = '{name}'",
                    color=(f"tool === '{name}' ? 'primary' : undefined",), data_tool_button=name,
                ):  # fmt: skip
                    v3.VIcon(icon, size=20)
                    ui.tooltip(hint, "right")
        with html.Div(style=(f"({{ position: 'absolute', zIndex: 2, pointerEvents: 'none', ...{OVER_3D} }})",)):
            slices_tab.readout()
            html.Div("{{ frame }}", classes="pv-status", title=("drawing",))
        with html.Div(classes="pv-notes"):
            with html.Div(v_if="measured.length", classes="pv-measured"):
                v3.VBtn(
                    "{{ text }}", v_for="(text, row) in measured", key="row", size="x-small", classes="text-none",
                    append_icon="mdi-close", title="Remove this distance", data_action="remove-distance",
                    click=(app.selecting.remove_distance, "[row]"),
                )  # fmt: skip
                v3.VBtn(
                    "Clear all", v_if="measured.length > 1", size="x-small", classes="text-none",
                    data_action="clear-distances", click=app.selecting.clear_distances,
                )  # fmt: skip
            html.Div("{{ no_room }}", v_if="no_room", data_value="no-room")
            html.Div(
                "{{ measuring ? 'Click the second point' : 'Click two points, or drag' }} (Esc: stop)",
                v_if="tool === 'measure'", data_value="measuring",
            )  # fmt: skip
            html.Div(
                "Click where {{ placing_name }} shall be (Esc: stop)", v_if="tool === 'place'", data_value="placing"
            )
        with html.Div(
            v_if="!layers.length && !job.text",
            style="position: absolute; inset: 0; display: grid; place-items: center; z-index: 3; pointer-events: none",
        ):
            with html.Div(style="pointer-events: auto; text-align: center; color: #fff"):
                html.Div("Nothing is open yet", classes="text-h6 mb-2")
                v3.VBtn("Open a file", color="primary", click=(app.files.browse, "['']"), classes="ma-1 text-none")
                v3.VBtn("Open the demo", variant="outlined", click=app.files.open_demo, classes="ma-1 text-none")
