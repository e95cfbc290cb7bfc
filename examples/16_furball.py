"""A furball
=========

A set like the paper's largest, of 787,327 segments, and the segment at a pixel.

Run it as ``python examples/16_furball.py [FOLDER]``.
"""

import sys
from dataclasses import replace
from pathlib import Path

import pyvista as pv

from pvfiblets.synthetic import tube_set
from pvfiblets.tubes.curves import cubic

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
folder.mkdir(parents=True, exist_ok=True)
tubes = tube_set("furball")
plotter = pv.Plotter(off_screen=True, window_size=(1350, 700), shape=(1, 2), border=False)
plotter.set_background("black", all_renderers=True)
for index, zoom in enumerate((1.4, 9.0)):
    plotter.subplot(0, index)
    actor = plotter.add_spline_tubes(tubes, scalars="value", cmap="copper", show_scalar_bar=False)
    actor.prop.specular, actor.prop.specular_power = 0.3, 20
    actor.ambient_occlusion = {"radius": 6.0}
    plotter.view_vector((1.0, -1.0, 0.5), viewup=(0, 0, 1))
    plotter.camera.zoom(zoom)
plotter.show(auto_close=False)
segment, t = actor.pick_at(1012, 350)  # the middle of the right image; None over the background
hair = tubes.tubes[segment]
*place, radius = cubic(tubes, segment, t)
print(f"segment {segment} at t = {t:.2f}, of hair {hair}, where its radius is {radius:.3f} mm")

marked = tubes.subset([hair])
plotter.add_spline_tubes(replace(marked, radius=1.3 * marked.radius), color="deepskyblue")
plotter.add_spline_tubes([[place]], radius=2.5 * radius, color="white")  # a line of one point is a ball
plotter.screenshot(folder / "furball.png")
