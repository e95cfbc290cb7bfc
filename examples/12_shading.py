"""
Shading
=======

Shade lines: by the scene's lights, as illuminated lines, with ambient occlusion, depth cueing, halos; as tubes.

Run it as ``python examples/12_shading.py [FOLDER]``. Each of these is off, and costs nothing, until it is set.
"""

import sys
from pathlib import Path

import pyvista as pv

import pvfiblets
from pvfiblets.synthetic import brain_streamlines


def main(folder: Path) -> None:
    """Write one picture of six ways to shade."""
    folder.mkdir(parents=True, exist_ok=True)
    fiblets = pvfiblets.compress(brain_streamlines(6_000))
    plotter = pv.Plotter(off_screen=True, window_size=(1350, 800), shape=(2, 3), border=False)
    for index in range(6):
        plotter.subplot(index // 3, index % 3)
        actor = plotter.add_fiblets(fiblets, color="lightskyblue" if index in (1, 2) else None)
        if index == 0:
            title = "the scene's lights"
        elif index == 1:
            title = "illuminated lines"
            actor.illuminated = True
        elif index == 2:
            title = "ambient occlusion"
            actor.ambient_occlusion = True
        elif index == 3:
            title = "depth cueing and halos"
            actor.depth_cue = True
            actor.halos = True
        elif index == 4:
            title = "style = 'halo'"
            actor.style = "halo"
        else:
            title = "lines of 4 pixels, shaded as tubes"
            actor.subset(0.25)
            actor.line_width = 4
            actor.tube_shading = True
        plotter.add_text(title, position=(12, 370), font_size=11, color="black")
        plotter.view_vector((-1, -0.4, 0.4), viewup=(0, 0, 1))
        plotter.camera.zoom(1.45)
    plotter.show(auto_close=False)
    plotter.screenshot(folder / "shading.png")
    for actor in plotter.fiblets:
        print(actor.explain()["features"])
    plotter.close()


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
