"""Sets in shards that are not put together: every answer is that of the same set put together."""

import copy
import pickle
from dataclasses import replace

import numpy as np
import pytest

import pvfiblets as pf
from pvfiblets import regions
from pvfiblets.codec.shards import unread_set
from pvfiblets.codec.shards.unread_set import UnreadSet
from pvfiblets.codec.shards.write import write_shards
from pvfiblets.codec.streamline_ranges import StreamlineRanges, coded_rows
from pvfiblets.query.measures.measures import measure
from pvfiblets.query.selection.endpoints import end_points
from pvfiblets.query.selection.passing import region_flags
from pvfiblets.query.selection.screen import under_polygon

from ..samples import assert_equal_streamlines
from ..test_extract import with_groups


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    whole = pf.compress(with_groups(), per_point=["height", "fine"], per_point_bits=16, exact=False)
    place = tmp_path_factory.mktemp("shards") / "a.fiblets"
    write_shards(whole, place, whole.nbytes // 5)
    return place


@pytest.fixture(scope="module")
def together(folder):
    return pf.ShardedSet.open(folder).gather()


@pytest.fixture
def unread(folder, monkeypatch):
    """One that cannot be put together."""
    found = pf.FibletSet.open(folder)
    assert isinstance(found, UnreadSet)
    monkeypatch.setattr(pf.ShardedSet, "gather", lambda *_: pytest.fail("all shards were put together"))
    return found


def test_facts_are_those_of_the_set(unread, together):
    names = "n_streamlines n_points n_fiblets n_ranks bounds promise step in_order dropped space parameters"
    for name in names.split():
        assert getattr(unread, name) == getattr(together, name), name
    np.testing.assert_array_equal(unread.affine, together.affine)
    np.testing.assert_array_equal(unread.rank_to_id, together.rank_to_id)
    for name in ("groups", "per_streamline"):
        found, wanted = getattr(unread, name), getattr(together, name)
        assert list(found) == list(wanted)
        for key, rows in wanted.items():
            np.testing.assert_array_equal(found[key], rows)
            assert found[key].dtype == rows.dtype
    assert {g: {k: list(v) for k, v in d.items()} for g, d in unread.per_group.items()} == {
        g: {k: list(v) for k, v in d.items()} for g, d in together.per_group.items()
    }
    for key, stored in together.per_point.items():
        np.testing.assert_array_equal(unread.per_point[key].codes, stored.codes)
        np.testing.assert_array_equal(unread.per_point[key].values(slice(5, 99)), stored.values(slice(5, 99)))
        assert len(unread.per_point[key].codes) == unread.n_points
    np.testing.assert_array_equal(unread.offsets(), together.offsets())
    np.testing.assert_array_equal(unread.lengths(), together.lengths())
    np.testing.assert_array_equal(coded_rows(unread), coded_rows(together))
    found, wanted = StreamlineRanges.from_fiblets(unread), StreamlineRanges.from_fiblets(together)
    for name in ("fiblet", "fiblets", "point", "points"):
        np.testing.assert_array_equal(getattr(found, name), getattr(wanted, name))
    assert "FibletSet(" in repr(unread)
    assert unread._repr_html_()


@pytest.mark.parametrize("ids", [None, [5, 3, 5, -1], slice(10, 20), np.arange(0)])
def test_points_are_those_of_the_set(unread, together, ids):
    assert_equal_streamlines(unread.decompress(ids), together.decompress(ids))
    if ids is not None:
        assert_equal_streamlines(unread[ids].decompress(), together[ids].decompress())


@pytest.mark.more
def test_chunks_are_those_of_the_set(unread, together):
    chunks = list(unread.iter_chunks(200))
    assert len(chunks) > 3
    points = np.concatenate([chunk.points for chunk in chunks])
    np.testing.assert_array_equal(points, together.decompress().points)


@pytest.mark.more
def test_questions_have_the_same_answers(unread, together):
    middle = np.reshape(together.bounds, (3, 2)).mean(axis=1)
    ball = regions.Sphere(middle, float(np.ptp(np.reshape(together.bounds, (3, 2)), axis=1).max()) / 4)
    np.testing.assert_array_equal(region_flags(unread, ball), region_flags(together, ball))
    some = np.arange(0, len(together), 3)
    np.testing.assert_array_equal(region_flags(unread, ball, ids=some), region_flags(together, ball, ids=some))
    np.testing.assert_array_equal(end_points(unread), end_points(together))
    for name in ("length", "mean_curvature", "curvature", "arc_length", "end_distance", "n_points"):
        np.testing.assert_array_equal(measure(unread, name).array(), measure(together, name).array())
    np.testing.assert_array_equal(unread.density(5.0).values, together.density(5.0).values)
    matrix = np.diag([*(1.0 / np.abs(together.bounds).max() / 1.01 for _ in range(3)), 1.0])
    words = np.random.default_rng(0).integers(0, 2**32, together.n_points // 32 + 2, np.uint64).astype(np.uint32)
    for points in (None, words):
        found, wanted = (
            under_polygon(one, matrix, (100, 100), [(20, 20), (70, 20), (70, 80)], points=points)
            for one in (unread, together)
        )
        assert len(wanted.ids) > 3
        np.testing.assert_array_equal(found.depths, wanted.depths)
        for name in ("ids", "places"):
            np.testing.assert_array_equal(
                getattr(found, name)[np.argsort(found.ids)], getattr(wanted, name)[np.argsort(wanted.ids)]
            )


def test_it_travels_without_its_records(unread):
    for other in (pickle.loads(pickle.dumps(unread)), copy.deepcopy(unread)):
        assert isinstance(other, UnreadSet)
        assert other.numbers == unread.numbers
    assert len(pickle.dumps(unread)) < 20_000


def test_records_are_put_together_when_they_are_asked_for(folder, together):
    unread = pf.FibletSet.open(folder)
    for name in ("anchors", "decoding", "codes", "ends", "pages", "reach"):
        np.testing.assert_array_equal(getattr(unread, name), getattr(together, name))
    np.testing.assert_array_equal(unread.anchors_low, together.anchors_low)
    assert unread.exact is None
    other = replace(unread, groups={})
    assert type(other) is pf.FibletSet
    assert_equal_streamlines(other.decompress(), replace(together, groups={}).decompress())


def test_some_shards_are_a_part_whose_streamlines_keep_their_numbers(folder, together):
    part = pf.FibletSet.open(folder).of_shards([1, 3])
    mine = np.concatenate([part.shards.ids(1), part.shards.ids(3)])
    assert (len(part), part.n_points) == (len(together), int(np.diff(together.offsets())[mine].sum()))
    wanted = together.decompress(mine)
    for found in (part, part.gathered):
        np.testing.assert_array_equal(found.decompress(mine).points, wanted.points)
        others = np.setdiff1d(np.arange(len(together)), mine)
        assert found.decompress(others).n_points == 0
    none = part.of_shards([])
    assert (none.n_points, len(none), none.gathered.n_points) == (0, len(together), 0)


def test_too_little_memory_is_told(folder, monkeypatch):
    monkeypatch.setattr(unread_set, "free_host_memory", lambda: 100)
    with pytest.raises(MemoryError, match=r"shards together are .* GB.*fit='stream'"):
        _ = pf.FibletSet.open(folder).anchors


def test_the_thinned_level_is_an_even_share(folder, together):
    part, ids = pf.ShardedSet.open(folder).thinned()
    assert 0 < len(part) < len(together) / 4
    np.testing.assert_array_equal(part.decompress().points, together.decompress(ids).points)
    assert not list(folder.glob("thinned*.fiblets")), "patterns of shards leave it out"


def test_a_set_without_a_thinned_level_is_read(folder, tmp_path, together):
    import json
    import shutil

    old = tmp_path / "old.fiblets"
    shutil.copytree(folder, old)
    manifest = json.loads((old / "manifest.json").read_text())
    del manifest["thinned"]
    (old / "manifest.json").write_text(json.dumps(manifest))
    shards = pf.ShardedSet.open(old)
    shards.verify()
    assert shards.thinned() is None
    assert_equal_streamlines(pf.FibletSet.open(old).decompress(), together.decompress())
