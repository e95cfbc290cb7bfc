"""Bundles that are measured: values along them and a row for each, in the tab Bundles."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets.web.actions import LineActions
from pvfiblets.web.panels import elements as ui
from pvfiblets.web.panels.charts import COLOURS, Band, profiles_chart, short
from pvfiblets.web.panels.csv_tables import table_text
from pvfiblets.web.panels.elements import fold, html, v3
from pvfiblets.web.scene.files.loading import Watch
from pvfiblets.web.session.document import LINES

if TYPE_CHECKING:
    from pvfiblets.codec.fibletset import FibletSet
    from pvfiblets.query.measures.table import Table
    from pvfiblets.web.app import Explorer
    from pvfiblets.web.session.document import Bundle, Layer

FORMATS = ("csv", "tsv", "parquet")  # of the tables that are fetched
PROFILED = 24  # bundles in one chart
MEASURED = 2000  # bundles in one table
PLACES = 100
SHOWN = 200  # rows of a table on the page
KINDS = ("profile", "table")

Curves = dict[str | None, tuple[np.ndarray, np.ndarray, np.ndarray]]
"""Mean, low and high value at positions along bundles, by the bundle's name; None for all streamlines."""


@dataclass(frozen=True, eq=False)
class _Result:
    """Measurements, with their layer and bundles."""

    layer: str
    bundles: tuple[Bundle, ...]
    table: Table
    shown: dict[str, Any]


class MeasureActions(LineActions):
    """The page's measures of the bundles of the chosen tractogram."""

    def __init__(self, app: Explorer) -> None:
        super().__init__(app)
        self._open = False
        self._value = ""
        self._results: dict[str, _Result] = {}

    # What is shown

    def refresh(self) -> None:
        """Show the possible measures, and earlier results as long as they are valid."""
        page, scene = self._app.page, self._app.scene
        if not self._open or not page.chosen or page.chosen_kind not in LINES:
            page.measures = {"open": self._open, "values": [], "value": "", "profile": {}, "table": {}}
            return
        layer = self._layer
        values = self._values(layer.id)
        titles = [value["value"] for value in values]
        self._value = self._value if self._value in titles else titles[0]
        there = scene.bundles.of_layer(layer.id)
        kept = {kind: one for kind, one in self._results.items()
                if one.layer != layer.id or all(bundle in there for bundle in one.bundles)}  # fmt: skip
        self._results = kept
        shown = {kind: one.shown for kind, one in kept.items() if one.layer == layer.id}
        page.measures = {
            "open": True, "values": values, "value": self._value,
            "profile": shown.get("profile", {}), "table": shown.get("table", {}),
        }  # fmt: skip

    def _values(self, layer_id: str) -> list[dict[str, str]]:
        """Return what there can be a profile of: values of points, and images."""
        from pvfiblets.query.measures.measures import measure_names

        names = [name for name in measure_names(self._app.scene.actor(layer_id).fiblets, "point")
                 if name != "coding_error"]  # fmt: skip
        stored = [name for name in names if name not in ("curvature", "arc_length")]
        found = [{"title": name, "value": f"array {name}"} for name in [*stored, "curvature", "arc_length"]]
        return found + [{"title": name, "value": f"image {name}"} for name in self._images()]

    def _images(self) -> dict[str, Any]:
        """Return the scene's images that have a number for each voxel, as :func:`.as_image` takes them, by name."""
        scene, found = self._app.scene, {}
        for layer in scene.layers:
            if layer.kind in ("volume", "image"):
                data = scene.data(layer).data
                if getattr(data, "affine", None) is not None and (data.values.ndim == 3 or data.values.shape[3] == 1):
                    found[layer.name] = data
        return found

    def fold(self, is_open: bool) -> None:
        """Open or close the section."""
        self._open = is_open is True
        self._show()

    def set_value(self, value: str) -> None:
        """Choose what profiles are of."""
        self._value = str(value)
        self._show()

    # What is done

    def profile(self) -> None:
        """Average the chosen value along the bundles chosen, or along all that are shown."""
        layer, bundles = self._layer, self._of()
        if len(bundles) > PROFILED:
            raise ValueError(f"{len(bundles)} bundles are too many for one chart; choose {PROFILED} at most by boxes")
        known = {one["value"] for one in self._values(layer.id)}
        if self._value not in known:
            raise ValueError(f"there are no values {self._value[:60]!r}; choose others")
        kind, _, name = self._value.partition(" ")
        values = self._images()[name] if kind == "image" else name
        fiblets = self._app.scene.actor(layer.id).fiblets

        def work(watch: Watch) -> _Result:
            from pvfiblets.query.bundles.tract_profile import profile_table, tract_profile

            found = []
            for done, one in enumerate(bundles):
                watch(f"averaging {name} along {one.name}", done / len(bundles))
                found.append(tract_profile(fiblets, one.ids.array(), values, PLACES, name=name, bundle=one.name))
            return _Result(layer.id, bundles, profile_table(found), _profiles(found, bundles, name))

        self._app.later(self._measure("profile", layer, fiblets, work))

    def statistics(self) -> None:
        """Measure the bundles chosen, or all that are shown."""
        layer, bundles = self._layer, self._of()
        if len(bundles) > MEASURED:
            raise ValueError(f"{len(bundles)} bundles are too many for a table; choose {MEASURED} at most by boxes")
        images, fiblets = self._images(), self._app.scene.actor(layer.id).fiblets

        def work(watch: Watch) -> _Result:
            from pvfiblets.query.bundles.statistics import bundle_table
            from pvfiblets.query.measures.table import Table

            parts = []
            for done, one in enumerate(bundles):
                watch(f"measuring {one.name}", done / len(bundles))
                parts.append(bundle_table(fiblets, {one.name: one.ids.array()}, images=images))
            names = dict.fromkeys(name for part in parts for name in part)
            nothing = np.array([np.nan])
            table = Table({name: np.concatenate([part.get(name, nothing) for part in parts]) for name in names})
            return _Result(layer.id, bundles, table, _statistics(table))

        self._app.later(self._measure("table", layer, fiblets, work))

    def _of(self) -> tuple[Bundle, ...]:
        """Return the bundles to measure, without empty ones."""
        there = self._app.scene.bundles.of_layer(self._layer.id)
        chosen = self._app.bundles.chosen()
        found = tuple(one for one in there if (one.name in chosen if chosen else one.visible) and len(one.ids))
        if not found:
            raise ValueError("no bundle with streamlines is chosen or shown; make one, or choose it by its box")
        return found

    async def _measure(self, kind: str, layer: Layer, fiblets: FibletSet, work: Callable[[Watch], _Result]) -> None:
        try:
            found = await self._beside(layer, fiblets, work, "measuring", cancelled="", again="measure")
        except KeyError as error:
            raise ValueError(str(error.args[0])) from error
        if found is None:
            return
        self._results[kind] = found
        self._show()

    def fetch(self, kind: str, suffix: str) -> str | bytes:
        """Return a table in full, for the browser to save."""
        if kind not in KINDS or suffix not in FORMATS:
            raise ValueError(f"there is no {str(kind)[:40]!r} as {str(suffix)[:40]!r}")
        found = self._results.get(kind)
        if found is None or found.layer != self._layer.id:
            raise ValueError("measure first")
        if suffix != "parquet":
            return table_text(found.table, tabs=suffix == "tsv")
        with tempfile.TemporaryDirectory(prefix="pvfiblets-") as folder:
            path = Path(folder) / "bundles.parquet"
            try:
                found.table.save(path)
            except ImportError as error:
                raise ValueError("Parquet needs pyarrow where the server runs; choose CSV or TSV") from error
            return path.read_bytes()


