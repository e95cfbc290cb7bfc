"""What other actors hide is culled, and comes back with the first picture in which they no longer do."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv

import pvfiblets
from pvfiblets.synthetic import brain_streamlines


@pytest.fixture(scope="module")
def fiblets():
    return pvfiblets.compress(brain_streamlines(600, 0.5, 3))


def scene(fiblets, *, wall_first=True, culling="two-phase", samples=0):
    """A wall in front of most of a brain."""
    plotter = pv.Plotter(off_screen=True, window_size=(320, 240))
    plotter.set_background("black")
    if not samples:
        plotter.disable_anti_aliasing()
    plane = pv.Plane(center=(0, -140, 10), direction=(0, 1, 0), i_size=150, j_size=150, i_resolution=1, j_resolution=1)
    if wall_first:
        wall = plotter.add_mesh(plane, color="white", render=False)
    actor = plotter.add_fiblets(fiblets, culling=culling, render=False)
    if not wall_first:
        wall = plotter.add_mesh(plane, color="white", render=False)
    plotter.camera_position = [(0, -450, 10), (0, -18, 10), (0, 0, 1)]
    plotter.reset_camera_clipping_range()
    plotter.show(auto_close=False)
    return plotter, actor, wall


def turn(plotter, degrees):
    plotter.camera.azimuth += degrees
    plotter.render()
    return plotter.screenshot(None, return_img=True)


@pytest.mark.few(1)
@pytest.mark.parametrize("samples", [0, 4])
@pytest.mark.parametrize("wall_first", [True, False])
def test_pictures_are_those_without_culling(fiblets, wall_first, samples):
    culled, actor, wall = scene(fiblets, wall_first=wall_first, samples=samples)
    whole, _, other_wall = scene(fiblets, wall_first=wall_first, culling=None, samples=samples)
    for move in range(8):
        for it in (wall, other_wall):
            if move == 3:
                it.SetVisibility(False)
            if move == 4:
                it.SetVisibility(True)
            if move == 6:
                it.SetPosition(40, 0, 0)
        a, b = (turn(plotter, 3.0 if move % 2 else 0.0) for plotter in (culled, whole))
        assert (a == b).all(), f"move {move}"
    actor.prop.line_width = 4
    culled.render()
    culled.close()
    whole.close()


def drawn(actor):
    """Fiblets in the plan of the last redraw."""
    return actor.explain()["fiblets"]["drawn"]


def test_less_is_drawn_behind_a_wall(fiblets):
    shares = {}
    for wall_first in (True, False):
        plotter, actor, _ = scene(fiblets, wall_first=wall_first)
        turn(plotter, 2.0)
        turn(plotter, 2.0)
        shares[wall_first] = drawn(actor) / fiblets.n_fiblets
        plotter.close()
    assert shares[True] < 0.7 * shares[False]


def test_picking_looks_behind_the_wall(fiblets):
    plotter, actor, _ = scene(fiblets)
    turn(plotter, 2.0)
    with_wall = actor.mapper.pick_at(160, 120, tolerance=3)
    plotter.close()
    free, other, _ = scene(fiblets, wall_first=False)
    turn(free, 2.0)
    assert with_wall == other.mapper.pick_at(160, 120, tolerance=3)
    assert np.isfinite(with_wall[1])
    free.close()
