"""Legacy vtk and vtp lines: values against VTK's own readers, and bad input."""

import itertools

import numpy as np
import pytest
import pyvista as pv
from hypothesis import given
from hypothesis import strategies as st

from pvfiblets import formats
from pvfiblets.errors import FormatError
from pvfiblets.formats.vtk_files import legacy_parser
from pvfiblets.invalid_points import CUT, NONFINITE
from pvfiblets.lines import gather
from pvfiblets.other_libraries import streamlines_of
from pvfiblets.streamlines import Streamlines

from .samples import rich, same

ALL = ("per_point", "per_streamline", "groups", "per_group")

OLD = b"""# vtk DataFile Version 3.0
made by hand%s
ASCII
DATASET POLYDATA
POINTS 5 float
0 0 0  1 0 0  1 1 0
2 2 2  3 3 3
VERTICES 1 2
1 4
LINES 2 7
3 0 1 2
2 3 0
CELL_DATA 3
SCALARS c int 1
LOOKUP_TABLE default
7 8 9
POINT_DATA 5
VECTORS v double
1 2 3 4 5 6 7 8 9 10 11 12 13 14 15
FIELD FieldData 2
fa%%20x 1 5 float
0.5 nan 1e-3 -2 3
name 1 5 string
a
b
c
d
e
"""


def refused(path, data: bytes | None = None) -> FormatError:
    if data is not None:
        path.write_bytes(data)
    with pytest.raises(FormatError) as caught:
        formats.read(path)
    return caught.value


def by_vtk(path) -> Streamlines:
    return Streamlines.from_polydata(pv.read(path))


def test_real_files_agree_with_vtk_and_those_of_other_datasets_are_refused(shared_data):
    names = ["ukf_2T_fw_fiber.vtk", "wma_brain_0002.vtk", "nv_tract.FAT_R.vtk"]
    for name in [*names, "vtk_track1.binary.vtk", "vtk_Coastlines_Los_Alamos.vtp"]:
        ours, theirs = formats.read(shared_data / name), by_vtk(shared_data / name)
        same(ours, theirs)
        assert ours.dropped == theirs.dropped
    for name in ("vtk_office.binary.vtk", "vtk_carotid.vtk"):
        assert "DATASET POLYDATA" in refused(shared_data / name).expected


def test_a_file_made_by_hand(tmp_path):
    path = tmp_path / "a.vtk"
    path.write_bytes(OLD % b"")
    s = formats.read(path)
    assert [p.tolist() for p in s] == [[[0, 0, 0], [1, 0, 0], [1, 1, 0]], [[2, 2, 2], [0, 0, 0]]]
    assert s.per_streamline["c"].tolist() == [8, 9]
    assert s.per_point["v"][3].tolist() == [10, 11, 12]
    assert np.allclose(s.per_point["fa x"], [0.5, np.nan, 1e-3, -2, 0.5], equal_nan=True)
    assert s.dropped == {
        "cells that are not lines": 1, "points of no line": 1, "text arrays": 1,
    }  # fmt: skip


RAS_POINTS = [[10, 20, 30], [11, 21, 31], [12, 23, 33]]


def slicers_file(path, space, where, mode):
    """Write a line with its space in the title or the field data, as 3D Slicer does."""
    from vtkmodules.vtkIOLegacy import vtkPolyDataWriter
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

    flip = np.float32([-1, -1, 1]) if space == "LPS" else np.float32(1)
    mesh = pv.PolyData(np.array(RAS_POINTS, np.float32) * flip, lines=[3, 0, 1, 2])
    if where == "field":
        mesh.field_data["SPACE"] = [space]
    if path.suffix == ".vtp":
        writer = vtkXMLPolyDataWriter()
        getattr(writer, f"SetDataModeTo{mode}")()
    else:
        writer = vtkPolyDataWriter()
        writer.SetFileVersion(mode)
        writer.SetFileType(2 if mode == 51 else 1)
        writer.SetHeader(f"3D Slicer output. SPACE={space}" if where == "title" else "vtk output")
    writer.SetFileName(str(path))
    writer.SetInputData(mesh)
    writer.Write()


@pytest.mark.parametrize(
    ("suffix", "where", "mode"),
    [
        *((".vtk", where, version) for where in ("title", "field") for version in (42, 51)),
        *((".vtp", "field", mode) for mode in ("Ascii", "Binary", "Appended")),
    ],
)
@pytest.mark.parametrize("space", ["LPS", "RAS"])
def test_the_space_that_slicer_names(space, suffix, where, mode, tmp_path):
    path = tmp_path / f"a{suffix}"
    slicers_file(path, space, where, mode)
    s = formats.read(path)
    assert s[0].tolist() == RAS_POINTS
    assert s.dropped == {}
    assert formats.info(path)["space"] == space
    if where == "field":
        assert by_vtk(path)[0].tolist() == RAS_POINTS
        grid = pv.read(path).cast_to_unstructured_grid()
        for source in (pv.read(path), grid, pv.MultiBlock([grid])):
            assert gather(source).points.tolist() == streamlines_of(source).points.tolist() == RAS_POINTS


