"""An angiogram
============

Vessels in a volume: as a surface, by the greatest and by the first peak on each ray, and as light through a medium.

Run it as ``python examples/22_angiogram.py [FOLDER]``. Images like figures 5 and 6 of Lesar 2015.
"""

import sys
from pathlib import Path

import pyvista as pv

from pvfiblets.synthetic.vessels import vessel_tree

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
folder.mkdir(parents=True, exist_ok=True)
light = [0, 0.02, 0.2, 0.7, 0.95, 1, 1]  # thin parts nearly vanish, bright parts are solid
ways = {
    "surface": {"mode": "isosurface", "values": 70, "color": "#f2907c"},
    "greatest value": {"mode": "mip", "cmap": "gray", "opacity": 1.0},
    "first peak of 60 or more": {"mode": "local-mip", "peak": 60, "cmap": "gray", "opacity": 1.0},
    "light": {"mode": "composite", "cmap": "hot", "opacity": light, "opacity_unit_distance": 2.0},
}
volume = vessel_tree(192, noise=0.04)  # the path of a NIfTI, NRRD or MetaImage file would do as well
plotter = pv.Plotter(off_screen=True, window_size=(1240, 1320), shape=(2, 2), border=False)
plotter.set_background("black", all_renderers=True)
for index, (title, way) in enumerate(ways.items()):
    plotter.subplot(*divmod(index, 2))
    plotter.picture.antialias = 4  # samples a pixel instead of 16: each takes seconds without a graphics card
    actor = plotter.add_raycast_volume(volume, clim=(20, 255), show_scalar_bar=False, **way)
    if actor.mode == "isosurface":
        actor.ray_occlusion = {"radius": 12.0, "samples": 24}
    elif actor.mode != "composite":  # fading shows which of two peaks is nearer
        actor.depth_cue = {"color": "black", "strength": 0.6}
    plotter.add_text(title, font_size=18, color="white", position=(20, 10))
    plotter.camera_position = [(108.0, -302.0, 32.0), (3.0, 0.0, -14.0), (0, 0, 1)]
plotter.screenshot(folder / "angiogram.png")
