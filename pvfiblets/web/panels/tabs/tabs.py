"""The right side: Clip, Filter, Selection and Info."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from pvfiblets.web.panels import elements as ui
from pvfiblets.web.panels.controls import NAMES
from pvfiblets.web.panels.elements import eye, fold, html, v3
from pvfiblets.web.panels.files.writing import EXPORTS
from pvfiblets.web.panels.tabs import bundles_tab, slices_tab

if TYPE_CHECKING:
    from pvfiblets.web.app import Explorer

TABS = (
    ("clip", "Clip", "mdi-content-cut"), ("filter", "Filter", "mdi-filter-outline"),
    ("selection", "Selection", "mdi-selection-ellipse"), ("bundles", "Bundles", "mdi-group"),
    ("slices", "Slices", "mdi-layers-outline"), ("info", "Info", "mdi-information-outline"),
)  # fmt: skip
TAB = "min-width: 0; font-size: 13px; letter-spacing: 0"
CUTS = (("plane", "Plane"), ("slab", "Slab"), ("box", "Box"), ("sphere", "Sphere"))
WHAT = (("selected", "selected streamlines"), ("shown", "visible streamlines"), ("all", "all streamlines"))
WHERE = (("folder", "the served folder"), ("computer", "this computer"))


def build(app: Explorer) -> None:
    """Build the tabs."""
    with html.Div(style="display: flex; flex-direction: column; height: 100%"):
        with v3.VTabs(v_model=("tab", "clip"), density="compact", grow=True, style="flex: none", show_arrows=False):
            for name, title, _ in TABS:
                v3.VTab(title, value=name, classes="text-none px-0", style=TAB, data_tab=name)
        with html.Div(classes="pv-scroll", style="flex: 1 1 auto"):
            with html.Div(v_if="tab === 'clip'", id="tab-clip"):
                _clip(app)
            with html.Div(v_if="tab === 'filter'", id="tab-filter"):
                _filter(app)
            with html.Div(v_if="tab === 'selection'", id="tab-selection"):
                _selection(app)
            with html.Div(v_if="tab === 'bundles'", id="tab-bundles", classes="pv-bundles"):
                bundles_tab.build(app)
            with html.Div(v_if="tab === 'slices'", id="tab-slices"):
                slices_tab.build(app)
            with html.Div(v_if="tab === 'info'", id="tab-info"):
                _info()


def _slider_rows(change: Any, typed: Any, kind: str, owner: str, rows: str) -> None:
    """Build sliders, with their numbers in mm to type, for a list of described values."""
    shown = f"(held.at === '{kind} ' + {owner} + ' ' + c.name ? held.shown : c.shown)"

    def field(end: int, label: str) -> None:
        ui.number_field(
            value=(f"{shown}[{end}]",), style="width: 60px", title="mm",
            change=(typed, f"[{owner}, c.name, {end}, $event.target.value]"), aria_label=(f"c.label + '{label}, mm'",),
        )  # fmt: skip

    with ui.labelled("{{ c.label }}", ("c.help || ''",), v_for=f"c in {rows}", key="c.name", data_control=("c.name",)):
        with html.Div(style="min-width: 0"):
            common: dict[str, Any] = {
                "min": ("c.limits[0]",), "max": ("c.limits[1]",), "step": ("c.step",), "density": "compact",
                "hide_details": True, "color": "primary", "thumb_size": 14, "track_size": 3,
                "model_value": ("c.value",), "end": (change, f"[{owner}, c.name, $event]"), "aria_label": ("c.label",),
                "data_live": (f"JSON.stringify(['{kind}', {owner}, c.name])",),
            }  # fmt: skip
            with html.Div(v_if="c.type === 'range'"):
                v3.VRangeSlider(**common)
                with html.Div(classes="pv-pair pv-small", style="justify-content: space-between"):
                    field(0, " from")
                    html.Span("to", style="flex: 1; text-align: center")
                    field(1, " to")
                    html.Span("mm")
            with html.Div(v_else=True, classes="pv-pair"):
                v3.VSlider(**common, style="min-width: 0")
                field(0, "")
                html.Span("mm", classes="pv-small")


def _clip(app: Explorer) -> None:
    with html.Div(classes="pa-2", style="display: flex; flex-wrap: wrap; gap: 6px"):
        for kind, title in CUTS:
            ui.button(title, size="small", click=(app.cuts.add, f"['{kind}']"), prepend_icon="mdi-plus", data_cut=kind)
        ui.button(
            "Mesh", size="small", prepend_icon="mdi-plus", click=(app.files.browse, "['', 'clip']"), data_cut="mesh",
        )  # fmt: skip
    html.Div(
        "Add a plane, a box or another shape, which hides its other side. A cut applies to all tractograms, or to "
        "the layers chosen for it.",
        v_if="!clips.length", classes="pv-small px-3",
    )  # fmt: skip
    with html.Div(v_for="clip in clips", key="clip.id", data_clip=("clip.id",)):
        with html.Div(classes="pv-pair px-2 pt-2"):
            eye("clip.enabled", "Switch off", "Switch on", click=(app.cuts.enable, "[clip.id, !clip.enabled]"))
            html.Span("{{ clip.name }}", style="flex: 1; font-size: 13px; font-weight: 500")
            ui.button(
                "{{ clip.side }}", click=(app.cuts.turn, "[clip.id, !clip.inside]"), title="Show the other side",
                data_action="side",
            )  # fmt: skip
            ui.icon_button("mdi-delete-outline", "Remove", click=(app.cuts.remove, "[clip.id]"))
        with html.Div(v_if="clip.axes", classes="pv-pair px-3 pt-1", style="flex-wrap: wrap"):
            for axis, name in zip("xyz", NAMES, strict=True):
                v3.VBtn(
                    name.capitalize(), size="x-small", classes="text-none px-2",
                    click=(app.cuts.set_axis, f"[clip.id, '{axis}']"), data_axis=axis,
                    **ui.pressed(f"clip.axis === '{axis}'"),
                )  # fmt: skip
            v3.VBtn("View", size="x-small", variant="tonal", title="Facing the camera", classes="text-none px-2",
                    click=(app.cuts.set_axis, "[clip.id, 'view']"), data_axis="view")  # fmt: skip
        _slider_rows(app.cuts.set_value, app.cuts.set_end, "clip", "clip.id", "clip.controls")
        with ui.labelled("Cuts"):
            ui.select(
                items=("clip.items",), model_value=("clip.layers",), multiple=True, placeholder="nothing",
                aria_label="Layers that are cut", update_modelValue=(app.cuts.set_layers, "[clip.id, $event]"),
                data_select="clip-layers",
            )  # fmt: skip
        v3.VDivider(classes="mt-2")


def _filter(app: Explorer) -> None:
    html.Div(
        "Choose a tractogram on the left to filter its streamlines.", v_if="!filters.layer", classes="pv-small pa-3"
    )
    with html.Div(v_if="filters.layer"):
        with html.Div(classes="pv-pair px-3 pt-2"):
            html.Span(
                "{{ held.counted || filters.counted }}", classes="pv-value", style="flex: 1", data_value="counted"
            )
            ui.button("Show all", click=app.filtering.clear, disabled=("!filters.active",))
        html.Div("Criteria", classes="pv-head")
        with html.Div(v_for="c in filters.criteria", key="c.name", data_criterion=("c.name",)):
            with html.Div(classes="pv-pair px-3"):
                html.Span("{{ c.label }}", style="flex: 1; font-size: 13px")
                ui.icon_button("mdi-close", "Remove", 16, click=(app.filtering.remove, "[c.name]"))
            html.Div(v_html=("c.chart",), classes="pv-chart mx-4")
            ui.slider(
                "VRangeSlider", model_value=("c.value",), min=("c.limits[0]",), max=("c.limits[1]",), step=("c.step",),
                end=(app.filtering.set_criterion, "[c.name, $event]"), classes="mx-4", aria_label=("c.label",),
                data_live=("JSON.stringify(['criterion', 'of', c.name])",),
            )  # fmt: skip
            shown = "(held.at === 'criterion of ' + c.name ? held.shown : c.shown)"
            with html.Div(classes="pv-pair px-4 pb-2", style="justify-content: space-between"):
                for end in (0, 1):
                    ui.number_field(
                        value=(f"{shown}[{end}]",),
                        change=(app.filtering.set_end, f"[c.name, {end}, $event.target.value]"),
                        aria_label=(f"c.label + ({end} ? ', most' : ', least')",),
                    )  # fmt: skip
        ui.select(
            label="Add a criterion", items=("filters.more",), model_value=("null",), classes="mx-3 my-1",
            id="add-criterion", update_modelValue=(app.filtering.add, "[$event]"),
        )  # fmt: skip
        with html.Div(v_if="filters.groups && filters.groups.length"):
            html.Div("Groups", classes="pv-head")
            ui.select(
                items=("filters.groups",), model_value=("filters.shown_groups",), multiple=True, chips=True,
                closable_chips=True, clearable=True, placeholder="all", classes="mx-3",
                aria_label="Groups",
                update_modelValue=(app.filtering.set_groups, "[$event]"),
            )  # fmt: skip
        html.Div("Random subset", classes="pv-head")
        with html.Div(classes="pv-row"):
            html.Span("{{ held.at === 'share of streamlines' ? held.shown[0] : filters.share }} %", classes="pv-value")
            ui.slider(
                model_value=("filters.share",), min=1, max=100, step=1, end=(app.filtering.set_share, "[$event]"),
                aria_label="Share of streamlines", data_live=("JSON.stringify(['share', 'of', 'streamlines'])",),
            )  # fmt: skip
        _regions(app)


def _regions(app: Explorer) -> None:
    regions = app.regions
    with html.Div(classes="pv-pair pr-2"):
        html.Div("Regions", classes="pv-head", style="flex: 1")
        eye("show_regions", "Hide regions in the picture", "Show regions in the picture", data_action="show-regions",
            v_if="filters.regions.length", click="show_regions = !show_regions", title="Show regions in the view",
            )  # fmt: skip
    with html.Div(classes="pv-pair px-3 pb-1", style="flex-wrap: wrap"):
        ui.button("Sphere", size="small", prepend_icon="mdi-plus", click=(regions.add, "['sphere']"),
                  data_region="sphere")  # fmt: skip
        ui.button("Box", size="small", prepend_icon="mdi-plus", click=(regions.add, "['box']"), data_region="box")
        ui.button("File", size="small", prepend_icon="mdi-plus", title="A closed mesh, or a volume of labels",
                  click=(app.files.browse, "['', 'region']"), data_region="file")  # fmt: skip
    html.Div(
        "Add a sphere or a box, and drag it or place it by a click; only streamlines through it stay visible. “not” "
        "keeps streamlines outside it.",
        v_if="!filters.regions.length", classes="pv-small px-3",
    )  # fmt: skip
    with html.Div(v_if="filters.regions.length", classes="pv-pair px-3 pb-1"):
        html.Span(
            "{{ filters.sentence }}", classes="pv-small", style="flex: 1; overflow-wrap: anywhere",
            data_value="sentence",
        )  # fmt: skip
        with v3.VBtnToggle(
            v_if="filters.regions.length > 1", model_value=("filters.join",), mandatory=True, density="compact",
            update_modelValue=(regions.set_join, "[$event]"), style="height: 26px",
        ):  # fmt: skip
            v3.VBtn("all", value="and", size="x-small", classes="text-none", title="All of these must hold")
            v3.VBtn("any", value="or", size="x-small", classes="text-none", title="One of these must hold")
    with html.Div(v_for="(r, i) in filters.regions", key="i", data_region_row=("i",), classes="pv-region"):
        with html.Div(classes="pv-pair px-3 pt-1"):
            html.Span(classes="pv-dot", style=("{ background: r.not ? '#ff7a7a' : '#7ad97a' }",))
            html.Input(
                classes="pv-num", style="flex: 1; width: auto; font-weight: 600", value=("r.name",), maxlength=40,
                change=(regions.rename, "[i, $event.target.value]"), aria_label="Name of the region",
                title=("r.file || r.kind",), data_field="name",
            )  # fmt: skip
            with v3.VBtn(
                v_if="r.kind === 'sphere' || r.kind === 'box'", size="x-small", variant=(
                    "tool === 'place' && placing === i ? 'flat' : 'tonal'",), classes="text-none",
                click=(regions.begin_placing, "[i]"), prepend_icon="mdi-target", data_action="place",
                title="Move it to the next click: on a streamline, a slice or a surface",
            ):  # fmt: skip
                html.Span("Place")
            ui.icon_button("mdi-delete-outline", "Remove", click=(regions.drop, "[i]"))
        with html.Div(classes="pv-pair px-3 pt-1"):
            ui.button(
                "not", variant=("r.not ? 'flat' : 'outlined'",), color=("r.not ? 'error' : ''",),
                click=(regions.set_not, "[i, !r.not]"), style="min-width: 36px",
                title="Invert: keep all other streamlines",
            )  # fmt: skip
            ui.select(
                items=("filters.hows",), model_value=("r.how",), update_modelValue=(regions.set_how, "[i, $event]"),
                aria_label="What streamlines do there",
            )  # fmt: skip
        html.Div("{{ r.file }}", v_if="r.file", classes="pv-small px-3 text-truncate", title=("r.file",))
        with ui.labelled("Labels", v_if="r.kind === 'labels'"):
            html.Input(
                classes="pv-num", style="width: auto", value=("r.labels",), placeholder="all but 0",
                change=(regions.set_labels, "[i, $event.target.value]"), aria_label="Labels, between commas",
                title="Numbers of the labels, between commas",
            )  # fmt: skip
        _slider_rows(regions.set_value, regions.set_end, "region", "i", "r.controls")
        with ui.labelled("Used for", v_if="filters.lines.length > 1 && r.named"):
            ui.select(
                items=("filters.lines",), model_value=("r.layers",), multiple=True,
                aria_label="Layers that this region is used for",
                update_modelValue=(regions.set_layers, "[i, $event]"), data_select="region-layers",
            )  # fmt: skip
        v3.VDivider(classes="mt-2")


def _selection(app: Explorer) -> None:
    html.Div(
        "Take the pick, box or lasso tool beside the picture, or press P, B or L, and point at streamlines. "
        "With Shift they are added.",
        v_if="!selection.count", classes="pv-small pa-3",
    )  # fmt: skip
    with html.Div(v_if="selection.count"):
        with html.Div(classes="pv-pair px-3 pt-2"):
            html.Span("{{ selection.title }}", classes="pv-value", style="flex: 1", data_value="selected")
            ui.button("Clear", click=app.selecting.clear)
        with html.Div(classes="pa-2", style="display: flex; flex-wrap: wrap; gap: 6px"):
            ui.button("As a layer", size="small", click=app.selecting.as_layer)
            ui.button(
                "Table as CSV", size="small", data_action="table-csv",
                click="trigger('selection_csv').then((t) => t && utils.download('selection.csv', t, 'text/csv'))",
            )  # fmt: skip
        with html.Div(style="max-height: 46vh; overflow: auto", classes="px-2", tabindex="0"):
            with html.Table(classes="pv-table", id="picked"):
                with html.Thead():
                    with html.Tr():
                        html.Th("{{ c }}", v_for="c in selection.columns", key="c")
                with html.Tbody():
                    with html.Tr(v_for="(row, at) in selection.rows", key="at"):
                        html.Td("{{ cell }}", v_for="(cell, k) in row", key="k")
        html.Div("{{ selection.more }}", v_if="selection.more", classes="pv-small px-3 py-1")
        with html.Div(v_if="selection.profiles && selection.profiles.length", classes="pa-2"):
            with ui.labelled("Profile of"):
                ui.select(
                    items=("selection.profiles",), model_value=("selection.profile",),
                    aria_label="Profile of",
                    update_modelValue=(app.selecting.set_profile, "[$event]"),
                )  # fmt: skip
            html.Div(v_html=("selection.chart",), id="profile")
            ui.button(
                "Profile as CSV", data_action="profile-csv",
                click="trigger('profile_csv').then((t) => t && utils.download('profile.csv', t, 'text/csv'))",
            )  # fmt: skip
    _export(app)


def _export(app: Explorer) -> None:
    with html.Div(v_if="chosen_kind === 'tractogram' || chosen_kind === 'selection' || selection.count", id="export"):
        html.Div("Export", classes="pv-head")
        for label, key, items in (("Streamlines", "export_what", WHAT), ("To", "export_to", WHERE)):
            with ui.labelled(label):
                ui.select(
                    v_model=(key,), items=(repr([{"title": title, "value": value} for value, title in items]),),
                    aria_label=label, data_select=key,
                )  # fmt: skip
        with ui.labelled("Name"):
            html.Input(
                classes="pv-num", style="width: auto", value=("export_name",), placeholder="layer name",
                change="export_name = $event.target.value", aria_label="Name of the file", maxlength=200,
                data_field="export-name",
            )  # fmt: skip
        with ui.labelled("Format"):
            with ui.button("Export as…", size="small", data_action="export"):
                with v3.VMenu(activator="parent"):
                    with v3.VList(density="compact"):
                        for suffix in EXPORTS:
                            v3.VListItem(title=suffix, click=(app.exports.export, f"['{suffix}']"),
                                         data_export=suffix)  # fmt: skip
        with html.Div(v_if="download.url", classes="px-3 py-2"):
            v3.VBtn("Download {{ download.file }}", size="small", color="primary", block=True,
                    classes="text-none", href=("download.url",), download=("download.file",), data_action="download",
                    prepend_icon="mdi-download")  # fmt: skip
            html.Div("{{ download.file }} is {{ download.where }}.", classes="pv-small pt-1", data_value="exported")


def _info() -> None:
    for folded in (False, True):
        shown = f"info.filter((t) => t.folded === {'true' if folded else 'false'})"
        with html.Div(v_if="expert_open" if folded else "true"):
            with html.Div(v_for=f"t in {shown}", key="t.title", data_info=("t.title",)):
                html.Div("{{ t.title }}", classes="pv-head")
                with html.Div(classes="px-3"):
                    with html.Table(classes="pv-table", aria_label=("t.title",)):
                        with html.Thead(v_if="t.columns.length"):
                            with html.Tr():
                                html.Th("{{ c }}", v_for="(c, k) in t.columns", key="k", scope="col")
                        with html.Tbody():
                            with html.Tr(v_for="(row, at) in t.rows", key="at"):
                                html.Td("{{ cell }}", v_for="(cell, k) in row", key="k")
        if not folded:
            fold("Drawing", "expert_open", size="small", v_if="info.some((t) => t.folded)", data_action="info-expert")
    html.Div("Choose a layer.", v_if="!info.length", classes="pv-small pa-3")
