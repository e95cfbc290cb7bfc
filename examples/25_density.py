"""Density
=======

Streamlines added up in voxels: as light, as mean directions, and as the mean FA. A NIfTI file keeps the counts.

Run it as ``python examples/25_density.py [FOLDER]``.
"""

import sys
from pathlib import Path

import numpy as np
import pyvista as pv

import pvfiblets
from pvfiblets.synthetic import brain_streamlines

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
folder.mkdir(parents=True, exist_ok=True)
fiblets = pvfiblets.compress(brain_streamlines(20_000, seed=2, fa=True), per_point=["fa"])
counts = fiblets.density(1.5)  # mm
counts.save(folder / "counts.nii.gz")
top = float(np.percentile(counts.values[counts.values > 0], 98))
bar = {"color": "white", "n_labels": 2, "title_font_size": 16, "label_font_size": 14}
plotter = pv.Plotter(off_screen=True, window_size=(1350, 450), shape=(1, 3), border=False)
plotter.set_background("black", all_renderers=True)
light = {"cmap": "inferno", "clim": (0, top), "opacity": [0, 0.06, 0.2, 0.5, 0.8], "opacity_unit_distance": 6.0}
plotter.add_raycast_volume(counts, **light, scalar_bar_args={**bar, "title": "streamlines per voxel"})
plotter.subplot(0, 1)
image = fiblets.density(like=counts, contrast="direction").to_image()
image["rgb"] = image["direction"] * np.clip(counts.to_image()["count"] / top, 0.0, 1.0)[:, None] ** 0.4
plotter.add_mesh(image.slice("y", origin=(0, -27, 0)), scalars="rgb", rgb=True, lighting=False)
plotter.subplot(0, 2)
image = fiblets.density(like=counts, contrast="fa").to_image().slice("y", origin=(0, -27, 0)).threshold(1e-3)
plotter.add_mesh(image, lighting=False, scalar_bar_args={**bar, "title": "mean of FA"})
plotter.link_views()
plotter.view_xz()
plotter.camera.zoom(1.1)
plotter.screenshot(folder / "density.png")
