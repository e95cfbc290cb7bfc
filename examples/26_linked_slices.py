"""
Slices
======

Axial, coronal and sagittal panes and the 3-D view, linked by a cross-hair: a map of fibre density in grey, directions
in colour over it, and in each pane the streamlines of a slab about its slice.

Run it as ``python examples/26_linked_slices.py [FOLDER]``.
"""

import sys
from pathlib import Path

import numpy as np
import pyvista as pv

import pvfiblets
from pvfiblets.synthetic import brain_streamlines


def main(folder: Path) -> None:
    """Write a picture of the workspace."""
    fiblets = pvfiblets.compress(brain_streamlines(20_000, seed=2))
    counts = fiblets.density(2.0)
    directions = fiblets.density(like=counts, contrast="direction")

    plotter = pv.Plotter(off_screen=True, window_size=(1000, 1000), shape=(2, 2))
    plotter.set_background("black", all_renderers=True)
    workspace = plotter.slices.workspace(counts, thickness=4.0)
    top = workspace.slices.layers[0].clim[1]
    few = 0.15 * top  # nearly black, where it would hide lines of the 3-D view
    workspace.slices.layers[0].below = few
    workspace.slices.add(directions, kind="direction", modulate=counts, clim=(0.0, top), below=few, opacity=0.6)
    plotter.add_fiblets(fiblets, lighting=False)
    workspace.position = counts.affine[:3] @ (*(0.5 * np.array(counts.values.shape)), 1.0) + (8.0, -10.0, 4.0)
    workspace.add_contours(pv.Sphere(radius=25.0, center=workspace.position), "white")
    plotter.view_isometric()
    plotter.camera.zoom(1.4)

    found = workspace.values(radius=3.0)
    print(found.images, {name: len(ids) for name, ids in found.streamlines.items()})
    plotter.show(auto_close=False)
    plotter.screenshot(folder / "slices.png")
    plotter.close()


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
