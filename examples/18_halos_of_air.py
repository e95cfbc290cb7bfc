"""Halos of air
============

Air currents in an office, as ink on paper; the second image is for red-cyan glasses, red on the left eye.

Run it as ``python examples/18_halos_of_air.py [FOLDER]``. Images like figures 8 and 11 of Everts et al. 2009.
"""

import sys
from pathlib import Path

import numpy as np
import pyvista as pv

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
folder.mkdir(parents=True, exist_ok=True)
room, rng = np.array((6000.0, 4000.0, 2800.0)), np.random.default_rng(7)  # mm
desks = [(1000, 2400, 600, 1500, 0, 750), (4600, 5600, 0, 500, 0, 2000), (3900, 5300, 2100, 3000, 0, 750)]
grid = pv.ImageData(dimensions=(61, 41, 29), spacing=(100.0, 100.0, 100.0))
low, high = np.moveaxis(np.reshape(desks, (3, 1, 3, 2)), 3, 0)
outside = np.linalg.norm(np.maximum(low - grid.points, grid.points - high).clip(0.0), axis=2)
near = (np.vstack([outside, grid.points.T, (room - grid.points).T]).min(axis=0) / 350.0).clip(0.0, 1.0)[:, None]
waves = np.sin(grid.points @ rng.normal(0.0, 1.2e-3, (3, 30)) + range(30)) @ rng.normal(0.0, 0.12, (30, 3))
grid["potential"] = near**2 * (3.0 - 2.0 * near) * ((0, 1, 0) + waves)  # the curl has no sources
grid = grid.compute_derivative("potential", gradient=False, vorticity=True)
seeds = np.repeat(rng.uniform(300.0, room - 300.0, (56, 3)), 14, axis=0) + rng.normal(0.0, 70.0, (784, 3))
lines = grid.streamlines_from_source(pv.PolyData(seeds), "vorticity", integration_direction="forward", max_length=8e3)
plotter = pv.Plotter(off_screen=True, window_size=(1150, 850))
plotter.set_background("white")
plotter.add_halo_lines(lines, color="black")
plotter.add_mesh(pv.merge([pv.Box(desk) for desk in desks]), color="white", lighting=False)
edges = [pv.Box(np.add(desk, (-10, 10, -10, 10, 0, 10))).extract_feature_edges() for desk in desks]
plotter.add_halo_lines(pv.merge(edges), line_width=14, max_displacement=200, tapering=False)
plotter.view_vector((-0.35, -1.0, 0.55), viewup=(0, 0, 1))
plotter.camera.zoom(1.35)
plotter.screenshot(folder / "halos_of_air.png")
plotter.enable_stereo_render()
plotter.render()
plotter.screenshot(folder / "halos_of_air_stereo.png")
