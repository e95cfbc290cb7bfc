"""Files
=====

Tractogram files with PyVista alone: read, save, convert.

Run it as ``python examples/05_files.py [FOLDER]``.
"""

import sys
from pathlib import Path

import pyvista as pv
from matplotlib.figure import Figure

import pvfiblets
from pvfiblets.synthetic import brain_streamlines

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
folder.mkdir(parents=True, exist_ok=True)
sizes = {}
lines = pv.wrap(brain_streamlines(500).to_polydata())
lines.clear_data()  # points alone: some formats cannot hold bundles, and warn
for suffix in (".tck", ".trk", ".trx", ".vtp", ".fiblets"):
    path = folder / f"lines{suffix}"
    lines.save(path)
    again = pv.read(path)
    sizes[suffix] = path.stat().st_size / again.n_points
    print(f"{path.name:<14} {path.stat().st_size:>9,} bytes, {again.n_lines} lines, {again.n_points:,} points")

figure = Figure(figsize=(9, 3.5), layout="constrained")
axes = figure.subplots()
axes.bar_label(axes.barh(list(sizes)[::-1], list(sizes.values())[::-1], color="teal"), fmt="%.1f", padding=4)
axes.set_xlabel("bytes per point")
figure.savefig(folder / "sizes.png", dpi=130)

# From file to file, whatever its size, without ever holding it whole:
result = pvfiblets.compress_file(folder / "lines.trk", folder / "from_trk.fiblets")
print(f"{result['bytes_per_point']:.2f} bytes per point, greatest error {result['error_mm']['max']:.4f} mm")
