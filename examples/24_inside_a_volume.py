"""Inside a volume
===============

A head with a part bitten out by a mesh, the vessels in a box, and a camera inside a vessel.

Run it as ``python examples/24_inside_a_volume.py [FOLDER]``.
"""

import sys
from pathlib import Path

import pyvista as pv

from pvfiblets import regions
from pvfiblets.synthetic.vessels import brain_like, vessel_lines, vessel_tree

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
folder.mkdir(parents=True, exist_ok=True)
head, tree, way = brain_like(192), vessel_tree(256), vessel_lines().get_cell(0).points
plotter = pv.Plotter(off_screen=True, window_size=(1350, 900), shape="1|2", splitting_position=0.67, border=False)
plotter.set_background("black", all_renderers=True)
surface = {"mode": "isosurface", "values": 90, "smooth": 0.8, "show_scalar_bar": False}
bite = pv.Sphere(radius=62, center=(45, 48, 42), theta_resolution=90, phi_resolution=90)
plotter.add_raycast_volume(head, **surface, color="#f0cdb2").clip(bite, inside=False)
grey = {"cmap": "gray", "clim": (0, 250), "opacity": [0, 0] + [1] * 30, "show_scalar_bar": False}
plotter.add_raycast_volume(head, **grey).clip(regions.Sphere((45, 48, 42), 63.5) - regions.Sphere((45, 48, 42), 61.9))
plotter.camera_position = [(235, 211, 188), (0, 0, 0), (0, 0, 1)]
plotter.subplot(1)
cube = pv.Cube(center=way[-3], x_length=48, y_length=48, z_length=48)
plotter.add_raycast_volume(tree, **surface, color="#ffc4b4").clip(cube.bounds)
plotter.add_mesh(cube, style="wireframe", color="gray")
plotter.camera_position = [way[-3] + (39, -129, 39), way[-3], (0, 0, 1)]
plotter.subplot(2)
plotter.add_raycast_volume(tree, **surface, color="#e8897a").depth_cue = {"color": "black", "range": (4, 45)}
plotter.camera_position = [way[8], way[10], (0, 1, 0)]
plotter.remove_all_lights(only_active=True)
plotter.add_light(pv.Light(position=way[8], positional=True, cone_angle=180), only_active=True)
plotter.camera.view_angle, plotter.camera.clipping_range = 60, (0.1, 300)
plotter.screenshot(folder / "inside_a_volume.png")
