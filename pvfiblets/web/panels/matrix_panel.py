"""The matrix beside the picture: parcels by parcels as an image, whose cells show the streamlines behind them."""

from __future__ import annotations

import base64
import io
import tempfile
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets.images.files import SUFFIXES as VOLUMES
from pvfiblets.query.connectome.matrix import STATISTICS, SUFFIXES
from pvfiblets.web.actions import LineActions
from pvfiblets.web.panels import elements as ui
from pvfiblets.web.panels.charts import short
from pvfiblets.web.panels.describe import typed
from pvfiblets.web.panels.elements import html, v3
from pvfiblets.web.scene.files.file_kinds import TABLES
from pvfiblets.web.scene.files.loading import Cancelled
from pvfiblets.web.scene.matrix import COLOURS, choices, colour_range
from pvfiblets.web.scene.slices.label_images import BESIDE
from pvfiblets.web.session.document import LINES, Matrix
from pvfiblets.web.values import number

if TYPE_CHECKING:
    from pvfiblets.query.connectome.matrix import Connectome
    from pvfiblets.web.app import Explorer

__all__ = ["MatrixActions", "build", "matrix_image"]

LISTED = 200  # files that may be labels, or their names


class MatrixActions(LineActions):
    """The page's actions on the matrix of the chosen tractogram."""

    def __init__(self, app: Explorer) -> None:
        super().__init__(app)
        self._open = False
        self._settings = True
        self._form: dict[str, Any] = {}
        self._volumes: list[str] = []
        self._tables: list[str] = []
        self._pending: Matrix | None = None
        self._failed: Matrix | None = None
        self._drawn: tuple[Any, ...] = ()

    # What is shown

    def refresh(self) -> None:
        """Show the matrix of the document; one that is not known yet, as of a session, is put together."""
        page, scene = self._app.page, self._app.scene
        matrix = scene.state.matrix
        found = scene.matrix.connectome(scene.state)
        if matrix is None:
            self._failed = None
        elif found is None and self._pending is None and matrix.bare != self._failed:
            self._open = True
            self._begin(matrix)
        page.matrix = {
            "open": self._open and bool(scene.layers), "settings": self._settings or found is None,
            "form": self._described(), **self._told(matrix, found),
        }  # fmt: skip
        self._draw(matrix, found)

    @property
    def _connectome(self) -> Connectome | None:
        return self._app.scene.matrix.connectome(self._app.scene.state)

    def _described(self) -> dict[str, Any]:
        """Return what there is to choose."""
        app = self._app
        if not self._open or not app.page.chosen or app.page.chosen_kind not in LINES:
            return {"labels": [], "names": [], "weights": [], "contrasts": [], "chosen": {}}
        weights, contrasts = choices(app.scene.data(self._layer).data)
        images = [layer for layer in app.scene.layers if layer.kind in ("image", "volume") and layer.path is not None]
        paths = [*dict.fromkeys([*(layer.path for layer in images), *self._volumes])]
        labels = [{"title": Path(str(path)).name, "value": path, "props": {"subtitle": path}} for path in paths]
        tables = [{"title": Path(path).name, "value": path} for path in self._tables]
        return {
            "labels": labels, "names": [{"title": "none", "value": ""}, *tables],
            "weights": [{"title": "none", "value": ""}, *({"title": name, "value": name} for name in weights)],
            "contrasts": contrasts, "chosen": self._chosen(),
        }  # fmt: skip

    def _chosen(self) -> dict[str, Any]:
        usual = {"labels": None, "names": "", "weights": "", "contrast": "count", "statistic": "", "radius": "4"}
        return {**usual, **self._form}

    def _told(self, matrix: Matrix | None, found: Connectome | None) -> dict[str, Any]:
        """Return the description of the matrix."""
        if matrix is None or found is None:
            return {"n": 0, "names": [], "said": "", "low": "", "high": "", "cell": ""}
        layer = self._app.scene.layer(matrix.layer)
        weighted = f", weighted by {matrix.weights}" if matrix.weights is not None else ""
        what = "streamline count" if found.contrast == "count" else f"{found.statistic} {found.contrast}"
        low, high = colour_range(found.matrix, matrix.log)
        connection = layer.filters.connection
        cell = ""
        if connection is not None:
            cell = " – ".join(self._name(found, label) for label in connection["pair"])
        return {
            "n": len(found.labels), "names": found.names, "low": short(low), "high": short(high),
            "log": matrix.log, "graph": matrix.graph, "threshold": f"{matrix.threshold:.6g}",
            "said": f"{layer.name}, {Path(matrix.labels).name}: {what}{weighted}; {found.n_connecting:,} of "
            f"{len(found.ends):,} streamlines connect two labels (radius {found.radius:g} mm)",
            "cell": cell, "pair": self._app.scene.matrix.cell(self._app.scene.state),
        }  # fmt: skip

    def _name(self, found: Connectome, label: int) -> str:
        at = np.flatnonzero(found.labels == label)
        return found.names[int(at[0])] if len(at) else str(label)

    def _draw(self, matrix: Matrix | None, found: Connectome | None) -> None:
        """Send the image, if it is another one."""
        drawn = () if matrix is None or found is None else (found, matrix.threshold, matrix.log)
        if drawn == self._drawn:
            return
        self._drawn, image = drawn, ""
        if matrix is not None and found is not None:
            strong = np.where(abs(found.matrix) >= matrix.threshold, found.matrix, np.nan)
            image = matrix_image(strong, matrix.log, colour_range(found.matrix, matrix.log))
        self._app.page.matrix_image = image

    def at(self, row: Any, column: Any) -> str:
        """Return the text of a cell, for the pointer."""
        found = self._connectome
        if found is None:
            return ""
        i, j = _cell(found, row, column)
        value, count = found.matrix[i, j], int(found.counts[i, j])
        said = "–" if np.isnan(value) else short(float(value))
        lines = f"{count:,} streamline{'' if count == 1 else 's'}"
        of = lines if found.contrast == "count" and said == f"{count}" else f"{said} ({lines})"
        return f"{self._label(found, i)} – {self._label(found, j)}: {of}"

    def _label(self, found: Connectome, row: int) -> str:
        label, name = int(found.labels[row]), found.names[row]
        return name if name == str(label) else f"{name} ({label})"

    # What is done

    def open(self, is_open: bool) -> None:
        """Open the panel, with the files that there are now, or fold it away."""
        self._open = is_open is True
        if self._open:
            files = [entry.path for _, entries in self._app.confined.walk() for entry in entries if not entry.folder]
            self._volumes = [path for path in files if path.lower().endswith(VOLUMES)][:LISTED]
            self._tables = [path for path in files if path.lower().endswith(TABLES)][:LISTED]
        self._show()

    def change(self) -> None:
        """Show or fold the settings."""
        self._settings = not self._settings
        self._show()

    def set(self, name: str, value: Any) -> None:
        """Choose what the matrix is of; labels bring the names that lie beside them."""
        if name not in ("labels", "names", "weights", "contrast", "statistic", "radius"):
            raise ValueError(f"a matrix has no {str(name)[:40]!r}")
        if name == "radius":
            typed(str(value), "radius")
        self._form[name] = value
        if name == "labels" and isinstance(value, str):
            self._form["names"] = self._names_of(value)
        self._show()

    def _names_of(self, path: str) -> str:
        """Return the table of a label volume's names: that of an image shown, or one beside the file."""
        for layer in self._app.scene.layers:
            if layer.kind == "image" and layer.path == path and layer.source.values:
                return str(layer.source.values[-1])
        suffix = max((one for one in VOLUMES if path.lower().endswith(one)), key=len, default="")
        stem = path[: len(path) - len(suffix)]
        return next((stem + one for one in BESIDE if stem + one in self._tables), "")

    def set_scale(self, logarithmic: bool) -> None:
        """Draw colours by logarithms, or as numbers are."""
        self._app.scene.matrix.change("colours of the matrix", log=logarithmic is True)

    def show_graph(self, graph: bool) -> None:
        """Show nodes and edges in the 3-D view, or no longer."""
        what = "show nodes and edges" if graph is True else "hide nodes and edges"
        self._app.scene.matrix.change(what, graph=graph is True)

    def set_threshold(self, given: str) -> None:
        """Leave weaker connections out."""
        threshold = number(typed(given, "threshold"), "threshold", 0.0)
        self._app.scene.matrix.change("threshold of the matrix", threshold=threshold)

    def pick(self, x: float, y: float) -> bool:
        """Show the streamlines of the edge at a pixel, or name the node; return whether there is one."""
        picked = self._app.scene.matrix.pick_at(x, y)
        if picked is None or (found := self._connectome) is None:
            return False
        if len(picked.nodes) == 2:
            self.connect(*picked.nodes)
        else:
            self._app.say(self._label(found, picked.nodes[0]))
        return True

    def make(self) -> None:
        """Put the matrix together, beside everything else."""
        chosen = self._chosen()
        if not chosen["labels"]:
            raise ValueError("choose a volume of labels first, such as an atlas or a parcellation")
        wanted: dict[str, Any] = {name: chosen[name] or None for name in ("names", "weights", "statistic")}
        wanted |= {"layer": self._layer.id, "labels": chosen["labels"], "contrast": chosen["contrast"]}
        wanted["radius"] = typed(str(chosen["radius"]), "radius")
        before, scene = self._app.scene.state.matrix, self._app.scene
        if before is not None:  # a threshold of other numbers means nothing
            wanted |= {"graph": before.graph, "log": before.log}
        matrix = scene.matrix.prepare_matrix(**wanted)
        if scene.store.connectome(scene.data(self._layer).data, matrix) is not None:
            scene.matrix.show_matrix(matrix)
        else:
            self._begin(matrix)

    def _begin(self, matrix: Matrix) -> None:
        self._pending = matrix
        self._app.later(self._make(matrix))

    async def _make(self, matrix: Matrix) -> None:
        app, scene = self._app, self._app.scene
        try:
            store = await app.files.run_in_background(
                Path(matrix.labels).name, lambda progress, cancel: scene.matrix.load_matrix(matrix, progress, cancel),
                "connecting parcels",
            )  # fmt: skip
        except BaseException as error:
            self._failed = matrix.bare
            if not isinstance(error, Cancelled):
                raise
            app.say("The matrix was not made: cancelled.")
            return
        finally:
            self._pending = None
        self._settings, self._failed = False, None
        scene.matrix.take_matrix(matrix, store)
        self._show()

    def connect(self, row: Any, column: Any) -> None:
        """Show only the streamlines of a cell; again, show all."""
        scene = self._app.scene
        matrix, found = scene.state.matrix, self._connectome
        if matrix is None or found is None:
            raise ValueError("there is no matrix; make one first")
        i, j = _cell(found, row, column)
        if not found.counts[i, j]:
            self._app.say(f"No streamline connects {self._label(found, i)} and {self._label(found, j)}.")
            return
        pair = sorted([int(found.labels[i]), int(found.labels[j])])
        before = scene.layer(matrix.layer).filters.connection
        same = before == {"labels": matrix.labels, "pair": pair, "radius": matrix.radius}
        scene.matrix.set_connection(matrix.layer, None if same else pair, matrix.labels, matrix.radius)

    def disconnect(self) -> None:
        """Show all streamlines, whatever they connect."""
        matrix = self._app.scene.state.matrix
        self._app.scene.matrix.set_connection(self._layer.id if matrix is None else matrix.layer, None)

    def close(self) -> None:
        """Take the matrix away."""
        self._open = False
        self._app.scene.matrix.show_matrix(None)
        self._show()

    def fetch(self, suffix: str) -> str | bytes:
        """Return the matrix as a file, for the browser to save."""
        found = self._connectome
        if found is None:
            raise ValueError("there is no matrix; make one first")
        if suffix not in SUFFIXES:
            raise ValueError(f"{str(suffix)[:40]!r} is none of {', '.join(SUFFIXES)}")
        safe = replace(found, names=[f"'{name}" if name[:1] in "=+-@" and name != str(label) else name
                                     for name, label in zip(found.names, found.labels, strict=True)])  # fmt: skip
        with tempfile.TemporaryDirectory(prefix="pvfiblets-") as folder:
            path = Path(folder) / f"matrix{suffix}"
            safe.save(path)
            return path.read_bytes() if suffix == ".npy" else path.read_text(encoding="utf-8")


