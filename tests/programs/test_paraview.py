"""What ParaView reads of the files that pvfiblets writes."""

from __future__ import annotations

import json
import subprocess

import numpy as np
import pytest

import pvfiblets as pf
from pvfiblets.cli.command import main
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


def opened(path, of):
    """Return numbers of points and of cells, bounds and ranges of arrays as ParaView has them."""
    script = path.with_name("look.py")
    script.write_text(LOOK)
    command = ["pvpython", str(script), str(path), of]
    told = subprocess.run(command, capture_output=True, text=True, timeout=240, check=False)
    return json.loads(told.stdout.partition("FOUND")[2] or pytest.fail(told.stderr))


@beside("ParaView")
@pytest.mark.parametrize("suffix", [".vtk", ".vtp"])
def test_tractograms(tmp_path, suffix):
    """`.vtk` and `.vtp` files of ours: opens both, with per-point and per-streamline arrays.

    Here: writes legacy 4.2, which all current readers accept, and XML.
    """
    values = np.arange(18, dtype="f4")
    lines = Streamlines.from_list(LINES, per_point={"fa": values}, per_streamline={"w": np.array([3.0, 4.0, 5.0])})
    path = tmp_path / f"a{suffix}"
    pf.write(path, lines)
    for of, wanted in (("points", {"fa": [[0.0, 17.0]]}), ("cells", {"w": [[3.0, 5.0]]})):
        points, cells, bounds, arrays = opened(path, of)
        assert (points, cells) == (18, 3)
        assert wanted.items() <= arrays.items()
        np.testing.assert_allclose(np.reshape(bounds, (3, 2)).T, [lines.points.min(0), lines.points.max(0)], atol=1e-5)


@beside("ParaView")
def test_density_maps(tmp_path):
    """density maps: has no reader of NIfTI without a plug-in; opens `.vti` with its direction of axes.

    Here: `density` writes `.vti` beside NIfTI and MIF.
    """
    pf.write(tmp_path / "a.tck", Streamlines.from_list(LINES))
    assert main(["density", str(tmp_path / "a.tck"), str(tmp_path / "a.vti"), "--voxel", "8", "--quiet"]) == 0
    points, _, bounds, arrays = opened(tmp_path / "a.vti", "points")
    image = pf.density(Streamlines.from_list(LINES), voxel_size=8.0)
    assert points == np.prod(image.values.shape)
    corners = np.array([[0, 0, 0], np.array(image.values.shape) - 1]) @ image.affine[:3, :3].T + image.affine[:3, 3]
    np.testing.assert_allclose(np.reshape(bounds, (3, 2)).T, corners, atol=1e-4)
    assert [[0.0, float(image.values.max())]] in arrays.values()
