"""Warnings about where the contents of a file lie: one each, however often the file is read."""

from __future__ import annotations

import os
import warnings
from pathlib import Path

_MOST = 4096  # files
_notes: dict[tuple[str, int], list[str]] = {}


def note(path: str | os.PathLike[str], text: str) -> None:
    """Warn about a file, once for each state of it."""
    texts = _notes.setdefault(_key(path), [])
    while len(_notes) > _MOST:
        _notes.pop(next(iter(_notes)))
    if text not in texts:
        texts.append(text)
        warnings.warn(text, UserWarning, stacklevel=2)


def notes_of(path: str | os.PathLike[str]) -> tuple[str, ...]:
    """Return the warnings about a file as it is now."""
    return tuple(_notes.get(_key(path), ()))


def _key(path: str | os.PathLike[str]) -> tuple[str, int]:
    place = os.path.realpath(path)
    try:
        return place, Path(place).stat().st_mtime_ns
    except OSError:
        return place, 0
