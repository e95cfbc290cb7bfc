"""What the name of a file says of it, by the Brain Imaging Data Structure (BIDS 1.9, "Entities"), and names made of it.

A name is made of pairs ``key-value`` with underscores between, and a suffix:
``sub-01/ses-a/dwi/sub-01_ses-a_bundle-AFleft_tractography.trk``. Folders say the subject and the session, too. Pairs
with keys that BIDS knows nothing of are kept under their own key.
"""

from __future__ import annotations

import re
from pathlib import PurePath
from string import Formatter

from pvfiblets.formats.registry import UnknownFormatError, suffix_of

NAMES = {
    "sub": "subject", "ses": "session", "task": "task", "acq": "acquisition", "ce": "contrast_agent", "run": "run",
    "rec": "reconstruction", "dir": "direction", "space": "space", "desc": "description", "atlas": "atlas",
    "seg": "segmentation", "hemi": "hemisphere", "res": "resolution", "den": "density", "param": "parameter",
}  # fmt: skip
"""Names of BIDS keys; other keys keep theirs."""
_PAIR = re.compile(r"([a-zA-Z0-9]+)-([a-zA-Z0-9+.]+)")
_FOLDER = re.compile(r"(sub|ses)-([a-zA-Z0-9]+)")


def stem_of(path: PurePath) -> str:
    """Return the name without the suffix of its format, which may be one of two parts."""
    try:
        return path.name[: -len(suffix_of(path.name))]
    except UnknownFormatError:
        return path.stem


def entities(path: PurePath) -> dict[str, str]:
    """Return what a path says of its file."""
    found: dict[str, str] = {}
    for folder in path.parts[:-1]:
        if (match := _FOLDER.fullmatch(folder)) is not None:
            found[NAMES[match[1]]] = match[2]
    *parts, last = stem_of(path).split("_")
    for part in (*parts, last):
        if (match := _PAIR.fullmatch(part)) is not None:
            found[NAMES.get(match[1], match[1])] = match[2]
    if any(map(_PAIR.fullmatch, parts)) and _PAIR.fullmatch(last) is None:
        found["suffix"] = last
    return found


def study_root(path: PurePath) -> PurePath | None:
    """Return the folder that holds the subject's folder, ``None`` where no folder is one of a subject."""
    for place, folder in enumerate(path.parts[:-1]):
        if folder.startswith("sub-") and _FOLDER.fullmatch(folder):
            return PurePath(*path.parts[:place])
    return None


def fields_of(template: str) -> set[str]:
    """Return the names between braces in a text."""
    try:
        return {name for _, name, _, _ in Formatter().parse(template) if name is not None}
    except ValueError as error:
        raise ValueError(f"{template!r} is no path with names between braces: {error}") from None


def filled(template: str, values: dict[str, str], source: str) -> str:
    """Return a text with the values of a source put in the place of their names."""
    lacking = sorted(fields_of(template) - set(values))
    if lacking:
        raise ValueError(
            f"{template!r} asks for {', '.join(lacking)}, which the name of {source} does not say; it says "
            + ", ".join(f"{key} {value}" for key, value in values.items())
        )
    return template.format_map(values)
