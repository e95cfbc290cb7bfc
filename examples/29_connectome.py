"""A connectome
============

Nodes are parcels. An edge shows the number of its streamlines by radius and colour; on the right it is their mean.

Run it as ``python examples/29_connectome.py [FOLDER]``.
"""

import sys
from pathlib import Path

import numpy as np
import pyvista as pv

import pvfiblets
from pvfiblets.synthetic import brain_streamlines

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
folder.mkdir(parents=True, exist_ok=True)
fiblets = pvfiblets.compress(brain_streamlines(6000, seed=3))
density = fiblets.density(4.0)  # for a synthetic atlas; the path of one would do as well
voxels = np.argwhere(density.values > 0)
places = voxels @ density.affine[:3, :3].T + density.affine[:3, 3]
seeds = np.random.default_rng(1).choice(places, 40, replace=False)
labels = np.zeros(density.values.shape, int)
labels[tuple(voxels.T)] = 1 + np.linalg.norm(places[:, None] - seeds, axis=2).argmin(axis=1)
matrix = fiblets.connectome(atlas := (labels, density.affine))
plotter = pv.Plotter(off_screen=True, window_size=(1400, 600), shape=(1, 2), border=False)
plotter.set_background("black", all_renderers=True)
plotter.add_connectome(matrix, atlas, threshold=10, log_scale=True, show_scalar_bar=False)
plotter.subplot(0, 1)
bar = {"title": "count", "color": "white", "vertical": True}
way = {"edges": "streamlines", "streamlines": fiblets, "log_scale": True, "scalar_bar_args": bar}
plotter.add_connectome(matrix, atlas, **way).threshold = 10  # hides weaker edges
plotter.link_views()
plotter.view_yz(negative=True)
plotter.camera.zoom(1.5)
plotter.render()
plotter.screenshot(folder / "connectome.png")