@pytest.mark.parametrize("suffix", [".vtk", ".vtp"])
def test_our_files_name_their_space(suffix, tmp_path):
    s = Streamlines(np.array(RAS_POINTS, np.float32), [0, 3])
    formats.write(tmp_path / f"ours{suffix}", s)
    s.to_polydata().save(tmp_path / f"pyvistas{suffix}")
    for path in tmp_path.iterdir():
        assert pv.read(path).field_data["SPACE"][0] == "RAS"
        assert formats.read(path)[0].tolist() == RAS_POINTS


def test_an_unknown_space_is_a_warning(tmp_path):
    path = tmp_path / "a.vtk"
    slicers_file(path, "XYZ", "field", 42)
    with pytest.warns(UserWarning, match="names the space 'XYZ'; RAS or LPS is expected"):
        assert formats.read(path)[0].tolist() == RAS_POINTS


def test_a_line_is_cut_at_a_nan_in_files_and_in_objects(tmp_path):
    mesh = pv.PolyData(np.arange(36.0).reshape(12, 3), lines=[12, *range(12)])
    mesh.points[5] = np.nan
    mesh.save(tmp_path / "a.vtp")
    s = formats.read(tmp_path / "a.vtp")
    assert (s.counts.tolist(), s.dropped) == ([5, 6], {NONFINITE: 1, CUT: 1})
    assert formats.info(tmp_path / "a.vtp")["dropped"] == s.dropped
    plotter = pv.Plotter(off_screen=True)
    for source in (mesh, tmp_path / "a.vtp"):
        with pytest.warns(UserWarning, match="non-finite points: 1; streamlines added"):
            actor = plotter.add_fiblets(source)
        assert actor.fiblets.decompress().counts.tolist() == [5, 6]
    plotter.close()


@given(st.lists(st.integers(0, 5), max_size=8), st.sampled_from([".vtk", ".vtp"]))
def test_round_trip_keeps_everything(tmp_path_factory, counts, suffix):
    path = tmp_path_factory.mktemp("vtk") / f"a{suffix}"
    s = rich(1, counts)
    assert formats.write(path, s) == []
    back = formats.read(path)
    same(back, s, ALL if s.n_points else ())
    if s.n_points:  # VTK writes nothing at all of empty poly data
        assert np.array_equal(back.affine, s.affine)
    theirs = by_vtk(path)
    assert np.array_equal(theirs.points, s.points)
    pieces = list(formats.iter_chunks(path, 4))
    same(Streamlines.concatenate(pieces), back, ALL if s.n_points else ())


@pytest.mark.parametrize("binary", [True, False])
@pytest.mark.parametrize("version", [42, 51])
def test_both_styles_of_cells_in_text_and_binary(binary, version, tmp_path):
    from vtkmodules.vtkIOLegacy import vtkPolyDataWriter

    mesh = rich().to_polydata()
    mesh.point_data["tensor"] = np.arange(27.0 * 9).reshape(27, 9)
    for name, kind in (("u8", "u1"), ("i8", "i1"), ("i16", "i2"), ("i64", "i8"), ("u64", "u8")):
        mesh.point_data[name] = np.arange(27).astype(kind)
    writer = vtkPolyDataWriter()
    writer.SetFileName(str(tmp_path / "a.vtk"))
    writer.SetFileVersion(version)
    (writer.SetFileTypeToBinary if binary else writer.SetFileTypeToASCII)()
    writer.SetInputData(mesh)
    writer.Write()
    same(formats.read(tmp_path / "a.vtk"), by_vtk(tmp_path / "a.vtk"), ALL)


MODES = list(itertools.product(["Ascii", "Binary", "Appended"], ["None", "ZLib", "LZMA"], *[[0, 1]] * 3))


@pytest.mark.parametrize(("mode", "packer", "encode", "big", "wide"), MODES)
def test_every_way_to_write_vtp(mode, packer, encode, big, wide, tmp_path):
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

    writer = vtkXMLPolyDataWriter()
    writer.SetFileName(str(tmp_path / "a.vtp"))
    getattr(writer, f"SetDataModeTo{mode}")()
    getattr(writer, f"SetCompressorTypeTo{packer}")()
    writer.SetBlockSize(4096)  # the smallest: several blocks
    writer.SetEncodeAppendedData(encode)
    writer.SetByteOrder(0 if big else 1)
    writer.SetHeaderType(64 if wide else 32)
    writer.SetInputData(rich(2, (400, 300)).to_polydata())
    assert writer.Write()
    same(formats.read(tmp_path / "a.vtp"), by_vtk(tmp_path / "a.vtp"), ALL)


