"""
Selected tracts
===============

Selected streamlines as smooth tubes among compressed ones, and a few tubes with a radius and values of their own.

Run it as ``python examples/15_selected_tracts.py [FOLDER]``.
"""

import sys
from itertools import pairwise
from pathlib import Path

import numpy as np
import pyvista as pv

import pvfiblets
from pvfiblets.synthetic import brain_streamlines

EVERY = 10  # points from node to node: splines need few


def nodes_of(streamlines: pvfiblets.Streamlines) -> tuple[list[np.ndarray], list[np.ndarray]]:
    """Return some points of each streamline, and the mean FA around each of them."""
    lines, values = [], []
    for start, stop in pairwise(streamlines.offsets):
        fa = np.pad(streamlines.per_point["fa"][start:stop], EVERY, mode="edge")
        smooth = np.convolve(fa, np.full(2 * EVERY + 1, 1.0 / (2 * EVERY + 1)), mode="valid")
        lines.append(streamlines.points[start:stop:EVERY])
        values.append(smooth[::EVERY])
    return lines, values


def main(folder: Path) -> None:
    """Write one picture of a selected bundle, and one of some tracts whose FA is their colour and their thickness."""
    folder.mkdir(parents=True, exist_ok=True)
    brain = brain_streamlines(5_000, fa=True)
    fiblets = pvfiblets.compress(brain)

    plotter = pv.Plotter(off_screen=True, window_size=(1350, 650), shape=(1, 2), border=False)
    plotter.set_background("black", all_renderers=True)
    actor = plotter.add_fiblets(fiblets)
    actor.select(brain.groups["arcuate"][::3], as_tubes=True, radius=0.9)  # colours, cuts and filters stay the actor's
    actor.selection_style(dim=0.75)
    plotter.view_vector((-1.0, 0.3, 0.4), viewup=(0, 0, 1))
    plotter.camera.zoom(1.5)

    plotter.subplot(0, 1)
    lines, fa = nodes_of(brain[brain.groups["callosum"][::20]])
    bar = {"title": "FA", "color": "white", "vertical": True, "position_x": 0.86, "position_y": 0.06, "height": 0.35}
    tubes = plotter.add_spline_tubes(
        lines,
        radius=[0.2 + 2.0 * values for values in fa],
        scalars=fa,
        cmap="viridis",
        scalar_bar_args=bar,
    )
    tubes.prop.specular, tubes.prop.specular_power = 0.4, 30
    tubes.ambient_occlusion = {"radius": 8.0}
    plotter.add_fiblets(fiblets, color="white", opacity=0.01)
    plotter.view_vector((0.6, 1.0, 0.6), viewup=(0, 0, 1))
    plotter.camera.zoom(1.5)
    plotter.scalar_bars["FA"].SetVerticalTitleSeparation(12)  # off the first number
    plotter.screenshot(folder / "selected_tracts.png")
    plotter.close()


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
