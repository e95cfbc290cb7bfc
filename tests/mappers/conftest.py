"""Scenes for the mapper's tests, with two renderers: the engine, and GL lines that know nothing of it."""

from __future__ import annotations

import importlib.util
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import pyvista as pv
from vtkmodules.vtkRenderingCore import vtkActor, vtkMapper

from pvfiblets.codec.compress import compress
from pvfiblets.mappers import FibletMapper, windows
from pvfiblets.streamlines import Streamlines


def _standin():
    path = Path(__file__).with_name("standin.py")
    spec = importlib.util.spec_from_file_location("fiblets_standin", path)
    module = importlib.util.module_from_spec(spec)
    import sys

    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


standin = _standin()


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


@dataclass
class Fibres:
    """One set of streamlines as the mapper takes it and as VTK's polylines take it."""

    kind: str
    fiblets: Any
    reference: Streamlines

    def mapper(self, **options: Any) -> FibletMapper:
        """Return a mapper on this kind's renderer."""
        if self.kind == "lines":
            options["renderer_factory"] = standin.LineRenderer
        return FibletMapper(self.fiblets, **options)

    def actor(self, *, lighting: bool = False, **options: Any) -> tuple[FibletMapper, vtkActor]:
        """Return a mapper and its actor."""
        mapper = self.mapper(**options)
        actor = vtkActor()
        actor.GetProperty().SetLighting(lighting)
        mapper.attach(actor)
        return mapper, actor

    def polydata(self) -> pv.PolyData:
        return polylines(self.reference)


def fibres(kind: str, streamlines: Streamlines, values: Any = None) -> Fibres:
    """Return streamlines for one of the two renderers."""
    if kind == "lines":
        plain = standin.PlainFiblets(np.asarray(streamlines.points, np.float64), streamlines.offsets, values)
        return Fibres(kind, plain, streamlines)
    fiblets = compress(streamlines)
    return Fibres(kind, fiblets, fiblets.decompress())


@pytest.fixture(params=["engine", pytest.param("lines", marks=pytest.mark.exhaustive)])
def kind(request) -> str:
    """Return which renderer fills the G-buffer."""
    return request.param


@pytest.fixture
def make_fibres(kind):
    """Return a function that makes fibres for this renderer."""
    return lambda streamlines=None, values=None: fibres(kind, streamlines or helices(), values)


@pytest.fixture
def lines(make_fibres) -> Fibres:
    """Return helices."""
    return make_fibres()


@pytest.fixture
def plain() -> Fibres:
    """Return helices on GL lines, for tests in which the engine has no part."""
    return fibres("lines", helices())


@pytest.fixture
def standins():
    """Return the list of line renderers made since the test began."""
    standin.LineRenderer.made.clear()
    return standin.LineRenderer.made


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
