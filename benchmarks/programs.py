"""Milliseconds a frame of mrview and ParaView, and of PyVista's lines and fiblets, on the same lines.

::

    python benchmarks/programs.py --segments 1100000 6000000 --output programs.json

What counts is the processor time of all threads, which other work on the machine changes little. Each program runs with
few frames and with more; the difference is that of the frames. mrview writes a PNG for each.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

from common import PER_STREAMLINE, machine, on_machine, to_table

FEW, MORE, STEP = 2, 12, 0.1
SIZE = 1920, 1080

PARAVIEW = """
import os
import sys
from paraview.simple import *
lines = OpenDataFile(sys.argv[1])
view = CreateRenderView(ViewSize=[int(sys.argv[3]), int(sys.argv[4])])
Show(lines, view)
ResetCamera(view)
for _ in range(int(sys.argv[2])):
    view.GetActiveCamera().Azimuth(1.14)
    Render(view)
os._exit(0)  # it may abort at its end
"""
OURS = """
import sys
import pyvista as pv
import pvfiblets
plotter = pv.Plotter(off_screen=True, window_size=[int(sys.argv[3]), int(sys.argv[4])])
plotter.set_background("black")
if sys.argv[5] == "fiblets":
    plotter.add_fiblets(sys.argv[1], scalars="orientation", show_scalar_bar=False)
else:
    plotter.add_mesh(pv.read(sys.argv[1]), color="white", lighting=False)
plotter.show(auto_close=False)
for _ in range(int(sys.argv[2])):
    plotter.camera.azimuth += 1.14
    plotter.render()
    plotter.render_window.WaitForCompletion()
    plotter.render_window.GetPixelData(0, 0, 0, 0, 0, 0)
"""


def commands(folder: Path) -> dict[str, list[str]]:
    """Return each program's command, to which a number of frames is to be added."""
    size = ["-size", f"{SIZE[0]},{SIZE[1]}"]
    screen = ["xvfb-run", "-a", "-s", f"-screen 0 {SIZE[0]}x{SIZE[1]}x24"]
    tracks = ["-tractography.load", "a.tck", "-tractography.slab", "-1", "-tractography.geometry"]
    mrview = [*screen, "mrview", "image.nii", "-imagevisible", "false", *size, "-noannotations", *tracks]
    found = {
        "mrview, lines": [*mrview, "lines"],
        "mrview, pseudotubes": [*mrview, "pseudotubes"],
        "ParaView": [*screen, "pvpython", str(folder / "theirs.py"), "a.vtp"],
        "PyVista": [sys.executable, str(folder / "ours.py"), "a.vtp"],
        "fiblets": [sys.executable, str(folder / "ours.py"), "a.fiblets"],
    }
    return {name: one for name, one in found.items() if shutil.which(one[4] if one[0] == screen[0] else one[0])}


def frames_of(name: str, command: list[str], count: int) -> list[str]:
    """Return a command that draws so many frames."""
    if name.startswith("mrview"):
        return [*command, *["-capture.grab"] * count, "-exit"]
    kind = "fiblets" if name == "fiblets" else "lines"
    return [*command, str(count), *map(str, SIZE), kind]


def seconds(command: list[str], folder: Path) -> float:
    """Run a command and return its processor time."""
    drawn = os.environ | {"VTK_DEFAULT_OPENGL_WINDOW": "vtkEGLRenderWindow", "PVFIBLETS_ANTIALIAS": "off"}
    others = {name: value for name, value in os.environ.items() if not name.startswith(("VTK_", "PYTHON", "VIRTUAL_"))}
    environment = drawn if command[0] == sys.executable else others
    for last in (False, False, True):  # ParaView aborts now and then
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        done = subprocess.run(command, cwd=folder, env=environment, check=last, capture_output=True, timeout=1800)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        if not done.returncode:
            break
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def make(folder: Path, segments: int) -> int:
    """Write the same lines in each program's format; return their segments."""
    import nibabel as nib
    import numpy as np

    import pvfiblets
    from pvfiblets.synthetic import brain_streamlines

    lines = brain_streamlines(max(round(segments * STEP / PER_STREAMLINE), 1), step=STEP)
    for suffix in ("tck", "vtp", "fiblets"):
        pvfiblets.write(folder / f"a.{suffix}", lines)
    low, high = lines.points.min(0), lines.points.max(0)
    affine = np.diag([2.0, 2.0, 2.0, 1.0])
    affine[:3, 3] = low
    nib.save(nib.Nifti1Image(np.zeros(((high - low) / 2 + 1).astype(int), "f4"), affine), folder / "image.nii")
    (folder / "theirs.py").write_text(PARAVIEW)
    (folder / "ours.py").write_text(OURS)
    return lines.n_points - len(lines)


def main() -> None:
    """Measure, and print a table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--segments", type=int, nargs="+", default=[1_100_000, 6_000_000])
    parser.add_argument("--output", type=Path)
    options = parser.parse_args()
    rows: list[dict[str, Any]] = []
    for wanted in options.segments:
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            count = make(folder, wanted)
            for program, command in commands(folder).items():
                few, more = (seconds(frames_of(program, command, n), folder) for n in (FEW, MORE))
                rows.append({"segments": count, "program": program, "ms": 1000.0 * (more - few) / (MORE - FEW)})
                print(rows[-1], flush=True)
    facts = machine()
    if options.output:
        options.output.write_text(json.dumps({"about": facts, "rows": rows}, indent=1))
    print(on_machine(facts))
    lines = (f"| {row['segments']:,} | {row['program']} | {row['ms']:.0f} |" for row in rows)
    print("\n".join(to_table(("segments", "program", "ms"), lines)))


if __name__ == "__main__":
    main()
