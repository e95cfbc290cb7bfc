"""Tubes and halos take the objects that fiblets take, with their data by name."""

from __future__ import annotations

import nibabel as nib
import numpy as np
import pytest
import pyvista as pv

ADDS = ("add_spline_tubes", "add_halo_lines")


@pytest.fixture
def tractogram():
    random = np.random.default_rng(0)
    lines = [np.cumsum(random.random((n, 3)), axis=0).astype(np.float32) for n in (10, 20, 5)]
    fa = [random.random((len(line), 1)).astype(np.float32) for line in lines]
    return nib.streamlines.Tractogram(
        lines, data_per_point={"fa": fa}, data_per_streamline={"w": np.arange(3.0)[:, None]}, affine_to_rasmm=np.eye(4)
    )


def values_of(actor):
    drawn = actor.tubes if hasattr(actor, "tubes") else actor.lines
    held = drawn.values["fa"]
    return held.values if hasattr(held, "values") else held


@pytest.mark.parametrize("add", ADDS)
@pytest.mark.parametrize("kind", ["Tractogram", "TrkFile", "StatefulTractogram", "MultiBlock"])
def test_data_of_other_libraries_go_by_their_names(plotter, tractogram, add, kind, tmp_path):
    source = tractogram
    wanted = np.concatenate(tractogram.data_per_point["fa"])[:, 0]
    if kind == "TrkFile":
        nib.streamlines.save(tractogram, tmp_path / "lines.trk")
        source = nib.streamlines.load(tmp_path / "lines.trk")
    elif kind == "StatefulTractogram":
        dipy = pytest.importorskip("dipy.io.stateful_tractogram")
        image = nib.Nifti1Image(np.zeros((40, 40, 40), np.float32), np.eye(4))
        source = dipy.StatefulTractogram(
            tractogram.streamlines, image, dipy.Space.RASMM,
            data_per_point=tractogram.data_per_point, data_per_streamline=tractogram.data_per_streamline,
        )  # fmt: skip
    elif kind == "MultiBlock":
        source = pv.MultiBlock()
        for line, fa, w in zip(tractogram.streamlines, tractogram.data_per_point["fa"], range(3), strict=True):
            block = pv.PolyData(line, lines=[len(line), *range(len(line))])
            block.point_data["fa"], block.cell_data["w"] = fa[:, 0], [float(w)]
            source.append(block)
    actor = getattr(plotter, add)(source, scalars="fa", show_scalar_bar=False)
    np.testing.assert_allclose(values_of(actor), wanted, atol=1e-6)
    per_line = getattr(plotter, add)(source, scalars="w", cmap="gray", show_scalar_bar=False)
    assert per_line.clim == (0.0, 2.0)
