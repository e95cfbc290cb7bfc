"""TrackVis tracks: places against nibabel, byte orders, compression, and bad input."""

import gzip
import itertools
import struct
import warnings

import nibabel
import numpy as np
import pytest
from nibabel.streamlines.trk import TrkFile

from pvfiblets import formats
from pvfiblets.errors import FormatError
from pvfiblets.formats.trackvis import trk
from pvfiblets.invalid_points import CUT, NONFINITE
from pvfiblets.streamlines import Streamlines

from .samples import rich, same

COUNTS = (5, 1, 12, 3, 2, 7)


def nibabel_load(path):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # nibabel tells of defaults that it fills in
        return nibabel.streamlines.load(path)


def assert_agrees(path) -> Streamlines:
    theirs = nibabel_load(path)
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "voxel size|.*no voxel-to-RAS matrix")
        ours = formats.read(path)
    points = np.reshape(theirs.streamlines.get_data(), (-1, 3))
    if not ours.space["affine_recorded"]:  # nibabel takes voxels of 1 mm then
        points = points * ours.affine.diagonal()[:3]
    assert ours.counts.tolist() == [len(t) for t in theirs.streamlines]
    assert np.allclose(ours.points, points, rtol=0, atol=2e-5 * max(1, np.abs(points).max(initial=0) / 100))
    for part, columns in (
        (ours.per_point, theirs.tractogram.data_per_point),
        (ours.per_streamline, theirs.tractogram.data_per_streamline),
    ):
        assert list(part) == [name.rstrip() for name in columns]
        for name, values in columns.items():
            flat = values.get_data() if hasattr(values, "get_data") else np.asarray(values)
            mine = part[name.rstrip()]
            assert np.array_equal(mine.reshape(len(mine), -1), flat)
    return ours


@pytest.fixture
def file(tmp_path):
    """A trk file; without empty streamlines, which nibabel loses."""
    path = tmp_path / "a.trk"
    formats.write(path, rich(counts=COUNTS))
    return path


def refused(path, data: bytes) -> FormatError:
    path.write_bytes(data)
    with pytest.raises(FormatError) as caught:
        formats.read(path)
    with pytest.raises(FormatError):
        list(formats.iter_chunks(path, 2))
    return caught.value


def test_real_files_land_where_nibabel_puts_them(shared_data):
    paths = sorted([*shared_data.glob("*.trk"), *shared_data.glob("*.trk.gz")])
    assert len(paths) >= 8
    for path in paths:
        assert_agrees(path)


def test_files_packaged_with_nibabel(tmp_path):
    folder = nibabel.streamlines.__path__[0] + "/../tests/data/"
    from pathlib import Path

    paths = sorted(Path(folder).glob("*.trk"))
    if not paths:
        pytest.skip("nibabel is installed without its test data: real data is not on this machine")
    for path in paths:
        assert_agrees(path)


ORDERS = ["".join(order) for axes in itertools.permutations(("LR", "PA", "SI")) for order in itertools.product(*axes)]


@pytest.mark.parametrize("order", ORDERS)
def test_every_voxel_order_with_an_oblique_affine(order, tmp_path):
    header = TrkFile.create_empty_header()
    angle = 0.3
    turn = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
    affine = np.eye(4)
    affine[:3, :3] = turn @ np.diag([-1.5, 2, 3])
    affine[:3, 3] = 12, -30, 7
    header.update(voxel_order=order.encode(), voxel_to_rasmm=affine, voxel_sizes=(1.5, 2, 3), dimensions=(40, 50, 60))
    streamlines = [np.float32([[1, 2, 3], [10, 20, 30]]), np.float32([[-4, 5.5, 0]])]
    tractogram = nibabel.streamlines.Tractogram(streamlines, affine_to_rasmm=np.eye(4))
    path = tmp_path / "a.trk"
    TrkFile(tractogram, header).save(str(path))
    ours = assert_agrees(path)
    assert np.allclose(ours.points, np.concatenate(streamlines), atol=1e-4)
    formats.write(tmp_path / "b.trk", ours)
    again = assert_agrees(tmp_path / "b.trk")
    assert np.allclose(again.points, ours.points, atol=1e-4)
    assert again.space["voxel_order"] == order


def test_written_files_are_read_by_nibabel(file):
    ours = assert_agrees(file)
    s = rich(counts=COUNTS)
    same(ours, s, atol=1e-4)
    assert np.allclose(ours.affine, s.affine)
    header = nibabel_load(file).header
    assert header["nb_streamlines"] == len(s)
    assert header["voxel_order"] == b"LAS"
    assert formats.write(file, s) == ["groups", "per_group"]


def big_endian(data: bytes) -> bytes:
    """The same file as a big-endian machine writes it."""
    kind = np.frombuffer(data[:1000], TrkFile._default_structarr("little").dtype)
    header = kind.astype(kind.dtype.newbyteorder(">")).tobytes()
    return header + np.frombuffer(data[1000:], "<u4").astype(">u4").tobytes()


