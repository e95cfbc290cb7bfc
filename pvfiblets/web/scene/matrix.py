"""The matrix of a scene: how strongly parcels are connected, and the streamlines that connect two of them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets.query.connectome.matrix import STATISTICS
from pvfiblets.web.session.document import Matrix
from pvfiblets.web.values import mapping, number, shown, text, whole

if TYPE_CHECKING:
    from pvfiblets.query.connectome.matrix import Connectome
    from pvfiblets.web.scene.loading import Cancel, Progress
    from pvfiblets.web.scene.scene import Scene
    from pvfiblets.web.session.store import Store

__all__ = ["SceneMatrix", "as_json", "check_connection", "check_matrix", "choices"]

PARCELS = 1024  # greatest number of parcels of a matrix
WIDEST = 100.0  # mm about an end in which its parcel is looked for


class SceneMatrix:
    """The matrix of a scene, and the streamlines behind one of its cells."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene

    def prepare_matrix(self, **wanted: Any) -> Matrix:
        """Check what a matrix is to be of; arguments as of :class:`.Matrix`, paths of files under the root."""
        layer = self.scene.lines_layer(wanted.get("layer", ""))
        return check_matrix(wanted, lambda _: self.scene.data(layer).data, self._place)

    def _place(self, path: str) -> str:
        return self.scene.files.name(self.scene.files.resolve(path))

    def load_matrix(
        self, matrix: Matrix, progress: Progress | None = None, cancel: Cancel | None = None
    ) -> tuple[Store, Connectome]:
        """Put a matrix together, for :meth:`show_matrix`; may run in a thread of its own."""
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
        return store, connectome(
            fiblets, labels, weights=matrix.weights, contrast=matrix.contrast, radius=matrix.radius,
            statistic=matrix.statistic, names=names, ends=ends,
        )  # fmt: skip

    def show_matrix(self, matrix: Matrix | None) -> None:
        """Show a matrix beside the picture, whose data are in the store already; None for none."""
        self.scene.become(replace(self.scene.state, matrix=matrix), "the matrix" if matrix is not None else "no matrix")

    def set_connection(self, layer_id: str, pair: Any, labels: str = "", radius: float = 4.0) -> None:
        """Show only streamlines that connect two parcels."""
        layer = self.scene.lines_layer(layer_id)
        connection = None
        if pair is not None:
            connection = check_connection({"labels": labels, "pair": pair, "radius": radius}, self._place)
        self.scene.filters.filter_by(layer, "connection", connection=connection)


def choices(data: Any) -> tuple[list[str], list[str]]:
    """Return names of the weights and of the contrasts that there are for a set."""
    from pvfiblets.query.measures.measures import measure_names

    stored = [name for name, rows in data.per_streamline.items() if np.asarray(rows).dtype.kind in "biuf"
              and np.asarray(rows).reshape(len(data), -1).shape[1] == 1]  # fmt: skip
    measured = [name for name in measure_names(data) if name != "coding_error"]
    return stored, ["count", "length", *(name for name in measured if name != "length")]


def check_matrix(value: Any, data_of: Callable[[str], Any], place: Callable[[str], str]) -> Matrix:
    """Return a matrix of a session or a page that was checked."""
    optional = ("names", "weights", "contrast", "statistic", "radius")
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
    return Matrix(layer, labels, names, given["weights"], given["contrast"], given["statistic"], radius)


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
