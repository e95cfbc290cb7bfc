"""Cut
===

Cut a tractogram: by a plane, a box without a ball, a mesh with a hole, and a slab with an image in it.

Run it as ``python examples/09_cut.py [FOLDER]``. In a window, ``plotter.fiblets.add_clip_plane_widget()`` moves a cut.
"""

import sys
from pathlib import Path

import pyvista as pv

from pvfiblets import regions
from pvfiblets.synthetic import brain_streamlines
from pvfiblets.synthetic.vessels import brain_like

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
folder.mkdir(parents=True, exist_ok=True)
streamlines = brain_streamlines(10_000)
head = pv.wrap(brain_like(96).values)  # or pvfiblets.read_volume("t1.nii.gz")
head.spacing, head.origin = (2.0, 2.0, 1.9), (-95, -113, -81)
torus = pv.ParametricTorus(ringradius=45, crosssectionradius=20).translate((0, 0, 15))
box = regions.Box((-60, 60, -75, 20, -20, 70)) - regions.Sphere((0, -75, 50), 50)
cuts = {"a plane": ((-1, 0, 0), (0, 0, 0)), "a box without a ball": box, "a torus": torus}
plotter = pv.Plotter(off_screen=True, window_size=(1000, 800), shape=(2, 2))
plotter.set_background("black", all_renderers=True)
for index, title in enumerate([*cuts, "a slab, with a slice of an image"]):
    plotter.subplot(*divmod(index, 2))
    actor = plotter.add_fiblets(streamlines)
    if title in cuts:
        actor.clip(cuts[title])
    plotter.add_text(title, position=(12, 370), font_size=11, color="white")
    plotter.view_vector((1, -1.6, 0.8), viewup=(0, 0, 1), bounds=torus.bounds if index == 2 else None)
    plotter.camera.zoom(1.45)
plotter.fiblets.add_slab(actor, "y", origin=-18, thickness=6, volume=head, cmap="gray", show_scalar_bar=False)
plotter.screenshot(folder / "cut.png")