def test_big_endian(file):
    s = formats.read(file)
    file.write_bytes(big_endian(file.read_bytes()))
    assert_agrees(file)
    same(formats.read(file), s)
    same(Streamlines.concatenate(formats.iter_chunks(file, 3)), s)


def test_gzip_streams_in_pieces(file, tmp_path):
    packed = tmp_path / "a.trk.gz"
    packed.write_bytes(gzip.compress(file.read_bytes()))
    s = formats.read(file)
    same(formats.read(packed), s)
    for max_points in (1, 5, 100):
        pieces = list(formats.iter_chunks(packed, max_points))
        assert all(len(p) == 1 or p.n_points <= max_points for p in pieces)
        same(Streamlines.concatenate(pieces), s)
    with pytest.raises(formats.UnknownFormatError, match=r"\.trk\.gz has no write"):
        formats.write(tmp_path / "b.trk.gz", s)


def patched(data: bytes, position: int, form: str, *values) -> bytes:
    raw = bytearray(data)
    struct.pack_into(form, raw, position, *values)
    return bytes(raw)


@pytest.mark.parametrize(
    ("position", "form", "values", "at", "words"),
    [
        (0, "5s", [b"TRASH"], 0, "TRACK"),
        (996, "<i", [999], 996, "1000"),
        (992, "<i", [7], 992, "version 7"),
        (988, "<i", [-1], 988, "-1"),
        (36, "<h", [-1], 36, "scalars -1"),
        (238, "<h", [-2], 238, "properties -2"),
        (12, "<f", [-1.0], 12, "voxel size"),
        (12, "<f", [np.nan], 12, "voxel size"),
        (440, "<f", [np.inf], 440, "invertible"),
        (440, "<f", [0.0], 440, "invertible"),
        (948, "4s", [b"XYZ"], 948, "XYZ"),
        (948, "4s", [b"LLS"], 948, "LLS"),
        (38, "20s", [b"fa\x0099"], 38, "99 columns"),
        (1000, "<i", [-5], 1000, "-5 points"),
        (1000, "<i", [2**31 - 1], 0, "truncated"),
    ],
)
def test_damaged_fields(file, position, form, values, at, words):
    error = refused(file, patched(file.read_bytes(), position, form, *values))
    assert at in (0, error.position)
    assert words in f"{error.found} {error.expected}"


@pytest.mark.parametrize("zeros", [(0,), (0, 1, 2), (2,)])
@pytest.mark.parametrize("order", ["RAS", "LPS", "SPL"])
def test_voxels_of_size_0_have_the_size_that_the_matrix_says(tmp_path, order, zeros):
    """The file with its sizes, by nibabel, is what the one without them must be read as."""
    lines = rich(counts=COUNTS)
    lines.affine = np.diag([2.0, 3.0, 4.0, 1.0]) @ nibabel.affines.from_matvec(np.eye(3), [1, 2, 3])
    sizes = nibabel.orientations.apply_orientation(
        np.arange(24).reshape(2, 3, 4),
        nibabel.orientations.ornt_transform(
            nibabel.orientations.axcodes2ornt("RAS"), nibabel.orientations.axcodes2ornt(order)
        ),
    ).shape
    lines.space = {"dimensions": (20, 30, 40), "voxel_order": order, "voxel_sizes": np.array(sizes, float)}
    path = tmp_path / "a.trk"
    formats.write(path, lines)
    whole = path.read_bytes()
    want = assert_agrees(path)
    for axis in zeros:
        path.write_bytes(patched(path.read_bytes(), 12 + 4 * axis, "<f", 0.0))
    with pytest.warns(UserWarning, match="voxel size is .*0.0.* is taken, by the voxel-to-RAS matrix"):
        found = formats.read(path)
    np.testing.assert_array_equal(found.points, want.points)
    assert tuple(found.space["voxel_sizes"]) == sizes
    formats.write(path, found)
    assert path.read_bytes()[12:24] == whole[12:24]


def test_voxels_of_size_0_and_no_matrix_are_of_1_mm(file):
    data = patched(file.read_bytes(), 440, "<16f", *[0.0] * 16)
    file.write_bytes(patched(data, 12, "<3f", 1.0, 1.0, 1.0))
    want = assert_agrees(file)
    file.write_bytes(patched(data, 12, "<3f", 0.0, 0.0, 0.0))
    with pytest.warns(UserWarning, match="voxel size is"), pytest.warns(UserWarning, match="no voxel-to-RAS matrix"):
        np.testing.assert_array_equal(formats.read(file).points, want.points)


@pytest.mark.parametrize("lost", [1, 4, 30])
def test_truncated_in_the_data(file, lost):
    data = file.read_bytes()
    for count in (None, 0):
        bad = data[:-lost] if count is None else patched(data[:-lost], 988, "<i", count)
        error = refused(file, bad)
        assert error.position >= len(data) - 60


