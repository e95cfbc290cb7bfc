"""Volumes from VTK's XML files of images: every way to write them, and sizes that no such file can hold."""

from __future__ import annotations

import numpy as np
import pytest
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

from pvfiblets.errors import FormatError
from pvfiblets.volumes import as_raycast_volume

from .small_volume import assert_is_the_volume, image


def written(path, made, mode, packer="ZLib", *, wide=False, pieces=1):
    """Write an image by VTK; 'Encoded' is appended in base64."""
    writer = vtkXMLImageDataWriter()
    writer.SetFileName(str(path))
    writer.SetInputData(made)
    (writer.SetDataModeToAppended if mode == "Encoded" else getattr(writer, f"SetDataModeTo{mode}"))()
    writer.SetEncodeAppendedData(mode == "Encoded")
    getattr(writer, f"SetCompressorTypeTo{packer}")()
    (writer.SetHeaderTypeToUInt64 if wide else writer.SetHeaderTypeToUInt32)()
    writer.SetNumberOfPieces(pieces)
    assert writer.Write()


def test_vti(tmp_path):
    image(other=np.arange(60.0)).save(tmp_path / "a.vti")
    assert_is_the_volume(as_raycast_volume(tmp_path / "a.vti", scalars="ct"), "ct", atol=1e-7)
    assert as_raycast_volume(tmp_path / "a.vti", scalars="other").value_range == (0.0, 59.0)


@pytest.mark.parametrize("wide", [False, True], ids=["32-bit", "64-bit"])
@pytest.mark.parametrize("packer", ["None", "ZLib", "LZ4", "LZMA"])
@pytest.mark.parametrize("mode", ["Ascii", "Binary", "Appended", "Encoded"])
def test_every_way_to_write_vti(tmp_path, mode, packer, wide):
    made = image(other=np.arange(60.0))
    made.cell_data["cells"] = np.arange(made.n_cells)
    made.field_data["note"] = ["one", "two"]
    made.field_data["numbers"] = np.arange(7)
    written(tmp_path / "a.vti", made, mode, packer, wide=wide, pieces=2)
    assert_is_the_volume(as_raycast_volume(tmp_path / "a.vti", scalars="ct"), "ct", atol=1e-6)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('WholeExtent="0 2 0 3 0 4"', 'WholeExtent="0 2 0 3 0 2147483646"', "60 points in pieces"),
        ('Extent="0 2 0 3 0 4"', 'Extent="0 2 0 3 0 2147483646"', "bytes in a file of"),
        ('WholeExtent="0 2 0 3 0 4"', 'WholeExtent="0 2 0 -3 0 4"', "a point along each axis"),
        ('WholeExtent="0 2 0 3 0 4"', 'WholeExtent="0 2 0 3 0"', "six whole numbers"),
        ('type="ImageData"', 'type="PolyData"', "VTKFile of type 'ImageData'"),
        ("AQAAAACAAA", "AQ99999999", "blocks of"),
    ],
)
def test_sizes_that_a_vti_cannot_hold(tmp_path, old, new, words):
    written(tmp_path / "a.vti", image(), "Binary")
    text = (tmp_path / "a.vti").read_text()
    assert old in text
    head, found, tail = text.rpartition(old) if old.startswith("Extent") else text.partition(old)
    assert found
    (tmp_path / "a.vti").write_text(head + new + tail)
    with pytest.raises(FormatError, match=words):
        as_raycast_volume(tmp_path / "a.vti")
