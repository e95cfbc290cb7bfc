"""
Compress and check
==================

Compress a tractogram, look at what that costs, store it and open it again.

Run it as ``python examples/02_compress_and_check.py [FOLDER]``.
"""

import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import pvfiblets
from pvfiblets.synthetic import brain_streamlines


def main(folder: Path) -> None:
    """Print size and error of four ways to compress, and plot the errors of three."""
    folder.mkdir(parents=True, exist_ok=True)
    brain = brain_streamlines(5_000, fa=True)
    raw = brain.points.nbytes
    print(f"{len(brain):,} streamlines, {brain.n_points:,} points, {raw / 1e6:.1f} MB as float32")

    figure = Figure(figsize=(9, 5), layout="constrained")
    axes = figure.subplots()
    bins = np.geomspace(0.1, 30, 80)
    for what, options in {
        "as it comes": {},
        "looking ahead": {"effort": "high"},
        "within 5 micrometres": {"max_error": 0.005},
        "with FA in each point": {"per_point": ["fa"]},
    }.items():
        fiblets = pvfiblets.compress(brain, **options)
        error = pvfiblets.measure_error(brain, fiblets)
        print(
            f"{what:<22} {fiblets.nbytes / brain.n_points:5.2f} bytes per point, "
            f"error mean {1e3 * error.mean_mm:5.2f} µm, greatest {1e3 * error.max_mm:6.2f} µm"
        )
        if "per_point" not in options:  # numbers per point change no place
            off = 1e3 * np.linalg.norm(fiblets.decompress().points - brain.points, axis=1)
            label = f"{what}: {fiblets.nbytes / brain.n_points:.2f} bytes per point"
            axes.hist(off, bins, histtype="step", linewidth=2, weights=np.full(off.size, 100 / off.size), label=label)
    axes.set(xscale="log", xlabel="how far a point is from where it was, µm (steps are 500 µm)", ylabel="points, %")
    axes.legend(frameon=False)
    figure.savefig(folder / "errors.png", dpi=130)

    fiblets.save(folder / "brain.fiblets")
    again = pvfiblets.FibletSet.open(folder / "brain.fiblets")  # mapped, not read: takes no time
    first = again.decompress([0, 1, 2])
    print(f"the first three are {', '.join(f'{length:.0f}' for length in first.lengths())} mm long")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
