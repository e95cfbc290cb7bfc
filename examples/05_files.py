"""
Files
=====

Tractogram files with PyVista alone: read, save, convert.

Run it as ``python examples/05_files.py [FOLDER]``.
"""

import sys
from pathlib import Path

import pyvista as pv

import pvfiblets
from pvfiblets.synthetic import brain_streamlines


def main(folder: Path) -> None:
    """Write one tractogram in every format, and compare the sizes."""
    lines = pv.wrap(brain_streamlines(500).to_polydata())
    for suffix in (".tck", ".trk", ".trx", ".vtp", ".fiblets"):
        path = folder / f"lines{suffix}"
        lines.save(path)
        again = pv.read(path)
        print(f"{path.name:<14} {path.stat().st_size:>9,} bytes, {again.n_lines} lines, {again.n_points:,} points")

    # From file to file, whatever its size, without ever holding it whole:
    result = pvfiblets.compress_file(folder / "lines.trk", folder / "from_trk.fiblets")
    print(f"{result['bytes_per_point']:.2f} bytes per point, greatest error {result['error_mm']['max']:.4f} mm")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
