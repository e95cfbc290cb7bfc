"""Change settings live
====================

Change an actor's properties at any time; the next render shows them.

Run it as ``python examples/06_change_it_live.py [FOLDER]``.
"""

import sys
from pathlib import Path

import pyvista as pv

from pvfiblets.synthetic import brain_streamlines

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
folder.mkdir(parents=True, exist_ok=True)
plotter = pv.Plotter(off_screen=True, window_size=(1000, 800))
plotter.set_background("black")
bar = {"color": "white", "vertical": True, "position_x": 0.86, "position_y": 0.25, "height": 0.5}
actor = plotter.add_fiblets(brain_streamlines(8_000), name="brain", scalar_bar_args=bar)
plotter.view_vector((0, 0, 1), viewup=(0, 1, 0))
plotter.camera.zoom(1.4)
plotter.screenshot(folder / "live_1_orientation.png")
actor.scalars, actor.cmap, actor.clim = "curvature", "inferno", (0.0, 0.2)
plotter.scalar_bars["curvature [1/mm]"].SetVerticalTitleSeparation(12)  # off the first number
plotter.render()
plotter.screenshot(folder / "live_2_curvature.png")

actor.color, actor.line_width = "gold", 3
actor.tube_shading = actor.ambient_occlusion = True
actor.subset(0.4)
plotter.render()
plotter.screenshot(folder / "live_3_gold.png")

report = actor.explain()
print("active:", ", ".join(report["features"]))
print(*(f"  {item['name']:<12} {item['ms']:8.2f} ms" for item in report["passes"]), sep="\n")
print(f"  {report['gpu_bytes'] / 1e6:.1f} MB on the GPU")
