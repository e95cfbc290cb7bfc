"""Filter
======

Choose streamlines: by numbers, by regions they pass through or end in, by group, at random; and save the result.

Run it as ``python examples/10_filter.py [FOLDER]``.
"""

import sys
from pathlib import Path

import pyvista as pv

import pvfiblets
from pvfiblets import regions
from pvfiblets.synthetic import brain_streamlines

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
folder.mkdir(parents=True, exist_ok=True)
fiblets = pvfiblets.compress(brain_streamlines(8_000))
ball, top = regions.Sphere((-20, -10, 25), 14), regions.Plane((0, 0, 1), (0, 0, 55))
titles = "50 to 90 mm, little curvature", "through the ball, not ending in it", "three groups", "a mask"
plotter = pv.Plotter(off_screen=True, window_size=(1000, 800), shape=(2, 2))
plotter.set_background("black", all_renderers=True)
for index, title in enumerate(titles):
    plotter.subplot(*divmod(index, 2))
    plotter.add_text(title, position=(12, 370), font_size=11, color="white")
    plotter.add_fiblets(fiblets, scalars="group" if title == "three groups" else None, show_scalar_bar=False)
    plotter.view_vector((-1, -1.2, 0.6), viewup=(0, 0, 1))
    plotter.camera.zoom(1.4)
by_number, by_region, by_group, by_mask = plotter.fiblets
by_number.criterion("length", (50, 90))
by_number.criterion("curvature", (0, 0.06))  # a number per point: hides parts of streamlines
by_region.include(regions.passes(ball) & ~regions.ends_in(ball))
by_group.groups_shown = ["callosum", "corona", "thalamic"]
chosen = fiblets.select(regions.ends_in(top) & regions.passes(ball))
by_mask.show_only(chosen)
plotter.screenshot(folder / "filter.png")
fiblets[chosen].save(folder / "chosen.trk")
