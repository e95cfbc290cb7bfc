"""
More colours
============

Colour by a volume sampled on the GPU, by a distance, by the coding error; and look through layers.

Run it as ``python examples/13_more_colours.py [FOLDER]``.
"""

import sys
from pathlib import Path

import numpy as np
import pyvista as pv

from pvfiblets import regions
from pvfiblets.synthetic import brain_streamlines


def main(folder: Path) -> None:
    """Write one picture of four ways to colour."""
    folder.mkdir(parents=True, exist_ok=True)
    streamlines = brain_streamlines(5_000)
    volume = pv.ImageData(dimensions=(80, 96, 80), spacing=(2.0, 2.0, 2.0), origin=(-79.0, -95.0, -70.0))
    x, y, z = volume.points.T
    volume["made-up FA"] = 0.5 + 0.4 * np.cos(x / 15) * np.cos(y / 18) * np.cos(z / 16)
    lesion = regions.Sphere((30, 10, 25), 12)
    bar = {"color": "white", "title_font_size": 14, "label_font_size": 12, "n_labels": 2}
    plotter = pv.Plotter(off_screen=True, window_size=(1000, 800), shape=(2, 2))
    titles = "a volume", "the distance from a ball", "the coding error", "four layers of lines, and a ball"
    for index, title in enumerate(titles):
        plotter.subplot(index // 2, index % 2)
        plotter.set_background("black")
        if index == 0:
            plotter.add_fiblets(streamlines, scalars=volume, cmap="viridis", scalar_bar_args=bar)
        elif index == 1:
            away = regions.Distance(lesion, per="point")
            plotter.add_fiblets(streamlines, scalars=away, cmap="inferno_r", clim=(0, 60), scalar_bar_args=bar)
        elif index == 2:
            plotter.add_fiblets(streamlines, scalars="coding_error", clim=(0, 0.008), scalar_bar_args=bar)
        else:
            plotter.add_fiblets(streamlines, opacity=0.25, transparency="layers", line_width=2)
            plotter.add_mesh(pv.Sphere(radius=12, center=(30, 10, 25)), color="white")
        plotter.add_text(title, position=(12, 368), font_size=11, color="white")
        plotter.view_vector((1, 0.9, 0.6), viewup=(0, 0, 1))
        plotter.camera.zoom(1.5)
    plotter.show(auto_close=False)
    plotter.screenshot(folder / "more_colours.png")
    plotter.close()


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
