"""Sets in shards: the same streamlines, bit for bit, divided by place and in files that keep to their size."""

import json
import re
from pathlib import Path

import numpy as np
import pytest

import pvfiblets as pf
from pvfiblets.cli.command import main
from pvfiblets.codec.shards.manifest import MANIFEST
from pvfiblets.codec.shards.places import shards_of, streamline_bytes
from pvfiblets.codec.shards.write import compress_file_in_shards, write_shards
from pvfiblets.streamlines import Streamlines

from ..samples import assert_equal_streamlines, noisy, smooth
from ..test_extract import with_groups


def assert_same(found, wanted):
    assert_equal_streamlines(found, wanted)
    np.testing.assert_array_equal(found.affine, wanted.affine)
    assert found.space == wanted.space
    assert found.dropped == wanted.dropped


@pytest.fixture(scope="module")
def whole():
    return pf.compress(with_groups(), per_point=["height", "fine"], per_point_bits=16, exact=False)


@pytest.fixture
def sharded(whole, tmp_path):
    write_shards(whole, tmp_path / "a.fiblets", whole.nbytes // 5)
    return tmp_path / "a.fiblets"


def test_all_shards_together_are_the_set(whole, sharded):
    shards = pf.ShardedSet.open(sharded)
    assert len(shards.shards) > 4
    shards.verify()
    gathered = shards.gather()
    gathered.verify()
    assert gathered.bounds == whole.bounds
    assert gathered.promise == whole.promise
    assert_same(gathered.decompress(), whole.decompress())
    assert {g: {k: list(v) for k, v in d.items()} for g, d in gathered.per_group.items()} == {
        g: {k: list(v) for k, v in d.items()} for g, d in whole.per_group.items()
    }


@pytest.mark.more
@pytest.mark.parametrize("max_points", [150, 1000, 100_000])
def test_chunks_join_to_the_set(whole, sharded, max_points):
    chunks = list(pf.iter_chunks(sharded, max_points))
    assert all(chunk.n_points <= max_points or len(chunk) == 1 for chunk in chunks)
    whole.save(sharded.with_name("one.fiblets"))
    wanted = pf.read(sharded.with_name("one.fiblets"))
    points = np.concatenate([np.asarray(chunk.points, np.float64) for chunk in chunks])
    np.testing.assert_array_equal(points, np.asarray(wanted.points, np.float64))
    assert sum(map(len, chunks)) == len(wanted)


def test_what_reads_files_reads_folders(whole, sharded, tmp_path):
    whole.save(tmp_path / "one.fiblets")
    assert_same(pf.read(sharded), pf.read(tmp_path / "one.fiblets"))
    assert_same(pf.FibletSet.open(sharded).decompress(), whole.decompress())
    facts = pf.formats.info(sharded)
    assert (facts["streamlines"], facts["points"]) == (len(whole), whole.n_points)
    assert facts["shards"] == len(pf.ShardedSet.open(sharded).shards)
    assert facts["groups"] == {k: len(v) for k, v in whole.groups.items()}
    assert set(facts["per_point"]) == {"height", "fine"}


def test_each_shard_is_an_ordinary_file_of_its_streamlines(whole, sharded):
    shards = pf.ShardedSet.open(sharded)
    wanted = whole.decompress(dtype=np.float64)
    for number in range(len(shards.shards)):
        part = pf.FibletSet.open(sharded / f"{number:06}.fiblets")
        lines = part.decompress(dtype=np.float64)
        for line, streamline in zip(lines, shards.ids(number), strict=True):
            np.testing.assert_array_equal(line, wanted[int(streamline)])


def test_a_slice_reads_consecutive_streamlines(whole, sharded):
    shards = pf.ShardedSet.open(sharded)
    for a, b in ((0, 73), (10, 31), (72, 73), (5, 5)):
        part = shards[a:b].decompress(dtype=np.float64)
        np.testing.assert_array_equal(part.points, whole[a:b].decompress(dtype=np.float64).points)
        assert len(part) == b - a
    with pytest.raises(ValueError, match="in steps of 2"):
        shards[::2]
    with pytest.raises(TypeError, match="give a slice"):
        shards[3]


@pytest.mark.parametrize("lines", [smooth(200, 60), noisy(150, 90)], ids=["smooth", "noisy"])
def test_no_shard_is_larger_than_asked(lines):
    whole = pf.compress(lines, exact=False)
    sizes = streamline_bytes(whole)
    assert sizes.sum() == pytest.approx(whole.nbytes - whole.pages.nbytes, abs=0)
    for size in (1, int(sizes.max()), 3000, 10_000, 1 << 30):
        parts = shards_of(whole, size)
        np.testing.assert_array_equal(np.sort(np.concatenate(parts)), np.arange(len(whole)))
        assert all(sizes[part].sum() <= size or len(part) == 1 for part in parts)
        if size >= 3000:
            assert len(parts) <= -(-sizes.sum() // (size - sizes.max())), "more shards than such sizes need"


def test_shards_hold_near_streamlines():
    """Eight clusters in the corners of a cube, in a random order, make eight shards of one corner each."""
    rng = np.random.default_rng(5)
    corner = rng.permutation(np.repeat(np.arange(8), 30))
    middles = np.stack([corner & 1, corner >> 1 & 1, corner >> 2], axis=1) * 100.0
    lines = [m + np.cumsum(rng.normal(size=(40, 3)) * 0.1, axis=0) for m in middles]
    whole = pf.compress(Streamlines.from_list(lines), exact=False)
    parts = shards_of(whole, -(-int(streamline_bytes(whole).sum()) // 8) + 200)
    assert len(parts) == 8
    assert sum(len(set(corner[part])) == 1 for part in parts) >= 1
    assert max(len(set(corner[part])) for part in parts) <= 2, "a shard reaches over more than two corners"


def test_a_box_chooses_shards(whole, sharded):
    shards = pf.ShardedSet.open(sharded)
    b = np.array(shards.shards[0].bounds)
    numbers = shards.manifest.meeting(b)
    assert 0 in numbers
    far = b + 1e6
    assert shards.manifest.meeting(far) == []
    assert len(shards.within(far)) == 0
    found = shards.within(b)
    assert len(found) == sum(shards.shards[n].streamlines for n in numbers)
    with pytest.raises(ValueError, match="each minimum first"):
        shards.manifest.meeting([1, 0, 0, 1, 0, 1])


@pytest.mark.few(1)
@pytest.mark.parametrize("exact", [True, False, None])
def test_a_file_becomes_shards(tmp_path, exact):
    lines = smooth(60, 100)
    pf.write(tmp_path / "a.tck", lines)
    told = compress_file_in_shards(tmp_path / "a.tck", tmp_path / "b.fiblets", 3_000, exact=exact)
    assert told["shards"] == len(list((tmp_path / "b.fiblets").glob("*.fiblets"))) > 1
    assert told["bytes"] == sum(p.stat().st_size for p in (tmp_path / "b.fiblets").iterdir())
    back = pf.read(tmp_path / "b.fiblets")
    source = pf.read(tmp_path / "a.tck")
    errors = np.linalg.norm(np.asarray(back.points, float) - source.points, axis=1)
    assert errors.max() <= told["promise_mm"] + 1e-5
    manifest = pf.ShardedSet.open(tmp_path / "b.fiblets").manifest
    assert manifest.promise_mm == told["promise_mm"]
    assert (manifest.promise_mm == 0.0) == told["exact"]
    assert ("exact)" in repr(pf.ShardedSet.open(tmp_path / "b.fiblets"))) == told["exact"]
    if told["exact"]:
        np.testing.assert_array_equal(back.points, source.points)
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a.tck", "b.fiblets"], "nothing else is left"


@pytest.mark.more
def test_a_set_is_divided_as_it_is(whole, tmp_path):
    whole.save(tmp_path / "a.fiblets")
    whole.save(tmp_path / "b.fiblets", shards=4000)
    assert_same(pf.read(tmp_path / "b.fiblets"), pf.read(tmp_path / "a.fiblets"))
    compress_file_in_shards(tmp_path / "b.fiblets", tmp_path / "b.fiblets", 8000)  # in the place of the older one
    assert_same(pf.read(tmp_path / "b.fiblets"), pf.read(tmp_path / "a.fiblets"))
    with pytest.raises(ValueError, match="max_error: .* is compressed already"):
        compress_file_in_shards(tmp_path / "a.fiblets", tmp_path / "c.fiblets", 4000, max_error=0.1)


def test_nothing_else_is_replaced(whole, tmp_path):
    (tmp_path / "a.fiblets").write_bytes(b"dear")
    with pytest.raises(FileExistsError, match=r"a\.fiblets is a file, which shards would replace"):
        write_shards(whole, tmp_path / "a.fiblets", 1000)
    (tmp_path / "b.fiblets").mkdir()
    with pytest.raises(FileExistsError, match="folder without shards"):
        write_shards(whole, tmp_path / "b.fiblets", 1000)
    with pytest.raises(ValueError, match=r"ends in \.fiblets"):
        whole.save(tmp_path / "c.trk", shards=1000)
    with pytest.raises(ValueError, match="shards of 0 bytes"):
        write_shards(whole, tmp_path / "c.fiblets", 0)
    assert (tmp_path / "a.fiblets").read_bytes() == b"dear"


@pytest.mark.parametrize("streamlines", [[], [[]], [[], np.zeros((1, 3)), []]], ids=["none", "empty", "one point"])
def test_sets_of_nothing(streamlines, tmp_path):
    lines = Streamlines.from_list([np.reshape(np.asarray(line, float), (-1, 3)) for line in streamlines])
    for exact in (True, False):
        write_shards(pf.compress(lines, exact=exact), tmp_path / f"{exact}.fiblets", 1000)
        back = pf.read(tmp_path / f"{exact}.fiblets")
        assert (len(back), back.n_points) == (len(lines), lines.n_points)


def test_damage_is_reported(sharded):
    with pytest.raises(pf.FormatError, match=r"no manifest\.json"):
        pf.FibletSet.open(sharded.parent)
    path = sharded / "000001.fiblets"
    kept = path.read_bytes()
    changed = bytearray(kept)
    changed[len(kept) // 2] ^= 1
    path.write_bytes(changed)
    with pytest.raises(pf.FormatError, match="changed bytes|000001"):
        pf.ShardedSet.open(sharded).verify()
    path.write_bytes(kept[:-1])
    with pytest.raises(pf.FormatError, match=f"{len(kept) - 1} bytes"):
        pf.ShardedSet.open(sharded).gather()
    path.unlink()
    with pytest.raises(pf.FormatError, match=r"no file 000001\.fiblets"):
        pf.read(sharded)


def test_foreign_shards_are_refused(sharded):
    """A shard of another set of the same length in bytes."""
    text = json.loads((sharded / MANIFEST).read_text())
    text["shards"][0]["streamlines"] += 1
    text["shards"][1]["streamlines"] -= 1
    (sharded / MANIFEST).write_text(json.dumps(text))
    with pytest.raises(pf.FormatError, match="that its manifest names"):
        pf.read(sharded)


@pytest.mark.few(4)
@pytest.mark.parametrize(
    ("change", "told"),
    [
        (lambda m: m.update(format="zip"), "format 'zip'"),
        (lambda m: m.update(version=2), "update pvfiblets"),
        (lambda m: m.update(streamlines=1), "does not fit together"),
        (lambda m: m.pop("bounds"), "does not fit together"),
        (lambda m: m.update(shards=[]), "does not fit together"),
        (lambda m: m["shards"][0]["fiblets"].update(name="../secret.fiblets"), "does not fit together"),
        (lambda m: m["shards"][0]["ids"].update(name="/etc/passwd"), "does not fit together"),
        (lambda m: m["shards"][0].update(bounds=[0, 1, 0, 1, 0, None]), "does not fit together"),
    ],
)
def test_damaged_manifests(sharded, change, told):
    found = json.loads((sharded / MANIFEST).read_text())
    change(found)
    (sharded / MANIFEST).write_text(json.dumps(found))
    with pytest.raises(pf.FormatError, match=told):
        pf.ShardedSet.open(sharded)


@pytest.mark.parametrize("text", [b"", b"{", b"[]", b"\xff\xfe", b"12"])
def test_manifests_that_are_none(sharded, text):
    (sharded / MANIFEST).write_bytes(text)
    with pytest.raises(pf.FormatError, match="manifest"):
        pf.ShardedSet.open(sharded)


def test_commands(whole, tmp_path, capsys):
    source, target = str(tmp_path / "a.tck"), str(tmp_path / "b.fiblets")
    pf.write(source, smooth(60, 100))
    assert main(["convert", source, target, "--shards", "2K", "--quiet"]) == 0
    assert re.search(r"60 streamlines, 6,000 points, in \d+ shards\n", capsys.readouterr().out)
    assert main(["info", target]) == 0
    facts = capsys.readouterr().out
    assert re.search(r"^shards +\d", facts, re.MULTILINE)
    assert re.search(rf"^bytes +{sum(p.stat().st_size for p in Path(target).iterdir()):,}$", facts, re.MULTILINE)
    assert main(["verify", target, source, "--quiet"]) == 0
    assert "good" in capsys.readouterr().out
    assert main(["convert", target, str(tmp_path / "c.trk")]) == 0
    assert len(pf.read(tmp_path / "c.trk")) == 60
    assert main(["convert", target, str(tmp_path / "d.fiblets"), "--shards", "9K", "--quiet"]) == 0
    assert len(pf.FibletSet.open(tmp_path / "d.fiblets")) == len(pf.FibletSet.open(target))
    capsys.readouterr()
    assert main(["convert", target, target, "--shards", "9K"]) == 1
    assert "overwritten by itself" in capsys.readouterr().err
    assert main(["convert", source, str(tmp_path / "c.trk"), "--shards", "9K"]) == 1
    assert "--shards and --small are for .fiblets files" in capsys.readouterr().err
    assert main(["convert", source, "-", "--format", "fiblets", "--shards", "9K"]) == 1
    assert "give the folder's name" in capsys.readouterr().err
    with pytest.raises(SystemExit):
        main(["convert", source, target, "--shards", "many"])
    assert "'many' is no file size" in capsys.readouterr().err
    assert main(["info", "https://example.org/a.tck"]) == 1
    assert "is an address" in capsys.readouterr().err
