"""The elements of a page: trame's, with every attribute passed on.

trame leaves out attributes that it does not know of an element, without a word; ``data-`` and ``aria-`` are among them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from html import escape
from types import ModuleType
from typing import Any

from trame.widgets import html as _html
from trame.widgets import vuetify3 as _vuetify

PASSED_ON = ("data_", "aria_")
PLAIN = frozenset(
    {"accept", "autofocus", "download", "draggable", "hidden", "inputmode", "maxlength", "role", "tabindex", "type"}
)


class Elements:
    """The elements of a module of trame's."""

    def __init__(self, module: ModuleType) -> None:
        self._module = module  # such as `trame.widgets.html`

    def __getattr__(self, name: str) -> Callable[..., Any]:
        kind = getattr(self._module, name)

        def make(*children: Any, **attributes: Any) -> Any:
            rest = {key: value for key, value in attributes.items() if not _passed_on(key)}
            raw = [written(key, value) for key, value in attributes.items() if _passed_on(key)]
            return kind(*children, raw_attrs=raw, **rest)

        return make


def _passed_on(name: str) -> bool:
    return name.startswith(PASSED_ON) or name in PLAIN


def written(name: str, value: Any) -> str:
    """Return an attribute as a template has it: a tuple holds an expression, as everywhere in trame."""
    name = name.replace("_", "-")
    if value is True:
        return name
    if isinstance(value, tuple):
        return f':{name}="{escape(value[0])}"'
    return f'{name}="{escape(str(value))}"'


html = Elements(_html)
v3 = Elements(_vuetify)


def button(text: str, **attributes: Any) -> Any:
    """Build a small button."""
    return v3.VBtn(text, **{"size": "x-small", "variant": "tonal", "classes": "text-none", **attributes})


def icon_button(icon: str, label: str | tuple[str], size: int = 18, **attributes: Any) -> None:
    """Build a small button with an icon alone; the label is for screen readers."""
    with v3.VBtn(icon=True, aria_label=label, **{"size": "x-small", "variant": "text", **attributes}):
        v3.VIcon(icon, size=size)


def tooltip(text: str, location: str = "bottom", label: str | tuple[str] | None = None) -> None:
    """Build the tooltip of the element around it; the label names it for screen readers while it is closed."""
    v3.VTooltip(text, activator="parent", location=location, aria_label=text if label is None else label)


def pressed(condition: str, otherwise: str = "tonal") -> dict[str, Any]:
    """Return the attributes of a button that shows whether a condition holds."""
    return {"variant": (f"{condition} ? 'flat' : '{otherwise}'",), "color": (f"{condition} ? 'primary' : undefined",)}


@contextmanager
def labelled(label: str, hint: str | tuple[str] | None = None, **attributes: Any) -> Iterator[None]:
    """Build a row of a panel: its label, and what the block builds."""
    with html.Div(classes="pv-row", **attributes):
        html.Label(label, **({} if hint is None else {"title": hint}))
        yield


def number_field(**attributes: Any) -> None:
    """Build a field for a number."""
    html.Input(classes="pv-num", inputmode="decimal", **attributes)


def slider(kind: str = "VSlider", **attributes: Any) -> None:
    """Build a slider, or by ``VRangeSlider`` one with two ends."""
    getattr(v3, kind)(density="compact", hide_details=True, color="primary", thumb_size=14, track_size=3, **attributes)


def select(**attributes: Any) -> None:
    """Build a list to choose from."""
    v3.VSelect(density="compact", variant="outlined", hide_details=True, **attributes)


def switch(**attributes: Any) -> None:
    """Build a switch."""
    v3.VSwitch(density="compact", hide_details=True, color="primary", **attributes)


def fold(title: str, is_open: str, **attributes: Any) -> None:
    """Build the line that opens and folds a section of a panel."""
    v3.VBtn(
        title, variant="text", block=True, classes="text-none pv-fold", aria_expanded=(is_open,),
        append_icon=(f"{is_open} ? 'mdi-chevron-up' : 'mdi-chevron-down'",),
        **{"size": "x-small", "click": f"{is_open} = !{is_open}", **attributes},
    )  # fmt: skip


def eye(shown: str, hide: str = "Hide", show: str = "Show", **attributes: Any) -> None:
    """Build the button that shows or hides something of a list."""
    with v3.VBtn(icon=True, size="x-small", variant="text", aria_label=(f"{shown} ? '{hide}' : '{show}'",),
                 **attributes):  # fmt: skip
        v3.VIcon(icon=(f"{shown} ? 'mdi-eye' : 'mdi-eye-off'",), size=18)
