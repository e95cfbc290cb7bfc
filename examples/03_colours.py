"""Colours
=======

Four ways to colour the same streamlines.

Run it as ``python examples/03_colours.py [FOLDER]``.
"""

import sys
from pathlib import Path

import numpy as np
import pyvista as pv

import pvfiblets
from pvfiblets.synthetic import BUNDLES, brain_streamlines

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
folder.mkdir(parents=True, exist_ok=True)
fiblets = pvfiblets.compress(brain_streamlines(8_000, fa=True), per_point=["fa"])
font = {"title_font_size": 34, "label_font_size": 34, "color": "white"}
bar = {**font, "vertical": True, "position_x": 0.83, "position_y": 0.1, "height": 0.7, "n_labels": 3}
palette = np.random.default_rng(3).uniform(0.2, 1.0, (len(BUNDLES), 3))
panels = {
    "orientation": {},
    "length": {"scalars": "length", "cmap": "plasma", "scalar_bar_args": {**bar, "title": "mm"}},
    "FA in each point": {"scalars": "fa", "clim": (0.1, 0.7), "scalar_bar_args": {**bar, "title": "FA"}},
    "bundles": {"scalars": palette[fiblets.per_streamline["bundle"]]},  # a colour per streamline
}
plotter = pv.Plotter(off_screen=True, shape=(2, 2), window_size=(1600, 1200), border=False)
plotter.set_background("black", all_renderers=True)
for index, (title, colours) in enumerate(panels.items()):
    plotter.subplot(*divmod(index, 2))
    plotter.add_fiblets(fiblets, **colours)
    plotter.add_text(title, font_size=22, color="white")
    plotter.view_vector((-1, 0, 0), viewup=(0, 0, 1))
    plotter.camera.zoom(1.3)
plotter.screenshot(folder / "colours.png")
