"""Bundles and the matrix
======================

Clusters of streamlines as bundles, FA along them, and a connectivity matrix with its strongest connection.

Run it as ``python examples/27_bundles_and_matrix.py [FOLDER]``.
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pyvista as pv

import pvfiblets.bundles
from pvfiblets.synthetic import brain_streamlines

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
folder.mkdir(parents=True, exist_ok=True)
fiblets = pvfiblets.compress(brain_streamlines(6000, seed=3, fa=True), per_point=["fa"])
fiblets.groups.clear()
for index, cluster in enumerate(list(fiblets.clusters(threshold=18.0).by_size())[:8]):
    fiblets.bundles.add(f"bundle {index + 1}", cluster, color=plt.cm.Set1(index)[:3])
blocks = fiblets.density(40.0)  # voxels of 40 mm serve as an atlas; a file's path would do as well
matrix = fiblets.connectome((1 + np.arange(blocks.values.size).reshape(blocks.values.shape), blocks.affine), radius=0.0)
a, b = np.unravel_index(np.triu(matrix.matrix, 1).argmax(), matrix.matrix.shape)
plotter = pv.Plotter(off_screen=True, window_size=(1400, 600), shape=(1, 2), border=False)
plotter.set_background("black", all_renderers=True)
plotter.add_fiblets(fiblets, scalars="group", show_scalar_bar=False).groups_shown = list(fiblets.groups)
plotter.subplot(0, 1)
plotter.add_fiblets(fiblets[::8], color="grey", lighting=False)
plotter.add_fiblets(fiblets[matrix.streamlines(int(matrix.labels[a]), int(matrix.labels[b]))], line_width=4)
plotter.link_views()
plotter.view_yz(negative=True)
plotter.camera.zoom(1.5)
plotter.screenshot(folder / "bundles.png")
figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4.2), layout="constrained")
for bundle in list(fiblets.bundles)[:3]:
    pvfiblets.bundles.tract_profile(fiblets, bundle.name, "fa", n=50).plot(left, color=bundle.color)
left.legend()
shown = right.imshow(np.log10(np.where(matrix.matrix > 0, matrix.matrix, np.nan)), cmap="inferno")
figure.colorbar(shown, ax=right, label="log10 of streamlines")
figure.savefig(folder / "bundles_numbers.png", dpi=120)
