"""
Density
=======

What streamlines add up to in voxels: light where they are many, their mean directions, the mean of a number; and a
NIfTI file for other programs.

Run it as ``python examples/25_density.py [FOLDER]``.
"""

import sys
from pathlib import Path

import nibabel as nib
import numpy as np
import pyvista as pv

import pvfiblets
from pvfiblets.synthetic import brain_streamlines

VOXEL = 1.5  # mm


def main(folder: Path) -> None:
    """Write three maps as one picture, and one of them as a file."""
    folder.mkdir(parents=True, exist_ok=True)
    fiblets = pvfiblets.compress(brain_streamlines(20_000, seed=2, fa=True), per_point=["fa"])
    counts = fiblets.density(VOXEL)
    directions = fiblets.density(like=counts, contrast="direction")
    means = fiblets.density(like=counts, contrast="fa")
    print(counts, f"at most {counts.values.max()} streamlines in a voxel")

    counts.save(folder / "counts.nii.gz")
    stored = nib.load(folder / "counts.nii.gz")
    print(f"{stored.shape} voxels of {stored.header.get_zooms()} mm, {stored.get_data_dtype()}")

    plotter = pv.Plotter(off_screen=True, window_size=(1350, 450), shape=(1, 3), border=False)
    plotter.set_background("black", all_renderers=True)
    bar = {"color": "white", "n_labels": 2, "title_font_size": 16, "label_font_size": 14}

    # Light adds up along rays: dense parts shine.
    plotter.subplot(0, 0)
    top = float(np.percentile(counts.values[counts.values > 0], 98))
    plotter.add_raycast_volume(
        counts, cmap="inferno", clim=(0, top), opacity=[0, 0.06, 0.2, 0.5, 0.8], opacity_unit_distance=4 * VOXEL,
        scalar_bar_args={**bar, "title": "streamlines per voxel"},
    )  # fmt: skip

    # Directions as colours, dark where there are few.
    plotter.subplot(0, 1)
    image = directions.to_image()
    share = np.clip(counts.to_image()["count"] / top, 0.0, 1.0) ** 0.4
    image["rgb"] = (255 * image["direction"] * share[:, None]).astype(np.uint8)
    middle = np.array(image.center) + (0.0, -12.0, 0.0)
    plotter.add_mesh(image.slice("y", origin=middle), scalars="rgb", rgb=True, lighting=False)

    plotter.subplot(0, 2)
    image = means.to_image()
    image["fa"][image["fa"] == 0.0] = np.nan
    plotter.add_mesh(
        image.slice("y", origin=middle), cmap="viridis", nan_color="black", lighting=False,
        scalar_bar_args={**bar, "title": "mean of FA"},
    )  # fmt: skip

    for index in range(3):
        plotter.subplot(0, index)
        plotter.view_xz()
        plotter.camera.zoom(1.3)
    plotter.show(auto_close=False)
    plotter.screenshot(folder / "density.png")
    plotter.close()


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
