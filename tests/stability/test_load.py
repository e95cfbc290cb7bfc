"""Files are converted in memory that does not grow with them: a billion points take what a million do."""

import mmap
import sys
from pathlib import Path

import numpy as np
import pytest

from pvfiblets import formats
from pvfiblets.formats.mapped import forget
from pvfiblets.streamlines import Streamlines

from . import conversions

pytestmark = pytest.mark.more

LINUX = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="resident memory is read from /proc")

CHUNK = 100_000
SIZES = {True: (400_000, 3_200_000), False: (1_200_000, 7_200_000)}
"""Points, by whether fiblets are made of them. Writers of other formats hold a million points at a time."""

MOST = {True: 7.0, False: 6.0}
"""Bytes of memory per point of the file. A file held in memory is 12; offsets of lines of 250 points are 0.03 each.
What is allocated and given back meanwhile makes the peak uncertain by up to 20 MB."""


PAIRS = [
    (".tck", ".fiblets"), (".trk", ".fiblets"), (".trx", ".fiblets"), (".fiblets", ".fiblets"),
    (".tck", ".trx"), (".trk", ".tck"), (".trx", ".trk"),
]  # fmt: skip


@pytest.fixture(scope="module")
def converted(tmp_path_factory):
    """Convert a small and a large file of every pair, all in one process; return what each took."""
    folder = tmp_path_factory.mktemp("conversions")
    jobs = []
    for suffix, target in PAIRS:
        for n in SIZES[target == ".fiblets"]:
            source = folder / f"{n}{suffix}"
            if suffix != ".fiblets":
                conversions.made(source, n)
            # The first pair makes the .fiblets files that another reads.
            name = f"{n}" if suffix == ".tck" else "out"
            jobs.append((source, folder / f"{name}{target}"))
    warm = jobs[0]  # what is loaded and compiled by the first conversion is no growth
    rows = conversions.converted(warm, *jobs, chunk_points=CHUNK)[1:]
    return {pair: rows[2 * i : 2 * i + 2] for i, pair in enumerate(PAIRS)}


@LINUX
@pytest.mark.timeout(900)
@pytest.mark.parametrize("pair", PAIRS, ids="-".join)
def test_peak_memory_is_alike_for_many_times_the_points(converted, pair):
    rows, compressed = converted[pair], pair[1] == ".fiblets"
    assert [row["points"] for row in rows] == [*SIZES[compressed]]
    assert [row["streamlines"] for row in rows] == [n // conversions.LENGTH for n in SIZES[compressed]]
    assert not any(row["dropped"] for row in rows)
    assert conversions.slope(rows) < MOST[compressed], [row["peak_mb"] for row in rows]


def test_pieces_hold_the_points_asked_for():
    pieces = list(conversions.chunks(1_234_567))
    assert sum(piece.n_points for piece in pieces) == 1_234_567
    steps = np.linalg.norm(np.diff(pieces[1][7].astype(float), axis=0), axis=1)
    np.testing.assert_allclose(steps, conversions.STEP, rtol=1e-4)
    assert not np.array_equal(pieces[0][0], pieces[1][0])


def resident(path: Path) -> int:
    """Return how many bytes of maps of a file are in memory."""
    total, ours = 0, False
    for line in Path("/proc/self/smaps").read_text(encoding="utf-8").splitlines():
        first, *rest = line.split()
        if not first.endswith(":"):
            ours = rest[-1:] == [str(path)]
        elif ours and first == "Rss:":
            total += 1024 * int(rest[0])
    return total


@LINUX
@pytest.mark.parametrize("suffix", [".tck", ".trk", ".trx"])
@pytest.mark.parametrize("kind", ["f4", "f8"])
def test_writing_mapped_points_leaves_none_of_them_in_memory(tmp_path, suffix, kind):
    n = 2_400_000
    points = np.memmap(tmp_path / "points", kind, "w+", shape=(n, 3))
    points[:] = np.arange(n)[:, None]
    values = np.memmap(tmp_path / "values", kind, "w+", shape=(n,))
    values[:] = 7.0
    per_point = {} if suffix == ".tck" else {"v": values}
    whole = Streamlines(points, np.arange(0, n + 1, 300), per_point=per_point)
    formats.write(tmp_path / f"a{suffix}", whole)
    assert resident(tmp_path / "points") < 3_000_000  # the last block's neighbourhood
    if per_point:
        assert resident(tmp_path / "values") < 3_000_000
    again = formats.read(tmp_path / f"a{suffix}")
    np.testing.assert_allclose(again.points, points, rtol=1e-6)
    np.testing.assert_array_equal(points[:, 0], np.arange(n).astype(kind))


def test_forgetting_keeps_changes_that_are_in_memory_only(tmp_path):
    """A private map's changes would be lost with its pages."""
    np.arange(9000.0).tofile(tmp_path / "a")
    private = np.memmap(tmp_path / "a", "f8", "c")
    private[:] = -1.0
    forget(np.asarray(private)[10:], 0, 8000)
    assert (private == -1.0).all()
    inside = np.asarray(np.memmap(tmp_path / "a", "f8", "r+", offset=8, shape=(8000,))[100:])
    inside[:] = 5.0
    forget(inside, 0, len(inside))
    assert (inside == 5.0).all()
    forget(np.arange(5.0), 0, 5)


def test_forgetting_reads_anew_what_a_plain_map_only_reads(tmp_path):
    np.arange(90_000.0).tofile(tmp_path / "a")
    with (tmp_path / "a").open("r+b") as file:
        for access, dropped in ((mmap.ACCESS_READ, True), (mmap.ACCESS_COPY, False)):
            plain = mmap.mmap(file.fileno(), 0, access=access)
            array = np.frombuffer(plain, "f8")
            if access == mmap.ACCESS_COPY:
                array[:] = -1.0
            assert array.sum() != 0.0
            forget(array[10:], 0, len(array) - 10)
            if LINUX.args[0] is False:
                assert (resident(tmp_path / "a") < 20_000) == dropped
            assert (array == (np.arange(90_000.0) if dropped else -1.0)).all()
            del array
            plain.close()
