"""Files: what is written is what is read, and damage is found."""

import json
import os
import zipfile

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import pvfiblets as pf
from pvfiblets.codec import layout
from pvfiblets.codec.files import archive, fiblets_file, fiblets_format
from pvfiblets.codec.files.file_error import measure_file_error
from pvfiblets.errors import FormatError
from pvfiblets.streamlines import Streamlines

from .samples import extremes, smooth, wandering


def rich(name="cluster/with slash"):
    """Streamlines with one of everything, and an empty streamline among them."""
    base = wandering(20, 30)
    rng = np.random.default_rng(0)
    values = rng.normal(size=base.n_points).astype(np.float32)
    values[5] = np.nan
    offsets = np.insert(np.asarray(base.offsets), 7, base.offsets[7])
    return Streamlines(
        base.points,
        offsets,
        per_point={"fa": values, "rgb": rng.uniform(0, 255, (base.n_points, 3))},
        per_streamline={"weight": rng.normal(size=21), name: np.arange(21, dtype=np.uint16)},
        groups={"AF left": np.array([1, 3, 20]), "none": np.empty(0, np.int64)},
        per_group={"AF left": {"colour": np.array([1, 2, 3])}},
        affine=np.diag([2.0, 2.0, 2.0, 1.0]),
        space={"dimensions": (10, 11, 12), "voxel_order": "RAS", "voxel_sizes": np.array([2.0, 2.0, 2.0])},
        dropped={"non-finite points": 2},
    )


def assert_equal_sets(a, b):
    assert a.parameters == b.parameters
    assert a.bounds == b.bounds
    assert a.n_streamlines == b.n_streamlines
    assert a.dropped == b.dropped
    for name in ("anchors", "decoding", "reach", "codes", "ends", "pages", "affine"):
        np.testing.assert_array_equal(getattr(a, name), getattr(b, name))
    for name in ("anchors_low", "rank_to_id"):
        x, y = getattr(a, name), getattr(b, name)
        assert (x is None) == (y is None)
        if x is not None:
            np.testing.assert_array_equal(x, y)
    for group in ("per_streamline", "groups"):
        assert list(getattr(a, group)) == list(getattr(b, group))
        for name, value in getattr(a, group).items():
            np.testing.assert_array_equal(value, getattr(b, group)[name])
    assert list(a.per_point) == list(b.per_point)
    for name, value in a.per_point.items():
        np.testing.assert_array_equal(value.codes, b.per_point[name].codes)
        assert (value.lo, value.hi, value.max_error) == (
            b.per_point[name].lo,
            b.per_point[name].hi,
            b.per_point[name].max_error,
        )


def test_a_rich_set_survives_the_disk(tmp_path):
    fiblets = pf.compress(rich(), per_point=["fa", "rgb"], per_point_bits=16)
    assert list(fiblets.per_point) == ["fa", "rgb[0]", "rgb[1]", "rgb[2]"]
    fiblets.save(tmp_path / "a.fiblets")
    again = pf.FibletSet.open(tmp_path / "a.fiblets")
    assert_equal_sets(fiblets, again)
    assert again.space["voxel_order"] == "RAS"
    assert again.per_group["AF left"]["colour"].tolist() == [1, 2, 3]
    fiblets_format.verify_file(tmp_path / "a.fiblets")
    assert os.listdir(tmp_path) == ["a.fiblets"], "nothing else may be left behind"


@pytest.mark.few(8)
@pytest.mark.parametrize("name", extremes())
def test_every_extreme_survives_the_disk(tmp_path, name):
    fiblets = pf.compress(extremes()[name])
    fiblets.save(tmp_path / "a.fiblets")
    assert_equal_sets(fiblets, pf.FibletSet.open(tmp_path / "a.fiblets"))
    fiblets_format.verify_file(tmp_path / "a.fiblets")


