"""Documents of scenes: immutable values, so that a state of it is kept by keeping a reference.

A :class:`State` says all that a user may undo: layers, cuts, background. It holds no data and no actors; a
:class:`Source` says where a layer's data comes from, and is the same as long as the data is.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np

from pvfiblets.support.vtk_space import Space
from pvfiblets.web.session.painting import Painting
from pvfiblets.web.session.runs import numbers_in, pack, runs_of
from pvfiblets.web.values import shown

__all__ = [
    "KINDS",
    "LINES",
    "Clip",
    "Filters",
    "Ids",
    "Layer",
    "Matrix",
    "Measurement",
    "Source",
    "State",
    "as_volume_choice",
    "free_name",
    "named",
    "volume_in",
    "volumes_of",
]

KINDS = ("tractogram", "tubes", "volume", "mesh", "selection", "image")  # kinds of layers

LINES = ("tractogram", "selection")  # kinds that are drawn from fiblets: they can be filtered, cut and picked


@dataclass(frozen=True, eq=False)
class Ids:
    """Numbers of streamlines, each once and rising, as the runs that they are made of."""

    runs: np.ndarray  # `(n, 2)` int64: first number of each run, and the number behind its last

    def __post_init__(self) -> None:
        runs = np.array(self.runs, np.int64).reshape(-1, 2)
        ends = runs.ravel()
        if len(runs) and (runs[0, 0] < 0 or (np.diff(ends)[::2] <= 0).any() or (np.diff(ends)[1::2] <= 0).any()):
            raise ValueError("runs of streamlines are not rising; give [[first, behind the last], ...] from 0 on")
        runs.flags.writeable = False
        object.__setattr__(self, "runs", runs)

    @classmethod
    def from_numbers(cls, ids: Any) -> Ids:
        """Make them of numbers in any order."""
        return cls(runs_of(np.unique(np.asarray(ids, np.int64))))

    def __len__(self) -> int:
        return int((self.runs[:, 1] - self.runs[:, 0]).sum())

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Ids) and self._bytes == other._bytes

    def __hash__(self) -> int:
        return hash(self._bytes)

    @cached_property
    def _bytes(self) -> bytes:
        return self.runs.tobytes()

    @property
    def highest(self) -> int:
        """The greatest number; -1 for none."""
        return int(self.runs[-1, 1]) - 1 if len(self.runs) else -1

    def array(self) -> np.ndarray:
        """``(n,)`` int64: the numbers."""
        return numbers_in(self.runs)

    @cached_property
    def packed(self) -> str:
        """The numbers as text; see :func:`.pack`."""
        return pack(self.runs)


@dataclass(frozen=True)
class Source:
    """The source of data; one of ``path`` and ``demo``."""

    path: str | None = None  # A file: relative to the scene's root, with `/`, or absolute
    demo: str | None = None  # `"tracts"` or `"head"`: made here (`pvfiblets.synthetic`)
    size: int = 0  # of a demo: streamlines, or voxels along a side
    ids: Ids | None = None  # only these streamlines of it
    # files with a number for each of its points or streamlines; these have the files' names. Of an image, the table of
    # its labels.
    values: tuple[str, ...] = ()
    space: Space | None = None  # of its coordinates, if it is a file of VTK that names none

    @property
    def bare(self) -> Source:
        """The same, whole and with no values but its own."""
        return Source(self.path, self.demo, self.size, space=self.space)


def as_volume_choice(source: Source) -> dict[str, Any]:
    """Return the setting that colours lines by a volume: ``{"volume": {"path": ...}}``, or of a demo its size."""
    if source.path is not None:
        return {"volume": {"path": source.path}}
    return {"volume": {"demo": source.demo, "size": source.size}}


def volume_in(setting: Any) -> Source | None:
    """Return the volume that a setting of :func:`as_volume_choice` names; ``None`` for any other."""
    if not isinstance(setting, Mapping) or not isinstance(setting.get("volume"), Mapping):
        return None
    named = setting["volume"]
    return Source(named.get("path"), named.get("demo"), named.get("size", 0))


VOLUME_SETTINGS = ("scalars", "modulate")
"""Settings that may name a volume: what colours lines, and what directions of an image are as bright as."""


def volumes_of(settings: Mapping[str, Any]) -> dict[str, Source]:
    """Return the volumes that settings of a layer name, by setting."""
    found = {name: volume_in(settings.get(name)) for name in VOLUME_SETTINGS}
    return {name: source for name, source in found.items() if source is not None}


@dataclass(frozen=True)
class Filters:
    """The filters of a layer's streamlines; all of them together."""

    # least and greatest value that is shown, by the name of the values
    criteria: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    # images whose values at the points criteria of these names compare
    images: Mapping[str, Source] = field(default_factory=dict)
    groups: tuple[str, ...] | None = None  # those shown; `None` for all streamlines
    subset: Mapping[str, Any] | None = None  # `{"amount": share or number, "seed": int}` or `{"every": n}`
    # an expression of `pvfiblets.web.session.shapes`: `{"how": "passes", "region": {...}}`, joined by `{"op": "and" |
    # "or" | "not", "of": [...]}`
    regions: Mapping[str, Any] | None = None
    # `{"labels": path, "pair": [label, label], "radius": mm}`: streamlines between two parcels of a label volume, as
    # `pvfiblets.connectome` has it
    connection: Mapping[str, Any] | None = None

    @property
    def active(self) -> bool:
        """Whether anything is left out."""
        others = (self.groups, self.subset, self.regions, self.connection)
        return bool(self.criteria) or any(part is not None for part in others)


