"""Selecting streamlines of a scene by pixel, box or lasso, and the selection's statistics and actions."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from pvfiblets.web.panels.files.writing import EXPORTS, write
from pvfiblets.web.scene.files.originals import original_of
from pvfiblets.web.session.document import LINES, Ids, Layer
from pvfiblets.web.values import number, numbers, plain, shown, truth, whole

if TYPE_CHECKING:
    from pvfiblets.codec.fibletset import FibletSet
    from pvfiblets.web.scene.scene import Scene

MODES = ("replace", "add", "remove", "toggle")
_LONGEST_LASSO = 4096
_LONGEST_TABLE = 5000


class SceneSelection:
    """Streamlines of a scene that are chosen; pixels count from the lower left corner."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene

    # Picking ------------------------------------------------------------------------------------

    def pick_at(self, x: float, y: float, *, mode: str = "replace", tolerance: float = 4.0) -> dict[str, Any] | None:
        """Select the streamline at a pixel of the last picture."""
        from pvfiblets.plotting.fiblets.pick_result import visible

        at = np.array([[number(x, "x"), number(y, "y")]])
        reach = number(tolerance, "tolerance", 0.0, 64.0)
        found = [
            (picked, layer)
            for layer, actor in self._pickable()
            if (picked := visible(actor, at, tolerance=reach, nearest=True, renderer=self.scene.plotter.renderer))
            is not None
        ]
        if not found:
            self._take({}, mode, "pick nothing")
            return None
        picked, layer = min(found, key=lambda pair: (pair[0].distance, pair[0].depths[0]))
        self._take({layer.id: picked.ids[:1]}, mode, "pick")
        return {
            "layer": layer.id,
            "streamline": int(picked.ids[0]),
            "point": float(picked.places[0]),
            "position": picked.points[0].tolist(),
            "value": plain(float(picked.values[0])),
        }

    def select_box(
        self, x0: float, y0: float, x1: float, y1: float, *, mode: str = "replace", through: bool = False
    ) -> int:
        """Select the streamlines in a rectangle of the last frame; ``through``: occluded ones too."""
        from pvfiblets.plotting.fiblets.pick_result import checked_box

        box = numbers([x0, y0, x1, y1], "box", 4)
        return self._area(checked_box(box), mode, through, "select a box")

    def select_polygon(self, points: Any, *, mode: str = "replace", through: bool = False) -> int:
        """Select the streamlines in a polygon of the last frame, ``(k, 2)`` pixels; see :meth:`select_box`."""
        fine = isinstance(points, (list, tuple, np.ndarray)) and 3 <= len(points) <= _LONGEST_LASSO
        if not fine:
            raise ValueError(f"the lasso is {shown(points)}; give 3 to {_LONGEST_LASSO} pixels")
        corners = [numbers(list(point), "a corner of the lasso", 2) for point in np.asarray(points, object)]
        return self._area(np.array(corners), mode, through, "select by lasso")

    def select(self, layer_id: str, ids: Any, *, mode: str = "replace") -> int:
        """Select streamlines of one layer by their numbers; return how many are selected now."""
        layer = self.scene.lines_layer(layer_id)
        total = self.scene.actor(layer_id).fiblets.n_streamlines
        given = np.atleast_1d(np.asarray(ids))
        if given.size and given.dtype.kind not in "iu":
            raise ValueError(f"streamlines are {shown(ids)}; give whole numbers")
        if given.size and not 0 <= int(given.min()) <= int(given.max()) < total:
            raise ValueError(
                f"streamlines are from {given.min()} to {given.max()}; {layer.name!r} has 0 to {total - 1}"
            )
        self._take({layer_id: given}, mode, "select")
        return self.count()

    def deselect(self) -> None:
        """Select nothing."""
        self._take({}, "replace", "select nothing")

    def count(self) -> int:
        """Return how many streamlines are selected, of all layers."""
        return sum(len(layer.selected) for layer in self.scene.state.layers if layer.selected is not None)

    # What is selected ---------------------------------------------------------------------------

    def table(self, layer_id: str | None = None, *, first: int = 0, limit: int = 200) -> dict[str, Any]:
        """Return the selected streamlines, for a table."""
        first, limit = whole(first, "first"), whole(limit, "limit", 0, _LONGEST_TABLE)
        chosen = [self.scene.lines_layer(layer_id)] if layer_id is not None else self.scene.state.layers
        rows: list[dict[str, Any]] = []
        before = 0
        for layer in chosen:
            if layer.selected is None:
                continue
            ids = layer.selected.array()
            part = ids[max(first - before, 0) : max(first + limit - before, 0)]
            before += len(ids)
            if len(part):
                rows += _rows(layer, self.scene.actor(layer.id), part)
        return {"total": before, "rows": rows}

    def profile(self, layer_id: str, scalars: str | None = None, n: int = 100) -> dict[str, Any]:
        """Return the mean of a value along the selected streamlines, from end to end."""
        layer = self.scene.lines_layer(layer_id)
        if layer.selected is None:
            raise ValueError(f"nothing of {layer.name!r} is selected; pick streamlines first")
        actor = self.scene.actor(layer_id)
        active = actor.active_scalars
        count = whole(n, "n", 2, 1000)
        if active is not None and active.volume is not None and scalars in (None, active.name):
            return _volume_profile(actor, layer.selected.array(), active.volume, count)
        if scalars is None:
            scalars = active.name if active is not None and active.kind == "point_scalar" else "curvature"
        try:
            found = actor.selection_profile(scalars, count)
        except KeyError as error:
            raise ValueError(str(error.args[0])) from error
        return {
            "position": plain(found.position),
            "mean": plain(found.mean),
            "std": plain(found.std),
            "name": found.name,
            "count": found.count,
        }

    def export(self, layer_id: str, path: str, *, what: str = "selected", overwrite: bool = False) -> dict[str, Any]:
        """Write streamlines of a layer to a file under the scene's root."""
        layer = self.scene.lines_layer(layer_id)
        if not isinstance(path, str) or not path.lower().endswith(EXPORTS):
            raise ValueError(f"the file's name is {shown(path)}; let it end in one of {', '.join(EXPORTS)}")
        target = self.scene.files.resolve(path, new=True)
        if target.exists() and not truth(overwrite, "overwrite"):
            raise FileExistsError(f"{path} is there already; give another name")
        fiblets, ids = self.chosen(layer.id, what)
        original, _ = original_of(cast("Scene", self), layer, ids)
        found = write(fiblets, ids, target, original=original)
        return {"path": self.scene.files.name(target), **found}

    def chosen(self, layer_id: str, what: str) -> tuple[Any, np.ndarray]:
        """Return a layer's fiblets and the numbers of streamlines; `what` as of :meth:`export`."""
        layer = self.scene.lines_layer(layer_id)
        actor = self.scene.actor(layer_id)
        if what == "selected":
            if layer.selected is None:
                raise ValueError(f"nothing of {layer.name!r} is selected; pick streamlines first")
            return actor.fiblets, layer.selected.array()
        if what == "shown":
            return actor.fiblets, np.flatnonzero(actor.shown)
        if what == "all":
            return actor.fiblets, np.arange(actor.fiblets.n_streamlines)
        raise ValueError(f"unknown set {shown(what)}; choose one of selected, shown, all")

    # Inside -------------------------------------------------------------------------------------

    def _pickable(self) -> list[tuple[Layer, Any]]:
        return [
            (layer, self.scene.actor(layer.id))
            for layer in self.scene.state.layers
            if layer.kind in LINES and layer.visible
        ]

    def _area(self, corners: np.ndarray, mode: str, through: bool, what: str) -> int:
        from pvfiblets.plotting.fiblets.pick_result import everything, visible

        find: Any = everything if truth(through, "through") else visible
        found = {}
        for layer, actor in self._pickable():
            picked = find(actor, corners, renderer=self.scene.plotter.renderer)
            if picked is not None:
                found[layer.id] = picked.ids
        self._take(found, mode, what)
        return self.count()

    def _take(self, found: dict[str, Any], mode: str, what: str) -> None:
        """Make a selection of streamlines that were found, by layer, and of the present one."""
        if mode not in MODES:
            raise ValueError(f"mode is {shown(mode)}; choose one of {', '.join(MODES)}")

        def chosen(layer: Layer) -> Ids | None:
            if layer.kind not in LINES:
                return None
            new = Ids.from_numbers(found[layer.id]) if layer.id in found else None
            old = layer.selected
            if mode == "replace":
                return new if new is not None and len(new) else None
            if new is None:
                return old
            before = np.zeros(0, np.int64) if old is None else old.array()
            join: Any = {"add": np.union1d, "remove": np.setdiff1d, "toggle": np.setxor1d}[mode]
            joined = Ids.from_numbers(join(before, new.array()))
            return joined if len(joined) else None

        taken = [(layer, chosen(layer)) for layer in self.scene.state.layers]
        layers = tuple(layer if ids == layer.selected else replace(layer, selected=ids) for layer, ids in taken)
        self.scene.become(replace(self.scene.state, layers=layers), what)