@given(st.data())
def test_any_set_survives_the_disk(tmp_path_factory, data):
    counts = data.draw(st.lists(st.integers(0, 130), max_size=6))
    n, m = sum(counts), len(counts)
    rng = np.random.default_rng(data.draw(st.integers(0, 1000)))
    scale = 10.0 ** data.draw(st.integers(-4, 5))
    names = st.text(st.characters(blacklist_categories=["Cs"]), min_size=1, max_size=6)
    lines = Streamlines(
        np.cumsum(rng.normal(size=(n, 3)), axis=0) * scale + rng.normal(size=3) * scale * 100.0,
        np.concatenate([[0], np.cumsum(counts, dtype=np.int64)]),
        per_point={name: rng.normal(size=n).astype(np.float32) for name in data.draw(st.sets(names, max_size=2))},
        per_streamline={name: rng.normal(size=(m, 2)) for name in data.draw(st.sets(names, max_size=2))},
        groups={name: np.flatnonzero(rng.random(m) < 0.5) for name in data.draw(st.sets(names, max_size=2))},
    )
    order = data.draw(st.sampled_from(["input", "hilbert"]))
    bits = data.draw(st.sampled_from([8, 16]))
    fiblets = pf.compress(lines, per_point=tuple(lines.per_point), per_point_bits=bits, order=order)
    path = tmp_path_factory.mktemp("any") / "a.fiblets"
    fiblets.save(path)
    again = pf.FibletSet.open(path)
    assert_equal_sets(fiblets, again)
    fiblets_format.verify_file(path)
    decoded = again.decompress()
    np.testing.assert_array_equal(decoded.offsets, lines.offsets)
    assert np.linalg.norm(decoded.points.astype(float) - lines.points, axis=1).max(initial=0.0) <= again.promise
    for name, members in lines.groups.items():
        np.testing.assert_array_equal(decoded.groups[name], members)


def test_numpy_alone_reads_a_file(tmp_path):
    fiblets = pf.compress(smooth(5, 100))
    fiblets.save(tmp_path / "a.fiblets")
    with np.load(tmp_path / "a.fiblets") as plain:
        np.testing.assert_array_equal(plain["codes"], fiblets.codes)
        np.testing.assert_array_equal(plain["anchors"], fiblets.anchors)
        header = json.loads(bytes(plain["header.json"]))
    assert header["version"] == fiblets_file.OF_CODES
    assert header["n_points"] == fiblets.n_points


def test_arrays_are_mapped_and_aligned(tmp_path):
    pf.compress(rich(), per_point=["fa"]).save(tmp_path / "a.fiblets")
    again = pf.FibletSet.open(tmp_path / "a.fiblets")
    for array in (again.anchors, again.decoding, again.codes, again.per_point["fa"].codes):
        assert isinstance(array, np.memmap)
        assert array.offset % 64 == 0
        assert not array.flags.writeable


def test_opening_reads_no_array(tmp_path):
    """Constant in time and memory: opening succeeds even where the arrays' bytes are nonsense."""
    path = tmp_path / "a.fiblets"
    pf.compress(smooth(5, 100)).save(path)
    opened = pf.FibletSet.open(path)
    spans = [(a.offset, a.nbytes) for a in (opened.anchors, opened.decoding, opened.codes, opened.reach)]
    data = bytearray(path.read_bytes())
    for start, size in spans:
        data[start : start + size] = b"\xa5" * size
    path.write_bytes(data)
    assert pf.FibletSet.open(path).n_points == 500
    with pytest.raises(FormatError):
        fiblets_format.verify_file(path)


def test_values_come_back_within_their_measured_error():
    lines = rich()
    fiblets = pf.compress(lines, per_point=["fa"])
    decoded = fiblets.decompress()
    original = lines.per_point["fa"]
    difference = np.abs(decoded.per_point["fa"].astype(float) - original)
    assert np.isnan(decoded.per_point["fa"][5])
    assert np.nanmax(difference) <= fiblets.per_point["fa"].max_error
    assert fiblets.per_point["fa"].max_error <= (np.nanmax(original) - np.nanmin(original)) / 253 / 2 + 1e-6
    for name, value in lines.per_streamline.items():
        np.testing.assert_array_equal(decoded.per_streamline[name], value)
    assert decoded.groups["AF left"].tolist() == [1, 3, 20]


