"""What ParaView reads of the files that pvfiblets writes."""

from __future__ import annotations

import json
import subprocess

import numpy as np
import pytest

import pvfiblets as pf
from pvfiblets.streamlines import Streamlines

from .rows import beside

LINES = [np.random.default_rng(k).normal(0, 20, (5 + k, 3)).astype("f4") for k in range(3)]
LOOK = """
import json, sys
from paraview.simple import OpenDataFile
source = OpenDataFile(sys.argv[1])
source.UpdatePipeline()
data = source.GetDataInformation()
arrays = {a.Name: [list(a.GetRange(k)) for k in range(a.GetNumberOfComponents())]
          for a in (source.PointData.values() if sys.argv[2] == "points" else source.CellData.values())}
print("FOUND" + json.dumps([data.GetNumberOfPoints(), data.GetNumberOfCells(), list(data.GetBounds()), arrays]))
"""


@beside("ParaView")
@pytest.mark.parametrize("suffix", [".vtk", ".vtp"])
def test_tractograms(tmp_path, suffix):
    """`.vtk` and `.vtp` files of ours: opens both, with arrays of points and of streamlines.

    Here: writes legacy 4.2, which all of today's readers take, and XML.
    """
    values = np.arange(18, dtype="f4")
    lines = Streamlines.from_list(LINES, per_point={"fa": values}, per_streamline={"w": np.array([3.0, 4.0, 5.0])})
    path = tmp_path / f"a{suffix}"
    pf.write(path, lines)
    (tmp_path / "look.py").write_text(LOOK)
    for of, wanted in (("points", {"fa": [[0.0, 17.0]]}), ("cells", {"w": [[3.0, 5.0]]})):
        told = subprocess.run(
            ["pvpython", str(tmp_path / "look.py"), str(path), of],
            capture_output=True,
            text=True,
            timeout=240,
            check=False,
        )
        points, cells, bounds, arrays = json.loads(told.stdout.partition("FOUND")[2] or pytest.fail(told.stderr))
        assert (points, cells) == (18, 3)
        assert wanted.items() <= arrays.items()
        np.testing.assert_allclose(np.reshape(bounds, (3, 2)).T, [lines.points.min(0), lines.points.max(0)], atol=1e-5)
