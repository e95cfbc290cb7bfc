"""TRX: values against trx-python, every type, stored and deflated, and bad input."""

import json
import struct
import warnings
from zipfile import ZIP_BZIP2, ZIP_DEFLATED, ZIP_STORED, ZipFile

import numpy as np
import pytest
import pyvista as pv
from hypothesis import given
from hypothesis import strategies as st

from pvfiblets import formats
from pvfiblets.errors import FormatError
from pvfiblets.formats import trx
from pvfiblets.invalid_points import CUT, NONFINITE
from pvfiblets.streamlines import Streamlines

from .samples import rich, same

ALL = ("per_point", "per_streamline", "groups", "per_group")
POINTS = np.arange(15, dtype="f4").reshape(5, 3)


def packed(path, entries: dict[str, np.ndarray | bytes], header=None, method=ZIP_STORED):
    """A trx file of the given entries, made by hand."""
    head = {"NB_VERTICES": 5, "NB_STREAMLINES": 2, "DIMENSIONS": [3, 4, 5]}
    head["VOXEL_TO_RASMM"] = np.diag([2.0, 3, 4, 1]).tolist()
    head.update(header or {})
    with ZipFile(path, "w", method) as archive:
        archive.writestr("header.json", json.dumps(head))
        for name, values in entries.items():
            raw = values if isinstance(values, bytes) else values.tobytes()
            archive.writestr(name, raw)
    return path


def base(**more):
    return {"positions.3.float32": POINTS, "offsets.uint64": np.array([0, 3, 5], "<u8")} | more


def refused(path) -> FormatError:
    with pytest.raises(FormatError) as caught:
        formats.read(path)
    with pytest.raises(FormatError):
        list(formats.iter_chunks(path, 2))
    return caught.value


def with_last_offset(path, target):
    """Copy a trx file, adding the last offset, without which trx-python now refuses files."""
    with ZipFile(path) as old, ZipFile(target, "w") as new:
        for entry in old.infolist():
            raw = old.read(entry)
            if entry.filename == "offsets.uint64":
                raw += np.uint64(json.loads(old.read("header.json"))["NB_VERTICES"]).tobytes()
            if not entry.is_dir():
                new.writestr(entry.filename, raw)
    return target


def test_agrees_with_trx_python_on_real_files(shared_data, tmp_path):
    import trx.trx_file_memmap as library

    paths = sorted(shared_data.glob("trxpy*.trx"))
    assert len(paths) == 2
    for original in paths:
        ours = formats.read(original)
        path = with_last_offset(original, tmp_path / "a.trx")
        same(formats.read(path), ours, ALL)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            theirs = library.load(str(path))
        assert np.array_equal(ours.points, theirs.streamlines._data.astype(np.float32))
        assert ours.counts.tolist() == theirs.streamlines._lengths.tolist()
        assert set(ours.per_point) == {k.rstrip() for k in theirs.data_per_vertex}
        for name, values in theirs.data_per_vertex.items():
            assert np.array_equal(ours.per_point[name.rstrip()], np.squeeze(values._data))
        for name, values in theirs.data_per_streamline.items():
            assert np.array_equal(ours.per_streamline[name], np.squeeze(values))
        for name, members in theirs.groups.items():
            assert ours.groups[name].tolist() == sorted(np.ravel(members).tolist())
        for group, data in theirs.data_per_group.items():
            for name, value in data.items():
                assert np.array_equal(ours.per_group[group][name].ravel(), np.ravel(value))
        assert np.allclose(ours.affine, theirs.header["VOXEL_TO_RASMM"])
        pieces = list(formats.iter_chunks(path, 5000))
        same(Streamlines.concatenate(pieces), ours, ALL)
        theirs.close()


