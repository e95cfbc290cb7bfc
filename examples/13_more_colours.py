"""More colours
============

Colour by a volume, by a distance and by the coding error; and show four translucent layers.

Run it as ``python examples/13_more_colours.py [FOLDER]``.
"""

import sys
from pathlib import Path

import numpy as np
import pyvista as pv

from pvfiblets import regions
from pvfiblets.synthetic import brain_streamlines

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
folder.mkdir(parents=True, exist_ok=True)
volume = pv.ImageData(dimensions=(80, 96, 80), spacing=(2.0, 2.0, 2.0), origin=(-79.0, -95.0, -70.0))
volume["made-up FA"] = 0.5 + 0.4 * np.cos(volume.points / (15, 18, 16)).prod(axis=1)
ball = regions.Sphere((30, 10, 25), 12)
panels = {
    "a volume": {"scalars": volume},
    "the distance from a ball": {"scalars": regions.Distance(ball, per="point"), "cmap": "inferno_r", "clim": (0, 60)},
    "the coding error": {"scalars": "coding_error", "clim": (0, 0.008)},
    "four layers of lines, and a ball": {"opacity": 0.25, "transparency": "layers", "line_width": 2},
}
bar = {"color": "white", "title_font_size": 14, "label_font_size": 12, "n_labels": 2}
plotter = pv.Plotter(off_screen=True, window_size=(1000, 800), shape=(2, 2))
plotter.set_background("black", all_renderers=True)
for index, (title, settings) in enumerate(panels.items()):
    plotter.subplot(*divmod(index, 2))
    plotter.add_fiblets(brain_streamlines(5_000), scalar_bar_args=bar, **settings)
    plotter.add_text(title, position=(12, 368), font_size=11, color="white")
    plotter.view_vector((1, 0.9, 0.6), viewup=(0, 0, 1))
    plotter.camera.zoom(1.5)
plotter.add_mesh(pv.Sphere(radius=12, center=(30, 10, 25)), color="white")
plotter.screenshot(folder / "more_colours.png")
