"""
Halos of air
============

Air currents in an office, as ink on paper: bundles, branches and depth.

Run it as ``python examples/18_halos_of_air.py [FOLDER]``. Pictures like figures 8 and 11 of Everts et al. 2009. The
flow is made up; streamlines are VTK's. The second picture is for red-cyan glasses, red on the left eye.
"""

import sys
from pathlib import Path

import numpy as np
import pyvista as pv

ROOM = (6000.0, 4000.0, 2800.0)  # mm
FURNITURE = [
    (1000, 2400, 600, 1500, 0, 750), (1200, 2600, 2500, 3400, 0, 750),
    (4600, 5600, 0, 500, 0, 2000), (3900, 5300, 2100, 3000, 0, 750),
]  # fmt: skip
STEP = 100.0  # mm of the grid
LAYER = 350.0  # mm from walls within which air slows down to nothing across them


def ramp(grid: pv.ImageData) -> np.ndarray:
    """0 at walls and inside the furniture, 1 from a layer's thickness on, smooth between."""
    distance = np.minimum(grid.points, ROOM - grid.points).min(axis=1)
    for box in np.array(FURNITURE, float):
        outside = np.maximum(np.maximum(box[::2] - grid.points, grid.points - box[1::2]), 0.0)
        distance = np.minimum(distance, np.linalg.norm(outside, axis=1))
    share = np.clip(distance / LAYER, 0.0, 1.0)
    return share * share * (3.0 - 2.0 * share)


def air(seed: int = 7) -> pv.ImageData:
    """Return a flow without sources: the curl of a potential that is the same all over the walls (curl noise)."""
    grid = pv.ImageData(dimensions=[int(side / STEP) + 1 for side in ROOM], spacing=[STEP] * 3)
    rng = np.random.default_rng(seed)
    potential = np.zeros((grid.n_points, 3))
    potential[:, 1] = 1.0  # the air conditioner turns the whole room, along the ceiling and back
    for _ in range(30):
        k = rng.normal(size=3) * 2.0 * np.pi / rng.uniform(2500.0, 6000.0)
        phase = grid.points @ k + rng.uniform(0.0, 2.0 * np.pi)
        potential += 0.12 * rng.normal(size=3) * np.sin(phase)[:, None]
    grid["potential"] = potential * ramp(grid)[:, None]
    flow = grid.compute_derivative("potential", vorticity=True, gradient=False)
    grid["velocity"] = flow["vorticity"] * 1e3
    return grid


def streams(flow: pv.ImageData, rakes: int = 56, each: int = 14, seed: int = 2) -> pv.PolyData:
    """Follow the air from short rakes."""
    rng = np.random.default_rng(seed)
    middle = rng.uniform(0.1, 0.9, (rakes, 1, 3)) * ROOM
    along = rng.normal(0.0, 120.0, (rakes, 1, 3)) * np.linspace(-1.0, 1.0, each)[:, None]
    seeds = pv.PolyData((middle + along).reshape(-1, 3))
    # Forward only: both ways are two lines, which would narrow where they meet.
    way = {"integration_direction": "forward", "max_length": 8_000.0, "terminal_speed": 1e-3}
    return flow.streamlines_from_source(seeds, vectors="velocity", integrator_type=4, initial_step_length=0.3, **way)


def main(folder: Path) -> None:
    """Write a picture of the air among the furniture, and the same in stereo."""
    folder.mkdir(parents=True, exist_ok=True)
    lines = streams(air())
    print(f"{lines.n_lines:,} streamlines of {lines.n_points:,} vertices")
    plotter = pv.Plotter(off_screen=True, window_size=(1400, 850))
    plotter.set_background("white")
    plotter.add_halo_lines(lines, color="black")  # not the speed of the air, which its lines carry
    for box in FURNITURE:
        plotter.add_mesh(pv.Box(box), color="white", lighting=False)
    edges = pv.merge([pv.Box(np.add(box, (-10, 10, -10, 10, 0, 10))).extract_feature_edges() for box in FURNITURE])
    plotter.add_halo_lines(edges, line_width=14.0, max_displacement=200.0, tapering=False)
    plotter.view_vector((-0.35, -1.0, 0.55), viewup=(0, 0, 1))
    plotter.camera.zoom(1.4)
    plotter.screenshot(folder / "halos_of_air.png")
    plotter.enable_stereo_render()
    plotter.render()
    plotter.screenshot(folder / "halos_of_air_stereo.png")
    plotter.close()


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
