"""Bundles and the matrix
======================

Clusters of streamlines as bundles, curvature along them, and a connectivity matrix with its strongest connection.

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
fiblets = pvfiblets.compress(brain_streamlines(6000, seed=3))
fiblets.groups = dict(list(fiblets.clusters(threshold=18.0).groups("bundle {}").items())[:8])  # the largest
blocks = fiblets.density(40.0)  # voxels of 40 mm serve as an atlas; a file's path would do as well
matrix = fiblets.connectome((1 + np.arange(blocks.values.size).reshape(blocks.values.shape), blocks.affine), radius=0.0)
strongest = matrix.labels[list(np.unravel_index(np.triu(matrix.matrix, 1).argmax(), matrix.matrix.shape))].tolist()
plotter = pv.Plotter(off_screen=True, window_size=(1400, 600), shape=(1, 2), border=False, theme=pv.themes.DarkTheme())
plotter.add_fiblets(fiblets, scalars="group", show_scalar_bar=False).groups_shown = list(fiblets.groups)
plotter.subplot(0, 1)
plotter.add_fiblets(fiblets[::8], color="grey", lighting=False)
plotter.add_fiblets(fiblets[matrix.streamlines(*strongest)], line_width=4)
plotter.link_views()
plotter.camera_position = [(-310, -14, 2), (0, -14, 2), (0, 0, 1)]
plotter.screenshot(folder / "bundles.png")
figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4.2), layout="constrained")
for bundle in list(fiblets.bundles)[:4]:
    pvfiblets.bundles.tract_profile(fiblets, bundle.name, "curvature", n=50).plot(left, color=bundle.color)
left.legend()
figure.colorbar(right.imshow(matrix.matrix, norm="log", cmap="inferno"), ax=right, label="streamlines")
figure.savefig(folder / "bundles_numbers.png", dpi=120)