def _volume_profile(actor: Any, ids: np.ndarray, volume: Any, n: int) -> dict[str, Any]:
    """Return the profile of a volume's values; see :meth:`SceneSelection.profile`."""
    from pvfiblets.query.measures.profile import mean_profile

    part = actor.fiblets.extract(ids)
    mean, std = mean_profile(part, np.arange(len(ids)), volume.at(part.decompress().points), n)
    position = np.linspace(0.0, 1.0, n)
    return {
        "position": plain(position), "mean": plain(mean), "std": plain(std), "name": volume.name, "count": len(ids),
    }  # fmt: skip


def _along(fiblets: FibletSet, ids: np.ndarray, volume: Any) -> tuple[np.ndarray, np.ndarray]:
    """Return a volume's values at the points of streamlines, as ``point_values`` does."""
    lines = fiblets.decompress(ids)
    return volume.at(lines.points), lines.offsets


def _rows(layer: Layer, actor: Any, ids: np.ndarray) -> list[dict[str, Any]]:
    fiblets = actor.fiblets
    part = fiblets.extract(ids)
    lengths, points = part.lengths(), np.diff(part.offsets())
    values, of = _values(actor, ids)
    groups: list[list[str]] = [[] for _ in ids]
    for name, members in fiblets.groups.items():
        for row in np.flatnonzero(np.isin(ids, members)):
            groups[row].append(name)
    return [
        {
            "layer": layer.id,
            "name": layer.name,
            "streamline": int(ids[row]),
            "points": int(points[row]),
            "length": float(lengths[row]),
            "value": plain(float(values[row])),
            "of": of,
            "groups": groups[row],
        }
        for row in range(len(ids))
    ]


def _values(actor: Any, ids: np.ndarray) -> tuple[np.ndarray, str | None]:
    """Return a number for each streamline, NaN for none, and its name."""
    from pvfiblets.plotting.fiblets.scalars import point_values

    nothing = np.full(len(ids), np.nan)
    scalars = actor.active_scalars
    if scalars is None or not scalars.mapped:
        return nothing, None
    if scalars.kind == "streamline_scalar":
        return np.asarray(scalars.values, np.float64)[ids], scalars.title
    found = _along(actor.fiblets, ids, scalars.volume) if scalars.volume is not None else None
    found = found or point_values(actor.fiblets, ids, scalars.name)
    if found is None:
        return nothing, None
    values, offsets = found
    for row in range(len(ids)):
        some = values[offsets[row] : offsets[row + 1]]
        some = some[np.isfinite(some)]
        if len(some):
            nothing[row] = some.mean()
    return nothing, f"mean of {scalars.title}"