def test_values_cost_nothing_unless_kept():
    lines = rich()
    without, with_fa = pf.compress(lines), pf.compress(lines, per_point=["fa"])
    assert not without.per_point
    assert with_fa.nbytes - without.nbytes == lines.n_points


def test_selection_keeps_everything_that_belongs():
    lines = rich()
    fiblets = pf.compress(lines, per_point=["fa"])
    ids = [20, 3, 7, 3, -21]
    some = fiblets.decompress(ids)
    whole = fiblets.decompress()
    assert len(some) == 5
    for place, i in enumerate([20, 3, 7, 3, 0]):
        np.testing.assert_array_equal(some[place], whole[i])
    np.testing.assert_array_equal(
        some.per_streamline["weight"], np.asarray(lines.per_streamline["weight"])[[20, 3, 7, 3, 0]]
    )
    np.testing.assert_array_equal(
        some.per_point["fa"], np.concatenate([whole[[i]].per_point["fa"] for i in (20, 3, 7, 3, 0)])
    )
    assert some.groups["AF left"].tolist() == [1, 0]
    mask = np.zeros(21, bool)
    mask[[2, 7]] = True
    assert len(fiblets.decompress(mask)) == 2
    assert len(fiblets.decompress(slice(5, 9))) == 4
    with pytest.raises(IndexError, match="streamline 21 is not among the 21"):
        fiblets.decompress([21])
    with pytest.raises(IndexError, match=r"a mask of shape \(3,\)"):
        fiblets.decompress(np.ones(3, bool))
    with pytest.raises(IndexError, match="whole numbers"):
        fiblets.decompress([1.5])


@pytest.mark.more
def test_a_few_streamlines_are_found_as_many_are(monkeypatch):
    """Over several pages, with streamlines that cross from one into the next, and with empty ones."""
    rng = np.random.default_rng(0)
    counts = rng.integers(0, 40, 9000) * rng.integers(1, 30, 9000)
    points = np.cumsum(rng.normal(size=(counts.sum(), 3)) * 0.05, axis=0)
    lines = Streamlines(points, np.concatenate([[0], np.cumsum(counts)]))
    fiblets = pf.compress(lines, max_error=0.5)
    assert len(fiblets.pages) > 3
    borders = fiblets.fiblet_streamlines()[:: layout.PAGE]
    chosen = np.concatenate([rng.integers(0, 9000, 150), borders, borders[1:] - 1, [0, 8999]])
    few = fiblets.decompress(chosen)
    monkeypatch.setattr("pvfiblets.codec.streamline_ranges.FEW", 0)
    many = fiblets.decompress(chosen)
    np.testing.assert_array_equal(few.offsets, many.offsets)
    np.testing.assert_array_equal(few.points, many.points)
    np.testing.assert_array_equal(few.counts, lines.counts[chosen])


@pytest.mark.parametrize("max_points", [1, 61, 100, 1000, 10**9])
def test_chunks_put_together_are_the_whole(max_points):
    lines = rich()
    fiblets = pf.compress(lines, per_point=["fa"])
    whole = fiblets.decompress()
    chunks = list(fiblets.iter_chunks(max_points))
    np.testing.assert_array_equal(np.concatenate([c.points for c in chunks]), whole.points)
    np.testing.assert_array_equal(np.concatenate([c.counts for c in chunks]), whole.counts)
    np.testing.assert_array_equal(np.concatenate([c.per_point["fa"] for c in chunks]), whole.per_point["fa"])
    np.testing.assert_array_equal(
        np.concatenate([c.per_streamline["weight"] for c in chunks]), whole.per_streamline["weight"]
    )
    found, base = [], 0
    for c in chunks:
        found += (c.groups["AF left"] + base).tolist()
        base += len(c)
    assert sorted(found) == [1, 3, 20]


