"""Writes pages: one file with all its data, or above a size a folder whose data lie beside the page.

A page runs its own script and nothing else: a content security policy names script and style by their hashes, allows
no request to any other host, and no evaluation of text. Names are data of JSON and become text of the document, never
HTML.
"""

from __future__ import annotations

import base64
import hashlib
import html
import json
from functools import cache
from importlib import resources
from os import PathLike
from pathlib import Path
from typing import Any

from pvfiblets.support.whole_files import made_folder, replacing

from .fiblet_bytes import SMALL_FROM, small_bytes
from .scene import PageScene

LARGEST_FILE = 64_000_000
"""Bytes of data above which they lie beside the page: browsers keep the text of a page in memory, twice."""


@cache
def _resource(name: str) -> str:
    return (resources.files(__package__) / name).read_text(encoding="utf-8")


def write_page(scene: PageScene, path: str | PathLike[str], *, largest_file: int = LARGEST_FILE) -> list[Path]:
    """Write a page."""
    path = check_name(path)
    content = scene.plain()
    apart = path.suffix == "" or sum(map(len, scene.blobs)) > largest_file
    page = path if path.suffix else path / "index.html"
    written = [page]
    sets = {layer["data"] for layer in scene.layers if layer["kind"] == "fiblets"}
    if apart:
        folder = path if not path.suffix else path.with_name(f"{path.stem}_data")
        made_folder(folder)
        content["data"] = []
        for number, blob in enumerate(scene.blobs):
            name = folder / f"{number}.{'fiblets' if number in sets else 'bin'}"
            with replacing(name, len(blob)) as file:
                file.write(blob)
            written.append(name)
            content["data"].append({"bytes": len(blob), "file": name.relative_to(page.parent).as_posix()})
        blocks: list[bytes] = []
    else:
        blobs = [small_bytes(b) if i in sets and len(b) >= SMALL_FROM else b for i, b in enumerate(scene.blobs)]
        content["data"] = [{"bytes": len(blob)} for blob in blobs]
        blocks = [_data_block(f"data-{number}", blob) for number, blob in enumerate(blobs)]
    text = _page_text(content, apart=apart)
    head, tail = text.split("<!-- data -->")
    with replacing(page, len(text) + sum(map(len, blocks))) as file:
        file.write(head.encode())
        for block in blocks:
            file.write(block)
        file.write(tail.encode())
    return written


def check_name(path: str | PathLike[str]) -> Path:
    """Return a name that a page can have."""
    path = Path(path).expanduser()
    if path.suffix.lower() not in ("", ".html", ".htm"):
        raise ValueError(f"{path}: a page is written as .html, or into a folder whose name has no ending; name it so")
    return path


def _page_text(content: dict[str, Any], *, apart: bool) -> str:
    """Return the page without its data."""
    script, style = _resource("page.js"), _resource("page.css")
    policy = "; ".join(
        (
            "default-src 'none'",
            f"script-src 'sha256-{_digest(script)}'",
            f"style-src 'sha256-{_digest(style)}'",
            "img-src data: blob:",
            "connect-src 'self'" if apart else "connect-src 'none'",
            "base-uri 'none'",
            "form-action 'none'",
        )
    )
    parts = {
        "policy": html.escape(policy, quote=True).replace("&#x27;", "'"),
        "title": html.escape(str(content["title"])),
        "style": style,
        "scene": _json(content),
        "script": script,
    }
    pieces = _resource("page.html").split("{{")
    made = [pieces[0]]
    for piece in pieces[1:]:
        name, _, rest = piece.partition("}}")
        made += [parts[name.strip()], rest]
    return "".join(made)


def _digest(text: str) -> str:
    return base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()


def _json(content: dict[str, Any]) -> str:
    """Return JSON that cannot end the element that it stands in."""
    return json.dumps(content, allow_nan=False, separators=(",", ":")).replace("<", "\\u003c")


def _data_block(name: str, blob: bytes) -> bytes:
    return b'<script type="text/plain" id="' + name.encode() + b'">' + base64.b64encode(blob) + b"</script>\n"
