"""An application without trame: what a page's actions need of one, so that they are tested without a browser."""

import asyncio
import contextlib
from types import SimpleNamespace

import numpy as np
import pyvista as pv

from pvfiblets.web.panels.describe import Charts
from pvfiblets.web.panels.files.opening import FileActions
from pvfiblets.web.panels.matrix_panel import MatrixActions
from pvfiblets.web.panels.tabs.bundle_finding import FindingActions
from pvfiblets.web.panels.tabs.bundle_measures import MeasureActions
from pvfiblets.web.panels.tabs.bundles_tab import BundleActions
from pvfiblets.web.panels.tabs.clip_tab import CutActions
from pvfiblets.web.panels.tabs.filter_regions import RegionActions
from pvfiblets.web.panels.tabs.filter_tab import FilterActions
from pvfiblets.web.scene.files.confined import Confined
from pvfiblets.web.scene.scene import Scene
from pvfiblets.web.scene.slices.slicing import VIEWS, ready_views
from pvfiblets.web.server.options import Options
from pvfiblets.web.server.scratch import Notes
from pvfiblets.web.session.history import History
from pvfiblets.web.session.script import as_script
from pvfiblets.web.state import Page


@contextlib.contextmanager
def scene_of_views(folder):
    """Open a scene whose root is a folder, with slices beside the 3-D view."""
    plotter = pv.Plotter(off_screen=True, window_size=(240, 160), shape=VIEWS, border=False)
    plotter.set_background("black")
    plotter.disable_anti_aliasing()
    ready_views(plotter)
    scene = Scene(plotter, folder)
    try:
        yield scene
    finally:
        scene.close()
        plotter.close()


def assert_script_draws(scene, folder, picture, placing=contextlib.nullcontext):
    """Run the script of a scene whose root is a folder, and compare what it draws with a picture.

    It is written, but not run, in the context ``placing``.
    """
    with placing():
        text = as_script(scene, str(folder / "found.png"))
    exec(compile(text.replace('FOLDER = Path(".")', f"FOLDER = Path({str(folder)!r})"), "script", "exec"), {})
    found = np.asarray(pv.read(folder / "found.png").active_scalars).reshape(*picture.shape[:2], -1)[::-1]
    assert (abs(found[..., :3].astype(int) - picture).max(axis=-1) > 8).mean() < 0.002


class Desk:
    """A scene with a page that is only a record; what is said to the user is in ``said``."""

    def __init__(self, scene, folder, **options):
        self.scene, self.plotter = scene, scene.plotter
        self.options = Options(root=str(folder), **options)
        self.confined = Confined(folder)
        self.history = History(scene)
        self.notes = Notes(None)
        self.page = Page()
        self.state = contextlib.nullcontext()
        size = tuple(scene.plotter.window_size)
        self.stream = SimpleNamespace(request=lambda: None, warm=lambda: None, size=size, settle=lambda: size)
        self.said = []
        self.refreshed = 0
        self.files = FileActions(self)
        self.cuts = CutActions(self)
        self.regions = RegionActions(self)
        self.filtering = FilterActions(self, Charts(scene))
        self.bundles = BundleActions(self)
        self.finding = FindingActions(self)
        self.measuring = MeasureActions(self)
        self.matrix = MatrixActions(self)
        self.tasks = []

    def choose(self, layer):
        """Make a layer the one that the panels are about."""
        self.page.chosen, self.page.chosen_kind = layer.id, layer.kind
        return layer.id

    def say(self, text, kind="info"):
        self.said.append((kind, text))

    def complain(self, text):
        self.say(text, "error")

    def refresh(self):
        self.refreshed += 1

    def later(self, coroutine):
        self.tasks.append(asyncio.get_running_loop().create_task(coroutine))
        return self.tasks[-1]

    def run(self, act):
        """Do something of the page, and wait for what runs beside."""

        async def doing():
            act()
            await self.done()

        asyncio.run(doing())

    async def done(self):
        """Wait for what runs beside; its errors are raised here."""
        while self.tasks:
            await self.tasks.pop(0)
