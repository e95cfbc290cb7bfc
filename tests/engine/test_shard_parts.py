"""Sets in shards, drawn shard by shard: held against a renderer of all of the set, bit by bit."""

import threading
import time
from concurrent.futures import Future

import numpy as np
import pytest

import pvfiblets as pf
from pvfiblets.codec.shards.store import Folder
from pvfiblets.codec.shards.unread_set import UnreadSet
from pvfiblets.codec.shards.write import write_shards
from pvfiblets.engine import FibletRenderer, FibletStyle, View
from pvfiblets.engine.fiblets.data.filter_textures import Filter
from pvfiblets.engine.fiblets.parts.shard_parts import ShardGroups, ShardParts, gpu_bytes_of_shards
from pvfiblets.engine.fiblets.parts.streamed_renderer import StreamedRenderer, streamed_renderer

from .pictures import SIZE, assert_alike, brain_with_gaps, read

WHOLE_BRAIN = {"eye": (0, -300, 40), "target": (0, -10, 20), "far": 900.0}
NEAR = {"eye": (60, -60, 90), "target": (20, 0, 40), "far": 900.0}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    whole = brain_with_gaps(1500, 1.5)
    place = tmp_path_factory.mktemp("shards") / "brain.fiblets"
    write_shards(whole, place, whole.nbytes // 20)
    return place


@pytest.fixture(scope="module")
def together(folder):
    return pf.ShardedSet.open(folder).gather()


class Far(Folder):
    """A folder whose shards are fetched one by one, when they are let through."""

    def __init__(self, path):
        super().__init__(path)
        self.here, self.asked, self.let = set(), [], threading.Semaphore(0)

    def is_here(self, file):
        return file.name in self.here

    def local(self, file):
        if file.name not in self.here and file.name.endswith(".fiblets"):
            self.asked.append(file.name)
            assert self.let.acquire(timeout=20)
        self.here.add(file.name)
        return super().local(file)


@pytest.fixture
def far(folder, monkeypatch):
    monkeypatch.setattr(pf.ShardedSet, "gather", lambda *_: pytest.fail("all shards were put together"))
    shards = pf.ShardedSet.open(folder)
    shards._store = store = Far(folder)
    store.let.release()  # the first shard, which has what all share
    shards.shard(0)
    return UnreadSet(shards)


@pytest.fixture
def made(gl, together):
    renderers = []

    def make(fiblets, share=0.5, **options):
        whole = FibletRenderer(gl, together, culling=None)
        room = int(share * gpu_bytes_of_shards(fiblets))
        parts = streamed_renderer(gl, fiblets, max_total_bytes=room, **options)
        renderers.extend([whole, parts])
        return whole, parts

    yield make
    for renderer in renderers:
        renderer.release()


@pytest.mark.more
@pytest.mark.parametrize("share", [0.9, 0.35])
def test_a_complete_picture_is_that_of_the_whole_set(made, camera, folder, share, monkeypatch):
    unread = pf.FibletSet.open(folder)
    monkeypatch.setattr(pf.ShardedSet, "gather", lambda *_: pytest.fail("all shards were put together"))
    whole, parts = made(unread, share)
    assert isinstance(parts, StreamedRenderer)
    for place in (WHOLE_BRAIN, NEAR):
        view = View(SIZE, camera(SIZE, **place))
        for style in (FibletStyle(values="height"), FibletStyle(line_width=4.0, across=True, edges=True)):
            assert_alike(read(parts.render(view, style)), read(whole.render(view, style)))
    divided = parts.explain()["parts"]["total"]
    shards = len(unread.shards.shards)
    assert divided == shards if share == 0.9 else divided > shards, "large shards are divided"
    assert parts.value_range("height") == whole.value_range("height")


def test_what_fits_is_put_together(gl, folder):
    renderer = streamed_renderer(gl, pf.FibletSet.open(folder))
    assert isinstance(renderer, FibletRenderer)
    renderer.release()


@pytest.mark.more
def test_cuts_and_filters_are_those_of_the_whole_set(made, camera, folder, together):
    whole, parts = made(pf.FibletSet.open(folder))
    rng = np.random.default_rng(0)
    words = rng.integers(0, 2**32, -(-together.n_points // 32), np.uint64).astype(np.uint32)
    whole.filtering = parts.filtering = Filter(rng.random(together.n_streamlines) < 0.5, words)
    view = View(SIZE, camera(SIZE, **WHOLE_BRAIN), clip_planes=[(1.0, 0.0, 0.0, 5.0)])
    assert_alike(read(parts.render(view)), read(whole.render(view)))


def test_shards_that_show_nothing_are_not_fetched(made, camera, far):
    for _ in range(40):
        far.shards._store.let.release()
    whole, parts = made(far, 0.9)
    view = View(SIZE, camera(SIZE, **WHOLE_BRAIN), clip_planes=[(1.0, 0.0, 0.0, -45.0)])
    assert_alike(read(parts.render(view)), read(whole.render(view)))
    seen = len(far.shards._store.here)
    told = parts.explain()["parts"]
    assert 0 < told["in_view"] < told["total"]
    assert seen < 2 * len(far.shards.shards)
    # Nor are those of which the filter keeps nothing.
    mask = np.zeros(len(far), bool)
    mask[far.shards.ids(0)] = True
    whole.filtering = parts.filtering = Filter(mask, None)
    view = View(SIZE, camera(SIZE, **WHOLE_BRAIN))
    assert_alike(read(parts.render(view)), read(whole.render(view)))
    assert parts.explain()["parts"]["in_view"] == 1


def test_pictures_go_on_while_shards_come(made, camera, far):
    whole, parts = made(far, 0.9)
    store = far.shards._store
    parts.patience = 0.05
    view = View(SIZE, camera(SIZE, **WHOLE_BRAIN))
    store.let.release()  # the even share
    store.here.update(name for name in (far.shards.manifest.thinned.fiblets.name,))
    first = read(parts.render(view))
    everything = read(whole.render(view))
    assert parts.unfinished
    assert parts.share < 0.3
    assert 0.1 < first.drawn.sum() / everything.drawn.sum() < 1.0, "the first shard and the even share"
    assert (first.depth[first.drawn] >= everything.depth[first.drawn]).all()
    assert len(store.asked) <= 4, "few at once"
    shares = []
    until = time.monotonic() + 120.0  # only a hang reaches it
    while parts.unfinished and time.monotonic() < until:
        store.let.release()
        parts.render(view)
        shares.append(parts.share)
    assert not parts.unfinished
    assert shares[-1] == 1.0
    assert len(set(shares)) > 3
    told = parts.explain()["parts"]
    assert told["fetched"] <= told["total"] + 1, "each part and the even share once: no picture begins anew"
    assert_alike(read(parts.render(view)), everything)


def test_shards_that_are_here_before_their_threads_end_make_room_for_others(far):
    parts, threads = ShardParts(far, 1 << 30), []

    class Pool:
        def submit(self, fetch, shard):
            far.shards._store.let.release()
            fetch(shard)
            threads.append(Future())
            return threads[-1]

    parts._pool = Pool()
    numbers = [number for number in range(len(parts)) if not parts.is_here(number)]
    assert len(threads) == 2
    left = [number for number in numbers if not parts.is_here(number)]
    assert len(left) == len(numbers) - 2, "these are drawn, and not asked for again"
    for thread in threads:
        thread.set_result(None)
    for number in left:
        parts.is_here(number)
    assert len(threads) == 4


def test_an_unreachable_shard_is_reported(made, camera, far, monkeypatch):
    _, parts = made(far)
    store = far.shards._store
    parts.patience = 0.05

    def lost(file):
        raise OSError(f"{file.name}: it cannot be fetched")

    monkeypatch.setattr(store, "local", lambda file: Folder.local(store, file) if "thin" in file.name else lost(file))
    view = View(SIZE, camera(SIZE, **WHOLE_BRAIN))

    def wait():
        while True:
            parts.render(view)

    with pytest.raises(OSError, match="cannot be fetched"):
        wait()


def test_boxes_hold_all_points(folder, together):
    parts = ShardParts(pf.FibletSet.open(folder), 10_000)
    found = []
    for number in range(len(parts)):
        part, box = parts.part(number), parts.box(number)
        if part.n_points:
            points = part.decompress(part.rank_to_id).points
            assert (points >= box[0]).all()
            assert (points <= box[1]).all()
        found.append(np.asarray(part.rank_to_id))
    np.testing.assert_array_equal(np.sort(np.concatenate(found)), np.flatnonzero(np.diff(together.offsets())))


@pytest.mark.parametrize("old", [False, True])
def test_the_even_share_keeps_to_its_size(folder, together, old, monkeypatch):
    if old:
        monkeypatch.setattr(pf.ShardedSet, "thinned", lambda _: None)
    parts = ShardParts(pf.FibletSet.open(folder), 10_000)
    sizes = []
    for nbytes in (6_000, 2_500):
        part = parts.thinned(nbytes)
        sizes.append(part.nbytes)
        ids = np.asarray(part.rank_to_id)
        np.testing.assert_array_equal(part.decompress(ids).points, together.decompress(ids).points)
    assert sizes[1] < 0.7 * sizes[0]
    assert sizes[1] < 5_000


@pytest.mark.parametrize("count", [1, 2, 5, 19, 40])
def test_groups_hold_each_shard_once(folder, count):
    unread = pf.FibletSet.open(folder)
    groups = ShardGroups(unread, count)
    numbers = [groups.part(number).numbers for number in range(len(groups))]
    assert len(groups) == min(count, len(unread.numbers))
    assert sum(numbers, ()) == unread.numbers
    assert all(numbers)
    sizes = [groups.part(number).n_fiblets for number in range(len(groups))]
    assert max(sizes) < 2.5 * unread.n_fiblets / len(groups)
    for number in range(len(groups)):
        part = groups.part(number)
        np.testing.assert_array_equal(groups.ids(number), part.gathered.rank_to_id if count > 1 else part.rank_to_id)
