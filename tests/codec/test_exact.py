"""Sets that keep every bit of their points: small ones by default, and those that coding would enlarge."""

import json
import subprocess
import sys
import zipfile

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import pvfiblets as pf
from pvfiblets.cli.command import main
from pvfiblets.codec.decompress import decode_fiblets
from pvfiblets.codec.files import exact_file
from pvfiblets.codec.files.exact_file import FORMS, pack_points, unpack_points
from pvfiblets.codec.files.fiblets_format import verify_file
from pvfiblets.codec.layout import MAX_POINTS, PLAIN_POINTS, unpack
from pvfiblets.errors import FormatError
from pvfiblets.formats import read, write
from pvfiblets.report.studies.decode.reference import decode_lattice
from pvfiblets.streamlines import Streamlines

from .samples import extremes, noisy, smooth, wandering
from .test_extract import assert_equal, with_groups

CASES = {**extremes(), "wandering": wandering(), "smooth": smooth(6), "noisy": noisy(6)}
CASES["float32"] = Streamlines(wandering(40).points.astype(np.float32), wandering(40).offsets)


def drawn(fiblets):
    """What records decode to, which is what a GPU draws."""
    points = np.empty((fiblets.n_points, 3))
    decode_fiblets(fiblets, np.arange(fiblets.n_fiblets), fiblets.fiblet_points(), points)
    return points


def same_points(fiblets, lines):
    back = fiblets.decompress()
    assert back.points.dtype == lines.points.dtype
    np.testing.assert_array_equal(back.points, lines.points)
    np.testing.assert_array_equal(back.offsets, lines.offsets)


@pytest.mark.few(9)
@pytest.mark.parametrize("name", CASES)
def test_every_bit_is_kept_in_memory_and_in_files(name, tmp_path):
    lines = CASES[name]
    fiblets = pf.compress(lines, exact=True)
    fiblets.verify()
    same_points(fiblets, lines)
    error = pf.measure_error(lines, fiblets)
    assert error.max_mm == 0.0
    assert not error.max_degrees > 0.0  # NaN where no line has a direction
    away = np.abs(drawn(fiblets) - lines.points).max(initial=0.0)
    assert away <= fiblets.promise
    extent = np.ptp(lines.points, axis=0).max() if lines.n_points else 0.0
    far = np.abs(lines.points).max(initial=0.0)
    assert fiblets.promise <= 1e-8 * extent + 1e-14 * far + 1e-130
    fiblets.save(tmp_path / "a.fiblets")
    verify_file(tmp_path / "a.fiblets")
    opened = pf.FibletSet.open(tmp_path / "a.fiblets")
    same_points(opened, lines)
    for field in ("anchors", "anchors_low", "decoding", "reach", "codes", "ends", "pages", "rank_to_id"):
        np.testing.assert_array_equal(getattr(opened, field), getattr(fiblets, field))
    assert opened.parameters == fiblets.parameters
    assert opened.bounds == fiblets.bounds


def test_records_decode_as_the_reference_says():
    lines = wandering(20, 60)
    fiblets = pf.compress(lines, exact=True)
    counts = unpack("last", fiblets.decoding).astype(int) + 1
    assert counts.max() <= PLAIN_POINTS < MAX_POINTS
    assert counts.min() > 1
    points, firsts = drawn(fiblets), fiblets.fiblet_points()
    codes = unpack("code", fiblets.decoding)
    for f in range(fiblets.n_fiblets):
        mine = points[firsts[f] : firsts[f] + counts[f]]
        again = decode_lattice(mine[0], 3, 0, 0, fiblets.lattice, fiblets.codes[codes[f] :], counts[f])
        np.testing.assert_allclose(mine, again, atol=1e-12)


@pytest.mark.parametrize("mapped", [False, True])
def test_parts_and_joins_keep_every_bit(mapped, tmp_path):
    lines = with_groups()
    whole = pf.compress(lines, exact=True, per_point=["height", "fine"], per_point_bits=16)
    if mapped:
        whole.save(tmp_path / "a.fiblets")
        whole = pf.FibletSet.open(tmp_path / "a.fiblets")
    rng = np.random.default_rng(0)
    for ids in (np.array([5]), rng.permutation(73)[:30], np.arange(73)):
        part = whole.extract(ids)
        assert_equal(part, whole.decompress(ids, dtype=np.float64), whole)
        np.testing.assert_array_equal(part.decompress().points, lines[ids].points)
        part.save(tmp_path / "b.fiblets")
        opened = pf.FibletSet.open(tmp_path / "b.fiblets")
        assert_equal(opened, whole.decompress(ids, dtype=np.float64), opened)
    both = whole[:40] + whole[40:]
    same_points(both, lines)
    assert both.exact is not None
    other = pf.compress(smooth(3), exact=True)
    joined = pf.FibletSet.concatenate([pf.compress(wandering(5), exact=True), other])
    same_points(joined, Streamlines.concatenate([wandering(5), smooth(3)]))
    chunks = list(whole.iter_chunks(100))
    np.testing.assert_array_equal(np.concatenate([c.points for c in chunks]), lines.points)
    mixed = other + pf.compress(smooth(3), exact=False)
    assert mixed.exact is None