def _cell(found: Connectome, row: Any, column: Any) -> tuple[int, int]:
    n = len(found.labels)
    for place in (row, column):
        if isinstance(place, bool) or not isinstance(place, int) or not 0 <= place < n:
            raise ValueError(f"there is no row or column {str(place)[:40]!r} in a matrix of {n} parcels")
    return row, column


def matrix_image(matrix: np.ndarray, logarithmic: bool, ends: tuple[float, float]) -> str:
    """Return a matrix as the address of a PNG: a pixel a cell, grey where there is no number, or none above 0."""
    import matplotlib as mpl
    from PIL import Image

    low, high = ends
    with np.errstate(divide="ignore", invalid="ignore"):
        values = np.log(matrix) if logarithmic else matrix
        first, last = (np.log(low), np.log(high)) if logarithmic else (low, high)
        share = np.clip((values - first) / (last - first), 0.0, 1.0) if last > first else np.ones(matrix.shape)
    known = np.isfinite(values)
    colours = np.asarray(mpl.colormaps[COLOURS](np.where(known, share, 0.0), bytes=True))[..., :3]
    colours[~known] = 38
    file = io.BytesIO()
    Image.fromarray(np.ascontiguousarray(colours)).save(file, "png")
    return f"data:image/png;base64,{base64.b64encode(file.getvalue()).decode()}"


