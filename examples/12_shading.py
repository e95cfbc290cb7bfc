"""Shading
=======

Shade lines by the scene's lights, as illuminated lines, by ambient occlusion, by depth cueing and halos, or as tubes.

Run it as ``python examples/12_shading.py [FOLDER]``. All but the lights are off by default, and cost nothing then.
"""

import sys
from pathlib import Path

import pyvista as pv

import pvfiblets
from pvfiblets.synthetic import brain_streamlines

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
folder.mkdir(parents=True, exist_ok=True)
fiblets = pvfiblets.compress(brain_streamlines(6_000))
titles = (
    "the scene's lights", "illuminated lines", "ambient occlusion",
    "depth cueing and halos", "style = 'halo'", "lines of 4 pixels, shaded as tubes",
)  # fmt: skip
plotter = pv.Plotter(off_screen=True, window_size=(1350, 800), shape=(2, 3), border=False)
for index, title in enumerate(titles):
    plotter.subplot(*divmod(index, 3))
    plotter.add_fiblets(fiblets, color="lightskyblue" if index in (1, 2) else None)
    plotter.add_text(title, position=(12, 370), font_size=11, color="black")
    plotter.view_vector((-1, -0.4, 0.4), viewup=(0, 0, 1))
    plotter.camera.zoom(1.45)
_, illuminated, occluded, cued, halo, tubes = plotter.fiblets
illuminated.illuminated = True
occluded.ambient_occlusion = True
cued.depth_cue = cued.halos = True
halo.style = "halo"
tubes.line_width, tubes.tube_shading = 4, True
tubes.subset(0.25)
plotter.screenshot(folder / "shading.png")
