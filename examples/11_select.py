"""Select
======

Pick the streamlines in an area of the image, grow the selection, draw it as tubes, and measure along it.

Run it as ``python examples/11_select.py [FOLDER]``. In a window, ``plotter.fiblets.enable_picking(mode="lasso")`` does
with the mouse what ``pick_box`` does here.
"""

import sys
from pathlib import Path

import matplotlib as mpl
import pyvista as pv

from pvfiblets.synthetic import brain_streamlines

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
folder.mkdir(parents=True, exist_ok=True)
mpl.use("Agg")
plotter = pv.Plotter(off_screen=True, window_size=(900, 700))
actor = plotter.add_fiblets(brain_streamlines(6_000, fa=True))
plotter.view_vector((-1, 0.3, 0.3), viewup=(0, 0, 1))
plotter.camera.zoom(1.4)
plotter.show(auto_close=False)

visible = actor.pick_box((430, 330, 470, 370))
everything = actor.pick_box((430, 330, 470, 370), through=True)
print(f"{len(visible.ids)} streamlines are visible in the box, {len(everything.ids)} lie under it")

actor.select(visible.ids)
actor.grow_selection(8.0)  # adds streamlines with ends within 8 mm of selected ends
actor.selection_style(color="gold", as_tubes=True, radius=0.8, dim=0.75)
print(actor.selection_statistics("fa"))
plotter.render()
plotter.screenshot(folder / "selection.png")
actor.selection_profile("fa").plot().figure.savefig(folder / "profile.png", dpi=100)
actor.save_selection(folder / "selection.trx")
