"""Documents of scenes: immutable values, so that a state of it is kept by keeping a reference.

A :class:`State` says all that a user may undo: layers, cuts, background. It holds no data and no actors; a
:class:`Source` says where a layer's data comes from, and is the same as long as the data is.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field
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

KINDS = ("tractogram", "tubes", "volume", "mesh", "selection", "image")
"""Kinds of layers."""

LINES = ("tractogram", "selection")
"""Kinds that are drawn from fiblets: they can be filtered, cut and picked."""


@dataclass(frozen=True, eq=False)
class Ids:
    """Numbers of streamlines, each once and rising, as the runs that they are made of.

    Parameters
    ----------
    runs : array_like
        ``(n, 2)`` int64: first number of each run, and the number behind its last.

    Raises
    ------
    ValueError
        If runs are empty, negative, or not rising.
    """

    runs: np.ndarray

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
    """The source of data; one of ``path`` and ``demo``.

    Attributes
    ----------
    path : str or None
        A file: relative to the scene's root, with ``/``, or absolute.
    demo : str or None
        ``"tracts"`` or ``"head"``: made here (:mod:`pvfiblets.synthetic`).
    size : int
        Of a demo: streamlines, or voxels along a side.
    ids : Ids or None
        Only these streamlines of it.
    values : tuple of str
        Files with a number for each of its points or streamlines; these have the files' names. Of an image, the table
        of its labels.
    space : {"RAS", "LPS"} or None
        Of its coordinates, if it is a file of VTK that names none.
    """

    path: str | None = None
    demo: str | None = None
    size: int = 0
    ids: Ids | None = None
    values: tuple[str, ...] = ()
    space: Space | None = None

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
    """The filters of a layer's streamlines; all of them together.

    Attributes
    ----------
    criteria : mapping of str to (float, float)
        Least and greatest value that is shown, by the name of the values.
    images : mapping of str to Source
        Images whose values at the points criteria of these names compare.
    groups : tuple of str or None
        Those shown; ``None`` for all streamlines.
    subset : mapping or None
        ``{"amount": share or number, "seed": int}`` or ``{"every": n}``.
    regions : mapping or None
        An expression of :mod:`pvfiblets.web.session.shapes`: ``{"how": "passes", "region": {...}}``, joined by
        ``{"op": "and" | "or" | "not", "of": [...]}``.
    connection : mapping or None
        ``{"labels": path, "pair": [label, label], "radius": mm}``: streamlines between two parcels of a label volume,
        as :func:`pvfiblets.connectome` has it.
    """

    criteria: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    images: Mapping[str, Source] = field(default_factory=dict)
    groups: tuple[str, ...] | None = None
    subset: Mapping[str, Any] | None = None
    regions: Mapping[str, Any] | None = None
    connection: Mapping[str, Any] | None = None

    @property
    def active(self) -> bool:
        """Whether anything is left out."""
        others = (self.groups, self.subset, self.regions, self.connection)
        return bool(self.criteria) or any(part is not None for part in others)


@dataclass(frozen=True)
class Layer:
    """Something that a scene shows.

    Attributes
    ----------
    id : str
        Stays the same as long as the layer is there.
    kind : str
        Of `KINDS`.
    name : str
        For people.
    source : Source
        Where its data comes from.
    visible : bool
    settings : mapping of str to JSON values
        All settable properties (:mod:`pvfiblets.web.scene.layers`), defaults included.
    filters : Filters
    selected : Ids or None
        Streamlines that are selected.
    """

    id: str
    kind: str
    name: str
    source: Source
    visible: bool = True
    settings: Mapping[str, Any] = field(default_factory=dict)
    filters: Filters = field(default_factory=Filters)
    selected: Ids | None = None

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
    """A cut through layers.

    Attributes
    ----------
    id, name : str
    shape : mapping
        Of :mod:`pvfiblets.web.session.shapes`, such as ``{"kind": "plane", "normal": [...], "origin": [...]}``.
    inside : bool
        Which side stays: of a plane, that which the normal points to.
    enabled : bool
    layers : tuple of str or None
        Ids of cut layers; ``None`` for all layers of lines, later ones included.
    """

    id: str
    name: str
    shape: Mapping[str, Any]
    inside: bool = True
    enabled: bool = True
    layers: tuple[str, ...] | None = None

    def cuts(self, layer: Layer) -> bool:
        """Whether it cuts a layer."""
        if not self.enabled:
            return False
        return layer.kind in LINES if self.layers is None else layer.id in self.layers


@dataclass(frozen=True)
class Measurement:
    """A straight distance.

    Attributes
    ----------
    begin, end : tuple of 3 floats
        Where it is measured, mm.
    """

    begin: tuple[float, float, float]
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
    """A connectome: the connections of a label volume's parcels by a tractogram.

    Attributes
    ----------
    layer : str
        Id of the tractogram.
    labels : str
        The volume's file.
    names : str or None
        A file with the labels' names.
    weights, contrast, statistic, radius
        As of :func:`pvfiblets.connectome`; weights and contrast are names of arrays.
    """

    layer: str
    labels: str
    names: str | None = None
    weights: str | None = None
    contrast: str = "count"
    statistic: str | None = None
    radius: float = 4.0


@dataclass(frozen=True)
class State:
    """A scene's document.

    Attributes
    ----------
    layers : tuple of Layer
    clips : tuple of Clip
    background : str
        ``#rrggbb``.
    measurements : tuple of Measurement
    painting : Painting or None
        Regions that are painted on slices.
    bundles : tuple of (Source, tuple of Bundle)
        Those of sources whose bundles were edited.
    matrix : Matrix or None
        That which is shown beside the picture.
    oblique : tuple of 2 floats or None
        Tilt and turn of the oblique slice, degrees.
    """

    layers: tuple[Layer, ...] = ()
    clips: tuple[Clip, ...] = ()
    background: str = "#000000"
    measurements: tuple[Measurement, ...] = ()
    painting: Painting | None = None
    bundles: tuple[tuple[Source, tuple[Bundle, ...]], ...] = ()
    matrix: Matrix | None = None
    oblique: tuple[float, float] | None = None

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
