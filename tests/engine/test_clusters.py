"""Clusters of fiblets: boxes that hold them, and frames that do not depend on them."""

import numpy as np
import pytest

from pvfiblets import compress, regions
from pvfiblets.engine import FibletRenderer, FibletStyle, View
from pvfiblets.engine.fiblets.data import chunks
from pvfiblets.engine.fiblets.data.clusters import cluster_words
from pvfiblets.engine.fiblets.data.filter_textures import Filter
from pvfiblets.engine.fiblets.pipelines import compute
from pvfiblets.engine.gl.work_limits import WorkLimits
from pvfiblets.synthetic import brain_streamlines

from .pictures import differences, read
from .test_coverage import capsules
from .test_two_phase import Both, changed, orbit, random_views, shells
from .visibility_bits import planned

SIZE = (160, 120)


@pytest.fixture(autouse=True)
def clustered(monkeypatch):
    """Let sets of any size have clusters."""
    monkeypatch.setattr(chunks, "CLUSTERED", 0)


@pytest.fixture(scope="module")
def brain():
    """Return 27,000 fiblets."""
    return compress(brain_streamlines(4000, step=0.25))


@pytest.fixture(scope="module")
def onion():
    """Return 42,000 fiblets that hide each other well."""
    return shells(0.45)


@pytest.fixture
def both(gl):
    """Return a maker of a renderer with clusters beside one without culling."""
    made = []

    def make(fiblets, **options):
        made.append(Both(gl, fiblets, **options))
        assert all("clusters" in chunk.buffers for chunk in made[-1].culled._chunks)
        assert not any("clusters" in chunk.buffers for chunk in made[-1].whole._chunks)
        return made[-1]

    yield make
    for pair in made:
        pair.release()