@pytest.mark.usefixtures("usual_limits")
def test_small_sets_are_exact_unless_something_is_asked_of_coding():
    lines = smooth(4)
    assert pf.compress(lines).exact is not None
    for asked in ({"max_error": 0.01}, {"max_angle": 5.0}, {"effort": "high"}, {"order": "hilbert"}, {"exact": False}):
        assert pf.compress(lines, **asked).exact is None
    with pytest.raises(ValueError, match="exact=True keeps the points as they are, and step=0.5 would"):
        pf.compress(lines, exact=True, step=0.5)
    large = smooth(400, 110)  # 132,000 bytes a coordinate, 8 bytes each
    assert large.points.nbytes > 1_000_000
    assert pf.compress(large).exact is None


@pytest.mark.more
@pytest.mark.usefixtures("usual_limits")
def test_sets_that_coding_would_enlarge_are_kept_as_they_are(tmp_path, capsys):
    rng = np.random.default_rng(0)
    ends = rng.uniform(-80, 80, (60_000, 2, 3)).astype(np.float32)
    lines = Streamlines(ends.reshape(-1, 3), np.arange(60_001) * 2)
    raw = lines.points.nbytes + 4 * len(lines)
    assert raw > 1_000_000
    for fiblets in (pf.compress(lines), pf.compress(lines, max_error=0.1)):
        assert fiblets.nbytes <= raw
        same_points(fiblets, lines)
    assert pf.compress(lines, exact=False).nbytes > lines.points.nbytes
    write(tmp_path / "a.trk", lines)
    assert main(["convert", str(tmp_path / "a.trk"), str(tmp_path / "a.fiblets"), "--json"]) == 0
    result = json.loads(capsys.readouterr().out)
    assert result["exact"]
    assert result["error_mm"]["max"] == 0.0
    assert result["bytes"] < 24 * len(lines) + 1000
    np.testing.assert_array_equal(read(tmp_path / "a.fiblets").points, read(tmp_path / "a.trk").points)


@pytest.mark.usefixtures("usual_limits")
def test_lines_of_two_points_that_share_ends_take_twelve_bytes(shared_data, tmp_path):
    source = shared_data / "vtk_Coastlines_Los_Alamos.vtp"
    lines = read(source)
    report = pf.compress_file(source, tmp_path / "a.fiblets")
    assert report["exact"]
    assert report["bytes"] <= 12 * len(lines)
    same_points(pf.FibletSet.open(tmp_path / "a.fiblets"), lines)


@pytest.mark.usefixtures("usual_limits")
@pytest.mark.parametrize(
    "name", ["dipy_EuDX_small_25.trk", "nv_tract.SLF1_R.tck", "trxpy_small.trx", "nib_matlab_nan.tck"]
)
def test_small_real_files_shrink_without_loss(shared_data, tmp_path, name, capsys):
    source, target = shared_data / name, tmp_path / "a.fiblets"
    assert main(["convert", str(source), str(target)]) == 0
    assert "exact" in capsys.readouterr().out
    header = len(str(pf.read(source).space))  # kept as text, uncompressed
    assert target.stat().st_size - header < source.stat().st_size
    np.testing.assert_array_equal(read(target).points, read(source).points)
    assert main(["info", str(target)]) == 0
    assert "exact            yes" in capsys.readouterr().out
    assert main(["verify", str(target), str(source)]) == 0


@pytest.mark.usefixtures("usual_limits")
def test_the_file_and_memory_hold_the_same(tmp_path):
    lines = with_groups()
    write(tmp_path / "a.trx", lines)
    source = read(tmp_path / "a.trx")
    report = pf.compress_file(tmp_path / "a.trx", tmp_path / "a.fiblets", per_point="all")
    made, opened = pf.compress(source, per_point="all"), pf.FibletSet.open(tmp_path / "a.fiblets")
    assert_equal(opened, made.decompress(dtype=np.float64), made)
    assert report["per_point"] == list(made.per_point) == list(opened.per_point)
    assert opened.dropped == made.dropped
    assert tuple(opened.space["dimensions"]) == made.space["dimensions"]
    np.testing.assert_array_equal(opened.affine, made.affine)


def header_of(path):
    with zipfile.ZipFile(path) as archive:
        return json.loads(archive.read("header.json"))


