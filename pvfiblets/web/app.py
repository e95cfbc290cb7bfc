"""The application of one session: a scene, its page, and what the page's controls do.

Calls of browsers have passed :mod:`pvfiblets.web.server.rpc_allowlist`; the scene checks their meaning. An error
becomes a sentence on the page, and the scene stays as it was.
"""

from __future__ import annotations

import asyncio
import logging
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

from trame.app import TrameApp

from pvfiblets.web.panels import describe, layout
from pvfiblets.web.panels.csv_tables import selection_csv
from pvfiblets.web.panels.files.exporting import ExportActions
from pvfiblets.web.panels.files.opening import FileActions
from pvfiblets.web.panels.matrix_panel import MatrixActions
from pvfiblets.web.panels.sliders import SlideActions
from pvfiblets.web.panels.tabs.atlas_tab import AtlasActions
from pvfiblets.web.panels.tabs.bundle_finding import FindingActions
from pvfiblets.web.panels.tabs.bundle_measures import MeasureActions
from pvfiblets.web.panels.tabs.bundles_tab import BundleActions
from pvfiblets.web.panels.tabs.clip_tab import CutActions
from pvfiblets.web.panels.tabs.filter_regions import RegionActions
from pvfiblets.web.panels.tabs.filter_tab import FilterActions
from pvfiblets.web.panels.tabs.info_tables import tables
from pvfiblets.web.panels.tabs.painting_tab import PaintActions
from pvfiblets.web.panels.tabs.selection_tab import SelectionActions
from pvfiblets.web.panels.tabs.slices_tab import SliceActions
from pvfiblets.web.scene.files.confined import Confined
from pvfiblets.web.scene.scene import Scene
from pvfiblets.web.scene.slices.slicing import VIEWS, ready_views
from pvfiblets.web.server.options import Options
from pvfiblets.web.server.rpc_allowlist import EXPECTED, AllowedCalls, sentence
from pvfiblets.web.server.scratch import Notes
from pvfiblets.web.session.document import volume_in
from pvfiblets.web.session.history import History
from pvfiblets.web.state import WRITABLE, bind
from pvfiblets.web.view.browser_drawing import BrowserDrawing
from pvfiblets.web.view.camera import CameraActions
from pvfiblets.web.view.first_document import first_document
from pvfiblets.web.view.sent_scene import URL
from pvfiblets.web.view.stream import PictureStream

logger = logging.getLogger("pvfiblets.web")

CLIENT = Path(__file__).with_name("client")
CLIENT_URL = "__pvfiblets"
SCRIPTS = ("pvfiblets.js", "fields.js", "regions.js", "slices.js", "painting.js", "matrix.js", "connection.js",
           "distances.js", "browser_renderer.js")  # fmt: skip


