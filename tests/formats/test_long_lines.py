"""A line longer than memory should hold comes from disk, in parts, and is what it is read whole."""

import gzip
import subprocess
import sys
import zipfile
from pathlib import Path

import numpy as np
import pytest

from pvfiblets import formats
from pvfiblets.codec import parameters
from pvfiblets.codec.encoding import encode
from pvfiblets.codec.encoding.encode import Encoder
from pvfiblets.codec.encoding.record_writer import join
from pvfiblets.codec.fibletset import FibletSet
from pvfiblets.codec.files import convert
from pvfiblets.codec.files.convert import compress_file
from pvfiblets.codec.files.file_error import measure_file_error
from pvfiblets.codec.parameters import Parameters, survey
from pvfiblets.formats import scratch
from pvfiblets.streamlines import Streamlines


def walk(n: int, noise: float, uneven: float = 0.0, seed: int = 0) -> np.ndarray:
    rng = np.random.default_rng(seed)
    way = np.cumsum(rng.normal(size=(n, 3)) * noise, axis=0) + [1.0, 0.0, 0.0]
    way *= 0.5 * (1.0 + uneven * rng.normal(size=(n, 1))) / np.linalg.norm(way, axis=1, keepdims=True)
    return np.cumsum(way, axis=0).astype(np.float32)


def lines(long: np.ndarray) -> Streamlines:
    whole = Streamlines.from_list([walk(90, 0.05), long, np.zeros((0, 3), np.float32), walk(70, 0.1)])
    whole.per_point = {"fa": np.linspace(0.0, 1.0, whole.n_points, dtype=np.float32)}
    whole.per_streamline = {"w": np.arange(4, dtype=np.float32)}
    return whole


@pytest.fixture
def short_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    """Have lines of 1,000 points count as very long."""
    monkeypatch.setattr(scratch, "LONG", 1000)
    monkeypatch.setattr(scratch, "SPAN", 370)
    monkeypatch.setattr(convert, "CHUNK_POINTS", 800)
    monkeypatch.setattr(parameters, "BLOCK_POINTS", 300)
    monkeypatch.setattr(encode, "LONG_PART", 300)


SETS = {
    "even": walk(3000, 0.05),
    "uneven": walk(3000, 0.05, 0.3),
    "sharp": walk(3000, 0.5, 0.1),
    "equal points": np.ones((3000, 3), np.float32),
}


@pytest.mark.parametrize("name", SETS)
def test_parts_of_a_line_are_coded_as_the_whole(name, monkeypatch) -> None:
    whole = lines(SETS[name])
    found = survey([whole])
    given = Parameters.choose(found)
    once = Encoder(given)
    expected = join([once.add(whole)])
    for part in (150, 777):
        monkeypatch.setattr(scratch, "LONG", 1000)
        monkeypatch.setattr(encode, "LONG_PART", part)
        monkeypatch.setattr(parameters, "BLOCK_POINTS", part)
        again = survey([whole])
        assert (again.longest, again.widest_end) == (found.longest, found.widest_end)
        coder = Encoder(given)
        chunks = list(coder.parts(whole))
        assert len(chunks) > 3
        for key, values in join(chunks).items():
            np.testing.assert_array_equal(values, expected[key], err_msg=key)
        np.testing.assert_array_equal(coder.page_table(), once.page_table())
        np.testing.assert_array_equal(coder.rank_to_id(), once.rank_to_id())
        assert (coder.parameters, coder.n_streamlines) == (once.parameters, once.n_streamlines)


def deflated(path: Path, target: Path) -> Path:
    with zipfile.ZipFile(path) as stored, zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as packed:
        for info in stored.infolist():
            packed.writestr(info.filename, stored.read(info))
    return target


def big_endian(path: Path, target: Path) -> Path:
    """Write the same .tck with numbers of the other order."""
    raw = path.read_bytes()
    offset = int(raw.split(b"file: . ")[1].split()[0])
    head = raw[:offset].replace(b"Float32LE", b"Float32BE")
    target.write_bytes(head + np.frombuffer(raw[offset:], "<f4").astype(">f4").tobytes())
    return target


def holes(path: Path, target: Path) -> Path:
    """Write the same .tck with points of the long line that are no numbers; those at its end cut nothing."""
    raw = bytearray(path.read_bytes())
    offset = int(bytes(raw).split(b"file: . ")[1].split()[0])
    for point in (91, 92, 91 + 2998):
        raw[offset + 12 * point + 4 : offset + 12 * point + 8] = np.float32(np.nan).tobytes()
    target.write_bytes(raw)
    return target


def zipped(path: Path, target: Path) -> Path:
    target.write_bytes(gzip.compress(path.read_bytes()))
    return target


def written(suffix: str):
    def write(streamlines: Streamlines, folder: Path) -> Path:
        formats.write(folder / f"a{suffix}", streamlines)
        return folder / f"a{suffix}"

    return write


