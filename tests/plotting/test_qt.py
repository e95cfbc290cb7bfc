"""A Qt window with PyVista's interactor shows what an off-screen plotter shows, and takes changes and picks."""

from __future__ import annotations

import os
import subprocess
import sys

import numpy as np
import pytest

from tests.display import display

# A process of its own: a window of X beside the tests' headless ones, and Qt's one application.
SCRIPT = """
import os, sys
import numpy as np
import pyvista as pv
import pvfiblets.plotting

t = np.linspace(0, 6, 100)
spring = [np.c_[20 * np.cos(t), 20 * np.sin(t), 5 * t]]

def fill(plotter):
    plotter.set_background("black")
    plotter.disable_anti_aliasing()
    actor = plotter.add_fiblets(spring, color="red", line_width=4, lighting=False)
    plotter.add_halo_points(np.array([(0.0, 0.0, 5.0)]), point_size=6, halo_size=9, color="lime", halo_color="blue")
    plotter.view_isometric()
    return actor

def pictures(plotter, actor):
    plotter.render()
    first = plotter.screenshot(return_img=True)
    row, column = np.argwhere((first == (255, 0, 0)).all(axis=2))[0]
    picked = actor.pick_at(int(column), first.shape[0] - 1 - int(row))
    actor.line_width = 9
    plotter.render()
    wide = plotter.screenshot(return_img=True)
    np.savez(sys.argv[2], first=first, wide=wide, picked=[] if picked is None else picked)

if sys.argv[1] == "qt":
    from pyvistaqt import QtInteractor
    from qtpy import QtCore, QtWidgets

    application = QtWidgets.QApplication([])
    frame = QtWidgets.QMainWindow()
    plotter = QtInteractor(frame, auto_update=False)
    frame.setCentralWidget(plotter)
    plotter.setFixedSize(320, 240)
    frame.show()
    actor = fill(plotter)

    def look():
        try:
            pictures(plotter, actor)
        finally:
            plotter.close()
            frame.close()
            application.quit()

    QtCore.QTimer.singleShot(1000, look)
    application.exec()
else:
    plotter = pv.Plotter(off_screen=True, window_size=(320, 240))
    actor = fill(plotter)
    plotter.show(auto_close=False)
    pictures(plotter, actor)
"""


@pytest.fixture
def environment():
    """Return the environment of a display of its own, or skip where there is none."""
    with display() as number:
        pytest.importorskip("pyvistaqt")
        pytest.importorskip("PySide6")
        yield {"DISPLAY": number, "QT_API": "pyside6", "QT_QPA_PLATFORM": "xcb"}


def seen(tmp_path, kind, extra):
    """Run the script, and return its pictures."""
    environment = {name: value for name, value in os.environ.items() if name != "VTK_DEFAULT_OPENGL_WINDOW"}
    path = tmp_path / f"{kind}.npz"
    command = [sys.executable, "-c", SCRIPT, kind, str(path)]
    done = subprocess.run(
        command, capture_output=True, text=True, check=False, env={**environment, **extra}, timeout=200
    )
    assert done.returncode == 0, done.stderr
    return np.load(path)


@pytest.mark.more
def test_a_qt_window_shows_the_same_scene(environment, tmp_path):
    window = seen(tmp_path, "qt", environment)
    headless = seen(tmp_path, "headless", {"VTK_DEFAULT_OPENGL_WINDOW": "vtkEGLRenderWindow"})
    for name in ("first", "wide"):
        assert window[name].shape == headless[name].shape == (240, 320, 3)
        assert (headless[name] != headless[name][0, 0]).any(axis=2).sum() > 500
        differs = (abs(window[name].astype(int) - headless[name]) > 8).any(axis=2)
        assert differs.mean() < 0.005
    assert (window["wide"] != window["first"]).any()
    assert window["picked"].size > 0
    np.testing.assert_allclose(window["picked"], headless["picked"], rtol=1e-3)