@pytest.mark.parametrize("offsets", [[0, 0, 0], [0, 0, 3, 3, 3], [0, 3, 3], [0]])
def test_chunks_keep_empty_streamlines(offsets):
    lines = Streamlines(np.zeros((offsets[-1], 3)) + np.arange(offsets[-1])[:, None], offsets)
    fiblets = pf.compress(lines)
    assert sum(len(c) for c in fiblets.iter_chunks(1)) == len(lines)
    assert fiblets.decompress().offsets.tolist() == offsets


# ------------------------------------------------------------------------------------------------------ conversion


@pytest.mark.parametrize("effort", ["fast", "small"])
def test_conversion_writes_what_compressing_gives(effort, tmp_path, monkeypatch):
    pf.write(tmp_path / "a.trx", rich("cluster"))
    monkeypatch.setattr("pvfiblets.codec.files.convert.CHUNK_POINTS", 100)
    report = pf.compress_file(tmp_path / "a.trx", tmp_path / "a.fiblets", per_point=["fa"], effort=effort)
    fiblets_format.verify_file(tmp_path / "a.fiblets")
    source = pf.read(tmp_path / "a.trx")
    again = pf.FibletSet.open(tmp_path / "a.fiblets")
    assert_equal_sets(pf.compress(source, per_point=["fa"], effort=effort), again)
    error = pf.measure_error(source, pf.FibletSet.open(tmp_path / "a.fiblets"))
    assert report["error_mm"]["max"] == pytest.approx(error.max_mm)
    assert report["streamlines"] == 21
    assert report["bytes"] == (tmp_path / "a.fiblets").stat().st_size
    assert sorted(os.listdir(tmp_path)) == ["a.fiblets", "a.trx"]


def test_conversion_of_nothing(tmp_path):
    pf.write(tmp_path / "a.tck", Streamlines(np.empty((0, 3), np.float32), [0]))
    report = pf.compress_file(tmp_path / "a.tck", tmp_path / "a.fiblets")
    assert report["points"] == 0
    assert len(pf.read(tmp_path / "a.fiblets")) == 0


def test_conversion_tells_how_far_it_is_and_can_be_stopped(tmp_path, monkeypatch):
    pf.write(tmp_path / "a.tck", smooth(20, 50))
    monkeypatch.setattr("pvfiblets.codec.files.convert.CHUNK_POINTS", 100)
    told = []
    pf.compress_file(tmp_path / "a.tck", tmp_path / "a.fiblets", progress=lambda *step: told.append(step))
    for what in ("compressing", "measuring"):
        shares = [share for stage, share in told if stage == what]
        np.testing.assert_allclose(shares, np.arange(20) / 20)
    assert [what for what, _ in told[:20]] == ["surveying"] * 20

    def stop(what, share):
        if what == "compressing" and share > 0.5:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        pf.compress_file(tmp_path / "a.tck", tmp_path / "b.fiblets", progress=stop)
    assert sorted(os.listdir(tmp_path)) == ["a.fiblets", "a.tck"]


def test_conversion_refuses_unknown_values(tmp_path):
    pf.write(tmp_path / "a.tck", smooth(2, 10))
    with pytest.raises(ValueError, match="no per-point array 'fa'; the streamlines have: none"):
        pf.compress_file(tmp_path / "a.tck", tmp_path / "a.fiblets", per_point=["fa"])
    assert os.listdir(tmp_path) == ["a.tck"]


def test_measuring_against_another_file_is_refused(tmp_path):
    pf.write(tmp_path / "a.tck", smooth(5, 50))
    pf.write(tmp_path / "b.tck", smooth(4, 50))
    pf.write(tmp_path / "c.tck", smooth(5, 49))
    pf.compress_file(tmp_path / "a.tck", tmp_path / "a.fiblets")
    with pytest.raises(ValueError, match="hold 5 streamlines, the original 4"):
        measure_file_error(tmp_path / "a.fiblets", tmp_path / "b.tck")
    with pytest.raises(ValueError, match="streamline 0 has 49 points in the original, 50 in the fiblets"):
        measure_file_error(tmp_path / "a.fiblets", tmp_path / "c.tck")