def coded(exact: bool):
    def write(streamlines: Streamlines, folder: Path) -> Path:
        compress_file(written(".trx")(streamlines, folder), folder / "a.fiblets", exact=exact)
        return folder / "a.fiblets"

    return write


FILES = {
    "tck": written(".tck"),
    "tck of the other order": lambda s, f: big_endian(FILES["tck"](s, f), f / "b.tck"),
    "tck with holes": lambda s, f: holes(FILES["tck"](s, f), f / "c.tck"),
    "trk": written(".trk"),
    "trk.gz": lambda s, f: zipped(FILES["trk"](s, f), f / "a.trk.gz"),
    "trx": written(".trx"),
    "trx deflated": lambda s, f: deflated(FILES["trx"](s, f), f / "b.trx"),
    "fiblets": coded(exact=False),
    "exact fiblets": coded(exact=True),
}


@pytest.mark.filterwarnings("ignore:.*have no points")
@pytest.mark.parametrize("kind", FILES)
def test_a_long_line_comes_from_disk_as_it_is_read_whole(kind, tmp_path, short_memory) -> None:
    path = FILES[kind](lines(SETS["even"]), tmp_path)
    whole = formats.read(path)
    parts = list(formats.iter_chunks(path, 800))
    longest = max(parts, key=lambda part: part.n_points)
    assert longest.counts.max() >= 2990
    owner = longest.points
    while owner is not None and not isinstance(owner, np.memmap) and type(owner).__name__ != "mmap":
        owner = owner.obj if isinstance(owner, memoryview) else getattr(owner, "base", None)
    assert owner is not None, "it lies in memory"
    joined = Streamlines.concatenate(parts)
    np.testing.assert_array_equal(joined.points, whole.points)
    np.testing.assert_array_equal(joined.offsets, whole.offsets)
    assert joined.dropped == whole.dropped
    for part in ("per_point", "per_streamline"):
        for name, values in getattr(whole, part).items():
            np.testing.assert_array_equal(getattr(joined, part)[name], values)


def test_a_long_line_is_converted_and_measured_as_it_is_otherwise(tmp_path, request) -> None:
    path = FILES["trx deflated"](lines(SETS["uneven"]), tmp_path)
    plain = compress_file(path, tmp_path / "whole.fiblets", exact=False)
    request.getfixturevalue("short_memory")
    parts = compress_file(path, tmp_path / "parts.fiblets", exact=False)
    assert (tmp_path / "whole.fiblets").read_bytes() == (tmp_path / "parts.fiblets").read_bytes()
    for key in ("error_mm", "error_steps", "error_degrees"):
        assert parts[key] == pytest.approx(plain[key], rel=1e-12), key
    back = measure_file_error(tmp_path / "parts.fiblets", path)
    assert back.max_mm == plain["error_mm"]["max"]
    assert FibletSet.open(tmp_path / "parts.fiblets").per_point.keys() == {"fa"}


@pytest.mark.parametrize("cut", [4, 5000])
def test_a_truncated_long_line_is_reported(cut, tmp_path, short_memory) -> None:
    whole = lines(SETS["even"])
    for path in (FILES["tck"](whole[:2], tmp_path), FILES["trk"](whole[:2], tmp_path)):
        path.write_bytes(path.read_bytes()[:-cut])
        with pytest.raises(formats.FormatError, match="truncated"):
            list(formats.iter_chunks(path, 800))
    cut_gz = tmp_path / "b.trk.gz"
    cut_gz.write_bytes(gzip.compress((tmp_path / "a.trk").read_bytes()))
    with pytest.raises(formats.FormatError, match="truncated"):
        list(formats.iter_chunks(cut_gz, 800))


PEAK = """
import sys
from pvfiblets.codec.files import convert
from pvfiblets.codec import parameters
from pvfiblets.codec.encoding import encode
from pvfiblets.formats import scratch
scratch.LONG, scratch.SPAN = 200_000, 100_000
parameters.SAMPLED = convert.CHUNK_POINTS = parameters.BLOCK_POINTS = encode.LONG_PART = 100_000
convert.compress_file(sys.argv[1], sys.argv[2], exact=False)
status = dict(line.split(":", 1) for line in open("/proc/self/status"))
print(int(status["VmHWM"].split()[0]) / 1024)
"""


@pytest.mark.more
@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="peak memory is read from /proc")
def test_memory_does_not_grow_with_a_line(tmp_path) -> None:
    peaks = []
    for n in (1_500_000, 6_000_000):
        line = Streamlines(np.ones((n, 3), np.float32), [0, n])
        path = tmp_path / f"{n}.trx"
        formats.write(path, line)
        path = deflated(path, tmp_path / f"{n}d.trx")
        done = subprocess.run(
            [sys.executable, "-c", PEAK, str(path), str(tmp_path / f"{n}.fiblets")], capture_output=True, text=True
        )
        assert done.returncode == 0, done.stderr
        peaks.append(float(done.stdout))
    # 54 MB more of points; in memory they would take ten times as much.
    assert peaks[1] - peaks[0] < 40.0, peaks