@pytest.mark.parametrize("low", [False, True], ids=["anchors16", "anchors32"])
@pytest.mark.parametrize("part", [(0, None), (0, 100), (63, 64)])
def test_boxes_hold_their_fiblets_and_each_is_in_one(fabricate, random_lines, low, part):
    fiblets = fabricate(random_lines(300, seed=5), kind=2, per_fiblet=5, low=low)
    first, last = part[0], part[1] or fiblets.n_fiblets
    words = np.concatenate([np.ravel(words).view(np.uint32) for words in cluster_words(fiblets, first, last)])
    n = last - first
    count = -(-n // 64)
    assert len(words) == 3 * count + n
    order = words[3 * count :]
    assert sorted(order.tolist()) == list(range(n))
    boxes = words[: 3 * count].view(np.uint16).reshape(-1, 2, 3).astype(float)
    assert boxes.min() > 0
    assert boxes.max() < 65535
    unit = fiblets.anchor_scale * (65536.0 if low else 1.0)
    least, most = (fiblets.origin + (boxes[:, side] * 2.0 - 32768.0) * unit for side in (0, 1))
    a, b, r = (values[first:last][order] for values in capsules(fiblets))
    of = np.arange(n) // 64
    assert (np.minimum(a, b) - r[:, None] >= least[of]).all()
    assert (np.maximum(a, b) + r[:, None] <= most[of]).all()


def test_boxes_are_as_small_as_neighbours_allow(brain):
    """Consecutive fiblets are whole streamlines, those of a cluster some millimetres."""
    words = np.concatenate([np.ravel(words).view(np.uint32) for words in cluster_words(brain, 0, brain.n_fiblets)])
    count = -(-brain.n_fiblets // 64)
    boxes = words[: 3 * count].view(np.uint16).reshape(-1, 2, 3).astype(float)
    sides = (boxes[:, 1] - boxes[:, 0]) * 2.0 * brain.anchor_scale
    a, b, _ = capsules(brain)
    starts = np.arange(0, brain.n_fiblets, 64)
    coded = np.maximum.reduceat(np.maximum(a, b), starts) - np.minimum.reduceat(np.minimum(a, b), starts)
    assert np.median(np.linalg.norm(sides, axis=1)) < 0.5 * np.median(np.linalg.norm(coded, axis=1))


STYLES = {"thin": FibletStyle(), "wide": FibletStyle(3.0), "detail": FibletStyle(tolerance=2.0)}


@pytest.mark.few(1)
@pytest.mark.parametrize("style", STYLES)
def test_no_picture_shows_them(both, onion, camera, style):
    pair, size = both(onion), (400, 300)
    for angle in (0.0, 1.14, 67.0, 68.14):
        pair.draw(View(size, camera(size, **orbit(angle, 110.0, 30.0))), STYLES[style])
    assert pair.hidden > (0.4 if style == "wide" else 0.1) * pair.tested


@pytest.mark.more
@pytest.mark.parametrize("seed", [0, 1])
def test_random_cameras(both, brain, onion, camera, seed):
    rng = np.random.default_rng(seed)
    for fiblets in (brain, onion):
        pair = both(fiblets)
        for view, style in random_views(rng, 5, camera):
            pair.draw(view, style)
        assert pair.hidden > 0.01 * pair.tested


@pytest.mark.parametrize("low", [False, True], ids=["anchors16", "anchors32"])
def test_several_chunks(both, fabricate, random_lines, camera, low):
    fiblets = fabricate(random_lines(700, seed=12, longest=230), kind=2, per_fiblet=2, low=low)
    pair = both(fiblets, max_buffer_bytes=12 * (16384 + 1), max_groups=16)
    assert len(pair.culled._chunks) == 3
    for angle in (0.0, 1.14, 60.0, 180.0):
        pair.draw(View(SIZE, camera(SIZE, **orbit(angle, 180.0))), FibletStyle(4.0))
    assert pair.hidden > 0.03 * pair.tested


def test_planes_filters_and_slots(both, brain, camera, monkeypatch):
    monkeypatch.setattr(WorkLimits, "from_context", classmethod(lambda cls, ctx: cls(1 << 20, 1 << 62, 1000)))
    pair = both(brain)
    assert pair.culled._pipeline._marks[0].slots > 10
    rng = np.random.default_rng(3)
    for i, height in enumerate((40.0, 0.0, -20.0, None, 0.0)):
        planes = [] if height is None else [(0.1, 1.0, 0.2, height)]
        if i > 2:
            chosen = Filter(streamlines=rng.uniform(size=brain.n_streamlines) < 0.5)
            pair.culled.filtering = pair.whole.filtering = chosen
        pair.draw(View(SIZE, camera(SIZE, **orbit(4.0 * i))), FibletStyle(1.0 + i % 2))
        pair.draw(View(SIZE, camera(SIZE, **orbit(4.0 * i + 1.0)), planes), FibletStyle(2.0))


def test_most_clusters_are_not_looked_into(gl, onion, camera):
    """What a frame tests: fiblets seen before, and those of clusters that a pyramid does not hide."""
    renderer, size = FibletRenderer(gl, onion, culling="two-phase"), (100, 75)
    for angle in (0.0, 1.14, 2.28):
        renderer.render(View(size, camera(size, **orbit(angle, 110.0, 30.0))), FibletStyle(3.0))
    pipeline = renderer._pipeline
    marks, held = pipeline._marks[0], pipeline.buffers["visibility_bits"]
    for number in (compute.LAST_LEFT, compute.NOW_LEFT):
        left = int.from_bytes(held.read(4, offset=marks.length_at(number)), "little")
        assert 0 < 64 * left < 0.75 * onion.n_fiblets
    assert planned(renderer).sum() < 0.5 * onion.n_fiblets
    renderer.release()


@pytest.mark.exhaustive
def test_too_small_boxes_would_be_noticed(both, onion, camera, monkeypatch):
    changed(monkeypatch, "fiblets/compute/cluster_box.glsl", "0.5 * (b - a)", "0.1 * (b - a)")
    pair = both(onion)
    different = 0
    for view, style in random_views(np.random.default_rng(0), 8, camera):
        a, b = read(pair.culled.render(view, style)), read(pair.whole.render(view, style))
        different += sum(differences(a, b).values())
    assert different > 0


CUTS = {
    "planes": {"clip_planes": [(0.2, 1.0, 0.1, 0.0)]},
    "sphere": {"region": regions.Sphere((10.0, -5.0, 5.0), 20.0)},
    "outside": {"region": ~regions.Box((-20.0, 40.0, -40.0, 10.0, -30.0, 10.0))},
}


@pytest.mark.few(1)
@pytest.mark.parametrize("cut", CUTS)
def test_clusters_that_are_cut_away_are_not_looked_into(both, onion, camera, cut):
    """Frames do not show it. What is left is as little as boxes that reach into what is kept, from NumPy."""
    pair, size = both(onion), (200, 150)
    for angle, style in ((0.0, 3.0), (1.14, 1.0)):
        view = View(size, camera(size, **orbit(angle, 110.0, 30.0)), **CUTS[cut])
        pair.draw(view, FibletStyle(style))
    words = np.concatenate([np.ravel(words).view(np.uint32) for words in cluster_words(onion, 0, onion.n_fiblets)])
    boxes = words[: 3 * -(-onion.n_fiblets // 64)].view(np.uint16).reshape(-1, 2, 3).astype(float)
    unit = onion.anchor_scale * (1.0 if onion.anchors_low is None else 65536.0)
    least, most = (onion.origin + (boxes[:, side] * 2.0 - 32768.0) * unit for side in (0, 1))
    middle, reach = 0.5 * (least + most), 0.5 * (most - least)
    if cut == "planes":
        normal = np.array(CUTS[cut]["clip_planes"][0][:3])
        may = middle @ normal + reach @ np.abs(normal) >= -0.05
    else:
        ball = np.linalg.norm(reach, axis=1) + 0.5
        if cut == "sphere":
            may = np.linalg.norm(middle - (10.0, -5.0, 5.0), axis=1) <= 20.0 + ball
        else:
            low, high = np.reshape((-20.0, 40.0, -40.0, 10.0, -30.0, 10.0), (3, 2)).T
            may = ~((middle - ball[:, None] > low) & (middle + ball[:, None] < high)).all(axis=1)
    assert may.mean() < 0.9
    lengths = pair.culled._pipeline.list_lengths().sum(axis=0)
    assert 0 < lengths[compute.NOW_LEFT, 0] <= may.sum()
    assert 0 < lengths[compute.LAST_LEFT, 0] <= may.sum()


@pytest.mark.exhaustive
@pytest.mark.parametrize("cut", ["planes", "sphere"])
def test_too_small_cut_boxes_would_be_noticed(both, onion, camera, monkeypatch, cut):
    smaller = "!cut_away(Box(box.middle, 0.1 * box.reach))"
    changed(monkeypatch, "fiblets/compute/cluster_box.glsl", "!cut_away(box)", smaller)
    pair, different = both(onion), 0
    for angle in (0.0, 60.0, 120.0):
        view = View((300, 200), camera((300, 200), **orbit(angle, 110.0, 30.0)), **CUTS[cut])
        a, b = read(pair.culled.render(view, FibletStyle())), read(pair.whole.render(view, FibletStyle()))
        different += sum(differences(a, b).values())
    assert different > 0