def _profiles(found: list[Any], bundles: tuple[Bundle, ...], name: str) -> dict[str, Any]:
    """Return what the page shows of profiles."""
    from pvfiblets.plotting.colours.scalars import UNITS

    bands = [Band(one.bundle, bundle.color, one.mean, one.low, one.high)
             for one, bundle in zip(found, bundles, strict=True)]  # fmt: skip
    rows = [
        [f"{100.0 * position:.0f} %", *(_cell(one.mean[place]) for one in found)]
        for place, position in enumerate(found[0].position)
    ]
    return {
        "chart": profiles_chart(found[0].position, bands, UNITS.get(name, name)),
        "legend": [{"name": one.bundle, "color": bundle.color, "count": f"{one.count:,}"}
                   for one, bundle in zip(found, bundles, strict=True)],
        "columns": ["", *(one.bundle for one in found)], "rows": rows, "name": name,
    }  # fmt: skip


def curves_along(scene: Any, layer: Layer) -> Curves:
    """Return the profiles from a file that colour a tractogram along its bundles; nothing where others do."""
    from pvfiblets.formats.attachments import name_of
    from pvfiblets.plotting.fiblets.along import profiles_in

    name, fiblets = layer.settings["scalars"], scene.actor(layer.id).fiblets
    for path in reversed(layer.source.values):
        if name in fiblets.per_point and name.startswith(name_of(path)):
            try:
                found = profiles_in(fiblets, scene.files.resolve(path))
            except (OSError, ValueError):  # the file has gone, or is another one now
                return {}
            if name in found:
                ends = [found.get(f"{name} {end}", found[name]) for end in ("low", "high")]
                return {group: (rows, ends[0][group][0], ends[1][group][0]) for group, (rows, _) in found[name].items()}
    return {}


