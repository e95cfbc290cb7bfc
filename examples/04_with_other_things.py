"""Among meshes
============

Streamlines with meshes: a translucent surface around them, and an opaque one inside.

Run it as ``python examples/04_with_other_things.py [FOLDER]``.
"""

import sys
from pathlib import Path

import pyvista as pv

from pvfiblets.synthetic import brain_streamlines

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
folder.mkdir(parents=True, exist_ok=True)
brain = brain_streamlines(20_000)
callosum = brain[brain.groups["callosum"]]
points = pv.PolyData(brain.points[::50])
glass = points.delaunay_3d().extract_surface(algorithm="dataset_surface").smooth(n_iter=100)
lesion = pv.Sphere(radius=9, center=(16, 34, 34))

plotter = pv.Plotter(off_screen=True, window_size=(1200, 900))
plotter.set_background("white")
plotter.enable_depth_peeling()
plotter.disable_anti_aliasing()  # VTK's depth peeling and multi-sampling do not go together everywhere
plotter.add_mesh(glass, color="lightsteelblue", opacity=0.25, smooth_shading=True)
plotter.add_mesh(lesion, color="gold", smooth_shading=True)
plotter.add_fiblets(callosum, line_width=1.5, label="corpus callosum")
plotter.view_vector((0.7, 1.0, 0.5), viewup=(0, 0, 1))
plotter.camera.zoom(1.4)
plotter.screenshot(folder / "with_other_things.png")
