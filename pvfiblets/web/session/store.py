"""Data that a scene's documents name, read once: tractograms, volumes, meshes, regions, by their source."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets.web.scene.files.loading import Cancel, Files, Loaded, Progress, Watch
from pvfiblets.web.session.document import LINES, Layer, Matrix, Source, State

if TYPE_CHECKING:
    from pvfiblets.codec.fibletset import FibletSet
    from pvfiblets.query.connectome.matrix import Connectome

__all__ = ["Store"]

KEPT = 3  # tables of the parcels in which streamlines end, eight bytes a streamline, and matrices


@dataclass(frozen=True, eq=False)
class _Ends:
    """Parcels of the ends of streamlines, by the volume's path and the radius."""

    fiblets: Any
    at: tuple[str, float]
    labels: np.ndarray


class Store:
    """Data of a scene."""

    def __init__(self, files: Files) -> None:
        self.files = files  # where it is read from
        self.loaded: dict[tuple[str, Source], Loaded] = {}
        self.shapes: dict[tuple[str, Source], Any] = {}
        self.ends: list[_Ends] = []
        self.connectomes: list[tuple[Any, Matrix, Connectome]] = []  # with their fiblets

    def fork(self) -> Store:
        """Return another that begins with the same; a thread may fill it while this one is in use."""
        twin = Store(self.files)
        twin.loaded, twin.shapes = self.loaded.copy(), self.shapes.copy()
        twin.ends, twin.connectomes = list(self.ends), list(self.connectomes)
        return twin

    def take(self, other: Store) -> None:
        """Take over all data of another store."""
        self.loaded = {**other.loaded, **self.loaded}
        self.shapes = {**other.shapes, **self.shapes}
        self.ends = [*self.ends, *(one for one in other.ends if one not in self.ends)][-KEPT:]
        known = [id(one) for *_, one in self.connectomes]
        self.connectomes += [one for one in other.connectomes if id(one[-1]) not in known]
        del self.connectomes[:-KEPT]

    @contextmanager
    def with_new(self, loaded: Loaded) -> Iterator[None]:
        """Keep the loaded data, unless their use fails: then undo it."""
        before = self.loaded.copy()
        self.put(loaded)
        try:
            yield
        except BaseException:
            self.loaded = before
            raise

    def put(self, loaded: Loaded) -> None:
        """Keep the loaded data, in place of earlier data of that source."""
        self.loaded.pop(("colours", loaded.source), None)  # of the file as it was
        self.loaded[loaded.kind, loaded.source] = loaded

    def data(self, layer: Layer, progress: Progress | None = None, cancel: Cancel | None = None) -> Loaded:
        """Return what a layer draws; it is read if it must be."""
        kind = _family(layer.kind)
        key = kind, layer.source
        if key not in self.loaded:
            loaded = self._read(kind, layer.source.bare, progress, cancel)
            if layer.source.values:
                loaded = self.files.with_values(loaded, layer.source.values)
            if layer.source.ids is not None:
                ids, total = layer.source.ids, loaded.data.n_streamlines
                if ids.highest >= total:
                    raise ValueError(f"streamline {ids.highest} does not exist; {loaded.name} has {total}")
                loaded = replace(loaded, source=layer.source, data=loaded.data.extract(ids.array()))
            self.loaded[key] = loaded
        for volume in layer.volumes:
            self.colours(volume, progress, cancel)
        return self.loaded[key]

    def whole(self, source: Source, progress: Progress | None = None, cancel: Cancel | None = None) -> Any:
        """Return all streamlines of a source's file, a :class:`.FibletSet`."""
        found = self._read("tractogram", source.bare, progress, cancel)
        if found.kind not in LINES:
            raise ValueError(f"{found.name} is of kind {found.kind} and has no streamlines")
        return found.data

    def colours(self, source: Source, progress: Progress | None = None, cancel: Cancel | None = None) -> Any:
        """Return the volume, a :class:`.VolumeSource`, that colours or filters lines where they run."""
        return self._read("colours", source, progress, cancel).data

    def shape(self, shape: Mapping[str, Any]) -> Any:
        """Return what a region is made of: the region of a mesh, or an image of labels."""
        key = kind, source = shape["kind"], Source(shape["path"], space=shape.get("space"))
        if key not in self.shapes:
            from pvfiblets.plotting.filtering.region_sources import as_region

            data = self.files.load(source, kind).data
            self.shapes[key] = as_region(data) if kind == "mesh" else data
        return self.shapes[key]

    def parcels(self, path: str) -> tuple[Any, Any]:
        """Return the labels of a volume, ``(i, j, k)``, and the matrix that places them."""
        volume = self.shape({"kind": "labels", "path": path})
        return volume.labels, volume.affine

    def end_labels(
        self,
        fiblets: FibletSet,
        path: str,
        radius: float,
        progress: Progress | None = None,
        cancel: Cancel | None = None,
    ) -> Any:
        """Return the parcels in which streamlines end, ``(n, 2)``, as :func:`.end_labels`; the latest are kept."""
        found = next((one for one in self.ends if one.fiblets is fiblets and one.at == (path, radius)), None)
        if found is None:
            from pvfiblets.query.connectome.matrix import end_labels

            labels = end_labels(fiblets, self.parcels(path), radius, progress=Watch(progress, cancel))
            found = _Ends(fiblets, (path, radius), labels.astype(np.int32))
            self.ends = [*self.ends[1 - KEPT :], found]
        return found.labels

    def connectome(self, fiblets: FibletSet, matrix: Matrix) -> Connectome | None:
        """Return the numbers of a matrix; None if they are not known."""
        known = (found for data, of, found in self.connectomes if data is fiblets and of == matrix.bare)
        return next(known, None)

    def keep(self, states: Iterable[State]) -> None:
        """Release data that none of some documents needs."""
        needed = set()
        for state in states:
            for kind, source in state.sources():
                needed |= {(_family(kind), source), (_family(kind), source.bare)}
        self.loaded = {key: loaded for key, loaded in self.loaded.items() if key in needed}
        alive = [loaded.data for loaded in self.loaded.values()]
        self.ends = [one for one in self.ends if any(one.fiblets is data for data in alive)]
        self.connectomes = [one for one in self.connectomes if any(one[0] is data for data in alive)]

    def clear(self) -> None:
        """Release everything."""
        self.loaded.clear()
        self.shapes.clear()
        self.ends.clear()
        self.connectomes.clear()

    def _read(self, kind: str, source: Source, progress: Progress | None, cancel: Cancel | None) -> Loaded:
        if (kind, source) not in self.loaded:
            self.loaded[kind, source] = self.files.load(source, kind, progress, cancel)
        return self.loaded[kind, source]


def _family(kind: str) -> str:
    return "tractogram" if kind in LINES else kind
