"""
Depth of field
==============

Lead the eye with a lens: the focus is sharp, the rest is blurred and optionally darker. Tone mapping brightens dark
parts.

Run it as ``python examples/21_depth_of_field.py [FOLDER]``. ``plotter.picture`` changes all that a renderer shows,
whatever drew it: here vessels in a volume, balls of VTK's, and fiblets as tubes. Texts stay as they are.
"""

import sys
from pathlib import Path

import numpy as np
import pyvista as pv

from pvfiblets.synthetic import brain_streamlines
from pvfiblets.synthetic.vessels import vessel_tree

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
folder.mkdir(parents=True, exist_ok=True)
volume, brain = vessel_tree(144), brain_streamlines(2_500)
chosen = [brain.groups[name] for name in ("callosum", "cingulum", "arcuate", "corona")]
tracts = brain[np.sort(np.concatenate(chosen))]
plotter = pv.Plotter(off_screen=True, window_size=(1300, 1040), shape=(2, 2), border=False)
plotter.set_background("black", all_renderers=True)
title = {"position": (15, 488), "font_size": 13, "color": "white"}
for column in (0, 1):
    plotter.subplot(0, column)
    surface = {"mode": "isosurface", "values": 90, "smooth": 0.5, "show_scalar_bar": False}
    plotter.add_raycast_volume(volume, **surface, color="#f2907c").prop.specular = 0.3
    for x, y in ((18, -55), (45, -15), (74, 25), (104, 65)):  # 145, 185, 225 and 265 mm away
        plotter.add_mesh(pv.Sphere(radius=6, center=(x, y, -22)), color="gold", smooth_shading=True)
    plotter.camera_position = [(0, -200, 20), (0, 0, 8), (0, 0, 1)]
    plotter.camera.view_angle = 40
    plotter.subplot(1, column)
    plotter.add_fiblets(tracts).tube_radius = 0.5
    plotter.camera_position = [(-150, -100, 85), (0, -15, 12), (0, 0, 1)]
    plotter.camera.view_angle = 38
plotter.add_text("focus on the middle, and gamma 1.25", **title)
plotter.picture.depth_of_field = {"focal_distance": "center", "aperture": 9}  # with "cursor" the mouse chooses
plotter.picture.gamma = 1.25

plotter.subplot(1, 0)
plotter.add_text("as it is drawn", **title)
plotter.subplot(0, 0)
plotter.picture.depth_of_field = {"focal_distance": 145, "aperture": 14}
plotter.add_text("focus at 145 mm", **title)
plotter.subplot(0, 1)
plotter.picture.depth_of_field = {"focal_distance": 225, "aperture": 14, "darkening": 0.8}
plotter.picture.tone = {"operator": "reinhard", "exposure": 1.8}
plotter.add_text("at 225 mm, the rest darkened, and brighter tones", **title)
plotter.screenshot(folder / "depth_of_field.png")
