"""The elements of a page: trame's, with every attribute passed on.

trame leaves out attributes that it does not know of an element, without a word; ``data-`` and ``aria-`` are among them.
"""

from __future__ import annotations

from collections.abc import Callable
from html import escape
from types import ModuleType
from typing import Any

from trame.widgets import html as _html
from trame.widgets import vuetify3 as _vuetify

__all__ = ["eye", "html", "v3"]

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
