"""Small files: packed members give the same arrays in fewer bytes, and damage is an error that names its byte."""

import json
import math
import zipfile
import zlib
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import pvfiblets as pf
from pvfiblets.cli.command import main
from pvfiblets.codec.files import packed
from pvfiblets.codec.files.fiblets_format import verify_file
from pvfiblets.codec.files.packed import pack, unpack
from pvfiblets.codec.kernels.entropy_kernels import ALONE, BLOCK, LONGEST, code_lengths
from pvfiblets.codec.layout import SPLINE, coded_kind
from pvfiblets.codec.layout import unpack as unpack_field
from pvfiblets.errors import FormatError
from pvfiblets.query.painting.fiblet_index import FibletIndex
from pvfiblets.regions import index_of
from pvfiblets.synthetic import brain_streamlines


def assert_equal(found, wanted):
    """Assert that two sets hold the same in every bit."""
    for name in ("anchors", "decoding", "reach", "codes", "ends", "pages", "anchors_low", "rank_to_id", "exact"):
        one, other = getattr(found, name), getattr(wanted, name)
        assert (one is None) == (other is None)
        if one is not None:
            assert one.dtype == other.dtype
            np.testing.assert_array_equal(one, other)
    assert (found.parameters, found.bounds, found.dropped) == (wanted.parameters, wanted.bounds, wanted.dropped)
    assert found.per_point.keys() == wanted.per_point.keys()
    for name, values in wanted.per_point.items():
        np.testing.assert_array_equal(found.per_point[name].values(), values.values())
    for kind in ("per_streamline", "groups"):
        assert getattr(found, kind).keys() == getattr(wanted, kind).keys()
        for name, values in getattr(wanted, kind).items():
            np.testing.assert_array_equal(getattr(found, kind)[name], values)

