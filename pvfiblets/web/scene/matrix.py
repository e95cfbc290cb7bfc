"""The matrix of a scene: how strongly parcels are connected, and the streamlines that connect two of them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets.query.connectome.matrix import STATISTICS
from pvfiblets.web.session.document import Matrix, State
from pvfiblets.web.values import mapping, number, shown, text, truth, whole

if TYPE_CHECKING:
    from pvfiblets.plotting.connectomes.graph import ConnectomeGraph, ConnectomePick
    from pvfiblets.query.connectome.matrix import Connectome
    from pvfiblets.web.scene.files.loading import Cancel, Progress
    from pvfiblets.web.scene.scene import Scene
    from pvfiblets.web.session.store import Store

__all__ = ["SceneMatrix", "as_json", "check_connection", "check_matrix", "choices", "colour_range", "graph_looks"]

PARCELS = 1024  # greatest number of parcels of a matrix
COLOURS = "viridis"
WIDEST = 100.0  # mm about an end in which its parcel is looked for


class SceneMatrix:
    """The matrix of a scene, its nodes and edges, and the streamlines behind one of its cells."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        self._graph: ConnectomeGraph | None = None
        self._drawn: tuple[Connectome, Matrix] | None = None

    def prepare_matrix(self, **wanted: Any) -> Matrix:
        """Check what a matrix is to be of; arguments as of :class:`.Matrix`, paths of files under the root."""
        layer = self.scene.lines_layer(wanted.get("layer", ""))
        return check_matrix(wanted, lambda _: self.scene.data(layer).data, self._place)

    def _place(self, path: str) -> str:
        return self.scene.files.name(self.scene.files.resolve(path))

    def load_matrix(
        self, matrix: Matrix, progress: Progress | None = None, cancel: Cancel | None = None
    ) -> Store:
        """Put a matrix together, for :meth:`take_matrix`; may run in a thread of its own."""
        from pvfiblets.query.connectome.matrix import connectome
        from pvfiblets.slices.labels import as_label_table

        store, fiblets = self.scene.store.fork(), self.scene.data(self.scene.lines_layer(matrix.layer)).data
        labels = store.parcels(matrix.labels)
        if (many := len(np.unique(labels[0]))) > PARCELS:
            raise ValueError(
                f"{matrix.labels} holds {many:,} different numbers, and a matrix here {PARCELS:,} parcels; choose a "
                "volume of labels, or use `pvfiblets connectome`"
            )
        names = None if matrix.names is None else as_label_table(self.scene.files.resolve(matrix.names)).names
        ends = store.end_labels(fiblets, matrix.labels, matrix.radius, progress, cancel)
        found = connectome(
            fiblets, labels, weights=matrix.weights, contrast=matrix.contrast, radius=matrix.radius,
            statistic=matrix.statistic, names=names, ends=ends,
        )  # fmt: skip
        store.connectomes.append((fiblets, matrix.bare, found))
        return store

    def take_matrix(self, matrix: Matrix, store: Store) -> None:
        """Show a matrix that :meth:`load_matrix` put together."""
        self.scene.store.take(store)
        self.show_matrix(matrix)
        self.draw(self.scene.state)  # of a session it was there before its numbers

    def show_matrix(self, matrix: Matrix | None) -> None:
        """Show a matrix beside the picture, whose data are in the store already; None for none."""
        what = "the matrix" if matrix is not None else "remove the matrix"
        self.scene.become(replace(self.scene.state, matrix=matrix), what)

    def change(self, what: str, **changes: Any) -> None:
        """Change how the matrix is shown: ``graph``, ``threshold`` or ``log``."""
        matrix = self.scene.state.matrix
        if matrix is None:
            raise ValueError("there is no matrix; make one first")
        self.scene.become(replace(self.scene.state, matrix=replace(matrix, **changes)), what)

    def connectome(self, state: State) -> Connectome | None:
        """Return the numbers of a document's matrix; None if there is none, or they are not known."""
        if state.matrix is None:
            return None
        return self.scene.store.connectome(self.scene.data(state.layer(state.matrix.layer)).data, state.matrix)

    def cell(self, state: State) -> list[int]:
        """Return row and column of the connection that is shown; nothing if there is none."""
        matrix, found = state.matrix, self.connectome(state)
        connection = None if matrix is None else state.layer(matrix.layer).filters.connection
        if matrix is None or found is None or connection is None or connection["labels"] != matrix.labels:
            return []
        places = [np.flatnonzero(found.labels == label) for label in connection["pair"]]
        return [int(place[0]) for place in places] if all(map(len, places)) else []

    # Nodes and edges

    def draw(self, state: State) -> None:
        """Bring nodes and edges in step with a document; they wait for the numbers of its matrix."""
        matrix, found = state.matrix, self.connectome(state)
        wanted = None if matrix is None or found is None or not matrix.graph else (found, matrix)
        if self._graph is not None and (wanted is None or self._drawn is None or self._drawn[0] is not wanted[0]):
            self._graph.remove()
            self._graph = None
        if wanted is not None:
            self._draw(*wanted)
            self._mark(self.cell(state))
        self._drawn = wanted

    def _draw(self, found: Connectome, matrix: Matrix) -> None:
        looks = graph_looks(found, matrix)
        if self._graph is None:
            self._graph = self.scene.plotter.add_connectome(
                found, self.scene.store.parcels(matrix.labels), **looks, show_scalar_bar=False, reset_camera=False,
                render=False,
            )  # fmt: skip
        elif self._drawn != (found, matrix):
            self._graph.threshold = matrix.threshold
            if (actor := self._graph.edge_actor) is not None:
                actor.log_scale = False  # so that any range will do
                actor.clim, actor.log_scale = looks["clim"], looks["log_scale"]

    def _mark(self, cell: list[int]) -> None:
        """Select the edge of a cell."""
        if self._graph is not None and self._graph.edge_actor is not None:
            self._graph.edge_actor.select(edge_of(self._graph.pairs, cell))

    def pick_at(self, x: float, y: float) -> ConnectomePick | None:
        """Return the node or edge at a pixel, counted from the lower left corner."""
        return None if self._graph is None else self._graph.pick_at(round(x), round(y))

    def set_connection(self, layer_id: str, pair: Any, labels: str = "", radius: float = 4.0) -> None:
        """Show only streamlines that connect two parcels."""
        layer = self.scene.lines_layer(layer_id)
        connection = None
        if pair is not None:
            connection = check_connection({"labels": labels, "pair": pair, "radius": radius}, self._place)
        self.scene.filters.filter_by(layer, "connection", connection=connection)


