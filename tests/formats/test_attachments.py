"""Values in side files: where they go, and files that do not fit."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pvfiblets import formats
from pvfiblets.errors import FormatError
from pvfiblets.formats import attachments
from pvfiblets.streamlines import Streamlines

from .samples import rich, tck_bytes


def test_real_tsf(shared_data):
    s = formats.read(shared_data / "nv_tract.SLF1_R.tck")
    assert formats.attach(s, shared_data / "nv_mni152.SLF1_R.tsf", "t1") == "per_point"
    values = s.per_point["t1"]
    # Read the file by hand: float32 after byte 300, NaN after each of the 13 streamlines.
    raw = np.frombuffer((shared_data / "nv_mni152.SLF1_R.tsf").read_bytes(), "<f4", offset=300)
    assert np.array_equal(values, raw[np.isfinite(raw)])
    assert len(values) == s.n_points


def test_tsf_round_trip_and_misfits(tmp_path):
    s = rich()
    attachments.write_scalars(tmp_path / "fa.tsf", s, "fa")
    other = rich()
    del other.per_point["fa"]
    assert formats.attach(other, tmp_path / "fa.tsf") == "per_point"
    assert np.array_equal(other.per_point["fa"], s.per_point["fa"])
    with pytest.raises(FormatError, match="6 streamlines.*expected 3"):
        formats.attach(s[:3], tmp_path / "fa.tsf")
    with pytest.raises(FormatError, match="12 values in streamline 2.*expected 11"):
        formats.attach(rich(counts=(5, 1, 11, 0, 3, 7)), tmp_path / "fa.tsf")
    with pytest.raises(ValueError, match="one finite value"):
        attachments.write_scalars(tmp_path / "b.tsf", s, "rgb")


def test_tsf_is_checked_like_tck(tmp_path):
    path = tmp_path / "a.tsf"
    rows = np.array([[1.0], [2], [np.nan], [np.inf]])
    path.write_bytes(tck_bytes(rows[:-1], magic=attachments.MAGIC_SCALARS, header="count: 2\n"))
    with pytest.raises(FormatError, match="truncated"):
        attachments.read_scalars(path)
    path.write_bytes(tck_bytes(rows))
    with pytest.raises(FormatError, match="mrtrix track scalars"):
        attachments.read_scalars(path)


@pytest.mark.parametrize(
    ("shape", "place"),
    [((6,), "per_streamline"), ((6, 3), "per_streamline"), ((27,), "per_point"), ((27, 2), "per_point")],
)
def test_arrays_go_where_their_length_says(shape, place, tmp_path):
    values = np.random.default_rng(0).random(shape)
    np.save(tmp_path / "a.npy", values.astype(">f4"))
    np.savetxt(tmp_path / "b.txt", values)
    s = rich()
    assert formats.attach(s, tmp_path / "a.npy") == place
    assert formats.attach(s, tmp_path / "b.txt", "text") == place
    stored = getattr(s, place)
    assert np.array_equal(stored["a"], values.astype("f4"))
    assert stored["a"].dtype.isnative
    assert np.allclose(stored["text"], values)


def test_mrtrix_weights_in_one_line(tmp_path):
    (tmp_path / "w.txt").write_text("# command_history: tcksift2\n1 2 3.5 4 5 6e-1\n")
    s = rich()
    assert formats.attach(s, tmp_path / "w.txt") == "per_streamline"
    assert s.per_streamline["w"].tolist() == [1, 2, 3.5, 4, 5, 0.6]


def test_files_that_do_not_fit(tmp_path):
    s = rich()
    np.save(tmp_path / "five.npy", np.zeros(5))
    np.save(tmp_path / "text.npy", np.array(["a"] * 6))
    np.save(tmp_path / "cube.npy", np.zeros((6, 2, 2)))
    np.save(tmp_path / "objects.npy", np.array([{}] * 6), allow_pickle=True)
    np.save(tmp_path / "short.npy", np.zeros(27))
    short = tmp_path / "short.npy"
    short.write_bytes(short.read_bytes()[:-8])
    (tmp_path / "no.npy").write_bytes(b"PK")
    (tmp_path / "ragged.txt").write_text("1 2\n3\n")
    (tmp_path / "words.txt").write_text("one two\n")
    (tmp_path / "empty.txt").write_text("")
    (tmp_path / "bytes.txt").write_bytes(b"\xff\xfe\x00")
    for path in sorted(tmp_path.iterdir()):
        with pytest.raises(FormatError):
            formats.attach(s, path)
    with pytest.raises(formats.UnknownFormatError, match=r"\.tsf, \.npy"):
        formats.attach(s, "a.dat")


def test_headers_of_npy(tmp_path):
    """One as Python 2 wrote it is read without a warning; one longer than the file takes no memory."""
    s, path = rich(), tmp_path / "a.npy"
    values = np.arange(s.n_points, dtype=np.float32)
    np.save(path, values)
    raw = path.read_bytes()
    assert b"(27,), }  " in raw
    path.write_bytes(raw.replace(b"(27,), }  ", b"(27L,), } "))
    assert formats.attach(s, path, "v") == "per_point"
    np.testing.assert_array_equal(s.per_point["v"], values)
    path.write_bytes(raw[:6] + b"\x03\0" + (662372470).to_bytes(4, "little") + raw[10:])
    with pytest.raises(FormatError, match="its header up to byte 662372482"):
        formats.attach(s, path)


@given(st.lists(st.integers(0, 5), max_size=8), st.sampled_from([".tsf", ".npy", ".txt", ".csv"]), st.booleans())
def test_any_values_come_back(tmp_path_factory, counts, suffix, wide):
    n = sum(counts)
    values = np.random.default_rng(n).normal(size=n).astype(np.float64 if wide else np.float32)
    offsets = np.concatenate([[0], np.cumsum(counts, dtype=np.int64)])
    s = Streamlines(np.zeros((n, 3), np.float32), offsets, per_point={"v": values})
    path = tmp_path_factory.mktemp("any") / f"a{suffix}"
    if suffix == ".tsf":
        attachments.write_scalars(path, s, "v")
    elif suffix == ".npy":
        np.save(path, values)
    else:
        np.savetxt(path, values, delimiter=",")
    where = formats.attach(s, path, "again")
    # Of as many points as streamlines, values are taken to be the streamlines'.
    assert where == ("per_streamline" if len(counts) == n and suffix != ".tsf" else "per_point")
    np.testing.assert_array_equal(getattr(s, where)["again"], values)
