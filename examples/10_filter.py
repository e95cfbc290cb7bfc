"""
Filter
======

Choose streamlines: by numbers, by regions they pass through or end in, by group, at random; and save the result.

Run it as ``python examples/10_filter.py [FOLDER]``.
"""

import sys
from pathlib import Path

import pyvista as pv

import pvfiblets
from pvfiblets import regions
from pvfiblets.synthetic import brain_streamlines


def main(folder: Path) -> None:
    """Write one picture of four choices, and a file of the last one."""
    folder.mkdir(parents=True, exist_ok=True)
    fiblets = pvfiblets.compress(brain_streamlines(8_000))
    ball = regions.Sphere((-20, -10, 25), 14)
    top = regions.Plane((0, 0, 1), (0, 0, 55))
    plotter = pv.Plotter(off_screen=True, window_size=(1000, 800), shape=(2, 2))
    for index in range(4):
        plotter.subplot(index // 2, index % 2)
        plotter.set_background("black")
        bar = {"color": "white", "vertical": True, "height": 0.8, "position_x": 0.89, "position_y": 0.05}
        actor = plotter.add_fiblets(fiblets, scalar_bar_args=bar)
        if index == 0:
            title = "length 60 to 90 mm, curvature below 0.06 / mm"
            actor.criterion("length", (60, 90))
            actor.criterion("curvature", (0, 0.06))  # a number per point: parts of streamlines go
        elif index == 1:
            title = "through the ball, not ending in it"
            actor.include(ball)
            actor.exclude(regions.ends_in(ball))
            plotter.add_mesh(pv.Sphere(radius=14, center=(-20, -10, 25)), color="white", opacity=0.3)
        elif index == 2:
            names = list(fiblets.groups)[:3]
            title = "groups " + ", ".join(names)
            actor.groups_shown = names
            actor.scalars = "group"
        else:
            title = "ends above and passes the ball, or one in fifty"
            chosen = actor.streamlines_where(regions.ends_in(top) & regions.passes(ball))
            chosen[::50] = True
            actor.show_only(chosen)
            fiblets[chosen].save(folder / "chosen.trk")
        plotter.add_text(title, position=(12, 370), font_size=10, color="white")
        plotter.view_vector((-1, -1.2, 0.6), viewup=(0, 0, 1))
        plotter.camera.zoom(1.4 if index == 2 else 1.55)
        plotter.camera.SetWindowCenter(0.2 if index == 2 else 0.0, 0.08)  # room for the legend and the title
        print(f"{title}: {actor.shown.sum():,} of {len(fiblets):,} streamlines")
    plotter.show(auto_close=False)
    plotter.screenshot(folder / "filter.png")
    plotter.close()
    print(pvfiblets.read(folder / "chosen.trk"))


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
