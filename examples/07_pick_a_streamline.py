"""Pick a streamline
=================

Find the streamline at a pixel, and draw it thick.

Run it as ``python examples/07_pick_a_streamline.py [FOLDER]``.
"""

import sys
from pathlib import Path

import pyvista as pv

from pvfiblets.synthetic import brain_streamlines

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
folder.mkdir(parents=True, exist_ok=True)
plotter = pv.Plotter(off_screen=True, window_size=(1000, 750))
plotter.set_background("black")
actor = plotter.add_fiblets(brain_streamlines(6_000))
plotter.view_vector((-1, 0, 0), viewup=(0, 0, 1))
plotter.camera.zoom(1.4)
plotter.show(auto_close=False)

found = actor.pick_at(500, 375)
if found is None:
    sys.exit("there is no streamline in the middle of the picture")
streamline, position = found
picked = actor.fiblets.decompress([streamline])
print(f"streamline {streamline} at its point {position:.1f}; it is {picked.lengths()[0]:.0f} mm long")

actor.opacity = 0.4
line = plotter.add_fiblets(picked, color="yellow", line_width=7, reset_camera=False)
line.tube_shading = True
plotter.render()
plotter.screenshot(folder / "picked.png")
