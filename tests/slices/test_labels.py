"""Tables of labels of five programs."""

from __future__ import annotations

import nibabel as nib
import numpy as np
import pytest

from pvfiblets.errors import FormatError
from pvfiblets.slices.labels import LabelTable, as_label_table, distinct_colours


def test_a_colour_table_of_freesurfer(tmp_path):
    (tmp_path / "lut.txt").write_text(
        "#$Id: FreeSurferColorLUT.txt $\n#No. Label Name:  R   G   B   A\n\n0   Unknown        0   0   0   0\n"
        "17  Left-Hippocampus   220 216 20  0\n  1002  ctx-lh-caudal anterior 125 100 160 0\n"
    )
    table = as_label_table(tmp_path / "lut.txt")
    assert table.name(17) == "Left-Hippocampus"
    assert table.colours[17] == (220, 216, 20, 255)
    assert table.name(1002) == "ctx-lh-caudal anterior"
    assert table.rows(np.array([0, 17]))[:, 3].tolist() == [0, 255]


def test_a_table_of_mrtrix(tmp_path):
    """Lines of its own ``fs_default.txt``; `labelconvert` takes the second name."""
    (tmp_path / "fs_default.txt").write_text(
        "# Lookup table\n\n0     ???     Unknown                         0   0   0   0\n\n"
        "1     L.BSTS  ctx-lh-bankssts                 25  100 40  255\n36    L.TH    Left-Thalamus   0   118 14  128\n"
        '50    R.X     "Right X"                       1   2   3   255\n'
    )
    table = as_label_table(tmp_path / "fs_default.txt")
    assert table.names == {0: "Unknown", 1: "ctx-lh-bankssts", 36: "Left-Thalamus", 50: "Right X"}
    assert table.colours == {0: (0, 0, 0, 0), 1: (25, 100, 40, 255), 36: (0, 118, 14, 128), 50: (1, 2, 3, 255)}


def test_fractions_are_colours_and_other_lines_are_named(tmp_path):
    (tmp_path / "lut.txt").write_text("# names\n1 V1 0.5 0.25 1.0 0\n2 V2 127.6 20.0 3 0\n3 V3 red\n\n4 V4 1 0 255 0\n")
    with pytest.warns(UserWarning, match=r"lut.txt: left out line 4, which names no label: '3 V3 red'"):
        table = as_label_table(tmp_path / "lut.txt")
    assert table.colours == {1: (128, 64, 255, 255), 2: (128, 20, 3, 255), 4: (1, 0, 255, 255)}
    (tmp_path / "lut.txt").write_text("1 V1 0.5 0.25 1.0 0\n2 V2 1 0 0 0\n")
    assert as_label_table(tmp_path / "lut.txt").colours == {1: (128, 64, 255, 255), 2: (255, 0, 0, 255)}


def test_a_description_of_itk_snap(tmp_path):
    (tmp_path / "seg.label").write_text(
        '#####\n# IDX -R- -G- -B- -A-- VIS MSH LABEL\n    0     0    0    0        0  0  0    "Clear Label"\n'
        '    1   255    0    0        1  1  1    "White matter"\n    2     0  255    0      0.5  1  0    "Grey"\n'
        '    3     0    0  255        1  0  1    "Hidden"\n'
    )
    table = as_label_table(tmp_path / "seg.label")
    assert table.name(1) == "White matter"
    assert table.colours[1] == (255, 0, 0, 255)
    assert table.colours[2] == (0, 255, 0, 128)
    assert table.colours[3][3] == 0


def test_a_table_of_bids(tmp_path):
    (tmp_path / "atlas_dseg.tsv").write_text(
        "index\tname\tabbreviation\tcolor\n1\tGray Matter\tGM\t#ff53bb\n2\tWM\tWM\tn/a\n"
    )
    table = as_label_table(tmp_path / "atlas_dseg.tsv")
    assert table.names == {1: "Gray Matter", 2: "WM"}
    assert table.colours == {1: (255, 0x53, 0xBB, 255)}
    (tmp_path / "b.tsv").write_text("a\tb\n1\t2\n")
    with pytest.raises(FormatError, match="the columns a, b"):
        as_label_table(tmp_path / "b.tsv")


def test_gifti_and_mappings_are_tables_and_other_kinds_are_refused(tmp_path):
    gifti = nib.gifti
    table = gifti.GiftiLabelTable()
    for key, name, colour in ((0, "???", (0, 0, 0, 0)), (5, "V1", (1.0, 0.5, 0.0, 1.0))):
        label = gifti.GiftiLabel(key, *colour)
        label.label = name
        table.labels.append(label)
    array = gifti.GiftiDataArray(np.zeros(4, np.int32), intent="NIFTI_INTENT_LABEL")
    nib.save(gifti.GiftiImage(darrays=[array], labeltable=table), tmp_path / "a.label.gii")
    found = as_label_table(tmp_path / "a.label.gii")
    assert (found.name(5), found.colours[5]) == ("V1", (255, 128, 0, 255))
    table = as_label_table({1: "one", 2: ("two", "red"), 3: "#00ff00", 4: (0, 0, 255)})
    assert table.names == {1: "one", 2: "two"}
    assert table.colours == {2: (255, 0, 0, 255), 3: (0, 255, 0, 255), 4: (0, 0, 255, 255)}
    assert table.name(9) == "9"
    (tmp_path / "a.txt").write_text("nothing of the kind\n")
    for source, error, said in (
        (tmp_path / "a.txt", FormatError, "table of labels"), (3, TypeError, "labels is a int"),
        (tmp_path / "b.txt", FileNotFoundError, "b.txt"),
    ):  # fmt: skip
        with pytest.raises(error, match=said):
            as_label_table(source)


def test_colours_that_no_table_gives_differ_and_stay():
    labels = np.arange(1, 60)
    found = distinct_colours(labels)
    assert len(np.unique(found, axis=0)) == 59
    np.testing.assert_array_equal(found[10:20], distinct_colours(labels[10:20]))
    assert (abs(np.diff(found[:, :3].astype(int), axis=0)).sum(axis=1) > 100).all()
    np.testing.assert_array_equal(LabelTable().rows(labels), found)
