"""DSI Studio's TinyTrack: the layout by hand, the real file, and bad input."""

import gzip
import shutil
import struct

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pvfiblets import formats
from pvfiblets.errors import FormatError
from pvfiblets.formats import tinytrack
from pvfiblets.streamlines import Streamlines

from .samples import AFFINE, same, tt_bytes


def packed(path, data: bytes):
    path.write_bytes(gzip.compress(data, mtime=0))
    return path


@given(st.lists(st.integers(1, 7), max_size=6), st.integers(1, 3), st.integers(0, 2**32 - 1))
def test_points_are_sums_of_differences(tmp_path_factory, counts, blocks, seed):
    rng = np.random.default_rng(seed)
    tracks = []
    for k in counts:
        steps = rng.integers(-128, 128, (k, 3))
        steps[0] = rng.integers(-(2**20), 2**20, 3)
        tracks.append(np.cumsum(steps, axis=0))
    path = packed(tmp_path_factory.mktemp("tt") / "a.tt.gz", tt_bytes(tracks, blocks=blocks))
    s = formats.read(path)
    order = [t for block in range(blocks) for t in tracks[block::blocks]]
    assert s.counts.tolist() == [len(t) for t in order]
    for ours, voxels in zip(s, order, strict=True):
        assert np.allclose(ours, voxels / 32 @ AFFINE[:3, :3].T + AFFINE[:3, 3], rtol=1e-6)
    same(Streamlines.concatenate(formats.iter_chunks(path, 3)), s)


def test_real_file(shared_data, tmp_path):
    path = shared_data / "trxrs_tinytrack_small.tt.gz"
    s = formats.read(path)
    # The manifest's figures, and steps of about half a millimetre.
    assert (len(s), s.n_points) == (9, 2120)
    steps = np.concatenate([np.linalg.norm(np.diff(p, axis=0), axis=1) for p in s])
    assert abs(steps.mean() - 0.5) < 0.02
    assert s.affine[0].tolist() == [-1, 0, 0, 78]
    assert s.groups["cluster_1"].tolist() == [3, 4, 5]
    # Left bundles lie at negative x, right ones at positive x.
    assert s[s.groups["cluster_0"]].points[:, 0].mean() < 0 < s[s.groups["cluster_1"]].points[:, 0].mean()
    copy = shutil.copy(path, tmp_path / "a.tt.gz")
    (tmp_path / "a.txt").write_text("AF_L\nAF_R\n")
    named = formats.read(copy)
    assert list(named.groups) == ["AF_L", "AF_R", "cluster_2"]
    assert named.per_group["AF_L"]["color"].tolist() == [60, 160, 255]


def test_malformed_real_file(shared_data):
    with pytest.raises(FormatError, match="378 coordinates"):
        formats.read(shared_data / "trxrs_tinytrack_malformed.tt.gz")


def test_what_cannot_be_is_counted_or_refused(tmp_path):
    data = tt_bytes([np.zeros((2, 3), int)], extra=[("extra", np.zeros(3, "<f4"))])
    assert formats.read(packed(tmp_path / "a.tt.gz", data)).dropped == {tinytrack.UNKNOWN: 1}
    data = tt_bytes([np.zeros((2, 3), int)], extra=[("cluster", np.zeros(3, "<u2"))])
    with pytest.raises(FormatError, match="3 clusters"):
        formats.read(packed(tmp_path / "a.tt.gz", data))
    with pytest.raises(formats.UnknownFormatError, match=r"\.tt\.gz has no write"):
        formats.write(tmp_path / "a.tt.gz", Streamlines.from_list([]))


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda d: d[:-1], "truncated"),
        (lambda d: d[:10], "matrix header"),
        (lambda d: d.replace(b"trans_to_mni", b"trans_to_mno"), "trans_to_mni"),
        (lambda d: d.replace(b"track\0", b"crack\0"), "no matrix 'track'"),
        (lambda d: struct.pack("<i", 1020) + d[4:], "matrix type"),
        (lambda d: d[:4] + struct.pack("<i", -1) + d[8:], "a matrix of -1"),
        (lambda d: d[:4] + struct.pack("<i", 2**31 - 1) + d[8:], "truncated"),
        (lambda d: d.replace(struct.pack("<I", 12), struct.pack("<I", 11)), "11 coordinates"),
        (lambda d: d.replace(struct.pack("<I", 12), struct.pack("<I", 2**32 - 1)), "coordinates"),
        (lambda d: d.replace(struct.pack("<f", 90), struct.pack("<f", np.nan)), "finite"),
    ],
)
def test_damage(change, words, tmp_path):
    data = tt_bytes([np.cumsum(np.full((4, 3), 5), axis=0)])
    with pytest.raises(FormatError, match=words):
        formats.read(packed(tmp_path / "a.tt.gz", change(data)))
