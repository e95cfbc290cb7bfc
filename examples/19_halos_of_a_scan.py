"""Halos of a scan
===============

A scanned surface as a cloud of points: gaps where one part of it passes in front of another, and no mesh at all.

Run it as ``python examples/19_halos_of_a_scan.py [FOLDER]``. Images like figure 15 of Everts et al. 2009. The
surface is that of the bones in PyVista's frog, which was cut into slices and photographed.
"""

import sys
from pathlib import Path

import numpy as np
import pyvista as pv
from pyvista import examples

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
folder.mkdir(parents=True, exist_ok=True)
frog = examples.load_frog_tissues()
bones = frog.contour([0.5], scalars=(frog["MetaImage"] == 13).astype(np.uint8), method="flying_edges")
corners, area = bones.points[bones.regular_faces], bones.compute_cell_sizes(volume=False)["Area"]
rng = np.random.default_rng(0)
hit = corners[rng.choice(len(area), 300_000, p=area / area.sum())]
points = (rng.dirichlet((1.0, 1.0, 1.0), len(hit))[:, :, None] * hit).sum(axis=1)  # by chance, evenly by area
plotter = pv.Plotter(off_screen=True, window_size=(1500, 800), shape=(1, 2), border=False)
sizes = {"point_size": 0.55, "halo_size": 5.0, "max_displacement": 12.0}  # mm
plotter.set_background("white", all_renderers=False)
actor = plotter.add_halo_points(points, **sizes, displacement="square root")
plotter.view_vector((0.3, -0.5, -1.0), viewup=(0, -1, 0))
plotter.camera.zoom(1.35)

plotter.subplot(0, 1)
plotter.set_background("black", all_renderers=False)
plotter.add_halo_points(points, **sizes, displacement="square root")
plotter.camera_position = [(420.0, 60.0, -330.0), (390.0, 215.0, 90.0), (0.0, -1.0, 0.0)]
plotter.screenshot(folder / "halos_of_a_scan.png")
print(f"{actor.explain()['points_total']:,} points, {actor.explain()['gpu_bytes'] / 1e6:.0f} MB with pictures")
plotter.close()
