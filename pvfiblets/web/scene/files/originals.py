"""The streamlines of a layer as its file has them, before they were coded."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets import formats
from pvfiblets.formats.attachments import name_of, values_for
from pvfiblets.formats.registry import suffix_of

if TYPE_CHECKING:
    from pvfiblets.streamlines import Streamlines
    from pvfiblets.web.scene.files.loading import Watch
    from pvfiblets.web.scene.scene import Scene
    from pvfiblets.web.session.document import Layer


@dataclass(frozen=True, eq=False)
class Original:
    """The source of some streamlines."""

    path: Path
    values: tuple[Path, ...]  # files with values of all of its streamlines
    ids: np.ndarray  # numbers of the streamlines in the file, rising

    def chunks(self, watch: Watch) -> Iterator[Streamlines]:
        """Yield the streamlines as the file has them, piece by piece; one piece at least."""
        last = int(self.ids[-1]) if len(self.ids) else -1
        attached = self._attached() if self.values else {}
        first = points = 0
        for chunk in formats.iter_chunks(self.path):
            n, of_points = len(chunk), chunk.n_points
            for name, (where, values) in attached.items():
                span = slice(points, points + of_points) if where == "per_point" else slice(first, first + n)
                getattr(chunk, where)[name] = values[span]
            low, high = np.searchsorted(self.ids, [first, first + n])
            if high > low or first == 0:
                yield chunk[self.ids[low:high] - first]
            first, points = first + n, points + of_points
            watch("reading the source", 0.7 * min(first / (last + 1), 1.0) if last >= 0 else 0.7)
            if first > last:
                return
        raise ValueError(f"{self.path.name} has {first:,} streamlines now; streamline {last} does not exist")

    def _attached(self) -> dict[str, tuple[str, Any]]:
        counts = np.concatenate([chunk.counts for chunk in formats.iter_chunks(self.path)])
        return {name_of(path): values_for(path, counts) for path in self.values}


def original_of(scene: Scene, layer: Layer, ids: np.ndarray) -> tuple[Original | None, str]:
    """Return where streamlines of a layer came from, or else why their points are not to be had."""
    source = layer.source
    if source.path is None or suffix_of(source.path) == ".fiblets":
        return None, ""
    for name, stamp in scene.data(layer).stamps.items():
        try:
            now = scene.files.stamp(scene.files.resolve(name))
        except (OSError, ValueError):
            return None, f"{Path(name).name} is not there any more"
        if now != stamp:
            return None, f"{Path(name).name} has changed since it was opened"
    numbers = np.asarray(ids, np.int64) if source.ids is None else source.ids.array()[ids]
    places = [scene.files.resolve(name) for name in (source.path, *source.values)]
    return Original(places[0], tuple(places[1:]), numbers), ""
