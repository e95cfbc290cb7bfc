"""
Cut
===

Cut a tractogram: by a plane, a box without a ball, a mesh with a hole, and a slab with the anatomy in it.

Run it as ``python examples/09_cut.py [FOLDER]``. In a window, ``plotter.fiblets.add_clip_plane_widget()`` and its
kin let you drag the same cuts.
"""

import sys
from pathlib import Path

import numpy as np
import pyvista as pv

from pvfiblets import regions
from pvfiblets.synthetic import brain_streamlines


def anatomy() -> pv.ImageData:
    """Return a made-up volume: something round that is brighter inside."""
    image = pv.ImageData(dimensions=(80, 96, 80), spacing=(2.0, 2.0, 2.0), origin=(-79.0, -95.0, -70.0))
    x, y, z = image.points.T
    radius = np.sqrt((x / 70) ** 2 + (y / 85) ** 2 + ((z - 10) / 62) ** 2)
    texture = np.cos(0.4 * x) * np.cos(0.3 * y) * np.cos(0.35 * z) * (radius < 1)
    image["T1"] = np.clip(1.2 - radius, 0.0, 1.0) + 0.1 * texture
    return image


def main(folder: Path) -> None:
    """Write one picture of four cuts."""
    folder.mkdir(parents=True, exist_ok=True)
    plotter = pv.Plotter(off_screen=True, window_size=(1000, 800), shape=(2, 2))
    streamlines = brain_streamlines(10_000)
    torus = pv.ParametricTorus(ringradius=45, crosssectionradius=20).translate((0, 0, 15))
    for index, title in enumerate(("a plane", "a box without a ball", "a torus", "a slab, with a volume's slice")):
        plotter.subplot(index // 2, index % 2)
        plotter.set_background("black")
        actor = plotter.add_fiblets(streamlines)
        if index == 0:
            actor.clip(((-1, 0, 0), (0, 0, 0)))
        elif index == 1:
            actor.clip(regions.Box((-60, 60, -75, 20, -20, 70)) - regions.Sphere((0, -75, 50), 50))
        elif index == 2:
            actor.clip(torus)
            plotter.add_mesh(torus, color="white", opacity=0.08)
        else:
            slab = plotter.fiblets.add_slab(actor, "y", origin=(0, -15, 0), thickness=6, volume=anatomy())
            slab.position = -18.0  # it may move at any time
        plotter.add_text(title, position=(12, 368), font_size=11, color="white")
        plotter.view_vector((1, -1.6, 0.8), viewup=(0, 0, 1))
        plotter.camera.zoom(1.9 if index == 2 else 1.6)
        plotter.camera.SetWindowCenter(0.0, 0.08)  # room for the title
    plotter.show(auto_close=False)
    plotter.screenshot(folder / "cut.png")
    for actor in plotter.fiblets:
        report = actor.explain()
        print(report["clips"], f"{report['fiblets']['in_frustum']:,} of {report['fiblets']['total']:,} fiblets left")
    plotter.close()


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
