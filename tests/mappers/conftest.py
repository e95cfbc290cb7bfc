"""Scenes for the tests of mappers, and the same lines for VTK's own."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
import pyvista as pv
from vtkmodules.vtkRenderingCore import vtkActor, vtkMapper

from pvfiblets.codec.encoding.compress import compress
from pvfiblets.mappers import FibletMapper
from pvfiblets.mappers.fiblets import engine_renderer
from pvfiblets.mappers.frames import windows
from pvfiblets.streamlines import Streamlines


@pytest.fixture(autouse=True)
def _no_coincident_topology():
    """Switch off what PyVista switches on for the whole process when it draws edges: VTK then shifts depths."""
    before = vtkMapper.GetResolveCoincidentTopology()
    vtkMapper.SetResolveCoincidentTopologyToOff()
    yield
    vtkMapper.SetResolveCoincidentTopology(before)


def helices(count: int = 24, points: int = 150, seed: int = 0) -> Streamlines:
    """Return smooth curves about 90 mm across, around the origin."""
    random = np.random.default_rng(seed)
    curves = []
    for _ in range(count):
        t = np.linspace(0, 6, points) + random.uniform(0, 6)
        shift = random.normal(size=3) * 10 - (0, 0, 30)
        curves.append(np.c_[20 * np.cos(t), 20 * np.sin(t), 5 * t] + shift)
    return Streamlines.from_list(curves)


def polylines(streamlines: Any) -> pv.PolyData:
    """Return the same lines for VTK's own mapper."""
    counts = np.diff(streamlines.offsets)
    cells = np.insert(np.arange(len(streamlines.points)), streamlines.offsets[:-1], counts)
    return pv.PolyData(np.asarray(streamlines.points, dtype=np.float64), lines=cells)


MADE: list[Any] = []


def counted(ctx: Any, fiblets: Any, **options: Any) -> Any:
    """Return the engine's renderer, and remember it."""
    MADE.append(engine_renderer(ctx, fiblets, **options))
    return MADE[-1]


@dataclass
class Fibres:
    """One set of streamlines as the mapper takes it and as VTK's polylines take it."""

    fiblets: Any

    @property
    def reference(self) -> Streamlines:
        return self.fiblets.decompress()

    def mapper(self, **options: Any) -> FibletMapper:
        return FibletMapper(self.fiblets, **{"renderer_factory": counted} | options)

    def actor(self, *, lighting: bool = False, **options: Any) -> tuple[FibletMapper, vtkActor]:
        """Return a mapper and its actor."""
        mapper = self.mapper(**options)
        actor = vtkActor()
        actor.GetProperty().SetLighting(lighting)
        mapper.attach(actor)
        return mapper, actor

    def polydata(self) -> pv.PolyData:
        return polylines(self.reference)


def fibres(streamlines: Streamlines | None = None) -> Fibres:
    """Return streamlines, by default helices, for both."""
    return Fibres(compress(helices() if streamlines is None else streamlines))


@pytest.fixture
def make_fibres():
    """Return a function that makes fibres."""
    return fibres


@pytest.fixture
def lines() -> Fibres:
    """Return helices."""
    return fibres()


@pytest.fixture
def renderers():
    """Return the list of renderers made since the test began."""
    MADE.clear()
    yield MADE
    MADE.clear()


def check(*mappers: FibletMapper) -> None:
    """Raise what a mapper's draw has stored."""
    for mapper in mappers:
        mapper.raise_pending()


def gl_error(context: windows.WindowContext) -> str:
    """Return the GL error of a window's context."""
    context.window.MakeCurrent()
    return context.ctx.error


@pytest.fixture
def make_plotter():
    """Return a function that opens plotters; GL errors in any of them fail the test."""
    plotters = []

    def make(**options: Any) -> pv.Plotter:
        options = {"off_screen": True, "window_size": (240, 200)} | options
        plotter = pv.Plotter(**options)
        plotter.set_background("black")
        # Multisampling blends edges, which no comparison by pixels survives; it has tests of its own.
        plotter.disable_anti_aliasing()
        plotters.append(plotter)
        return plotter

    yield make
    errors = [gl_error(context) for context in windows._contexts.values() if context.alive]
    for plotter in plotters:
        plotter.close()
    assert set(errors) <= {"GL_NO_ERROR"}, errors
    assert not any(context.alive for context in windows._contexts.values())


def picture(plotter: pv.Plotter, *mappers: FibletMapper) -> np.ndarray:
    """Render, raise what the draw stored, and return (height, width, 3) uint8."""
    plotter.show(auto_close=False, interactive=False)
    plotter.render()
    image = plotter.screenshot(return_img=True)
    check(*mappers)
    return np.asarray(image)[..., :3]


def covered(image: np.ndarray, background: Any = (0, 0, 0)) -> np.ndarray:
    """Return which pixels differ from the background."""
    return (image != np.asarray(background, dtype=np.uint8)).any(axis=-1)


def grown(mask: np.ndarray) -> np.ndarray:
    """Return a mask with all eight neighbours added."""
    padded = np.pad(mask, 1)
    height, width = mask.shape
    return np.any([padded[y : y + height, x : x + width] for y in range(3) for x in range(3)], axis=0)


def agreement(ours: np.ndarray, theirs: np.ndarray) -> float:
    """Return the share of covered pixels with one of the other picture within a pixel."""
    assert ours.any(), "nothing was drawn"
    assert theirs.any(), "the reference drew nothing"
    hits = (ours & grown(theirs)).sum() + (theirs & grown(ours)).sum()
    return float(hits / (ours.sum() + theirs.sum()))


@pytest.fixture
def compare(make_plotter, lines):
    """Return a function that draws fiblets and VTK's polylines in the same scene and compares them.

    The scene is a function of a plotter, an actor and its mapper, called for either.
    """

    def run(scene, fibres_=None, **options: Any) -> tuple[np.ndarray, np.ndarray]:
        fibres_ = fibres_ or lines
        mapper, actor = fibres_.actor()
        from pvfiblets.mappers import Colouring

        mapper.colouring = Colouring("solid", color=(1.0, 1.0, 0.0))
        ours = make_plotter(**options)
        ours.add_actor(actor, reset_camera=False)
        reference = make_plotter(**options)
        other = reference.add_mesh(fibres_.polydata(), color=(1.0, 1.0, 0.0), lighting=False, reset_camera=False)
        for plotter, prop in ((ours, actor), (reference, other)):
            plotter.camera_position = [(60, -150, 70), (0, 0, 0), (0, 0, 1)]
            scene(plotter, prop, prop.GetMapper())
        return picture(ours, mapper), picture(reference)

    return run


@pytest.fixture
def tools():
    """Return the comparison functions."""
    from types import SimpleNamespace

    return SimpleNamespace(
        picture=picture,
        covered=covered,
        agreement=agreement,
        grown=grown,
        fibres=fibres,
        helices=helices,
        polylines=polylines,
        check=check,
    )
