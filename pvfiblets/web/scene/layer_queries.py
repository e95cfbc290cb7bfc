"""Queries of a scene's layers: properties, histograms, facts, and the meaning of colours."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets.web.scene import layers
from pvfiblets.web.session.document import LINES, Layer, Source, volume_in
from pvfiblets.web.values import plain, shown, whole

if TYPE_CHECKING:
    from pvfiblets.web.scene.scene import Scene

MOST_POINTS = 4_000_000  # greatest number of values in a histogram; of larger data an even share

_KEPT = 64  # histograms


class LayerQueries:
    """Read-only queries of a scene's layers."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        self.histograms: dict[tuple[Any, ...], dict[str, Any]] = {}

    def properties(self, layer_id: str) -> list[dict[str, Any]]:
        """Return all that can be set of a layer, and its present values; see :meth:`.Property.describe`."""
        layer = self.scene.layer(layer_id)
        data = self.scene.data(layer).data
        volumes = self.scene.volume_choices(layer)
        return plain(layers.describe(layer.kind, self.scene.actor(layer_id), data, layer.settings, volumes))

    def arrays(self, layer_id: str) -> list[dict[str, str]]:
        """Return the values that a layer can be filtered by and that have histograms: ``name``, ``title``."""
        from pvfiblets.plotting.colours.scalars import UNITS
        from pvfiblets.web.scene.layer_properties import value_names

        layer = self.scene.layer(layer_id)
        data = self.scene.data(layer).data
        if layer.kind in LINES:
            names = value_names(data)
        elif layer.kind in ("volume", "image"):
            names = [data.name] if layer.kind == "volume" or data.n_volumes == 1 else []
        elif layer.kind == "mesh":
            scalars = next(prop for prop in layers.TABLES["mesh"] if prop.name == "scalars")
            names = [name for name, _ in scalars.choices_for(data) if name is not None]
        else:
            names = ["radius"]
        return [{"name": name, "title": UNITS.get(name, name)} for name in names]

    def histogram(self, layer_id: str, array: str | Source | None = None, bins: int = 64) -> dict[str, Any]:
        """Return a histogram of values; an image's values are sampled at the points of lines."""
        layer = self.scene.layer(layer_id)
        count = whole(bins, "bins", 1, 4096)
        known = [entry["name"] for entry in self.arrays(layer_id)]
        colours = layer.settings.get("scalars")
        if array is None and (volume := volume_in(colours)) is not None:
            return self._kept(("colours", volume, count), lambda: _counted(self.scene.store.colours(volume), count))
        if array is None:
            array = colours if colours in known else (known or [""])[0]
        what: Any = array
        name: Any = array
        if isinstance(array, Source) and layer.kind in LINES:
            what = self.scene.store.colours(array)
            name = what.name
        elif array not in known:
            raise ValueError(f"there are no values {shown(array)} in {layer.name!r}; there are {', '.join(known)}")
        data = self.scene.data(layer).data
        return self._kept(
            (layer.kind, layer.source, array, count), lambda: _count(name, *_values(layer, data, what), count)
        )

    def _kept(self, key: tuple[Any, ...], make: Callable[[], dict[str, Any]]) -> dict[str, Any]:
        """Return a histogram that was made before, or make it."""
        if key not in self.histograms:
            if len(self.histograms) >= _KEPT:
                self.histograms.pop(next(iter(self.histograms)))
            self.histograms[key] = make()
        return self.histograms[key]

    def info(self, layer_id: str) -> dict[str, Any]:
        """Return the facts of a layer, in JSON's types."""
        layer = self.scene.layer(layer_id)
        actor, loaded = self.scene.actor(layer_id), self.scene.data(layer)
        found: dict[str, Any] = {
            "name": layer.name,
            "kind": layer.kind,
            "path": layer.path,
            "facts": loaded.facts,
        }
        if layer.kind == "image":
            corners = loaded.data.corners
            ends = zip(corners.min(axis=0).tolist(), corners.max(axis=0).tolist(), strict=True)
            return plain(found | {"bounds": [end for pair in ends for end in pair]})
        found["bounds"] = list(loaded.data.bounds)
        if layer.kind == "mesh":
            return plain(found)
        explained = actor.explain()
        found["milliseconds"] = sum(entry.get("ms") or 0.0 for entry in explained["passes"])
        found["gpu_bytes"] = explained["gpu_bytes"]
        if layer.kind in LINES:
            fiblets = actor.fiblets
            found["promise_mm"] = fiblets.points_promise
            found |= loaded.error or {}
            found["points"] = fiblets.n_points
            found["bytes"] = fiblets.nbytes
            found["groups"] = {name: len(members) for name, members in fiblets.groups.items()}
            found["streamlines"] = explained["streamlines"]
            found["fiblets"] = {"drawn": explained["fiblets"]["drawn"], "total": fiblets.n_fiblets}
        found["explain"] = explained
        return plain(found)

    @property
    def legend(self) -> list[dict[str, Any]]:
        """Return the meaning of the colours of each visible layer."""
        found = []
        for layer in self.scene.state.layers:
            if not layer.visible or layer.kind == "image":
                continue
            s, actor = layer.settings, self.scene.actor(layer.id)
            entry: dict[str, Any] = {"layer": layer.id, "name": layer.name}
            title = s["scalars"] if layer.kind == "mesh" else actor.scalars_title
            if title is not None and getattr(actor, "shows_labels", False):
                entry |= {"title": title, "cmap": s["cmap"], "names": list(actor.active_scalars.categories.values())}
            elif title is not None:
                clim = actor.mapper.scalar_range if layer.kind == "mesh" else actor.clim
                entry |= {"title": title, "cmap": s["cmap"], "clim": clim, "log_scale": s.get("log_scale", False)}
            elif s.get("scalars") is None:
                entry["color"] = s["color"]
            elif s["scalars"] == "orientation":
                entry["directions"] = {"red": "left–right", "green": "back–front", "blue": "down–up"}
            found.append(entry)
        return plain(found)