def edge_of(pairs: np.ndarray, cell: Any) -> np.ndarray:
    """Return the number of the edge between two nodes, in an array that is empty if there is none."""
    return np.flatnonzero((pairs == sorted(cell)).all(axis=1)) if len(cell) else np.zeros(0, np.int64)


def colour_range(matrix: np.ndarray, logarithmic: bool) -> tuple[float, float]:
    """Return the values that the ends of the colours stand for."""
    known = matrix[np.isfinite(matrix)]
    some = known[known > 0.0] if logarithmic else known
    return (float(some.min()), float(some.max())) if len(some) else (0.0, 0.0)


def graph_looks(found: Connectome, matrix: Matrix) -> dict[str, Any]:
    """Return arguments of ``add_connectome`` that give edges the colours of their cells."""
    clim = colour_range(found.matrix, matrix.log)
    return {"threshold": matrix.threshold, "cmap": COLOURS, "clim": clim, "log_scale": matrix.log and clim[0] > 0.0}


def choices(data: Any) -> tuple[list[str], list[str]]:
    """Return names of the weights and of the contrasts that there are for a set."""
    from pvfiblets.query.measures.measures import measure_names

    stored = [name for name, rows in data.per_streamline.items() if np.asarray(rows).dtype.kind in "biuf"
              and np.asarray(rows).reshape(len(data), -1).shape[1] == 1]  # fmt: skip
    measured = [name for name in measure_names(data) if name != "coding_error"]
    return stored, ["count", "length", *(name for name in measured if name != "length")]


def check_matrix(value: Any, data_of: Callable[[str], Any], place: Callable[[str], str]) -> Matrix:
    """Return a matrix of a session or a page that was checked."""
    optional = ("names", "weights", "contrast", "statistic", "radius", "graph", "threshold", "log")
    mapping(value, "matrix", ("layer", "labels"), optional)
    layer = text(value["layer"], "layer of the matrix")
    weights, contrasts = choices(data_of(layer))
    given = {"names": None, "weights": None, "contrast": "count", "statistic": None, "radius": 4.0, **value}
    for name, known in (("weights", [None, *weights]), ("contrast", contrasts), ("statistic", [None, *STATISTICS])):
        if given[name] not in known:
            there = ", ".join(str(one) for one in known if one is not None)
            raise ValueError(f"{name} of the matrix: {shown(given[name])} is none of {there}")
    labels = place(text(value["labels"], "labels of the matrix", 4096))
    names = None if given["names"] is None else place(text(given["names"], "names of the matrix", 4096))
    radius = number(given["radius"], "radius of the matrix", 0.0, WIDEST, unit=" of mm")
    graph, log = truth(value.get("graph", False), "graph of the matrix"), truth(value.get("log", True), "log")
    threshold = number(value.get("threshold", 0.0), "threshold of the matrix", 0.0)
    return Matrix(
        layer, labels, names, given["weights"], given["contrast"], given["statistic"], radius, graph, threshold, log
    )


def check_connection(value: Any, place: Callable[[str], str]) -> dict[str, Any]:
    """Return a connection of filters that was checked; see :func:`check_matrix`."""
    mapping(value, "connection", ("labels", "pair"), ("radius",))
    pair = value["pair"]
    if not isinstance(pair, (list, tuple)) or len(pair) != 2:
        raise ValueError(f"a connection is between {shown(pair)}; give two labels")
    return {
        "labels": place(text(value["labels"], "labels of a connection", 4096)),
        "pair": sorted(whole(label, "a label", -(2**31), 2**31 - 1) for label in pair),
        "radius": number(value.get("radius", 4.0), "radius of a connection", 0.0, WIDEST, unit=" of mm"),
    }


def as_json(matrix: Matrix, path_of: Callable[[str], str]) -> dict[str, Any]:
    """Return a matrix as sessions have it."""
    names = None if matrix.names is None else path_of(matrix.names)
    return {**asdict(matrix), "labels": path_of(matrix.labels), "names": names}
