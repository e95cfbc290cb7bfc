"""
Tracts in their anatomy
=======================

A T1-weighted brain that is cut open, with its grey values on the faces of the cut, and the same brain as glass; fibre
tracts run through both, and each hides the other by depth.

Run it as ``python examples/23_tracts_in_their_anatomy.py [FOLDER] [T1]``. T1 is
the path of a brain without its skull in the space of MNI; by default the template of MNI that lies in the folder
``PVFIBLETS_DATA`` or in ``../shared/data``, and a made-up brain where there is none.
"""

import os
import sys
from pathlib import Path

import numpy as np
import pyvista as pv

from pvfiblets import Streamlines, regions
from pvfiblets.synthetic import brain_streamlines
from pvfiblets.synthetic.vessels import brain_like
from pvfiblets.volumes import RaycastVolume, as_raycast_volume

DATA = Path(os.environ.get("PVFIBLETS_DATA", Path(sys.argv[0]).resolve().parents[2] / "shared" / "data"))
TEMPLATE = DATA / "nv_MNI152_2009_template.nii.gz"
WINDOW = regions.Box((4, 120, -14, 160, 6, 120))  # the part cut out, mm: right, front and up
FACES = regions.Box((1.5, 120, -16.5, 160, 3.5, 120)) - WINDOW  # the layer behind the cut


def made_up_brain() -> RaycastVolume:
    """Return a brain of the size of the streamlines', without scalp and skull."""
    head = brain_like(144, noise=0.05)
    place = np.stack(np.meshgrid(*[np.linspace(-1.0, 1.0, n) for n in head.shape], indexing="ij"), axis=-1)
    within = np.linalg.norm(place * 100.0 / (74.0, 92.0, 72.0), axis=-1) < 0.86
    fluid = np.percentile(head.values[within], 2.0)
    values = np.clip(head.values.astype(float) - fluid, 0.0, None) * within
    affine = np.diag([1.16, 1.16, 1.16, 1.0]) @ head.affine
    affine[:3, 3] += (0.0, -19.0, 2.0)
    return RaycastVolume(values.astype(np.float32), affine)


def draw_cut(plotter: pv.Plotter, brain: RaycastVolume, tracts: Streamlines) -> None:
    """A surface in light and shade, its grey values where it is cut, and tracts where it is not."""
    white = float(np.percentile(brain.values[brain.values > 0], 80.0))
    hull = plotter.add_raycast_volume(
        brain, mode="isosurface", values=0.5 * white, color="#e3cfc0", smooth=0.7, show_scalar_bar=False
    )
    hull.prop.specular, hull.prop.specular_power = 0.15, 20
    hull.ray_occlusion = {"radius": 14.0, "samples": 40}
    hull.clip(WINDOW, inside=False)
    grey = {"cmap": "gray", "clim": (0.25 * white, 1.25 * white), "show_scalar_bar": False}
    faces = plotter.add_raycast_volume(brain, opacity=[0, 1, 1, 1], opacity_unit_distance=0.3, **grey)
    faces.clip(FACES)
    plotter.add_fiblets(tracts, line_width=1.5).clip(WINDOW)
    plotter.view_vector((1.0, 0.8, 0.75), viewup=(0, 0, 1))


def draw_glass(plotter: pv.Plotter, brain: RaycastVolume, tracts: Streamlines) -> None:
    """A thin glow where the brain begins, smoothed so that its folds do not flicker."""
    white = float(np.percentile(brain.values[brain.values > 0], 80.0))
    plotter.add_raycast_volume(
        brain,
        smooth=1.5,
        color="lightsteelblue",
        clim=(0.0, white),
        opacity=[0, 0, 0.015, 0.05, 0.018, 0, 0, 0],
        show_scalar_bar=False,
    )
    plotter.add_fiblets(tracts, line_width=1.2)
    plotter.view_vector((1.0, 0.8, 0.75), viewup=(0, 0, 1))


def main(folder: Path, source: Path | None) -> None:
    """Write one picture of both."""
    folder.mkdir(parents=True, exist_ok=True)
    brain = made_up_brain() if source is None else as_raycast_volume(source)
    streamlines = brain_streamlines(12_000)
    chosen = np.concatenate([streamlines.groups[name] for name in ("callosum", "corona", "cingulum", "arcuate")])
    tracts = streamlines[np.sort(chosen)]
    plotter = pv.Plotter(off_screen=True, window_size=(1500, 720), shape=(1, 2), border=False)
    plotter.set_background("black", all_renderers=True)
    for index, draw in enumerate((draw_cut, draw_glass)):
        plotter.subplot(0, index)
        draw(plotter, brain, tracts)
        plotter.camera.zoom(1.95)
    plotter.screenshot(folder / "tracts_in_their_anatomy.png")
    print(f"{len(tracts):,} streamlines in {brain.n_points:,} voxels")
    plotter.close()


if __name__ == "__main__":
    given = Path(sys.argv[2]) if len(sys.argv) > 2 else TEMPLATE if TEMPLATE.is_file() else None
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."), given)
