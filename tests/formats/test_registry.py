"""Suffixes, the table of formats, and what every format has in common."""

import sys
import types
import warnings

import nibabel as nib
import numpy as np
import pytest
import pyvista as pv
from hypothesis import given
from hypothesis import strategies as st
from nibabel.streamlines.trk import header_2_dtype

import pvfiblets as pf
from pvfiblets import formats
from pvfiblets.cli.command import main
from pvfiblets.formats import registry
from pvfiblets.streamlines import Streamlines

from .samples import corpus, rich, same


def test_suffixes_and_formats_are_known(tmp_path):
    assert registry.suffix_of("/a.b/X.TRK.GZ") == ".trk.gz"
    assert registry.suffix_of("x.trk") == ".trk"
    with pytest.raises(ValueError, match="max_points is 0"):
        list(formats.iter_chunks("a.tck", 0))
    for path in corpus(tmp_path).values():
        facts = formats.info(path)
        s = formats.read(path)
        assert facts["format"] == registry.suffix_of(path)
        assert facts["streamlines"] == len(s)
        assert facts["points"] in (None, s.n_points)
        assert facts.get("per_point", []) == list(s.per_point)
        assert facts.get("per_streamline", []) == list(s.per_streamline)


def test_unknown_suffixes_missing_files_and_folders_are_errors(tmp_path):
    with pytest.raises(formats.UnknownFormatError, match=r"a\.nii.*\.tck, .*\.trx"):
        formats.read("a.nii")
    with pytest.raises(formats.UnknownFormatError, match=r"\.gz"):
        formats.read("tck.gz")
    for suffix in registry.suffixes():
        with pytest.raises(FileNotFoundError):
            formats.read(tmp_path / f"none{suffix}")
    for suffix in (".tck", ".trk", ".trx", ".vtk", ".vtp"):
        with pytest.raises(FileNotFoundError):
            formats.write(tmp_path / "none" / f"a{suffix}", rich())


def test_a_format_registered_from_outside(monkeypatch):
    module = types.ModuleType("outside_format")
    module.read = lambda path, *, progress: rich()
    monkeypatch.setitem(sys.modules, "outside_format", module)
    monkeypatch.setattr(registry, "_MODULES", dict(registry._MODULES))
    registry.register(".outside", "outside_format")
    assert len(formats.read("a.outside")) == 6
    with pytest.raises(formats.UnknownFormatError, match=r"\.outside has no write.*\.trx"):
        formats.write("a.outside", rich())
    with pytest.raises(ValueError, match="begin with a dot"):
        registry.register("outside", "outside_format")


KEPT = (
    "dimensions", "voxel_sizes", "voxel_order", "voxel_to_rasmm", "image_orientation_patient", "pad2",
)  # fmt: skip
"""Of the fields that http://trackvis.org/docs/?subsect=fileformat lists, those of the image."""


def by_pyvista(source, target):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        pv.read(source).save(target)


def by_compressing_a_mesh(source, target):
    pv.read(source).fiblets.compress(per_point="all", max_error=1e-3).save(target)


def by_fiblets_file(source, target):
    between = target.with_suffix(".fiblets")
    pf.compress(pf.read(source), max_error=1e-3).save(between)
    pf.FibletSet.open(between)[::1].save(target)


def by_convert(source, target):
    assert main(["convert", str(source), str(target), "--quiet"]) == 0


def by_converting_twice(source, target):
    between = target.with_suffix(".fiblets")
    assert main(["convert", str(source), str(between), "--max-error", "0.001", "--quiet"]) == 0
    assert main(["convert", str(between), str(target), "--quiet"]) == 0


def by_vtp(source, target):
    """Through VTK's own XML writer and our reader of it."""
    by_pyvista(source, target.with_suffix(".vtp"))
    by_convert(target.with_suffix(".vtp"), target)


def by_vtk(source, target):
    by_pyvista(source, target.with_suffix(".vtk"))
    by_convert(target.with_suffix(".vtk"), target)


WAYS = (by_pyvista, by_compressing_a_mesh, by_fiblets_file, by_convert, by_converting_twice, by_vtp, by_vtk)
FILES = ("nv_tract.IFOF_R.trk", "nib_standard.LPS.trk", "nv_colby.trk")


def raw_header(path):
    raw = path.read_bytes()[:1000]
    little = np.frombuffer(raw, header_2_dtype.newbyteorder("<"))[0]
    return little if little["hdr_size"] == 1000 else np.frombuffer(raw, header_2_dtype.newbyteorder(">"))[0]


