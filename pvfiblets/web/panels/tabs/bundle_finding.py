"""Finding bundles in the tab Bundles: similar streamlines, clusters, and models."""

from __future__ import annotations

from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets.formats.registry import suffixes
from pvfiblets.web.actions import LineActions
from pvfiblets.web.panels import elements as ui
from pvfiblets.web.panels.describe import typed
from pvfiblets.web.panels.elements import fold, html
from pvfiblets.web.scene.files.loading import Watch
from pvfiblets.web.session.document import Ids
from pvfiblets.web.values import number

if TYPE_CHECKING:
    from pvfiblets.codec.fibletset import FibletSet
    from pvfiblets.web.app import Explorer
    from pvfiblets.web.scene.files.loading import Files
    from pvfiblets.web.session.document import Layer

__all__ = ["FindingActions", "build"]

LISTED = 50  # clusters that become bundles; the others are counted
COMPARED = 1000  # streamlines that all others are compared with; of more, an even share


class FindingActions(LineActions):
    """The page's actions that find streamlines of the chosen tractogram."""

    def __init__(self, app: Explorer) -> None:
        super().__init__(app)
        self._open = False
        self._folders: list[str] | None = None
        self._asked: tuple[str, Ids, np.ndarray] | None = None  # layer, result, and the query's streamlines

    def refresh(self) -> None:
        """Show what can be done."""
        self._app.page.finding = {
            "open": self._open, "folders": self._folders or [], "dipy": find_spec("dipy") is not None,
        }  # fmt: skip

    def fold(self, is_open: bool) -> None:
        """Open the section, with the folders that there are now, or close it."""
        self._open = is_open is True
        if self._open:
            self._folders = model_folders(self._app.confined)
        self._show()

    # More like this

    def similar(self, text: str) -> None:
        """Select all streamlines that run as near to the selected ones, or to the bundles chosen, as was typed."""
        layer, distance = self._layer, _length(text, "distance")
        self._app.later(self._similar(layer, self._like(layer), distance))

    def _like(self, layer: Layer) -> np.ndarray:
        """Return the query's streamlines; a result is queried by its own query."""
        if layer.selected is not None:
            if self._asked is not None and self._asked[:2] == (layer.id, layer.selected):
                return self._asked[2]
            return np.asarray(layer.selected.array())
        chosen = self._app.bundles.chosen_ids()
        if not len(chosen):
            raise ValueError("pick a streamline, or choose a bundle by its box, to find more like it")
        return np.asarray(chosen)

    async def _similar(self, layer: Layer, like: np.ndarray, distance: float) -> None:
        app, fiblets = self._app, self._app.scene.actor(layer.id).fiblets
        some = like if len(like) <= COMPARED else like[np.linspace(0, len(like) - 1, COMPARED).astype(np.int64)]
        found = await self._found(
            layer, fiblets, lambda watch: fiblets.similar(some, distance, progress=watch), "comparing"
        )
        if found is None:
            return
        app.scene.selection.select(layer.id, found.ids)
        selected = app.scene.layer(layer.id).selected
        self._asked = (layer.id, selected, like) if selected is not None else None
        of = f"{len(like):,}" if some is like else f"an even {COMPARED:,} of the {len(like):,}"
        app.say(f"{len(found):,} streamlines run within {distance:g} mm of {of} reference streamlines.", "success")

    # Clusters

    def cluster(self, text: str) -> None:
        """Add a bundle for each cluster of streamlines that run alike, as near to each other as was typed."""
        self._app.later(self._cluster(self._layer, _length(text, "distance")))

    async def _cluster(self, layer: Layer, threshold: float) -> None:
        app, fiblets = self._app, self._app.scene.actor(layer.id).fiblets
        found = await self._found(
            layer, fiblets, lambda watch: fiblets.clusters(threshold=threshold, progress=watch), "clustering"
        )
        if found is None:
            return
        largest = found.by_size()
        groups = {f"cluster {k + 1}": largest[k].ids for k in range(min(len(largest), LISTED))}
        if not groups:
            raise ValueError(f"{layer.name} has no streamlines with points to cluster")
        app.scene.bundles.add_bundles(layer.id, groups, f"{len(groups)} clusters")
        rest = f"; the {len(groups)} largest are bundles now" if len(found) > len(groups) else ", now bundles"
        app.say(f"{len(found):,} clusters{rest}.", "success")

    # Models

    def recognise(self, folder: str) -> None:
        """Add the bundles of a folder of models that RecoBundles recognises."""
        if find_spec("dipy") is None:
            raise ValueError("recognising bundles needs dipy, which is not installed: pip install dipy")
        models = {entry.name: entry.path for entry in self._app.confined.listing(folder) if _is_lines(entry)}
        if not models:
            raise ValueError(f"{str(folder)[:80]!r} has no tractograms; choose a folder with one for each bundle")
        self._app.later(self._recognise(self._layer, models))

    async def _recognise(self, layer: Layer, models: dict[str, str]) -> None:
        app, fiblets = self._app, self._app.scene.actor(layer.id).fiblets

        def work(watch: Watch) -> Any:
            return fiblets.recognise(read_models(app.scene.files, models, watch), progress=watch)

        found = await self._found(layer, fiblets, work, "reading models")
        if found is None:
            return
        groups = {name: ids for name, ids in found.items() if len(ids)}
        none = [name for name in found if name not in groups]
        if groups:
            app.scene.bundles.add_bundles(layer.id, groups, f"{len(groups)} recognised bundles")
        missing = f"; nothing was recognised of {', '.join(none[:8])}{' and others' * (len(none) > 8)}" if none else ""
        app.say(f"{len(groups):,} bundles were recognised{missing}.", "success" if groups else "info")

    # Inside

    async def _found(self, layer: Layer, fiblets: FibletSet, work: Callable[[Watch], Any], what: str) -> Any:
        return await self._beside(layer, fiblets, work, what, cancelled="; all is as it was", again="ask")