def _counted(volume: Any, count: int) -> dict[str, Any]:
    """Return the histogram of a volume that colours lines, or of an even share of it."""
    every = max(volume.values.size // MOST_POINTS, 1)
    return _count(volume.name, np.asarray(volume.values.reshape(-1)[::every], np.float64), 1.0 / every, count)


def _count(name: str, values: np.ndarray, share: float, count: int) -> dict[str, Any]:
    fine = values[np.isfinite(values)]
    counts, edges = np.histogram(fine, bins=count) if len(fine) else (np.zeros(count), np.linspace(0, 1, count + 1))
    return {
        "name": name,
        "edges": plain(edges),
        "counts": [int(number) for number in counts],
        "missing": int(len(values) - len(fine)),
        "share": share,
    }


def _values(layer: Layer, data: Any, name: Any) -> tuple[np.ndarray, float]:
    """Return the numbers of a layer, or of an even share of it, and how large that is."""
    if layer.kind in LINES:
        from pvfiblets.query.measures.measures import measure

        share = 1.0
        if data.n_points > MOST_POINTS:
            count = max(MOST_POINTS * data.n_streamlines // data.n_points, 1)
            ids = np.unique(np.linspace(0, data.n_streamlines - 1, count).astype(np.int64))
            share, data = len(ids) / data.n_streamlines, data.extract(ids)
        return np.asarray(measure(data, name).array(), np.float64), share
    if layer.kind in ("volume", "image"):
        every = max(data.values.size // MOST_POINTS, 1)
        return np.asarray(data.values.reshape(-1)[::every], np.float64), 1.0 / every
    if layer.kind == "tubes":
        return np.asarray(data.radius, np.float64), 1.0
    array = np.asarray(data.point_data[name] if name in data.point_data else data.cell_data[name], np.float64)
    return (np.linalg.norm(array, axis=1) if array.ndim == 2 else array), 1.0