# The page -------------------------------------------------------------------------------------------


def build(app: Explorer) -> None:
    """Build the panel; client/matrix.js tells cells and takes clicks on them."""
    matrix = app.matrix
    with html.Div(v_if="matrix.open", classes=("['pv-matrix', matrix_alone ? 'pv-alone' : '']",), id="pv-matrix"):
        with html.Div(classes="pv-pair px-3 pt-1"):
            html.Span("Matrix", classes="pv-name pa-0", style="flex: 1")
            ui.button("Settings", v_if="matrix.n", variant="text", click=matrix.change, data_action="matrix-settings")
            ui.button("Remove", v_if="matrix.n", variant="text", click=matrix.close, data_action="remove-matrix",
                      title="Remove the matrix")  # fmt: skip
            ui.icon_button("mdi-arrow-expand-horizontal", "Full width", v_if="matrix.n",
                           click="matrix_alone = !matrix_alone", data_action="matrix-alone",
                           **ui.pressed("matrix_alone", "text"))  # fmt: skip
            ui.icon_button("mdi-close", "Close", data_action="fold-matrix", click=(matrix.open, "[false]"))
        with html.Div(v_if="matrix.settings", id="matrix-settings"):
            _settings(matrix)
        with html.Div(v_if="matrix.n", classes="px-3"):
            html.Div("{{ matrix.said }}", classes="pv-small pb-1", data_value="matrix-said")
            with html.Div(classes="pv-cells", id="pv-cells", data_n=("matrix.n",)):
                html.Div(classes="pv-rows", id="pv-rows", v_pre=True)
                html.Div(classes="pv-columns", id="pv-columns", v_pre=True)
                html.Img(src=("matrix_image",), alt="The matrix", draggable="false")
                html.Div(classes="pv-cross", id="pv-cross", hidden=True)
                html.Div(
                    v_if="matrix.pair && matrix.pair.length", classes="pv-chosen-cell",
                    style=("{ left: 100 * matrix.pair[1] / matrix.n + '%', top: 100 * matrix.pair[0] / matrix.n + '%', "
                           "width: 100 / matrix.n + '%', height: 100 / matrix.n + '%' }",),
                )  # fmt: skip
            html.Div("Point at a cell; click it to see its streamlines.", id="pv-cell", classes="pv-small",
                     style="min-height: 3em", v_pre=True)  # fmt: skip
            with html.Div(v_if="matrix.cell", classes="pv-pair pb-1"):
                html.Span("Shown: {{ matrix.cell }}", classes="pv-value", style="flex: 1", data_value="connection")
                ui.button("Show all", click=matrix.disconnect, data_action="show-all-connections")
            with html.Div(classes="pv-pair pv-small"):
                html.Span("{{ matrix.low }}")
                html.Div(style="flex: 1; height: 10px; border-radius: 2px; background: linear-gradient(90deg, "
                         "#440154, #414487, #2a788e, #22a884, #7ad151, #fde725)")  # fmt: skip
                html.Span("{{ matrix.high }}")
                ui.button(
                    "log", variant=("matrix.log ? 'flat' : 'tonal'",), click=(matrix.set_scale, "[!matrix.log]"),
                    title="Colours by logarithms", data_action="matrix-log",
                )  # fmt: skip
            with ui.labelled("Nodes and edges", title="Show the matrix in the 3-D view"):
                ui.switch(model_value=("matrix.graph",), update_modelValue=(matrix.show_graph, "[!!$event]"),
                          aria_label="Nodes and edges", data_action="matrix-graph")  # fmt: skip
            with ui.labelled("Threshold", title="Weaker connections are hidden"):
                ui.number_field(
                    value=("matrix.threshold",), change=(matrix.set_threshold, "[$event.target.value]"),
                    aria_label="Threshold", data_field="matrix-threshold", style="width: 74px",
                )  # fmt: skip
            with html.Div(classes="py-2", style="display: flex; gap: 4px"):
                for suffix in SUFFIXES:
                    said = "'application/octet-stream'" if suffix == ".npy" else "'text/plain'"
                    v3.VBtn(
                        suffix[1:].upper() if suffix != ".npy" else "npy", size="x-small", variant="tonal",
                        classes="text-none", data_fetch=f"matrix{suffix}", title="Download the matrix",
                        click=f"trigger('matrix_file', ['{suffix}'])"
                        f".then((t) => t && utils.download('matrix{suffix}', t, {said}))",
                    )  # fmt: skip


