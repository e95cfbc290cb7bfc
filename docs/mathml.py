"""Formulas as MathML: browsers lay it out themselves, so that pages need neither the network nor a script."""

from __future__ import annotations

import re
from typing import Any

from docutils import nodes
from latex2mathml.converter import convert

__all__ = ["formula", "setup"]

BOLD = re.compile(r'<mi mathvariant="bold">')
# MathML Core, which is what browsers draw, knows no other variant than "normal": boldness is a matter of style there.
BOLD_IN_BROWSERS = '<mi mathvariant="normal" style="font-weight: bold">'

# Long ones scroll in narrow windows. The class "math" is the theme's, for pictures that a script puts there.
ROOM = "margin: 0 0 1.15rem; overflow-x: auto; overflow-y: hidden"


def formula(text: str, *, display: bool) -> str:
    """Return TeX as MathML.

    Parameters
    ----------
    text : str
        What stands between the dollars.
    display : bool
        Whether it has a line of its own.

    Returns
    -------
    str
        A ``math`` element.
    """
    return BOLD.sub(BOLD_IN_BROWSERS, convert(text, display="block" if display else "inline"))


def _inline(translator: Any, node: nodes.math) -> None:
    translator.body.append(formula(node.astext(), display=False))
    raise nodes.SkipNode


def _block(translator: Any, node: nodes.math_block) -> None:
    translator.body.append(f'<div style="{ROOM}">{formula(node.astext(), display=True)}</div>\n')
    raise nodes.SkipNode


def setup(app: Any) -> dict[str, bool]:
    """Offer this way to Sphinx, under the name ``mathml``."""
    app.add_html_math_renderer("mathml", (_inline, None), (_block, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
