"""Compress and check
==================

Compress a tractogram, measure the error of every point, save the result and open it again.

Run it as ``python examples/02_compress_and_check.py [FOLDER]``.
"""

import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import pvfiblets
from pvfiblets.synthetic import brain_streamlines

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
folder.mkdir(parents=True, exist_ok=True)
brain = brain_streamlines(5_000)
print(f"{len(brain):,} streamlines, {brain.n_points:,} points, {brain.points.nbytes / 1e6:.1f} MB as float32")

figure = Figure(figsize=(9, 5), layout="constrained")
axes = figure.subplots()
ways = {"default": {}, "looking ahead": {"effort": "high"}, "within 5 micrometres": {"max_error": 0.005}}
for name, options in ways.items():
    fiblets = pvfiblets.compress(brain, **options)
    error = pvfiblets.measure_error(brain, fiblets)
    print(f"{name:<20} error mean {1e3 * error.mean_mm:.2f} µm, greatest {1e3 * error.max_mm:.2f} µm")
    distances = 1e3 * np.linalg.norm(fiblets.decompress().points - brain.points, axis=1)
    label = f"{name}: {fiblets.nbytes / brain.n_points:.2f} bytes per point"
    axes.hist(distances, np.geomspace(0.1, 30, 80), histtype="step", linewidth=2, label=label)
axes.set(xscale="log", xlabel="error of a point, µm (steps are 500 µm)", ylabel="points")
axes.legend(frameon=False)
figure.savefig(folder / "errors.png", dpi=130)

fiblets.save(folder / "brain.fiblets")
again = pvfiblets.FibletSet.open(folder / "brain.fiblets")  # mapped, not read: takes no time
print(again.decompress([0, 1, 2]).lengths(), "mm")