def along_chart(layer: Layer, bundles: tuple[Bundle, ...], curves: Curves) -> dict[str, Any]:
    """Return what the page shows of the profiles of visible bundles."""
    known: dict[str | None, Bundle] = {one.name: one for one in bundles}
    names = [name for name in curves if name not in known or known[name].visible][:PROFILED]
    if not names:
        return {}
    most = max(len(curves[name][0]) for name in names)
    bands = [
        Band(
            name or layer.name,
            known[name].color if name in known else COLOURS[place % len(COLOURS)],
            *(_resampled(curve, most) for curve in curves[name]),
        )
        for place, name in enumerate(names)
    ]
    return {
        "chart": profiles_chart(np.linspace(0.0, 1.0, most), bands, layer.settings["scalars"]),
        "legend": [{"name": one.name, "color": one.color} for one in bands],
    }


def _resampled(curve: np.ndarray, n: int) -> np.ndarray:
    if len(curve) == n:
        return curve
    return np.interp(np.linspace(0.0, 1.0, n), np.linspace(0.0, 1.0, len(curve)), curve)


def _statistics(table: Table) -> dict[str, Any]:
    """Return what the page shows of a table: the most telling columns first."""
    titles = {
        "bundle": "bundle", "count": "count", "length_mean": "mm", "length_std": "± mm", "volume_mm3": "mm³",
    }  # fmt: skip
    names = [name for name in titles if name in table] + [name for name in table if name.startswith("mean_")]
    rows = [[_cell(table[name][row]) for name in names] for row in range(min(table.n_rows, SHOWN))]
    more = f"and {table.n_rows - SHOWN:,} more" if table.n_rows > SHOWN else ""
    return {"columns": [titles.get(name, name.removeprefix("mean_")) for name in names], "rows": rows, "more": more}


def _cell(value: Any) -> str:
    if isinstance(value, str):
        return str(value)
    if isinstance(value, (int, np.integer)):
        return f"{value:,}"
    return "–" if not np.isfinite(value) else short(float(value)) if abs(value) < 1e4 else f"{value:,.0f}"


# The page -------------------------------------------------------------------------------------------


def build(app: Explorer) -> None:
    """Build the section of the tab Bundles that measures."""
    measuring = app.measuring
    fold("Measure", "measures.open", size="small", click=(measuring.fold, "[!measures.open]"),
         data_action="measure-bundles")  # fmt: skip
    with html.Div(v_if="measures.open", id="measures"):
        html.Div("For the ticked bundles, or all visible ones.", classes="pv-small px-3 pb-1")
        with ui.labelled("Profile of"), html.Div(classes="pv-pair"):
            ui.select(
                items=("measures.values",), model_value=("measures.value",),
                update_modelValue=(measuring.set_value, "[$event]"), aria_label="Profile of",
                data_select="profiled", style="min-width: 0",
            )  # fmt: skip
            ui.button("Plot", size="small", click=measuring.profile, data_action="profile-bundles")
        with html.Div(v_if="measures.profile.rows", id="bundle-profile"):
            build_chart("measures.profile")
            _table("measures.profile", "profile")
        with ui.labelled("Statistics"):
            ui.button("Table", size="small", click=measuring.statistics, data_action="table-bundles",
                      style="justify-self: start")  # fmt: skip
        with html.Div(v_if="measures.table.rows", id="bundle-table"):
            _table("measures.table", "table")
            html.Div("{{ measures.table.more }}", v_if="measures.table.more", classes="pv-small px-3")


def build_chart(record: str) -> None:
    """Build a chart with its legend."""
    html.Div(v_html=(f"{record}.chart",), classes="px-2 pt-1")
    with (
        html.Div(classes="px-3", style="display: flex; flex-wrap: wrap; gap: 2px 10px"),
        html.Span(v_for=f"one in {record}.legend", key="one.name", classes="pv-small pv-pair"),
    ):
        html.Span(classes="pv-dot", style=("{ background: one.color }",))
        html.Span("{{ one.name }}{{ one.count ? ` (${one.count})` : '' }}", style="overflow-wrap: anywhere")


def _table(record: str, kind: str) -> None:
    rows = html.Div(style="max-height: 30vh; overflow: auto", classes="px-2 pt-1", tabindex="0")
    with rows, html.Table(classes="pv-table"):
        with html.Thead(), html.Tr():
            html.Th("{{ c }}", v_for=f"(c, k) in {record}.columns", key="k", scope="col")
        with html.Tbody(), html.Tr(v_for=f"(row, at) in {record}.rows", key="at"):
            html.Td("{{ cell }}", v_for="(cell, k) in row", key="k")
    with html.Div(classes="px-3 py-1", style="display: flex; gap: 4px"):
        for suffix in FORMATS:
            said = "'application/octet-stream'" if suffix == "parquet" else "'text/plain'"
            v3.VBtn(
                suffix.upper() if suffix != "parquet" else "Parquet", size="x-small", variant="tonal",
                classes="text-none", data_fetch=f"{kind}-{suffix}", title="Download the table in full",
                click=f"trigger('bundle_table', ['{kind}', '{suffix}'])"
                f".then((t) => t && utils.download('bundles_{kind}.{suffix}', t, {said}))",
            )  # fmt: skip
