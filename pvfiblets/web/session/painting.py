"""Regions that are painted on slices, as plain values: what a document holds, sessions keep and undo goes through.

Voxels are held as strokes, each with the one before it: documents share them, and from one document to another leads
the way back to the last stroke that both have, and on from there.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from pvfiblets.query.painting.painter import Stroke
from pvfiblets.web.session.runs import numbers_in, pack, runs_of, unpack
from pvfiblets.web.values import colour, mapping, numbers, shown, text, truth, whole

USES = {
    "": "not used",
    "passes": "pass through",
    "misses": "miss",
    "ends_in": "end in",
    "stays_in": "stay in",
    "in_order": "pass in order",
}
"""Relations of visible streamlines to a region."""

LONGEST = 60  # characters of a name
MOST_REGIONS = 32
MOST_VOXELS = 1 << 28


@dataclass(frozen=True)
class Painted:
    """A region: its name, its number in the volume, its colour (``#rrggbb``), and its use, of `USES`."""

    name: str
    label: int
    color: str
    visible: bool = True
    use: str = ""


@dataclass(frozen=True, eq=False)
class Strokes:
    """The last of the strokes that were painted, and those before it."""

    stroke: Stroke
    before: Strokes | None
    count: int

    @classmethod
    def after(cls, before: Strokes | None, stroke: Stroke) -> Strokes:
        """Return the strokes with one more."""
        return cls(stroke, before, 1 if before is None else before.count + 1)


@dataclass(frozen=True)
class Painting:
    """The painted regions of a scene, on the voxels of one image."""

    shape: tuple[int, int, int]
    affine: tuple[float, ...]  # voxels to mm, row by row
    regions: tuple[Painted, ...] = ()
    strokes: Strokes | None = None

    @property
    def matrix(self) -> np.ndarray:
        """``(4, 4)`` voxels to mm."""
        return np.array(self.affine).reshape(4, 4)

    def region(self, name: str) -> Painted:
        """Return a region; KeyError if there is none of that name."""
        found = next((one for one in self.regions if one.name == name), None)
        if found is None:
            there = ", ".join(repr(one.name) for one in self.regions) or "none"
            raise KeyError(f"there is no painted region {shown(name)}; there are: {there}")
        return found

    def with_region(self, old: Painted, new: Painted | None) -> Painting:
        """Return the same with a region in another's place, or without it."""
        rest = ((new if one is old else one) for one in self.regions)
        return replace(self, regions=tuple(one for one in rest if one is not None))


def path_between(now: Strokes | None, wanted: Strokes | None) -> tuple[list[Stroke], list[Stroke]]:
    """Return the strokes to undo, the last first, and the strokes to redo, the first first."""
    back: list[Stroke] = []
    on: list[Stroke] = []
    while now is not wanted:
        if now is not None and (wanted is None or now.count >= wanted.count):
            back.append(now.stroke)
            now = now.before
        else:
            assert wanted is not None
            on.append(wanted.stroke)
            wanted = wanted.before
    return back, on[::-1]


# Sessions -------------------------------------------------------------------------------------------


def check_painting(value: Any) -> Painting:
    """Return painted regions, of what a session says."""
    given = mapping(value, "painting", ("shape", "affine", "regions"))
    if not isinstance(given["shape"], list) or len(given["shape"]) != 3:
        raise ValueError(f"shape of painting is {shown(given['shape'])}; give three whole numbers")
    nx, ny, nz = (whole(side, "shape of painting", 1, 1 << 16) for side in given["shape"])
    if nx * ny * nz > MOST_VOXELS:
        raise ValueError(f"painting is on {nx * ny * nz:,} voxels; {MOST_VOXELS:,} at most")
    affine = numbers(given["affine"], "affine of painting", 16)
    if not abs(np.linalg.det(np.array(affine).reshape(4, 4)[:3, :3])) > 0.0:
        raise ValueError("affine of painting cannot be inverted; give the matrix from voxels to mm")
    listed = given["regions"]
    if not isinstance(listed, list) or not 1 <= len(listed) <= MOST_REGIONS:
        raise ValueError(f"regions of painting are {shown(listed)}; give a list of 1 to {MOST_REGIONS}")
    regions = tuple(_region(one, number) for number, one in enumerate(listed, 1))
    if len({one.name for one in regions}) < len(regions):
        raise ValueError("two painted regions have the same name; give each its own")
    runs = [unpack(one["runs"], "runs of a painted region", nx * ny * nz, "voxel") for one in listed]
    spans = np.concatenate(runs)
    spans = spans[np.argsort(spans[:, 0])]
    if (spans[1:, 0] < spans[:-1, 1]).any():
        raise ValueError("a voxel is in two painted regions; it is in one at most")
    places = np.concatenate([numbers_in(one) for one in runs])
    counts = [int((one[:, 1] - one[:, 0]).sum()) for one in runs]
    labels = np.repeat(np.arange(1, len(runs) + 1, dtype=np.uint16), counts)
    stroke = Stroke(places, np.zeros(len(places), np.uint16), labels)
    strokes = Strokes.after(None, stroke) if len(places) else None
    return Painting((nx, ny, nz), tuple(affine), regions, strokes)


def _region(value: Any, label: int) -> Painted:
    mapping(value, "painted region", ("name", "color", "runs"), ("visible", "use"))
    use = value.get("use", "")
    if not isinstance(use, str) or use not in USES:
        raise ValueError(f"use of a painted region is {shown(use)}; choose one of {', '.join(filter(None, USES))}")
    return Painted(
        text(value["name"], "name of a painted region", LONGEST),
        label,
        colour(value["color"], "colour of a painted region"),
        truth(value.get("visible", True), "visible"),
        use,
    )


def as_json(painting: Painting, labels: np.ndarray) -> Mapping[str, Any]:
    """Return painted regions in JSON's types; ``labels`` is the volume as it is, ``(i, j, k)``."""
    flat = labels.reshape(-1)
    return {
        "shape": list(painting.shape),
        "affine": list(painting.affine),
        "regions": [
            {"name": one.name, "color": one.color, "visible": one.visible, "use": one.use,
             "runs": pack(runs_of(np.flatnonzero(flat == one.label)))}
            for one in painting.regions
        ],
    }  # fmt: skip