@pytest.mark.filterwarnings("ignore:.*no voxel-to-RAS matrix")
def test_real_file_without_the_last_offset(shared_data):
    """trx-python refuses this one; the trk file beside it holds the same streamlines."""
    ours = formats.read(shared_data / "nv_colby.trx")
    same_in_trk = formats.read(shared_data / "nv_colby.trk")
    assert ours.offsets.tolist() == same_in_trk.offsets.tolist()
    assert set(ours.per_point) == set(same_in_trk.per_point)
    assert np.allclose(ours.per_point["pval"], same_in_trk.per_point["pval"])


def test_ours_are_read_by_trx_python(tmp_path):
    import trx.trx_file_memmap as library

    s = rich(counts=(5, 1, 12, 3, 2, 7))
    s.per_streamline["flag"] = np.array([1, 0, 1, 1, 0, 0], bool)
    assert formats.write(tmp_path / "a.trx", s) == []
    theirs = library.load(str(tmp_path / "a.trx"))
    assert np.array_equal(theirs.streamlines._data, s.points)
    assert theirs.streamlines._lengths.tolist() == s.counts.tolist()
    assert np.array_equal(theirs.data_per_vertex["rgb"]._data, s.per_point["rgb"])
    assert np.ravel(theirs.data_per_streamline["flag"]).tolist() == [1, 0, 1, 1, 0, 0]
    assert theirs.groups["left"].tolist() == [0, 2, 4]
    assert np.allclose(theirs.header["VOXEL_TO_RASMM"], s.affine)
    theirs.close()


@given(st.lists(st.integers(0, 5), max_size=8), st.integers(1, 9), st.sampled_from(["f4", "f8"]))
def test_round_trip_keeps_everything(tmp_path_factory, counts, max_points, kind):
    path = tmp_path_factory.mktemp("trx") / "a.trx"
    s = rich(1, counts)
    s.points = s.points.astype(kind)
    s.per_point["ids"] = np.arange(s.n_points, dtype=np.uint16)
    s.per_streamline["yes"] = np.arange(len(s)) % 2 == 0
    formats.write(path, s)
    back = formats.read(path)
    same(back, s, ALL)
    assert back.points.dtype == s.points.dtype
    assert back.per_streamline["yes"].dtype == bool
    assert np.array_equal(back.affine, s.affine)
    assert back.dropped == {}
    pieces = list(formats.iter_chunks(path, max_points))
    assert all(len(p) == 1 or p.n_points <= max_points for p in pieces)
    same(Streamlines.concatenate(pieces), back, ALL if counts else ())


@pytest.mark.parametrize("kind", ["float16", "float32", "float64"])
@pytest.mark.parametrize("method", [ZIP_STORED, ZIP_DEFLATED])
@pytest.mark.parametrize("last", [True, False])
@pytest.mark.parametrize("integers", ["uint64", "uint32", "int64"])
def test_types_and_both_kinds_of_offsets(kind, method, last, integers, tmp_path):
    offsets = np.array([0, 3, 5][: 3 if last else 2], integers)
    entries = {f"positions.3.{kind}": POINTS.astype(kind), f"offsets.{integers}": offsets}
    path = packed(tmp_path / "a.trx", entries, method=method)
    s = formats.read(path)
    assert s.points.dtype == (np.float64 if kind == "float64" else np.float32)
    assert np.array_equal(s.points, POINTS)
    assert s.offsets.tolist() == [0, 3, 5]
    assert s.space["dimensions"] == (3, 4, 5)
    same(Streamlines.concatenate(formats.iter_chunks(path, 3)), s)
    facts = formats.info(path)
    assert (facts["streamlines"], facts["points"], facts["dtype"]) == (2, 5, kind)


