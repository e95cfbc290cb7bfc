"""Selected tracts
===============

Selected streamlines as smooth tubes among compressed ones, and a few tubes with a radius and values of their own.

Run it as ``python examples/15_selected_tracts.py [FOLDER]``.
"""

import sys
from pathlib import Path

import pyvista as pv

import pvfiblets
from pvfiblets.synthetic import brain_streamlines

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
folder.mkdir(parents=True, exist_ok=True)
brain = brain_streamlines(5_000, fa=True)
fiblets = pvfiblets.compress(brain)
plotter = pv.Plotter(off_screen=True, window_size=(1350, 650), shape=(1, 2), border=False)
plotter.set_background("black", all_renderers=True)
actor = plotter.add_fiblets(fiblets)
actor.select(brain.groups["arcuate"][::3], as_tubes=True, radius=0.9)  # colours, cuts and filters stay the actor's
actor.selection_style(dim=0.75)
plotter.view_vector((-1.0, 0.3, 0.4), viewup=(0, 0, 1))
plotter.camera.zoom(1.5)
plotter.subplot(0, 1)
some = brain[brain.groups["callosum"][::20]]
nodes = [range(start, stop, 10) for start, stop in zip(some.offsets[:-1], some.offsets[1:], strict=True)]
fa = [some.per_point["fa"][line] for line in nodes]  # every tenth point: splines need few
radius, bar = [0.2 + 2.0 * values for values in fa], {"title": "FA", "color": "white", "n_labels": 2}
tubes = plotter.add_spline_tubes([some.points[line] for line in nodes], radius=radius, scalars=fa, scalar_bar_args=bar)
tubes.prop.specular, tubes.prop.specular_power = 0.4, 30
tubes.ambient_occlusion = {"radius": 8.0}
plotter.add_fiblets(fiblets, color="white", opacity=0.01)
plotter.view_vector((0.6, 1.0, 0.6), viewup=(0, 0, 1))
plotter.camera.zoom(1.3)
plotter.screenshot(folder / "selected_tracts.png")
