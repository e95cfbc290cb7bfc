"""Dialogs of the page: files, sessions, the script, keys, renaming, progress and messages."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from pvfiblets.web.panels import elements as ui
from pvfiblets.web.panels.elements import html, v3
from pvfiblets.web.server.access import LARGEST_SESSION

if TYPE_CHECKING:
    from pvfiblets.web.app import Explorer

KEYS = (
    ("1 2 3 4", "axial, coronal, sagittal, oblique"),
    ("0", "view from the other side"),
    ("R", "show everything"),
    ("5", "parallel or perspective"),
    ("Esc", "turn, move and zoom with the pointer"),
    ("P B L", "pick, box, lasso; with Shift add to the selection"),
    ("M", "measure: two clicks, or a drag"),
    ("X", "slices, or the 3-D view alone"),
    ("arrows  Page Up Down", "in a pane: move the cross-hair, go through slices"),
    ("G", "on slices: type the position"),
    ("N E F U J W", "on slices: brush, erase, fill, outline, ball, grow"),
    ("comma, full stop", "previous, next volume of an image"),
    ("V", "show or hide the chosen layer"),
    ("Del", "remove the chosen layer"),
    ("Ctrl+Z  Ctrl+Y", "undo, redo"),
    ("O S C", "open a file, sessions, save the image"),
    ("T", "light or dark"),
    ("[  ]", "left and right side"),
    ("?", "this list"),
)
POINTER = (
    ("drag", "turn; one finger"),
    ("Shift + drag, middle button", "move; two fingers"),
    ("wheel, right button", "zoom; pinch"),
    ("Ctrl + drag", "roll"),
)


SAVE = (  # of a session that is too large the page gets only an error
    "trigger('save_session').then((text) => text && utils.download('session.json', text, 'application/json'))"
)
LABEL = "cursor: pointer; background: rgba(128,128,128,.2)"  # of files to choose: labels that look like buttons


def build(app: Explorer) -> None:
    """Build all of them."""
    # Outside of the dialogs: an input in a dialog that another user has closed would receive no file.
    html.Input(type="file", hidden=True, id="pv-upload", multiple=True, data_upload=True, data_limit=("upload_limit",))
    html.Input(type="file", accept=".json,application/json", hidden=True, id="pv-session", data_session=True,
               data_limit=LARGEST_SESSION)  # fmt: skip
    _files(app)
    _sessions(app)
    _picture(app)
    _script()
    _help()
    _rename(app)
    _end()
    _progress(app)
    with v3.VSnackbar(
        v_model=("toast_open", False),
        timeout=8000,
        color=("toast_kind",),
        location="bottom",
        id="toast",
        style=("job.text || uploading ? 'margin-bottom: 100px' : ''",),  # above how far things are
    ):
        html.Span("{{ toast }}", data_toast=True)
        with v3.Template(v_slot_actions=True):
            v3.VBtn("Close", variant="text", classes="text-none", click="toast_open = false")


def _dialog(name: str, title: str, width: int) -> Any:
    dialog = v3.VDialog(
        model_value=(f"dialog === '{name}'",),
        update_modelValue=f"dialog = !$event && dialog === '{name}' ? '' : dialog",
        max_width=width,
        scrollable=True,
        aria_label=title,
    )
    with dialog:
        card = v3.VCard(id=f"dialog-{name}")
        with card:
            with html.Div(classes="d-flex align-center px-4 pt-3 pb-1"):
                html.Div(title, classes="text-subtitle-1 font-weight-medium", style="flex: 1")
                with v3.VBtn(icon=True, size="small", variant="text", click="dialog = ''", aria_label="Close"):
                    v3.VIcon("mdi-close")
    return card


# Folders come first, however files are sorted; sorting is stable, and the server's order is by name.
LISTED = (
    "entries.filter((e) => e.name.toLowerCase().includes((file_search || '').toLowerCase()))"
    ".sort((a, b) => b.folder - a.folder || (file_sort === 'name' || a.folder ? 0 : b[file_sort] - a[file_sort]))"
)


def _files(app: Explorer) -> None:
    with _dialog("open", "Open a file", 620):
        with html.Div(classes="px-4 pb-1 pv-pair"):
            with v3.VBtn(
                icon=True, size="small", variant="text", aria_label="Folder above", disabled=("!folder",),
                click=(app.files.browse, "[folder.split('/').slice(0, -1).join('/')]"),
            ):  # fmt: skip
                v3.VIcon("mdi-arrow-up")
            html.Span("/{{ folder }}", classes="pv-value", style="flex: 1")
            with html.Label(v_if="upload_limit > 0", classes="v-btn v-btn--density-default v-btn--size-small "
                            "v-btn--variant-tonal px-3 text-none", style=LABEL, **{"for": "pv-upload"}):  # fmt: skip
                html.Span("Upload…")
        with html.Div(classes="px-4 pb-1 pv-pair"):
            v3.VTextField(
                v_model=("file_search",), placeholder="Search", density="compact", variant="outlined",
                hide_details=True, prepend_inner_icon="mdi-magnify", aria_label="Search",
                data_field="search",
            )  # fmt: skip
            with v3.VBtnToggle(v_model=("file_sort",), mandatory=True, density="compact", style="height: 32px"):
                for name, title in (("name", "Name"), ("bytes", "Size"), ("time", "Newest")):
                    v3.VBtn(title, value=name, size="x-small", classes="text-none", data_sort=name)
        with v3.VCardText(classes="pa-0", style="max-height: 60vh"):
            with v3.VList(density="compact"):
                with v3.VListItem(
                    v_for=f"e in {LISTED}",
                    key="e.path",
                    click=(app.files.take, "[e.path, e.folder]"),
                    title=("e.name",),
                    subtitle=("e.detail",),
                    prepend_icon=("e.icon",),
                    data_entry=("e.name",),
                ):
                    with v3.Template(v_slot_append=True):
                        html.Input(
                            type="checkbox", v_if="several && !e.folder", classes="pv-mark", data_mark=("e.name",),
                            checked=("marked.includes(e.path)",), aria_label=("'Choose ' + e.name",),
                            v_on_click_stop=(app.files.mark, "[e.path]"),
                        )  # fmt: skip
            html.Div("No files that can be opened here.", v_if="!entries.length", classes="pv-small pa-4")
            html.Div(
                "No matching file.",
                v_if=f"entries.length && !{LISTED}.length",
                classes="pv-small pa-4",
            )
        with html.Div(classes="px-4 py-1 pv-pair", v_if="entries.some((e) => e.spaced)", data_part="space"):
            html.Span("VTK files without a space are in", classes="pv-small", style="flex: 1")
            with v3.VBtnToggle(v_model=("open_space",), mandatory=True, density="compact", style="height: 32px"):
                for name in ("RAS", "LPS"):
                    v3.VBtn(name, value=name, size="x-small", classes="text-none", data_space=name)
        with v3.VCardActions(v_if="marked.length"):
            html.Span("{{ marked.length }} chosen", classes="pv-small px-2")
            v3.VSpacer()
            v3.VBtn("Open them", color="primary", variant="tonal", classes="text-none", click=app.files.take_marked,
                    data_action="open-marked")  # fmt: skip


def _sessions(app: Explorer) -> None:
    with _dialog("session", "Session", 460):
        with v3.VCardText():
            html.Div("A session file stores layers, camera, cuts, filters and selections, but no data.",
                     classes="pv-small mb-3")  # fmt: skip
            with html.Div(classes="d-flex flex-wrap", style="gap: 8px"):
                v3.VBtn("Save", color="primary", classes="text-none", data_action="save-session", click=SAVE)
                with html.Label(classes="v-btn v-btn--density-default v-btn--size-default v-btn--variant-tonal px-4 "
                                "text-none", style=LABEL, **{"for": "pv-session"}):  # fmt: skip
                    html.Span("Load…")
            html.Div("Or save it in the served folder, and open it like any other file.",
                     classes="pv-small mt-4 mb-1")  # fmt: skip
            with html.Form(
                classes="pv-pair", v_on_submit_prevent=(app.files.store_session, "[$event.target[0].value]")
            ):
                html.Input(classes="pv-num", value="session.json", style="flex: 1; width: auto", aria_label="File name",
                           data_read_later=True)  # fmt: skip
                v3.VBtn("Save there", type="submit", variant="tonal", classes="text-none", data_action="store-session")


def _picture(app: Explorer) -> None:
    with _dialog("picture", "Save the picture", 420), v3.VCardText(classes="px-1 pt-0"):
        with ui.labelled("Times the view"):
            with html.Div(classes="pv-pair", style="flex-wrap: wrap"):
                for times in (1, 2, 3, 4):
                    v3.VBtn(f"{times}", size="x-small", variant="tonal", click=(app.camera.ask_picture, f"[{times}]"),
                            aria_label=f"{times} times as large as the view", data_times=times)  # fmt: skip
        for label, name, unit in (("Width", "width", "pixels"), ("Height", "height", "pixels")):
            with ui.labelled(label):
                with html.Div(classes="pv-pair"):
                    html.Input(classes="pv-num", inputmode="numeric", value=(f"picture.{name}",), aria_label=label,
                               id=f"picture-{name}", data_read_later=True)  # fmt: skip
                    html.Span(unit, classes="pv-small")
        with ui.labelled("For print"):
            with html.Div(classes="pv-pair"):
                ui.number_field(value="300", aria_label="Pixels per inch", id="picture-dpi", data_read_later=True)
                html.Span("dpi", classes="pv-small")
        with html.Label(classes="pv-row", style="cursor: pointer"):
            html.Span("Background", classes="pv-label")
            with html.Span(classes="pv-pair pv-value"):
                html.Input(type="checkbox", id="picture-transparent")
                html.Span("transparent")
        html.Div("Lines and letters keep their size relative to the image. Large images take a while.",
                 classes="pv-small px-3 pt-2")  # fmt: skip
        with html.Div(classes="d-flex justify-end pt-2 px-3"):
            v3.VBtn("Save", color="primary", classes="text-none", data_action="save-picture")


def _script() -> None:
    with _dialog("script", "The same picture in Python", 820):
        with v3.VCardText():
            html.Div("{{ script }}", classes="pv-code", id="script")
        with v3.VCardActions():
            v3.VSpacer()
            v3.VBtn("Download", color="primary", variant="tonal", classes="text-none",
                    click="utils.download('scene.py', script, 'text/x-python')")  # fmt: skip


def _help() -> None:
    with _dialog("help", "Keys and pointer", 520), v3.VCardText():
        for rows in (KEYS, POINTER):
            with html.Table(classes="mb-3", style="width: 100%; font-size: 13px"):
                for keys, meaning in rows:
                    with html.Tr():
                        html.Td(keys, style="width: 40%; font-weight: 500; padding: 3px 0")
                        html.Td(meaning)


def _rename(app: Explorer) -> None:
    with _dialog("rename", "Rename", 400), v3.VCardText():
        html.Input(
            id="rename", value=("chosen_name",), classes="pv-num", style="width: 100%; font-size: 15px; padding: 8px",
            change=(app.rename, "[chosen, $event.target.value]"), aria_label="Name", autofocus=True,
        )  # fmt: skip


def _end() -> None:
    with _dialog("end", "Close this session?", 420):
        v3.VCardText("Unsaved changes are lost; the place becomes free for another browser.")
        with html.Form(method="post", action="/end", classes="d-flex justify-end pa-3", style="gap: 8px"):
            v3.VBtn("Cancel", variant="text", classes="text-none", click="dialog = ''")
            v3.VBtn("Close", type="submit", color="primary", classes="text-none", data_action="end-session")


def _progress(app: Explorer) -> None:
    with v3.VCard(
        v_if="job.text", elevation=8, width=340, id="busy", classes="pv-progress",
    ):  # fmt: skip
        with html.Div(classes="pa-3"):
            with html.Div(classes="pv-pair mb-2"):
                html.Span(
                    "{{ job.text }}", style="flex: 1; font-size: 13px", classes="text-truncate", title=("job.text",)
                )
                ui.button("Cancel", v_if="job.cancellable", click=app.files.cancel, data_action="cancel")
            v3.VProgressLinear(
                model_value=("job.share",), indeterminate=("job.share < 0",), color="primary", aria_label=("job.text",),
            )  # fmt: skip
            html.Div(
                "{{ job.then }}", v_if="job.then", style="font-size: 12px; opacity: .7", classes="text-truncate mt-2",
                title=("job.then",), id="waiting",
            )  # fmt: skip
    with v3.VCard(
        v_if="uploading && !job.text", elevation=8, width=340, id="uploading", classes="pv-progress",
    ):  # fmt: skip
        with html.Div(classes="pa-3"):
            with html.Div(classes="pv-pair mb-2"):
                html.Span(
                    "Uploading {{ uploading }}",
                    style="flex: 1; font-size: 13px",
                    classes="text-truncate",
                    title=("uploading",),
                )
                ui.button("Cancel", data_action="cancel-upload")
            v3.VProgressLinear(
                model_value=("uploaded",), indeterminate=("uploaded < 0",), color="primary", aria_label=("uploading",),
            )  # fmt: skip
