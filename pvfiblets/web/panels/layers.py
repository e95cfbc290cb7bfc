"""The left side: layers, and the properties of the chosen one, drawn from their descriptions."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from pvfiblets.web.panels import elements as ui
from pvfiblets.web.panels.elements import eye, fold, html, v3

if TYPE_CHECKING:
    from pvfiblets.web.app import Explorer

EXPERT = "Drawing"
ICONS = {
    "tractogram": "mdi-vector-polyline",
    "tubes": "mdi-pipe",
    "volume": "mdi-cube-outline",
    "mesh": "mdi-triangle-outline",
    "selection": "mdi-selection-ellipse",
    "image": "mdi-layers-outline",
}


def layers(app: Explorer) -> None:
    """Build the list of layers."""
    html.Div("Layers", classes="pv-head")
    with html.Div(classes="pv-scroll", style="flex: 0 0 auto; max-height: 34%", id="layers"):
        with v3.VList(density="compact", nav=True, classes="py-0"):
            with v3.VListItem(
                v_for="layer in layers",
                key="layer.id",
                active=("layer.id === chosen",),
                click=(app.choose, "[layer.id]"),
                classes="pv-layer",
                data_layer=("layer.id",),
            ):
                with v3.Template(v_slot_prepend=True):
                    eye("layer.visible", v_on_click_stop=(app.show, "[layer.id, !layer.visible]"), data_action="eye")
                    v3.VIcon(icon=(f"({ICONS!r})[layer.kind]",), size=16, classes="mx-1", title=("layer.kind",))
                v3.VListItemTitle("{{ layer.name }}", title=("layer.name",), style="font-size: 13px")
                with v3.Template(v_slot_append=True):
                    with v3.VBtn(
                        icon=True,
                        size="x-small",
                        variant="text",
                        aria_label="More",
                        v_on_click_stop="0",
                        data_action="more",
                    ):
                        v3.VIcon("mdi-dots-vertical", size=18)
                        with v3.VMenu(activator="parent"):
                            with v3.VList(density="compact"):
                                v3.VListItem(
                                    title="Rename",
                                    prepend_icon="mdi-pencil-outline",
                                    click=(app.ask_name, "[layer.id]"),
                                )
                                v3.VListItem(
                                    title="Show as slices", v_if="layer.kind === 'volume'",
                                    prepend_icon="mdi-layers-outline", click=(app.slices.of_volume, "[layer.id]"),
                                )  # fmt: skip
                                v3.VListItem(
                                    title="Names of labels…", v_if="layer.kind === 'image'",
                                    prepend_icon="mdi-tag-outline", click=(app.slices.choose_table, "[layer.id]"),
                                )  # fmt: skip
                                v3.VListItem(
                                    title="Duplicate",
                                    prepend_icon="mdi-content-copy",
                                    click=(app.duplicate, "[layer.id]"),
                                )
                                v3.VListItem(
                                    title="Remove",
                                    prepend_icon="mdi-delete-outline",
                                    click=(app.remove, "[layer.id]"),
                                )
    v3.VDivider()


def properties(app: Explorer) -> None:
    """Build the panel of properties: one control for each type, repeated over what the server describes."""
    html.Div(
        "{{ chosen_name || 'Properties' }}", classes="pv-name text-truncate", title=("chosen_name",), style="flex: none"
    )
    with html.Div(classes="pv-scroll pb-4", style="flex: 1 1 auto", id="properties"):
        html.Div(
            "Choose a layer to see what can be set of it.", v_if="layers.length && !chosen", classes="pv-small pa-3"
        )
        with html.Div(v_for="group in groups", key="chosen + group.title"):
            html.Div("{{ group.title }}", classes="pv-head", v_if=f"group.title !== '{EXPERT}'")
            fold(EXPERT, "expert_open", v_else=True, data_action="expert")  # folded: what experts set
            with html.Div(
                v_for="p in group.properties", key="p.name", data_property=("p.name",),
                v_show=f"group.title !== '{EXPERT}' || expert_open",
            ):  # fmt: skip
                with ui.labelled("{{ p.label }}", ("p.help",), v_if="p.matters"):
                    with html.Div(classes="pv-pair"):
                        _controls(app)


def _controls(app: Explorer) -> None:
    def change(value: str) -> tuple[Any, str]:
        return app.set_property, f"[chosen, p.name, {value}]"

    slider = {
        "model_value": ("p.effective",),
        "min": ("p.limits[0]",),
        "max": ("p.limits[1]",),
        "step": ("p.step",),
        "end": change("$event"),
        "density": "compact",
        "hide_details": True,
        "color": "primary",
        "thumb_size": 14,
        "track_size": 3,
        "aria_label": ("p.label",),
        "data_live": ("JSON.stringify(['property', chosen, p.name])",),
    }
    held = "held.at === 'property ' + chosen + ' ' + p.name"
    html.Span("{{ p.shown }}", v_if="p.read_only", classes="pv-value")
    ui.select(
        v_else_if="p.type === 'choice'",
        items=("p.items",),
        model_value=("p.index",),
        aria_label=("p.label",),
        update_modelValue=(app.set_choice, "[chosen, p.name, $event]"),
    )
    ui.switch(
        v_else_if="p.type === 'bool'",
        model_value=("p.value",),
        update_modelValue=change("!!$event"),
        aria_label=("p.label",),
    )
    with v3.Template(v_else_if="p.type === 'colour'"):
        html.Input(
            type="color",
            classes="pv-colour",
            value=("p.shown",),
            change=change("$event.target.value"),
            aria_label=("p.label",),
        )
        html.Span("auto", v_if="p.optional && p.value === null", classes="pv-small")
    with v3.Template(v_else_if="p.type === 'number'"):
        v3.VSlider(
            v_if="p.limits && !p.wide",
            **slider,
        )
        ui.number_field(
            value=(f"{held} ? held.shown[0] : p.shown",),
            placeholder=("p.automatic",),
            change=(app.set_number, "[chosen, p.name, $event.target.value]"),
            style=("p.wide || !p.limits ? 'flex: 1; width: auto; min-width: 0' : 'width: 62px'",),
            aria_label=("p.label",),
        )
    with v3.Template(v_else_if="p.type === 'range'"):
        with html.Div(style="flex: 1; min-width: 0"):
            html.Div(v_if="p.name === 'clim' && range_chart", v_html=("range_chart",), classes="pv-chart")
            v3.VRangeSlider(
                v_if="p.limits",
                **slider,
            )
            with html.Div(classes="pv-pair", style="justify-content: space-between"):
                for end in (0, 1):
                    ui.number_field(
                        value=(f"({held} ? held.shown : p.ends)[{end}]",),
                        change=(app.set_end, f"[chosen, p.name, {end}, $event.target.value]"),
                        aria_label=(f"p.label + ({end} ? ', high end' : ', low end')",),
                        style="width: 74px",
                    )
    v3.VSlider(
        v_if="p.type === 'numbers' && p.limits && p.one !== null",
        **{**slider, "model_value": ("p.one",)},
    )
    html.Input(
        v_if="p.type === 'numbers' || p.type === 'text'",
        classes="pv-num",
        style=(
            "p.type === 'numbers' && p.limits && p.one !== null ? 'width: 62px' : 'flex: 1; width: auto; min-width: 0'",
        ),
        value=(f"{held} ? held.shown[0] : p.shown",),
        placeholder=("p.optional ? 'auto' : ''",),
        change=(app.set_text, "[chosen, p.name, $event.target.value]"),
        aria_label=("p.label",),
    )
    ui.icon_button(
        "mdi-backup-restore", ("'Reset ' + p.label",), 16,
        v_if="p.optional && p.value !== null && !p.read_only && p.type !== 'choice'", click=change("null"),
        title="Back to automatic",
    )  # fmt: skip