@dataclass(frozen=True)
class Layer:
    """Something that a scene shows."""

    id: str  # stays the same as long as the layer is there
    kind: str  # of `KINDS`
    name: str  # for people
    source: Source  # where its data comes from
    visible: bool = True
    # all settable properties (`pvfiblets.web.scene.layers`), defaults included
    settings: Mapping[str, Any] = field(default_factory=dict)
    filters: Filters = field(default_factory=Filters)
    selected: Ids | None = None  # streamlines that are selected

    @property
    def path(self) -> str | None:
        """The file, relative to the scene's root where it lies in it; None where there is none."""
        return self.source.path

    @property
    def volumes(self) -> tuple[Source, ...]:
        """Volumes and images that colour or filter it."""
        return *volumes_of(self.settings).values(), *self.filters.images.values()


@dataclass(frozen=True)
class Bundle:
    """A named set of streamlines: its colour (``#rrggbb``), and whether it is shown."""

    name: str
    ids: Ids
    color: str
    visible: bool = True


@dataclass(frozen=True)
class Clip:
    """A cut through layers."""

    id: str
    name: str
    # of `pvfiblets.web.session.shapes`, such as `{"kind": "plane", "normal": [...], "origin": [...]}`
    shape: Mapping[str, Any]
    inside: bool = True  # which side stays: of a plane, that which the normal points to
    enabled: bool = True
    layers: tuple[str, ...] | None = None  # ids of cut layers; `None` for all layers of lines, later ones included

    def cuts(self, layer: Layer) -> bool:
        """Whether it cuts a layer."""
        if not self.enabled:
            return False
        return layer.kind in LINES if self.layers is None else layer.id in self.layers


@dataclass(frozen=True)
class Measurement:
    """A straight distance."""

    begin: tuple[float, float, float]  # where it is measured, mm
    end: tuple[float, float, float]

    @property
    def mm(self) -> float:
        """Its length."""
        return math.dist(self.begin, self.end)

    @property
    def text(self) -> str:
        """Its length, for people."""
        return f"{self.mm:.4g} mm"


@dataclass(frozen=True)
class Matrix:
    """A connectome: the connections of a label volume's parcels by a tractogram."""

    layer: str  # id of the tractogram
    labels: str  # the volume's file
    names: str | None = None  # A file with the labels' names
    weights: str | None = None  # as of `pvfiblets.connectome`; weights and contrast are names of arrays
    contrast: str = "count"
    statistic: str | None = None
    radius: float = 4.0
    graph: bool = False  # whether its nodes and edges are in the 3-D view
    threshold: float = 0.0  # weaker connections are not shown
    log: bool = True  # colours by logarithms

    @property
    def bare(self) -> Matrix:
        """The same numbers, however they are shown."""
        return replace(self, graph=False, threshold=0.0, log=True)


@dataclass(frozen=True)
class State:
    """A scene's document."""

    layers: tuple[Layer, ...] = ()
    clips: tuple[Clip, ...] = ()
    # `#rrggbb`
    background: str = "#000000"
    measurements: tuple[Measurement, ...] = ()
    painting: Painting | None = None  # regions that are painted on slices
    # bundles of the sources whose bundles were edited
    bundles: tuple[tuple[Source, tuple[Bundle, ...]], ...] = ()
    matrix: Matrix | None = None  # that which is shown beside the picture
    oblique: tuple[float, float] | None = None  # tilt and turn of the oblique slice, degrees

    def bundles_of(self, source: Source) -> tuple[Bundle, ...] | None:
        """Return the bundles of a source, if they were edited; None for the groups of its file."""
        return next((listed for one, listed in self.bundles if one == source), None)

    def layer(self, layer_id: str) -> Layer:
        """Return a layer."""
        return named(self.layers, layer_id, "layer", by="id")

    def clip(self, clip_id: str) -> Clip:
        """Return a cut; errors as of :meth:`layer`."""
        return named(self.clips, clip_id, "cut", by="id")

    def sources(self) -> set[tuple[str, Source]]:
        """Kind and source of all layers, and of volumes that colour or filter them as of the kind ``"colours"``."""
        sampled = {("colours", source) for layer in self.layers for source in layer.volumes}
        return sampled | {(layer.kind, layer.source) for layer in self.layers}


def free_name(name: str, taken: Collection[str], kept: int | None = None) -> str:
    """Return a name, shortened and numbered if it is taken."""
    numbered = (f"{name[:kept]} {k}" for k in range(2, len(taken) + 3))
    return name if name not in taken else next(found for found in numbered if found not in taken)


def named(things: Iterable[Any], wanted: Any, what: str, *, by: str = "name") -> Any:
    """Return the one of some things that has a name."""
    things = list(things)
    found = next((thing for thing in things if getattr(thing, by) == wanted), None)
    if found is None:
        there = ", ".join(repr(getattr(thing, by)) for thing in things[:40]) or "none"
        raise KeyError(f"there is no {what} {shown(wanted)}; there are: {there}")
    return found