def test_odd_files_are_read(tmp_path):
    more = {"dpv/pval   .float32": np.ones(5, "f4"), "notes.txt": b"hello", "odd/x.uint8": b"1"}
    s = formats.read(packed(tmp_path / "a.trx", base(**more)))
    assert list(s.per_point) == ["pval"]
    assert s.dropped == {trx.UNKNOWN: 2}
    path = packed(tmp_path / "a.trx", {}, {"NB_VERTICES": 0, "NB_STREAMLINES": 0})
    assert len(formats.read(path)) == 0
    assert [len(p) for p in formats.iter_chunks(path, 5)] == [0]
    s = formats.read(packed(tmp_path / "a.trx", base(), {"NB_STREAMLINES": 3}))
    assert s.counts.tolist() == [3, 2, 0]


def test_nonfinite_points(tmp_path):
    points = POINTS.copy()
    points[1, 2] = np.inf
    more = {"positions.3.float32": points, "dpv/i.uint8": np.arange(5, dtype="u1")}
    s = formats.read(packed(tmp_path / "a.trx", base(**more)))
    assert s.dropped == {NONFINITE: 1, CUT: 1}
    assert s.counts.tolist() == [1, 1, 2]
    assert s.per_point["i"].tolist() == [0, 2, 3, 4]


@pytest.mark.parametrize(
    ("entries", "header", "words"),
    [
        (base(), {"NB_VERTICES": 7}, "5 rows.*7, the header's NB_VERTICES"),
        (base(), {"NB_VERTICES": 3}, "5 rows"),
        (base(**{"dpv/fa.float32": np.zeros(6, "f4")}), {"NB_VERTICES": 6}, "positions with 5 rows"),
        (base(**{"offsets.uint64": np.array([0, 3], "u8")}), {"NB_VERTICES": 6}, "positions with 5 rows"),
        (base(), {"NB_STREAMLINES": 4}, "3 rows"),
        (base(), {"NB_STREAMLINES": -1}, "NB_STREAMLINES = -1"),
        (base(), {"NB_VERTICES": 10**18}, "rows"),
        (base(), {"NB_VERTICES": "5"}, "'5'"),
        (base(), {"VOXEL_TO_RASMM": [1, 2]}, "4 x 4"),
        ({"offsets.uint64": np.zeros(3, "u8")}, {}, "no positions"),
        ({"positions.3.float32": POINTS}, {}, "no offsets"),
        (base(**{"offsets.uint64": np.array([0, 6, 5], "u8")}), {}, "never decrease"),
        (base(**{"offsets.uint64": np.array([1, 3, 5], "u8")}), {}, "offsets from 0"),
        (base(**{"offsets.uint64": np.array([0, 3, 4], "u8")}), {}, "offset 2 is 4"),
        (base(**{"offsets.uint64": np.array([0, 2**63, 5], "u8")}), {}, "never decrease"),
        (base(**{"dpv/fa.float32": np.zeros(4, "f4")}), {}, "dpv/fa with 4 rows"),
        (base(**{"dps/w.uint8": b"123"}), {}, "dps/w with 3 rows"),
        (base(**{"dpv/fa.float32": b"12345"}), {}, "multiple of 4"),
        (base(**{"groups/g.int64": np.array([0, 2])}), {}, "group 'g'"),
        (base(**{"groups/g.float32": np.array([0], "f4")}), {}, "integers"),
        (base(**{"dpv/x.0.uint8": b""}), {}, "0 columns"),
    ],
)  # fmt: skip
def test_contradictions(entries, header, words, tmp_path):
    error = refused(packed(tmp_path / "a.trx", entries, header))
    import re

    assert re.search(words, str(error)), str(error)


