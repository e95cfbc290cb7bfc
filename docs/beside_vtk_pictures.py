"""Makes docs/pictures/beside_vtk.jpg, four scenes as add_mesh draws them and as this package does, by their defaults.

``python docs/beside_vtk_pictures.py``. The data come from the folder that ``PVFIBLETS_DATA`` names, or of
``../shared/data``: a bundle, a whole brain, the flow in a carotid artery; the vessel tree is synthetic.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pyvista as pv
from PIL import Image

import pvfiblets
from pvfiblets.streamlines import Streamlines
from pvfiblets.synthetic.vessels import vessel_lines

HERE = Path(__file__).resolve().parent
DATA = Path(os.environ.get("PVFIBLETS_DATA", HERE.parents[1] / "shared" / "data"))
SIZE = (400, 320)
GROUNDS = ("black", "white")


def by_direction(streamlines: Streamlines) -> pv.PolyData:
    """Return lines with the colour of the direction at every point, as users make it for add_mesh."""
    mesh = streamlines.to_polydata()
    ahead = np.diff(streamlines.points, axis=0, append=streamlines.points[-1:])
    last = streamlines.offsets[1:][streamlines.counts > 1] - 1
    ahead[last] = ahead[last - 1]
    size = np.linalg.norm(ahead, axis=1, keepdims=True)
    mesh.clear_data()
    mesh["direction"] = (255 * np.abs(ahead) / np.maximum(size, 1e-12)).astype(np.uint8)
    return mesh


def tracts(name: str) -> tuple[Callable[[Any], Any], Callable[[Any], Any]]:
    """Return what adds a tractogram to a plotter: by add_mesh, and by add_fiblets."""
    streamlines = pvfiblets.read(DATA / name)
    mesh, fiblets = by_direction(streamlines), pvfiblets.compress(streamlines)
    return lambda p: p.add_mesh(mesh, scalars="direction", rgb=True), lambda p: p.add_fiblets(fiblets)


def flow() -> tuple[Callable[[Any], Any], Callable[[Any], Any]]:
    """Return what adds streamlines of a flow, coloured by speed."""
    grid = pv.read(DATA / "vtk_carotid.vtk")
    fastest = grid.points[np.linalg.norm(grid["vectors"], axis=1).argmax()]
    lines = grid.streamlines(
        "vectors", n_points=150, source_radius=8.0, source_center=tuple(fastest), max_length=300.0, max_step_length=0.5
    )
    lines["speed"] = np.linalg.norm(lines["vectors"], axis=1)
    more = {"scalars": "speed", "cmap": "viridis", "show_scalar_bar": False}
    return lambda p: p.add_mesh(lines, **more), lambda p: p.add_fiblets(lines, **more)


def vessels() -> tuple[Callable[[Any], Any], Callable[[Any], Any]]:
    """Return what adds a tree of vessels, by radius: a mesh of VTK's tube filter, and spline tubes."""
    tree = vessel_lines()
    mesh = tree.tube(scalars="radius", absolute=True)
    more = {"scalars": "radius", "cmap": "autumn_r", "log_scale": True, "show_scalar_bar": False}
    return lambda p: p.add_mesh(mesh, **more), lambda p: p.add_spline_tubes(tree, **more)


def tile(add: Callable[[Any], Any], ground: str, view: str) -> np.ndarray:
    """Draw one scene with one of both."""
    plotter = pv.Plotter(off_screen=True, window_size=SIZE)
    plotter.set_background(ground)
    add(plotter)
    getattr(plotter, view)()
    plotter.camera.zoom(1.35)
    picture: np.ndarray = plotter.screenshot(None)
    plotter.close()
    return picture


def main() -> None:
    """Draw all, and write them as one picture: a row a scene and ground, add_mesh at the left."""
    scenes = [
        (tracts("nv_tract.IFOF_R.trk"), "view_yz"), (tracts("wholebrain_eudx_0.5mm_fifth.tck"), "view_yz"),
        (flow(), "view_xz"), (vessels(), "view_xz"),
    ]  # fmt: skip
    rows = [
        np.concatenate([tile(add, ground, view) for ground in GROUNDS for add in both], axis=1) for both, view in scenes
    ]
    Image.fromarray(np.concatenate(rows)).save(HERE / "pictures" / "beside_vtk.jpg", quality=88, optimize=True)


if __name__ == "__main__":
    main()
