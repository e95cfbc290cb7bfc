"""Films of PyVista's: `open_gif`, `write_frame` and `orbit_on_path` hold what screenshots show."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv

imageio = pytest.importorskip("imageio.v3")

LINES = [np.linspace([0.0, 0.0, k], [9.0, 5.0 * k, k], 20) for k in range(3)]


@pytest.fixture
def plotter():
    plotter = pv.Plotter(off_screen=True, window_size=(96, 64))  # sizes that films of all codecs may have
    plotter.set_background("black")
    yield plotter
    plotter.close()


def image():
    ball = pv.ImageData(dimensions=(8, 8, 8))
    ball["values"] = np.exp(-(((np.mgrid[:8, :8, :8] - 3.5) ** 2).sum(axis=0)) / 8.0).ravel(order="F")
    return ball


ADDED = {
    "fiblets": lambda plotter: plotter.add_fiblets(LINES, line_width=3, color="red"),
    "tubes": lambda plotter: plotter.add_spline_tubes(LINES, radius=1.0, color="red"),
    "halos": lambda plotter: plotter.add_halo_lines(LINES, light_on_dark=True),
    "volume": lambda plotter: plotter.add_raycast_volume(image(), show_scalar_bar=False),
}


@pytest.mark.few(1)
@pytest.mark.parametrize("what", ADDED)
def test_frames_are_screenshots(plotter, tmp_path, what):
    ADDED[what](plotter)
    plotter.open_gif(str(tmp_path / "a.gif"), loop=0)
    shown = []
    for _ in range(3):
        plotter.camera.azimuth += 40.0
        plotter.write_frame()
        shown.append(plotter.screenshot())
    plotter.close()
    frames = imageio.imread(tmp_path / "a.gif")
    assert len(frames) == 3
    for frame, picture in zip(frames, shown, strict=True):
        assert picture.any()
        assert np.abs(frame[..., :3].astype(int) - picture).mean() < 8.0  # of a palette


def test_lines_that_grow(plotter, tmp_path):
    actor = plotter.add_fiblets([line[:5] for line in LINES], line_width=3, color="red")
    plotter.view_xy()
    plotter.camera.zoom(0.3)
    plotter.open_gif(str(tmp_path / "a.gif"))
    for points in (5, 12, 20):
        actor.update([line[:points] for line in LINES])
        plotter.write_frame()
    plotter.close()
    frames = imageio.imread(tmp_path / "a.gif")[..., :3].astype(int)
    inked = [int((frame.sum(axis=-1) > 60).sum()) for frame in frames]
    assert 0 < inked[0] < inked[1] < inked[2]
