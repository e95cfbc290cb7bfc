"""
Bundles and the matrix
======================

Streamlines that run alike become bundles with colours of their own. A value is averaged along them, and a matrix says
how strongly the parcels of an atlas are connected: the streamlines behind its strongest number are drawn beside it.

Run it as ``python examples/27_bundles_and_matrix.py [FOLDER]``.
"""

import sys
from pathlib import Path

import numpy as np
import pyvista as pv
from matplotlib.figure import Figure

import pvfiblets
from pvfiblets import bundles
from pvfiblets.synthetic import brain_streamlines

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
folder.mkdir(parents=True, exist_ok=True)
fiblets = pvfiblets.compress(brain_streamlines(6000, seed=3, fa=True), per_point=["fa"])
fiblets.groups.clear()
colours = ("#e6194b", "#3cb44b", "#ffe119", "#4f8cff", "#f58231", "#b15de6", "#46f0f0", "#f032e6")
for color, cluster in zip(colours, fiblets.clusters(threshold=18.0).by_size(), strict=False):
    fiblets.bundles.add(f"bundle {len(fiblets.bundles) + 1}", cluster, color=color)
profiles = [bundles.tract_profile(fiblets, one.name, "fa", n=50) for one in list(fiblets.bundles)[:3]]
bundles.profile_table(profiles).save(folder / "profiles.csv")

low, high = np.array(fiblets.bounds).reshape(3, 2).T
size = (high - low) / (4, 5, 3)
affine = np.diag([*size, 1.0])
affine[:3, 3] = low + size / 2
labels = 1 + np.arange(60).reshape(4, 5, 3)  # made up: blocks of the brain; a file's path would do as well
matrix = fiblets.connectome((labels, affine), radius=0.0)
a, b = np.unravel_index(np.triu(matrix.matrix, 1).argmax(), matrix.matrix.shape)
between = matrix.streamlines(int(matrix.labels[a]), int(matrix.labels[b]))
print(f"{matrix}; {len(between)} streamlines connect {matrix.names[a]} and {matrix.names[b]}")

plotter = pv.Plotter(off_screen=True, window_size=(1400, 600), shape=(1, 2), border=False)
plotter.set_background("black", all_renderers=True)
actor = plotter.add_fiblets(fiblets, scalars="group", line_width=2, show_scalar_bar=False)
actor.include(np.isin(np.arange(len(fiblets)), np.concatenate([one.ids for one in fiblets.bundles])))
plotter.subplot(0, 1)
plotter.add_fiblets(fiblets[::8], color="grey", lighting=False)
plotter.add_fiblets(fiblets[between], line_width=4)
plotter.link_views()
plotter.view_yz(negative=True)
plotter.camera.zoom(1.5)
plotter.screenshot(folder / "bundles.png")

figure = Figure(figsize=(11, 4.2), layout="constrained")
left, right = figure.subplots(1, 2)
for one, profile in zip(fiblets.bundles, profiles, strict=False):
    profile.plot(left, color=one.color)
left.legend()
shown = right.imshow(np.log10(np.where(matrix.matrix > 0, matrix.matrix, np.nan)), cmap="inferno")
figure.colorbar(shown, ax=right, label="log10 of streamlines")
figure.savefig(folder / "bundles_numbers.png", dpi=120)
