"""All kernels that tell streamlines of painted regions are compiled beforehand."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

import pvfiblets
from pvfiblets.query.painting import kernels

SCRIPT = """
import numpy as np
import pvfiblets
from pvfiblets import regions
from pvfiblets.query.painting import coarse_kernels, fill_kernels, index_kernels, kernels, walk_kernels
from pvfiblets.synthetic import brain_streamlines

def compiled():
    modules = coarse_kernels, fill_kernels, index_kernels, walk_kernels
    found = {(m.__name__, name): kernel for m in modules for name, kernel in vars(m).items()}
    found = {name: getattr(kernel, "_threaded", kernel) for name, kernel in found.items()}
    return {name: set(kernel.signatures) for name, kernel in found.items() if hasattr(kernel, "signatures")}

kernels.compile_all()
before = compiled()
assert any(before.values())
grid = (180, 200, 160), np.array([[1, 0, 0, -90], [0, 1, 0, -100], [0, 0, 1, -80], [0, 0, 0, 1.0]])
made = pvfiblets.compress(brain_streamlines(50, seed=1), exact=False)
made.save("plain.fiblets")
regions.index_of(made)
made.save("indexed.fiblets")
ordered = pvfiblets.compress(brain_streamlines(50, seed=1), exact=False, order="hilbert")
for data in (made, ordered, pvfiblets.FibletSet.open("plain.fiblets"), pvfiblets.FibletSet.open("indexed.fiblets")):
    painter = regions.RegionPainter(grid)
    painter.add("a")
    painter.add("b")
    live = regions.LiveRegions(data, painter)
    live.count("a")
    place = data.decompress().points[100]
    painter.paint("a", place, 10.0)
    painter.erase(place, 2.0)
    painter.paint("b", place, 3.0)
    live.select(include="a", ends_in="b", stays_in="a")
    live.select(in_order=["a", "b"])
    painter.undo()
    painter.fill("b", place)
assert compiled() == before
print("done")
"""


@pytest.mark.more
def test_strokes_compile_nothing_after_all_is_compiled(tmp_path):
    environment = {**os.environ, "PYTHONPATH": str(Path(pvfiblets.__file__).parents[1])}
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT], env=environment, cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == ["done"]
    assert kernels.are_compiled()  # that is known to others
