"""MRtrix tracks: values against nibabel, layout by hand, and every kind of bad input."""

import nibabel
import numpy as np
import pytest

from pvfiblets import formats
from pvfiblets.errors import FormatError
from pvfiblets.formats import rows as row_tools
from pvfiblets.formats import tck
from pvfiblets.invalid_points import CUT, NONFINITE
from pvfiblets.streamlines import Streamlines

from .samples import rich, same, tck_bytes

NAN, INF = [np.nan] * 3, [np.inf] * 3
A, B, C = [1.0, 2.0, 3.0], [4.0, 5.0, 6.5], [-7.0, 0.0, 1e-3]


@pytest.fixture
def load(tmp_path):
    def read(rows, **how):
        path = tmp_path / "made.tck"
        path.write_bytes(tck_bytes(np.array(rows), **how))
        return formats.read(path)

    return read


def refused(tmp_path, data: bytes) -> FormatError:
    path = tmp_path / "bad.tck"
    path.write_bytes(data)
    with pytest.raises(FormatError) as caught:
        formats.read(path)
    with pytest.raises(FormatError):
        list(formats.iter_chunks(path, 2))
    assert caught.value.path == str(path)
    return caught.value


@pytest.mark.parametrize("datatype", ["Float32LE", "Float32BE", "Float64LE", "Float64BE"])
@pytest.mark.parametrize("offset", [256, 257])
def test_each_datatype_also_unaligned(datatype, offset, tmp_path):
    data = tck_bytes([A, B, NAN, C, NAN, INF], datatype=datatype, offset=offset)
    path = tmp_path / "a.tck"
    path.write_bytes(data[:256] + b"\n" * (offset - 256) + data[256:])
    s = formats.read(path)
    assert s.points.dtype == (np.float32 if "32" in datatype else np.float64)
    assert s.points.dtype.isnative
    assert np.array_equal(s.points, np.array([A, B, C], s.points.dtype))
    assert s.offsets.tolist() == [0, 2, 3]
    assert s.dropped == {}


def test_agrees_with_nibabel_on_real_files(shared_data):
    for path in sorted(shared_data.glob("*.tck")):
        if "no_" in path.name:
            continue
        theirs = nibabel.streamlines.load(path).streamlines
        ours = formats.read(path)
        assert np.array_equal(ours.points, np.reshape(theirs.get_data(), (-1, 3))), path.name
        assert ours.counts.tolist() == [len(t) for t in theirs], path.name


def test_pieces_of_a_real_file_join_to_the_whole(shared_data):
    path = shared_data / "wholebrain_eudx_0.5mm_fifth.tck"
    whole = formats.read(path)
    pieces = list(formats.iter_chunks(path, 100_000))
    assert max(p.n_points for p in pieces) <= 100_000
    assert len(pieces) < 60
    same(Streamlines.concatenate(pieces), whole)


def test_files_of_nibabel_are_read_and_ours_by_nibabel(tmp_path):
    s = rich()
    streamlines = [p for p in s if len(p)]
    tractogram = nibabel.streamlines.Tractogram(streamlines, affine_to_rasmm=np.eye(4))
    nibabel.streamlines.save(tractogram, tmp_path / "theirs.tck")
    assert np.array_equal(formats.read(tmp_path / "theirs.tck").points, s.points)
    left_out = formats.write(tmp_path / "ours.tck", s)
    assert left_out == ["per_point", "per_streamline", "groups", "per_group"]
    theirs = nibabel.streamlines.load(tmp_path / "ours.tck")
    assert int(theirs.header["count"]) == len(s)
    assert np.array_equal(theirs.streamlines.get_data(), s.points)


def test_odd_lines_are_kept_and_small_blocks_give_the_same(load, monkeypatch):
    s = load([A, NAN, NAN, B, B, NAN, INF])
    assert s.counts.tolist() == [1, 0, 2]
    assert s[2].tolist() == [B, B]
    assert s.dropped == {}
    odd = np.array([0x7FC00001, 0xFFFFFFFF, 0x7F800001], np.uint32).view(np.float32)
    s = load(np.array([A, odd, B, NAN, INF], np.float32))
    assert s.counts.tolist() == [1, 1]
    assert load([A, NAN, B, C, INF]).counts.tolist() == [1, 2]
    assert load([A, NAN, B, NAN], header="count: 2\n").dropped == {tck.NO_END_MARKER: 1}
    rows = [A, B, NAN, C, [np.nan, 1, 2], NAN, NAN, A, INF]
    expected = load(rows)
    monkeypatch.setattr(row_tools, "BLOCK_BYTES", 12)
    same(load(rows), expected)


@pytest.mark.parametrize("bad", [[1, np.nan, 2], [1, np.inf, 2], [1, 2, -np.inf]])
def test_a_line_is_cut_at_a_partly_nonfinite_point(bad, load):
    s = load([A, bad, bad, B, NAN, bad, NAN, bad, C, bad, NAN, INF], header="count: 3\n")
    assert s.dropped == {NONFINITE: 5, CUT: 1}
    assert s.counts.tolist() == [1, 1, 0, 1]
    assert s.points.tolist() == np.array([A, B, C], np.float32).tolist()


def test_x_alone_delimits_as_in_mrtrix(load):
    """MRtrix reads no more of these rows than x (mrtrix3#1131)."""
    s = load([A, B, [np.nan, 0, 0], C, [np.nan, 5, 6], [-np.inf, 0, 0], A])
    assert s.counts.tolist() == [2, 1]
    assert s.dropped == {tck.AFTER_END: 12}


