"""Pictures drawn by workers and put together: held against a renderer of all of the set, bit by bit."""

import os
import pickle
import signal
from contextlib import contextmanager

import numpy as np
import pytest
import pyvista as pv

from pvfiblets import compress, regions
from pvfiblets.cli.command import main
from pvfiblets.cluster import connection
from pvfiblets.cluster.connection import connected
from pvfiblets.codec.fibletset import FibletSet
from pvfiblets.engine import EngineError, FibletRenderer, FibletStyle, View
from pvfiblets.engine.fiblets import sample_layers
from pvfiblets.engine.fiblets.data.filter_textures import Filter
from pvfiblets.engine.fiblets.data.sampled_volume import VolumeSource
from pvfiblets.engine.fiblets.parts import cluster_renderer
from pvfiblets.engine.fiblets.parts.cluster_renderer import ClusterRenderer, _client_at
from pvfiblets.engine.fiblets.parts.sparse_picture import SparsePicture, nearer
from pvfiblets.report.studies.stability.render_checks import camera
from pvfiblets.web.scene.scene import Scene
from pvfiblets.web.scene.slices.slicing import ready_views
from tests.engine.pictures import SIZE, assert_alike, brain_with_gaps, read

pytestmark = pytest.mark.more

VIEW = View(SIZE, camera(SIZE, eye=(0, -300, 40), target=(0, -10, 20), far=900.0))
CLOSE = View(SIZE, camera(SIZE, eye=(60, -60, 90), target=(20, 0, 40), far=900.0))


@pytest.fixture(scope="module")
def brain(tmp_path_factory):
    """A set of a file, mapped."""
    path = tmp_path_factory.mktemp("set") / "brain.fiblets"
    brain_with_gaps(600, 2.0).save(path)
    return FibletSet.open(path)


@pytest.fixture(autouse=True)
def usual_programs(monkeypatch):
    """Draw here as workers do, whatever tests of the engine before have set for this process."""
    monkeypatch.setattr("pvfiblets.engine.fiblets.pipelines.compute.FEW", 2048)


@pytest.fixture
def whole(gl, brain):
    made = FibletRenderer(gl, brain, culling=None)
    yield made
    made.release()


@pytest.fixture
def make(gl, client):
    made = []

    def renderer(fiblets, **options):
        made.append(ClusterRenderer(gl, fiblets, client, **options))
        return made[-1]

    yield renderer
    for one in made:
        one.release()


@pytest.mark.parametrize("count", [1, 2, 3, 4])
def test_workers_draw_what_one_machine_draws(make, whole, brain, count):
    parts = make(brain, count=count)
    for style in (FibletStyle(values="height"), FibletStyle(line_width=4.0, across=True, edges=True)):
        for view in (VIEW, CLOSE):
            assert_alike(read(parts.render(view, style)), read(whole.render(view, style)))
    told = parts.explain()
    assert (parts.share, told["share"], parts.unfinished) == (1.0, 1.0, False)
    assert len(told["cluster"]["draw_ms"]) == told["cluster"]["parts"] == count
    assert len(told["cluster"]["merge_ms"]) == count - 1
    assert told["cluster"]["bytes"] > 0


@pytest.mark.exhaustive
@pytest.mark.parametrize("workers", [3, 4])
def test_more_workers_draw_it_too(gl, whole, brain, workers):
    with connected(None, workers, None, dashboard=False) as client:
        parts = ClusterRenderer(gl, brain, client)
        assert len(parts._parts) == workers
        assert_alike(read(parts.render(VIEW)), read(whole.render(VIEW)))
        parts.release()


def test_a_set_in_memory_is_sent_part_by_part(make, whole, brain):
    held = compress(brain.decompress(), per_point=["height"])
    other = FibletRenderer(whole._ctx, held, culling=None)
    assert_alike(read(make(held).render(VIEW)), read(other.render(VIEW)))
    other.release()


