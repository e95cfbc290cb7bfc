"""Pieces joined on disk equal pieces joined in memory, and streaming keeps memory flat."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from pvfiblets import formats
from pvfiblets.formats.spool import gathered
from pvfiblets.streamlines import Streamlines


def rich() -> Streamlines:
    rng = np.random.default_rng(0)
    offsets = np.array([0, 4, 4, 9, 30, 31])
    return Streamlines(
        rng.normal(size=(31, 3)).astype(np.float32),
        offsets,
        per_point={"fa": rng.normal(size=31), "rgb": rng.integers(0, 255, (31, 3)).astype(np.uint8)},
        per_streamline={"w": rng.normal(size=5)},
        groups={"left": [0, 3, 4], "none": []},
        per_group={"left": {"colour": [1, 2, 3]}},
        affine=np.diag([2.0, 2.0, 2.0, 1.0]),
        space={"dimensions": (3, 4, 5)},
        dropped={"reason": 3},
    )


def test_gathered_pieces_are_the_whole(tmp_path: Path) -> None:
    whole = rich()
    pieces = [whole[:2], whole[2:3], whole[3:]]
    for piece in pieces[1:]:
        piece.dropped = {}
    with gathered(pieces, tmp_path) as joined:
        np.testing.assert_array_equal(joined.points, whole.points)
        np.testing.assert_array_equal(joined.offsets, whole.offsets)
        for part in ("per_point", "per_streamline", "groups"):
            assert list(getattr(joined, part)) == list(getattr(whole, part))
            for name, values in getattr(whole, part).items():
                np.testing.assert_array_equal(getattr(joined, part)[name], values)
        assert joined.dropped == {"reason": 3}
        assert joined.space == whole.space
        formats.write(tmp_path / "a.trx", joined)
    assert [p.name for p in tmp_path.iterdir()] == ["a.trx"], "temporary files must go"
    np.testing.assert_array_equal(formats.read(tmp_path / "a.trx").points, whole.points)


def test_an_array_without_columns_is_refused_by_trx(tmp_path: Path) -> None:
    lines = Streamlines(np.zeros((2, 3)), [0, 2], per_streamline={"empty": np.zeros((1, 0))})
    with pytest.raises(ValueError, match="'dps/empty' has no columns; remove it"):
        formats.write(tmp_path / "a.trx", lines)


def test_pieces_with_other_columns_are_refused(tmp_path: Path) -> None:
    whole = rich()
    other = Streamlines(np.zeros((1, 3)), [0, 1])
    with pytest.raises(ValueError, match=r"per_point is \[\] from streamline 5 on"), gathered([whole, other], tmp_path):
        pass
    with pytest.raises(ValueError, match="no pieces"), gathered([], tmp_path):
        pass


PEAK = """
import sys
import pvfiblets.codec.files.convert
pvfiblets.codec.files.convert.CHUNK_POINTS = 200_000
pvfiblets.compress_file(sys.argv[1], sys.argv[2])
# Not getrusage: that also remembers the process that started this one.
status = dict(line.split(":", 1) for line in open("/proc/self/status"))
print(int(status["VmHWM"].split()[0]) / 1024)
"""


@pytest.mark.exhaustive  # every other conversion is held to less by tests/stability/test_load.py
@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="peak memory is read from /proc")
@pytest.mark.parametrize("suffix", [".tck", ".trk", ".trx"])
def test_memory_does_not_grow_with_the_file(tmp_path: Path, suffix: str) -> None:
    """Peak resident memory, mapped pages included, of a file-to-file conversion."""
    rng = np.random.default_rng(0)
    directions = np.cumsum(rng.normal(size=(2000, 150, 3)) * 0.05 + rng.normal(size=(2000, 1, 3)), axis=1)
    directions /= np.linalg.norm(directions, axis=2, keepdims=True)
    lines = np.cumsum(0.5 * directions, axis=1).astype(np.float32)
    peaks = []
    for copies in (15, 60):
        points = np.tile(lines.reshape(-1, 3), (copies, 1))
        path = tmp_path / f"{copies}{suffix}"
        formats.write(path, Streamlines(points, np.arange(0, len(points) + 1, 150)))
        out = subprocess.run(
            [sys.executable, "-c", PEAK, str(path), str(tmp_path / "out.fiblets")],
            capture_output=True,
            text=True,
            check=True,
        )
        peaks.append(float(out.stdout))
        del points
    file_growth = 45 * lines.nbytes / 2**20
    assert peaks[1] < 1500
    assert peaks[1] - peaks[0] < 0.25 * file_growth
