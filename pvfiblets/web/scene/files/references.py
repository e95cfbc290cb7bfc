"""Files that name other files: the named files are found before a reader opens them, and confined as paths are.

The headers of NRRD and MetaImage are parsed here by the functions that read them afterwards, so both see the same
names. Of formats that are not listed here no reader follows a reference: tests ask the system which files are opened.

A file is checked by its place without links, and the reader opens that place a moment later. Browsers can change
nothing between: uploads and exports replace no file and make no links. A user with write access to the served folder by
other means can, and so must be trusted with what the server may read.
"""

from __future__ import annotations

import json
import os
import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any
from urllib.parse import unquote

from pvfiblets.errors import FormatError
from pvfiblets.images import metaimage, mif, nrrd
from pvfiblets.slices import fixels
from pvfiblets.volumes import gifti_files

_GLB = b"glTF"
_GLB_JSON = 0x4E4F534A


def check_references(place: Path, folders: list[Path]) -> None:
    """Refuse a file that names another one outside of some folders."""
    beside = [one for one in fixels.sibling_files(place) if one != place]
    named = [one.name for one in beside] + _named(place)
    for one in beside if all(_inside(place.parent, name, folders) for name in named) else ():
        named += _named(one)
    if not all(_inside(place.parent, name, folders) for name in named):
        raise PermissionError(
            f"{place.name}: it names a file that is not in the folder open to you; convert it to one file"
        )


def _named(place: Path) -> list[str]:
    """Return the files that a file names."""
    name = place.name.lower()
    find = next((found for suffix, found in _FINDERS.items() if name.endswith(suffix)), None)
    return [] if find is None else find(place)


def _inside(parent: Path, named: str, folders: list[Path]) -> bool:
    if not named or not named.isprintable() or "\\" in named:
        return False
    # What lies outside by its name alone is never looked at, so that it takes no longer if it is there.
    plain = Path(os.path.normpath(parent / named))
    if not any(plain.is_relative_to(folder) for folder in folders):
        return False
    try:
        found = Path(os.path.realpath(parent / named))
    except OSError:
        return False
    return any(found.is_relative_to(folder) for folder in folders)


def _of_nrrd(place: Path) -> list[str]:
    fields = nrrd.header_fields(place)
    return [fields[name] for name in ("data file", "datafile") if name in fields and not _several(fields[name])]


def _of_metaimage(place: Path) -> list[str]:
    named = metaimage.header_fields(place).get("elementdatafile", "LOCAL")
    return [] if named.upper() == "LOCAL" or _several(named) else [named]


def _several(named: str) -> bool:
    """Whether a list or a pattern of files is named, which our readers refuse without a look at them."""
    return named.upper().split()[:1] == ["LIST"] or "%" in named


def _of_gltf(place: Path) -> list[str]:
    content = place.read_bytes()
    texts = [content]
    if content.startswith(_GLB):
        texts, at = [], 12
        while at + 8 <= len(content):
            size, kind = struct.unpack_from("<II", content, at)
            if kind == _GLB_JSON:
                texts.append(content[at + 8 : at + 8 + size])
            at += 8 + size
    named: list[Any] = []

    def collect(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        # Of keys that stand twice parsers take one or the other: all of them count.
        named.extend(value for key, value in pairs if key == "uri")
        return dict(pairs)

    try:
        for text in texts:
            json.loads(text, object_pairs_hook=collect)
    except (ValueError, RecursionError):
        raise FormatError(place, None, "invalid JSON", "a glTF file, or a .glb file of version 2") from None
    found: list[str] = []
    for uri in named:
        if isinstance(uri, str) and uri[:5].lower() == "data:":
            continue
        # Anything else with a colon is an address; an empty name is refused.
        found += [""] if not isinstance(uri, str) or ":" in uri or ":" in unquote(uri) else [uri, unquote(uri)]
    return found


def _of_obj(place: Path) -> list[str]:
    with place.open(encoding="utf-8", errors="replace") as file:
        lines = [line.split(maxsplit=1) for line in file if line.lstrip()[:6].lower() == "mtllib"]
    return [name for line in lines if len(line) > 1 for name in (line[1].strip(), *line[1].split())]


def _of_shards(place: Path) -> list[str]:
    """Return every file of a folder of shards: its manifest may name any of them."""
    return [f"{place.name}/{entry.name}" for entry in os.scandir(place)] if place.is_dir() else []


_FINDERS: dict[str, Callable[[Path], list[str]]] = {
    ".nrrd": _of_nrrd, ".nhdr": _of_nrrd, ".mhd": _of_metaimage, ".mha": _of_metaimage, ".gltf": _of_gltf,
    ".glb": _of_gltf, ".obj": _of_obj, ".mif": mif.named_files, ".mif.gz": mif.named_files, ".mih": mif.named_files,
    ".fiblets": _of_shards, ".gii": gifti_files.named_files, ".gii.gz": gifti_files.named_files,
}  # fmt: skip
