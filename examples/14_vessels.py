"""Vessels
=======

A tree of vessels as spline tubes: coloured by radius, cut by a plane, and from inside.

Run it as ``python examples/14_vessels.py [FOLDER]``. Centre lines of VMTK, with their radii, take the same calls.
"""

import sys
from pathlib import Path

import pyvista as pv

from pvfiblets.synthetic.vessels import vessel_lines

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
folder.mkdir(parents=True, exist_ok=True)
tree = vessel_lines()  # branches share their nodes; the point data "radius" are mm
plotter = pv.Plotter(off_screen=True, window_size=(1350, 900), shape="1|2", splitting_position=0.67, border=False)
plotter.set_background("black", all_renderers=True)
colours = {"scalars": "radius", "cmap": "autumn_r", "log_scale": True}
bar = {"title": "radius (mm)", "color": "white", "vertical": True, "position_x": 0.05, "height": 0.3}
actor = plotter.add_spline_tubes(tree, **colours, scalar_bar_args=bar)
actor.prop.specular, actor.ambient_occlusion = 0.4, {"radius": 10.0}
plotter.view_vector((0.25, -1.0, 0.12), viewup=(0, 0, 1))
plotter.camera.zoom(1.4)
plotter.subplot(1)
actor = plotter.add_spline_tubes(tree, **colours, show_scalar_bar=False)
actor.mapper.AddClippingPlane(pv.generate_plane((0, 1, -0.3), (0, 0, 0)))  # the normal points to the visible part
plotter.view_vector((0.25, -1.0, 0.12), viewup=(0, 0, 1))
plotter.camera.zoom(5)
plotter.subplot(2)
rings = {"scalars": "arc_length", "cmap": ["#8c1a1a", "#e8695a"] * 10, "lighting": False, "show_scalar_bar": False}
plotter.add_spline_tubes(tree, **rings).depth_cue = {"color": "black", "range": (5, 70)}
middle = tree.get_cell(0).points
plotter.camera_position = [middle[1], middle[4], (0, 1, 0)]
plotter.camera.view_angle, plotter.camera.clipping_range = 85, (0.2, 500)
plotter.scalar_bars["radius (mm)"].SetVerticalTitleSeparation(12)  # off the first number
plotter.screenshot(folder / "vessels.png")