# ---------------------------------------------------------------------------------------------------------- damage


def saved(tmp_path):
    path = tmp_path / "a.fiblets"
    pf.compress(rich(), per_point=["fa"]).save(path)
    return path


def test_an_older_version_is_refused(tmp_path):
    """Version 1 had spheres where capsules are now, and no end vectors."""
    header, arrays = archive.open_archive(saved(tmp_path))
    header["version"] = 1
    del header["parameters"]["end_scale"], header["parameters"]["largest_radius"]
    members = {k: archive.array_member(np.array(v)) for k, v in arrays.items() if k != "ends.npy"}
    archive.write_archive(tmp_path / "b.fiblets", header, members)
    with pytest.raises(FormatError, match="by an older pvfiblets, expected versions 2 to 5: compress the original"):
        pf.FibletSet.open(tmp_path / "b.fiblets")


@pytest.mark.parametrize("name", ["reach", "ends"])
def test_verify_finds_bounds_that_do_not_hold(tmp_path, name):
    """Such a set would lose lines to culling; its checksums are right."""
    header, arrays = archive.open_archive(saved(tmp_path))
    arrays = {k: np.array(v) for k, v in arrays.items()}
    arrays[f"{name}.npy"][5] = 0
    archive.write_archive(tmp_path / "b.fiblets", header, {k: archive.array_member(v) for k, v in arrays.items()})
    with pytest.raises(FormatError, match=r"fiblet \d+ with points outside its capsule"):
        fiblets_format.verify_file(tmp_path / "b.fiblets")


def test_verify_finds_a_radius_that_is_too_small(tmp_path):
    header, arrays = archive.open_archive(saved(tmp_path))
    header["parameters"]["largest_radius"] *= 0.99
    members = {k: archive.array_member(np.array(v)) for k, v in arrays.items()}
    archive.write_archive(tmp_path / "b.fiblets", header, members)
    with pytest.raises(FormatError, match="beyond the set's largest radius"):
        fiblets_format.verify_file(tmp_path / "b.fiblets")


def test_a_header_that_says_it_is_larger_than_its_file(tmp_path):
    path = tmp_path / "a.fiblets"
    pf.compress(smooth(3, 40)).save(path)
    raw = bytearray(path.read_bytes())
    at = raw.rindex(b"header.json") - 46  # its entry in the zip's directory
    assert raw[at : at + 4] == b"PK\1\2"
    raw[at + 20 : at + 24] = (0x7FFFFFFF).to_bytes(4, "little")  # bytes as stored
    path.write_bytes(raw)
    with pytest.raises(FormatError, match="2147483647 as stored"):
        pf.FibletSet.open(path)


def test_other_files_are_refused(tmp_path):
    (tmp_path / "text.fiblets").write_text("not a zip")
    with pytest.raises(FormatError, match="no readable zip"):
        pf.FibletSet.open(tmp_path / "text.fiblets")
    with zipfile.ZipFile(tmp_path / "zip.fiblets", "w") as z:
        z.writestr("readme.txt", "hello")
    with pytest.raises(FormatError, match="without a member header.json"):
        pf.FibletSet.open(tmp_path / "zip.fiblets")
    with pytest.raises(FileNotFoundError):
        pf.FibletSet.open(tmp_path / "none.fiblets")


def test_a_truncated_file_is_refused(tmp_path):
    path = saved(tmp_path)
    data = path.read_bytes()
    for size in (0, 10, len(data) // 2, len(data) - 1):
        path.write_bytes(data[:size])
        with pytest.raises(FormatError):
            pf.FibletSet.open(path)


def test_verify_names_the_changed_member(tmp_path):
    path = saved(tmp_path)
    codes = pf.FibletSet.open(path).codes
    data = bytearray(path.read_bytes())
    data[codes.offset + 3] ^= 0xFF
    path.write_bytes(data)
    with pytest.raises(FormatError, match=r"changed bytes in codes.npy"):
        fiblets_format.verify_file(path)
