"""Depth of field
==============

The focus is sharp, the rest is blurred and optionally darker. Gamma brightens dark parts.

Run it as ``python examples/21_depth_of_field.py [FOLDER]``. ``plotter.picture`` changes the whole frame, except texts.
"""

import sys
from pathlib import Path

import pyvista as pv

from pvfiblets.synthetic import brain_streamlines
from pvfiblets.synthetic.vessels import vessel_tree

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
folder.mkdir(parents=True, exist_ok=True)
volume, tracts = vessel_tree(144), brain_streamlines(1_500)
plotter = pv.Plotter(off_screen=True, window_size=(1300, 1040), shape=(2, 2), border=False)
plotter.set_background("black", all_renderers=True)
near, far = {"focal_distance": 145, "aperture": 14}, {"focal_distance": 225, "aperture": 14, "darkening": 0.8}
middle = {"focal_distance": "center", "aperture": 9}  # with "cursor" the mouse chooses
titles = "focus at 145 mm", "at 225 mm, the rest darkened", "no effect", "focus on the middle, and gamma 1.25"
for index, (title, effect) in enumerate(zip(titles, (near, far, None, middle), strict=True)):
    plotter.subplot(*divmod(index, 2))
    plotter.add_text(title, position=(15, 488), font_size=13, color="white")
    if index < 2:
        plotter.add_raycast_volume(volume, mode="isosurface", values=90, smooth=0.5, color="#f2907c")
        for x, y in ((18, -55), (45, -15), (74, 25), (104, 65)):  # 145, 185, 225 and 265 mm away
            plotter.add_mesh(pv.Sphere(radius=6, center=(x, y, -22)), color="gold", smooth_shading=True)
        plotter.camera_position = [(0, -200, 20), (0, 0, 8), (0, 0, 1)]
    else:
        plotter.add_fiblets(tracts).tube_radius = 0.5
        plotter.camera_position = [(-150, -100, 85), (0, -15, 12), (0, 0, 1)]
    plotter.camera.view_angle = 40
    plotter.picture.depth_of_field = effect
plotter.picture.gamma = 1.25
plotter.screenshot(folder / "depth_of_field.png")