@pytest.fixture(scope="module")
def shards(brain, tmp_path_factory):
    """The same set in shards."""
    place = tmp_path_factory.mktemp("shards") / "brain.fiblets"
    brain.save(place, shards=brain.nbytes // 6)
    return FibletSet.open(place)


def test_workers_read_shards_themselves(make, gl, shards, monkeypatch):
    together = shards.shards.gather()
    monkeypatch.setattr("pvfiblets.ShardedSet.gather", lambda *_: pytest.fail("all shards were put together"))
    other = FibletRenderer(gl, together, culling=None)
    parts = make(shards, count=3)
    style = FibletStyle(values="height")
    rng = np.random.default_rng(0)
    words = rng.integers(0, 2**32, -(-shards.n_points // 32), np.uint64).astype(np.uint32)
    for filtering in (None, Filter(rng.random(shards.n_streamlines) < 0.5, words)):
        other.filtering = parts.filtering = filtering
        assert_alike(read(parts.render(VIEW, style)), read(other.render(VIEW, style)))
    assert len(parts.explain()["cluster"]["draw_ms"]) == 3
    assert parts.value_range("height") == other.value_range("height")
    assert sum(len(pickle.dumps(parts._stretches.part(n))) for n in range(3)) < 30_000, "the manifest alone is sent"
    other.release()


def test_cuts_and_filters_are_those_of_the_whole_set(make, whole, brain):
    parts = make(brain)
    rng = np.random.default_rng(0)
    words = rng.integers(0, 2**32, -(-brain.n_points // 32), np.uint64).astype(np.uint32)
    cuts = {"clip_planes": [(1.0, 0.0, 0.0, 5.0)], "region": regions.Sphere((0, 0, 20), 40.0)}
    view = View(SIZE, VIEW.model_view_projection, **cuts)
    for filtering in (Filter(rng.random(brain.n_streamlines) < 0.5, words), None):
        whole.filtering = parts.filtering = filtering
        assert_alike(read(parts.render(view)), read(whole.render(view)))
    with pytest.raises(ValueError, match="5 streamlines are kept or not; the set has 603"):
        parts.filtering = Filter(np.ones(5, bool))


def test_values_of_volumes_and_ranges(make, whole, brain):
    parts = make(brain)
    volume = VolumeSource(np.arange(8, dtype=np.float32).reshape(2, 2, 2), np.diag([80.0, 80.0, 80.0, 1.0]))
    style = FibletStyle(values=volume)
    assert_alike(read(parts.render(VIEW, style)), read(whole.render(VIEW, style)))
    for values in ("height", "curvature", volume):
        assert parts.value_range(values) == whole.value_range(values)
    with pytest.raises(EngineError, match="no per-point array 'none'"):
        parts.value_range("none")


def test_a_worker_that_dies_is_made_up_for(make, whole, brain, client):
    parts = make(brain)
    parts.render(VIEW)
    os.kill(next(iter(client.run(os.getpid).values())), signal.SIGKILL)
    assert_alike(read(parts.render(CLOSE)), read(whole.render(CLOSE)))
    assert parts.share == 1.0
    client.wait_for_workers(2)
    assert_alike(read(parts.render(VIEW)), read(whole.render(VIEW)))


@contextmanager
def busy(client, workers):
    """Have workers that do nothing else meanwhile."""
    from distributed import Event

    def hold(begun, end):
        begun.set()
        end.wait(120)

    end, begun = Event(client=client), {worker: Event(client=client) for worker in workers}
    held = [client.submit(hold, one, end, pure=False, priority=100, workers=[at]) for at, one in begun.items()]
    assert all(one.wait(120) for one in begun.values())
    try:
        yield
    finally:
        end.set()
        client.gather(held)


def test_a_late_part_leaves_the_picture_incomplete_and_the_next_goes_on(make, whole, brain, client):
    parts = make(brain, count=2)
    parts.render(VIEW)
    # dask has whoever is free draw what is late: both are busy.
    with busy(client, parts._workers()):
        parts.patience = 0.2
        seen = [read(parts.render(CLOSE)).drawn.sum()]
        assert parts.unfinished
        assert parts.share < 1.0
    while parts.unfinished:
        seen.append(read(parts.render(CLOSE)).drawn.sum())
    assert (np.diff(seen) >= 0).all()
    assert_alike(read(parts.render(CLOSE)), read(whole.render(CLOSE)))


def test_a_changed_file_is_reported(gl, client, brain, tmp_path):
    path = tmp_path / "moved.fiblets"
    brain.save(path)
    parts = ClusterRenderer(gl, FibletSet.open(path), client)
    path.unlink()
    with pytest.raises(EngineError, match="finds no .*moved.fiblets; put the set where all workers see it"):
        parts.render(VIEW)
    parts.release()


def test_workers_that_all_go_away_are_told(make, brain, client, monkeypatch):
    parts = make(brain)
    monkeypatch.setattr(cluster_renderer, "GRACE", 0.0)
    monkeypatch.setattr(cluster_renderer, "TICK", 0.01)
    with busy(client, parts._workers()):
        parts._ask(VIEW, FibletStyle())
        monkeypatch.setattr(parts, "_present_workers", list)
        with pytest.raises(EngineError, match="no workers; start some, or leave the cluster out"):
            parts.render(VIEW)


def test_no_cluster_and_no_workers_are_told(gl, brain, monkeypatch):
    monkeypatch.setattr(cluster_renderer, "GRACE", 0.0)
    with pytest.raises(TypeError, match=r"cluster is 3; give a distributed\.Client"):
        ClusterRenderer(gl, brain, 3)

    class Deserted:
        def submit(self):
            raise AssertionError

        def scheduler_info(self, n_workers):
            return {"workers": {}}

    with pytest.raises(EngineError, match="no workers; start some, or leave the cluster out"):
        ClusterRenderer(gl, brain, Deserted())


def test_two_pictures_are_put_together_the_same_way_in_any_order():
    rng = np.random.default_rng(1)

    def picture(order):
        pixels = np.flatnonzero(rng.random(1000) < 0.6).astype(np.uint32)
        depth = rng.integers(0, 5, len(pixels)).astype(np.uint32)  # many are at one depth
        owner = np.full(len(pixels), order, np.uint32)
        return SparsePicture((40, 25), order, pixels, {"depth": depth, "owner": owner, "ids": pixels + 7 * owner})

    def dense(one):
        full = np.full((3, 1000), 2**32 - 1, np.uint64)
        for row, name in enumerate(("depth", "owner", "ids")):
            full[row, one.pixels] = one.textures[name]
        return full

    many = [picture(order) for order in range(5)]
    stacked = np.stack([dense(one) for one in many])
    first = np.lexsort((stacked[:, 1], stacked[:, 0]), axis=0)[0]
    expected = np.take_along_axis(stacked, first[None, None], axis=0)[0]
    for order in (range(5), (3, 1, 4, 0, 2)):
        found = many[order[0]]
        for number in order[1:]:
            found = nearer(found, many[number])
        np.testing.assert_array_equal(dense(found), expected)
        assert len(np.unique(found.pixels)) == len(found.pixels)


def test_a_plotter_shows_what_workers_draw(client, brain):
    def shot(**options):
        plotter = pv.Plotter(off_screen=True, window_size=(160, 120))
        plotter.add_mesh(pv.Sphere(radius=40.0, center=(0, 0, 20)), color="white")
        actor = plotter.add_fiblets(brain, scalars="height", **options)
        actor.include(regions.Sphere((20, 0, 20), 40.0))
        plotter.show(auto_close=False)
        picture = plotter.screenshot(None)
        places = [(x, y) for x in range(0, 160, 16) for y in range(0, 120, 16)]
        found = picture, [actor.pick_at(*at) for at in places], actor.explain().get("cluster")
        plotter.close()
        return found

    picture, hits, told = shot(cluster=client)
    here, there, _ = shot()
    np.testing.assert_array_equal(picture, here)
    assert hits == there
    assert any(hits)
    assert told["parts"] == 2


@pytest.mark.parametrize("other", [None, "mesh", "lines before", "lines after"])
def test_samples_of_what_workers_draw_are_those_of_one_machine(client, brain, other, monkeypatch):
    monkeypatch.setattr(sample_layers, "MOST_TEXELS", 2**17)
    among = [line + 0.5 for line in brain.decompress()][::2]

    def shot(**options):
        plotter = pv.Plotter(off_screen=True, window_size=(160, 120))
        plotter.picture.antialias = "refined"
        if other == "mesh":
            plotter.add_mesh(pv.Sphere(radius=40.0, center=(0, 0, 20)), color="white")
        if other == "lines before":
            plotter.add_fiblets(among, color="white")
        actor = plotter.add_fiblets(brain, scalars="height", **options)
        if other == "lines after":
            plotter.add_fiblets(among, color="white")
        actor.include(regions.Sphere((20, 0, 20), 40.0))
        plotter.show(auto_close=False)
        found = plotter.screenshot(None)
        assert plotter.picture.samples == 16
        plotter.close()
        return found

    here = shot()
    assert len(np.unique(here.reshape(-1, 3), axis=0)) > 500
    np.testing.assert_array_equal(shot(cluster=client), here)


def test_a_page_has_workers_draw(client, brain, tmp_path):
    brain.save(tmp_path / "brain.fiblets")
    pictures, told = [], []
    for cluster in (client.scheduler.address, None):
        plotter = pv.Plotter(off_screen=True, window_size=(120, 90), shape=(2, 2), border=False)
        ready_views(plotter)
        scene = Scene(plotter, tmp_path, cluster=cluster)
        scene.open("brain.fiblets")
        plotter.show(auto_close=False)
        pictures.append(plotter.screenshot(None))
        told.append(next(iter(plotter.actors.values())).explain().get("cluster"))
        scene.close()
        plotter.close()
    assert pictures[0].std() > 1.0
    np.testing.assert_array_equal(*pictures)
    assert told[0]["parts"] == 2
    assert told[1] is None
    _client_at(client.scheduler.address).close()
    _client_at.cache_clear()


def test_an_address_without_a_server_is_reported(gl, brain, monkeypatch, capsys):
    monkeypatch.setattr(cluster_renderer, "GRACE", 0.2)
    with pytest.raises(EngineError, match=r"no scheduler of dask answers at tcp://127\.0\.0\.1:9 .* dask scheduler"):
        ClusterRenderer(gl, brain, "tcp://127.0.0.1:9")
    monkeypatch.setattr(connection, "ANSWER_WITHIN", 0.2)
    assert main(["serve", "--port", "0", "--cluster", "tcp://127.0.0.1:9"]) == 1
    assert "no scheduler of dask answers at tcp://127.0.0.1:9" in capsys.readouterr().err