def _settings(matrix: MatrixActions) -> None:
    for name, label, items, hint in (
        ("labels", "Labels", "matrix.form.labels", "Label image: a number for each parcel"),
        ("names", "Names", "matrix.form.names", "Names of the labels: a table of FreeSurfer, ITK-SNAP or BIDS"),
        ("contrast", "Values", "matrix.form.contrasts", "Streamline count, or a measure of streamlines"),
        ("weights", "Weights", "matrix.form.weights", "Weights of streamlines, such as SIFT2's"),
        ("statistic", "Statistic", repr([{"title": "default", "value": ""},
                                         *({"title": one, "value": one} for one in STATISTICS)]),
         "Default: the sum of counts, else the mean"),
    ):  # fmt: skip
        with ui.labelled(label, title=hint):
            ui.select(
                items=(items,), model_value=(f"matrix.form.chosen.{name}",), aria_label=label,
                update_modelValue=(matrix.set, f"['{name}', $event]"), data_select=f"matrix-{name}",
                style="min-width: 0",
            )  # fmt: skip
    with ui.labelled("Radius", title="Search radius around each end; 0: the end's voxel alone"):
        with html.Div(classes="pv-pair"):
            ui.number_field(
                value=("matrix.form.chosen.radius",), aria_label="Radius, mm",
                change=(matrix.set, "['radius', $event.target.value]"), data_field="matrix-radius",
                style="width: 56px",
            )  # fmt: skip
            html.Span("mm", classes="pv-small", style="flex: 1")
            v3.VBtn("Make", size="small", color="primary", classes="text-none", click=matrix.make,
                    disabled=("!matrix.form.chosen.labels",), data_action="make-matrix")  # fmt: skip
    html.Div(
        "Choose a tractogram on the left.", v_if="!matrix.form.contrasts.length", classes="pv-small px-3",
    )  # fmt: skip
