"""Files that browsers may name: those under one folder, links out of it left out."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from pvfiblets.web.scene.files.file_kinds import is_tractogram_folder

LONGEST_PATH = 4096
LONGEST_NAME = 255  # bytes, as file systems have it
UNSUITABLE = frozenset('<>:"|?*&/\\')
RESERVED = frozenset(["CON", "PRN", "AUX", "NUL", *(f"{port}{n}" for port in ("COM", "LPT") for n in range(1, 10))])
"""Names that are devices on Windows, whatever follows the dot."""
LISTED = 2000  # entries of one folder that are shown


class ConfinedError(ValueError):
    """A browser named a path that it may not have; the message is safe to show it."""


class TakenError(ConfinedError):
    """A name that a file has already."""


@dataclass(frozen=True)
class Entry:
    """One line of a file browser."""

    name: str
    path: str  # relative to the root, with slashes
    folder: bool  # a set in shards is none: it opens like a file
    size: int
    time: float  # of the last change, seconds since 1970


class Confined:
    """The folder that browsers may open files from and save files to."""

    def __init__(self, root: str | Path) -> None:
        self.root = Path(root).resolve(strict=True)  # the folder. Links inside it may point to other places inside it.
        if not self.root.is_dir():
            raise NotADirectoryError(20, "Not a directory", str(root))

    def resolve(self, text: object) -> Path:
        """Return the absolute path that a relative one means."""
        if not isinstance(text, str) or len(text) > LONGEST_PATH or "\0" in text or "\\" in text:
            raise ConfinedError(f"not a path: {str(text)[:80]!r}")
        relative = PurePosixPath(text)
        if relative.is_absolute() or ".." in relative.parts or ":" in text.partition("/")[0]:
            raise ConfinedError(f"{text!r} is outside the served folder; paths are relative to it, without '..'")
        found = Path(os.path.realpath(self.root / relative))
        if found != self.root and self.root not in found.parents:
            raise ConfinedError(f"{text!r} leads out of the served folder by a link")
        return found

    def existing(self, text: object) -> Path:
        """Return the path of a file that is there."""
        path = self.resolve(text)
        if not (path.is_file() or is_tractogram_folder(path)):
            raise ConfinedError(f"there is no file {text!r} in the served folder")
        return path

    def writable(self, text: object, suffixes: tuple[str, ...]) -> Path:
        """Return the path for a file to write: of a known kind, in a folder that exists, never over another."""
        path = self.resolve(text)
        if not path.name.lower().endswith(suffixes):
            raise ConfinedError(f"{text!r}: the name must end in one of {', '.join(suffixes)}")
        if not path.parent.is_dir():
            raise ConfinedError(f"{text!r}: there is no such folder")
        if path.exists():
            raise TakenError(f"{text!r} exists already; choose another name")
        return path

    def uploaded(self, name: str, suffixes: tuple[str, ...]) -> Path:
        """Return the path for an upload, as :meth:`writable` does; the name is one that every page can show."""
        return self.writable(check_name(name), suffixes)

    def relative(self, path: Path) -> str:
        """Return how browsers name a path under the root."""
        return path.relative_to(self.root).as_posix()

    def listing(self, text: object = "") -> list[Entry]:
        """Return a folder's entries: folders first, by name; hidden ones and links that lead out left out."""
        folder = self.resolve(text)
        if not folder.is_dir():
            raise ConfinedError(f"there is no folder {text!r} in the served folder")
        entries = []
        for item in os.scandir(folder):
            if item.name.startswith("."):
                continue
            relative = self.relative(folder / item.name)
            try:
                path = self.resolve(relative)
                if not (path.is_dir() or path.is_file()):
                    continue  # devices, sockets, links to nothing
                status = path.stat()
                folder_too, size = path.is_dir(), status.st_size
                if folder_too:
                    whole = is_tractogram_folder(path)
                    size = sum(file.stat().st_size for file in path.rglob("*") if file.is_file()) if whole else 0
                    folder_too = not whole
                entries.append(Entry(item.name, relative, folder_too, size, status.st_mtime))
            except (ConfinedError, OSError):
                continue
        entries.sort(key=lambda entry: (not entry.folder, entry.name.lower()))
        return entries[:LISTED]

    def walk(self, deepest: int = 3, most: int = 200) -> list[tuple[str, list[Entry]]]:
        """Return folders, the root's own path ``""`` first, with their entries: some levels deep, and not too many."""
        found: list[tuple[str, list[Entry]]] = []
        waiting = [("", 0)]
        while waiting and len(found) < most:
            folder, depth = waiting.pop(0)
            entries = self.listing(folder)
            found.append((folder, entries))
            if depth < deepest:
                waiting += [(entry.path, depth + 1) for entry in entries if entry.folder]
        return found


def check_name(name: str) -> str:
    """Return the name of a file without a folder, if it is one that every system and page can show."""
    if len(name.encode("utf-8", "surrogatepass")) > LONGEST_NAME:
        raise ConfinedError(f"the file's name is longer than {LONGEST_NAME} bytes; choose a shorter one")
    if (
        not name.isprintable() or name.startswith((".", " ")) or set(name) & UNSUITABLE
        or name.partition(".")[0].strip().upper() in RESERVED
    ):  # fmt: skip
        raise ConfinedError(
            "the file's name begins with a dot or a blank, is reserved, or has control characters, slashes or one "
            'of < > : " | ? * & in it; choose a plain one'
        )
    return name