@pytest.mark.parametrize(
    ("entries", "header"),
    [
        (base(), {"NB_VERTICES": 6}),
        (base(), {"NB_VERTICES": 4}),
        (base(**{"dpv/fa.float32": np.zeros(5, "f4")}), {"NB_VERTICES": 6}),
        (base(**{"offsets.uint64": np.array([0, 3], "u8"), "dpv/i.uint8": bytes(5)}), {"NB_VERTICES": 4}),
        (base(), {"NB_STREAMLINES": 1}),
        (base(**{"dps/w.uint8": b"12"}), {"NB_STREAMLINES": 3}),
        (base(**{"dps/w.uint8": b"12"}), {"NB_STREAMLINES": 1}),
        (base(**{"offsets.uint64": np.array([0, 3], "u8"), "dps/w.uint8": b"12"}), {"NB_STREAMLINES": 1}),
        (base(**{"offsets.uint64": np.array([0, 3], "u8"), "dps/w.uint8": b"12"}), {"NB_STREAMLINES": 3}),
        (base(), {"NB_STREAMLINES": 1, "NB_VERTICES": 6}),
    ],
)
@pytest.mark.parametrize("method", [ZIP_STORED, ZIP_DEFLATED])
def test_a_header_off_by_one_warns_and_the_arrays_count(entries, header, method, tmp_path):
    path = packed(tmp_path / "a.trx", entries, header, method)
    for ask in (formats.read, lambda path: Streamlines.concatenate(formats.iter_chunks(path, 3))):
        with pytest.warns(UserWarning, match=r"a.trx: NB_\w+ is \d, but all arrays have \d, which is used"):
            s = ask(path)
        assert s.counts.tolist() == [3, 2]
        np.testing.assert_array_equal(s.points, POINTS)
    with pytest.warns(UserWarning, match="which is used"):
        facts = formats.info(path)
    assert (facts["streamlines"], facts["points"]) == (2, 5)


def test_what_is_no_archive_or_damaged_is_refused(tmp_path):
    path = tmp_path / "a.trx"
    for raw in (b"", b"PK\x03\x04 and no more", b"x" * 100):
        path.write_bytes(raw)
        refused(path)
    with ZipFile(path, "w") as archive:
        archive.writestr("positions.3.float32", POINTS.tobytes())
    assert "header.json" in refused(path).found
    with ZipFile(path, "w") as archive:
        archive.writestr("header.json", "{broken")
    assert "header.json" in refused(path).found
    packed(path, base(), method=ZIP_BZIP2)
    assert "method 12" in refused(path).found
    path = packed(tmp_path / "a.trx", base())
    data = path.read_bytes()
    path.write_bytes(data[: len(data) // 2])
    refused(path)
    path = packed(tmp_path / "a.trx", base(), {"NB_VERTICES": 10**8}, ZIP_DEFLATED)
    raw = bytearray(path.read_bytes())
    # The directory's entry of the positions: its uncompressed size stands 22 bytes before the name.
    at = raw.rindex(b"positions.3.float32") - 22
    struct.pack_into("<I", raw, at, 12 * 10**8)
    path.write_bytes(raw)
    assert "damaged" in refused(path).expected


@pytest.mark.parametrize("name", ["a.trx", "unpacked"])
def test_a_folder_is_read_as_its_archive(name, tmp_path, capsys):
    """The format allows both; trx-python opens both."""
    from trx.trx_file_memmap import load_from_directory

    from pvfiblets.cli.command import main

    formats.write(tmp_path / "packed.trx", rich(counts=(5, 1, 12, 3, 2, 7)))
    folder = tmp_path / name
    with ZipFile(tmp_path / "packed.trx") as archive:
        archive.extractall(folder)
    s, packed = formats.read(folder), formats.read(tmp_path / "packed.trx")
    same(s, packed, ("per_point", "per_streamline", "groups", "per_group"))
    assert np.array_equal(s.points, load_from_directory(str(folder)).streamlines.get_data())
    same(Streamlines.concatenate(list(formats.iter_chunks(folder, 4))), packed)
    assert formats.info(folder)["points"] == 30
    assert main(["info", str(folder), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["streamlines"] == 6
    plotter = pv.Plotter(off_screen=True)
    assert plotter.add_fiblets(folder).fiblets.n_points == 30
    plotter.close()
    (folder / "positions.3.float32").write_bytes(b"short")
    with pytest.raises(FormatError, match="positions"):
        formats.read(folder)