class Explorer(TrameApp):
    """One session."""

    def __init__(self, options: Options, notes: Notes) -> None:
        super().__init__("pvfiblets")
        import pyvista

        # records files written outside of its temporary folder
        self.options, self.notes = options, notes  # its initial files, and the root that it is confined to
        self.confined = Confined(options.root)
        self.plotter = pyvista.Plotter(off_screen=True, window_size=(960, 640), shape=VIEWS, border=False)
        ready_views(self.plotter)
        self.plotter.set_background("black")
        self.plotter.enable_trackball_style()
        if options.antialias is not None:
            self.plotter.picture.antialias = options.antialias
        given = [*options.files, *options.volume, *options.mesh]
        self.scene = Scene(
            self.plotter, self.confined.root, allowed=[Path(path) for path in given], look=options.look,
            cluster=options.cluster,
        )  # fmt: skip
        self.history = History(self.scene)
        self.page = bind(self.state)
        self.page.shared = options.shared
        self.page.upload_limit = options.upload
        self.page.keep = float(options.timeout)
        self.state.trame__template_error_reconnect = "<div></div>"  # client/connection.js shows what happens, and tries
        self.state.trame__title = "pvfiblets"
        self.doors = AllowedCalls(WRITABLE, self._is_trigger, self.complain)
        self.stream = PictureStream(
            self.plotter,
            layout.VIEW,
            codec=options.codec,
            pending=self._pending,
            failed=lambda error: self.complain(f"The picture could not be drawn: {error}"),
            drawn=self._drawn,
            elsewhere=lambda: self.browser.draws(),
            left_out=lambda: self.browser.drawn_view(),
            pane_at=self.scene.slicing.pane_at,
            resized=self.scene.cameras.refit,
            postpones=self.scene.slicing.postpones_3d,
        )
        self.browser = BrowserDrawing(self)
        self._charts = describe.Charts(self.scene)
        self.camera = CameraActions(self)
        self.cuts = CutActions(self)
        self.regions = RegionActions(self)
        self.filtering = FilterActions(self, self._charts)
        self.selecting = SelectionActions(self)
        self.files = FileActions(self)
        self.slices = SliceActions(self)
        self.painting = PaintActions(self)
        self.atlas = AtlasActions(self)
        self.bundles = BundleActions(self)
        self.finding = FindingActions(self)
        self.measuring = MeasureActions(self)
        self.matrix = MatrixActions(self)
        self.exports = ExportActions(self)
        self.sliders = SlideActions(self)
        self.page.export_to = "folder" if os.access(self.confined.root, os.W_OK) else "computer"
        self.server.enable_module(
            {"serve": {CLIENT_URL: str(CLIENT)}, "scripts": [f"{CLIENT_URL}/{name}" for name in SCRIPTS]}
        )
        self._register_keys()
        self.ui = layout.build(self)
        self.scene.watch(lambda _: self.refresh())
        self.scene.watch(lambda _: self.files.keep_soon())
        self.state.change("tab")(lambda tab, **_: self._show_info() if tab == "info" else None)
        self.state.change("tool")(lambda **_: self.selecting.end_measuring())
        self.refresh()
        self.server.controller.on_server_ready.add(lambda **_: self.files.open_given())

    def _is_trigger(self, name: str) -> bool:
        return self.server.controller.trigger_fn(name) is not None

    def _pending(self) -> int:
        protocol = self.server.protocol
        return 0 if protocol is None else int(protocol.network_monitor.pending)

    def _register_keys(self) -> None:
        """Give names to what client/pvfiblets.js calls."""
        named: dict[str, Callable[..., Any]] = {
            "view": self.camera.view,
            "flip": self.camera.flip,
            "reset": self.camera.reset,
            "toggle_parallel": self.camera.toggle_parallel,
            "undo": self.undo,
            "redo": self.redo,
            "browse": self.files.browse,
            "toggle_chosen": self.toggle_chosen,
            "remove_chosen": self.remove_chosen,
            "point": self.selecting.point,
            "save_session": self.files.save_session,
            "picture": self.camera.picture,
            "save_picture": self.camera.save_picture,
            "selection_csv": lambda: selection_csv(self.scene),
            "profile_csv": self.selecting.profile_csv,
            "bundle_table": self.measuring.fetch,
            "matrix_at": self.matrix.at,
            "matrix_show": self.matrix.connect,
            "matrix_file": self.matrix.fetch,
            "slide": self.sliders.slide,
            "set_layout": self.slices.set_layout,
            "step_slice": self.slices.step,
            "go_to_slice": self.slices.go_to,
            "step_volume": self.slices.step_volume,
            "ask_label": self.atlas.ask_at,
            "paint": self.painting.paint,
            "paint_end": self.painting.end,
            "release": self.sliders.release,
            "there_ready": self.browser.report,
            "there_camera": self.browser.moved,
        }
        for name, function in named.items():
            self.server.controller.trigger(name)(function)

    def add_routes(self, router: Any) -> None:
        """Add the routes of plain HTTP."""
        from aiohttp import web

        document = first_document()

        async def index(_: Any) -> Any:
            return web.Response(text=document, content_type="text/html")

        router.add_get("/index.html", index)
        router.add_post("/upload", self.files.receive)
        router.add_post("/session", self.files.receive_session)
        router.add_get("/download/{number}", self.exports.send)
        router.add_get(f"{URL}/page.js", self.browser.send_script)
        router.add_get(f"{URL}/{{name}}", self.browser.send)

    def close(self) -> None:
        """Release everything."""
        self.exports.close()
        self.scene.close()
        self.plotter.close()

    # Messages

    def complain(self, text: str) -> None:
        """Show an error on the page."""
        self.say(text, "error")

    def say(self, text: str, kind: str = "info") -> None:
        """Show a sentence on the page."""
        with self.state:
            self.page.toast = " ".join(text.split())[:400]
            self.page.toast_kind = kind
            self.page.toast_open = True
            self.page.toast_number += 1

    # Layers

    def refresh(self) -> None:
        """Show the scene as it is now, and draw it."""
        scene, page = self.scene, self.page
        if self.sliders.moving:
            self.stream.request()
            return
        with self.state:
            ids = [layer.id for layer in scene.layers]
            if page.chosen not in ids:
                page.chosen = ids[-1] if ids else ""
            page.layers = [describe.layer(layer) for layer in scene.layers]
            chosen = scene.layer(page.chosen) if page.chosen else None
            page.chosen_name = chosen.name if chosen is not None else ""
            page.chosen_kind = chosen.kind if chosen is not None else ""
            if chosen is not None and chosen.kind == "image":
                scene.slicing.workspace.active = scene.actor(chosen.id)  # whose window the right button changes
            page.groups = describe.groups(scene.queries.properties(page.chosen)) if page.chosen else []
            page.range_chart = self._charts.of_range(page.chosen)
            page.undo_label = self.history.undo_label or ""
            page.redo_label = self.history.redo_label or ""
            page.background = scene.state.background
            self.cuts.refresh()
            self.filtering.refresh()
            self.selecting.refresh()
            self.slices.refresh()
            self.painting.refresh()
            self.atlas.refresh()
            self.bundles.refresh()
            self.finding.refresh()
            self.measuring.refresh()
            self.matrix.refresh()
        self.stream.request()

    def _show_info(self) -> None:
        """Show the facts of the chosen layer, some of them counted on the GPU: only while the tab is open."""
        page = self.page
        if page.tab == "info":
            page.info = tables(self.scene.queries.info(page.chosen)) if page.chosen else []

    def choose(self, layer_id: str) -> None:
        """Make a layer the one that the panels are about."""
        self.page.chosen = self.scene.layer(layer_id).id
        self.refresh()

    def show(self, layer_id: str, visible: bool) -> None:
        """Show or hide a layer."""
        self.scene.show(layer_id, visible is True)

    def toggle_chosen(self) -> None:
        """Show or hide the chosen layer."""
        if self.page.chosen:
            self.scene.show(self.page.chosen, not self.scene.layer(self.page.chosen).visible)

    def duplicate(self, layer_id: str) -> None:
        """Add a layer like another."""
        self.page.chosen = self.scene.duplicate(layer_id).id
        self.refresh()

    def remove(self, layer_id: str) -> None:
        """Take a layer away."""
        self.scene.remove(layer_id)

    def remove_chosen(self) -> None:
        """Take the chosen layer away."""
        if self.page.chosen:
            self.scene.remove(self.page.chosen)

    def ask_name(self, layer_id: str) -> None:
        """Open the dialog for a new name."""
        self.choose(layer_id)
        self.page.dialog = "rename"

    def rename(self, layer_id: str, name: str) -> None:
        """Give a layer another name."""
        self.scene.rename(layer_id, name)
        self.page.dialog = ""

    # Properties

    def set_property(self, layer_id: str, name: str, value: Any) -> None:
        """Set a property as a control gave it."""
        if isinstance(value, dict):  # of a volume, if of anything
            known = [choice for choice, _ in self.scene.volume_choices(self.scene.layer(layer_id))]
            volume = volume_in(value) if value in known else None
            if volume is not None and ("colours", volume) not in self.scene.store.loaded:
                self.later(self.files.with_volume(volume, lambda: self.scene.set(layer_id, name, value)))
                return
        try:
            self.scene.set(layer_id, name, value)
        except Exception:
            self.page.groups = []  # restores the current value in the field
            self.state.flush()
            self.refresh()
            raise

    def set_choice(self, layer_id: str, name: str, index: int) -> None:
        """Set a property to one of its choices, by number: values may be none, which no list can show."""
        choices = self._property(layer_id, name)["choices"]
        if not isinstance(index, int) or not 0 <= index < len(choices):
            raise ValueError(f"{name}: there is no choice {index}")
        self.set_property(layer_id, name, choices[index]["value"])

    def set_number(self, layer_id: str, name: str, text: str) -> None:
        """Set a property to a number that was typed."""
        described = self._property(layer_id, name)
        read = describe.typed_or_none if described["optional"] else describe.typed
        value = read(text, name)
        whole = described["whole"] and value is not None and value == int(value)
        self.set_property(layer_id, name, int(value) if whole and value is not None else value)

    def set_end(self, layer_id: str, name: str, end: int, text: str) -> None:
        """Set one end of a range to a number that was typed."""
        value = describe.typed(text, name)
        ends = list(self._property(layer_id, name)["effective"])
        ends[1 if end else 0] = value
        self.set_property(layer_id, name, ends)

    def set_text(self, layer_id: str, name: str, text: str) -> None:
        """Set a property to a text, or to numbers between commas."""
        described = self._property(layer_id, name)
        value: Any = text.strip() or None
        if described["type"] == "numbers" and value is not None:
            value = [describe.typed(part, name) for part in text.replace(";", ",").split(",")]
        self.set_property(layer_id, name, value)

    def _property(self, layer_id: str, name: str) -> dict[str, Any]:
        for described in self.scene.queries.properties(layer_id):
            if described["name"] == name:
                return dict(described)
        raise ValueError(f"there is no property {name!r}")

    # History

    def undo(self) -> None:
        """Undo the last change."""
        if (what := self.history.undo()) is not None:
            self.refresh()
            self.say(f"Undone: {what}")

    def redo(self) -> None:
        """Redo the last undone change."""
        if (what := self.history.redo()) is not None:
            self.refresh()
            self.say(f"Redone: {what}")

    # Frames

    def _drawn(self) -> None:
        """Show what goes with a frame; nothing is sent where it is as before."""
        self.files.keep_soon()  # camera moves do not trigger it by themselves
        with self.state:
            self.camera.refresh()
            self.slices.refresh()
            self.regions.refresh_marks()
            left_out = self.scene.bars.left_out
            self.page.no_room = f"No room for the colours of {', '.join(left_out)}" if left_out else ""
            milliseconds = self.stream.milliseconds
            if self.browser.on:
                self.page.frame = "drawn by this browser"
                if self.browser.rests and self.page.tab == "info":
                    self.stream.settle()  # counts belong to the server's last frame
                    self._show_info()
            elif milliseconds is not None and not self.stream.moving:
                self.page.frame = f"{milliseconds:.0f} ms a frame"
                self._show_info()

    def later(self, coroutine: Any) -> asyncio.Task[Any]:
        """Run a coroutine beside everything else; its error becomes a sentence on the page."""
        task = asyncio.get_running_loop().create_task(coroutine)
        task.add_done_callback(self._done)
        return task

    def _done(self, task: asyncio.Task[Any]) -> None:
        if not task.cancelled() and (error := task.exception()) is not None:
            if not isinstance(error, EXPECTED):
                logger.error("a task failed", exc_info=error)
            self.complain(sentence(error))
