"""
Halos of fibres
===============

Fibre tracts as ink on paper: bundles show as dark strands, and gaps where one passes behind another.

Run it as ``python examples/17_halos_of_fibres.py [FOLDER]``. Pictures like figures 1, 7 and 10 of Everts et al. 2009.
"""

import sys
from itertools import pairwise
from pathlib import Path

import pyvista as pv

from pvfiblets import Streamlines, regions
from pvfiblets.synthetic import brain_streamlines

SLICE = regions.Slab((1, 0, 0), (9, 0, 0), 3.0)  # sagittal, 9 mm to the right of the middle


def through(region: regions.Region, brain: Streamlines) -> Streamlines:
    """Return the streamlines with a point inside a region."""
    inside = region.contains(brain.points)
    return brain[[bool(inside[start:stop].any()) for start, stop in pairwise(brain.offsets)]]


def draw_chosen(folder: Path, chosen: Streamlines) -> None:
    """Draw what passes through the slice: the nearest in thick lines, the farthest in thin ones."""
    plotter = pv.Plotter(off_screen=True, window_size=(1200, 850))
    plotter.set_background("white")
    actor = plotter.add_halo_lines(chosen, width_cue=0.7)
    print(f"lines of {actor.line_width:.2f} mm in strips of {actor.strip_width:.2f} mm suit their distances")
    actor.line_width = 0.4  # thicker in a picture of this size
    plotter.view_vector((1.0, 0.35, 0.3), viewup=(0, 0, 1))
    plotter.camera.zoom(1.7)
    plotter.screenshot(folder / "halos_of_fibres.png")
    plotter.close()


def draw_filtered(folder: Path, brain: Streamlines) -> None:
    """Draw all, then only high FA, which shows the inside; at last in colours by direction."""
    plotter = pv.Plotter(off_screen=True, window_size=(1400, 900), shape=(2, 2), border=False)
    plotter.set_background("white", all_renderers=True)
    settings = {
        "all": {"threshold": None},
        "FA of 0.45 and more": {"threshold": 0.45},
        "FA of 0.62 and more": {"threshold": 0.62},
        "the same, by direction": {"threshold": 0.62, "scalars": "orientation"},
    }
    for index, (title, setting) in enumerate(settings.items()):
        plotter.subplot(*divmod(index, 2))
        plotter.add_halo_lines(brain, line_width=0.35, strip_width=1.4, filter_by="fa", **setting)
        plotter.view_vector((0.35, 1.0, 0.3), viewup=(0, 0, 1))
        plotter.camera.zoom(1.75)
        plotter.camera.SetWindowCenter(0.0, 0.08)  # room for the title
        plotter.add_text(title, position=(14, 416), font_size=11, color="white" if index == 3 else "black")
    plotter.set_background("black", all_renderers=False)
    plotter.screenshot(folder / "halos_filtered.png")
    plotter.close()


def main(folder: Path) -> None:
    """Write one picture of a region of interest, and one of three stages of filtering."""
    folder.mkdir(parents=True, exist_ok=True)
    brain = brain_streamlines(7_000, step=1.0, fa=True)
    chosen = through(SLICE, brain)
    print(f"{len(chosen):,} of {len(brain):,} streamlines pass through the slice")
    draw_chosen(folder, chosen)
    draw_filtered(folder, brain[: len(brain) * 2 // 3])


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
