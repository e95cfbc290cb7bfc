"""Halos of fibres
===============

Fibre tracts as ink on paper: bundles are dark strands, with gaps where one passes behind another.

Run it as ``python examples/17_halos_of_fibres.py [FOLDER]``. Images like figures 1, 7 and 10 of Everts et al. 2009.
"""

import sys
from pathlib import Path

import pyvista as pv

import pvfiblets
from pvfiblets import regions
from pvfiblets.synthetic import brain_streamlines

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
folder.mkdir(parents=True, exist_ok=True)
brain = brain_streamlines(7_000, step=1.0, fa=True)
slab = regions.Slab((1, 0, 0), (9, 0, 0), 3.0)  # sagittal, 9 mm to the right of the middle
chosen = brain[pvfiblets.compress(brain).select(regions.passes(slab))]
plotter = pv.Plotter(off_screen=True, window_size=(1200, 850))
plotter.set_background("white")
plotter.add_halo_lines(chosen, line_width=0.4, width_cue=0.7)  # near lines are thick, far ones thin
plotter.view_vector((1.0, 0.35, 0.3), viewup=(0, 0, 1))
plotter.camera.zoom(1.7)
plotter.screenshot(folder / "halos_of_fibres.png")
plotter = pv.Plotter(off_screen=True, window_size=(1400, 900), shape=(2, 2), border=False)  # filtered by FA
for index, (least, scalars) in enumerate([(None, None), (0.45, None), (0.62, None), (0.62, "orientation")]):
    plotter.subplot(*divmod(index, 2))
    plotter.set_background("black" if scalars else "white", all_renderers=False)
    look = {"line_width": 0.35, "strip_width": 1.4, "scalars": scalars}
    plotter.add_halo_lines(brain[: len(brain) * 2 // 3], filter_by="fa", threshold=least, **look)
    title = f"FA of {least} and more" if least else "all"
    plotter.add_text(title, position="lower_edge", font_size=14, color="white" if scalars else "black")
    plotter.view_vector((0.35, 1.0, 0.3), viewup=(0, 0, 1))
    plotter.camera.zoom(1.75)
plotter.screenshot(folder / "halos_filtered.png")
