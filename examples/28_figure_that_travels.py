"""A figure as one HTML file
=========================

One HTML file with the streamlines in it, which any browser draws by itself: for reviewers, notebooks and phones.

Run it as ``python examples/28_figure_that_travels.py [FOLDER]``.
"""

import sys
from pathlib import Path

import pyvista as pv

import pvfiblets
from pvfiblets.synthetic import brain_streamlines

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
folder.mkdir(parents=True, exist_ok=True)
fiblets = pvfiblets.compress(brain_streamlines(20_000, seed=2, fa=True), per_point=["fa"])

plotter = pv.Plotter(off_screen=True, window_size=(900, 700))
plotter.set_background("white")
plotter.add_fiblets(fiblets, scalars="fa", cmap="viridis", name="whole brain")
plotter.add_mesh(pv.Sphere(radius=12.0, center=(0.0, -20.0, 15.0)), color="tomato", name="seed region")
plotter.view_isometric()
plotter.camera.zoom(1.3)
(page,) = plotter.fiblets.export_page(folder / "figure.html", title="A synthetic whole brain")
print(f"{page.stat().st_size / fiblets.n_points:.2f} bytes for each of {fiblets.n_points:,} points")
plotter.screenshot(folder / "figure_by_the_engine.png")