def model_folders(confined: Any) -> list[str]:
    """Return the folders under the root that hold tractograms, at most some levels deep."""
    return sorted(
        folder for folder, entries in confined.walk() if folder and any(_is_lines(entry) for entry in entries)
    )


def read_models(files: Files, models: dict[str, str], watch: Watch) -> dict[str, Any]:
    """Read tractograms by the names of their files, with the checks of all that is opened."""
    from pvfiblets.codec.files.open_lines import open_lines
    from pvfiblets.formats.gzipped import check_ratio

    found: dict[str, Any] = {}
    for done, (name, path) in enumerate(models.items()):
        watch(f"reading {name}", 0.1 * done / len(models))
        place = files.resolve(path)
        check_ratio(place)
        suffix = next(one for one in sorted(suffixes(), key=len, reverse=True) if name.lower().endswith(one))
        found[name[: -len(suffix)]] = open_lines(place)
    return found


def _is_lines(entry: Any) -> bool:
    return not entry.folder and Path(entry.name).name.lower().endswith(tuple(suffixes()))


def _length(text: str, name: str) -> float:
    return number(typed(str(text), name), name, 0.1, 1000.0, unit=" of mm")


# The page -------------------------------------------------------------------------------------------


def build(app: Explorer) -> None:
    """Build the section of the tab Bundles that finds streamlines."""
    finding = app.finding
    fold("Find", "finding.open", size="small", click=(finding.fold, "[!finding.open]"), data_action="find")
    with html.Div(v_if="finding.open", id="find"):
        for name, label, key, act, button, hint in (
            ("similar", "More like this", "like_mm", finding.similar, "Select",
             "Select all streamlines within this distance of the selection or the chosen bundles (MDF)"),
            ("clusters", "Clusters", "cluster_mm", finding.cluster, "Make",
             "Make bundles of streamlines within this distance of their mean line (QuickBundles)"),
        ):  # fmt: skip
            with ui.labelled(label, data_find=name, title=hint), html.Div(classes="pv-pair"):
                ui.number_field(style="width: 56px", v_model=(key,), aria_label=f"{label}: distance, mm")
                html.Span("mm", classes="pv-small", style="flex: 1")
                ui.button(button, size="small", click=(act, f"[{key}]"), data_bundle=name)
        with ui.labelled(
            "Models", v_if="finding.dipy && finding.folders.length", data_find="models",
            title="Bundles that match a folder of models (RecoBundles, by dipy)",
        ):  # fmt: skip
            with html.Div(classes="pv-pair"):
                ui.select(
                    v_model=("models_folder",), items=("finding.folders",), placeholder="folder",
                    aria_label="Folder of models", data_select="models",
                )  # fmt: skip
                ui.button("Recognise", size="small", data_bundle="recognise",
                          click=(finding.recognise, "[models_folder]"), disabled=("!models_folder",))  # fmt: skip
        html.Div(
            "Bundles are recognised by a folder with a tractogram for each; there is none in the served folder.",
            v_if="finding.dipy && !finding.folders.length", classes="pv-small px-3 pt-1",
        )  # fmt: skip
        html.Div(
            "Recognising bundles by models needs dipy where the server runs: pip install dipy",
            v_if="!finding.dipy", classes="pv-small px-3 pt-1",
        )  # fmt: skip