RANDOM = np.random.default_rng(0)
STEPS = np.cumsum(RANDOM.integers(0, 9, (5000, 3)), axis=0)
ARRAYS = {
    "bytes": np.minimum(RANDOM.geometric(0.1, 70_000), 255).astype(np.uint8),
    "one byte only": np.full(3 * BLOCK + 5, 7, np.uint8),
    "less than a block": np.arange(BLOCK - 1) // 1000 % 3 == 0,
    "one block": (np.arange(BLOCK) // 7 % 5).astype(np.uint8),
    "one block and a byte": (np.arange(BLOCK + 1) // 7 % 5).astype(np.int8),
    "records": STEPS.astype("<u4"),
    "shorts": (STEPS % 65536).astype("<u2"),
    "numbers": STEPS.astype("<i8"),
    "floats": STEPS.astype("<f4") / 3.0,
    "doubles": np.sin(STEPS[:, 0] / 1000.0).round(3),
    "texts": np.array(["left", "right", "neither"])[np.arange(3000) // 100 % 3],
    "many axes": (np.arange(2 * 3 * 5 * 100) // 9).astype("<i2").reshape(100, 5, 3, 2),
    "odd texts": np.array([b"abc", b"abd", b"xyz"])[np.arange(3000) // 100 % 3],
}


def back(array):
    made = pack(array)
    assert made is not None
    facts, held = made
    assert len(held) + len(json.dumps(facts)) < array.nbytes
    return unpack("x", "array", json.loads(json.dumps(facts)), held)


@pytest.mark.parametrize("name", ARRAYS)
def test_arrays_come_back_bit_by_bit(name):
    array = ARRAYS[name]
    found = back(array)
    assert found.dtype == array.dtype
    np.testing.assert_array_equal(found, array)


def test_what_would_be_no_smaller_stays():
    assert pack(RANDOM.integers(0, 256, 100_000).astype(np.uint8)) is None


@given(st.lists(st.integers(0, 2**62), min_size=256, max_size=256), st.integers(0, 255))
def test_lengths_are_those_of_a_code_whatever_is_counted(counts, n):
    row = np.array(counts, np.int64) >> 10
    row[n:] = 0
    lengths = np.zeros((1, 256), np.uint8)
    code_lengths(row[None], lengths)
    found = lengths[0].astype(int)
    assert ((found > 0) == (row > 0)).all()
    if (row > 0).sum() == 1:
        assert found.max() == ALONE
    elif row.any():
        assert found.max() <= LONGEST
        assert (0.5 ** found[found > 0]).sum() == 1.0  # Kraft's equation: no bits are lost


def test_codes_are_as_short_as_the_entropy_of_a_byte_given_the_one_before():
    # A chain of four states, each followed by one of two in the ratio 3 : 1.
    n, state, likely = 400_000, 0, RANDOM.random(400_000) < 0.75
    chain = np.empty(n, np.uint8)
    for i in range(n):
        state = (state + (1 if likely[i] else 2)) % 4
        chain[i] = 40 * state
    _, held = pack(chain)
    assert len(held) <= 1.07 * n / 8  # two bytes may follow, a bit each, and in the first place of a block any of four


def test_a_code_takes_at_most_a_few_hundredths_of_a_bit_more_than_its_entropy():
    counts = np.bincount(ARRAYS["bytes"], minlength=256) / len(ARRAYS["bytes"])
    entropy = -sum(p * math.log2(p) for p in counts if p > 0)
    _, held = pack(ARRAYS["bytes"])
    assert entropy <= 8 * (len(held) - 100) / len(ARRAYS["bytes"]) + 0.02
    assert 8 * len(held) / len(ARRAYS["bytes"]) <= entropy + 0.06


def lines():
    made = brain_streamlines(150, seed=1)
    made.per_point.update(fa=np.sin(made.points[:, 0]), n=np.arange(made.n_points) % 5)
    return made


@pytest.fixture(scope="module")
def fiblets():
    return pf.compress(lines(), per_point=("fa", "n"))


@pytest.mark.parametrize("exact", [False, True])
def test_a_small_file_holds_the_same_set(exact, tmp_path):
    fiblets = pf.compress(lines(), per_point=("fa", "n"), exact=exact)
    fiblets.save(tmp_path / "plain.fiblets")
    fiblets.save(tmp_path / "small.fiblets", small=True)
    assert (tmp_path / "small.fiblets").stat().st_size < 0.8 * (tmp_path / "plain.fiblets").stat().st_size
    verify_file(tmp_path / "small.fiblets")
    assert_equal(pf.FibletSet.open(tmp_path / "small.fiblets"), pf.FibletSet.open(tmp_path / "plain.fiblets"))


def test_any_type_of_values_of_streamlines_comes_back(tmp_path):
    made = brain_streamlines(600, seed=1)
    n = np.arange(len(made))
    made.per_streamline.update(
        fields=np.stack([n, n], axis=1).astype(np.int32).view([("a", "<i4"), ("b", "<i4")]).ravel(),
        big=n.astype(">f4"), days=n.astype("<M8[D]"), raw=n.astype("<u4").view("V4"), texts=n.astype(str),
    )  # fmt: skip
    fiblets = pf.compress(made)
    fiblets.save(tmp_path / "a.fiblets", small=True)
    assert_equal(pf.FibletSet.open(tmp_path / "a.fiblets"), fiblets)


def test_codes_of_tracking_take_less_than_three_quarters(tmp_path):
    fiblets = pf.compress(brain_streamlines(200, step=0.1, seed=2))
    fiblets.save(tmp_path / "plain.fiblets")
    fiblets.save(tmp_path / "small.fiblets", small=True)
    assert (tmp_path / "small.fiblets").stat().st_size < 0.75 * (tmp_path / "plain.fiblets").stat().st_size


def test_the_spatial_index_stays(fiblets, tmp_path):
    index_of(fiblets)
    fiblets.save(tmp_path / "a.fiblets", small=True)
    found = pf.FibletSet.open(tmp_path / "a.fiblets")
    kept = index_of(found)
    assert isinstance(kept, FibletIndex)
    np.testing.assert_array_equal(kept.order, index_of(fiblets).order)
    np.testing.assert_array_equal(kept.pieces, index_of(fiblets).pieces)


def test_shards_are_small_too(fiblets, tmp_path):
    for name, small in (("plain", False), ("small", True)):
        fiblets.save(tmp_path / f"{name}.fiblets", shards=60_000, small=small)
    folders = tmp_path / "plain.fiblets", tmp_path / "small.fiblets"
    sizes = [sum(file.stat().st_size for file in folder.glob("*.fiblets")) for folder in folders]
    assert sizes[1] < 0.85 * sizes[0]
    found = pf.FibletSet.open(tmp_path / "small.fiblets")
    assert list(found.sizes.values()) == [part.nbytes for part, _ in found.parts()]  # in memory, not on disk
    verify_file(tmp_path / "small.fiblets")
    one, other = (pf.FibletSet.open(tmp_path / f"{n}.fiblets").decompress() for n in ("plain", "small"))
    np.testing.assert_array_equal(one.points, other.points)


def test_every_damaged_byte_of_a_block_is_named(fiblets, tmp_path):
    path = tmp_path / "a.fiblets"
    fiblets.save(path, small=True)
    whole = path.read_bytes()
    with zipfile.ZipFile(path) as archive:
        begins = {info.filename: info.header_offset for info in archive.infolist()}
        held = archive.read("codes.npy")
    begin = whole.index(held, begins["codes.npy"]) + 128  # behind the header of the .npy
    model = json.loads(zipfile.ZipFile(path).read("header.json"))["packed"]["codes.npy"]["streams"][0][2]
    blocks = begin + model
    for place in (begin + 1, begin + model // 2, *(blocks + n for n in (0, 5, 8, 5000)), begin + len(held) - 129):
        damaged = bytearray(whole)
        damaged[place] ^= 0x10
        path.write_bytes(damaged)
        with pytest.raises(FormatError, match="byte") as caught:
            pf.FibletSet.open(path)
        assert caught.value.position is not None
        assert begin <= caught.value.position <= place + 8  # of a checksum, the block behind it


def damaged_facts(facts, **changed):
    return {**facts, **changed}


def test_facts_that_do_not_fit_are_refused_before_memory_is_taken():
    facts, held = pack(ARRAYS["records"])
    first = facts["streams"][0]
    for changed in (
        {"shape": [2**40, 3]}, {"shape": [-1, 3]}, {"shape": [5000, 4]}, {"shape": [4999, 3]}, {"dtype": "<u2"},
        {"dtype": "O"}, {"streams": facts["streams"][:-1]}, {"streams": [[0, 3, first[2]], *facts["streams"][1:]]},
        {"streams": [[0, first[1], 2**40], *facts["streams"][1:]]},
        {"streams": [[0, first[1], -8], *facts["streams"][1:]]},
    ):  # fmt: skip
        with pytest.raises(FormatError):
            unpack("x", "array", damaged_facts(facts, **changed), held)


def test_lengths_of_no_code_are_refused():
    facts, held = pack(ARRAYS["one block"])
    _, shift, model = facts["streams"][0]
    for value in (0x11, 0xCC, 0xFF):  # too many of one bit, too long, two that stand alone
        lengths = zlib.compress(bytes([value]) * (128 * (256 >> shift)), 9)
        bad = np.frombuffer(lengths + held[model:].tobytes(), np.uint8)
        with pytest.raises(FormatError):
            unpack("x", "array", damaged_facts(facts, streams=[[0, shift, len(lengths)]]), bad)


def test_a_block_that_ends_before_its_bytes_is_refused():
    facts, held = pack(ARRAYS["bytes"])
    _, _, model = facts["streams"][0]
    block = held[model + 8 :].tobytes()[:-40]
    heads = np.array([len(block), zlib.crc32(block)], "<u4").tobytes()
    with pytest.raises(FormatError, match="byte"):
        unpack("x", "array", facts, np.frombuffer(held[:model].tobytes() + heads + block, np.uint8))


def test_newer_versions_ask_for_an_update(fiblets, tmp_path):
    fiblets.save(tmp_path / "a.fiblets", small=True)
    data = (tmp_path / "a.fiblets").read_bytes()
    with zipfile.ZipFile(tmp_path / "a.fiblets") as archive:
        header = archive.read("header.json")
        members = {name: archive.read(name) for name in archive.namelist()}
    assert data
    assert json.loads(header)["version"] == 4
    members["header.json"] = json.dumps(json.loads(header) | {"version": 6}).encode()
    with zipfile.ZipFile(tmp_path / "b.fiblets", "w") as archive:
        for name, content in members.items():
            archive.writestr(name, content)
    with pytest.raises(FormatError, match="at most 5: update pvfiblets"):
        pf.FibletSet.open(tmp_path / "b.fiblets")


def test_splines_are_of_a_version_of_their_own_packed_or_not(tmp_path):
    whole = pf.compress(brain_streamlines(60, seed=1), exact=False, effort="small")
    for small in (False, True):
        whole.save(tmp_path / "a.fiblets", small=small)
        with zipfile.ZipFile(tmp_path / "a.fiblets") as archive:
            header = json.loads(archive.read("header.json"))
        assert header["version"] == 5
        assert ("packed" in header) == small
        verify_file(tmp_path / "a.fiblets")
        assert_equal(pf.FibletSet.open(tmp_path / "a.fiblets"), whole)


def test_a_spline_that_spans_other_points_is_damage():
    whole = pf.compress(brain_streamlines(20, seed=1), exact=False, effort="small")
    spline = int(np.flatnonzero(coded_kind(whole.decoding) == SPLINE)[3])
    codes = whole.codes.copy()
    codes[int(unpack_field("code", whole.decoding)[spline])] ^= 3  # of its first node's span
    with pytest.raises(FormatError, match=f"fiblet {spline} with a spline of more or fewer points"):
        replace(whole, codes=codes).verify()


def test_the_command_packs_originals_and_compressed_files(fiblets, tmp_path, capsys):
    made = lines()
    pf.write(tmp_path / "a.trk", made)
    for source, target, options in (
        ("a.trk", "a.fiblets", ["--no-exact"]), ("a.trk", "b.fiblets", ["--no-exact", "--small"]),
        ("a.fiblets", "c.fiblets", ["--small"]),
    ):  # fmt: skip
        assert main(["convert", str(tmp_path / source), str(tmp_path / target), "--quiet", *options]) == 0
    plain = pf.FibletSet.open(tmp_path / "a.fiblets")
    for name in ("b", "c"):
        assert_equal(pf.FibletSet.open(tmp_path / f"{name}.fiblets"), plain)
        assert (tmp_path / f"{name}.fiblets").stat().st_size < 0.85 * (tmp_path / "a.fiblets").stat().st_size
    assert main(["verify", str(tmp_path / "c.fiblets"), str(tmp_path / "a.trk"), "--quiet"]) == 0
    capsys.readouterr()
    again = ["convert", str(tmp_path / "a.fiblets"), str(tmp_path / "d.fiblets"), "--small", "--max-error", "0.1"]
    assert main(again) != 0
    assert "is compressed already" in capsys.readouterr().err
    assert main(["convert", str(tmp_path / "a.trk"), str(tmp_path / "d.tck"), "--small"]) != 0
    assert "--small are for .fiblets files" in capsys.readouterr().err


def test_small_is_for_fiblets_alone(fiblets, tmp_path):
    with pytest.raises(ValueError, match=r"only \.fiblets files can be small"):
        fiblets.save(tmp_path / "a.trk", small=True)


def test_memory_is_asked_for_before_it_is_taken(monkeypatch):
    facts, held = pack(ARRAYS["bytes"])
    asked = []
    monkeypatch.setattr(packed, "check_room", asked.append)
    unpack("x", "array", facts, held)
    assert asked == [2 * ARRAYS["bytes"].nbytes]