def test_truncated_in_the_header_or_count_larger_than_the_data(file):
    whole = file.read_bytes()
    assert refused(file, whole[:700]).position == 700
    assert refused(file, b"").position == 0
    error = refused(file, patched(whole, 988, "<i", 7))
    assert "after 6 streamlines" in error.found
    assert "7 streamlines" in error.expected


def test_count_smaller_than_the_data_is_reported(file, tmp_path):
    s = formats.read(file)
    data = patched(file.read_bytes(), 988, "<i", 4)
    file.write_bytes(data)
    # Two streamlines of 2 and 7 points: a count, 7 numbers each with scalars, 3 properties.
    part = {trk.AFTER_LAST: 4 * ((1 + 2 * 7 + 3) + (1 + 7 * 7 + 3))}
    short = formats.read(file)
    same(short, s[:4])
    assert short.dropped == part
    packed = tmp_path / "b.trk.gz"
    packed.write_bytes(gzip.compress(data))
    assert formats.read(packed).dropped == part
    assert Streamlines.concatenate(formats.iter_chunks(packed, 4)).dropped == part


def test_count_zero_reads_to_the_end_and_nan_among_scalars_is_data(file):
    s = formats.read(file)
    file.write_bytes(patched(file.read_bytes(), 988, "<i", 0))
    same(formats.read(file), s)
    file.write_bytes(patched(file.read_bytes(), 1000 + 4 + 12, "<f", np.nan))
    s = formats.read(file)
    assert s.dropped == {}
    assert np.isnan(s.per_point["fa"][0])


def test_lines_are_cut_at_nonfinite_points(file):
    s = formats.read(file)
    # First streamline: 5 points of 7 numbers after its count.
    file.write_bytes(patched(file.read_bytes(), 1000 + 4 + 2 * 28, "<f", np.nan))
    bad = formats.read(file)
    assert bad.dropped == {NONFINITE: 1, CUT: 1}
    assert bad.counts.tolist() == [2, 2, *s.counts[1:]]
    assert np.array_equal(bad.per_streamline["weight"], s.per_streamline["weight"][[0, *range(len(s))]])
    assert np.array_equal(bad.per_point["fa"], np.delete(s.per_point["fa"], 2))


def test_a_missing_matrix_is_that_of_the_voxels(file):
    """Voxels of 2 x 2.5 x 3 mm in the order LAS; nibabel's identity counts voxels where these are millimetres."""
    for data in (patched(file.read_bytes(), 992, "<i", 1), patched(file.read_bytes(), 440, "<16f", *[0.0] * 16)):
        file.write_bytes(data)
        told = r"has no voxel-to-RAS matrix; its voxel size 2 x 2\.5 x 3 mm and voxel order LAS are used"
        with pytest.warns(UserWarning, match=told):
            s = formats.read(file)
        with pytest.warns(nibabel.streamlines.tractogram_file.HeaderWarning):
            voxels = nibabel.streamlines.load(file).streamlines.get_data()
        np.testing.assert_allclose(s.points, voxels * [2.0, 2.5, 3.0], atol=1e-3)
        assert np.array_equal(s.affine, np.diag([2.0, 2.5, 3.0, 1.0]))
        assert s.space["affine_recorded"] is False
        formats.write(file, s)
        with pytest.warns(UserWarning, match=told):  # written, it has none either
            again = formats.read(file)
        np.testing.assert_allclose(again.points, s.points, atol=1e-4)


def test_damaged_gzip(file, tmp_path):
    packed = gzip.compress(file.read_bytes())
    path = tmp_path / "b.trk.gz"
    for bad in (packed[:-9], packed[:200], b"no gzip at all", packed[:60] + b"\xff\xff" + packed[62:]):
        path.write_bytes(bad)
        with pytest.raises(FormatError):
            formats.read(path)


def test_far_from_the_origin_keeps_float32_precision(tmp_path):
    s = rich()
    s.affine = s.affine.copy()
    s.affine[:3, 3] += 2**20
    s = Streamlines(s.points.astype(np.float64) + 2**20, s.offsets, affine=s.affine, space=s.space)
    formats.write(tmp_path / "a.trk", s)
    # The file counts from the image's corner, so only the result's float32 is coarse: 2^20 / 2^24.
    assert np.abs(formats.read(tmp_path / "a.trk").points - s.points).max() <= 0.0626


def test_a_signalling_nan_is_left_out_without_a_warning(tmp_path):
    """Widening such a number makes the processor complain."""
    path = tmp_path / "a.trk"
    formats.write(path, Streamlines(np.arange(12.0, dtype=np.float32).reshape(4, 3), [0, 4]))
    data = bytearray(path.read_bytes())
    data[1004 + 12 : 1004 + 16] = (0x7F800001).to_bytes(4, "little")  # behind the header and the count: point 1's x
    path.write_bytes(data)
    s = formats.read(path)
    assert s.n_points == 3
    assert s.dropped == {NONFINITE: 1, CUT: 1}
