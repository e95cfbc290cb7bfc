"""Slices
======

Three slice views and a 3-D view, linked by a cross-hair: a head, fibre directions, and streamlines near each slice.

Run it as ``python examples/26_linked_slices.py [FOLDER]``.
"""

import sys
from pathlib import Path

import numpy as np
import pyvista as pv

import pvfiblets
from pvfiblets.synthetic import brain_streamlines
from pvfiblets.synthetic.vessels import brain_like

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
folder.mkdir(parents=True, exist_ok=True)
head = brain_like(144, noise=0.02)  # a made-up image; a file's path would do as well
affine = np.diag([1.3, 1.3, 1.25, 1.0]) @ head.affine + np.outer((0, -18, 4, 0), (0, 0, 0, 1))
fiblets = pvfiblets.compress(brain_streamlines(20_000, seed=2))
directions = fiblets.density(2.0, contrast="direction")
counts = fiblets.density(like=directions)
plotter = pv.Plotter(off_screen=True, window_size=(1000, 1000), shape=(2, 2))
plotter.set_background("black", all_renderers=True)
workspace = plotter.slices.workspace((head.values, affine), thickness=1.5)
workspace.slices.layers[0].below = 15.0  # air would occlude the slices behind it
most = float(np.percentile(counts.values, 99.0))
workspace.slices.add(directions, kind="direction", modulate=counts, clim=(0.0, most), below=0.3 * most, opacity=0.5)
plotter.add_fiblets(fiblets[fiblets.groups["callosum"]], lighting=False)
workspace.position = (-12.0, -24.0, 30.0)
workspace.add_contours(pv.Sphere(radius=15.0, center=workspace.position), "white")
plotter.view_isometric()
plotter.camera.zoom(1.4)
print(workspace.values(radius=3.0).images)
plotter.show(auto_close=False)
plotter.screenshot(folder / "slices.png")