@pytest.mark.parametrize(
    ("count", "report"),
    [("2", {}), ("0000000002", {}), ("5", {tck.FEWER: 3}), ("0", {tck.MORE: 2}), ("1", {tck.MORE: 1})],
)
def test_count_that_differs_is_reported(count, report, load):
    s = load([A, NAN, B, C, NAN, INF], header=f"count: {count}\n")
    assert len(s) == 2
    assert s.dropped == report


@pytest.mark.parametrize(
    ("rows", "header"),
    [([A, NAN, B], ""), ([A, NAN, B, NAN], "count: 3\n"), ([A, NAN, B, NAN], "count: 1\n"), ([A, B, C], "count: 1\n")],
)
def test_missing_end_marker_with_doubt_is_an_error(rows, header, tmp_path):
    data = tck_bytes(np.array(rows), header=header)
    error = refused(tmp_path, data)
    assert error.position == len(data)
    assert "truncated" in error.expected


def test_what_is_truncated_is_refused_and_bytes_after_the_end_counted(tmp_path):
    data = tck_bytes(np.array([A, NAN, B, NAN, INF]))
    error = refused(tmp_path, data[:-5])
    assert error.position == len(data) - 5
    path = tmp_path / "a.tck"
    path.write_bytes(tck_bytes(np.array([A, NAN, INF, B, NAN])) + b"xyz")
    assert formats.read(path).dropped == {tck.AFTER_END: 27}


@pytest.mark.parametrize(
    ("data", "position", "words"),
    [
        (b"", 0, "mrtrix tracks"),
        (b"mrtrix track scalars\nEND\n", 0, "mrtrix tracks"),
        (b"mrtrix tracks\ncount: 1\n", 23, "END"),
        (b"mrtrix tracks\ndatatype: Int16\nfile: . 46\nEND\n", 14, "Int16"),
        (b"mrtrix tracks\nfile: other.dat 0\nEND\n", 14, "other.dat"),
        (b"mrtrix tracks\nfile: . -3\nEND\n", 14, "-3"),
        (b"mrtrix tracks\nfile: . 3\nEND\n", 14, "byte 3"),
        (b"mrtrix tracks\nfile: . 99999999999999999999999\nEND\n", 14, "offset"),
        (b"mrtrix tracks\ncount: -4\nfile: . 40\nEND\n    ", 14, "-4"),
        (b"mrtrix tracks\ncount: many\nEND\n", 14, "many"),
    ],
)
def test_bad_headers(data, position, words, tmp_path):
    error = refused(tmp_path, data)
    assert error.position == position
    assert words in f"{error.found} {error.expected}"


def test_malformed_real_files(shared_data):
    with pytest.raises(FormatError, match="mrtrix tracks"):
        formats.read(shared_data / "nib_no_magic_number.tck")
    with pytest.raises(FormatError, match="END"):
        formats.read(shared_data / "nib_no_header_end.tck")
    assert len(formats.read(shared_data / "nib_empty.tck")) == 0
    assert formats.read(shared_data / "nib_matlab_nan.tck").dropped == {tck.FEWER: 614_999}


def test_no_file_line_and_windows_newlines(tmp_path):
    path = tmp_path / "a.tck"
    header = b"mrtrix tracks\r\ndatatype: Float32LE\r\nstep_size: 0.5\r\nEND\r\n"
    path.write_bytes(header + np.array([A, NAN, INF], "<f4").tobytes())
    assert formats.read(path).points.tolist() == [A]
    assert formats.info(path)["header"]["step_size"] == "0.5"


def test_points_are_written_as_float32_unless_doubles_are_asked_for(tmp_path):
    path = tmp_path / "a.tck"
    near = Streamlines(np.array([A, B]), [0, 2])
    formats.write(path, near)
    assert formats.info(path)["dtype"] == "float32"
    far = Streamlines(np.array([A, B]) * 1.1 - 1e6, [0, 2])
    error = np.abs(far.points.astype(np.float32) - far.points).max()
    with pytest.warns(UserWarning, match=rf"float32 moves points by up to {error:.2g} mm; doubles .*double=True"):
        formats.write(path, far)
    assert np.array_equal(nibabel.streamlines.load(path).streamlines[0], far.points.astype(np.float32))
    formats.write(path, far, double=True)
    assert formats.info(path)["dtype"] == "float64"
    assert np.array_equal(formats.read(path).points, far.points)
    with pytest.raises(ValueError, match=r"double is an option of \.tck and \.vtk files"):
        formats.write(tmp_path / "a.trk", far, double=True)
    with pytest.raises(ValueError, match="float32 cannot hold some coordinates"):
        formats.write(path, Streamlines(np.full((2, 3), 1e39), [0, 2]))


def test_a_failed_write_leaves_the_old_file(tmp_path):
    path = tmp_path / "a.tck"
    formats.write(path, rich())
    before = path.read_bytes()
    broken = rich()
    broken.points = broken.points[:5]
    with pytest.raises((ValueError, IndexError), match="shape mismatch|cannot assign|out of bounds"):
        formats.write(path, broken)
    assert path.read_bytes() == before
    assert [p.name for p in tmp_path.iterdir()] == ["a.tck"]
