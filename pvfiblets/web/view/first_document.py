"""The first document of the application: trame's, with a placeholder inside it until the page is there.

trame's own fetches that text and puts it into the page whenever it comes. On a busy machine it can come after the page,
and then takes its place for good.
"""

from __future__ import annotations

import re
from pathlib import Path

WAITING = (
    '<div id="app"><div style="position: fixed; inset: 0; display: grid; place-items: center; background: #121212; '
    'color: #ccc; font: 16px/1.5 system-ui, sans-serif">Loading…</div></div>'
)
_FETCHED = re.compile(r'<div id="app"></div>\s*<script>.*?</script>', re.DOTALL)


def first_document() -> str:
    """Return the document."""
    from trame_client.module import vue3

    text = (Path(vue3.www) / "index.html").read_text(encoding="utf-8")
    text, replaced = _FETCHED.subn(WAITING, text)
    if replaced != 1 or "loading.tpl" in text:
        raise RuntimeError("index.html of trame-client has another form; see pvfiblets/web/view/first_document.py")
    text = text.replace(",maximum-scale=1,minimum-scale=1", "")  # whoever needs it may zoom
    return text.replace("<title>trame is built by Kitware</title>", "<title>pvfiblets</title>")
