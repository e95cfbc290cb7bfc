"""What a batch has done, one line of JSON a file: what a second run goes by.

A line is appended when a file's outputs are there, in one write. A process that is killed in the middle leaves at most
one line without an end, which is passed over. The last line of a file counts.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, BinaryIO

from pvfiblets.support.whole_files import replacing

PIECE = 1 << 22


def checksum(path: Path) -> str:
    """Return the SHA-256 of a file, in hexadecimal; of a folder, of its files' names and bytes."""
    found = hashlib.sha256()
    for part in sorted(p for p in path.rglob("*") if p.is_file()) if path.is_dir() else [path]:
        if part != path:
            found.update(part.relative_to(path).as_posix().encode() + b"\0")
        with part.open("rb") as stream:
            while piece := stream.read(PIECE):
                found.update(piece)
    return found.hexdigest()


def fingerprint(path: Path) -> tuple[int, int]:
    """Return size (bytes) and time of the last change (ns): what tells at no cost that a file is as it was."""
    told = path.stat()
    return told.st_size, told.st_mtime_ns


@dataclass(frozen=True)
class Output:
    """A file that a task made."""

    path: str  # relative to the batch's folder
    size: int  # as `fingerprint`
    changed: int
    sha256: str

    @classmethod
    def from_file(cls, folder: Path, path: Path) -> Output:
        """Describe a file below a folder."""
        return cls(path.relative_to(folder).as_posix(), *fingerprint(path), checksum(path))

    def is_there(self, folder: Path) -> bool:
        """Whether the file is as it was made. Its bytes are read only where its size or time says something else."""
        path = folder / self.path
        try:
            size, changed = fingerprint(path)
        except OSError:
            return False
        if (size, changed) == (self.size, self.changed):
            return True
        return path.is_file() and size == self.size and checksum(path) == self.sha256


@dataclass(frozen=True)
class Entry:
    """What became of one source."""

    name: str  # the source, below the folder that all sources have in common
    asked: str  # hash of the operation and its options
    size: int = 0  # of the source, as of `Output`
    changed: int = 0
    sha256: str = ""
    outputs: tuple[Output, ...] = ()
    error: str = ""  # one sentence; empty where all went well
    seconds: float = 0.0  # that the task took
    extra: dict[str, Any] = field(default_factory=dict)

    def holds(self, source: Path, asked: str, folder: Path) -> bool:
        """Return True if the task is finished: same bytes, same request, unchanged result."""
        if self.error or self.asked != asked:
            return False
        size, changed = fingerprint(source)
        same = (size, changed) == (self.size, self.changed)
        if not same and (size != self.size or checksum(source) != self.sha256):
            return False
        return all(output.is_there(folder) for output in self.outputs)


class Record:
    """The file of a batch's entries."""

    def __init__(self, path: Path) -> None:
        self.path = path  # made when something is added to it
        self.entries: dict[str, Entry] = {}
        self._stream: BinaryIO | None = None
        if path.exists():
            for line in path.read_bytes().split(b"\n"):
                try:
                    entry = _entry(json.loads(line))
                except (ValueError, TypeError, KeyError):
                    continue  # the end of a file whose writer was killed
                self.entries[entry.name] = entry

    def begin(self, *, afresh: bool) -> None:
        """Write the record in whole lines, and open it for appending."""
        if afresh:
            self.entries = {}
        with replacing(self.path) as file:
            for entry in self.entries.values():
                file.write(_line(entry))
        self._stream = self.path.open("ab", buffering=0)

    def add(self, entry: Entry) -> None:
        """Add what became of a source."""
        assert self._stream is not None
        self.entries[entry.name] = entry
        self._stream.write(_line(entry))

    def close(self) -> None:
        """Close the file."""
        if self._stream is not None:
            os.fsync(self._stream.fileno())
            self._stream.close()
            self._stream = None


def _line(entry: Entry) -> bytes:
    told = {key: value for key, value in vars(entry).items() if value}
    told["outputs"] = [vars(output) for output in entry.outputs]
    return json.dumps(told, separators=(",", ":")).encode() + b"\n"


def _entry(told: Mapping[str, Any]) -> Entry:
    return Entry(**{**told, "outputs": tuple(Output(**output) for output in told["outputs"])})