def test_pieces_of_vtp_are_joined(tmp_path):
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

    writer = vtkXMLPolyDataWriter()
    writer.SetFileName(str(tmp_path / "a.vtp"))
    writer.SetDataModeToAscii()
    writer.SetInputData(rich().to_polydata())
    writer.Write()
    text = (tmp_path / "a.vtp").read_text()
    begin, end = text.index("<Piece"), text.index("</Piece>") + len("</Piece>")
    doubled = text[:end] + text[begin:end] + text[end:]
    (tmp_path / "b.vtp").write_text(doubled)
    one = formats.read(tmp_path / "a.vtp")
    both = formats.read(tmp_path / "b.vtp")
    assert both.counts.tolist() == one.counts.tolist() * 2
    assert np.array_equal(both.points, np.concatenate([one.points] * 2))


def test_nonfinite_points_and_a_last_number_without_newline_are_reported(tmp_path):
    path = tmp_path / "a.vtk"
    path.write_bytes((OLD % b"").replace(b"1 1 0", b"1 nan 0"))
    s = formats.read(path)
    assert s.counts.tolist() == [2, 2]
    assert s.dropped[NONFINITE] == 1
    assert CUT not in s.dropped
    whole = (OLD % b"").split(b"POINT_DATA")[0].rstrip()
    path.write_bytes(whole)
    assert formats.read(path).dropped[legacy_parser.LAST_NUMBER] == 1


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        (b"# vtk DataFile", b"# vtk FataDile", "DataFile Version"),
        (b"ASCII", b"ASCIZ", "ASCII or BINARY"),
        (b"POLYDATA", b"STRUCTURED_GRID", "extract the lines"),
        (b"POINTS 5", b"POINTS 6", "more numbers"),
        (b"POINTS 5", b"POINTS -5", "a count"),
        (b"POINTS 5", b"POINTS 999999999999", "999"),
        (b"POINTS 5 float", b"POINTS 5 quad", "type 'quad'"),
        (b"POINTS 5 float", b"POINTS", "words"),
        (b"LINES 2 7", b"LINES 3 7", "cell 2 has the end"),
        (b"LINES 2 7", b"LINES 1 7", "take 4 numbers"),
        (b"3 0 1 2\n", b"9 0 1 2\n", "cell 0 has 9 points"),
        (b"3 0 1 2\n", b"-3 0 1 2\n", "cell 0 has -3 points"),
        (b"2 3 0", b"2 3 5", "point indices 0 to 5"),
        (b"2 3 0", b"2 3 -1", "point indices -1 to 4|point indices -1"),
        (b"CELL_DATA 3", b"CELL_DATA 2", "one of POINTS"),
        (b"7 8 9", b"7 eight 9", "more numbers"),
        (b"VECTORS", b"VICTORS", "VICTORS"),
        (b"5 float\n0.5", b"4 float\n0.5", "of 4 rows"),
    ],
)
def test_damaged_text(old, new, words, tmp_path):
    import re

    error = refused(tmp_path / "a.vtk", (OLD % b"").replace(old, new, 1))
    assert re.search(words, str(error)), str(error)


def test_empty_and_foreign_files(tmp_path):
    for suffix in (".vtk", ".vtp"):
        for raw in (b"", b"\0" * 50, b"<VTKFile", b"GIF89a"):
            refused(tmp_path / f"a{suffix}", raw)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('NumberOfPoints="27"', 'NumberOfPoints="28"', "28 rows of 3"),
        ('NumberOfPoints="27"', 'NumberOfPoints="99999999999"', "99999999999"),
        ('NumberOfLines="6"', 'NumberOfLines="7"', "7 rows"),
        ('NumberOfLines="6"', 'NumberOfLines="2147483648000"', "2147483648000 rows"),
        ('NumberOfLines="6"', 'NumberOfLines="-6"', "whole number"),
        ('type="Float32" Name="Points"', 'type="Float99" Name="Points"', "Float99"),
        ("</Piece>", "</Peace>", "broken XML"),
        ('type="PolyData"', 'type="ImageData"', "extract the lines"),
        ("<VTKFile", "<!DOCTYPE x [<!ENTITY a 'b'>]>\n<VTKFile", "document type"),
        ('compressor="vtkZLibDataCompressor"', 'compressor="vtkOtherDataCompressor"', "with zlib"),
    ],
)
def test_damaged_vtp(old, new, words, tmp_path):
    rich().to_polydata().save(tmp_path / "a.vtp", binary=False)
    text = (tmp_path / "a.vtp").read_text()
    assert old in text
    error = refused(tmp_path / "a.vtp", text.replace(old, new, 1).encode())
    assert words in str(error)
