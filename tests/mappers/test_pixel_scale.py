"""Widths in pixels are what the viewer sees: the same share of the picture however large and finely it is drawn."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from vtkmodules.vtkRenderingCore import vtkActor

from pvfiblets.codec.encoding.compress import compress
from pvfiblets.halos import HaloLines, HaloStyle
from pvfiblets.mappers import FibletMapper
from pvfiblets.mappers.colouring import Colouring
from pvfiblets.mappers.effects.line_tubes import Tubes
from pvfiblets.mappers.effects.shading import Silhouette
from pvfiblets.mappers.frames.scene import pixel_scale
from pvfiblets.mappers.halos import HaloMapper
from pvfiblets.mappers.tubes import TubeMapper, TubeOptions
from pvfiblets.streamlines import Streamlines
from pvfiblets.tubes.build import as_spline_tubes

WIDTH = 8.0
SIZE = (120, 120)
ENDS = np.array([[-30.0, 0.0, 0.0], [0.0, 0.0, 0.0], [30.0, 0.0, 0.0]])
LINE = Streamlines.from_list([ENDS])
WHITE, THIN = Colouring("solid", color=(1.0, 1.0, 1.0)), 0.01


def fiblets(width=WIDTH):
    return FibletMapper(compress(LINE), line_width=width, colouring=WHITE)


def fiblets_as_tubes():
    mapper = fiblets(1.0)
    mapper.set_effect("tubes", Tubes(THIN))
    return mapper


def outline(width):
    mapper = fiblets(1.0)
    mapper.set_effect("silhouette", Silhouette(np.ones(1, bool), width=width))
    return mapper


def tubes(width=WIDTH):
    return TubeMapper(as_spline_tubes(LINE, radius=THIN), options=TubeOptions(min_width=width), colouring=WHITE)


def halos(width=WIDTH):
    look = HaloStyle(THIN, 2 * THIN, 1.0, min_width=width, smooth=False, n_tapered=0)
    return HaloMapper(HaloLines(ENDS, [0, 3]), look, colouring=WHITE, halo_color=(1.0, 1.0, 1.0))


# What is drawn, and how many pixels of the window it takes across.
DRAWN = {
    "fiblets": (fiblets, WIDTH),
    "thin fiblets": (lambda: fiblets(1.0), 1.0),
    "fiblets as tubes": (fiblets_as_tubes, 1.0),
    "outline of fiblets": (lambda: outline(3.0), 1.0 + 2 * 3.0),
    "spline tubes": (tubes, WIDTH),
    "lines with halos": (halos, WIDTH),
}


@pytest.fixture
def shown(make_plotter, tools):
    """Return a function that shows a mapper: a horizontal line at a quarter of the height, away from edges of tiles."""

    def show(mapper, supersampled=False, size=SIZE):
        actor = vtkActor()
        actor.GetProperty().SetLighting(False)
        mapper.attach(actor)
        plotter = make_plotter(window_size=size)
        plotter.add_actor(actor, reset_camera=False)
        plotter.camera_position = [(0, -100, 10.13), (0, 0, 10.13), (0, 0, 1)]
        plotter.enable_parallel_projection()
        plotter.camera.parallel_scale = 20.0
        if supersampled:
            plotter.enable_anti_aliasing("ssaa")
        tools.picture(plotter, mapper)
        return plotter

    return show


def across(plotter, mapper, scale):
    """Return the pixels of the window that are lit, in the middle column of a picture."""
    image = np.asarray(plotter.screenshot(None, scale=scale))[..., :3].astype(float)
    mapper.raise_pending()
    assert image.shape[:2] == (SIZE[1] * scale, SIZE[0] * scale)
    return image[:, image.shape[1] // 2].max(axis=-1).sum() / 255.0 / scale


@pytest.mark.few(2)
@pytest.mark.every("pair")
@pytest.mark.parametrize("scale", [1, 2, 3])
@pytest.mark.parametrize("supersampled", [False, True], ids=["plain", "ssaa"])
@pytest.mark.parametrize("name", DRAWN)
def test_a_width_is_what_the_viewer_sees(shown, name, supersampled, scale):
    make, wanted = DRAWN[name]
    mapper = make()
    assert across(shown(mapper, supersampled), mapper, scale) == pytest.approx(wanted, abs=0.75)


@pytest.mark.parametrize("dpi", [36, 72, 144])
@pytest.mark.parametrize("name", ["fiblets", "spline tubes", "lines with halos"])
def test_fewer_dots_per_inch_make_thinner_lines(shown, name, dpi):
    mapper = DRAWN[name][0]()
    plotter = shown(mapper)
    plotter.render_window.SetDPI(dpi)
    plotter.render()
    assert across(plotter, mapper, 1) == pytest.approx(WIDTH * min(1.0, dpi / 72), abs=0.75)


@pytest.mark.parametrize(("drawn", "wanted"), [((300, 200), 1.0), ((301, 201), 1.0), ((900, 600), 3.0)])
def test_rounding_of_sizes_makes_no_line_wider(drawn, wanted):
    def tiled_size(width, height):
        width[0], height[0] = 300, 200

    window = SimpleNamespace(GetDPI=lambda: 72, GetTileScale=lambda: (1, 1))
    renderer = SimpleNamespace(GetRenderWindow=lambda: window, GetTiledSize=tiled_size)
    assert pixel_scale(renderer, (0, 0, *drawn)) == wanted
