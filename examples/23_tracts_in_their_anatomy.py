"""Tracts in their anatomy
=======================

A T1-weighted brain, cut open, and the same brain as glass. Fibre tracts run through both.

Run it as ``python examples/23_tracts_in_their_anatomy.py [FOLDER] [T1]``: a file in MNI space, or a synthetic head.
"""

import sys
from pathlib import Path

import numpy as np
import pyvista as pv

from pvfiblets import regions
from pvfiblets.synthetic import brain_streamlines
from pvfiblets.synthetic.vessels import brain_like
from pvfiblets.volumes import as_raycast_volume

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
folder.mkdir(parents=True, exist_ok=True)
brain = as_raycast_volume(sys.argv[2]) if len(sys.argv) > 2 else brain_like(144)
white, window = float(np.percentile(brain.values[brain.values > 0], 80)), regions.Box((4, 120, -14, 160, 6, 120))
tracts = brain_streamlines(12_000)
tracts = tracts[np.concatenate([tracts.groups[name] for name in ("callosum", "corona", "cingulum", "arcuate")])]
plotter = pv.Plotter(off_screen=True, window_size=(1500, 720), shape=(1, 2), border=False, theme=pv.themes.DarkTheme())
surface = {"mode": "isosurface", "values": 0.5 * white, "color": "#e3cfc0", "smooth": 0.7, "ray_occlusion": True}
plotter.add_raycast_volume(brain, **surface, show_scalar_bar=False).clip(window, inside=False)
grey = {"cmap": "gray", "clim": (0.25 * white, 1.25 * white), "opacity": [0, 1, 1, 1], "show_scalar_bar": False}
plotter.add_raycast_volume(brain, **grey).clip(regions.Box((1.5, 120, -16.5, 160, 3.5, 120)) - window)
plotter.add_fiblets(tracts, line_width=1.5).clip(window)
plotter.subplot(0, 1)
glow = {"color": "lightsteelblue", "clim": (0.0, white), "opacity": [0, 0, 0.015, 0.05, 0.018, 0, 0, 0]}
plotter.add_raycast_volume(brain, **glow, smooth=1.5, show_scalar_bar=False)
plotter.add_fiblets(tracts, line_width=1.2)
plotter.link_views()
plotter.view_vector((1.0, 0.8, 0.75), viewup=(0, 0, 1))
plotter.camera.zoom(1.8)
plotter.screenshot(folder / "tracts_in_their_anatomy.png")
