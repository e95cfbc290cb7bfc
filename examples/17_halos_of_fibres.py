"""
Halos of fibres
===============

Fibre tracts as ink on paper: bundles show as dark strands, and gaps where one passes behind another.

Run it as ``python examples/17_halos_of_fibres.py [FOLDER]``. Pictures like figures 1, 7 and 10 of Everts et al. 2009.
"""

import sys
from itertools import pairwise
from pathlib import Path

import pyvista as pv

from pvfiblets import regions
from pvfiblets.synthetic import brain_streamlines

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
folder.mkdir(parents=True, exist_ok=True)
brain = brain_streamlines(7_000, step=1.0, fa=True)
inside = regions.Slab((1, 0, 0), (9, 0, 0), 3.0).contains(brain.points)  # sagittal, 9 mm to the right of the middle
chosen = brain[[bool(inside[start:stop].any()) for start, stop in pairwise(brain.offsets)]]
plotter = pv.Plotter(off_screen=True, window_size=(1200, 850))
plotter.set_background("white")
actor = plotter.add_halo_lines(chosen, width_cue=0.7)  # near lines are thick, far ones thin
print(f"lines of {actor.line_width:.2f} mm in strips of {actor.strip_width:.2f} mm suit their distances")
actor.line_width = 0.4
plotter.view_vector((1.0, 0.35, 0.3), viewup=(0, 0, 1))
plotter.camera.zoom(1.7)
plotter.screenshot(folder / "halos_of_fibres.png")

# All, then only high FA, which shows the inside; at last by direction.
plotter = pv.Plotter(off_screen=True, window_size=(1400, 900), shape=(2, 2), border=False)
for index, least in enumerate((None, 0.45, 0.62, 0.62)):
    plotter.subplot(*divmod(index, 2))
    plotter.set_background("black" if index == 3 else "white", all_renderers=False)
    look = {"line_width": 0.35, "strip_width": 1.4, "scalars": "orientation" if index == 3 else None}
    plotter.add_halo_lines(brain[: len(brain) * 2 // 3], filter_by="fa", threshold=least, **look)
    title = "all" if least is None else f"FA of {least} and more"
    plotter.add_text(title, position="lower_edge", font_size=11, color="white" if index == 3 else "black")
    plotter.view_vector((0.35, 1.0, 0.3), viewup=(0, 0, 1))
    plotter.camera.zoom(1.75)
plotter.screenshot(folder / "halos_filtered.png")