def in_bounds(path):
    """Whether dipy finds all points of a file inside its image: what ``bbox_valid_check`` refuses a file for."""
    from dipy.io.streamline import load_tractogram

    return load_tractogram(str(path), "same", bbox_valid_check=False).is_bbox_in_vox_valid()


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("way", WAYS, ids=lambda way: way.__name__)
@pytest.mark.parametrize("name", FILES)
def test_the_header_of_a_trk_file_goes_along(shared_data, tmp_path, capsys, name, way):
    source, target = shared_data / name, tmp_path / "saved.trk"
    way(source, target)
    before, after = raw_header(source), raw_header(target)
    for field in KEPT:
        np.testing.assert_array_equal(after[field], before[field], err_msg=field)
    a, b = nib.streamlines.load(source), nib.streamlines.load(target)
    np.testing.assert_allclose(b.streamlines.get_data(), a.streamlines.get_data(), atol=2e-3)
    if name != "nv_colby.trk":  # whose matrix is not recorded, which dipy takes for an error
        assert in_bounds(target) == in_bounds(source)


@pytest.mark.parametrize("order", ["RAS", "LPS", "SPL"])
def test_a_trx_file_has_the_dimensions_along_the_axes_of_its_affine(tmp_path, order):
    """nibabel's own reorientation of an image of these dimensions says what they must be."""
    affine = np.diag([2.0, 3.0, 4.0, 1.0])
    dimensions = (20, 30, 40)
    orientation = nib.orientations
    move = orientation.ornt_transform(orientation.axcodes2ornt(order), orientation.axcodes2ornt("RAS"))
    wanted = orientation.apply_orientation(np.zeros(dimensions, np.uint8), move).shape
    space = {"dimensions": dimensions, "voxel_order": order}
    lines = Streamlines(np.ones((2, 3), np.float32), [0, 2], affine=affine, space=space)
    formats.write(tmp_path / "a.trx", lines)
    assert formats.read(tmp_path / "a.trx").space["dimensions"] == wanted


def test_the_rest_of_a_header_goes_through_a_mesh(tmp_path):
    space = {"dimensions": (20, 30, 40), "voxel_sizes": (1.5, 2.0, 2.5), "voxel_order": "LPS", "report": "mm²"}
    lines = Streamlines(np.eye(3), [0, 3], space={**space, "affine_recorded": False})
    back = Streamlines.from_polydata(lines.to_polydata())
    assert back.space == {**space, "affine_recorded": False}
    back.space["voxel_sizes"] = (1.0, 0.0, 1.0)
    with pytest.raises(ValueError, match=r"voxel_sizes.* is \[1.0, 0.0, 1.0\]; three positive numbers"):
        formats.write(tmp_path / "a.trk", back)


@pytest.mark.filterwarnings("ignore:.*have no points")
@pytest.mark.parametrize("suffix", [".tck", ".trk"])
@given(counts=st.lists(st.integers(0, 5), max_size=8), max_points=st.integers(1, 9))
def test_round_trip_and_pieces(tmp_path_factory, suffix, counts, max_points):
    path = tmp_path_factory.mktemp("round") / f"a{suffix}"
    s = rich(1, counts)
    formats.write(path, s)
    back = formats.read(path)
    kept = s if suffix == ".trk" else Streamlines(s.points, s.offsets)
    same(back, kept, atol=1e-4 if suffix == ".trk" else 0.0)
    assert back.dropped == {}
    pieces = list(formats.iter_chunks(path, max_points))
    assert all(len(p) == 1 or p.n_points <= max_points for p in pieces)
    same(Streamlines.concatenate(pieces), back)


@pytest.mark.parametrize(
    ("suffix", "part", "name", "values", "words"),
    [
        (".trk", "per_point", "a name of more than twenty letters", np.zeros(27), "too long"),
        (".trk", "per_point", "long", np.full(27, 2**24 + 1), "float32"),
        (".trk", "per_streamline", "text", np.array(["a"] * 6), "numbers only"),
        (".trx", "per_point", "a/b", np.zeros(27), "slashes"),
        (".trx", "per_point", "", np.zeros(27), "cannot be a name"),
        (".trx", "per_point", "text", np.array(["a"] * 27), "integers and floats"),
        (".trx", "per_streamline", "cube", np.zeros((6, 2, 2)), "2 axes"),
    ],
)
def test_what_a_format_cannot_hold(suffix, part, name, values, words, tmp_path):
    s = rich()
    getattr(s, part)[name] = values
    with pytest.raises(ValueError, match=words):
        formats.write(tmp_path / f"a{suffix}", s)
    assert not list(tmp_path.iterdir())


def test_trk_holds_ten_arrays(tmp_path):
    s = rich()
    s.per_point = {f"v{i}": np.zeros(27) for i in range(11)}
    with pytest.raises(ValueError, match="at most 10"):
        formats.write(tmp_path / "a.trk", s)
