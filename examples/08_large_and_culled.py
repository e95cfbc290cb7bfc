"""Large sets and culling
======================

Many lines: list the pipelines of this machine, count the culled fiblets, and check that culling changes no pixel.

Run it as ``python examples/08_large_and_culled.py [FOLDER]``.
"""

import sys
from pathlib import Path

import pyvista as pv

from pvfiblets.synthetic import brain

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
folder.mkdir(parents=True, exist_ok=True)
fiblets = brain(11_000, step=0.1)  # compressed as it is made: no file and no raw points
print(fiblets)
pictures = {}
for culling in ("two-phase", None):
    plotter = pv.Plotter(off_screen=True, window_size=(800, 600))
    plotter.set_background("black")
    actor = plotter.add_fiblets(fiblets, culling=culling)
    plotter.view_vector((-1, 0.8, 0.45), viewup=(0, 0, 1))
    plotter.camera.zoom(1.3)
    plotter.show(auto_close=False)
    if culling:
        print(plotter.fiblets.pipelines())
    for _ in range(3):
        plotter.camera.azimuth += 2.0
        plotter.render()
    counts = actor.explain()["fiblets"]
    print(f"culling={culling}: {counts['drawn']:,} of {counts['in_frustum']:,} fiblets in view drawn")
    pictures[culling] = plotter.screenshot(folder / "large.png", return_img=True)
    plotter.close()
different = int((pictures["two-phase"] != pictures[None]).any(axis=2).sum())
print(f"{different} pixels differ")