def with_header(path, **changes):
    """The file with other values in its header."""
    with zipfile.ZipFile(path) as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    members["header.json"] = json.dumps({**json.loads(members["header.json"]), **changes}).encode()
    with zipfile.ZipFile(path, "w") as archive:
        for name, content in members.items():
            archive.writestr(name, content)


def test_older_programs_are_told_and_older_files_are_read(tmp_path):
    """Files of codes are of version 2, which older programs read; those of exact points of one that they refuse."""
    pf.compress(smooth(3)).save(tmp_path / "coded.fiblets")
    pf.compress(smooth(3), exact=True).save(tmp_path / "exact.fiblets")
    assert header_of(tmp_path / "coded.fiblets")["version"] == 2
    assert header_of(tmp_path / "exact.fiblets")["version"] == 3
    with_header(tmp_path / "exact.fiblets", version=6)  # what version 3 is to a program of version 2
    with pytest.raises(FormatError, match="version 6 in header.json, expected at most 5: update pvfiblets"):
        pf.FibletSet.open(tmp_path / "exact.fiblets")


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"n_points": 10**12}, "as many as these hold"),
        ({"n_points": 451}, "bytes of exact points"),
        ({"n_points": -1}, "as many as these hold"),
        ({"n_streamlines": 4}, "bytes of exact points"),
        ({"exact": {"member": "exact.npy", "form": 7, "float": 8, "count": 1}}, "a form below 3"),
        ({"exact": {"member": "other.npy", "form": 1, "float": 8, "count": 1}}, "does not fit its members"),
        ({"exact": None}, "does not fit its members"),
    ],
)
def test_damaged_headers_are_named(tmp_path, changes, says):
    pf.compress(smooth(3), exact=True).save(tmp_path / "a.fiblets")
    with_header(tmp_path / "a.fiblets", **changes)
    with pytest.raises(FormatError, match=says):
        pf.FibletSet.open(tmp_path / "a.fiblets")


def test_damaged_points_are_found(tmp_path):
    path = tmp_path / "a.fiblets"
    pf.compress(smooth(3), exact=True).save(path)
    whole = path.read_bytes()
    for at in range(0, len(whole), 97):
        path.write_bytes(whole[:at] + bytes([whole[at] ^ 16]) + whole[at + 1 :])
        try:
            same_points(pf.FibletSet.open(path), smooth(3))
        except FormatError:
            continue
        except AssertionError:  # a changed header may be one, too
            with pytest.raises(FormatError):
                verify_file(path)


@given(st.data())
def test_points_come_back_from_their_bytes(data):
    kind = data.draw(st.sampled_from([np.float32, np.float64]))
    counts = np.array(data.draw(st.lists(st.integers(0, 300), max_size=8)), np.int64)
    rng = np.random.default_rng(data.draw(st.integers(0, 99)))
    n = int(counts.sum())
    points = data.draw(
        st.sampled_from([rng.normal(size=(n, 3)) * 80, np.cumsum(rng.normal(size=(n, 3)), axis=0), np.zeros((n, 3))])
    ).astype(kind)
    facts, packed = pack_points(points, counts)
    for form in range(FORMS):
        raw = np.frombuffer(exact_file._TO[form](points), np.uint8)
        np.testing.assert_array_equal(exact_file._FROM[form](raw, kind().itemsize), points)
    again, lengths = unpack_points("a", facts, packed, len(counts), n)
    assert again.dtype == kind
    np.testing.assert_array_equal(again, points)
    np.testing.assert_array_equal(lengths, counts)


def test_no_compiler_is_loaded_for_small_sets(tmp_path):
    write(tmp_path / "a.tck", wandering(20))
    program = (
        "import sys, pvfiblets as pf; from pvfiblets.cli.command import main\n"
        f"assert pf.compress(pf.read({str(tmp_path / 'a.tck')!r})).exact is not None\n"
        f"assert main(['convert', {str(tmp_path / 'a.tck')!r}, {str(tmp_path / 'a.fiblets')!r}]) == 0\n"
        f"pf.FibletSet.open({str(tmp_path / 'a.fiblets')!r}).decompress()\n"
        "assert 'numba' not in sys.modules"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_a_promise_about_exact_points_is_refused(tmp_path):
    lines = Streamlines.from_list([np.cumsum(np.full((40, 3), 0.5), axis=0)])
    with pytest.raises(ValueError, match=r"keeps every bit of the points; leave max_error=0\.1 out"):
        pf.compress(lines, exact=True, max_error=0.1)
    with pytest.raises(ValueError, match="exact is 'yes'; True, False or None is needed"):
        pf.compress(lines, exact="yes")
    pf.write(tmp_path / "a.tck", lines)
    with pytest.raises(ValueError, match="leave max_error=0"):
        pf.compress_file(tmp_path / "a.tck", tmp_path / "a.fiblets", exact=True, max_error=0.1)
