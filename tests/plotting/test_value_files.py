"""Values that lie in files beside the tractogram, MRtrix's track scalar files above all, colour lines."""

from __future__ import annotations

import re

import nibabel as nib
import numpy as np
import pytest
import pyvista as pv

import pvfiblets as pf
from pvfiblets.cli import main
from pvfiblets.errors import FormatError

NAME = "nv_mni152.SLF1_R"


@pytest.fixture
def files(shared_data):
    return shared_data / "nv_tract.SLF1_R.tck", shared_data / f"{NAME}.tsf"


def numbers_of(path):
    """The values of a track scalar file, by its specification: after the offset, a number a point, NaN between."""
    raw = path.read_bytes()
    start = int(re.search(rb"\nfile: \. (\d+)", raw)[1])
    values = np.frombuffer(raw[start:], "<f4")
    return values[np.isfinite(values)]


@pytest.fixture
def plotter():
    made = pv.Plotter(off_screen=True, window_size=(200, 150))
    yield made
    made.close()


@pytest.mark.parametrize("compressed", [False, True])
def test_a_track_scalar_file_colours_its_tractogram(files, plotter, compressed):
    tractogram, scalars = files
    wanted = numbers_of(scalars)
    assert len(wanted) == len(nib.streamlines.load(tractogram).streamlines.get_data()) == 156
    source = pf.compress(pf.read(tractogram)) if compressed else tractogram
    actor = plotter.add_fiblets(source, scalars=str(scalars))
    values = actor.fiblets.decompress().per_point[NAME].ravel()
    np.testing.assert_allclose(values, wanted, atol=np.ptp(wanted) / 500)
    assert actor.scalars == NAME
    assert actor.clim == pytest.approx((wanted.min(), wanted.max()))
    actor.scalars = "length"
    actor.scalars = scalars  # again, of the actor that is there
    assert actor.scalars == NAME


def test_weights_of_streamlines_in_a_text_file(files, plotter, tmp_path):
    weights = np.linspace(0.5, 2.0, 13)
    (tmp_path / "sift2.txt").write_text(" ".join(map(str, weights)))
    actor = plotter.add_fiblets(files[0], scalars=tmp_path / "sift2.txt")
    np.testing.assert_allclose(actor.fiblets.per_streamline["sift2"], weights)
    assert actor.clim == pytest.approx((0.5, 2.0))


@pytest.mark.parametrize("kind", ["path", "mesh", "fiblets"])
@pytest.mark.parametrize("add", ["add_spline_tubes", "add_halo_lines"])
def test_tubes_and_lines_with_halos_take_them_too(files, plotter, add, kind):
    tractogram, scalars = files
    source = {"path": str, "mesh": pv.read, "fiblets": lambda path: pf.compress(pf.read(path))}[kind](tractogram)
    actor = getattr(plotter, add)(source, scalars=scalars)
    assert actor.scalars == NAME
    wanted = numbers_of(scalars)
    assert actor.clim == pytest.approx((wanted.min(), wanted.max()))


def test_a_file_of_other_lines_is_refused(files, shared_data):
    with pytest.raises(FormatError, match="13 streamlines.*14 as the tractogram has"):
        pv.Plotter(off_screen=True).add_fiblets(shared_data / "nv_tract.IFOF_R.trk", scalars=files[1])


@pytest.mark.more
def test_the_command_line_takes_it(files, tmp_path, capsys):
    picture = tmp_path / "a.png"
    arguments = ["screenshot", str(files[0]), "-o", str(picture), "--scalars", str(files[1]), "--size", "120x90"]
    assert main([*arguments, "--cmap", "gray", "--line-width", "3", "--no-lighting"]) == 0
    colours = np.asarray(pv.read(picture).active_scalars)[:, :3]
    grey = np.unique(colours[(colours == colours[:, :1]).all(axis=1)])
    assert len(grey) > 20  # of the 156 numbers
    assert main(["screenshot", str(files[0]), "-o", str(picture), "--scalars", str(tmp_path / "none.tsf")]) == 1
    assert "none.tsf" in capsys.readouterr().err
