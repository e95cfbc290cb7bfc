"""``manifest.json`` of a sharded set: which files there are, and what each holds.

::

    whole.fiblets/
      manifest.json
      000000.fiblets   000000.ids.npy
      000001.fiblets   000001.ids.npy
      ...
      thinned.level    thinned.ids.npy

``NUMBER.ids.npy`` holds the numbers that the shard's streamlines have in the whole set, rising. ``thinned.level``
is a ``.fiblets`` file too, under a name that patterns of shards leave out: an even share of all streamlines once more,
for a first picture before shards are there. Sets of one shard, and older ones, have none. All checksums are SHA-256. A
folder without a manifest is no set: it is written last.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from ...errors import FormatError

MANIFEST = "manifest.json"
FORMAT, VERSION = "fiblets-shards", 1

Bounds = tuple[float, float, float, float, float, float]


@dataclass(frozen=True)
class StoredFile:
    """A file of the set."""

    name: str  # without a folder
    bytes: int
    sha256: str


@dataclass(frozen=True)
class Shard:
    """One shard."""

    fiblets: StoredFile
    ids: StoredFile
    streamlines: int
    points: int
    n_fiblets: int
    bounds: Bounds  # of its points `(xmin, xmax, ymin, ymax, zmin, zmax)`, mm
    length_mm: dict[str, float] = field(default_factory=dict)  # `mean, max` over its streamlines
    unpacked: int = 0  # bytes in memory of a small file; 0 of files that are mapped

    @property
    def nbytes(self) -> int:
        """Bytes of the shard in memory."""
        return self.unpacked or self.fiblets.bytes


@dataclass(frozen=True)
class Manifest:
    """The set that the shards are parts of."""

    streamlines: int  # of all shards
    points: int
    n_fiblets: int
    promise_mm: float  # as `.FibletSet.points_promise`: 0 where every bit of the points is kept
    bounds: Bounds  # of the original points, mm
    groups: dict[str, int]  # how many members each group has
    dropped: dict[str, int]  # what reading the source left out, by reason
    shards: tuple[Shard, ...]
    thinned: Shard | None = None  # an even share of all streamlines

    def to_json(self) -> str:
        """Return the file's text."""
        return json.dumps({"format": FORMAT, "version": VERSION, **asdict(self)}, indent=1, allow_nan=False) + "\n"

    @classmethod
    def from_json(cls, text: str | bytes, path: str) -> Manifest:
        """Read the file's text."""
        try:
            found = json.loads(text)
        except ValueError as error:
            raise FormatError(path, None, f"a manifest that is no JSON ({error})", "the manifest of a set") from error
        if not isinstance(found, dict) or found.get("format") != FORMAT:
            said = found.get("format") if isinstance(found, dict) else type(found).__name__
            raise FormatError(path, None, f"format {said!r} in its manifest", repr(FORMAT))
        version = found.get("version")
        if version != VERSION:
            update = ": update pvfiblets to read it" if isinstance(version, int) and version > VERSION else ""
            raise FormatError(path, None, f"version {version!r} in its manifest", f"version {VERSION}{update}")
        try:
            return _checked(cls._of(found))
        except (KeyError, TypeError, ValueError, OverflowError) as error:
            raise FormatError(
                path, None, f"a manifest that does not fit together ({error!r})", "one as written"
            ) from error

    @classmethod
    def _of(cls, found: Mapping[str, Any]) -> Manifest:
        return cls(
            streamlines=int(found["streamlines"]),
            points=int(found["points"]),
            n_fiblets=int(found["n_fiblets"]),
            promise_mm=float(found["promise_mm"]),
            bounds=_bounds(found["bounds"]),
            groups={str(k): int(v) for k, v in found["groups"].items()},
            dropped={str(k): int(v) for k, v in found["dropped"].items()},
            shards=tuple(map(_shard, found["shards"])),
            thinned=None if found.get("thinned") is None else _shard(found["thinned"]),
        )

    def meeting(self, bounds: npt.ArrayLike) -> list[int]:
        """Return the numbers of the shards whose bounds meet a box ``(xmin, xmax, ymin, ymax, zmin, zmax)``, mm."""
        box = np.asarray(bounds, float)
        if box.shape != (6,) or not (box[::2] <= box[1::2]).all():
            raise ValueError(
                f"bounds are {np.array2string(box, separator=', ')}; six numbers (xmin, xmax, ymin, ymax, zmin, zmax) "
                "with each minimum first are needed"
            )
        found = []
        for number, shard in enumerate(self.shards):
            b = np.array(shard.bounds)
            if shard.points and (b[::2] <= box[1::2]).all() and (b[1::2] >= box[::2]).all():
                found.append(number)
        return found


def is_set_in_shards(path: str | PathLike[str]) -> bool:
    """Whether a path is a folder that :func:`.write_shards` made."""
    place = Path(path)
    return place.suffix.lower() == ".fiblets" and (place / MANIFEST).is_file()


def _bounds(given: Any) -> Bounds:
    b = [float(v) for v in given]
    if len(b) != 6 or not np.isfinite(b).all():
        raise ValueError(f"bounds {b}")
    return (b[0], b[1], b[2], b[3], b[4], b[5])


def _shard(given: Mapping[str, Any]) -> Shard:
    return Shard(
        fiblets=_file(given["fiblets"]),
        ids=_file(given["ids"]),
        streamlines=int(given["streamlines"]),
        points=int(given["points"]),
        n_fiblets=int(given["n_fiblets"]),
        bounds=_bounds(given["bounds"]),
        length_mm={str(k): float(v) for k, v in given["length_mm"].items()},
        unpacked=max(int(given.get("unpacked", 0)), 0),
    )


def _file(given: Mapping[str, Any]) -> StoredFile:
    name, size = str(given["name"]), int(given["bytes"])
    # Whoever wrote the manifest chooses files of its own folder, and no other.
    if not name or name.startswith(".") or any(c in name for c in "/\\:") or size < 0:
        raise ValueError(f"file {name!r} of {size} bytes")
    return StoredFile(name, size, str(given["sha256"]))


def _checked(manifest: Manifest) -> Manifest:
    if not manifest.shards:
        raise ValueError("no shards")
    for name in ("streamlines", "points", "n_fiblets"):
        parts = [getattr(shard, name) for shard in manifest.shards]
        if min(parts) < 0 or sum(parts) != getattr(manifest, name):
            raise ValueError(f"{name} {getattr(manifest, name)}, of shards {sum(parts)}")
    return manifest
