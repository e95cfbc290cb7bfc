"""Whether light through a brain takes about as long with neighbouring settings: opacities, unit distances, steps.

The default integrator chooses for each step of a ray how it is taken. A choice for the whole volume would show here as
a cliff: a unit distance or a step a little larger, and several times the time. Times are of the processor, all threads,
so that what runs beside hardly counts; each is the least of four frames, one after the other in one window.

    python benchmarks/volumes_neighbours.py brain.nii.gz
"""

from __future__ import annotations

import argparse
import itertools
import os
import time
from typing import Any

TABLES: tuple[Any, ...] = (
    "linear", "geom", "sigmoid", "foreground", [0, 0, 1], [0, 1], [0, 0.05], [0, 0, 0.1, 0.1, 1], [0, 0.5, 0, 0.5, 0],
    "sigmoid_20", "linear_r",
)  # fmt: skip
UNITS = (0.5, 0.9, 1.0, 1.1, 2.0, 5.0)
STEPS = (0.4, 0.5, 0.6, 0.7, 0.85, 1.0)


def frame_ms(plotter: Any, actor: Any) -> float:
    """Return the time of a frame that is drawn anew."""
    times = []
    for _ in range(4):
        plotter.camera.Azimuth(0.02)
        start = time.process_time()
        plotter.render()
        actor.explain()  # waits for its end
        times.append(1e3 * (time.process_time() - start))
    return min(times)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("image", help="a volume that add_raycast_volume takes")
    parser.add_argument("--size", type=int, nargs=2, default=(240, 180), metavar=("W", "H"))
    options = parser.parse_args()
    os.environ["PVFIBLETS_ANTIALIAS"] = "off"
    import pyvista as pv

    from pvfiblets.plotting.viewpoints import point_camera

    plotter = pv.Plotter(off_screen=True, window_size=list(options.size))
    plotter.disable_anti_aliasing()
    actor = plotter.add_raycast_volume(options.image, show_scalar_bar=False, interactive_quality=1.0)
    point_camera(plotter, "oblique")
    plotter.show(auto_close=False)
    steps, units = (", ".join(map(str, values)) for values in (STEPS, UNITS))
    print(f"| opacity | steps {steps} | unit distances {units} mm |")
    print("|---|---|---|")
    worst = 1.0
    for opacity in TABLES:
        actor.opacity, rows = opacity, []
        for name, values in (("step", STEPS), ("opacity_unit_distance", UNITS)):
            actor.step, actor.opacity_unit_distance = 0.5, 1.0
            row = []
            for value in values:
                setattr(actor, name, value)
                plotter.render()
                row.append(frame_ms(plotter, actor))
            rows.append(row)
            worst = max([worst, *(max(a / b, b / a) for a, b in itertools.pairwise(row))])
        print(f"| {opacity} | " + " | ".join(", ".join(f"{ms:.0f}" for ms in row) for row in rows) + " |", flush=True)
    print(f"\nNeighbours differ by {worst:.2f} times at the most; ms of the processor.")
    plotter.close()


if __name__ == "__main__":
    main()
