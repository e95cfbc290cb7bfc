"""The files of a batch, and their common folder."""

from __future__ import annotations

import glob
import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from pvfiblets.errors import FibletsError

from .bids import entities, stem_of, study_root


class _NoSourceError(FibletsError, ValueError):
    """A pattern that no file matches."""


@dataclass(frozen=True)
class SourceFile:
    """A file."""

    path: Path  # absolute
    name: str  # below the folder that all sources have in common, with slashes: `sub-01/dwi/sub-01_tractography.trk`

    @property
    def stem(self) -> str:
        """The name without the suffix of its format."""
        name = Path(self.name)
        return (name.parent / stem_of(name)).as_posix()

    @property
    def said(self) -> dict[str, str]:
        """What the name says of the file, for columns."""
        return entities(Path(self.name))

    @property
    def fields(self) -> dict[str, str]:
        """What may stand between braces in an option's path."""
        name = Path(self.name)
        return {**self.said, "folder": name.parent.as_posix(), "stem": stem_of(name)}


def find_sources(patterns: str | os.PathLike[str] | Sequence[str | os.PathLike[str]]) -> list[SourceFile]:
    """Return the files that patterns match, each once, in the order of their names."""
    given = [patterns] if isinstance(patterns, (str, os.PathLike)) else list(patterns)
    found: dict[Path, Path | None] = {}
    for pattern in given:
        text = str(Path(pattern).expanduser())
        wild = glob.has_magic(text)
        paths = sorted(glob.glob(text, recursive=True)) if wild else [text]  # noqa: PTH207 - of absolute ones, too
        paths = [p for p in paths if Path(p).is_file() or (Path(p).is_dir() and p.endswith(".fiblets"))]
        if not paths:
            raise _NoSourceError(f"{text!r} matches no file; put a pattern between quotes, such as 'sub-*/dwi/*.trk'")
        for place in paths:
            found.setdefault(_absolute(place), _fixed(text) if wild else None)
    common = Path(os.path.commonpath([path.parent for path in found]))
    made = []
    for path, fixed in found.items():
        root = study_root(path) or fixed or common
        made.append(SourceFile(path, Path(os.path.relpath(path, root)).as_posix()))
    return made


def _absolute(path: str) -> Path:
    """Without following links: data sets of git-annex are links whose targets have no names that say anything."""
    return Path(os.path.abspath(path))  # noqa: PTH100


def _fixed(pattern: str) -> Path:
    """The leading folders of a pattern in which nothing stands for something else."""
    parts = _absolute(pattern).parts
    n = next(i for i, part in enumerate(parts) if glob.has_magic(part))
    return Path(*parts[: min(n, len(parts) - 1)])
