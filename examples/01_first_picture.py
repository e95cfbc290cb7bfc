"""A first picture
===============

A whole-brain-like tractogram in an ordinary PyVista scene.

Run it as ``python examples/01_first_picture.py [FOLDER]``.
"""

import sys
from pathlib import Path

import pyvista as pv

from pvfiblets.synthetic import brain_streamlines

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
folder.mkdir(parents=True, exist_ok=True)
brain = brain_streamlines(20_000)  # or the path of a .tck, .trk, .trx, .vtk, .vtp or .fiblets file

plotter = pv.Plotter(off_screen=True, window_size=(1200, 900))
plotter.set_background("black")
plotter.add_fiblets(brain)
plotter.view_vector((-1, 0, 0), viewup=(0, 0, 1))
plotter.camera.zoom(1.5)
plotter.screenshot(folder / "first_picture.png")
